"""The unit of a comparison, a polar section or the blocks between two of them: its path, its feeds and its orders."""

from __future__ import annotations

from collections.abc import Sequence

import msgspec
import numpy as np

from polarcheck.checking.not_known import position_not_known
from polarcheck.columns.filling import before, happened
from polarcheck.columns.path.moves import Moves, programmed_moves, z_along
from polarcheck.columns.path.standing_moves import with_z_alone
from polarcheck.columns.path.tool_center import ToolCenter
from polarcheck.columns.trace import Trace
from polarcheck.foundation.arrays import Floats, Mask, Points, Rows, States
from polarcheck.foundation.states import FeedMode, Motion
from polarcheck.geometry import polar
from polarcheck.geometry.plane_path import SpacePath
from polarcheck.rewrite.compare.orders import Step, feed_step, special_rows
from polarcheck.rewrite.compare.terms import Terms
from polarcheck.rewrite.writing.outcome import radius_not_known
from polarcheck.rules.quantity import Quantity, in_row
from polarcheck.rules.repair import FEED, WAY, Z

#: Angles less than this below a full turn count as 0 [deg].
_NEAR_TURN = 0.01
NOWHERE = complex("nan+nanj")


class FedPath(SpacePath, frozen=True):
    """
    Moves of the tool in space, in the order in which they run.

    row: row of the trace of each move, or the line of its block. rapid: it is in rapid traverse. feed_mode: FeedMode.
    feed: F in force [mm per min or revolution], NaN without one.
    """

    row: Rows
    rapid: Mask
    feed_mode: States
    feed: Floats

    def position(self, row: int) -> tuple[float, float, float]:
        """Return x, y and z of the tool before a row of the trace; NaN where nothing moves."""
        if not len(self):
            return np.nan, np.nan, np.nan
        move = int(np.searchsorted(self.row, row)) - 1
        point, z = (self.start[0], self.z_start[0]) if move < 0 else (self.end[move], self.z_end[move])
        return float(point.real), float(point.imag), float(z)


class Stretch(msgspec.Struct, frozen=True):
    """
    A polar section, or the blocks between two sections.

    trace: of its program. section: number of the section, -1 outside.
    rows: rows of the trace.
    path: inside a section plane points on the part, with Z; outside Z + 1j*X, with C in the place of Z.
    steps: the orders beside the moves.
    knows_z: Z is written anywhere; always True outside.
    c_scale: outside sections the length that stands for one degree of C in the path.
    is_rewritten: C is compared at feed only.
    needs: why a move is not known; empty if all are.
    as_programmed: why the path is the programmed one, as R is missing; empty if it is that of the tool center.
    """

    trace: Trace
    section: int
    rows: Rows
    path: FedPath
    steps: Sequence[Step]
    knows_z: bool = True
    c_scale: float = 1.0
    is_rewritten: bool = False
    needs: str = ""
    as_programmed: str = ""

    def line(self, row: int) -> int:
        """Return the line of a row in the file."""
        return self.trace.line(row)

    def quantity(self, value: float, row: int) -> Quantity:
        """Return a value of a row in the units of its program."""
        return in_row(value, self.trace.lengths, row)

    @property
    def enter(self) -> int:
        """The row that switches the mode of a section on."""
        return int(self.trace.mode.sections.enter[self.section])

    @property
    def known(self) -> Stretch:
        """The same with its known moves alone."""
        return msgspec.structs.replace(self, path=self.path[self.path.is_known])


def of_sections(trace: Trace, tool_center: ToolCenter, steps: Sequence[Step], terms: Terms) -> list[Stretch]:
    """
    Return the polar sections in order, without what may change.

    The speed of the tool center on the plane differs from F where F is along the contour, or along X, C and Z.
    """
    if not len(trace.mode.sections):
        return []
    of_tool, _ = with_z_alone(trace, tool_center.moves)
    plain, _ = with_z_alone(trace, programmed_moves(trace))
    steps_of = _by_section(trace, steps)
    of_tool, plain = (_without_changes(trace, moves, terms) for moves in (of_tool, plain))
    result = []
    for number in range(len(trace.mode.sections)):
        low, high = np.searchsorted(of_tool.section, (number, number + 1)).tolist()
        moves = of_tool[low:high]
        missing = moves.row[~moves.is_of_tool & np.isnan(trace.compensation.radius_of_move[moves.row])]
        needs = as_programmed = ""
        if len(missing):
            row = int(missing[0])
            as_programmed = radius_not_known(trace, row)
            low, high = np.searchsorted(plain.section, (number, number + 1)).tolist()
            moves = plain[low:high]
        turned, knows_z = _turned(trace, moves, number)
        if not turned.is_known.all() and not (turned := _from_unknown(trace, turned, moves.row)).is_known.all():
            needs = position_not_known(trace, int(moves.row[np.argmin(turned.is_known)]))
        path = _with_feeds(trace, turned, moves.row, terms, in_section=True)
        if terms.is_rewritten:
            path = msgspec.structs.replace(path, feed=path.feed * moves.plane_share)
        rows, orders = np.flatnonzero(trace.mode.section == number), steps_of.get(number, ())
        stretch = Stretch(trace, number, rows, path, orders, knows_z, needs=needs, as_programmed=as_programmed)
        result.append(stretch)
    return result


