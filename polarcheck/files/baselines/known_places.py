"""Finds the known findings of a file again, wherever they stand now, but no others in their place."""

from __future__ import annotations

from bisect import bisect_right
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from itertools import islice
from typing import NamedTuple

from msgspec import UnsetType

from polarcheck.files.baselines.baseline_file import Entry, Key, Location, Program
from polarcheck.files.baselines.block_alignment import aligned
from polarcheck.files.baselines.growth import blocks_of, growth, values_of
from polarcheck.foundation.finding import FileReport, Finding, Outline
from polarcheck.rules.rule import load_all

#: A file is still the program that it was if this share of its blocks is left, or this share of the blocks of now was
#: in it. Under another name, the longer version must have the second share in common.
SAME, SAME_AS_PART = 0.5, 0.75
#: Files are compared by so many of their smallest hashes first.
_SMALLEST = 64
#: The most files that are compared block by block with a new one.
_COMPARED = 8


class Similar:
    """Compares files by their smallest hashes, which costs little, and then by their blocks."""

    def __init__(self, programs: Mapping[str, Program]) -> None:
        self._programs = programs
        self._smallest: dict[str, frozenset[int]] = {}

    def among(self, files: Iterable[str], outline: Outline, has_same_name: Callable[[str], bool]) -> dict[str, float]:
        """Return the files whose blocks are mostly those of an outline, with the share of them."""
        smallest = _smallest(outline.hashes)
        ranked = sorted(files, key=lambda file: (-len(smallest & self._of(file)), not has_same_name(file), file))
        shares = {}
        for file in ranked[:_COMPARED]:
            share = Versions(self._programs[file], outline).share
            if share >= (SAME if has_same_name(file) else SAME_AS_PART):
                shares[file] = share
        return shares

    def _of(self, file: str) -> frozenset[int]:
        if file not in self._smallest:
            self._smallest[file] = _smallest(self._programs[file].hashes)
        return self._smallest[file]


def _smallest(hashes: Iterable[int]) -> frozenset[int]:
    return frozenset(sorted(set(hashes))[:_SMALLEST])


#: A finding that has moved within its file has most of these blocks before it and after it.
_AROUND = 4
#: The most places of an entry that are tried for a finding, and the most pairs of both where these may have moved.
_TRIED, _MOST_PAIRS = 8, 20_000
#: The span of rules with one finding for all blocks of a polar section.
_SECTION = "section"


#: Returns for findings, by number, the places of an entry that they can be.
_Way = Callable[[Mapping[int, Location], Mapping[int, Finding]], Mapping[int, Sequence[int]]]


class Match(NamedTuple):
    """
    A known finding that has been found again.

    entry: the entry.
    number: the index of its place in the entry.
    growth: what is worse now, in words.
    """

    entry: Entry
    number: int
    growth: list[str]


