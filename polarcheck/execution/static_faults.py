"""What is wrong in macro statements whether they were run or not, and the blocks that no run came to."""

from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.execution.expression import Fault, ambiguous
from polarcheck.execution.loops import find_loops
from polarcheck.execution.programs import Program, block_text
from polarcheck.execution.statement import Statement

if TYPE_CHECKING:
    from polarcheck.execution.execute import Execution


def static_faults(execution: Execution) -> None:
    """What is wrong in macro statements, whether they were run or not; and loops that do not close."""
    for program in execution.programs.programs:
        read = execution.macro_statements(program)
        for block, statement in read:
            execution.found(statement.fault, block)
            _ambiguous(execution, block, statement)
            _duplicate_target(execution, program, block, statement)
        loops = find_loops(read, execution.macro.loop_levels)
        for rule, block, text in loops.faults:
            execution.fault(rule, block, execution.statement(block), text)
    if not execution.remarks and not execution.stopped:
        _unreached(execution)


def _ambiguous(execution: Execution, block: int, statement: Statement) -> None:
    expressions = [statement.value, statement.condition, statement.target, statement.jump]
    expressions += [word.value for word in statement.words]
    for expression in expressions:
        place = ambiguous(expression) if expression is not None else None
        if place is not None:
            fault = Fault("format", *place)
            execution.fault("ambiguous-precedence", block, fault, "AND, OR or XOR beside + - * / without brackets")


def _duplicate_target(execution: Execution, program: Program, block: int, statement: Statement) -> None:
    jump = statement.jump or (statement.then.jump if statement.then else None)
    if jump is None or len(jump.steps) != 1 or jump.steps[0].name != "number":
        return
    number = round(jump.steps[0].number)
    count = len(execution.programs.targets(program).get(number, []))
    if count > 1:
        text = f"N{number} stands {count} times in this program; the control takes the next one"
        execution.fault("duplicate-sequence-number", block, jump, text)


def _unreached(execution: Execution) -> None:
    """The first block of each stretch of blocks with words that no run came to, behind an unconditional turn."""
    text, visited = execution.text, execution.visited
    for program in execution.programs.programs:
        blocks = execution.rows.filled(program.first, program.end)
        if not visited[program.first : program.end].any():
            continue
        was_visited, previous = True, program.first
        for block in blocks:
            if not visited[block] and was_visited and execution.ends_flow(previous):
                start = block_text(text, block)
                lead = len(start) - len(start.lstrip())
                place = Fault("format", lead, max(len(start.rstrip()), lead + 1))
                execution.fault("unreachable-block", block, place, "no run of the program comes to this block")
            was_visited = bool(visited[block])
            previous = block
