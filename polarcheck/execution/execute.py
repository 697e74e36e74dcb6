"""Executing programs that jump, loop, compute or call: block by block where the flow can turn, in ranges between."""

from __future__ import annotations

import bisect
import time
from dataclasses import dataclass, field

import numpy as np

from polarcheck.arrays import Mask
from polarcheck.checking.fault_texts import fault_text
from polarcheck.execution.arithmetic import Arithmetic
from polarcheck.execution.calls import Again, Bounds, Calls, Level, ModalCall, Resolver, Stop
from polarcheck.execution.executed_rows import ExecutedRows
from polarcheck.execution.expression import Expression, Fault, decide, evaluate
from polarcheck.execution.loops import Loops, find_loops
from polarcheck.execution.macro import Variables, assign, word_value
from polarcheck.execution.programs import Program, Programs, block_text, turns
from polarcheck.execution.run import FlowFault, Run
from polarcheck.execution.statement import Kind, Statement, read_statement
from polarcheck.machines.machine import Macro
from polarcheck.reading.words import Text


@dataclass
class Execution(Calls):
    text: Text
    programs: Programs
    macro: Macro
    ends: tuple[str, ...]
    skip: bool
    bounds: Bounds
    resolve: Resolver
    rows: ExecutedRows
    faults: list[FlowFault] = field(default_factory=list)
    remarks: list[tuple[str, int]] = field(default_factory=list)
    visited: Mask = field(default_factory=lambda: np.zeros(0, bool))
    statements: dict[int, Statement] = field(default_factory=dict)
    loops: dict[int, Loops] = field(default_factory=dict)
    modal: ModalCall | None = None
    stopped: bool = False
    count: int = 0
    changes: int = 0
    last_change: dict[tuple[int, int], int] = field(default_factory=dict)
    began: float = field(default_factory=time.monotonic)
    said: set[tuple[str, int, int]] = field(default_factory=set)

    def __post_init__(self) -> None:
        self.stops: list[int] = np.flatnonzero(turns(self.text, self.ends)).tolist()
        self.visited = np.zeros(len(self.text.blocks), bool)
        self.arithmetic = Arithmetic(self.macro.signed_angles, self.macro.largest_number)
        self.variables = Variables()
        self.stack: list[Level] = []

    # ---- one program and all that it calls ----

    def run(self, program: Program, arguments_unknown: bool) -> None:
        self.variables = Variables(given=self.macro.given)
        if arguments_unknown:
            self.variables.forget()
        self.modal = None
        self.stack = [Level(program)]
        self.rows.start_program()
        block = program.first
        try:
            while self.stack:
                block = self.step(block)
        except Stop:
            self.stack = []

    def step(self, block: int) -> int:
        """Run up to the next block at which the flow can turn, and that block; give the block to go on with."""
        frame = self.stack[-1]
        at = bisect.bisect_left(self.stops, block)
        stop = min(self.stops[at] if at < len(self.stops) else frame.program.end, frame.program.end)
        if stop > block:
            modal = self.modal_call()
            if modal is not None:
                moving = self.rows.first_moving(block, stop)
                if moving is not None:
                    self.plain(block, moving + 1)
                    return self.call(modal.program, moving + 1, modal.repeats, modal.arguments)
            self.plain(block, stop)
        if stop >= frame.program.end:
            return self.leave(None)
        self.visited[stop] = True
        self.bound(stop)
        return self.turn(stop)

    def plain(self, first: int, end: int) -> None:
        self.visited[first:end] = True
        self.rows.add_plain(first, end, len(self.stack) - 1)

    def bound(self, block: int) -> None:
        self.count += 1
        reached = ""
        if len(self.rows) > self.bounds.blocks:
            reached = f"{self.bounds.blocks} executed blocks"
        elif self.count > self.bounds.statements:
            reached = f"{self.bounds.statements} macro statements and calls"
        elif self.count % 256 == 0 and time.monotonic() - self.began > self.bounds.seconds:
            reached = f"{self.bounds.seconds:g} seconds"
        if reached:
            self.endless(block, f"still running after {reached}; the rest is not executed")

    def endless(self, block: int, text: str) -> None:
        self.fault("endless-loop", block, self.statement(block), text)
        self.rows.shorten()
        self.stopped = True
        raise Stop

    def fault(self, rule: str, block: int, place: Statement | Fault | Expression, text: str) -> None:
        key = (rule, block, place.start)
        if key in self.said:
            return
        self.said.add(key)
        start = int(self.text.blocks.start[block])
        end = max(place.end, place.start + 1)
        self.faults.append(FlowFault(rule, block, start + place.start, start + end, text, len(self.rows)))

    def found(self, fault: Fault | None, block: int) -> None:
        """Keep what a calculation found wrong."""
        if fault is not None:
            source = block_text(self.text, block)[fault.start : fault.end]
            self.fault(fault.rule, block, fault, fault_text(fault.kind, source))

    def statement(self, block: int) -> Statement:
        if block not in self.statements:
            macro = self.macro
            self.statements[block] = read_statement(
                block_text(self.text, block), loops=macro.loop_numbers, levels=macro.bracket_levels, size=5_000
            )
        return self.statements[block]

    def macro_statements(self, program: Program) -> list[tuple[int, Statement]]:
        """The macro statements of a program with their blocks, in order."""
        stops = self.stops[bisect.bisect_left(self.stops, program.first) : bisect.bisect_left(self.stops, program.end)]
        return [(block, self.statement(block)) for block in stops if self.text.blocks.is_macro[block]]

    def ends_flow(self, block: int) -> bool:
        """Whether nothing comes to the next block by itself: GOTO, M30, M99."""
        if not self.text.blocks.is_macro[block] and block not in self.stops:
            return False
        statement = self.statement(block)
        return statement.kind is Kind.GOTO or statement.call == "M99" or self.rows.ends(block)

    # ---- the block at which the flow can turn ----

    def turn(self, block: int) -> int:
        statement = self.statement(block)
        if statement.fault is not None and self.text.blocks.is_macro[block]:
            self.found(statement.fault, block)
        if self.skip and any(skip.start < statement.start for skip in statement.skips):
            return block + 1
        return self.execute(statement, block)

    def execute(self, statement: Statement, block: int) -> int:
        match statement.kind:
            case Kind.ASSIGN:
                self.assign(statement, block)
            case Kind.IF_GOTO:
                if self.holds(statement, block):
                    return self.go_to(statement, block)
            case Kind.IF_THEN:
                if statement.then is not None and self.holds(statement, block):
                    return self.execute(statement.then, block)
            case Kind.GOTO:
                return self.go_to(statement, block)
            case Kind.WHILE_DO | Kind.DO | Kind.END:
                return self.loop(statement, block)
            case Kind.CALL:
                return self.enter(statement, block)
            case Kind.NC:
                return self.nc(statement, block)
            case _:
                pass
        return block + 1

    def assign(self, statement: Statement, block: int) -> None:
        number = None
        if statement.target is not None:
            number, _ = evaluate(statement.target, self.variables, self.arithmetic)
        before = self.variables.read(number) if number is not None and self.variables.exists(number) else None
        self.found(assign(statement, self.variables, self.arithmetic), block)
        after = self.variables.read(number) if number is not None and self.variables.exists(number) else None
        self.changes += before != after or number is None or number != number
        if number in (3000, 3006):
            self.remarks.append((f"the program stops itself with #{int(number)}", block))
            if number == 3000:
                raise Stop

    def holds(self, statement: Statement, block: int) -> bool:
        """Whether the condition holds; an unknown one counts as not, and is said."""
        if statement.condition is None:
            return False
        result, fault = decide(statement.condition, self.variables, self.arithmetic)
        self.found(fault, block)
        if result is None:
            self.unknown_condition(block)
            return False
        return result

    def unknown_condition(self, block: int) -> None:
        remark = ("the condition depends on a value that is not known, and is taken as not fulfilled", block)
        if remark not in self.remarks:
            self.remarks.append(remark)

    def go_to(self, statement: Statement, block: int) -> int:
        if statement.jump is None:
            return block + 1
        number, fault = evaluate(statement.jump, self.variables, self.arithmetic)
        self.found(fault, block)
        if number is None or number != number:
            if fault is None and number is None:
                self.fault("jump-target-missing", block, statement.jump, "GOTO with a vacant variable")
            else:
                self.unknown_condition(block)
            return block + 1
        target = self.programs.jump(self.stack[-1].program, round(number), block)
        if target is None:
            self.fault("jump-target-missing", block, statement.jump, f"there is no N{round(number)} in this program")
            return block + 1
        if target <= block:
            self.goes_back(block)
        return target

    def goes_back(self, block: int) -> None:
        """Back again without any variable changed since the last time here: it will never end."""
        key = (block, len(self.stack))
        if self.last_change.get(key) == self.changes:
            self.endless(block, "nothing changes from round to round: it never ends")
        self.last_change[key] = self.changes

    def loop(self, statement: Statement, block: int) -> int:
        program = self.stack[-1].program
        if program.first not in self.loops:
            self.loops[program.first] = find_loops(self.macro_statements(program))
        loops = self.loops[program.first]
        if statement.kind is Kind.END:
            head = loops.head.get(block)
            if head is None:
                return block + 1
            if self.statement(head).kind is Kind.DO or not self.once(head):
                self.goes_back(block)
                return head
            return block + 1
        end = loops.end.get(block)
        if statement.kind is Kind.DO or end is None:
            return block + 1
        if statement.condition is None:
            return end + 1
        result, fault = decide(statement.condition, self.variables, self.arithmetic)
        self.found(fault, block)
        if result is None:
            self.unknown_condition(block)
            return block + 1  # run once; the END goes on
        return block + 1 if result else end + 1

    def once(self, head: int) -> bool:
        """Whether a loop runs only once since its condition is not known."""
        condition = self.statement(head).condition
        return condition is None or decide(condition, self.variables, self.arithmetic)[0] is None

    def nc(self, statement: Statement, block: int) -> int:
        """A block of NC words, some of which are computed."""
        if not self.text.blocks.is_macro[block]:
            self.rows.add_plain(block, block + 1, len(self.stack) - 1)
            if self.rows.ends(block):
                raise Stop
            return block + 1
        words = []
        cut = (
            next((skip.start for skip in statement.skips if skip.start > statement.start), None) if self.skip else None
        )
        for word in statement.words:
            if cut is not None and word.start > cut:
                break
            increment = {"G": 0.1, "M": 1.0, "S": 1.0, "T": 1.0}.get(word.address, self.macro.increment)
            value, fault = word_value(word, self.variables, increment, self.arithmetic)
            self.found(fault, block)
            if value is None:
                text = f"{block_text(self.text, block)[word.start : word.end].strip()} is vacant: the control drops it"
                self.fault("vacant-variable", block, Fault("word-format", word.start, word.end), text)
                continue
            words.append((word, value))
        if self.rows.add_computed(block, words, len(self.stack) - 1):
            raise Stop
        modal = self.modal_call()
        if modal is not None and any(word.address in "XYZUVWCH" for word, _ in words):
            return self.call(modal.program, block + 1, modal.repeats, modal.arguments)
        return block + 1


