from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.rules.rule import NOTE, rule

if TYPE_CHECKING:
    from polarcheck.columns.modes.offsets import ToolOffsets
    from polarcheck.columns.modes.tools import CalledTools
    from polarcheck.foundation.arrays import Mask
    from polarcheck.rules.hit import Details, Hit


@rule(NOTE, "R {radius:length} is taken {origin}", values=("offset", "radius"), at=("T",))
def radius_from_comment(tools: CalledTools, offsets: ToolOffsets) -> Mask:
    """
    Cutter radius taken from a comment.

    With --radius-from-comments (or radius_from_comments in polarcheck.toml) the radius in the comment beside a T word
    is taken where the job gives none for the offset. What follows holds only if the offset table says the same. Give it
    with --tool, or read the table in with --offsets.

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


def details(hit: Hit, offsets: ToolOffsets, tools: CalledTools) -> Details:
    from polarcheck.rules.wording.offsets import option
    from polarcheck.rules.wording.written import short

    radius = float(offsets.radius_of_offset[hit.row])
    comment = short(offsets.radii_from_comments[int(tools.offset_number[hit.row])].comment)
    lines, are_all = _sections_of_center(hit)
    if not lines:
        return {"radius": radius, "origin": f"from the comment: {comment}"}
    shorter = "every ramp is shorter there, as on a path of the tool center"
    remedy = f"{shorter}; give {option(tools, hit.row, 'radius')}"
    if are_all:
        return {"radius": 0.0, "origin": f"in place of {hit.length(radius)} of the comment {comment}: {remedy}"}
    sections = f"{'line' if len(lines) == 1 else 'lines'} {', '.join(map(str, lines))}"
    return {"radius": radius, "origin": f"from the comment {comment}, but 0 in the polar mode of {sections}: {remedy}"}


def _sections_of_center(hit: Hit) -> tuple[list[int], bool]:
    """Lines of the G12.1 of the sections of a T word in which R is taken as 0; whether it has no others with ramps."""
    import numpy as np

    trace, row = hit.trace, hit.row
    called = np.flatnonzero(trace.tools.calls_offset)
    until = int(np.append(called, len(trace))[np.searchsorted(called, row, side="right")])
    ramps = trace.compensation.starts_up | trace.compensation.cancels
    has_ramps = trace.mode.enters & trace.mode.anywhere_in_section(ramps)
    enters = row + np.flatnonzero(has_ramps[row:until])
    of_center = trace.compensation.is_path_of_center[enters]
    return trace.blocks.line[enters[of_center]].tolist(), bool(of_center.all())
