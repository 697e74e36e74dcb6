"""
The ways in which a file runs: each of its channels, as it stands or executed, with block skip off and on, with the
programs that it calls.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from itertools import chain

import msgspec
import numpy as np

from polarcheck.program.execution.arithmetic import UNKNOWN
from polarcheck.program.execution.programs import block_text, needs_flow, read_text
from polarcheck.program.execution.run import Beside, Run, straight
from polarcheck.program.execution.variable_names import ASSIGNED
from polarcheck.program.machines.job import Job
from polarcheck.program.machines.machine import Machine
from polarcheck.program.reading.channel_texts import channels
from polarcheck.program.reading.source import Source
from polarcheck.program.reading.words import Text

#: What stands in a channel for the text of the others.
_BLANK = 32


def runs(source: Source, machine: Machine, job: Job) -> list[tuple[str, Run]]:
    """
    The runs of a file, each with the state of block skip ("" where it makes no difference); those of a channel
    together, the channels by their numbers.

    The file and each file that it calls are read once, and executed once for each state of block skip; once more only
    where a program whose number is computed lies in a file that was not read yet. A channel runs for itself, from the
    power-on states on. It can call the programs of the others.
    """
    texts = texts_of(source, machine)
    called = [_called(text, machine) for text in texts] if len(texts) > 1 else [frozenset[int | str]()]
    results = []
    for number, text in enumerate(texts):
        remaining = range(len(texts))[:number], range(len(texts))[number + 1 :]
        indices = list(chain(*remaining))
        channels = Beside(
            [texts[index] for index in indices], frozenset[int | str]().union(*(called[index] for index in indices))
        )
        results += _runs(text, machine, job, channels)
    return results


def texts_of(source: Source, machine: Machine) -> list[Text]:
    """Return the text of each channel of a file; nothing is executed."""
    control = machine.control
    texts = [read_text(channel, machine) for channel in channels(source, control.channel_mark, control.line_comments)]
    return _with_programs(texts) if len(texts) > 1 else texts


def _with_programs(channels: Sequence[Text]) -> list[Text]:
    """The channels that have more than what stands before the first mark of one; a single one is the file itself."""

    def has_own(text: Text) -> bool:
        reference = next(channel for channel in channels if channel is not text).source.code
        differing = np.flatnonzero(text.source.code != reference)
        differing = differing[text.source.code[differing] != _BLANK]
        blocks = np.searchsorted(text.blocks.start, differing, side="right") - 1
        return bool(np.isin(text.words.start, differing).any() or text.blocks.is_macro[blocks].any())

    texts = [text for text in channels if has_own(text)] or [channels[0]]
    if len(texts) > 1:
        return texts
    (only,) = texts
    return [msgspec.structs.replace(only, source=msgspec.structs.replace(only.source, channel=""))]


def _called(text: Text, machine: Machine) -> frozenset[int | str]:
    """The numbers and names of the programs that a channel calls."""
    if not needs_flow(text, machine.macro.flow_codes):
        return frozenset()
    from polarcheck.program.execution.listing import Listing  # most files need none of it

    return frozenset(Listing([text], machine).named_by([0], by_number_only=True))


def _runs(text: Text, machine: Machine, job: Job, channels: Beside) -> list[tuple[str, Run]]:
    """The runs of one channel; beside: the others."""
    if not needs_flow(text, machine.macro.flow_codes):
        return [("", straight(text, machine.m_codes.program_end))]
    from polarcheck.program.execution.executions import executed  # most files need none of it

    states: tuple[str, ...] = ("off", "on") if job.run.block_skip == "both" else (job.run.block_skip,)
    if not (np.any(text.words.address == ord("/")) or _skips_macro(text)):
        states = ("off",)
    executed_runs = executed(text, machine, _without_values(job, machine, channels.texts), states, channels)
    return list(zip(states, executed_runs, strict=True)) if len(executed_runs) > 1 else [("", executed_runs[0])]


def _without_values(job: Job, machine: Machine, texts: Iterable[Text]) -> Job:
    """The job of a channel: common variables that another channel assigns may hold anything, unless the job says it."""
    common = (*machine.macro.common_variables, *machine.macro.retained_variables)
    assigned = {
        number: UNKNOWN
        for text in texts
        for number in (int(digits) for digits in set(ASSIGNED.findall(text.source.code.tobytes())))
        if any(first <= number <= last for first, last in common)
    }
    if not assigned:
        return job
    run = msgspec.structs.replace(job.run, variables={**assigned, **job.run.variables})
    return msgspec.structs.replace(job, run=run)


def _skips_macro(text: Text) -> bool:
    """Return True if a macro block of the text begins with / or has one that is no division."""
    blocks = np.flatnonzero(text.blocks.is_macro).tolist()
    return any(re.match(r"\s*(?:N\s*\d+\s*)?/", block_text(text, block), re.IGNORECASE) for block in blocks)
