"""Plain moves of X and C become polar sections of lines and arcs: polarcheck roll."""

from __future__ import annotations

import json
import math
import re
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from cases import looped
from click.testing import CliRunner, Result
from programs import job_of, machine_of
from rolled_programs import cam_contour, cam_program, farthest, way_of_blocks, way_of_section
from unrolled_contours import hexagon, oval, places, slot

from polarcheck.checking.settings import Settings
from polarcheck.commands import main
from polarcheck.foundation.states import Motion
from polarcheck.geometry.comparison.path_deviation import path_deviation
from polarcheck.rewrite.roll.rolling import Rolling, rolled
from polarcheck.rewrite.unroll.unrolling import Unrolling, unrolled
from polarcheck.rewrite.writing.original import Original, read
from polarcheck.rewrite.writing.outcome import Outcome, RefusedError
from polarcheck.rewrite.writing.part_paths import path_on_part

TOLERANCE = 0.01


def original_of(text: str | bytes, machine: str = "fanuc-30i", changes: Mapping[str, Any] | None = None) -> Original:
    settings = Settings(machine, machine_of(machine, changes), job_of(), (), {})
    return read("a.nc", text.encode() if isinstance(text, str) else text, settings)


def roll(
    text: str | bytes, machine: str = "fanuc-30i", changes: Mapping[str, Any] | None = None, **options: Any
) -> Outcome:
    return rolled(original_of(text, machine, changes), Rolling(**options))


def new_text(text: str, machine: str = "fanuc-30i", **options: Any) -> str:
    return roll(text, machine, **options).data.decode()


def refusal(text: str, machine: str = "fanuc-30i", **options: Any) -> str:
    with pytest.raises(RefusedError) as error:
        roll(text, machine, **options)
    return str(error.value)


def figures(outcome: Outcome) -> dict[str, float]:
    return {figure.name: figure.value for figure in outcome.figures}


def feeds(text: str) -> list[float]:
    """F of the blocks of the first section with X or C, in their order."""
    section = text.split("G12.1\n")[1].split("G13.1")[0].splitlines()
    return [float(match[1]) for line in section if (match := re.search(r"F([0-9.]+)", line)) and "Z" not in line]


# ---- the way of the tool ----

CONTOURS = {"hexagon": (hexagon(), 13), "slot": (slot(), 5), "oval": (oval(), 5)}


@pytest.mark.ci
@pytest.mark.one_in(12)
@pytest.mark.parametrize("name", CONTOURS)
@pytest.mark.parametrize("inverse", [False, pytest.param(True, marks=pytest.mark.ci)])
def test_a_contour_of_lines_and_arcs_comes_back_with_as_many_of_them_and_its_f(name: str, inverse: bool) -> None:
    contour, count = CONTOURS[name]
    text = cam_contour(contour, inverse=inverse)
    outcome = roll(text)
    new = outcome.data.decode()
    way, kinds = way_of_section(new)
    assert len(kinds) == count
    assert farthest(way_of_blocks(text, 1), way) <= TOLERANCE
    assert farthest(way, way_of_blocks(text)) <= TOLERANCE + 0.005  # the chords that the CAM allowed itself
    assert set(feeds(new)) - {1500.0} == {200.0}
    told = figures(outcome)
    assert told["blocks before"] == text.count(" C") - 2
    assert told["blocks after"] <= count + 6
    assert told["time at feed after"] == pytest.approx(told["time at feed before"], rel=1e-3)
    measured = farthest(way_of_blocks(text, 1), way)
    # Here an arc has the radius of its start; a control takes it to the end that is written.
    assert told["largest distance of the ends of the blocks from the new path"] == pytest.approx(measured, abs=1e-3)


@pytest.mark.nightly
def test_a_free_contour_is_passed_within_the_tolerance() -> None:
    angle = np.linspace(0, math.tau, 801)
    points = (20 + 2 * np.sin(5 * angle) + 0.7 * np.sin(13 * angle + 1)) * np.exp(1j * angle)
    text = cam_program(points, 300.0)
    counts = {}
    for tolerance in (0.005, 0.02):
        outcome = roll(text, tolerance=tolerance)
        way, kinds = way_of_section(outcome.data.decode())
        assert farthest(way_of_blocks(text, 1), way) <= tolerance
        counts[tolerance] = len(kinds)
    assert counts[0.02] < counts[0.005] < 120


