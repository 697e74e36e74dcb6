"""The cutter, X and C over the time of a section, beside the moves of the trace."""

from __future__ import annotations

import json
import math
import re
from pathlib import Path
from typing import Any

import msgspec
import numpy as np
import pytest
from cases import looped
from click.testing import CliRunner
from test_pictures import ARCS, GROOVE, HEAD, HEXAGON, column, drawn_of, section_of

import polarcheck
from polarcheck.commands import main
from polarcheck.view import rate_curves
from polarcheck.view.picture_data import SectionPicture

SAMPLES = Path("sample_programs")
NEAR_CENTER = HEAD + "G1 X50. C.05 F400\nX-50.\nC10.\nX3.\nG2 X-1. C-.4 R12.\nG1 X80.\nG13.1\nM30\n"
WITH_Z = HEAD + "G1 X40. F200\nZ-1. C5.\nG4 P800\nZ-3.\nX-10. C-12. Z-4.\nG13.1\nM30\n"
INCH = "G20 G98 G40 T0808\nG0 X4. C0 Z.1\nG12.1\nG1 Z-.1 F10.\nG42 X1. F8.\nC.5\nX-1.\nC-.5\nX1.\nC0\nG40 X4.\nG13.1\n"
#: Through the center along X, on an arc, and to it and back in another direction.
CENTER = HEAD + "G1 X40. F200\nX-40.\nC5.\nX20. C0\nG2 X0 C10. I-5. J5.\nG1 X-20. C0\nX0\nC8.\nX60.\nG13.1\nM30\n"


def state(start: complex, end: complex, center: complex, kind: str, share: float) -> tuple[complex, float]:
    """The point at a share of a move, and what the point has turned about C0 since its start [deg], in small steps."""
    part = np.linspace(0.0, share, 4001)
    points = start + part * (end - start)
    if kind != "line":
        sign = 1 if kind == "ccw" else -1
        sweep = sign * ((sign * np.angle((end - center) / (start - center))) % (2 * math.pi) or 2 * math.pi)
        points = center + (start - center) * np.exp(1j * sweep * part)
    seen = points[np.abs(points) > 1e-7]
    return complex(points[-1]), float(np.degrees(np.angle(seen[1:] / seen[:-1]).sum()))


def compare_with_trace(section: SectionPicture, moves: Any, sense: int = 1, side: int = 1) -> int:
    """Compare the curves of a section with its moves in the trace, at ten shares of each; how many moves."""
    table, curves = section.moves, section.rates
    t, move = column(curves.t), np.array(curves.move)
    drawn = {name: column(getattr(curves, name)) for name in ("x", "c", "z", "angle", "machine_x")}
    centers = table.center
    moving = [
        number
        for number in range(len(table.line))
        if table.start[number] != table.end[number] or centers[number] is not None
    ]
    assert len(moving) == len(moves)
    count = 0
    for number, trace in zip(moving, moves, strict=True):
        own, time, begin = np.flatnonzero(move == number), table.time[number], table.begin[number]
        if time is None or begin is None or table.jump[number]:
            continue
        assert table.angle[number] == pytest.approx(trace.c_axis[0], abs=1e-3)
        for share in (np.arange(10) + 0.37) / 10:
            point, turn = state(trace.start[0], trace.end[0], trace.center[0], str(trace.kind[0]), share)
            at = {name: float(np.interp(begin + share * time, t[own], values[own])) for name, values in drawn.items()}
            assert complex(at["x"], at["c"]) == pytest.approx(point, abs=0.01)
            assert at["angle"] == pytest.approx(trace.c_axis[0, 0] + sense * turn, abs=0.1)
            assert at["machine_x"] == pytest.approx(side * abs(point), abs=0.01)
            if np.isfinite(trace.z[0]).all():
                assert at["z"] == pytest.approx(trace.z[0, 0] + share * (trace.z[0, 1] - trace.z[0, 0]), abs=0.01)
        count += 1
    return count


def moves_of(trace: Any) -> list[Any]:
    return [trace[number : number + 1] for number in range(len(trace))]


CASES: dict[str, tuple[str, dict[str, Any], int, int]] = {
    "hexagon": (HEXAGON, {}, 1, 1),
    "arcs": (ARCS, {}, 1, 1),
    "groove": (GROOVE, {}, 1, 1),
    "near the center": (NEAR_CENTER, {}, 1, 1),
    "Z and dwells": (WITH_Z, {}, 1, 1),
    "inch": (INCH, {}, 1, 1),
    "C at entry": (HEXAGON.replace("C0 Z2.", "C210. Z2."), {}, 1, 1),
    "X below 0": (HEXAGON.replace("G0 X80.", "G0 X-80."), {}, 1, -1),
    "radius programming": (HEXAGON, {"control": {"x": "radius"}}, 1, 1),
    "C the other way": (HEXAGON, {"polar": {"zero_angle": "at-c0-reversed"}}, -1, 1),
    "clamped": (HEXAGON, {"limits": {"polar_feed": 150.0}}, 1, 1),
}


@looped("case", CASES, one_in=12)
def test_the_cutter_x_and_c_are_those_of_the_trace(case: str) -> None:
    program, changes, sense, side = CASES[case]
    radius = 0.25 if case == "inch" else 4.0
    section = section_of(program, f"8:radius={radius}", changes=changes)
    flat = {f"{table}.{key}": value for table, keys in changes.items() for key, value in keys.items()}
    trace = polarcheck.trace_text(program, machine="fanuc", changes=flat, tools={8: radius})
    assert section.sense == sense
    assert compare_with_trace(section, moves_of(trace), sense, side) >= 3


