"""
Which offset vectors cutter compensation sets up at the end of each move: FANUC type C, with lines at outside corners,
or with arcs or intersections there, as other controls have them.
"""

from __future__ import annotations

import msgspec
import numpy as np

from polarcheck.foundation.arrays import Mask, Points, Rows
from polarcheck.foundation.states import Corner
from polarcheck.geometry.cutter_compensation.corner import (
    STRAIGHT,
    Corners,
    is_inner,
    is_straight,
    meeting,
    squared_off,
    turn,
)
from polarcheck.geometry.cutter_compensation.programmed_path import Method, Programmed, fits
from polarcheck.geometry.tolerances import ROUNDING

#: The places that a vector can take at the end of a move, in the order in which the tool center passes them.
BEFORE, CORNER, ACROSS, AFTER = range(4)


class Vectors(msgspec.Struct, frozen=True):
    """
    Ends of the offset vectors at the end of each of m moves.

    point: complex128[4, m] [mm], by place. used: bool[4, m]; the columns of moves outside compensation have none.
    round: bool[m], the way from the first to the last vector is an arc about the corner.
    known: bool[m], False where a point or R is unknown. missing: bool[m], perpendicular only since the control does not
    know the next move in time. apart: bool[m], the two curves at an inside corner do not meet.
    """

    point: Points
    used: Mask
    round: Mask
    known: Mask
    missing: Mask
    apart: Mask

    @property
    def first(self) -> Points:
        """Where the move before ends."""
        return self._last_used(AFTER, ACROSS, CORNER, BEFORE)

    @property
    def last(self) -> Points:
        """Where the next move begins."""
        return self._last_used(BEFORE, CORNER, ACROSS, AFTER)

    def _last_used(self, otherwise: int, *slots: int) -> Points:
        """Per corner the point of the last of these slots that is used; that of another one without any."""
        result: Points = self.point[otherwise].copy()
        for slot in slots:
            np.copyto(result, self.point[slot], where=self.used[slot])
        return result


def end_vectors(programmed: Programmed, method: Method) -> Vectors:
    """The offset vectors at the end of each move made with compensation on."""
    count = len(programmed.row)
    vectors = Vectors(
        point=np.zeros((4, count), dtype=np.complex128),
        used=np.zeros((4, count), dtype=np.bool_),
        round=np.zeros(count, dtype=np.bool_),
        known=_are_known(programmed),
        missing=np.zeros(count, dtype=np.bool_),
        apart=np.zeros(count, dtype=np.bool_),
    )
    # Without a next move, or after a G40 alone, the vector is perpendicular to the last one (M700V manual p. 191).
    vectors.point[BEFORE] = programmed.end + 1j * programmed.side * programmed.radius * programmed.arriving
    vectors.used[BEFORE] = programmed.on
    if count > 1:
        _join(vectors, programmed, method)
    return vectors


def _are_known(programmed: Programmed) -> Mask:
    """A boolean per move: its vectors depend on nothing unknown."""
    alone = ~programmed.has_next | programmed.cancelled | ~programmed.read
    next_known = np.append(programmed.known[1:], False)
    return np.asarray(programmed.known & (alone | next_known))


class _Joints(msgspec.Struct, frozen=True):
    """
    What becomes of the end of each move but the last, bool[m - 1] each. Where none of the first four is set, the one
    vector is perpendicular to the move before.

    to_next: one vector, perpendicular to the move after. meets: one, where the two curves of the tool center meet.
    outer: an outside corner. changes: G41 to G42 or back, two perpendicular vectors.
    ramps_on, ramps_off: the move before is the start-up, the one after the cancel, and a line.
    """

    to_next: Mask
    meets: Mask
    outer: Mask
    changes: Mask
    ramps_on: Mask
    ramps_off: Mask


def _join(vectors: Vectors, programmed: Programmed, method: Method) -> None:
    """Fill in the vectors where a move goes on into the next one (FANUC 16/18-C lathe manual p. 224-232)."""
    joins = (programmed.on & programmed.has_next & ~programmed.cancelled & programmed.known)[:-1]
    joins &= programmed.known[1:] & (programmed.radius[:-1] > 0)
    if not joins.any():  # R is 0 or not known: each move ends perpendicular
        return
    slanted = _is_slanted(programmed)
    corners = _corners(programmed, slanted)
    turned = turn(corners)
    joints = _joints(programmed, joins, corners, turned, slanted, method)

    by_arc, by_curves = _other_corners(programmed, turned, joints, method)
    point = meeting(corners, turned, joints.meets | by_curves)
    by_arc |= by_curves & ~_leads_on(corners, point)
    by_curves &= ~by_arc
    by_lines = joints.outer & ~by_arc & ~by_curves
    meets = joints.meets & np.isfinite(point)
    # Without a common point G40 I J begins perpendicular; at an inside corner both vectors come nearest to the program.
    apart = joints.meets & ~meets & ~joints.ramps_off
    acute = by_lines & (turned.real < 0)
    before = by_arc | (joints.outer & joints.ramps_on) | (by_lines & (corners.turning_before != 0))
    before |= apart | joints.changes
    after = by_arc | (joints.outer & joints.ramps_off) | (by_lines & (corners.turning_after != 0))
    after |= apart | joints.changes | joints.to_next

    needs_next = joints.to_next | meets | joints.outer | apart
    read = programmed.read[:-1]
    small_turn = (np.abs(turned.imag) < np.sin(method.tangent_tolerance)) & (turned.real > 0)
    vectors.missing[:-1] = needs_next & ~read
    vectors.apart[:-1] = apart & read & corners.fits & ~small_turn

    set_up = read | joints.changes
    vectors.used[BEFORE, :-1] &= before | ~needs_next | ~read
    vectors.used[CORNER, :-1] = (meets | by_lines | by_curves) & set_up
    vectors.round[:-1] = by_arc & set_up
    vectors.used[ACROSS, :-1] = acute & set_up
    vectors.used[AFTER, :-1] = after & set_up

    vectors.point[CORNER, :-1] = point
    rows = np.flatnonzero(acute)
    vectors.point[CORNER, rows], vectors.point[ACROSS, rows] = squared_off(corners[rows])
    rows = np.flatnonzero(after)
    vectors.point[AFTER, rows] = _after(programmed, rows)


