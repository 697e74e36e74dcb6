"""What a program makes: the shapes of its finished part, section by section and depth by depth."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import groupby
from typing import TYPE_CHECKING, NamedTuple

import msgspec
import numpy as np

from polarcheck.checking.channels import first_runs
from polarcheck.checking.phrases.offsets import called_tool, to_give
from polarcheck.checking.phrases.part import Sizes, shape_in_words
from polarcheck.checking.quantity import rounded
from polarcheck.checking.tables import Tables
from polarcheck.errors import TooHardError
from polarcheck.finding import FileReport, LeftStanding, MadeShape, OddSide
from polarcheck.geometry.shapes.shape import SAME, Shape
from polarcheck.geometry.tolerances import ROUNDING
from polarcheck.machines.modal import Units
from polarcheck.parts.as_meant import as_meant
from polarcheck.time_limit import keep_time

if TYPE_CHECKING:
    from polarcheck.columns.trace import Trace
    from polarcheck.table.finished import Finished, Level
    from polarcheck.table.overcuts import Overcuts


def part_of(report: FileReport, runs: Sequence[tuple[str, Tables]]) -> FileReport:
    """The report with what the program makes, in its first run and in each channel."""
    made: list[MadeShape] = []
    for _, tables in first_runs(runs):
        channel = tables["text"].source.channel
        made += [msgspec.structs.replace(one, channel=channel) if channel else one for one in made_by(tables)]
    return msgspec.structs.replace(report, part=made)


#: More shapes than these are no line.
_IN_ONE_LINE = 4


class _Depth(NamedTuple):
    """What one depth of a section makes. radius: R of the cutter [mm], NaN if not known. needs: as in MadeShape."""

    section: int
    z: float
    radius: float
    shapes: list[Shape]
    needs: str | None


def made_by(tables: Tables) -> list[MadeShape]:
    """What one run makes, an entry for each shape of each section, with all its depths."""
    trace: Trace = tables["trace"]
    if not len(trace.mode.sections):
        return []
    try:
        return _by_section(trace, tables)
    except TooHardError as error:
        return [_nothing(trace, section, str(error)) for section in range(len(trace.mode.sections))]


def in_one_line(tables: Tables) -> str:
    """
    What one run makes, as short as it is true: `hexagon, 30.000 across flats, to Z-5.000`.

    Empty where not all of it is known, or where it takes too long.
    """
    trace: Trace = tables["trace"]
    try:
        groups = [*_merged(_depths(tables))]
    except TooHardError:
        return ""
    shapes = [(group, shape) for group in groups for shape in group[0].shapes]
    if not all(group[0].shapes for group in groups) or not 0 < len(shapes) <= _IN_ONE_LINE:
        return ""
    row = int(trace.mode.sections.enter[0])
    sizes = Sizes(bool(trace.lengths.units[row] == Units.INCH))
    parts = []
    for depth, made in groupby(shapes, lambda pair: _deepest(pair[0], sizes)):
        words = [_words(trace, shape, _row_of(trace, group, shape), short=True) for group, shape in made]
        parts.append(f"{'; '.join(dict.fromkeys(words))}, {depth}")
    needs = dict.fromkeys(group[0].needs.partition(",")[0] for group in groups if group[0].needs)
    return "; ".join(parts) + (f" ({', '.join(needs)})" if needs else "")


def _deepest(group: Sequence[_Depth], sizes: Sizes) -> str:
    known = [depth.z for depth in group if not np.isnan(depth.z)]
    return f"to Z{sizes(min(known))}" if known else "to Z not known"


def _depths(tables: Tables) -> list[_Depth]:
    """All depths of all sections; raises TooHardError where that takes too long."""
    from polarcheck.parts.tool_paths import depths_of_paths

    return [*_of_contours(tables), *(_Depth(*one) for one in depths_of_paths(tables))]


def _by_section(trace: Trace, tables: Tables) -> list[MadeShape]:
    """The same; raises TooHardError where it takes too long."""
    found = _depths(tables)
    standing = _ribs_and_strips(tables)
    made = []
    for section in range(len(trace.mode.sections)):
        own = [depth for depth in found if depth.section == section]
        entries = [*_entries(trace, own)]
        left = [one for number, one in standing if number == section]
        if left and entries:
            entries[0] = msgspec.structs.replace(entries[0], left_standing=[*entries[0].left_standing, *left])
        entries = entries or [_nothing(trace, section, _why_nothing(tables, section))]
        made += [msgspec.structs.replace(entries[0], as_meant=as_meant(trace, section) or None), *entries[1:]]
    return made


def shapes_of_level(trace: Trace, level: Level) -> list[Shape]:
    """What the contours of one depth make."""
    from polarcheck.geometry.shapes.shapes import shapes_of

    return [] if level.tangled else shapes_of(level.outline, level.gap, _bar(trace))


def level_in_words(trace: Trace, level: Level) -> str:
    """The same as text, in the units of the program; empty where nothing is to be told."""
    shapes = shapes_of_level(trace, level)
    return "; ".join(_words(trace, shape, int(level.walls.row[0])) for shape in shapes)


def _bar(trace: Trace) -> float:
    diameter = trace.lengths.stock_diameter[trace.compensation.compensates]
    return float(diameter[0]) if len(diameter) else np.nan


def _words(trace: Trace, shape: Shape, row: int, short: bool = False) -> str:
    sizes = Sizes(bool(trace.lengths.units[row] == Units.INCH))
    return shape_in_words(shape, lambda at: int(trace.blocks.line_in_file[at]), sizes, short)


def _row_of(trace: Trace, group: Sequence[_Depth], shape: Shape) -> int:
    return shape.row if shape.row >= 0 else int(trace.mode.sections.enter[group[0].section])


# ---- contours with G41 and G42 ----


def _of_contours(tables: Tables) -> Iterator[_Depth]:
    trace: Trace = tables["trace"]
    finished: Finished = tables["finished"]
    for level in finished.levels:
        why = "its contour crosses itself too often to say what it makes" if level.tangled else None
        yield _Depth(level.section, level.z, level.radius, shapes_of_level(trace, level), why)
    for level in finished.meant:
        row = int(level.walls.row[0])
        why = f"R of {called_tool(trace.tools, row)} is not known, so whether the tool makes it was not looked at"
        shapes = shapes_of_level(trace, level)
        yield _Depth(
            level.section, level.z, np.nan, shapes, f"{why}: {to_give(trace.tools, trace.machine, row, 'radius')}"
        )


def _ribs_and_strips(tables: Tables) -> list[tuple[int, LeftStanding]]:
    """What the tool leaves between passes and where it comes and goes; with the section."""
    trace: Trace = tables["trace"]
    overcuts: Overcuts = tables["overcuts"]
    if not overcuts.compensates:
        return []
    coverage = tables["coverage"]
    found = []
    for kind, left in (("rib", coverage.ribs), ("strip", coverage.strips)):
        for row in np.flatnonzero(left.height > 0).tolist():
            sizes = Sizes(bool(trace.lengths.units[row] == Units.INCH))
            place, line = complex(left.place[row]), int(trace.blocks.line_in_file[row])
            size = float(left.height[row])
            how = "high" if kind == "rib" else "thick"
            text = f"a {kind} {sizes(size)} {how} behind line {line}, at x {sizes(place.real)} c {sizes(place.imag)}"
            told = LeftStanding(
                kind=kind, text=text, line=line, size=round(size, 6), place=(round(place.real, 6), round(place.imag, 6))
            )
            found.append((int(trace.mode.section[row]), told))
    return found


# ---- entries ----


def _merged(depths: Sequence[_Depth]) -> Iterator[list[_Depth]]:
    """The depths that make the same shapes are one group; in their order."""
    groups: list[list[_Depth]] = []
    for depth in depths:
        keep_time()
        same = next((group for group in groups if _are_same(group[0], depth)), None)
        if same is None:
            groups.append([depth])
        else:
            same.append(depth)
    yield from groups


def _entries(trace: Trace, depths: Sequence[_Depth]) -> Iterator[MadeShape]:
    """One entry for each shape, whatever the number of depths at which it is made."""
    for group in _merged(depths):
        first = group[0]
        if not first.shapes and first.needs:
            yield _nothing(trace, first.section, first.needs)
        for shape in first.shapes:
            yield _entry(trace, group, shape)


def _are_same(one: _Depth, other: _Depth) -> bool:
    return (
        len(one.shapes) == len(other.shapes) and one.needs == other.needs and all(map(_alike, one.shapes, other.shapes))
    )


def _alike(one: Shape, other: Shape) -> bool:
    if (one.name, one.inside, len(one.odd)) != (other.name, other.inside, len(other.odd)):
        return False
    if one.values.keys() != other.values.keys():
        return False
    return all(abs(value - other.values[name]) <= 2 * SAME for name, value in one.values.items() if name != "area")


def _entry(trace: Trace, group: Sequence[_Depth], shape: Shape) -> MadeShape:
    first = group[0]
    row = _row_of(trace, group, shape)
    sizes = Sizes(bool(trace.lengths.units[row] == Units.INCH))
    known = [depth.z for depth in group if not np.isnan(depth.z)]
    line, end_line = _lines(trace, first.section)
    odd = [OddSide(line=int(trace.blocks.line_in_file[side.row]), size=round(side.size, 6)) for side in shape.odd]
    words = _words(trace, shape, row)
    return MadeShape(
        line=line,
        end_line=end_line,
        z=rounded(min(known)) if known else None,
        depths=[round(z, 6) for z in known],
        shape=shape.name,
        inside=shape.inside,
        is_regular=shape.is_regular,
        values={name: round(value, 6) + 0.0 for name, value in shape.values.items()},
        odd=odd,
        text=f"{words}; {_depths_in_words(known, sizes)}",
        left_standing=[*_corners_left(shape, first.radius, sizes)],
        needs=first.needs,
    )


def _depths_in_words(depths: Sequence[float], sizes: Sizes) -> str:
    """`to Z-6.000 in 3 passes, 2.000 each`; the passes of one depth count once."""
    if not depths:
        return "to Z not known"
    deep = sorted({round(z, 6) for z in depths}, reverse=True)
    text = f"to Z{sizes(deep[-1])}"
    if len(deep) == 1:
        return text
    steps = -np.diff(deep)
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


def _lines(trace: Trace, section: int) -> tuple[int, int]:
    """Of the G12.1 and of the end of a section."""
    sections = trace.mode.sections
    enter, last = int(sections.enter[section]), min(int(sections.last[section]), len(trace) - 1)
    return int(trace.blocks.line_in_file[enter]), int(trace.blocks.line_in_file[last])


def _nothing(trace: Trace, section: int, needs: str) -> MadeShape:
    line, end_line = _lines(trace, section)
    return MadeShape(
        line=line,
        end_line=end_line,
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
    from polarcheck.parts.tool_paths import above_the_face

    own = trace.mode.section == section
    if not (own & trace.path.cuts & trace.path.on_plane & ~above_the_face(trace)).any():
        return "it cuts nothing in the plane"
    if not (own & trace.compensation.compensates).any():
        return "its path is nowhere as long as the cutter is wide at one Z"
    return "its contour leaves nothing standing that could be told: a position is not known, or it does not close"
