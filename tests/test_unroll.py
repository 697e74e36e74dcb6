"""
`polarcheck unroll`: the blocks of X and C that it writes, sampled and compared with closed forms of the contours.

What the tool does in the written blocks is worked out by written_moves, which shares nothing with polarcheck.
"""

from __future__ import annotations

import cmath
import json
import math
import re
from collections.abc import Callable
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from cases import looped
from click.testing import CliRunner, Result
from hypothesis import Phase, assume, given, settings
from hypothesis import strategies as st
from programs import report_of
from written_moves import (
    Block,
    Floats,
    Points,
    blocks_of,
    fastest,
    from_circle,
    from_flattened_circle,
    from_line,
    from_polygon,
    from_slot,
    largest,
    of_section,
    way,
)

from polarcheck.commands import main

pytestmark = pytest.mark.usefixtures("own_folder")

HEAD = "%\nO1\nG21 G98 G40\nT0101\nG0 X80. C0 Z2.\nG12.1\n"
END = "G13.1\nG0 X100. Z50.\nM30\n%\n"
#: How a profile that lacks it is told where X is a diameter.
DIAMETERS = ("--set", "control.x=diameter", "--set", "polar.x=diameter")
METHODS = {
    "per-minute": ("--machine", "fanuc-30i"),
    "per-minute-diameter": ("--machine", "fanuc-30i", "--feed", "per-minute-diameter"),
    "per-minute-c": ("--machine", "doosan"),
    "inverse-time": ("--machine", "mitsubishi-m700", *DIAMETERS),
}


def call(program: str | bytes, *arguments: str) -> Result:
    return CliRunner().invoke(main, ["unroll", "-", *arguments], input=program, prog_name="polarcheck")


def unrolled(program: str, *arguments: str) -> tuple[str, str]:
    """The new program, and what was said."""
    result = call(program, *(arguments or METHODS["per-minute"]))
    assert result.exit_code == 0, result.stderr
    return result.stdout, result.stderr


def reasons(program: str, *arguments: str) -> list[str]:
    """Why a program is refused, `line: reason`."""
    result = call(program, "--format", "json", *(arguments or METHODS["per-minute"]))
    assert result.exit_code == 2, result.stderr
    return [f"{each['line']}: {each['text']}" for each in json.loads(result.stdout)["files"][0]["refusals"]]


def figure(said: str, name: str) -> float:
    match = re.search(rf": {name}: ([0-9.e+-]+)", said)
    assert match, said
    return float(match[1])


class Contour:
    """
    A contour with its closed form.

    blocks: of the program. first, last: the tool center at both ends. distance: of points from it. length: of the path
    of the tool center, NaN where it does not matter. tool: R of the cutter.
    """

    def __init__(
        self,
        blocks: str,
        first: complex,
        last: complex,
        distance: Callable[[Points], Floats],
        length: float,
        tool: int = 0,
    ) -> None:
        self.program = f"{HEAD}{blocks}{END}"
        self.first, self.last, self.distance, self.length = first, last, distance, length
        self.options = ("--tool", f"1:radius={tool}") if tool else ()


# A hexagon of 30 across flats with a cutter of 8: the tool center runs on one of 38, 19 / cos(30 deg) at its corners.
HEXAGON = Contour(
    "G1 X60. F900\nG42 X30. F300\nC8.66\nX0 C17.321\nX-30. C8.66\nC-8.66\nX0 C-17.321\nX30. C-8.66\nC0\nG40 X60.\n",
    19 + 0j, 19 + 0j, from_polygon(6, 19.0), 12 * 19 * math.tan(math.pi / 6), tool=4,
)  # fmt: skip
CONTOURS = {
    "hexagon": HEXAGON,
    "circle off the center": Contour(
        "G1 X36. C5. F300\nG3 X36. C5. I-6. J0\nG1 X80. C0\n",
        18 + 5j, 18 + 5j, from_circle(12 + 5j, 6.0), 12 * math.pi,
    ),
    "pocket about the center, off it": Contour(
        "G1 X20. C3. F300\nG2 X20. C3. I-8. J0\nG1 X80. C0\n",
        10 + 3j, 10 + 3j, from_circle(2 + 3j, 8.0), 16 * math.pi,
    ),
    "flat on a circle": Contour(
        "G1 X30. C13.229 F300\nG3 X30. C-13.229 R-20.\nG1 C13.229\nG1 X80. C0\n",
        15 + 13.229j, 15 + 13.229j, from_flattened_circle(20.0, 15.0),
        40 * (math.pi - math.acos(0.75)) + 26.458,
    ),
    "slot": Contour(
        "G1 X40. C-5. F300\nX60.\nG3 X60. C5. R5.\nG1 X20.\nG3 X20. C-5. R5.\nG1 X40.\nG1 X80. C0\n",
        20 - 5j, 20 - 5j, from_slot(20, 10.0, 5.0), 40 + 10 * math.pi,
    ),
    "line by the center": Contour(
        "G1 X40. C0.3 F300\nX-40.\nG1 C-60.\n", 20 + 0.3j, -20 + 0.3j, from_line(20 + 0.3j, -20 + 0.3j), 40.0,
    ),
}  # fmt: skip


