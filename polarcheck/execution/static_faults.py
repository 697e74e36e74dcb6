"""What is wrong in macro statements whether they were run or not, and the blocks that no run came to."""

from __future__ import annotations

import math

from polarcheck.execution.execute import Execution
from polarcheck.execution.expression import Fault
from polarcheck.execution.listing import Listing
from polarcheck.execution.programs import Program, block_text
from polarcheck.execution.statement import Kind, Statement

#: Of an expression that is named in a message [characters].
_SHOWN = 40


def add_static_faults(execution: Execution) -> None:
    """
    Add to the faults of an execution what is wrong whether it was run or not: loops that do not close, jumps to a
    number that stands twice. Called files that it did not use are left to checks of their own.
    """
    listing = execution.listing
    for program in listing.programs.programs:
        if program.file not in execution.used:
            continue
        for block, statement in listing.macro_statements(program):
            execution.found(statement.fault, block)
            _mixed_logic(execution, block, statement)
            _target_twice(execution, program, block, statement)
        for kind, block, number, other, levels in listing.loops(program).faults:
            execution.fault(kind, block, listing.statement(block), number=number, other=other, levels=levels)
        for structure in listing.structures(program.first).faults:
            place = listing.statement(structure.block)
            names = {"keyword": structure.keyword, "missing": structure.missing}
            execution.fault(structure.kind, structure.block, place, **names)
    if not execution.remarks and not execution.stopped:
        _never_run(execution)


def _mixed_logic(execution: Execution, block: int, statement: Statement) -> None:
    expressions = [statement.value, statement.condition, statement.target, statement.jump]
    expressions += [word.value for word in statement.words]
    for expression in expressions:
        place = expression.mixed if expression is not None else None
        if expression is not None and place is not None:
            written = " ".join(block_text(execution.listing.text, block)[expression.start : expression.end].split())
            execution.fault("mixed-logic", block, Fault("mixed-logic", *place), expression=written[:_SHOWN])


def _target_twice(execution: Execution, program: Program, block: int, statement: Statement) -> None:
    jump = statement.jump or (statement.then.jump if statement.then else None)
    if jump is None or len(jump.steps) != 1 or jump.steps[0].name != "number":
        return
    number = jump.steps[0].number
    count = len(execution.listing.programs.targets(program).get(round(number), [])) if math.isfinite(number) else 0
    if count > 1:
        execution.fault("sequence-number-twice", block, jump, number=round(number), count=count)


def _never_run(execution: Execution) -> None:
    """The first block of each stretch of blocks with words that no run came to, behind an unconditional turn."""
    listing, visited = execution.listing, execution.visited
    for program in listing.programs.programs:
        if not visited[program.first : program.end].any():
            continue
        was_visited, previous = True, program.first
        for block in execution.rows.filled(program.first, program.end):
            is_new = not visited[block] and was_visited and block not in listing.programs.with_labels
            if is_new and _ends_flow(listing, execution, previous):
                written = block_text(listing.text, block)
                lead = len(written) - len(written.lstrip())
                place = Fault("never-run", lead, max(len(written.rstrip()), lead + 1))
                execution.fault("never-run", block, place)
            was_visited = bool(visited[block])
            previous = block


def _ends_flow(listing: Listing, execution: Execution, block: int) -> bool:
    """Whether nothing comes to the next block by itself: GOTO, M30, M99."""
    if execution.rows.ends(block):
        return True
    if not listing.turns_at(block):
        return False
    statement = listing.statement(block)
    returns = listing.macro.program_returns
    return any(part.kind is Kind.GOTO or part.call in returns for part in (statement, *statement.more))
