"""What differs between the orders and kept moves of a program and of the one written anew: reasons not to write it."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator, Sequence

import numpy as np

from polarcheck.columns.trace import Trace
from polarcheck.foundation.arrays import Mask
from polarcheck.rewrite.compare.compared_sections import FedPath
from polarcheck.rewrite.compare.comparison_report import Difference, SectionPair
from polarcheck.rewrite.compare.differences import feed_differs
from polarcheck.rewrite.compare.order_differences import order_differences
from polarcheck.rewrite.compare.order_meanings import meaning_steps, names_speeds, speed_steps
from polarcheck.rewrite.compare.orders import Step, steps
from polarcheck.rewrite.compare.terms import ANGLE, DWELL, EXACT, FEED_SHARE, SPEED
from polarcheck.rewrite.writing.outcome import Refusal, refusal_at

#: Words of M, S and T in a text.
_COMMANDS = re.compile(r"\b[MST]\d")


def refusal_of(difference: Difference, section: SectionPair | None = None) -> Refusal:
    """Return a difference as a reason not to write the new program."""
    line = difference.old_line or (section.old.line if section is not None and section.old is not None else 0)
    where = f" (line {difference.new_line} of the result)" if difference.new_line else ""
    return Refusal(line, f"{difference.text}{where}")


def changed_orders(old: Trace, new: Trace, old_path: FedPath, new_path: FedPath, tolerance: float) -> Iterator[Refusal]:
    """
    Yield what differs between the orders of two programs for the same machine, and where the tool is elsewhere on the
    part at an order.

    G codes that are added, and G41 to G40 with D, say how the path is written, and are compared by the path.
    tolerance: of the paths [mm].
    """

    def moved(step: Step, new_step: Step) -> Difference | None:
        here, there = old_path.position(step.row), new_path.position(new_step.row)
        # NaN before the first move: of both or of neither.
        if np.allclose(here, there, rtol=0, atol=tolerance, equal_nan=True):
            return None
        text = f"{step.text} would stand elsewhere on the path"
        return Difference("place", text, old_line=step.line, new_line=new_step.line)

    before, after = (steps(trace, is_same_machine=True, with_sides=False) for trace in (old, new))
    for difference in order_differences(before, after, EXACT, moved):
        if difference.old_line is not None or _COMMANDS.search(difference.text):
            yield refusal_of(difference)


def changed_moves(
    traces: tuple[Trace, Trace], paths: tuple[FedPath, FedPath], stays: tuple[Mask, Mask]
) -> Iterator[Refusal]:
    """
    Yield the first move that a rewriter leaves as it is and that would lead elsewhere, or run at another F.

    paths: on the part, a piece for each move. stays: a boolean per row of either program: its move is compared.
    """
    old, new = (path[mask[path.row]] for path, mask in zip(paths, stays, strict=True))
    if len(old) != len(new):
        yield Refusal(0, f"the result has {len(new)} moves outside of rewritten paths, not {len(old)}")
        return
    moves, steps_of = np.arange(len(old)), traces[0].lengths.least_step[old.row]
    apart = np.maximum(np.abs(old.end - new.end), np.abs(old.z_end - new.z_end))
    differs = ~(apart <= steps_of + np.abs(old.end) * np.radians(ANGLE))
    differs |= traces[0].axes.motion[old.row] != traces[1].axes.motion[new.row]
    differs |= feed_differs(old, moves, new, moves, FEED_SHARE)
    yield from (refusal_at(traces[0], row, "X, Z, C or F would differ") for row in old.row[differs][:1].tolist())


def changed_meanings(
    old: Trace, new: Trace, decided: Collection[int], added_speeds: Collection[int], origin: Sequence[int]
) -> Iterator[Refusal]:
    """
    Yield the orders that a program for another machine lacks at their place in the order, and the first speed that
    differs.
    """
    ordered = [step for step in meaning_steps(old) if step.line not in decided]
    for difference in order_differences(ordered, meaning_steps(new), DWELL):
        if difference.old_line is not None:
            yield refusal_of(difference)
    if names_speeds(old) and names_speeds(new):
        left_out = {*decided, *added_speeds}
        before = [step for step in speed_steps(old) if step.line not in left_out]
        after = [step for step in speed_steps(new) if line_of(origin, step.line) not in left_out]
        for difference in order_differences(before, after, SPEED)[:1]:
            yield refusal_of(difference)


def line_of(origin: Sequence[int], line: int) -> int:
    """Return the line of the original for a line of the new program; 0 where there is none."""
    return origin[line - 1] if 0 < line <= len(origin) else 0
