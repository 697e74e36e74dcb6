from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.rules.causes import END_IN_DOUBT
from polarcheck.rules.rule import ARC, ERROR, rule

if TYPE_CHECKING:
    from polarcheck.columns.path.arcs import Arcs
    from polarcheck.columns.path.path import ProgrammedPath
    from polarcheck.foundation.arrays import Mask
    from polarcheck.program.machines.machine import Machine
    from polarcheck.rules.hit import Details, Hit


@rule(
    ERROR,
    "arc without {radius_word}, {centers}{still_in_force}{more_arcs}",
    at=("arc_clockwise", "arc_counterclockwise", "X", "U", "C", "H"),
    once="motion",
    subject="",
    doubts=END_IN_DOUBT,
    follows={"block": ("side-repeated-in-offset-mode",)},
    is_symptom=True,
    only_with=(ARC,),
)
def arc_without_center(path: ProgrammedPath, arcs: Arcs) -> Mask:
    """
    Arc with neither radius nor center.

    A move in G2 or G3 needs R, or I and J, in its own block; neither of them stays in force. The control stops with an
    alarm or, with parameter 3403#5 CIR = 0, moves straight. G1 forgotten after an arc looks the same.

    Source: FANUC alarm 022; parameter 3403#5.

    Bad:

        G98 G0 X60. C0
        G12.1
        G1 X40. C10. F200
        G3 X20. C20.      (expect: arc-without-center)
        G1 X60.
        G13.1

    Bad:

        G98 G0 X60. C0
        G12.1
        G1 X40. C10. F200
        G3 X20. C20. R10.
        X-20.             (expect: arc-without-center)
        G13.1

    Good:

        G98 G0 X60. C0
        G12.1
        G1 X40. C10. F200
        G3 X20. C20. R10.
        G1 X-20.
        G13.1
    """
    has_center = arcs.by_radius | arcs.by_center | arcs.has_word_of_other_plane | arcs.is_off_plane
    return path.is_arc & ~has_center & ~arcs.ends_at_start & ~path.shape_is_unknown


def details(hit: Hit, machine: Machine) -> Details:
    from polarcheck.rules.wording.arcs import still_in_force

    more = f"; so {'is' if hit.count == 2 else 'are'} {hit.count - 1} more up to the next code of motion"
    return {
        "radius_word": machine.arcs.radius_word,
        "still_in_force": still_in_force(hit.trace, hit.row),
        "more_arcs": more if hit.count > 1 else "",
    }