@pytest.mark.nightly
def test_twenty_thousand_blocks_are_few() -> None:
    angle = np.linspace(0, math.tau, 20_001)
    points = (20 + 2 * np.sin(5 * angle) + 0.7 * np.sin(13 * angle + 1)) * np.exp(1j * angle)
    text = cam_program(points, 300.0, inverse=True)
    outcome = roll(text)
    told = figures(outcome)
    assert told["blocks before"] == 20_000
    assert told["blocks after"] < 100
    way, _ = way_of_section(outcome.data.decode())
    assert farthest(way_of_blocks(text, 1)[::7], way) <= TOLERANCE


@pytest.mark.nightly
def test_several_depths_are_one_section_and_stretches_apart_are_several() -> None:
    points = places(*hexagon(), 0.005)
    lines = cam_program(points).splitlines()
    again = [re.sub(r"C([-0-9.]+)", lambda match: f"C{float(match[1]) + 360:.3f}", line) for line in lines[6:-4]]
    deeper = "\n".join([*lines[:-4], "G1 Z-4. F80.", *again, *lines[-4:], ""])
    outcome = roll(deeper)
    new = outcome.data.decode()
    assert figures(outcome)["sections"] == 1
    assert len(way_of_section(new)[1]) == 26
    assert "\nZ-4.000 F80" in new
    two = "\n".join([*lines[:-3], "G0 X20. C0", "G1 Z-4. F100.", *lines[6:-4], "G0 Z2.", *lines[-3:], ""])
    outcome = roll(two)
    assert figures(outcome)["sections"] == 2
    assert outcome.data.decode().count("G12.1") == outcome.data.decode().count("G13.1") == 2


def test_x_alone_c_alone_and_long_blocks_belong_to_it() -> None:
    steps = "\n".join(f"G1 X{60 - k:.1f} F100." for k in range(1, 11))
    arc = "G1 C120. F600."
    out = "\n".join(f"G1 X{50 + k:.1f} F100." for k in range(1, 6))
    new = new_text(f"G21 G98\nG0 X60. C0 Z2.\nG1 Z-1. F100.\n{steps}\n{arc}\n{out}\nG0 Z2.\nM30\n")
    assert way_of_section(new)[1] == ["G1", "G3", "G1"]


@pytest.mark.ci
def test_x_below_zero_is_the_other_side_and_through_the_center_is_one_line_where_the_machine_lets_it() -> None:
    inward = "\n".join(f"G1 X{2 * x:.1f} C30. F400." for x in np.arange(19.5, -0.1, -0.5))
    below = "\n".join(f"G1 X{-2 * x:.1f} F400." for x in np.arange(0.5, 20.1, 0.5))
    turned = "C210. F60.\n" + "\n".join(f"G1 X{2 * x:.1f} F400." for x in np.arange(0.5, 20.1, 0.5))
    along = "\n".join(f"G1 X40. C{210 + 2 * k}. F300." for k in range(1, 30))
    head = "G71 G94\nDIAMON\nG0 X40. C30. Z2.\nG1 Z-2. F100.\nG93\n"
    new = new_text(f"{head}{inward}\n{turned}\n{along}\nG94\nG0 Z5.\nM30\n", "siemens-transmit")
    section = [line for line in new.split("TRANSMIT\n")[1].split("TRAFOOF")[0].splitlines() if "X" in line]
    assert [line[:2] for line in section] == ["G1", "G3"] or [line[:2] for line in section] == ["G1", "G2"]
    text = f"{head}{inward}\n{below}\n{along}\nG94\nG0 Z5.\nM30\n".replace("X40. C", "X-40. C").replace(
        "G0 X-40. C30", "G0 X40. C30"
    )
    assert "X is below zero where it ends" in refusal(text.replace("C21", "C3").replace("C2", "C4"), "siemens-transmit")
    for machine in ("fanuc-30i", "haas-lathe"):
        plain = f"{head}{inward}\n{turned}\n{along}\nG94\nG0 Z5.\nM30\n"
        plain = plain.replace("G71 G94\nDIAMON", "G21 G98").replace("G94", "G98")
        assert "through the center of C" in refusal(plain, machine)


