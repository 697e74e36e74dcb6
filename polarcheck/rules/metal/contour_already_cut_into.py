from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.rules.rule import WARNING, Hits, rule

if TYPE_CHECKING:
    from polarcheck.columns.metal.earlier_contours import EarlierContours
    from polarcheck.columns.path.compensation import CutterCompensation
    from polarcheck.rules.hit import Details, Hit
    from polarcheck.rules.rule import Needs


@rule(
    WARNING,
    "the contour of line {line_before} takes off {depth:length} of what this contour is to leave standing",
    values=("depth",),
    worse=("depth",),
    once="section",
    subject="metal",
)
def contour_already_cut_into(earlier_contours: EarlierContours) -> Hits:
    """
    Contour of which another section of the same depth has cut off corners or walls before.

    Roughing and finishing stand at different C, or the roughing is smaller than the finished size: the part has lost
    metal that the finished contour was to keep. Compare C at both G12.1, and both sizes.

    Compared are closed contours whose sections end at one Z, without turning between them, and whose outlines are alike
    but for C, an allowance and single walls; and contours that run in what another one has cleared. Not reported are
    contours of other depths, as those of chamfers; a tool that clears on beside its own contour; what a later section
    takes off; and regular shapes turned by half a pitch that have one size, or lose only a little of their corners:
    they make twice as many sides or chamfers.

    Source: the geometry of both contours alone.

    Bad, tool 1:radius=4, tool 2:radius=4:

        O1
        G21 G98
        T0101
        G0 X60. Z2. C0
        G12.1
        G1 X60. C0 F1500
        Z-5. F300
        G42 X20. F200
        C10.
        X-20.
        C-10.
        X20.
        C0
        G40 X60. F1500
        Z2.
        G13.1
        T0202
        G0 X60. Z2. C0
        G12.1
        G1 X60. C0 F1500
        Z-5. F300
        G42 X22. F200
        C11.     (expect: contour-already-cut-into)
        X-22.
        C-11.
        X22.
        C0
        G40 X60. F1500
        Z2.
        G13.1
        M30

    Good, tool 1:radius=4, tool 2:radius=4:

        O1
        G21 G98
        T0101
        G0 X60. Z2. C0
        G12.1
        G1 X60. C0 F1500
        Z-5. F300
        G42 X23. F200
        C11.5
        X-23.
        C-11.5
        X23.
        C0
        G40 X60. F1500
        Z2.
        G13.1
        T0202
        G0 X60. Z2. C90.
        G12.1
        G1 X60. C0 F1500
        Z-5. F300
        G42 X22. F200
        C11.
        X-22.
        C-11.
        X22.
        C0
        G40 X60. F1500
        Z2.
        G13.1
        M30
    """
    loss = earlier_contours.loss
    return Hits(loss > 0, values={"depth": loss})


def needs(compensation: CutterCompensation, earlier_contours: EarlierContours) -> Needs:
    return earlier_contours.compared, {"radius": compensation.radius}


def details(hit: Hit, earlier_contours: EarlierContours) -> Details:
    return {"line_before": int(hit.trace.blocks.line[earlier_contours.earlier(hit.row)])}
