"""
Where a tool goes down in a section: a pocket or hole that is off the regular polygon of all the others, and a depth at
which nothing is cut.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from polarcheck.columns.contour.correction import Correction
from polarcheck.columns.contour.passes import numbered
from polarcheck.columns.contour.written_loop import axis_words
from polarcheck.columns.path.lengths import same_place
from polarcheck.columns.trace import Trace
from polarcheck.columns.words.slips import parts_of, plain_number, slip_of
from polarcheck.foundation.arrays import Points, Rows, different, first_in_run
from polarcheck.foundation.states import Motion, Side
from polarcheck.geometry.regularity.symmetric_corners import each_once, is_lonely, regular_polygons
from polarcheck.geometry.tolerances import ROUNDING

#: Places of a section that are compared; of the fewest a slip alone tells that no other design explains.
_FEWEST, _MOST = 4, 36
#: Even depths at one place, at the least, one of which nothing is cut at.
_DEPTHS = 3
#: Decimals of coordinates of one place [mm].
_DECIMALS = 5


def misplaced(trace: Trace, rows: Rows) -> Iterator[Correction]:
    """The corrections of places where a tool goes down without compensation, which are these rows; one a section."""
    for of_section in np.split(rows, np.flatnonzero(first_in_run(trace.mode.section[rows]))[1:]):
        yield from _of_section(trace, of_section)


def idle(trace: Trace, rows: Rows) -> Iterator[Correction]:
    """The corrections of depths to which a tool goes in steps, one without a cut behind it; rows as for misplaced."""
    moving = np.flatnonzero(trace.path.moves & trace.mode.in_polar)
    following = np.append(moving, -1)[np.searchsorted(moving, rows, side="right")]
    cuts = trace.path.travels[following] & (trace.axes.motion[following] != Motion.RAPID)
    cuts &= trace.mode.section[following] == trace.mode.section[rows]
    place = np.round(trace.path.end[rows], _DECIMALS)
    number = numbered([trace.mode.section[rows], place.real, place.imag])
    order, begins = np.argsort(number, kind="stable"), np.append(0, np.cumsum(np.bincount(number)))
    has_one, words = np.bincount(number, ~cuts) == 1, trace.blocks.word_indices("Z")
    for index in np.flatnonzero(~cuts & has_one[number]).tolist():
        at_place = order[begins[number[index]] : begins[number[index] + 1]]
        depth, own = -trace.path.z[rows[at_place]], -trace.path.z[rows[index]]
        depths = different(depth)
        steps = np.diff(depths)
        first, last = np.searchsorted(trace.run.row[words], (rows[index], rows[index] + 1))
        # The first depth may be one to which a tool goes fast.
        if len(depths) >= _DEPTHS and own > max(depths[0] + ROUNDING, 0) and np.ptp(steps) <= ROUNDING and last > first:
            becomes = f"something would be cut at each of its {len(depths)} depths"
            word = int(words[last - 1])
            yield Correction(rows[index], word, "", "nothing is cut at it", "with a cut behind it", becomes, "depths")


def _of_section(trace: Trace, rows: Rows) -> Iterator[Correction]:
    place = trace.path.end[rows]
    written = different(place)
    if not _FEWEST <= len(written) <= _MOST:
        return
    tolerance = same_place(complex(trace.lengths.half_of_last_digit(rows[:1])[0]))
    places = each_once(written, tolerance)
    visits = np.count_nonzero(np.abs(place[:, None] - places) <= tolerance, axis=0)
    if len(places) < _FEWEST or visits.min() != visits.max():
        return
    for polygon in regular_polygons(places, tolerance, 1, _FEWEST):
        free, odd = polygon[is_lonely(polygon, places, tolerance)], places[is_lonely(places, polygon, tolerance)]
        if len(polygon) == len(places) and len(free) == len(odd) == 1:
            visit = int(np.argmax(np.abs(place - odd[0]) <= tolerance))
            above = int(rows[visit - 1]) if visit else int(trace.mode.sections.enter[trace.mode.section[rows[0]]])
            found = _correction(trace, above, int(rows[visit]), complex(free[0]), places)
            if found is not None:
                yield found
                return


def _correction(trace: Trace, above: int, row: int, place: complex, places: Points) -> Correction | None:
    """The word that leads to another place than where the tool goes down in a row, if it is a slip of the pen."""
    moves = np.arange(above + 1, row)
    moves = moves[trace.path.travels[moves] & (trace.compensation.side[moves] == Side.OFF)]
    if not len(moves):
        return None
    axes = axis_words(trace, moves)
    tolerance = same_place(complex(trace.lengths.half_of_last_digit(np.array([row]))[0]))
    away = [complex((place - trace.path.end[row]) / axis.direction).real for axis in axes]
    odd = [axis for axis, shift in zip(axes, away, strict=True) if abs(shift) > tolerance]
    if len(odd) != 1:
        return None
    (axis,) = odd
    scale = float(axis.scale[-1])
    needed = complex(place / axis.direction).real / scale
    # As another place has it, but for its sign: each of them is rounded.
    sizes = np.abs((places / axis.direction).real / scale)
    nearest = float(sizes[np.argmin(np.abs(sizes - abs(needed)))])
    if abs(nearest - abs(needed)) <= tolerance / scale:
        needed = float(np.copysign(round(nearest, 5), needed))
    becomes = f"the {len(places)} places where the tool goes down would be a regular polygon"
    written = np.flatnonzero(axis.word >= 0)
    if not len(written):
        text = f"{axis.address}{plain_number(round(needed, 3))}"
        return Correction(int(moves[-1]), -1, text, "a word is missing", f"with {text}", becomes, "pattern")
    at = int(written[-1])
    address, number = parts_of(trace.run.written(int(axis.word[at])))
    slip = slip_of(number, needed, ROUNDING) or slip_of(number, needed, tolerance / scale)
    if axis.is_step[at] or slip is None or (len(places) == _FEWEST and not slip.plain):
        return None
    text = address + slip.text
    return Correction(int(moves[at]), int(axis.word[at]), text, slip.kind, f"with {text}", becomes, "pattern")