@pytest.mark.ci
def test_c_that_rolls_over_goes_on_and_turns_back_on_a_lathe_that_does_not() -> None:
    text = cam_contour(hexagon())
    within = re.sub(r" C([0-9.]+)", lambda match: f" C{float(match[1]) % 360:.3f}", text)
    new = new_text(within, changes={"control": {"rotary_rolls_over": True}})
    assert len(way_of_section(new)[1]) == 13
    assert "C turns back by nearly a turn here" in refusal(within)


@pytest.mark.ci
def test_a_helix_is_written_where_z_may_stand_beside_the_plane() -> None:
    points = places(*hexagon(), 0.005)
    text = cam_program(points, inverse=True, z=np.linspace(-2, -4, len(points)).tolist())
    new = new_text(text, "haas-lathe")
    section = new.split("G112\n")[1].split("G113")[0].splitlines()
    depths = [float(match[1]) for line in section if (match := re.search(r"Z(-[0-9.]+)", line))]
    assert len(section) == len(depths) == 13
    assert depths == sorted(depths, reverse=True)
    assert depths[-1] == -4
    assert refusal(text).startswith("line 8: Z moves beside X and C")
    assert "Z cannot move in an arc" in refusal(text, "hurco")


# ---- there and back ----

_ON = {
    "fanuc-30i": (["G12.1"], ["G13.1"], "C", 2, "G98"),
    "haas-lathe": (["G17", "G112"], ["G113", "G18"], "Y", 1, "G98"),
    "siemens-transmit": (["DIAMOF", "TRANSMIT", "G17"], ["TRAFOOF", "DIAMON"], "Y", 1, "G94"),
    "mitsubishi-m700": (["G12.1"], ["G13.1"], "C", 1, "G94"),
    "hurco": (["G7", "G101", "G17"], ["G109", "G8"], "Y", 1, "G94"),
    "doosan": (["G12.1"], ["G13.1"], "C", 2, "G98"),
    "mazak-quick-turn": (["G17 XC", "G12.1"], ["G13.1"], "C", 2, "G98"),
}


def polar_program(machine: str, inch: bool, c: str) -> str:
    """Nine lines and arcs in a section, in the words of a machine."""
    on, off, v, factor, per_minute = _ON[machine]
    unit = 25.4 if inch else 1.0
    is_siemens = machine == "siemens-transmit"
    units = {True: {True: "G700", False: "G71"}, False: {True: "G20", False: "G21"}}[is_siemens][inch]

    def at(x: float, y: float, radius: float = 0.0) -> str:
        arc = f" {'CR=' if is_siemens else 'R'}{radius / unit:.4f}" if radius else ""
        return f"X{x * factor / unit:.4f} {v}{y / unit:.4f}{arc}"

    blocks = [
        *([] if is_siemens else ["O0001"]),
        f"{units} {per_minute}",
        *(["DIAMON"] if is_siemens else []),
        f"G0 X{60 / unit:.4f} {c} Z{2 / unit:.4f}",
        *on,
        f"G1 Z{-2 / unit:.4f} F{100 / unit:.3f}",
        f"G1 {at(20, 5)} F{200 / unit:.3f}",
        f"G3 {at(15, 10, 5)}",
        f"G1 {at(-15, 10)}",
        f"G3 {at(-20, 5, 5)}",
        f"G1 {at(-20, -8)}",
        f"G2 {at(-12, -16, 8)}",
        f"G1 {at(20, -16)}",
        at(20, 5),
        at(30, 0),
        f"G1 Z{2 / unit:.4f} F{500 / unit:.3f}",
        *off,
        f"G0 X{80 / unit:.4f} C0",
        "M30",
        "",
    ]
    return "\n".join(blocks)


