"""
Codes as somebody writes them into a machine file: in lower case, with leading zeros, with blanks; and lists that only
say what differs from the inherited one, `["+G93", "-G80"]`.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from polarcheck.foundation.patterns import lazy_pattern
from polarcheck.program.machines.code_keys import EVERY
from polarcheck.program.machines.code_lists import is_code, numbers

#: Beside the lists of codes: codes by alarm, and addresses that are written as codes are.
_FURTHER_TABLE, _FURTHER_KEY = "alarm_codes", "polar.virtual_axis_of_other_controls"
#: Tables of codes.
_PAIRS = ("control.motion_codes",)
#: What holds addresses: one, a list of them, or lists by address.
_ADDRESSES = frozenset(
    (
        *("polar.virtual_axis", "polar.virtual_axis_incremental", "polar.linear_address", "polar.infeed_word"),
        *("polar.center_words", "arcs.radius_word", "control.axes"),
    )
)
_AS_IT_IS = lazy_pattern(r"[GM](?:0|[1-9]\d*)(?:\.[1-9])?", re.ASCII)
_CODE = lazy_pattern(
    r"([GMgm]) *0*(\d{1,4})(?:\.(\d)0*)?(?: *- *([GMgm]) *0*(\d{1,4})| *([A-Za-z]) *([-+]?\d+(?:\.\d*)?))?",
    re.ASCII,
)
_ADDRESS = lazy_pattern("[a-z]")
#: What any list can hold: codes, ranges, codes with a word, addresses, names of lists.
_FORM = lazy_pattern(r"[GM]\d{1,3}(\.\d)?(-[GM]\d{1,3}| [A-Z][-.\d]+)?|[A-Z]|[a-z_]{4,}", re.ASCII)


class ListError(ValueError):
    """A list that changes the inherited one, and gives a whole one at once, or names no code; the text names what."""


def is_list(key: str) -> bool:
    """Return True if a key with its table, as in `polar.allowed_codes`, holds a list of codes."""
    return key in EVERY or key == _FURTHER_KEY or key.partition(".")[0] == _FURTHER_TABLE


def plain(text: str) -> str:
    """A code in the form in which it is compared: `g098` is G98, `m3p12` is M3 P12; any other text as it is."""
    if _AS_IT_IS.fullmatch(text):
        return text
    match = _CODE.fullmatch(text.strip(" "))
    if match is None:
        return text.upper() if _ADDRESS.fullmatch(text) else text
    letter, number, tenth, second, last, address, value = match.groups()
    first = f"{letter.upper()}{number}" + (f".{tenth}" if tenth and tenth != "0" else "")
    if second:
        return f"{first}-{second.upper()}{last}"
    return f"{first} {address.upper()}{_number(value)}" if address else first


def _number(text: str) -> str:
    sign = "-" if text.startswith("-") else ""
    whole, point, rest = text.lstrip("+-").partition(".")
    return f"{sign}{whole.lstrip('0') or '0'}{f'.{rest}' if point and rest.strip('0') else ''}"


def taken(key: str, value: Any, inherited: Any) -> Any:
    """
    The value of a key as it counts: codes in their plain form, addresses in capitals, and a list of changes put into
    the inherited one.

    inherited: of the same key. What is no list of codes stays as it is. Raises ListError.
    """
    if key.startswith("power_on.") and isinstance(value, str):
        return plain(value)
    if key in _ADDRESSES:
        return _in_capitals(value)
    if key in _PAIRS and isinstance(value, Mapping):
        return {
            plain(name): plain(replacement) if isinstance(replacement, str) else replacement
            for name, replacement in value.items()
        }
    if not isinstance(value, list) or not is_list(key):
        return value
    signed = [text for text in value if is_change(text)]
    if not signed:
        return [plain(text) if isinstance(text, str) else text for text in value]
    if len(signed) < len(value):
        unsigned = next(text for text in value if not is_change(text))
        raise ListError(f"{unsigned!r} beside {signed[0]!r}: write + or - before each of them, or the whole list")
    result = list(inherited) if isinstance(inherited, list) else []
    for change in signed:
        code = plain(change[1:].strip(" "))
        if change[0] == "-":
            if code not in result and not _FORM.fullmatch(code):
                raise ListError(f"{change!r}: {code!r} is no code")
            result = without(result, code)
        elif not holds(result, code):
            result.append(code)
    return result


def _in_capitals(value: Any) -> Any:
    if isinstance(value, str):
        return value.strip(" ").upper() if value.isascii() else value
    if isinstance(value, list):
        return [_in_capitals(element) for element in value]
    return (
        {_in_capitals(name): _in_capitals(element) for name, element in value.items()}
        if isinstance(value, dict)
        else value
    )


def is_change(text: Any) -> bool:
    """`+G93` or `-G80`."""
    return isinstance(text, str) and text[:1] in ("+", "-")


def holds(codes: Iterable[Any], code: str) -> bool:
    """Return True if a list contains a code or range, ranges of the list included."""
    listed = list(codes)
    if code in listed or not is_code(code):
        return code in listed
    return set(numbers([code])) <= set(numbers(text for text in listed if isinstance(text, str) and is_code(text)))


def without(codes: Sequence[Any], code: str) -> list[Any]:
    """A list without a code or a range of codes; a range that it cuts is left in two parts."""
    if not is_code(code):
        return [text for text in codes if text != code]
    gone = set(numbers([code]))
    remaining: list[Any] = []
    for text in codes:
        members = numbers([text]) if isinstance(text, str) and is_code(text) else []
        if gone.isdisjoint(members):
            remaining.append(text)
            continue
        kept = [number // 10 for number in members if number not in gone] if "-" in text else []
        for number in kept:
            if remaining and number - 1 in kept:
                remaining[-1] = f"{remaining[-1].partition('-')[0]}-{text[0]}{number}"
            else:
                remaining.append(f"{text[0]}{number}")
    return remaining


def without_effect(changes: Any, inherited: Any) -> list[str]:
    """The changes that change nothing: `+G93` where G93 is inherited, `-G80` where G80 is not."""
    if not isinstance(changes, list) or not all(map(is_change, changes)):
        return []
    listed = list(inherited) if isinstance(inherited, list) else []
    useless = []
    for change in changes:
        code = plain(change[1:].strip(" "))
        if holds(listed, code) if change[0] == "+" else without(listed, code) == listed:
            useless.append(change)
    return useless
