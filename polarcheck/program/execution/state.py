"""The state of one execution: where it stands, what it has found so far, and the bounds that end it."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import NoReturn, Protocol

import msgspec
import numpy as np

from polarcheck.foundation.time_limit import Limit, current_limit, keep_going, seconds_for
from polarcheck.program.execution.arithmetic import Value
from polarcheck.program.execution.executed_rows import ExecutedRows
from polarcheck.program.execution.expression import Expression, Fault, decide, evaluate
from polarcheck.program.execution.kinds import FaultKind, RemarkKind
from polarcheck.program.execution.listing import Listing
from polarcheck.program.execution.macro import Variables
from polarcheck.program.execution.programs import Program, ProgramName
from polarcheck.program.execution.run import FlowFault, Remark, is_code
from polarcheck.program.machines.job import Running

#: After as many endless programs of a file, each later program may execute only _FEW_STATEMENTS.
_ENDLESS_PROGRAMS = 4
_FEW_STATEMENTS = 1000
#: Statements that a call counts for: itself, the return and the way back.
_STATEMENTS_OF_A_CALL = 3

#: Looks for the file of a program that is not in the listing; returns True if the listing has grown by it.
Resolver = Callable[[ProgramName], bool]


class Stop(Exception):  # noqa: N818 - ends one program, and never leaves execute
    """M30, an alarm that the program raises, or a bound."""


class Restart(Exception):  # noqa: N818 - the listing has grown by a called program
    """The execution starts over with the longer listing."""


class HasPlace(Protocol):
    """Characters of a block, end exclusive: a fault, an expression, a statement."""

    @property
    def start(self) -> int: ...

    @property
    def end(self) -> int: ...


class Level(msgspec.Struct):
    """
    One level of calls.

    program: the program that runs.
    back: the block with which its caller continues.
    repeats: how often it still runs, this time included.
    is_macro: it has local variables.
    assigned: variables that the call has set, and that have no value after the return.
    is_part: it is a part of the program that its caller runs.
    changes: count of changes of variables before it began, where it runs once in place of more repeats than a check
    executes; else None.
    """

    program: Program
    back: int = 0
    repeats: int = 1
    is_macro: bool = False
    assigned: tuple[int, ...] = ()
    is_part: bool = False
    changes: int | None = None


class ModalCall(msgspec.Struct):
    """The modal call that is in force (G66): its program, arguments and repeats."""

    program: Program
    arguments: dict[int, float | None]
    repeats: int


class State:
    """
    The state of one execution of all programs of a file, with one state of block skip.

    listing: the blocks and their statements.
    settings: the bounds, and values of variables.
    resolve: looks for files of called programs.
    skip: block skip is on.
    used_files: indices of the files of which a program was called; shared by the executions of a file.
    unused_files: indices of files that hold a program of a called name, but were not used for that call.
    programs: the program of each call so far, None where there is none.
    rivals: per program, the files that can hold it where there are several; which of them is called is not known.
    called_beside: numbers and names of programs that other channels call, so that they run there.
    rows: the executed rows.
    visited: per block, True where it was executed.
    stopped: a bound has ended a program.
    jumped: the block that is executed has jumped.
    stack: the levels of calls, the main program first.
    modal: the modal call in force.
    variables: their present values; changes: how often one has changed.
    unknown_targets: blocks that assign a variable whose number is unknown.
    """

    def __init__(
        self, listing: Listing, settings: Running, resolve: Resolver, used_files: set[int], *, skip: bool, inch: bool
    ) -> None:
        self.listing, self.settings, self.resolve, self.skip = listing, settings, resolve, skip
        self.used_files = used_files
        self.unused_files: set[int] = set()
        self.programs: dict[ProgramName, Program | None] = {}
        self.rivals: Mapping[ProgramName, Sequence[str]] = {}
        self.called_beside: frozenset[int | str] = frozenset()
        self.rows = ExecutedRows(listing.text, listing.machine, skip=skip, inch_at_first=inch)
        self.visited = np.zeros(len(listing.text.blocks), bool)
        self.stopped = self.jumped = False
        self.stack: list[Level] = []
        self.modal: ModalCall | None = None
        self.variables = Variables(listing.macro)
        self.changes = 0
        self.unknown_targets: set[int] = set()
        self._faults: dict[tuple[FaultKind, int, int], FlowFault] = {}
        self._remarks: dict[tuple[RemarkKind, int], Remark] = {}
        self._count = self._total = 0
        self._limit = settings.max_statements
        self._limit_of_text = _STATEMENTS_OF_A_CALL * len(listing.stops)
        self._changes_at: dict[tuple[int, int], int] = {}
        self._seconds = seconds_for(len(listing.text.source.code), settings.max_seconds)
        self._time = current_limit() or Limit(self._seconds)

    @property
    def depth(self) -> int:
        """The number of calls around the present block."""
        return len(self.stack) - 1

    def start_program(self, program: Program, variables: Variables) -> None:
        """Begin a program of the file with these variables; its statements are counted from 0."""
        limit = self.settings.max_statements
        self._total += self._count
        self._limit_of_text = max(_STATEMENTS_OF_A_CALL * len(self.listing.stops) - self._total, 0)
        # An endless program must not use up what the programs behind it may execute.
        self._count, self._limit = 0, limit if self._total <= _ENDLESS_PROGRAMS * limit else min(_FEW_STATEMENTS, limit)
        self.variables, self.modal, self.stack = variables, None, [Level(program)]
        self.rows.start_program()

    # ---- bounds ----

    def count_statement(self, block: int) -> None:
        """
        Count one executed statement, and end the program at a bound: a check never hangs.

        Beyond the bound a file may execute each of its statements once: none is too long by what is written in it.
        """
        self._count += 1
        settings, listing = self.settings, self.listing
        if len(self.rows) > settings.max_blocks + len(listing.text.blocks):
            self._break_off("too-many-blocks", block, limit=settings.max_blocks)
        elif self._count > self._limit + self._limit_of_text:
            self._break_off("too-many-statements", block, limit=self._limit)
        elif self._count % 256 == 0:
            keep_going()
            if self._time.is_late():
                self._break_off("runs-too-long", block, limit=self._seconds)

    def _break_off(self, kind: FaultKind, block: int, limit: float) -> NoReturn:
        """End a program at a bound. At the control it may go on, so nothing is known of what comes after."""
        self.add_fault(kind, block, self.listing.statement(block), limit=limit)
        self.rows.break_off(block, self.depth)
        self.stopped = True
        raise Stop

    def go_back(self, block: int, target: int | None = None) -> None:
        """
        The flow goes back from a block: if no variable has changed since the last time, it never ends.

        target: of a jump. Where the program stops between both for the operator or the bar feeder, at M0 or M1, such a
        jump begins the next part, as M99 at the end of a main program does.
        """
        key = (block, len(self.stack))
        if target is not None and self.changes == self._changes_at.get(key, 0) and self._stops_between(target, block):
            raise Stop
        if self._changes_at.get(key) == self.changes:
            self.add_fault("nothing-changes", block, self.listing.statement(block))
            self.rows.shorten()
            self.stopped = True
            raise Stop
        self._changes_at[key] = self.changes

    def _stops_between(self, first: int, last: int) -> bool:
        """M0 or M1 stands in one of the blocks from the first to the last, alone in its program."""
        words = self.listing.text.words
        low, high = np.searchsorted(words.block, (first, last + 1))
        stops = ["M0", *self.listing.machine.m_codes.optional_stop]
        return len(self.stack) == 1 and bool(is_code(words[low:high], stops).any())

    # ---- faults and remarks ----

    def add_fault(self, kind: FaultKind, block: int, span: HasPlace, **values: str | int | float) -> None:
        """Record a fault, each kind once at each place."""
        key = (kind, block, span.start)
        if key not in self._faults:
            start = int(self.listing.text.blocks.start[block])
            end = max(span.end, span.start + 1)
            self._faults[key] = FlowFault(kind, block, start + span.start, start + end, values, len(self.rows))

    def add(self, fault: Fault | None, block: int) -> None:
        """Record the fault of reading or calculating, if there is one."""
        if fault is not None:
            values = {} if fault.number is None else {"number": fault.number}
            self.add_fault(fault.kind, block, fault, **values)

    def evaluate(self, expression: Expression, block: int) -> Value:
        """The value of an expression in a block, whose fault is recorded."""
        value, fault = evaluate(expression, self.variables, self.listing.arithmetic)
        self.add(fault, block)
        return value

    def decide(self, condition: Expression, block: int) -> bool | None:
        """Whether a condition in a block holds; None, which is remarked, where that is not known."""
        result, fault = decide(condition, self.variables, self.listing.arithmetic)
        self.add(fault, block)
        if result is None:
            self.add_remark("condition-unknown", block)
        return result

    def add_remark(self, kind: RemarkKind, block: int, **values: str | int | float) -> None:
        """Record, once for each block, why it was not executed as the control would."""
        if (kind, block) not in self._remarks:
            is_alone = kind == "condition-unknown" and not self.depth and self.modal is None
            row = len(self.rows) if is_alone and self.listing.runs_down(block) else -1
            self._remarks[kind, block] = Remark(kind, block, values, row)

    @property
    def faults(self) -> tuple[FlowFault, ...]:
        """In the order in which they were found."""
        return tuple(self._faults.values())

    @property
    def remarks(self) -> tuple[Remark, ...]:
        """In the order in which they were recorded."""
        return tuple(self._remarks.values())
