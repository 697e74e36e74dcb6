"""The one word or block of a loop with which its contour would be regular, symmetric, or closed."""

from __future__ import annotations

import re
from collections.abc import Iterator
from itertools import islice
from typing import NamedTuple

import numpy as np

from polarcheck.columns.contour.correction import Correction
from polarcheck.columns.contour.plane_loops import PlaneLoop
from polarcheck.columns.contour.written_loop import AxisWords, axis_words
from polarcheck.columns.trace import Trace
from polarcheck.columns.words.slips import Slip, plain_number, slip_of
from polarcheck.foundation.arrays import Points, cached_property
from polarcheck.geometry.regularity.symmetric_corners import each_once, is_lonely, missing_places, regular_polygons
from polarcheck.geometry.regularity.symmetry import Symmetry

#: Least number of corners of a contour that repeats itself in a turn, and of one that is only its own mirror image.
_CORNERS, _MIRRORED_CORNERS = 5, 6
#: The order of what comes again after half a turn.
_HALF_TURN = 2
#: By how many numbers fewer a correction must say where all corners are: more where other designs differ so, too.
_GAIN, _GAIN_IF_UNSURE = 4, 5
#: From so many corners on a shape that repeats itself in turns and mirrors is meant, be it that its sides are parallel.
_MANY_CORNERS = 8
#: From so many corners on, one that is off the regular polygon of all the others is a mistake, whatever was written.
_ODD_OF = 6
#: Corrections that are tried for one loop; ends of a path where it may close; blocks between which one may be missing.
_MOST_TRIALS, _ENDS, _GAPS = 80, 3, 3
#: Halves of the last digit by which a number may differ from that of another block.
_DIGITS = 5

#: An angle in degrees is a multiple of this, from twice as much on.
_PART_OF_TURN, _FULL_TURN = 15.0, 360.0
#: Numbers that differ by less are one.
_SAME_NUMBER = 1e-6
_WORD = re.compile(r"([A-Z])([+-]?+(?:\d++\.?+\d*+|\.\d++))")


class _Trial(NamedTuple):
    """A correction that is tried: the number of the block in the loop, the slip, and where the blocks end with it."""

    at: int
    word: int
    slip: Slip
    point: Points
    loop: PlaneLoop


def correction_of(trace: Trace, loop: PlaneLoop, written: Symmetry | None) -> Correction | None:
    """
    The correction that leaves least free; None where the contour is as it should be, or is no such contour.

    written: its symmetry as it is written.
    """
    return _Search(trace, loop, written).best()


