"""Dwells: what the words of one machine count, and the word of another that counts as much."""

from __future__ import annotations

from fractions import Fraction

from polarcheck.program.machines.machine import Machine
from polarcheck.rewrite.convert.number_text import rounded

#: The part of a second that a word counts; one with a point may count another.
_SECONDS = {"seconds": Fraction(1), "hundredths": Fraction(1, 100), "thousandths": Fraction(1, 1000)}
_THOUSANDTH = Fraction(1, 1000)


def counts_turns(machine: Machine, address: str, per_revolution: bool) -> bool:
    """The word of a dwell counts turns of the spindle."""
    by_mode = per_revolution and machine.feed.dwell_per_revolution == "turns"
    return machine.feed.dwell_words[address] == "turns" or by_mode


def amount(machine: Machine, address: str, number: str, least: Fraction) -> Fraction:
    """What the number of a dwell counts [s, or turns]. least: the least increment of lengths, in which X may count."""
    unit, value = machine.feed.dwell_words[address], Fraction(number)
    if unit == "as-lengths":
        in_increments = "." not in number and machine.control.number_without_point == "least-increment"
        return value * least if in_increments else value
    if unit == "thousandths-or-seconds":
        return value if "." in number else value * _THOUSANDTH
    return value * _SECONDS.get(unit, Fraction(1))


def word_for(machine: Machine, dwell: Fraction, is_turns: bool, per_revolution: bool, preferred: str) -> str:
    """
    The word of a dwell on a machine; empty where it has none for it.

    dwell: [s, or turns]. preferred: the address that the original has.
    """
    words = [word for word in machine.feed.dwell_words if counts_turns(machine, word, per_revolution) == is_turns]
    if not words:
        return ""
    address = preferred if preferred in words else words[0]
    unit = machine.feed.dwell_words[address]
    if unit in ("thousandths", "thousandths-or-seconds"):
        return f"{address}{round(dwell / _THOUSANDTH)}"
    if unit == "hundredths":
        return f"{address}{round(dwell * 100)}"
    return address + rounded(dwell, _THOUSANDTH)
