"""
A baseline: known findings, so that only new ones are reported.

A finding is matched by file, rule and fingerprint; equal ones are counted. A moved file is recognised by its findings,
once its old path no longer exists.
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

#: Characters of the block that an entry shows to its reader.
_BLOCK = 80


class Leftover(NamedTuple):
    """
    An entry whose findings no longer occur.

    missing: how many of its findings.
    is_gone: the whole file no longer exists.
    """

    entry: Entry
    missing: int
    is_gone: bool


class Updated(NamedTuple):
    """
    The baseline after an update.

    entries: of all findings that are known now.
    new: how many of the findings are new.
    """

    entries: list[Entry]
    new: int


class Baseline:
    """
    The known findings of the files of a run.

    entries: of the baseline file.
    folder: that of the baseline file; paths in entries are relative to it.
    paths: the files of the run.
    walked: files and folders that the run was started with, None for all; entries of files that are missing elsewhere
    stay as they are.

    of_file: the entries by file.
    path_of: the path of a file as entries have it, by its path as reports have it.
    moved: the former path of each file that was moved, empty for one that was not.
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
        self._evaluated: dict[str, Collection[str]] = {}
        self._gone = self._missing_files()
        self._walked = None if walked is None else [os.path.normcase(os.path.realpath(path)) for path in walked]
        self._origins: set[str] = set()
        self._counts = {file: _counted(self.of_file[file]) for file in self._gone}
        self._gone_files_with: dict[Key, list[str]] = {}
        for file, counts in self._counts.items():
            for key in counts:
                self._gone_files_with.setdefault(key, []).append(file)
        # A missing file with the name of a new one is reserved for that, whichever new file is checked first.
        self._new_names = {_name(path) for path in self._new_files()}

    def _relative(self, path: str) -> str:
        """The path of a program relative to the folder of the baseline, with slashes; absolute on another drive."""
        if path == STANDARD_INPUT:
            return path
        folder, name = os.path.split(path)
        whole = os.path.join(os.path.realpath(folder or os.curdir), name)  # noqa: PTH118
        try:
            return shown(os.path.relpath(whole, self.folder))
        except ValueError:
            return shown(whole)

    def _missing_files(self) -> list[str]:
        """The files of entries that no longer exist."""
        checked = {os.path.normcase(path) for path in self.path_of.values()}
        return [
            file
            for file in self.of_file
            if file not in checked and file != STANDARD_INPUT and not os.path.lexists(os.path.join(self.folder, file))  # noqa: PTH118
        ]

    def _deleted_files(self) -> Iterator[str]:
        """The missing files that the run would have checked, and that were not moved to another of its files."""
        for file in self._gone:
            whole = os.path.normcase(os.path.normpath(os.path.join(self.folder, file)))  # noqa: PTH118
            was_in_run = self._walked is None or any(
                whole == path or whole.startswith(os.path.join(path, ""))  # noqa: PTH118
                for path in self._walked
            )
            if was_in_run and file not in self._origins:
                yield file

    def _new_files(self) -> Iterator[str]:
        """The files of this run that have no entry."""
        return (path for path in self.path_of.values() if os.path.normcase(path) not in self.of_file)

    def entries_for(self, report: FileReport) -> list[Entry]:
        """The entries of a file, or of the file that it was before it was moved."""
        path = os.path.normcase(self.path_of[report.path])
        if path in self.of_file:
            return self.of_file[path]
        if path not in self.moved:
            self.moved[path] = self._origin(path, Counter(map(_key, report.findings)))
            self._origins.add(self.moved[path])
        return self.of_file.get(self.moved[path], [])

    def _origin(self, path: str, present: Counter[Key]) -> str:
        """
        The former path of a moved file, empty if it was not moved.

        present: the findings of the file, counted.

        The former file has the same name and a finding in common, or at least half of its known findings are present:
        one common block does not make a new program a moved one.
        """
        common: Counter[str] = Counter()
        for key, count in present.items():
            for file in self._gone_files_with.get(key, ()):
                common[file] += min(count, self._counts[file][key])
        likely = [
            file
            for file in common
            if file not in self._origins
            and (
                _name(file) == _name(path)
                or (_name(file) not in self._new_names and 2 * common[file] >= self._counts[file].total())
            )
        ]
        return min(likely, key=lambda file: (_name(file) != _name(path), -common[file], file), default="")

    def without_known(self, report: FileReport, evaluated: Collection[str]) -> FileReport:
        """
        The report with the known findings suppressed, and the verdict of the others.

        The findings that follow from a known one go with it. A finding that is more severe than it was, or from which
        another rule follows, is not the known one and is reported.

        evaluated: the rules that were selected and could be evaluated.
        """
        known = {entry.key: entry for entry in _added_up(self.entries_for(report))}
        unmatched = _counted(known.values())
        reported: list[Finding] = []
        suppressed: list[Silenced] = []
        bounds: list[NotEvaluated | None] = []
        for finding in report.findings:
            key = _key(finding)
            if not unmatched[key]:
                reported.append(finding)
                continue
            unmatched[key] -= 1
            entry = known[key]
            if SEVERITIES[finding.severity] > SEVERITIES[entry.severity] or not _rules(finding) <= {*entry.follows}:
                reported.append(finding)
            else:
                suppressed.append(silenced(finding, BASELINE, entry.reason))
                bounds.append(bound_silenced(finding))
        path = os.path.normcase(self.path_of[report.path])
        matched = _counted(known.values()) - unmatched
        self._matched[path] = matched | self._matched.get(path, Counter())
        self._evaluated[path] = evaluated
        if not suppressed:
            return report
        not_evaluated = [*report.not_evaluated, *filter(None, bounds)]
        return msgspec.structs.replace(
            report,
            findings=reported,
            not_evaluated=not_evaluated,
            silenced=in_order([*report.silenced, *suppressed]),
            verdict=verdict(reported, not_evaluated),
        )

    def updated(self, reports: Iterable[tuple[FileReport, Collection[str]]], reason: str) -> Updated:
        """
        The entries for the present findings.

        Entries of rules that could not be evaluated stay, and so do those of files outside of this run.

        reports: each with the rules that were selected and could be evaluated.
        reason: that of new entries.
        """
        entries: list[Entry] = []
        updated: set[str] = set()
        new = 0
        for report, evaluated in reports:
            file = self.path_of[report.path]
            known = {entry.key: entry for entry in _added_up(self.entries_for(report))}
            reasons = {key: entry.reason for key, entry in known.items()}
            now = _entries_of(report.findings, file, reasons, reason)
            new += (_counted(now) - _counted(known.values())).total()
            counts = _counted(now)
            unevaluated = [entry for key, entry in known.items() if not counts[key] and entry.rule not in evaluated]
            entries += [*now, *(msgspec.structs.replace(entry, file=file) for entry in unevaluated)]
            updated.add(os.path.normcase(file))
        updated |= {*self._deleted_files()} | self._origins
        entries += [entry for file, of_file in self.of_file.items() if file not in updated for entry in of_file]
        return Updated(_added_up(entries), new)

    def pruned(self) -> list[Entry]:
        """The entries without the findings that no longer occur."""
        missing = {(leftover.entry.file, leftover.entry.key): leftover.missing for leftover in self.leftovers()}
        remaining = []
        for entry in _added_up(entry for of_file in self.of_file.values() for entry in of_file):
            count = entry.count - missing.get((entry.file, entry.key), 0)
            if count:
                remaining.append(msgspec.structs.replace(entry, count=count))
        return remaining

    @staticmethod
    def total(entries: Iterable[Entry]) -> int:
        """The number of findings in the entries."""
        return sum(entry.count for entry in entries)

    def leftovers(self) -> Iterator[Leftover]:
        """The entries whose findings no longer occur, in checked files and in files that were deleted."""
        for path, matched in self._matched.items():
            file = path if path in self.of_file else self.moved.get(path, "")
            for entry in _added_up(self.of_file.get(file, ())):
                missing = entry.count - matched[entry.key]
                if missing > 0 and entry.rule in self._evaluated[path]:
                    yield Leftover(entry, missing, is_gone=False)
        for file in self._deleted_files():
            yield from (Leftover(entry, entry.count, is_gone=True) for entry in _added_up(self.of_file[file]))