def _without_changes(trace: Trace, moves: Moves, terms: Terms) -> Moves:
    """Return the moves without those whose way may change, and without Z alone where Z may."""
    if not terms.changes:
        return moves
    rows = np.unique(moves.row)
    changed = np.flatnonzero(terms.may_change(trace, WAY)[rows])
    may_change = np.isin(moves.row, rows[np.union1d(changed, np.maximum(changed - 1, 0))])
    return moves[~(may_change | (moves.is_still & terms.may_change(trace, Z)[moves.row]))]


def _by_section(trace: Trace, steps: Sequence[Step]) -> dict[int, list[Step]]:
    by_section: dict[int, list[Step]] = {}
    for step in steps:
        by_section.setdefault(int(trace.mode.section[step.row]), []).append(step)
    return by_section


def _with_feeds(trace: Trace, path: SpacePath, row: Rows, terms: Terms, *, in_section: bool) -> FedPath:
    """Return a path with the rows of its moves, and with F and rapid traverse there but where they may change."""
    mode = trace.feedrate.feed_mode[row]
    feed = np.where(mode == FeedMode.PER_MINUTE, trace.feedrate.feed[row], trace.feedrate.feed_number[row])
    rapid, z = trace.axes.motion[row] == Motion.RAPID, (path.z_start, path.z_end)
    if terms.changes:
        may_change = terms.may_change(trace, FEED)[row]
        feed, rapid = np.where(may_change, np.nan, feed), rapid & ~may_change
        if in_section:
            is_level = terms.may_change(trace, Z)[row]
            z = np.where(is_level, 0.0, z[0]), np.where(is_level, 0.0, z[1])
    return FedPath(*path.shape, *z, row, rapid, mode, feed)


def _turned(trace: Trace, moves: Moves, section: int) -> tuple[SpacePath, bool]:
    """Return the path in the frame of the part, and True if Z is known; otherwise Z is 0."""
    turn = complex(trace.path.section_turn[section])
    z_from, z_to = z_along(trace, moves)
    knows_z = not len(moves) or not (np.isnan(z_from).all() and np.isnan(z_to).all())
    if not knows_z:
        z_from = z_to = np.zeros(len(moves))
    return SpacePath(*moves.turned_by(turn).shape, z_from, z_to), knows_z


def _from_unknown(trace: Trace, path: SpacePath, row: Rows) -> SpacePath:
    """Let rapid traverse at the beginning of a section begin at its first known point, as where it leads outside."""
    first = int(np.argmin(np.append(trace.axes.motion[row] == Motion.RAPID, False)))
    start, end, z_start, z_end = path.start.copy(), path.end.copy(), path.z_start.copy(), path.z_end.copy()
    of_lead = slice(0, first + 1)
    for begins, ends in ((start.real, end.real), (start.imag, end.imag), (z_start, z_end)):
        if not np.isnan(begins[first] if first < len(path) else ends[-1]):
            begins[of_lead], ends[of_lead] = _without_unknown(begins[of_lead], ends[of_lead])
    return msgspec.structs.replace(path, start=start, end=end, z_start=z_start, z_end=z_end)


