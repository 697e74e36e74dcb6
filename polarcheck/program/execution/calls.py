"""Calls of programs and returns from them: M98, M99, G65, G66 and their levels."""

from __future__ import annotations

from msgspec.structs import replace

from polarcheck.program.execution.expression import evaluate
from polarcheck.program.execution.macro import assign_arguments, called_program
from polarcheck.program.execution.programs import Program, ProgramName
from polarcheck.program.execution.state import Level, ModalCall, Restart, State, Stop
from polarcheck.program.execution.statement import Statement


def execute_call(state: State, statement: Statement, block: int) -> int:
    """Execute a block with a code that calls, returns, or ends a modal call; return the next block."""
    macro, code = state.listing.macro, statement.call
    modal_calls = (*macro.modal_macro_calls, *macro.modal_macro_calls_each_block)
    has_arguments = code in (*macro.macro_calls, *modal_calls)
    state.rows.add_call(block, statement, state.depth, has_arguments)
    if code in macro.modal_macro_cancel:
        state.modal = None
        return block + 1
    if code in macro.program_returns:
        return leave_program(state, statement, block)
    called = called_program(statement, state.variables, macro, state.listing.arithmetic)
    if called.fault is not None:
        state.add(called.fault, block)
        return block + 1
    arguments: dict[int, float | None] | None = None
    if has_arguments:
        assigned = assign_arguments(statement, state.variables, macro, state.listing.arithmetic)
        state.add(assigned.fault, block)
        arguments = assigned.values
    program = state.listing.programs.around(block) if called.is_own else find_program(state, called.program)
    if program is not None and statement.parameters is not None:
        arguments = parameters_of(state, statement, program, block)
    if program is None:
        report_missing(state, statement, block, called.program)
        return block + 1
    rivals = state.rivals.get(called.program)
    if rivals and state.listing.found.get(called.program) == program.file:
        first, *further = rivals
        listed = f"{first} and {', '.join(further)}"
        state.add_remark("program-in-several-files", block, program=str(called.program), files=listed, first=first)
    if called.begin is not None:
        program = part_from(state, statement, program, called.begin, block)
        if program is None:
            return block + 1
    if called.repeats is None:
        state.add_remark("condition-unknown", block)
    repeats = 1 if called.repeats is None else called.repeats
    if repeats > state.settings.max_blocks:
        state.add_fault("too-many-repeats", block, statement, repeats=repeats, limit=state.settings.max_blocks)
    if code in modal_calls:
        state.modal = ModalCall(program, arguments or {}, repeats)
        return block + 1
    return enter_program(state, program, block + 1, repeats, arguments, statement, block)


def parameters_of(state: State, statement: Statement, program: Program, block: int) -> dict[int, float | None]:
    """The parameters of a program called by name: the argument of the call, else the default of the program, else 0."""
    procedure, arguments = state.listing.procedure(program), statement.parameters or ()
    values: dict[int, float | None] = {}
    for index, parameter in enumerate(procedure.parameters or () if procedure else ()):
        expression = (arguments[index].value if index < len(arguments) else None) or parameter.value
        value, fault = (0.0, None) if expression is None else evaluate(expression, state.variables)
        state.add(fault, block)
        values[parameter.variable] = value
    return values


def modal_call(state: State) -> ModalCall | None:
    """The modal call that each block with a move makes. Moves inside of its macro do not call it again."""
    modal = state.modal
    if modal is None or any(level.program is modal.program for level in state.stack):
        return None
    return modal


def find_program(state: State, called: ProgramName) -> Program | None:
    """The program of a call; its file is read if necessary. It is the same during the whole execution."""
    if called == ProgramName(None, None):
        return None
    if called not in state.programs:
        state.programs[called] = _look_up(state, called)
    program = state.programs[called]
    if program is not None:
        state.used_files.add(program.file)
    return program


def _look_up(state: State, called: ProgramName) -> Program | None:
    """Look in the file itself and in the files used so far, then in the folders."""
    candidates = state.listing.programs.named(called)
    for program in candidates:
        if program.file in state.used_files:
            return program
    if called in state.listing.found:
        file = state.listing.found[called]
        return next((program for program in candidates if program.file == file), None)
    if state.resolve(called):
        raise Restart
    state.unused_files.update(program.file for program in candidates)
    return None


