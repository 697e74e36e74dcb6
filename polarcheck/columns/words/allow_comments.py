"""
The allow comments of a file: the rules that each one names, the blocks in which it suppresses them, its fault if any.

    (POLARCHECK ALLOW RAPID-IN-POLAR REASON)       in a block, or alone before it
    (POLARCHECK ALLOW-FILE HIGH-FEED REASON)       at the head of the file
    (POLARCHECK ALLOW-ON A-RULE, OTHER REASON)     from here on, to (POLARCHECK ALLOW-OFF A-RULE, OTHER)
"""

from __future__ import annotations

import bisect
import re
from collections.abc import Collection, Iterator, Mapping, Sequence
from functools import cached_property

import msgspec
import numpy as np
from numpy.typing import NDArray

from polarcheck.columns.words.allow_mention import WORD, Used
from polarcheck.columns.words.allow_syntax import FILE, OFF, ON, Allow, grouped, read_allow
from polarcheck.foundation.arrays import Mask, Rows
from polarcheck.foundation.time_limit import keep_time
from polarcheck.program.execution.run import begins_program
from polarcheck.program.reading.source import LF
from polarcheck.program.reading.words import Text

#: Characters of a comment that are parsed; a longer comment is prose.
_LONGEST = 1000
#: Comments of a file whose misspelled names are compared with the known names.
_GUESSES = 500
#: Most signs and blanks between the start of a comment and its first word.
_SIGNS = 20
#: Addresses that make a block do nothing: sequence number and program number.
_NUMBERS = tuple(b"NO")


#: str[comments], empty where there is no message.
Texts = NDArray[np.object_]


class Place(msgspec.Struct, frozen=True):
    """
    The place of an allow comment.

    start, end: its first character and the one behind its last, in the file.
    block: number of its block.
    is_loose: it stands in no comment, as on the line of a %.
    """

    start: int
    end: int
    block: int
    is_loose: bool


class Grant(msgspec.Struct, frozen=True):
    """
    One name of an allow comment, and where it suppresses its rules.

    allow: number of the comment.
    name: of a rule or a group.
    first, last: blocks, the last one exclusive.
    """

    allow: int
    name: str
    first: int
    last: int


class Region(msgspec.Struct, frozen=True):
    """
    The blocks of the checked file, or of a called file that is appended to it.

    first, last: blocks, the last one exclusive.
    body: the first block that does something.
    heads: the blocks with a program number.
    is_main: the blocks are those of the checked file.
    """

    first: int
    last: int
    body: int
    heads: list[int]
    is_main: bool


class _Ranges:
    """The open ALLOW-ON ranges by name, as indices of the grants that began them."""

    def __init__(self, grants: list[Grant], known: Mapping[str, Collection[str]]) -> None:
        self._grants = grants
        self._known = known
        self._open: dict[str, list[int]] = {}

    def open(self, begin: int) -> None:
        """Open a range for each grant from index `begin` on."""
        for number in range(begin, len(self._grants)):
            self._open.setdefault(self._grants[number].name, []).append(number)

    def close(self, names: Sequence[str], last: int) -> str:
        """
        Close the ranges of some names at a block (exclusive), all ranges if no name is given.

        Returns the message about names without an open range, else an empty text. A rule also closes the range of its
        group, and a group those of its rules: what is no longer allowed must not stay suppressed under another name.
        """
        closed = set()
        for name in list(self._open):
            if not names or any(self._overlap(name, other) for other in names):
                closed.add(name)
                for number in self._open.pop(name):
                    self._grants[number] = msgspec.structs.replace(self._grants[number], last=last)
        if not names:
            return "" if closed else "no range is open here that it could close"
        idle = [name for name in names if not any(self._overlap(name, other) for other in closed)]
        return f"no range of {', '.join(idle).upper()} is open here that it could close" if idle else ""

    def _overlap(self, name: str, other: str) -> bool:
        """True for equal names, and for a group and one of its rules."""
        return name == other or name in self._known[other] or other in self._known[name]

    def close_all(self) -> dict[int, str]:
        """Close all ranges; returns their names by the number of the comment that began them."""
        names: dict[int, dict[str, None]] = {}
        for number in sorted(number for numbers in self._open.values() for number in numbers):
            names.setdefault(self._grants[number].allow, {})[self._grants[number].name.upper()] = None
        self._open.clear()
        return {allow: ", ".join(of_comment) for allow, of_comment in names.items()}


