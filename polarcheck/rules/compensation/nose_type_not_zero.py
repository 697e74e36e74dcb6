from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.rules.rule import ERROR, rule

if TYPE_CHECKING:
    from polarcheck.columns.modes.offsets import ToolOffsets
    from polarcheck.columns.path.compensation import CutterCompensation
    from polarcheck.foundation.arrays import Mask
    from polarcheck.rules.hit import Details, Hit
    from polarcheck.rules.rule import Needs


@rule(
    ERROR,
    "offset {offset} {has} nose type T{nose:.0f}; for a mill it must be {allowed}",
    values=("offset", "nose"),
    gouges=True,
    at=("compensation_left", "compensation_right"),
    once="tool call",
)
def nose_type_not_zero(offsets: ToolOffsets, compensation: CutterCompensation) -> Mask:
    """
    Nose type of a turning tool in the offset of a mill.

    T of the tool offset says where on the nose the programmed point lies. For a mill it is the cutter center, type 0;
    with another type compensation shifts the contour by R along one or both axes of the plane. Set T to 0 in the offset
    table. Other types that mean the center on a machine, too, are in its profile (compensation.nose_types), and the
    message names them. A T that is not given is listed as not evaluated, without weight: offset tables have it for
    turning tools.

    Source: builder's guide to G12.1, cutter compensation data setting; FANUC B-62754EN/01, tool nose radius
    compensation.

    Bad, tool 8:radius=4, tool 8:nose=3:

        T0808
        G98 G0 X60. C0
        G12.1
        G1 G41 X40. F200   (expect: nose-type-not-zero)
        C-10.
        G40 X60.
        G13.1
        G0 C180.
        G12.1
        G1 G41 X40. F200
        C-10.
        G40 X60.
        G13.1

    Bad:

        G10 P8 R4. Q3
        T0808
        G98 G0 X60. C0
        G12.1
        G1 G41 X40. F200   (expect: nose-type-not-zero)
        C-10.
        G40 X60.
        G13.1

    Good, tool 8:radius=4, tool 8:nose=0:

        T0808
        G98 G0 X60. C0
        G12.1
        G1 G41 X40. F200
        C-10.
        G40 X60.
        G13.1
    """
    known = offsets.nose >= 0
    return compensation.starts_up & known & ~offsets.nose_is_of_mill


def details(hit: Hit, offsets: ToolOffsets) -> Details:
    from polarcheck.rules.wording.written import block_and_line

    setter = int(offsets.nose_set_in[hit.row])
    return {
        "nose": offsets.nose[hit.row],
        "has": f"is set by {block_and_line(hit.trace, setter)} to" if setter >= 0 else "has",
        "allowed": " or ".join(map(str, hit.trace.machine.compensation.nose_types)),
    }


def needs(offsets: ToolOffsets, compensation: CutterCompensation) -> Needs:
    return compensation.starts_up, {"nose": offsets.nose}
