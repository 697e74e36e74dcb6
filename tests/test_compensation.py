"""Cutter compensation: closed cases, a second opinion one corner at a time, and what a machinist would nod at."""

from __future__ import annotations

import cmath
import json
import math
import shutil
import sys
from collections import Counter
from itertools import pairwise

import numpy as np
import pytest
from cases import looped
from compensation_oracle import Block, Rules, simulate
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from msgspec.structs import fields, replace
from plane_moves import path_of_rows, points_along, turn_of
from programs import ROOT, SHARED

from polarcheck.foundation.states import Motion, Side
from polarcheck.geometry.cutter_compensation.offset_path import Method, Path, Phase, ToolPath, tool_center_path
from polarcheck.geometry.plane import arc_sweep

sys.path.insert(0, str(ROOT / "benchmarks"))

import compare_rs274

CASES = SHARED / "facts" / "compensation_cases.json"
NAN = complex(math.nan, math.nan)
MOTIONS = {"line": Motion.LINE, "cw": Motion.CW, "ccw": Motion.CCW, "none": Motion.NONE}
SIDES = {"G40": Side.OFF, "G41": Side.LEFT, "G42": Side.RIGHT}
MIRRORED = {"G41": "G42", "G42": "G41", "cw": "ccw", "ccw": "cw"}
FLAGS = [
    "inside_arc_too_small",
    "interferes",
    "no_intersection",
    "movement_missing",
    "arc_center_on_path",
]

Program = tuple[complex, list[Block]]


def path_of(*sections: Program) -> Path:
    """The columns of some sections, each a start point and its blocks."""
    rows = []
    for number, (start, blocks) in enumerate(sections):
        here, side = start, Side.OFF
        for block in blocks:
            side = SIDES.get(block.word, side)
            moves = block.kind != "none"
            end = block.end if moves else here
            center = NAN if block.center is None else block.center
            vector = NAN if block.vector is None else block.vector
            written = block.word in ("G41", "G42")
            rows.append(
                (
                    number,
                    MOTIONS[block.kind],
                    moves,
                    here,
                    end,
                    center,
                    side,
                    written,
                    block.radius,
                    vector,
                    block.stops,
                )
            )
            here = end
    return path_of_rows(rows)


def control(rules: Rules) -> Method:
    return Method(rules.start_up, rules.start_up_moving, rules.read_ahead, rules.interference, rules.tangent)


def transformed(program: Program, turn: complex = 1, mirror: bool = False, scale: float = 1) -> Program:
    """The same program elsewhere: mirrored about X, then turned and scaled about the center."""

    def place(point: complex | None) -> complex | None:
        return None if point is None else (point.conjugate() if mirror else point) * turn * scale

    def block(of: Block) -> Block:
        kind, word = (MIRRORED.get(of.kind, of.kind), MIRRORED.get(of.word, of.word)) if mirror else (of.kind, of.word)
        return of._replace(
            kind=kind,
            word=word,
            end=place(of.end),
            center=place(of.center),
            vector=place(of.vector),
            radius=of.radius * scale,
        )

    start, blocks = program
    return place(start), [block(of) for of in blocks]


def listed(tool: ToolPath) -> list[tuple[int, int, complex, complex, complex, int, bool]]:
    columns = (tool.row, tool.kind, tool.start, tool.end, tool.center, tool.phase, tool.corner)
    return list(zip(*(column.tolist() for column in columns), strict=True))


def flagged(tool: ToolPath) -> dict[str, set[int]]:
    found = {name: set(np.flatnonzero(getattr(tool, name)).tolist()) for name in FLAGS}
    return {name: rows for name, rows in found.items() if rows}


def near(one: complex, two: complex, tolerance: float = 1e-6) -> bool:
    return abs(one - two) <= tolerance * max(1.0, abs(two) / 100) or (cmath.isnan(one) and cmath.isnan(two))


# --- the closed cases --------------------------------------------------------------------------------------------


def read_case(case: dict) -> Program:
    blocks, word = [], ""
    names = {"L": "line", "CW": "cw", "CCW": "ccw", "N": "none"}
    for name, *rest in case["prog"]:
        word = rest.pop() if rest and isinstance(rest[-1], str) else ""
        points = [complex(*rest[i : i + 2]) for i in range(0, len(rest), 2)] + [None, None]
        blocks.append(Block(names[name], points[0] or 0j, points[1], word, case["r"]))
    return complex(*case["start"]), blocks


