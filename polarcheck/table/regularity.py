"""Contours that are nearly regular, symmetric or repeated, and the word or block with which they would be."""

from __future__ import annotations

from collections.abc import Iterator
from functools import cached_property
from typing import NamedTuple

import numpy as np

from polarcheck.arrays import Columns, Floats, Mask, Points, Rows
from polarcheck.columns.filling import before
from polarcheck.columns.trace import Trace
from polarcheck.geometry.plane import arc_sweep
from polarcheck.geometry.regularity.places import each_once, missing_places
from polarcheck.geometry.regularity.rings import Ring, rings_in
from polarcheck.geometry.regularity.symmetry import Symmetry, symmetry_of
from polarcheck.machines.modal import Motion
from polarcheck.table.last_digit import half_of_last_digit
from polarcheck.table.slips import Slip, plain_number, slip_of
from polarcheck.time_limit import keep_time

#: Blocks of a loop that is looked at, and how much work is done in one file: the squares of these numbers together.
_FEWEST, _MOST, _WORK = 4, 400, 1_000_000
#: Corners of a contour of which a missing one is told, and of one that is only a mirror image of itself.
_CORNERS, _MIRRORED_CORNERS = 5, 6
#: Edges that are as long as another one, as a share of all, where a contour may be regular; and what is as long [mm].
_ALIKE, _AS_LONG = 0.4, 0.02
#: Least and greatest distance that counts as the same place [mm], in last digits.
_SAME, _SAME_AT_MOST, _DIGITS = 0.01, 0.03, 5
#: By how many numbers fewer a correction must say where all corners are: more where other designs differ so, too.
_GAIN, _GAIN_IF_UNSURE, _GAIN_OF_BLOCK = 4, 5, 4
#: Corrections that are tried for one loop.
_MOST_TRIALS = 60


class Correction(NamedTuple):
    """
    What makes a contour regular.

    row: of the block. word: the executed word that is wrong, -1 where a word or a block is missing. text: as it is to
    be written. why: the slip. becomes: what the contour is then.
    """

    row: int
    word: int
    text: str
    why: str
    becomes: Symmetry


class _Loop(NamedTuple):
    """
    One path in the polar plane, n blocks without a ramp between them.

    row: int[n + 1], the first of it is the block before. point: complex128[n + 1] [mm]. turns: int[n], -1, 0 or 1.
    radius: float64[n], R with its sign [mm], NaN without. to_center: complex128[n] [mm].
    """

    row: Rows
    point: Points
    turns: Rows
    radius: Floats
    to_center: Points
    tolerance: float


