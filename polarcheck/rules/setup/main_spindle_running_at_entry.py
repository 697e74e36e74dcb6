from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.rules.rule import ERROR, Hits, graded, rule

if TYPE_CHECKING:
    from polarcheck.columns.modes.mode import PolarMode
    from polarcheck.columns.modes.spindles import Spindles
    from polarcheck.program.machines.machine import Machine
    from polarcheck.rules.hit import Details, Hit


@rule(ERROR, "{code} is in force at {switch}{spindle_remedy}", values=("code",), at=("on",), once="spindle code")
def main_spindle_running_at_entry(mode: PolarMode, spindles: Spindles, machine: Machine) -> Hits:
    """
    Main spindle not stopped before the polar mode.

    The main spindle is the C axis in the mode. It has to be stopped, M5, before it can be engaged and positioned. Many
    lathes start the live tool with M3, too; where the machine profile does not name codes of its own for the live tool,
    this is a note. In a section on the sub-spindle it is the sub-spindle that has to stand.

    Source: builder's guide to G12.1, sample program.

    Bad, set m_codes.live_tool_on=["M33"]:

        S1000 M3
        G98 G0 X60. C0
        M33
        G12.1             (expect: main-spindle-running-at-entry)
        G1 C10. F1500
        X60.
        G13.1

    Bad:

        S1000 M3
        G98 G0 X60. C0
        G12.1             (expect: main-spindle-running-at-entry)
        G1 X40. F200
        C10.
        X60.
        G13.1

    Good, set m_codes.live_tool_on=["M33"]:

        S1000 M3
        M5
        G98 G0 X60. C0
        M33
        G12.1
        G1 C10. F1500
        X60.
        G13.1
    """
    running = mode.enters & spindles.runs
    must_stop = spindles.are_no_live_tool | machine.polar.main_spindle_must_stop
    return graded(error=running & must_stop, note=running & ~must_stop)


def details(hit: Hit, spindles: Spindles, machine: Machine) -> Details:
    codes = machine.m_codes
    return {
        "code": " or ".join(codes.sub_spindle_on if spindles.on_sub_spindle[hit.row] else codes.spindle_on),
        "spindle_remedy": _remedy(hit, spindles),
    }


def _remedy(hit: Hit, spindles: Spindles) -> str:
    """
    How that is stopped before a section; where it may be the live tool, that it is asked about. Where that does
    not run in the section, the code of the main spindle may stand in the place of that of the live tool.
    """
    import numpy as np

    trace, row, codes = hit.trace, hit.row, hit.trace.machine.m_codes
    if not spindles.are_no_live_tool[row] and not trace.machine.polar.main_spindle_must_stop:
        return ": if that is the main spindle, stop it"
    off = codes.sub_spindle_off if spindles.on_sub_spindle[row] else codes.spindle_off
    stop = f"; write {next(iter(off), 'the code that stops it')} before the {hit.rotary} axis is engaged"
    cuts = trace.path.cuts & (trace.mode.section == trace.mode.section[row])
    is_live_tool = bool(codes.live_tool_on) and cuts.any() and not np.any(cuts & trace.modal.live_tool)
    return f"{stop}, and {' or '.join(codes.live_tool_on)} for the live tool" if is_live_tool else stop
