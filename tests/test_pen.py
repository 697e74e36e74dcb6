"""The pen writes sections for every machine, which reads back the geometry that was asked for."""

from __future__ import annotations

import cmath
import math

import numpy as np
import pytest
from programs import machine_of, report_of, tables_of
from setter_dialects import DIALECTS

from polarcheck.columns.trace import Trace
from polarcheck.program.machines import profiles
from polarcheck.rewrite.writing.pen import Pen
from polarcheck.rewrite.writing.style import Style

#: A straight move and arcs of 90, 36.87, 180 and 360 deg, as (end, center, counterclockwise).
CONTOUR = [
    (40 + 0j, None, False),
    (40 + 10j, None, False),
    (30 + 20j, 30 + 10j, True),
    (30 - 20j, 30 + 0j, True),
    (30 - 20j, 30 - 15j, False),
    (26.123 - 19.4567j, None, False),
    (33.123 - 18.4567j, 29.123 - 15.4567j, False),
    (20 + 0j, None, False),
]
#: What is no matter of the section.
AROUND = ("no-tool-offset-at-entry", "live-tool-stopped-in-cut", "main-spindle-running-at-entry")


def head(machine: str, inch: bool) -> str:
    """What stands before a section, in the words of the machine as test_pen knows them."""
    dialect = DIALECTS.get(machine, DIALECTS["mazak-eia"] if machine == "mazak-integrex" else None)
    profile = machine_of(machine)
    system = profile.system
    blocks = ["O1" if profile.writing.program_head else "", *(system.inch[-1:] if inch else system.mm[-1:])]
    blocks += ["G90" if system.absolute[:1] == ["G90"] else "", "G40"]
    if dialect:
        blocks += [dialect.engage, dialect.reference, dialect.spindle]
    blocks += [system.feed_per_minute[0], *(["G0"] if profile.writing.rapid_in_mode else [])]
    x = 50 * (2 if profile.control.x == "diameter" and profile.control.x_without_words != "radius" else 1)
    scale = 25.4 if inch else 1
    blocks.append(f"G0 X{x / scale:.4f} C0 Z{5 / scale:.4f}".replace("C0", "" if machine == "fagor-8055t" else "C0"))
    return "\n".join(block for block in blocks if block) + "\n"


def program(machine: str, inch: bool, style: Style) -> tuple[str, int, int]:
    """A program with a section of CONTOUR, and the first and the last line of that section."""
    pen = Pen(machine_of(machine), style, inch)
    blocks = pen.enter(50 + 0j, 5.0)
    blocks += pen.rapid(45 + 0j)
    blocks += pen.line(z=-2.0, feed=100)
    for end, center, ccw in CONTOUR:
        blocks += pen.line(end, feed=200) if center is None else pen.arc(end, center, ccw, feed=200)
    if pen.machine.writing.helices:
        blocks += pen.arc(20 + 0j, 15 + 0j, True, z=-3.0)
    blocks += pen.line(20 + 0j, 5.0, feed=400) if pen.machine.polar.other_axes != "forbidden" else pen.line(z=5.0)
    blocks += pen.rapid(50 + 0j)
    blocks += pen.leave()
    before = head(machine, inch)
    first = before.count("\n") + 1
    return before + "".join(style.blank.join(block.words) + "\n" for block in blocks) + "M30\n", first, len(blocks)


def path_of(trace: Trace, step: float) -> list[complex]:
    """Points along the moves of the section: the ends, and of arcs the middle."""
    points = []
    for row in np.flatnonzero(trace.path.travels & (trace.mode.section >= 0)):
        start, end, center = complex(trace.path.start[row]), complex(trace.path.end[row]), trace.path.center[row]
        if trace.path.is_arc[row]:
            turn = 1 if trace.axes.motion[row] == 3 else -1
            sweep = (
                cmath.phase((end - center) / (start - center)) * turn % math.tau
                if abs(end - start) > step
                else math.tau
            )
            points.append(center + (start - center) * cmath.exp(0.5j * turn * sweep))
        points.append(end)
    return points


def distance(point: complex, start: complex, end: complex, center: complex | None, ccw: bool) -> float:
    """The distance of a point from a move [mm]."""
    if center is None:
        way = end - start
        share = min(max(((point - start) * way.conjugate()).real / abs(way) ** 2, 0.0), 1.0) if way else 0.0
        return abs(point - start - share * way)
    turn = 1 if ccw else -1
    sweep = cmath.phase((end - center) / (start - center)) * turn % math.tau if end != start else math.tau
    along = cmath.phase((point - center) / (start - center)) * turn % math.tau
    ends = min(abs(point - start), abs(point - end))
    return min(ends, abs(abs(point - center) - abs(start - center))) if along <= sweep else ends