CASES = [
    *((name, "per-minute") for name in CONTOURS),
    *(("slot", method) for method in METHODS if method != "per-minute"),
    ("line by the center", "inverse-time"),
]


@pytest.mark.one_in(12)
@pytest.mark.parametrize(("name", "method"), CASES)
def test_the_tool_stays_on_the_contour_and_is_nowhere_faster_than_f(name: str, method: str) -> None:
    contour = CONTOURS[name]
    text, said = unrolled(contour.program, *METHODS[method], *contour.options)
    blocks = of_section(blocks_of(text), contour.first, contour.last)
    distance = largest(blocks, contour.distance)
    assert distance <= 0.005
    # The words of the program itself are rounded: 8.66 and 17.321.
    assert figure(said, "largest distance of the tool center from its path") >= distance - 6e-4
    assert way(blocks) == pytest.approx(contour.length, rel=1e-3)
    average, anywhere = fastest(blocks, method)
    assert 0.97 * 300 <= average <= anywhere <= 300.01
    assert {block.inverse for block in blocks} == {method == "inverse-time"}
    rate = max(block.ways[1] / block.minutes(method) for block in blocks)
    assert figure(said, "largest rate of C") >= 0.999 * rate


@pytest.mark.ci
@looped("chord_error", ["0.002", "0.02"])
def test_the_chord_error_is_held(chord_error: str) -> None:
    contour = CONTOURS["slot"]
    text, _ = unrolled(contour.program, *METHODS["per-minute"], "--chord-error", chord_error)
    blocks = of_section(blocks_of(text), contour.first, contour.last)
    assert 0.7 * float(chord_error) <= largest(blocks, contour.distance) <= float(chord_error)


@pytest.mark.nightly
@looped(
    ("name", "place"),
    [
        ("circle off the center", lambda share: 12 + 5j + 6 * np.exp(2j * np.pi * share)),
        ("line by the center", lambda share: 20 - 40 * share + 0.3j),
    ],
)
def test_the_number_of_blocks_is_near_the_least(name: str, place: Callable[[Floats], Points]) -> None:
    """The least: each block as long as the chord error, or 5 deg of C, lets it be, found by halving."""
    contour = CONTOURS[name]
    text, _ = unrolled(contour.program)
    count = len(of_section(blocks_of(text), contour.first, contour.last))
    least, at = 0, 0.0
    while at < 1:
        low, high = 0.0, min(1 - at, 0.25)
        if not _fits(contour, place, at, at + high):
            for _ in range(30):
                middle = (low + high) / 2
                low, high = (middle, high) if _fits(contour, place, at, at + middle) else (low, middle)
            at += low
        else:
            at += high
        least += 1
    assert least <= count <= 1.15 * least + 2


def _fits(contour: Contour, place: Callable[[Floats], Points], first: float, last: float) -> bool:
    ends = place(np.array([first, last]))
    middle = np.unwrap(np.angle(place(np.linspace(first, last, 9))))
    turn = math.degrees(middle[-1] - middle[0])
    block = Block("", (abs(ends[0]), 0.0, 0.0), (abs(ends[1]), turn, 0.0), 1.0, False, False)
    points = block.points() * np.exp(1j * middle[0])
    return abs(turn) <= 5 and float(np.max(np.abs(contour.distance(points)))) <= 0.005


# ---- limits and times ----


