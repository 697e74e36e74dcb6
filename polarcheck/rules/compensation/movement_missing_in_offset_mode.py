from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.rules.causes import OUT_OF_PLACE
from polarcheck.rules.rule import WARNING, rule

if TYPE_CHECKING:
    from polarcheck.columns.path.compensation import CutterCompensation
    from polarcheck.columns.path.ramps import Ramps
    from polarcheck.columns.path.tool_center import ToolCenter
    from polarcheck.foundation.arrays import Mask
    from polarcheck.rules.hit import Details, Hit
    from polarcheck.rules.rule import Needs


@rule(
    WARNING,
    "{why}; the tool center ends perpendicular to {move_before}, not where the next one needs it",
    values=("blocks", "limit"),
    worse=("blocks",),
    gouges=True,
    doubts=(("metal", "pause"),),
    follows={"pause": (*OUT_OF_PLACE, "full-circle-by-radius"), "way": OUT_OF_PLACE},
    is_symptom=True,
)
def movement_missing_in_offset_mode(tool_center: ToolCenter) -> Mask:
    """
    Too many blocks without movement between two moves with compensation.

    To find the way round a corner the control must know the next move on the plane. It reads a few blocks ahead, and Z
    moves, M and S codes, dwell and empty moves use them up; M0 and M1 stop the reading altogether. Then the tool center
    goes to R beside the end of this block, cuts into an inside corner, and after a start-up may stand on the wrong
    side. Bring the blocks to another place, or join them: one Z move to depth is harmless, two are not.

    Source: FANUC B-63664EN, p. 170; B-63944EN-2, p. 146.

    Bad, tool 1:radius=4:

        T0101
        G98 G0 X100. Z5. C0
        G12.1
        G1 C20. F500
        G41 X60. F200      (expect: movement-missing-in-offset-mode)
        Z1.
        Z-3.
        C-20.
        G40 X100.
        G13.1

    Bad, tool 1:radius=4:

        T0101
        G98 G0 X100. Z5. C0
        G12.1
        G1 C20. F500
        G41 X60. F200
        C-20.              (expect: movement-missing-in-offset-mode)
        M0
        X20.
        G40 X-100.
        G13.1

    Good, tool 1:radius=4:

        T0101
        G98 G0 X100. Z5. C0
        G12.1
        G1 C20. F500
        G41 X60. F200
        Z-3.
        C-20.
        G4 X1.
        X20.
        G40 X-100.
        G13.1
    """
    # Compares nothing: which moves the control knows in time, and needs to know, shows only while it compensates.
    return tool_center.waits_for_movement


def details(hit: Hit) -> Details:
    import numpy as np

    trace, row = hit.trace, hit.row
    move = int(np.flatnonzero(trace.path.travels[: row + 1])[-1])
    following = move + 1
    while following < len(trace) and trace.mode.in_polar[following] and not trace.path.length[following] > 0:
        following += 1
    stops = np.flatnonzero(trace.blocks.codes(*trace.machine.m_codes.stops_reading_ahead)[move:following])
    count, least = following - move - 1, trace.machine.compensation.read_ahead - 2
    why = _too_many(count, least)
    if move != row:
        rest = f", and {count} blocks behind that move make none on the plane" if count > 1 else ""
        why = f"this block moves nowhere, its point is that of the block before{rest}: delete it or correct its words"
    if len(stops):
        why = f"line {hit.line(move + stops[0])} stops reading ahead"
    return {
        "blocks": np.nan if len(stops) else count,
        "limit": np.nan if len(stops) else least,
        "why": why,
        "move_before": "this block" if move == row else f"line {hit.line(move)}",
    }


def needs(compensation: CutterCompensation, ramps: Ramps) -> Needs:
    return ramps.compensated, {"radius": compensation.radius}


def _too_many(count: int, least: int) -> str:
    many = f"{count} blocks" if count > 1 else "a block"
    return f"{many} without a move on the plane follow{'' if count > 1 else 's'}, this control reads past {least}"
