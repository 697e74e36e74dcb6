from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.foundation.states import MM_PER_INCH
from polarcheck.rules.rule import WARNING, Hits, rule

if TYPE_CHECKING:
    from polarcheck.columns.modes.entry import Entry
    from polarcheck.columns.modes.offsets import ToolOffsets
    from polarcheck.rules.hit import Details, Hit

#: So far wear and a path of the tool center may take R from what a comment tells, or from 0 [mm].
_WEAR = 0.25

#: Radii that differ by less than this share are one.
_SAME_SHARE = 0.02


@rule(
    WARNING,
    "R {radius:length} {is_given}, the comment tells {radius_stated:length}: {comment}; {which_radius}",
    values=("offset", "radius", "radius_stated", "comment"),
    worse=("radius:radius_stated",),
    at=("T",),
    subject="size",
    doubts=(("compensation", "tool call"),),
)
def radius_contradicts_comment(entry: Entry) -> Hits:
    """
    Given radius that is not that of the program's own comment.

    With the wrong radius a bad program passes and a good one fails: what is found of compensation with this tool is
    listed under this finding. Measure the cutter, and look up the offset number: the last digits of T. A radius near
    that of the comment is wear, one near 0 the adjustment of a program that gives the path of the tool center; of these
    nothing is said.

    What counts is the comment beside the T word, in its block or alone on the line before or after it, and the line of
    a list of tools with its number. It names a cutter in plain words: EM10, CUTTER 10, D12 EM, 8MM DIA. CUTTER. A bar,
    a boring bar, a drill and a size of the part are no cutters.

    Source: builder's guide to G12.1, T0808 (3/4" DIA. CUTTER).

    Bad, tool 8:radius=.6:

        O1
        G20 G98
        T0808 (3/4 DIA. CUTTER)    (expect: radius-contradicts-comment)
        G0 X3. C0
        G12.1
        G1 G42 X1. F5.
        C.1
        G40 X3.
        G13.1
        M30

    Bad:

        O1
        G20 G98
        T0808 (3/4 DIA. CUTTER)    (expect: radius-contradicts-comment)
        G10 P8 R.6
        G0 X3. C0
        G12.1
        G1 G42 X1. F5.
        C.1
        G40 X3.
        G13.1
        M30

    Bad, tool 1:radius=4, tool 2:radius=4:

        O1
        (T1 D=12. CR=0. - FLAT END MILL)
        G21 G98
        T0101    (expect: radius-contradicts-comment)
        G0 X60. C0
        G12.1
        G1 G41 X40. F200
        C-10.
        G40 X60.
        G13.1
        T0202 (EM16)    (expect: radius-contradicts-comment)
        G0 X60. C0
        G12.1
        G1 G41 X40. F200
        C-10.
        G40 X60.
        G13.1
        M30

    Good, tool 1:radius=4, tool 2:radius=4:

        O1
        (BAR DIA 28)
        T0101 (MILL HEX 24 AF)
        G21 G98
        G0 X60. C0
        G12.1
        G1 G41 X40. F200
        C-10.
        G40 X60.
        G13.1
        T0202 (EM8, 2 FLATS)
        G0 X60. C0
        G12.1
        G1 G41 X40. F200
        C-10.
        G40 X60.
        G13.1
        M30

    Good, tool 8:radius=.37:

        O1
        G20 G98
        T0808 (3/4 DIA. CUTTER)
        G0 X3. C0
        G12.1
        G1 G42 X1. F5.
        C.1
        G40 X3.
        G13.1
        M30

    Good, tool 1:radius=6.3, tool 2:radius=6.3,diameter=12:

        O1
        G21 G98
        T0101 (D12 ROUGH)
        G0 X60. C0
        G12.1
        G1 G41 X40. F200
        C-10.
        G40 X60.
        G13.1
        T0202 (EM12)
        G0 X60. C0
        G12.1
        G1 G41 X40. F200
        C-10.
        G40 X60.
        G13.1
        M30

    Good, tool 8:radius=-.005:

        O1
        G20 G98
        T0808 (3/4 DIA. CUTTER)
        G0 X3. C0
        G12.1
        G1 G42 X1. F5.
        C.1
        G40 X3.
        G13.1
        M30
    """
    contradicts = (entry.radius_off_comment > _WEAR) & (abs(entry.radius_in_mode) > _WEAR)
    return Hits(contradicts, values={"radius": entry.radius_in_mode, "radius_stated": entry.radius_told})


def details(hit: Hit, offsets: ToolOffsets, entry: Entry) -> Details:
    from polarcheck.rules.wording.written import block_and_line, short

    number = int(hit.trace.tools.offset_number[hit.row])
    setter = int(offsets.radius_set_in[entry.first_in_mode[number]])
    by_block = f" by {block_and_line(hit.trace, setter)}" if setter >= 0 else ""
    return {
        "comment": short(offsets.radii_in_comments[number].comment),
        "is_given": f"is {'set' if by_block else 'given'} for offset {hit.offset}{by_block}",
        "which_radius": _which_radius(hit, entry),
    }


def _which_radius(hit: Hit, entry: Entry) -> str:
    """What may be wrong where R and the comment of an offset differ: the unit, the offset number, or one of both."""
    from polarcheck.rules.wording.offsets import job_scale, shown_offset
    from polarcheck.rules.wording.written import code_of

    tools, row = hit.trace.tools, hit.row
    given, stated = entry.radius_in_mode[row], entry.radius_told[row]
    if abs(given / stated - MM_PER_INCH) < _SAME_SHARE * MM_PER_INCH and hit.trace.lengths.scale[row] == 1.0:
        return f"in inch the comment fits: {code_of(hit.trace.machine, 'inch')} is missing"
    other = int(tools.tool[row])
    radius = tools.of_job[other].radius if other in tools.of_job else None
    is_same = radius and abs(radius * job_scale(hit.trace, hit.row) - stated) < _SAME_SHARE * stated
    if other != tools.offset_number[row] and is_same:
        return f"offset {shown_offset(tools, other)} has the R of the comment"
    if abs(given / stated - 2) < _SAME_SHARE:
        return "R may be given as the diameter: measure the cutter"
    return "measure the cutter, and correct the one that is wrong"
