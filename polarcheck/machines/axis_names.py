"""
What follows from the name of an axis: a profile that names its rotary or virtual axis need not say the rest.

Y as the virtual axis has V for its incremental words and is none of other controls; a rotary axis A is A in the mode
and outside it. It is worked out once for each profile of a chain, from what that profile says, so that the nearest word
counts; what the profile says itself stays.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from itertools import zip_longest
from typing import Any, NamedTuple, TypeGuard

from polarcheck.machines.axes import INCREMENTS, axis_of, is_rotary
from polarcheck.machines.parameters import Origin

#: The rotary axis in the meanings of parameters, and the address of its incremental words (B-62754EN/01).
_USUAL = "C"
_INCREMENTAL = "H"
#: An axis that is written with =.
_NAME = re.compile("[ABCHU-Z][A-Z]{0,5}[0-9]{1,2}")
_KEYS = ("rotary_address", "rotary_incremental", "virtual_axis", "virtual_axis_incremental")


class AxisNames(NamedTuple):
    """The axes of the polar mode in a profile: addresses, absolute and incremental; those that it has elsewhere."""

    rotary: tuple[str, str]
    virtual: tuple[str, str]
    elsewhere: list[str]


def axis_names(merged: Mapping[str, Any]) -> AxisNames | None:
    """Return the axes of the merged profile so far; None if some are missing, or are no texts."""
    polar = merged.get("polar")
    if not isinstance(polar, Mapping):
        return None
    names = [polar.get(key) for key in _KEYS]
    elsewhere = polar.get("virtual_axis_of_other_controls")
    if not (_is_texts(names) and _is_texts(elsewhere)):
        return None
    return AxisNames((names[0], names[1]), (names[2], names[3]), list(elsewhere))


def follow(
    merged: dict[str, Any], table: Mapping[str, Any], profile: str, origins: dict[str, Origin], inherited: AxisNames
) -> None:
    """
    Set in `merged` what follows from the axes that a profile names, where it does not say it itself.

    table: what stands in the profile. inherited: the names before it was merged.
    """
    told = {key for key, origin in origins.items() if origin.profile == profile}
    polar = merged["polar"]
    for key in ("rotary_address", "virtual_axis"):
        polar[key] = _followed(polar[key], _named(merged))

    def put(key: str, value: Any, cause: str) -> None:
        if key not in told and polar.get(key.partition(".")[2]) != value:
            polar[key.partition(".")[2]] = value
            origins[key] = Origin(profile, f"follows from {cause}", origins[cause].doubtful, origins[cause].parameter)

    for name, cause in _rotary_by(merged, told):
        put("polar.rotary_address", name, cause)
        told.add("polar.rotary_address")
    names = axis_names(merged)
    if names is None:
        return
    if (rotary := names.rotary[0]) != inherited.rotary[0]:
        put("polar.rotary_incremental", _INCREMENTAL if rotary == _USUAL else "", "polar.rotary_address")
        _rename(merged, inherited, put)
    _by_parameter(polar, table, origins)
    names = axis_names(merged)
    if names is not None and names.virtual[0] != inherited.virtual[0]:
        _of_virtual(merged, names, inherited, put)
    _enter(merged)


def _rotary_by(merged: Mapping[str, Any], told: set[str]) -> list[tuple[str, str]]:
    """The rotary axis as the names of all axes or the virtual axis tell it, and which key does; the first counts."""
    polar, axes = merged["polar"], _axes(merged)
    found = []
    number, virtual = polar.get("rotary_axis"), polar.get("virtual_axis")
    if isinstance(number, int) and told & {"control.axes", "polar.rotary_axis"}:
        cause = "control.axes" if "control.axes" in told else "polar.rotary_axis"
        found.append((_followed(axis_of(axes, number), _named(merged)), cause))
    if isinstance(virtual, str) and "polar.virtual_axis" in told:
        found.append((virtual, "polar.virtual_axis"))
    return [(name, cause) for name, cause in found if is_rotary(name) and (len(name) == 1 or _NAME.fullmatch(name))][:1]


def _axes(merged: Mapping[str, Any]) -> list[str]:
    """The names of all axes, as far as they are texts."""
    control = merged.get("control")
    axes = control.get("axes") if isinstance(control, Mapping) else None
    return axes if _is_texts(axes) else []


def _named(merged: Mapping[str, Any]) -> Mapping[str, Any]:
    """The axes that are written with =, as far as they are a table."""
    control = merged.get("control")
    named = control.get("named_axes") if isinstance(control, Mapping) else None
    return named if isinstance(named, Mapping) else {}


def _followed(name: str, named_axes: Mapping[str, Any]) -> str:
    """The address that a named axis is, as C1 is C; else the name itself."""
    meant = named_axes.get(name)
    return meant if isinstance(meant, str) and meant else name


def _rename(merged: dict[str, Any], inherited: AxisNames, put: Callable[[str, Any, str], None]) -> None:
    """Copy the inherited keys of the rotary axis to its new name."""
    polar, cause = merged["polar"], "polar.rotary_address"
    old, new = inherited.rotary, (polar["rotary_address"], polar["rotary_incremental"])
    if inherited.virtual[0] == old[0]:
        put("polar.virtual_axis", new[0], cause)
    by_word, beside = polar.get("virtual_axis_by_word"), polar.get("words_beside_switch")
    if isinstance(by_word, Mapping):
        renamed = {word: list(new) if list(pair) == list(old) else pair for word, pair in by_word.items()}
        put("polar.virtual_axis_by_word", renamed, cause)
    if _is_texts(beside):
        put("polar.words_beside_switch", [new[0] if word == old[0] else word for word in beside], cause)
    pairs = [new if pair == old else pair for pair in _pairs(inherited.elsewhere)]
    put("polar.virtual_axis_of_other_controls", [address for pair in pairs for address in pair], cause)


def _by_parameter(polar: dict[str, Any], table: Mapping[str, Any], origins: Mapping[str, Origin]) -> None:
    """A parameter that lets the axes stand beside G12.1 names the rotary axis as most lathes do."""
    beside, own = polar.get("words_beside_switch"), table.get("polar")
    is_written = isinstance(own, Mapping) and "words_beside_switch" in own
    origin = origins.get("polar.words_beside_switch")
    if _is_texts(beside) and origin is not None and origin.parameter and not is_written:
        polar["words_beside_switch"] = [polar["rotary_address"] if word == _USUAL else word for word in beside]


def _of_virtual(
    merged: Mapping[str, Any], names: AxisNames, inherited: AxisNames, put: Callable[[str, Any, str], None]
) -> None:
    """The incremental words of a virtual axis that is another one than before, and where that one was."""
    virtual, cause = names.virtual[0], "polar.virtual_axis"
    increment = names.rotary[1] if virtual == names.rotary[0] else INCREMENTS.get(virtual, "")
    put("polar.virtual_axis_incremental", increment, cause)
    axes = _axes(merged)
    is_rotary_no_more = inherited.virtual == inherited.rotary and virtual != names.rotary[0]
    former = names.rotary if is_rotary_no_more else inherited.virtual
    # An axis of the lathe that has the address moves by it.
    pairs = [*_pairs(names.elsewhere), former][: None if former[0] not in axes or is_rotary_no_more else -1]
    kept = [pair for pair in dict.fromkeys(pairs) if pair[0] != virtual]
    put("polar.virtual_axis_of_other_controls", [address for pair in kept for address in pair], cause)
    put("polar.other_controls", "", cause)


def _enter(merged: dict[str, Any]) -> None:
    """Axes that are written with = belong to the named ones."""
    control, polar = merged.get("control"), merged["polar"]
    named = _named(merged)
    told = (polar["rotary_address"], polar["virtual_axis"], *_axes(merged))
    names = [name for name in told if _NAME.fullmatch(name)]
    if isinstance(control, dict) and any(name not in named for name in names):
        control["named_axes"] = {**dict.fromkeys(names, ""), **named}


def _pairs(addresses: Sequence[str]) -> list[tuple[str, str]]:
    """Addresses, absolute and incremental, two by two."""
    return list(zip_longest(addresses[::2], addresses[1::2], fillvalue=""))


def _is_texts(values: Any) -> TypeGuard[list[str]]:
    return isinstance(values, list) and all(isinstance(value, str) for value in values)
