"""What was not evaluated, why, and what to give."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Callable, Iterable, Iterator
from typing import NamedTuple, TypeAlias

import numpy as np

from polarcheck.arrays import Floats, Mask, Rows
from polarcheck.checking.macro_faults import ENDLESS_LOOP, Faults, reason_of
from polarcheck.checking.not_known import OF_MOVES, OF_VARIABLES, cause_of, why
from polarcheck.checking.phrases.common import block_and_line
from polarcheck.checking.phrases.drawing import compared_with
from polarcheck.checking.phrases.offsets import offset, to_give
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
from polarcheck.checking.remedies import option_or_place, place, unlisted_codes
from polarcheck.checking.rule import Rule
from polarcheck.checking.tables import Tables
from polarcheck.columns.filling import before
from polarcheck.columns.trace import Trace
from polarcheck.errors import TooHardError
from polarcheck.finding import Finding, NotEvaluated, Undecided
from polarcheck.geometry.tolerances import CHORDS, CROSSINGS, FARTHEST
from polarcheck.machines.machine import Machine, OwnMachine
from polarcheck.table.skipped_loops import SkipReason

#: Extra reasons that a rule could not be evaluated.
_Said: TypeAlias = Callable[[Tables, Rule], Iterator["Missing"]]
#: Behind the columns that a rule needs.
SAID = 1000

#: Columns without which a finding may be missing, but hardly is: lists of offsets have T for turning tools alone.
_WITHOUT_WEIGHT = ("offsets.nose",)
#: Contours that are named one by one; a hostile file has any number of them.
NAMED = 20


class Missing(NamedTuple):
    """
    Where a rule could not look, for one cause.

    kind: which of the columns that the rule needs is not known, by number; behind these what else is said of the rule.
    cause: the same for all of which the first one tells. rate: of C [deg/min], of which nobody knows whether it is
    allowed, the highest tells; NaN where it is not about that.
    """

    rule: str
    kind: int
    cause: int | str
    reason: str
    blocks: int
    matters: bool = True
    rate: float = math.nan


def all_unevaluated(tables: Tables, rules: Iterable[Rule]) -> Iterator[NotEvaluated]:
    """Blocks that were not executed, and what the rules could not look at."""
    yield from unexecuted(tables)
    for rule in rules:
        yield from told(unevaluated(tables, rule), tables["machine"])


def bounds_not_reported(tables: Tables, findings: Iterable[Finding]) -> Iterator[NotEvaluated]:
    """The bounds at which programs were broken off, where no finding says so: the rule was not asked, or silenced."""
    faults: Faults = tables["faults"]
    if not faults.is_bound.any() or any(_is_of_bound(finding) for finding in findings):
        return
    trace: Trace = tables["trace"]
    for index in np.flatnonzero(faults.is_bound).tolist():
        line = int(trace.text.blocks.line[trace.run.faults[index].block])
        # At which block the time is over is a matter of luck, and two runs should say the same.
        at = "a block" if faults.kind[index] == "runs-too-long" else f"the block of line {line}"
        yield NotEvaluated(rule="all", reason=f"{at} {faults.reason(index)}", blocks=1)


def bound_silenced(finding: Finding) -> NotEvaluated | None:
    """What stays not evaluated where a baseline holds the finding that says so."""
    if not _is_of_bound(finding):
        return None
    return NotEvaluated(rule="all", reason=f"line {finding.line}: {finding.message}", blocks=1)


def _is_of_bound(finding: Finding) -> bool:
    return finding.rule == ENDLESS_LOOP and isinstance(finding, Undecided)


def told(missing: Iterable[Missing], machine: Machine) -> Iterator[NotEvaluated]:
    """What is said where one rule could not look: one entry for each reason, in the words of the first of its cause."""
    causes: dict[tuple[int, int | str, bool], list[Missing]] = {}
    for one in sorted(missing, key=lambda one: one.kind):
        causes.setdefault((one.kind, one.cause, one.matters), []).append(one)
    blocks: dict[tuple[str, int | str, str, bool], int] = {}
    for (kind, cause, matters), alike in causes.items():
        is_rate = not math.isnan(alike[0].rate)
        first = max(alike, key=lambda one: one.rate) if is_rate else alike[0]
        if is_rate and not machine.limits.c_feed_harmless < first.rate <= machine.limits.c_feed_suspicious:
            continue
        key = first.rule, cause if kind == SAID else kind, first.reason, matters
        blocks[key] = blocks.get(key, 0) + sum(one.blocks for one in alike)
    for (rule, _, reason, matters), count in blocks.items():
        yield NotEvaluated(rule=rule, reason=reason, blocks=count, matters=matters)


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
        *axes_not_followed(trace.blocks, trace.axes, trace.mode, trace.run, trace.machine),
        *names_not_known(trace.blocks, trace.run),
        *names_not_followed(trace.blocks, trace.axes, trace.mode, trace.run),
        *on_sub_spindle(trace.blocks, trace.axes, trace.mode, trace.compensation, trace.machine),
        offsets_not_known(trace),
        *frames_not_simulated(trace, tables),
        *not_simulated(tables["infeed"]),
        not_understood(trace.blocks, tables["other_mode"]),
        on_cylinder(trace.blocks, trace.mode),
        contours_outside(trace.blocks, trace.mode),
        extrudes(trace.blocks, trace.mode, trace.run),
    ):
        if count:
            yield NotEvaluated(rule="all", reason=reason, blocks=count)


def frames_not_simulated(trace: Trace, tables: Tables) -> Iterator[tuple[str, int]]:
    """The blocks that begin a frame which is not simulated, where the mode uses it, or an allowance changes in it."""
    frames = trace.path.frames
    if frames is not None:
        in_force = ~frames.is_known & (trace.mode.in_polar | trace.mode.enters)
        for row in np.flatnonzero(in_force & ~before(in_force, trace.blocks.starts, False))[:NAMED].tolist():
            begins = np.flatnonzero(frames.is_known[: row + 1])
            first = int(begins[-1]) + 1 if len(begins) else 0
            what = f"{block_and_line(trace.blocks, trace.run, first)} is not simulated"
            yield f"{what}: where the tool goes in that frame is not known", int(np.count_nonzero(in_force))
    selects = tables["mode_words"].selects_other_work_offset
    if selects.any():
        block = block_and_line(trace.blocks, trace.run, int(np.flatnonzero(selects)[0]))
        what = f"{block} selects another work offset in the mode"
        yield f"{what}: it is taken to lie where the one before did", int(np.count_nonzero(selects))
    changed = np.flatnonzero(trace.compensation.changes_allowance_in_offset_mode)
    if len(changed):
        what = f"{block_and_line(trace.blocks, trace.run, int(changed[0]))} changes what is added to R in offset mode"
        yield f"{what}: the way from one to the other is not simulated; change it where G40 is in force", len(changed)


def offsets_not_known(trace: Trace) -> tuple[str, int]:
    """The blocks that set an offset, or a variable that may be one, nobody knows which."""
    rows = np.flatnonzero(trace.offsets.sets_unknown_offset)
    if not len(rows):
        return "", 0
    what = f"which offset {block_and_line(trace.blocks, trace.run, int(rows[0]))} sets is not known"
    return f"{what}, those in force are taken as given: {OF_VARIABLES}", len(rows)


def unevaluated(tables: Tables, rule: Rule) -> Iterator[Missing]:
    """The rows where a rule would have looked but could not."""
    try:
        yield from _not_known(tables, rule)
        said = _SAID_OF.get(rule.name)
        if said is not None:
            yield from said(tables, rule)
    except TooHardError as error:
        # What takes long is the geometry of the polar sections.
        trace: Trace = tables["trace"]
        blocks = int(np.count_nonzero(trace.mode.in_polar)) or len(trace)
        yield Missing(rule.name, SAID, str(error), str(error), blocks)


def _not_known(tables: Tables, rule: Rule) -> Iterator[Missing]:
    """The rows in which a column is not known that the rule needs."""
    trace: Trace = tables["trace"]
    for kind, name in enumerate(rule.needs):
        where: Mask = tables.column(rule.where)
        if not where.any():
            continue
        # Of sections that are not followed one entry speaks for all.
        rows = np.flatnonzero(
            np.isnan(tables.column(name)) & where & trace.mode.is_followed & ~trace.compensation.sides_are_open
        )
        if name in OF_MOVES:
            rows = rows[~(tables["feeds"].missing | tables["feeds"].lost)[rows]]  # a finding says so
        cause = cause_of(trace, name, rows)
        first, counts = _groups(cause)
        for row, of, count in sorted(zip(rows[first].tolist(), cause[first].tolist(), counts.tolist(), strict=True)):
            yield Missing(rule.name, kind, of, why(name, tables, row), count, matters=name not in _WITHOUT_WEIGHT)


def _groups(values: Rows) -> tuple[Rows, Rows]:
    """Where each value stands first, and how often; NumPy's unique would load its masked arrays."""
    order = np.argsort(values, kind="stable")
    begins = np.flatnonzero(np.append(True, np.diff(values[order]) != 0)) if len(order) else order
    return order[begins], np.diff(np.append(begins, len(order)))


