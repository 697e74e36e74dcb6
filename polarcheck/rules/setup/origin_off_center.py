from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.geometry.tolerances import ROUNDING
from polarcheck.rules.rule import ERROR, Hits, rule

if TYPE_CHECKING:
    from polarcheck.columns.modes.entry import Entry
    from polarcheck.columns.modes.mode import PolarMode
    from polarcheck.rules.hit import Details, Hit
    from polarcheck.rules.rule import Needs


@rule(
    ERROR,
    "{name} puts X0 {shift:length} off the spindle axis{as_diameter} at {switch}",
    values=("shift",),
    worse=("shift",),
    at=("on",),
    once="origin",
    follows={"origin": ("origin-shifted-in-polar",)},
)
def origin_off_center(mode: PolarMode, entry: Entry) -> Hits:
    """
    Origin of the polar plane off the spindle axis.

    The control takes X0 as the center that C turns about. If the work offset or a local shift in force puts X0
    elsewhere, every radius and every angle of the shape is wrong. Set X of the work offset to the spindle axis and
    cancel G52 before G12.1. Known are the work offsets of the job, `[work_offsets.G54] x = 0`, and in the program G52,
    and G50 (G92 in systems B and C) with U, or with X where the program says where X stands; G50.3 (G92.1) takes both
    back. What sets X of a work offset, of the external one or of the work shift counts up to 50 mm, be it G10 or a
    variable: beyond, it is the way from the reference position of the lathe, and what is added to that counts again.
    Where the value set is not known, nothing is said of the origin but that.

    Source: FANUC B-62764EN/01, p. 51; builder's guide to G12.1, coordinate system origin.

    Bad:

        G52 X2.
        G98 G0 X60. C0
        G12.1             (expect: origin-off-center)
        G1 X40. F200
        C10.
        X60.
        G13.1
        G52 X0.

    Bad:

        G10 L2 P1 X.5
        G54
        G98 G0 X60. C0
        G12.1             (expect: origin-off-center)
        G1 X40. F200
        C10.
        X60.
        G13.1

    Bad:

        G10 L2 P1 X-260.5
        #5221=#5221+.5
        G98 G0 X60. C0
        G12.1             (expect: origin-off-center)
        G1 X40. F200
        C10.
        X60.
        G13.1

    Bad:

        G98 G0 X60. Z2.
        G50 X59.8
        G0 X62. C0
        G12.1             (expect: origin-off-center)
        G1 X40. F200
        C10.
        X60.
        G13.1

    Bad, set job.work_offsets.G55.x=0.5:

        G55
        G98 G0 X60. C0
        G12.1             (expect: origin-off-center)
        G1 X40. F200
        C10.
        X60.
        G13.1

    Good:

        G10 L2 P1 X-260.5
        G50 X200. Z100.
        G98 G0 X60. C0
        G50 X60. S2000
        G12.1
        G1 X40. F200
        C10.
        X60.
        G13.1

    Good, set job.work_offsets.G55.x=0.5:

        G55
        G0 X80. C0
        G52 X2.
        G52 X0.
        G52 X1.
        G50.3 X0
        G54
        G98 G0 X60. C0
        G12.1
        G1 X40. F200
        C10.
        X60.
        G13.1
    """
    return Hits(mode.enters & (abs(entry.origin_shift) > ROUNDING), values={"shift": entry.origin_distance})


def details(hit: Hit, entry: Entry) -> Details:
    written, distance = entry.origin_shift[hit.row], entry.origin_distance[hit.row]
    return {
        "name": " and ".join(entry.origin.causes(hit.row)),
        "as_diameter": "" if written == distance else f", X {hit.length(written)} as a diameter,",
    }


def needs(entry: Entry, mode: PolarMode) -> Needs:
    return mode.enters, {"origin": entry.origin_shift}
