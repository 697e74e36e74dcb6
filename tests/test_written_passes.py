"""Passes with the same numbers: a code, a letter or the order of two blocks in one of them is a slip."""

from __future__ import annotations

import pytest
from cases import looped
from programs import report_of, tables_of

pytestmark = pytest.mark.ci

HEAD = "O1\nG21 G98 T0101\nG0 X80. Z2. C0\nG12.1\nG1 X80. C0. F800\n"
BLOCKS = "Z{}.\nG42 X40. C0. F80\nC20.5\nX-36.2 C18.7\nX-44.3 C-15.4\nX40. C-22.9\nC0.\nG40 X80. C0. F800\n"
END = "Z2.\nG13.1\nM30\n"


def program(old: str, new: str, which: int = 2) -> str:
    """Three passes, one of them with another text."""
    texts = [BLOCKS.format(-2 * number) for number in range(1, 4)]
    assert old in texts[which]
    texts[which] = texts[which].replace(old, new)
    return HEAD + "".join(texts) + END


def different(text: str, machine: str = "fanuc") -> dict[int, int]:
    """The lines that differ, each with that of the other pass."""
    tables = tables_of(text, machine, "1:radius=4")
    lines = tables["trace"].blocks.line
    found = tables["pass_differences"].found.values()
    return {int(lines[one.row]): int(lines[one.other]) for one in found}


def test_a_sound_program_is_silent() -> None:
    assert report_of(program("C0.", "C0."), "fanuc", "1:radius=4").findings == []


@looped(
    ("old", "new", "expected"),
    [
        ("C20.5", "C20.5", {}),
        # A code that is in force may be written again; a pass without compensation is another pass.
        ("C20.5", "G1 C20.5", {}),
        ("G42 X40.", "X40.", {}),
        # G42 a block late, G40 a block early, a letter, two blocks exchanged.
        ("G42 X40. C0. F80\nC20.5", "X40. C0. F80\nG42 C20.5", {23: 7}),
        ("C0.\nG40 X80. C0.", "G40 C0.\nX80. C0.", {28: 12}),
        ("C20.5", "X20.5", {24: 8}),
        ("C20.5\nX-36.2 C18.7", "X-36.2 C18.7\nC20.5", {24: 8}),
        # A side in two blocks is the same side, one with another corner is not.
        ("C20.5", "C8.\nC20.5", {}),
        ("X-44.3 C-15.4", "X-40.25 C1.65\nX-44.3 C-15.4", {}),
        ("X-44.3 C-15.4", "X-41.25 C1.65\nX-44.3 C-15.4", {26: 10}),
    ],
)
def test_what_differs_in_the_last_of_three_passes(old: str, new: str, expected: dict[int, int]) -> None:
    assert different(program(old, new)) == expected


def test_arcs_of_one_circle_are_one_however_they_are_divided() -> None:
    whole = "Z{}.\nG42 X40. C0 F80\nC10.\nG3 X-40. I-20. J0\nG1 C-10.\nG3 X40. I20. J0\nG1 C0\nG40 X80. F800\n"
    divided = whole.replace("G3 X-40. I", "G3 X20. C27.321 I-20. J0\nX-40. C10. I").replace(
        "0. I-20. J0\nG1", "0. I-10. J-17.321\nG1"
    )
    assert divided.count("\n") == whole.count("\n") + 1
    assert different(HEAD + whole.format(-2) + divided.format(-4) + END) == {}
    assert different(HEAD + whole.format(-2) + divided.format(-4).replace("X-40. C10.", "X-40. C1.") + END) == {18: 9}


@looped(
    ("old", "new", "which", "expected"),
    [
        # A word that the other passes have: the pass that lacks it is wrong, be it the first one.
        ("G42 X40. C0.", "G42 C0.", 0, {7: 15}),
        ("G42 X40. C0.", "G42 C0.", 2, {23: 7}),
        ("G42 X40. C0.", "G42 X04. C0.", 2, {23: 7}),
        # Each pass may begin, and leave the contour, where it likes; what is in force need not be written again.
        ("G42 X40. C0.", "G42 X40. C5.", 2, {}),
        ("G40 X80. C0.", "G40 X80.", 2, {}),
        ("G40 X80. C0.", "G40 X08. C0.", 2, {}),
        ("G42 X40. C0.", "G42 X40.", 2, {}),
    ],
)
def test_a_word_of_the_first_block_is_lost_or_mistyped(
    old: str, new: str, which: int, expected: dict[int, int]
) -> None:
    assert different(program(old, new, which)) == expected