def _c_axis_without_limit(tables: Tables, rule: Rule) -> Iterator[Missing]:
    """
    The highest rate of C, for the setter to compare, where the profile has nothing to compare it with; not where every
    C axis manages it, nor where none does, which is a finding.
    """
    trace: Trace = tables["trace"]
    c_feed: Floats = tables["tool_center"].c_feed
    rows = np.flatnonzero(tables["center"].cuts_off_center & np.isfinite(c_feed))
    if not np.isnan(trace.machine.limits.c_feed) or not len(rows):
        return
    at = int(rows[np.argmax(c_feed[rows])])
    line, rate, axis = int(trace.blocks.line[at]), float(c_feed[at]), trace.machine.polar.rotary_address
    reason = (
        f"{trace.machine.title} gives no limit of the {axis} axis; highest rate found {rate:.0f} deg/min, line {line}"
    )
    remedy = f"give the lathe's own, {option_or_place(trace.machine, 'limits.c_feed')}"
    yield Missing(rule.name, SAID, "rate", f"{reason}: {remedy}", len(rows), rate=rate)


def _codes_not_named(key: str, what: str) -> _Said:
    """
    On a lathe of the user's own whose file names no code of a list, though the program has some that may be one: where
    to add it. Of our own machines nobody expects to know the codes of each builder.
    """

    def found(tables: Tables, rule: Rule) -> Iterator[Missing]:
        trace: Trace = tables["trace"]
        if not isinstance(trace.machine, OwnMachine) or getattr(trace.machine.m_codes, key):
            return
        rows = np.flatnonzero(trace.mode.enters)
        codes = [unlisted_codes(trace.blocks, trace.run, trace.machine, tables["spindles"], int(row)) for row in rows]
        if any(codes):
            file, first = trace.machine.file, next(filter(None, codes))
            remedy = f"if {first} does, add it to {place(trace.machine, f'm_codes.{key}')}"
            count = sum(map(bool, codes))
            reason = f"{file} names no code that {what}: {remedy}"
            yield Missing(rule.name, SAID, key, reason, count, matters=False)

    return found


