"""Reports what was not evaluated: the reason, and the input that would change it."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Sequence
from typing import TypeAlias

import msgspec
import numpy as np

from polarcheck.checking.not_followed import (
    axes_not_followed,
    contours_outside,
    depths_not_known,
    extrudes,
    face_not_known,
    left_by_caller,
    names_not_followed,
    names_not_known,
    not_simulated,
    not_understood,
    on_cylinder,
    on_sub_spindle,
)
from polarcheck.checking.not_known import angles_not_known, cause_of, is_argument, of_variables, value_not_known, why
from polarcheck.columns.contour.skipped_loops import SkipReason
from polarcheck.columns.filling import before
from polarcheck.columns.trace import Trace
from polarcheck.columns.words.macro_faults import ENDLESS_LOOP, Faults, reason_of
from polarcheck.columns.words.unknown_words import UnknownItem, UnknownWords
from polarcheck.foundation.arrays import Floats, Mask, Rows, first_in_run, first_of_each, side_by_side
from polarcheck.foundation.errors import TooHardError
from polarcheck.foundation.finding import Finding, NotEvaluated, Undecided
from polarcheck.geometry.tolerances import CHORDS, CROSSINGS, FARTHEST
from polarcheck.program.execution.run import Remark, is_code
from polarcheck.program.machines.machine import Machine, OwnMachine
from polarcheck.program.machines.part_keys import DrawnPart
from polarcheck.program.reading.excerpt import shortened
from polarcheck.rules.quantity import in_row
from polarcheck.rules.remedies import option_or_place, place, unlisted_codes
from polarcheck.rules.rule import Rule
from polarcheck.rules.tables import Tables, called
from polarcheck.rules.wording.offsets import offset, to_give
from polarcheck.rules.wording.written import block_and_line, point

#: Extra reasons that a rule could not be evaluated.
_ExtraReasons: TypeAlias = Callable[[Tables, Rule], Iterator["Missing"]]
#: Missing.kind of an extra reason; it sorts after the columns that the rule needs.
SAID = 1000

#: Characters of a word that is quoted.
_LONGEST = 40
#: Contours listed individually; the bound keeps the report of a hostile file short.
NAMED = 20


class Missing(msgspec.Struct, frozen=True):
    """
    The blocks in which a rule could not be evaluated, for one cause.

    rule: the name of the rule.
    kind: the index in what `needs` of the rule returns of the column that is not known, or SAID for an extra reason.
    cause: identifies the cause; entries with the same kind and cause are merged.
    reason: the text of the report.
    blocks: the number of blocks.
    matters: False if a finding is hardly ever missed.
    rate: a rate of the C axis with no limit to compare it with [deg/min]; NaN for other reasons.
    """

    rule: str
    kind: int
    cause: int | str
    reason: str
    blocks: int
    matters: bool = True
    rate: float = math.nan


def unevaluated_by(tables: Tables, rule: Rule) -> list[NotEvaluated]:
    """Return the blocks that a rule could not evaluate, by reason."""
    if (rule.companion("needs") or rule.name in _EXTRA_REASONS) and tables.has(rule.only_with):
        return [*merged_by_reason(unevaluated(tables, rule), tables["machine"])]
    return []


def bounds_not_reported(tables: Tables, findings: Iterable[Finding]) -> Iterator[NotEvaluated]:
    """Report the bounds that stopped a program, unless a finding does: its rule may be off or silenced."""
    faults: Faults = tables["faults"]
    if not faults.is_bound.any() or any(_is_of_bound(finding) for finding in findings):
        return
    trace: Trace = tables["trace"]
    for index in np.flatnonzero(faults.is_bound).tolist():
        line = int(trace.text.blocks.line[trace.run.faults[index].block])
        # The block at which time runs out differs between runs; the report must not.
        block = "a block" if faults.kind[index] == "runs-too-long" else f"the block of line {line}"
        yield NotEvaluated(rule="all", reason=f"{block} {faults.reason(index)}", blocks=1)


def bound_silenced(finding: Finding) -> NotEvaluated | None:
    """Report a bound as not evaluated if a baseline suppresses its finding."""
    if not _is_of_bound(finding):
        return None
    return NotEvaluated(rule="all", reason=f"line {finding.line}: {finding.message}", blocks=1)


def _is_of_bound(finding: Finding) -> bool:
    return finding.rule == ENDLESS_LOOP and isinstance(finding, Undecided)


def merged_by_reason(missing: Iterable[Missing], machine: Machine) -> Iterator[NotEvaluated]:
    """Merge the entries of one rule: one report per reason, with the text of the first entry of each cause."""
    causes: dict[tuple[int, int | str, bool], list[Missing]] = {}
    for entry in sorted(missing, key=lambda entry: entry.kind):
        causes.setdefault((entry.kind, entry.cause, entry.matters), []).append(entry)
    blocks: dict[tuple[str, int | str, str, bool], int] = {}
    for (kind, cause, matters), entries in causes.items():
        is_rate = not math.isnan(entries[0].rate)
        first = max(entries, key=lambda entry: entry.rate) if is_rate else entries[0]
        if is_rate and not machine.limits.c_feed_harmless < first.rate <= machine.limits.c_feed_suspicious:
            continue
        key = first.rule, cause if kind == SAID else kind, first.reason, matters
        blocks[key] = blocks.get(key, 0) + sum(entry.blocks for entry in entries)
    for (rule, _, reason, matters), count in blocks.items():
        yield NotEvaluated(rule=rule, reason=reason, blocks=count, matters=matters)


def _is_done_before(trace: Trace, remark: Remark) -> bool:
    """A cycle outside the mode, behind which the positions are known again before the next section begins."""
    if not remark.values.get("is_cycle"):
        return False
    rows = np.flatnonzero(trace.run.block == remark.block)
    enter = trace.mode.sections.enter
    next_ = enter[np.minimum(np.searchsorted(enter, rows), max(len(enter) - 1, 0))] if len(enter) else rows
    follows = next_ > rows
    position = trace.path.x_before[next_] + trace.path.z[next_] + trace.path.c_angle[next_]
    return len(rows) > 0 and not bool(np.any((trace.mode.section[rows] >= 0) | (follows & np.isnan(position))))


def _last_switch(trace: Trace) -> int:
    """The last block of the file that switches the mode on; the number of all blocks where no section is left."""
    sections, words = trace.mode.sections, trace.text.words
    if not len(sections) or not sections.left[-1]:
        return len(trace.text.blocks)
    return int(words.block[is_code(words, trace.machine.polar.on)].max(initial=-1))


def unexecuted(tables: Tables, *, of_metal: bool = True) -> Iterator[NotEvaluated]:
    """
    Report the blocks that were not executed, and those that were executed without full knowledge.

    of_metal: conditions on which no section rests do not matter.
    """
    trace: Trace = tables["trace"]
    language = tables["dialect"].recognised
    if language is not None:
        yield NotEvaluated(
            rule="all", reason=f"the file is written for {language.title}: convert it for this lathe", blocks=len(trace)
        )
        return
    # A condition behind all sections leads to none where no switch stands below it and all runs down to the end.
    last_switch = _last_switch(trace) if of_metal else len(trace.text.blocks)
    remarks = Counter(
        (
            reason_of(remark, trace.run, trace.machine),
            bool(remark.values.get("matters", True))
            and not _is_done_before(trace, remark)
            and not (remark.block > last_switch and remark.row > trace.mode.sections.leave[-1]),
        )
        for remark in trace.run.remarks
    )
    for (reason, matters), count in remarks.items():
        yield NotEvaluated(rule="all", reason=reason, blocks=count, matters=matters)
    for value in unknown_values(tables):
        yield NotEvaluated(rule="all", reason=value.reason, blocks=value.blocks, matters=value.matters)
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
        left_by_caller(trace),
        contours_outside(trace),
        extrudes(trace),
        *angles_not_known(trace),
    ):
        if count:
            yield NotEvaluated(rule="all", reason=reason, blocks=count)
    for reason, count in (*depths_not_known(trace), *face_not_known(trace, tables["bar"])):
        yield NotEvaluated(rule="all", reason=reason, blocks=count, matters=False)


class UnknownValue(msgspec.Struct, frozen=True):
    """
    What rests on a variable without a value.

    line: of the first word that rests on it. reason: names the word, the variable, and what to give. blocks: with such
    words. matters: a polar section rests on it.
    """

    line: int
    reason: str
    blocks: int
    matters: bool


def unknown_values(tables: Tables) -> Iterator[UnknownValue]:
    """
    Yield an entry for each variable without a value on which sections rest, and one for all others together.

    Arguments on which no section rests are left out: a subprogram that nothing calls has no value for any of them.
    """
    words: UnknownWords = tables["unknown_words"]
    trace: Trace = tables["trace"]
    causes: dict[int | None, list[UnknownItem]] = {}
    others: dict[int | None, list[UnknownItem]] = {}
    for item in words.items:
        if item.matters:
            causes.setdefault(item.variable, []).append(item)
        elif not item.is_data and (item.variable is None or not is_argument(trace.machine, item.variable)):
            others.setdefault(item.variable, []).append(item)
    for variable, items in causes.items():
        yield unknown_value(trace, [variable], items, matters=True)
    if others:
        yield unknown_value(trace, [*others], [item for items in others.values() for item in items], matters=False)


def unknown_value(
    trace: Trace, variables: Sequence[int | None], items: Sequence[UnknownItem], *, matters: bool
) -> UnknownValue:
    """Return the entry for items that rest on these variables."""
    first = items[0]
    written = " ".join(trace.text.source.excerpt(first.start, first.end).split())
    line = int(trace.blocks.line[first.row])
    word = f"{shortened(written, _LONGEST)} of line {line}"
    blocks = len({item.row for item in items})
    return UnknownValue(line, value_not_known(trace, variables, word), blocks, matters)


def frames_not_simulated(trace: Trace, tables: Tables) -> Iterator[tuple[str, int]]:
    """Yield a reason and a block count for frames, work offsets and allowances that are not simulated in the mode."""
    frames = trace.path.frames
    if frames is not None:
        in_force = ~frames.is_known & (trace.mode.in_polar | trace.mode.enters)
        for row in np.flatnonzero(in_force & ~before(in_force, trace.blocks.starts, False))[:NAMED].tolist():
            begins = np.flatnonzero(frames.is_known[: row + 1])
            first = int(begins[-1]) + 1 if len(begins) else 0
            frame = f"{block_and_line(trace, first)} is not simulated"
            yield f"{frame}: where the tool goes in that frame is not known", int(np.count_nonzero(in_force))
    selects = tables["mode_words"].selects_other_work_offset
    if selects.any():
        block = block_and_line(trace, int(np.flatnonzero(selects)[0]))
        selection = f"{block} selects another work offset in the mode"
        yield f"{selection}: it is taken to lie where the one before did", int(np.count_nonzero(selects))
    changed = np.flatnonzero(trace.compensation.changes_allowance_in_offset_mode)
    if len(changed):
        change = f"{block_and_line(trace, int(changed[0]))} changes what is added to R in offset mode"
        yield f"{change}: the way from one to the other is not simulated; change it where G40 is in force", len(changed)


def offsets_not_known(trace: Trace) -> tuple[str, int]:
    """Return a reason and a block count for blocks that set a variable of unknown number, which may be an offset."""
    rows = np.flatnonzero(trace.offsets.sets_unknown_offset & ~trace.blocks.is_unknown("P"))
    if not len(rows):
        return "", 0
    setting = f"which offset {block_and_line(trace, int(rows[0]))} sets is not known"
    return f"{setting}, those in force are taken as given: {of_variables(trace)}", len(rows)


def unevaluated(tables: Tables, rule: Rule) -> Iterator[Missing]:
    """Yield the rows that a rule could not evaluate."""
    try:
        yield from _unknown_columns(tables, rule)
        extra_reasons = _EXTRA_REASONS.get(rule.name)
        if extra_reasons is not None:
            yield from extra_reasons(tables, rule)
    except TooHardError as error:
        # The geometry of the polar sections takes the time, so their blocks are counted.
        trace: Trace = tables["trace"]
        blocks = int(np.count_nonzero(trace.mode.in_polar)) or len(trace)
        yield Missing(rule.name, SAID, str(error), str(error), blocks)


def _unknown_columns(tables: Tables, rule: Rule) -> Iterator[Missing]:
    """Yield the rows in which a column that the rule needs is not known."""
    trace: Trace = tables["trace"]
    needs = rule.companion("needs")
    if needs is None:
        return
    where, columns = called(needs, tables, {})
    # Sections that are not followed have an entry of their own.
    judged = (where & trace.mode.is_followed & ~trace.compensation.sides_are_open).nonzero()[0]
    for kind, (need, column) in enumerate(columns.items()) if len(judged) else ():
        rows = judged[np.isnan(column[judged])]
        if not len(rows):
            continue
        if need == "rate":
            rows = rows[~(tables["feeds"].missing | tables["feeds"].lost)[rows]]  # these have a finding already
        cause = cause_of(trace, need, rows)
        first, counts = _groups(cause)
        for row, first_cause, count in sorted(side_by_side(rows[first], cause[first], counts)):
            # Offset lists give the nose type for turning tools only.
            yield Missing(rule.name, kind, first_cause, why(need, tables, row), count, matters=need != "nose")


def _groups(values: Rows) -> tuple[Rows, Rows]:
    """Return the first index and the count of each value, by rising value; most stand beside their equals."""
    begins = first_in_run(values).nonzero()[0]
    if len(begins) == 1:
        return begins, np.array([len(values)])
    first, number = first_of_each(values[begins])
    return begins[first], np.bincount(number, np.diff(np.append(begins, len(values)))).astype(np.int64)


def _c_axis_without_limit(tables: Tables, rule: Rule) -> Iterator[Missing]:
    """
    Report the highest C rate if the profile has no limit, so that the setter can compare it.

    merged_by_reason() drops a rate that every C axis reaches, and one that none does, which is a finding.
    """
    trace: Trace = tables["trace"]
    c_feed: Floats = tables["tool_center"].c_feed
    rows = np.flatnonzero(tables["center"].cuts_off_center & np.isfinite(c_feed))
    if not np.isnan(trace.machine.limits.c_feed) or not len(rows):
        return
    row = int(rows[np.argmax(c_feed[rows])])
    line, rate, axis = int(trace.blocks.line[row]), float(c_feed[row]), trace.machine.polar.rotary_address
    reason = (
        f"{trace.machine.title} gives no limit of the {axis} axis; highest rate found {rate:.0f} deg/min, line {line}"
    )
    remedy = f"give the lathe's own, {option_or_place(trace.machine, 'limits.c_feed')}"
    yield Missing(rule.name, SAID, "rate", f"{reason}: {remedy}", len(rows), rate=rate)


def _codes_not_named(key: str, what: str) -> _ExtraReasons:
    """
    Report an empty list of M codes in the user's machine file, if an unlisted code of the program may belong to it.

    Built-in profiles are exempt: they cannot know the codes of each builder.
    """

    def missing_code(tables: Tables, rule: Rule) -> Iterator[Missing]:
        trace: Trace = tables["trace"]
        if not isinstance(trace.machine, OwnMachine) or getattr(trace.machine.m_codes, key):
            return
        rows = np.flatnonzero(trace.mode.enters)
        codes = [unlisted_codes(trace, tables["spindles"], int(row)) for row in rows]
        if any(codes):
            file, first = trace.machine.file, next(filter(None, codes))
            remedy = f"if {first} does, add it to {place(trace.machine, f'm_codes.{key}')}"
            count = sum(map(bool, codes))
            reason = f"{file} names no code that {what}: {remedy}"
            yield Missing(rule.name, SAID, key, reason, count, matters=False)

    return missing_code


def _ramps_of_center(tables: Tables, rule: Rule) -> Iterator[Missing]:
    """Report ramps of sections read as tool center paths because all are shorter than the radius in the comment."""
    trace: Trace = tables["trace"]
    ramps = np.flatnonzero(
        (trace.compensation.starts_up | trace.compensation.cancels) & trace.compensation.is_path_of_center
    )
    first, counts = _groups(trace.tools.offset_number[ramps])
    for row, count in sorted(side_by_side(ramps[first], counts)):
        reason = (
            f"R of offset {offset(trace.tools, row)} is taken as 0, since every ramp is shorter than the radius of its "
            f"comment; whether they are too short is open: {to_give(trace.tools, trace.machine, row, 'radius')}"
        )
        yield Missing(rule.name, SAID, int(trace.tools.offset_number[row]), reason, count)


def _contours_skipped(tables: Tables, rule: Rule) -> Iterator[Missing]:
    """Report the loops that the table of the rule skips; self-crossing loops are reported for overcuts only."""
    overcuts, table = tables["overcuts"], tables[_TABLE_OF[rule.name]]
    for reason, sentence in _SENTENCES[rule.name].items():
        rows = table.skipped.rows(overcuts.loop, reason)
        if table is not overcuts:
            rows &= ~overcuts.skipped.rows(overcuts.loop, SkipReason.CROSSES)
        matters = reason != SkipReason.PATHS_TOO_LONG  # long paths hardly ever hide a finding
        yield from _skipped_loops(tables, rule, rows, sentence, matters)


def _parts_not_compared(tables: Tables, rule: Rule) -> Iterator[Missing]:
    """Report drawings that no contour was compared with, and contours that give no part polygon."""
    deviations = tables["deviations"]
    if not deviations.parts:
        return
    from polarcheck.rules.wording.drawing import compared_with  # late: few programs have a part to compare

    crosses = f"crosses itself or others more than {CROSSINGS} times a block: no part can be told from it"
    yield from _skipped_loops(tables, rule, deviations.where & deviations.crosses, crosses)
    for number, part in enumerate(deviations.parts):
        if isinstance(part, DrawnPart) and part.passed_over:
            reason = f"{compared_with(deviations, number)} shows {part.passed_over}, which was passed over"
            yield Missing(rule.name, SAID, reason, reason, 1, matters=False)
    yield from _drawings_with_gaps(tables, rule)
    for comparison in deviations.comparisons:
        if comparison.is_partial and comparison.agrees:
            line = int(tables["trace"].blocks.line[comparison.row])
            contour = f"the contour of line {line} does not come back to where it begins"
            compared = f"was compared with {compared_with(deviations, comparison.number)} along its walls alone"
            reason = f"{contour}, and {compared}: end it where it began, or beyond"
            yield Missing(rule.name, SAID, reason, reason, 1)
        if comparison.difference.is_broken and comparison.agrees:
            title = compared_with(deviations, comparison.number)
            reason = f"of the round of {title} a part is milled: whether the rest of it is turned is not known"
            yield Missing(rule.name, SAID, reason, reason, 1)
        if comparison.difference.is_beyond and comparison.agrees:
            title = compared_with(deviations, comparison.number)
            reason = f"{title} lies beyond the bar, and nowhere within it: it was compared where they touch alone"
            yield Missing(rule.name, SAID, reason, reason, 1)
        if comparison.difference.outside >= 0 and comparison.agrees:
            line = int(tables["trace"].blocks.line[comparison.row_outside])
            title = compared_with(deviations, comparison.number)
            runs = f"the contour of line {line} runs outside of the round of {title}"
            reason = f"{runs}, where there may be metal: give the bar, [stock] diameter"
            yield Missing(rule.name, SAID, reason, reason, 1)
        if comparison.island and comparison.agrees and not tables["trace"].job.stock.unknown:
            title = compared_with(deviations, comparison.number)
            line = int(tables["trace"].blocks.line[comparison.row])
            along = f"{title} is milled along its walls alone at line {line}"
            reason = f"{along}: whether its middle is cleared before is not known; give the bar, [stock] diameter"
            yield Missing(rule.name, SAID, reason, reason, 1)
    for number, cause in deviations.missing():
        reason = f"{compared_with(deviations, number)} was compared with nothing: {cause}"
        rows = deviations.where if deviations.where.any() else tables["trace"].mode.in_polar
        yield Missing(rule.name, SAID, reason, reason, int(np.count_nonzero(rows)))


def _drawings_with_gaps(tables: Tables, rule: Rule) -> Iterator[Missing]:
    """Report drawings whose curves do not meet, unless the part differs along these."""
    from polarcheck.rules.wording.drawing import compared_with

    deviations, trace = tables["deviations"], tables["trace"]
    differing = {comparison.number for comparison in deviations.comparisons if comparison.differs}
    row = int(trace.mode.sections.enter[0]) if len(trace.mode.sections) else 0
    for number in range(len(deviations.nominal_parts.parts)):
        gap = deviations.nominal_parts.gap(number, row)
        if gap is None or number in differing:
            continue
        apart = f"gap {in_row(gap.size, trace.lengths, row):length} at {point(trace, gap.place, row)}"
        reason = f"the curves of {compared_with(deviations, number)} do not meet: {apart}"
        reason = f"{reason}; contours were compared along them alone: close the gaps"
        yield Missing(rule.name, SAID, reason, reason, 1)


def _skipped_loops(tables: Tables, rule: Rule, rows: Mask, reason: str, matters: bool = True) -> Iterator[Missing]:
    """Yield an entry for each of the first NAMED loops in these rows, and one for all further loops."""
    trace: Trace = tables["trace"]
    skipped = np.flatnonzero(rows & tables["ramps"].compensated)
    if not len(skipped):
        return
    first, counts = _groups(tables["ramps"].loop[skipped])
    order = np.argsort(first)
    for number, count in zip(skipped[first[order]][:NAMED].tolist(), counts[order].tolist(), strict=False):
        sentence = f"the contour at line {int(trace.blocks.line[number])} {reason}"
        yield Missing(rule.name, SAID, f"{sentence} {number}", sentence, count, matters)
    if len(first) > NAMED:
        sentence = f"each of {len(first) - NAMED} more contours {reason}"
        yield Missing(rule.name, SAID, sentence, sentence, int(counts[order[NAMED:]].sum()), matters)


def _metal_not_followed(tables: Tables, rule: Rule) -> Iterator[Missing]:
    """Report ways into the bar that were not looked at, and why. They matter little: most of them are sound."""
    workpiece, trace = tables["workpiece"], tables["trace"]
    for row, count, why_not in workpiece.not_followed():
        block = block_and_line(trace, row)
        yield Missing(
            rule.name, SAID, why_not, f"where {block} leads is not looked at: {why_not}", count, matters=False
        )


_CROSS_BESIDE = {
    SkipReason.CROSSES: (
        f"crosses itself or others beside it more than {CROSSINGS} times a block: no part can be told from them; "
        "program fewer contours in a section"
    )
}
#: The sentence about a skipped contour, by rule and reason.
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

_EXTRA_REASONS: dict[str, _ExtraReasons] = {
    "c-feed-above-limit": _c_axis_without_limit,
    "c-axis-not-engaged": _codes_not_named("c_axis_on", "engages the C axis"),
    "live-tool-stopped-in-cut": _codes_not_named("live_tool_on", "starts the live tool"),
    "start-up-shorter-than-radius": _ramps_of_center,
    **dict.fromkeys(_TABLE_OF, _contours_skipped),
    "part-differs-from-drawing": _parts_not_compared,
    "rapid-through-stock": _metal_not_followed,
}
