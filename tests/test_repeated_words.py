"""Posts repeat the words of axes that stand still: where nothing moves, nothing is judged as moved."""

from __future__ import annotations

import re

import pytest
from cases import looped
from contour_families import program_of
from programs import report_of, said, trace_of

SECTION = (
    "O1\nG21 G98 G40\nT0101\nG28 H0\nG0 X60. Z2. C0.\nG12.1\nG1 X60. F1500\nZ-5.\n"
    "{}\nG1 G40 X60. F1500\nZ2.\nG13.1\nM30\n"
)
SQUARE = "G42 X40. F200\nC20.\nX-40.\nC-20.\nX40.\nC0."
ROUND = "G41 X40. F200\nG2 X0. C-20. I-20. J0.\nG2 X-40. C0. I0. J20.\nG2 X0. C20. I20. J0.\nG2 X40. C0. I0. J-20."
FULL = "G41 X40. F200\nG2 I-20."
INCREMENTAL = "G42 U-20. F200\nH20.\nU-80.\nH-40.\nU80.\nH20."


def with_z(program: str) -> str:
    """The program with the Z of the line above, or of its own, in each block of the mode that moves X or C."""
    lines, z, inside = [], "", False
    for line in program.splitlines():
        inside = line == "G12.1" or (inside and line != "G13.1")
        if written := re.search(r"Z-?[\d.]+", line):
            z = written[0]
        elif inside and z and re.search(r"[XCUHIJ]-?[\d.]", line):
            line = f"{line} {z}"
        lines.append(line)
    return "\n".join(lines) + "\n"


def with_all(program: str) -> str:
    """The program with X, C and Z in each block of lines in the mode, as they stand there."""
    path = trace_of(program).path
    lines = program.splitlines()
    for row, line in enumerate(lines):
        if (
            re.search(r"[XC]-?[\d.]", line)
            and line.startswith(("G1 ", "X", "C", "G42"))
            and path.end[row] == path.end[row]
        ):
            rest = re.sub(r"[XC]-?[\d.]+ ?", "", line)
            lines[row] = f"{rest} X{2 * path.end[row].real:.4f} C{path.end[row].imag:.4f} Z{path.z[row]:.4f}"
    return "\n".join(lines) + "\n"


@pytest.mark.ci
@looped("machine", ["fanuc-30i", "fanuc-16i", "doosan", "siemens-iso", "mitsubishi-m700"], one_in=12)
@looped("contour", [SQUARE, ROUND, FULL, INCREMENTAL], ids=["square", "round", "full", "incremental"])
def test_z_repeated_in_each_block_is_no_move(contour: str, machine: str) -> None:
    program = SECTION.format(contour)
    assert said(report_of(with_z(program), machine, "1:radius=4,nose=0")) == said(
        report_of(program, machine, "1:radius=4,nose=0")
    )


@pytest.mark.ci
@looped("machine", ["fanuc-30i", "doosan"])
def test_all_words_repeated_in_each_block_are_no_moves(machine: str) -> None:
    assert "Z-5.0000" in with_all(SECTION.format(SQUARE))
    program = SECTION.format(SQUARE)
    assert said(report_of(with_all(program), machine, "1:radius=4,nose=0")) == said(
        report_of(program, machine, "1:radius=4,nose=0")
    )


@pytest.mark.nightly
@pytest.mark.one_in(12)
@pytest.mark.parametrize("seed", range(0, 60, 3))
def test_contours_with_z_repeated_give_the_same(seed: int) -> None:
    program = program_of(seed)
    if "W" in program.text or "G91" in program.text:
        pytest.skip("with incremental Z")
    tool = f"1:radius={program.radius},nose=0"
    assert said(report_of(with_z(program.text), "fanuc-30i", tool)) == said(report_of(program.text, "fanuc-30i", tool))


@pytest.mark.ci
@looped(
    ("blocks", "rule"),
    [
        ("X40. Z-5.", ""),
        ("X40. W0", ""),
        ("X40. Z-5.001", "z-with-plane-axis"),
        ("X40. W-1.", "z-with-plane-axis"),
        ("G3 X0. C30. I-30. J0. Z-5.", ""),
        ("G3 X0. C30. I-30. J0. Z-6.", "helical-arc-in-polar"),
    ],
)
def test_a_word_is_a_move_where_it_changes_something_or_is_not_known(blocks: str, rule: str) -> None:
    program = f"O1\nG98 G40\nG0 X60. Z2. C0\nG12.1\nG1 Z-5. F200\n{blocks}\nG1 X80.\nG13.1\nM30\n"
    names = {name for _, name in said(report_of(program))} & {"z-with-plane-axis", "helical-arc-in-polar"}
    assert names == ({rule} if rule else set())


def test_z_of_which_the_place_is_not_known_is_a_move() -> None:
    program = "G98 G0 X60. C0\nG12.1\nG1 X40. Z-5. F200\nX50. Z-5.\nG13.1\n"
    assert trace_of(program).path.moves_z.tolist() == [False, False, True, False, False]
    assert said(report_of(program)) == [(3, "z-with-plane-axis")]


def test_x_and_c_outside_the_mode() -> None:
    path = trace_of("G0 X60. C0\nX60. C0\nX60. C30.\nU0 C30.\nH30.\nX50. C60.\n").path
    assert path.moves_x.tolist() == [True, False, False, False, False, True]
    assert path.moves_c.tolist() == [True, False, True, False, True, False]
    assert path.moves.tolist() == [True, False, True, False, True, True]


@pytest.mark.ci
@looped(
    ("machine", "changes", "rules"),
    [
        ("turning-center", {}, ["z-with-plane-axis", "helical-arc-in-polar"]),
        ("fanuc-30i", {"polar": {"repeated_z": "forbidden-in-arcs"}}, ["helical-arc-in-polar"]),
        ("fanuc-30i", {"polar": {"repeated_z": "forbidden"}}, ["z-with-plane-axis", "helical-arc-in-polar"]),
        ("fanuc-30i", {}, []),
    ],
)
def test_a_document_or_a_control_may_forbid_the_word_itself(machine: str, changes: dict, rules: list[str]) -> None:  # type: ignore[type-arg]
    program = "G20 G98 G0 X3. Z.1 C0\nG12.1\nG1 Z-.2 F5.\nX2. Z-.2\nG3 X0. C1. Z-.2 I-1. J0.\nG1 X3.\nG13.1\n"
    report = report_of(program, machine, changes=changes)
    assert [name for _, name in said(report) if name in ("z-with-plane-axis", "helical-arc-in-polar")] == rules
