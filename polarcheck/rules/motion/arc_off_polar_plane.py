from __future__ import annotations

from polarcheck.checking.rule import ERROR, Arcs, Mask, Trace, rule


@rule(
    ERROR,
    "arc along Z; in the polar mode arcs lie in the plane of X and C",
    at=("arc_clockwise", "arc_counterclockwise", "Z", "W"),
)
def arc_off_polar_plane(trace: Trace, arcs: Arcs) -> Mask:
    """
    Arc along Z in the polar mode.

    In the mode G2 and G3 are arcs of X and C. A block of theirs with Z and neither X nor C is no such arc, and the
    control stops with an alarm. Often it is a move of Z behind an arc, where G1 was forgotten.

    Source: FANUC alarm 021; B-62764EN/01, p. 51.

    Bad:

        G98 G0 X60. C0
        G12.1
        G1 X40. C10. F200
        G3 X20. C20. R10.
        Z5.               (expect: arc-off-polar-plane)
        G13.1

    Bad:

        G98 G0 X60. C0
        G12.1
        G1 X40. C10. F200
        G2 Z-5. R10.      (expect: arc-off-polar-plane)
        G1 X60.
        G13.1

    Good:

        G98 G0 X60. C0
        G12.1
        G1 X40. C10. F200
        G3 X20. C20. R10.
        G1 Z5.
        G13.1
    """
    return arcs.in_force & trace.moves_z & ~arcs.has_word_of_plane
