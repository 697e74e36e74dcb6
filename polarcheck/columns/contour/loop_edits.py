"""All that one slip of the pen may have changed in a path: words, letters, codes, blocks; and the path without it."""

from __future__ import annotations

import functools
from collections.abc import Iterator
from typing import Literal, NamedTuple

import numpy as np

from polarcheck.columns.contour.written_loop import AxisWords, WrittenLoop
from polarcheck.columns.trace import Trace
from polarcheck.columns.words.slips import Slip, parts_of, plain_number, slips_of
from polarcheck.foundation.arrays import Floats, Mask, Points, Rows
from polarcheck.geometry.regularity.coincidences import Outlines

#: Numbers of a contour; smaller ones are 0, or nobody can tell.
_LEAST, _GREATEST = 0.02, 2000.0
#: Numbers that differ by less are one; a number that is calculated is off by so many last digits of what is written,
#: of which none is coarser than that of so many decimals.
_SAME_NUMBER, _STEPS, _COARSEST = 5e-5, 1.5, 2
#: By how much an edit is less likely, as a number of coordinates that are as they are by chance: a slip that is seldom
#: made, a number of another block, a word or block that is missing or too many, another sense, a number that no other
#: block has with more decimals than what is written, one of a block that is not beside it, and one that is nearly that
#: of another block.
_SELDOM, _ELSEWHERE, _OF_BLOCK, _SAME_SIZE, _FINER, _FAR, _NEARLY = 0.3, 0.2, 0.4, 0.1, 0.6, 2.5, 0.4

#: What no R, I or J that is meant is larger than, as a multiple of how far the path reaches from its start.
_LARGEST_ARC = 5.0
#: An angle in degrees is a multiple of this, from twice as much on; what is said of one.
_PART_OF_TURN, _FULL_TURN = 15.0, 360.0
_IS_ANGLE = "it looks like an angle"
#: What is to be done where nothing is to be written.
_REMEDIES = {"twice": "without it", "order": "behind the next one"}


class Edit(NamedTuple):
    """
    One edit of a path.

    kind: what it changes. corner: the block, 0 for the move before. words: the executed words that it replaces. text:
    what is written instead, or put behind the last word. why: the slip. cost: how unlikely the slip is. axis: of a
    word, 0 for X. value: its number, for a word of an arc the factor. how: what is to be done, where it is more than to
    write the text. is_of_pen: no other design is likely to differ by the slip alone.
    """

    kind: Literal["word", "missing", "letter", "exchanged", "arc", "sense", "twice", "order", "code", "other pass"]
    corner: int
    words: tuple[int, ...]
    text: str
    why: str
    cost: float
    axis: int = 0
    value: float = np.nan
    how: str = ""
    is_of_pen: bool = True

    @property
    def remedy(self) -> str:
        """What is to be done, as it stands before what it makes of the contour."""
        return self.how or _REMEDIES.get(self.kind, f"with {self.text}")

    @property
    def is_common(self) -> bool:
        """The slip is often made."""
        return self.cost < _SELDOM

    @property
    def is_plain(self) -> bool:
        """The slip is often made, and no other design is likely to differ by it."""
        return self.cost < _ELSEWHERE


def order_edit(corner: int, cost: float) -> Edit:
    """The edit that exchanges a block with the one behind it."""
    return Edit("order", corner, (), "", "it stands before the block that should be before it", cost)


def edits_of(trace: Trace, loop: WrittenLoop) -> Iterator[Edit]:
    """All edits of a path, the likelier first where they say the same."""
    for axis in range(2):
        yield from _of_axis(trace, loop, axis)
    for address in loop.arc_words:
        yield from _of_arcs(trace, loop, address)
    yield from _of_codes(trace, loop)
    yield from _of_blocks(loop)


