"""What was not evaluated, why, and what to give."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator
from typing import Any, TypeAlias

import numpy as np

from polarcheck.arrays import Floats, Mask, Rows
from polarcheck.checking.finding import NotEvaluated
from polarcheck.checking.macro_faults import reason_of
from polarcheck.checking.phrases.common import block_and_line, linear
from polarcheck.checking.phrases.drawing import compared_with
from polarcheck.checking.phrases.offsets import called_tool, example, offset, to_give
from polarcheck.checking.phrases.polar import (
    axes_not_followed,
    contours_outside,
    extrudes,
    names_not_followed,
    names_not_known,
    not_simulated,
    not_understood,
    on_cylinder,
    on_sub_spindle,
)
from polarcheck.checking.places import block_in_line
from polarcheck.checking.remedies import option_or_place, place, unlisted_codes
from polarcheck.checking.rule import Rule
from polarcheck.checking.tables import Tables
from polarcheck.geometry.tolerances import CHORDS, CROSSINGS, FARTHEST
from polarcheck.machines.machine import OwnMachine
from polarcheck.table.filling import before
from polarcheck.table.trace import Trace

#: Why a column is not known in a row.
_Reason: TypeAlias = Callable[[Tables, int], str]

#: Columns that hang on the offset in force, and those that hang on the whole move.
_OF_OFFSETS = ("trace.radius", "trace.cutter_diameter", "trace.nose")
_OF_MOVES = ("tool_center.c_feed", "tool_center.c_acceleration")
#: Columns without which a finding may be missing, but hardly is: lists of offsets have T for turning tools alone.
_WITHOUT_WEIGHT = ("trace.nose",)
#: What to give where a value of the program is not known.
_OF_VARIABLES = "give its variables as [run.variables] in polarcheck.toml, or write the number"
#: Causes, beside the offset numbers, for which a move is not known.
_POSITION, _NO_FEED, _FEED_OF_SPINDLE = -3, -2, -1
#: Contours that are named one by one; a hostile file has any number of them.
_LISTED = 20
#: Of a block that is named; more is cut off [characters].
_BLOCK_LENGTH = 40


def unexecuted(tables: Tables) -> Iterator[NotEvaluated]:
    """Blocks that were not executed."""
    trace: Trace = tables["trace"]
    language = tables["dialect"].recognised
    if language is not None:
        yield NotEvaluated(
            rule="all", reason=f"the file is written for {language.title}: convert it for this lathe", blocks=len(trace)
        )
        return
    remarks = Counter((reason_of(remark), bool(remark.values.get("matters", True))) for remark in trace.run.remarks)
    for (reason, matters), count in remarks.items():
        yield NotEvaluated(rule="all", reason=reason, blocks=count, matters=matters)
    for reason, count in (
        *axes_not_followed(trace),
        *names_not_known(trace),
        *names_not_followed(trace),
        *on_sub_spindle(trace),
        offsets_not_known(trace),
        *frames_not_simulated(trace, tables),
        *not_simulated(tables["infeed"]),
        not_understood(trace, tables["other_mode"]),
        on_cylinder(trace),
        contours_outside(trace),
        extrudes(trace),
    ):
        if count:
            yield NotEvaluated(rule="all", reason=reason, blocks=count)


def frames_not_simulated(trace: Trace, tables: Tables) -> Iterator[tuple[str, int]]:
    """The blocks that begin a frame which is not simulated, where the mode uses it, or an allowance changes in it."""
    frames = trace.frames
    if frames is not None:
        in_force = ~frames.is_known & (trace.in_polar | trace.enters)
        for row in np.flatnonzero(in_force & ~before(in_force, trace.starts, False))[:_LISTED].tolist():
            begins = np.flatnonzero(frames.is_known[: row + 1])
            first = int(begins[-1]) + 1 if len(begins) else 0
            what = f"{block_and_line(trace, first)} is not simulated"
            yield f"{what}: where the tool goes in that frame is not known", int(np.count_nonzero(in_force))
    selects = tables["mode_words"].selects_other_work_offset
    if selects.any():
        what = f"{block_and_line(trace, int(np.flatnonzero(selects)[0]))} selects another work offset in the mode"
        yield f"{what}: it is taken to lie where the one before did", int(np.count_nonzero(selects))
    changed = np.flatnonzero(trace.changes_allowance_in_offset_mode)
    if len(changed):
        what = f"{block_and_line(trace, int(changed[0]))} changes what is added to R in offset mode"
        yield f"{what}: the way from one to the other is not simulated; change it where G40 is in force", len(changed)


def offsets_not_known(trace: Trace) -> tuple[str, int]:
    """The blocks that set an offset, or a variable that may be one, nobody knows which."""
    rows = np.flatnonzero(trace.sets_unknown_offset)
    if not len(rows):
        return "", 0
    what = f"which offset {block_and_line(trace, int(rows[0]))} sets is not known"
    return f"{what}, those in force are taken as given: {_OF_VARIABLES}", len(rows)


def unevaluated(tables: Tables, rule: Rule) -> Iterator[NotEvaluated]:
    """The rows where a rule would have looked but could not, one entry for each reason."""
    trace: Trace = tables["trace"]
    for name in rule.needs:
        where: Mask = tables.column(rule.where)
        if not where.any():
            continue
        # Of sections that are not followed one entry speaks for all.
        rows = np.flatnonzero(np.isnan(tables.column(name)) & where & trace.is_followed & ~trace.sides_are_open)
        if name in _OF_MOVES:
            rows = rows[~(tables["feeds"].missing | tables["feeds"].lost)[rows]]  # a finding says so
        reasons: dict[str, int] = {}
        first, counts = _groups(_cause(trace, name, rows))
        for row, count in sorted(zip(rows[first].tolist(), counts.tolist(), strict=True)):
            reason = _REASONS.get(name, _plain(name))(tables, row)
            reasons[reason] = reasons.get(reason, 0) + count
        for reason, count in reasons.items():
            yield NotEvaluated(rule=rule.name, reason=reason, blocks=count, matters=name not in _WITHOUT_WEIGHT)
    yield from _SAID_OF.get(rule.name, _nothing)(tables, rule)


def _groups(values: Rows) -> tuple[Rows, Rows]:
    """Where each value stands first, and how often; NumPy's unique would load its masked arrays."""
    order = np.argsort(values, kind="stable")
    begins = np.flatnonzero(np.append(True, np.diff(values[order]) != 0)) if len(order) else order
    return order[begins], np.diff(np.append(begins, len(order)))


