"""The tool in force in each executed block, and its offset: by the last digits of T, or by T and the edge of D."""

from __future__ import annotations

import numpy as np

from polarcheck.columns.filling import before, fill_down, happened
from polarcheck.columns.modes.executed_blocks import ExecutedBlocks
from polarcheck.columns.modes.tool_changes import OFFSET_COUNT, called_tools
from polarcheck.foundation.arrays import Columns, Mask, Rows, cached_property, is_among
from polarcheck.program.execution.run import Run
from polarcheck.program.machines.job import Job, Tool
from polarcheck.program.machines.machine import Machine
from polarcheck.program.machines.offset_keys import key_of

_LONGEST_TOOL_NUMBER = 1e15
#: Digits of T for the tool, where digits of their own name the offset with R.
_TOOL_DIGITS = 2
#: As many edges a tool may have, and as large its number may be where it has some.
_EDGES = 100_000
_LARGEST_TOOL = 10**13
#: The edge of a D whose value is not known, and the tool before the first T.
_UNKNOWN = _EDGES - 1
_NO_TOOL = _LARGEST_TOOL


class CalledTools(Columns, frozen=True):
    """The tool and the tool offset that the program calls."""

    run: Run
    machine: Machine
    job: Job
    blocks: ExecutedBlocks

    @cached_property
    def _called_at_changes(self) -> tuple[Mask, Rows] | None:
        return called_tools(self.blocks) if self.machine.offsets.called_by == "tool-change" else None

    @cached_property
    def calls_tool(self) -> Mask:
        """The row calls a tool: by T, or by the M6 for which T has prepared it."""
        return self.blocks.has("T") if self._called_at_changes is None else self._called_at_changes[0]

    @cached_property
    def _t(self) -> Rows:
        """The number that the last T has, 0 before the first; where M6 calls, in the same form (tool_changes)."""
        if self._called_at_changes is not None:
            calls, number = self._called_at_changes
            return fill_down(number, calls | self.blocks.starts, 0)
        written, called = self.blocks.has("T"), self.blocks.word("T")
        # A longer number calls nothing (too-many-digits), and none that a whole number could hold.
        value = np.where(np.abs(called) < _LONGEST_TOOL_NUMBER, called, 0).astype(np.int64)
        return fill_down(value, written | self.blocks.starts, 0)

    @cached_property
    def has_edges(self) -> Mask:
        """The tool in force has edges: T is the tool alone, and D calls the offset. One with a name always has."""
        if self.machine.offsets.called_by == "edge":
            return np.ones(len(self.run), bool)
        return is_among(self._t, list(self.run.names))

    @cached_property
    def calls_edge(self) -> Mask:
        """A D word that calls an edge of the tool in force."""
        return self.blocks.has("D") & self.has_edges

    @property
    def means_cutter_by_d(self) -> Mask:
        """A D word where D calls nothing: tools have no edges."""
        return self.blocks.has("D") & ~self.has_edges

    @cached_property
    def calls_offset(self) -> Mask:
        """A word stands in the row that calls a tool offset, be it the one in force: T, or D of a tool with edges."""
        return self.calls_tool | self.calls_edge

    @cached_property
    def edge(self) -> Rows:
        """The edge in force by D, or by the tool change that calls one by itself; 0 for none."""
        called, default = self.calls_edge, self.machine.offsets.edge_after_tool
        by_tool = self.blocks.has("T") & (self._t != before(self._t, self.blocks.starts, 0)) & ~called & (default >= 0)
        written = np.where(np.abs(self.blocks.word("D")) < _UNKNOWN, np.abs(self.blocks.word("D")), _UNKNOWN)
        value = np.where(called, written, np.where(by_tool, default, 0)).astype(np.int64)
        return fill_down(value, called | by_tool | self.blocks.starts, 0)

    @cached_property
    def tool_called(self) -> Rows:
        """The tool and offset called in each row as one number: 808 for T0808; 0 before the first call."""
        if not self.has_edges.any():
            return self._t
        tool = np.where(happened(self.blocks.has("T"), self.blocks.starts), self._t, _NO_TOOL)
        is_edge = (self.edge > 0) & (tool != 0) & (np.abs(tool) <= _NO_TOOL)
        return np.where(self.has_edges, np.where(is_edge, np.abs(tool) * _EDGES + self.edge, 0), self._t)

    @property
    def tool_called_before(self) -> Rows:
        """The tool and offset that T called above the row."""
        return before(self.tool_called, self.blocks.starts, 0)

    @cached_property
    def is_unknown(self) -> Mask:
        """The word that has called the tool or the edge in force has no known value."""
        unknown = (self.blocks.is_unknown("T") & self.calls_tool) | (self.blocks.is_unknown("D") & self.calls_edge)
        return happened(unknown, (self.calls_offset & ~unknown) | self.blocks.starts) if unknown.any() else unknown

    @cached_property
    def has_called_tool(self) -> Mask:
        """A tool or its offset has been called in the row or above it in its program."""
        return happened(self.calls_offset, self.blocks.starts)

    @cached_property
    def tool(self) -> Rows:
        """Tool number in force, 0 before the first; one with a name has a number of its own (run.names)."""
        # Where D calls the offset, T is the tool alone; of an offset by D that of the tool is assumed.
        number = self._t if self.machine.offsets.called_by == "d-word" else self._t // self._most_plain
        plain = np.where(self._names_radius_offset, number % 10**_TOOL_DIGITS, number)
        return np.where(self.has_edges, self._t, plain)

    @cached_property
    def _names_radius_offset(self) -> Mask:
        """T has digits of its own for the offset with R: T010203 is R of offset 1, tool 2, offset 3."""
        control, words = self.machine.control, self.run.words
        names_offset, short = np.zeros(len(self.run), bool), _TOOL_DIGITS + control.offset_digits
        if not control.radius_offset_digits:
            return names_offset
        index = self.blocks.word_indices("T")
        is_long = (words.digits[index] > short) | (np.nan_to_num(words.value[index]) >= 10**short)
        names_offset[self.run.row[index]] = is_long
        return fill_down(names_offset, self.blocks.has("T") | self.blocks.starts, False).astype(bool)

    @property
    def _plain_offset(self) -> Rows:
        """Number of the offset with R as the digits of T name it, which is that of the tool unless T names another."""
        named = self._t // (10**_TOOL_DIGITS * self._most_plain) % self._most_plain
        return np.where(self._names_radius_offset, named, self._t % self._most_plain)

    @cached_property
    def tool_offset_number(self) -> Rows:
        """Number of the tool offset in force, 0 for none; R may be that of another one."""
        return np.where(self.has_edges, self.offset_number, self._t % self._most_plain)

    @property
    def _most_plain(self) -> int:
        """How many numbers of offsets the digits of T leave room for."""
        return OFFSET_COUNT if self._called_at_changes else int(10**self.machine.control.offset_digits)

    @cached_property
    def _edges_called(self) -> Rows:
        """The edges of tools that are in force anywhere, as tool_called has them, each once, ascending."""
        edges = np.sort(self.tool_called[self.has_edges & (self.tool_called > 0)])
        # NumPy's unique would load its masked arrays.
        return np.asarray(edges[np.append(True, np.diff(edges) > 0)[: len(edges)]])

    @cached_property
    def offset_number(self) -> Rows:
        """Offset number in force, 0 for none; an edge of a tool has one of its own, beyond those of the control."""
        if not len(self._edges_called):
            return np.where(self.has_edges, 0, self._plain_offset)
        of_edge = self._most_plain + np.searchsorted(self._edges_called, self.tool_called)
        plain = np.where(self.has_edges, 0, self._plain_offset)
        return np.where(self.has_edges & (self.tool_called > 0), of_edge, plain)

    @property
    def offset_count(self) -> int:
        """More than the highest offset number."""
        return self._most_plain + len(self._edges_called)

    @property
    def called_offsets(self) -> list[int]:
        """The offset numbers that are called anywhere."""
        numbers = np.abs(self.offset_number[self.calls_offset])
        return np.flatnonzero(np.bincount(numbers, minlength=1)).tolist()

    @cached_property
    def changes_tool(self) -> Mask:
        """A T word that names another tool than the one in force."""
        is_other = self.tool != before(self.tool, self.blocks.starts, 0)
        return np.asarray(self.calls_tool & is_other & (self.tool > 0))

    @cached_property
    def takes_offset_of_other(self) -> Mask:
        """T with the offset of another tool, which is called with it, too; T is never called with its own: T0103."""
        call = self.calls_tool & ~self.has_edges & (self.tool > 0)
        is_own = call & (self.tool == self.tool_offset_number)
        by_tool = is_among(np.stack([self.tool, self.tool_offset_number]), self.tool[is_own])
        return np.asarray(call & ~by_tool[0] & by_tool[1])

    def tool_name(self, tool: int) -> str:
        """The name or the number of a tool in force; empty for the one that is there before the first T."""
        return "" if tool == _NO_TOOL else self.run.names.get(tool, str(tool))

    def edge_of(self, offset: int) -> tuple[str, str] | None:
        """Tool and edge of an offset number; None for one that has no edge. The edge is ? where D is not known."""
        if offset < self._most_plain:
            return None
        tool, edge = divmod(int(self._edges_called[offset - self._most_plain]), _EDGES)
        return self.tool_name(tool), "?" if edge == _UNKNOWN else str(edge)

    def offset_key(self, offset: int) -> str:
        """The key by which a job gives an offset number (offset_keys); for an unknown one, a key that no job has."""
        pair = self.edge_of(offset)
        if pair is None:
            return str(offset)
        tool, edge = pair
        return key_of(tool, int(edge)) if tool and edge.isdecimal() else ""

    @cached_property
    def of_job(self) -> dict[int, Tool]:
        """The offsets of this file in the job, by offset number."""
        if not self.job.tools:
            return {}
        plain = {int(key): tool for key, tool in self.job.tools.items() if key.isdecimal()}
        tools = {number: tool for number, tool in plain.items() if number < self._most_plain}
        for number in range(self._most_plain, self.offset_count):
            key = self.offset_key(number)
            if key in self.job.tools:
                tools[number] = self.job.tools[key]
        return tools
