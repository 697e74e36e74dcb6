"""
Programmed path in the polar plane to tool center path under cutter compensation: G41, G42, FANUC type C.

`programmed_path` has the blocks that move and what the control knows of them, `offset_vectors` the vectors at their
ends, `corner` the position of these; here they become moves. Compensation works in the X-C plane, before the path is
turned into X and C of the lathe (B-62764EN p. 51).
"""

from __future__ import annotations

import enum
from itertools import pairwise

import msgspec
import numpy as np
from numpy.typing import NDArray

from polarcheck.foundation.arrays import Floats, Mask, Points, Rows, States, column_at, mask_at
from polarcheck.foundation.states import Motion, plain
from polarcheck.geometry.cutter_compensation.offset_vectors import Vectors, end_vectors
from polarcheck.geometry.cutter_compensation.programmed_path import Method, Path, Programmed, fits, moving_rows
from polarcheck.geometry.plane_path import PlanePath
from polarcheck.geometry.tolerances import ROUNDING, ZERO

__all__ = ["Method", "Path", "Phase", "ToolPath", "tool_center_path"]

_NOWHERE = complex(np.nan, np.nan)
_KINDS = np.array([Motion.CW, Motion.LINE, Motion.CCW], dtype=np.int16)


@plain
class Phase(enum.IntEnum):
    """The four states around G41 ... G40; lines across corners, and arcs in a ramp, are run as in OFFSET."""

    CANCELLED = 0
    START_UP = 1
    OFFSET = 2
    CANCEL = 3


class ToolPath(PlanePath, frozen=True):
    """
    The moves of the tool center, and what the control would object to. An arc that ends where it starts is a full
    circle.

    Per move, k of them. row: int[k], into Path; the block whose F applies: a line across a corner belongs to the latter
    block. phase: int16[k]. corner: bool[k], a line or an arc that the control adds between two blocks. known: bool[k],
    False where a position or R is unknown and the move is therefore the programmed one.

    Per row of the Path, n of them, bool[n]. inside_arc_too_small: arc radius not above R on its inner side (PS0041).
    interferes: tool center would run against the program (PS0041). no_intersection: the offset curves do not meet at
    the inside corner at the row's end (PS0033). movement_missing: the vector at the row's end is perpendicular, and
    wrong, for want of a known next move. arc_center_on_path: center is the start or the end (PS0038).
    """

    row: Rows
    phase: States
    corner: Mask
    known: Mask
    inside_arc_too_small: Mask
    interferes: Mask
    no_intersection: Mask
    movement_missing: Mask
    arc_center_on_path: Mask


#: Least number of rows that are followed at once.
_PART = 16_384
#: What belongs to one block, in the order in which it is run.
_LEAD, _CORNER, _BLOCK, _TRAIL = range(4)


class _Moves(PlanePath, frozen=True):
    """Some moves of the tool center, columns as in ToolPath; `order` sorts them among all others."""

    order: Rows
    row: Rows
    phase: States
    known: Mask


class _Blocks(msgspec.Struct, frozen=True):
    """
    The programmed moves with compensation; all arrays of length m.

    entry, leave: where the tool center begins and ends the block proper. side, radius: as for Programmed, in an offset
    cancel those of the block before. in_mode: runs along the programmed path. known: entry and leave are. turning:
    1 CCW, -1 CW, 0 for a line and for what has become one.
    """

    entry: Points
    leave: Points
    side: Floats
    radius: Floats
    in_mode: Mask
    known: Mask
    turning: Floats


def tool_center_path(path: Path, method: Method | None = None) -> ToolPath:
    """
    Tool center path of all sections of a program.

    After everything to which the control would object, the path goes on as the programmer meant: with perpendicular
    vectors where no others are right, with a straight line for an arc that leaves no path to the tool.
    Raises nothing; what is unknown gives the programmed moves with `known` False.
    Source of the rules: FANUC 16/18-C lathe manual, 16i-LB B-63664EN p. 170-184, 30i B-63944EN-2 p. 146-158.
    """
    method = method or Method()
    parts: list[ToolPath] = []
    for first, end in pairwise(_parts(path.section)):
        part = _of_sections(path[first:end], method)
        parts.append(msgspec.structs.replace(part, row=part.row + first))
    if len(parts) == 1:
        return parts[0]
    return ToolPath.concatenated(parts)