def report_missing(state: State, statement: Statement, block: int, called: ProgramName) -> None:
    """Report a program that is unknown or does not exist; the effect of the call is unknown."""
    if called == ProgramName(None, None):
        state.add_remark("program-unknown", block)
    else:
        state.add_fault("program-not-found", block, statement, program=str(called))
    state.rows.mark_unknown()


def part_from(state: State, statement: Statement, program: Program, begin: float, block: int) -> Program | None:
    """The part of a program from an N number on, as M98 Q100 calls it; None, and reported, where there is none."""
    if begin != begin:
        state.add_remark("program-unknown", block)
        state.rows.mark_unknown()
        return None
    first = state.listing.programs.jump(program, round(begin), program.first - 1)
    if first is None:
        macro = state.listing.macro
        address = "P" if statement.call in macro.local_calls else macro.sequence_word
        word = next(word for word in statement.words if word.address == address)
        this_program = state.listing.programs.around(block)
        name = "this program" if program == this_program else str(ProgramName(program.number, program.name))
        state.add_fault("call-target-not-found", block, word, number=round(begin), called=name)
        state.rows.mark_unknown()
        return None
    return replace(program, first=first)


def enter_program(
    state: State,
    program: Program,
    back: int,
    repeats: int,
    arguments: dict[int, float | None] | None,
    statement: Statement | None = None,
    block: int = -1,
) -> int:
    """Enter a program; beyond the levels of the control continue behind the call. Returns the next block."""
    macro = state.listing.macro
    macros = sum(level.is_macro for level in state.stack)
    limit = macro.macro_levels if arguments is not None else macro.subprogram_levels
    depth = macros if arguments is not None else state.depth - macros
    if depth >= limit or len(state.stack) > macro.macro_levels + macro.subprogram_levels:
        if statement is not None:
            state.add_fault("call-levels", block, statement, levels=limit)
        return back
    if repeats <= 0:
        return back
    assigned = statement.assigned if statement is not None else ()
    level = Level(program, back, repeats, arguments is not None, assigned)
    state.stack.append(level)
    if arguments is not None:
        state.variables.enter(arguments)
        for number, value in arguments.items():
            state.rows.note_value(back - 1, number, value, state.variables.depth)
        state.changes += 1
    if repeats > state.settings.max_blocks:
        level.repeats, level.changes = 1, state.changes
    return program.first


def leave_program(state: State, statement: Statement | None, block: int = -1) -> int:
    """Execute M99 or the end of a program: continue in the caller, at its N number with M99 P, or repeat with L."""
    level = state.stack[-1]
    state.count_statement(max(block, level.program.first))
    if level.repeats > 1:
        level.repeats -= 1
        return level.program.first
    target = return_target(state, statement, block)
    state.stack.pop()
    if level.is_macro:
        state.variables.leave()
    for number in level.assigned:
        state.variables.write(number, None)
    if level.changes is not None:
        state.rows.add_unknown(level.back - 1, max(state.depth, 0))
        if level.changes != state.changes:
            state.variables.forget()
    if not state.stack:
        if target is not None:
            state.add_remark("return-jumps", block, code=statement.call if statement else "")
        raise Stop
    if target is None:
        return level.back
    caller = state.stack[-1].program
    next_block = state.listing.programs.jump(caller, target, caller.first - 1)
    if next_block is None:
        assert statement is not None
        state.add_fault("return-target-not-found", block, statement, number=target)
        return level.back
    if next_block < level.back:
        state.go_back(block)
    return next_block


def return_target(state: State, statement: Statement | None, block: int) -> int | None:
    """The N number in P of an M99; None where there is none, or, which is remarked, where it is unknown."""
    word = next((word for word in statement.words if word.address == "P"), None) if statement else None
    if word is None:
        return None
    value, _ = evaluate(word.value, state.variables, state.listing.arithmetic)
    if value is not None and value != value:
        state.add_remark("condition-unknown", block)
        return None
    return None if value is None else round(value)