class Versions:
    """
    The blocks of a program in the baseline and now.

    is_same: most blocks of one of the two are in the other, in any order.
    share: of the blocks of the longer version, those that are in the other one.
    """

    def __init__(self, program: Program, outline: Outline) -> None:
        of = max(program.of, outline.of)
        self._kept, self._old = _thinned(program.hashes, of)
        self._new_kept, self._new = _thinned(outline.hashes, of)
        self._is_whole = of == 1
        pairs = aligned(self._old, self._new)
        self._counts = Counter(self._old)
        common = (self._counts & Counter(self._new)).total()
        self.is_same = common >= SAME * len(self._old) or common >= SAME_AS_PART * len(self._new)
        self.share = common / max(len(self._old), len(self._new), 1)
        self._pairs = {**pairs, -1: -1, len(self._old): len(self._new)}
        self._old_of = {new: old for old, new in pairs.items()}
        self._outline = outline

    def now(self, index: int) -> int | None:
        """Return the index in the outline of a block of the program; None if it is not there any more."""
        old = self._in_old(index)
        if old not in self._pairs:
            return None
        new = self._pairs[old]
        return self._new_kept[new] if 0 <= new < len(self._new) else new

    def targets(self, index: int) -> set[int]:
        """
        Return where a block of the program can be now, as `target` has it.

        Of a long program blocks between two that are listed are the same if one of these two is.
        """
        old = self._in_old(index)
        places = {self._pairs[old]} if old in self._pairs else set()
        if not self._is_whole and old + 1 in self._pairs:
            places.add(self._pairs[old + 1] - 1)
        return places

    def target(self, line: int) -> int | None:
        """Return the index of the block in a line; None if no block stands there."""
        index = self._outline.place_of_line.get(line)
        return None if index is None else bisect_right(self._new_kept, index) - 1

    def stays(self, index: int, line: int) -> bool:
        """Return True if a block and most of those around it are aligned with a line and the blocks around that."""
        old, new = self._in_old(index), self.target(line)
        return (
            new is not None
            and self._pairs.get(old) == new
            and self._most(old, lambda step: self._is_at(step, new - old))
        )

    def has_moved(self, index: int, line: int) -> bool:
        """
        Return True if a block has gone from its place with most of those around it, and these are new around the line.

        Where the blocks around it are still at the former place, it is another block with the same surroundings. The
        ends of sections are often the same: there an alignment counts only if the blocks around agree with it.
        """
        old, new = self._in_old(index), self.target(line)
        if new is None or not self._most(old, lambda step: self._have_moved(step, step + new - old)):
            return False
        former = self._old_of.get(new)
        return not any(
            self._most(block, lambda step, by=partner - block: self._is_at(step, by))  # type: ignore[misc]
            for block, partner in ((old, self._pairs.get(old)), (former, new))
            if block is not None and partner is not None
        )

    def _most(self, old: int, holds: Callable[[int], bool]) -> bool:
        """Return True if something holds for most blocks around one; those that the program has once say more."""
        around = [
            index for index in range(old - _AROUND, old + _AROUND + 1) if index != old and 0 <= index < len(self._old)
        ]
        single = [index for index in around if self._counts[self._old[index]] == 1]
        around = single if len(single) > 1 else around
        return 2 * sum(map(holds, around)) > len(around)

    def _is_at(self, old: int, by: int) -> bool:
        return self._pairs.get(old) == old + by

    def _have_moved(self, old: int, new: int) -> bool:
        is_same = 0 <= new < len(self._new) and self._old[old] == self._new[new]
        return is_same and self._pairs.get(old, new) == new and self._old_of.get(new, old) == old

    def _in_old(self, index: int) -> int:
        return bisect_right(self._kept, index) - 1


def _thinned(hashes: Sequence[int], of: int) -> tuple[list[int], list[int]]:
    """Return the indices of the hashes that are a multiple of a number, and these hashes."""
    chosen = [index for index, value in enumerate(hashes) if value % of == 0]
    return chosen, [hashes[index] for index in chosen]


def versions(program: Program | None, outline: Outline | UnsetType) -> Versions | None:
    """Return the two versions of a program; None if one of them is not known."""
    return Versions(program, outline) if program is not None and isinstance(outline, Outline) else None


def matches(entries: Iterable[Entry], both: Versions | None, report: FileReport) -> list[Match | None]:
    """
    Return for each finding of a report the known one that it is, None for new ones.

    Without two versions of the program findings are counted only, as those of a baseline of the first schema.
    """
    by_key = {entry.key: entry for entry in entries}
    numbers: dict[Key, list[int]] = {}
    for number, finding in enumerate(report.findings):
        if key_of(finding) in by_key:
            numbers.setdefault(key_of(finding), []).append(number)
    of_findings: list[Match | None] = [None] * len(report.findings)
    if both is not None and not both.is_same:
        return of_findings
    for key, of_key in numbers.items():
        findings = {number: report.findings[number] for number in of_key}
        for number, match in _of_entry(by_key[key], both, findings, report.outline):
            of_findings[number] = match
    return of_findings