def execute(
    text: Text,
    programs: Programs,
    macro: Macro,
    ends: tuple[str, ...],
    *,
    skip: bool = False,
    bounds: Bounds = Bounds(),  # noqa: B008 - frozen
    resolve: Resolver = lambda number, name: False,
) -> Run | None:
    """
    The rows of all programs of a file as the control would run them; None if `resolve` has found another program.

    Programs that are called run in their callers; the others run by themselves, those that end with M99 with arguments
    unknown. skip: block skip is on.
    """
    execution = Execution(text, programs, macro, ends, skip, bounds, resolve, ExecutedRows(text, ends, skip))
    called = _called(text)
    own = [program for program in programs.programs if program.number not in called]
    try:
        for program in own or programs.programs[:1]:
            if not execution.visited[program.first : program.end].any():
                execution.run(program, _returns(text, program))
    except Again:
        return None
    from polarcheck.execution.static_faults import static_faults

    static_faults(execution)
    return execution.rows.run(tuple(execution.faults), tuple(execution.remarks), execution.visited)


def _called(text: Text) -> set[int]:
    """Program numbers that stand as P in a block with a call."""
    words = text.words
    at_turn = turns(text, ())[words.block]
    values = words.value[(words.address == ord("P")) & at_turn]
    numbers = values[~np.isnan(values)].astype(np.int64)
    return set(numbers.tolist()) | set((numbers % 10_000)[numbers > 9_999].tolist())


def _returns(text: Text, program: Program) -> bool:
    """Whether a program ends with M99: it is a subprogram, and its caller's values are not known."""
    words = text.words
    inside = (words.block >= program.first) & (words.block < program.end) & (words.address == ord("M"))
    return program.has_head and bool(np.any(words.value[inside] == 99)) and not bool(np.any(words.value[inside] == 30))
