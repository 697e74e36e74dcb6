from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.rules.causes import NO_SUCH_ARC
from polarcheck.rules.rule import ARC, ERROR, Hits, rule

if TYPE_CHECKING:
    from polarcheck.columns.path.arcs import Arcs
    from polarcheck.columns.path.axes import PlaneAxes
    from polarcheck.columns.path.path import ProgrammedPath
    from polarcheck.rules.hit import Details, Hit


@rule(
    ERROR,
    "{word} is not of the polar plane; the center is {center}",
    values=("word",),
    subject="",
    doubts=NO_SUCH_ARC,
    follows={"section": ("linear-axis-never-programmed",)},
    only_with=(ARC,),
)
def arc_word_of_other_plane(axes: PlaneAxes, path: ProgrammedPath, arcs: Arcs) -> Hits:
    """
    Center of an arc with K.

    The letters of the center follow the linear axis of the polar plane: with X they are I and J, I along X and J along
    C. K belongs to Z. The control stops with an alarm, or takes the center to be where I and J say without it.

    Source: FANUC B-62764EN/01, p. 51.

    Bad:

        G98 G0 X60. C0
        G12.1
        G1 X40. C10. F200
        G3 X20. C20. K-10.  (expect: arc-word-of-other-plane)
        G1 X60.
        G13.1

    Bad:

        G98 G0 X60. C0
        G12.1
        G1 X40. C10. F200
        G3 X20. C20. I-10. K5.  (expect: arc-word-of-other-plane)
        G1 X60.
        G13.1

    Good:

        G98 G0 X60. C0
        G12.1
        G1 X40. C10. F200
        G3 X20. C20. I-10. J0 K0
        G1 X60.
        G13.1
    """
    return Hits(path.is_arc & arcs.has_word_of_other_plane & ~arcs.is_off_plane, at=axes.other_center_words)


def details(hit: Hit, axes: PlaneAxes) -> Details:
    along, across = axes.center_words(hit.row)
    return {"center": f"{along} along {hit.linear} and {across} along {hit.virtual}"}
