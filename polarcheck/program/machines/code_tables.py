"""G and M codes as whole numbers, and tables over them."""

from __future__ import annotations

import functools
from collections.abc import Iterable, Mapping

import numpy as np
from numpy.typing import NDArray

from polarcheck.foundation.arrays import Floats, Mask, States, mask_at
from polarcheck.foundation.states import OF_CODE, STATES
from polarcheck.program.machines.code_lists import numbers
from polarcheck.program.machines.machine import Machine

#: Not a code that a column can hold.
NO_CODE = -1
CODE_LIMIT = 10_000


def code(word: str) -> int:
    """`G12.1` or `M35` as the whole number that columns hold: ten times its value."""
    return round(float(word[1:]) * 10)


def spelled(letter: str, number: int) -> str:
    """The inverse of code(): 121 -> `G12.1`."""
    return f"{letter}{number // 10}" if number % 10 == 0 else f"{letter}{number / 10:.1f}"


def code_numbers(value: Floats) -> NDArray[np.int32]:
    """The written values of G or M words as codes; NO_CODE where no control could know them."""
    tenfold = np.where(np.isfinite(value), value, NO_CODE) * 10.0
    whole = np.rint(tenfold)
    good = (np.abs(whole - tenfold) < 1e-6) & (whole >= 0) & (whole < CODE_LIMIT)
    return np.where(good, whole, NO_CODE).astype(np.int32)


def renumbered(value: NDArray[np.int32], meanings: Mapping[str, str]) -> NDArray[np.int32]:
    """The codes, those that this control numbers otherwise (G101 for G1) as what they mean."""
    if not meanings:
        return value
    table = np.append(np.arange(CODE_LIMIT, dtype=np.int32), np.int32(NO_CODE))
    for word, equivalent in meanings.items():
        table[code(word)] = code(equivalent)
    return table[value]


def code_set(words: Iterable[str]) -> Mask:
    """A table over code numbers: whether it is one of the words (`G27-G39` is a range). Its last element is NO_CODE."""
    return _code_set(tuple(words))


@functools.lru_cache(1000)
def _code_set(words: tuple[str, ...]) -> Mask:
    """The same, once for each of the lists of a machine."""
    table = mask_at(CODE_LIMIT + 1, numbers(words))
    table.setflags(write=False)
    return table


#: For each list of codes of each modal group.
Lists = tuple[tuple[tuple[str, ...], ...], ...]


def modal_tables(machine: Machine) -> tuple[tuple[str, ...], NDArray[np.uint8], States]:
    """The names of the modal groups, and for each code number its group (from 1, 0 for none) and its state."""
    return _modal_tables(machine.cached("modal", lambda: _lists(machine)))


def _lists(machine: Machine) -> Lists:
    return tuple(tuple(tuple(machine.codes(key)) for key in states) for states in STATES.values())


@functools.cache
def _modal_tables(lists: Lists) -> tuple[tuple[str, ...], NDArray[np.uint8], States]:
    group_of = np.zeros(CODE_LIMIT + 1, np.uint8)
    state_of = np.zeros(CODE_LIMIT + 1, np.int16)
    for number, (states, of_group) in enumerate(zip(STATES.values(), lists, strict=True), 1):
        for state, words in zip(states.values(), of_group, strict=True):
            listed = np.flatnonzero(code_set(words))
            group_of[listed] = number
            state_of[listed] = listed // 10 if state == OF_CODE else state
    return tuple(STATES), group_of, state_of