def outside(trace: Trace, steps: Sequence[Step], rows: Rows, terms: Terms) -> Stretch:
    """
    Return what lies outside sections in these rows.

    terms: C is scaled so that the tolerance of angles counts as much as that of lengths.
    """
    rows = rows[trace.mode.section[rows] < 0]
    left_out = np.isin(trace.blocks.line_in_file, list(terms.left_out))
    # Behind a block that is left out the tool comes from elsewhere to where the old program has it already.
    arrives = happened(left_out, trace.path.moves & ~left_out) & trace.blocks.has(*trace.machine.axis_words)
    goes = np.isin(trace.axes.motion, (Motion.RAPID, Motion.LINE, Motion.CW, Motion.CCW))
    goes &= trace.path.moves | arrives
    # Before the first G0 or G1 axis words move as the control has it at power-on.
    goes |= (trace.axes.motion == Motion.NONE) & (trace.path.moves_x | trace.path.moves_z | trace.path.moves_c)
    moving = (goes & ~special_rows(trace))[rows]
    is_left_out = left_out[rows]
    row = rows[moving & ~is_left_out]
    starts, path = trace.blocks.starts, trace.path
    earlier = [before(column, starts, np.nan) for column in (path.x, path.z, path.c_angle)]
    # At its end in a section X counts on the plane; the mode is left with X where the machine stands.
    left = np.flatnonzero((trace.mode.section < 0) & (before(trace.mode.section, starts, -1) >= 0))
    earlier[0][left] = np.abs(path.end[left - 1])
    columns = [(column[row], after[row]) for column, after in zip(earlier, (path.x, path.z, path.c_angle), strict=True)]
    needs, of_unknown = "", list[Step]()
    written = (("X", "U"), ("Z", "W"), trace.machine.polar.rotary_words)
    comes_from_unknown = np.zeros(len(row), bool)
    for (begins, after), words in zip(columns, written, strict=True):
        is_named = trace.blocks.has(*words)[row]
        comes_from_unknown |= np.isnan(begins) & is_named
        lost = np.isnan(after) & is_named
        if lost.any() and not terms.is_kept:
            distance = _distance(trace, words)[row]
            by_distance = np.flatnonzero(lost & ~np.isnan(distance))
            of_unknown += [
                _step_by(trace, words[1], at, by)
                for at, by in zip(row[by_distance].tolist(), distance[by_distance].tolist(), strict=True)
                if by
            ]
            lost[by_distance] = False
        if lost.any() and not needs:
            needs = f"{words[0]} of line {trace.line(row[np.argmax(lost)])} is not known"
    if terms.is_rewritten and len(rows):
        positions = [column[rows[0]] for column in earlier]
        named = [trace.blocks.has(*words)[row] for words in written]
        columns = [
            _following_on(here, np.where(names, end, np.nan))
            for here, (_, end), names in zip(positions, columns, named, strict=True)
        ]
        if not np.isnan(direction := _direction_behind(trace, int(rows[-1]))):
            # The angle beside the switch that ends these rows stands for a move of C there.
            columns[2][1][-1:] = direction
    (x_from, x_to), (z_from, z_to) = (_without_unknown(*column) for column in columns[:2])
    c_from, c_to = _without_unknown(*columns[2])
    if terms.is_rewritten:
        turn = c_to - c_from
        turn -= 360 * np.round((turn - np.nan_to_num(path.c_turn[row])) / 360)
        c_from, c_to = _at_feed_alone(trace, row, left_out, c_from, c_from + turn)
    else:
        c_from, c_to = _continuous(c_from, c_to, path.c_turn[row])
    # C counts in the sense of the plane, which is not that of C on each lathe.
    scale = terms.tolerance / terms.angle * trace.path.c_axis.sense
    start, end = z_from + 1j * x_from, z_to + 1j * x_to
    kind = trace.axes.motion[row].astype(np.int16)
    center = _centers(trace, row, start, end, kind)
    kind = np.where(np.isnan(center), Motion.LINE, kind).astype(np.int16)
    of_stretch = SpacePath(start, end, center, kind, c_from * scale, c_to * scale)
    rows_kept = set(rows[~is_left_out].tolist())
    steps = [step for step in steps if step.row in rows_kept]
    fed = _with_feeds(trace, of_stretch, row, terms, in_section=False)
    if not terms.is_kept:
        # Such a move has no length in the path, along which F is compared.
        feeds = [feed_step(trace, int(row[move])) for move in np.flatnonzero(comes_from_unknown & ~fed.rapid).tolist()]
        steps = sorted([*steps, *of_unknown, *feeds], key=lambda step: step.row)
    return Stretch(trace, -1, rows, fed, steps, c_scale=scale, is_rewritten=terms.is_rewritten, needs=needs)


def _distance(trace: Trace, words: tuple[str, str]) -> Floats:
    """Return the distance that each row goes along an axis by increments [mm or deg]; NaN without one."""
    axis = words[0]
    lengths, is_rotary = trace.lengths, words == trace.machine.polar.rotary_words
    values = [trace.coordinates.angle_of(word) if is_rotary else lengths.length_of(word) for word in words]
    distance = np.where(trace.modal.is_step(axis), values[0], np.where(trace.blocks.has(axis), np.nan, values[1]))
    return np.asarray(distance * lengths.x_factor if axis == "X" else distance)