def case_moves(case: dict) -> list[tuple[int, complex, complex]]:
    kinds = {None: Motion.LINE, True: Motion.CCW, False: Motion.CW}
    return [(kinds[m.get("ccw")], complex(*m["to"]), complex(*m["c"]) if "c" in m else NAN) for m in case["moves"]]


PLACES = [
    pytest.param(1, False, 1, id="as-is"),
    pytest.param(1, True, 1, id="mirrored"),
    pytest.param(cmath.exp(2j), False, 1, id="turned"),
    pytest.param(cmath.exp(-0.7j), True, 3.7, id="turned-mirrored-scaled"),
    pytest.param(-1j, False, 1 / 25.4, id="turned-inch"),
]


@pytest.mark.skipif(not CASES.exists(), reason="no shared facts beside the checkout")
@pytest.mark.parametrize(("turn", "mirror", "scale"), PLACES)
def test_closed_cases(turn, mirror, scale):
    cases = json.loads(CASES.read_text())
    assert len(cases) >= 24
    for case in cases:
        program = transformed(read_case(case), turn, mirror, scale)
        tool = tool_center_path(path_of(program), Method(start_up=case["type"]))
        if "alarm" in case:
            check_alarm(case, tool)
            continue
        expected = transformed((0j, [Block("none", to, at) for _, to, at in case_moves(case)]), turn, mirror, scale)[1]
        assert len(tool.end) == len(expected), case["id"]
        for kind, end, center, (told, *_), block in zip(
            tool.kind, tool.end, tool.center, case_moves(case), expected, strict=True
        ):
            assert kind == ({2: 3, 3: 2}.get(told, told) if mirror else told), case["id"]
            assert near(end, block.end), case["id"]
            assert near(center, block.center), case["id"]
        for row, corner, move in zip(tool.row, tool.corner, case["moves"], strict=True):
            # There the line across a corner is listed with the block before it.
            assert row > move["block"] if corner else row == move["block"], case["id"]
        assert flagged(tool).keys() <= {"movement_missing"}, case["id"]
        assert ("movement_missing" in flagged(tool)) == (case["id"] == "28")


def check_alarm(case: dict, tool: ToolPath) -> None:
    rows = set().union(*(flagged(tool).get(name, set()) for name in ("inside_arc_too_small", "interferes")))
    if case["alarm"] == "PS0041":
        assert rows == {case["alarm_block"]}, case["id"]
    else:
        # An arc in the ramp (PS0034) is for the rules; the path goes on all the same.
        assert case["alarm"] == "PS0034"
        assert case["alarm_block"] in tool.row, case["id"]
    assert np.isfinite(tool.end).all()


# --- the rest of the rules, by hand ------------------------------------------------------------------------------


def point(text: str) -> complex:
    return complex(*map(float, text.split(",")))


def read_block(text: str, radius: float) -> Block:
    """`G41 0,0`, `ccw 10,10 about 10,0`, `G40 60,20 ij 0,1`, `R3 40,0`, `M0`; no point, no movement: `-`, `G40`."""
    kind, word, stops, points = "none", "", False, {}
    name = "end"
    for item in text.split():
        if item in ("cw", "ccw"):
            kind = item
        elif item in SIDES:
            word = item
        elif item in ("about", "ij"):
            name = item
        elif item.startswith("R"):
            radius = float(item[1:])
        elif "," in item:
            points[name] = point(item)
        stops |= item == "M0"
    if "end" in points and kind == "none":
        kind = "line"
    return Block(kind, points.get("end", 0j), points.get("about"), word, radius, points.get("ij"), stops)


def read_section(text: str) -> Program:
    start, *blocks = text.split(" | ")
    return point(start), [read_block(block, 5.0) for block in blocks]


def vertices(tool: ToolPath) -> str:
    """Row and end of each move, with the sign of a turn for arcs."""
    signs = {Motion.LINE: "", Motion.CW: "cw ", Motion.CCW: "ccw "}
    return " | ".join(
        f"{row}: {signs[kind]}{round(end.real, 3) + 0:g},{round(end.imag, 3) + 0:g}"
        for row, kind, _, end, *_ in listed(tool)
    )


