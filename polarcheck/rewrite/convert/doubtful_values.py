"""The values of two profiles on which a new program rests: those in doubt, and the sense of Z where it differs."""

from __future__ import annotations

from collections.abc import Container, Iterator

import msgspec
import numpy as np

from polarcheck.checking.settings import Settings
from polarcheck.columns.metal.turning_tools import z_into_part
from polarcheck.columns.trace import Trace
from polarcheck.foundation.states import Units
from polarcheck.program.machines.machine import Machine
from polarcheck.program.machines.own_language import shown
from polarcheck.rewrite.writing.outcome import Doubt, Refusal

#: Z stays as it is: where it grows into the part on one lathe alone, somebody has to say that this is right.
SENSE_OF_Z = "control.z_into_part"
#: Keys on which the numbers of a new program may rest.
KEYS = (
    "control.number_without_point",
    "control.units",
    "control.x",
    SENSE_OF_Z,
    "feed.dwell_words",
    "polar.feed_measures",
    "polar.x",
    "polar.zero_angle",
)


class Basis(msgspec.Struct):
    """On which keys the changed numbers of a program rest. rows: key -> the first row with such a number."""

    rows: dict[str, int] = {}

    def add(self, key: str, row: int) -> None:
        """Note that a number of a row is another one in the new program because of the values of a key."""
        self.rows[key] = min(row, self.rows.get(key, row))


def doubts(basis: Basis, trace: Trace, source: Settings, target: Settings) -> Iterator[Doubt]:
    """
    Yield the values in doubt that differ between two lathes and make a number of the new program another one, in the
    order of lines; then the sense of Z where that differs.

    trace: of the original, for `source`.
    """
    for key, row in sorted(basis.rows.items(), key=lambda item: (item[1], item[0])):
        ours, theirs = (_value(settings.machine, key) for settings in (source, target))
        are_written = [False, False]
        if key == "control.units":
            ours = "inch" if trace.lengths.units[row] == Units.INCH else "mm"
            are_written = [bool(trace.modal.sets("units")[: row + 1].any()), bool(target.machine.codes(ours))]
        elif key in ("control.x", "polar.x"):
            are_written = [_has_switch_of_x(trace, row), _writes_switch_of_x(target.machine, key)]
        titles = [settings.machine.title for settings in (source, target)]
        # A code in the program leaves no doubt.
        of = [
            title
            for title, is_written, settings in zip(titles, are_written, (source, target), strict=True)
            if key in settings.doubtful and not is_written
        ]
        if ours != theirs and of:
            yield Doubt(trace.line(row), key, _shown(ours), _shown(theirs), of)
    named = np.flatnonzero(trace.blocks.has("Z", "W"))
    ours, theirs = z_into_part(trace), target.machine.control.z_into_part or "minus"
    if len(named) and ours and ours != theirs:
        line = trace.line(named[0])
        yield Doubt(line, SENSE_OF_Z, ours, theirs, [source.machine.title, target.machine.title])


def note_on_units(trace: Trace, source: Settings, target: Settings) -> list[str]:
    """Return a note where a program that does not name its unit gets a code for it, and the unit is in doubt."""
    units = source.machine.control.units
    codes = target.machine.codes(units)
    if trace.modal.sets("units").any() or not codes or "control.units" not in source.doubtful:
        return []
    if units == target.machine.control.units:
        return []
    text = (
        f"the program does not say in which unit it counts: {codes[0]}, since {source.machine.title} counts in {units}"
    )
    return [f"{text} (control.units, which is in doubt)"]


def unaccepted(found: list[Doubt], accepted: Container[str]) -> list[Refusal]:
    """Return a reason for each value in doubt that nobody has accepted."""
    how = "look it up at the lathe, then --accept {key}, or give it in a machine file of your own"
    return [
        Refusal(doubt.line, f"{said(doubt)}: {how.format(key=doubt.key)}")
        for doubt in found
        if doubt.key not in accepted
    ]


def said(doubt: Doubt) -> str:
    """Return in words which numbers rest on a value in doubt."""
    if doubt.key == SENSE_OF_Z:
        ours, theirs = doubt.machines
        here = f"{doubt.value} Z on {ours} and {doubt.new_value} Z on {theirs}"
        return f"the way into the part is {here}, and Z stays as it is ({SENSE_OF_Z})"
    values = f" ({doubt.value} becomes {doubt.new_value})" if doubt.value else ""
    return f"numbers change with {doubt.key}{values}, which is in doubt for {' and for '.join(doubt.machines)}"


def _has_switch_of_x(trace: Trace, row: int) -> bool:
    control = trace.machine.control
    switches = trace.blocks.codes(*control.x_radius_words, *control.x_diameter_words)
    return bool(switches[: row + 1].any())


def _writes_switch_of_x(machine: Machine, key: str) -> bool:
    """The new program says itself what X is: in its head, or before the mode."""
    control = machine.control
    if key == "control.x":
        return bool(control.x_without_words and control.x_diameter_words)
    switches = [shown(control.native_words, word) for word in (*control.x_radius_words, *control.x_diameter_words)]
    return any(text in switches for text in machine.writing.before)


def _value(machine: Machine, key: str) -> object:
    group, _, name = key.partition(".")
    return getattr(getattr(machine, group), name)


def _shown(value: object) -> str:
    """A value of one word; empty for a table."""
    return value if isinstance(value, str) else ""
