"""Two mistakes in one contour are two findings, each in its block, each with the value that can be known."""

from __future__ import annotations

import pytest
from cases import looped
from programs import report_of, said
from test_explanations import CENTERED, HEAD, ROUNDED, program

#: Blocks that are wrong, by what stands there in the sound contour, and what is to be written.
Slips = dict[str, tuple[str, str]]
#: Two words that no single edit makes up for.
PAIRS: list[tuple[list[str], Slips]] = [
    (ROUNDED, {"C7.": ("C17.", "C7."), "G3 X-34. C-10. R3.": ("G3 X-34. C-100. R3.", "C-10.")}),
    (ROUNDED, {"G1 X-34.": ("G1 X-340.", "X-34."), "G3 X-34. C-10. R3.": ("G3 X-34. C-10. R30.", "R3.")}),
    (ROUNDED, {"G3 X34. C10. R3.": ("G3 X3.4 C10. R3.", "X34."), "G1 C-7.": ("G1 C-77.", "C-7.")}),
    (CENTERED, {"G3 X34. C10. I-3. J0": ("G3 X43. C10. I-3. J0", "X34."), "G1 X34.": ("G1 X340.", "X34.")}),
]
#: A mistake that hides the other one, and the line that it stands in.
HIDING: list[tuple[str, str, str]] = [
    ("G1 X-34.", "G1 X-34", "number-without-point"),
    ("G1 X-34.", "G1 X-34. X-3.", "word-repeated"),
    ("G1 C-7.", "G1 Y-7.", "wrong-axis-address-in-polar"),
]


def lines_of(contour: list[str], slips: dict[str, str]) -> dict[int, str]:
    """The lines of blocks in the program, with what stands there."""
    return {len(HEAD) + contour.index(block) + 1: block for block in slips}


@pytest.mark.ci
@looped(("contour", "slips"), PAIRS)
def test_each_of_two_wrong_words_is_told_with_its_value(contour: list[str], slips: Slips) -> None:
    written = [slips.get(line, (line, ""))[0] for line in contour]
    findings = report_of(program(written), "fanuc-30i", "1:radius=2").findings
    needed = {len(HEAD) + contour.index(block) + 1: word for block, (_, word) in slips.items()}
    assert {finding.line for finding in findings} == set(needed)
    assert all(f"with {needed[finding.line]} " in finding.message for finding in findings)


@looped(("block", "wrong", "rule"), HIDING)
def test_a_wrong_word_beside_one_that_makes_the_contour_doubtful_is_told(block: str, wrong: str, rule: str) -> None:
    slips = {block: wrong, "G3 X40. C-7. R3.": "G3 X20. C-7. R3."}
    written = [slips.get(line, line) for line in ROUNDED]
    findings = report_of(program(written), "fanuc-30i", "1:radius=2").findings
    first, second = (len(HEAD) + ROUNDED.index(line) + 1 for line in slips)
    assert {(finding.line, finding.rule == rule) for finding in findings} == {(first, True), (second, False)}
    assert all("X40." in finding.message for finding in findings if finding.line == second)


def test_a_high_feed_beside_rapid_traverse_in_the_mode_is_told() -> None:
    lines = program([line.replace("F200", "F9000") for line in ROUNDED]).replace("G1 X50. F1500", "G0 X50. F1500")
    report = report_of(lines, "fanuc-30i", "1:radius=2", changes={"limits": {"c_feed": 3000}})
    assert {"rapid-in-polar", "c-feed-above-limit"} <= {finding.rule for finding in report.findings}


@looped(("block", "wrong", "rule"), HIDING)
def test_nothing_is_told_beside_one_mistake(block: str, wrong: str, rule: str) -> None:
    written = [wrong if line == block else line for line in ROUNDED]
    report = report_of(program(written), "fanuc-30i", "1:radius=2")
    assert {finding.rule for finding in report.findings} == {rule}, said(report)