EXAMPLES = {
    "ramp off to the left along J": (
        "-20,0 | G41 0,0 | 40,0 | G40 60,20 ij 0,1",
        "0: 0,5 | 1: 35,5 | 2: 60,20",
    ),
    "ramp off with J the other way": (
        "-20,0 | G41 0,0 | 40,0 | G40 60,20 ij 0,-1",
        "0: 0,5 | 1: 45,5 | 2: 60,20",
    ),
    "ramp off with I against the path": (
        "-20,0 | G41 0,0 | 40,0 | G40 60,20 ij -1,0",
        "0: 0,5 | 1: 40,5 | 2: 60,20",
    ),
    "ramp off with I J from an arc": (
        "-20,0 | G42 0,0 | ccw 20,20 about 0,20 | G40 60,20 ij -1,0",
        "0: 0,-5 | 1: ccw 24.495,25 | 2: 60,20",
    ),
    "side changed": (
        "-20,0 | G41 0,0 | 40,0 | G42 80,0 | 80,-30",
        "0: 0,5 | 1: 40,5 | 2: 40,-5 | 2: 75,-5 | 3: 75,-30",
    ),
    "side repeated": (
        "-20,0 | G41 0,0 | 40,0 | G41 40,30",
        "0: 0,5 | 1: 40,5 | 2: 35,30",
    ),
    "side repeated without movement": (
        "-20,0 | G41 0,0 | 40,0 | G41 | 40,30",
        "0: 0,5 | 1: 40,5 | 3: 35,30",
    ),
    "G41 alone": (
        "-20,0 | G41 | 0,0 | 0,30",
        "1: -5,0 | 2: -5,30",
    ),
    "G41 alone, type C": (
        "-20,0 | G41 | 0,0 | 0,30 | G40 | 30,30",
        "0: -20,5 | 1: -5,5 | 2: -5,30 | 3: 0,30 | 4: 30,30",
        Method(start_up="C"),
    ),
    "ramps with movement, type C as B": (
        "0,0 | G41 20,0 | 20,-30 | G40 0,-30",
        "0: 20,5 | 1: 25,5 | 1: 25,-35 | 2: 20,-35 | 2: 0,-30",
        Method(start_up="C", start_up_moving="B"),
    ),
    "ramps, type A": (
        "0,0 | G41 20,0 | 20,-30 | G40 0,-30",
        "0: 25,0 | 1: 25,-30 | 2: 0,-30",
    ),
    "two Z blocks after the ramp": (
        "-20,0 | G41 0,0 | - | - | 0,30",
        "0: 0,5 | 3: -5,30 | movement_missing 0",
    ),
    "two Z blocks after a short move along the contour": (
        "-20,0 | G41 0,0 | 0,0.1 | - | - | 0,30",
        "0: -5,0 | 1: -5,0.1 | 4: -5,30",
    ),
    "three blocks without movement, five known": (
        "-20,0 | G41 0,0 | 40,0 | - | - | - | 40,30",
        "0: 0,5 | 1: 35,5 | 5: 35,30",
        Method(read_ahead=5),
    ),
    "four blocks without movement, five known": (
        "-20,0 | G41 0,0 | 40,0 | - | - | - | - | 40,30",
        "0: 0,5 | 1: 40,5 | 6: 35,30 | movement_missing 1",
        Method(read_ahead=5),
    ),
    "a stop between": (
        "-20,0 | G41 0,0 | 40,0 | M0 | 40,30",
        "0: 0,5 | 1: 40,5 | 3: 35,30 | movement_missing 1",
        Method(read_ahead=8),
    ),
    "a stop in the block itself": (
        "-20,0 | G41 0,0 | 40,0 M0 | 40,30",
        "0: 0,5 | 1: 40,5 | 2: 35,30 | movement_missing 1",
        Method(read_ahead=8),
    ),
    "a stop in the block after": (
        "-20,0 | G41 0,0 | 40,0 | 40,30 M0",
        "0: 0,5 | 1: 35,5 | 2: 35,30",
    ),
    "a move of no length": (
        "-20,0 | G41 0,0 | 40,0 | 40,0 | 40,30",
        "0: 0,5 | 1: 40,5 | 3: 35,30 | movement_missing 1",
    ),
    "nothing to know before a ramp off of type A": (
        "-20,0 | G41 0,0 | 40,0 | - | - | G40 40,30",
        "0: 0,5 | 1: 40,5 | 4: 40,30",
    ),
    "full circle inside": (
        "0,0 | G41 20,0 | ccw 20,0 about 0,0 | G40 0,0",
        "0: 15,0 | 1: ccw 15,0 | 2: 0,0",
    ),
    "full circle between lines": (
        "-20,0 | G41 0,0 | 20,0 | ccw 20,0 about 20,10 | 40,0",
        "0: 0,5 | 1: 20,5 | 2: ccw 20,5 | 3: 40,5",
    ),
    "ramp on by an arc": (
        "-20,0 | G41 ccw 0,20 about -20,20 | 0,40",
        "0: -20,5 | 0: ccw -5,20 | 1: -5,40",
    ),
    "ramp off by an arc": (
        "-20,0 | G41 0,0 | 20,0 | G40 ccw 30,10 about 20,10 | 50,10",
        "0: 0,5 | 1: 20,5 | 2: ccw 25,10 | 2: 30,10 | 3: 50,10",
    ),
    "G40 alone, then an arc": (
        "-20,0 | G41 0,0 | 20,0 | G40 | ccw 30,10 about 20,10",
        "0: 0,5 | 1: 20,5 | 3: 20,0 | 3: ccw 30,10",
    ),
    "G40 and G41 alone": (
        "-20,0 | G41 0,0 | 20,0 | G40 | G41 | 40,0 | 40,30",
        "0: 0,5 | 1: 20,5 | 4: 35,0 | 5: 35,30",
    ),
    "reversal into a valley": (
        "-20,0 | G41 0,0 | 40,0 | cw 20,20 about 40,20",
        "0: 0,5 | 1: 20,5 | 2: cw 15,20",
    ),
    "groove of twice R": (
        "-20,0 | G41 0,0 | 20,0 | 20,-20 | 30,-20 | 30,0 | 50,0",
        "0: 0,5 | 1: 25,5 | 2: 25,-15 | 4: 25,5 | 5: 50,5",
    ),
    "arc as small as R": (
        "-20,0 | G41 0,0 | 20,0 | ccw 25,5 about 20,5 | 25,30",
        "0: 0,5 | 1: 20,5 | 3: 20,30 | inside_arc_too_small 2",
    ),
    "arc smaller than R": (
        "-20,0 | G41 0,0 | 20,0 | ccw 24,4 about 20,4 | 24,30",
        "0: 0,5 | 1: 20,5 | 2: 19,4 | 3: 19,30 | inside_arc_too_small 2",
    ),
    "arc out of reach from the line": (
        "-20,0 | G41 0,0 | 40,0 | ccw 34,6 about 34,0 | 0,6",
        "0: 0,5 | 1: 40,5 | 2: 35,0 | 2: ccw 34,1 | 3: 0,1 | no_intersection 1",
    ),
    "narrow slot": (
        "-20,0 | G41 0,0 | 20,0 | 20,-4 | 26,-4 | 26,0 | 46,0",
        "0: 0,5 | 1: 25,5 | 2: 25,1 | 3: 21,1 | 4: 21,5 | 5: 46,5 | interferes 3",
    ),
    "narrow slot, check off": (
        "-20,0 | G41 0,0 | 20,0 | 20,-4 | 26,-4 | 26,0 | 46,0",
        "0: 0,5 | 1: 25,5 | 2: 25,1 | 3: 21,1 | 4: 21,5 | 5: 46,5",
        Method(interference="ignore"),
    ),
    "center on the end": (
        "-20,0 | 0,0 | ccw 20,0 about 20,0 | 20,30",
        "0: 0,0 | 1: 20,0 | 2: 20,30 | arc_center_on_path 1",
    ),
    "R changed": (
        "-20,0 | G41 0,0 | R3 40,0 | R3 40,30 | R3 G40 60,30",
        "0: 0,5 | 1: 37,3 | 2: 37,30 | 3: 60,30",
    ),
    "R negative on an arc": (
        "0,-40 | G42 R-5 0,-20 | R-5 ccw 0,20 about 0,0 | R-5 G40 0,40",
        "0: 0,-15 | 1: ccw 0,15 | 2: 0,40",
    ),
}