def test_c_keeps_its_limit_and_the_block_takes_longer() -> None:
    contour = CONTOURS["line by the center"]
    text, said = unrolled(contour.program, *METHODS["per-minute"], "--set", "limits.c_feed=3600")
    blocks = of_section(blocks_of(text), contour.first, contour.last)
    assert max(block.ways[1] / block.minutes("per-minute") for block in blocks) <= 3600
    assert fastest(blocks, "per-minute")[1] <= 300.01
    # Near the center C turns at its limit: by acos of the distance at which F asks for it, on both sides.
    near = math.sqrt(0.3 * 300 / math.radians(3600))
    turn = 2 * math.degrees(math.acos(0.3 / near))
    free = 2 * (20 - math.sqrt(near**2 - 0.3**2)) / 300
    minutes = sum(block.minutes("per-minute") for block in blocks)
    assert minutes == pytest.approx(free + turn / 3600, rel=0.01)
    assert "slower than its F" in said
    assert figure(said, "time at feed now") > figure(said, "time at feed in the mode") + 1


def test_x_keeps_its_limit() -> None:
    text, _ = unrolled(f"{HEAD}G1 X40. F900\n{END}", *METHODS["per-minute"], "--set", "limits.x_feed=600")
    assert "\nG1 X40. C0 F600\n" in text


def test_times_are_those_of_the_mode() -> None:
    _, said = unrolled(HEXAGON.program, *METHODS["inverse-time"], *HEXAGON.options)
    before, now = (figure(said, f"time at feed {when}") for when in ("in the mode", "now"))
    assert before == pytest.approx(60 * ((40 - 30) / 900 + (11 + 131.636 + 11) / 300), rel=1e-3)
    assert before <= now <= 1.01 * before


def test_the_block_rate_is_said_beside_what_the_control_runs() -> None:
    contour = CONTOURS["slot"]
    text, said = unrolled(contour.program, *METHODS["per-minute"], "--set", "limits.block_time=0.2")
    blocks = [block for block in blocks_of(text) if not block.rapid and block.ways[0] + block.ways[1]]
    times = np.array([60 * block.minutes("per-minute") for block in blocks])
    assert figure(said, "shortest block") == pytest.approx(times.min(), rel=1e-3)
    begin = np.cumsum(times) - times
    most = max(int(np.sum((begin >= at) & (begin < at + 1))) for at in begin.tolist())
    assert abs(figure(said, "most of them in one second") - most) <= 1
    assert f": {np.sum(times < 0.2)} blocks are shorter than the 0.2 s that the control needs" in said
    assert figure(said, "bytes before") == len(contour.program)
    assert figure(said, "bytes after") == len(text)


def test_stepwise_f_is_the_lowest_of_several_blocks() -> None:
    contour = CONTOURS["circle off the center"]
    each, stepwise = (
        blocks_of(unrolled(contour.program, *METHODS["per-minute"], *option)[0])
        for option in ((), ("--feed", "stepwise"))
    )
    assert [block.end for block in each] == [block.end for block in stepwise]
    shares = [step.feed / block.feed for block, step in zip(each, stepwise, strict=True) if not block.rapid]
    assert 0.899 <= min(shares) <= max(shares) <= 1
    assert sum("F" in block.text for block in stepwise) < sum("F" in block.text for block in each) / 2


# ---- what a path may be ----


def test_a_full_circle_about_the_center_is_two_blocks_of_c() -> None:
    text, _ = unrolled(f"{HEAD}G1 X40. F200\nG3 X40. C0 I-20. J0\nG2 X40. C0 I-20. J0\n{END}")
    assert "\nG1 X40. C0 F200\nC180. F572.95\nC360.\nC180.\nC0\n" in text


@pytest.mark.ci
def test_c_counts_on_over_full_turns_or_rolls_over() -> None:
    program = f"{HEAD}G1 X40. F200\nG3 X40. C0 I-20. J0\nG3 X40. C0 I-20. J0\n{END}"
    text, said = unrolled(program)
    assert "\nC180. F572.95\nC360.\nC540.\nC720.\n" in text.replace("G1 C", "C")
    assert "line 9: C has turned on by 2 turns, to 720 deg" in said
    assert "C has turned on by 1 turn, to 360 deg" in unrolled(program.replace("G3 X40. C0 I-20. J0\n", "", 1))[1]
    assert "that it does not roll over there is in doubt" in said
    rolls, said = unrolled(program, *METHODS["per-minute"], "--set", "control.rotary_rolls_over=true")
    assert "\nC120. F572.95\nC240.\nC0\nC120.\nC240.\nC0\n" in rolls.replace("G1 C", "C")
    assert "turned on" not in said


