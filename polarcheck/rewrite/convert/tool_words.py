"""T and D words: a tool and its offset as the other machine calls them, and the offsets of the job under new keys."""

from __future__ import annotations

import itertools

import msgspec
import numpy as np
from msgspec.structs import replace

from polarcheck.columns.trace import Trace
from polarcheck.foundation.states import Side
from polarcheck.program.machines.job import Job
from polarcheck.program.machines.machine import Machine
from polarcheck.program.machines.offset_keys import key_of

#: From here on offsets are numbered that the original has as edges of tools.
_FIRST_FREE = 51


class ToolCall(msgspec.Struct, frozen=True):
    """
    How a tool is called on the other machine.

    words: that call it. decision: what is to be decided about its offset; or empty. refusal: why it cannot be called.
    """

    words: tuple[str, ...] = ()
    decision: str = ""
    refusal: str = ""


class ToolWords:
    """
    The calls of tools of a program as those of another machine.

    keys: offset of the job by the key of the other machine -> its key in the job of the program.
    is_same: T and D words mean the same on both machines.
    """

    def __init__(self, trace: Trace, target: Machine) -> None:
        self.trace, self.source, self.target = trace, trace.machine, target
        self.keys: dict[str, str] = {}
        self._edges: dict[int, list[int]] = {}
        self._offsets: dict[tuple[int, int], int] = {}
        side = trace.compensation.side
        used: list[int] = np.unique(trace.tools.tool).tolist()
        free = (number for number in itertools.count(1) if number not in used)
        self._number_by_name = dict(zip((tool for tool in used if tool in trace.run.names), free, strict=False))
        self._compensated = {self._number(tool) for tool in np.unique(trace.tools.tool[side != Side.OFF]).tolist()}
        ours, theirs = self.source, target
        self.is_same = (
            ours.offsets.called_by == theirs.offsets.called_by
            and ours.control.offset_digits == theirs.control.offset_digits
            and ours.control.radius_offset_digits == theirs.control.radius_offset_digits
            and ours.has_edges == theirs.has_edges
        )

    def is_called_by_d(self, row: int) -> bool:
        """A D word calls in this row: an edge, or with T the offset that has the number of the tool."""
        trace = self.trace
        if self.source.offsets.called_by == "d-word" and trace.tools.calls_tool[row]:
            return bool(trace.tools.tool[row] == trace.blocks.word("D")[row])
        return bool(trace.tools.has_edges[row])

    def call(self, row: int) -> ToolCall:
        """The words that call in their place what a row calls; for a tool with a name those of a free number."""
        call, tool = self._call(row), int(self.trace.tools.tool[row])
        name = self.trace.run.names.get(tool)
        if name is None or call.refusal:
            return call
        words = " ".join(call.words)
        stands = f"{words} stands for the tool {name}: choose the number of its station"
        return replace(call, decision=f"{stands}. {call.decision}" if call.decision else stands)

    def _call(self, row: int) -> ToolCall:
        tools = self.trace.tools
        tool = self._number(int(tools.tool[row]))
        if not 0 <= tool <= 99:
            return ToolCall(refusal=f"the tool {tools.tool_name(tool)} is no number that both machines can call")
        if bool(tools.has_edges[row]):
            offset, radius_offset = int(tools.edge[row]), int(tools.edge[row])
        else:
            offset, radius_offset = int(tools.tool_offset_number[row]), int(tools.offset_number[row])
        key = tools.offset_key(int(tools.offset_number[row]))
        if self.target.offsets.called_by == "edge":
            return self._by_edge(row, tool, offset, radius_offset, key)
        if self.target.offsets.called_by == "d-word":
            if bool(tools.has_edges[row]) and offset == 1:
                offset = radius_offset = tool
            return self._by_d_word(tool, offset, radius_offset, key)
        if bool(tools.has_edges[row]):
            return self._of_edge(tool, offset, key)
        return self._by_digits(tool, offset, radius_offset, key)

    def _by_d_word(self, tool: int, offset: int, radius_offset: int, key: str) -> ToolCall:
        if tool and tool == offset == radius_offset and self._claim_key(str(offset), key):
            return ToolCall((f"T{tool}", f"D{offset}"))
        return ToolCall(decision=f"T{tool:02d}{offset:02d}: {self.target.title} calls tool and offset by T and D")

    def _by_digits(self, tool: int, offset: int, radius_offset: int, key: str) -> ToolCall:
        control = self.target.control
        if offset >= 10**control.offset_digits:
            return ToolCall(refusal=f"offset {offset} has more digits than T leaves room for")
        written = f"T{tool:02d}{offset:0{control.offset_digits}d}"
        if control.radius_offset_digits and offset and (radius_offset != offset or tool in self._compensated):
            # R in force is that of the digits before the tool: without them the control may take none.
            written = f"T{radius_offset:0{control.radius_offset_digits}d}{written[1:]}"
            number = radius_offset
        else:
            number = offset
        is_claimed = self._claim_key(str(number), key)
        if is_claimed and (radius_offset == offset or control.radius_offset_digits):
            return ToolCall((written,))
        if not is_claimed:
            return ToolCall(refusal=f"offset {number} is to have the radius of several offsets")
        return ToolCall((written,), f"{written}: enter the radius of offset {radius_offset} in offset {offset}")

    def _by_edge(self, row: int, tool: int, offset: int, radius_offset: int, key: str) -> ToolCall:
        changes = row == 0 or self.trace.tools.tool[row - 1] != self.trace.tools.tool[row]
        # T0000 cancels the offset; T0 would take the tool away.
        head = (f"T{tool}",) if changes and tool else ()
        if not offset:
            return ToolCall((*head, "D0"))
        edges = self._edges.setdefault(tool, [])
        if offset not in edges:
            edges.append(offset)
        edge = edges.index(offset) + 1
        is_new = self._claim_key(key_of(str(tool), edge), key)
        if not is_new:
            return ToolCall(refusal=f"edge {edge} of tool {tool} is to have the radius of several offsets")
        words = (*head, f"D{edge}")
        if edge == 1 and offset == tool == radius_offset:
            return ToolCall(words)
        return ToolCall(words, f"D{edge} of tool {tool}: enter the values of offset {radius_offset}")

    def _of_edge(self, tool: int, edge: int, key: str) -> ToolCall:
        if not edge:
            return self._by_digits(tool, 0, 0, "")
        offset = tool if edge == 1 else self._offsets.setdefault((tool, edge), self._free_offset())
        call = self._by_digits(tool, offset, offset, key)
        if edge == 1 or call.refusal:
            return call
        text = f"{call.words[0]}: enter the values of edge {edge} of tool {tool} in offset {offset}"
        return ToolCall(call.words, text)

    def _number(self, tool: int) -> int:
        """The number by which a tool is called; for one with a name the next one that the program does not use."""
        return self._number_by_name.get(tool, tool)

    def _free_offset(self) -> int:
        """The next offset number that is neither a tool of the program nor taken."""
        taken = {*self._offsets.values(), *(self._number(tool) for tool in np.unique(self.trace.tools.tool).tolist())}
        return next(number for number in itertools.count(_FIRST_FREE) if number not in taken)

    def _claim_key(self, new: str, old: str) -> bool:
        """Take the key of an offset in; False where it stands for another one already."""
        return not old or self.keys.setdefault(new, old) == old

    def job(self, job: Job) -> Job:
        """The job with its offsets under the keys of the other machine."""
        if not self.keys:
            return job
        tools = {new: job.tools[old] for new, old in self.keys.items() if old in job.tools}
        return replace(job, tools=tools)
