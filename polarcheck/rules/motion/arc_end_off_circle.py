from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.rules.causes import END_IN_DOUBT
from polarcheck.rules.rule import ARC, ERROR, Hits, rule

if TYPE_CHECKING:
    from polarcheck.columns.path.arcs import Arcs
    from polarcheck.columns.path.ramps import Ramps
    from polarcheck.program.machines.machine import Machine
    from polarcheck.rules.hit import Details, Hit
    from polarcheck.rules.rule import Needs


@rule(
    ERROR,
    "the arc starts {start_radius:length/end_radius} from its center and "
    "ends {end_radius:length/start_radius} from it; "
    "{tolerance:length} of difference is allowed{likewise}",
    values=("difference", "start_radius", "end_radius", "tolerance"),
    worse=("difference",),
    at=("X", "U", "C", "H", "I", "J"),
    once="loop",
    doubts=END_IN_DOUBT,
    follows={"block": ("arc-center-on-path",), "misfitting arcs": ("arc-radius-too-small",)},
    is_symptom=True,
    only_with=(ARC,),
)
def arc_end_off_circle(arcs: Arcs, machine: Machine) -> Hits:
    """
    Arc whose end is not on its circle.

    I and J lead from the start of the arc to its center, I along X and J along the virtual axis, both as radii, never
    as diameters. From there the end must be as far away as the start. Beyond the tolerance the control stops with an
    alarm; older ones go on straight, others spiral. A word of the virtual axis that is missing, or an X that is not on
    the diameter, shows here. Several such arcs of a contour are one finding: an end that is wrong is the start of the
    next arc.

    Source: FANUC B-62754EN/01, p. 67; parameter 3410; alarm 020.

    Bad:

        G98 G0 X60. C0
        G12.1
        G1 X40. F200
        G3 X20. C20. I-10. J5.  (expect: arc-end-off-circle)
        G1 X60.
        G13.1

    Bad:

        G98 G0 X60. C0
        G12.1
        G1 X40. C10. F200
        G3 X24. I-8. J6.  (expect: arc-end-off-circle)
        G1 X60.
        G13.1

    Good:

        G98 G0 X60. C0
        G12.1
        G1 X40. C10. F200
        G3 X24. C26. I-8. J6.
        G1 X60.
        G13.1
    """
    tolerance = machine.arcs.tolerance
    return Hits(abs(arcs.start_radius - arcs.end_radius) > tolerance, values={"tolerance": tolerance})


def details(hit: Hit, arcs: Arcs, ramps: Ramps, machine: Machine) -> Details:
    start, end = arcs.start_radius[hit.row], arcs.end_radius[hit.row]
    same_loop = ramps.loop == ramps.loop[hit.row]
    others = (abs(arcs.start_radius - arcs.end_radius) > machine.arcs.tolerance) & same_loop
    return {
        "difference": abs(start - end),
        "start_radius": start,
        "end_radius": end,
        "likewise": hit.likewise(others),
    }


def needs(arcs: Arcs) -> Needs:
    return arcs.by_center, {"position": arcs.end_radius}
