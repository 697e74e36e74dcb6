"""Reads how a program is written from its words."""

from __future__ import annotations

from typing import Literal

import numpy as np

from polarcheck.columns.trace import Trace
from polarcheck.foundation.arrays import Mask, Rows
from polarcheck.foundation.states import MOVES, Motion
from polarcheck.program.reading.words import Text
from polarcheck.rewrite.writing.style import PLAIN, Style

#: Addresses of lengths and angles.
_LENGTHS = "XYZCUVWHIJKR"
#: A share above which something is the habit of the program.
_MOST = 0.5
#: So many of the numbers of a program have all decimals where it leaves none out.
_NEARLY_ALL = 0.9


def style_of(trace: Trace) -> Style:
    """Return how a program is written; where too little of it says so, as Style has it."""
    text = trace.text
    words = text.words
    if not len(words):
        return PLAIN
    lengths = _decimals(text, _of(text, _LENGTHS))
    feeds = _decimals(text, _of(text, "F"))
    numbered, step, digits = _numbers(text)
    motion, axes, feed = _repeats(trace)
    return Style(
        blank=_blank(text),
        lower_case=_is_lower(text),
        code_digits=_code_digits(text),
        decimals=lengths[0],
        fraction_decimals=_fraction_decimals(text, _of(text, _LENGTHS)) if lengths[0] is None else None,
        point=lengths[1],
        zero_point=lengths[2],
        leading_zero=_leading_zero(text),
        feed_decimals=feeds[0],
        feed_point=feeds[1],
        numbered=numbered,
        number_step=step,
        number_digits=digits,
        repeats_motion=motion,
        repeats_axes=axes,
        repeats_feed=feed,
        by_center=_by_center(trace),
    )


def _of(text: Text, addresses: str) -> Rows:
    """The words of these addresses that have digits."""
    numbers = np.frombuffer(addresses.encode(), np.uint8)
    return np.flatnonzero(np.isin(text.words.address, numbers) & (text.words.digits > 0))


def _blank(text: Text) -> str:
    words = text.words
    same = words.block[1:] == words.block[:-1]
    gaps = (words.start[1:] - words.end[:-1])[same]
    # A gap of more than a blank or two may hold a comment; it says nothing.
    gaps = gaps[gaps < 3]
    return " " if not len(gaps) or np.mean(gaps > 0) > _MOST else ""


def _is_lower(text: Text) -> bool:
    first = text.source.code[text.words.start]
    return bool(np.mean((first >= ord("a")) & (first <= ord("z"))) > _MOST)


def _code_digits(text: Text) -> int:
    """2 where most codes below 10 have a zero before them."""
    codes = _of(text, "GM")
    codes = codes[(text.words.value[codes] < 10) & (text.words.decimals[codes] == 0)]
    return 2 if len(codes) and np.mean(text.words.digits[codes] > 1) > _MOST else 1


def _decimals(text: Text, words: Rows) -> tuple[int | None, bool, bool]:
    """All decimals of a number, or None where zeros are left out; a point in whole numbers; a point in zero."""
    of = text.words
    values, decimals, points = of.value[words], of.decimals[words], of.has_point[words]
    whole = values == np.round(values)
    zero = values == 0
    count: int | None = None
    most = int(decimals.max(initial=0))
    ends_with_zero = (decimals > 0) & (text.source.code[of.end[words] - 1] == ord("0"))
    if most and len(words) > 2 and ends_with_zero.any() and np.mean(decimals[~zero] == most) >= _NEARLY_ALL:
        count = most
    return count, _is_usual(points[whole & ~zero], True), _is_usual(points[zero], False)


def _fraction_decimals(text: Text, words: Rows) -> int | None:
    """All decimals of a number that is not whole, or None where zeros are left out."""
    values, decimals = text.words.value[words], text.words.decimals[words]
    fractions = values != np.round(values)
    most = int(decimals[fractions].max(initial=0))
    if np.count_nonzero(fractions) < 3 or not most:
        return None
    ends_with_zero = text.source.code[text.words.end[words[fractions]] - 1] == ord("0")
    return most if ends_with_zero.any() and np.mean(decimals[fractions] == most) >= _NEARLY_ALL else None


def _is_usual(mask: Mask, otherwise: bool) -> bool:
    return bool(np.mean(mask) > _MOST) if len(mask) else otherwise


def _leading_zero(text: Text) -> bool:
    words, code = text.words, text.source.code
    lengths = _of(text, _LENGTHS + "F")
    small = lengths[(np.abs(words.value[lengths]) < 1) & (words.decimals[lengths] > 0)]
    first = np.minimum(words.start[small] + 1, len(code) - 1)
    signed = np.isin(code[first], np.frombuffer(b"+-=", np.uint8))
    return not len(small) or bool(np.mean(code[np.minimum(first + signed, len(code) - 1)] != ord(".")) > _MOST)


def _numbers(text: Text) -> tuple[Literal["none", "some", "all"], int, int]:
    """Which blocks have N words, the usual step, the least digits."""
    words = text.words
    numbers = _of(text, "N")
    if not len(numbers):
        return "none", PLAIN.number_step, PLAIN.number_digits
    # Blocks of words alone: heads of programs and macro statements may lack a number everywhere.
    blocks = np.unique(words.block[~np.isin(words.address, np.frombuffer(b"NO/", np.uint8))])
    share = float(np.mean(np.isin(blocks, words.block[numbers]))) if len(blocks) else 1.0
    steps = np.diff(words.value[numbers])
    steps = steps[(steps > 0) & (steps <= 1000)]
    values, counts = np.unique(steps, return_counts=True)
    step = int(values[np.argmax(counts)]) if len(values) else PLAIN.number_step
    padded = text.source.code[np.minimum(words.start[numbers] + 1, len(text.source.code) - 1)] == ord("0")
    digits = int(words.digits[numbers].max()) if np.mean(padded) > 0.05 else 1
    return ("all" if share > _MOST else "some"), max(step, 1), digits


def _repeats(trace: Trace) -> tuple[bool, bool, bool]:
    """A motion code in each block that moves in the mode, both axes, F: most blocks that need not have them do."""
    blocks, path = trace.blocks, trace.path
    rows = np.flatnonzero(path.travels & (trace.mode.section >= 0))
    if len(rows) < 2:
        return False, False, False
    same = np.append(False, np.diff(trace.axes.motion[rows]) == 0)
    motion = blocks.listed(*MOVES.values())[rows]
    lines = trace.axes.motion[rows] == Motion.LINE
    still = (path.start[rows].real == path.end[rows].real) | (path.start[rows].imag == path.end[rows].imag)
    both = (trace.axes.programs_linear_axis & trace.axes.has_virtual_word)[rows]
    feed = np.append(False, trace.feedrate.written_feed[rows][1:] == trace.feedrate.written_feed[rows][:-1])
    return (
        _is_usual(motion[same], False),
        _is_usual(both[lines & still], False),
        _is_usual(blocks.has("F")[rows][feed & same], False),
    )


def _by_center(trace: Trace) -> bool | None:
    """Arcs in the mode are written by their center: most that are no full circles."""
    rows = np.flatnonzero(trace.path.is_arc & (trace.mode.section >= 0) & (trace.path.start != trace.path.end))
    return bool(np.mean(trace.axes.has_center[rows]) > _MOST) if len(rows) else None
