"""The executions of a file, one for each state of block skip, with all that is found in them."""

from __future__ import annotations

from collections.abc import Sequence
from collections.abc import Set as AbstractSet

import msgspec
import numpy as np

from polarcheck.arrays import Rows
from polarcheck.execution.execute import Execution, execute
from polarcheck.execution.library import Shelf
from polarcheck.execution.listing import Listing
from polarcheck.execution.run import Beside, FlowFault, Remark, Run
from polarcheck.execution.static_faults import add_static_faults
from polarcheck.machines.job import Job
from polarcheck.machines.machine import Machine
from polarcheck.reading.joining import joined
from polarcheck.reading.words import Text


def executed(text: Text, machine: Machine, job: Job, states: Sequence[str], beside: Beside | None = None) -> list[Run]:
    """
    The run of a file in each state of block skip ("off", "on").

    beside: the other channels of the file. Called files that no call came to are no part of its text.
    """
    inch = (job.program_units or machine.control.units) == "inch"
    shelf = Shelf(text, machine, job.run.subprograms, beside)
    texts: dict[frozenset[int], Text] = {}
    found = []
    for state in states:
        execution = execute(shelf, job.run, skip=state == "on", inch=inch)
        add_static_faults(execution)
        used = frozenset(execution.used)
        if used not in texts:
            listing = execution.listing
            is_whole = len(used) == len(listing.files)
            texts[used] = listing.text if is_whole else joined([listing.files[file] for file in sorted(used)])
        found.append(_with_text(execution, texts[used]))
    return found


def _with_text(execution: Execution, text: Text) -> Run:
    """The rows of an execution as a run of the text that holds no other files than those it used."""
    listing = execution.listing
    names = {number: name for name, number in listing.names.tools.items()}
    run = execution.rows.run(execution.faults.all(), execution.remarks, names)
    if len(execution.used) == len(listing.files):
        return msgspec.structs.replace(run, text=text)
    blocks, characters = _shifts(listing, execution.used)
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
    """By how many blocks and characters each file moves forward where those that are not used are left out."""
    first = np.array(listing.first_blocks)
    begin = np.append(listing.text.blocks.start[first[:-1]], len(listing.text.source.code))
    left_out = np.array([file not in used for file in range(len(listing.files))])

    def before(sizes: Rows) -> Rows:
        dropped = np.where(left_out, sizes, 0)
        return np.asarray(np.cumsum(dropped) - dropped)

    return before(np.diff(first)), before(np.diff(begin))
