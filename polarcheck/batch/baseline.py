"""
A baseline: findings that are known, so that only new ones are told.

A finding is known by its rule and its fingerprint, which are counted in each file. A file that has been moved is known
by what is found in it, once its old path is gone.
"""

from __future__ import annotations

import os
import re
from collections import Counter
from collections.abc import Collection, Iterable, Iterator, Mapping
from pathlib import Path
from typing import NamedTuple

import msgspec

from polarcheck.batch.baseline_file import Entry, Key
from polarcheck.checking.check import verdict
from polarcheck.checking.engine import in_order
from polarcheck.checking.not_evaluated import bound_silenced
from polarcheck.finding import BASELINE, SEVERITIES, FileReport, Finding, NotEvaluated, Silenced
from polarcheck.reading.excerpt import shortened
from polarcheck.reading.files import STANDARD_INPUT, shown
from polarcheck.silence.suppression import silenced

#: Of the block that is shown for whoever reads the file [characters].
_BLOCK = 80


class Leftover(NamedTuple):
    """An entry, and how many of its findings are missing; is_gone: the whole file is not there."""

    entry: Entry
    missing: int
    is_gone: bool


class Updated(NamedTuple):
    """The entries of what is found now, and how many of the findings are new."""

    entries: list[Entry]
    new: int


class Baseline:
    """
    What is known of the files of a run.

    walked: files and folders that the run was asked for, None for all: of what is gone from elsewhere it says nothing.
    moved: by the paths of files, from the folder of the baseline, the gone ones whose entries count for them.
    """

    def __init__(
        self, entries: Iterable[Entry], folder: Path, paths: Iterable[str], walked: Iterable[str] | None = None
    ) -> None:
        self.folder = os.path.realpath(folder)
        self.of_file: dict[str, list[Entry]] = {}
        for entry in entries:
            self.of_file.setdefault(os.path.normcase(entry.file), []).append(entry)
        self.path_of = {shown(path): self._relative(path) for path in paths}
        self.moved: dict[str, str] = {}
        self._matched: dict[str, Counter[Key]] = {}
        self._asked: dict[str, Collection[str]] = {}
        self._gone = self._not_there()
        self._walked = None if walked is None else [os.path.normcase(os.path.realpath(path)) for path in walked]
        self._taken: set[str] = set()
        self._counts = {file: _counted(self.of_file[file]) for file in self._gone}
        self._gone_with: dict[Key, list[str]] = {}
        for file, counts in self._counts.items():
            for key in counts:
                self._gone_with.setdefault(key, []).append(file)
        # Each gone file whose name a new one has is kept for that, whichever of them is checked first.
        self._new_names = {_name(path) for path in self._new()}

    def _relative(self, path: str) -> str:
        """The path of a program from the folder of the baseline, with slashes; of another drive all of it."""
        if path == STANDARD_INPUT:
            return path
        folder, name = os.path.split(path)
        whole = os.path.join(os.path.realpath(folder or os.curdir), name)  # noqa: PTH118
        try:
            return shown(os.path.relpath(whole, self.folder))
        except ValueError:
            return shown(whole)

    def _not_there(self) -> list[str]:
        """The files of entries that are no longer there."""
        checked = {os.path.normcase(path) for path in self.path_of.values()}
        return [
            file
            for file in self.of_file
            if file not in checked and file != STANDARD_INPUT and not os.path.lexists(os.path.join(self.folder, file))  # noqa: PTH118
        ]

    def _dropped(self) -> Iterator[str]:
        """The files that are gone from where the run was, and were not moved to where it was."""
        for file in self._gone:
            whole = os.path.normcase(os.path.normpath(os.path.join(self.folder, file)))  # noqa: PTH118
            was_in_run = self._walked is None or any(
                whole == path or whole.startswith(os.path.join(path, ""))  # noqa: PTH118
                for path in self._walked
            )
            if was_in_run and file not in self._taken:
                yield file

    def _new(self) -> Iterator[str]:
        """The files of this run that no entry is for."""
        return (path for path in self.path_of.values() if os.path.normcase(path) not in self.of_file)

    def known(self, report: FileReport) -> list[Entry]:
        """The entries that count for a file."""
        path = os.path.normcase(self.path_of[report.path])
        if path in self.of_file:
            return self.of_file[path]
        if path not in self.moved:
            self.moved[path] = self._origin(path, Counter(map(_key, report.findings)))
            self._taken.add(self.moved[path])
        return self.of_file.get(self.moved[path], [])

    def _origin(self, path: str, found: Counter[Key]) -> str:
        """
        The gone file that this one was, empty for none.

        It has the same name and a finding in common, or at least half of all that was known of it is found here, so
        that one common block does not make a new program an old one.
        """
        common: Counter[str] = Counter()
        for key, count in found.items():
            for file in self._gone_with.get(key, ()):
                common[file] += min(count, self._counts[file][key])
        likely = [
            file
            for file in common
            if file not in self._taken
            and (
                _name(file) == _name(path)
                or (_name(file) not in self._new_names and 2 * common[file] >= self._counts[file].total())
            )
        ]
        return min(likely, key=lambda file: (_name(file) != _name(path), -common[file], file), default="")

    def answered(self, report: FileReport, asked: Collection[str], fail_on: str = "warning") -> FileReport:
        """
        The report with the known findings silenced, and the verdict of the rest; what follows from one goes with it.

        One that is more severe than it was, or from which something else follows, is told: it is not what was known.
        asked: the rules that were asked and could be evaluated.
        """
        known = {entry.key: entry for entry in _added_up(self.known(report))}
        left = _counted(known.values())
        told: list[Finding] = []
        silent: list[Silenced] = []
        bounds: list[NotEvaluated | None] = []
        for finding in report.findings:
            key = _key(finding)
            if not left[key]:
                told.append(finding)
                continue
            left[key] -= 1
            entry = known[key]
            if SEVERITIES[finding.severity] > SEVERITIES[entry.severity] or not _rules(finding) <= {*entry.follows}:
                told.append(finding)
            else:
                silent.append(silenced(finding, BASELINE, entry.reason))
                bounds.append(bound_silenced(finding))
        path = os.path.normcase(self.path_of[report.path])
        matched = _counted(known.values()) - left
        self._matched[path] = matched | self._matched.get(path, Counter())
        self._asked[path] = asked
        if not silent:
            return report
        not_evaluated = [*report.not_evaluated, *filter(None, bounds)]
        return msgspec.structs.replace(
            report,
            findings=told,
            not_evaluated=not_evaluated,
            silenced=in_order([*report.silenced, *silent]),
            verdict=verdict(told, not_evaluated, fail_on),
        )

    def updated(self, found: Iterable[tuple[FileReport, Collection[str]]], reason: str) -> Updated:
        """
        The entries for what is found now. What could not be evaluated stays, and what is known of files of other runs.

        found: the reports, each with the rules that were asked and could be evaluated. reason: of what is new.
        """
        entries: list[Entry] = []
        done: set[str] = set()
        new = 0
        for report, asked in found:
            file = self.path_of[report.path]
            known = {entry.key: entry for entry in _added_up(self.known(report))}
            reasons = {key: entry.reason for key, entry in known.items()}
            now = _entries_of(report.findings, file, reasons, reason)
            new += (_counted(now) - _counted(known.values())).total()
            counts = _counted(now)
            stays = [entry for key, entry in known.items() if not counts[key] and entry.rule not in asked]
            entries += [*now, *(msgspec.structs.replace(entry, file=file) for entry in stays)]
            done.add(os.path.normcase(file))
        done |= {*self._dropped()} | self._taken
        entries += [entry for file, own in self.of_file.items() if file not in done for entry in own]
        return Updated(_added_up(entries), new)

    def pruned(self) -> list[Entry]:
        """The entries without what no longer occurs."""
        left = {(one.entry.file, one.entry.key): one.missing for one in self.leftovers()}
        kept = []
        for entry in _added_up(entry for own in self.of_file.values() for entry in own):
            count = entry.count - left.get((entry.file, entry.key), 0)
            if count:
                kept.append(msgspec.structs.replace(entry, count=count))
        return kept

    @staticmethod
    def total(entries: Iterable[Entry]) -> int:
        """How many findings the entries stand for."""
        return sum(entry.count for entry in entries)

    def leftovers(self) -> Iterator[Leftover]:
        """What no longer occurs, of the files that were checked and of those that are gone and were not moved."""
        for path, matched in self._matched.items():
            file = path if path in self.of_file else self.moved.get(path, "")
            for entry in _added_up(self.of_file.get(file, ())):
                missing = entry.count - matched[entry.key]
                if missing > 0 and entry.rule in self._asked[path]:
                    yield Leftover(entry, missing, is_gone=False)
        for file in self._dropped():
            yield from (Leftover(entry, entry.count, is_gone=True) for entry in _added_up(self.of_file[file]))


