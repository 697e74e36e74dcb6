"""Arcs that no setter writes, rewritten: written as what they are, or refused by name; never by an internal error."""

from __future__ import annotations

import math
from functools import partial
from pathlib import Path

import numpy as np
import pytest
from cases import looped
from click.testing import CliRunner
from programs import machine_of, report_of, tables_of
from rolled_programs import cam_contour
from test_convert import convert, refused, section
from test_pen import distance, path_of
from unrolled_contours import hexagon

from polarcheck.columns.trace import Trace
from polarcheck.commands import main
from polarcheck.files.settings.of_programs import OfPrograms, Options
from polarcheck.rewrite.compensate.compensating import Compensating, compensated
from polarcheck.rewrite.compensate.contours import SIDES
from polarcheck.rewrite.roll import rolled_deviation
from polarcheck.rewrite.roll.rolling import Rolling, rolled
from polarcheck.rewrite.writing.outcome import RefusedError
from polarcheck.rewrite.writing.pen import Pen
from polarcheck.rewrite.writing.rewritten_program import rewritten
from polarcheck.rewrite.writing.written_arcs import swept

#: Those whose sections are not written in the same words.
OTHER_WORDS = (
    "haas-lathe",
    "okuma-osp",
    "siemens-transmit",
    "citizen",
    "mitsubishi-m700",
    "hurco",
    "fagor-8055t",
    "lsis",
)
#: Arcs from X40. C0 of a FANUC whose ends, center and R lie where no setter puts them.
WRITTEN = {
    "an end an increment nearer to its center": "G3 X39.998 C0 I-10. J0",
    "an end an increment farther from its center": "G2 X40.002 C0 I-10. J0",
    "half a circle whose radius grows": "G3 X20.004 C0 I-4.999 J0",
    "an arc of an increment": "G3 X40. C0.001 R0.001",
    "R below half the chord": "G3 X40.008 C0 R0.001",
    "half a circle of an increment": "G3 X39.996 C0 I-0.001 J0",
    "a full circle of an increment": "G3 X40. C0 I-0.001 J0",
    "a full circle of two increments": "G2 I0 J-0.002",
    "nearly straight": "G3 X40. C10. R99999.",
    "nearly a full circle": "G3 X40. C-0.001 I-5. J0",
    "an arc about the center of the part": "G2 X-40. C0 I-20. J0",
    "no length": "G1 X40. C0\nG3 X40. C0 R5.",
}
REFUSED = {
    "its center at its start": "G3 X39.998 C0 I0 J0.",
    "its center at its start, in steps": "G91 G3 U-0.002 H0 I0 J0.",
    "its center at its end": "G3 X39.998 C0 I-0.001 J0",
    "a full circle without a radius": "G3 X40. C0 I0. J0",
    "its end across from a center at its start": "G2 X40. C0.001 I0. J0",
}


def of_blocks(*blocks: str) -> str:
    """A program whose section has blocks, each from X40. C0."""
    moves = [line for block in blocks for line in (*block.split("\n"), "G1 X40. C0")]
    return section("G1 X80. F1000", "Z-1. F200", "G1 X40.", *moves, "G1 X80.", "Z2.")


def moves_of(trace: Trace) -> list[tuple[complex, complex, complex | None, bool]]:
    """Start, end, center and sense of each move of the sections."""
    path, rows = trace.path, np.flatnonzero(trace.path.travels & (trace.mode.section >= 0))
    return [
        (
            complex(path.start[row]),
            complex(path.end[row]),
            complex(path.center[row]) if path.is_arc[row] else None,
            bool(trace.axes.motion[row] == 3),
        )
        for row in rows.tolist()
    ]


def assert_same_path(program: str, data: bytes, target: str) -> None:
    """The ends of all moves and the middles of arcs lie on the other path, up to what is rounded."""
    ours, theirs = (
        tables_of(text, machine)["trace"] for text, machine in ((program, "fanuc-30i"), (data.decode(), target))
    )
    for first, second in ((ours, theirs), (theirs, ours)):
        moves = moves_of(second)
        assert max(min(distance(point, *move) for move in moves) for point in path_of(first, 1e-9)) < 0.0021


