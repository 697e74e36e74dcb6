"""Keys of machine files that were called otherwise: whoever still writes the old name is told the new one."""

from __future__ import annotations

from polarcheck.foundation.errors import MachineError

#: Old name -> new name; a whole table by its name alone.
RENAMED = {
    "meanings": "known_parameters",
    "polar.switch_words": "polar.words_beside_switch",
    "polar.virtual_axis_is": "polar.virtual_axis_programming",
    "polar.virtual_axis_increment": "polar.virtual_axis_incremental",
    "polar.other_virtual_axis_of": "polar.other_controls",
    "polar.other_virtual_axis": "polar.virtual_axis_of_other_controls",
    "polar.other_on": "polar.on_of_other_controls",
    "feed.inheritance": "feed.carried_into_polar",
    "compensation.start_up_moving": "compensation.start_up_with_move",
    "m_codes.stops_reading": "m_codes.stops_reading_ahead",
    "macro.increment": "control.least_increment",
}


def refuse(key: str, profile: str) -> None:
    """Raises MachineError, naming the profile and the new name, for a key or table of an old name."""
    if key in RENAMED:
        raise MachineError(f"{profile}: {key} is now {RENAMED[key]}")
