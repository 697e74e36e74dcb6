"""
A baseline: known findings, so that only new ones are reported.

A finding is matched by file, rule, fingerprint and the place of its block in the program. A moved file is recognised by
its blocks, once its old path no longer exists.
"""

from __future__ import annotations

import os
import re
from collections import Counter
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import NamedTuple

import msgspec

from polarcheck.checking.check import verdict
from polarcheck.checking.engine import in_order
from polarcheck.checking.not_evaluated import bound_silenced
from polarcheck.checking.suppression import silenced
from polarcheck.files.baselines.baseline_file import SCHEMA, Contents, Entry, Key, Location, Program, program_of
from polarcheck.files.baselines.known_places import Similar, Versions, key_of, matches, place_of, versions
from polarcheck.foundation.finding import BASELINE, SEVERITIES, FileReport, Finding, NotEvaluated, Outline, Silenced
from polarcheck.program.reading.excerpt import shortened
from polarcheck.program.reading.files import STANDARD_INPUT, display_path
from polarcheck.rules.rule import load_all

#: Characters of the block that an entry shows to its reader.
_BLOCK = 80


class Leftover(NamedTuple):
    """
    An entry whose findings no longer occur.

    missing: how many of its findings.
    matched: the numbers of its places that still have a finding.
    is_gone: the whole file no longer exists.
    """

    entry: Entry
    missing: int
    matched: Collection[int]
    is_gone: bool


class Updated(NamedTuple):
    """
    The baseline after an update.

    contents: with all findings that are known now.
    new: how many of the findings are new.
    """

    contents: Contents
    new: int