@pytest.mark.nightly
@pytest.mark.parametrize("target", OTHER_WORDS)
def test_odd_arcs_are_written_as_what_they_are(target: str) -> None:
    program = of_blocks(*WRITTEN.values())
    assert_same_path(program, convert(program, "fanuc-30i", target).data, target)


@pytest.mark.nightly
@looped("target", ["haas-lathe", "okuma-osp", "siemens-transmit"], one_in=5)
@looped("name", WRITTEN)
def test_each_odd_arc_is_written_alone(name: str, target: str) -> None:
    program = of_blocks(WRITTEN[name])
    assert_same_path(program, convert(program, "fanuc-30i", target).data, target)


@looped("target", OTHER_WORDS, one_in=24)
@looped("name", REFUSED)
def test_an_arc_without_a_radius_is_refused_by_its_line(name: str, target: str) -> None:
    reasons = refused(of_blocks(REFUSED[name]), "fanuc-30i", target)
    assert (12, "the center of this arc is its start or its end") in reasons


@pytest.mark.nightly
@looped("code", ["G2", "G3"], one_in=3)
@looped("x", ["39.998", "40.002"])
def test_an_arc_along_its_own_radius_is_a_line(code: str, x: str) -> None:
    """Its angle is 0: no control is told to go round a full circle."""
    lines = convert(of_blocks(f"{code} X{x} C0 I-10. J0"), "fanuc-30i", "haas-lathe").data.decode().split("\n")
    at = lines.index("G1 X20.")
    assert lines[at + 1] == f"G1 X{float(x) / 2:.3f}"
    assert not [line for line in lines if line.startswith(("G2 ", "G3 "))]


@pytest.mark.ci
def test_a_program_of_an_arc_below_half_its_chord_is_converted() -> None:
    program = "O1\nG17 G90 G94 G40 G97\nT0101\nG0 X60. Z2. C0\nG12.1\nG1 X30. F1000\nZ-1. F200\nG1 X20. C0\n"
    program += "G3 X20.004 C0 R0.001\nG1 X40.\nZ2.\nG13.1\nG0 X100. Z50.\nM30\n"
    lines = convert(program, "mitsubishi-m700", "siemens-transmit").data.decode().split("\n")
    assert "G3 X20.004 Y0 CR=0.002" in lines


@looped("ccw", [True, False])
@looped(
    ("start", "end", "center", "expected"),
    [
        (20, 19.999, 10, 0),
        (20, 20.001, 10, 0),
        (3 + 4j, 3.0015 + 4.002j, 0, 0),
        (20, 20, 10, math.tau),
        (20, 10, 10, math.tau),
        (20, -1, 10, math.pi),
    ],
)
def test_the_sweep_is_the_same_in_both_senses(
    start: complex, end: complex, center: complex, expected: float, ccw: bool
) -> None:
    assert swept(start, end, center, ccw) == pytest.approx(expected if ccw else -expected, abs=1e-12)


@looped(("end", "center"), [(19.999, 20), (20, 20), (19.999, 19.999), (20.001j, 20)])
def test_the_pen_draws_no_arc_without_a_radius(end: complex, center: complex) -> None:
    pen = Pen(machine_of("haas-lathe"))
    pen.enter(20 + 0j)
    with pytest.raises(RefusedError, match="center of this arc is its start or its end"):
        pen.arc(end, center, True)


@pytest.mark.nightly
@looped(
    ("machine", "moves"),
    [
        ("fanuc", "G12.1\nG1 X2.361 F100\nU-4.7\nG2 X-2.3 R4\nJ0\nG1 X60.\nG13.1"),
        ("siemens-transmit", "TRANSMIT\nX0\nG2 I.01\nG2 X.02 R1\nTRAFOOF"),
        ("siemens-transmit", "TRANSMIT\nX0\nG2 X.01 R2\nX0 R.01"),
    ],
)
def test_an_arc_whose_neighbours_ask_for_an_r_of_0_is_checked(machine: str, moves: str) -> None:
    """Nothing divides by it: a warning of NumPy is an error in tests."""
    tools = ("1:radius=0.4,nose=3", "2:radius=-0.1", "8:radius=1000")
    assert report_of(f"{moves}\nM30\n", machine, *tools, job={"program_units": "mm"}).verdict