def _of_axis(trace: Trace, loop: WrittenLoop, number: int) -> Iterator[Edit]:
    axis, other = loop.axes[number], loop.axes[1 - number]
    sizes, on_circle = _sizes(axis.value[~axis.is_step]), _on_circles(trace, loop, number)
    gap = _gap(loop, number)
    is_open = abs(gap) > 2 * loop.tolerance
    for corner, word in enumerate(axis.word.tolist()):
        if word < 0:
            if is_open and corner and other.is_step[corner] and other.word[corner] >= 0:
                letter, _ = parts_of(trace.run.written(int(other.word[corner])))
                is_letter = letter.strip("=") == other.step_address.strip("=")
                value = _rounded(gap / float(axis.scale[corner]), axis, other)
                text = f"{axis.step_address if is_letter else axis.address}{plain_number(value)}"
                yield Edit("missing", corner, (), text, "a word is missing", _OF_BLOCK, number, value)
            values = dict.fromkeys(signed for size in (0.0, *sizes) for signed in (size, -size))
            for value in (*values, *on_circle.get(corner, ())) if corner else ():
                text = f"{axis.address}{plain_number(value)}"
                yield Edit("missing", corner, (), text, "a word is missing", _OF_BLOCK, number, value)
            continue
        address, written = parts_of(trace.run.written(word))
        if not address or np.isnan(axis.value[corner]):  # an edit has given the word to the other axis
            continue
        others = () if axis.is_step[corner] else (0.0, *sizes)
        neighbors = axis.value[max(corner - 1, 0) : corner + 2 : 2] if corner else axis.value[1:2]
        beside = tuple(neighbors[~np.isnan(neighbors)].tolist())
        is_angle = number == 1 and _looks_like_angle(loop, corner)
        for slip, cost in _numbers(written, float(axis.value[corner]), others, beside, is_angle=is_angle):
            text, value = address + slip.text, float(slip.text)
            yield Edit("word", corner, (word,), text, slip.kind, cost, number, value, is_of_pen=slip.plain)
        if axis.is_step[corner] and corner and is_open:
            value = _rounded(float(axis.value[corner]) + gap / float(axis.scale[corner]), axis)
            text = address + plain_number(value)
            yield Edit("word", corner, (word,), text, "another number is meant", _SELDOM, number, value)
        is_earlier = bool(trace.run.row[word] != loop.row[corner])
        if other.word[corner] < 0 and not is_earlier:
            # In G91 the letter of a position is an increment, too.
            letter = other.step_address if address.strip("=") == axis.step_address.strip("=") else other.address
            text = letter + "=" * address.endswith("=") + written
            yield Edit("letter", corner, (word,), text, "it has the letter of the other axis", 0.0, number)
        elif not number and not is_earlier and (parts := parts_of(trace.run.written(int(other.word[corner]))))[0]:
            words = word, int(other.word[corner])
            text = f"{address}{parts[1]} {parts[0]}{written}"
            why = f"the numbers of {address.strip('=')} and {parts[0].strip('=')} are exchanged"
            yield Edit("exchanged", corner, words, text, why, 0.0)


def _rounded(value: float, *axes: AxisWords) -> float:
    """A number with as many decimals as those of some axes."""
    numbers = np.concatenate([axis.value[~np.isnan(axis.value)] for axis in axes])
    return round(value, max(_decimals(plain_number(number)) for number in numbers.tolist()))


def _gap(loop: WrittenLoop, number: int) -> float:
    """How far along an axis the path ends before its start [mm]."""
    ends = loop.points([axis.value[None] for axis in loop.axes], [axis.is_step[None] for axis in loop.axes])[0]
    return float((complex(ends[0] - ends[-1]) / loop.axes[number].direction).real)


def _on_circles(trace: Trace, loop: WrittenLoop, number: int) -> dict[int, tuple[float, ...]]:
    """By corner where an axis would end on the circle of an arc, with the other axis as it is written."""
    axis, other = loop.axes[number], loop.axes[1 - number]
    ends = loop.points([one.value[None] for one in loop.axes], [one.is_step[None] for one in loop.axes])[0]
    found: dict[int, tuple[float, ...]] = {}
    for block in np.flatnonzero((loop.turns != 0) & np.isnan(loop.radius)).tolist():
        center = complex(ends[block] + loop.to_center[block])
        across = ((ends[block + 1] - center) / other.direction).real
        if abs(across) < abs(loop.to_center[block]):
            reach, middle = (abs(loop.to_center[block]) ** 2 - across**2) ** 0.5, (center / axis.direction).real
            places = int(trace.run.words.decimals[axis.word[axis.word >= 0]].max(initial=0))
            found[block + 1] = tuple(round((middle + way) / axis.scale[block + 1], places) for way in (reach, -reach))
    return found


def _of_arcs(trace: Trace, loop: WrittenLoop, address: str) -> Iterator[Edit]:
    words = loop.arc_words[address]
    values, axis = trace.run.words.value[words[words >= 0]], max("RIJ".find(address), 0)
    ends = loop.points([one.value[None] for one in loop.axes], [one.is_step[None] for one in loop.axes])[0]
    longest = _LARGEST_ARC * np.abs(ends - ends[0]).max() / loop.axes[1].scale
    for block, word in enumerate(words.tolist()):
        had = float(trace.run.words.value[word]) if word >= 0 else 0.0
        letters, written = parts_of(trace.run.written(word)) if word >= 0 else ("", "")
        if letters and had:
            for slip, cost in _numbers(written, had, (0.0, *_sizes(values)), tuple(values.tolist())):
                value = float(slip.text)
                if (value or axis) and abs(value) <= max(longest[block + 1], abs(had)):
                    text, factor = letters + slip.text, value / had
                    yield Edit("arc", block + 1, (word,), text, slip.kind, cost, axis, factor)
            if axis and (value := _to_both_ends(loop, ends, block, axis, had)) and abs(value - had) > _SAME_NUMBER:
                text = letters + plain_number(value)
                yield Edit("arc", block + 1, (word,), text, "another number is meant", _SELDOM, axis, value / had)


