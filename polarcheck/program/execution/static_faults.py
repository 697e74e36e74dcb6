"""Faults of macro statements that are there whether they were executed or not, and blocks that were never reached."""

from __future__ import annotations

import math

from polarcheck.program.execution.expression import Fault
from polarcheck.program.execution.listing import Listing
from polarcheck.program.execution.programs import Program, block_text
from polarcheck.program.execution.state import State
from polarcheck.program.execution.statement import Kind, Statement

#: Characters of an expression in a message.
_SHOWN = 40


def add_static_faults(state: State) -> None:
    """
    Add faults that do not depend on the flow: loops that do not close, jumps to a number that stands twice.

    Called files that were not used are left to checks of their own.
    """
    listing = state.listing
    for program in listing.programs.programs:
        if program.file not in state.used_files:
            continue
        for block, statement in listing.macro_statements(program):
            state.add(statement.fault, block)
            _mixed_logic(state, block, statement)
            _target_twice(state, program, block, statement)
        for loop in listing.loops(program).faults:
            place = listing.statement(loop.block)
            state.add_fault(loop.kind, loop.block, place, number=loop.number, other=loop.other, levels=loop.levels)
        for structure in listing.structures(program.first).faults:
            place = listing.statement(structure.block)
            names = {"keyword": structure.keyword, "missing": structure.missing}
            state.add_fault(structure.kind, structure.block, place, **names)
    if not state.remarks and not state.stopped:
        _never_run(state)


def _mixed_logic(state: State, block: int, statement: Statement) -> None:
    expressions = [statement.value, statement.condition, statement.target, statement.jump]
    expressions += [word.value for word in statement.words]
    for expression in expressions:
        place = expression.mixed if expression is not None else None
        if expression is not None and place is not None:
            written = " ".join(block_text(state.listing.text, block)[expression.start : expression.end].split())
            state.add_fault("mixed-logic", block, Fault("mixed-logic", *place), expression=written[:_SHOWN])


def _target_twice(state: State, program: Program, block: int, statement: Statement) -> None:
    jump = statement.jump or (statement.then.jump if statement.then else None)
    if jump is None or len(jump.steps) != 1 or jump.steps[0].name != "number":
        return
    number = jump.steps[0].number
    count = len(state.listing.programs.targets(program).get(round(number), [])) if math.isfinite(number) else 0
    if count > 1:
        state.add_fault("sequence-number-twice", block, jump, number=round(number), count=count)


def _never_run(state: State) -> None:
    """Report the first of each run of unreached blocks with words, behind an unconditional jump or end."""
    listing, visited = state.listing, state.visited
    for program in listing.programs.programs:
        if not visited[program.first : program.end].any():
            continue
        was_visited, previous = True, program.first
        for block in state.rows.filled(program.first, program.end):
            is_new = not visited[block] and was_visited and block not in listing.programs.with_labels
            if is_new and _ends_flow(listing, state, previous):
                written = block_text(listing.text, block)
                lead = len(written) - len(written.lstrip())
                place = Fault("never-run", lead, max(len(written.rstrip()), lead + 1))
                state.add_fault("never-run", block, place)
            was_visited = bool(visited[block])
            previous = block


def _ends_flow(listing: Listing, state: State, block: int) -> bool:
    """True if the flow never continues to the next block: GOTO, M30, M99."""
    if state.rows.ends(block):
        return True
    if not listing.turns_at(block):
        return False
    statement = listing.statement(block)
    returns = listing.macro.program_returns
    return any(part.kind is Kind.GOTO or part.call in returns for part in (statement, *statement.more))
