"""
Corners that the control makes in the mode at the end of a move: RND=, RNDM=, CHR= and CHF= of Siemens.

Sources: programming manual 840D 10.2004 (6FC5298-7AB00-0BP1) p. 4-72: RND is the radius, RNDM modal and ended by 0, CHF
the length of the chamfer, CHR its width in the direction of the move. 828D manual, chamfer and rounding: the word
stands in the block that leads to the corner; F is that of the block that leads away; a value that is too large is
reduced; no corner is made behind more than three blocks without a move. 808D user manual p. 112: of radius and chamfer
in one block only the radius is made.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import msgspec
import numpy as np

from polarcheck.columns.filling import fill_down
from polarcheck.columns.trace import Trace
from polarcheck.foundation.arrays import Floats, Mask, Rows
from polarcheck.geometry.made_corners import CornerPairs, leg_of_length
from polarcheck.geometry.plane_path import PlanePath
from polarcheck.geometry.tolerances import ROUNDING
from polarcheck.program.execution.run import MadeCorners, Remark, Run, with_rows_behind

#: Blocks without a move that may stand between the two moves of a corner.
_MOST_BETWEEN = 3
_NOT_BETWEEN_MOVES = "the corner is not one between two moves at feed on the polar plane"
_SIDE_CHANGES = "cutter compensation changes in the next move"
_NO_ROOM = "it is too large for the moves beside it, and how far the control reduces it is not known"
_BESIDE_ARC = "how the control lays a chamfer beside an arc is not known"
_BELOW_ZERO = "a size below 0 makes no corner"
_NOT_KNOWN = "a move beside it is not known"


class _Sizes(NamedTuple):
    """
    What the words say of the corner at the end of each row, float64[rows] [mm]; 0 where they say nothing.

    radius: R of an arc. leg, length: of a chamfer. is_modal: the row has no such word but a modal one.
    """

    radius: Floats
    leg: Floats
    length: Floats
    is_modal: Mask


def with_made_corners(trace: Trace) -> Run:
    """
    The run of the trace with a row for each corner that its words ask for; with a remark for each that is not made.

    trace: of the run without them.
    """
    sizes = _sizes(trace)
    wanted = trace.mode.in_polar & ((sizes.radius != 0) | (sizes.leg != 0) | (sizes.length != 0))
    rows = np.flatnonzero(wanted & trace.path.travels)
    following = _following(trace, rows)
    is_corner = following >= 0
    reasons = dict.fromkeys(np.flatnonzero(wanted & ~trace.path.travels & ~sizes.is_modal).tolist(), _NOT_BETWEEN_MOVES)
    reasons |= dict.fromkeys(rows[~is_corner & ~sizes.is_modal[rows]].tolist(), _NOT_BETWEEN_MOVES)
    rows, following = rows[is_corner], following[is_corner]
    chosen, corners, of_geometry = _made(trace, rows, following, sizes)
    reasons |= of_geometry
    run = msgspec.structs.replace(trace.run, remarks=(*trace.run.remarks, *_remarks(trace, reasons, sizes.is_modal)))
    if not chosen.any():
        return run
    return msgspec.structs.replace(
        with_rows_behind(run, rows[chosen]),
        corners=_columns(trace, rows[chosen], following[chosen], corners[chosen]),
    )


def _sizes(trace: Trace) -> _Sizes:
    blocks, lengths = trace.blocks, trace.lengths
    address = {kind: word for word, kind in trace.machine.arcs.made_corners.items()}

    def of(kind: str) -> Floats:
        return np.nan_to_num(lengths.length_of(address[kind])) if kind in address else np.zeros(len(trace))

    radius, modal, leg, length = (of(kind) for kind in ("radius", "modal-radius", "leg", "length"))
    sets_modal = blocks.has(address.get("modal-radius", "")) | blocks.starts
    in_force = fill_down(np.where(sets_modal, modal, 0.0), sets_modal, 0.0)
    is_modal = (radius == 0) & (leg == 0) & (length == 0)
    has_radius = radius != 0
    return _Sizes(
        np.where(is_modal, in_force, radius), np.where(has_radius, 0, leg), np.where(has_radius, 0, length), is_modal
    )


def _following(trace: Trace, rows: Rows) -> Rows:
    """The row of the move on the plane at feed that follows each of these; -1 where another move or none does."""
    path = trace.path
    moving = np.flatnonzero(path.moves & trace.mode.in_polar)
    following = np.append(moving, -1)[np.searchsorted(moving, rows, "right")]
    plain = path.cuts & ~path.moves_z & trace.axes.is_simulated
    is_pair = (following >= 0) & plain[rows] & plain[following]
    is_pair &= (trace.mode.section[rows] == trace.mode.section[following]) & (following - rows - 1 <= _MOST_BETWEEN)
    return np.where(is_pair, following, -1)


def _made(trace: Trace, rows: Rows, following: Rows, sizes: _Sizes) -> tuple[Mask, PlanePath, dict[int, str]]:
    """Which corners are made, all of them, and by row why one is not."""
    path, side = trace.path, trace.compensation.side
    before, after = path.moves_of(rows), path.moves_of(following)
    radius = np.where(sizes.radius[rows] != 0, sizes.radius[rows], np.nan)
    leg = np.where(sizes.leg[rows] != 0, sizes.leg[rows], leg_of_length(before, after, sizes.length[rows]))
    pairs = CornerPairs(before, after, radius, leg)
    made = pairs.made()
    at_end, at_start = pairs.cut_off(made)
    taken = np.zeros(len(trace))
    np.add.at(taken, rows, at_end)
    np.add.at(taken, following, at_start)
    fits = taken <= np.nan_to_num(path.length) + ROUNDING
    is_known = before.is_known & after.is_known & ~(path.shape_is_unknown[rows] | path.shape_is_unknown[following])
    is_chamfer = np.isnan(radius)
    choices = (
        (pairs.is_straight & is_known, ""),
        (~is_known, _NOT_KNOWN),
        ((radius < 0) | (leg < 0), _BELOW_ZERO),
        (side[rows] != side[following], _SIDE_CHANGES),
        (is_chamfer & (before.is_arc | after.is_arc), _BESIDE_ARC),
        (~(fits[rows] & fits[following]), _NO_ROOM),
    )
    reasons: dict[int, str] = {}
    for mask, reason in choices:
        for row in rows[mask].tolist():
            reasons.setdefault(row, reason)
    chosen = np.array([row not in reasons for row in rows.tolist()], bool)
    return chosen, made, {row: reason for row, reason in reasons.items() if reason}


def _columns(trace: Trace, rows: Rows, following: Rows, corners: PlanePath) -> MadeCorners:
    """The corners by the rows of the run that has them; rows, following: of the run without."""
    inserted = rows + np.arange(1, len(rows) + 1)
    first, second = (row + np.searchsorted(rows, row) for row in (rows, following))
    path = trace.path
    round_rows = np.concatenate((first, inserted, second))
    centers = np.concatenate((path.center[rows], corners.center, path.center[following]))
    is_round = ~np.isnan(centers)
    return MadeCorners(
        row=inserted,
        motion=corners.kind,
        following=second,
        ended=np.concatenate((first, inserted)),
        end=np.concatenate((corners.start, corners.end)),
        round=round_rows[is_round],
        center=centers[is_round],
    )


def _remarks(trace: Trace, reasons: dict[int, str], is_modal: Mask) -> Iterator[Remark]:
    kinds = trace.machine.arcs.made_corners
    of_row, modal = (
        np.sort(
            trace.blocks.word_indices(*(word for word, kind in kinds.items() if (kind == "modal-radius") == of_modal))
        )
        for of_modal in (False, True)
    )
    said = set[tuple[int, str]]()
    for row in sorted(reasons):
        words = modal if is_modal[row] else of_row
        index = int(words[np.searchsorted(trace.run.row[words], row, "right") - 1])
        word, block = trace.run.written(index), int(trace.run.block[row])
        if (block, word) not in said:
            said.add((block, word))
            yield Remark("corner-not-made", block, {"word": word, "reason": reasons[row]})
