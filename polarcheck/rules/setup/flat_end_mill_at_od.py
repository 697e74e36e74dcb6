from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.rules.rule import ERROR, rule

if TYPE_CHECKING:
    from polarcheck.columns.modes.entry import Entry
    from polarcheck.columns.modes.mode import PolarMode
    from polarcheck.foundation.arrays import Mask


@rule(
    ERROR,
    "offset {offset} is a flat end mill that points at the outer diameter",
    values=("offset",),
    at=("on",),
    once="tool call",
)
def flat_end_mill_at_od(mode: PolarMode, entry: Entry) -> Mask:
    """
    Flat end mill that points at the outer diameter of the part.

    The shape is made by the periphery of a mill that points at the face. A flat end mill that points at the outer
    diameter touches the part with its bottom edge, now on one side of its center and now on the other, and cannot make
    an acceptable shape; a ball-nose mill can, touched off at the center of its ball. Known from the job:
    `[tools.8] mount = "radial", shape = "flat"`.

    Source: builder's guide to G12.1, cutting tools and tool offset data.

    Bad, set job.tools.8.mount="radial", set job.tools.8.shape="flat":

        T0808
        G98 G0 X60. C0
        G12.1             (expect: flat-end-mill-at-od)
        G1 X40. F200
        C10.
        X60.
        G13.1
        G0 C180.
        G12.1
        G1 X40. F200
        C10.
        X60.
        G13.1

    Good, set job.tools.8.mount="radial", set job.tools.8.shape="ball":

        T0808
        G98 G0 X60. C0
        G12.1
        G1 X40. F200
        C10.
        X60.
        G13.1

    Good, set job.tools.8.mount="axial", set job.tools.8.shape="flat":

        T0808
        G98 G0 X60. C0
        G12.1
        G1 X40. F200
        C10.
        X60.
        G13.1
    """
    return mode.enters & entry.is_flat_and_radial
