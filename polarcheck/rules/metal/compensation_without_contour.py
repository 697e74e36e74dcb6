from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.rules.rule import WARNING, rule

if TYPE_CHECKING:
    from polarcheck.columns.contour.misplaced_ramps import MisplacedRamps
    from polarcheck.foundation.arrays import Mask
    from polarcheck.rules.hit import Details, Hit

#: Least number of blocks that cut between two offset cancels, for the first to be the one too many.
_LEAST_BLOCKS = 2


@rule(
    WARNING,
    "{code} of this block is taken back by {early_cancel}: no block of a contour is cut with compensation; "
    "{where_ramps_belong}",
    values=("code", "other_line"),
    gouges=True,
    at=("compensation_left", "compensation_right"),
    once="section",
    subject="",
    doubts=(("compensation", "section"), ("metal", "section"), ("size", "section"), ("offset", "section")),
)
def compensation_without_contour(misplaced_ramps: MisplacedRamps) -> Mask:
    """
    Start-up that is followed at once by the offset cancel.

    The move with G41 or G42 is only the ramp onto the contour, and the next one with G40 the ramp off it. Between them
    no block is left that is cut with compensation: G41 stands a block too late, behind the ramp, or G40 follows it by
    mistake. What is cut before and after runs with the cutter center on the programmed path and is off by R.

    Source: builder's guide to G12.1, cutter compensation (ramp on, contour, ramp off).

    Bad, tool 1:radius=4:

        T0101
        G98 G0 X60. Z2. C0
        G12.1
        G1 C16. F800
        Z-5.
        X16. F100
        G41 C-16.         (expect: compensation-without-contour)
        G40 X42.
        Z2.
        G13.1

    Bad, tool 1:radius=4:

        T0101
        G98 G0 X60. Z2. C0
        G12.1
        G1 X60. F1500
        Z-5.
        G42 X40. F200     (expect: compensation-without-contour)
        G40
        C20.
        X-40.
        C-20.
        X40.
        C0
        G40 X60. F1500
        Z2.
        G13.1

    Good, tool 1:radius=4:

        T0101
        G98 G0 X60. Z2. C0
        G12.1
        G1 C16. F800
        Z-5.
        G41 X16. F100
        C-16.
        G40 X42.
        Z2.
        G13.1
    """
    # Compares nothing: which moves follow each other is a column.
    return misplaced_ramps.cancelled_at_once


def details(hit: Hit) -> Details:
    from polarcheck.rules.wording.ramps import next_row

    cancel = next_row(hit.trace.compensation.cancels, hit.row)
    return {
        "code": hit.side,
        "other_line": hit.line(cancel),
        "early_cancel": f"{hit.cancel} of line {hit.line(cancel)}",
        "where_ramps_belong": _where_ramps_belong(hit, cancel),
    }


def _where_ramps_belong(hit: Hit, first: int) -> str:
    """
    What to write where an offset cancel follows a start-up at once.

    A second G40 behind blocks that cut shows that the first stands there by mistake.
    """
    import numpy as np

    from polarcheck.rules.wording.ramps import next_row

    trace = hit.trace
    of_section = trace.mode.section == trace.mode.section[hit.row]
    again = next_row((trace.compensation.writes_cancel & of_section) | trace.compensation.starts_up, first)
    is_second = again > first and not trace.compensation.starts_up[again]
    if is_second and np.count_nonzero(trace.path.cuts[first:again]) >= _LEAST_BLOCKS:
        return f"the contour behind it is left by {hit.cancel} of line {hit.line(again)}, so delete the earlier one"
    return f"write {hit.side} into the block that leads to the contour, and {hit.cancel} into the one that leaves it"