class Regularity(Columns, frozen=True):
    """Columns of one trace, one value per row."""

    trace: Trace

    @cached_property
    def _loops(self) -> list[_Loop]:
        """The loops that may be regular, each contour once in the order of the program."""
        trace = self.trace
        if not len(trace.mode.sections):
            return []
        motion = trace.axes.motion
        at_feed = (motion == Motion.LINE) | (motion == Motion.CW) | (motion == Motion.CCW)
        compensation = trace.compensation
        ramp = compensation.starts_up | compensation.cancels
        z = trace.path.z
        deeper = trace.path.moves_z & ~trace.path.travels & ~(z == before(z, trace.blocks.starts, np.nan))
        begins = ramp | trace.mode.enters | deeper | (trace.path.travels & ~at_feed)
        rows = np.flatnonzero(trace.path.on_plane & at_feed & ~ramp & ~np.isnan(trace.path.end + trace.path.start))
        if not len(rows):
            return []
        stretch = np.cumsum(begins)[rows]
        first = np.flatnonzero(np.diff(stretch, prepend=-1))
        count = np.diff(first, append=len(rows))
        fits = (count >= _FEWEST) & (count <= _MOST)
        if not fits.any():
            return []
        length = np.abs(trace.path.end[rows] - trace.path.start[rows])
        order = np.lexsort((length, stretch))
        near = (np.diff(length[order]) <= _AS_LONG) & (np.diff(stretch[order]) == 0)
        alike = np.zeros(len(rows), bool)
        alike[order] = np.append(near, False) | np.append(False, near)
        fits &= np.add.reduceat(alike, first, dtype=np.int64) >= _ALIKE * count
        return [*self._different(rows, first[fits], count[fits])]

    def _different(self, rows: Rows, first: Rows, count: Rows) -> Iterator[_Loop]:
        trace, work = self.trace, 0
        known: set[bytes] = set()
        half = np.abs(half_of_last_digit(trace)) if len(first) else np.zeros(0)
        to_center = None
        for begin, size in zip(first.tolist(), count.tolist(), strict=True):
            own = rows[begin : begin + size]
            point = np.append(trace.path.start[own[:1]], trace.path.end[own])
            motion = trace.axes.motion[own]
            turns = np.where(motion == Motion.CW, -1, np.where(motion == Motion.CCW, 1, 0)).astype(np.int64)
            key = np.round(point, 5).tobytes() + turns.tobytes()
            if key in known:
                continue
            known.add(key)
            work += size**2
            if work > _WORK:
                return
            radius, center = np.full(size, np.nan), np.zeros(size, np.complex128)
            if turns.any():
                if to_center is None:
                    to_center = np.nan_to_num(trace.path.center - trace.path.start, nan=0.0)
                    by_radius = trace.lengths.length_of(trace.machine.arcs.radius_word)
                radius, center = np.where(turns != 0, by_radius[own], np.nan), to_center[own]
            tolerance = float(np.clip(_DIGITS * half[own[0]], _SAME, _SAME_AT_MOST))
            yield _Loop(np.append(max(own[0] - 1, 0), own), point, turns, radius, center, tolerance)

    # ---- one word or block ----

    @cached_property
    def corrections(self) -> dict[int, Correction]:
        """By row what makes a contour regular."""
        found: dict[int, Correction] = {}
        for loop in self._loops:
            keep_time()
            correction = _Search(self.trace, loop).best()
            if correction is not None:
                found.setdefault(correction.row, correction)
        return found

    @cached_property
    def is_wrong(self) -> Mask:
        """Rows with a word that makes a contour irregular, or before which a block is missing."""
        return self.trace.blocks.mask_of(np.array(sorted(self.corrections), np.int64))

    @cached_property
    def wrong_words(self) -> Mask:
        """Per executed word: it makes a contour irregular."""
        words = [correction.word for correction in self.corrections.values() if correction.word >= 0]
        return self.trace.blocks.words_at(np.array(sorted(words), np.int64))


class _Axis(NamedTuple):
    """
    One axis of a loop, a value for each of its n + 1 points.

    word: the executed word in the row, -1 for none. is_step: that is incremental. scale: mm per unit of it.
    direction: where it points on the plane.
    """

    address: str
    word: list[int]
    is_step: list[bool]
    scale: list[float]
    direction: complex


