"""Finds where a section is entered above the part, with C at 0, so that its coordinates are those of the drawing."""

from __future__ import annotations

import msgspec
import numpy as np

from polarcheck.columns.trace import Trace
from polarcheck.foundation.arrays import stretch
from polarcheck.foundation.states import FeedMode, Motion
from polarcheck.rewrite.roll.following import Following
from polarcheck.rewrite.roll.rollable import Stretch
from polarcheck.rewrite.roll.ways import AxisMoves
from polarcheck.rules.editing import is_plain, words_of

#: C counts as 0 within this distance of a full turn [deg].
_AT_ZERO = 1e-9
#: The least X, as a radius, at which C may be turned back to the angle of the stretch [mm].
_NEAREST = 0.5
#: Lists of G codes that may stand between the positioning and the stretch.
_CODES = ("rapid", "line", "feed_inverse_time", "feed_per_minute", "absolute")
#: The most rows before the stretch that are searched for the positioning.
_MOST_ROWS = 30


class Entry(msgspec.Struct, frozen=True):
    """
    A section that is entered above the part, with C at full turns.

    behind: the row after which the mode is switched on.
    first: the first of the rows of only Z, within the mode, that lead down to the stretch.
    turns: C at the entry [deg].
    c_word: the C word of row `behind`, which gets that angle; -1 if a new block positions C.
    """

    behind: int
    first: int
    turns: float
    c_word: int


def entry_of(trace: Trace, candidate: Stretch, moves: AxisMoves, following: Following) -> Entry | None:
    """
    Return how a section can be entered with C at 0; None if it starts there, or cannot.

    It can if the tool is positioned in rapid traverse above everything that the stretch cuts, and only moves of Z
    follow: C turns at that X, above the part.
    """
    path = trace.path
    angle = float(path.c_angle_before[candidate.first])
    turns = 360.0 * round(angle / 360)
    if trace.machine.polar.plane_is_fixed or abs(angle - turns) <= _AT_ZERO:
        return None
    low = max(candidate.first - _MOST_ROWS, 0)
    remaining = [row for row in range(low, candidate.first) if not _is_of_z(trace, row)]
    begin = remaining[-1] + 1 if remaining else low
    highest = max(float(moves.z.max()), float(moves.z_before.max()))
    moving = begin + np.flatnonzero(trace.axes.motion[begin : candidate.first] != Motion.NONE)
    above = moving[path.z_before[moving] > highest]
    if not len(above) or path.x_before[candidate.first] < _NEAREST:
        return None
    first = int(above[-1])
    entry_row = first - 1
    before = int(following.moves.searchsorted(entry_row, "right")) - 1
    last = int(following.moves[before]) if before >= 0 else -1
    is_rapid = last >= 0 and trace.axes.motion[last] == Motion.RAPID and trace.mode.whole_section[last] < 0
    if (
        not (is_rapid and _goes_on(trace, entry_row, candidate.first))
        or following.jump_targets[entry_row : candidate.first + 1].any()
    ):
        return None
    return Entry(entry_row, first, turns, _c_word(trace, entry_row))


def _goes_on(trace: Trace, entry_row: int, first: int) -> bool:
    """Return True if the rows stand on their own lines, in ascending order, in one program."""
    rows = slice(entry_row, first + 1)
    block, line, depth = trace.run.block[rows], trace.blocks.line_in_file[rows], trace.run.depth[rows]
    return bool(np.all(np.diff(block) > 0) and line[1] > line[0] and np.all(depth == depth[0]))


def _is_of_z(trace: Trace, row: int) -> bool:
    """Return True for a row that has only Z, or only codes for the following moves."""
    run, machine = trace.run, trace.machine
    low, high = stretch(run.row, row, row + 1)
    letters = {int(letter) for letter in run.words.address[low:high]}
    allowed = {machine.address_number(name) for name in ("N", "Z", "W", "F", "G")}
    codes = {code for key in _CODES for code in machine.codes(key)}
    motion = trace.axes.motion[row]
    if not letters <= allowed or run.unknown[row] or trace.blocks.starts[row] or not is_plain(run, row):
        return False
    if any(f"G{run.words.value[index]:g}" not in codes for index in range(low, high) if run.words.address[index] == 71):
        return False
    if trace.mode.whole_section[row] >= 0 or np.isnan(trace.path.z[row]):
        return False
    is_per_minute = trace.feedrate.modal_feed_mode[row] == FeedMode.PER_MINUTE and trace.feedrate.written_feed[row] > 0
    return bool(motion in (Motion.NONE, Motion.RAPID) or (motion == Motion.LINE and is_per_minute))


def _c_word(trace: Trace, row: int) -> int:
    """Return the index of the C word of a row if its number may be replaced; otherwise -1."""
    run, machine = trace.run, trace.machine
    axis = machine.polar.rotary_address
    number = machine.address_number(axis)
    is_other = trace.modal.is_step(axis)[row] or trace.run.distance is not None
    if is_other or len(axis) > 1 or trace.axes.motion[row] != Motion.RAPID or not is_plain(run, row):
        return -1
    c_words = [index for index in words_of(run, row) if run.words.address[index] == number]
    letters = {chr(int(run.words.address[index])) for index in words_of(run, row)}
    return c_words[0] if len(c_words) == 1 and letters <= {axis, "X", "Z", "N", "G"} else -1
