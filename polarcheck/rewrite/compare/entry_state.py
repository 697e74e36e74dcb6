"""The state at the beginning of a polar section, and what differs there between two revisions."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from polarcheck.rewrite.compare.compared_sections import Stretch
from polarcheck.rewrite.compare.comparison_report import Difference
from polarcheck.rewrite.compare.orders import speed_in_force
from polarcheck.rewrite.compare.terms import Terms
from polarcheck.rules.quantity import rounded
from polarcheck.rules.wording.offsets import called_tool

#: What is compared, as a sentence names it, and the unit of its value; a state without one is a text.
_STATES = {
    "tool": ("the tool", ""),
    "radius": ("R", "mm"),
    "c_angle": ("C at the beginning of the section", "deg"),
    "spindle": ("the main spindle", ""),
    "live_tool": ("the live tool", ""),
    "speed": ("S", "rev/min"),
    "plane": ("the plane", ""),
}


def _numbers(section: Stretch) -> dict[str, float]:
    """Return R of the compensation or in force [mm], C from 0 to 360 [deg], and S as written; NaN is not known."""
    trace, number = section.trace, section.section
    return {
        "radius": abs(float(trace.compensation.radius[_row_of_tool(section)])),
        "c_angle": float(trace.path.section_entry[number]) % 360 if trace.path.knows_section_entry[number] else np.nan,
        "speed": float(speed_in_force(trace)[section.enter]),
    }


def _texts(section: Stretch) -> dict[str, str]:
    """Return tool and offset as the program calls them, which spindles run, the code of the plane; empty for none."""
    trace, enter, row = section.trace, section.enter, _row_of_tool(section)
    plane = int(trace.modal.state("plane")[enter])
    return {
        "tool": called_tool(trace.tools, row) if trace.tools.has_called_tool[row] else "",
        "spindle": "runs" if trace.modal.spindle[enter] else "stands",
        "live_tool": "runs" if trace.modal.live_tool[enter] else "stands",
        "plane": f"G{plane}" if plane else "",
    }


def _row_of_tool(section: Stretch) -> int:
    trace = section.trace
    compensated = np.flatnonzero((trace.mode.section == section.section) & trace.compensation.compensates)
    return int(compensated[0]) if len(compensated) else section.enter


def entry_differences(old: Stretch, new: Stretch, *, is_same_machine: bool, terms: Terms) -> Iterator[Difference]:
    """Yield what differs at the start of two sections; across machines only states that mean the same on both."""
    lines = [part.line(part.enter) for part in (old, new)]
    left_out = set() if is_same_machine else {"tool", "plane", *_of_one_machine(old, new)}
    (numbers, texts), (new_numbers, new_texts) = ((_numbers(part), _texts(part)) for part in (old, new))
    least = {"c_angle": terms.angle, "radius": terms.tolerance}
    for what, (name, unit) in _STATES.items():
        if what in left_out:
            continue
        if what in texts:
            value, new_value = texts[what], new_texts[what]
            if value != new_value:
                text = f"{name}: {value or 'none'} has become {new_value or 'none'}"
                yield Difference(what, text, value or None, new_value or None, "", *lines)
            continue
        number, new_number = numbers[what], new_numbers[what]
        apart = abs(number - new_number)
        if what == "c_angle":
            apart = min(apart, 360 - apart)
        # Where R or C is not known in one of them, that is no difference, and the section says so.
        is_open = np.isnan(apart) and (what in least or np.isnan(number) == np.isnan(new_number))
        if not (is_open or apart <= least.get(what, 0.0)):
            was, is_now = (_value_text(part, what, of_part) for part, of_part in ((old, number), (new, new_number)))
            text = f"{name} was {was} and is {is_now}"
            yield Difference(what, text, rounded(number), rounded(new_number), unit, *lines)


def _of_one_machine(old: Stretch, new: Stretch) -> Iterator[str]:
    """Yield the states that only one of two machines has, or whose codes its profile does not name."""
    traces = old.trace, new.trace
    names_live_tool = [bool(trace.machine.m_codes.live_tool_on) for trace in traces]
    if not all(names_live_tool):
        yield "live_tool"
    # Without a code for the live tool M3 may start either.
    if names_live_tool[0] != names_live_tool[1] or not all(trace.machine.m_codes.spindle_on for trace in traces):
        yield "spindle"
    if any(trace.machine.polar.plane_is_fixed for trace in traces):
        yield "c_angle"
    if any(np.isnan(speed_in_force(trace)).all() for trace in traces):
        yield "speed"


def _value_text(part: Stretch, what: str, value: float) -> str:
    if np.isnan(value):
        return "not known"
    if what == "radius":
        return part.quantity(value, part.enter).shown("length", 1)
    return f"{value:.3f}".rstrip("0").rstrip(".")