def _of_entry(
    entry: Entry, both: Versions | None, findings: Mapping[int, Finding], outline: Outline | UnsetType
) -> Iterator[tuple[int, Match]]:
    """Yield the numbers of findings with the places of an entry: the same block first, then others that it can be."""
    places = dict(enumerate(entry.places or [Location()] * entry.count))
    unmatched = dict(findings)
    for pairing in _pairings(entry, both):
        fitting = pairing(places, unmatched)
        for number, finding in findings.items():
            ats = [*islice((index for index in fitting.get(number, ()) if index in places), _TRIED)]
            if number in unmatched and ats:
                grown = {
                    index: [
                        *growth(entry, places[index], finding, outline),
                        *_elsewhere(places[index], both, finding, outline),
                    ]
                    for index in ats
                }
                index = min(ats, key=lambda index: bool(grown[index]))
                yield number, Match(entry, index, grown[index])
                del places[index], unmatched[number]


def _pairings(entry: Entry, both: Versions | None) -> Iterator[_Way]:
    """Yield the ways in which findings can be those of an entry, the surest first."""
    if both is None or not entry.places:
        yield lambda places, findings: dict.fromkeys(findings, tuple(places))
        return
    yield lambda places, findings: {
        number: [
            index
            for index in fitting
            if not places[index].all_at or any(both.stays(at, findings[number].line) for at in places[index].all_at)
        ]
        for number, fitting in _aligned(both, places, findings).items()
    }
    rule = load_all().get(entry.rule)
    if rule is not None and rule.once == _SECTION:
        # Where the first block with the fault has been mended, another one of the section stands for it.
        yield lambda places, findings: _by_index(
            {
                index: both.targets(location.section)
                for index, location in places.items()
                if location.section is not None
            },
            {number: both.target(finding.section_line or 0) for number, finding in findings.items()},
        )
    yield lambda places, findings: _moved(both, places, findings)
    yield lambda places, findings: _aligned(both, places, findings)


def _aligned(both: Versions, places: Mapping[int, Location], findings: Mapping[int, Finding]) -> dict[int, list[int]]:
    return _by_index(
        {index: _targets(both, location) or {None} for index, location in places.items()},
        {number: both.target(finding.line) for number, finding in findings.items()},
    )


def _targets(both: Versions, location: Location) -> set[int | None]:
    return {target for at in location.all_at for target in both.targets(at)}


def _elsewhere(
    location: Location, both: Versions | None, finding: Finding, outline: Outline | UnsetType
) -> Iterator[str]:
    """Say in which line a finding that its program has once is new."""
    if both is None or not location.also or not isinstance(outline, Outline):
        return
    targets = _targets(both, location)
    for line in outline.lines.get(Outline.key(finding), ()):
        if both.target(line) not in targets and not any(both.has_moved(at, line) for at in location.also):
            yield f"now in line {line}, too"
            return


def _by_index(places: Mapping[int, Iterable[int | None]], findings: Mapping[int, int | None]) -> dict[int, list[int]]:
    """Return for each finding the places with the same index."""
    of_index: dict[int | None, list[int]] = {}
    for place_number, indices in places.items():
        for index in indices:
            of_index.setdefault(index, []).append(place_number)
    return {number: of_index[index] for number, index in findings.items() if index in of_index}


def _moved(both: Versions, places: Mapping[int, Location], findings: Mapping[int, Finding]) -> dict[int, list[int]]:
    if len(places) * len(findings) > _MOST_PAIRS:
        return {}
    return {
        number: [
            index
            for index, location in places.items()
            if any(both.has_moved(at, finding.line) for at in location.all_at)
        ]
        for number, finding in findings.items()
    }


def place_of(finding: Finding, outline: Outline | UnsetType) -> Location:
    """Return the place of a finding, as an entry has it."""
    lines = outline.place_of_line if isinstance(outline, Outline) else {}
    rule = load_all().get(finding.rule)
    of_finding = outline.lines.get(Outline.key(finding), ()) if isinstance(outline, Outline) else ()
    also = [lines[line] for line in of_finding if line in lines]
    in_section = rule is not None and rule.once == _SECTION and finding.section_line is not None
    return Location(
        at=lines.get(finding.line),
        also=also if len(also) > 1 else [],
        section=lines.get(finding.section_line or 0) if in_section else None,
        blocks=blocks_of(finding),
        values=values_of(finding, outline),
    )


def key_of(finding: Finding) -> Key:
    """Return by what a finding is matched."""
    return finding.rule, finding.fingerprint
