"""The one word or block of a loop with which its contour would be regular, symmetric, or closed."""

from __future__ import annotations

from collections.abc import Hashable, Iterator
from itertools import islice
from typing import NamedTuple

import msgspec
import numpy as np

from polarcheck.columns.contour.correction import Correction
from polarcheck.columns.contour.likely_edits import (
    AS_LIKELY,
    Compared,
    Likely,
    all_compared,
    correction_by,
    likely_outlines,
    likely_pairs,
)
from polarcheck.columns.contour.loop_edits import Edit, outlines_of, with_edit
from polarcheck.columns.contour.plane_loops import PlaneLoop
from polarcheck.columns.contour.written_loop import AxisWords, WrittenLoop, written_loop
from polarcheck.columns.trace import Trace
from polarcheck.columns.words.slips import Slip, parts_of, plain_number, slip_of, slips_of
from polarcheck.foundation.arrays import Mask, Points, Rows, cached_property
from polarcheck.geometry.regularity.coincidences import Outlines, are_about_axis
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
#: Edits that are looked at; how much less they must leave to chance, without and with symmetry; blocks of such a path.
_MOST_EDITS, _LEAST_GAIN, _GAIN_ALONE, _FEWEST_BLOCKS = 16, 0.5, 3.8, 6
#: Arcs that are parts of one circle by no chance.
_FEWEST_ARCS = 2
#: Pairs of edits that are looked at, and the gain of both together.
_MOST_PAIRS, _GAIN_OF_TWO = 4, 4.0
#: The gain of a slip that is often made, and makes all arcs tangent.
_GAIN_IF_COMMON = 3.0
#: Sine of the turn at a point within a straight side.
_STRAIGHT = 0.002
#: The gain with more symmetry, by which so many numbers more are fixed.
_GAIN_IN_SYMMETRY, _LEAST_FIXED = 2.4, 3


class _Trial(NamedTuple):
    """A correction that is tried: the number of the block in the loop, the slip, and where the blocks end with it."""

    at: int
    word: int
    slip: Slip
    point: Points
    loop: PlaneLoop


class Corrections(NamedTuple):
    """
    What may be meant instead of a contour.

    symmetric: that makes it symmetric, or two that do so together. likely: that makes it more regular and counts only
    where no rule objects.
    """

    symmetric: tuple[Correction, ...]
    likely: Correction | None

    def moved(self, rows: int, words: int) -> Corrections:
        """The same so many rows and words later."""
        symmetric = tuple(correction.moved(rows, words) for correction in self.symmetric)
        return Corrections(symmetric, self.likely and self.likely.moved(rows, words))


def corrections_of(
    trace: Trace, loop: PlaneLoop, written: Symmetry | None, known: dict[Hashable, Corrections]
) -> Corrections:
    """
    The corrections of a contour; None where it is as it should be, or is no such contour.

    written: its symmetry as it is written. known: those of contours of the file that are written in the same words in
    the same lines, by these words; rows and words are counted from the first ones of the contour.
    """
    search = _Search(trace, loop, written)
    row, word, key = search.content
    if key not in known:
        best = search.best()
        symmetric = search.of_two_words() if best is None else (best,)
        known[key] = Corrections(symmetric, None if symmetric else search.likely).moved(-row, -word)
    return known[key].moved(row, word)


