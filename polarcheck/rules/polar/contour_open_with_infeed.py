from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.rules.rule import ERROR, rule

if TYPE_CHECKING:
    from polarcheck.columns.path.infeed import Infeed
    from polarcheck.foundation.arrays import Mask
    from polarcheck.rules.hit import Details, Hit


@rule(
    ERROR,
    "{word} asks for passes around the contour, which ends {gap:length} from where it begins: it must be closed",
    values=("gap", "word"),
    worse=("gap",),
    at=("E",),
    subject="side",
)
def contour_open_with_infeed(infeed: Infeed) -> Mask:
    """
    Infeed cycle on a contour that is not closed.

    With E beside G12.1 the control cuts the contour in passes, each nearer by E, and goes straight from the end of one
    to the beginning of the next. Unless the last point of the contour is its first, that way leads through the part.
    Close the contour, or leave E out for a single pass.

    Source: GSK 988, description of G12.1 IP P Q E, note on closed contours.

    Bad, machine gsk-988, tool 2:radius=5, tool 2:nose=0:

        T0202
        G98 G0 X120. C0
        G12.1 E4.             (expect: contour-open-with-infeed)
        G42 G1 X80. F200
        C20.
        G3 X40. C40. R20.
        G1 X-40.
        G3 X-80. C20. R20.
        G1 C0
        G40 X-120.
        G13.1

    Good, machine gsk-988, tool 2:radius=5, tool 2:nose=0:

        T0202
        G98 G0 X120. C0
        G12.1 E4.
        G42 G1 X80. F200
        C40.
        X-80.
        C-40.
        X80.
        C0
        G40 X120.
        G13.1

    Good, machine gsk-988, tool 2:radius=5, tool 2:nose=0:

        T0202
        G98 G0 X120. C0
        G12.1 E0
        G42 G1 X80. F200
        C40.
        G40 X120.
        G13.1
    """
    return infeed.gap > 0


def details(hit: Hit, infeed: Infeed) -> Details:
    return {"gap": infeed.gap[hit.row], "word": hit.written("E")}
