"""The moves of a path with the blocks between them that stand still on the plane: Z alone, dwells."""

from __future__ import annotations

from typing import Any

import numpy as np
from msgspec.structs import replace

from polarcheck.columns.path.moves import Moves
from polarcheck.columns.path.path import NOWHERE
from polarcheck.columns.trace import Trace
from polarcheck.foundation.arrays import Mask, Rows
from polarcheck.foundation.states import Motion
from polarcheck.geometry.cutter_compensation.offset_path import Phase


def with_z_alone(trace: Trace, moves: Moves) -> tuple[Moves, Rows]:
    """Insert the blocks of polar sections that move Z alone. Return the moves, and the number of each, -1 for those."""
    return with_standing(trace, moves, (trace.mode.section >= 0) & trace.path.moves_z & ~trace.path.travels)


def with_standing(trace: Trace, moves: Moves, standing: Mask) -> tuple[Moves, Rows]:
    """
    Insert rows in which the tool stands still on the plane, as of Z alone. Return the moves, and the number of each.

    standing: bool[rows of the trace]. An inserted move ends at the point where it starts; its number is -1.
    """
    row = np.flatnonzero(standing & ~trace.blocks.mask_of(moves.row))
    if not len(row):
        return moves, np.arange(len(moves))
    # Each pass of an infeed cycle runs over the same rows again.
    insertion = np.searchsorted(np.maximum.accumulate(moves.row), row)
    last = np.append(moves.end, complex(np.nan, np.nan))[insertion - 1]
    follows = np.append(moves.section, -1)[insertion - 1] == trace.mode.section[row]
    point = np.where(follows, last, trace.path.end[row])
    off = np.where(trace.compensation.compensates[row], Phase.OFFSET, Phase.CANCELLED)
    is_known = np.append(moves.known, True)[insertion - 1]
    still: dict[str, Any] = {
        "row": row,
        "section": trace.mode.section[row],
        "kind": np.int16(Motion.LINE),
        "start": point,
        "end": point,
        "center": NOWHERE,
        "feed": trace.feedrate.feed[row],
        "rise": 0.0,
        "arc_share": 1.0,
        "known": np.where(follows, is_known, True) & ~np.isnan(point),
        "phase": off,
        "corner": False,
        "allowance": 0.0,
    }
    columns = {name: np.insert(getattr(moves, name), insertion, values) for name, values in still.items()}
    return replace(moves, **columns), np.insert(np.arange(len(moves)), insertion, -1)
