"""
The allow comments of a file: which rules each of them names, in which blocks it silences them, what is wrong with it.

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

from polarcheck.arrays import Mask, Rows
from polarcheck.execution.run import begins_program
from polarcheck.reading.source import LF
from polarcheck.reading.words import Text
from polarcheck.silence.allow_syntax import FILE, OFF, ON, Allow, grouped, read_allow
from polarcheck.silence.suppression import WORD, Used
from polarcheck.time_limit import keep_time

#: Of a comment that is read [characters]; a longer one is prose.
_LONGEST = 1000
#: Comments of a file whose misspelled names are compared with all others.
_GUESSES = 500
#: Between the begin of a comment and its first word stand signs and blanks, not many.
_SIGNS = 20
#: Words beside which a block does nothing: its number, its program number.
_NUMBERS = tuple(b"NO")


#: A text per comment, empty where there is nothing to say.
Texts = NDArray[np.object_]


class Place(msgspec.Struct, frozen=True):
    """Where an allow comment stands: its characters, its block; is_loose: in no comment, as on the line of a %."""

    start: int
    end: int
    block: int
    is_loose: bool


class Grant(msgspec.Struct, frozen=True):
    """One name of an allow comment: its rules are silent in the blocks from first to last (exclusive)."""

    allow: int
    name: str
    first: int
    last: int


class Region(msgspec.Struct, frozen=True):
    """
    The blocks of the file itself, or of a called one behind it, from first to last (exclusive).

    body: the first block that does something. heads: the blocks with the number of a program.
    """

    first: int
    last: int
    body: int
    heads: list[int]
    is_own: bool


class _Ranges:
    """The ranges that are open, by name, as indices of the grants that have begun them."""

    def __init__(self, grants: list[Grant], known: Mapping[str, Collection[str]]) -> None:
        self._grants = grants
        self._known = known
        self._open: dict[str, list[int]] = {}

    def open(self, begin: int) -> None:
        """The grants from there on begin ranges."""
        for number in range(begin, len(self._grants)):
            self._open.setdefault(self._grants[number].name, []).append(number)

    def close(self, names: Sequence[str], last: int) -> str:
        """
        End the ranges of names at a block (exclusive), all where none is named; what is to be said of the others.

        A name ends the range of its group, too: what is not allowed any more must not stay silent under another name.
        """
        closed = set()
        for name in list(self._open):
            if not names or any(self._is_same(name, one) for one in names):
                closed.add(name)
                for number in self._open.pop(name):
                    self._grants[number] = msgspec.structs.replace(self._grants[number], last=last)
        if not names:
            return "" if closed else "no range is open here that it could close"
        idle = [one for one in names if not any(self._is_same(name, one) for name in closed)]
        return f"no range of {', '.join(idle).upper()} is open here that it could close" if idle else ""

    def _is_same(self, one: str, other: str) -> bool:
        """Whether two names are the same, or a group and a rule of it."""
        return one == other or one in self._known[other] or other in self._known[one]

    def left(self) -> dict[int, str]:
        """Per comment the names of the ranges that are still open, which are so no longer."""
        names: dict[int, dict[str, None]] = {}
        for number in sorted(number for numbers in self._open.values() for number in numbers):
            names.setdefault(self._grants[number].allow, {})[self._grants[number].name.upper()] = None
        self._open.clear()
        return {allow: ", ".join(own) for allow, own in names.items()}


class Allows:
    """
    The allow comments of a file and of the called ones behind it, in order.

    groups: the group of each rule, by name.

    start, end, block: per comment. faults: per comment what is wrong with it, empty where nothing is. grants: what each
    name silences. is_own: per comment whether it stands in the file itself. unpaired: per comment the names of ranges
    that are never closed, or of those that it closes and nothing has begun.
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
        self.read: list[Allow] = []
        found: list[Grant] = []
        ranges = _Ranges(found, self.known)
        region = None
        for number, place in enumerate(places):
            keep_time()
            comment = text.source.excerpt(place.start, min(place.end, place.start + _LONGEST))
            allow = read_allow(comment, self.known, number < _GUESSES)
            self.read.append(allow)
            self.faults[number] = allow.fault
            here = self._region(place.block)
            if region is not None and here is not region:
                self._left_open(ranges, region)
            region = here
            if allow.kind == OFF:
                is_clear = allow.names or not allow.fault
                self.unpaired[number] = ranges.close(allow.names, place.block + 1) if is_clear else ""
                continue
            first, last = self._reach(number, place, allow, region)
            begun = len(found)
            found += [Grant(number, name, first, last) for name in allow.names]
            if allow.kind == ON and first < last:
                ranges.open(begun)
        if region is not None:
            self._left_open(ranges, region)
        self.grants = [grant for grant in found if grant.first < grant.last]

    def __len__(self) -> int:
        return len(self.start)

    @cached_property
    def is_own(self) -> Mask:
        """Per comment whether it stands in the file itself, and not in a called one."""
        return np.array([self._region(int(block)).is_own for block in self.block], bool)

    @cached_property
    def silences(self) -> Mask:
        """Per comment whether it names what is silent from now on."""
        return np.array([bool(one.names) and one.kind != OFF for one in self.read], bool)

    @cached_property
    def has_reason(self) -> Mask:
        """Per comment whether it says why."""
        return np.array([bool(one.reason) for one in self.read], bool)

    # ---- what is silent ----

    @cached_property
    def _of_rules(self) -> dict[str, list[Grant]]:
        return {}

    def _of_rule(self, rule: str) -> list[Grant]:
        """The grants for a rule, under its own name and that of its group, by where they begin."""
        if rule not in self._of_rules:
            own = [grant for grant in self.grants if rule in self.known[grant.name]]
            self._of_rules[rule] = sorted(own, key=lambda grant: grant.first)
        return self._of_rules[rule]

    def names(self, rule: str) -> bool:
        """Whether any comment allows a rule anywhere."""
        return bool(self._of_rule(rule))

    def silenced(self, rule: str, blocks: Rows) -> Mask:
        """Which of these blocks a rule is silent in."""
        steps = np.zeros(len(self.text.blocks) + 1, np.int64)
        for grant in self._of_rule(rule):
            steps[grant.first] += 1
            steps[grant.last] -= 1
        return np.asarray(np.cumsum(steps)[blocks] > 0)

    def used(self, rule: str, blocks: Rows) -> set[Used]:
        """The names that silence a rule in any of these blocks: each with the position of its comment."""
        at = np.unique(blocks)
        return {
            (int(self.start[grant.allow]), grant.name)
            for grant in self._of_rule(rule)
            if np.searchsorted(at, grant.first) < np.searchsorted(at, grant.last)
        }

    def reason(self, rule: str, block: int) -> str:
        """Why a rule is silent in a block: the words of the comment that is nearest before it."""
        grants = self._of_rule(rule)
        at = bisect.bisect_right(grants, block, key=lambda grant: grant.first)
        found = next((grant for grant in reversed(grants[:at]) if block < grant.last), None)
        return self.read[found.allow].reason if found else ""

    def unused(self, used: Collection[Used], could: Collection[str]) -> UnusedAllows:
        """
        What has silenced nothing, of comments of the file itself that nothing else is wrong with.

        could: the rules of which something would have been found; only a name all of whose rules are among them counts.
        """
        names = _texts(len(self))
        for number, allow in enumerate(self.read):
            if self.is_own[number] and allow.kind != OFF and not self.faults[number]:
                own = [name for name in allow.names if (int(self.start[number]), name) not in used]
                names[number] = ", ".join(
                    name.upper() for name in own if all(map(could.__contains__, self.known[name]))
                )
        return UnusedAllows(names)

    # ---- where an allow reaches ----

    def _reach(self, number: int, place: Place, allow: Allow, region: Region) -> tuple[int, int]:
        """The blocks that an allow comment is for, none where it cannot be for any; then its fault says why."""
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
        """The block of a comment, or the one behind its end on the same line; else the next that has words."""
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

    def _left_open(self, ranges: _Ranges, region: Region) -> None:
        for number, names in ranges.left().items():
            if region.is_own:
                self.unpaired[number] = f"no ALLOW-OFF {names} closes this range: it reaches to the end of the file"

    # ---- the file ----

    @cached_property
    def has_words(self) -> Mask:
        """Per block whether anything but its number and comments stands in it."""
        return self._with_words(_NUMBERS[:1])

    @cached_property
    def _with_text(self) -> Rows:
        return np.flatnonzero(self.has_words)

    @cached_property
    def does_something(self) -> Mask:
        """The same without the numbers and names of programs."""
        found = self._with_words(_NUMBERS)
        found[self.text.names.block] = False
        return found

    def _with_words(self, besides: tuple[int, ...]) -> Mask:
        text = self.text
        found = text.blocks.is_macro.copy()
        found[text.words.block[~np.isin(text.words.address, besides)]] = True
        for spans in (text.names, text.strays, text.prose):
            found[spans.block] = True
        return found

    @cached_property
    def _regions(self) -> list[Region]:
        text = self.text
        starts = [int(np.searchsorted(text.blocks.line, part.first_line)) for part in text.source.parts]
        edges = [0, *starts, len(text.blocks)]
        heads = np.unique(text.words.block[begins_program(text.words)])
        found = []
        for number, first in enumerate(edges[:-1]):
            last = edges[number + 1]
            body = first + int(np.argmax(np.append(self.does_something[first:last], True)))
            own = heads[(heads >= first) & (heads < last)].tolist()
            found.append(Region(first, last, body, own, number == 0))
        return found

    def _region(self, block: int) -> Region:
        at = bisect.bisect_right(self._regions, block, key=lambda region: region.first)
        return self._regions[at - 1]


class UnusedAllows(msgspec.Struct, frozen=True):
    """
    names: per allow comment those that have silenced nothing, in upper case with commas between.
    """

    names: Texts


def _texts(length: int) -> Texts:
    found: Texts = np.full(length, "", np.object_)
    return found


def _places(text: Text) -> Iterator[Place]:
    """Where comments begin with the word; and lines with it that the control does not store, before the program."""
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