@pytest.mark.ci
@looped("c", ["C0", "C37.5"], one_in=28)
@looped("inch", [False, True])
@looped("machine", _ON)
def test_a_section_without_the_mode_and_back_is_the_same_contour(machine: str, inch: bool, c: str) -> None:
    original = original_of(polar_program(machine, inch, c), machine)
    known = original.settings.machine.feed.with_rotary
    feed = "" if known else "per-minute"
    plain = unrolled(original, Unrolling(feed=feed))
    outcome = roll(plain.data, machine, feed=feed, keep_c=True)
    again = original_of(outcome.data, machine)
    paths = [path_on_part(each.tables) for each in (original, again)]
    assert path_deviation(paths[0], paths[1], TOLERANCE).largest <= 0.003
    moves = [each.trace.path.travels & each.trace.mode.in_polar for each in (original, again)]
    counts = [int(own.sum()) for own in moves]
    assert counts[0] == 9
    # An arc of 90 deg whose rounded ends are beyond the limit of 90 deg is two.
    assert counts[1] in ((9, 10) if machine == "hurco" else (9,))
    for each, own in zip((original, again), moves, strict=True):
        written = each.trace.feedrate.feed[own & (each.trace.axes.motion != Motion.RAPID)]
        assert np.nanmin(written) == pytest.approx(200, rel=0.01)
        assert np.nanmax(written) == pytest.approx(200, rel=0.01)


# ---- where the section begins ----


@pytest.mark.nightly
def test_c_goes_to_0_above_the_part_so_that_the_coordinates_are_those_of_the_drawing() -> None:
    text = cam_contour(slot())
    outcome = roll(text)
    new = outcome.data.decode()
    assert "Z2.\nG0 C0.000\nG12.1\nG2 X40.000 C-5.000 I-20.616 J0.000 F1500.0000\nG1 Z-2.000 F100.0000\nX60.000" in new
    assert any("behind line 5 C goes to 0 above the part" in note for note in outcome.notes)
    turned = roll(text, keep_c=True)
    assert b"Z2.\nG1 Z-2.000 F100.\nG12.1\nG1 X60.634 C2.425" in turned.data
    assert any("its coordinates are turned by C-14.036" in note for note in turned.notes)
    beside = text.replace("Z2.\nG1 Z-2.000", "Z-2.\nG1 Z-2.000")
    assert "G0 C0" not in new_text(beside)
    assert "G0 C0" not in new_text(text.replace("Z2.\n", "G1 Z2. F900.\n"))
    one_block = text.replace("C-14.036\nZ2.", "C-14.036 Z2.")
    assert "G0 X41.231 C0.000 Z2.\nG12.1\nG2 X40.000 C-5.000" in new_text(one_block)
    slow = roll(text, changes={"limits": {"c_feed": 3600.0}}).data.decode()
    assert max(feeds(slow)) == pytest.approx(0.9 * 3600 * math.pi / 180 * 20.616, rel=1e-3)


@pytest.mark.ci
def test_the_nearest_full_turn_of_c_is_its_zero() -> None:
    text = re.sub(r"C([-0-9.]+)", lambda match: f"C{float(match[1]) + 720:.3f}", cam_contour(slot()))
    assert "G0 C720.\nG12.1" in new_text(text).replace("720.000", "720.")


def test_a_plane_that_stands_still_on_the_part_needs_no_c() -> None:
    text = cam_contour(slot(), inverse=True).replace("G98", "G94")
    new = new_text(text, "hurco")
    assert "G0 C0" not in new
    assert "G7\nG101\nG17\nG1 X30.000 Y-5.000" in new


# ---- F ----


@pytest.mark.nightly
def test_f_is_lower_near_the_center_and_the_line_is_divided_for_it() -> None:
    points = np.array([complex(1, y) for y in np.arange(-15, 15.01, 0.1)])
    angle = np.abs(np.diff(np.unwrap(np.angle(points))))
    speed = [300.0, *np.minimum(300, 3600 / np.degrees(angle / np.abs(np.diff(points)))).tolist()]
    text = cam_program(points, speed, inverse=True)
    for changes in ({"limits": {"c_feed": 3600.0}}, None):
        outcome = roll(text, changes=changes)
        own = feeds(outcome.data.decode())[1:]
        assert own[0] == pytest.approx(300, rel=0.01)
        assert own[-1] == 300
        assert min(own) <= 3600 * math.pi / 180
        assert min(own) == pytest.approx(3600 * math.pi / 180, rel=0.02)
        assert 5 < len(own) < 14
        told = figures(outcome)
        assert told["time at feed after"] == pytest.approx(told["time at feed before"], rel=0.06)
    overridden = roll(text, changes={"limits": {"c_feed": 3600.0, "automatic_override": True}})
    assert feeds(overridden.data.decode())[1:] == [300]


