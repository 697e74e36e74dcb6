from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.rules.rule import WARNING, rule

if TYPE_CHECKING:
    from polarcheck.columns.path.arcs import Arcs
    from polarcheck.columns.path.path import ProgrammedPath
    from polarcheck.foundation.arrays import Mask


@rule(
    WARNING,
    "arc that moves Z, too: only with the helical option, else an alarm",
    at=("Z", "W"),
    once="section",
    subject="",
)
def helical_arc_in_polar(path: ProgrammedPath, arcs: Arcs) -> Mask:
    """
    Arc in the polar mode that moves Z.

    Z moves along with an arc only where the control has helical interpolation; else it stops with an alarm for the
    wrong plane. Posts break such arcs up into short lines. Move Z in a block of its own, or along lines. A word that
    repeats the Z at which the tool stands moves nothing; where the control alarms at the word itself, or a document
    forbids it, the machine's profile says so (polar.repeated_z).
    A helix is one finding of its section.

    Source: FANUC alarm 021; Autodesk turn-mill posts, which avoid helical arcs in the mode.

    Bad:

        G98 G0 X60. C0
        G12.1
        G1 X40. C10. F200
        G3 X20. C20. R10. Z-2.  (expect: helical-arc-in-polar)
        G1 X60.
        G13.1

    Bad, tool 1:radius=4:

        O1
        G21 G98
        T0101
        G0 X40. Z2. C0
        G12.1
        G1 Z0 F300
        G42 X20. F200
        G3 X-20. C0 R10. Z-1.  (expect: helical-arc-in-polar)
        X20. C0 R10. Z-2.
        X-20. C0 R10. Z-3.
        X20. C0 R10.
        X-20. C0 R10.
        G1 G40 X-40. F1500
        Z2.
        G13.1
        M30

    Bad:

        G98 G0 X60. C0
        G12.1
        G1 X40. C10. F200
        G3 I-10. J0 W-2.  (expect: helical-arc-in-polar)
        G1 X60.
        G13.1

    Bad, set polar.repeated_z="forbidden-in-arcs":

        G98 G0 X60. C0
        G12.1
        G1 X40. C10. F200
        Z-2.
        G3 X20. C20. R10. Z-2.  (expect: helical-arc-in-polar)
        G1 X60. Z-2.
        G13.1

    Good:

        G98 G0 X60. C0
        G12.1
        G1 X40. C10. F200
        Z-2.
        G3 X20. C20. R10.
        G1 X60.
        G13.1

    Good:

        G98 G0 X60. C0
        G12.1
        G1 X40. C10. F200
        Z-2.
        G3 X20. C20. Z-2. I-10. J0
        G1 X60. C20. Z-2.
        G13.1
    """
    return arcs.in_force & path.judged_z_of_arc & ~arcs.is_off_plane
