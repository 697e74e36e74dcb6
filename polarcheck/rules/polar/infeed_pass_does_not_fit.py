from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.rules.rule import WARNING, rule

if TYPE_CHECKING:
    from polarcheck.columns.path.compensation import CutterCompensation
    from polarcheck.columns.path.infeed import Infeed
    from polarcheck.foundation.arrays import Mask
    from polarcheck.rules.hit import Details, Hit
    from polarcheck.rules.rule import Needs

#: Of a block that is named; more is cut off [characters].
_BLOCK_LENGTH = 60


@rule(
    WARNING,
    "{unfit} of {passes} passes do not fit into the contour: {misfit_of_pass}",
    values=("unfit", "passes", "allowance", "radius", "other_line"),
    worse=("unfit",),
    at=("E",),
)
def infeed_pass_does_not_fit(infeed: Infeed) -> Mask:
    """
    Infeed cycle whose passes are too far off for the inside of the contour.

    A pass runs as if the cutter were larger by what it leaves on the contour. Round an inside arc, or in a slot, R and
    this allowance together must fit, even where R alone does: else the control has no path for the pass, and stops or
    cuts into what should stay. Take a smaller E and a start point nearer to the contour, so that no pass lies so far
    off, or cut such places in a section of their own.

    Source: GSK 988, description of G12.1 IP P Q E; FANUC B-63664EN, p. 184, for what does not fit.

    Bad, machine gsk-988, tool 2:radius=5, tool 2:nose=0:

        T0202
        G98 G0 X120. C0
        G12.1 E4.             (expect: infeed-pass-does-not-fit)
        G42 G1 X80. F200
        C40.
        X20.
        C38.
        G2 X-20. R10.
        G1 C40.
        X-80.
        C-40.
        X80.
        C0
        G40 X120.
        G13.1

    Good, machine gsk-988, tool 2:radius=5, tool 2:nose=0:

        T0202
        G98 G0 X98. C0
        G12.1 E2.
        G42 G1 X80. F200
        C40.
        X20.
        C38.
        G2 X-20. R10.
        G1 C40.
        X-80.
        C-40.
        X80.
        C0
        G40 X98.
        G13.1
    """
    return infeed.unfit > 0


def details(hit: Hit, infeed: Infeed, compensation: CutterCompensation) -> Details:
    from polarcheck.rules.places import block_in_line

    allowance, at = infeed.least_unfit[hit.row]
    radius = abs(float(compensation.radius[at]))
    has_radius = radius > 0 and bool(compensation.compensates[at])
    tool = f" with R {hit.length(radius)}" if has_radius else ""
    where = f"line {hit.line(at)}, {block_in_line(hit.trace.run, at, _BLOCK_LENGTH)}"
    return {
        "unfit": infeed.unfit[hit.row],
        "passes": infeed.passes[hit.row],
        "allowance": allowance,
        "radius": radius if has_radius else None,
        "other_line": hit.line(at),
        "misfit_of_pass": f"already {hit.length(allowance)} off it{tool} there is no way along {where}",
    }


def needs(compensation: CutterCompensation, infeed: Infeed) -> Needs:
    return infeed.judged_by_radius, {"radius": compensation.radius}
