"""Calls of programs and returns from them: M98, M99, G65, G66 and their levels."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol

from polarcheck.execution.executed_rows import ExecutedRows
from polarcheck.execution.expression import Fault, evaluate
from polarcheck.execution.fault_list import HasPlace
from polarcheck.execution.kinds import FaultKind, RemarkKind
from polarcheck.execution.listing import Listing
from polarcheck.execution.macro import Variables, assign_arguments, called_program
from polarcheck.execution.programs import Program, ProgramName
from polarcheck.execution.statement import Statement
from polarcheck.machines.job import Running

#: Looks for the file of a program that is not in the listing; whether the listing has grown by it.
Resolver = Callable[[ProgramName], bool]


@dataclass(slots=True)
class Level:
    """
    One level of calls: the program that runs, where its caller goes on, and how often it runs again.

    passed: the variables that the call has set, which have no value behind the return.
    is_macro: it has local variables of its own. is_part: it is a part of the program that its caller runs.
    changes: of variables until it began, where it runs once in place of more repeats than a check executes.
    """

    program: Program
    back: int = 0
    repeats: int = 1
    is_macro: bool = False
    passed: tuple[int, ...] = ()
    is_part: bool = False
    changes: int | None = None


@dataclass(slots=True)
class ModalCall:
    """What G66 has in force: the program and its arguments."""

    program: Program
    arguments: dict[int, float | None]
    repeats: int


class Stop(Exception):  # noqa: N818 - ends one run, and never leaves execute.Execution
    """M30, an alarm of the program's own, or a bound."""


class Again(Exception):  # noqa: N818 - the listing has grown by a called program
    """Start over with the longer listing."""


class FaultTaker(Protocol):
    """How a fault is reported; see FaultList.add."""

    def __call__(self, kind: FaultKind, block: int, place: HasPlace, **values: str | int | float) -> None: ...


class RemarkTaker(Protocol):
    """How a remark is made; see run.Remark."""

    def __call__(self, kind: RemarkKind, block: int, **values: str | int | float) -> None: ...