def test_through_the_center_c_turns_on_the_spot() -> None:
    text, said = unrolled(f"{HEAD}G1 X40. F200\nX-60.\n{END}")
    assert "\nG1 X40. C0 F200\nX0\nC180. F3600\nX60. F200\n" in text
    assert "through the center of C, where C turns on the spot: line 8" in said


def test_a_helix_goes_down_evenly() -> None:
    text, _ = unrolled(f"{HEAD}G1 X36. C5. Z0 F300\nG3 X36. C5. I-6. J0 Z-3.\nG1 X80. C0\n{END}")
    blocks = of_section(blocks_of(text), 18 + 5j, 18 + 5j)
    turned = 0.0
    for block in blocks:
        ends = block.points(2) - (12 + 5j)
        turned += float(np.angle(ends[1] / ends[0]))
        assert block.end[2] == pytest.approx(-3 * turned / (2 * math.pi), abs=2e-3)
    assert turned == pytest.approx(2 * math.pi, abs=1e-3)


def test_depths_rapids_and_what_else_stands_in_a_section() -> None:
    text, _ = unrolled(
        f"{HEAD}G1 X60. F300 (NEAR)\nM8\nG1 Z-1. F100\nX40. F200\nG4 P500\nZ-2. F100 S800\nX60. F200 M9\nG0 Z2.\n{END}"
    )
    assert text == (
        HEAD.replace("G12.1\n", "")
        + "G1 X60. C0 F300 (NEAR)\nM8\nZ-1. F100\nX40. F200\nG4 P500\nZ-2. F100 S800\nX60. F200 M9\nG0 Z2.\n"
        + END.replace("G13.1\n", "")
    )


def test_a_section_in_which_nothing_moves_is_left_out() -> None:
    assert unrolled(f"{HEAD}{END}")[0] == f"{HEAD}{END}".replace("G12.1\n", "").replace("G13.1\n", "")


def test_rapid_traverse_keeps_its_path_by_the_f_for_positioning() -> None:
    program = f"{HEAD}G0 X20. Y12.\nG1 X-20. F300\nG0 X80. Y0\n{END}".replace("G12.1", "G112").replace("G13.1", "G113")
    haas = ("--machine", "haas-lathe", "--feed", "per-minute")
    text, _ = unrolled(program.replace("G0 X100. Z50.", "X100."), *haas)
    blocks = of_section(blocks_of(text), 40 + 0j, 20 + 12j)
    assert not any(block.rapid for block in blocks)
    assert 1480 <= fastest(blocks, "per-minute")[1] <= 1500.1
    # The next move took G0 over from the section.
    assert "G0\nX100.\n" in text


def test_subprograms_and_loops_are_written_out_where_they_run() -> None:
    program = f"{HEAD}Z0\nM98 P30002\nG1 Z5.\n{END}".replace("%\nO1", "%\nO1").replace(
        "M30\n%", "M30\nO2\nG1 W-1. F100\nX60. F500 (PASS)\nX40.\nX80.\nM99\n%"
    )
    text, said = unrolled(program)
    passes = "".join(
        f"{code}Z-{depth}. F100\nX60. {first}F500{comment}\nX40.\nX80.\n"
        for depth, code, first, comment in ((1, "G1 ", "C0 ", " (PASS)"), (2, "", "", ""), (3, "", "", ""))
    )
    assert text == HEAD.replace("G12.1\n", "") + "G0 Z0\n" + passes + "Z5.\n" + END.replace("G13.1\n", "")
    assert "the subprogram is written out where it ran, and left out here" in said
    loop = f"{HEAD}#1=1\nWHILE[#1LE3]DO1\nG1 Z-#1 F100\nX60. F500 (PASS)\nX40.\nX80.\n#1=#1+1\nEND1\nZ5.\n{END}"
    assert unrolled(loop)[0] == text.replace("G0 Z0\n", "")


# ---- the style of the program ----


