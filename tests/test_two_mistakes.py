"""Two mistakes in one contour are two findings, each in its block, each with the value that can be known."""

from __future__ import annotations

from typing import Any

import pytest
from cases import looped
from programs import report_of, said
from test_explanations import CENTERED, HEAD, ROUNDED, program

from polarcheck.checking import hidden_findings

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


@pytest.mark.nightly
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


@pytest.mark.ci
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


@pytest.mark.ci
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


@pytest.mark.ci
@looped(("block", "wrong", "rule"), HIDING)
def test_nothing_is_told_beside_one_mistake(block: str, wrong: str, rule: str) -> None:
    written = [wrong if line == block else line for line in ROUNDED]
    report = report_of(program(written), "fanuc-30i", "1:radius=2")
    assert {finding.rule for finding in report.findings} == {rule}, said(report)


#: A contour of distances milled twice, and one with centers.
_MILLED = "Z-7./G41 X18. F100./G91 G102 X-5.078 Y-6.343 L6.5/G101 X-15.234 Y-3.415/G102 X-12.188 Y9.758 L10."
_MILLED += "/X12.188 Y9.758 L10./G101 X15.234 Y-3.415/G102 X5.078 Y-6.343 L6.5/G40 G90 G101 X27. F1500."
TWICE = (
    f"G40/T030303/G94/M110/G97 SB=3000 M13/G0 C0/G0 X58. Z2./G137 C0/G17/G101 X27. F1500./{_MILLED}/{_MILLED}/Z2./G136"
)
_CROSS = "G42 G1 X19.5 Y0 F80./G1 X19.5 Y7.5/G1 X14.5 Y7.5/G2 X7.5 Y14.5 I0 J7./G1 X7.5 Y19.5/G1 X-7.5 Y19.5"
_CROSS += "/G1 X-7.5 Y14.5/G2 X-14.5 Y7.5 I-7. J0/G1 X-19.5 Y7.5/G1 X-19.5 Y-7.5/G1 X-14.5 Y-7.5"
_CROSS += "/G2 X-7.5 Y-14.5 I0 J-7./G1 X-7.5 Y-19.5/G1 X7.5 Y-19.5/G1 X7.5 Y-14.5/G2 X14.5 Y-7.5 I7. J0/G1 X19.5 Y-7.5"
CROSS = "G71 G90 G40/T2 D1/G94/SETMS(2) S2=3000 M2=3/G0 C0/G0 X62. Z2./G0 Z-5.5/DIAMOF/TRANSMIT/G1 X28.5 Y0 F800."
CROSS += f"/{_CROSS}/G1 X19.5 Y0/G40 G1 X28.5 Y0 F800./TRAFOOF/DIAMON/G0 Z2."


@pytest.mark.ci
@looped(
    ("machine", "tool", "text", "slips", "lines"),
    [
        ("okuma-osp", "3:radius=5", TWICE, [("/G17/G101 X27.", "/G17/G101 X2.7"), ("X5.078 Y", "X5078 Y")], {11, 27}),
        (
            "siemens-transmit",
            "2:radius=5",
            CROSS,
            [("X19.5 Y0 F", "X19.55 Y0 F"), ("X-14.5 Y7.5 I", "X-7.5 Y7.5 I")],
            {11, 18},
        ),
    ],
)
def test_what_an_explanation_leaves_under_another_finding_is_told(
    machine: str, tool: str, text: str, slips: list[tuple[str, str]], lines: set[int]
) -> None:
    for right, wrong in slips:
        before, _, behind = text.rpartition(right)
        text = f"{before}{wrong}{behind}"
    report = report_of(text.replace("/", "\n") + "\nM30\n", machine, tool, job={"stock": {"diameter": 40}})
    assert {finding.line for finding in report.findings} == lines


def test_of_many_words_of_an_address_a_few_are_left_out_in_turn(monkeypatch: pytest.MonkeyPatch) -> None:
    """A file that is no program may have a block of any length."""
    tried = 0
    without = hidden_findings.without

    def counted(*arguments: Any) -> Any:
        nonlocal tried
        tried += 1
        return without(*arguments)

    monkeypatch.setattr(hidden_findings, "without", counted)
    written = [f"G1 X-34.{' X-34.' * 300}" if line == "G1 X-34." else line for line in ROUNDED]
    report = report_of(program(written), "fanuc-30i", "1:radius=2")
    assert "word-repeated" in {rule for _, rule in said(report)}
    assert 0 < tried < 20
