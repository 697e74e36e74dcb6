"""Whether the code lists of a machine hold codes, and no code stands for two states of one modal group."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from polarcheck.errors import MachineError
from polarcheck.machines.code_lists import GCodes, GCodeSystem, is_code, numbers
from polarcheck.machines.machine import Machine, MCodes
from polarcheck.machines.modal import STATES
from polarcheck.machines.parameters import Origin

#: Table -> its lists of codes, and the letters that they begin with.
_LISTS = {
    "control": (("known_codes",), "G"),
    "g_codes": (GCodes.__struct_fields__, "G"),
    "g_code_system_a": (GCodeSystem.__struct_fields__, "G"),
    "g_code_system_b": (GCodeSystem.__struct_fields__, "G"),
    "g_code_system_c": (GCodeSystem.__struct_fields__, "G"),
    "polar": (("on", "off", "allowed_codes", "plane_before"), "GM"),
    "m_codes": (MCodes.__struct_fields__, "GM"),
}


def check_codes(machine: Machine, origins: Mapping[str, Origin], chain: Sequence[str]) -> None:
    """
    Raises MachineError, naming the profile and the key, for what is no code and for a code of two states.

    chain: the profiles, the nearest first; of two lists with the same code that of the nearer one is named.
    """
    for table, (keys, letters) in _LISTS.items():
        for key in keys:
            for code in getattr(getattr(machine, table), key):
                if isinstance(code, str) and not is_code(code, letters):
                    raise MachineError(f"{origins[f'{table}.{key}'].profile}: {table}.{key}: {code!r} is no code")

    def distance(key: str) -> int:
        profile = origins[key].profile
        return chain.index(profile) if profile in chain else -1

    for states in STATES.values():
        list_of: dict[int, str] = {}
        for key in states:
            full = f"{machine.table_of(key)}.{key}"
            for number in numbers(machine.codes(key)):
                if list_of.setdefault(number, full) != full:
                    nearer, other = sorted((full, list_of[number]), key=distance)
                    code = f"G{number / 10:g}"
                    raise MachineError(f"{origins[nearer].profile}: {nearer}: {code} is in {other}, too")