class Allows:
    """
    The allow comments of a file and of the called files appended to it, in order.

    groups: the group of each rule, by name of the rule.

    start, end: int[comments], positions in the file [characters].
    block: int[comments].
    faults: str[comments], what is wrong with a comment.
    unpaired: str[comments], the message about ranges that are never closed, or closed and never opened.
    grants: one for each name of a comment, with the blocks in which it holds.
    """

    def __init__(self, text: Text, groups: Mapping[str, str]) -> None:
        self.text = text
        places = list(_places(text))
        self.start: Rows = np.array([place.start for place in places], np.int64)
        self.end: Rows = np.array([place.end for place in places], np.int64)
        self.block: Rows = np.array([place.block for place in places], np.int64)
        self.faults = _texts(len(places))
        self.unpaired = _texts(len(places))
        self.known = grouped(groups)
        self.parsed: list[Allow] = []
        grants: list[Grant] = []
        ranges = _Ranges(grants, self.known)
        region = None
        for number, place in enumerate(places):
            keep_time()
            comment = text.source.excerpt(place.start, min(place.end, place.start + _LONGEST))
            allow = read_allow(comment, self.known, number < _GUESSES)
            self.parsed.append(allow)
            self.faults[number] = allow.fault
            previous, region = region, self._region(place.block)
            if previous is not None and previous is not region:
                self._close_open_ranges(ranges, previous)
            if allow.kind == OFF:
                is_clear = allow.names or not allow.fault
                self.unpaired[number] = ranges.close(allow.names, place.block + 1) if is_clear else ""
                continue
            first, last = self._reach(number, place, allow, region)
            begin = len(grants)
            grants += [Grant(number, name, first, last) for name in allow.names]
            if allow.kind == ON and first < last:
                ranges.open(begin)
        if region is not None:
            self._close_open_ranges(ranges, region)
        self.grants = [grant for grant in grants if grant.first < grant.last]

    def __len__(self) -> int:
        return len(self.start)

    @cached_property
    def is_in_main_file(self) -> Mask:
        """bool[comments]: it stands in the checked file, not in a called one."""
        return np.array([self._region(int(block)).is_main for block in self.block], bool)

    @cached_property
    def silences(self) -> Mask:
        """bool[comments]: it names rules to suppress."""
        return np.array([bool(allow.names) and allow.kind != OFF for allow in self.parsed], bool)

    @cached_property
    def has_reason(self) -> Mask:
        """bool[comments]: it gives a reason."""
        return np.array([bool(allow.reason) for allow in self.parsed], bool)

    # ---- what is suppressed ----

    @cached_property
    def _grants_of_rule(self) -> dict[str, list[Grant]]:
        return {}

    def _grants_for(self, rule: str) -> list[Grant]:
        """The grants for a rule by its name or its group, in order of their first block."""
        if rule not in self._grants_of_rule:
            grants = [grant for grant in self.grants if rule in self.known[grant.name]]
            self._grants_of_rule[rule] = sorted(grants, key=lambda grant: grant.first)
        return self._grants_of_rule[rule]

    def names(self, rule: str) -> bool:
        """True if any comment allows the rule anywhere."""
        return bool(self._grants_for(rule))

    def silenced(self, rule: str, blocks: Rows) -> Mask:
        """bool[len(blocks)]: the rule is suppressed in the block."""
        steps = np.zeros(len(self.text.blocks) + 1, np.int64)
        for grant in self._grants_for(rule):
            steps[grant.first] += 1
            steps[grant.last] -= 1
        return np.asarray(np.cumsum(steps)[blocks] > 0)

    def used(self, rule: str, blocks: Rows) -> set[Used]:
        """The names that suppress a rule in any of these blocks, each with the position of its comment."""
        at = np.unique(blocks)
        return {
            (int(self.start[grant.allow]), grant.name)
            for grant in self._grants_for(rule)
            if np.searchsorted(at, grant.first) < np.searchsorted(at, grant.last)
        }

    def reason(self, rule: str, block: int) -> str:
        """The reason for which a rule is suppressed in a block: that of the nearest comment before the block."""
        grants = self._grants_for(rule)
        at = bisect.bisect_right(grants, block, key=lambda grant: grant.first)
        grant = next((grant for grant in reversed(grants[:at]) if block < grant.last), None)
        return self.parsed[grant.allow].reason if grant else ""

    def unused(self, used: Collection[Used], could: Collection[str]) -> UnusedAllows:
        """
        The names that have suppressed nothing, of comments in the checked file without a fault.

        used: the names that have suppressed a finding.
        could: the rules that were evaluated; a name counts only if all of its rules were.
        """
        names = _texts(len(self))
        for number, allow in enumerate(self.parsed):
            if self.is_in_main_file[number] and allow.kind != OFF and not self.faults[number]:
                idle = [name for name in allow.names if (int(self.start[number]), name) not in used]
                names[number] = ", ".join(
                    name.upper() for name in idle if all(map(could.__contains__, self.known[name]))
                )
        return UnusedAllows(names)

    # ---- the blocks that an allow comment is for ----

    def _reach(self, number: int, place: Place, allow: Allow, region: Region) -> tuple[int, int]:
        """The blocks that an allow comment is for (last exclusive); without any, its fault says why."""
        none = region.first, region.first
        if allow.kind == FILE:
            if place.block < region.body:
                return region.first, region.last
            head = bisect.bisect_right(region.heads, place.block)
            if head and not self.does_something[region.heads[head - 1] : place.block + 1].any():
                later = region.heads[head : head + 1] or [region.last]
                return region.heads[head - 1], later[0]
            self._faulty(number, "ALLOW-FILE stands before the first block of a program; ALLOW-ON begins a range")
            return none
        if place.is_loose:
            self._faulty(number, f"only ALLOW-FILE can stand outside the program, not {allow.kind}")
            return none
        if allow.kind == ON:
            return place.block, region.last
        target = self._target(place.block, region)
        if target is None:
            self._faulty(number, "no block follows that it could be for")
            return none
        return target, target + 1

    def _target(self, block: int, region: Region) -> int | None:
        """The block of a comment, or another one on the same line; else the next block with words."""
        if self.has_words[block]:
            return block
        line, at = self.text.blocks.line, int(np.searchsorted(self._with_text, block))
        after = int(self._with_text[at]) if at < len(self._with_text) else region.last
        if after < region.last and line[after] == line[block]:
            return after
        before = block - 1
        if before >= region.first and line[before] == line[block] and self.has_words[before]:
            return before
        return after if after < region.last else None

    def _faulty(self, number: int, fault: str) -> None:
        self.faults[number] = self.faults[number] or fault

    def _close_open_ranges(self, ranges: _Ranges, region: Region) -> None:
        for number, names in ranges.close_all().items():
            if region.is_main:
                self.unpaired[number] = f"no ALLOW-OFF {names} closes this range: it reaches to the end of the file"

    # ---- the file ----

    @cached_property
    def has_words(self) -> Mask:
        """bool[blocks]: the block holds more than its sequence number and comments."""
        return self._with_words(_NUMBERS[:1])

    @cached_property
    def _with_text(self) -> Rows:
        return np.flatnonzero(self.has_words)

    @cached_property
    def does_something(self) -> Mask:
        """bool[blocks]: the same, program numbers and names not counted."""
        mask = self._with_words(_NUMBERS)
        mask[self.text.names.block] = False
        return mask

    def _with_words(self, besides: tuple[int, ...]) -> Mask:
        text = self.text
        mask = text.blocks.is_macro.copy()
        mask[text.words.block[~np.isin(text.words.address, besides)]] = True
        for spans in (text.names, text.strays, text.prose):
            mask[spans.block] = True
        return mask

    @cached_property
    def _regions(self) -> list[Region]:
        text = self.text
        starts = [int(np.searchsorted(text.blocks.line, part.first_line)) for part in text.source.parts]
        edges = [0, *starts, len(text.blocks)]
        heads = np.unique(text.words.block[begins_program(text.words)])
        regions = []
        for number, first in enumerate(edges[:-1]):
            last = edges[number + 1]
            body = first + int(np.argmax(np.append(self.does_something[first:last], True)))
            inside = heads[(heads >= first) & (heads < last)].tolist()
            regions.append(Region(first, last, body, inside, number == 0))
        return regions

    def _region(self, block: int) -> Region:
        at = bisect.bisect_right(self._regions, block, key=lambda region: region.first)
        return self._regions[at - 1]


