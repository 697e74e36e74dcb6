"""Why polar sections cannot be written for another machine."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from polarcheck.checking.not_known import position_not_known
from polarcheck.columns.path.moves import Moves
from polarcheck.columns.trace import Trace
from polarcheck.foundation.states import FeedMode
from polarcheck.program.machines.machine import Machine
from polarcheck.rewrite.convert.doubtful_values import Basis
from polarcheck.rewrite.writing.original import Original
from polarcheck.rewrite.writing.outcome import Refusal
from polarcheck.rewrite.writing.refused_sections import (
    Check,
    checks_of_sections,
    checks_of_switches,
    refusals_in_sections,
)

#: Shares of F that differ by less, by the larger one, are the same.
_SAME_SHARE = 1e-9


class SectionFeeds:
    """
    The feeds of a program on another machine.

    moves: moves of the tool center. basis: takes the keys on which changed feeds rest.

    One machine measures F on the plane, another along the path in space; one at the tool center, another at the contour
    (polar.feed_measures, codes of feed_at_contour).
    """

    def __init__(self, trace: Trace, moves: Moves, target: Machine, basis: Basis) -> None:
        self._basis = basis
        share, length = np.ones(len(trace)), np.zeros(len(trace))
        of_contour = ~moves.corner & ~np.isnan(moves.plane_share)
        share[moves.row[of_contour]] = moves.plane_share[of_contour]
        np.add.at(length, moves.row, np.nan_to_num(moves.length))
        # The share of F with which the tool center will run on the plane.
        target_share, path = np.ones(len(trace)), trace.path
        if target.polar.feed_measures == "space":
            rises = np.flatnonzero(path.moves_z & (length > 0) & ~np.isnan(path.z - path.z_before))
            target_share[rises] = length[rises] / np.hypot(length, path.z - path.z_before)[rises]
        feedrate = trace.feedrate
        is_per_minute = feedrate.feed_mode == FeedMode.PER_MINUTE
        feed = np.where(is_per_minute, feedrate.programmed_feed, feedrate.feed_number)
        differs = (np.abs(share - target_share) > _SAME_SHARE * np.maximum(share, target_share)) & ~np.isnan(feed)
        self._differs = set(np.flatnonzero(differs).tolist())
        self._feed: list[float] = np.where(differs, feed * share / target_share, feed).tolist()

    def of_row(self, row: int) -> float | None:
        """F of a row [mm/min, or mm per revolution]; None where none is in force."""
        feed = self._feed[row]
        if row in self._differs:
            self._basis.add("polar.feed_measures", row)
        return None if math.isnan(feed) else feed


def refusals(original: Original, is_same: bool, why_not: Callable[[int], str]) -> list[Refusal]:
    """
    Return the reasons, each once a section, in the order of lines.

    is_same: the words of sections stay as they are, so that it does not matter what they come to. why_not: of a row,
    why it becomes a comment as it is; empty for others.
    """
    trace = original.trace
    of_section = [*checks_of_sections(trace, trace.mode.is_followed), *_of_rows(trace)]
    reasons = list(refusals_in_sections(trace, checks_of_switches(trace) if is_same else of_section))
    if not is_same:
        reasons += [reason for row, reason in original.unpointed if not why_not(row)]
    return sorted(dict.fromkeys(reasons), key=lambda reason: reason.line)


def _of_rows(trace: Trace) -> list[Check]:
    path, mode = trace.path, trace.mode
    moving = path.travels & mode.in_polar
    # Where the tool stands before a line does not matter: posts of some controls position it behind the switch.
    unknown = moving & (np.isnan(path.end) | (path.is_arc & np.isnan(path.start)))
    off_by = np.abs(np.abs(path.start - path.center) - np.abs(path.end - path.center))
    off_circle = path.is_arc & moving & (off_by > trace.machine.arcs.tolerance)
    on_sub_spindle = trace.modal.on_sub_spindle & mode.enters
    feed_mode = trace.feedrate.modal_feed_mode
    return [
        (on_sub_spindle, "the sub-spindle turns the plane, Z and G41 round by builder: convert its sections by hand"),
        (unknown, position_not_known),
        (off_circle, "this arc does not end on its circle"),
        (path.is_arc & moving & np.isnan(path.center), "the center of this arc is not known"),
        (mode.enters & (path.frames is not None), "the program shifts or turns its coordinates by frames"),
        ((feed_mode == FeedMode.INVERSE_TIME) & moving, "inverse time in the mode is not converted"),
    ]
