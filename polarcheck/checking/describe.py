"""Phrases for messages about one row of the trace, in the program's own units."""

from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.checking.message import Quantity
from polarcheck.machines.modal import Units
from polarcheck.reading.translation import shown

if TYPE_CHECKING:
    from polarcheck.table.trace import Trace


def _quantity(trace: Trace, row: int, value: complex) -> Quantity:
    return Quantity(value, bool(trace.units[row] == Units.INCH), bool(trace.x_factor[row] < 1))


def _virtual(trace: Trace) -> str:
    return trace.machine.polar.virtual_axis


def _along(trace: Trace, row: int, length: float) -> str:
    """A way on the plane as the program writes it: along X on the diameter, else as it is."""
    shown = _quantity(trace, row, length)
    start, end = trace.start[row], trace.end[row]
    if start.imag == end.imag and start != end and shown.diameter:
        return f"{shown:diameter} in X on the diameter"
    return f"{shown:length}" + (f" in {_virtual(trace)}" if start.real == end.real and start != end else "")


def ramp(trace: Trace, row: int) -> str:
    """How far a ramp moves."""
    return _along(trace, row, float(trace.length[row]))


def ramp_needed(trace: Trace, row: int) -> str:
    """How far it must: R on the plane."""
    return _along(trace, row, abs(float(trace.radius[row])))


def missing_before(trace: Trace, section: int) -> str:
    """Where the G13.1 of a section is missing."""
    sections = trace.sections
    row = int(sections.leave[section])
    off = switch_off(trace, int(sections.enter[section]))
    if row >= len(trace) or trace.starts[row]:
        return f"{off} is missing at the end of the program"
    block = int(trace.run.block[row])
    text = trace.text.source.excerpt(int(trace.text.blocks.start[block]), int(trace.text.blocks.end[block]))
    return f"{off} is missing before line {int(trace.line[row])}, {' '.join(text.split())[:60]}"


def switch(trace: Trace, row: int) -> str:
    """The code in a row that switches the polar mode on or off, as in G12.1 or G113."""
    return shown(trace.machine.control.native_words, _switch(trace, row))


def _switch(trace: Trace, row: int) -> str:
    polar = trace.machine.polar
    return next((name for name in (*polar.on, *polar.off) if trace.codes(name)[row]), polar.on[0])


def switch_off(trace: Trace, row: int) -> str:
    """The code that ends the mode which the code in this row begins: G113 for G112."""
    polar = trace.machine.polar
    code = dict(zip(polar.on, polar.off, strict=False)).get(_switch(trace, row), polar.off[0])
    return shown(trace.machine.control.native_words, code)


def ramp_fault(trace: Trace, row: int) -> str:
    """What is wrong with a ramp that is shorter than R, or has no length at all."""
    if not trace.moves_plane[row]:
        code = "G40" if trace.codes("G40")[row] else f"G{trace.side[row]}"
        return f"is missing: no move on the plane follows {code}"
    radius = abs(float(trace.radius[row]))
    shown = _quantity(trace, row, radius)
    if trace.length[row] > 0:
        return f"moves {ramp(trace, row)}; with R {shown:length} it needs {ramp_needed(trace, row)}"
    return "does not move the tool" + (f"; it has to move R, {shown:length}, on the plane" if radius == radius else "")


def why_not_read(trace: Trace, row: int) -> str:
    """What keeps the control from knowing the move after this one in time."""
    following = row + 1
    while following < len(trace) and trace.in_polar[following] and not trace.length[following] > 0:
        following += 1
    stops = trace.codes(*trace.machine.m_codes.stops_reading)
    for at in range(row, following):
        if stops[at]:
            return f"line {trace.line[at]} stops reading ahead"
    count = following - row - 1
    least = trace.machine.compensation.read_ahead - 2
    blocks = f"{count} blocks" if count > 1 else "a block"
    return f"{blocks} without a move on the plane follow{'' if count > 1 else 's'}, this control reads past {least}"


def point(trace: Trace, row: int, value: complex) -> str:
    """A plane point as X and C words."""
    return f"{_quantity(trace, row, value):point}".replace("C", _virtual(trace))