def _parts(section: Rows) -> list[int]:
    """Where to part a path: sections know nothing of each other, and some at a time take less memory than all."""
    begins = np.flatnonzero(section[1:] != section[:-1]) + 1
    parts = [0]
    while len(section) - parts[-1] > _PART:
        next_ = begins[np.searchsorted(begins, parts[-1] + _PART) :]
        if not len(next_):
            break
        parts.append(int(next_[0]))
    return [*parts, len(section)]


def _of_sections(path: Path, method: Method) -> ToolPath:
    with np.errstate(all="ignore"):
        programmed, center_on_path = moving_rows(path, method)
        if not (programmed.on & ~np.isnan(programmed.radius)).any():
            return _as_programmed(programmed, center_on_path)
        vectors = end_vectors(programmed, method)
        blocks = _blocks(programmed, vectors)
        fitting = fits(programmed, np.arange(len(programmed.row)), blocks.side, blocks.radius)
        checked = blocks.in_mode & blocks.known
        reversed_ = checked & fitting & _runs_backwards(programmed, blocks)
        interferes = reversed_ & (method.interference != "ignore")
        if method.interference == "erase" and reversed_.any():
            vectors, interferes = _erase(programmed, vectors, blocks, reversed_)
            blocks = _blocks(programmed, vectors)
        blocks.turning[checked & (reversed_ | ~fitting)] = 0
        moves = _merged(
            _leads(programmed, blocks, vectors),
            _across_corners(programmed, vectors),
            _along(programmed, blocks),
            _trails(programmed, blocks),
        )

    def per_row(mask: Mask) -> Mask:
        return column_at(len(path.section), programmed.row, mask, False)

    return ToolPath(
        *moves.shape,
        row=moves.row,
        phase=moves.phase,
        corner=moves.order % 4 == _CORNER,
        known=moves.known,
        inside_arc_too_small=per_row(checked & ~fitting),
        interferes=per_row(interferes),
        no_intersection=per_row(vectors.apart),
        movement_missing=per_row(vectors.missing),
        arc_center_on_path=center_on_path,
    )


def _as_programmed(programmed: Programmed, center_on_path: Mask) -> ToolPath:
    """The path where nothing is compensated with a known R: the programmed moves, unknown where R would move them."""
    known = programmed.known & ~_begins_at_vector(programmed)
    sides = programmed.side, programmed.radius, _runs_in_mode(programmed)
    moves = _along(programmed, _Blocks(programmed.start, programmed.end, *sides, known, programmed.turning))
    corner, none = np.zeros(len(moves), bool), np.zeros(len(center_on_path), bool)
    faults = none, none, none, none, center_on_path
    return ToolPath(*moves.shape, moves.row, moves.phase, corner, moves.known, *faults)


def _runs_in_mode(programmed: Programmed) -> Mask:
    """Which blocks run along the programmed path, and are no ramps."""
    on, before_on, is_arc = programmed.on, programmed.before_on, programmed.is_arc
    return np.asarray((on & (before_on | is_arc)) | (before_on & ~on & is_arc))


def _blocks(programmed: Programmed, vectors: Vectors) -> _Blocks:
    """Where each block begins and ends once the vectors are known."""
    on, is_arc = programmed.on, programmed.is_arc
    cancels = programmed.before_on & ~on
    side, radius = programmed.side.copy(), programmed.radius.copy()
    before = np.flatnonzero(cancels) - 1
    side[cancels], radius[cancels] = side[before], radius[before]

    is_known = programmed.known & ~(on & ~vectors.known)
    entry, leave = programmed.start.copy(), np.where(on, vectors.first, programmed.end)
    joined = np.flatnonzero(_begins_at_vector(programmed))
    entry[joined] = vectors.last[joined - 1]
    is_known[joined] &= vectors.known[joined - 1]
    # G41 or G40 in a block with an arc (alarm 034) shifts the tool before or after the arc, which is run with R.
    rows = np.flatnonzero((programmed.shifts_at >= 0) | (on & ~programmed.before_on & is_arc))
    entry[rows] = programmed.start[rows] + 1j * side[rows] * radius[rows] * programmed.leaving[rows]
    rows = np.flatnonzero(cancels & is_arc)
    leave[rows] = programmed.end[rows] + 1j * side[rows] * radius[rows] * programmed.arriving[rows]
    rows = np.flatnonzero(programmed.left_over & ~on & is_arc)
    entry[rows] = programmed.start[rows]
    entry[~is_known], leave[~is_known] = programmed.start[~is_known], programmed.end[~is_known]
    return _Blocks(entry, leave, side, radius, _runs_in_mode(programmed), is_known, programmed.turning.copy())