class _Search:
    """Searches the correction of one loop."""

    def __init__(self, trace: Trace, loop: _Loop) -> None:
        self.trace, self.loop, self.tolerance = trace, loop, loop.tolerance
        self.written = max(
            (_symmetry(ring, self.tolerance) for ring in self._rings(loop.point)), key=_rank, default=None
        )

    def best(self) -> Correction | None:
        """The correction that leaves least free; None where the contour is as it should be, or is no such contour."""
        if self.written is not None and self.written.is_turned:
            return None
        point = each_once(self.loop.point, self.tolerance)
        if not 3 < len(point) <= _MOST:
            return None
        places = missing_places(point, self.tolerance)
        if not len(places):
            return None
        found: list[tuple[tuple[float, ...], Correction]] = []
        for trial, (why, moved, axis, at, word, text, plain) in enumerate(self._of_words(places)):
            if trial >= _MOST_TRIALS:
                break
            symmetry = self._after(moved)
            gain = _GAIN if plain else _GAIN_IF_UNSURE
            if symmetry is None or not self._is_better(symmetry, gain) or not (plain or symmetry.is_turned):
                continue
            row = int(self.loop.row[at])
            found.append(((symmetry.freedom, not plain, trial), Correction(row, word, text, why, symmetry)))
            del axis
        if not found:
            found = [*self._of_blocks(places)]
        return min(found, key=lambda one: one[0])[1] if found else None

    def _is_better(self, symmetry: Symmetry, gain: int) -> bool:
        before = 2 * symmetry.corners if self.written is None else self.written.freedom
        enough = symmetry.corners >= (_CORNERS if symmetry.is_turned else _MIRRORED_CORNERS)
        return enough and before - symmetry.freedom >= gain

    # ---- one word ----

    @cached_property
    def _axes(self) -> list[_Axis]:
        trace, rows = self.trace, self.loop.row
        linear = chr(trace.axes.linear_axis[rows[-1]])
        turn = complex(trace.path.frames.turn[rows[-1]]) if trace.path.frames is not None else 1 + 0j
        steps = {"X": "U", "Y": "V", "Z": "W"}
        virtual = trace.axes.virtual_addresses(int(rows[-1]))
        own = {int(row): at for at, row in enumerate(rows.tolist())}
        scale, x_factor = trace.lengths.scale, trace.lengths.x_factor
        of_virtual = 0.5 if trace.machine.polar.virtual_axis_programming == "diameter" else 1.0
        made = []
        for pair, direction in (((linear, steps.get(linear, "")), turn), (virtual, 1j * turn)):
            word, is_step = [-1] * len(rows), [False] * len(rows)
            for address in pair:
                if not address:
                    continue
                stepped = trace.modal.is_step(address) if address == pair[0] else None
                indices = trace.blocks.word_indices(address)
                low, high = np.searchsorted(trace.run.row[indices], (rows[0], rows[-1] + 1))
                for index in indices[low:high].tolist():
                    row = int(trace.run.row[index])
                    if row in own:
                        word[own[row]] = index
                        is_step[own[row]] = stepped is None or bool(stepped[row])
            factor = [float(scale[row] * (x_factor[row] if pair[0] == linear else of_virtual)) for row in rows.tolist()]
            made.append(_Axis(pair[0], word, is_step, factor, direction))
        return made

    def _of_words(self, places: Points) -> Iterator[tuple[str, Points, _Axis, int, int, str, bool]]:
        """Per word that a slip explains: the slip, the points after it, the axis, the block, the word, its text."""
        point, tolerance = self.loop.point, self.tolerance
        tried: set[tuple[int, int, float]] = set()
        away = places[None, :] - point[:, None]
        for number, axis in enumerate(self._axes):
            local = away / axis.direction
            along = np.abs(local.imag) <= tolerance * 2
            for at, place in np.argwhere(along & (np.abs(local.real) >= 2 * tolerance)).tolist():
                shift = float(local[at, place].real)
                for begin in self._writers(axis, at):
                    key = (number, begin, round(shift, 2))
                    if key in tried:
                        continue
                    tried.add(key)
                    slip = self._slip(axis, begin, shift)
                    if slip is not None:
                        moved = self._moved(axis, begin, shift)
                        yield slip.kind, moved, axis, begin, axis.word[begin], slip.text, slip.plain

    @staticmethod
    def _writers(axis: _Axis, at: int) -> Iterator[int]:
        """The blocks whose word of an axis moves a point, and the block itself where it has none."""
        if axis.word[at] < 0 and at:
            yield at
        for begin in range(at, -1, -1):
            if axis.word[begin] >= 0:
                yield begin
                if not axis.is_step[begin]:
                    return

    def _moved(self, axis: _Axis, begin: int, shift: float) -> Points:
        """The points with the word of a block changed."""
        end = begin + 1
        while end < len(axis.word) and (axis.word[end] < 0 or axis.is_step[end]):
            end += 1
        moved = self.loop.point.copy()
        moved[begin:end] += shift * axis.direction
        return moved

    def _slip(self, axis: _Axis, at: int, shift: float) -> Slip | None:
        """The slip that shifts a word of an axis, or leaves it out."""
        trace, index, step = self.trace, axis.word[at], shift / axis.scale[at]
        tolerance = 2 * self.tolerance / axis.scale[at]
        if index < 0:
            value = float((self.loop.point[at] / axis.direction).real) / axis.scale[at] + step
            return Slip(f"{axis.address}{self._as_elsewhere(axis, value, tolerance)}", "the word is missing", False)
        words = trace.run.words
        written = trace.run.text.source.excerpt(int(words.start[index]), int(words.end[index])).replace(" ", "")
        address = written[: len(written) - len(written.lstrip("ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz="))]
        value = float(words.value[index]) + step
        slip = slip_of(written[len(address) :], value, tolerance)
        if slip is None and abs(float(words.value[index])) and self._is_of_neighbor(axis, at, tolerance):
            slip = Slip("", "it is that of the block beside it", False)
        if slip is None:
            return None
        return slip._replace(text=f"{address}{self._as_elsewhere(axis, value, tolerance, slip.text)}")

    def _is_of_neighbor(self, axis: _Axis, at: int, tolerance: float) -> bool:
        value = self.trace.run.words.value
        beside = [axis.word[other] for other in (at - 1, at + 1) if 0 <= other < len(axis.word)]
        return any(word >= 0 and abs(float(value[word] - value[axis.word[at]])) <= tolerance for word in beside)

    def _as_elsewhere(self, axis: _Axis, value: float, tolerance: float, slip: str = "") -> str:
        """A value as another block of the loop has it, with the sign that it needs."""
        words = self.trace.run.words.value
        near = [abs(float(words[word])) for word in axis.word if word >= 0]
        near = [size for size in near if abs(size - abs(value)) <= tolerance]
        if near:
            return plain_number(np.copysign(min(near, key=lambda size: abs(size - abs(value))), value))
        return slip or plain_number(round(value, 3))

    # ---- one block ----

    def _of_blocks(self, places: Points) -> Iterator[tuple[tuple[float, ...], Correction]]:
        """The blocks that are missing."""
        point = self.loop.point
        detour = np.abs(places[:, None] - point[:-1]) + np.abs(places[:, None] - point[1:]) - np.abs(np.diff(point))
        trial = 0
        for place in range(len(places)):
            for at in np.argsort(detour[place])[:3].tolist():
                trial += 1
                if trial > _MOST_TRIALS:
                    return
                symmetry = self._with_block(at, complex(places[place]))
                if symmetry is None or not symmetry.is_turned or not self._is_better(symmetry, _GAIN_OF_BLOCK):
                    continue
                text = self._block(at, complex(places[place]))
                row = int(self.loop.row[at + 1])
                yield (symmetry.freedom, trial), Correction(row, -1, text, "a block is missing", symmetry)

    def _block(self, at: int, place: complex) -> str:
        parts = []
        for axis in self._axes:
            value = (place / axis.direction).real / axis.scale[at + 1]
            parts.append(f"{axis.address}{self._as_elsewhere(axis, value, 2 * self.tolerance / axis.scale[at + 1])}")
        return " ".join(parts)

    def _with_block(self, at: int, place: complex) -> Symmetry | None:
        """The symmetry with one more point behind a block."""
        moved = self.loop.point.copy()
        for axis in self._axes:
            shift = ((place - moved[at]) / axis.direction).real
            end = at + 1
            while end < len(axis.word) and axis.word[end] < 0:
                end += 1
            moved[at + 1 : end] += shift * axis.direction
        point = np.insert(moved, at + 1, place)
        loop = self.loop._replace(
            point=point,
            turns=np.insert(self.loop.turns, at, 0),
            radius=np.insert(self.loop.radius, at, np.nan),
            to_center=np.insert(self.loop.to_center, at, 0),
        )
        return max((_symmetry(ring, self.tolerance) for ring in _rings(loop, point)), key=_rank, default=None)

    # ---- rings ----

    def _rings(self, point: Points) -> Iterator[Ring]:
        return _rings(self.loop, point)

    def _after(self, point: Points) -> Symmetry | None:
        return max((_symmetry(ring, self.tolerance) for ring in self._rings(point)), key=_rank, default=None)