def test_bytes_are_written_as_the_program_is() -> None:
    program = (
        "%\r\nO0001(\xc4RGER)\r\nN0010g21g98g40\r\nN0020t0101\r\nN0030g0x80.z2.c0\r\nN0040g12.1(ON)\r\n"
        "N0050g1x60.f500\r\nN0060z-5.f300(DOWN)\r\nN0070x50.f200\r\nN0080c5.m8\r\nN0090z2.\r\nN0100g13.1\r\n"
        "N0110g0x100.z50.\r\nN0120m30\r\n%\r\n"
    ).encode("latin-1")
    result = call(program, *METHODS["per-minute"], "--chord-error", "0.1")
    assert result.exit_code == 0
    new = result.stdout_bytes
    head, tail = program.split(b"N0040g12.1(ON)\r\n")[0], b"N0110g0x100.z50.\r\nN0120m30\r\n%\r\n"
    assert new.startswith(
        head + b"N0040 (ON)\r\nN0050g1x60.c0f500\r\nN0060z-5.f300 (DOWN)\r\nN0070x50.f200\r\nN0080x50."
    )
    assert new.endswith(tail)
    section = new[len(head) : -len(tail)]
    assert re.search(rb"m8\r\nn008[125]x", section)
    assert not re.search(rb"[^\r]\n", section)
    assert not re.search(rb"[XCZFGM ]", section.replace(b" (ON)", b"").replace(b" (DOWN)", b""))


def test_inch() -> None:
    program = "O1\nG20 G98 G40\nT0101\nG0 X3. Z.1 C0\nG12.1\nG1 X1.5 C.25 F7.\nX-1.5\nG1 X3. C0\nG13.1\nM30\n"
    text, _ = unrolled(program)
    blocks = of_section(blocks_of(text, scale=25.4), 25.4 * (0.75 + 0.25j), 25.4 * (-0.75 + 0.25j), 4e-3)
    assert largest(blocks, from_line(25.4 * (0.75 + 0.25j), 25.4 * (-0.75 + 0.25j))) <= 0.005
    # F counts inches and degrees alike.
    for block in blocks:
        minutes = math.hypot(block.ways[0] / 25.4, block.ways[1]) / block.feed
        assert 0.95 * 7 <= way([block]) / 25.4 / minutes <= 7.0003


def test_axes_with_a_number_and_codes_with_zeros() -> None:
    program = HEAD.replace("G0 X80. C0", "G0 X1=80. C1=0").replace("Z2.", "Z1=2.")
    program += "G1 X1=60. C1=10. F100\nX1=80. C1=0\n" + END.replace("G0 X100. Z50.", "G0 X1=100.")
    text, _ = unrolled(program, *METHODS["per-minute"], "--chord-error", "0.1")
    assert len(re.findall(r" C1=", text)) >= 5
    assert not re.search(r"[XC][0-9]+\.", text.replace("X1=", "").replace("C1=", ""))
    zeros = f"{HEAD}G1 X60. F100\n{END}".replace("G0", "G00").replace("G1 ", "G01 ")
    assert "\nG01 X60. C0 F100\n" in unrolled(zeros)[0]


def test_the_code_of_f_is_written_where_no_block_says_it() -> None:
    bare = HEAD.replace("G98 ", "")
    text, said = unrolled(f"{bare}G1 X60. F100\n{END}")
    assert "\nG98 G1 X60. C0 F100\n" in text
    assert "no code says that F is per minute" in said
    assert "\nG1 X60. C0 F100\n" in unrolled(f"{HEAD}G98 G1 X60. F100\n{END}")[0]
    assert "\nG98 G1 X60. C0 F100\n" in unrolled(f"{bare}G98 G1 X60. F100\n{END}")[0]


def test_okuma_moves_by_g1_since_g101_is_a_line_on_the_plane() -> None:
    program = "O1\nG94 G40\nT0101\nG0 X80. C0 Z2.\nG137 C0\nG17\nG101 X30. Y0 F200\nG101 Y10.\nG136\nM30\n"
    text, _ = unrolled(program, "--machine", "okuma-osp", "--feed", "per-minute")
    assert "\nG1 X60. C0 F200\n" in text
    assert "G101" not in text


def test_block_skip_is_that_of_one_position_of_the_switch() -> None:
    program = f"{HEAD}G1 X60. F100\n/X40.\n/M8\nX50.\n{END}"
    assert "choose with --block-skip" in reasons(program)[0]
    runs, _ = unrolled(program, *METHODS["per-minute"], "--block-skip", "off")
    assert "\nG1 X60. C0 F100\nX40.\n/M8\nX50.\n" in runs
    skips, said = unrolled(program, *METHODS["per-minute"], "--block-skip", "on")
    assert "\nG1 X60. C0 F100\n/M8\nX50.\n" in skips
    assert "line 8: written for this position of the switch" in said


