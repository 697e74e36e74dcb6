"""The polar sections on which the verdict of a file rests: each with its radius, and how near it comes to a limit."""

from __future__ import annotations

import functools
from collections.abc import Iterator, Sequence
from typing import Any

import msgspec
import numpy as np
from msgspec import UNSET

from polarcheck.columns.feed.dynamics import Dynamics
from polarcheck.columns.metal.bar import Bar
from polarcheck.columns.modes.sections import Sections
from polarcheck.columns.path.center import Center
from polarcheck.columns.path.ramps import Ramps
from polarcheck.columns.trace import Trace
from polarcheck.foundation.arrays import Floats, Mask, Rows, column_at, mask_at, side_by_side
from polarcheck.foundation.errors import TooHardError
from polarcheck.foundation.finding import FileReport, KnownStock, PolarSection
from polarcheck.foundation.states import Units
from polarcheck.program.machines.code_lists import expanded
from polarcheck.program.machines.code_tables import CODE_LIMIT, code_numbers
from polarcheck.program.machines.machine import Machine
from polarcheck.program.reading.words import Text
from polarcheck.rules.quantity import rounded
from polarcheck.rules.tables import Tables
from polarcheck.rules.wording.offsets import key_of


def polar_sections(tables: Tables) -> list[PolarSection]:
    """One element for each polar section, in order."""
    trace: Trace = tables["trace"]
    if not len(trace.mode.sections):
        return []
    try:
        return _polar_sections(trace, tables["dynamics"], tables["center"], tables["ramps"])
    except TooHardError:
        return []  # what the verdict does not rest on; what was given up stands under "not evaluated"


def known_stock(tables: Tables) -> KnownStock | None:
    """The bar that rules about the metal rest on; None where nothing is known of it."""
    if not len(tables["sections"]):
        return None
    bar: Bar = tables["bar"]
    stock = bar.known
    if stock.source == "none" and np.isnan(stock.face):
        return None
    (line, end_line), (face_line, face_end_line) = stock.lines, stock.face_lines
    return KnownStock(
        diameter=rounded(stock.smallest),
        largest=rounded(stock.largest),
        bore=rounded(stock.bore),
        face=rounded(bar.face_as_written),
        source=stock.source,
        line=line or None,
        end_line=end_line or None,
        face_line=face_line or None,
        face_end_line=face_end_line or None,
    )


def _polar_sections(trace: Trace, dynamics: Dynamics, center: Center, ramps: Ramps) -> list[PolarSection]:
    sections, tool_center = trace.mode.sections, dynamics.tool_center
    c_feed = np.where(center.cuts_off_center, tool_center.c_feed, -np.inf)
    highest = _of_sections(sections, c_feed, np.maximum, -np.inf)
    fastest = _fastest(trace, c_feed, highest)
    meets = np.flatnonzero(trace.path.cuts & center.meets_center)
    met = dict(side_by_side(trace.mode.section[meets[::-1]], meets[::-1]))
    at_entry = _offset_rows(trace)
    nearest = _of_sections(sections, np.where(trace.path.cuts, tool_center.nearest, np.inf), np.minimum, np.inf)
    ramp = _ramp_used(trace, ramps)
    limit, rotary = rounded(trace.machine.limits.c_feed), trace.machine.polar.rotary_address
    listed = []
    for index, (enter, end, row, fast) in enumerate(side_by_side(sections.enter, sections.last, at_entry, fastest)):
        time = float(dynamics.section_time[index])
        listed.append(
            PolarSection(
                line=int(trace.blocks.line_in_file[enter]),
                end_line=int(trace.blocks.line_in_file[min(end, len(trace) - 1)]),
                units="inch" if trace.lengths.units[enter] == Units.INCH else "mm",
                offset=key_of(trace.tools, int(trace.tools.offset_number[row])),
                radius=rounded(trace.compensation.radius[row] - trace.compensation.allowance[row]),
                radius_source=radius_source(trace, row),
                nearest=rounded(nearest[index]),
                c_feed=rounded(highest[index]),
                c_feed_line=int(trace.blocks.line_in_file[fast]) if fast >= 0 else None,
                c_feed_limit=limit,
                center_line=int(trace.blocks.line_in_file[met[index]]) if index in met else UNSET,
                ramp_used=rounded(ramp[index]),
                time=rounded(time),
                rotary=UNSET if rotary == "C" else rotary,
                **(_of_known_blocks(dynamics, index) if np.isnan(time) else {}),
            )
        )
    return listed


def _of_known_blocks(dynamics: Dynamics, section: int) -> dict[str, Any]:
    """The known part of the time of a section whose time is not known, and each reason with its first line."""
    trace = dynamics.trace
    times = dynamics.times(np.flatnonzero(trace.mode.section == section))
    reasons = [f"{reason} in line {trace.blocks.line_in_file[first]}" for reason, _, first in times.unknown]
    return {"time_known": rounded(times.known), "time_not_known": reasons}


def _offset_rows(trace: Trace) -> Rows:
    """Per section the row whose tool offset counts: the first that is compensated, else G12.1."""
    rows = trace.mode.sections.enter.copy()
    first = np.flatnonzero(trace.mode.first_in_section(trace.compensation.compensates))
    rows[trace.mode.section[first]] = first
    return rows