def _cause(trace: Trace, name: str, rows: Any) -> Any:
    """A number for each row, the same for the same reason."""
    if name in _OF_OFFSETS:
        return trace.offset_number[rows]
    if name in _OF_MOVES:
        stands_nowhere, has_feed = np.isnan(trace.start + trace.end)[rows], ~np.isnan(trace.feed[rows])
        of_feed = np.where(trace.per_minute[rows], _NO_FEED, _FEED_OF_SPINDLE)
        of_tool = np.where(np.isnan(trace.radius[rows]), trace.offset_number[rows], _POSITION)
        return np.where(stands_nowhere, _POSITION, np.where(has_feed, of_tool, of_feed))
    return np.zeros(len(rows), np.int64)


def _of_move(tables: Tables, row: int) -> str:
    """Why the tool center path or the speed along it is not known."""
    cause = int(_cause(tables["trace"], "tool_center.c_feed", np.array([row]))[0])
    if cause >= 0:
        return _REASONS["trace.radius"](tables, row)
    return _position(tables, row) if cause == _POSITION else _feed(tables, row)


def _nothing(tables: Tables, rule: Rule) -> Iterator[NotEvaluated]:
    return iter(())


def _c_axis_without_limit(tables: Tables, rule: Rule) -> Iterator[NotEvaluated]:
    """
    The highest rate of C, for the setter to compare, where the profile has nothing to compare it with; not where every
    C axis manages it, nor where none does, which is a finding.
    """
    trace: Trace = tables["trace"]
    c_feed: Floats = tables["tool_center"].c_feed
    rows = np.flatnonzero(tables["center"].cuts_off_center & np.isfinite(c_feed))
    limits = trace.machine.limits
    if (
        not np.isnan(limits.c_feed)
        or not limits.c_feed_harmless < np.max(c_feed[rows], initial=0) <= limits.c_feed_suspicious
    ):
        return
    at = int(rows[np.argmax(c_feed[rows])])
    line, rate, axis = int(trace.line[at]), float(c_feed[at]), trace.machine.polar.rotary_address
    reason = (
        f"{trace.machine.title} gives no limit of the {axis} axis; highest rate found {rate:.0f} deg/min, line {line}"
    )
    remedy = f"give the lathe's own, {option_or_place(trace.machine, 'limits.c_feed')}"
    yield NotEvaluated(rule=rule.name, reason=f"{reason}: {remedy}", blocks=len(rows))