@pytest.mark.ci
def test_each_f_of_the_original_is_one_of_the_section() -> None:
    points = places(*hexagon(), 0.005)
    speed = [150.0 if point.real > 5 else 250.0 for point in points.tolist()]
    own = set(feeds(new_text(cam_program(points, speed))))
    assert {150.0, 250.0} <= own
    assert len(own) <= 4  # lines along which it changes have one of their own


def test_a_speed_that_changes_along_the_way_is_told() -> None:
    text = re.sub(r"(C[-0-9.]+) F[0-9.]+", r"\1", cam_contour(slot())).replace("F100.", "F100.\nF300.")
    outcome = roll(text)
    assert any(re.search(r"speed of the tool changed along it from [0-9.]+ to [0-9.]+", note) for note in outcome.notes)
    assert len(set(feeds(outcome.data.decode())[1:])) < 3


@pytest.mark.ci
def test_what_f_per_minute_is_has_to_be_known() -> None:
    text = cam_contour(hexagon())
    assert refusal(text, "haas-lathe").startswith("line 7: what F per minute is")
    assert "F200" in new_text(text, "haas-lathe", feed="per-minute")
    assert "no G93 is in force" in refusal(text, "haas-lathe", feed="inverse-time")
    of_c = roll(text, feed="per-minute-c")
    assert "F is per-minute-c as --feed says" in "\n".join(of_c.notes)


# ---- what stands around it ----


@pytest.mark.ci
@looped(
    ("behind", "expected"),
    [
        ("G0 Z2.\nX80. C0\nM30", "G13.1\nG0 Z2.\n"),
        ("Z2. F500.\nX80. C0\nM30", "G13.1\nZ2. F500.\n"),
        ("Z2.\nX80. C0\nM30", "G13.1\nF1144"),
        ("Z2. F500.\nC40.\nX80.\nM30", "G13.1\nG1 X20.000\nZ2. F500.\n"),
    ],
    one_in=4,
)
def test_what_the_stretch_leaves_in_force_is_in_force_behind_the_section(behind: str, expected: str) -> None:
    text = cam_contour(hexagon()).replace("G0 Z2.\nX80. C0\nM30", behind)
    assert expected in new_text(text)


@pytest.mark.ci
def test_inverse_time_is_in_force_again_where_blocks_behind_take_it_over() -> None:
    text = cam_contour(hexagon(), inverse=True)
    stays = text.replace("G98\nG0 Z2.\nX80. C0", "G1 Z2. F60.\nG0 X80. C0")
    assert "G13.1\nG93\nG1 Z2. F60.\n" in new_text(stays)
    assert "G93" not in new_text(text)


@pytest.mark.ci
def test_the_plane_is_in_force_again_where_arcs_follow() -> None:
    arc = "G0 X30. Z2.\nG1 Z-5. F100.\nG2 X40. Z-10. R5.\nG0 X90.\nM30"
    text = cam_contour(hexagon(), inverse=True).replace("M30", arc)
    assert "G13.1\nG18\nG98\n" in new_text(text, "mazak-quick-turn")
    assert "G18" not in new_text(text.replace("G2 X40.", "G1 X40.").replace(" R5.", ""), "mazak-quick-turn")


def test_an_arc_at_the_end_is_not_in_force_behind_the_section() -> None:
    text = cam_contour(oval()).replace("G0 Z2.\n", "Z2. F500.\n")
    assert "G13.1\nG1\nZ2. F500.\n" in new_text(text)


@pytest.mark.ci
def test_the_style_of_the_program_stays() -> None:
    lines = cam_contour(hexagon()).splitlines()
    numbered = [
        f"N{10 * k:04d}{line.replace(' ', '')}" if k and line[0] not in "%O" else line for k, line in enumerate(lines)
    ]
    numbered[10] += "(ENTR\xc9E)"
    data = "\r\n".join([*numbered, ""]).lower().encode("latin-1")
    new = roll(data).data
    assert b"(entr\xe9e)" in new
    assert new.count(b"\r\n") == new.count(b"\n") < 40
    section = new.split(b"g12.1")[1].split(b"g13.1")[0]
    numbers = [int(number) for number in re.findall(rb"^n(\d+)", new, re.MULTILINE)]
    assert numbers == sorted(numbers)
    assert len(numbers) == new.count(b"\r\n") - 3
    assert section.count(b" ") == 1  # before the comment
    assert section.islower()


