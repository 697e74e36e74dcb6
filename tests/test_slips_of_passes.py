"""A slip in one of several passes is one finding, in inch, in the mirror, turned and on another control alike."""

from __future__ import annotations

import re
from collections.abc import Callable

import pytest
from programs import report_of

from polarcheck.foundation.finding import Finding

DOUBLE_D = ["G1 G42 X21.", "C10.712", "G3 X-21. C10.712 R15.", "G1 C-10.712", "G3 X21. C-10.712 R15.", "G1 C0"]
CANCEL = "G1 G40 X50. F1500"
HEAD = ["G21 G98 G40", "T0808", "G0 X60. C0 Z2.", "G12.1", "G1 C30. F1500", "X50.", "C0"]
END = ["Z2. F1500", "G13.1", "G0 X100. Z50."]


def passes(*contours: list[str]) -> str:
    """A program that mills these contours one below the other."""
    cuts = ([f"G1 Z-{2 * number}. F1500", *blocks] for number, blocks in enumerate(contours, 1))
    return "\n".join([*HEAD, *(block for cut in cuts for block in cut), *END])


def _with_numbers(text: str, letters: str, change: Callable[[float], float], digits: int = 3) -> str:
    def word(match: re.Match[str]) -> str:
        number = f"{change(float(match[2])):.{digits}f}".rstrip("0")
        return f"{match[1]}{'0' if not float(number) else number}"

    return re.sub(rf"([{letters}])(-?\d+\.?\d*)", word, text)


def in_inch(text: str) -> str:
    text = _with_numbers(text, "XCZRIJF", lambda number: number / 25.4, 4)
    return text.replace("G21", "G20")


def mirrored(text: str) -> str:
    """In the X axis: the contour is travelled the other way round."""
    text = _with_numbers(text, "CJ", lambda number: -number)
    others = {"G2": "G3", "G3": "G2", "G41": "G42", "G42": "G41"}
    return re.sub(r"\bG(?:2|3|41|42)\b", lambda match: others[match[0]], text)


def turned(text: str) -> str:
    """By half a turn, but for the place outside of the mode."""
    head, on, rest = text.partition("G12.1\n")
    return f"{head}{on}{_with_numbers(rest, 'XCIJ', lambda number: -number)}".replace("X-100.", "X100.")


def by_radius(text: str) -> str:
    """For a control that takes X as a radius."""
    return _with_numbers(text, "X", lambda number: number / 2).replace("G98", "G94")


FORMS = [
    pytest.param(lambda text: text, "fanuc-30i", id="as it is"),
    pytest.param(in_inch, "fanuc-30i", id="inch"),
    pytest.param(mirrored, "takisawa", id="mirrored"),
    pytest.param(turned, "doosan", id="turned"),
    pytest.param(by_radius, "mitsubishi-m700", id="by radius"),
]


def said(text: str, machine: str, **job: object) -> list[tuple[int, str]]:
    """Line and rule of what is found."""
    radius = 5 / 25.4 if "G20" in text else 5
    found = report_of(text, machine, f"8:radius={radius},nose=0", job=job).findings
    return [(finding.line, finding.rule) for finding in found if finding.severity != "note"]


@pytest.mark.parametrize(("form", "machine"), FORMS)
@pytest.mark.parametrize("slip", ["no block", "no code"])
@pytest.mark.parametrize("odd", range(2))
def test_a_pass_that_is_not_cancelled_is_one_finding(
    form: Callable[[str], str], machine: str, slip: str, odd: int
) -> None:
    sound = [[*DOUBLE_D, CANCEL] for _ in range(3)]
    assert said(form(passes(*sound)), machine) == []
    sound[odd] = DOUBLE_D + (["G1 X50. F1500"] if slip == "no code" else [])
    assert len(said(form(passes(*sound)), machine)) == 1


