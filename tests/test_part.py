"""What is told of what a program makes: `polarcheck part`, and the section of the reports."""

from __future__ import annotations

import json
from pathlib import Path

import msgspec
import pytest
from cases import looped
from click.testing import CliRunner
from programs import tables_of
from test_cli import call

from polarcheck.commands import main
from polarcheck.foundation.finding import MadeShape
from polarcheck.reports.made_parts.part_report import made_by
from polarcheck.rules.examples import examples
from polarcheck.rules.rule import load_all
from polarcheck.rules.wording.part import Sizes

pytestmark = pytest.mark.usefixtures("own_folder")

HEAD = "G21 G98 G40 T0808\nG0 X80. Z2. C0\nG12.1\nG1 Z-2. F300\n"
END = "\nG40 X80.\nG13.1\nM30\n"
HEXAGON = "G42 X30. F200\nC8.660\nX0 C17.321\nX-30. C8.660\nC-8.660\nX0 C-17.321\nX30. C-8.660\nC0"


def made(body: str, *tools: str, head: str = HEAD, end: str = END, stock: float = 0) -> list[MadeShape]:
    job = {"stock": {"diameter": stock}} if stock else {}
    return made_by(tables_of(head + body + end, "fanuc", *tools, job=job))


def texts(body: str, *tools: str, head: str = HEAD, end: str = END, stock: float = 0) -> list[str]:
    return [one.text for one in made(body, *tools, head=head, end=end, stock=stock)]


CASES = {
    "circle off center": (
        "G42 X20. F100\nG3 X20. C0 I-6. J0\nG1",
        "circle 12.000, center 4.000 off the axis (x 4.000, c 0.000)",
    ),
    "round corners": (
        "G42 X20. F100\nC7.\nG3 X14. C10. R3.\nG1 X-14.\nG3 X-20. C7. R3.\nG1 C-7.\nG3 X-14. C-10. R3.\nG1 X14.\n"
        "G3 X20. C-7. R3.\nG1 C0",
        "square, 20.000 across flats, corners R3.000",
    ),
    "one flat": (
        "G42 X24. F100\nC9.\nG3 X24. C-9. I-12. J-9.\nG1 C0",
        "round 30.000 with one flat, 12.000 from the center",
    ),
    "one flat beyond the center": (
        "G42 X-8. F100\nC14.457\nG3 X-8. C-14.457 I4. J-14.457\nG1 C0",
        "round 30.000 with one flat, 4.000 beyond the center",
    ),
    "two flats": (
        "G42 X24. F100\nC9.\nG3 X-24. C9. I-12. J-9.\nG1 C-9.\nG3 X24. C-9. I12. J9.\nG1 C0",
        "round 30.000 with 2 flats 24.000 apart",
    ),
    "oblong": (
        "G42 X0 C-5. F100\nX20.\nG3 X20. C5. R5.\nG1 X-20.\nG3 X-20. C-5. R5.\nG1 X0",
        "oblong 10.000 x 30.000, ends R5.000",
    ),
    "pocket": (
        "G41 X20. F100\nC10.\nX-20.\nC-10.\nX20.\nC0",
        "pocket: square, 20.000 across flats",
    ),
}  # fmt: skip


@pytest.mark.ci
@looped("name", CASES)
def test_what_is_told_of_a_contour(name: str) -> None:
    body, expected = CASES[name]
    head = HEAD.replace("X80.", "X0") if name == "pocket" else HEAD
    end = END.replace("X80.", "X0") if name == "pocket" else END
    assert texts(body, "8:radius=2", head=head, end=end) == [f"{expected}; to Z-2.000"]


def test_three_depths_of_one_shape_are_one_entry() -> None:
    body = "\nG1 Z-4.\n".join([HEXAGON, HEXAGON.replace("G42 ", "")]) + "\nZ-6.\n" + HEXAGON.replace("G42 ", "")
    (found,) = made(body, "8:radius=4")
    assert found.text == "hexagon, 30.000 across flats; to Z-6.000 in 3 passes from Z-2.000, 2.000 each"
    assert found.depths == [-2, -4, -6]


