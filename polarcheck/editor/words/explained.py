"""What a word means on this machine, at its block."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from polarcheck.columns.trace import Trace
from polarcheck.editor.analysis import Analysis
from polarcheck.editor.words import code_meanings, in_force, variables
from polarcheck.editor.words.at_cursor import CursorWord
from polarcheck.foundation.arrays import Rows
from polarcheck.foundation.states import FeedMode, Units
from polarcheck.program.execution.macro import ARGUMENTS
from polarcheck.program.machines.code_lists import expanded
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
        for meaning in code_meanings.meanings_of(code, machine):
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


Facts = list[tuple[str, str]]
#: The longest number that is repeated as a code [characters].
_LONGEST_CODE = 8
_AXES = {"X": "X", "Y": "Y", "Z": "Z", "U": "X", "V": "Y", "W": "Z"}


def explained(word: CursorWord, analysis: Analysis, trace: Trace | None, row: int | None) -> tuple[str, Facts]:
    """
    Return a word with its meaning, and facts by name; the meaning is empty if nothing is known of it.

    trace, row: the run that executes its block, and the first row of the block there; None if no run does.
    """
    assert analysis.settings is not None
    machine = analysis.settings.machine
    if word.kind == "variable":
        return word.letter, list(variables.facts_of(word, analysis, row, trace))
    if word.kind == "name":
        code_read = machine.control.native_words.get(word.letter)
        if code_read is None:
            return "", []
        return f"{word.letter}: read as {code_read}", list(_of_code(code_read, analysis, trace, row)) if code_read[
            0
        ] in "GM" else []
    if word.letter in ("G", "M"):
        code = _code(word)
        if code:
            text = code_meanings.known_codes(machine).get(code)
            written = "".join(word.text.source.excerpt(word.start, word.end).split()).upper()
            name = code if written.startswith(word.letter) else f"{written} ({code})"
            title = f"{name}: {text}" if text else name
            return title, list(_of_code(code, analysis, trace, row))
    title = meaning_of(word, machine) or _title(word, machine, trace, row)
    return (f"{word.letter}: {title}" if title else ""), list(_more(word, trace, row))


def _code(word: CursorWord) -> str:
    """Return a G or M word as the profile writes it; empty for a computed one."""
    if word.value is None or not 0 <= word.value < 10 ** (_LONGEST_CODE - 1):
        return ""
    return f"{word.letter}{word.value:g}" if word.value < 1e5 else ""


def _of_code(code: str, analysis: Analysis, trace: Trace | None, row: int | None) -> Iterator[tuple[str, str]]:
    """Yield sources and effects of a code."""
    assert analysis.settings is not None
    machine = analysis.settings.machine
    meanings = code_meanings.meanings_of(code, machine)
    if not meanings:
        if code_meanings.is_known(code, machine):
            yield "meaning", "a code of this control; polarcheck follows nothing of it"
        elif code[0] == "G":
            yield "meaning", f"not among the codes of {machine.title}"
        else:
            yield "meaning", f"not in the profile of {machine.title}; [m_codes] of a machine file says what it does"
    for meaning in meanings[:2]:
        source = code_meanings.source_of(meaning.key, analysis)
        yield "source", f"{source} ({meaning.key})" if source else meaning.key
    if code[0] != "G":
        return
    group = in_force.group_of(code, machine)
    if trace is not None and row is not None:
        if trace.mode.in_polar[row] and meanings and meanings[0].key not in ("polar.on", "polar.off"):
            is_allowed = code in set(expanded(machine.polar.allowed_codes))
            yield "in the polar mode", "allowed" if is_allowed else "not among the codes that may be used"
        if group:
            before = in_force.code_in_force(trace, group, row - 1) if not trace.blocks.starts[row] else ""
            was = f"; before it {before}" if before and before != code else ""
            yield "modal", f"group of {in_force.title_of(group)}{was}"


def _title(word: CursorWord, machine: Machine, trace: Trace | None, row: int | None) -> str:
    """Return what the address of a word stands for."""
    letter = word.letter
    in_polar = trace is not None and row is not None and bool(trace.mode.in_polar[row])
    if letter in ("N", "O"):
        return "sequence number, the target of jumps" if letter == "N" else "program number"
    if letter == "T":
        return "tool and tool offset" if machine.offsets.called_by != "edge" else "tool; D calls its edge"
    if letter == "F":
        return _feed(trace, row)
    if letter == "S":
        speed = in_force.code_in_force(trace, "speed", row) if trace is not None and row is not None else ""
        is_surface = speed in machine.codes("constant_surface_speed")
        return f"surface speed, since {speed} is in force" if is_surface else "spindle speed [1/min]"
    return _of_axis(letter, machine, trace, row, in_polar)


def _feed(trace: Trace | None, row: int | None) -> str:
    if trace is None or row is None:
        return "feed"
    if trace.blocks.listed("dwell")[row]:
        return "time of the dwell"
    mode = FeedMode(int(trace.feedrate.feed_mode[row]))
    unit = "inch" if trace.lengths.feed_units[row] == Units.INCH else "mm"
    if mode == FeedMode.PER_REVOLUTION:
        return f"feed per revolution [{unit}/rev]"
    if mode == FeedMode.INVERSE_TIME:
        return "inverse of the time of the block [1/min]"
    along = " along the path in the plane of X and C" if trace.mode.in_polar[row] else ""
    return f"feed per minute{along} [{unit}/min]"


def _of_axis(letter: str, machine: Machine, trace: Trace | None, row: int | None, in_polar: bool) -> str:
    """Return what an axis, an arc word, or any other address stands for."""
    polar = machine.polar
    if in_polar and trace is not None and row is not None:
        virtual = trace.axes.virtual_axis_of(row)
        if letter in (virtual, polar.virtual_axis_incremental):
            how = "distance" if letter == polar.virtual_axis_incremental and letter != virtual else "coordinate"
            return f"virtual axis, a length as a {polar.virtual_axis_programming} and no angle ({how})"
    if letter in polar.rotary_words:
        return "rotary axis [deg]" + (", incremental" if letter == polar.rotary_incremental else "")
    if letter in _AXES:
        how = "distance" if letter in "UVW" else "coordinate"
        if _AXES[letter] == "X":
            is_diameter = (
                bool(trace.lengths.x_factor[row] < 1)
                if trace is not None and row is not None
                else (polar.x if in_polar else machine.control.x) == "diameter"
            )
            return f"X axis, {'a diameter' if is_diameter else 'a radius'} ({how})"
        return f"{_AXES[letter]} axis ({how})"
    if letter == machine.arcs.radius_word:
        return "radius of an arc"
    if letter in "IJK":
        return "center of an arc, from its start"
    if letter in ("P", "Q"):
        return "number of a program, of a block, or a time, as the code beside it says"
    if letter == "/":
        return "block skip: the block is left out while the switch is on"
    return ""


def _more(word: CursorWord, trace: Trace | None, row: int | None) -> Iterator[tuple[str, str]]:
    """Yield what else there is to say of a word: how its number counts."""
    if trace is None or row is None or word.value is None or word.has_point or len(word.letter) != 1:
        return
    run = trace.run
    low, high = (int(index) for index in _stretch(run.row, row))
    for index in range(low, high):
        if int(run.words.start[index]) == word.start and bool(trace.coordinates.is_unpointed[index]):
            counts = "least input increments" if trace.machine.control.number_without_point == "least-increment" else ""
            if counts:
                yield "without a decimal point", f"{word.value:g} counts {counts}"


def _stretch(rows: Rows, row: int) -> tuple[int, int]:
    low, high = np.searchsorted(rows, (row, row + 1)).tolist()
    return low, high