def _ramps_of_center(tables: Tables, rule: Rule) -> Iterator[Missing]:
    """The ramps of sections that are taken for paths of the tool center since they are all too short for a comment."""
    trace: Trace = tables["trace"]
    ramps = np.flatnonzero(
        (trace.compensation.starts_up | trace.compensation.cancels) & trace.compensation.is_path_of_center
    )
    first, counts = _groups(trace.tools.offset_number[ramps])
    for row, count in sorted(zip(ramps[first].tolist(), counts.tolist(), strict=True)):
        reason = (
            f"R of offset {offset(trace.tools, row)} is taken as 0, since every ramp is shorter than the radius of its "
            f"comment; whether they are too short is open: {to_give(trace.tools, trace.machine, row, 'radius')}"
        )
        yield Missing(rule.name, SAID, int(trace.tools.offset_number[row]), reason, count)


def _contours_skipped(tables: Tables, rule: Rule) -> Iterator[Missing]:
    """Loops that the table of the rule skips; but those that cross themselves are reported for overcuts alone."""
    overcuts, table = tables["overcuts"], tables[_TABLE_OF[rule.name]]
    for reason, sentence in _SENTENCES[rule.name].items():
        rows = table.skipped.rows(overcuts.loop, reason)
        if table is not overcuts:
            rows &= ~overcuts.skipped.rows(overcuts.loop, SkipReason.CROSSES)
        matters = reason != SkipReason.PATHS_TOO_LONG  # hardly ever is anything amiss beside these
        yield from _of_contours(tables, rule, rows, sentence, matters)


