"""Spindle speeds as the other machine writes them: S, SB= of a live tool, P beside its start."""

from __future__ import annotations

import math
from functools import cached_property

import numpy as np

from polarcheck.columns.trace import Trace
from polarcheck.foundation.arrays import Mask, Rows, stretch
from polarcheck.program.machines.machine import Machine
from polarcheck.rewrite.compare.order_meanings import is_speed
from polarcheck.rewrite.convert.measures import Measures
from polarcheck.rewrite.convert.number_text import number_of
from polarcheck.rewrite.convert.spindle_roles import SpindleRoles
from polarcheck.rewrite.writing.outcome import refused_at

_M_PER_FT = 0.3048


class SpeedWords:
    """The speeds of a program on another machine."""

    def __init__(self, trace: Trace, target: Machine, measures: Measures, roles: SpindleRoles) -> None:
        self.trace, self.source, self.target = trace, trace.machine, target
        self.measures, self._roles = measures, roles
        words = self.source.control.spindle_words
        self._named = {self.source.address_number(word): role for word, role in words.items()}

    @cached_property
    def is_speed(self) -> Mask:
        """Per executed word: it names a spindle speed."""
        return is_speed(self.trace)

    def is_surface_speed(self, row: int) -> bool:
        """S of a row is a cutting speed [m/min or ft/min], by G96, and not the limit beside G50."""
        is_limit = bool(self.trace.blocks.listed("coordinate_setting")[row])
        return bool(self.trace.modal.state("speed")[row]) and not is_limit

    def _surface_speed(self, row: int, number: str) -> str:
        """A cutting speed in the units of the new program: m/min beside mm, ft/min beside inch."""
        ratio = self.measures.unit_ratio(row)
        if ratio == 1:
            return number
        return str(round(float(number) * (_M_PER_FT if ratio > 1 else 1 / _M_PER_FT)))

    def in_force(self, row: int, is_live: bool) -> str:
        """
        Return the word of the speed that a spindle starts with in a row without one; empty where that is the same word.

        One control has S for all spindles, another one a word for the live tool: what is in force differs between them.
        Raises RefusedError where that speed is not known.
        """
        ours, theirs = (machine.writing.live_tool_speed or "S" for machine in (self.source, self.target))
        if ours == theirs or self.is_speed[slice(*stretch(self.trace.run.row, row, row + 1))].any():
            return ""
        speed = self._last(row, is_live and ours != "S")
        if math.isnan(speed):
            raise refused_at(self.trace, row, "the speed of this spindle is not known")
        return f"{theirs if is_live else 'S'}{speed:g}"

    def _last(self, row: int, is_live_word: bool) -> float:
        """The last speed up to a row: by S, or by the word of the live tool; NaN without one."""
        words, row_of_word = self._by_word[is_live_word]
        index = int(row_of_word.searchsorted(row, side="right")) - 1
        return float(self.trace.run.words.value[words[index]]) if index >= 0 else math.nan

    @cached_property
    def _by_word(self) -> tuple[tuple[Rows, Rows], tuple[Rows, Rows]]:
        """The words of speeds by S, without limits, and by other words; with their rows."""
        run = self.trace.run
        is_s = run.words.address == ord("S")
        is_limit = self.trace.blocks.listed("coordinate_setting")[run.row]
        by_s, by_address = (np.flatnonzero(self.is_speed & ~is_limit & mask) for mask in (is_s, ~is_s))
        return (by_s, run.row[by_s]), (by_address, run.row[by_address])

    def written(self, row: int, index: int) -> str:
        """
        Return the word of a speed; empty where the other machine has none for that spindle.

        Raises RefusedError for a computed speed.
        """
        address = int(self.trace.run.words.address[index])
        role = self._named.get(address)
        by_row = role is None or address == ord("P")
        is_live = bool(self._roles.speed_of_live_tool[row]) if by_row else role == "live"
        number = number_of(self.measures.written(index))
        if number is None:
            raise refused_at(self.trace, row, "its speed is computed")
        if role in ("sub", ""):
            return ""
        if self.is_surface_speed(row):
            number = self._surface_speed(row, number)
        names = [word for word, of_spindle in self.target.control.spindle_words.items() if of_spindle == "live"]
        if is_live and role == "live" and names:
            return f"{names[0]}={number}"
        word = (self.target.writing.live_tool_speed or "S") if is_live else "S"
        # P is a speed beside the start of the live tool alone, where `in_force` writes it.
        return f"{'S' if word == 'P' and not self._starts_live_tool[row] else word}{number}"

    @cached_property
    def _starts_live_tool(self) -> Mask:
        codes, blocks = self.source.m_codes, self.trace.blocks
        return blocks.codes(*codes.live_tool_on) | (blocks.codes(*codes.spindle_on) & self._roles.of_live_tool)