def _codes_not_named(key: str, what: str) -> Callable[[Tables, Rule], Iterator[NotEvaluated]]:
    """
    On a lathe of the user's own whose file names no code of a list, though the program has some that may be one: where
    to add it. Of our own machines nobody expects to know the codes of each builder.
    """

    def found(tables: Tables, rule: Rule) -> Iterator[NotEvaluated]:
        trace: Trace = tables["trace"]
        if not isinstance(trace.machine, OwnMachine) or getattr(trace.machine.m_codes, key):
            return
        rows = np.flatnonzero(trace.enters)
        codes = [unlisted_codes(trace, tables["spindles"], int(row)) for row in rows]
        if any(codes):
            file, first = trace.machine.file, next(filter(None, codes))
            remedy = f"if {first} does, add it to {place(trace.machine, f'm_codes.{key}')}"
            count = sum(map(bool, codes))
            yield NotEvaluated(
                rule=rule.name, reason=f"{file} names no code that {what}: {remedy}", blocks=count, matters=False
            )

    return found


def _ramps_of_center(tables: Tables, rule: Rule) -> Iterator[NotEvaluated]:
    """The ramps of sections that are taken for paths of the tool center since they are all too short for a comment."""
    trace: Trace = tables["trace"]
    ramps = np.flatnonzero((trace.starts_up | trace.cancels) & trace.is_path_of_center)
    first, counts = _groups(trace.offset_number[ramps])
    for row, count in sorted(zip(ramps[first].tolist(), counts.tolist(), strict=True)):
        reason = (
            f"R of offset {offset(trace, row)} is taken as 0, since every ramp is shorter than the radius of its "
            f"comment; whether they are too short is open: {to_give(trace, row, 'radius')}"
        )
        yield NotEvaluated(rule=rule.name, reason=reason, blocks=count)


def _contours_given_up(tables: Tables, rule: Rule) -> Iterator[NotEvaluated]:
    """Loops of which nobody can say, or not in bounded time, what they leave standing."""
    overcuts = tables["overcuts"]
    crosses = f"crosses itself more than {CROSSINGS} times a block: no part can be told from it"
    far = f"reaches farther than {FARTHEST:.0f} mm from the center of C, or turns round a point far beyond"
    long = f"has arcs of more than {CHORDS} chords"
    yield from _loops_given_up(
        tables, rule, overcuts.tangled, f"{crosses}; program each contour by itself, between its own G41 or G42 and G40"
    )
    yield from _loops_given_up(tables, rule, overcuts.too_far, f"{far}: no part can be told from it; mend its words")
    yield from _loops_given_up(
        tables, rule, overcuts.too_long, f"{long}: they are too many to look at; are their R, I and J meant?"
    )


