from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.rules.rule import ERROR, Hits, graded, rule

if TYPE_CHECKING:
    from polarcheck.columns.modes.entry import Entry
    from polarcheck.columns.modes.modal import ModalStates
    from polarcheck.columns.modes.mode import PolarMode
    from polarcheck.columns.modes.spindles import Spindles
    from polarcheck.columns.path.path import ProgrammedPath
    from polarcheck.program.machines.machine import Machine
    from polarcheck.rules.hit import Details, Hit


@rule(
    ERROR,
    "the live tool is not running in this cutting move; {code_needed} is missing{or_started_by}",
    values=("code_needed",),
    gouges=True,
    at=("line", "arc_clockwise", "arc_counterclockwise"),
    once="live tool code",
    follows={"section": ("main-spindle-running-at-entry",)},
)
def live_tool_stopped_in_cut(
    modal: ModalStates, mode: PolarMode, path: ProgrammedPath, entry: Entry, spindles: Spindles, machine: Machine
) -> Hits:
    """
    Cutting move in the polar mode with the live tool stopped.

    The cutter is pressed into the part without turning, and breaks. Start the live tool before the approach and stop it
    after the retract: `G97 S2000 M33`. Nothing is said where the machine profile names no such code, nor in an excerpt
    that has none.

    A spindle that has a speed by its number, `S2=2000`, is started by its number, too: `M2=3`. Where nothing in the
    program starts it, that is a warning: which spindle has the tool is not known to the profile. So it is where M5 has
    stopped the spindle before, and no code behind that can have started the live tool.

    Source: builder's guide to G12.1, sample program.

    Bad, set m_codes.live_tool_on=["M33"], set m_codes.live_tool_off=["M5"]:

        O0001
        T0808
        G98 G0 X60. C0
        G12.1
        G1 C10. F1500     (expect: live-tool-stopped-in-cut)
        X40. F200
        C-10.
        X60. F1500
        G13.1
        M30

    Bad, set m_codes.live_tool_on=["M33"], set m_codes.live_tool_off=["M5"]:

        G98 G0 X60. C0
        S2000 M33
        G12.1
        G1 C10. F1500
        M5
        G1 X40. F200      (expect: live-tool-stopped-in-cut)
        C-10.
        X60. F1500
        G13.1

    Bad, machine siemens-transmit, tool 8:radius=4:

        T8 D1
        G94 S2=2000
        DIAMOF
        G0 X40 C0 Z5
        TRANSMIT
        G17
        G1 G42 X20 Y1 F300 (expect: live-tool-stopped-in-cut)
        Y10
        X-10
        Y-10
        X20
        Y1
        G40 X40
        TRAFOOF
        M30

    Bad, tool 8:radius=4:

        T0101
        G97 S1200 M3
        G99 G1 X50. Z-20. F0.2
        G0 Z20. M5
        T0808
        G98 G0 X60. C0
        G12.1
        G1 G42 X40. F200  (expect: live-tool-stopped-in-cut)
        C10.
        X-40.
        C-10.
        X40.
        C0
        G40 X60. F1500
        G13.1

    Good, set m_codes.live_tool_on=["M33"], set m_codes.live_tool_off=["M5"]:

        G98 G0 X60. C0
        S2000 M33
        G12.1
        G1 C10. F1500
        X40. F200
        C-10.
        X60. F1500
        G13.1
        M5
    """
    codes, unstarted = machine.m_codes, spindles.unstarted_speed >= 0
    expected = entry.expects(codes.live_tool_on and [*codes.live_tool_on, *codes.live_tool_off])
    stopped = mode.first_in_section(path.cuts & ~modal.live_tool & expected)
    # Where the main spindle was started in its place, that is the fault; a tool that ran before is another.
    ran = mode.anywhere_in_section(modal.live_tool & mode.in_polar)
    never = mode.first_in_section(path.cuts & (unstarted | (spindles.stopped_by >= 0)) & ~modal.live_tool)
    return graded(error=stopped, warning=never, follows={"section": ~ran})


def details(hit: Hit, spindles: Spindles) -> Details:
    from polarcheck.rules.remedies import or_by
    from polarcheck.rules.wording.written import executed_word

    codes, index = hit.trace.machine.m_codes, int(spindles.unstarted_speed[hit.row])
    if index >= 0:
        run = hit.trace.run
        speed = executed_word(run, index)
        number = "".join(character for character in speed.partition("=")[0] if character.isdigit())
        code = f"M{number}=3 or M{number}=4"
        return {
            "code_needed": code,
            "or_started_by": f", nothing starts the spindle with {speed} of line {hit.line(run.row[index])}",
        }
    if (stop := int(spindles.stopped_by[hit.row])) >= 0:
        started = f", {' or '.join(codes.spindle_off)} of line {hit.line(stop)} has stopped the spindle"
        return {"code_needed": "the code that starts it", "or_started_by": started}
    return {
        "code_needed": " or ".join(codes.live_tool_on),
        "or_started_by": or_by(hit, spindles, "starts it", "m_codes.live_tool_on"),
    }