@pytest.mark.nightly
@looped("side", SIDES, one_in=20)
@looped("blocks", ["G3 X2. I7.", "G2 X2. I7.", "G3 X2. Y.2 I7. J0", "G3 X4. Y.2 I0. J0", "G3 X3.999 Y.2 I-1. J0"])
def test_odd_arcs_are_compensated_or_refused(blocks: str, side: str) -> None:
    """An arc from X4. Y.2 without a sweep or a radius is no part of a contour: it stays, or all is refused."""
    program = f"T1 M6\nG98 G0 X60. C0\nG101\nG1 X4. F100\nY.2\n{blocks}\nG109\nM30\n"
    settings = OfPrograms(Options(machine="hurco", tools=("1:radius=0.4",), use_config=False))("")
    try:
        work = partial(compensated, options=Compensating(side))
        outcome = rewritten("a.nc", program.encode(), settings, work)
    except RefusedError as error:
        assert error.refusals  # noqa: PT017
    else:
        assert blocks in outcome.data.decode().split("\n")


def test_a_section_without_a_move_has_no_contour() -> None:
    program = "T1\nG98 G0 X60. C0\nG112\nG3 U\nG113\nM30\n"
    settings = OfPrograms(Options(machine="lsis", tools=("1:radius=0.4",), use_config=False))("")
    with pytest.raises(RefusedError) as error:
        rewritten("a.nc", program.encode(), settings, partial(compensated, options=Compensating("")))
    assert error.value.refusals[0].line == 4
    assert "arc-without-center" in error.value.refusals[0].text


@pytest.mark.ci
def test_a_block_that_no_move_of_the_rolled_program_stands_for_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    """Nothing is inf mm away."""
    away = rolled_deviation._away
    monkeypatch.setattr(rolled_deviation, "_away", lambda each, *others: away(each, *others) + np.inf)
    settings = OfPrograms(Options(machine="fanuc-30i", use_config=False))("")
    with pytest.raises(RefusedError, match="no move of the result leads to the end of this block"):
        rewritten(
            "a.nc", cam_contour(hexagon()).encode(), settings, partial(rolled, options=Rolling(0.01, "per-minute"))
        )


@pytest.mark.ci
def test_an_arc_whose_ends_lie_on_no_circle_has_no_keyway() -> None:
    """Its center is not known, and nothing is divided by that."""
    program = "G12.1\nG42X20C-20\nG2X1J5C1\nX20C-20.5"
    result = CliRunner().invoke(main, ["check", "--part", "-", "--no-config", "--no-cache"], input=program)
    assert (result.exit_code, "internal error" in result.stderr) == (1, False)


@pytest.mark.nightly
@pytest.mark.usefixtures("own_folder")
@looped("first", ["G0 X1 Z4\nG112 Z7", "G0 X50. Z4.\nG112\nG0 Z5.\nG0 C0"])
def test_a_section_whose_cuts_are_not_known_is_compared_by_its_rapids(first: str) -> None:
    for name, text in (("a.nc", f"{first}\n=\nG1 Z"), ("b.nc", f"G112\nG1 X5.\nG113\n{first}\nG1 X#500")):
        Path(name).write_text(text)
    for pair in (("a.nc", "a.nc"), ("a.nc", "b.nc"), ("b.nc", "a.nc"), ("b.nc", "b.nc")):
        result = CliRunner().invoke(main, ["compare", *pair, "--machine", "haas-lathe", "--no-config"])
        assert result.exit_code in (0, 1, 2), (pair, result.stderr)


@pytest.mark.ci
@looped("count", [400, 5000], one_in=2)
@looped("word", ["Z", "X20. Z", "F"])
def test_a_number_of_any_length_is_written_or_refused(word: str, count: int) -> None:
    program = f"G21 G98\nG1 {word}{'9' * count}\nM30\n"
    try:
        outcome = convert(program, "fanuc-30i", "okuma-osp")
    except RefusedError as error:
        assert all(refusal.line == 2 or "line 2" in refusal.text for refusal in error.refusals)  # noqa: PT017
    else:
        assert outcome.data.strip()
