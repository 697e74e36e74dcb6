"""Calls of programs and returns from them: M98, M99, G65, G66 and their levels."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from polarcheck.execution.arithmetic import Arithmetic
from polarcheck.execution.executed_rows import ExecutedRows
from polarcheck.execution.expression import Fault, evaluate
from polarcheck.execution.macro import Variables, assign_arguments, called_program
from polarcheck.execution.programs import Program, Programs
from polarcheck.execution.statement import Statement
from polarcheck.machines.machine import Macro

#: Looks up the text of a program that is not in the file, by number or name; None where it is not found.
Resolver = Callable[[int | None, str | None], bool]


@dataclass(frozen=True, slots=True)
class Bounds:
    """What a run may take: executed blocks, macro statements, seconds. Reaching one is a finding, never a hang."""

    blocks: int = 200_000
    statements: int = 60_000
    seconds: float = 20.0


@dataclass(slots=True)
class Level:
    """One level of calls: the program that runs, where its caller goes on, and how often it runs again."""

    program: Program
    back: int = 0
    repeats: int = 1
    is_macro: bool = False


@dataclass(slots=True)
class ModalCall:
    """What G66 has in force: the program and its arguments."""

    program: Program
    arguments: dict[int, float | None]
    repeats: int


class Stop(Exception):  # noqa: N818 - ends one run, and never leaves this module
    """M30, an alarm of the program's own, or a bound."""


class Again(Exception):  # noqa: N818 - the text has grown by a called program
    """Start over with the longer text."""


class Calls:
    """What an execution does at calls and returns; the attributes are those of execute.Execution."""

    programs: Programs
    macro: Macro
    bounds: Bounds
    resolve: Resolver
    rows: ExecutedRows
    remarks: list[tuple[str, int]]
    modal: ModalCall | None
    changes: int
    arithmetic: Arithmetic
    variables: Variables
    stack: list[Level]
    bound: Callable[[int], None]
    fault: Callable[[str, int, Any, str], None]
    found: Callable[[Fault | None, int], None]
    unknown_condition: Callable[[int], None]
    goes_back: Callable[[int], None]

    def enter(self, statement: Statement, block: int) -> int:
        code = statement.call
        if code == "G67":
            self.modal = None
            self.rows.add_call(block, statement, len(self.stack) - 1)
            return block + 1
        self.rows.add_call(block, statement, len(self.stack) - 1)
        if code == "M99":
            return self.leave(statement, block)
        called = called_program(
            statement, self.variables, repeats_in_p=self.macro.repeats_in_p, arithmetic=self.arithmetic
        )
        if called.fault is not None:
            self.found(called.fault, block)
            return block + 1
        arguments: dict[int, float | None] | None = None
        if code[0] == "G":
            given = assign_arguments(
                statement, self.variables, second=self.macro.second_arguments, arithmetic=self.arithmetic
            )
            self.found(given.fault, block)
            arguments = given.values
        program = self.find(called.program, called.name)
        if program is None:
            self.missing(statement, block, called.program, called.name)
            return block + 1
        if called.repeats is None:
            self.unknown_condition(block)
        repeats = 1 if called.repeats is None else called.repeats
        if repeats > self.bounds.blocks:
            self.fault("endless-loop", block, statement, f"would run {repeats} times")
            repeats = 1
        if code in ("G66", "G66.1"):
            self.modal = ModalCall(program, arguments or {}, repeats)
            return block + 1
        return self.call(program, block + 1, repeats, arguments, statement, block)

    def modal_call(self) -> ModalCall | None:
        """What runs after each block that moves; the moves of that macro itself do not call it again."""
        modal = self.modal
        inside = modal is None or any(frame.program is modal.program for frame in self.stack)
        return None if inside else modal

    def find(self, number: int | None, name: str | None) -> Program | None:
        if number is None and name is None:
            return None
        found = self.programs.of_number(number) if number is not None else self.programs.of_name(name or "")
        if found is None and self.resolve(number, name):
            raise Again
        return found

    def missing(self, statement: Statement, block: int, number: int | None, name: str | None) -> None:
        if number is None and name is None:
            self.remarks.append(("which program is called depends on a value that is not known", block))
        else:
            wanted = f"O{number:04d}" if number is not None else f"<{name}>"
            text = f"{wanted} is not in this file and in no folder of the job; positions after it are not known"
            self.fault("subprogram-missing", block, statement, text)
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
        macros = sum(frame.is_macro for frame in self.stack)
        limit = self.macro.macro_levels if arguments is not None else self.macro.subprogram_levels
        depth = macros if arguments is not None else len(self.stack) - 1 - macros
        if depth >= limit or len(self.stack) > self.macro.macro_levels + self.macro.subprogram_levels:
            if statement is not None:
                self.fault("nesting-too-deep", block, statement, f"more than {limit} levels of calls")
            return back
        if repeats <= 0:
            return back
        self.stack.append(Level(program, back, repeats, arguments is not None))
        if arguments is not None:
            self.variables.enter(arguments)
            self.changes += 1
        return program.first

    def leave(self, statement: Statement | None, block: int = -1) -> int:
        """M99, or the end of a program: back to the caller, to its N number with M99 P, or once more with L."""
        frame = self.stack[-1]
        self.bound(max(block, frame.program.first))
        if frame.repeats > 1:
            frame.repeats -= 1
            return frame.program.first
        target = self.return_target(statement)
        self.stack.pop()
        if frame.is_macro:
            self.variables.leave()
        if not self.stack:
            if target is not None:
                self.remarks.append(("M99 P in the main program jumps; what follows it is taken as the end", block))
            raise Stop
        if target is None:
            return frame.back
        found = self.programs.jump(self.stack[-1].program, target, self.stack[-1].program.first - 1)
        if found is None:
            assert statement is not None
            self.fault("jump-target-missing", block, statement, f"the calling program has no N{target}")
            return frame.back
        if found < frame.back:
            self.goes_back(block)
        return found

    def return_target(self, statement: Statement | None) -> int | None:
        word = next((word for word in statement.words if word.address == "P"), None) if statement else None
        if word is None:
            return None
        value, _ = evaluate(word.value, self.variables, self.arithmetic)
        return None if value is None or value != value else round(value)
