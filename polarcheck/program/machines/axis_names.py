"""
Keys that follow from the names of the axes: a profile with the name of its rotary or virtual axis can omit them.

The virtual axis Y has incremental words with V, and is not the one of other controls; a rotary axis A is A in the mode
and outside it. The keys are derived once for each profile of a chain, from its values, so that the nearest profile
counts. Keys that the profile contains are not changed.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from itertools import zip_longest
from typing import Any, TypeGuard

import msgspec

from polarcheck.foundation.patterns import lazy_pattern
from polarcheck.program.machines.axis_table import INCREMENTS, axis_of, is_rotary
from polarcheck.program.machines.parameters import Origin, value_of

#: The rotary axis in the meanings of parameters, and the address of its incremental words (B-62754EN/01).
_USUAL = "C"
_INCREMENTAL = "H"
#: An axis that is written with =.
_NAME = lazy_pattern("[ABCHU-Z][A-Z]{0,5}[0-9]{1,2}")
_KEYS = ("rotary_address", "rotary_incremental", "virtual_axis", "virtual_axis_incremental")


class AxisNames(msgspec.Struct, frozen=True):
    """
    The addresses of the axes of the polar mode in a profile.

    rotary: of the rotary axis, absolute and incremental.
    virtual: of the virtual axis, absolute and incremental.
    elsewhere: of the virtual axis on other controls, absolute and incremental by turns.
    """

    rotary: tuple[str, str]
    virtual: tuple[str, str]
    elsewhere: list[str]


def axis_names(merged: Mapping[str, Any]) -> AxisNames | None:
    """The axes of the merged profile; None where a name is missing or is not a text."""
    names = [value_of(merged, f"polar.{key}") for key in _KEYS]
    elsewhere = value_of(merged, "polar.virtual_axis_of_other_controls")
    if not (_is_texts(names) and _is_texts(elsewhere)):
        return None
    return AxisNames((names[0], names[1]), (names[2], names[3]), list(elsewhere))


def follow(
    merged: dict[str, Any], table: Mapping[str, Any], profile: str, origins: dict[str, Origin], inherited: AxisNames
) -> None:
    """
    Set the keys in `merged` that follow from the axes that a profile names, unless the profile contains them.

    table: the profile. inherited: the axes before it was merged.
    """
    written = {key for key, origin in origins.items() if origin.profile == profile}
    polar = merged["polar"]
    for key in ("rotary_address", "virtual_axis"):
        polar[key] = _followed(polar[key], _named(merged))

    def put(key: str, value: Any, cause: str) -> None:
        if key not in written and polar.get(key.partition(".")[2]) != value:
            polar[key.partition(".")[2]] = value
            origins[key] = Origin(profile, f"follows from {cause}", origins[cause].doubtful, origins[cause].parameter)

    for name, cause in _rotary_by(merged, written):
        put("polar.rotary_address", name, cause)
        written.add("polar.rotary_address")
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


def _rotary_by(merged: Mapping[str, Any], written: set[str]) -> list[tuple[str, str]]:
    """The rotary axis according to control.axes or the virtual axis, and the key that says so; one or none."""
    polar, axes = merged["polar"], _axes(merged)
    candidates = []
    number, virtual = polar.get("rotary_axis"), polar.get("virtual_axis")
    if isinstance(number, int) and written & {"control.axes", "polar.rotary_axis"}:
        cause = "control.axes" if "control.axes" in written else "polar.rotary_axis"
        candidates.append((_followed(axis_of(axes, number), _named(merged)), cause))
    if isinstance(virtual, str) and "polar.virtual_axis" in written:
        candidates.append((virtual, "polar.virtual_axis"))
    return [
        (name, cause) for name, cause in candidates if is_rotary(name) and (len(name) == 1 or _NAME.fullmatch(name))
    ][:1]


def _axes(merged: Mapping[str, Any]) -> list[str]:
    """The names of all axes; empty where they are not texts."""
    axes = value_of(merged, "control.axes")
    return axes if _is_texts(axes) else []


def _named(merged: Mapping[str, Any]) -> Mapping[str, Any]:
    """The table of axes that are written with =; empty where it is not a table."""
    named = value_of(merged, "control.named_axes")
    return named if isinstance(named, Mapping) else {}


def _followed(name: str, named_axes: Mapping[str, Any]) -> str:
    """The address that a named axis is, as C1 is C; else the name itself."""
    followed = named_axes.get(name)
    return followed if isinstance(followed, str) and followed else name


def _rename(merged: dict[str, Any], inherited: AxisNames, put: Callable[[str, Any, str], None]) -> None:
    """Rename the rotary axis in the inherited keys."""
    polar, cause = merged["polar"], "polar.rotary_address"
    old, new = inherited.rotary, (polar["rotary_address"], polar["rotary_incremental"])
    if inherited.virtual[0] == old[0]:
        put("polar.virtual_axis", new[0], cause)
    by_word, words = polar.get("virtual_axis_by_word"), polar.get("words_beside_switch")
    if isinstance(by_word, Mapping):
        renamed = {word: list(new) if list(pair) == list(old) else pair for word, pair in by_word.items()}
        put("polar.virtual_axis_by_word", renamed, cause)
    if _is_texts(words):
        put("polar.words_beside_switch", [new[0] if word == old[0] else word for word in words], cause)
    pairs = [new if pair == old else pair for pair in _pairs(inherited.elsewhere)]
    put("polar.virtual_axis_of_other_controls", [address for pair in pairs for address in pair], cause)


def _by_parameter(polar: dict[str, Any], table: Mapping[str, Any], origins: Mapping[str, Origin]) -> None:
    """A parameter that lets the axes stand beside G12.1 names the rotary axis as most lathes do."""
    words, written = polar.get("words_beside_switch"), table.get("polar")
    is_written = isinstance(written, Mapping) and "words_beside_switch" in written
    origin = origins.get("polar.words_beside_switch")
    if _is_texts(words) and origin is not None and origin.parameter and not is_written:
        polar["words_beside_switch"] = [polar["rotary_address"] if word == _USUAL else word for word in words]


def _of_virtual(
    merged: Mapping[str, Any], names: AxisNames, inherited: AxisNames, put: Callable[[str, Any, str], None]
) -> None:
    """Set the keys of a virtual axis that has changed: its incremental words, and the former axis."""
    virtual, cause = names.virtual[0], "polar.virtual_axis"
    increment = names.rotary[1] if virtual == names.rotary[0] else INCREMENTS.get(virtual, "")
    put("polar.virtual_axis_incremental", increment, cause)
    axes = _axes(merged)
    is_rotary_no_more = inherited.virtual == inherited.rotary and virtual != names.rotary[0]
    former = names.rotary if is_rotary_no_more else inherited.virtual
    # The address of another axis of the lathe moves that axis.
    pairs = [*_pairs(names.elsewhere), former][: None if former[0] not in axes or is_rotary_no_more else -1]
    pairs_left = [pair for pair in dict.fromkeys(pairs) if pair[0] != virtual]
    put("polar.virtual_axis_of_other_controls", [address for pair in pairs_left for address in pair], cause)
    put("polar.other_controls", "", cause)


def _enter(merged: dict[str, Any]) -> None:
    """Add axes that are written with = to control.named_axes."""
    control, polar = merged.get("control"), merged["polar"]
    named = _named(merged)
    axes = (polar["rotary_address"], polar["virtual_axis"], *_axes(merged))
    names = [name for name in axes if _NAME.fullmatch(name)]
    if isinstance(control, dict) and any(name not in named for name in names):
        control["named_axes"] = {**dict.fromkeys(names, ""), **named}


def _pairs(addresses: Sequence[str]) -> list[tuple[str, str]]:
    """Pairs of an absolute and an incremental address."""
    return list(zip_longest(addresses[::2], addresses[1::2], fillvalue=""))


def _is_texts(values: Any) -> TypeGuard[list[str]]:
    return isinstance(values, list) and all(isinstance(value, str) for value in values)
