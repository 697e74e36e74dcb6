"""The ways in which a file runs: as it stands or executed, with block skip off and on, with the programs it calls."""

from __future__ import annotations

import re

import numpy as np

from polarcheck.execution.programs import block_text, needs_flow, read_text
from polarcheck.execution.run import Run, straight
from polarcheck.machines.job import Job
from polarcheck.machines.machine import Machine
from polarcheck.reading.source import Source
from polarcheck.reading.words import Text


def runs(source: Source, machine: Machine, job: Job) -> list[tuple[str, Run]]:
    """
    The runs of a file, each with the state of block skip ("" where it makes no difference).

    The file and each file that it calls are read once, and executed once for each state of block skip; once more only
    where a program whose number is computed lies in a file that was not read yet.
    """
    text = read_text(source, machine)
    if not needs_flow(text, machine.macro.flow_codes):
        return [("", straight(text, machine.m_codes.program_end))]
    from polarcheck.execution.executions import executed  # most files need none of it

    states: tuple[str, ...] = ("off", "on") if job.run.block_skip == "both" else (job.run.block_skip,)
    if not (np.any(text.words.address == ord("/")) or _skips_macro(text)):
        states = ("off",)
    found = executed(text, machine, job, states)
    return list(zip(states, found, strict=True)) if len(found) > 1 else [("", found[0])]


def _skips_macro(text: Text) -> bool:
    """Whether a block with macro begins with / or has one that is no division."""
    blocks = np.flatnonzero(text.blocks.is_macro).tolist()
    return any(re.match(r"\s*(?:N\s*\d+\s*)?/", block_text(text, block), re.IGNORECASE) for block in blocks)