def _parts_not_compared(tables: Tables, rule: Rule) -> Iterator[NotEvaluated]:
    """What the job asks for and no contour was compared with; contours of which no part can be told."""
    deviations = tables["deviations"]
    if not deviations.parts:
        return
    crosses = f"crosses itself or others more than {CROSSINGS} times a block: no part can be told from it"
    yield from _loops_given_up(tables, rule, deviations.asked & tables["overcuts"].tangled, crosses)
    for one in deviations.comparisons:
        if one.is_partial and one.agrees:
            of_block = f"the contour of line {int(tables['trace'].line[one.row])} does not come back to where it begins"
            compared = f"was compared with {compared_with(deviations, one.number)} along its walls alone"
            reason = f"{of_block}, and {compared}: end it where it began, or beyond"
            yield NotEvaluated(rule=rule.name, reason=reason, blocks=1)
    for number, why in deviations.missing():
        reason = f"{compared_with(deviations, number)} was compared with nothing: {why}"
        rows = deviations.asked if deviations.asked.any() else tables["trace"].in_polar
        yield NotEvaluated(rule=rule.name, reason=reason, blocks=int(np.count_nonzero(rows)))


def _contours_beside(tables: Tables, rule: Rule) -> Iterator[NotEvaluated]:
    """The same for loops that only together are too hard."""
    asked = _TOGETHER[rule.name](tables)
    reason = f"crosses itself or others beside it more than {CROSSINGS} times a block: no part can be told from them"
    yield from _loops_given_up(
        tables, rule, asked & ~tables["overcuts"].tangled, f"{reason}; program fewer contours in a section"
    )


def _strips_beside(tables: Tables, rule: Rule) -> Iterator[NotEvaluated]:
    """Loops beside paths that are too long to look for what stays there, which is hardly ever amiss."""
    yield from _contours_beside(tables, rule)
    reason = "lies beside so many others, or such long paths, that nobody has looked for what stays between them"
    yield from _loops_given_up(tables, rule, tables["coverage"].too_long, reason, matters=False)


def _loops_given_up(
    tables: Tables, rule: Rule, rows: Mask, reason: str, matters: bool = True
) -> Iterator[NotEvaluated]:
    """An entry for each loop of these rows, one for all of them from some number on."""
    trace: Trace = tables["trace"]
    at = np.flatnonzero(rows & tables["ramps"].compensated)
    if not len(at):
        return
    first, counts = _groups(tables["ramps"].loop[at])
    order = np.argsort(first)
    for number, count in zip(at[first[order]][:_LISTED].tolist(), counts[order].tolist(), strict=False):
        told = f"the contour at line {int(trace.line[number])} {reason}"
        yield NotEvaluated(rule=rule.name, reason=told, blocks=count, matters=matters)
    if len(first) > _LISTED:
        told = f"each of {len(first) - _LISTED} more contours {reason}"
        yield NotEvaluated(rule=rule.name, reason=told, blocks=int(counts[order[_LISTED:]].sum()), matters=matters)


def _no_offset(what: str, key: str, of_program: Callable[[Trace], Rows] | None = None) -> _Reason:
    """of_program: gives the row in which the program has set it, -1 where it has not."""

    def reason(tables: Tables, row: int) -> str:
        trace: Trace = tables["trace"]
        number = int(trace.offset_number[row])
        if not number:
            how = example(trace.machine)
            return f"no {what}: no tool offset is in force; call one before the polar mode, as in {how}"
        setter = int(of_program(trace)[row]) if of_program else -1
        if setter >= 0:
            return _not_known_from_program(trace, row, setter, what, key)
        return f"no {what} for {called_tool(trace, row)}: {to_give(trace, row, key)}"

    return reason


def _not_known_from_program(trace: Trace, row: int, setter: int, what: str, key: str) -> str:
    """Why what the program itself sets of an offset is not known: by which block, and what to give."""
    unknown = trace.row_of_unknown_setting(int(trace.offset_number[row]), setter, key)
    missing = f"no {what} for offset {offset(trace, row)}"
    if unknown >= 0:
        return f"{missing}: {block_and_line(trace, unknown)} sets what is not known; {_OF_VARIABLES}"
    setting = block_and_line(trace, setter)
    return f"{missing}: {setting} sets wear or a difference alone; {to_give(trace, row, key)}"


