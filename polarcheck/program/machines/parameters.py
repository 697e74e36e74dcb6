"""Control parameters by their own names: what the user copies from the control, turned into values of the profile."""

from collections.abc import Mapping
from typing import Any

import msgspec

from polarcheck.foundation.errors import MachineError, suggestion
from polarcheck.program.machines.renamed import refuse
from polarcheck.program.machines.value_types import MisfitError, fitted


class Origin(msgspec.Struct, frozen=True):
    """
    Where a value of a profile comes from: the profile, the source it names, whether that is in doubt, and the control
    parameter that it was given by.
    """

    profile: str
    source: str
    doubtful: bool = False
    parameter: str = ""


class Meaning(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """
    What a control parameter sets.

    title: what the manual calls it. key, factor: the value of the profile that it is, times the factor. values: for
    settings, each with the values of the profile that it stands for; "= control.x" takes over another value. A number
    that is not among the values goes to the key. is_letter: it is a letter from A to Z instead of a number.
    """

    title: str
    key: str = ""
    factor: float = 1.0
    values: dict[str, dict[str, Any]] = {}
    is_letter: bool = False


def apply(merged: dict[str, Any], table: Mapping[str, Any], profile: str, origins: dict[str, Origin]) -> None:
    """
    Set in `merged` what the [parameters] of one profile say; keys that the same profile gives itself stay.

    Raises MachineError, naming profile and parameter, for an unknown parameter or setting.
    """
    meanings = _meanings(merged, profile)
    given = merged["parameters"]
    named = set(table["parameters"]) - {"source", "doubtful"}
    for name in sorted(named):
        if name not in meanings:
            raise MachineError(f"{profile}: parameters: {_unknown(name, meanings)}")
    # In the order of the known parameters, so that the order in which the user lists them makes no difference.
    copies = []
    for name, meaning in meanings.items():
        if name not in named:
            continue
        for key, value in _values(name, meaning, given[name], profile).items():
            refuse(key, profile)
            if value_of(table, key) is not None:
                continue
            origins[key] = Origin(profile, f"parameter {name} = {given[name]}: {meaning.title}", parameter=name)
            if isinstance(value, str) and value.startswith("= "):
                copies.append((key, value[2:]))
            else:
                _set(merged, key, value)
    for key, target in copies:
        _set(merged, key, value_of(merged, target))


def _meanings(merged: Mapping[str, Any], profile: str) -> dict[str, Meaning]:
    try:
        return fitted(merged.get("known_parameters", {}), dict[str, Meaning], "known_parameters")
    except MisfitError as misfit:
        raise MachineError(f"{profile}: {misfit}") from None


def _values(name: str, meaning: Meaning, given: Any, profile: str) -> Mapping[str, Any]:
    is_number = isinstance(given, int | float)
    spelled = f"{given:g}" if is_number else str(given)
    # A number in quotes is shown with them: it looks like what is expected.
    written = given if (spelled and spelled.isprintable() and not spelled.isdecimal()) or is_number else repr(given)
    for setting, values in meaning.values.items():
        if setting.upper() == spelled.upper():
            return values
    if meaning.is_letter:
        if len(spelled) == 1 and "A" <= spelled.upper() <= "Z":
            return {meaning.key: spelled.upper()}
        raise MachineError(f"{profile}: parameters.{name}: expected a letter from A to Z, not {written}")
    if not meaning.key or not is_number:
        expected = " or ".join(meaning.values) or "a number"
        raise MachineError(f"{profile}: parameters.{name}: expected {expected}, not {written}")
    return {meaning.key: given if meaning.factor == 1 else given * meaning.factor}


def value_of(merged: Mapping[str, Any], key: str) -> Any:
    """The value of a key, as in `control.axes`; None where there is none, or no table for it."""
    group, _, last = key.partition(".")
    values = merged.get(group)
    return values.get(last) if isinstance(values, Mapping) else None


def _set(merged: dict[str, Any], key: str, value: Any) -> None:
    group, _, last = key.partition(".")
    values = merged.setdefault(group, {})
    if isinstance(values, dict):  # else the profile is wrong, and said to be when it is converted
        values[last] = value


def _unknown(name: str, meanings: Mapping[str, Meaning]) -> str:
    hint = suggestion(name, meanings) or f"; known are {', '.join(meanings) or 'none'}"
    return f"no meaning is known for {name}{hint}"