# ---- what is refused ----


@pytest.mark.ci
@looped(
    ("program", "arguments", "expected"),
    [
        (HEXAGON.program, (), "8: R of T0101 is not known: give --tool 1:radius=..."),
        (f"{HEAD}G1 X60. F100\n{END}", ("--machine", "gsk-988"), "None: what F is where X and C move together"),
        (f"{HEAD}G1 X60. F100\n{END}", (*METHODS["inverse-time"], "--feed", "stepwise"), "None: how X and C share F"),
        (f"{HEAD}G1 X60. F100\nG0 X100.\nM30\n%\n", (), "6: read for fanuc-30i, it means something else: polar mode"),
        (f"{HEAD.replace(' C0', '')}G1 X60. F100\n{END}", (), "6: C is not known where the mode begins"),
        (f"{HEAD}G1 X60.\n{END}", (), "7: F is missing"),
        (f"{HEAD}G1 X60. F100\nG3 X40. C5.\n{END}", (), "8: "),
        (f"{HEAD}G1 X60. F100\nG28 U0\n{END}", (), "8: a code in the mode leads to other coordinates"),
        (f"{HEAD}G1 X60. F100\n#3006=1\n{END}", (), "8: #3006 is set: what it does would be lost"),
        (f"{HEAD}G1 X60. F100\nG3 X40. C5. R1.\n{END}", (), "8: a radius of 1 mm does not reach"),
        (HEXAGON.program.replace("G40 X60.\n", ""), ("--tool", "1:radius=4"), "16: cutter compensation is in force"),
        (f"{HEAD}G1 X60. F100\n{END}", ("--set", "limits.x_minimum=35"), "7: X would go below its travel limit of 35"),
        (f"{HEAD}G1 X60. C9. F100\n{END}", ("--chord-error", "0.0008"), "7: rounding of X and C alone moves the tool"),
        ("O1\nG0 X10.\nM30\n", (), "None: there is no polar section in it"),
    ], one_in=2,
)  # fmt: skip
def test_the_reason_is_named(program: str, arguments: tuple[str, ...], expected: str) -> None:
    machine = () if "--machine" in arguments else METHODS["per-minute"]
    assert any(reason.startswith(expected) for reason in reasons(program, *machine, *arguments))


def test_a_word_that_cannot_be_read_is_one_reason() -> None:
    """Where the tool goes with it is not known, too, and no variable says it."""
    program = f"{HEAD}G1 X60. F100\nX.\nC9.\n{END}"
    found = reasons(program, *METHODS["per-minute"])
    assert [reason for reason in found if not reason.startswith("None")] == [
        "8: X.: no digits after the address [bad-number]"
    ]
    doubts = [entry.reason for entry in report_of(program).not_evaluated]
    position = "the position is not known: X. in line 8 leaves open where the tool goes"
    assert f"{position}; write numbers that the control can read" in doubts


def test_on_the_sub_spindle_only_where_the_profile_says_how_c_turns() -> None:
    program = HEAD.replace("G12.1", "M135\nG0 C0\nG12.1") + f"G1 X60. C10. F100\n{END}"
    assert call(program, *METHODS["per-minute-c"], "--set", "polar.sub_spindle_plane=as-main").exit_code == 0
    unknown = (*METHODS["per-minute-c"], "--set", "polar.sub_spindle_plane=unknown")
    assert any("on the sub-spindle is not known" in reason for reason in reasons(program, *unknown))


@pytest.mark.ci
def test_a_program_in_a_file_is_kept() -> None:
    Path("a.nc").write_text(CONTOURS["slot"].program)
    run = CliRunner()
    options = ["--machine", "fanuc-30i"]
    assert run.invoke(main, ["unroll", "a.nc", "--in-place", *options]).exit_code == 2
    result = run.invoke(main, ["unroll", "a.nc", "--diff", *options])
    assert result.exit_code == 1
    assert "-G3 X60. C5. R5." in result.stdout
    assert run.invoke(main, ["unroll", "a.nc", "--in-place", "--backup", *options]).exit_code == 0
    assert Path("a.nc.orig").read_text() == CONTOURS["slot"].program
    assert Path("a.nc").read_text() == unrolled(CONTOURS["slot"].program)[0]


