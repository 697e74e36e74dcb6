from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.rules.rule import ERROR, rule

if TYPE_CHECKING:
    from polarcheck.columns.path.arcs import Arcs
    from polarcheck.columns.path.center import Center
    from polarcheck.columns.path.path import ProgrammedPath
    from polarcheck.columns.path.tool_center import ToolCenter
    from polarcheck.foundation.arrays import Mask
    from polarcheck.rules.hit import Details, Hit


@rule(
    ERROR,
    "tool center {meeting}",
    at=("X", "U", "C", "H"),
    subject="speed",
    doubts=(("move", "X before"),),
    gouges=True,
    is_symptom=True,
)
def path_through_center(path: ProgrammedPath, center: Center, arcs: Arcs) -> Mask:
    """
    Path through the center of the C axis.

    At the center C has no angle. A path across it wants C half a turn further in no time, whatever F is; one that stops
    there leaves the angle of the next move open. The control stops with an alarm, or leaves a mark on the part. Lead
    the path around the center. With cutter compensation it is the tool center that counts, not the contour.

    A move along a radius that ends at the center or begins there belongs here, too, though C does not turn on the way.

    Source: FANUC B-62764EN/01, p. 52: do not come close to the center; Siemens alarm 21617, pole.

    Bad:

        G98 G0 X60. C0
        G12.1
        G1 X-40. F200     (expect: path-through-center)
        C10.
        G13.1

    Bad:

        G98 G0 X60. C0
        G12.1
        G1 X0 F200        (expect: path-through-center)
        C10.
        G13.1

    Bad, tool 1:radius=5:

        T0101
        G98 G0 X60. C0
        G12.1
        G1 C15. F200
        G41 X-10.
        C-15.             (expect: path-through-center)
        X40.
        G40 C20.
        G13.1

    Good:

        G98 G0 X60. C0
        G12.1
        G1 C5. F200
        X-40.
        C10.
        G13.1
    """
    return path.cuts & center.meets_center & ~arcs.is_no_circle


def details(hit: Hit, tool_center: ToolCenter, center: Center) -> Details:
    import numpy as np

    moves, stops, least = tool_center.moves, center.stops_at_center, hit.trace.lengths.least_step[hit.row]
    at = np.flatnonzero((moves.row == hit.row) & (stops | (moves.nearest < least)))[-1]
    axis = hit.rotary
    if stops[at] or abs(moves.start[at]) < least:
        verb = "stops" if stops[at] else "starts"
        return {"meeting": f"{verb} at the center of the {axis} axis, where {axis} has no angle"}
    through = f"passes through the center of the {axis} axis"
    return {"meeting": f"{through}, where {axis} would have to turn by 180 deg at once"}
