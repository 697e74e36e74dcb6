from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.rules.rule import WARNING, Hits, rule

if TYPE_CHECKING:
    from polarcheck.columns.modes.entry import Entry

#: So far wear and a path of the tool center may take R from what a comment tells, or from 0 [mm].
_WEAR = 0.25


@rule(
    WARNING,
    "R {given:length} {is_given}, the comment tells {told:length}: {comment}; {which_radius}",
    values={"offset": "offset", "radius": "given", "radius_stated": "told", "comment": "comment"},
    worse=("radius:radius_stated",),
    at=("T",),
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
    return Hits(contradicts, values={"given": entry.radius_in_mode, "told": entry.radius_told})