def _parts_not_compared(tables: Tables, rule: Rule) -> Iterator[Missing]:
    """What the job asks for and no contour was compared with; contours of which no part can be told."""
    deviations = tables["deviations"]
    if not deviations.parts:
        return
    crosses = f"crosses itself or others more than {CROSSINGS} times a block: no part can be told from it"
    yield from _of_contours(tables, rule, deviations.asked & deviations.crosses, crosses)
    for one in deviations.comparisons:
        if one.is_partial and one.agrees:
            of_block = (
                f"the contour of line {int(tables['trace'].blocks.line[one.row])} does not come back to where it begins"
            )
            compared = f"was compared with {compared_with(deviations, one.number)} along its walls alone"
            reason = f"{of_block}, and {compared}: end it where it began, or beyond"
            yield Missing(rule.name, SAID, reason, reason, 1)
    for number, cause in deviations.missing():
        reason = f"{compared_with(deviations, number)} was compared with nothing: {cause}"
        rows = deviations.asked if deviations.asked.any() else tables["trace"].mode.in_polar
        yield Missing(rule.name, SAID, reason, reason, int(np.count_nonzero(rows)))


def _of_contours(tables: Tables, rule: Rule, rows: Mask, reason: str, matters: bool = True) -> Iterator[Missing]:
    """One entry for each loop of these rows, and one for all beyond the first NAMED."""
    trace: Trace = tables["trace"]
    at = np.flatnonzero(rows & tables["ramps"].compensated)
    if not len(at):
        return
    first, counts = _groups(tables["ramps"].loop[at])
    order = np.argsort(first)
    for number, count in zip(at[first[order]][:NAMED].tolist(), counts[order].tolist(), strict=False):
        said = f"the contour at line {int(trace.blocks.line[number])} {reason}"
        yield Missing(rule.name, SAID, f"{said} {number}", said, count, matters)
    if len(first) > NAMED:
        said = f"each of {len(first) - NAMED} more contours {reason}"
        yield Missing(rule.name, SAID, said, said, int(counts[order[NAMED:]].sum()), matters)


_CROSS_BESIDE = {
    SkipReason.CROSSES: (
        f"crosses itself or others beside it more than {CROSSINGS} times a block: no part can be told from them; "
        "program fewer contours in a section"
    )
}
#: By rule and reason, what is said of a contour that is skipped.
_SENTENCES: dict[str, dict[SkipReason, str]] = {
    "overcut": {
        SkipReason.CROSSES: (
            f"crosses itself more than {CROSSINGS} times a block: no part can be told from it; program each contour by "
            "itself, between its own G41 or G42 and G40"
        ),
        SkipReason.TOO_FAR: (
            f"reaches farther than {FARTHEST:.0f} mm from the center of C, or turns round a point far beyond: no part "
            "can be told from it; mend its words"
        ),
        SkipReason.TOO_MANY_CHORDS: (
            f"has arcs of more than {CHORDS} chords: they are too many to look at; are their R, I and J meant?"
        ),
    },
    "slot-narrower-than-cutter": _CROSS_BESIDE,
    "uncompensated-cut-into-part": _CROSS_BESIDE,
    "material-left": _CROSS_BESIDE
    | {
        SkipReason.PATHS_TOO_LONG: (
            "lies beside so many others, or such long paths, that nobody has looked for what stays between them"
        )
    },
}
_TABLE_OF = {
    "overcut": "overcuts",
    "slot-narrower-than-cutter": "slots",
    "uncompensated-cut-into-part": "uncompensated_cuts",
    "material-left": "coverage",
}

_SAID_OF: dict[str, _Said] = {
    "c-feed-above-limit": _c_axis_without_limit,
    "c-axis-not-engaged": _codes_not_named("c_axis_on", "engages the C axis"),
    "live-tool-stopped-in-cut": _codes_not_named("live_tool_on", "starts the live tool"),
    "start-up-shorter-than-radius": _ramps_of_center,
    **dict.fromkeys(_TABLE_OF, _contours_skipped),
    "part-differs-from-drawing": _parts_not_compared,
}
