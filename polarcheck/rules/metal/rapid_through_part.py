from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.rules.rule import ERROR, Hits, graded, rule

if TYPE_CHECKING:
    from polarcheck.columns.metal.workpiece import Workpiece
    from polarcheck.rules.hit import Details, Hit


@rule(
    ERROR,
    "{block} takes the cutter, R {cutter}, {height} {through} the finished part; {way_round}",
    values=("radius", "z"),
    worse=("-z",),
    gouges=True,
    once="tool call",
    subject="rapid",
    follows={"tool call": ("cut-in-air",)},
    is_symptom=True,
)
def rapid_through_part(workpiece: Workpiece) -> Hits:
    """
    Positioning through the finished part.

    Behind a section, or on the way to it, the mill moves in rapid traverse with its tip below the top of a contour, and
    a part that the contour leaves standing is in its way: the retract is missing, and the next G0 or the index of C
    tears the cutter through the part. Or a section begins at depth, where the contour leaves metal: the approach is
    that of another block. No bar needs to be known for that: the metal beside a programmed wall, up to 2R behind it,
    must stand whatever the bar is, unless the program mills it off as well. Only mills along Z are looked at, whose R
    is known. At feed it is a warning, since a slot may be milled by C alone.

    Source: FANUC B-62764EN/01, p. 51 (positions outside the mode are X and the angle of C).

    Bad, tool 1:radius=2.5:

        T0101
        G98 G0 X26. Z2. C0
        G12.1
        G1 X26. F500
        Z-4. F40
        G41 X34. F80
        G3 I-4.
        G1 G40 X26.
        G13.1
        G0 C120.          (expect: rapid-through-part)

    Bad, tool 1:radius=4:

        T0101
        G98 G0 X27.2 Z-4. C0    (expect: rapid-through-part)
        G12.1
        G1 X46.4 F250
        Z-5.
        G42 X27.
        C7.794
        X0 C15.588
        X-27. C7.794
        C-7.794
        X0 C-15.588
        X27. C-7.794
        C0
        G40 X46.4
        Z2.
        G13.1

    Bad, tool 1:radius=2.5:

        T0101
        G98 G0 X26. Z2. C0
        G12.1
        G1 X26. F500
        Z-4. F40
        G41 X34. F80
        G3 I-4.
        G1 G40 X26.
        G13.1
        G1 C120. F2000    (expect: rapid-through-part)

    Good, tool 1:radius=2.5:

        T0101
        G98 G0 X26. Z2. C0
        G12.1
        G1 X26. F500
        Z-4. F40
        G41 X34. F80
        G3 I-4.
        G1 G40 X26.
        Z2.
        G13.1
        G0 C120.
    """
    error = workpiece.hits_part & workpiece.is_rapid & ~workpiece.may_miss_part
    return graded(error=error, warning=workpiece.hits_part, undecided=workpiece.may_miss_part)


def details(hit: Hit, workpiece: Workpiece) -> Details:
    from polarcheck.rules.wording.metal import height_in_words, through, z_of_move

    return {
        "radius": workpiece.radius[hit.row],
        "z": z_of_move(workpiece.trace, hit.row),
        "cutter": hit.length(workpiece.radius[hit.row]),
        "height": height_in_words(hit, workpiece.trace),
        "through": through(hit, workpiece),
        "way_round": "arrive beside the part, or above it"
        if workpiece.arrives[hit.row]
        else "retract Z above the part first",
    }
