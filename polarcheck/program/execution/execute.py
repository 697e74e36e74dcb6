"""Executing programs that jump, loop, compute or call: block by block where the flow can turn, in ranges between."""

from __future__ import annotations

import bisect
from collections.abc import Iterable
from collections.abc import Set as AbstractSet

import numpy as np

from polarcheck.program.execution.arithmetic import UNKNOWN, FromVacant, Unknown
from polarcheck.program.execution.branches import execute_structure, is_true, is_unknown, leave_parts, repeat_part
from polarcheck.program.execution.called_programs import Shelf
from polarcheck.program.execution.calls import enter_program, execute_call, leave_program, modal_call
from polarcheck.program.execution.expression import evaluate
from polarcheck.program.execution.listing import Listing
from polarcheck.program.execution.macro import Variables, assign, step_of, word_value
from polarcheck.program.execution.programs import Program, Search
from polarcheck.program.execution.run import NO_VARIABLE, Assigned
from polarcheck.program.execution.state import Restart, State, Stop
from polarcheck.program.execution.statement import Kind, Statement, Word
from polarcheck.program.machines.code_tables import code_numbers, code_set
from polarcheck.program.machines.job import Running
from polarcheck.program.machines.macro_keys import Macro


def execute(shelf: Shelf, settings: Running, *, skip: bool, inch: bool) -> State:
    """
    Execute all programs of a file as the control would; once more if a computed number names a file not yet read.

    settings: the bounds, and the values of variables. skip: block skip is on. inch: lengths are in inch where the
    program does not say.
    """
    used = {0}
    while True:
        state = State(shelf.listing, settings, shelf.add, used, skip=skip, inch=inch)
        state.called_beside = shelf.beside.called
        state.rivals = shelf.rivals
        try:
            _run_all(state)
        except Restart:
            continue
        return state


# ---- the programs of the file ----


def _run_all(state: State) -> None:
    """
    Execute the programs of the file itself that no call names; if all are named, the first one.

    Called programs run in their callers; a program that ends with M99 runs with unknown arguments. A program that was
    not called comes last if it is named by <NAME>, with computed words, or by a file that is not used.
    """
    listing, every = state.listing, range(len(state.listing.files))
    programs = [program for program in listing.programs.programs if not program.file]
    named = listing.named_by(every, by_number_only=False)
    called = _called(state)
    ran = False
    for program in sorted(programs, key=lambda program: not named.isdisjoint(program.keys)):
        if not state.visited[program.first : program.end].any() and called.isdisjoint(program.keys):
            used = len(state.used_files)
            _run_program(state, program)
            ran = True
            if len(state.used_files) > used:
                called = _called(state)
    if not ran:
        _run_program(state, programs[0])
    if state.unused_files & state.used_files:
        raise Restart


def _called(state: State) -> AbstractSet[int | str]:
    """Numbers and names of the programs that run in their callers."""
    return state.called_beside | state.listing.named_by(state.used_files, by_number_only=True)


def _run_program(state: State, program: Program) -> None:
    macro = state.listing.macro
    variables = Variables(macro, {**macro.given, **state.settings.variables})
    if _is_subprogram(state.listing, program):
        variables.forget()
    state.start_program(program, variables)
    block = program.first
    try:
        while state.stack:
            block = _step(state, block)
    except Stop:
        state.stack = []


def _is_subprogram(listing: Listing, program: Program) -> bool:
    """True for a program that ends with M99: the values of its caller are unknown."""
    words = listing.text.words
    inside = (words.block >= program.first) & (words.block < program.end) & (words.address == ord("M"))
    codes = code_numbers(words.value[inside])
    returns, ends = code_set(listing.macro.program_returns), code_set(listing.ends)
    if not program.has_head or np.any(ends[codes]):
        return False
    statements = listing.macro_statements(program)
    return bool(np.any(returns[codes])) or any(_returns(statement, listing.macro) for _, statement in statements)


def _step(state: State, block: int) -> int:
    """Execute up to the next block at which the flow can turn, and that block; return the next block."""
    program, stops = state.stack[-1].program, state.listing.stops
    index = bisect.bisect_left(stops, block)
    stop = min(stops[index] if index < len(stops) else program.end, program.end)
    if stop > block:
        modal = modal_call(state)
        if modal is not None:
            moving = state.rows.first_moving(block, stop)
            if moving is not None:
                _add_plain(state, block, moving + 1)
                return enter_program(state, modal.program, moving + 1, modal.repeats, modal.arguments)
        _add_plain(state, block, stop)
    if stop >= program.end:
        return leave_program(state, None)
    state.visited[stop] = True
    state.count_statement(stop)
    return _execute_block(state, stop)


