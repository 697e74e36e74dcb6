"""Finds stretches milled by plain moves of X and C, and why some of them cannot become a polar section."""

from __future__ import annotations

from collections.abc import Iterator

import msgspec
import numpy as np

from polarcheck.columns.trace import Trace
from polarcheck.foundation.arrays import Mask, Rows, column_at, mask_at
from polarcheck.foundation.states import Distance, FeedMode, Motion, Side
from polarcheck.program.machines.code_tables import code_set
from polarcheck.rewrite.roll.following import Following
from polarcheck.rewrite.writing.outcome import Refusal, refusal_at
from polarcheck.rewrite.writing.unknown_moves import UnknownMoves

#: The least blocks of X and C in a stretch: for fewer, the section would need as many blocks of its own.
LEAST = 8
#: Lists of G codes that may stand in a block of a stretch: what they say is in the moves, or does not matter there.
_CODES = ("line", "feed_inverse_time", "feed_per_minute", "absolute")
#: A radius within this distance of zero counts as zero [mm].
_ZERO = 1e-6
#: The most that C turns in one block of a contour [deg].
_STEP = 30.0
_UNWINDS = (
    "C turns back by nearly a turn here: on a lathe that takes the shorter way, --set control.rotary_rolls_over=true "
    "or its machine file says so"
)
_ON_CYLINDER = "C and Z move together and X stands: that is milling on the cylinder, not on the face"


class Stretch(msgspec.Struct, frozen=True):
    """
    Consecutive blocks in which X and C move at feed, beginning and ending with such a block.

    first, last: rows of the trace. line: of the first, in the file, from 1. last_line: of the last.
    """

    first: int
    last: int
    line: int
    last_line: int

    def rows(self, trace: Trace) -> Rows:
        """Its rows that move, or name the place where the tool stands."""
        rows = np.arange(self.first, self.last + 1)
        return np.asarray(rows[trace.axes.motion[rows] != Motion.NONE])


def stretches(trace: Trace, following: Following) -> tuple[list[Stretch], list[Refusal]]:
    """Return the stretches that can become sections, and the reasons why the others cannot."""
    reasons = _reasons(trace, following)
    result: list[Stretch] = []
    refusals: list[Refusal] = []
    for candidate in _candidates(trace):
        reason = _first_reason(trace, candidate, reasons) or _reason_at_ends(trace, candidate, following)
        if reason is None:
            result.append(candidate)
        else:
            refusals.append(reason)
    return result, refusals


def _candidates(trace: Trace) -> Iterator[Stretch]:
    belongs = _belongs(trace)
    breaks = np.flatnonzero(~belongs | _jumps(trace))
    begin = 0
    for end in [*breaks.tolist(), len(trace)]:
        if end - begin >= LEAST:
            yield from _within(trace, begin, end)
        # A row that breaks because of what stands before it may begin the next stretch.
        begin = end if end < len(trace) and belongs[end] else end + 1


def _within(trace: Trace, begin: int, end: int) -> Iterator[Stretch]:
    """Stretches of rows that belong together: runs on the plane, parted by Z alone, without approaches and retracts."""
    path, lines = trace.path, trace.blocks.line_in_file
    rows = np.arange(begin, end)
    turns, moves_x, moves_z = path.moves_c[rows], path.moves_x[rows], path.moves_z[rows]
    on_plane = turns | moves_x
    run = np.cumsum(moves_z & ~on_plane)
    count = np.bincount(run, on_plane)
    mills = count >= LEAST
    # X and C that go together to another place, with Z above, are no contour.
    goes = turns & moves_x & (np.abs(np.nan_to_num(path.c_turn[rows])) > _STEP)
    parts = ~mills & (np.bincount(run, goes, minlength=len(count)) > 0)
    # Where a stretch begins or ends, X beside Z alone is turning, or an approach.
    bounds = (turns | (moves_x & ~moves_z)) & mills[run]
    group = np.cumsum(parts)[run]
    for rows_of_group in np.split(rows, np.flatnonzero(np.diff(group)) + 1):
        ends = rows_of_group[bounds[rows_of_group - begin]]
        if (
            len(ends)
            and turns[(chosen := slice(ends[0] - begin, ends[-1] + 1 - begin))].any()
            and moves_x[chosen].any()
        ):
            first, last = int(ends[0]), int(ends[-1])
            yield Stretch(first, last, int(lines[first]), int(lines[last]))


def _belongs(trace: Trace) -> Mask:
    """
    Return a mask of the rows outside the mode that may be in a stretch: straight moves at feed without other words, and
    rows that do not move.
    """
    blocks, machine, words = trace.blocks, trace.machine, trace.run.words
    rotary = machine.polar.rotary_words
    names = [name for name in ("N", "X", "U", "Z", "W", "F", *rotary) if name]
    is_known = mask_at(256, [machine.address_number(name) for name in names])
    allowed = is_known[words.address]
    codes = code_set([code for key in _CODES for code in machine.codes(key)])
    allowed[blocks.g_words] = codes[blocks.g_codes]
    has_other_words = blocks.with_words(~allowed)
    lines = (trace.axes.motion == Motion.LINE) & trace.modal.uses_axes & ~trace.modal.in_cycle
    none = trace.axes.motion == Motion.NONE
    return np.asarray((lines | none) & ~has_other_words & (trace.mode.whole_section < 0) & ~trace.run.unknown)


def _jumps(trace: Trace) -> Mask:
    """Rows before which the program does not simply go on to the next block."""
    run, text = trace.run, trace.text
    is_full = text.blocks.is_macro.copy()
    is_full[text.words.block] = True
    full = np.append(0, np.cumsum(is_full))
    block, before = run.block[1:], run.block[:-1]
    goes_on = (block > before) & (full[block] - full[np.minimum(before + 1, len(is_full))] == 0)
    goes_on &= run.depth[1:] == run.depth[:-1]
    return np.append(True, ~goes_on)[: len(trace)] | trace.blocks.starts