class _Search:
    def __init__(self, trace: Trace, loop: PlaneLoop, written: Symmetry | None) -> None:
        self.trace, self.loop, self.tolerance, self.written = trace, loop, loop.tolerance, written
        self.likely: Correction | None = None

    def best(self) -> Correction | None:
        point = each_once(self.loop.point, self.tolerance)
        if len(point) < _CORNERS - 1:
            return None
        edit = self._of_edits()
        if edit is not None and edit[0].order > _HALF_TURN:
            return edit[1]
        # The ends of leads are no corners, and where leads cross is one.
        rings = (ring.corner for ring in islice(self.loop.rings, 1))
        missing = [missing_places(points, self.tolerance) for points in (point, point[1:-1], *rings)]
        places = each_once(np.concatenate(missing), self.tolerance)
        trials = [*self._fitting(self._of_places(places))]
        if edit is not None:
            return min([(edit[0].freedom, -1, edit[1]), *trials], key=lambda trial: trial[:2])[2]
        trials = trials or [*self._fitting(self._of_steps())] or [*self._fitting(self._of_odd_corner())]
        trials = trials or ([*self._fitting(self._of_blocks(places))] if len(places) else [])
        return min(trials, key=lambda trial: trial[:2])[2] if trials else None

    def _fitting(self, trials: Iterator[_Trial]) -> Iterator[tuple[int, int, Correction]]:
        """The trials that make the contour regular: what they leave free, their number, the correction."""
        for number, trial in enumerate(islice(trials, _MOST_TRIALS)):
            # Where one block more leaves an arc that is none, it goes round that.
            if len(trial.point) > len(self.loop.point) and np.isnan(trial.loop.bulges(trial.point)).any():
                continue
            symmetry = trial.loop.symmetry(trial.point)
            if symmetry is not None and self._is_better(symmetry, trial):
                row, slip = self._row(trial.at), trial.slip
                remedy, becomes = _remedy(slip), _becomes(symmetry)
                yield symmetry.freedom, number, Correction(row, trial.word, slip.text, slip.kind, remedy, becomes)

    def _row(self, corner: int) -> int:
        """The row of a block of the loop; behind the last one, that of the next move."""
        rows = self.loop.row
        if corner < len(rows):
            return int(rows[corner])
        last = int(rows[-1])
        following = np.flatnonzero(self.trace.path.travels[last + 1 :])
        return last + 1 + int(following[0]) if len(following) else last

    def _row_of(self, edit: Edit) -> int:
        return int(self.trace.run.row[edit.words[0]]) if edit.words else self._row(edit.corner)

    def _is_better(self, symmetry: Symmetry, trial: _Trial) -> bool:
        written, plain = self.written, trial.slip.plain
        if symmetry.corners + symmetry.arcs < (_CORNERS if symmetry.is_turned else _MIRRORED_CORNERS):
            return False
        added = len(trial.point) - len(self.loop.point)
        if written is not None and symmetry.corners < written.corners_behind_start + max(added, 0):
            return False
        if added > 0 and symmetry.order <= _HALF_TURN and symmetry.corners < _MANY_CORNERS:
            return False  # a rectangle with a lead comes again after half a turn with one block more
        # Where a wrong point lies on another one, the most regular ring of the path is a part of it.
        absent = symmetry.corners if written is None else symmetry.corners - max(added, 0) - written.corners
        before = 2 * max(absent, 0) + (symmetry.arcs if written is None else written.freedom)
        if before - symmetry.freedom < (_GAIN if plain or added else _GAIN_IF_UNSURE):
            return False
        if plain:
            return True
        is_meant = symmetry.is_turned and symmetry.mirrored and symmetry.corners >= _MANY_CORNERS
        sides_are_parallel = not added and self._keeps_directions(trial.point)
        return symmetry.is_turned and (not sides_are_parallel or (is_meant and trial.slip.is_common))

    def _is_more_symmetric(self, symmetry: Symmetry) -> bool:
        """More turns and mirrors leave the contour as it is, and it has all of its corners."""
        written = self.written
        if written is None or symmetry.corners < written.corners_behind_start:
            return False
        return written.images < symmetry.images and written.freedom - symmetry.freedom >= _LEAST_FIXED

    def _keeps_directions(self, point: Points) -> bool:
        """No block leads in another direction: a side lies elsewhere, which may be meant."""
        written, moved = np.diff(self.loop.point), np.diff(point)
        changed = np.abs(written - moved) > self.tolerance
        aside = np.abs((written * moved.conj()).imag) / np.maximum(np.abs(written), 1e-9)
        return not bool((changed & (aside > self.tolerance)).any())

    @cached_property
    def _row_of_points(self) -> Rows:
        """The rows of the points; no move leads to the loop where the words of its first block are those of its end."""
        row = self.loop.row.copy()
        if row[0] == row[1]:
            row[0] = -1
        return row

    @cached_property
    def _written(self) -> WrittenLoop:
        return written_loop(self.trace, self._row_of_points)

    @property
    def _axes(self) -> tuple[AxisWords, AxisWords]:
        return self._written.axes

    @property
    def content(self) -> tuple[int, int, Hashable]:
        """The first row and word of the loop, and all that its corrections depend on, but for what no edit changes."""
        trace, loop, written = self.trace, self.loop, self._written
        words = np.concatenate([*(axis.word for axis in written.axes), written.code, *written.arc_words.values()])
        row, word = int(loop.row[1]), int(words.min(where=words >= 0, initial=len(trace.run.words.value)))
        columns = (
            np.where(words >= 0, words - word, -1),
            loop.row - row,
            self._row(len(loop.row)) - row,
            trace.blocks.line[loop.row],
            trace.lengths.scale[loop.row],
            *(part for axis in written.axes for part in (axis.scale, axis.direction, axis.value, axis.is_step)),
            *(written.start, written.turns, written.radius, written.to_center, written.tolerance),
            *(loop.point, loop.turns, loop.radius, loop.to_center, loop.last_digit),
        )
        texts = (
            *(trace.run.written(index) for index in words[words >= 0].tolist()),
            *(axis.address for axis in self._axes),
        )
        return row, word, (*texts, *(np.asarray(column).tobytes() for column in columns))

    # ---- one edit ----

    @cached_property
    def _compared(self) -> Compared:
        return all_compared(self.trace, self._written)

    def _of_edits(self) -> tuple[Symmetry, Correction] | None:
        """The likeliest edit that makes the contour symmetric; where one in another block is as likely, with that."""
        # Where sides are divided, the number of different lengths tells nothing.
        may_be_likely = not _are_within_sides(self.loop.point, self.loop.turns).any()
        found: list[tuple[Likely, Correction, Symmetry]] = []
        best = -1
        for likely, outline in likely_outlines(self._compared, _MOST_EDITS, _LEAST_GAIN):
            if best >= 0 and found[best][0].gain - likely.gain > AS_LIKELY:
                break
            edit = likely.edit
            point, turns, radius, to_center = (part[0] for part in outline)
            edited = msgspec.structs.replace(self.loop, turns=turns, radius=radius, to_center=to_center)
            moves_side = not edit.is_of_pen and self._keeps_directions(point)
            slip = Slip(edit.text, edit.why, edit.is_plain and not moves_side, edit.is_common)
            symmetry = edited.symmetry(point)
            if symmetry is None:
                continue
            found.append((likely, correction_by(likely, self._row_of(edit)), symmetry))
            is_symmetric = self._is_better(symmetry, _Trial(edit.corner, -1, slip, point, edited))
            if best < 0 and is_symmetric and edit.kind not in {"arc", "sense"}:
                best = len(found) - 1
            elif may_be_likely and self.likely is None:
                is_clear = is_symmetric or self._is_clear(likely, symmetry, moves_side) or self._rounds(likely, outline)
                self.likely = found[-1][1] if is_clear else None
        if best < 0:
            return None
        chosen, correction, symmetry = found[best]
        for likely, other, another in found:
            if likely.edit.corner != chosen.edit.corner and another.images >= symmetry.images:
                line = int(self.trace.blocks.line[other.row])
                correction = correction._replace(remedy=f"{correction.remedy}, or {other.remedy} in line {line},")
                break
        return symmetry, correction._replace(becomes=_becomes(symmetry))

    def _is_clear(self, likely: Likely, symmetry: Symmetry, moves_side: bool) -> bool:
        """An edit closes the contour, or makes all its arcs tangent or the contour more symmetric, and is no chance."""
        if not moves_side and likely.gain >= _GAIN_IN_SYMMETRY and self._is_more_symmetric(symmetry):
            return True
        is_whole = likely.smooths or (likely.closes and self.written is None)
        least = _GAIN_IF_COMMON if likely.smooths and likely.edit.is_common else _GAIN_ALONE
        return is_whole and likely.gain >= least and len(self.loop.turns) >= _FEWEST_BLOCKS

    def _rounds(self, likely: Likely, outline: Outlines) -> bool:
        """With a word that does not move all of them alike all arcs by R, two or more, are parts of the bar."""
        arcs, by_center = outline.turns[0] != 0, np.isnan(outline.radius[0])
        if likely.gain < _GAIN_ALONE or likely.edit.kind != "word" or (arcs & by_center).any() or not arcs.any():
            return False
        shift = (outline.point - self._compared.outlines.point)[0]
        if (np.abs(np.append(shift[:-1][arcs], shift[1:][arcs]) - shift[1:][arcs][0]) <= self.tolerance).all():
            return False
        now, then = (are_about_axis(one, self.tolerance)[0, arcs] for one in (self._compared.outlines, outline))
        return bool(len(then) >= _FEWEST_ARCS and then.all() and not now.all())

    # ---- one corner ----

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
                yield from self._of_crossed_leads(complex(place[0]), complex(odd[0]))
                for corner in np.flatnonzero(np.abs(point - odd[0]) <= tolerance).tolist():
                    away = [(complex(place[0] - point[corner]) / axis.direction).real for axis in axes]
                    words = [
                        (axis, int(axis.word[corner]), shift)
                        for axis, shift in zip(axes, away, strict=True)
                        if abs(shift) > tolerance
                    ]
                    if all(word >= 0 and not axis.is_step[corner] for axis, word, _ in words):
                        yield self._elsewhere(corner, words)

    def _of_crossed_leads(self, place: complex, odd: complex) -> Iterator[_Trial]:
        """The outer ends of the first and the last line, of which one crosses the other elsewhere than at a place."""
        point = self.loop.point
        if (np.abs(point - odd) <= self.tolerance).any():
            return
        last = len(point) - 1
        for corner, inner in ((0, 1), (last, last - 1)):
            side = place - complex(point[inner])
            for axis in self._axes:
                across = (axis.direction.conjugate() * side).imag
                word = int(axis.word[corner])
                if word < 0 or axis.is_step[corner] or abs(across) <= _STRAIGHT * abs(side):
                    continue
                shift = (complex(point[inner] - point[corner]).conjugate() * side).imag / across
                needed = float(self.trace.run.words.value[word]) + shift / axis.scale[corner]
                address, number = parts_of(self.trace.run.written(word))
                slip = slip_of(number, needed, self.tolerance / axis.scale[corner])
                if slip is not None:
                    moved = point.copy()
                    moved[corner] += shift * axis.direction
                    yield _Trial(corner, word, slip._replace(text=address + slip.text), moved, self.loop)

    def of_two_words(self) -> tuple[Correction, ...]:
        """The two words with which the contour comes again in turns and mirrors."""
        for pair in likely_pairs(self.trace, self._compared, _MOST_PAIRS, _LEAST_GAIN):
            one, two = pair
            is_of_words = all(likely.edit.kind == "word" for likely in pair)
            if not is_of_words or one.gain + two.gain < _GAIN_OF_TWO:
                continue
            outline = outlines_of(with_edit(self._written, one.edit), [two.edit])
            point, turns, radius, to_center = (part[1] for part in outline)
            edited = msgspec.structs.replace(self.loop, turns=turns, radius=radius, to_center=to_center)
            symmetry = edited.symmetry(point)
            if symmetry is None or symmetry.order <= _HALF_TURN or not symmetry.mirrored:
                continue
            if symmetry.corners + symmetry.arcs >= _CORNERS:
                first, second = (correction_by(likely, self._row_of(likely.edit)) for likely in pair)
                line, becomes = int(self.trace.blocks.line[second.row]), _becomes(symmetry)
                remedy = f"{first.remedy}, and {second.remedy} in line {line},"
                return first._replace(remedy=remedy, becomes=becomes), second._replace(becomes=becomes)
        return ()

    def _of_places(self, places: Points) -> Iterator[_Trial]:
        """Blocks with one other word, each with one of these places for its end."""
        for place in places.tolist():
            for corner in range(len(self.loop.point)):
                if (trial := self._slip(corner, place)) is not None:
                    yield trial._replace(slip=trial.slip._replace(plain=False))

    def _slip(self, corner: int, place: complex) -> _Trial | None:
        """The block with the one other word that leads it to a place, if it is a slip of the pen."""
        away = [((place - self.loop.point[corner]) / axis.direction).real for axis in self._axes]
        words = [(axis, int(axis.word[corner]), shift) for axis, shift in zip(self._axes, away, strict=True)]
        words = [(axis, word, shift) for axis, word, shift in words if abs(shift) > self.tolerance]
        if len(words) != 1 or words[0][1] < 0 or words[0][0].is_step[corner]:
            return None
        trial = self._elsewhere(corner, words)
        written, needed = (parts_of(text)[1] for text in (self.trace.run.written(words[0][1]), trial.slip.text))
        if not (written and needed):
            return None
        slip = next((slip for slip in slips_of(written) if float(slip.text) == float(needed)), None)
        if corner and float(written) == words[0][0].value[corner - 1]:
            slip = Slip("", "it is that of the block before it", False)
        return None if slip is None else trial._replace(slip=slip._replace(text=trial.slip.text))

    def _elsewhere(self, corner: int, words: list[tuple[AxisWords, int, float]]) -> _Trial:
        """The block with other words, and what follows it with them."""
        values, moved, texts = self.trace.run.words.value, self.loop.point.copy(), []
        for axis, word, shift in words:
            moved[corner : _next_word(axis, corner)] += shift * axis.direction
            value, step = float(values[word]) + shift / axis.scale[corner], 2 * self.tolerance / axis.scale[corner]
            texts.append(f"{axis.address}{self._as_elsewhere(axis, value, step)}")
        slip = Slip(" ".join(texts), "its corner alone is off the polygon of the others", False)
        return _Trial(corner, words[0][1] if len(words) == 1 else -1, slip, moved, self.loop)

    def _as_elsewhere(self, axis: AxisWords, value: float, tolerance: float) -> str:
        """A value as another block of the loop has it, with the sign that it needs."""
        words = self.trace.run.words.value
        sizes = [abs(float(words[word])) for word in axis.word if word >= 0]
        near = [size for size in sizes if abs(size - abs(value)) <= tolerance]
        if near:
            return plain_number(float(np.copysign(min(near, key=lambda size: abs(size - abs(value))), value)))
        return plain_number(round(value, 3))

    # ---- increments: what is wrong in one shifts all that follow ----

    def _of_steps(self) -> Iterator[_Trial]:
        """Blocks of increments that are missing, or there twice, with which the path would close."""
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
        """The path with a block once less, or with one more block before it, if that closes the gap."""
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
                    trial = self._with_block(corner, complex(places[index]), turns)
                    if not self._flattens(trial):
                        yield trial

    def _flattens(self, trial: _Trial) -> bool:
        """A corner beside the additional block lies on a straight side then: nobody wrote a corner of no use."""
        is_within = np.append(_are_within_sides(trial.point, trial.loop.turns), [False, False])
        return bool(is_within[[trial.at - 2, trial.at]].any())

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
        return msgspec.structs.replace(
            loop,
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


def _are_within_sides(point: Points, turns: Rows) -> Mask:
    """Points but for the first and the last at which two lines go straight on, bool[n - 2]."""
    step = np.diff(point)
    turn = step[:-1].conj() * step[1:]
    is_straight = np.abs(turn.imag) <= _STRAIGHT * np.abs(turn)
    return np.asarray(is_straight & (turn.real > 0) & (turns[:-1] == 0) & (turns[1:] == 0))


def _remedy(slip: Slip) -> str:
    """What is to be written where."""
    remedy = f"with {slip.text}" if slip.text else "without it"
    return f"{remedy} in a block of its own before this one," if slip.text and "a block" in slip.kind else remedy


def _becomes(symmetry: Symmetry) -> str:
    """What the contour would be with a symmetry."""
    from polarcheck.geometry.shapes.shape import polygon_name

    if symmetry.is_regular:
        return f"it would be a regular {polygon_name(symmetry.corners)}"
    if symmetry.is_turned:
        return f"it would look the same after each turn of {360 / symmetry.order:g} deg"
    return "it would be its own mirror image"


def _next_word(axis: AxisWords, corner: int) -> int:
    """The first block behind one that has a word of an axis; up to it all points have its coordinate."""
    end = corner + 1
    while end < len(axis.word) and axis.word[end] < 0:
        end += 1
    return end