def _to_both_ends(loop: WrittenLoop, ends: Points, block: int, axis: int, had: float) -> float:
    """I or J, as round as it is written, with which the center of an arc is as far from both its ends; 0 for none."""
    chord, center = complex(ends[block + 1] - ends[block]), complex(loop.to_center[block])
    along, other = (chord.real, chord.imag * center.imag) if axis == 1 else (chord.imag, chord.real * center.real)
    own = center.real if axis == 1 else center.imag
    meant = (abs(chord) ** 2 / 2 - other) / along if abs(along) > loop.tolerance else 0.0
    value = round(meant / own * had, _decimals(plain_number(had))) if own else 0.0
    return value if own and abs(value / had * own - meant) <= loop.tolerance else 0.0


def _of_codes(trace: Trace, loop: WrittenLoop) -> Iterator[Edit]:
    machine = trace.machine
    for block in np.flatnonzero(loop.turns).tolist():
        codes = machine.codes("arc_counterclockwise" if loop.turns[block] < 0 else "arc_clockwise")
        words = (int(loop.code[block]),) if loop.code[block] >= 0 else ()
        if codes:
            why = "the arc has the other sense" if words else "its code is missing"
            yield Edit("sense", block + 1, words, next(iter(codes)), why, _SAME_SIZE)


def _of_blocks(loop: WrittenLoop) -> Iterator[Edit]:
    count = len(loop.turns)
    for corner in range(1, count + 1):
        if all(_is_same(axis, corner) for axis in loop.axes):
            yield Edit("twice", corner, (), "", "it stands there twice", _OF_BLOCK)
        if corner < count:
            yield order_edit(corner, _OF_BLOCK)


def _is_same(axis: AxisWords, corner: int) -> bool:
    """A block has the word of an axis that the block before it has."""
    return bool(np.isnan(axis.value[corner]) or (axis.value[corner - 1] == axis.value[corner]))


def _sizes(values: Floats) -> tuple[float, ...]:
    """The different sizes of numbers, but 0."""
    return tuple(dict.fromkeys(size for size in np.round(np.abs(values), 4).tolist() if size > 0))


def _looks_like_angle(loop: WrittenLoop, corner: int) -> bool:
    """C is one of the usual angles, and as a length twice as far out as any other point of the path."""
    x, c = loop.axes
    value, lengths = float(c.value[corner]), np.abs(np.array([axis.value * axis.scale for axis in (x, c)]))
    lengths[1, corner] = np.nan
    is_usual = value % _PART_OF_TURN == 0 and 2 * _PART_OF_TURN <= abs(value) <= _FULL_TURN
    return is_usual and abs(value) * float(c.scale[corner]) > 2 * float(np.fmax.reduce(lengths, None, initial=0.0))


@functools.lru_cache(maxsize=256)
def _numbers(
    written: str, value: float, others: tuple[float, ...], beside: tuple[float, ...], *, is_angle: bool = False
) -> tuple[tuple[Slip, float], ...]:
    """
    What a number may be instead, each once, with its cost; kept, since a trial asks for nearly all of them again.

    others: the sizes of the numbers of all blocks, one of which may be meant. beside: the numbers of the blocks before
    and behind, one of which may be what is written. is_angle: it looks like an angle.
    """
    known = {_key(value)}
    is_beside = any(abs(number - value) < _SAME_NUMBER for number in beside)
    why = "it is that of the block beside it" if is_beside else _IS_ANGLE if is_angle else "another number is meant"
    of_others = Slip("", why, False)
    # A number without decimals is as fine as the others.
    decimals = _decimals(written) or max((_decimals(plain_number(size)) for size in others), default=0)
    step = _STEPS * 10.0 ** -max(decimals, _COARSEST)
    of_pen = list(slips_of(written))
    exact = {_key(slip.text) for slip in of_pen}
    # A number that one slip writes exactly is none that another one writes but for rounding, and nobody rounds to 0.
    inexact = tuple(size for size in others if size and _key(size) not in exact and _key(-size) not in exact)
    likely = (slip._replace(text=_of_others(float(slip.text), slip.text, inexact, step)) for slip in of_pen)
    slips = [(slip, _cost(slip, written, others, step)) for slip in likely]
    for size in others:
        cost = _SELDOM if is_beside or is_angle else _FAR
        slips += [(of_others._replace(text=plain_number(number)), cost) for number in (size, -size)]
    found = []
    for slip, cost in sorted(slips, key=lambda pair: (pair[1], pair[0].kind != _IS_ANGLE)):
        key = _key(slip.text)
        if key not in known and (_LEAST <= abs(float(slip.text)) <= _GREATEST or not key):
            known.add(key)
            found.append((slip, cost))
    return tuple(found)