@pytest.mark.ci
@looped("path", ["rotary-a/contour.nc", "second-spindle/contour.nc", "siemens-transmit"], one_in=3)
def test_samples_of_other_lathes_are_drawn_as_their_trace(path: str) -> None:
    file = SAMPLES / path
    file = next(iter(sorted(each for each in file.iterdir() if each.suffix != ".toml"))) if file.is_dir() else file
    trace = polarcheck.trace(file)
    page = CliRunner().invoke(main, ["plot", str(file)]).output
    (data,) = re.findall(r'<script type="application/json"[^>]*>(.*?)</script>', page, re.DOTALL)
    sections = msgspec.convert(json.loads(data)[0]["sections"], list[SectionPicture])
    moves = moves_of(trace)
    compared = [
        compare_with_trace(section, [move for move in moves if move.section[0] == number], section.sense)
        for number, section in enumerate(sections)
    ]
    assert sum(compared) >= 3


@pytest.mark.nightly
def test_in_the_center_c_jumps_by_half_a_turn() -> None:
    section = section_of(CENTER)
    moves, curves = section.moves, section.rates
    jumps = [block for block, jumps in zip(moves.block, moves.jump, strict=True) if jumps]
    assert jumps == ["X-40.", "G2 X0 C10. I-5. J5.", "C8."]
    t, angle, x = column(curves.t), column(curves.angle), column(curves.x)
    (at,) = np.flatnonzero((np.abs(np.diff(angle)) > 100) & (np.array(curves.move[1:]) == 1))
    assert t[at] == t[at + 1]
    assert (x[at], x[at + 1]) == (0, 0)
    assert angle[at + 1] - angle[at] == 180
    assert curves.c_feed[at] is curves.c_feed[at + 1] is None
    assert (curves.x_feed[at], curves.x_feed[at + 1]) == (-200, 200)
    assert curves.machine_x[at] == 0
    assert moves.angle[1] == (0, 180)
    # On the arc C turns by a quarter, and by half a turn at once.
    arc = np.array(curves.move) == jumps_at(moves, "G2")
    assert np.sort(np.diff(angle[arc]))[-1] == 180
    assert abs(angle[arc][-1] - angle[arc][0]) == pytest.approx(90, abs=1e-3)


def jumps_at(moves: Any, code: str) -> int:
    return next(number for number, block in enumerate(moves.block) if block.startswith(code))


def test_under_override_the_tool_waits_in_the_center() -> None:
    limits = {"c_feed": 3600.0, "automatic_override": True, "override_share": 100.0}
    section = section_of(HEAD + "G1 X40. F200\nX-40.\nG13.1\nM30\n", changes={"limits": limits})
    curves = section.rates
    t, angle = column(curves.t), column(curves.angle)
    (at,) = np.flatnonzero(np.abs(np.diff(angle)) > 100)
    # Half a turn at 3600 deg/min.
    assert t[at + 1] - t[at] == pytest.approx(3.0, abs=1e-4)
    assert (curves.c_feed[at], curves.c_feed[at + 1]) == (3600, 3600)
    assert t[-1] == pytest.approx(section.time, abs=1e-3)


@pytest.mark.ci
def test_where_c_is_held_its_rate_is_the_slope_of_its_angle() -> None:
    limits = {"c_feed": 2000.0, "automatic_override": True, "override_share": 100.0}
    section = section_of(HEAD + "G1 X2. C10. F500\nC-10. F400\nX80.\nG13.1\nM30\n", changes={"limits": limits})
    chosen = np.array(section.rates.move) == 1
    t, angle = column(section.rates.t)[chosen], column(section.rates.angle)[chosen]
    point = column(section.rates.x)[chosen] + 1j * column(section.rates.c)[chosen]
    assert np.abs(point.real - 1).max() < 1e-4
    assert angle == pytest.approx(np.degrees(np.angle(point)), abs=5e-3)
    moves_on = np.diff(t) > 1e-3
    slope = np.abs(np.diff(angle))[moves_on] / np.diff(t)[moves_on] * 60
    assert slope.max() == pytest.approx(2000, rel=3e-3)


def test_many_points_are_left_out_where_the_curves_are_straight() -> None:
    count = 700
    zeros = np.zeros(count)
    angle = np.linspace(0, 90, count)
    curves = rate_curves.Samples(
        move=np.arange(count),
        t=np.linspace(0, 60, count),
        c_feed=zeros + 90,
        x_feed=zeros,
        feed=zeros + 100,
        point=20 * np.exp(1j * np.radians(angle)),
        z=zeros,
        angle=angle,
    )
    keep = np.zeros(count, bool)
    keep[234] = True
    chosen, off = rate_curves.thinned(curves, keep, 100)
    assert len(chosen.move) <= 110
    assert 234 in chosen.move
    assert off < 0.02
    assert rate_curves.thinned(curves, keep, count) == (curves, 0.0)
    # What is not straight stays by its highest and lowest values.
    rough = rate_curves.Samples(
        **{**{name: getattr(curves, name) for name in curves.__struct_fields__}, "x_feed": angle % 7}
    )
    chosen, off = rate_curves.thinned(rough, keep, 100)
    assert len(chosen.move) <= 110
    assert chosen.x_feed.max() == rough.x_feed.max()
    assert off < 2


@pytest.mark.ci
def test_the_views_of_a_second_channel_begin_at_their_own_angle() -> None:
    program = "$1\n" + HEXAGON + "$2\n" + HEXAGON.replace("C0 Z2.", "C45. Z2.")
    first, second = drawn_of(program, "8:radius=4", changes={"control": {"channel_mark": "$"}}).sections
    assert (first.entry, second.entry) == (0, 45)
    assert first.entry_known
    assert second.rates.angle[0] == 45
    assert not section_of("G98 G0 X60.\nG12.1\nG1 X40. F100\nG13.1\n").entry_known