def test_a_side_that_is_off_is_told_with_its_line() -> None:
    # One side 0.05 further out; its neighbours keep their lines.
    body = HEXAGON.replace("X30. F200\nC8.660", "X30.1 F200\nC8.631").replace("X30. C-8.660\nC0", "X30.1 C-8.631\nC0")
    (found,) = made(body, "8:radius=4")
    assert found.text.startswith("6 flats, 5 at 15.000, one at 15.050 (line ")
    assert [(odd.line, odd.size) for odd in found.odd] == [(6, pytest.approx(30.1, abs=0.001))]


def test_words_that_mix_radius_and_diameter_are_told() -> None:
    words = [
        "X20. C8.284",
        "X8.284 C20.",
        "X-8.284 C20.",
        "X-20. C8.284",
        "X-20. C-8.284",
        "X-8.284 C-20.",
        "X8.284 C-20.",
    ]
    body = "\n".join(["G42 X20. C0 F100", *words, "X20. C-8.284", "C0"])
    (found,) = made(body, "8:radius=2")
    assert found.text.startswith(
        "octagon, not regular, 20.000 to 40.000 across flats, with X doubled it would be regular"
    )


OCTAGON = [
    *("G42 X40. C0 F100", "C8.284", "X16.568 C20.", "X-16.568 C20.", "X-40. C8.284", "X-40. C-8.284"),
    *("X-16.568 C-20.", "X16.568 C-20.", "X40. C-8.284", "C0"),
]


@looped(
    ("block", "written", "how"),
    [(4, "X-20. C8.284", "doubled"), (7, "X33.136 C-20.", "halved"), (6, "X-8.284 C-20.", "doubled")],
)
def test_of_an_octagon_the_x_of_one_corner_may_be_a_radius(block: int, written: str, how: str) -> None:
    blocks = [*OCTAGON[:block], written, *OCTAGON[block + 1 :]]
    (found,) = made("\n".join(blocks), "8:radius=2")
    line = HEAD.count("\n") + block + 1
    told = f"with X of line {line} {how} it would be regular and 40.000 across flats"
    assert found.text.startswith("octagon, not regular")
    assert told in found.text


def test_the_cutter_stays_in_the_corners_of_a_pocket() -> None:
    inside = {"head": HEAD.replace("X80.", "X0"), "end": END.replace("X80.", "X0")}
    (found,) = made(CASES["pocket"][0], "8:radius=2", **inside)
    assert [left.text for left in found.left_standing] == ["R2.000 of the cutter in 4 inside corners"]


@pytest.mark.ci
@looped(("block", "written"), [("X-30. C8.660", "X#5041 C8.660"), ("C8.660", "C#500")])
def test_a_place_that_is_not_known_is_told(block: str, written: str) -> None:
    shapes = made(HEXAGON.replace(block, written, 1), "8:radius=4")
    line = HEAD.count("\n") + HEXAGON.split("\n").index(next(one for one in HEXAGON.split("\n") if block in one)) + 1
    missing = f"X or C of line {line} is not known: the contour is told without what is milled there"
    assert {shape.needs for shape in shapes} == {missing}
    assert [shape.needs for shape in made(HEXAGON, "8:radius=4")] == [None]


def test_without_a_radius_a_contour_is_told_and_what_to_give() -> None:
    (found,) = made(HEXAGON)
    assert found.text == "hexagon, 30.000 across flats; to Z-2.000"
    assert found.needs is not None
    assert "--tool 8:radius=..." in found.needs


@pytest.mark.ci
@looped(
    ("body", "expected"),
    [
        ("G1 X40. F100\nG3 X40. C0 I-20. J0", "circle 32.000; to Z-2.000"),
        ("G1 X40. F100\nC20.\nX-40.\nC-20.\nX40.\nC0", "square, 32.000 across flats; to Z-2.000"),
        (
            "G1 X38. F100\nC10.\nX-38.\nC-10.\nX38.\nC0",
            "rectangle 30.000 x 12.000; to Z-2.000",
        ),
    ],
)
def test_without_compensation_the_path_is_that_of_the_tool(body: str, expected: str) -> None:
    assert expected in texts(body + "\nG1", "8:radius=4", end="\nX80.\nG13.1\nM30\n")
    (unknown,) = made(body + "\nG1", end="\nX80.\nG13.1\nM30\n")
    assert unknown.shape is None
    assert "--tool 8:radius=..." in unknown.text


