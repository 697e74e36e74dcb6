"""The executions of a file, one for each state of block skip, as runs."""

from __future__ import annotations

from collections.abc import Sequence
from collections.abc import Set as AbstractSet

import msgspec
import numpy as np

from polarcheck.foundation.arrays import Rows
from polarcheck.program.execution.execute import execute
from polarcheck.program.execution.library import Shelf
from polarcheck.program.execution.listing import Listing
from polarcheck.program.execution.run import Beside, FlowFault, Remark, Run
from polarcheck.program.execution.state import State
from polarcheck.program.execution.static_faults import add_static_faults
from polarcheck.program.machines.job import Job
from polarcheck.program.machines.machine import Machine
from polarcheck.program.reading.joining import joined
from polarcheck.program.reading.words import Text


def executed(text: Text, machine: Machine, job: Job, states: Sequence[str], beside: Beside | None = None) -> list[Run]:
    """
    The run of a file in each state of block skip ("off", "on").

    beside: the other channels of the file. Called files that no call came to are no part of its text.
    """
    inch = (job.program_units or machine.control.units) == "inch"
    shelf = Shelf(text, machine, job.run.subprograms, beside)
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

    def fault(found: FlowFault) -> FlowFault:
        file = int(file_of(np.array(found.block)))
        start, end = found.start - int(characters[file]), found.end - int(characters[file])
        return msgspec.structs.replace(found, block=found.block - int(blocks[file]), start=start, end=end)

    def remark(found: Remark) -> Remark:
        return msgspec.structs.replace(found, block=found.block - int(blocks[int(file_of(np.array(found.block)))]))

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
