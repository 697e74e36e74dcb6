"""The state at the beginning of a polar section, and what differs there between two revisions."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from polarcheck.rewrite.compare.compared_sections import Stretch
from polarcheck.rewrite.compare.comparison_report import Difference
from polarcheck.rewrite.compare.orders import speed_in_force
from polarcheck.rewrite.compare.terms import Terms
from polarcheck.rules.quantity import rounded
from polarcheck.rules.wording.offsets import called_tool

_UNITS = {"radius": "mm", "c_angle": "deg", "speed": "rev/min"}
_NAMES = {
    "tool": "the tool",
    "radius": "R",
    "c_angle": "C at the beginning of the section",
    "spindle": "the main spindle",
    "live_tool": "the live tool",
    "speed": "S",
    "plane": "the plane",
}


class Entry(NamedTuple):
    """
    The state at the start of a section; NaN or empty if it is not known.

    tool: tool and offset as the program calls them.
    radius: R of the compensation, or the one in force [mm].
    c_angle: from 0 to 360 [deg].
    speed: S as written.
    plane: code of the plane, as G17.
    """

    tool: str
    radius: float
    c_angle: float
    spindle: str
    live_tool: str
    speed: float
    plane: str


def entry_of(of_section: Stretch) -> Entry:
    """Return the state of a section."""
    trace, section, enter = of_section.trace, of_section.section, of_section.enter
    compensated = np.flatnonzero((trace.mode.section == section) & trace.compensation.compensates)
    row = int(compensated[0]) if len(compensated) else enter
    angle = float(trace.path.section_entry[section]) % 360 if trace.path.knows_section_entry[section] else np.nan
    plane = int(trace.modal.state("plane")[enter])
    return Entry(
        tool=called_tool(trace.tools, row) if trace.tools.has_called_tool[row] else "",
        radius=abs(float(trace.compensation.radius[row])),
        c_angle=angle,
        spindle=_runs(bool(trace.modal.spindle[enter])),
        live_tool=_runs(bool(trace.modal.live_tool[enter])),
        speed=float(speed_in_force(trace)[enter]),
        plane=f"G{plane}" if plane else "",
    )


def _runs(on: bool) -> str:
    return "runs" if on else "stands"


def entry_differences(old: Stretch, new: Stretch, *, is_same_machine: bool, terms: Terms) -> Iterator[Difference]:
    """Yield what differs at the start of two sections; across machines only states that mean the same on both."""
    before, after = (entry_of(part) for part in (old, new))
    lines = [part.line(part.enter) for part in (old, new)]
    machine_specific = {"tool", "plane", *_of_one_machine(old, new)}
    for what in Entry._fields:
        if not is_same_machine and what in machine_specific:
            continue
        value, new_value = getattr(before, what), getattr(after, what)
        if isinstance(value, str):
            if value != new_value:
                text = f"{_NAMES[what]}: {value or 'none'} has become {new_value or 'none'}"
                yield Difference(what, text, value or None, new_value or None, "", *lines)
            continue
        apart = abs(value - new_value)
        if what == "c_angle":
            apart = min(apart, 360 - apart)
        least = {"c_angle": terms.angle, "radius": terms.tolerance}.get(what, 0.0)
        if (np.isnan(value) and np.isnan(new_value)) or apart <= least:
            continue
        if what in ("radius", "c_angle") and np.isnan(apart):
            continue  # one of them is not known: that is no difference, and the section says so
        texts = [_value_text(part, what, number) for part, number in ((old, value), (new, new_value))]
        yield Difference(
            what,
            f"{_NAMES[what]} was {texts[0]} and is {texts[1]}",
            rounded(value),
            rounded(new_value),
            _UNITS[what],
            *lines,
        )


def _of_one_machine(old: Stretch, new: Stretch) -> Iterator[str]:
    """Yield the states that only one of two machines has, or whose codes its profile does not name."""
    traces = old.trace, new.trace
    for what, codes in (("live_tool", "live_tool_on"), ("spindle", "spindle_on")):
        if not all(getattr(trace.machine.m_codes, codes) for trace in traces):
            yield what
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