def compensated(program: Program) -> compare_rs274.Contour | None:
    """What LinuxCNC can run of a program: moves of one R above 0 on one side, a line first, moved to the origin."""
    path = path_of(program)
    rows = np.flatnonzero(path.moves & (path.side != Side.OFF))
    lengths = abs(path.end[rows] - path.start[rows])
    is_one = len(rows) > 2 and len({*zip(path.side[rows], path.radius[rows], strict=True)}) == 1
    if (
        not is_one
        or path.motion[rows[0]] != Motion.LINE
        or not 0 < path.radius[rows[0]] < lengths[0]
        or not lengths.all()
    ):
        return None
    points = path.start, path.end, path.center
    moves = [
        compare_rs274.Move(Motion(path.motion[row]), *(of[row] - path.start[rows[0]] for of in points)) for row in rows
    ]
    return compare_rs274.Contour(Side(path.side[rows[0]]), float(path.radius[rows[0]]), moves)


@pytest.mark.nightly
@pytest.mark.skipif(shutil.which("rs274") is None, reason="there is no LinuxCNC here")
def test_fixtures_are_run_as_by_linuxcnc(tmp_path):
    programs = [read_section(program) for program, *_ in EXAMPLES.values()]
    if CASES.exists():
        programs += [read_case(case) for case in json.loads(CASES.read_text())]
    totals = Counter()
    for contour in filter(None, map(compensated, programs)):
        tool, other = compare_rs274.ours(contour), compare_rs274.theirs(contour, "rs274", tmp_path)
        assert bool(other.error) == compare_rs274.objects(tool), contour
        if not other.error:
            compare_rs274.compare(contour, tool, other, totals)
            assert not [name for name in totals if "DIFFER" in name], contour
    assert sum(totals.values()) > 8


