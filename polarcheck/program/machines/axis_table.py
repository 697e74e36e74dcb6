"""The axes of a lathe by number and name: which of them can be the linear, which the rotary axis of the mode."""

from __future__ import annotations

from collections.abc import Sequence

from polarcheck.program.machines.value_checks import MOST_AXES

#: Linear axes that are followed in the polar mode, and the addresses of their incremental words (B-62754EN/01).
INCREMENTS = {"X": "U", "Y": "V", "Z": "W"}
#: What the names of axes begin with.
AXIS_LETTERS = "ABCHUVWXYZ"
#: What a table of words has for an address that is longer than a letter: so much and the place of the name in a list.
FIRST_NAMED = 128
#: The same for the name of an axis that is in no list, and for a name that no axis has, as R1.
NOT_NAMED, NO_AXIS = 255, 254
#: The same for a function of a spindle by its number, as S2= and M2=: it moves nothing.
OF_SPINDLE = 253
#: Most names that can be in it.
MOST_NAMED = OF_SPINDLE - FIRST_NAMED
#: The addresses of all of them.
AXES = (*INCREMENTS, *INCREMENTS.values())
#: Names of axes by their kind.
_NAMES = {"linear": frozenset("XYZUVW"), "rotary": frozenset("ABCH")}


def address_number(address: str, names: Sequence[str]) -> int:
    """
    What a table of words has for an address: the character of a letter, in lower case where a comma stands before it;
    a number above all characters for the name of an axis.

    names: of axes, in order; NOT_NAMED or NO_AXIS stands for one that is not among them, OF_SPINDLE for one with its =.
    """
    if len(address) == 1:
        return ord(address)
    if address[0] == ",":
        return ord(address[1].lower())
    if address in names:
        return FIRST_NAMED + names.index(address)
    if address[-1] == "=":
        return OF_SPINDLE
    return NOT_NAMED if address[0] in AXIS_LETTERS else NO_AXIS


def is_rotary(name: str) -> bool:
    """Return True for the name of a rotary axis: A, B, C, H, or with a number, as C2."""
    return name[:1] in _NAMES["rotary"] and bool(name)


def check_axes(axes: Sequence[str], linear: int, rotary: int, rotary_address: str) -> None:
    """
    Raises ValueError where two axes have one name, or a number names no axis, one of the other kind, or another rotary
    axis than the address of that.

    axes: their names in the order of their numbers, from 1; nothing is checked where there are none.
    """
    if not axes:
        return
    if len(set(axes)) < len(axes):
        raise ValueError(f"control.axes names {next(name for name in axes if axes.count(name) > 1)} twice")
    for kind, number in (("linear", linear), ("rotary", rotary)):
        name = axis_of(axes, number)
        if not name:
            raise ValueError(f"polar.{kind}_axis is {number}, but control.axes names no more than {listed(axes)}")
        if name[0] not in _NAMES[kind]:
            raise ValueError(f"polar.{kind}_axis is {number}, but {name} is no {kind} axis: axes are {listed(axes)}")
    if (name := axis_of(axes, rotary)) != rotary_address:
        raise ValueError(f"polar.rotary_axis is {rotary}, {name}, but polar.rotary_address is {rotary_address}")


def numbers_of(axes: Sequence[str], kind: str) -> list[int]:
    """The numbers that an axis of a kind, linear or rotary, can have; those of every axis where no names are known."""
    if not axes:
        return list(range(1, MOST_AXES + 1))
    return [number for number, name in enumerate(axes, 1) if name[0] in _NAMES[kind]]


def axis_of(axes: Sequence[str], number: float) -> str:
    """The name of an axis by its number, from 1; empty where there is none."""
    return axes[int(number) - 1] if number == number // 1 and 1 <= number <= len(axes) else ""


def listed(axes: Sequence[str]) -> str:
    """The axes with their numbers, as in `1 X, 2 Z, 3 C`."""
    return ", ".join(f"{number} {name}" for number, name in enumerate(axes, 1))