def _begins_at_vector(programmed: Programmed) -> Mask:
    """Which blocks begin where the vectors of the block before end."""
    return (programmed.before_on & (programmed.shifts_at < 0)) | programmed.left_over


def _runs_backwards(programmed: Programmed, blocks: _Blocks) -> Mask:
    """
    Which blocks the tool center would run against the program: the vectors at their ends have passed each other.

    A line differs then by 90 to 270 degrees from the programmed one, the angle of an arc changes its sign
    (Tomatech TAC-100xt p. 169, as FANUC; Mitsubishi M700V p. 209).
    """
    result = ((blocks.leave - blocks.entry) * programmed.leaving.conj()).real < -ROUNDING
    arcs = np.flatnonzero(programmed.turning)
    result[arcs] = _arc_length(programmed, blocks, arcs) < -ROUNDING
    return np.asarray(result)


def _arc_length(programmed: Programmed, blocks: _Blocks, arcs: Rows) -> Floats:
    """Length [mm] of the tool center's arc, negative if it runs backwards."""
    center, turning = programmed.center[arcs], programmed.turning[arcs]
    start, end = programmed.start[arcs] - center, programmed.end[arcs] - center
    entry, leave = blocks.entry[arcs] - center, blocks.leave[arcs] - center
    sweep = np.mod(turning * np.angle(end / start), 2 * np.pi)
    sweep[programmed.full[arcs]] = 2 * np.pi
    sweep += turning * (np.angle(leave / end) - np.angle(entry / start))
    result: Floats = sweep * np.abs(leave)
    return result


def _erase(programmed: Programmed, vectors: Vectors, blocks: _Blocks, rows: Mask) -> tuple[Vectors, Mask]:
    """
    Drop the vectors that interfere, in pairs from the block outwards; the last one of a corner stays.

    Gives the vectors left and the blocks at which that does not help. FANUC 16i with No. 5008#3 CNV = 0.
    """
    used, point = vectors.used.copy(), vectors.point
    helpless = np.zeros_like(rows)
    joined = _begins_at_vector(programmed)
    for row in np.flatnonzero(rows):
        entry = list(np.flatnonzero(used[:, row - 1])) if joined[row] else []
        leave = list(np.flatnonzero(used[:, row]))
        chord = programmed.end[row] - programmed.start[row]
        while len(entry) > 1 or len(leave) > 1:
            if len(entry) > 1:
                used[entry.pop(), row - 1] = False
            if len(leave) > 1:
                used[leave.pop(0), row] = False
            start = point[entry[-1], row - 1] if entry else blocks.entry[row]
            end = point[leave[0], row] if leave else blocks.leave[row]
            if ((end - start) * chord.conj()).real >= -ROUNDING * abs(chord):
                break
        else:
            helpless[row] = True
    return msgspec.structs.replace(vectors, used=used), helpless


def _leads(programmed: Programmed, blocks: _Blocks, vectors: Vectors) -> _Moves:
    """Lines to the start of a block: to an arc, or at once at a G41 without movement (type C)."""
    at_once = programmed.shifts_at >= 0
    ramps = at_once | (programmed.on & ~programmed.before_on & programmed.is_arc)
    returns = programmed.left_over & ~programmed.on & programmed.is_arc
    leads = np.flatnonzero((ramps | returns) & blocks.known)
    start = programmed.start[leads]
    left_over = programmed.left_over[leads]
    start[left_over] = vectors.last[leads[left_over] - 1]
    row = np.where(at_once, programmed.shifts_at, programmed.row)[leads]
    phase = np.where(ramps[leads], Phase.START_UP, Phase.CANCEL)
    return _lines(leads * 4 + _LEAD, row, start, blocks.entry[leads], phase)


def _trails(programmed: Programmed, blocks: _Blocks) -> _Moves:
    """Lines from the end of a block: from an arc, or at once at a G40 without movement (type C)."""
    at_once = programmed.clears_at >= 0
    from_arc = programmed.before_on & ~programmed.on & programmed.is_arc
    trails = np.flatnonzero((at_once | from_arc) & blocks.known)
    row = np.where(at_once, programmed.clears_at, programmed.row)[trails]
    phase = np.full(len(trails), Phase.CANCEL)
    return _lines(trails * 4 + _TRAIL, row, blocks.leave[trails], programmed.end[trails], phase)