def _other_corners(programmed: Programmed, turned: Points, joints: _Joints, method: Method) -> tuple[Mask, Mask]:
    """
    Which outside corners are passed by an arc of R about the corner, and which where the two paths meet.

    A corner by intersection that is too sharp becomes an arc, one by an arc that is too flat an intersection
    (Siemens, function manual W1, machine data 20210 and 20230).
    """
    chosen = programmed.corner[1:]
    angle = np.abs(np.angle(turned))
    by_arc = joints.outer & (chosen == Corner.ARC) & (angle >= method.arc_from)
    by_arc |= joints.outer & (chosen == Corner.INTERSECTION) & (angle > method.arc_above + STRAIGHT)
    return by_arc, joints.outer & (chosen != Corner.LINES) & ~by_arc


def _leads_on(corners: Corners, point: Points) -> Mask:
    """A mask of the meeting points that lie ahead of the end of the move before, and before the start of the next."""
    ahead = (point - corners.point - corners.vector_before) * corners.arriving.conj()
    before_next = (corners.point + corners.vector_after - point) * corners.leaving.conj()
    return np.asarray(np.isfinite(point) & (ahead.real >= -ROUNDING) & (before_next.real >= -ROUNDING))


def _joints(
    programmed: Programmed, joins: Mask, corners: Corners, turned: Points, slanted: Mask, method: Method
) -> _Joints:
    """Sort the junctions; a radius of zero leaves the one perpendicular vector, of no length."""
    on, is_arc = programmed.on, programmed.is_arc
    # The manuals take the intersection of the two paths where there is one (FANUC 15i B-63324EN p. 405), builders ask
    # to cancel first: perpendicular to both moves is what controls do without an intersection, and is always near.
    changes = joins & on[1:] & (programmed.side[1:] != programmed.side[:-1])
    joins = joins & ~changes

    ramps_on = (~programmed.before_on & ~is_arc)[:-1]
    ramps_off = (~on & ~is_arc)[1:]
    slanted = joins & slanted
    inner = is_inner(corners, turned)
    # Type A, and inside also type B, has one vector at the contour's end of a ramp (M700V manual p. 177, 183).
    one_vector = inner | method.ramps_by_next
    # G41 in G41: perpendicular at the end of the block before (FANUC 30i B-63944EN-2 p. 158).
    repeats = programmed.written[:-1] & ~ramps_on & ~ramps_off
    perpendicular = is_straight(turned) | repeats | (ramps_off & ~ramps_on & one_vector)
    joins &= ~slanted & ~perpendicular
    to_next = joins & ramps_on & one_vector
    meets = slanted | (joins & inner & ~to_next)
    outer = joins & ~(to_next | meets)
    return _Joints(to_next, meets, outer, changes, ramps_on, ramps_off)


def _is_slanted(programmed: Programmed) -> Mask:
    """Cancels with I and J: they begin where the path cuts a line in that direction, offset alike (M700V p. 193)."""
    given = ~np.isnan(programmed.cancel_vector) & ~programmed.on & ~programmed.is_arc
    return np.asarray(given[1:] & (programmed.before_on | programmed.is_arc)[:-1])


def _corners(programmed: Programmed, slanted: Mask) -> Corners:
    """The junctions of each move but the last with the next one."""
    side, radius = programmed.side[:-1], programmed.radius[:-1]
    rows = np.arange(len(side))
    return Corners(
        point=programmed.end[:-1],
        arriving=programmed.arriving[:-1],
        leaving=np.where(slanted, programmed.cancel_vector[1:], programmed.leaving[1:]),
        center_before=programmed.center[:-1],
        center_after=programmed.center[1:],
        turning_before=programmed.turning[:-1],
        turning_after=programmed.turning[1:],
        fits=fits(programmed, rows, side, radius) & fits(programmed, rows + 1, side, radius),
        side=side,
        radius=radius,
    )


def _after(programmed: Programmed, rows: Rows) -> Points:
    """Perpendicular to the next move at the ends of these, with R as it was, on the side that the next move has."""
    after = rows + 1
    side = np.where(programmed.on[after], programmed.side[after], programmed.side[rows])
    result: Points = programmed.end[rows] + 1j * side * programmed.radius[rows] * programmed.leaving[after]
    return result