def test_of_two_passes_the_one_that_lacks_a_word_is_wrong() -> None:
    text = program("G42 X40. C0.", "G42 C0.", 0).replace(BLOCKS.format(-6), "")
    assert different(text) == {7: 15}


@pytest.mark.nightly
@looped(("old", "line"), [("X-36.2", 25), ("X40. C-22.9", 27)])
def test_increments_in_one_pass_are_told_by_the_others(old: str, line: int) -> None:
    text = program(old, f"G91 {old}")
    assert different(text, "mazak-eia") == {line: line - 16}
    found = report_of(text, "mazak-eia", "1:radius=4").findings
    assert any(one.line == line and "without G91" in one.message for one in found), found


def test_a_word_that_most_passes_lack_is_no_fault_of_these() -> None:
    text = HEAD + "".join(BLOCKS.format(-2 * number) for number in range(1, 4)) + END
    head, lacking = text, "G42 C0. F80"
    for _ in range(2):
        head = head.replace("G42 X40. C0. F80", lacking, 1)
    assert different(head) == {}


def test_among_many_contours_of_as_many_blocks_two_with_the_same_numbers_are_compared() -> None:
    others = [BLOCKS.replace("C20.5", f"C2{number}.5") for number in range(1, 9)]
    others += [BLOCKS.replace("X-36.2", f"X-3{number}.3") for number in range(8)]
    head = HEAD + "".join(f"Z2.\n{blocks.format(-2)}" for blocks in (BLOCKS, *others))
    last = BLOCKS.format(-4).replace("C20.5\nX-36.2 C18.7", "X-36.2 C18.7\nC20.5")
    assert different(head + last + END) == {head.count("\n") + 3: 9}


CHAMFERED = ["G42 X36. C-9.", "C9.", "X30. C12.", "X-30.", "X-36. C9.", "C-9.", "X-30. C-12.", "X30.", "X36. C-9."]
SQUARE = ["G42 X36. C-9.", "C9.", "X-36.", "C-9.", "X36.", "C-5."]


@pytest.mark.parametrize(
    ("contour", "written", "other", "is_told"),
    [
        (CHAMFERED, "X-36. C9.", "X-37. C9.", True),
        (CHAMFERED, "X-30. C-12.", "X-30. C-13.", True),
        # A side that is moved on purpose: those beside it lead in the same direction.
        (SQUARE, "X-36.", "X-37.", False),
    ],
)
def test_a_side_that_turns_those_beside_it_is_a_mistake(
    contour: list[str], written: str, other: str, is_told: bool
) -> None:
    passes = ["\n".join(contour), "\n".join(other if line == written else line for line in contour)]
    cuts = "".join(f"G1 Z{z} F300\n{blocks} F160\nG40 X80.\n" for z, blocks in zip(("-3.", "-6."), passes, strict=True))
    text = f"O1\nT0101\nG98 G0 X80. C-9. Z2.\nG12.1\n{cuts}G1 Z2. F900\nG13.1\nM30\n"
    found = [one.rule for one in report_of(text, "fanuc-30i", "1:radius=5").findings if one.severity != "note"]
    assert found == ["passes-differ"] * is_told


@pytest.mark.nightly
def test_an_arc_of_nearly_half_a_turn_has_the_r_that_it_needs() -> None:
    """The rounding of its ends shifts its center by 0.1 mm off that of the other arc."""
    contour = "C7.058\nG3 X1.984 C15.468 R15.5\nG1 X-27.784 C6.875\nG3 X27.6 C-7.058 R15.5\nG1 C0\n"
    text = f"{HEAD}Z-2.\nG42 X27.6 C0 F80\n{contour}G40 X80. F800\n{END}"
    assert report_of(text, "fanuc", "1:radius=2").findings == []
    assert report_of(text.replace("C-7.058 R15.5", "C-7.058 R16.5"), "fanuc", "1:radius=2").findings != []