class Baseline:
    """
    The known findings of the files of a run.

    contents: what the baseline file says.
    folder: that of the baseline file; paths in entries are relative to it.
    paths: the files of the run.
    walked: files and folders that the run was started with, None for all; entries of files that are missing elsewhere
    stay as they are.

    of_file: the entries by file.
    path_of: the path of a file as entries have it, by its path as reports have it.
    moved: the former path of each file that was moved, empty for one that was not.
    """

    def __init__(
        self, contents: Contents, folder: Path, paths: Iterable[str], walked: Iterable[str] | None = None
    ) -> None:
        self.schema = contents.schema
        self.folder = os.path.realpath(folder)
        self.of_file: dict[str, list[Entry]] = {}
        for entry in _added_up(contents.entries):
            self.of_file.setdefault(os.path.normcase(entry.file), []).append(entry)
        self._programs = {os.path.normcase(program.file): program for program in contents.programs}
        self.path_of = {display_path(path): self._relative(path) for path in paths}
        self.moved: dict[str, str] = {}
        self._matched: dict[str, dict[Key, set[int]]] = {}
        self._evaluated: dict[str, Collection[str]] = {}
        self._gone = self._missing_files()
        self._walked = None if walked is None else [os.path.normcase(os.path.realpath(path)) for path in walked]
        self._origins: set[str] = set()
        self._counts = {file: _counted(self.of_file[file]) for file in self._gone}
        self._gone_files_with: dict[Key, list[str]] = {}
        for file, counts in self._counts.items():
            for key in counts:
                self._gone_files_with.setdefault(key, []).append(file)
        self._similar = Similar(self._programs)
        # A missing file with the name of a new one is reserved for that, whichever new file is checked first.
        self._new_names = {_name(path) for path in self._new_files()}

    def _relative(self, path: str) -> str:
        """The path of a program relative to the folder of the baseline, with slashes; absolute on another drive."""
        if path == STANDARD_INPUT:
            return path
        folder, name = os.path.split(path)
        whole = os.path.join(os.path.realpath(folder or os.curdir), name)  # noqa: PTH118
        try:
            return display_path(os.path.relpath(whole, self.folder))
        except ValueError:
            return display_path(whole)

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
            self.moved[path] = self._origin(path, report)
            self._origins.add(self.moved[path])
        return self.of_file.get(self.moved[path], [])

    def _origin(self, path: str, report: FileReport) -> str:
        """
        Return the former path of a moved file, empty if it was not moved.

        Most of its blocks are those of the former file. In a baseline of the first schema the findings must do: the
        name is the same, or at least half of the known findings are present.
        """
        present = Counter(map(key_of, report.findings))
        common: Counter[str] = Counter()
        for key, count in present.items():
            for file in self._gone_files_with.get(key, ()):
                common[file] += min(count, self._counts[file][key])

        def has_same_name(file: str) -> bool:
            return _name(file) == _name(path)

        likely = [
            file
            for file in common
            if file not in self._origins
            and (
                has_same_name(file)
                or (
                    _name(file) not in self._new_names
                    and (file in self._programs or 2 * common[file] >= self._counts[file].total())
                )
            )
        ]
        shares: dict[str, float] = {}
        if isinstance(report.outline, Outline):
            with_blocks = [file for file in likely if file in self._programs]
            shares = self._similar.among(with_blocks, report.outline, has_same_name)
            likely = [file for file in likely if file in shares or file not in self._programs]
        return min(
            likely,
            key=lambda file: (not has_same_name(file), -shares.get(file, 0.0), -common[file], file),
            default="",
        )

    def _known(self, report: FileReport) -> tuple[list[Entry], Versions | None]:
        """Return the entries for a file, and the blocks of its program in the baseline and now."""
        entries = self.entries_for(report)
        program = self._programs.get(os.path.normcase(entries[0].file)) if entries else None
        return entries, versions(program, report.outline)

    def without_known(self, report: FileReport, evaluated: Collection[str]) -> FileReport:
        """
        Return the report with the known findings suppressed, and the verdict of the others.

        The findings that follow from a known one go with it. A finding that is worse than it was, or from which another
        rule follows, is reported, and its message says what is worse.

        evaluated: the rules that were selected and could be evaluated.
        """
        entries, both = self._known(report)
        path = os.path.normcase(self.path_of[report.path])
        matched = self._matched.setdefault(path, {})
        self._evaluated[path] = evaluated
        reported: list[Finding] = []
        suppressed: list[Silenced] = []
        bounds: list[NotEvaluated | None] = []
        for finding, match in zip(report.findings, matches(entries, both, report), strict=True):
            if match is None:
                reported.append(finding)
                continue
            matched.setdefault(match.entry.key, set()).add(match.number)
            if match.growth:
                message = f"{finding.message}; worse than in the baseline: {', '.join(match.growth)}"
                reported.append(msgspec.structs.replace(finding, message=message))
            else:
                suppressed.append(silenced(finding, BASELINE, match.entry.reason))
                bounds.append(bound_silenced(finding))
        report = msgspec.structs.replace(report, outline=msgspec.UNSET)
        if not matched:
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
        Return the baseline with the present findings.

        Entries of rules that could not be evaluated stay, and so do those of files outside of this run.

        reports: each with the rules that were selected and could be evaluated.
        reason: that of new entries.
        """
        entries: list[Entry] = []
        programs: dict[str, Program] = {}
        updated: set[str] = set()
        new = 0
        for report, evaluated in reports:
            file = self.path_of[report.path]
            of_file, both = self._known(report)
            entries_by_key = {entry.key: entry for entry in of_file}
            reasons = {key: entry.reason for key, entry in entries_by_key.items()}
            now = _entries_of(report, file, reasons, reason)
            counts = _counted(now)
            new += (counts - _counted(of_file)).total()
            unevaluated = [entry for entry in of_file if not counts[entry.key] and self._may_be_there(entry, evaluated)]
            entries += [*now, *(_brought_up(entry, file, both) for entry in unevaluated)]
            if isinstance(report.outline, Outline):
                programs[file] = program_of(file, report.outline.hashes, report.outline.of)
            elif unevaluated and (program := self._programs.get(os.path.normcase(unevaluated[0].file))):
                programs[file] = msgspec.structs.replace(program, file=file)
            updated.add(os.path.normcase(file))
        updated |= {*self._deleted_files()} | self._origins
        entries += [entry for file, of_file in self.of_file.items() if file not in updated for entry in of_file]
        remaining = [program for file, program in self._programs.items() if file not in updated]
        return Updated(_contents(_added_up(entries), [*programs.values(), *remaining]), new)

    @staticmethod
    def _may_be_there(entry: Entry, evaluated: Collection[str]) -> bool:
        """Return True for an entry without a finding that may have one: its rule was not evaluated."""
        return entry.rule not in evaluated and entry.rule in load_all()

    def pruned(self) -> Contents:
        """Return the baseline without the findings that no longer occur."""
        leftovers = {(leftover.entry.file, leftover.entry.key): leftover for leftover in self.leftovers()}
        remaining = []
        for entry in (entry for of_file in self.of_file.values() for entry in of_file):
            leftover = leftovers.get((entry.file, entry.key))
            if leftover is None:
                remaining.append(entry)
            elif leftover.missing < entry.count:
                places = [location for index, location in enumerate(entry.places) if index in leftover.matched]
                remaining.append(msgspec.structs.replace(entry, count=entry.count - leftover.missing, places=places))
        return _contents(remaining, self._programs.values(), self.schema)

    @staticmethod
    def total(entries: Iterable[Entry]) -> int:
        """The number of findings in the entries."""
        return sum(entry.count for entry in entries)

    def leftovers(self) -> Iterator[Leftover]:
        """Yield the entries whose findings no longer occur, in checked files and in files that were deleted."""
        for path, matched in self._matched.items():
            file = path if path in self.of_file else self.moved.get(path, "")
            for entry in self.of_file.get(file, ()):
                there = matched.get(entry.key, set())
                if len(there) < entry.count and not self._may_be_there(entry, self._evaluated[path]):
                    yield Leftover(entry, entry.count - len(there), there, is_gone=False)
        for file in self._deleted_files():
            yield from (Leftover(entry, entry.count, (), is_gone=True) for entry in self.of_file[file])


def _contents(entries: Sequence[Entry], programs: Iterable[Program], schema: int = SCHEMA) -> Contents:
    """Return the contents of a baseline, with the programs that have entries."""
    files = {os.path.normcase(entry.file) for entry in entries}
    return Contents(entries, [program for program in programs if os.path.normcase(program.file) in files], (), schema)


def _brought_up(entry: Entry, file: str, both: Versions | None) -> Entry:
    """Return an entry of a file with its places in the present version of the program."""
    places = entry.places
    if both is not None:
        places = [
            msgspec.structs.replace(
                location,
                at=None if location.at is None else both.now(location.at),
                also=[now for at in location.also if (now := both.now(at)) is not None],
                section=None if location.section is None else both.now(location.section),
            )
            for location in places
        ]
    return msgspec.structs.replace(entry, file=file, places=places)


def _entries_of(report: FileReport, file: str, reasons: Mapping[Key, str], reason: str) -> list[Entry]:
    """
    Return the entries for the findings of a file.

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
            follows=sorted({follower.rule for follower in finding.follows}),
            reason=reasons.get(key_of(finding), reason),
            places=[place_of(finding, report.outline)],
        )
        for finding in report.findings
    ]
    return _added_up(entries)


