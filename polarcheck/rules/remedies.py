"""Where a value that the machine lacks is to be given: in the file of the user's own lathe, or in a new one."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from polarcheck.columns.modes.spindles import Spindles
from polarcheck.columns.trace import Trace
from polarcheck.program.machines import profiles
from polarcheck.program.machines.job import Job
from polarcheck.program.machines.machine import Machine, OwnMachine

if TYPE_CHECKING:
    from polarcheck.rules.hit import Hit

#: The most M codes that are named where each of them may be meant.
_NAMED = 3


def place(machine: Machine, key: str) -> str:
    """`m_codes.c_axis_on in lathe.toml`; for a machine of ours, in a file that is still to be made."""
    file = machine.file if isinstance(machine, OwnMachine) else "a file of your own (polarcheck machines new)"
    return f"{key} in {file}"


def option_or_place(machine: Machine, key: str) -> str:
    """The place for a single number: for a machine of ours the option that gives it, which is shorter."""
    return place(machine, key) if isinstance(machine, OwnMachine) else f"--set {key}=..."


def is_chosen(machine: Machine, job: Job) -> bool:
    """Return True if somebody has chosen the machine: it is not the one that is taken where nobody does."""
    return job.machine is not None or machine.title != profiles.load(profiles.DEFAULT).machine.title


def unlisted_codes(trace: Trace, spindles: Spindles, row: int) -> str:
    """`M76 of line 3 or M70 of line 5`: the M codes above a row of its program that are in no list; empty for none."""
    run, blocks, words = trace.run, trace.blocks, spindles.unlisted
    words = words[(run.row[words] <= row) & (blocks.program[run.row[words]] == blocks.program[row])]
    numbers = run.words.value[words]
    first = np.sort([np.flatnonzero(numbers == number)[0] for number in dict.fromkeys(numbers.tolist())]).astype(int)
    return " or ".join(_code_and_line(trace, int(words[index])) for index in first[:_NAMED])


def _code_and_line(trace: Trace, word: int) -> str:
    """`M76 of line 3`, and `M3 P14` where the machine tells M3 by what P is."""
    run, blocks = trace.run, trace.blocks
    row = int(run.row[word])
    code = f"M{run.words.value[word]:g}"
    listed = (entry.partition(" ") for entry in trace.machine.m_codes.with_words)
    letters = sorted({word[0] for listed_code, _, word in listed if listed_code == code})
    words = [f"{letter}{blocks.word(letter)[row]:g}" for letter in letters if blocks.has(letter)[row]]
    return f"{' '.join((code, *words))} of line {int(blocks.line[row])}"


def or_by(hit: Hit, spindles: Spindles, effect: str, key: str) -> str:
    """
    Return where to add an M code above a hit that may have had an effect; empty where each M code is in a list.

    effect: as `starts it`. key: the list of the machine.
    """
    codes = unlisted_codes(hit.trace, spindles, hit.row)
    return f"; if {codes} {effect}, add that to {place(hit.trace.machine, key)}" if codes else ""