def _entries_of(findings: Iterable[Finding], file: str, reasons: Mapping[Key, str], reason: str) -> list[Entry]:
    """
    The entries for the findings of a file.

    reasons: those of known findings, by key.
    reason: that of all others.
    """
    entries = [
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
    return _added_up(entries)


def _added_up(entries: Iterable[Entry]) -> list[Entry]:
    """Merge entries of the same file, rule and fingerprint: counts added, worst severity, all rules that follow."""
    merged: dict[tuple[str, Key], Entry] = {}
    for entry in entries:
        key = entry.file, entry.key
        first = merged.get(key)
        merged[key] = (
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
    return list(merged.values())


def _counted(entries: Iterable[Entry]) -> Counter[Key]:
    counts: Counter[Key] = Counter()
    for entry in entries:
        counts[entry.key] += entry.count
    return counts


def _shown_block(block: str) -> str:
    """The block as written, without its sequence number, which may change."""
    return re.sub(r"^(/?)N\d+\s*", r"\1", " ".join(block.upper().split()))


def _key(finding: Finding) -> Key:
    return finding.rule, finding.fingerprint


def _rules(finding: Finding) -> set[str]:
    """The rules of the findings that follow from this one."""
    return {follower.rule for follower in finding.follows}


def _name(path: str) -> str:
    return path.rpartition("/")[2].rpartition("\\")[2]
