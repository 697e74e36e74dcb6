from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.rules.causes import END_IN_DOUBT
from polarcheck.rules.rule import ERROR, rule

if TYPE_CHECKING:
    from polarcheck.columns.path.arcs import Arcs
    from polarcheck.foundation.arrays import Mask
    from polarcheck.program.machines.machine import Machine


@rule(
    ERROR,
    "a radius of {arcs.radius:length} does not reach: start and end are {arcs.chord:length} apart, "
    "least radius {least_radius}",
    values={"arc_radius": "arcs.radius", "arc_radius_needed": "half_chord", "chord": "arcs.chord"},
    worse=("arc_radius:arc_radius_needed",),
    at=("X", "U", "C", "H", "R"),
    needs=("arcs.chord",),
    where="arcs.by_radius",
    once="misfitting arcs",
    doubts=END_IN_DOUBT,
    follows={"loop": ("number-without-point",)},
)
def arc_radius_too_small(arcs: Arcs, machine: Machine) -> Mask:
    """
    Arc with an R that does not reach from start to end.

    No circle of this radius passes through both points: the way between them, X as a radius, is longer than twice R.
    The control stops with an alarm. R is the true radius, never on the diameter.

    Source: FANUC B-62754EN/01, p. 67; alarm 020.

    Bad:

        G98 G0 X60. C0
        G12.1
        G1 X40. C10. F200
        G3 X20. C20. R7.  (expect: arc-radius-too-small)
        G1 X60.
        G13.1

    Bad:

        G20 G98 G0 X2.5 C0
        G12.1
        G1 X1. C.5 F8.
        X.001 C.215
        G2 X0. C.86 R.225  (expect: arc-radius-too-small)
        G1 C1.5
        G13.1

    Good:

        G98 G0 X60. C0
        G12.1
        G1 X40. C10. F200
        G3 X20. C20. R7.08
        G1 X60.
        G13.1
    """
    return arcs.chord > 2 * abs(arcs.radius) + machine.arcs.tolerance
