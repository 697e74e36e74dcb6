"""
The ways in which a file runs: each of its channels, as it stands or executed, with block skip off and on, with the
programs that it calls.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence

import msgspec
import numpy as np

from polarcheck.execution.arithmetic import UNKNOWN
from polarcheck.execution.programs import block_text, needs_flow, read_text
from polarcheck.execution.run import Run, straight
from polarcheck.machines.job import Job
from polarcheck.machines.machine import Machine
from polarcheck.reading.channels import channels
from polarcheck.reading.source import Source
from polarcheck.reading.words import Text

#: An assignment of a variable by its number.
_ASSIGNED = re.compile(rb"#[ \t]*+(\d{1,6})[ \t]*+=")


def runs(source: Source, machine: Machine, job: Job) -> list[tuple[str, Run]]:
    """
    The runs of a file, each with the state of block skip ("" where it makes no difference); those of a channel
    together, the channels by their numbers.

    The file and each file that it calls are read once, and executed once for each state of block skip; once more only
    where a program whose number is computed lies in a file that was not read yet. A channel runs for itself, from the
    power-on states on. It can call the programs of the others.
    """
    control = machine.control
    texts = [read_text(one, machine) for one in channels(source, control.channel_mark, control.line_comments)]
    texts = [text for text in texts if _has_program(text)] or texts[:1]
    found = []
    for number, text in enumerate(texts):
        found += _runs(text, machine, job, [*texts[:number], *texts[number + 1 :]])
    return found


def _has_program(text: Text) -> bool:
    return bool(len(text.words) or np.any(text.blocks.is_macro))


def _runs(text: Text, machine: Machine, job: Job, others: Sequence[Text]) -> list[tuple[str, Run]]:
    """The runs of one channel; others: the texts of the other channels."""
    if not needs_flow(text, machine.macro.flow_codes):
        return [("", straight(text, machine.m_codes.program_end))]
    from polarcheck.execution.executions import executed  # most files need none of it

    states: tuple[str, ...] = ("off", "on") if job.run.block_skip == "both" else (job.run.block_skip,)
    if not (np.any(text.words.address == ord("/")) or _skips_macro(text)):
        states = ("off",)
    found = executed(text, machine, _without_values(job, machine, others), states, others)
    return list(zip(states, found, strict=True)) if len(found) > 1 else [("", found[0])]


def _without_values(job: Job, machine: Machine, others: Iterable[Text]) -> Job:
    """The job of a channel: common variables that another channel assigns may hold anything, unless the job says it."""
    common = (*machine.macro.common_variables, *machine.macro.retained_variables)
    assigned = {
        number: UNKNOWN
        for text in others
        for number in (int(digits) for digits in set(_ASSIGNED.findall(text.source.code.tobytes())))
        if any(first <= number <= last for first, last in common)
    }
    if not assigned:
        return job
    run = msgspec.structs.replace(job.run, variables={**assigned, **job.run.variables})
    return msgspec.structs.replace(job, run=run)


def _skips_macro(text: Text) -> bool:
    """Whether a block with macro begins with / or has one that is no division."""
    blocks = np.flatnonzero(text.blocks.is_macro).tolist()
    return any(re.match(r"\s*(?:N\s*\d+\s*)?/", block_text(text, block), re.IGNORECASE) for block in blocks)