def _add_plain(state: State, first: int, end: int) -> None:
    state.visited[first:end] = True
    state.rows.add_plain(first, end, state.depth)


# ---- the block at which the flow can turn ----


def _execute_block(state: State, block: int) -> int:
    statement = state.listing.statement(block)
    if statement.fault is not None and state.listing.text.blocks.is_macro[block]:
        state.add(statement.fault, block)
    if state.skip and any(skip.start < statement.start for skip in statement.skips):
        return block + 1
    for unread in statement.unread:
        state.add_remark("not-simulated", block, name=unread.name, matters=unread.matters, is_cycle=unread.is_cycle)
    state.jumped = False
    for part in (statement, *statement.more):
        next_block = _execute(state, part, block)
        if state.jumped or next_block != block + 1:
            return next_block
    loses_words = (
        statement.kind is Kind.NC and statement.fault is not None and state.listing.text.blocks.is_macro[block]
    )
    if loses_words or any(unread.moves for unread in statement.unread):
        state.rows.mark_unknown()
    return block + 1


def _execute(state: State, statement: Statement, block: int) -> int:
    match statement.kind:
        case Kind.ASSIGN:
            _assign(state, statement, block)
        case Kind.IF_GOTO:
            if is_true(state, statement.condition, block):
                return _go_to(state, statement, block)
            if _names_target(statement) and is_unknown(state, statement.condition):
                _find_target(state, statement, block)
        case Kind.IF_THEN:
            if statement.then is not None and is_true(state, statement.condition, block):
                return _execute(state, statement.then, block)
        case Kind.GOTO:
            return _go_to(state, statement, block)
        case Kind.WHILE_DO | Kind.DO | Kind.END:
            return _loop(state, statement, block)
        case Kind.CALL:
            return execute_call(state, statement, block)
        case Kind.STRUCTURE:
            return execute_structure(state, statement, block)
        case Kind.REPEAT:
            return repeat_part(state, statement, block)
        case Kind.NC:
            return _execute_words(state, statement, block)
        case _:
            pass
    return block + 1


def _assign(state: State, statement: Statement, block: int) -> None:
    macro, arithmetic = state.listing.macro, state.listing.arithmetic
    number, step = None, UNKNOWN
    if statement.target is not None:
        number, _ = evaluate(statement.target, state.variables, arithmetic)
    before = state.variables.value(number) if number is not None and state.variables.exists(number) else None
    is_of_offset = number is not None and _is_within(number, _offset_variables(macro))
    if is_of_offset:
        step = step_of(statement, number or 0.0, state.variables, arithmetic)
    state.add(assign(statement, state.variables, arithmetic), block)
    after = state.variables.value(number) if number is not None and state.variables.exists(number) else None
    state.changes += before != after or number is None or number != number
    if number is not None:
        state.rows.note_value(block, number, after, state.variables.depth)
    if is_of_offset:
        value = step if step == step else UNKNOWN if after is None else after
        state.rows.add_assigned(block, Assigned(round(number or 0), value, step == step), state.depth)
    elif (
        number is not None
        and number != number
        and macro.language == "custom-macro"  # those of other languages are no offsets
        and block not in state.unknown_targets
    ):
        state.unknown_targets.add(block)
        state.rows.add_assigned(block, Assigned(NO_VARIABLE, UNKNOWN), state.depth)
    if number in macro.alarm_variables or number in macro.stop_variables:
        state.add_remark("stops-itself", block, number=int(number or 0))
        if number in macro.alarm_variables:
            raise Stop


def _go_to(state: State, statement: Statement, block: int) -> int:
    target = _find_target(state, statement, block)
    return block + 1 if target is None else _jump(state, target, block)


def _names_target(statement: Statement) -> bool:
    """True for a jump to a label, or to a number as it is written: another way may assign a variable."""
    jump = statement.jump
    return bool(statement.label) or (jump is not None and [step.name for step in jump.steps] == ["number"])