def test_a_straight_path_makes_a_slot_as_wide_as_the_cutter() -> None:
    head = "G21 G98 G40 T0808\nG0 X30. Z2. C0\nG12.1\nG1 Z-2. F300\n"
    assert texts("X-30. F100", "8:radius=4", head=head, end="\nZ2.\nG13.1\nM30\n") == [
        "pocket: slot 8.000 x 38.000, ends R4.000; to Z-2.000"
    ]


def test_what_g1_does_before_the_face_is_no_slot() -> None:
    # The slot begins at x 20, where G1 at Z2 takes the tool from x 40.
    body, end = "X40. F1000\nZ-2. F100\nX-40.", "\nZ2.\nX80. F1000\nG13.1\nM30\n"
    head = "G21 G98 G40 T0808\nG0 X80. Z2. C0\nG12.1\nG1 "
    assert texts(body, "8:radius=4", head=head, end=end) == ["pocket: slot 8.000 x 48.000, ends R4.000; to Z-2.000"]
    # Deeper than Z0 the same moves cut.
    deep = [head.replace("Z2.", "Z-1."), end.replace("Z2.", "Z-1.")]
    assert "to Z-1.000" in texts(body, "8:radius=4", head=deep[0], end=deep[1])[0]
    # Nobody knows where the face is if the section stays above Z0.
    assert len(texts(body.replace("Z-2.", "Z1."), "8:radius=4", head=head, end=end)) > 1


def test_a_hole_without_a_way_cuts_nothing_in_the_plane() -> None:
    head = "G21 G98 G40 T0808\nG0 X80. Z2. C0\nG12.1\nG1 "
    (found,) = texts("X0 F1000\nZ-2. F100", "8:radius=4", head=head, end="\nZ2.\nG13.1\nM30\n")
    assert found == "not known: it cuts nothing in the plane"


def test_the_bottom_of_a_keyway_beyond_the_center() -> None:
    body = "G41 X80. C3.01 F100\nX-60.\nC-3.01\nX80."
    assert texts(body, "8:radius=2", head=HEAD.replace("X80.", "X120."), end=END.replace("X80.", "X120.")) == [
        "keyway 6.020 wide, its bottom 30.000 beyond the center, square end; to Z-2.000"
    ]


def test_a_zero_has_no_sign_and_an_angle_no_digits_of_rounding() -> None:
    # Corners of a hexagon of 27 across flats, turned by 15 deg, rounded to 0.001 as a program has them.
    body = "G42 X26.080 C3.494 F100\nX22.045 C11.023\nX-8.069 C15.057\nX-30.115 C4.035\nX-22.045 C-11.023\n"
    assert texts(f"{body}X8.069 C-15.057\nX30.115 C-4.035\nX26.080 C3.494", "8:radius=2") == [
        "hexagon, 27.000 across flats, turned by 15 deg; to Z-2.000"
    ]
    assert Sizes(inch=False)(-0.0004) == "0.000"
    assert Sizes(inch=True)(-0.0004) == "0.0000"


def test_in_inch_sizes_have_four_digits() -> None:
    body = "G42 X1.2 F5.\nC.6\nX-1.2\nC-.6\nX1.2\nC0"
    head = "G20 G98 G40 T0808\nG0 X4. Z.1 C0\nG12.1\nG1 Z-.1 F5.\n"
    found = made(body, "8:radius=.2", head=head, end="\nG40 X4.\nG13.1\nM30\n")
    assert [one.text for one in found] == ["square, 1.2000 across flats; to Z-0.1000"]
    assert found[0].values["across_flats"] == pytest.approx(30.48)


# ---- the command and the reports ----


@pytest.fixture
def program() -> Path:
    path = Path("hexagon.nc")
    path.write_text(HEAD + HEXAGON + END, "utf-8")
    return path


