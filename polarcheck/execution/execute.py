"""Executing programs that jump, loop, compute or call: block by block where the flow can turn, in ranges between."""

from __future__ import annotations

import bisect
import time
from collections.abc import Iterable
from collections.abc import Set as AbstractSet

import numpy as np

from polarcheck.execution.arithmetic import UNKNOWN
from polarcheck.execution.branches import Branches
from polarcheck.execution.calls import Again, Level, ModalCall, Resolver, Stop
from polarcheck.execution.executed_rows import ExecutedRows
from polarcheck.execution.expression import Fault, decide, evaluate
from polarcheck.execution.fault_list import FaultList, HasPlace
from polarcheck.execution.kinds import FaultKind, RemarkKind
from polarcheck.execution.library import Shelf
from polarcheck.execution.listing import Listing
from polarcheck.execution.macro import Variables, assign, step_of, word_value
from polarcheck.execution.programs import Program, ProgramName, Search
from polarcheck.execution.run import NO_VARIABLE, Assigned, Remark
from polarcheck.execution.statement import Kind, Statement, Word
from polarcheck.machines.codes import code_numbers, code_set
from polarcheck.machines.job import Running
from polarcheck.machines.macro_keys import Macro
from polarcheck.time_limit import current_limit, keep_going, seconds_for

#: So many endless programs of a file get all the statements that are asked for, those behind them so many each.
_ENDLESS = 4
_LEAST = 1000
#: A statement that calls counts, and so do the return and the way back.
_OF_CALL = 3


