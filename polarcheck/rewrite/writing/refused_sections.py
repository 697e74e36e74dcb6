"""Why polar sections cannot be rewritten, whatever is to become of them."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence

import numpy as np

from polarcheck.checking.not_known import position_not_known
from polarcheck.columns.trace import Trace
from polarcheck.foundation.arrays import Mask
from polarcheck.rewrite.writing.outcome import Refusal, refusal_at

#: Rows that cannot be rewritten, and why; of a reason that depends on the row the function that gives it.
Check = tuple[Mask, str | Callable[[Trace, int], str]]


def refusals_in_sections(trace: Trace, checks: Iterable[Check]) -> Iterator[Refusal]:
    """Yield for each check the first row of each section that it hits."""
    for hits, text in checks:
        for row in np.flatnonzero(trace.mode.first_in_section(hits)).tolist():
            yield refusal_at(trace, row, text if isinstance(text, str) else text(trace, row))


def unknown_positions(trace: Trace, rows: Mask, faults: Sequence[Refusal]) -> Check:
    """
    Return the rows whose position is not known.

    faults: that are told beside them: among them are those of words that the control cannot read, which leave the rest
    of their sections open.
    """
    if faults:
        rows = rows & ~trace.mode.anywhere_in_section(trace.blocks.with_words(trace.run.words.is_unreadable))
    return rows, position_not_known


def never_left(trace: Trace) -> Mask:
    """Return a boolean per section: nothing in its program leaves the mode."""
    sections = trace.mode.sections
    return np.asarray(~sections.left | sections.returned | (sections.leave >= len(trace)))


def checks_of_switches(trace: Trace) -> list[tuple[Mask, str]]:
    """Return the sections that are never left, and those that are switched on twice."""
    enters = trace.mode.sections.enter[never_left(trace)]
    again = (trace.mode.enters_again, "the polar mode is switched on again within")
    return [again, (trace.blocks.mask_of(enters), "the polar mode is never left")]


def checks_of_sections(trace: Trace, is_followed: Mask) -> list[Check]:
    """Return what nobody can rewrite. is_followed: a boolean per row: the axes of its section are followed."""
    mode, inside = trace.mode, trace.mode.in_polar
    return [
        *checks_of_switches(trace),
        (trace.blocks.has(trace.machine.polar.infeed_word) & mode.enters, "an infeed cycle makes the passes"),
        (trace.run.unknown & inside, "what this block does is not known"),
        (inside & ~is_followed, "the axes of this section are not followed"),
        (inside & (trace.axes.linear_axis != ord("X")), "the linear axis of this section is not X"),
        (inside & trace.modal.in_cycle & trace.axes.moves, "a cycle in the mode is not followed"),
    ]