@pytest.mark.parametrize(("form", "machine"), FORMS)
def test_a_rapid_through_the_bar_in_one_pass_is_one_finding(form: Callable[[str], str], machine: str) -> None:
    odd = [*DOUBLE_D[:3], "G0 C-10.712", *DOUBLE_D[4:], CANCEL]
    text = form(passes([*DOUBLE_D, CANCEL], odd))
    scale = 25.4 if "G20" in text else 1
    assert len(said(text, machine, stock={"diameter": 36 / scale})) == 1


@pytest.mark.parametrize("form", [form.values[0] for form in FORMS[:-1]])
@pytest.mark.parametrize("odd", range(2))
def test_arcs_longer_than_is_usual_in_all_passes_are_no_cause_of_one_that_differs(
    form: Callable[[str], str], odd: int
) -> None:
    boss = ["G1 G42 X30.", "G3 X-30. C0 R15.", "X30. C0 R15.", CANCEL]
    assert said(form(passes(boss, boss)), "takisawa") == []
    odd_one = [boss[0], "G3 X-30. C3. I-15. J1.5", *boss[2:]]
    found = said(form(passes(*(odd_one if number == odd else boss for number in range(2)))), "takisawa")
    assert "arc-sweep-above-limit" not in {rule for _, rule in found}


LED = [
    "G1 X60. C-7. F1500",
    "G42 X35. F120",
    "G2 X21. C0 R7.",
    *("G1 C10.712", *DOUBLE_D[2:]),
    "G2 X35. C7. R7.",
    "G1 G40 X60.",
]


@pytest.mark.parametrize(("form", "machine"), FORMS)
@pytest.mark.parametrize("odd", range(2))
@pytest.mark.parametrize(
    ("index", "right", "wrong"),
    [
        (0, "C-7.", "C7."),
        (0, "C-7.", "C-4."),
        (1, "X35.", "X39."),
        (8, "X35.", "X53."),
        (8, "C7.", "C1."),
    ],
)
def test_a_lead_that_is_tangent_in_another_pass_is_told_with_the_word_of_that(
    form: Callable[[str], str], machine: str, odd: int, index: int, right: str, wrong: str
) -> None:
    contours = [[*LED], [*LED]]
    assert said(form(passes(*contours)), machine) == []
    contours[odd][index] = contours[odd][index].replace(right, wrong)
    text, sound = form(passes(*contours)).splitlines(), form(passes(LED, LED)).splitlines()
    line = next(number for number, pair in enumerate(zip(text, sound, strict=True), 1) if pair[0] != pair[1])
    (word,) = {*sound[line - 1].split()} - {*text[line - 1].split()}
    finding = one_finding("\n".join(text), machine)
    assert finding.line == line
    # Where the number is no slip of the pen, as in inch, the point of the other pass is named.
    assert re.search(rf"\b(?:with|line \d+ at) [^;]*{number_of(word)}(?![\d.])", finding.message)


@pytest.mark.parametrize(("form", "machine"), FORMS)
def test_the_start_of_the_arc_that_leads_to_an_only_pass_is_told_where_it_is_written(
    form: Callable[[str], str], machine: str
) -> None:
    assert said(form(passes(LED)), machine) == []
    finding = one_finding(form(passes([LED[0].replace("C-7.", "C7."), *LED[1:]])), machine)
    assert (finding.line, finding.rule) == (9, "nearly-regular-contour")


def one_finding(text: str, machine: str) -> Finding:
    radius = 5 / 25.4 if "G20" in text else 5
    found = report_of(text, machine, f"8:radius={radius},nose=0").findings
    (finding,) = (finding for finding in found if finding.severity != "note")
    return finding


def number_of(word: str) -> str:
    """A pattern of a word, be its number written with a 0 before or behind the point or without."""
    letter, sign, whole, part = re.fullmatch(r"([A-Z])(-?)0*(\d*)\.?(\d*?)0*", word).groups()  # type: ignore[union-attr]
    return rf"{letter}{sign}0*{whole}\.?{part}0*"
