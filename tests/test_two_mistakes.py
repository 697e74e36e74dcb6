"""Two mistakes in one contour are two findings, each in its block, each with the value that can be known."""

from __future__ import annotations

import pytest
from cases import looped
from programs import report_of, said
from test_explanations import CENTERED, HEAD, ROUNDED, program

#: Blocks that are wrong, by what stands there in the sound contour, and what is to be written.
Slips = dict[str, tuple[str, str]]
#: A hexagon turned by 15 degrees, which begins in the middle of a side.
TURNED = [
    *("G41 X21.25 C-5.694", "X17.963 C-17.963", "X-6.575 C-24.538", "X-24.538 C-6.575", "X-17.963 C17.963"),
    *("X6.575 C24.538", "X24.538 C6.575", "X21.25 C-5.694"),
]
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


@pytest.mark.ci
@looped(("contour", "slips"), PAIRS)
def test_each_of_two_wrong_words_is_told_with_its_value(contour: list[str], slips: Slips) -> None:
    written = [slips.get(line, (line, ""))[0] for line in contour]
    findings = report_of(program(written), "fanuc-30i", "1:radius=2").findings
    needed = {len(HEAD) + contour.index(block) + 1: word for block, (_, word) in slips.items()}
    assert {finding.line for finding in findings} == set(needed)
    assert all(f"with {needed[finding.line]} " in finding.message for finding in findings)


#: Two wrong corners of it, by the words that are meant.
CORNERS: list[Slips] = [
    {"X6.575 C24.538": ("X13.15 C24.538", "X6.575"), "X24.538 C6.575": ("X49.076 C6.575", "X24.538")},
    {"X-24.538 C-6.575": ("X-24.538 C-65.75", "C-6.575"), "X24.538 C6.575": ("X42.538 C6.575", "X24.538")},
]


@looped("slips", CORNERS)
def test_two_corners_beside_a_regular_polygon_are_told_with_their_words(slips: Slips) -> None:
    head = [line.replace("X60. Z2.", "X80. Z2.").replace("G1 X50.", "G1 X31.876 C-8.541") for line in HEAD]
    contour = [slips.get(line, (line, ""))[0] for line in TURNED]
    lines = [*head, *contour, "G40 X31.876 C-8.541 F1500", "Z2.", "G13.1", "M30"]
    findings = report_of("\n".join(lines) + "\n", "mitsubishi-m700", "1:radius=2").findings
    needed = {len(HEAD) + TURNED.index(block) + 1: word for block, (_, word) in slips.items()}
    assert {finding.line: needed[finding.line] in finding.message for finding in findings} == dict.fromkeys(
        needed, True
    )
    first, second = needed
    assert f"with {needed[first]}, and with {needed[second]} in line {second}, it" in findings[0].message


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