def _added_up(entries: Iterable[Entry]) -> list[Entry]:
    """Merge entries of the same file, rule and fingerprint: counts added, worst severity, all rules that follow."""
    merged: dict[tuple[str, Key], Entry] = {}
    more: dict[tuple[str, Key], list[Entry]] = {}
    for entry in entries:
        key = entry.file, entry.key
        if merged.setdefault(key, entry) is not entry:
            more.setdefault(key, [merged[key]]).append(entry)
    return list({**merged, **{key: _merged(same) for key, same in more.items()}}.values())


def _merged(same: Sequence[Entry]) -> Entry:
    places: list[Location] = []
    if any(entry.places for entry in same):
        places = [location for entry in same for location in entry.places or [Location()] * entry.count]
    return msgspec.structs.replace(
        same[0],
        count=sum(entry.count for entry in same),
        severity=max((entry.severity for entry in same), key=SEVERITIES.__getitem__),
        follows=sorted({rule for entry in same for rule in entry.follows}),
        reason=next((entry.reason for entry in same if entry.reason), ""),
        places=places,
    )


def _counted(entries: Iterable[Entry]) -> Counter[Key]:
    counts: Counter[Key] = Counter()
    for entry in entries:
        counts[entry.key] += entry.count
    return counts


def _shown_block(block: str) -> str:
    """The block as written, without its sequence number, which may change."""
    return re.sub(r"^(/?)N\d+\s*", r"\1", " ".join(block.upper().split()))


def _name(path: str) -> str:
    return path.rpartition("/")[2].rpartition("\\")[2]
