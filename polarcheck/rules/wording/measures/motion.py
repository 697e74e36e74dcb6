"""Measures of the rules about moves: lengths [mm]."""

from __future__ import annotations

from polarcheck.columns.path.arcs import Arcs
from polarcheck.columns.path.travel import Travel
from polarcheck.columns.words.unpointed import Unpointed
from polarcheck.program.machines.machine import Machine
from polarcheck.rules.wording.phrases.motion import beyond_travel


def difference_of_radii(arcs: Arcs, row: int) -> float:
    """By how much the end of an arc lies off the circle of its start."""
    return abs(float(arcs.start_radius[row] - arcs.end_radius[row]))


def half_chord(arcs: Arcs, row: int) -> float:
    """The least radius that reaches from start to end."""
    return float(arcs.chord[row]) / 2


def unpointed_count(unpointed: Unpointed, index: int) -> int:
    """How many coordinates a word without a decimal point stands for, itself among them."""
    return int(unpointed.in_increments[index] or unpointed.slips[index])


def axis_of_travel(machine: Machine, travel: Travel, row: int) -> str:
    """The axis that goes beyond its travel."""
    found = beyond_travel(machine, travel, row)
    return found.axis if found else ""


def position(machine: Machine, travel: Travel, row: int) -> float | None:
    """Where it goes, X as a radius."""
    found = beyond_travel(machine, travel, row)
    return found.value if found else None


def end_of_travel(machine: Machine, travel: Travel, row: int) -> float | None:
    """Where its travel ends, X as a radius."""
    found = beyond_travel(machine, travel, row)
    return found.limit if found else None
