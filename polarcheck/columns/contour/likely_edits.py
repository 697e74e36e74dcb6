"""Which one edit makes a path regular, tangent or closed, so that it may be what was meant."""

from __future__ import annotations

from collections.abc import Iterable
from itertools import islice
from typing import NamedTuple

import numpy as np

from polarcheck.columns.contour.correction import Correction
from polarcheck.columns.contour.loop_edits import Edit, edits_of, outlines_of, with_edit
from polarcheck.columns.contour.written_loop import WrittenLoop
from polarcheck.columns.trace import Trace
from polarcheck.foundation.arrays import Floats
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
#: How much less likely an edit of the block before the path is, since it leads to it; not where that closes the path
#: [coordinates].
_OF_LEAD = 2.0
#: The same where the path begins with an arc or would be closed, which says where it begins.
_OF_KNOWN_START = 0.5
#: Edits that are looked at for two mistakes, and second edits of each; kinds of edits that are none of two.
_FIRST_EDITS, _SECOND_EDITS, _OF_BLOCKS = 8, 2, ("twice", "order")
#: The least gain alone of the second of two edits: one that makes a path worse by itself mends nothing in it.
_LEAST_ALONE = -1.0
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


class Compared(NamedTuple):
    """
    Edits of a path, each of which changes one slip of the pen.

    outlines, chances: of the path as it is written, and with each of them. gain: how many coordinates fewer are as they
    are by chance.
    """

    loop: WrittenLoop
    edits: list[Edit]
    outlines: Outlines
    chances: Chances
    gain: Floats


def likely_edits(compared: Compared, most: int, least_gain: float) -> list[Likely]:
    """The edits that leave least to chance, the likeliest first, each path once; none where none is clearly better."""
    return [likely for likely, _ in likely_outlines(compared, most, least_gain)]


def likely_outlines(compared: Compared, most: int, least_gain: float) -> list[tuple[Likely, Outlines]]:
    """The same, each with the path that it makes, as the one outline of a table."""
    point, turns, radius, to_center = compared.outlines
    return [
        (_likely(compared, number), Outlines(point[[number]], turns[[number]], radius[[number]], to_center[[number]]))
        for number in _likeliest(compared, most, least_gain)
    ]


def all_compared(trace: Trace, loop: WrittenLoop) -> Compared:
    """All edits of a path in comparison, or none where they are too many."""
    return _compared(loop, edits_of(trace, loop))


def _compared(loop: WrittenLoop, edits: Iterable[Edit]) -> Compared:
    most = _MOST_POINTS // len(loop.row)
    edits = [*islice(edits, most)]
    edits = edits if len(edits) < most else []
    outlines = outlines_of(loop, edits)
    chances = chances_of(outlines, loop.tolerance)
    is_start = np.array([False, *(not edit.corner for edit in edits)])
    # Where the path would be closed, its start and its end are one point, and either may be wrong.
    is_known = (chances.is_open < chances.is_open[0]) | bool(loop.turns[0])
    total = chances.total + np.array([0.0, *(edit.cost for edit in edits)])
    total += is_start * np.where(is_known, _OF_KNOWN_START, _OF_LEAD)
    # A shape that loses corners is another shape.
    lost = np.maximum(chances.corners[0] - chances.corners - 1, 0)
    return Compared(loop, edits, outlines, chances, total[0] - total - _OF_LOST_CORNER * lost)


def _likeliest(compared: Compared, most: int, least_gain: float, *, is_one_of_two: bool = False) -> list[int]:
    """The outlines that leave least to chance, the likeliest first. is_one_of_two: another edit is made beside it."""
    loop, _, outlines, chances, gain = compared
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
    return found


def _likely(compared: Compared, number: int) -> Likely:
    _, edits, _, chances, gain = compared
    closes, smooths = (bool(part[number] == 0 and part[0] > 0) for part in (chances.is_open, chances.corners_at_arcs))
    # Corners at arcs about the center of C are counted among those of lines: moved there, a circle has no fewer.
    smooths &= bool(chances.corners[number] <= chances.corners[0])
    is_clear = bool(gain[number] >= LEAST_GAIN)
    return Likely(edits[number - 1], float(gain[number]), _becomes(chances, number), closes, smooths, is_clear)


def likely_pairs(
    trace: Trace, compared: Compared, most: int, least_gain: float = LEAST_IF_WHOLE
) -> list[tuple[Likely, Likely]]:
    """
    The pairs of edits of different words that leave least to chance, each of which does so beside the other one.

    least_gain: of the first edit, and of the second one beside it.
    """
    worse = {edit[:4] for edit, gain in zip(compared.edits, compared.gain[1:], strict=True) if gain < _LEAST_ALONE}
    found: dict[tuple[str, ...], tuple[float, Likely, Likely]] = {}
    for number in _likeliest(compared, _FIRST_EDITS, least_gain, is_one_of_two=True):
        first = _likely(compared, number)
        if first.edit.kind in _OF_BLOCKS:
            continue
        other = with_edit(compared.loop, first.edit)
        beside = _compared(other, (edit for edit in edits_of(trace, other) if edit[:4] not in worse))
        for second in (_likely(beside, at) for at in _likeliest(beside, _SECOND_EDITS, least_gain)):
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
    alike = ((np.abs(one - other) <= tolerance) | (np.isnan(one) & np.isnan(other)) for one, other in parts)
    return not all(part.all() for part in alike)


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