@pytest.mark.nightly
def test_a_long_section_has_a_block_for_each_short_line() -> None:
    """20,000 lines around the center, each within the chord error of one block."""
    turns = np.exp(1j * 0.02 * np.arange(20_000)) * (15 + 10 * np.sin(0.0013 * np.arange(20_000)))
    lines = "".join(f"X{2 * point.real:.3f} C{point.imag:.3f}\n" for point in turns.tolist())
    text, said = unrolled(f"{HEAD}G1 X30. F500\n{lines}{END}")
    assert figure(said, "blocks of X and C") <= 20_050
    ends = [block.points(2)[-1] for block in blocks_of(text) if not block.rapid and block.ways[0] + block.ways[1]]
    assert np.abs(np.array(ends[-19_999:]) - turns[1:]).max() < 2e-3


_POINT = st.builds(complex, st.integers(-40_000, 40_000), st.integers(-40_000, 40_000)).map(lambda point: point / 1000)


@pytest.mark.nightly
@given(st.lists(_POINT, min_size=1, max_size=6), st.sampled_from(list(METHODS)), st.sampled_from(["3600", "20000"]))
@settings(max_examples=25, deadline=None, phases=[Phase.explicit, Phase.generate])
def test_any_lines_are_followed_in_order(points: list[complex], method: str, limit: str) -> None:
    """Each block lies on the line whose turn it is; no block is faster than F, and C keeps its limit."""
    corners = [40 + 0j, *points]
    lines = list(pairwise(corners))
    assume(all(abs(end - start) > 0.05 for start, end in lines) and all(abs(point) > 0.5 for point in points))
    words = "".join(f"X{2 * point.real:.3f} C{point.imag:.3f}\n" for point in points)
    text, _ = unrolled(f"{HEAD}G1 F500\n{words}{END}", *METHODS[method], "--set", f"limits.c_feed={limit}")
    blocks = [block for block in blocks_of(text) if not block.rapid and block.ways[0] + block.ways[1]]
    at = 0
    for block in blocks:
        if not block.ways[0] and not block.start[0]:
            continue  # C turns on the spot
        assert _beyond(lines[at], block) <= 0.006
        assert fastest([block], method)[1] <= 500.1
        assert block.ways[1] / block.minutes(method) <= float(limit) * 1.0001
        at += abs(block.points(2)[-1] - lines[at][1]) <= 2e-3
    assert at == len(lines)


def _beyond(line: tuple[complex, complex], block: Block) -> float:
    """How far a block is from a line between two points, its ends included."""
    way = line[1] - line[0]
    offset = (block.points() - line[0]) * np.conj(way) / abs(way)
    along = np.maximum(np.maximum(-offset.real, offset.real - abs(way)), 0)
    return float(np.hypot(along, offset.imag).max())


@pytest.mark.ci
@looped("side", ["", "G42 "])
def test_corners_that_the_control_makes_are_run_along(side: str) -> None:
    """RND=2 and CHF=1 of a Siemens: the tool keeps R off the arc about X18 Y8, and off the chamfer."""
    blocks = f"G1 {side}X20 Y0 F200\nY10 RND=2\nX-20\nY-10 CHF=1\nX20\nY0\nG40 X28"
    head = "G90 DIAMON G71 G94\nT1 D1\nG0 X60 Z2 C0\nDIAMOF\nTRANSMIT\nG17\n"
    program = f"{head}{blocks}\nTRAFOOF\nDIAMON\nM30\n"
    text, _ = unrolled(program, "--machine", "siemens-transmit", "--feed", "per-minute", "--tool", "1/1:radius=3")
    moves = re.findall(r"^(?:G1 )?(?:X([\d.]+) ?)?(?:C([-\d.]+))?", text, re.MULTILINE)
    x, c, points = 30.0, 0.0, []
    for words in moves:
        x, c = (float(word) if word else value for word, value in zip(words, (x, c), strict=True))
        points.append(cmath.rect(x, math.radians(-c)))
    offset = 3.0 if side else 0.0
    along = [abs(point - (18 + 8j)) for point in points if point.real > 18.01 and point.imag > 8.01]
    assert len(along) > 5
    assert max(abs(distance - 2 - offset) for distance in along) < 0.006
    chamfer = [abs((point + 20 + 9.2929j).real + (point + 20 + 9.2929j).imag) / math.sqrt(2) for point in points]
    assert sum(abs(distance - offset) < 0.006 for distance in chamfer) >= 2
    assert "RND" not in text
