"""
The shapes of the finished part of a program, section by section and depth by depth.

All are in the frame of the part, whose x runs towards C0: C at G12.1 is added to angles and turns points. Where it is
not known they are given as the section writes them.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from itertools import groupby
from typing import TYPE_CHECKING

import msgspec
import numpy as np

from polarcheck.checking.channel_reports import first_runs
from polarcheck.columns.filling import last_row
from polarcheck.foundation.errors import TooHardError
from polarcheck.foundation.finding import FileReport, LeftStanding, MadeInSection, MadeShape, OddSide
from polarcheck.foundation.states import Units
from polarcheck.geometry.shapes.shape import SAME, Shape
from polarcheck.geometry.tolerances import ROUNDING
from polarcheck.parts.as_meant import as_meant
from polarcheck.parts.depth_areas import known_of
from polarcheck.parts.made_depths import Depth, merged, put_together
from polarcheck.reports.made_parts.differing_depths import Area, with_differences
from polarcheck.rules.quantity import rounded
from polarcheck.rules.tables import Tables
from polarcheck.rules.wording.offsets import called_tool, to_give
from polarcheck.rules.wording.part import Manner, Sizes, angle_in_words, shape_in_words
from polarcheck.rules.wording.written import switch

if TYPE_CHECKING:
    from polarcheck.columns.contour.overcuts import Overcuts
    from polarcheck.columns.metal.finished import Finished, Level
    from polarcheck.columns.trace import Trace
    from polarcheck.program.machines.job import Job


def part_of(report: FileReport, runs: Sequence[tuple[str, Tables]]) -> FileReport:
    """The report with what the program makes, in its first run and in each channel."""
    shapes: list[MadeShape] = []
    for _, tables in first_runs(runs):
        channel = tables["text"].source.channel
        shapes += [msgspec.structs.replace(shape, channel=channel) if channel else shape for shape in made_by(tables)]
    return msgspec.structs.replace(report, part=shapes)


#: More shapes than these are no line.
_IN_ONE_LINE = 4
#: Words for a round or a chamfer at the end of a block, as they are named where they are not simulated.
_CORNER_WORDS = ("RND=", "RNDM=", "CHF=", "CHR=")
#: More angles than these are given by their first and last one, if their steps are the same [deg].
_IN_A_LIST, _SAME_STEP = 8, 1e-3


def made_by(tables: Tables) -> list[MadeShape]:
    """The part of one run: an entry for each shape of each section, with all its depths."""
    trace: Trace = tables["trace"]
    if not len(trace.mode.sections):
        return []
    try:
        return _by_section(trace, tables)
    except TooHardError as error:
        return [_nothing(trace, (section,), str(error)) for section in range(len(trace.mode.sections))]


def in_one_line(tables: Tables) -> str:
    """
    The part of one run in one line: `hexagon, 30.000 across flats, to Z-5.000`.

    Empty where not all of it is known, or where it takes too long.
    """
    trace: Trace = tables["trace"]
    try:
        groups = merged(depths_of(tables))
    except TooHardError:
        return ""
    shapes = [(group, shape) for group in groups for shape in group[0].shapes]
    is_whole = all(group[0].shapes for group in groups) and not _missing(trace, 0)
    if not is_whole or not 0 < len(shapes) <= _IN_ONE_LINE:
        return ""
    sizes, into = _sizes(trace, int(trace.mode.sections.enter[0])), tables["upright"].path.z_sense
    parts = []
    for depth, alike in groupby(shapes, lambda pair: _deepest(pair[0], sizes, into)):
        words = [_words(trace, shape, group[0], short=True) for group, shape in alike]
        parts.append(f"{'; '.join(dict.fromkeys(words))}, {depth}")
    needs = dict.fromkeys(group[0].needs.partition(",")[0] for group in groups if group[0].needs)
    return "; ".join(parts) + (f" ({', '.join(needs)})" if needs else "")


def _deepest(group: Sequence[Depth], sizes: Sizes, into: float) -> str:
    depths = _known_depths(group)
    return f"to Z{sizes(_deepest_of(depths, into))}{_floor(group, sizes, into)}" if depths else "to Z not known"


def _floor(group: Sequence[Depth], sizes: Sizes, into: float) -> str:
    """Where the floor of the deepest of these depths ends, if it slopes."""
    known = (depth for depth in group if not np.isnan(depth.z))
    deepest = min(known, key=lambda depth: depth.z * into, default=None)
    is_sloped = deepest is not None and not np.isnan(deepest.bottom)
    return f", the floor slopes to Z{sizes(deepest.bottom)}" if deepest is not None and is_sloped else ""


def depths_of(tables: Tables) -> list[Depth]:
    """All depths of all sections, computed once for a run; raises TooHardError where that takes too long."""
    from polarcheck.reports.made_parts.tool_paths import depths_of_paths

    depths: list[Depth] | None = tables.get("depths")
    if depths is None:
        depths = [*_of_contours(tables), *depths_of_paths(tables)]
        tables.give("depths", depths)
    return depths


def _by_section(trace: Trace, tables: Tables) -> list[MadeShape]:
    """The same; raises TooHardError where it takes too long."""
    depths = depths_of(tables)
    standing = _ribs_and_strips(tables)
    job: Job = tables["job"]
    by_first: dict[int, list[Depth]] = {}
    for depth in depths:
        by_first.setdefault(depth.sections[0], []).append(depth)
    makers = {section for depth in depths if depth.shapes or depth.needs for section in depth.sections}
    report: list[MadeShape] = []
    for section in range(len(trace.mode.sections)):
        of_section = by_first.get(section, [])
        entries = [*_entries(trace, of_section, tables["upright"].path.z_sense)]
        areas = [Area(depth.z, depth.polygon, depth.is_cleared) for depth in of_section if depth.polygon is not None]
        if len(entries) > 1 and len(areas) > 1:
            sizes = _sizes(trace, int(trace.mode.sections.enter[section]))
            entries = [*with_differences(entries, areas, sizes)]
        standing_here = [one for number, one in standing if any(number in depth.sections for depth in of_section)]
        if standing_here and entries:
            entries[0] = msgspec.structs.replace(entries[0], left_standing=[*entries[0].left_standing, *standing_here])
        if missing := _missing(trace, section):
            entries = [entry if entry.shape is None else _replaced_needs(entry, missing) for entry in entries]
        if section not in makers:
            entries = [_nothing(trace, (section,), _why_nothing(tables, section))]
        sections = of_section[0].sections if of_section else (section,)
        if entries:
            intended = "; ".join(filter(None, (as_meant(trace, number) for number in sections)))
            entries[0] = msgspec.structs.replace(entries[0], as_meant=intended or None)
        if job.part:
            is_compared = any(part.section in (None, number + 1) for part in job.part for number in sections)
            entries = [msgspec.structs.replace(entry, is_compared=is_compared) for entry in entries]
        report += entries
    return report


def _missing(trace: Trace, section: int) -> str:
    """
    Why the contour of a section is not what the program writes: a way that is not known, a condition that is not,
    corners by words.
    """
    reasons = (_unknown_way(trace, section), _unknown_condition(trace, section), _sharp_corners(trace, section))
    return "; ".join(filter(None, reasons))


def _sharp_corners(trace: Trace, section: int) -> str:
    """The lines of corners and chamfers that words ask for and that are not simulated, or not known."""
    run, made = trace.run, trace.machine.arcs.made_corners
    blocks = [
        one.block for one in run.remarks if one.kind == "corner-not-made" or one.values.get("name") in _CORNER_WORDS
    ]
    written = trace.blocks.has(*trace.machine.arcs.corners_not_made) | (np.isin(run.block, blocks) if blocks else False)
    in_section = trace.mode.section == section
    rows = in_section & (written | trace.blocks.is_unknown(*made))
    lasting = [word for word, kind in made.items() if kind == "modal-radius"]
    in_force = last_row(trace.blocks.is_unknown(*lasting), trace.blocks.has(*lasting))[in_section]
    rows[in_force[in_force >= 0]] = True
    lines = trace.blocks.line_in_file[rows]
    if not len(lines):
        return ""
    where = ", ".join(map(str, dict.fromkeys(lines.tolist())))
    return f"corners not simulated: the rounds and chamfers of line{'s' * (len(lines) > 1)} {where} are left out"


def _unknown_way(trace: Trace, section: int) -> str:
    """The line of the first block of a section with an unknown end."""
    compensates = trace.compensation.compensates
    mills = np.where(trace.mode.anywhere_in_section(compensates), compensates, trace.path.cuts)
    mills |= trace.path.shape_is_unknown
    is_lost = np.isnan(trace.path.end)
    is_unknown = is_lost | trace.path.shape_is_unknown
    rows = np.flatnonzero((trace.mode.section == section) & mills & trace.path.on_plane & is_unknown)
    if not len(rows):
        return ""
    what = "X or C" if is_lost[rows[0]] else "the way"
    line = int(trace.blocks.line_in_file[rows[0]])
    return f"{what} of line {line} is not known: the contour is told without what is milled there"


def _unknown_condition(trace: Trace, section: int) -> str:
    """The line of a condition of unknown value in a section: which of its blocks run is not known."""
    conditions = [remark.block for remark in trace.run.remarks if remark.kind == "condition-unknown"]
    if not conditions:
        return ""
    executed = np.unique(trace.run.block)
    block_before = executed[np.maximum(np.searchsorted(executed, conditions, side="right") - 1, 0)]
    inside = np.isin(block_before, trace.run.block[trace.mode.section == section])
    if not inside.any():
        return ""
    line = int(trace.text.blocks.line[conditions[int(np.argmax(inside))]])
    return f"the condition of line {line} is not known: the contour is told as if it were not fulfilled"


def _replaced_needs(entry: MadeShape, missing: str) -> MadeShape:
    needs = missing if entry.needs is None else f"{entry.needs}; {missing}"
    return msgspec.structs.replace(entry, needs=needs)


def shapes_of_level(trace: Trace, level: Level) -> list[Shape]:
    """The shapes that the contours of one depth make."""
    from polarcheck.geometry.shapes.shapes import shapes_of

    return [] if level.tangled else shapes_of(level.outline, level.gap, _bar(trace))


def level_in_words(trace: Trace, level: Level) -> str:
    """The shapes of a level of one section in words, in the frame of the part and the units of the program."""
    turn = complex(trace.path.section_turn[level.section])
    if not level.angle and turn != 1:
        level = msgspec.structs.replace(level, outline=level.outline.turned_by(turn))
    depth = Depth(level.sections, level.z, level.radius, shapes_of_level(trace, level))
    return "; ".join(_words(trace, shape, depth) for shape in depth.shapes)


def _bar(trace: Trace) -> float:
    diameter = trace.lengths.stock_diameter[trace.compensation.compensates]
    return float(diameter[0]) if len(diameter) else np.nan


def _sizes(trace: Trace, row: int) -> Sizes:
    return Sizes(bool(trace.lengths.units[row] == Units.INCH))


def _words(trace: Trace, shape: Shape, depth: Depth, short: bool = False) -> str:
    is_known = bool(trace.path.knows_section_entry[depth.sections[0]])
    how = Manner(short=short, from_c0=is_known, switch=_switch(trace, depth.sections[0]))
    line_of = lambda row: int(trace.blocks.line_in_file[row])  # noqa: E731
    return shape_in_words(shape, line_of, _sizes(trace, _row_of(trace, depth, shape)), how)


def _switch(trace: Trace, section: int) -> str:
    """The code that begins a section, as G12.1 or G112."""
    return switch(trace.blocks, trace.machine, int(trace.mode.sections.enter[section]))


def _row_of(trace: Trace, depth: Depth, shape: Shape) -> int:
    return shape.row if shape.row >= 0 else int(trace.mode.sections.enter[depth.sections[0]])


# ---- contours with G41 and G42 ----


def _of_contours(tables: Tables) -> Iterator[Depth]:
    trace: Trace = tables["trace"]
    finished: Finished = tables["finished"]
    yield from _of_levels(trace, finished.of_part, finished.of_sections_put_together, _of_level)
    yield from _of_levels(trace, finished.meant_of_part, finished.meant_put_together, _of_meant_level)


def _of_levels(
    trace: Trace, levels: Sequence[Level], single: Sequence[Level], depth_of: Callable[[Trace, Level], Depth]
) -> Iterator[Depth]:
    """single: the levels of single sections that levels of several sections are put together of."""
    first = [int(single_level.walls.row[0]) for single_level in single]
    for level in levels:
        depth = depth_of(trace, level)
        if len(level.sections) == 1:
            yield depth
        else:
            matches = np.isin(first, level.walls.row)
            yield from put_together(
                depth,
                [depth_of(trace, single_level) for single_level, is_own in zip(single, matches, strict=True) if is_own],
            )


def _of_level(trace: Trace, level: Level) -> Depth:
    why = "its contour crosses itself too often to say what it makes" if level.tangled else None
    return _depth(trace, level, level.radius, why)


def _of_meant_level(trace: Trace, level: Level) -> Depth:
    row = int(level.walls.row[0])
    why = f"R of {called_tool(trace.tools, row)} is not known, so whether the tool makes it was not looked at"
    return _depth(trace, level, np.nan, f"{why}: {to_give(trace.tools, trace.machine, row, 'radius')}")


def _depth(trace: Trace, level: Level, radius: float, needs: str | None) -> Depth:
    shapes, bottom = shapes_of_level(trace, level), level.bottom if level.bottom < level.z - ROUNDING else np.nan
    return Depth(level.sections, level.z, radius, shapes, needs, known_of(level), bottom=bottom)


def _ribs_and_strips(tables: Tables) -> list[tuple[int, LeftStanding]]:
    """Ribs between passes and strips at leads that the tool leaves standing, each with its section."""
    trace: Trace = tables["trace"]
    overcuts: Overcuts = tables["overcuts"]
    if not overcuts.compensates:
        return []
    coverage = tables["coverage"]
    entries = []
    for kind, columns in (("rib", coverage.ribs), ("strip", coverage.strips)):
        for row in np.flatnonzero(columns.height > 0).tolist():
            sizes, section = _sizes(trace, row), int(trace.mode.section[row])
            point = complex(columns.place[row] * trace.path.section_turn[section])
            line = int(trace.blocks.line_in_file[row])
            size = float(columns.height[row])
            how = "high" if kind == "rib" else "thick"
            text = f"a {kind} {sizes(size)} {how} behind line {line}, at x {sizes(point.real)} c {sizes(point.imag)}"
            entry = LeftStanding(
                kind=kind, text=text, line=line, size=round(size, 6), place=(round(point.real, 6), round(point.imag, 6))
            )
            entries.append((section, entry))
    return entries


# ---- entries ----


def _entries(trace: Trace, depths: Sequence[Depth], into: float) -> Iterator[MadeShape]:
    """
    One entry for each shape, whatever the number of depths at which it is made.

    into: 1 where Z falls into the part, -1 where it rises.
    """
    for group in merged(depths):
        first = group[0]
        if not first.shapes and first.needs:
            yield _nothing(trace, first.sections, first.needs)
        for shape in first.shapes:
            yield _entry(trace, group, shape, into)


def _entry(trace: Trace, group: Sequence[Depth], shape: Shape, into: float) -> MadeShape:
    first = group[0]
    sizes = _sizes(trace, _row_of(trace, first, shape))
    depths_known = _known_depths(group)
    sections = _sections(trace, first.sections)
    odd = [OddSide(line=int(trace.blocks.line_in_file[side.row]), size=round(side.size, 6)) for side in shape.odd]
    texts = [
        _words(trace, shape, first),
        _depths_in_words(depths_known, sizes, into) + _floor(group, sizes, into),
        *_left_in_words(trace, first, sizes),
        *_sections_in_words(trace, first, sections),
    ]
    return MadeShape(
        line=sections[0].line,
        end_line=sections[0].end_line,
        sections=sections,
        z=rounded(_deepest_of(depths_known, into)) if depths_known else None,
        depths=[round(z, 6) for z in depths_known],
        shape=shape.name,
        inside=shape.inside,
        is_regular=shape.is_regular,
        values={name: round(value, 6) + 0.0 for name, value in shape.values.items()},
        odd=odd,
        text="; ".join(texts),
        left_standing=[*_corners_left(shape, first.radius, sizes)],
        needs=first.needs,
    )


def _left_in_words(trace: Trace, depth: Depth, sizes: Sizes) -> Iterator[str]:
    """`0.300 left`, where R of all its sections is as much larger than the cutter."""
    used = np.isin(trace.mode.section, depth.sections) & trace.compensation.compensates
    left = trace.offsets.metal_left[used]
    if len(left) and left.min() > 0:
        yield f"{sizes(float(left.min()))} left"


def _sections_in_words(trace: Trace, depth: Depth, sections: Sequence[MadeInSection]) -> Iterator[str]:
    """`C10 at G12.1`, or `by the sections of lines 9, 20, 31 at C0, C120, C240`; nothing for one at C0."""
    angles = [section.angle for section in sections if section.angle is not None]
    if len(sections) == 1:
        if any(angles):
            yield f"{angle_in_words(angles[0])} at {_switch(trace, depth.sections[0])}"
        return
    # A loop or a called program begins its sections in one line.
    lines = list(dict.fromkeys(str(section.line) for section in sections))
    where = f"sections of lines {', '.join(lines)}" if len(lines) > 1 else f"section of line {lines[0]}"
    yield f"by the {where}{f' at {_angles_in_words(angles)}' if any(angles) else ''}"


def _angles_in_words(angles: Sequence[float]) -> str:
    steps = np.diff(angles)
    if len(angles) > _IN_A_LIST and np.ptp(steps) <= _SAME_STEP:
        first, last = angle_in_words(angles[0]), angle_in_words(angles[-1])
        return f"{first} to {last}, {float(steps.mean()):.4g} deg apart"
    return ", ".join(map(angle_in_words, angles))


def _known_depths(group: Sequence[Depth]) -> list[float]:
    """Return the depths of a group [mm]; none where one of them is not known, which may be the deepest."""
    depths = [depth.z for depth in group]
    return [] if np.isnan(depths).any() else depths


def _deepest_of(depths: Sequence[float], into: float) -> float:
    return min(depths, key=lambda z: z * into)


def _depths_in_words(depths: Sequence[float], sizes: Sizes, into: float) -> str:
    """`to Z-6.000 in 3 passes, 2.000 each`; the passes of one depth count once."""
    if not depths:
        return "to Z not known"
    deep = sorted({round(z, 6) for z in depths}, key=lambda z: -z * into)
    text = f"to Z{sizes(deep[-1])}"
    if len(deep) == 1:
        return text
    steps = -np.diff(deep) * into
    even = f", {sizes(float(steps.mean()))} each" if np.ptp(steps) <= ROUNDING + SAME and len(deep) > 2 else ""
    return f"{text} in {len(deep)} passes from Z{sizes(deep[0])}{even}"


def _corners_left(shape: Shape, radius: float, sizes: Sizes) -> Iterator[LeftStanding]:
    """The inside corners that no round cutter reaches into."""
    values = shape.values
    count = int(values.get("inside_corners", 0))
    if count and radius > ROUNDING:
        where = "1 inside corner" if count == 1 else f"{count} inside corners"
        text = f"R{sizes(radius)} of the cutter in {where}"
        if radius > values.get("corner_reach", radius) + SAME:
            text += f"; the walls beside are too short for it: R{sizes(values['corner_reach'])} would reach them"
        yield LeftStanding(kind="corner", text=text, line=None, size=round(radius, 6), count=count)
    if radius > values.get("reach_beyond", radius) + SAME:
        corner = f"R{sizes(radius)} of the cutter, of an inside corner just outside the bar"
        text = f"{corner}: R{sizes(values['reach_beyond'])} would leave nothing"
        yield LeftStanding(kind="corner", text=text, line=None, size=round(radius, 6), count=1)


def _sections(trace: Trace, numbers: Sequence[int]) -> list[MadeInSection]:
    sections, lines = trace.mode.sections, trace.blocks.line_in_file
    return [
        MadeInSection(
            line=int(lines[sections.enter[number]]),
            end_line=int(lines[min(int(sections.last[number]), len(trace) - 1)]),
            angle=_angle(trace, number),
        )
        for number in numbers
    ]


def _angle(trace: Trace, section: int) -> float | None:
    """C at the beginning of a section [deg], from 0 to 360; None where it is not known."""
    if not trace.path.knows_section_entry[section]:
        return None
    return round(float(trace.path.section_entry[section]) % 360, 6) % 360


def _nothing(trace: Trace, numbers: Sequence[int], needs: str) -> MadeShape:
    sections = _sections(trace, numbers)
    return MadeShape(
        line=sections[0].line,
        end_line=sections[0].end_line,
        sections=sections,
        z=None,
        depths=[],
        shape=None,
        inside=False,
        is_regular=False,
        values={},
        odd=[],
        text=f"not known: {needs}",
        needs=needs,
    )


def _why_nothing(tables: Tables, section: int) -> str:
    trace: Trace = tables["trace"]
    from polarcheck.reports.made_parts.tool_paths import above_the_face

    of_section = trace.mode.section == section
    if not (of_section & trace.path.cuts & trace.path.on_plane & ~above_the_face(tables["upright"])).any():
        return "it cuts nothing in the plane"
    if not (of_section & trace.compensation.compensates).any():
        return "its path is nowhere as long as the cutter is wide at one Z"
    return "its contour leaves nothing standing that could be told: a position is not known, or it does not close"
