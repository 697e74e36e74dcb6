"""Structures (IF .. ELSE .. ENDIF, FOR, LOOP) and the parts of a program that run again."""

from __future__ import annotations

from polarcheck.program.execution.calls import enter_program
from polarcheck.program.execution.expression import Expression, decide, evaluate
from polarcheck.program.execution.programs import Program, Search
from polarcheck.program.execution.state import State
from polarcheck.program.execution.statement import Statement
from polarcheck.program.execution.structures import Structures


def execute_structure(state: State, statement: Statement, block: int) -> int:
    """Execute a statement that begins, divides or ends a structure; return the next block."""
    structures = state.listing.structures(block)
    match statement.structure:
        case "IF":
            if is_true(state, statement.condition, block):
                return block + 1
            return skip_to(state, structures.other.get(block, structures.end.get(block, block)))
        case "ELSE":
            return skip_to(state, structures.end.get(block, block))
        case "WHILE":
            if is_unknown(state, statement.condition):
                state.add_remark("condition-unknown", block)
                return block + 1  # run once
            is_on = is_true(state, statement.condition, block)
            return block + 1 if is_on else skip_to(state, structures.end.get(block, block))
        case "FOR":
            set_counter(state, statement, on=False)
            is_on = for_continues(state, statement, block)
            return block + 1 if is_on else skip_to(state, structures.end.get(block, block))
        case "ENDWHILE" | "ENDFOR" | "ENDLOOP" | "UNTIL":
            return end_of_loop(state, statement, block, structures)
    return block + 1


def skip_to(state: State, block: int) -> int:
    """Skip to a keyword; return the block behind it."""
    state.visited[block] = True
    return block + 1


def end_of_loop(state: State, statement: Statement, block: int, structures: Structures) -> int:
    """Execute the end of a loop: return its head, or the block behind its end."""
    head = structures.head.get(block)
    if head is None:
        return block + 1
    begin = state.listing.statement(head)
    if statement.structure == "UNTIL" and (
        is_true(state, statement.condition, block) or is_unknown(state, statement.condition)
    ):
        return block + 1
    if begin.structure == "FOR":
        set_counter(state, begin, on=True)
        if not for_continues(state, begin, block):
            return block + 1
    if begin.structure == "WHILE":
        if is_unknown(state, begin.condition):
            return block + 1
        state.go_back(block)
        return head
    state.go_back(block)
    return head + 1


def is_unknown(state: State, condition: Expression | None) -> bool:
    """True for a condition with an unknown value, or one that could not be read."""
    return condition is None or decide(condition, state.variables, state.listing.arithmetic)[0] is None


def is_true(state: State, condition: Expression | None, block: int) -> bool:
    """True for a condition that holds; an unknown one counts as false, and is remarked."""
    return condition is not None and bool(state.decide(condition, block))


def for_continues(state: State, statement: Statement, block: int) -> bool:
    """True where a FOR executes its blocks again; where its limits are unknown it does so once."""
    if not is_unknown(state, statement.condition):
        return is_true(state, statement.condition, block)
    state.add_remark("condition-unknown", block)
    return statement.structure == "FOR" and state.listing.statement(block) is statement


def set_counter(state: State, statement: Statement, *, on: bool) -> None:
    """Set the variable of a FOR to its first value, or to the next one if `on`."""
    arithmetic = state.listing.arithmetic
    if statement.target is None or statement.value is None:
        return
    number, _ = evaluate(statement.target, state.variables, arithmetic)
    if number is None or not state.variables.exists(number):
        return
    value = state.variables.value(number) if on else evaluate(statement.value, state.variables, arithmetic)[0]
    state.variables.write(number, (value or 0.0) + on)
    state.changes += 1


# ---- parts that run again ----


def repeat_part(state: State, statement: Statement, block: int) -> int:
    """Execute REPEAT of the blocks between labels, as a call of that part of the program; return the next block."""
    program = state.listing.programs.around(block)
    begin = find_label(state, program, statement.label, block)
    if begin is None:
        state.add_fault("label-not-found", block, statement, label=statement.label, where="")
        return block + 1
    end = end_of_part(state, program, statement, begin, block)
    if end is None:
        state.add_remark("not-simulated", block, name=f"{statement.label} behind REPEAT")
        state.rows.mark_unknown()
        return block + 1
    times = 1
    if statement.value is not None:
        value = state.evaluate(statement.value, block)
        if value != value:
            state.add_remark("condition-unknown", block)
        else:
            times = max(round(value or 0), 0)
    if times > state.settings.max_blocks:
        state.add_fault("too-many-repeats", block, statement, repeats=times, limit=state.settings.max_blocks)
    part = Program(program.number, program.name, begin, end, program.has_head, program.file)
    levels = len(state.stack)
    next_block = enter_program(state, part, block + 1, times, None, statement, block)
    if len(state.stack) > levels:
        state.stack[-1].is_part = True
    return next_block


def find_label(state: State, program: Program, label: str, block: int) -> int | None:
    """The block of a label before a block, else behind it."""
    programs = state.listing.programs
    before = programs.labelled(program, label, block, Search.BACKWARD)
    return before if before is not None else programs.labelled(program, label, block, Search.FORWARD)


def end_of_part(state: State, program: Program, statement: Statement, begin: int, block: int) -> int | None:
    """The block behind a part that begins at a label; None where the part has no end."""
    if statement.until == statement.label:
        return begin + 1
    last_label = statement.until or "ENDLABEL"
    last = state.listing.programs.labelled(program, last_label, begin, Search.FORWARD)
    if last is not None and (statement.until or begin > block or last < block):
        return last + 1
    return block if begin < block and not statement.until else None


def leave_parts(state: State, target: int) -> None:
    """End the repeated parts that a jump to this block leaves."""
    while state.stack[-1].is_part and not state.stack[-1].program.first <= target < state.stack[-1].program.end:
        state.stack.pop()
