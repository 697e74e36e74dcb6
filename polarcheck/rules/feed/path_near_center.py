from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.rules.rule import WARNING, Hits, rule

if TYPE_CHECKING:
    from polarcheck.columns.path.center import Center
    from polarcheck.columns.path.tool_center import ToolCenter
    from polarcheck.program.machines.machine import Machine
    from polarcheck.rules.hit import Details, Hit


@rule(
    WARNING,
    "tool center comes within {nearest:length/limit} of the center of the {rotary} axis; "
    "keep {limit:length/nearest} away",
    values=("nearest", "limit"),
    worse=("-nearest",),
    gouges=True,
    at=("X", "U", "C", "H"),
    subject="rate",
)
def path_near_center(center: Center, tool_center: ToolCenter, machine: Machine) -> Hits:
    """
    Path very close to the center of the C axis.

    On a line that passes the center at a distance d, C turns by 90 deg while the tool moves by 2d. So close to the
    center C turns nearly at once, the servo lags behind and leaves a mark on the part. Lead the path around the center,
    or pass it no closer than limits.keep_out of the profile. Where the tool stands beside the center and the control
    makes up for it, polar.center_error, it comes no nearer than that.

    Source: FANUC B-62764EN/01, p. 52; parameter 5464.

    Bad:

        G98 G0 X60. C0
        G12.1
        G1 X40. F1.
        C.008
        X-40.             (expect: path-near-center)
        G13.1

    Bad, set limits.keep_out=2:

        G98 G0 X60. C0
        G12.1
        G1 C1.5 F200
        X-40.             (expect: path-near-center)
        G13.1

    Bad, machine fanuc-30i, set parameters.5464=-0.5:

        G98 G0 X60. C0
        G12.1
        G1 X40. F5.
        C.3
        X-40.             (expect: path-near-center)
        G13.1

    Good, set limits.keep_out=2:

        G98 G0 X60. C0
        G12.1
        G1 C3. F200
        X-40.
        G13.1
    """
    keep_out = max(abs(machine.polar.center_error), machine.limits.keep_out)
    return Hits(
        center.cuts_off_center & (tool_center.nearest < keep_out), values={"limit": keep_out}, worst=tool_center.c_feed
    )


def details(hit: Hit, tool_center: ToolCenter) -> Details:
    return {"nearest": tool_center.nearest[hit.row]}