def radius_source(trace: Trace, row: int) -> str:
    """Where R of the offset in force in a row comes from, as in PolarSection."""
    if np.isnan(trace.compensation.radius[row]):
        return "none"
    if trace.offsets.radius_set_in[row] >= 0:
        return "program"
    tool = trace.tools.of_job.get(int(trace.tools.offset_number[row]))
    if trace.offsets.radius_is_from_comment[row] or tool is None:
        return "comment"
    return tool.source


def _of_sections(sections: Sections, values: Floats, fold: np.ufunc, none: float) -> Floats:
    """Per section the least or the largest of the values of its rows; NaN where there is none, or one is not known."""
    # From each G12.1 to its end, and from there to the next, which is left out.
    bounds = np.column_stack((sections.enter, sections.leave)).ravel()
    folded: Floats = fold.reduceat(np.append(values, none), bounds)[::2]
    folded[np.isinf(folded)] = np.nan
    return folded


def _fastest(trace: Trace, c_feed: Floats, highest: Floats) -> Rows:
    """Per section the first row with its highest rate of C; -1 where that is not known, or C does not turn."""
    is_highest: Mask = (
        (trace.mode.section >= 0) & (c_feed > 0) & (c_feed == np.append(highest, np.nan)[trace.mode.section])
    )
    rows = np.flatnonzero(is_highest)[::-1]
    return column_at(len(trace.mode.sections), trace.mode.section[rows], rows, -1)


def _ramp_used(trace: Trace, ramps: Ramps) -> Floats:
    """Per section how much of a start-up or offset cancel its R needs, the highest."""
    is_ramp = (trace.compensation.starts_up | trace.compensation.cancels) & (trace.path.length != 0)
    return _of_sections(trace.mode.sections, np.where(is_ramp, ramps.used, -np.inf), np.maximum, -np.inf)


# ---- doubtful keys of the profile ----

#: Keys that every polar section rests on.
_OF_SECTIONS = ("polar.x", "polar.virtual_axis", "polar.zero_angle", "limits.c_feed")
#: What X words outside the mode are, in a program with a word that says so and without one.
_X_KEYS = ("control.x", "control.x_without_words")
#: Keys that a section rests on that has no limit of C of the lathe.
_WITHOUT_LIMIT = ("limits.c_feed_suspicious",)
#: Keys that a section rests on in which such codes are written.
_WITH_CODES = {"arcs.tolerance": ("G2", "G3"), "feed.dwell_words": ("G4",), "feed.dwell_per_revolution": ("G4",)}
_CODES = ("g_codes", "m_codes")


def with_doubts(report: FileReport, runs: Sequence[tuple[str, Tables]], doubtful: Sequence[str]) -> FileReport:
    """Add the doubtful keys that a report rests on. doubtful: those of the profile, `polar.x`."""
    machine: Machine = runs[0][1]["machine"]
    written = set[str]().union(*(_written(tables["text"]) for _, tables in runs))
    keys = [key for key in doubtful if _rests_on(key, report, machine, written)]
    if not keys:
        return report
    keys.sort(key=lambda key: key not in _X_KEYS)
    settled_by = {
        key: parameter
        for parameter, meaning in machine.known_parameters.items()
        for key in keys
        if key == meaning.key or any(key in values for values in meaning.values.values())
    }
    return msgspec.structs.replace(report, doubtful=keys, doubtful_parameters=settled_by or UNSET)


def _written(text: Text) -> Iterator[str]:
    """Yield the G and M codes of a text, each once."""
    for letter in "GM":
        numbers = code_numbers(text.words.value[text.words.address == ord(letter)])
        present = mask_at(CODE_LIMIT + 1, numbers)
        yield from (f"{letter}{number / 10:g}" for number in present[:-1].nonzero()[0].tolist())


@functools.lru_cache(500)
def _one_by_one(codes: tuple[object, ...]) -> frozenset[str]:
    """Return the codes of a list of the profile, ranges one by one; numbers in it are no codes."""
    return frozenset(expanded(code for code in codes if isinstance(code, str)))


def _rests_on(key: str, report: FileReport, machine: Machine, written: set[str]) -> bool:
    group, _, name = key.partition(".")
    if group in _CODES or getattr(machine, group, None) is machine.system:
        codes = getattr(getattr(machine, group), name, None)
        return isinstance(codes, list) and not written.isdisjoint(_one_by_one(tuple(codes)))
    if key == "control.units":
        return written.isdisjoint((*machine.codes("inch"), *machine.codes("mm")))
    if not report.polar_sections:
        return False
    if key in _X_KEYS:
        control = machine.control
        switches = (*control.x_radius_words, *control.x_diameter_words, *control.x_absolute_diameter_words)
        is_without = bool(control.x_without_words) and written.isdisjoint(word.partition(" ")[0] for word in switches)
        return is_without == (key == "control.x_without_words")
    if key in _WITH_CODES:
        return not written.isdisjoint(_WITH_CODES[key])
    if key in _WITHOUT_LIMIT:
        return any(section.c_feed_limit is None and section.c_feed is not None for section in report.polar_sections)
    if group == "compensation":
        return any(section.ramp_used is not None for section in report.polar_sections)
    if group == "severities":
        return machine.severities.get(name) == "off"
    return key in _OF_SECTIONS