def _entries_of(findings: Iterable[Finding], file: str, reasons: Mapping[Key, str], reason: str) -> list[Entry]:
    """The entries for the findings of a file. reasons: by key, of those that are known. reason: of the others."""
    found = [
        Entry(
            file=file,
            rule=finding.rule,
            fingerprint=finding.fingerprint,
            severity=finding.severity,
            block=shortened(_shown_block(finding.block), _BLOCK),
            follows=sorted(_rules(finding)),
            reason=reasons.get(_key(finding), reason),
        )
        for finding in findings
    ]
    return _added_up(found)


def _added_up(entries: Iterable[Entry]) -> list[Entry]:
    """One entry for each file, rule and fingerprint: the sum, the worst severity, all that follows."""
    found: dict[tuple[str, Key], Entry] = {}
    for entry in entries:
        key = entry.file, entry.key
        first = found.get(key)
        found[key] = (
            entry
            if first is None
            else msgspec.structs.replace(
                first,
                count=first.count + entry.count,
                severity=max(first.severity, entry.severity, key=SEVERITIES.__getitem__),
                follows=sorted({*first.follows, *entry.follows}),
                reason=first.reason or entry.reason,
            )
        )
    return list(found.values())


def _counted(entries: Iterable[Entry]) -> Counter[Key]:
    found: Counter[Key] = Counter()
    for entry in entries:
        found[entry.key] += entry.count
    return found


def _shown_block(block: str) -> str:
    """As it is written, without its number, which may change."""
    return re.sub(r"^(/?)N\d+\s*", r"\1", " ".join(block.upper().split()))


def _key(finding: Finding) -> Key:
    return finding.rule, finding.fingerprint


def _rules(finding: Finding) -> set[str]:
    """The rules of what follows from a finding."""
    return {one.rule for one in finding.follows}


def _name(path: str) -> str:
    return path.rpartition("/")[2].rpartition("\\")[2]
