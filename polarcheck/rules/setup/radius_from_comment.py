from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.rules.rule import NOTE, rule

if TYPE_CHECKING:
    from polarcheck.columns.modes.offsets import ToolOffsets
    from polarcheck.columns.modes.tools import CalledTools
    from polarcheck.foundation.arrays import Mask


@rule(NOTE, "R {taken:length} is taken {origin}", values={"offset": "offset", "radius": "taken"}, at=("T",))
def radius_from_comment(tools: CalledTools, offsets: ToolOffsets) -> Mask:
    """
    Cutter radius taken from a comment.

    Asked for with --radius-from-comments (or radius_from_comments in polarcheck.toml): where the job knows no radius
    for an offset, the one that the comment beside its T word names is used. What follows holds only if the offset table
    says the same. Give it with --tool, or read the table in with --offsets.

    Where every ramp of a section is shorter than that radius, the comment tells the cutter and the program is the path
    of its center: R is taken as 0 there. The ramps may as well be too short, which only the offset table can tell.

    Source: comments as CAM posts write them; builder's guide to G12.1, T0808 (3/4" DIA. CUTTER).

    Bad, set job.radius_from_comments=true:

        T0808 (D=8. END MILL)   (expect: radius-from-comment)
        G98 G0 X60. C0
        G12.1
        G1 G41 X40. F200
        C-10.
        G40 X60.
        G13.1

    Bad, set job.radius_from_comments=true:

        T0808 (D=8. END MILL)   (expect: radius-from-comment)
        G98 G0 X50. C0
        G12.1
        G1 C10. F200
        G1 G41 X46.
        C-10.
        G40 X50.
        G13.1

    Good, set job.radius_from_comments=true, tool 8:radius=4:

        T0808 (D=8. END MILL)
        G98 G0 X60. C0
        G12.1
        G1 G41 X40. F200
        C-10.
        G40 X60.
        G13.1

    Good, set job.radius_from_comments=true:

        T0808 (D=8. END MILL)
        G10 P10008 R4. Q0
        G98 G0 X60. C0
        G12.1
        G1 G41 X40. F200
        C-10.
        G40 X60.
        G13.1

    Good:

        T0808 (D=8. END MILL)
        G98 G0 X60. C0
        G12.1
        G1 X40. F200
        C-10.
        X60.
        G13.1
    """
    return tools.calls_offset & offsets.radius_is_from_comment & ~offsets.sets_radius_after_call
