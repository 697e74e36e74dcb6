"""What a word means where a code beside it says so: the words of a cycle, of a dwell, the arguments of a macro call."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from polarcheck.editor.words import codes
from polarcheck.editor.words.at_cursor import CursorWord
from polarcheck.program.execution.macro import ARGUMENTS
from polarcheck.program.machines.machine import Machine

#: Words that mean the same beside any code.
_AS_EVER = frozenset("NOGMTS/")
#: Lists of codes whose words are numbers of their own, and no end point of a move.
_OF_CYCLE = ("repetitive_cycle", "data_input", "axis_words_no_move", "work_offset_extended")
#: Lists of codes whose F is the lead of a thread.
_THREADS = ("thread_cutting", "threading_cycle", "feed_is_lead")


def meaning_of(word: CursorWord, machine: Machine) -> str:
    """Return what a word means since a code stands in its block; empty where its address alone says it."""
    if word.kind != "word" or word.letter in _AS_EVER:
        return ""
    for code in _codes_of(word):
        for meaning in codes.meanings_of(code, machine):
            text = _of_list(word.letter, code, meaning.key.rpartition(".")[2], machine)
            if text:
                return text
    return ""


def _codes_of(word: CursorWord) -> Iterator[str]:
    """Yield the G and M codes of its block."""
    words = word.text.words
    low, high = np.searchsorted(words.block, (word.block, word.block + 1)).tolist()
    for index in range(low, high):
        letter, value = chr(int(words.address[index])), float(words.value[index])
        if letter in ("G", "M") and 0 <= value < 1e5:
            yield f"{letter}{value:g}"


def _of_list(letter: str, code: str, name: str, machine: Machine) -> str:
    if letter == "F" and name in _THREADS:
        return "lead of the thread"
    if letter == "H" and name == "tool_length_offset":
        return "number of the tool offset"
    if letter == "F" and name not in ("macro_calls", "modal_macro_calls"):
        return ""
    if name in ("macro_calls", "modal_macro_calls"):
        if letter in ("P", "L"):
            return "number of the program that is called" if letter == "P" else "how often it is called"
        # Which variable I, J and K are depends on those before them.
        number = f", #{ARGUMENTS[letter]} there" if letter in ARGUMENTS and letter not in "IJK" else ""
        return f"argument of the macro{number}"
    if name == "subprogram_calls":
        return {"P": "number of the program that is called", "L": "how often it is called"}.get(letter, "")
    if name == "program_returns" and letter == "P":
        return "number of the block of the caller to return to"
    if name == "dwell" and letter in machine.feed.dwell_words:
        return "time of the dwell"
    if name in _OF_CYCLE or (name == "drilling_cycle" and letter in "RQPKL"):
        return f"a number for {code}, which says what it means"
    return ""
