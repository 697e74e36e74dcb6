"""Spindle speeds as the other machine writes them: S, SB= of a live tool, P beside its start."""

from __future__ import annotations

from polarcheck.columns.trace import Trace
from polarcheck.conversion.control.measures import Measures
from polarcheck.conversion.control.number_text import number_of
from polarcheck.conversion.control.spindle_roles import SpindleRoles
from polarcheck.conversion.outcome import Refusal, RefusedError
from polarcheck.machines.machine import Machine


class SpeedWords:
    """The speeds of a program on another machine."""

    def __init__(self, trace: Trace, target: Machine, measures: Measures, roles: SpindleRoles) -> None:
        self.trace, self.source, self.target = trace, trace.machine, target
        self.measures, self._roles = measures, roles
        words = self.source.control.spindle_words
        self._named = {self.source.address_number(word): role for word, role in words.items()}

    def is_speed(self, row: int, index: int) -> bool:
        """Return True for a word that names a spindle speed."""
        address = int(self.trace.run.words.address[index])
        if address == ord("S") or address in self._named:
            return True
        starts = self.trace.blocks.codes(*self.source.m_codes.live_tool_on)
        return address == ord("P") and self.source.writing.live_tool_speed == "P" and bool(starts[row])

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
            raise RefusedError([Refusal(int(self.trace.blocks.line_in_file[row]), "its speed is computed")])
        if role in ("sub", ""):
            return ""
        names = [word for word, of_spindle in self.target.control.spindle_words.items() if of_spindle == "live"]
        if is_live and role == "live" and names:
            return f"{names[0]}={number}"
        return f"{(self.target.writing.live_tool_speed or 'S') if is_live else 'S'}{number}"