def _reasons(trace: Trace, following: Following) -> list[tuple[Mask, str]]:
    """Rows that keep a stretch from being rolled, each with the reason, in the order in which they are looked at."""
    run, path, modal, feedrate = trace.run, trace.path, trace.modal, trace.feedrate
    moves = trace.axes.motion == Motion.LINE
    travels = path.moves_x | path.moves_c | path.moves_z
    on_sub_spindle = modal.on_sub_spindle & (trace.machine.polar.sub_spindle_plane != "as-main")
    with_z = path.moves_z & (path.moves_x | path.moves_c)
    not_with_z = with_z & (trace.machine.polar.other_axes != "together")
    mode = feedrate.modal_feed_mode
    lost = UnknownMoves(trace).lost
    without_f = (mode == FeedMode.INVERSE_TIME) & ~trace.blocks.has("F")
    return [
        (np.bincount(run.block, minlength=1)[run.block] > 1, "its blocks run several times"),
        (_is_computed(trace), "its blocks are computed"),
        (trace.mode.contours_outside, "C beside this code is no plain move: the control follows the contour by itself"),
        (following.jump_targets, "a jump may lead to this block"),
        (modal.state("distance") == Distance.INCREMENTAL, "distances are in force, not coordinates"),
        (trace.compensation.side != Side.OFF, "cutter compensation is in force: X and C are not the path of the tool"),
        (modal.state("modal_call") != 0, "a program is called after each move"),
        (on_sub_spindle, "which way C turns in the mode on the sub-spindle is not known"),
        (moves & (np.isnan(path.x) | np.isnan(path.x_before) | lost("X")), "X is not known where it begins"),
        (
            path.moves_c & (np.isnan(path.c_turn) | lost(trace.machine.polar.rotary_address)),
            "C is not known where it begins: position it before, as C0",
        ),
        (_unwinds(trace), _UNWINDS),
        (moves & np.isnan(path.z) & bool(np.isfinite(path.z).any()), "Z is not known where it begins"),
        (with_z & (np.isnan(path.z_before) | lost("Z")), "Z is not known where it begins to move"),
        (np.nan_to_num(path.local_shift) != 0, "the origin is shifted off the center of C"),
        (travels & (mode == FeedMode.PER_REVOLUTION), "F is per revolution"),
        (travels & without_f, "F is missing, which inverse time has in every block"),
        (travels & ~(feedrate.written_feed > 0), "F is missing"),
        (not_with_z & path.moves_c & ~path.moves_x, _ON_CYLINDER),
        (not_with_z, f"Z moves beside X and C, with which it is not interpolated in the mode: {trace.machine.title}"),
        (
            trace.blocks.with_words(trace.coordinates.is_taken_as_pointed),
            "a number has no point, and counts increments",
        ),
    ]


def _unwinds(trace: Trace) -> Mask:
    """
    Return a mask of the rows in which C turns back by nearly a full turn, where the shorter way would continue the
    previous turn.
    """
    turn = np.where(trace.path.moves_c & (trace.axes.motion == Motion.LINE), np.nan_to_num(trace.path.c_turn), 0.0)
    rows = np.flatnonzero(turn)
    turns, before = turn[rows][1:], turn[rows][:-1]
    shorter = turns - 360 * np.round(turns / 360)
    return column_at(
        len(trace),
        rows[1:],
        (np.abs(turns) > 180) & (np.abs(shorter) <= _STEP) & (shorter * before > 0) & (turns * before < 0),
        False,
    )


def _is_computed(trace: Trace) -> Mask:
    """Rows whose words do not stand in the file as they are executed."""
    run = trace.run
    words, code = run.words, trace.text.source.code
    letter = code[np.minimum(words.start, len(code) - 1)]
    letter = np.where((letter >= ord("a")) & (letter <= ord("z")), letter - 32, letter)
    named = (words.address < 128) & (letter != words.address) & (letter != ord(":"))
    return trace.blocks.with_words(named) | trace.text.blocks.is_macro[run.block]


def _first_reason(trace: Trace, candidate: Stretch, reasons: list[tuple[Mask, str]]) -> Refusal | None:
    rows = slice(candidate.first, candidate.last + 1)
    for hits, text in reasons:
        if hits[rows].any():
            row = candidate.first + int(np.argmax(hits[rows]))
            return refusal_at(trace, row, text)
    path = trace.path
    turning = path.moves_c[rows]
    round_cylinder = turning & path.moves_z[rows] & ~path.moves_x[rows]
    if np.count_nonzero(round_cylinder) > np.count_nonzero(turning) / 2:
        return Refusal(candidate.line, _ON_CYLINDER)
    return None


def _reason_at_ends(trace: Trace, candidate: Stretch, following: Following) -> Refusal | None:
    path = trace.path
    if path.x_before[candidate.first] < _ZERO:
        return Refusal(candidate.line, "X is not above zero where it begins, where the mode would be switched on")
    if path.x[candidate.last] < -_ZERO:
        return Refusal(
            candidate.last_line, "X is below zero where it ends: the mode would leave it above, and C turned"
        )
    following_row = following.behind(candidate.last, following.turns)
    if following_row < len(trace) and path.moves_c[following_row]:
        axis = trace.machine.polar.rotary_address
        if not trace.blocks.has(axis)[following_row] or trace.modal.is_step(axis)[following_row]:
            return refusal_at(
                trace, following_row, "C is programmed in increments behind it, from an angle that rounding shifts"
            )
    return None