def _find_target(state: State, statement: Statement, block: int) -> int | None:
    """The block to which a statement jumps; None, and reported, where there is none, be the jump taken or not."""
    if statement.label:
        return _find_label(state, statement, block)
    if statement.jump is None:
        return None
    number, fault = evaluate(statement.jump, state.variables, state.listing.arithmetic)
    state.add(fault, block)
    if number is None or number != number:
        if fault is None and number is None:
            state.add_fault("sequence-number-vacant", block, statement.jump)
        else:
            state.add_remark("condition-unknown", block)
        return None
    target = state.listing.programs.jump(state.stack[-1].program, round(number), block, statement.search)
    if target is None and statement.search is not Search.IF_THERE:
        state.add_fault("sequence-number-not-found", block, statement.jump, number=round(number))
    return target


def _jump(state: State, target: int, block: int) -> int:
    """Jump to a block; return it."""
    if target <= block:
        state.go_back(block, target)
    leave_parts(state, target)
    state.jumped = True
    return target


def _find_label(state: State, statement: Statement, block: int) -> int | None:
    program, search = state.stack[-1].program, statement.search
    target = state.listing.programs.labelled(program, statement.label, block, search)
    limit = state.listing.macro.sequence_name_limit
    if target is None and limit and len(statement.label) - 1 > limit and search is not Search.IF_THERE:
        state.add_fault("label-too-long", block, statement, label=statement.label, limit=limit)
    elif target is None and search is not Search.IF_THERE:
        where = {Search.FORWARD: " behind this block", Search.BACKWARD: " before this block"}.get(search, "")
        state.add_fault("label-not-found", block, statement, label=statement.label, where=where)
    return target


def _loop(state: State, statement: Statement, block: int) -> int:
    loops = state.listing.loops(state.stack[-1].program)
    if statement.kind is Kind.END:
        head = loops.head.get(block)
        if head is None:
            return block + 1
        begin = state.listing.statement(head)
        if begin.kind is Kind.DO or not is_unknown(state, begin.condition):
            state.go_back(block)
            return head
        return block + 1
    end = loops.end.get(block)
    if statement.kind is Kind.DO or end is None:
        return block + 1
    if statement.condition is None:
        return end + 1
    # Where its condition is unknown it runs once; the END goes on.
    return end + 1 if state.decide(statement.condition, block) is False else block + 1


def _execute_words(state: State, statement: Statement, block: int) -> int:
    """Execute a block of NC words, some of which may be computed; return the next block."""
    if not state.listing.text.blocks.is_macro[block]:
        state.rows.add_plain(block, block + 1, state.depth)
        if state.rows.ends(block):
            raise Stop
        return block + 1
    words = _computed_words(state, statement, block)
    if state.rows.add_computed(block, words, state.depth):
        raise Stop
    if any(word.address in ("G", "M") and value != value for word, value in words):
        state.rows.mark_unknown()
    modal = modal_call(state)
    if modal is not None and state.rows.moves(words):
        return enter_program(state, modal.program, block + 1, modal.repeats, modal.arguments)
    return block + 1


def _computed_words(state: State, statement: Statement, block: int) -> list[tuple[Word, float]]:
    """The words of a block with their values, without those that block skip or a vacant variable removes."""
    control, macro = state.listing.machine.control, state.listing.macro
    least = control.least_increment_inch if state.rows.inch else control.least_increment
    cut = None
    if state.skip:
        cut = next((skip.start for skip in statement.skips if skip.start > statement.start), None)
    words = []
    for word in statement.words:
        if cut is not None and word.start > cut:
            break
        increment = macro.computed_increments.get(word.address, least)
        value, fault = word_value(word, state.variables, increment, state.listing.arithmetic)
        state.add(fault, block)
        if value is None:
            state.add_fault("word-vacant", block, word)
            continue
        if value is UNKNOWN:
            value = Unknown(None)
        if isinstance(value, FromVacant) and not state.variables.belongs_to_program(value.variable):
            value = float(value)
        words.append((word, value))
    return words


def _offset_variables(macro: Macro) -> tuple[tuple[int, int], ...]:
    return (*macro.tool_offset_variables, *macro.work_offset_variables)


def _returns(statement: Statement, macro: Macro) -> bool:
    return any(part.call in macro.program_returns for part in (statement, *statement.more))


def _is_within(number: float, ranges: Iterable[tuple[int, int]]) -> bool:
    """True if the number of a variable, rounded to a whole one, lies in one of the ranges (last included)."""
    return any(first - 0.5 <= number < last + 0.5 for first, last in ranges)
