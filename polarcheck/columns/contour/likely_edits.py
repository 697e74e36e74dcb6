"""Which one edit makes a path regular, tangent or closed, so that it may be what was meant."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from polarcheck.columns.contour.correction import Correction
from polarcheck.columns.contour.loop_edits import Edit, edits_of, outlines_of, with_edit
from polarcheck.columns.contour.written_loop import WrittenLoop
from polarcheck.columns.trace import Trace
from polarcheck.geometry.regularity.coincidences import Chances, Outlines, chances_of

#: An edit must leave so much less to chance than what is written: 2.5, of which the sum of the parts may be a bit less.
LEAST_GAIN = 2.499
#: The same where all findings of the path are gone with it; an edit of less must be told apart by more than that.
LEAST_IF_WHOLE = 0.9
#: By how much less a second edit may explain, for both to be named [coordinates].
AS_LIKELY = 0.5
#: Corners at arcs of a contour in which all other arcs are tangent.
_MOST_CORNERS = 2
#: So much of it must be other than arcs that reach their ends; in a path of few blocks more.
_LEAST_WITNESS, _IF_SHORT, _SHORT = 1.0, 2.0, 4
#: What each corner that is lost counts, but for the one of a wrong point on a side [coordinates].
_OF_LOST_CORNER = 2.0
#: How much less likely an edit of the block before the path is, since it leads to it [coordinates].
_OF_LEAD = 2.0
#: Edits that are looked at for two mistakes, and second edits of each; kinds of edits that are none of two.
_FIRST_EDITS, _SECOND_EDITS, _OF_BLOCKS = 8, 2, ("twice", "order")
#: Points of all edits of a path together, above which none is searched.
_MOST_POINTS = 400_000


class Likely(NamedTuple):
    """
    An edit that may be what was meant.

    gain: how many coordinates fewer are as they are by chance. becomes: what the path is then, in words. closes,
    smooths: it is closed then, or all of its arcs are tangent, and it was not. is_clear: the gain alone speaks for it.
    """

    edit: Edit
    gain: float
    becomes: str
    closes: bool
    smooths: bool
    is_clear: bool


def correction_by(likely: Likely, row: int) -> Correction:
    """The correction in the block of a row that an edit is."""
    edit = likely.edit
    word = edit.words[0] if len(edit.words) == 1 else -1
    return Correction(row, word, edit.text, edit.why, edit.remedy, likely.becomes)


def likely_edits(
    trace: Trace, loop: WrittenLoop, most: int, least_gain: float = LEAST_GAIN, *, is_one_of_two: bool = False
) -> list[Likely]:
    """
    The edits that leave least to chance, the likeliest first, each path once; none where none is clearly better.

    least_gain: how many coordinates fewer are as they are by chance. is_one_of_two: another edit is made beside it.
    """
    edits = edits_of(trace, loop)
    if (len(edits) + 1) * len(loop.row) > _MOST_POINTS:
        return []
    outlines = outlines_of(loop, edits)
    chances = chances_of(outlines, loop.tolerance)
    cost = [edit.cost + _OF_LEAD * (not edit.corner) for edit in edits]
    total = chances.total + np.array([0.0, *cost])
    # A shape that loses corners is another shape.
    lost = np.maximum(chances.corners[0] - chances.corners - 1, 0)
    gain = total[0] - total - _OF_LOST_CORNER * lost
    witness = chances.without_broken_arcs[0] - chances.without_broken_arcs
    # A gain that is not clear must be more than lengths and points that are alike.
    is_better = np.any([part < part[0] for part in chances[:4]], axis=0)
    least = _LEAST_WITNESS if len(loop.turns) >= _SHORT else _IF_SHORT
    found: list[int] = []
    for number in np.argsort(-gain, kind="stable").tolist():
        if len(found) == most or gain[number] < least_gain:
            break
        is_sure = gain[number] >= LEAST_GAIN or least_gain < LEAST_IF_WHOLE or is_better[number]
        if (
            is_sure
            and witness[number] >= least
            and all(_differs(outlines, number, other, loop.tolerance) for other in found)
        ):
            found.append(number)
    if found and not is_one_of_two and _leaves_corner(chances, outlines, found[0]):
        return []
    closes, smooths = ((part == 0) & (part[0] > 0) for part in (chances.is_open, chances.corners_at_arcs))
    return [
        Likely(
            edits[number - 1],
            float(gain[number]),
            _becomes(chances, number),
            bool(closes[number]),
            bool(smooths[number]),
            bool(gain[number] >= LEAST_GAIN),
        )
        for number in found
    ]


def likely_pairs(trace: Trace, loop: WrittenLoop, most: int) -> list[tuple[Likely, Likely]]:
    """The pairs of edits of different words that leave least to chance, each of which does so beside the other one."""
    found: dict[tuple[str, ...], tuple[float, Likely, Likely]] = {}
    for first in likely_edits(trace, loop, _FIRST_EDITS, LEAST_IF_WHOLE, is_one_of_two=True):
        if first.edit.kind in _OF_BLOCKS:
            continue
        for second in likely_edits(trace, with_edit(loop, first.edit), _SECOND_EDITS, LEAST_IF_WHOLE):
            if second.edit.kind in _OF_BLOCKS or second.edit.corner == first.edit.corner:
                continue
            one, two = sorted((first, second), key=lambda likely: likely.edit.corner)
            key = tuple(f"{likely.edit.corner} {likely.edit.text}" for likely in (one, two))
            found.setdefault(key, (first.gain + second.gain, one, two))
    pairs = sorted(found.values(), key=lambda pair: -pair[0])
    return [(one, two) for _, one, two in pairs[:most]]


def _leaves_corner(chances: Chances, outlines: Outlines, number: int) -> bool:
    """An edit mends an arc and leaves a corner at one of its ends, where nearly all arcs are tangent: more is wrong."""
    corners, arcs = int(chances.corners_at_arcs[number]), int(np.count_nonzero(outlines.turns[number]))
    mends = chances.broken_arcs[number] < chances.broken_arcs[0]
    return bool(mends and 0 < corners <= _MOST_CORNERS and arcs >= _MOST_CORNERS + corners)


def _differs(outlines: Outlines, first: int, second: int, tolerance: float) -> bool:
    """Two outlines are not the same."""
    if np.abs(outlines.point[first] - outlines.point[second]).max() > tolerance:
        return True
    parts = ((part[first], part[second]) for part in outlines[1:])
    return not all(np.allclose(one, other, atol=tolerance, equal_nan=True) for one, other in parts)


def _becomes(chances: Chances, number: int) -> str:
    """What an outline is better in than the one that is written."""
    before, after = ([int(part[index]) for part in chances[:4]] for index in (0, number))
    if after[0] < before[0]:
        return "all its arcs would end on their circles" if not after[0] else "one more arc would end on its circle"
    if after[3] < before[3]:
        return "it would be closed"
    if after[1] < before[1]:
        return "its arcs would be tangent" if not after[1] else "more of its arcs would be tangent"
    if after[2] < before[2]:
        return "it would not turn back"
    return "more of its lengths and points would be alike"