@looped("name", EXAMPLES)
def test_examples(name):
    program, expected, *rest = EXAMPLES[name]
    tool = tool_center_path(path_of(read_section(program)), *rest)
    flags = [f"{flag} {' '.join(map(str, sorted(rows)))}" for flag, rows in flagged(tool).items()]
    assert " | ".join([vertices(tool), *flags]) == expected


def test_columns_of_a_program():
    """Phases, rows and corners of two sections, the first of which ends with G41 in force."""
    left_on = read_section("-20,0 | G41 0,0 | 40,0 | 20,-34.641016 | -")
    whole = read_section("60,0 | 50,0 | G42 20,0 | - | 20,10 | G40 60,10 | -")
    tool = tool_center_path(path_of(left_on, whole))
    assert vertices(tool) == (
        "0: 0,5 | 1: 45,5 | 2: 46.83,1.83 | 2: 24.33,-37.141 | 4: 50,0 | 5: 25,0 | 7: 25,10 | 8: 60,10"
    )
    assert [Phase(phase).name for phase in tool.phase] == [
        "START_UP", "OFFSET", "OFFSET", "OFFSET", "CANCELLED", "START_UP", "OFFSET", "CANCEL",
    ]  # fmt: skip
    assert tool.corner.tolist() == [False, False, True, False, False, False, False, False]
    assert tool.known.all()
    assert tool.start[4] == 60
    assert not flagged(tool)


def test_rapid_counts_as_line():
    path = path_of(read_section("-20,0 | G41 0,0 | 40,0 | 40,30"))
    rapid = replace(path, motion=np.where(path.motion == Motion.LINE, Motion.RAPID, path.motion))
    assert_same(tool_center_path(rapid), tool_center_path(path))


def test_nothing():
    tool = tool_center_path(path_of())
    assert all(len(getattr(tool, field.name)) == 0 for field in fields(tool))
    for start_up in "ABC":
        tool = tool_center_path(path_of(read_section("0,0 | - | G41 | G40")), Method(start_up))
        assert len(tool.row) == 0
        assert len(tool.interferes) == 3


def test_unknown_radius_gives_the_programmed_path():
    program = "60,0 | 50,0 | G42 20,0 | ccw 20,0 about 0,0 | 20,30 | -10,30 | G40 -10,60 | 0,60"
    path = path_of(read_section(program))
    tool = tool_center_path(replace(path, radius=np.full(len(path.radius), math.nan)))
    assert vertices(tool) == "0: 50,0 | 1: 20,0 | 2: ccw 20,0 | 3: 20,30 | 4: -10,30 | 5: -10,60 | 6: 0,60"
    assert tool.known.tolist() == [True, False, False, False, False, False, True]
    assert [Phase(phase).name for phase in tool.phase[[0, 1, 2, 5]]] == ["CANCELLED", "START_UP", "OFFSET", "CANCEL"]
    assert not flagged(tool)


def test_unknown_start_reaches_one_move_far():
    path = path_of(read_section("0,0 | 50,0 | G42 20,0 | 20,10 | 0,10 | G40 0,30"))
    path.start[0] = NAN
    assert tool_center_path(path).known.tolist() == [False, True, True, True, True]


# --- random contours against the second opinion ------------------------------------------------------------------

TURNS = st.one_of(
    st.sampled_from([0, 0, 0, 90, -90, 180, 60, -120]),
    st.floats(-179, 179).map(lambda a: a + 0.1234567),
)
LENGTHS = st.floats(0.5, 60).map(lambda a: a + 0.01234567)
IDLE = ["", "", "", "G40", "G41", "G42"]