@pytest.mark.ci
def test_comments_between_the_blocks_stay_where_they_are() -> None:
    lines = cam_contour(hexagon()).splitlines()
    lines[60:60] = ["", "(SECOND HALF)"]
    new = new_text("\n".join([*lines, ""]))
    assert new.index("G12.1") < new.index("(SECOND HALF)") < new.index("G13.1")


# ---- what stays as it is, and what is refused ----


@looped(
    ("was", "becomes", "said"),
    [
        ("Z2.\n", "Z2.\nG42 D1\n", "line 8: cutter compensation is in force"),
        ("G21 G98", "G21 G99", "line 7: F is per revolution"),
        ("X20.000 C0.000\n", "X20.000\n", "line 7: C is not known where it begins"),
        ("G0 X20.000 C0.000\n", "G0 C0.000\n", "line 7: X is not known where it begins"),
        ("Z2.\nG1 Z-2.000 F100.\n", "", "line 5: Z is not known where it begins"),
    ],
)
def test_what_cannot_be_a_section_is_refused_with_its_line(was: str, becomes: str, said: str) -> None:
    assert said in refusal(cam_contour(hexagon()).replace(was, becomes, 1))


def test_c_in_increments_behind_it_would_build_on_an_angle_that_is_rounded() -> None:
    text = cam_contour(hexagon()).replace("G0 Z2.\nX80. C0", "G0 Z2.\nX80. H10.")
    assert "C is programmed in increments behind it" in refusal(text)


def test_a_few_blocks_are_nothing_to_roll() -> None:
    assert "nothing to roll" in refusal("O1\nG21 G98\nG0 X40. C0\nG1 X30. F100.\nC20.\nM30\n")


def test_a_subprogram_that_runs_twice_and_computed_blocks_stay_as_they_are() -> None:
    lines = cam_contour(hexagon()).splitlines()
    blocks = "\n".join(lines[6:-4])
    twice = f"O1\nG21 G98\nG0 X20. C0\nG0 Z2.\nM98 P2\nG0 X20. C0\nM98 P2\nM30\nO2\n{blocks}\nM99\n"
    assert "its blocks run several times" in refusal(twice)
    computed = (
        "O1\nG21 G98\nG0 X20. C0\n#1=1\n" + "\n".join(f"G1 X{20 + k} C[#1*{k}] F100." for k in range(1, 20)) + "\nM30\n"
    )
    assert "its blocks are computed" in refusal(computed)


def test_what_may_be_jumped_into_and_contours_by_other_codes_stay_as_they_are() -> None:
    lines = cam_contour(hexagon()).splitlines()
    lines[60] = f"N70 {lines[60]}"
    jump = "\n".join([*lines[:3], "IF[#100EQ1]GOTO70", *lines[3:], ""])
    assert "a jump may lead to this block" in refusal(jump)
    assert "a jump may lead to this block" in refusal(jump.replace("GOTO70", "GOTO N70"))
    contour = "\n".join(line.replace("G1 X", "G101 X") for line in cam_contour(hexagon()).splitlines())
    assert "no plain move" in refusal(contour, "okuma-osp", feed="per-minute")


def test_drilling_turning_and_milling_on_the_cylinder_are_left_alone() -> None:
    drilling = "\n".join(f"G0 C{30 * k}.\nG1 Z-5. F80.\nG0 Z2." for k in range(12))
    turning = "\n".join(f"G1 X{40 - k} Z-{k}. F100." for k in range(1, 20))
    cylinder = "\n".join(f"G1 C{3 * k}. Z-{k}. F100." for k in range(1, 20)) + "\nX39. F50.\n"
    head = "O1\nG21 G98\nG0 X40. C0 Z2.\n"
    for body in (drilling, turning):
        assert "nothing to roll" in refusal(f"{head}{body}\nM30\n")
    text = f"{head}G1 Z0 F100.\nX41. F100.\n{cylinder}C60. F300.\nM30\n"
    for machine in ("fanuc-30i", "haas-lathe"):
        assert "milling on the cylinder" in refusal(text, machine, feed="per-minute")


