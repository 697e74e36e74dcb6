from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.rules.rule import WARNING, Hits, rule

if TYPE_CHECKING:
    from polarcheck.columns.contour.rapid_contours import RapidContours
    from polarcheck.columns.modes.mode import PolarMode
    from polarcheck.program.machines.machine import Machine
    from polarcheck.rules.hit import Details, Hit


@rule(
    WARNING,
    "rapid traverse along the contour at Z{tip}{more}: the cutter goes through what it should mill; write {line_code} "
    "with an F",
    values=("z",),
    gouges=True,
    once="section",
    subject="",
    follows={"section": ("rapid-in-polar",)},
    doubts=(("rapid", "motion"),),
)
def rapid_along_contour(rapid_contours: RapidContours, mode: PolarMode, machine: Machine) -> Hits:
    """
    Contour in rapid traverse.

    Some controls take G0 in the polar mode. Where it is still in force when the contour begins, or stands in place of
    G1, the cutter goes along the contour at depth in rapid traverse: it breaks, or the part is torn out. Write G1 with
    an F. Rapid traverse above the face is right, and so is the way to the contour and away from it, with G41, G42 or
    G40 or straight to or from the center, and a way round the outside of all that is cut. Without G41 and G42 several
    such moves in a row are a contour. The face is at Z0 where nothing says another.

    Source: Haas codes, G0 and G112; builder's guide to G12.1, feed command.

    Bad, machine haas-lathe, tool 1:radius=.125:

        T0101
        G17 G98 G0 X1.5 Y0 Z.1 C0
        G112
        G1 Z-.25 F10.
        G42 X.5
        G0 Y.2887         (expect: rapid-along-contour)
        X0 Y.5774
        X-.5 Y.2887
        Y-.2887
        X0 Y-.5774
        X.5 Y-.2887
        Y0
        G1 G40 X1.5
        G0 Z.1
        G113

    Bad, machine siemens-transmit:

        G94 G0 X60 Z5 Y0 C0
        TRANSMIT
        G0 X20 Z-5
        Y10               (expect: rapid-along-contour)
        X-20
        Y-10
        X20
        Y0
        X60
        Z5
        TRAFOOF

    Good, machine haas-lathe, tool 1:radius=.125:

        T0101
        G17 G98 G0 X1.5 Y0 Z.1 C0
        G112
        G1 Z-.25 F10.
        G42 X.5
        Y.2887
        X-.5
        G0 G40 X-1.5
        Y-.2887
        G1 G42 X-.5 F10.
        Y-.5
        X.5
        G40 X1.5
        G0 Z.1
        X-.5 Y.2
        X.5 Y-.2
        X1.5
        G113
    """
    # Where G0 is no fault of its own it is the cause of nothing.
    forbidden = mode.in_polar & ("G0" not in machine.polar.allowed_codes)
    return Hits(rapid_contours.along_contour, follows={"section": forbidden})


def details(hit: Hit) -> Details:
    from polarcheck.rules.wording.written import move_code

    z = hit.trace.path.z[hit.row]
    return {
        "z": z,
        "tip": hit.number(z),
        "more": f", and in {hit.count - 1} more moves" if hit.count > 1 else "",
        "line_code": move_code(hit.trace.machine, "line"),
    }