class UnusedAllows(msgspec.Struct, frozen=True):
    """
    Names of allow comments that have suppressed nothing.

    names: str[comments], in upper case, separated by commas.
    """

    names: Texts


def _texts(length: int) -> Texts:
    texts: Texts = np.full(length, "", np.object_)
    return texts


def _places(text: Text) -> Iterator[Place]:
    """Comments that begin with the word, and lines with it before the program, which the control does not store."""
    code = text.source.code.tobytes()
    code = code if b"\n" in code else code.replace(b"\r", b"\n")
    ends = np.append(np.flatnonzero(np.frombuffer(code, np.uint8) == LF), len(code))
    comments, outside, blocks = text.comments, text.outside, text.blocks
    seen = -1
    for match in re.finditer(WORD, code, re.IGNORECASE):
        at = match.start()
        number = int(np.searchsorted(comments.start, at, side="right")) - 1
        block = int(np.searchsorted(blocks.start, at, side="right")) - 1
        if number >= 0 and at < comments.end[number]:
            start = int(comments.start[number])
            if number > seen and at - start <= _SIGNS and not re.search(rb"[A-Za-z0-9]", code[start:at]):
                yield Place(start, int(comments.end[number]), int(comments.block[number]), is_loose=False)
            seen = number
            continue
        line_end = int(ends[np.searchsorted(ends, at)])
        beyond = int(np.searchsorted(outside.start, at, side="right")) - 1
        is_outside = beyond >= 0 and at < outside.end[beyond]
        mark = int(np.searchsorted(text.tape_marks, at)) - 1
        is_marked = mark >= 0 and np.searchsorted(ends, text.tape_marks[mark]) == np.searchsorted(ends, at)
        if is_outside or is_marked:
            closed = code.find(b")", at, min(line_end, at + _LONGEST))
            yield Place(at, closed if closed >= 0 else line_end, block, is_loose=True)
