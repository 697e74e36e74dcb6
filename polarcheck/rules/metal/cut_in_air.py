from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.rules.causes import OUT_OF_PLACE
from polarcheck.rules.rule import WARNING, Hits, rule

if TYPE_CHECKING:
    from polarcheck.columns.metal.air_cuts import AirCuts
    from polarcheck.columns.metal.bar import Bar
    from polarcheck.rules.hit import Details, Hit


@rule(
    WARNING,
    "{in_air}",
    values=("z",),
    is_symptom=True,
    once="section",
    subject="stock",
    doubts=(("metal", "section"),),
    follows={"section": (*OUT_OF_PLACE, "contour-at-two-depths")},
)
def cut_in_air(air_cuts: AirCuts) -> Hits:
    """
    Section that cuts only air.

    The part comes off the machine without its shape, and the next tool meets the metal. The depth word is missing, so
    that the retract moves nowhere; its sign is wrong, so that the tool goes away from the part to cut and towards it to
    retract; the cut stands above the face that the program has turned or `[stock]` names, or above all others; it runs
    outside the bar, as in a program in inch that the control reads in mm, or goes far out of it with one word; or the
    same section is cut again at the same angle of C, since an index is missing or written twice; or a subprogram that
    is repeated goes down to the same depth each time, which was meant to be an increment. Programs with their origin at
    the back, which cut above Z0 alone, are not meant, nor are spring passes.

    Source: builder's guide to G12.1, order of a section.

    Bad, tool 1:radius=4:

        T0101
        G98 G0 X60. Z2. C0
        G12.1
        G1 X60. F1500
        G42 X30. C0 F200
        C8.66             (expect: cut-in-air)
        X0 C17.321
        X-30. C8.66
        C-8.66
        X0 C-17.321
        X30. C-8.66
        C0
        G40 X60. F1500
        Z2.
        G13.1
        G0 X100. Z50.

    Bad, tool 1:radius=4:

        T0101
        G98 G0 X60. Z2. C0
        G12.1
        G1 X60. F1500
        Z5.               (expect: cut-in-air)
        G42 X30. C0 F200
        C8.66
        X0 C17.321
        X-30. C8.66
        C-8.66
        X0 C-17.321
        X30. C-8.66
        C0
        G40 X60. F1500
        Z2.
        G13.1
        G0 X100. Z50.

    Bad, tool 1:radius=4:

        O1
        T0101
        G98 G0 X60. Z2. C0
        G12.1
        G1 X60. Z0 F1500
        M98 P30100
        Z2.
        G13.1
        M30
        O100
        G1 Z-2. F200
        G42 X30. C0
        C8.66             (expect: cut-in-air)
        X0 C17.321
        X-30. C8.66
        C-8.66
        X0 C-17.321
        X30. C-8.66
        C0
        G40 X60.
        M99

    Bad, tool 1:radius=4, set job.stock.diameter=46:

        T0101
        G98 G0 X64. Z2. C0
        G12.1
        G1 X64. C32. F1500
        Z-5.
        G41 X30. C32. F200
        C-112.            (expect: cut-in-air)
        G40 X64. F1500
        Z2.
        G13.1
        G0 X100. Z50.

    Good, tool 1:radius=4:

        T0101
        G98 G0 X60. Z2. C0
        G12.1
        G1 X60. F1500
        Z-5.
        G42 X30. C0 F200
        C8.66
        X0 C17.321
        X-30. C8.66
        C-8.66
        X0 C-17.321
        X30. C-8.66
        C0
        G40 X60. F1500
        Z2.
        G13.1
        G0 X100. Z50.
    """
    follows = {"program": air_cuts.is_outside_bar, "loop": air_cuts.goes_outside}
    return Hits(air_cuts.reason > 0, follows=follows)


def details(hit: Hit, air_cuts: AirCuts, bar: Bar) -> Details:
    return {"z": hit.trace.path.z[hit.row], "in_air": _in_air(hit, air_cuts, bar)}


def _in_air(hit: Hit, air_cuts: AirCuts, bar: Bar) -> str:
    """What is cut in air, and the witness."""
    from polarcheck.columns.metal.air_cuts import Reason
    from polarcheck.rules.wording.metal import bar_ends_at, of_line

    trace, row = hit.trace, hit.row
    z, enter = f"Z{hit.number(trace.path.z[row])}", int(trace.mode.sections.enter[trace.mode.section[row]])
    match air_cuts.reason[row]:
        case Reason.DEPTH_MISSING:
            why = "and the retract moves nowhere: a Z word for the depth is missing"
            return f"cuts at {z}, where the section begins, {why}"
        case Reason.SIGN_WRONG:
            above = f"above Z{hit.number(air_cuts.approach[row])} of the approach"
            return f"cuts at {z}, {above}, and retracts towards the part: check the sign of Z"
        case Reason.ABOVE_FACE:
            first, last = bar.known.face_lines
            lines = f"line {first}" if first == last else f"lines {first} to {last}"
            source = f"turned in {lines}" if first else "[stock]"
            face = hit.number(bar.face_as_written)
            return f"cuts at {z}, above the face at Z{face} ({source}): the section takes nothing off"
        case Reason.OTHERS_BELOW:
            where = of_line(trace, trace.axes.commands_z, row)
            if air_cuts.is_cut_below[row]:
                other = hit.number(-trace.path.z[row])
                return f"cuts at {z}{where}, and other cuts are at Z{other}: the sign of Z is missing"
            why = "and the program cuts below Z0 elsewhere: a Z word for the depth is missing"
            return f"cuts at {z}{where}, {why}"
        case Reason.OUTSIDE_BAR:
            largest = 2 * bar_ends_at(hit, bar)
            return f"runs outside the bar of {hit.length(largest)} all the way: check the units and X"
        case Reason.BLOCKS_REPEATED:
            where = of_line(trace, trace.axes.commands_z, row)
            return f"these blocks cut at {z}{where} each time that they are repeated: write the depth as an increment"
        case Reason.POINT_OUTSIDE:
            end = complex(trace.path.end[row])
            largest = 2 * bar_ends_at(hit, bar)
            return f"goes to {hit.point_off_center(end)}, far outside the bar of {hit.length(largest)}: check the word"
        case _:
            # Rounded, so that nothing is no 1.8e-15 and no -0.
            angle = round(float(trace.path.c_angle[enter]), 3) + 0.0
            return f"this section was cut before at the same angle of C ({angle:g} deg): it takes nothing off; index C"