@st.composite
def contours(draw: st.DrawFn, longest: int = 12) -> Program:
    """A section: ramp on, lines and arcs at any angle, ramp off; with everything between that a program may hold."""
    wild = draw(st.integers(0, 3)) == 0
    start = here = complex(draw(st.floats(-50, 50)), draw(st.floats(-50, 50)))
    tangent = cmath.exp(1j * draw(st.floats(-3, 3)))
    radius = draw(st.floats(0.5, 8))
    side = draw(st.sampled_from(["G41", "G42"]))
    blocks: list[Block] = []

    def move(word: str = "", straight: bool = False) -> None:
        nonlocal here, tangent
        tangent *= cmath.exp(1j * math.radians(draw(TURNS)))
        kind = "line" if straight else draw(st.sampled_from(["line", "cw", "ccw"]))
        center = None
        size = draw(LENGTHS)
        if kind == "line":
            here = here + size * tangent
        else:
            spoke = -1j * tangent if kind == "ccw" else 1j * tangent
            center = here - size * spoke
            angle = draw(st.one_of(st.floats(0.1, 6.1), st.just(math.tau)))
            turn = cmath.exp(1j * (angle if kind == "ccw" else -angle))
            end = here if angle == math.tau else center + size * spoke * turn
            here, tangent = end, tangent * turn
        vector = None
        if word == "G40" and wild and draw(st.booleans()):
            vector = cmath.exp(1j * draw(st.floats(-3, 3)))
        blocks.append(Block(kind, here, center, word, radius, vector))

    move(side, straight=not wild)
    for _ in range(draw(st.integers(0, longest))):
        event = draw(st.integers(0, 20)) if wild else draw(st.integers(0, 4))
        if event <= 14:
            move()
        elif event <= 16:
            idle = draw(st.sampled_from(IDLE))
            blocks.append(Block("none", 0j, None, idle, radius, None, idle == "" and draw(st.integers(0, 5)) == 0))
        elif event == 17:
            blocks.append(Block("line", here, None, draw(st.sampled_from(IDLE)), radius))
        elif event == 18:
            blocks.append(Block("none", 0j, None, "", radius))
        elif event == 19:
            move(draw(st.sampled_from(["G40", "G41", "G42"])), straight=draw(st.booleans()))
        else:
            radius = draw(st.sampled_from([0.0, -radius, radius * 1.2]))
    if draw(st.booleans()):
        move("G40", straight=not wild)
    return start, blocks


RULES = st.builds(
    Rules,
    st.sampled_from(["A", "B", "C"]),
    st.sampled_from(["A", "B"]),
    st.integers(3, 6),
    st.sampled_from(["alarm", "alarm", "erase", "ignore"]),
    st.just(1e-3),
)


@pytest.mark.nightly
@settings(max_examples=150, deadline=None)
@given(st.lists(contours(), min_size=1, max_size=3), RULES)
def test_agrees_with_the_plain_way(programs, rules):
    tool = tool_center_path(path_of(*programs), control(rules))
    assert tool.known.all()
    moves, alarms, first = [], {}, 0
    for start, blocks in programs:
        run = simulate(start, blocks, rules)
        moves += [(first + move.row, *move[1:]) for move in run.moves]
        for name, rows in run.alarms.items():
            alarms.setdefault(name, set()).update(first + row for row in rows)
        first += len(blocks)
    assert flagged(tool) == alarms
    assert len(tool.row) == len(moves)
    for ours, theirs in zip(listed(tool), moves, strict=True):
        row, kind, start, end, center, phase, corner = ours
        assert (row, kind, phase, corner) == (theirs[0], MOTIONS[theirs[1]], Phase[theirs[5]], theirs[6])
        assert near(start, theirs[2])
        assert near(end, theirs[3])
        assert near(center, NAN if theirs[4] is None else theirs[4])


# --- what a machinist would nod at -------------------------------------------------------------------------------