class Execution(Branches):
    """
    One execution of all programs of a file, with one state of block skip.

    used: the files of which a program was called. called_beside: the numbers and names of programs that other channels
    call, so that they run there. rows, faults, remarks: what came out of it. visited: per block,
    whether it was run. stopped: it was broken off at a bound. jumped: the block that runs has gone elsewhere.
    """

    def __init__(
        self, listing: Listing, asked: Running, resolve: Resolver, used: set[int], *, skip: bool, inch: bool
    ) -> None:
        self.listing, self.asked, self.resolve, self.skip = listing, asked, resolve, skip
        self.used = used
        self.called_beside: frozenset[int | str] = frozenset()
        self.passed: set[int] = set()
        self.resolved: dict[ProgramName, Program | None] = {}
        self.rows = ExecutedRows(listing.text, listing.machine, skip=skip, inch_at_first=inch)
        self.faults = FaultList(listing.text)
        self._remarks: dict[tuple[RemarkKind, int], Remark] = {}
        self.visited = np.zeros(len(listing.text.blocks), bool)
        self.stopped = self.jumped = False
        self.modal: ModalCall | None = None
        self.variables = Variables(listing.macro)
        self._of_offsets = (*listing.macro.tool_offset_variables, *listing.macro.work_offset_variables)
        self.stack: list[Level] = []
        self.changes = 0
        self.assigns_anywhere: set[int] = set()
        self._count = self._total = 0
        self._allowed, self._own = asked.max_statements, _OF_CALL * len(listing.stops)
        self._last_change: dict[tuple[int, int], int] = {}
        self._seconds = seconds_for(len(listing.text.source.code), asked.max_seconds)
        limit = current_limit()
        self._end = time.monotonic() + self._seconds if limit is None else limit.end

    # ---- the programs of the file ----

    def run(self) -> None:
        """
        Run the programs of the file itself that no call names; if all are named, the first.

        Programs that are called run in their callers; those that end with M99 with arguments unknown. Where nothing has
        called it, a program that is named by <NAME>, with computed words, or by a file that is not used comes last.
        """
        listing, every = self.listing, range(len(self.listing.files))
        own = [program for program in listing.programs.programs if not program.file]
        named = listing.named_by(every, by_number_only=False)
        called = self._called()
        ran = False
        for program in sorted(own, key=lambda program: not named.isdisjoint(program.keys)):
            if not self._was_run(program) and called.isdisjoint(program.keys):
                known = len(self.used)
                self._run_program(program)
                ran = True
                if len(self.used) > known:
                    called = self._called()
        if not ran:
            self._run_program(own[0])
        if self.passed & self.used:
            raise Again

    def _called(self) -> AbstractSet[int | str]:
        """The numbers and names of the programs that run in their callers."""
        return self.called_beside | self.listing.named_by(self.used, by_number_only=True)

    def _was_run(self, program: Program) -> bool:
        return bool(self.visited[program.first : program.end].any())

    def _run_program(self, program: Program) -> None:
        listing = self.listing
        self.variables = Variables(listing.macro, {**listing.macro.given, **self.asked.variables})
        if self._returns(program):
            self.variables.forget()
        self.modal = None
        # An endless program must not be the fault of those behind it; of many, the later ones get less.
        most = self.asked.max_statements
        self._total += self._count
        self._own = max(_OF_CALL * len(listing.stops) - self._total, 0)
        self._count, self._allowed = 0, most if self._total <= _ENDLESS * most else min(_LEAST, most)
        self.stack = [Level(program)]
        self.rows.start_program()
        block = program.first
        try:
            while self.stack:
                block = self.step(block)
        except Stop:
            self.stack = []

    def _returns(self, program: Program) -> bool:
        """Whether a program ends with M99: it is a subprogram, and its caller's values are not known."""
        words = self.listing.text.words
        inside = (words.block >= program.first) & (words.block < program.end) & (words.address == ord("M"))
        codes = code_numbers(words.value[inside])
        returns, ends = code_set(self.listing.macro.program_returns), code_set(self.listing.ends)
        if not program.has_head or np.any(ends[codes]):
            return False
        statements = self.listing.macro_statements(program)
        return bool(np.any(returns[codes])) or any(_returns(one, self.listing.macro) for _, one in statements)

    def step(self, block: int) -> int:
        """Run up to the next block at which the flow can turn, and that block; give the block to go on with."""
        program, stops = self.stack[-1].program, self.listing.stops
        at = bisect.bisect_left(stops, block)
        stop = min(stops[at] if at < len(stops) else program.end, program.end)
        if stop > block:
            modal = self.modal_call()
            if modal is not None:
                moving = self.rows.first_moving(block, stop)
                if moving is not None:
                    self.plain(block, moving + 1)
                    return self.call(modal.program, moving + 1, modal.repeats, modal.arguments)
            self.plain(block, stop)
        if stop >= program.end:
            return self.leave(None)
        self.visited[stop] = True
        self.bound(stop)
        return self.turn(stop)

    def plain(self, first: int, end: int) -> None:
        self.visited[first:end] = True
        self.rows.add_plain(first, end, len(self.stack) - 1)

    # ---- bounds, faults, remarks ----

    def bound(self, block: int) -> None:
        """
        Break off at a bound: a check never hangs.

        Beyond the bound a file may run what it has itself, once: none is too long by what is written in it.
        """
        self._count += 1
        asked, listing = self.asked, self.listing
        if len(self.rows) > asked.max_blocks + len(listing.text.blocks):
            self.break_off("too-many-blocks", block, limit=asked.max_blocks)
        elif self._count > self._allowed + self._own:
            self.break_off("too-many-statements", block, limit=self._allowed)
        elif self._count % 256 == 0:
            keep_going()
            if time.monotonic() > self._end:
                self.break_off("runs-too-long", block, limit=self._seconds)

    def break_off(self, kind: FaultKind, block: int, limit: float) -> None:
        """End a program at a bound; it may go on, so that nothing is known of what comes after."""
        self.fault(kind, block, self.listing.statement(block), limit=limit)
        self.rows.break_off(block, len(self.stack) - 1)
        self.stopped = True
        raise Stop

    def fault(self, kind: FaultKind, block: int, place: HasPlace, **values: str | int | float) -> None:
        self.faults.add(kind, block, place, len(self.rows), **values)

    def found(self, fault: Fault | None, block: int) -> None:
        """Keep what a calculation found wrong."""
        self.faults.add_found(fault, block, len(self.rows))

    def remark(self, kind: RemarkKind, block: int, **values: str | int | float) -> None:
        """Say once for each block why it was not run as the control would."""
        self._remarks.setdefault((kind, block), Remark(kind, block, values))

    @property
    def remarks(self) -> tuple[Remark, ...]:
        """In the order in which they were made."""
        return tuple(self._remarks.values())

    # ---- the block at which the flow can turn ----

    def turn(self, block: int) -> int:
        statement = self.listing.statement(block)
        if statement.fault is not None and self.listing.text.blocks.is_macro[block]:
            self.found(statement.fault, block)
        if self.skip and any(skip.start < statement.start for skip in statement.skips):
            return block + 1
        for unread in statement.unread:
            self.remark("not-simulated", block, name=unread.name, matters=unread.matters)
        self.jumped = False
        for part in (statement, *statement.more):
            goes_on = self.execute(part, block)
            if self.jumped or goes_on != block + 1:
                return goes_on
        loses_words = (
            statement.kind is Kind.NC and statement.fault is not None and self.listing.text.blocks.is_macro[block]
        )
        if loses_words or any(unread.moves for unread in statement.unread):
            self.rows.mark_unknown()
        return block + 1

    def execute(self, statement: Statement, block: int) -> int:
        match statement.kind:
            case Kind.ASSIGN:
                self.assign(statement, block)
            case Kind.IF_GOTO:
                if self.decided(statement.condition, block):
                    return self.go_to(statement, block)
            case Kind.IF_THEN:
                if statement.then is not None and self.decided(statement.condition, block):
                    return self.execute(statement.then, block)
            case Kind.GOTO:
                return self.go_to(statement, block)
            case Kind.WHILE_DO | Kind.DO | Kind.END:
                return self.loop(statement, block)
            case Kind.CALL:
                return self.enter(statement, block)
            case Kind.STRUCTURE:
                return self.structure(statement, block)
            case Kind.REPEAT:
                return self.run_again(statement, block)
            case Kind.NC:
                return self.nc(statement, block)
            case _:
                pass
        return block + 1

    def assign(self, statement: Statement, block: int) -> None:
        macro, arithmetic = self.listing.macro, self.listing.arithmetic
        number, step = None, UNKNOWN
        if statement.target is not None:
            number, _ = evaluate(statement.target, self.variables, arithmetic)
        before = self.variables.value(number) if number is not None and self.variables.exists(number) else None
        is_of_offset = number is not None and _is_within(number, self._of_offsets)
        if is_of_offset:
            step = step_of(statement, number or 0.0, self.variables, arithmetic)
        self.found(assign(statement, self.variables, arithmetic), block)
        after = self.variables.value(number) if number is not None and self.variables.exists(number) else None
        self.changes += before != after or number is None or number != number
        if is_of_offset:
            value = step if step == step else UNKNOWN if after is None else after
            self.rows.add_assigned(block, Assigned(round(number or 0), value, step == step), len(self.stack) - 1)
        elif number is not None and number != number and block not in self.assigns_anywhere:
            self.assigns_anywhere.add(block)
            self.rows.add_assigned(block, Assigned(NO_VARIABLE, UNKNOWN), len(self.stack) - 1)
        if number in macro.alarm_variables or number in macro.stop_variables:
            self.remark("stops-itself", block, number=int(number or 0))
            if number in macro.alarm_variables:
                raise Stop

    def go_to(self, statement: Statement, block: int) -> int:
        if statement.label:
            return self.go_to_label(statement, block)
        if statement.jump is None:
            return block + 1
        number, fault = evaluate(statement.jump, self.variables, self.listing.arithmetic)
        self.found(fault, block)
        if number is None or number != number:
            if fault is None and number is None:
                self.fault("sequence-number-vacant", block, statement.jump)
            else:
                self.remark("condition-unknown", block)
            return block + 1
        target = self.listing.programs.jump(self.stack[-1].program, round(number), block, statement.search)
        if target is None:
            if statement.search is not Search.IF_THERE:
                self.fault("sequence-number-not-found", block, statement.jump, number=round(number))
            return block + 1
        return self.gone_to(target, block)

    def gone_to(self, target: int, block: int) -> int:
        """The target of a jump, once what the jump means has been seen to."""
        if target <= block:
            self.goes_back(block)
        self.leave_parts(target)
        self.jumped = True
        return target

    def go_to_label(self, statement: Statement, block: int) -> int:
        program, search = self.stack[-1].program, statement.search
        target = self.listing.programs.labelled(program, statement.label, block, search)
        if target is None:
            if search is not Search.IF_THERE:
                where = {Search.FORWARD: "behind", Search.BACKWARD: "before"}.get(search, "beside")
                self.fault("label-not-found", block, statement, label=statement.label, where=where)
            return block + 1
        return self.gone_to(target, block)

    def goes_back(self, block: int) -> None:
        """Back again without any variable changed since the last time here: it will never end."""
        key = (block, len(self.stack))
        if self._last_change.get(key) == self.changes:
            self.fault("nothing-changes", block, self.listing.statement(block))
            self.rows.shorten()
            self.stopped = True
            raise Stop
        self._last_change[key] = self.changes

    def loop(self, statement: Statement, block: int) -> int:
        loops = self.listing.loops(self.stack[-1].program)
        if statement.kind is Kind.END:
            head = loops.head.get(block)
            if head is None:
                return block + 1
            if self.listing.statement(head).kind is Kind.DO or not self.once(head):
                self.goes_back(block)
                return head
            return block + 1
        end = loops.end.get(block)
        if statement.kind is Kind.DO or end is None:
            return block + 1
        if statement.condition is None:
            return end + 1
        result, fault = decide(statement.condition, self.variables, self.listing.arithmetic)
        self.found(fault, block)
        if result is None:
            self.remark("condition-unknown", block)
            return block + 1  # run once; the END goes on
        return block + 1 if result else end + 1

    def once(self, head: int) -> bool:
        """Whether a loop runs only once since its condition is not known."""
        condition = self.listing.statement(head).condition
        return condition is None or decide(condition, self.variables, self.listing.arithmetic)[0] is None

    def nc(self, statement: Statement, block: int) -> int:
        """A block of NC words, some of which are computed."""
        if not self.listing.text.blocks.is_macro[block]:
            self.rows.add_plain(block, block + 1, len(self.stack) - 1)
            if self.rows.ends(block):
                raise Stop
            return block + 1
        words = self.computed_words(statement, block)
        if self.rows.add_computed(block, words, len(self.stack) - 1):
            raise Stop
        modal = self.modal_call()
        if modal is not None and self.rows.moves(words):
            return self.call(modal.program, block + 1, modal.repeats, modal.arguments)
        return block + 1

    def computed_words(self, statement: Statement, block: int) -> list[tuple[Word, float]]:
        """The words of a block with their values, without those that block skip or a vacant variable drops."""
        control, macro = self.listing.machine.control, self.listing.macro
        least = control.least_increment_inch if self.rows.inch else control.least_increment
        cut = None
        if self.skip:
            cut = next((skip.start for skip in statement.skips if skip.start > statement.start), None)
        words = []
        for word in statement.words:
            if cut is not None and word.start > cut:
                break
            increment = macro.computed_increments.get(word.address, least)
            value, fault = word_value(word, self.variables, increment, self.listing.arithmetic)
            self.found(fault, block)
            if value is None:
                self.fault("word-vacant", block, word)
                continue
            words.append((word, value))
        return words


def _returns(statement: Statement, macro: Macro) -> bool:
    return any(part.call in macro.program_returns for part in (statement, *statement.more))


def _is_within(number: float, ranges: Iterable[tuple[int, int]]) -> bool:
    """Whether a variable, whose number is rounded to a whole one, stands in one of some ranges."""
    return any(first - 0.5 <= number < last + 0.5 for first, last in ranges)


def execute(shelf: Shelf, asked: Running, *, skip: bool, inch: bool) -> Execution:
    """
    Execute all programs of a file as the control would; once more where a computed number names a file not yet read.

    asked: the bounds, and the values of variables. skip: block skip is on. inch: lengths are in inch where the program
    does not say.
    """
    used = {0}
    while True:
        execution = Execution(shelf.listing, asked, shelf.add, used, skip=skip, inch=inch)
        execution.called_beside = shelf.beside.called
        try:
            execution.run()
        except Again:
            continue
        return execution
