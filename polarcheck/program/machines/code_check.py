"""Checks of a machine's code lists: they hold codes, and no code stands for two states."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping, Sequence

from polarcheck.foundation.errors import MachineError, RuleError, suggestion
from polarcheck.foundation.states import STATES
from polarcheck.program.machines import code_keys
from polarcheck.program.machines.code_lists import is_code, numbers
from polarcheck.program.machines.m_codes import SWITCHED, PowerOn
from polarcheck.program.machines.machine import Machine
from polarcheck.program.machines.parameters import Origin


def check_codes(machine: Machine, origins: Mapping[str, Origin], chain: Sequence[str]) -> None:
    """
    Raises MachineError, naming the profile and the key, for what is no code and for a code of two states.

    chain: the profiles, the nearest first; of two lists with the same code that of the nearer one is named. The error
    is the first one and has the others of its kind.
    """
    for kind in (_no_codes, _wrong_at_power_on, _wrong_in_alarm_codes, _of_two_states):
        first, *further = [*kind(machine, origins, chain), ""]
        if first:
            raise MachineError(first, filter(None, further))


def _no_codes(machine: Machine, origins: Mapping[str, Origin], chain: Sequence[str]) -> Iterator[str]:
    """A list that is sound in its profile has a word that is no code any more since a nearer file changes its lists."""
    for lists, is_one in _FORMS:
        for table, keys in lists.items():
            for key in keys:
                for code in getattr(getattr(machine, table), key):
                    if isinstance(code, str) and not is_one(code):
                        profile = origins[f"{table}.{key}"].profile
                        of = f" of {profile}" if profile in chain[1:] else ""
                        yield f"{chain[0] if of else profile}: {table}.{key}{of}: {code!r} is no code"


def _wrong_in_alarm_codes(machine: Machine, origins: Mapping[str, Origin], _: Sequence[str]) -> Iterator[str]:
    for alarm, names in machine.alarm_codes.items():
        for name in names:
            if not is_code(name) and not _is_list(machine, name):
                key = f"alarm_codes.{alarm}"
                near = suggestion(name, _lists(machine))
                yield f"{origins[key].profile}: {key}: {name!r} is neither a code nor a list of codes{near}"


def _of_two_states(machine: Machine, origins: Mapping[str, Origin], chain: Sequence[str]) -> Iterator[str]:
    def distance(key: str) -> int:
        profile = origins[key].profile
        return chain.index(profile) if profile in chain else -1

    for on, off in SWITCHED:
        both = [word for word in getattr(machine.m_codes, on) if word in getattr(machine.m_codes, off)]
        if both:
            nearer, farther = sorted((f"m_codes.{on}", f"m_codes.{off}"), key=distance)
            yield f"{origins[nearer].profile}: {nearer}: {both[0]} is in {farther}, too"
    list_of: dict[int, str] = {}
    for states in STATES.values():
        for key in states:
            full = f"{machine.table_of(key)}.{key}"
            for number in numbers(machine.codes(key)):
                if list_of.setdefault(number, full) != full:
                    nearer, farther = sorted((full, list_of[number]), key=distance)
                    code = f"G{number / 10:g}"
                    yield f"{origins[nearer].profile}: {nearer}: {code} is in {farther}, too"


def _wrong_at_power_on(machine: Machine, origins: Mapping[str, Origin], _: Sequence[str]) -> Iterator[str]:
    for group in PowerOn.__struct_fields__:
        selected = getattr(machine.power_on, group)
        listed = [code for key in STATES[group] for code in machine.codes(key)]
        if selected and selected not in listed:
            has = ", ".join(listed) or "none"
            key = f"power_on.{group}"
            yield f"{origins[key].profile}: {key}: {selected} selects no {group}; codes are {has}"


def _is_single(text: str) -> bool:
    return is_code(text, "GM") and "-" not in text


def _is_switch(text: str) -> bool:
    """`M3`, or `M3 P12`."""
    first, _, word = text.partition(" ")
    return _is_single(first) and (
        text == first or re.fullmatch(r"[A-FH-LO-Z]-?\d{1,8}(\.\d{1,4})?", word, re.ASCII) is not None
    )


def _is_address_or_code(text: str) -> bool:
    return re.fullmatch("[A-Z]|[ABCHU-Z][A-Z]{0,5}[0-9]{1,2}", text) is not None or is_code(text, "GM")


def _is_word(text: str) -> bool:
    """TRANSMIT is one; what looks like a code must be one, but for letters behind it (G16 XC)."""
    first, _, letters = text.partition(" ")
    is_one = _is_single(first) and (first == text or letters.isalpha())
    return bool(text) and (is_one or not re.match("[GM][0-9.-]", text))


_FORMS: tuple[tuple[Mapping[str, Sequence[str]], Callable[[str], bool]], ...] = (
    (code_keys.RANGES, is_code),
    (code_keys.SINGLE, _is_single),
    (code_keys.WITH_WORDS, _is_switch),
    (code_keys.MIXED, _is_address_or_code),
    (code_keys.WORDS, _is_word),
)


def _lists(machine: Machine) -> list[str]:
    return [key for table in machine.code_tables for key in getattr(machine, table).__struct_fields__]


def _is_list(machine: Machine, name: str) -> bool:
    try:
        return bool(machine.table_of(name))
    except RuleError:
        return False