def test_the_command_tells_it_as_text_and_as_data(program: Path) -> None:
    told = call("part", str(program), "--tool", "8:radius=4")
    assert (told.exit_code, told.stderr) == (0, "")
    assert told.stdout == "hexagon.nc\n    line 3   hexagon, 30.000 across flats; to Z-2.000\n\n"
    data = json.loads(call("part", str(program), "--format", "json").stdout)
    (found,) = msgspec.convert(data["files"][0]["part"], list[MadeShape])
    assert (found.shape, found.z, found.line) == ("hexagon", -2, 3)


@pytest.mark.ci
def test_check_tells_it_where_it_is_asked_to(program: Path) -> None:
    asked = call("check", "--part", str(program), "--tool", "8:radius=4")
    assert "part: hexagon.nc\nline 3   hexagon, 30.000 across flats; to Z-2.000\n" in asked.stdout
    assert "part: " not in call("check", str(program), "--tool", "8:radius=4").stdout
    as_data = json.loads(call("check", "--part", "--format", "json", str(program)).stdout)
    assert as_data["files"][0]["part"][0]["shape"] == "hexagon"
    assert "part" not in json.loads(call("check", "--format", "json", str(program)).stdout)["files"][0]


@pytest.mark.ci
def test_it_is_compared_with_what_was_asked_for(program: Path) -> None:
    Path("polarcheck.toml").write_text('[[part]]\nshape = "hexagon"\nacross_flats = 30.1\n', "utf-8")
    differs = call("part", str(program), "--tool", "8:radius=4")
    assert differs.exit_code == 1
    assert "     error   line " in differs.stdout
    unknown = call("part", str(program))
    assert unknown.exit_code == 0
    assert "not judged   " in unknown.stdout


def test_a_rib_is_told_where_it_stands() -> None:
    """The example of the rule on it, and the one beside it that leaves nothing."""
    bad, good = examples(load_all()["material-left"].page)[:2]
    found = [made_by(tables_of(one.program, "fanuc", *one.tools))[0] for one in (bad, good)]
    assert [one.shape for one in found] == ["square", "square"]
    assert [left.text for left in found[0].left_standing] == ["a rib 1.342 high behind line 11, at x 20.000 c 0.500"]
    assert found[1].left_standing == []


def test_a_low_rib_is_told_too() -> None:
    """Leads 2 apart with R3: 3 - sqrt(9 - 4) high."""
    (bad, *_) = examples(load_all()["material-left"].page)
    (square,) = made_by(tables_of(bad.program.replace("C1.", "C2."), "fanuc", *bad.tools))
    assert [left.text for left in square.left_standing] == ["a rib 0.764 high behind line 11, at x 20.000 c 1.000"]


def test_a_program_without_sections_and_one_that_is_not_there() -> None:
    Path("plain.nc").write_text("O1\nG0 X10.\nM30\n", "utf-8")
    assert "no polar section" in call("part", "plain.nc").stdout
    missing = call("part", "missing.nc")
    assert missing.exit_code == 2
    assert "missing.nc" in missing.stderr


OF_ANOTHER = (
    "G21 G98\nT0101\nG0 X60. Y0\nG112\nG1 G42 X30. F200\nY8.66\nX0 Y17.321\nX-30. Y8.66\nG40 X-60.\nG113\nM30\n"
)


@pytest.mark.ci
@looped("command", ["part", "feeds"])
def test_of_a_program_for_another_control_it_is_said_that_nothing_can_be_believed(command: str) -> None:
    Path("haas.nc").write_bytes(OF_ANOTHER.encode())
    result = CliRunner().invoke(main, [command, "haas.nc", "--tool", "1:radius=4"])
    assert "haas-lathe" in " ".join(result.output.split())
    assert result.exit_code == (1 if command == "part" else 0)
    own = CliRunner().invoke(main, [command, "haas.nc", "--machine", "haas-lathe", "--tool", "1:radius=4"])
    assert own.exit_code == 0
    assert "wrong-axis" not in own.output