def _step_by(trace: Trace, word: str, row: int, distance: float) -> Step:
    """Return a distance from a position that is not known as an order."""
    text = f"{word}{distance:.10g} from where it is not known"
    return Step(row, trace.line(row), (f"{word} from an unknown position",), (distance,), text)


def _direction_behind(trace: Trace, row: int) -> float:
    """Return the C angle beside a switch in the next row [deg]; NaN where there is none."""
    following = slice(row + 1, row + 2)
    angle = trace.path.c_angle[following][trace.mode.enters_with_direction[following]]
    return float(angle[0]) if len(angle) else np.nan


def _without_unknown(start: Floats, end: Floats) -> tuple[Floats, Floats]:
    """
    Fill unknown positions of an axis with its next known one, those after the last with the last; all with 0 if none is
    known.
    """
    values = np.column_stack((start, end)).ravel()
    known_rows = np.flatnonzero(~np.isnan(values))
    if not len(known_rows):
        return np.zeros(len(start)), np.zeros(len(end))
    following = known_rows[np.minimum(np.searchsorted(known_rows, np.arange(len(values))), len(known_rows) - 1)]
    filled = values[following]
    return filled[::2], filled[1::2]


def _following_on(here: float, end: Floats) -> tuple[Floats, Floats]:
    """
    Let each move begin where the previous one ends, and an axis that it does not name stay at its last named position.

    here: position of the axis before the first move; NaN if it is not known.
    """
    known_rows = np.flatnonzero(~np.isnan(end))
    if len(known_rows):
        last = np.searchsorted(known_rows, np.arange(len(end)), side="right") - 1
        end = np.where(last < 0, here, end[known_rows[np.maximum(last, 0)]])
    return np.append(here, end)[: len(end)], end


def _at_feed_alone(trace: Trace, row: Rows, left_out: Mask, start: Floats, end: Floats) -> tuple[Floats, Floats]:
    """
    Return C within one turn; in a run of moves in rapid traverse all have the C of the last.

    Which of these moves turns C, and over how many full turns, depends on the control.
    """
    sense = trace.path.c_axis.sense
    begin = (sense * start + _NEAR_TURN) % 360 - _NEAR_TURN
    finish = begin + sense * (end - start)
    stops = np.append(trace.axes.motion[row] != Motion.RAPID, True)[: len(row)]
    stops[-1:] = True
    cycles = np.cumsum(trace.modal.in_cycle & ~left_out)
    stops[:-1] |= np.diff(cycles[row]) > 0
    last = np.flatnonzero(stops)[np.searchsorted(np.flatnonzero(stops), np.arange(len(row)))] if len(row) else row
    is_rapid = trace.axes.motion[row] == Motion.RAPID
    # A run of rapid traverse that ends with a move at feed has the C with which that begins.
    angle = np.where(is_rapid[last], finish[last], begin[last])
    angle = (angle + _NEAR_TURN) % 360 - _NEAR_TURN
    return sense * np.where(is_rapid, angle, begin), sense * np.where(is_rapid, angle, finish)


def _continuous(start: Floats, end: Floats, turn: Floats) -> tuple[Floats, Floats]:
    """
    Return C as it turns: where it rolls over, it takes the shorter way to an angle, and 360 deg more are the same
    position.
    """
    end = np.where(np.isnan(turn), end, start + turn)
    jump = start - np.append(start[:1], end[:-1])
    turns = 360 * np.cumsum(np.round(jump / 360))
    return start - turns, end - turns


def _centers(trace: Trace, row: Rows, start: Points, end: Points, kind: States) -> Points:
    """
    Return the centers of arcs in the plane of X and Z, from I and K or from the radius; NaN for lines and without
    either.
    """
    addresses = ("I", "K", trace.machine.arcs.radius_word)
    i, k, radius = (trace.lengths.length_of(address)[row] for address in addresses)
    is_arc = (kind == Motion.CW) | (kind == Motion.CCW)
    by_radius = polar.center_from_radius(start, end, radius, kind, 0.01)
    by_words = start + np.nan_to_num(k) + 1j * np.nan_to_num(i)
    has_words = ~np.isnan(i) | ~np.isnan(k)
    return np.where(is_arc, np.where(has_words, by_words, by_radius), NOWHERE)
