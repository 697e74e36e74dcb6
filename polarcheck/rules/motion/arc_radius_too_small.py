from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.foundation.states import MM_PER_INCH, Units
from polarcheck.rules.causes import END_IN_DOUBT
from polarcheck.rules.rule import ARC, ERROR, rule

if TYPE_CHECKING:
    from polarcheck.columns.path.arcs import Arcs
    from polarcheck.columns.path.lengths import Lengths
    from polarcheck.foundation.arrays import Mask
    from polarcheck.program.machines.machine import Machine
    from polarcheck.rules.hit import Details, Hit
    from polarcheck.rules.rule import Needs


@rule(
    ERROR,
    "a radius of {arc_radius:length} does not reach: start and end are {chord:length} apart, "
    "least radius {least_radius}",
    values=("arc_radius", "arc_radius_needed", "chord"),
    worse=("arc_radius:arc_radius_needed",),
    at=("X", "U", "C", "H", "R"),
    once="misfitting arcs",
    doubts=END_IN_DOUBT,
    is_symptom=True,
    only_with=(ARC,),
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


def details(hit: Hit, arcs: Arcs, lengths: Lengths) -> Details:
    import numpy as np

    chord, inch = float(arcs.chord[hit.row]), lengths.units[hit.row] == Units.INCH
    # Rounded up to what the program can write.
    least, places = chord / (2 * MM_PER_INCH if inch else 2), 4 if inch else 3
    text = f"{np.ceil(least * 10**places - 1e-6) / 10**places:.{places}f}".rstrip("0").rstrip(".")
    return {
        "arc_radius": arcs.radius[hit.row],
        "arc_radius_needed": chord / 2,
        "chord": chord,
        "least_radius": f"{text} {'inch' if inch else 'mm'}",
    }


def needs(arcs: Arcs) -> Needs:
    return arcs.by_radius, {"position": arcs.chord}