@st.composite
def rings(draw: st.DrawFn) -> Program:
    """A contour once round the center, of lines and shallow arcs, with a tool that fits most of its corners."""
    count = draw(st.integers(5, 10))
    corners = [
        draw(st.floats(25, 50)) * cmath.exp(1j * (math.tau * i / count + draw(st.floats(-0.1, 0.1))))
        for i in range(count)
    ]
    radius = draw(st.floats(0.5, 6))
    side = draw(st.sampled_from(["G41", "G42"]))
    # The ramps meet the contour in the middle of a line, not in a corner.
    first = (corners[-1] + corners[0]) / 2
    away = first * (0.3 if side == "G41" else 1.8)
    blocks = [Block("line", first, None, side, radius), Block("line", corners[0], None, "", radius)]
    for here, end in pairwise(corners):
        bulge = draw(st.one_of(st.just(0.0), st.floats(-1, 1).filter(lambda b: abs(b) > 0.05)))
        if bulge == 0:
            blocks.append(Block("line", end, None, "", radius))
        else:
            # The center stands off the chord by at least its length.
            center = (here + end) / 2 + 1j * (end - here) / bulge
            blocks.append(Block("ccw" if bulge > 0 else "cw", end, center, "", radius))
    blocks += [Block("line", first, None, "", radius), Block("line", away, None, "G40", radius)]
    return away, blocks


def distance_to_block(points: np.ndarray, path: Path, row: int) -> np.ndarray:
    """Distance of plane points to one programmed line or arc."""
    start, end, center = path.start[row], path.end[row], path.center[row]
    ends = np.minimum(abs(points - start), abs(points - end))
    if np.isnan(center):
        along = ((points - start) * np.conj(end - start)).real / abs(end - start) ** 2
        return np.where((along > 0) & (along < 1), abs(points - start - along * (end - start)), ends)
    sweep = turn_of(start, end, center, path.motion[row])
    at = np.angle((points - center) / (start - center)) * np.sign(sweep) % math.tau
    return np.where(at <= abs(sweep), abs(abs(points - center) - abs(start - center)), ends)


@pytest.mark.nightly
@settings(max_examples=60, deadline=None)
@given(contours(), RULES, st.floats(-3, 3))
def test_turning_the_contour_turns_the_path(program, rules, angle):
    turn = cmath.exp(1j * angle)
    tool = tool_center_path(path_of(program), control(rules))
    turned = tool_center_path(path_of(transformed(program, turn)), control(rules))
    assert flagged(turned) == flagged(tool)
    assert_same(turned, replace(tool, start=tool.start * turn, end=tool.end * turn, center=tool.center * turn))


@pytest.mark.nightly
@settings(max_examples=60, deadline=None)
@given(contours(), RULES)
def test_mirroring_swaps_g41_and_g42(program, rules):
    tool = tool_center_path(path_of(program), control(rules))
    mirrored = tool_center_path(path_of(transformed(program, mirror=True)), control(rules))
    assert flagged(mirrored) == flagged(tool)
    swapped = np.array([0, 1, Motion.CCW, Motion.CW], dtype=np.int16)[tool.kind]
    points = {name: getattr(tool, name).conj() for name in ("start", "end", "center")}
    assert_same(mirrored, replace(tool, kind=swapped, **points))


@pytest.mark.nightly
@settings(max_examples=60, deadline=None)
@given(contours(), RULES)
def test_negative_radius_swaps_sides(program, rules):
    start, blocks = program
    negative = [of._replace(radius=-of.radius, word=MIRRORED.get(of.word, of.word)) for of in blocks if of.radius]
    positive = [of for of in blocks if of.radius]
    tool = tool_center_path(path_of((start, positive)), control(rules))
    swapped = tool_center_path(path_of((start, negative)), control(rules))
    assert flagged(swapped) == flagged(tool)
    assert_same(swapped, tool)


@pytest.mark.nightly
@settings(max_examples=60, deadline=None)
@given(contours(), RULES)
def test_radius_zero_gives_the_programmed_path(program, rules):
    start, blocks = program
    path = path_of((start, [of._replace(radius=0.0) for of in blocks]))
    tool = tool_center_path(path, control(rules))
    moving = np.flatnonzero(path.moves & ((path.start != path.end) | ~np.isnan(path.center)))
    assert tool.row.tolist() == moving.tolist()
    assert tool.kind.tolist() == path.motion[moving].tolist()
    for name in ("start", "end", "center"):
        assert np.allclose(getattr(tool, name), getattr(path, name)[moving], atol=1e-9, equal_nan=True)
    assert flagged(tool).keys() <= {"arc_center_on_path"}


@pytest.mark.nightly
@settings(max_examples=60, deadline=None)
@given(st.lists(contours(), min_size=1, max_size=3), RULES)
def test_path_is_continuous_within_a_section(programs, rules):
    path = path_of(*programs)
    tool = tool_center_path(path, control(rules))
    section = path.section[tool.row]
    begins = np.append(True, section[1:] != section[:-1])
    assert np.allclose(tool.start[1:][~begins[1:]], tool.end[:-1][~begins[1:]], atol=1e-6)
    assert np.isin(tool.start[begins], [start for start, _ in programs]).all()
    assert (np.diff(tool.row) >= 0).all()