Moves = list[tuple[complex, complex | None, bool]]


def largest_distance(points: list[complex], moves: Moves, start: complex) -> float:
    """The largest distance of points from the moves [mm]."""
    starts = [start, *(end for end, _, _ in moves)]
    return max(min(distance(point, *move) for move in pairs(starts, moves)) for point in points)


def pairs(starts: list[complex], moves: Moves) -> list[tuple[complex, complex, complex | None, bool]]:
    return [(begin, *move) for begin, move in zip(starts[:-1], moves, strict=True)]


@pytest.mark.ci
@pytest.mark.one_in(14)
@pytest.mark.parametrize("inch", [False, True], ids=["mm", "inch"])
@pytest.mark.parametrize("machine", profiles.names())
def test_a_section_reads_back_as_it_was_asked_for(machine: str, inch: bool) -> None:
    profile = machine_of(machine)
    if inch and not profile.system.inch:
        pytest.skip("the unit is a parameter there")
    text, first, count = program(machine, inch, Style())
    trace: Trace = tables_of(text, machine)["trace"]
    lines = range(first, first + count)
    report = report_of(text, machine)
    faults = [each for each in report.findings if each.line in lines and each.severity in ("error", "warning")]
    assert [each.message for each in faults if each.rule not in AROUND] == [], text
    assert len(trace.mode.sections) == 1
    step = 0.00254 if inch else 0.001
    back = path_of(trace, step)
    way = [(45 + 0j, None, False), *CONTOUR]
    if profile.writing.helices:
        way.append((20 + 0j, 15 + 0j, True))
    assert largest_distance(back, [*way, (50 + 0j, None, False)], 50 + 0j) < 1.5 * step
    for end, _, _ in way:
        assert min(abs(point - end) for point in back) < step
    rows = np.flatnonzero(trace.path.travels & (trace.mode.section >= 0))
    assert min(trace.path.z[rows]) == pytest.approx(-3 if profile.writing.helices else -2, abs=step)
    cuts = trace.axes.motion[rows] > 0
    assert 200.0 in {round(feed, 1) for feed in trace.feedrate.feed[rows][cuts].tolist()}


@pytest.mark.parametrize("growth", [0.0, 0.00127, -0.00254, 0.00254])
@pytest.mark.parametrize("sweep", [30, 60, 89.9])
def test_an_arc_by_radius_runs_between_ends_of_two_radii(sweep: float, growth: float) -> None:
    """
    An arc whose ends are rounded to 0.0001 inch grows by up to 0.00254 mm. By L it is one block all the same.

    The circle through both written ends is computed here from the chord. Both arcs meet at the ends but for rounding;
    a radius that grows evenly with the angle leaves a circle through its ends by less than 0.03 of the growth, and a
    rounded L moves the middle of the chord by (1 / cos(sweep / 2) - 1) / 2 least increments at most.
    """
    machine, step = machine_of("okuma-osp"), 0.001
    center, turn = 3.111 - 2.345j, math.radians(sweep)
    for radius in (3.11912, 7.3406, 12.3456, 31.98765):
        end = center + (radius + growth) * cmath.exp(1j * (0.4 + turn))
        start = center + radius * cmath.exp(0.4j)
        pen = Pen(machine)
        pen.enter(start, 0.0)
        pen.line(start)
        (block,) = pen.arc(end, center, True, feed=100)
        words = {word[0]: float(word[1:]) for word in block.words}
        assert block.words[0] == "G103"
        first = complex(round(start.real, 3), round(start.imag, 3))
        chord = complex(words["X"], words["Y"]) - first
        height = math.sqrt(words["L"] ** 2 - abs(chord) ** 2 / 4)
        written_center = first + chord / 2 + 1j * chord / abs(chord) * height
        allowed = step * (math.sqrt(0.5) + (1 / math.cos(turn / 2) - 1) / 2) + 0.03 * abs(growth)
        for share in np.linspace(0, 1, 33):
            point = center + (radius + growth * share) * cmath.exp(1j * (0.4 + turn * share))
            assert abs(abs(point - written_center) - words["L"]) < allowed, (radius, share)
