from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.foundation.states import MOVES
from polarcheck.rules.causes import FAULTS_OF_CONTOUR
from polarcheck.rules.rule import WARNING, rule

if TYPE_CHECKING:
    from polarcheck.columns.contour.pass_differences import Difference, PassDifferences
    from polarcheck.columns.path.arcs import Arcs
    from polarcheck.foundation.arrays import Mask
    from polarcheck.rules.hit import Details, Hit

#: Points farther from each other than this are two [mm].
_APART = 1e-3


@rule(
    WARNING,
    "{pass_difference}; all else in this pass is {alike} {other_pass}",
    values=("difference", "other_line"),
    worse=("difference",),
    subject="side",
    follows={
        "block": ("arc-sweep-above-limit",),
        "twin": FAULTS_OF_CONTOUR,
        "motion": ("rapid-along-contour",),
    },
    is_symptom=True,
)
def passes_differ(pass_differences: PassDifferences) -> Mask:
    """
    Pass of a contour that differs from another pass of it in one block.

    The same contour is cut at several depths, or in several sections, and one pass is unlike the others in one word: a
    digit or a sign is wrong, or a block is missing; or the words are the same, and one code or two blocks stand
    elsewhere. The wall has a step there. Of several passes the one that differs from the others is reported, of two the
    later one. A side that is moved on one level may be meant. A finish and its roughing are compared where they have
    the same number of blocks, and one lies beside the other but for one point. Passes of a section that differ in G41
    and G42 alone are reported where they have different depths: at one depth both cut the walls of a slot.

    Source: B-62764EN/01, p. 53 (a contour in several passes).

    Bad, tool 1:radius=3:

        T0101
        G98 G0 X100. Z2. C0
        G12.1
        G1 Z-5. F200
        G42 X40.
        C9.
        X12. C22.
        X-34. C14.
        X-28. C-11.
        X10. C-19.
        X40. C-8.
        C0
        G40 X100.
        Z-10.
        G42 X40.
        C9.
        X12. C22.
        X-34. C14.
        X-28. C-11.
        X10. C-16.         (expect: passes-differ)
        X40. C-8.
        C0
        G40 X100.
        G13.1

    Good, tool 1:radius=3:

        T0101
        G98 G0 X100. Z2. C0
        G12.1
        G1 Z-5. F200
        G42 X40.
        C20.
        X-40.
        C-20.
        X40.
        C0
        G40 X100.
        Z-10.
        G42 X40.
        C20.
        X-50.
        C-20.
        X40.
        C0
        G40 X100.
        G13.1
    """
    # Compares nothing: the table compares the moves of passes that begin and end at the same points.
    return pass_differences.differs


def details(hit: Hit, arcs: Arcs, pass_differences: PassDifferences) -> Details:
    path, difference = hit.trace.path, pass_differences.found[hit.row]
    other, (first, last) = difference.other, (hit.line(row) for row in (difference.first, difference.last))
    return {
        "difference": None if difference.is_missing else abs(path.end[hit.row] - path.end[other]),
        "other_line": hit.line(other),
        "pass_difference": f"a block as in line {hit.line(other)} is missing before this one"
        if difference.is_missing
        else _difference(hit, arcs, difference),
        "alike": "as in" if difference.beside is None else "as far from",
        "other_pass": f"lines {first} to {last}" if last > first else f"line {first}",
    }


def _difference(hit: Hit, arcs: Arcs, difference: Difference) -> str:
    """What is other in a row than in that of another pass."""
    from polarcheck.rules.wording.arcs import written_arc

    trace, row, other, line = hit.trace, hit.row, difference.other, hit.line(difference.other)
    side, its_side = (trace.compensation.side[at] for at in (row, other))
    if side != its_side:
        return f"G{side} stands here, and G{its_side} in line {line}"
    here, there = (complex(trace.path.end[at]) for at in (row, other))
    if difference.beside is not None:
        beside = difference.beside
        distance, place = hit.length(beside.offset), hit.point_off_center(beside.place)
        end = hit.point_off_center(here)
        return f"this block ends at {end}, and not {distance} beside that of line {line}, at {place}"
    if abs(here - there) > _APART:
        ends = hit.point_off_center(here), hit.point_off_center(there)
        return f"this block ends at {ends[0]}, line {line} at {ends[1]}"
    for ramp, does in ((trace.compensation.starts_up, "begins"), (trace.compensation.cancels, "ends")):
        if ramp[row] != ramp[other]:
            return (
                f"this block {does} the compensation, line {line} does not"
                if ramp[row]
                else (f"line {line} {does} the compensation, this block does not")
            )
    if trace.path.is_arc[row] and trace.path.is_arc[other]:
        codes = [trace.machine.codes(MOVES[int(trace.axes.motion[at])])[0] for at in (row, other)]
        arc, its = (f"{code} {written_arc(trace, arcs, at)}" for code, at in zip(codes, (row, other), strict=True))
        return f"this block is {arc}, line {line} {its}"
    return f"this block is another move than line {line}"