def _rank(symmetry: Symmetry) -> int:
    return 2 * symmetry.corners - symmetry.freedom


def _symmetry(ring: Ring, tolerance: float) -> Symmetry:
    return symmetry_of(ring, tolerance)


def _rings(loop: _Loop, point: Points) -> Iterator[Ring]:
    """The rings of a loop whose blocks end at other points."""
    return rings_in(point, _bulges(loop, point))


def _bulges(loop: _Loop, point: Points) -> Floats:
    """The tangent of a quarter of the sweep of each block, 0 for lines, NaN for arcs that are no circle."""
    bulge = np.zeros(len(loop.turns))
    arc = np.flatnonzero(loop.turns)
    if not len(arc):
        return bulge
    start, end, radius = point[arc], point[arc + 1], loop.radius[arc]
    half = np.abs(end - start) / 2
    with np.errstate(invalid="ignore"):
        by_radius = 2 * np.arcsin(np.minimum(half / np.abs(radius), 1.0))
    by_radius = np.where(half > np.abs(radius) + loop.tolerance, np.nan, by_radius)
    by_radius = np.where(radius < 0, 2 * np.pi - by_radius, by_radius)
    center = start + loop.to_center[arc]
    kind = np.where(loop.turns[arc] < 0, Motion.CW, Motion.CCW).astype(np.int16)
    by_center = np.abs(arc_sweep(start, end, center, kind))
    by_center = np.where(np.abs(np.abs(end - center) - np.abs(start - center)) > 2 * loop.tolerance, np.nan, by_center)
    sweep = np.where(np.isnan(radius), by_center, by_radius)
    bulge[arc] = loop.turns[arc] * np.tan(np.where(sweep < 6.2, sweep, np.nan) / 4)
    return bulge