def _across_corners(programmed: Programmed, vectors: Vectors) -> _Moves:
    """The moves between the vectors of one corner; they belong to the latter block (M700V p. 193)."""
    several = np.flatnonzero((vectors.used.sum(axis=0) > 1) & vectors.known)
    corner, slot = np.nonzero(vectors.used.T[several])
    vector = vectors.point[slot, several[corner]]
    goes_on = corner[1:] == corner[:-1]
    joint = several[corner[1:][goes_on]]
    phase = np.full(len(joint), Phase.OFFSET)
    moves = _lines(
        (joint + 1) * 4 + _CORNER, programmed.row[joint + 1], vector[:-1][goes_on], vector[1:][goes_on], phase
    )
    joint = moves.order // 4 - 1
    rows = np.flatnonzero(vectors.round[joint])
    # On the outside of a corner the tool goes round it as the contour does: to the right where it is on the left.
    moves.kind[rows] = np.where(programmed.side[joint[rows]] > 0, Motion.CW, Motion.CCW)
    moves.center[rows] = programmed.end[joint[rows]]
    return moves


def _along(programmed: Programmed, blocks: _Blocks) -> _Moves:
    """The blocks themselves; those that R has used up are left out."""
    on, before_on = programmed.on, programmed.before_on
    returns = (before_on | programmed.left_over) & ~on & ~programmed.is_arc
    phase = np.full(len(on), Phase.CANCELLED, dtype=np.int16)
    phase[on & ~before_on] = Phase.START_UP
    phase[returns] = Phase.CANCEL
    phase[blocks.in_mode] = Phase.OFFSET

    length = np.abs(blocks.leave - blocks.entry)
    arcs = np.flatnonzero((blocks.turning != 0) & blocks.in_mode & blocks.known)
    closed = arcs[length[arcs] <= ZERO]
    length[arcs] = _arc_length(programmed, blocks, arcs)
    blocks.leave[closed] = blocks.entry[closed]
    kept = np.flatnonzero(~(length <= ZERO) | (programmed.full & ~(blocks.in_mode & blocks.known)))
    # A full circle and a bit more would be taken as that bit alone: it is run in two halves.
    whole = np.flatnonzero(programmed.full[kept])
    circle = kept[whole]
    round_ = 2 * np.pi * np.abs(blocks.leave[circle] - programmed.center[circle])
    apart = np.abs(blocks.leave[circle] - blocks.entry[circle]) > ZERO
    is_halved = blocks.in_mode[circle] & blocks.known[circle] & apart & (length[circle] > round_)
    halved = mask_at(len(kept), whole[is_halved])
    first = np.cumsum(halved + 1)[halved] - 2
    kept = np.repeat(kept, halved + 1)
    start, end, turning = blocks.entry[kept], blocks.leave[kept], blocks.turning[kept]
    end[first] = start[first + 1] = 2 * programmed.center[kept[first]] - start[first]
    return _Moves(
        order=kept * 4 + _BLOCK,
        row=programmed.row[kept],
        start=start,
        end=end,
        center=np.where(turning != 0, programmed.center[kept], _NOWHERE),
        kind=_KINDS[turning.astype(np.int16) + 1],
        phase=phase[kept],
        known=blocks.known[kept],
    )


def _lines(order: Rows, row: Rows, start: Points, end: Points, phase: NDArray[np.integer]) -> _Moves:
    """Lines added by the control; those of no length are left out."""
    kept = np.flatnonzero(np.abs(end - start) > ZERO)
    return _Moves(
        order=order[kept],
        row=row[kept],
        start=start[kept],
        end=end[kept],
        center=np.full(len(kept), _NOWHERE),
        kind=np.full(len(kept), Motion.LINE, dtype=np.int16),
        phase=phase[kept].astype(np.int16),
        known=np.ones(len(kept), dtype=np.bool_),
    )


def _merged(*parts: _Moves) -> _Moves:
    """All moves in the order in which they are run; those of each part are in it."""
    present = [part for part in parts if len(part)]
    if len(present) == 1:
        return present[0]
    moves = _Moves.concatenated(parts)
    return moves[np.argsort(moves.order, kind="stable")]