@pytest.mark.nightly
@settings(max_examples=60, deadline=None)
@given(contours(), RULES, st.data())
def test_unknown_values_stay_where_they_are(program, rules, data):
    path = path_of(program)
    rows = data.draw(st.sets(st.integers(0, len(path.side) - 1), min_size=1, max_size=2))
    column = data.draw(st.sampled_from(["start", "end", "center", "radius"]))
    holes = getattr(path, column).copy()
    holes[list(rows)] = math.nan
    # An arc without length and center does not move: R with the end at the start.
    assume(column != "center" or not any(path.start[row] == path.end[row] for row in rows))
    whole = tool_center_path(path, control(rules._replace(interference="alarm")))
    tool = tool_center_path(replace(path, **{column: holes}), control(rules._replace(interference="alarm")))
    everything = listed(whole)
    for move, known in zip(listed(tool), tool.known, strict=True):
        if known:
            assert any(move[0] == other[0] and near(move[3], other[3]) for other in everything)
        else:
            assert not path.moves[move[0]] or move[1] in (Motion.LINE, path.motion[move[0]])
    assert tool.known.all() or any(path.moves[row] for row in rows)


@pytest.mark.nightly
@settings(max_examples=60, deadline=None)
@given(contours(), RULES)
def test_a_section_of_unknown_radius_is_the_same_beside_a_compensated_one(program, rules):
    start, blocks = program
    unknown = start, [of._replace(radius=math.nan) for of in blocks]
    compensated = read_section("-20,0 | G41 0,0 | 40,0 | 40,30 | G40 60,30")
    alone = tool_center_path(path_of(unknown), control(rules))
    both = tool_center_path(path_of(unknown, compensated), control(rules))
    assert both.known[len(alone) :].all()
    for field in fields(alone):
        column = getattr(alone, field.name)
        assert np.array_equal(column, getattr(both, field.name)[: len(column)], equal_nan=column.dtype.kind in "cf")


def assert_same(one: ToolPath, two: ToolPath) -> None:
    assert len(one.row) == len(two.row)
    for ours, theirs in zip(listed(one), listed(two), strict=True):
        assert (*ours[:2], *ours[5:]) == (*theirs[:2], *theirs[5:])
        assert all(near(a, b) for a, b in zip(ours[2:5], theirs[2:5], strict=True))


@pytest.mark.nightly
@settings(max_examples=60, deadline=None)
@given(rings(), st.sampled_from("AB"))
def test_tool_keeps_its_distance(program, start_up):
    path = path_of(program)
    tool = tool_center_path(path, Method(start_up=start_up))
    contour = [row for row in range(len(path.side)) if 0 < row < len(path.side) - 1]
    doubtful = np.zeros(len(path.side) + 2, dtype=bool)
    for rows in flagged(tool).values():
        for row in rows:
            doubtful[row - 1 : row + 2] = True
    for move in np.flatnonzero(tool.phase == Phase.OFFSET):
        if doubtful[tool.row[move]]:
            continue
        points = points_along(tool.start[move], tool.end[move], tool.center[move], tool.kind[move], 60)
        for row in contour:
            assert distance_to_block(points, path, row).min() >= path.radius[0] - 1e-6


@looped("turned", [1e-6, -1e-6, 0.0])
def test_a_full_circle_between_arcs_that_nearly_touch_it_is_run_whole(turned):
    """Rounded centers move the ends of its offset circle by less than a micrometre: past each other, or not."""
    spoke = cmath.exp(1j * turned)
    before, behind = Block("ccw", 20 + 0j, 20 - 8 * spoke, "", 3.0), Block("ccw", 12 + 8j, 12 + 0j, "", 3.0)
    blocks = [Block("line", 20 - 16 * spoke, None, "G42", 3.0), before, Block("ccw", 20 + 0j, 0j, "", 3.0), behind]
    path = tool_center_path(path_of((20 - 40 * spoke, blocks)))
    of_circle = (path.kind == Motion.CCW) & (np.abs(path.center) < 1e-3)
    sweep = arc_sweep(path.start[of_circle], path.end[of_circle], path.center[of_circle], path.kind[of_circle])
    assert sweep.sum() == pytest.approx(2 * np.pi, abs=1e-4)