def _position(tables: Tables, row: int) -> str:
    trace: Trace = tables["trace"]
    if trace.frames is not None and not trace.frames.is_known[row]:
        return "the position is not known: the frame in force is not simulated"
    open_ends = np.flatnonzero(trace.in_polar & np.isnan(trace.end) & ~np.isnan(trace.start))
    at_or_before = open_ends[open_ends <= row]
    if not np.isnan(trace.end[row]) and (open_ends > row).any():
        row = int(open_ends[open_ends > row][0])  # a corner hangs on the block behind it
    elif len(at_or_before):
        row = int(at_or_before[-1])
    if row in open_ends and not trace.run.unknown[row]:
        return (
            f"the position is not known: {block_and_line(trace, row)} leaves open where the tool goes; {_OF_VARIABLES}"
        )
    lost = np.flatnonzero((trace.run.unknown & (trace.program == trace.program[row]))[: row + 1])
    if not len(lost):
        axis = linear(trace, row)
        loses = np.isnan(trace.x) & (~np.isnan(trace.x_before) | (trace.uses_axes & trace.has(axis)))
        loses &= (trace.program == trace.program[row]) & ~trace.in_polar & ~trace.enters
        if loses[: row + 1].any():
            setting = block_and_line(trace, int(np.flatnonzero(loses[: row + 1])[-1]))
            return f"the position is not known: {setting} leaves open where {axis} stands; write G0 {axis}... after it"
        return (
            f"the position is not known: {axis} was not programmed before the polar mode; write G0 {axis}... before it"
        )
    at = int(lost[-1])
    written = f"line {int(trace.line[at])}, {block_in_line(trace, at, _BLOCK_LENGTH)}"
    axes = f"X and {trace.machine.polar.rotary_address}"
    remedy = f"--subprograms FOLDER says where called programs lie, or program {axes} after it"
    return f"the position is not known after {written}, which is not executed; {remedy}"


def _origin(tables: Tables, row: int) -> str:
    causes = " and ".join(tables["entry"].origin.unknown_causes(row))
    return f"where X0 lies is not known: {causes} sets X to what is not known; {_OF_VARIABLES}"


def _feed(tables: Tables, row: int) -> str:
    trace: Trace = tables["trace"]
    if trace.per_minute[row]:
        return "the feed is not known: no F is in force; write one before the cutting move"
    codes = " or ".join(trace.machine.codes("feed_per_minute"))
    return f"the feed is not known: F is per revolution of a spindle; write feed per minute before it, {codes}"


def _plain(name: str) -> _Reason:
    return lambda tables, row: f"{name.rpartition('.')[2].replace('_', ' ')} is not known"


_REASONS: dict[str, _Reason] = {
    "trace.radius": _no_offset("radius", "radius", lambda trace: trace.radius_set_in),
    "trace.cutter_diameter": _no_offset("cutter diameter", "diameter"),
    "trace.nose": _no_offset("nose type", "nose", lambda trace: trace.nose_set_in),
    "trace.length": _position,
    "trace.start": _position,
    "trace.end": _position,
    "arcs.end_radius": _position,
    "arcs.chord": _position,
    "travel.most_x": _of_move,
    "tool_center.c_feed": _of_move,
    "tool_center.c_acceleration": _of_move,
    "trace.feed": _feed,
    "entry.origin_shift": _origin,
}

_SAID_OF: dict[str, Callable[[Tables, Rule], Iterator[NotEvaluated]]] = {
    "c-feed-above-limit": _c_axis_without_limit,
    "c-axis-not-engaged": _codes_not_named("c_axis_on", "engages the C axis"),
    "live-tool-stopped-in-cut": _codes_not_named("live_tool_on", "starts the live tool"),
    "start-up-shorter-than-radius": _ramps_of_center,
    "overcut": _contours_given_up,
    "slot-narrower-than-cutter": _contours_beside,
    "uncompensated-cut-into-part": _contours_beside,
    "material-left": _strips_beside,
    "part-differs-from-drawing": _parts_not_compared,
}

_TOGETHER: dict[str, Callable[[Tables], Mask]] = {
    "slot-narrower-than-cutter": lambda tables: tables["slots"].tangled,
    "uncompensated-cut-into-part": lambda tables: tables["uncompensated_cuts"].tangled,
    "material-left": lambda tables: tables["coverage"].tangled,
}
