"""The executions of a file, one for each state of block skip, as runs."""

from __future__ import annotations

import math
from collections.abc import Sequence
from collections.abc import Set as AbstractSet

import msgspec
import numpy as np

from polarcheck.foundation.arrays import Rows
from polarcheck.program.execution.called_programs import Shelf
from polarcheck.program.execution.execute import execute
from polarcheck.program.execution.expression import Fault
from polarcheck.program.execution.idle_loops import idle_loop
from polarcheck.program.execution.listing import Listing
from polarcheck.program.execution.programs import Program, block_text
from polarcheck.program.execution.run import Beside, FlowFault, Remark, Run
from polarcheck.program.execution.state import State
from polarcheck.program.execution.statement import Kind, Statement
from polarcheck.program.machines.job import Job
from polarcheck.program.machines.machine import Machine
from polarcheck.program.reading.joining import joined
from polarcheck.program.reading.words import Text

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
        for fault in (*listing.loops(program).faults, *listing.structures(program.first).faults):
            state.add_fault(fault.kind, fault.block, listing.statement(fault.block), **fault.values)
        _idle_loops(state, program)
    if not state.remarks and not state.stopped:
        _never_run(state)


def _mixed_logic(state: State, block: int, statement: Statement) -> None:
    expressions = [statement.value, statement.condition, statement.target, statement.jump]
    expressions += [word.value for word in statement.words]
    for expression in expressions:
        mixed = expression.mixed if expression is not None else None
        if expression is not None and mixed is not None:
            written = " ".join(block_text(state.listing.text, block)[expression.start : expression.end].split())
            state.add_fault("mixed-logic", block, Fault("mixed-logic", *mixed), expression=written[:_SHOWN])


def _target_twice(state: State, program: Program, block: int, statement: Statement) -> None:
    jump = statement.jump or (statement.then.jump if statement.then else None)
    if jump is None or len(jump.steps) != 1 or jump.steps[0].name != "number":
        return
    number = jump.steps[0].number
    count = len(state.listing.programs.targets(program).get(round(number), [])) if math.isfinite(number) else 0
    if count > 1:
        state.add_fault("sequence-number-twice", block, jump, number=round(number), count=count)


def _idle_loops(state: State, program: Program) -> None:
    """Report loops that move or set something, and never run by what the program itself writes."""
    listing, visited = state.listing, state.visited
    heads = {**listing.loops(program).end, **listing.structures(program.first).end}
    statements = listing.macro_statements(program) if heads else []
    for head, end in heads.items():
        if not visited[head] or visited[head + 1 : end].any():
            continue
        loop = idle_loop(statements, head, end)
        if loop is not None:
            written = " ".join(block_text(listing.text, head)[loop.condition.start : loop.condition.end].split())
            counter = block_text(listing.text, loop.block)[loop.target.start : loop.target.end]
            state.add_fault(
                "loop-never-run",
                head,
                loop.condition,
                expression=written[:_SHOWN],
                counter=counter,
                start=loop.start,
                instead=loop.instead,
            )


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
                fault = Fault("never-run", lead, max(len(written.rstrip()), lead + 1))
                state.add_fault("never-run", block, fault)
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


def executed(
    text: Text, machine: Machine, job: Job, states: Sequence[str], channels: Beside | None = None
) -> list[Run]:
    """
    The run of a file in each state of block skip ("off", "on").

    channels: the other channels of the file. Called files that no call came to are no part of its text.
    """
    inch = (job.program_units or machine.control.units) == "inch"
    shelf = Shelf(text, machine, job.run.subprograms, channels)
    texts: dict[frozenset[int], Text] = {}
    runs = []
    for skip in states:
        state = execute(shelf, job.run, skip=skip == "on", inch=inch)
        add_static_faults(state)
        used = frozenset(state.used_files)
        if used not in texts:
            listing = state.listing
            is_whole = len(used) == len(listing.files)
            texts[used] = listing.text if is_whole else joined([listing.files[file] for file in sorted(used)])
        runs.append(_with_text(state, texts[used]))
    return runs


def _with_text(state: State, text: Text) -> Run:
    """The rows of an execution as a run of the text that holds only the files it used."""
    listing = state.listing
    names = {number: name for name, number in listing.names.tools.items()}
    run = state.rows.run(state.faults, state.remarks, names)
    if len(state.used_files) == len(listing.files):
        return msgspec.structs.replace(run, text=text)
    blocks, characters = _shifts(listing, state.used_files)
    files = np.array(listing.first_blocks[1:])

    def file_of(block: Rows) -> Rows:
        return np.searchsorted(files, block, side="right")

    of_words = file_of(run.words.block)
    words = msgspec.structs.replace(
        run.words,
        block=run.words.block - blocks[of_words],
        start=run.words.start - characters[of_words],
        end=run.words.end - characters[of_words],
    )

    def fault(flow_fault: FlowFault) -> FlowFault:
        file = int(file_of(np.array(flow_fault.block)))
        start, end = flow_fault.start - int(characters[file]), flow_fault.end - int(characters[file])
        return msgspec.structs.replace(flow_fault, block=flow_fault.block - int(blocks[file]), start=start, end=end)

    def remark(original: Remark) -> Remark:
        return msgspec.structs.replace(
            original, block=original.block - int(blocks[int(file_of(np.array(original.block)))])
        )

    return msgspec.structs.replace(
        run,
        text=text,
        words=words,
        block=run.block - blocks[file_of(run.block)],
        faults=tuple(map(fault, run.faults)),
        remarks=tuple(map(remark, run.remarks)),
    )


def _shifts(listing: Listing, used: AbstractSet[int]) -> tuple[Rows, Rows]:
    """Blocks and characters by which each file moves forward when the unused ones are left out."""
    first = np.array(listing.first_blocks)
    begin = np.append(listing.text.blocks.start[first[:-1]], len(listing.text.source.code))
    left_out = np.array([file not in used for file in range(len(listing.files))])

    def before(sizes: Rows) -> Rows:
        dropped = np.where(left_out, sizes, 0)
        return np.asarray(np.cumsum(dropped) - dropped)

    return before(np.diff(first)), before(np.diff(begin))
