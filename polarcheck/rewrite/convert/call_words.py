"""Calls of subprograms and returns from them, by the words in which the profiles write them."""

from __future__ import annotations

import re

import numpy as np

from polarcheck.columns.trace import Trace
from polarcheck.program.machines.machine import Machine
from polarcheck.rewrite.writing.outcome import refused_at

_BLANKS = re.compile(r"\s+")
#: A number of a program with repeats before its last four digits.
_LAST_DIGITS = 10_000


class Calls:
    """
    The calls and returns of a program as those of another machine.

    is_flow: a boolean per row: it calls a program or returns from one. calls_foreign_macro: a boolean per row: it calls
    a macro that is not in the file, such as one of the builder.
    """

    def __init__(self, trace: Trace, target: Machine) -> None:
        self.trace, self.source, self.target = trace, trace.machine, target
        writing, their_writing = self.source.writing, target.writing
        self._call = _pattern(writing.subprogram_call, writing.subprogram_repeats)
        self._return = "".join(writing.subprogram_return.split()).upper()
        ours, theirs = self.source.macro, target.macro
        self.is_same = (
            bool(their_writing.subprogram_call)
            and (writing.subprogram_call, writing.subprogram_return)
            == (their_writing.subprogram_call, their_writing.subprogram_return)
            and ours.language == theirs.language
            and all(
                getattr(ours, key) == getattr(theirs, key)
                for key in ("subprogram_calls", "program_returns", "local_calls", "sequence_word", "repeats_in_p")
            )
        )
        #: Programs that are called and not in the file -> the first line with a call.
        self.missing: dict[int, int] = {}
        self.is_flow = trace.blocks.codes(*self.source.macro.flow_codes)
        #: Rows behind which a program runs at the next depth.
        self._enters = enters = np.append(np.diff(trace.run.depth) > 0, False)[: len(trace)]
        self.calls_foreign_macro = trace.blocks.codes(*self.source.macro.macro_calls) & ~enters

    def names(self, text: str) -> bool:
        """The text of a block is a call or a return in the words of the profile, in whatever language."""
        squeezed = _BLANKS.sub("", text).upper()
        return bool(self._call and self._call.fullmatch(squeezed)) or (bool(self._return) and squeezed == self._return)

    def words_of_row(self, row: int, text: str) -> list[str] | None:
        """
        Return the words of a block that calls a program or returns from one; None for any other block.

        text: of the block, without N word and comments. Raises RefusedError where the other machine has no words.
        """
        if self.calls_foreign_macro[row] or (not self.names(text) and not self.is_flow[row]):
            return None
        squeezed = _BLANKS.sub("", text).upper()
        line = self.trace.line(row)
        if not self.is_same and squeezed == self._return and not int(self.trace.run.depth[row]):
            reason = f"{text}: how {self.target.title} begins the main program again is not known"
            raise refused_at(self.trace, row, reason)
        match = self._call.fullmatch(squeezed) if self._call else None
        if match and not self._enters[row]:
            self.missing.setdefault(int(match["number"]) % _LAST_DIGITS, line)
        words = text.split() if self.is_same else self.written(text)
        if words is None:
            reason = f"{text}: how {self.target.title} writes that is not known"
            raise refused_at(self.trace, row, reason)
        return list(words)

    def written(self, text: str) -> tuple[str, ...] | None:
        """
        A block that calls or returns, as the other machine writes it; None where one of them has no words for it.

        text: of the block, without N word and comments.
        """
        squeezed = _BLANKS.sub("", text).upper()
        theirs = self.target.writing
        if squeezed == self._return and self._return:
            return tuple(theirs.subprogram_return.split()) if theirs.subprogram_return else None
        match = self._call.fullmatch(squeezed) if self._call else None
        if match is None or not theirs.subprogram_call:
            return None
        number, repeats = int(match["number"]), match["repeats"]
        if self.source.macro.repeats_in_p and number >= _LAST_DIGITS and not repeats:
            repeats, number = str(number // _LAST_DIGITS), number % _LAST_DIGITS
        if not repeats:
            return tuple(theirs.subprogram_call.replace("#", str(number)).split())
        if not theirs.subprogram_repeats:
            return None
        call = theirs.subprogram_call.replace("#", str(number))
        return (*call.split(), f"{theirs.subprogram_repeats}{int(repeats)}")


def _pattern(call: str, repeats: str) -> re.Pattern[str] | None:
    if not call:
        return None
    head, _, tail = ("".join(call.split())).partition("#")
    times = f"(?:{re.escape(repeats)}(?P<repeats>\\d{{1,9}}))?" if repeats else "(?P<repeats>)"
    return re.compile(f"{re.escape(head)}0*(?P<number>\\d{{1,9}}){re.escape(tail)}{times}")