def _key(number: str | float) -> int:
    return round(float(number) / _SAME_NUMBER)


def _of_others(value: float, text: str, others: tuple[float, ...], step: float) -> str:
    """A number as another block has it, if it is that but for rounding; else the text."""
    near = [size for size in others if 0 < abs(size - abs(value)) <= step]
    return plain_number(float(np.copysign(near[0], value))) if near else text


def _cost(slip: Slip, written: str, others: tuple[float, ...], step: float) -> float:
    apart = min((abs(abs(float(slip.text)) - size) for size in others), default=np.inf)
    is_other = apart < _SAME_NUMBER
    is_finer = not is_other and _decimals(slip.text) > _decimals(written)
    is_nearly_other = not is_other and apart <= step
    cost = (not slip.is_common) * _SELDOM + (not (slip.plain or is_other)) * _ELSEWHERE
    return cost + is_finer * _FINER + is_nearly_other * _NEARLY


def _decimals(number: str) -> int:
    return len(number.partition(".")[2].rstrip("0"))


def outlines_of(loop: WrittenLoop, edits: list[Edit]) -> Outlines:
    """The path with each of these edits; the first outline is that of the path as it is written."""
    values, steps, turns, radius, to_center = _changed(loop, edits)
    return Outlines(loop.points(values, steps), turns, radius, to_center)


def with_edit(loop: WrittenLoop, edit: Edit) -> WrittenLoop:
    """The path with an edit that leaves its blocks as they are; its words are those that are written."""
    values, steps, turns, radius, to_center = _changed(loop, [edit])
    first, second = (
        axis._replace(value=value[1], is_step=step[1], word=np.where(np.isnan(value[1]), -1, axis.word))
        for axis, value, step in zip(loop.axes, values, steps, strict=True)
    )
    return loop._replace(axes=(first, second), turns=turns[1], radius=radius[1], to_center=to_center[1])


def _changed(loop: WrittenLoop, edits: list[Edit]) -> tuple[list[Floats], list[Mask], Rows, Floats, Points]:
    """Numbers of both axes, whether they are steps, turns, R and centers: as they are written, and with each edit."""
    count, axes = len(edits) + 1, loop.axes
    values = [np.repeat(axis.value[None], count, 0) for axis in axes]
    steps = [np.repeat(axis.is_step[None], count, 0) for axis in axes]
    turns, radius = np.repeat(loop.turns[None], count, 0), np.repeat(loop.radius[None], count, 0)
    to_center = np.repeat(loop.to_center[None], count, 0)
    for axis in range(2):
        # Most edits change one number.
        changes = [
            (number, edit.corner, edit.value, edit.kind == "missing" and edit.text.startswith(axes[axis].step_address))
            for number, edit in enumerate(edits, 1)
            if edit.axis == axis and edit.kind in ("word", "missing")
        ]
        if changes:
            numbers, corners, changed, is_step = (np.array(part) for part in zip(*changes, strict=True))
            values[axis][numbers, corners] = changed
            steps[axis][numbers, corners] |= is_step
    for number, edit in enumerate(edits, 1):
        at = number, edit.corner
        match edit.kind:
            case "word" | "missing":
                pass
            case "letter":
                values[1 - edit.axis][at], values[edit.axis][at] = values[edit.axis][at], np.nan
                steps[1 - edit.axis][at] = steps[edit.axis][at]
            case "exchanged":
                values[0][at], values[1][at] = values[1][at], values[0][at]
            case "arc":
                _change_arc(edit, radius, to_center, number)
            case "sense":
                turns[number, edit.corner - 1 : _next_code(loop, edit.corner)] *= -1
            case "twice":
                values[0][at] = values[1][at] = np.nan
                turns[number, edit.corner - 1] = 0
            case "order":
                for words in (*values, *steps):
                    words[number, edit.corner : edit.corner + 2] = words[number, [edit.corner + 1, edit.corner]]
                for parts in (turns, radius, to_center):
                    parts[number, edit.corner - 1 : edit.corner + 1] = parts[number, [edit.corner, edit.corner - 1]]
    return values, steps, turns, radius, to_center


def _next_code(loop: WrittenLoop, block: int) -> int:
    """The first block from this one on with a code of motion of its own."""
    following = np.flatnonzero(loop.code[block:] >= 0)
    return block + int(following[0]) if len(following) else len(loop.code)


def _change_arc(edit: Edit, radius: Floats, to_center: Points, number: int) -> None:
    at = number, edit.corner - 1
    if edit.axis == 1:
        to_center[at] += (edit.value - 1) * to_center[at].real
    elif edit.axis == 2:
        to_center[at] += 1j * (edit.value - 1) * to_center[at].imag
    else:
        radius[at] *= edit.value