class Calls:
    """What an execution does at calls and returns; the attributes are those of execute.Execution."""

    listing: Listing
    asked: Running
    resolve: Resolver
    rows: ExecutedRows
    used: set[int]
    passed: set[int]
    resolved: dict[ProgramName, Program | None]
    modal: ModalCall | None
    changes: int
    variables: Variables
    stack: list[Level]
    bound: Callable[[int], None]
    fault: FaultTaker
    found: Callable[[Fault | None, int], None]
    remark: RemarkTaker
    goes_back: Callable[[int], None]

    def enter(self, statement: Statement, block: int) -> int:
        """A block with a code that calls, returns, or ends a modal call; gives the block to go on with."""
        macro, code = self.listing.macro, statement.call
        modal_calls = (*macro.modal_macro_calls, *macro.modal_macro_calls_each_block)
        has_arguments = code in (*macro.macro_calls, *modal_calls)
        self.rows.add_call(block, statement, len(self.stack) - 1, has_arguments)
        if code in macro.modal_macro_cancel:
            self.modal = None
            return block + 1
        if code in macro.program_returns:
            return self.leave(statement, block)
        called = called_program(statement, self.variables, macro, self.listing.arithmetic)
        if called.fault is not None:
            self.found(called.fault, block)
            return block + 1
        arguments: dict[int, float | None] | None = None
        if has_arguments:
            given = assign_arguments(statement, self.variables, macro, self.listing.arithmetic)
            self.found(given.fault, block)
            arguments = given.values
        program = self.find(called.program)
        if program is not None and statement.parameters is not None:
            arguments = self.handed_over(statement, program, block)
        if program is None:
            self.missing(statement, block, called.program)
            return block + 1
        if called.repeats is None:
            self.remark("condition-unknown", block)
        repeats = 1 if called.repeats is None else called.repeats
        if repeats > self.asked.max_blocks:
            self.fault("too-many-repeats", block, statement, repeats=repeats, limit=self.asked.max_blocks)
        if code in modal_calls:
            self.modal = ModalCall(program, arguments or {}, repeats)
            return block + 1
        return self.call(program, block + 1, repeats, arguments, statement, block)

    def handed_over(self, statement: Statement, program: Program, block: int) -> dict[int, float | None]:
        """The variables that a program takes from a call by name: what is given, else what it says itself, else 0."""
        procedure, given = self.listing.procedure(program), statement.parameters or ()
        values: dict[int, float | None] = {}
        for place, parameter in enumerate(procedure.parameters or () if procedure else ()):
            expression = (given[place].value if place < len(given) else None) or parameter.value
            value, fault = (0.0, None) if expression is None else evaluate(expression, self.variables)
            self.found(fault, block)
            values[parameter.variable] = value
        return values

    def modal_call(self) -> ModalCall | None:
        """What runs after each block that moves; the moves of that macro itself do not call it again."""
        modal = self.modal
        inside = modal is None or any(level.program is modal.program for level in self.stack)
        return None if inside else modal

    def find(self, called: ProgramName) -> Program | None:
        """The program of a call, its file read where need be; it is the same all through a run."""
        if called == ProgramName(None, None):
            return None
        if called not in self.resolved:
            self.resolved[called] = self._look_up(called)
        program = self.resolved[called]
        if program is not None:
            self.used.add(program.file)
        return program

    def _look_up(self, called: ProgramName) -> Program | None:
        """In the file itself and those used so far, then in the folders; a file that no call used does not count."""
        candidates = self.listing.programs.named(called)
        for program in candidates:
            if program.file in self.used:
                return program
        if called in self.listing.found:
            file = self.listing.found[called]
            return next((program for program in candidates if program.file == file), None)
        if self.resolve(called):
            raise Again
        self.passed.update(program.file for program in candidates)
        return None

    def missing(self, statement: Statement, block: int, called: ProgramName) -> None:
        """A program that is not known or not there: what it would do is not known either."""
        if called == ProgramName(None, None):
            self.remark("program-unknown", block)
        else:
            self.fault("program-not-found", block, statement, program=str(called))
        self.rows.mark_unknown()

    def call(
        self,
        program: Program,
        back: int,
        repeats: int,
        arguments: dict[int, float | None] | None,
        statement: Statement | None = None,
        block: int = -1,
    ) -> int:
        """Go to the head of a program; past the levels of the control on with the block behind the call."""
        macro = self.listing.macro
        macros = sum(level.is_macro for level in self.stack)
        limit = macro.macro_levels if arguments is not None else macro.subprogram_levels
        depth = macros if arguments is not None else len(self.stack) - 1 - macros
        if depth >= limit or len(self.stack) > macro.macro_levels + macro.subprogram_levels:
            if statement is not None:
                self.fault("call-levels", block, statement, levels=limit)
            return back
        if repeats <= 0:
            return back
        passed = statement.passed if statement is not None else ()
        level = Level(program, back, repeats, arguments is not None, passed)
        self.stack.append(level)
        if arguments is not None:
            self.variables.enter(arguments)
            self.changes += 1
        if repeats > self.asked.max_blocks:
            level.repeats, level.changes = 1, self.changes
        return program.first

    def leave(self, statement: Statement | None, block: int = -1) -> int:
        """M99, or the end of a program: back to the caller, to its N number with M99 P, or once more with L."""
        level = self.stack[-1]
        self.bound(max(block, level.program.first))
        if level.repeats > 1:
            level.repeats -= 1
            return level.program.first
        target = self.return_target(statement)
        self.stack.pop()
        if level.is_macro:
            self.variables.leave()
        for number in level.passed:
            self.variables.write(number, None)
        if level.changes is not None:
            self.rows.add_unknown(level.back - 1, max(len(self.stack) - 1, 0))
            if level.changes != self.changes:
                self.variables.forget()
        if not self.stack:
            if target is not None:
                self.remark("return-jumps", block, code=statement.call if statement else "")
            raise Stop
        if target is None:
            return level.back
        caller = self.stack[-1].program
        found = self.listing.programs.jump(caller, target, caller.first - 1)
        if found is None:
            assert statement is not None
            self.fault("return-target-not-found", block, statement, number=target)
            return level.back
        if found < level.back:
            self.goes_back(block)
        return found

    def return_target(self, statement: Statement | None) -> int | None:
        """The N number in P of an M99; None where it has none, or none that is known."""
        word = next((word for word in statement.words if word.address == "P"), None) if statement else None
        if word is None:
            return None
        value, _ = evaluate(word.value, self.variables, self.listing.arithmetic)
        return None if value is None or value != value else round(value)
