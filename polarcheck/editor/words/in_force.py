"""The modal codes in force at a block, as the program or the power-on state has set them."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from polarcheck.columns.trace import Trace
from polarcheck.foundation.states import OF_CODE, STATES
from polarcheck.program.machines.code_tables import code, modal_tables, spelled
from polarcheck.program.machines.machine import Machine

#: The modal groups in the order in which they are listed.
_SHOWN = (
    *("motion", "plane", "side", "units", "distance", "feed_mode", "speed", "work_offset"),
    *("drilling", "scaling", "rotation", "mirror", "modal_call"),
)
_TITLES = {
    "side": "cutter compensation",
    "feed_mode": "feed mode",
    "feed_axes": "what F is along",
    "arc_feed": "F on arcs",
    "corner": "outer corners",
    "speed": "spindle speed",
    "work_offset": "work offset",
    "drilling": "drilling cycles",
    "mirror": "mirror image",
    "modal_call": "modal calls",
}


def group_of(word: str, machine: Machine) -> str:
    """Return the modal group of a code; empty if it has none."""
    if _acts_once(word, machine):
        return ""
    names, groups, _ = modal_tables(machine)
    number = code(word)
    group = int(groups[number]) if 0 <= number < len(groups) else 0
    return names[group - 1] if group else ""


def _acts_once(word: str, machine: Machine) -> bool:
    """Return True for a code that ends scaling elsewhere, and here counts for its own block: G50 S2500."""
    return word in machine.codes("coordinate_setting")


def title_of(group: str) -> str:
    """Return the name of a modal group for people."""
    return _TITLES.get(group, group)


def code_in_force(trace: Trace, group: str, row: int) -> str:
    """Return the code of a modal group that is in force behind a row; empty if none is, or nobody knows which."""
    if row < 0 or not (_is_set(trace, group, row) or str(getattr(trace.machine.power_on, group, ""))):
        return ""
    state = int(trace.modal.state(group)[row])
    return _names(trace.machine)[group].get(state, _of_number(trace.machine, group, state))


def codes_in_force(trace: Trace, row: int) -> list[str]:
    """Return the codes in force behind a row, in the order of their groups."""
    codes = (code_in_force(trace, group, row) for group in _SHOWN)
    return [word for word in dict.fromkeys(codes) if word and not _acts_once(word, trace.machine)]


def _is_set(trace: Trace, group: str, row: int) -> bool:
    """Return True if a code of the group stands in the program up to a row."""
    begins = np.flatnonzero(trace.blocks.starts[: row + 1])
    return bool(trace.modal.sets(group)[int(begins[-1]) if len(begins) else 0 : row + 1].any())


def _names(machine: Machine) -> Mapping[str, dict[int, str]]:
    return machine.cached("states of the editor", lambda: _named(machine))


def _named(machine: Machine) -> dict[str, dict[int, str]]:
    """Return for each group the first code that sets each state, where a state has codes of its own."""
    names_of_groups: dict[str, dict[int, str]] = {}
    for group, states in STATES.items():
        names = names_of_groups.setdefault(group, {})
        for key, state in states.items():
            words = machine.codes(key)
            if state != OF_CODE and words and key not in ("motion_not_followed", "thread_cutting"):
                names.setdefault(int(state), words[0])
    # Cycles of motion are one state of several codes.
    names_of_groups["motion"].pop(9, None)
    return names_of_groups


def _of_number(machine: Machine, group: str, state: int) -> str:
    """Return the code that is its own state."""
    for key, kind in STATES[group].items():
        for word in machine.codes(key) if kind == OF_CODE else ():
            if code(word) // 10 == state and state:
                return spelled("G", code(word))
    return ""