@pytest.mark.ci
def test_what_stays_is_told_beside_what_is_rolled() -> None:
    lines = cam_contour(hexagon()).splitlines()
    ramp = [f"G1 X{20 + k} C{k}. Z-{k / 10 + 2:.1f} F100." for k in range(1, 12)]
    outcome = roll("\n".join([*lines[:-2], "G0 X20. C0", "G0 Z2.", "G1 Z-2. F100.", *ramp, "G0 Z2.", *lines[-2:], ""]))
    assert figures(outcome)["sections"] == 1
    assert any(re.match(r"line \d+: left as it is: Z moves beside X and C", note) for note in outcome.notes)
    assert "\n".join(ramp) in outcome.data.decode()


def test_a_tolerance_below_rounding_is_refused() -> None:
    assert "is too little" in refusal(cam_contour(hexagon()), tolerance=0.002)


@pytest.mark.ci
def test_states_that_the_original_has_are_notes() -> None:
    outcome = roll(cam_contour(hexagon(), inverse=True), "haas-lathe")
    assert any("live-tool-stopped-in-cut" in note for note in outcome.notes)


# ---- the command ----


def call(*arguments: str) -> Result:
    return CliRunner().invoke(main, ["roll", *arguments], prog_name="polarcheck")


@pytest.mark.nightly
@pytest.mark.usefixtures("own_folder")
def test_the_command_writes_a_new_program_and_says_what_was_done() -> None:
    text = cam_contour(hexagon())
    Path("a.nc").write_text(text)
    result = call("a.nc", "-o", "b.nc", "--machine", "fanuc-30i")
    assert result.exit_code == 0
    assert "polarcheck: a.nc: blocks before: 144\npolarcheck: a.nc: blocks after: 15\n" in result.stderr
    assert "`polarcheck compensate` gives it G41 or G42" in result.stderr
    assert (Path("a.nc").read_text(), Path("b.nc").read_text()) == (text, new_text(text))
    shown = call("a.nc", "--diff", "--machine", "fanuc-30i")
    assert shown.exit_code == 1
    assert "+G12.1\n" in shown.stdout
    report = json.loads(call("a.nc", "--format", "json", "--machine", "fanuc-30i").stdout)
    assert report["command"] == "roll"
    assert report["files"][0]["figures"][1] == {"name": "blocks before", "value": 144.0, "unit": ""}
    assert call("a.nc", "--machine", "haas-lathe").exit_code == 2
    Path("d.nc").write_text("O1\nG0 X40.\nM30\n")
    refused = call("d.nc")
    assert refused.exit_code == 2
    assert "nothing to roll" in refused.stderr


@pytest.mark.nightly
@pytest.mark.usefixtures("own_folder")
def test_the_tolerance_is_in_the_units_of_the_program() -> None:
    start, pieces = hexagon()
    text = cam_contour((start, pieces))
    inch = re.sub(r"([XZF])([-0-9.]+)", lambda match: f"{match[1]}{float(match[2]) / 25.4:.5f}", text)
    inch = inch.replace("G21", "G20")
    Path("a.nc").write_text(re.sub(r"X([-0-9.]+)", lambda match: f"X{float(match[1]):.4f}", inch))
    result = call("a.nc", "--machine", "fanuc-30i", "--feed", "per-minute", "--tolerance", "0.002", "-o", "b.nc")
    assert "largest distance of the ends of the blocks from the new path: 0.0" in result.stderr
    assert "too little" in call("a.nc", "--machine", "fanuc-30i", "--tolerance", "0.0001").stderr


@pytest.mark.ci
def test_a_number_without_a_point_is_not_written_with_one() -> None:
    lines = cam_contour(hexagon()).splitlines()
    block = next(number for number, line in enumerate(lines) if number > 12 and line.startswith("G1 X"))
    lines[block] = re.sub(r"\.\d*", "", lines[block], count=1)
    assert f"line {block + 1}: a number has no point" in refusal("\n".join(lines))
