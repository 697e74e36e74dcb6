"""The orders of a program beside its moves: tools, speeds, M codes, cycles, dwells, in the order in which they run."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np

from polarcheck.columns.feed.dwells import dwells, time_of_dwells
from polarcheck.columns.filling import before, fill_down
from polarcheck.columns.trace import Trace
from polarcheck.foundation.arrays import Floats, Mask, Rows, cached_property
from polarcheck.foundation.patterns import lazy_pattern
from polarcheck.foundation.states import MM_PER_INCH, MOVES, STATES, FeedMode, Units
from polarcheck.program.execution.run import NO_VARIABLE, Assigned
from polarcheck.program.machines.axis_table import FIRST_NAMED, OF_SPINDLE
from polarcheck.program.machines.code_tables import code_set
from polarcheck.program.reading.excerpt import shortened
from polarcheck.rules.wording.written import executed_word

_OF_ARCS = ("I", "J", "K", "R")
#: Words of plain moves, and words that only name blocks.
_OF_MOVES = ("X", "Z", "U", "W", *_OF_ARCS, "F", "N", "O", "/")
_FEED_MODES: dict[int, str] = {FeedMode.PER_MINUTE: " mm/min", FeedMode.PER_REVOLUTION: " mm/rev"}
#: Words beside the code of a call: the program or block, how often, where from.
_OF_CALLS = "PLQH"
#: Words that hold lengths in a cycle.
_LENGTHS = ("X", "Y", "Z", "U", "V", "W", "I", "J", "K", "R")
#: Lists of G codes whose states are compared as moves, feeds and entries, not as orders.
_OF_STATES = (
    *MOVES.values(),
    *(key for group in ("plane", "side", "units", "feed_mode", "distance") for key in STATES[group]),
)
#: A statement by its name, with what is handed to it: `ADIS=0.5`, `ACC[X]=80`, `SOFT`.
_STATEMENT = lazy_pattern(r"(?<![\w$])([A-Z]\w+)(?:\[[^\]]{0,99}+\])?(?:\s*+=\s*+[^\s;]++|\([^)]{0,99}+\))?")
#: The number of a block.
_NUMBER = re.compile(r"^\s*N\d+")
#: Characters of a statement that is named.
_LONGEST = 60
#: M codes that mean the same on every lathe, and whose effect no table of states shows.
_EVERYWHERE = ("M0", "M1", "M7", "M8", "M9")
#: M codes that are compared across machines in another way, or that end programs.
_COMPARED_OTHERWISE = ("M2", "M3", "M4", "M5", "M30")


class Step(NamedTuple):
    """
    An order beside the moves.

    row: row of the trace.
    line: its line in the file; 0 in a golden trace.
    tokens: its codes, and the addresses of its values.
    values: the numbers at these addresses; lengths in mm, X as a radius.
    text: as it is reported.
    """

    row: int
    line: int
    tokens: tuple[str, ...]
    values: tuple[float, ...]
    text: str


def speed_in_force(trace: Trace) -> Floats:
    """Return the last S up to each row as written, ignoring limits beside G50; NaN before the first."""
    written = trace.blocks.has("S") & ~trace.modal.sets_coordinates
    return fill_down(np.where(written, trace.blocks.word("S"), np.nan), written | trace.blocks.starts, np.nan)


def feed_step(trace: Trace, row: int) -> Step:
    """Return the F of a move at feed as an order."""
    unit, feed = feed_unit(int(trace.feedrate.feed_mode[row])), float(trace.feedrate.feed_number[row])
    return Step(row, trace.line(row), (f"F{unit}",), (feed,), f"F{feed:g}{unit} of a first move")


def feed_unit(feed_mode: int) -> str:
    """Return ` mm/min` or ` mm/rev` for a FeedMode; empty for another one."""
    return _FEED_MODES.get(feed_mode, "")


def special_rows(trace: Trace) -> Mask:
    """
    Return a mask of the rows whose axis words are not the end of a plain move: cycles, references, shifts, dwells,
    blocks that are not executed.
    """
    modal = trace.modal
    with_other_words = trace.blocks.listed("machine_coordinates", "repetitive_cycle") | modal.sets_coordinates
    return np.asarray(~modal.uses_axes | modal.in_cycle | with_other_words)


def steps(trace: Trace, *, is_same_machine: bool, with_sides: bool = True) -> list[Step]:
    """
    Return the orders of a program in the order in which they run.

    is_same_machine: both revisions are for the same machine. Otherwise only M codes count that mean the same on every
    lathe: which others a contour needs depends on the lathe.
    with_sides: G40 to G42, D and G12.1 in the mode count, too; False where the path of the tool center shows them.
    """
    reader = _Reader(trace, is_same_machine, with_sides)
    in_order = [*filter(None, map(reader.step, _rows(trace, is_same_machine).tolist()))]
    not_simulated = [*statements(trace)] if is_same_machine else []
    return sorted([*not_simulated, *in_order], key=lambda step: step.row) if not_simulated else in_order


def statements(trace: Trace) -> Iterator[Step]:
    """
    Yield the statements that change speeds and corners alone, and the blocks without N that are not simulated, or call
    a program that is missing.

    Each has the row of the block that runs behind it.
    """
    text, listed = trace.text, trace.machine.macro.statements.items()
    names = {name.partition("[")[0].rstrip("=") for name, effect in listed if effect == "speeds"}
    unread = {remark.block for remark in trace.run.remarks if remark.kind == "not-simulated"}
    unread |= {fault.block for fault in trace.run.faults if fault.kind == "program-not-found"}
    blocks = sorted(unread.union(np.flatnonzero(text.blocks.is_macro).tolist() if names else ()))
    if not blocks or not len(trace):
        return
    for block, row in zip(blocks, rows_behind(trace, blocks), strict=True):
        content = text.without_comments(block).upper()
        of_speeds = [match[0] for match in _STATEMENT.finditer(content) if match[1] in names]
        for written in [_NUMBER.sub("", content)] if block in unread else of_speeds:
            statement = "".join(written.split())
            yield Step(row, int(text.blocks.line[block]), (statement,), (), shortened(statement, _LONGEST))


def rows_behind(trace: Trace, blocks: Sequence[int]) -> list[int]:
    """Return for each block its first row, or that of the first executed block behind it; the last row at the end."""
    executed, first_row = np.unique(trace.run.block, return_index=True)
    rows: list[int] = np.append(first_row, len(trace) - 1)[np.searchsorted(executed, blocks)].tolist()
    return rows


def not_comparable(trace: Trace) -> list[str]:
    """Return the M codes of a program that cannot be compared with those of another lathe."""
    macro = trace.machine.macro
    comparable = {*_EVERYWHERE, *_COMPARED_OTHERWISE, *macro.subprogram_calls, *macro.program_returns}
    written = dict.fromkeys(f"M{value:g}" for value in trace.run.words.value[trace.blocks.m_words].tolist())
    return [word for word in written if word not in comparable]


def _rows(trace: Trace, is_same_machine: bool) -> Rows:
    """Return the rows that may order something beside their moves."""
    blocks, row = trace.blocks, trace.run.row
    turns_side = _turns_side(trace)
    if not is_same_machine:
        return np.unique(np.concatenate([row[blocks.m_words], np.flatnonzero(turns_side)]))
    usual = [trace.machine.address_number(name) for name in (*_words_of_moves(trace), "G") if name]
    unusual = ~np.isin(trace.run.words.address, usual)
    unusual[blocks.g_words[~_sets_state(trace)]] = True
    settings = np.array(list(trace.run.assigned), np.int64)
    return np.unique(np.concatenate([row[unusual], settings, np.flatnonzero(special_rows(trace) | turns_side)]))


def _words_of_moves(trace: Trace) -> set[str]:
    polar, arcs = trace.machine.polar, trace.machine.arcs
    return {*_OF_MOVES, *polar.axis_addresses, *polar.rotary_words, arcs.radius_word}


def _sets_state(trace: Trace) -> Mask:
    """
    Return a mask of the G words whose state is compared elsewhere; G12.1 in the mode sets none.

    Whether X is a radius is seen in the path.
    """
    words = [word for key in _OF_STATES for word in trace.machine.codes(key)]
    words += [*trace.machine.polar.on, *trace.machine.polar.off]
    sets = code_set([word for word in words if word.startswith("G") and " " not in word])[trace.blocks.g_codes]
    sets |= np.isin(trace.blocks.g_words, _x_switches(trace))
    return np.asarray(sets & ~trace.mode.enters_again[trace.run.row[trace.blocks.g_words]])


def _x_switches(trace: Trace) -> Rows:
    """Return the words that make X a radius or a diameter: DIAMOF, G7, G10.9 beside X0."""
    control = trace.machine.control
    return trace.blocks.code_indices(*control.x_radius_words, *control.x_diameter_words)


def _turns_side(trace: Trace) -> Mask:
    """
    Return a mask of the rows that start or end compensation where the path does not show it: outside sections, or with
    R unknown.
    """
    side = trace.compensation.side
    is_hidden = (trace.mode.section < 0) | np.isnan(trace.compensation.radius_of_move)
    return np.asarray((side != before(side, trace.blocks.starts, 40)) & is_hidden)


def _of_calls(trace: Trace) -> Mask:
    """
    Return a mask of the words that call and return; the called blocks, with macro arguments filled in, are compared
    instead.
    """
    blocks, macro, row = trace.blocks, trace.machine.macro, trace.run.row
    plain = (*macro.subprogram_calls, *macro.local_calls, *macro.program_returns)
    of_macros = (*macro.macro_calls, *macro.modal_macro_calls, *macro.modal_macro_calls_each_block)
    words = blocks.words_at(blocks.code_indices(*plain)) | blocks.codes(*of_macros)[row]
    arguments = np.isin(trace.run.words.address, [ord(name) for name in _OF_CALLS])
    return np.asarray(words | (arguments & blocks.codes(*plain)[row]))


class _Reader:
    """Reads the orders of rows in sequence."""

    def __init__(self, trace: Trace, is_same_machine: bool, with_sides: bool) -> None:
        self._trace = trace
        self._is_same_machine = is_same_machine
        self._of_moves = _words_of_moves(trace) | (set() if with_sides else {"D"})
        self._special = special_rows(trace)
        #: The time of a dwell [ms], whichever word says it; NaN for other rows.
        self._dwell = np.where(dwells(trace), 1000 * time_of_dwells(trace), np.nan)
        self._turns_side = _turns_side(trace) & with_sides
        self._is_left_out = trace.run.words.is_unreadable | _of_calls(trace)
        # Corners that the control makes in the mode show in the path.
        corners = trace.blocks.word_indices(*trace.machine.arcs.made_corners)
        self._is_left_out[corners[trace.mode.in_polar[trace.run.row[corners]]]] = True
        is_seen = _sets_state(trace) | (trace.mode.enters_again[trace.run.row[trace.blocks.g_words]] & (not with_sides))
        self._is_left_out[trace.blocks.g_words[is_seen]] = True
        # The X of G10.9 X0.
        switches = trace.blocks.with_words(_x_switches(trace)) & ~trace.modal.uses_axes
        self._is_left_out |= switches[trace.run.row] & (trace.run.words.address == ord("X"))
        self._in_force: dict[str, float] = {}

    def step(self, row: int) -> Step | None:
        """Return the order of a row; None if it orders nothing that is not in force already."""
        low, high = np.searchsorted(self._trace.run.row, (row, row + 1)).tolist()
        parts = [part for index in range(low, high) if (part := self._part(row, index)) is not None]
        if parts and self._is_same_machine and self._trace.modal.in_cycle[row]:
            parts.append(self._feed(row))
        if (assigned := self._trace.run.assigned.get(row)) is not None:
            parts.append(self._setting(row, assigned))
        if self._turns_side[row]:
            side = f"G{int(self._trace.compensation.side[row])}"
            parts.insert(0, (side, None, side))
        if not parts:
            return None
        text = " ".join(part[2] for part in parts)
        # A block is executed whole, in whatever order its addresses stand; of two codes of a group the last one counts.
        tokens, values, _ = zip(*sorted(parts, key=lambda part: part[0][0]), strict=True)
        line = self._trace.line(row)
        return Step(row, line, tokens, tuple(value for value in values if value is not None), text)

    def _part(self, row: int, index: int) -> tuple[str, float | None, str] | None:
        """Return token, value and text of a word; None for a word that is compared elsewhere."""
        words, is_special = self._trace.run.words, bool(self._special[row])
        name, value = self._address(int(words.address[index])), float(words.value[index])
        written = executed_word(self._trace.run, index)
        # A word of a language of its own, as OFFN=, is read as one of a letter.
        is_as_written = np.isnan(value) or not name[-1].isalnum() or not written.upper().startswith(name)
        text = written if is_as_written else f"{name}{value:.10g}"
        # Two codes that are not known may be the same.
        token = f"{name}{value:.10g}"
        if self._is_left_out[index]:
            return None
        if name == "M":
            return (token, None, text) if self._is_same_machine or text in _EVERYWHERE else None
        if not self._is_same_machine:
            return None
        if name in self._trace.machine.feed.dwell_words and not np.isnan(self._dwell[row]):
            return "P", float(self._dwell[row]), text
        if name in ("S", "T"):
            if not is_special:
                if self._in_force.get(name) == value:
                    return None
                self._in_force[name] = value
            return name, value, text
        if words.address[index] == OF_SPINDLE:
            return f"{written.partition('=')[0]}=", value, written
        if name in ("N", "O", "/") or (name == "F" and self._trace.modal.in_cycle[row]):
            return None
        if name == "G":
            return token, None, text
        # Beside an order without a move R is no radius: `M19 R90.`.
        is_order = is_special or name not in self._of_moves or (name in _OF_ARCS and not self._trace.axes.moves[row])
        return (name, self._length(name, row, value), text) if is_order else None

    def _setting(self, row: int, assigned: Assigned) -> tuple[str, float, str]:
        """Return token, value and text of an assignment, as it is written where its variable or value is not known."""
        name = f"{assigned.name}={'+' * assigned.is_step}"
        if assigned.value == assigned.value:
            return name, assigned.value, f"{name}{assigned.value:.10g}"
        content = self._trace.text.without_comments(int(self._trace.run.block[row])).upper()
        written = "".join(_NUMBER.sub("", content).split())
        return written if assigned.variable == NO_VARIABLE else name, assigned.value, written

    def _feed(self, row: int) -> tuple[str, float | None, str]:
        """
        Return token, value and text of the F in force in a cycle, wherever it is written [mm per min or revolution].
        """
        feedrate, lead = self._trace.feedrate, float(self._leads[row])
        feed = lead if lead == lead else float(np.nan_to_num(feedrate.feed_number[row]))
        mode = feed_unit(int(feedrate.feed_mode[row]))
        return f"F{mode}", feed, f"F{feed:.10g}{mode}"

    @cached_property
    def _leads(self) -> Floats:
        """The F of a thread, which is no feed for later blocks, up to the next F or the end of its cycle."""
        blocks, in_cycle = self._trace.blocks, self._trace.modal.in_cycle
        leads = blocks.listed("feed_is_lead") & blocks.has("F")
        lead = np.where(leads, blocks.word("F") * self._trace.lengths.feed_scale, np.nan)
        return fill_down(lead, blocks.has("F") | ~in_cycle | blocks.starts, np.nan)

    def _length(self, name: str, row: int, value: float) -> float:
        """Return the value of a word of a cycle, converted if it may be a length [mm, X as a radius]."""
        trace = self._trace
        if name not in _LENGTHS:
            return value
        length = float(trace.lengths.length_of(name)[row])
        if np.isnan(length):
            length = value * (MM_PER_INCH if trace.lengths.units[row] == Units.INCH else 1.0)
        return length * float(trace.lengths.x_factor[row]) if name in ("X", "U") else length

    def _address(self, number: int) -> str:
        """Return the address with this number: a letter, a letter after a comma as `,R`, or the name of an axis."""
        if number < FIRST_NAMED:
            return f",{chr(number).upper()}" if chr(number).islower() else chr(number)
        control = self._trace.machine.control
        named = [*sorted(control.named_axes), *sorted(control.spindle_words)]
        return named[number - FIRST_NAMED] if number - FIRST_NAMED < len(named) else "?"