class _Search:
    def __init__(self, trace: Trace, loop: PlaneLoop, written: Symmetry | None) -> None:
        self.trace, self.loop, self.tolerance, self.written = trace, loop, loop.tolerance, written

    def best(self) -> Correction | None:
        point = each_once(self.loop.point, self.tolerance)
        if len(point) < _CORNERS - 1:
            return None
        # The ends of leads are no corners, and where leads cross is one.
        rings = (ring.corner for ring in islice(self.loop.rings, 1))
        found = [missing_places(points, self.tolerance) for points in (point, point[1:-1], *rings)]
        places = each_once(np.concatenate(found), self.tolerance)
        ends = np.append(self.loop.point[:_ENDS], self.loop.point[-_ENDS:])
        trials = [*self._fitting(self._of_words(np.append(places, ends))), *self._fitting(self._of_steps())]
        if not trials:
            trials = [*self._fitting(self._of_odd_corner())]
        if not trials and len(places):
            trials = [*self._fitting(self._of_blocks(places))]
        return min(trials, key=lambda trial: trial[:2])[2] if trials else None

    def _fitting(self, trials: Iterator[_Trial]) -> Iterator[tuple[int, int, Correction]]:
        """The trials that make the contour regular: what they leave free, their number, the correction."""
        for number, trial in enumerate(islice(trials, _MOST_TRIALS)):
            symmetry = trial.loop.symmetry(trial.point)
            if symmetry is not None and self._is_better(symmetry, trial):
                row, slip = self._row(trial.at), trial.slip
                rank = number + _MOST_TRIALS * (2 * (not slip.plain) + (not self._is_known(slip.text)))
                remedy, becomes = _remedy(slip), _becomes(symmetry)
                yield symmetry.freedom, rank, Correction(row, trial.word, slip.text, slip.kind, remedy, becomes)

    def _is_known(self, text: str) -> bool:
        """A word stands in a block of another loop, as another pass has it."""
        word = _WORD.fullmatch(text)
        if word is None:
            return False
        trace = self.trace
        indices = trace.blocks.word_indices(word[1])
        rows = trace.run.row[indices]
        elsewhere = indices[(rows < self.loop.row[0]) | (rows > self.loop.row[-1])]
        return bool(np.any(np.abs(trace.run.words.value[elsewhere] - float(word[2])) < _SAME_NUMBER))

    def _row(self, corner: int) -> int:
        """The row of a block of the loop; behind the last one, that of the next move."""
        rows = self.loop.row
        if corner < len(rows):
            return int(rows[corner])
        last = int(rows[-1])
        following = np.flatnonzero(self.trace.path.travels[last + 1 :])
        return last + 1 + int(following[0]) if len(following) else last

    def _is_better(self, symmetry: Symmetry, trial: _Trial) -> bool:
        written, plain = self.written, trial.slip.plain
        if symmetry.corners < (_CORNERS if symmetry.is_turned else _MIRRORED_CORNERS):
            return False
        added = len(trial.point) - len(self.loop.point)
        if written is not None and symmetry.corners_behind_start < written.corners_behind_start + max(added, 0):
            return False
        if added > 0 and symmetry.order <= _HALF_TURN and symmetry.corners < _MANY_CORNERS:
            return False  # a rectangle with a lead comes again after half a turn with one block more
        before = 2 * symmetry.corners if written is None else written.freedom
        if before - symmetry.freedom < (_GAIN if plain or added else _GAIN_IF_UNSURE):
            return False
        if plain:
            return True
        is_meant = symmetry.is_turned and symmetry.mirrored and symmetry.corners >= _MANY_CORNERS
        sides_are_parallel = not added and self._keeps_directions(trial.point)
        return symmetry.is_turned and (not sides_are_parallel or (is_meant and trial.slip.is_common))

    def _keeps_directions(self, point: Points) -> bool:
        """No block leads in another direction: a side lies elsewhere, which may be meant."""
        written, moved = np.diff(self.loop.point), np.diff(point)
        changed = np.abs(written - moved) > self.tolerance
        aside = np.abs((written * moved.conj()).imag) / np.maximum(np.abs(written), 1e-9)
        return not bool((changed & (aside > self.tolerance)).any())

    # ---- one word ----

    @cached_property
    def _axes(self) -> tuple[AxisWords, AxisWords]:
        row = self.loop.row.copy()
        if row[0] == row[1]:
            row[0] = -1  # no move leads to the loop: the words of its first block are those of its end
        return axis_words(self.trace, row)

    def _of_words(self, places: Points) -> Iterator[_Trial]:
        """Words of which a slip explains that a point is not at one of these places."""
        point, tolerance = self.loop.point, self.tolerance
        tried: set[tuple[int, int, float]] = set()
        away = places[None, :] - point[:, None]
        for number, axis in enumerate(self._axes):
            local = away / axis.direction
            along = np.abs(local.imag) <= tolerance * 2
            for corner, target in np.argwhere(along & (np.abs(local.real) >= 2 * tolerance)).tolist():
                shift = float(local[corner, target].real)
                for begin in _writers(axis, corner):
                    key = (number, begin, round(shift, 2))
                    if key not in tried:
                        tried.add(key)
                        yield from self._changed(axis, begin, shift)

    def _of_odd_corner(self) -> Iterator[_Trial]:
        """The words of the one corner that is elsewhere than on the regular polygon of all the others."""
        point, axes, tolerance = self.loop.point, self._axes, self.tolerance
        for ring in islice(self.loop.rings, 1):
            if ring.bulge.any() or len(ring) < _ODD_OF:
                continue
            for polygon in regular_polygons(ring.corner, tolerance, missing=1):
                place = polygon[is_lonely(polygon, ring.corner, tolerance)]
                odd = ring.corner[is_lonely(ring.corner, polygon, tolerance)]
                if len(place) != 1 or len(odd) != 1:
                    continue
                for corner in np.flatnonzero(np.abs(point - odd[0]) <= tolerance).tolist():
                    away = [(complex(place[0] - point[corner]) / axis.direction).real for axis in axes]
                    words = [
                        (axis, int(axis.word[corner]), shift)
                        for axis, shift in zip(axes, away, strict=True)
                        if abs(shift) > tolerance
                    ]
                    if all(word >= 0 and not axis.is_step[corner] for axis, word, _ in words):
                        yield self._elsewhere(corner, complex(place[0]), words)

    def _elsewhere(self, corner: int, place: complex, words: list[tuple[AxisWords, int, float]]) -> _Trial:
        """The block with other words, and what follows it with them."""
        values, moved, texts = self.trace.run.words.value, self.loop.point.copy(), []
        for axis, word, shift in words:
            moved[corner : _next_word(axis, corner)] += shift * axis.direction
            value, step = float(values[word]) + shift / axis.scale[corner], 2 * self.tolerance / axis.scale[corner]
            texts.append(f"{axis.address}{self._as_elsewhere(axis, value, step)}")
        slip = Slip(" ".join(texts), "its corner alone is off the polygon of the others", False)
        return _Trial(corner, words[0][1] if len(words) == 1 else -1, slip, moved, self.loop)

    def _changed(self, axis: AxisWords, begin: int, shift: float) -> Iterator[_Trial]:
        """The word of a block so that its point moves by as much; nothing where no slip explains it."""
        slip = self._slip(axis, begin, shift)
        if slip is not None:
            end = begin + 1
            while end < len(axis.word) and (axis.word[end] < 0 or axis.is_step[end]):
                end += 1
            moved = self.loop.point.copy()
            moved[begin:end] += shift * axis.direction
            yield _Trial(begin, int(axis.word[begin]), slip, moved, self.loop)

    def _slip(self, axis: AxisWords, corner: int, shift: float) -> Slip | None:
        """The slip that shifts a word of an axis, or leaves it out."""
        trace, index, step = self.trace, int(axis.word[corner]), shift / float(axis.scale[corner])
        # A point at the wrong place gives a word more digits than the others have.
        least = float(trace.lengths.least_increment[self.loop.row[corner]])
        half = self.loop.last_digit.imag if axis is self._axes[1] else self.loop.last_digit.real
        tolerance = _DIGITS * max(2 * half / float(axis.scale[corner]), least)
        if index < 0:
            value = float((self.loop.point[corner] / axis.direction).real) / axis.scale[corner] + step
            return Slip(f"{axis.address}{self._as_elsewhere(axis, value, tolerance)}", "a word is missing", False)
        words = trace.run.words
        value = float(words.value[index])
        written = trace.run.text.source.excerpt(int(words.start[index]), int(words.end[index])).replace(" ", "")
        address = written[: len(written) - len(written.lstrip("ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz="))]
        slip = slip_of(written[len(address) :], value + step, tolerance)
        if slip is None and value and self._is_of_neighbor(axis, corner, tolerance):
            slip = Slip("", "it is that of the block beside it", False)
        if slip is None and axis is self._axes[1] and self._looks_like_angle(value, value * axis.scale[corner]):
            slip = Slip("", "it looks like an angle", False)
        if slip is None:
            return None
        return slip._replace(text=f"{address}{self._as_elsewhere(axis, value + step, tolerance, slip.text)}")

    def _is_of_neighbor(self, axis: AxisWords, corner: int, tolerance: float) -> bool:
        value = self.trace.run.words.value
        words = [axis.word[neighbor] for neighbor in (corner - 1, corner + 1) if 0 <= neighbor < len(axis.word)]
        return any(word >= 0 and abs(float(value[word] - value[axis.word[corner]])) <= tolerance for word in words)

    def _looks_like_angle(self, value: float, length: float) -> bool:
        """A number is one of the usual angles, and as a length twice as far out as any other point of the loop."""
        point = self.loop.point
        off_axis = np.abs(point)[np.abs(np.abs(point.imag) - abs(length)) > self.tolerance]
        is_usual = value % _PART_OF_TURN == 0 and 2 * _PART_OF_TURN <= abs(value) <= _FULL_TURN
        return bool(is_usual and len(off_axis) and abs(length) > 2 * off_axis.max())

    def _as_elsewhere(self, axis: AxisWords, value: float, tolerance: float, slip: str = "") -> str:
        """A value as another block of the loop has it, with the sign that it needs."""
        words = self.trace.run.words.value
        sizes = [abs(float(words[word])) for word in axis.word if word >= 0]
        near = [size for size in sizes if abs(size - abs(value)) <= tolerance]
        if near:
            return plain_number(float(np.copysign(min(near, key=lambda size: abs(size - abs(value))), value)))
        return slip or plain_number(round(value, 3))

    # ---- increments: what is wrong in one shifts all that follow ----

    def _of_steps(self) -> Iterator[_Trial]:
        """Incremental words and blocks with which the path would close."""
        axes, point = self._axes, self.loop.point
        count = len(point)
        steps = [step for step in range(1, count) if all(axis.is_step[step] or axis.word[step] < 0 for axis in axes)]
        if len(steps) < count / 2:
            return
        for first in range(min(_ENDS, count)):
            for last in range(count - 1, max(count - 1 - _ENDS, first + 2), -1):
                gap = complex(point[first] - point[last])
                if abs(gap) <= 2 * self.tolerance:
                    continue
                for step in steps:
                    if first < step <= last:
                        yield from self._closing(step, gap)

    def _closing(self, corner: int, gap: complex) -> Iterator[_Trial]:
        """Corrections of blocks of increments that close a gap: a word, the block once less, or one more block."""
        for axis in self._axes:
            local = gap / axis.direction
            if axis.word[corner] >= 0 and abs(local.imag) <= 2 * self.tolerance:
                yield from self._changed(axis, corner, local.real)
        point = self.loop.point
        if abs(point[corner] - point[corner - 1] + gap) <= 2 * self.tolerance and corner > 1:
            moved = point.copy()
            moved[corner:] += gap
            yield _Trial(corner, -1, Slip("", "it stands there twice", False), moved, self.loop)
        shifted = np.append(point[:corner], point[corner - 1 :] + gap)
        text = " ".join(
            f"{axis.step_address}{plain_number(round((gap / axis.direction).real / axis.scale[corner], 4))}"
            for axis in self._axes
            if abs((gap / axis.direction).real) > self.tolerance
        )
        yield _Trial(corner, -1, Slip(text, "a block is missing", False), shifted, self._with_edge(corner - 1, 0))

    # ---- one block ----

    def _of_blocks(self, places: Points) -> Iterator[_Trial]:
        """Blocks that are missing, each with one of these places for its end."""
        point = self.loop.point
        for first in range(_ENDS):
            yield self._with_block(len(point) - 1, complex(point[first]), 0)
        detour = np.abs(places[:, None] - point[:-1]) + np.abs(places[:, None] - point[1:]) - np.abs(np.diff(point))
        for index in range(len(places)):
            for corner in np.argsort(detour[index])[:_GAPS].tolist():
                for turns in dict.fromkeys((0, self._usual_arc[0])):
                    yield self._with_block(corner, complex(places[index]), turns)

    @cached_property
    def _usual_arc(self) -> tuple[int, float]:
        """The sense and the radius that most arcs of the loop have; 0 and NaN without arcs."""
        arc = self.loop.turns != 0
        if not arc.any():
            return 0, np.nan
        radius = np.where(np.isnan(self.loop.radius), np.abs(self.loop.to_center), self.loop.radius)[arc]
        senses = self.loop.turns[arc]
        kinds, count = np.unique(np.round(senses * radius, 2), return_counts=True)
        usual = float(kinds[np.argmax(count)])
        return (1 if usual > 0 else -1), float(radius[np.argmin(np.abs(senses * radius - usual))])

    def _with_edge(self, corner: int, turns: int) -> PlaneLoop:
        """The loop with one more line or usual arc behind a block."""
        loop = self.loop
        return loop._replace(
            turns=np.insert(loop.turns, corner, turns),
            radius=np.insert(loop.radius, corner, self._usual_arc[1] if turns else np.nan),
            to_center=np.insert(loop.to_center, corner, 0),
        )

    def _with_block(self, corner: int, point: complex, turns: int) -> _Trial:
        """One more line, or arc, behind a block."""
        moved, parts = self.loop.point.copy(), []
        for axis in self._axes:
            shift = ((point - moved[corner]) / axis.direction).real
            moved[corner + 1 : _next_word(axis, corner)] += shift * axis.direction
            value, tolerance = (
                (point / axis.direction).real / axis.scale[corner],
                2 * self.tolerance / axis.scale[corner],
            )
            parts.append(f"{axis.address}{self._as_elsewhere(axis, value, tolerance)}")
        if turns:
            machine, scale = self.trace.machine, float(self.trace.lengths.scale[self.loop.row[corner]])
            codes = machine.codes("arc_clockwise" if turns < 0 else "arc_counterclockwise")
            code = next(iter(codes), "G2" if turns < 0 else "G3")
            parts = [code, *parts, f"{machine.arcs.radius_word}{plain_number(round(self._usual_arc[1] / scale, 4))}"]
        slip = Slip(" ".join(parts), "a block is missing", False)
        return _Trial(corner + 1, -1, slip, np.insert(moved, corner + 1, point), self._with_edge(corner, turns))


def _remedy(slip: Slip) -> str:
    """What is to be written where."""
    remedy = f"with {slip.text}" if slip.text else "without it"
    return f"{remedy} in a block before it" if slip.text and "a block" in slip.kind else remedy


def _becomes(symmetry: Symmetry) -> str:
    """What the contour would be with a symmetry."""
    from polarcheck.geometry.shapes.shape import polygon_name

    if symmetry.is_regular:
        return f"it would be a regular {polygon_name(symmetry.corners)}"
    if symmetry.is_turned:
        return f"it would be the same after each {360 / symmetry.order:g} deg"
    return "it would be its own mirror image"


def _next_word(axis: AxisWords, corner: int) -> int:
    """The first block behind one that has a word of an axis; up to it all points have its coordinate."""
    end = corner + 1
    while end < len(axis.word) and axis.word[end] < 0:
        end += 1
    return end


def _writers(axis: AxisWords, corner: int) -> Iterator[int]:
    """The blocks whose word of an axis moves a point, and the block itself where it has none."""
    if axis.word[corner] < 0 and corner:
        yield corner
    for begin in range(corner, -1, -1):
        if axis.word[begin] >= 0:
            yield begin
            if not axis.is_step[begin]:
                return
