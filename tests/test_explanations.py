"""One wrong word or block of a contour is one finding, in its block, with what to write instead."""

from __future__ import annotations

import re
from collections.abc import Callable

import numpy as np
import pytest
from cases import looped
from programs import report_of, said

from polarcheck.checking import explanations, hidden_findings
from polarcheck.columns.contour import correction_search

HEAD = ["O1", "T0101", "G98 G0 X60. Z2. C0", "G12.1", "G1 X50. F1500", "Z-4. F300"]
TAIL = ["G40 X60. F1500", "Z2.", "G13.1", "M30"]
#: A rectangle of 40 x 20 with corners of R 3.
ROUNDED = [
    *("G42 X40. F200", "C7.", "G3 X34. C10. R3.", "G1 X-34.", "G3 X-40. C7. R3."),
    *("G1 C-7.", "G3 X-34. C-10. R3.", "G1 X34.", "G3 X40. C-7. R3.", "G1 C0"),
]
#: The same with centers.
CENTERED = [
    re.sub(r"R3\.", center, line)
    for line, center in zip(ROUNDED, ("", "", "I-3. J0", "", "I0 J-3.", "", "I3. J0", "", "I0 J3.", ""), strict=True)
]
#: The first one in distances.
STEPS = [
    *("G42 X40. F200", "H7.", "G3 U-6. H3. R3.", "G1 U-68.", "G3 U-6. H-3. R3."),
    *("G1 H-14.", "G3 U6. H-3. R3.", "G1 U68.", "G3 U6. H3. R3.", "G1 H7."),
]
#: A contour, its block, what stands in the place of that, and the words that are meant.
Slip = tuple[list[str], str, str, str]
Turn = Callable[[list[str]], list[str]]
SLIPS: list[Slip] = [
    (ROUNDED, "C7.", "C-7.", "C7."),
    (ROUNDED, "G1 X-34.", "G1 X-43.", "X-34."),
    (ROUNDED, "G1 X-34.", "G1 X-3.4", "X-34."),
    (ROUNDED, "G1 C-7.", "G1 X-7.", "C-7."),
    (ROUNDED, "G3 X-40. C7. R3.", "G3 X7. C-40. R3.", "X-40. C7."),
    (ROUNDED, "G3 X-34. C-10. R3.", "G3 X-34. C-10. R30.", "R3."),
    (ROUNDED, "G3 X40. C-7. R3.", "G3 X20. C-7. R3.", "X40."),
    (CENTERED, "G3 X-34. C-10. I3. J0", "G3 X-34. C-10. I-3. J0", "I3."),
    (CENTERED, "G3 X40. C-7. I0 J3.", "G3 X40. C-7.5 I0 J3.", "C-7."),
    (CENTERED, "G1 X34.", "G1 X32.", "X34."),
]
#: Those that remain the same slip in the mirror.
OF_ONE_AXIS = [slip for slip in SLIPS if slip[2] not in ("G1 X-7.", "G3 X7. C-40. R3.")]


def program(contour: list[str]) -> str:
    return "\n".join([*HEAD, *contour, *TAIL]) + "\n"


def mirrored(lines: list[str]) -> list[str]:
    """The same on the other side of the X axis: C, J, the sense of arcs and the side of the cutter."""
    exchanged = {"G2": "G3", "G3": "G2", "G41": "G42", "G42": "G41"}
    codes = (re.sub(r"\bG(?:2|3|41|42)\b", lambda code: exchanged[code[0]], line) for line in lines)
    turned = (re.sub(r"\b([CJ])(-?)(?=[1-9])", lambda word: word[1] + "-" * (not word[2]), line) for line in codes)
    return list(turned)


@pytest.mark.ci
@looped("contour", [ROUNDED, CENTERED, mirrored(ROUNDED), mirrored(CENTERED)])
def test_the_sound_contour_has_no_finding(contour: list[str]) -> None:
    assert said(report_of(program(contour), "fanuc-30i", "1:radius=2")) == []


def test_a_lens_about_the_center_is_sound() -> None:
    contour = ["G42 X24. C0 F200", "G3 X0 C18.33 R20.", "G3 C-18.33 R20.", "G3 X24. C0 R20.", "G1 G40 X50."]
    assert said(report_of(program(contour), "fanuc-30i", "1:radius=2")) == []


def test_an_eccentric_circle_in_distances_is_sound() -> None:
    arcs = ["G1 X49. F120", "G2 U-41. H-20.5 R20.5", "U-41. H20.5 R20.5", "U41. H20.5 R20.5", "U41. H-20.5 R20.5"]
    text = program([*arcs, "G1 X63."]).replace("G40 X60. F1500\n", "")
    assert said(report_of(text, "fanuc-30i", "1:radius=5")) == []


#: A square with leads that are arcs; the same with centers.
LED = [
    *("G42 X52. C-6. F200", "G2 X40. C0 R6.", "G1 C20.", "X-40.", "C-20.", "X40."),
    *("C0", "G2 X52. C6. R6.", "G1"),
]
LED_CENTERED = [line.replace("C0 R6.", "C0 I0 J6.").replace("C6. R6.", "C6. I6. J0") for line in LED]


def in_inch(text: str) -> str:
    """A program of millimeters in inch."""
    text = re.sub(r"([XZCRIJF])(-?[\d.]+)", lambda word: f"{word[1]}{float(word[2]) / 25.4:.4f}", text)
    return text.replace("G98", "G20 G98")


@looped(
    ("contour", "old", "new", "needed"),
    [
        (LED, "C6. R6.", "C6. R9.", "R6."),
        (LED, "C0 R6.", "C0 R7.5", "R6."),
        (mirrored(LED), "C-6. R6.", "C-6. R9.", "R6."),
        (LED_CENTERED, "I6. J0", "I7.5 J-1.5", "I6. J0."),
    ],
)
def test_a_lead_that_is_not_tangent_has_the_radius_of_the_other(
    contour: list[str], old: str, new: str, needed: str
) -> None:
    sound = program(contour)
    wrong = sound.replace(old, new)
    assert said(report_of(sound, "fanuc-30i", "1:radius=3")) == []
    findings = report_of(wrong, "fanuc-30i", "1:radius=3").findings
    assert [(finding.rule, finding.values["word_needed"]) for finding in findings] == [("arc-not-tangent", needed)]
    assert said(report_of(in_inch(sound), "fanuc-30i", "1:radius=0.12")) == []
    assert [rule for _, rule in said(report_of(in_inch(wrong), "fanuc-30i", "1:radius=0.12"))] == ["arc-not-tangent"]


def as_it_is(lines: list[str]) -> list[str]:
    return lines


@pytest.mark.nightly
@looped(
    ("turn", "slip"), [*((as_it_is, slip) for slip in SLIPS), *((mirrored, slip) for slip in OF_ONE_AXIS)], one_in=3
)
def test_one_finding_in_the_block_says_what_to_write(turn: Turn, slip: Slip) -> None:
    contour, right, wrong, word = slip
    lines = turn([wrong if line == right else line for line in contour])
    report = report_of(program(lines), "fanuc-30i", "1:radius=2")
    (finding,) = report.findings
    assert finding.line == len(HEAD) + contour.index(right) + 1
    (meant,) = turn([word])
    assert meant in finding.message


@pytest.mark.nightly
@looped(("first", "second"), [(SLIPS[1], SLIPS[7]), (SLIPS[3], SLIPS[8])])
def test_mistakes_in_two_contours_are_two_findings(first: Slip, second: Slip) -> None:
    slipped = [[wrong if line == right else line for line in contour] for contour, right, wrong, _ in (first, second)]
    text = "\n".join([*HEAD, *slipped[0], *TAIL[:-1], *HEAD[2:], *slipped[1], *TAIL]) + "\n"
    report = report_of(text, "fanuc-30i", "1:radius=2")
    assert [first[3] in report.findings[0].message, second[3] in report.findings[1].message] == [True, True]
    assert len(report.findings) == 2


#: Contours that are sound to each rule but this one: a corner on the line of its neighbours, blocks exchanged, an arc
#: that alone is not tangent; a block, what stands in its place, and what is said.
HEXAGON = [
    "G42 X36. C0 F200",
    "C10.392",
    "X0 C20.785",
    "X-36. C10.392",
    "C-10.392",
    "X0 C-20.785",
    "X36. C-10.392",
    "C0",
]
CHAMFERED = [
    *("G42 X40. C0 F200", "C9.5", "X19. C20.", "X-19.", "X-40. C9.5"),
    *("C-9.5", "X-19. C-20.", "X19.", "X40. C-9.5", "C0"),
]


@pytest.mark.nightly
@looped(
    ("contour", "right", "wrong", "words"),
    [
        (HEXAGON, ["X0 C20.785"], ["X0 C10.392"], "with C20.785 it would be a regular hexagon"),
        (HEXAGON, ["X0 C-20.785"], ["X0 C-10.392"], "with C-20.785 it would be a regular hexagon"),
        (CHAMFERED, ["X-19.", "X-40. C9.5"], ["X-40. C9.5", "X-19."], "behind the next one"),
        (ROUNDED, ["G3 X34. C10. R3."], ["G3 X34. C10. R2.8"], "R3."),
    ],
)
def test_what_no_rule_objects_to_is_told_where_the_rest_shows_it(
    contour: list[str], right: list[str], wrong: list[str], words: str
) -> None:
    text = program(contour)
    slipped = text.replace("\n".join(["", *right, ""]), "\n".join(["", *wrong, ""]))
    assert slipped != text
    found = report_of(slipped, "fanuc-30i", "1:radius=2").findings
    assert [words in finding.message for finding in found] == [True]
    assert abs(found[0].line - text[: text.index("\n" + right[0])].count("\n") - 2) <= 1


@pytest.mark.nightly
@looped(
    ("right", "wrong"),
    [("G42 X36. C0 F200", "G42 X3.6 C0 F200"), ("G42 X36. C0 F200", "G42 X46. C0 F200"), ("C0", "X44. C0")],
)
def test_a_ramp_that_does_not_end_where_the_contour_ends_is_told_with_both_words(right: str, wrong: str) -> None:
    lines = [*HEAD[:-2], "G1 X60. F1500", HEAD[-1], *HEXAGON, *TAIL]
    last = len(lines) - 1 - lines[::-1].index(right)
    for turn in (as_it_is, mirrored):
        text = "\n".join(turn([*lines[:last], wrong, *lines[last + 1 :]])) + "\n"
        (finding,) = report_of(text, "fanuc-30i", "1:radius=2").findings
        assert finding.rule in {"start-up-off-contour", "nearly-regular-contour"}
        assert "X36" in finding.message
    assert said(report_of("\n".join(lines) + "\n", "fanuc-30i", "1:radius=2")) == []


#: What is as it was meant, and does not fit the cutter or the control: no word of it is doubted.
MEANT = [
    ("G98 G0 X100. C0/G12.1/G1 C20. F500/G41 X60. F200/C3./X40./C-3./X60./C-20./G40 X100./G13.1", "interference"),
    (
        "G98 G0 X110. C0/G12.1/G1 C20. F500/G41 X60. F200/C0./G3 X70. C0. R5./G1 C-20./G40 X110./G13.1",
        "no-offset-intersection",
    ),
    ("G98 G0 X60. C0/G12.1/G1 X40. C10. F200/G3 X24. I-8. J6./G1 X60./G13.1", "arc-end-off-circle"),
    ("G98 G0 X60. C0/G12.1/G1 X40. F200/G3 X40. C0 R20./G1 X60./G13.1", "full-circle-by-radius"),
]


@pytest.mark.nightly
@looped(("section", "rule"), MEANT)
def test_no_value_is_named_where_nothing_shows_it(section: str, rule: str) -> None:
    text = "T0101\n" + section.replace("/", "\n") + "\nM30\n"
    findings = report_of(text, "fanuc-30i", "1:radius=4").findings
    assert [finding.rule for finding in findings if finding.severity != "note"] == [rule]


def test_a_rule_that_is_not_run_explains_nothing() -> None:
    contour, right, wrong, _ = SLIPS[7]
    text = program([wrong if line == right else line for line in contour])
    (finding,) = report_of(text, "fanuc-30i", "1:radius=2", only=["arc-end-off-circle"]).findings
    assert finding.message.endswith("difference is allowed")


@pytest.mark.nightly
@looped(
    ("contour", "right", "wrong", "line", "words"),
    [
        # G40 a block late.
        (
            ROUNDED,
            ["G40 X60. F1500", "Z2."],
            ["X60. F1500", "G40 Z2."],
            18,
            "with G40 not here but in line 17 it would fit",
        ),
        # A block that is run only with block skip off.
        (ROUNDED, ["G3 X34. C10. R3."], ["/G3 X34. C10. R3."], 10, "without the / of line 9 it would fit"),
    ],
)
def test_a_block_elsewhere_is_named_where_all_findings_come_from_it(
    contour: list[str], right: list[str], wrong: list[str], line: int, words: str
) -> None:
    text = program(contour)
    slipped = text.replace("\n".join(["", *right, ""]), "\n".join(["", *wrong, ""]))
    assert slipped != text
    (finding,) = [found for found in report_of(slipped, "fanuc-30i", "1:radius=2").findings if found.severity != "note"]
    assert words in finding.message
    assert finding.line == line


@pytest.mark.nightly
@looped(
    ("contour", "right", "wrong", "words"),
    [
        # A value of the block beside it in a distance: what closes the path.
        (STEPS, "G3 U-6. H3. R3.", "G3 U-68. H3. R3.", "U-6."),
        (STEPS, "G1 U-68.", "G1 U-86.", "U-68."),
        # A word that is written twice, and what is meant instead of it, are one finding.
        (ROUNDED, "G1 X-34.", "G1 X-34. X7.", "X-34."),
    ],
)
def test_what_was_meant_is_named_with_the_finding_about_the_word(
    contour: list[str], right: str, wrong: str, words: str
) -> None:
    lines = [wrong if line == right else line for line in contour]
    (finding,) = [
        one for one in report_of(program(lines), "fanuc-30i", "1:radius=2").findings if one.severity != "note"
    ]
    assert finding.line == len(HEAD) + lines.index(wrong) + 1
    assert words in finding.message


#: A pocket of 40 x 20, R 6 in its corners, in two passes; lifted between them.
POCKET = [
    *("G41 X40. F200", "C4.", "G3 X28. C10. R6.", "G1 X-28.", "G3 X-40. C4. R6."),
    *("G1 C-4.", "G3 X-28. C-10. R6.", "G1 X28.", "G3 X40. C-4. R6.", "G1 C0", "G40 X30. F1500"),
]
POCKETS = [*HEAD[:4], "G1 X30. C0 F1500", "Z-2. F60", *POCKET, "Z-4. F60", *POCKET, *TAIL[1:]]
PASSES = [*HEAD, *ROUNDED, "G40 X50. F1500", "Z2.", "Z-8. F300", *ROUNDED, *TAIL]
BARE = [*HEAD[:-1], "X46. C0", HEAD[-1], "X40. F200", *ROUNDED[1:], "X46. F1500", *TAIL[1:]]


@pytest.mark.nightly
@looped(
    ("lines", "right", "wrong", "rule", "words"),
    [
        # A code too many in a path that nothing compensates.
        (BARE, ["G3 X34. C10. R3."], ["G41", "G3 X34. C10. R3."], "nearly-regular-contour", "without G41"),
        # Blocks exchanged before the cancel, which becomes an arc without center.
        (
            [*HEAD, *ROUNDED, *TAIL],
            ["G3 X40. C-7. R3.", "G1 C0"],
            ["G1 C0", "G3 X40. C-7. R3."],
            "nearly-regular-contour",
            "behind the next one",
        ),
        # G40 a block too early.
        (
            [*HEAD, "G42 X40. F200", "G3 X-40. R20.", "X40. R20.", "G40 G1 X60. F1500", *TAIL[1:]],
            ["X40. R20.", "G40 G1 X60. F1500"],
            ["G40 X40. R20.", "G1 X60. F1500"],
            "cancel-on-arc",
            "G1 block after the arc",
        ),
        # A block missing before the contour in the first of two passes.
        (PASSES, ["G42 X40. F200"], ["X40. F200"], "cancel-without-start-up", "write G41 or G42"),
        # Of two passes the first is wrong, and nothing objects to it but that the second one differs.
        (POCKETS, ["G3 X-40. C4. R6."], ["G3 X-40. C2. R6."], "nearly-regular-contour", "C4."),
        (PASSES, ["G42 X40. F200"], ["G41 X40. F200"], "side-of-compensation-mirrored", "G42"),
        (PASSES, ["G1 X50. F1500"], ["G0 X50. F1500"], "rapid-in-polar", "G1"),
    ],
)
def test_one_slip_is_one_finding(lines: list[str], right: list[str], wrong: list[str], rule: str, words: str) -> None:
    text = "\n".join(lines) + "\n"
    slipped = text.replace("\n".join(["", *right, ""]), "\n".join(["", *wrong, ""]), 1)
    assert slipped != text
    sound, found = (
        [one for one in report_of(program, "fanuc-30i", "1:radius=2").findings if one.severity != "note"]
        for program in (text, slipped)
    )
    assert sound == []
    assert [one.rule for one in found] == [rule]
    assert words in found[0].message


@pytest.mark.ci
def test_a_ramp_that_leaves_a_pocket_is_wrong_and_not_its_approach() -> None:
    text = "\n".join(POCKETS) + "\n"
    slipped = text.replace("G40 X30. F1500", "G40 X130. F1500", 1)
    job = {"stock": {"diameter": 70.0}}
    sound, found = (report_of(program, "fanuc-30i", "1:radius=2", job=job).findings for program in (text, slipped))
    assert sound == []
    assert [(one.rule, one.line) for one in found] == [
        ("start-up-sweeps-contour", slipped.split("X130.")[0].count("\n") + 1)
    ]


@pytest.mark.nightly
def test_g91_that_g90_takes_back_is_missing() -> None:
    of_system_b = [line.replace("U", "X").replace("H", "C") for line in STEPS[2:]]
    sound = [*HEAD, "G42 X40. F200", "G91 C7.", *of_system_b, "G40 G90 X60. F1500", *TAIL[1:]]
    text = "\n".join(sound).replace("G98", "G94") + "\n"
    changes = {"control": {"g_code_system": "B"}}
    of_sound, found = (
        report_of(program, "fanuc-30i", "1:radius=2", changes=changes).findings
        for program in (text, text.replace("G91 ", ""))
    )
    assert of_sound == []
    assert ["with G91 it would" in one.message for one in found] == [True]
    assert found[0].line == len(HEAD) + 2


#: Rounded corners of several radii, and no two sides of one length.
FREE = [
    *("G42 X27.919 C1.041 F120", "C5.466", "G3 X23.806 C8.962 R4.", "G1 X-1.119 C15.889", "G3 X-7.229 C15.396 R2.5"),
    *("G1 X-34.57 C0.529", "G3 X-35.02 C-1.181 R1.5", "G1 X-13.758 C-21.522", "G3 X-7.501 C-22.066 R2."),
    *("G1 X25.342 C-6.925", "G3 X27.919 C-3.984 R4.", "G1 C1.041"),
]
#: A hexagon of which one flat lies farther in.
KEYED = ["G42 X39. C0 F200", "C11.258", "X0 C22.517", "X-35. C12.413", "C-12.413", "X0 C-22.517", "X39. C-11.258", "C0"]


#: Two flats of a round bar.
DOUBLE_D = [
    *("G42 X30. C0 F200", "C13.229", "G3 X-30. C13.229 R20.", "G1 C-13.229", "G3 X30. C-13.229 R20.", "G1 C0"),
    "G40 X50.",
]
#: Six teeth, begun in the middle of one.
_TEETH = [
    place * turn
    for turn in np.exp(1j * np.radians(60) * np.arange(6))
    for place in (
        18 * np.exp(0.2j),
        12 * np.exp(0.24j),
        12 * np.exp(1j * np.pi / 3 - 0.24j),
        18 * np.exp(1j * np.pi / 3 - 0.2j),
    )
]
TEETH = [
    "G42 X35.282 C0 F200",
    *(f"X{2 * place.real:.3f} C{place.imag:.3f}" for place in _TEETH),
    *("X35.282 C0", "G40 X50."),
]


@pytest.mark.nightly
@looped(
    ("contour", "right", "wrong", "words"),
    [
        # The corners of what is left of the bar are meant.
        (DOUBLE_D, "G1 C-13.229", "G1 C-63.229", ["with C-13.229"]),
        # Six turns say more than a half turn or a mirror.
        (TEETH, TEETH[6], TEETH[6].replace("C", "C-"), [f"with {TEETH[6].split()[1]} it would look the same"]),
        (TEETH, TEETH[9], TEETH[9].replace("C", "C-"), [f"with {TEETH[9].split()[1]} it would look the same"]),
        (TEETH, TEETH[10], f"{TEETH[9].split()[0]} {TEETH[10].split()[1]}", [f"with {TEETH[10].split()[0]} it would"]),
        (FREE, "G3 X-35.02 C-1.181 R1.5", "G3 X-35.02 C-0.591 R1.5", ["with C-1.182 its arcs would be tangent"]),
        # Either word would make it its own mirror image.
        (KEYED, "X0 C22.517", "X0", ["with C-11.258", "or with C22.517 in line"]),
    ],
)
def test_a_point_is_told_where_the_shape_shows_it(contour: list[str], right: str, wrong: str, words: list[str]) -> None:
    lines = [*HEAD[:-2], "G1 X60. F1500", HEAD[-1], *contour, *TAIL]
    sound, found = (
        report_of("\n".join(text) + "\n", "fanuc-30i", "1:radius=2").findings
        for text in (lines, [wrong if line == right else line for line in lines])
    )
    assert sound == []
    assert len(found) == 1
    assert all(part in found[0].message for part in words)


#: A pentagon of 30 across flats in distances.
PENTAGON = ["U0. H-21.796", "U-41.459 H-6.736", "U-25.623 H17.634", "U25.623 H17.634", "U41.459 H-6.736"]


@pytest.mark.ci
@looped("missing", [(line, word) for line in PENTAGON[1:] for word in line.split()])
def test_a_distance_that_is_missing_is_the_one_that_closes_the_contour(missing: tuple[str, str]) -> None:
    line, word = missing
    rest = line.replace(word, "").strip()
    text = program(["G41 X30. C10.898 F150", *PENTAGON]).replace(line, rest)
    (finding,) = report_of(text, "fanuc-30i", "1:radius=5").findings
    assert (text.splitlines()[finding.line - 1], finding.values["word_needed"]) == (rest, word)


@pytest.mark.ci
@looped("ends", [("C8.", "C-8."), ("C8.", "C-2."), ("C4.", "C3."), ("C8.", "C0"), ("C0", "C-8.")])
def test_leads_along_a_side_belong_to_no_contour(ends: tuple[str, str]) -> None:
    begins, leaves = ends
    sides = ["G1 C-6.", "G2 X34. C-9. R3.", "G1 X-34.", "G2 X-40. C-6. R3.", "G1 C6.", "G2 X-34. C9. R3."]
    sound = [f"G41 X40. {begins} F200", *sides, "G1 X34.", "G2 X40. C6. R3.", f"G1 {leaves}"]
    assert report_of(program(sound), "fanuc-30i", "1:radius=4").findings == []


@pytest.mark.ci
@looped("code", ["CR=20", "CR=110", "CR=100"])
def test_an_end_of_a_slot_is_told_where_the_contour_begins_with_its_arc(code: str) -> None:
    moves = ["G41 X8 Y10 F180", "G2 X8 Y-10 CR=10", "G1 X-8", "G2 X-8 Y10 CR=10", "G1 X9", "G40 X30 Y22", "G0 Z2"]
    head = ["G18 G90 G71 G94 G40 DIAMON", "T5 D1", "SETMS(2) S2=2500 M2=3", "G0 X90 Z2", "TRANSMIT", "DIAMOF", "G17"]
    lines = [*head, "G0 X30 Y22", "G1 Z-4 F400", *moves, "TRAFOOF", "M30"]
    for line in (lines.index(moves[1]), lines.index(moves[3])):
        text = "\n".join([*lines[:line], lines[line].replace("CR=10", code), *lines[line + 1 :]]) + "\n"
        findings = report_of(text, "siemens-transmit", "T5:radius=5,nose=0").findings
        told = [(finding.rule, finding.line) for finding in findings if finding.severity != "note"]
        assert told == [("arc-not-tangent", line + 1)]


FLATS = ["G42 X24. C-30. F250", "C30.", "G40 X80. C34.", "Z2. F2000", "X-80. C34.", "Z-8. F800"]
FLATS += ["G42 X-24. C30. F250", "C-30.", "G40 X-80. C-34."]


@pytest.mark.ci
@looped("line", [0, 6])
def test_a_start_up_is_missing_where_the_way_out_mirrors_another_one(line: int) -> None:
    lines = [*HEAD[:-2], "G1 X80. C-34. F2000", "Z-8. F800", *FLATS, *TAIL[1:]]
    assert report_of("\n".join(lines) + "\n", "fanuc-30i", "1:radius=8").findings == []
    wrong = "\n".join(text.replace("G42 ", "") if text == FLATS[line] else text for text in lines) + "\n"
    (finding,) = report_of(wrong, "fanuc-30i", "1:radius=8").findings
    assert (finding.rule, wrong.splitlines()[finding.line - 1]) == ("cancel-without-start-up", FLATS[line + 2])


@pytest.mark.ci
def test_a_number_as_another_block_has_it_is_meant_and_none_that_is_nearly_that() -> None:
    sides = ["C8.66", "G3 X2.5 C12.99 R5.", "G1 X-12.5 C4.33", "G3 X-12.5 C-4.33 R5.", "G1 X2.5 C-12.99"]
    moves = ["G42 X10. C0 F150", *sides, "G3 X10. C-8.66 R5.", "G1 C0", "G40 X40.", "Z2.", "G13.1", "M30"]
    text = "\n".join(["O1", "T0101", "G90 G94 G0 X40. Z2. C0", "G12.1", "G1 Z-4. F300", *moves]) + "\n"
    assert report_of(text, "mitsubishi-m700", "1:radius=5").findings == []
    (finding,) = report_of(text.replace("C8.66", "C8.56", 1), "mitsubishi-m700", "1:radius=5").findings
    assert "a digit is wrong: with C8.66" in finding.message


@pytest.mark.ci
def test_what_stands_otherwise_in_another_pass_explains_what_follows_from_it() -> None:
    sides = [
        *("C8.733", "G3 X26.732 C11.467 I-3.5 J0", "G1 X6.122 C19.707", "G3 X-0.093 C19.719 I-1.561 J-1.953"),
        *("G1 X-28.788 C8.424", "C-9.591", "X3.604 C-22.829", "X29.361 C-10.983", "C-0.576"),
    ]
    contour = ["X63.36 C-3.576", "Z-3. F300", "G42 X29.361 C-0.576 F150", *sides, "G40 X63.361 F1500", "Z2."]
    passes = [*HEAD[:4], "G1 X65. F1500", *contour, *contour, *TAIL[2:]]
    assert report_of("\n".join(passes), "fanuc-30i", "1:radius=6").findings == []
    last = len(passes) - 1 - passes[::-1].index("G1 X6.122 C19.707")
    passes[last] = "G1 C19.707"
    (finding,) = report_of("\n".join(passes), "fanuc-30i", "1:radius=6").findings
    assert (finding.rule, finding.line) == ("passes-differ", last + 1)
    assert [one.rule for one in finding.follows] == ["arc-end-off-circle"]


@pytest.mark.ci
def test_a_code_that_one_of_the_passes_lacks_is_told_once() -> None:
    pocket = ["G0 X50. C0", "G12.1", "G1 Z-4. F300", *ROUNDED, "G40 X50. F1500", "Z2.", "G13.1"]
    lines = [
        "O1",
        "T0101",
        "G98 G0 Z2.",
        *(line for turn in (0, 120, 240) for line in (f"G0 C{turn}.", "G0 H0", *pocket)),
    ]
    text = "\n".join([*lines, "M30"])
    sound = report_of(text, "fanuc-30i", "1:radius=2").findings
    second = text.index("G40", text.index("G40") + 1)
    found = report_of(text[:second] + text[second + 4 :], "fanuc-30i", "1:radius=2").findings
    assert [one.rule for one in found if one not in sound] == ["passes-differ"]
    assert "polar-switched-in-offset-mode" in [one.rule for one in found[0].follows]


@pytest.mark.ci
def test_an_arc_before_the_line_that_leads_to_it_is_one_finding() -> None:
    """Behind it two lines follow, so that its code is in force in the second one."""
    cross = [
        *("G41 X38. C0 F200", "C-7.", "X25.", "G3 X14. C-12.5 I0 J-5.5", "G1 C-19.", "X-14.", "C-12.5"),
        *("G3 X-25. C-7. I-5.5 J0", "G1 X-38.", "C7.", "X-25.", "G3 X-14. C12.5 I0 J5.5", "G1 C19.", "X14."),
        *("C12.5", "G3 X25. C7. I5.5 J0", "G1 X38.", "C0"),
    ]
    lines = [*HEAD, *cross, *TAIL]
    assert report_of("\n".join(lines), "fanuc", "1:radius=5").findings == []
    arc = lines.index("G3 X-14. C12.5 I0 J5.5")
    lines[arc : arc + 2] = reversed(lines[arc : arc + 2])
    findings = report_of("\n".join(lines), "fanuc", "1:radius=5").findings
    assert [(one.rule, one.line) for one in findings] == [("nearly-regular-contour", arc + 1)]
    assert {one.rule for one in findings[0].follows} >= {"arc-end-off-circle", "arc-without-center"}


def test_arcs_of_the_other_sense_meet_nowhere_and_are_told_once() -> None:
    arcs = ["C11.013", "G2 X-35. C0 I-13.6 J-11.013", "X27.2 C-11.013 I17.5 J0", "G1 C0"]
    lines = [*HEAD, "G42 X27.2 C0 F200", *arcs, *TAIL]
    (finding,) = report_of(
        "\n".join(lines), "mazak-eia", "1:radius=2.5", job={}, only=["no-offset-intersection"]
    ).findings
    assert lines[finding.line - 1] == arcs[0]


@pytest.mark.ci
def test_a_cancel_that_is_lost_behind_an_arc_is_told_once() -> None:
    pocket = ["G41 X40. C0 F200", "G3 X-40. R20.", "X40. R20.", "G40 G1 X10. F1500"]
    wider = ["G41 X44. C0 F200", "G3 X-44. R22.", "X44. R22.", "G40 G1 X10. F1500"]
    lines = [*HEAD[:4], "G1 X10. F1500", "Z-4. F300", *pocket, *wider, "Z2.", *TAIL[2:]]
    assert "side-repeated-in-offset-mode" not in [
        one.rule for one in report_of("\n".join(lines), "fanuc", "1:radius=2").findings
    ]
    lines.remove(pocket[-1])
    found = report_of("\n".join(lines), "fanuc", "1:radius=2").findings
    assert [one.rule for one in found if one.severity != "note"] == ["side-repeated-in-offset-mode"]
    assert "arc-without-center" in [one.rule for one in found[0].follows]


@pytest.mark.ci
def test_a_ramp_that_is_skipped_is_told_by_its_sign_of_block_skip() -> None:
    hexagon = ["C11.547", "X0 C23.094", "X-40. C11.547", "C-11.547", "X0 C-23.094", "X40. C-11.547", "C0"]
    contour = ["Z-4. F300", "G42 X40. F200", *hexagon, "G40 X60. F1500", "Z2."]
    lines = [*HEAD[:4], "G1 X60. F1500", *contour, "X60. C0", *contour, *TAIL[2:]]
    ramp = len(lines) - 1 - lines[::-1].index("G42 X40. F200")
    lines[ramp] = "/" + lines[ramp]
    (finding,) = report_of("\n".join(lines), "fanuc-30i", "1:radius=2").findings
    assert f"without the / of line {ramp + 1}" in finding.message
    assert "cancel-without-start-up" in [one.rule for one in finding.follows]


@pytest.mark.ci
def test_a_limit_that_is_only_noted_leads_no_finding() -> None:
    slot = ["G41 X42.862 F75", "H4.762", "G2 U-12.7 H6.35 I-6.35 J0", "U-12.7 H-6.35 I0 J-6.35", "G1 H-9.524"]
    slot += ["G3 U12.7 H-6.35 I6.35 J0", "U12.7 H6.35 I0 J6.35", "G1 H4.762", "G40 X31.836 F800"]
    lines = ["O1", "T0101", "G98 G0 X31.836 Z2. C0", "G12.1", "G1 Z-6. F40", *slot, *TAIL[1:]]
    findings = report_of("\n".join(lines), "colchester", "1:radius=4.762").findings
    (finding,) = (finding for finding in findings if finding.severity != "note")
    assert (finding.rule, finding.line) == ("nearly-regular-contour", lines.index(slot[2]) + 1)
    assert "with G3" in finding.message


@pytest.mark.ci
def test_no_contour_is_searched_again_that_an_edit_leaves_as_it_is(monkeypatch: pytest.MonkeyPatch) -> None:
    """A hexagon with its own slip in each section: what is tried in one says nothing new of the others."""
    slips = [("C-8.66", "C-6.88"), ("C17.321", "C17.231"), ("X-30.", "X-33."), ("C-17.321", "C-13.721")]
    hexagon = "G42 X30. F200/C8.66/X0 C17.321/X-30. C8.66/C-8.66/X0 C-17.321/X30. C-8.66/C0"
    contours = [hexagon.replace(right, wrong, 1) for right, wrong in slips]
    sections = ["/".join(["G0 X60. Z2. C0", *HEAD[3:], contour, *TAIL[:-1]]) for contour in contours * 2]
    searched: list[object] = []
    best, trials = correction_search._Search.best, explanations.edited
    monkeypatch.setattr(correction_search._Search, "best", lambda search: searched.append("best") or best(search))
    monkeypatch.setattr(explanations, "edited", lambda *given: searched.append("edited") or trials(*given))
    report = report_of(
        "\n".join([*HEAD[:2], "G98", *"/".join(sections).split("/"), "M30"]) + "\n", "fanuc", "1:radius=4"
    )
    assert [rule for _, rule in said(report)].count("nearly-regular-contour") >= len(slips)
    # Once as it is written, and once where it is changed.
    assert searched.count("best") <= 3 * len(slips)
    assert searched.count("edited") <= 2 * len(slips)


@pytest.mark.ci
def test_what_an_arc_that_is_none_has_hidden_is_no_reason_against_what_mends_it() -> None:
    """A ramp of a tenth and an approach of half: without the first one the second can be seen."""
    arcs = ["C-9.5", "G2 X0 C-17.5 I-8. J0", "X-16. C-9.5 I0 J8.", "G1 C9.5", "G2 X0 C17.5 I8. J0", "X16. C9.5 I0 J-8."]
    moves = ["G41 G1 X16. C0 F200", *arcs, "G1 C0", "G40 X58. F1500"]
    head = [
        "O1",
        "G21 G40 G98",
        "T0909",
        "G28 H0",
        "G97 S3000 M13",
        "G0 X65. Z2. C0",
        "G12.1",
        "G1 X58. F1500",
        "Z-1.5",
    ]
    sound = "\n".join([*head, *moves, "Z2. F1500", "G13.1", "M30"]) + "\n"
    assert told(sound) == []
    wrong = sound.replace("G1 X58. F1500", "G1 X29. F1500").replace("X16. C0", "X1.6 C0")
    lines = wrong.splitlines()
    assert {lines[line - 1] for _, line in told(wrong)} >= {"G41 G1 X1.6 C0 F200"}
    assert any("with X16." in message for message, _ in told(wrong))


def told(text: str) -> list[tuple[str, int]]:
    """What is said in which line, of the contour with a cutter of 16 mm in a bar of 39 mm."""
    findings = report_of(text, "fanuc", "9:radius=8", job={"stock": {"diameter": 39}}).findings
    return [(finding.message, finding.line) for finding in findings if finding.severity != "note"]


#: An octagon with leads on the extensions of two sides, which cross at its corner.
CROSSED = [
    *("G42 X36.792 C11.863 F200", "X0. C19.483", "X-27.554 C13.777", "X-38.966 C0.", "X-27.554 C-13.777"),
    *("X0. C-19.483", "X27.554 C-13.777", "X38.966 C0.", "X23.726 C18.396"),
]
#: The same with a hexagon.
HEXAGON_CROSSED = [
    *("G42 X42.392 C6.238 F180", "X0. C18.475", "X-32. C9.238"),
    *("C-9.238", "X0. C-18.475", "X32. C-9.238", "C15.238"),
]
#: A square with chamfers.
SMALL = [
    *("G42 X40. C0. F200", "C17.5", "X35. C20.", "X-35.", "X-40. C17.5", "C-17.5", "X-35. C-20."),
    *("X35.", "X40. C-17.5", "C0."),
]


@pytest.mark.nightly
@looped(
    ("contour", "right", "wrong", "word"),
    [
        (CROSSED, "G42 X36.792 C11.863 F200", "G42 X16.792 C11.863 F200", "X36.792"),
        (HEXAGON_CROSSED, "X32. C-9.238", "X33. C-9.238", "X32."),
        (HEXAGON_CROSSED, "G42 X42.392 C6.238 F180", "G42 X42.392 C.238 F180", "C6.238"),
        (HEXAGON_CROSSED, "G42 X42.392 C6.238 F180", "G42 X24.392 C6.238 F180", "X42.392"),
        # No size without a point is taken for another one that is within its last digit.
        (SMALL, "X-35. C-20.", "X-35. C-220.", "C-20."),
    ],
)
def test_what_makes_it_symmetric_is_likelier_than_what_closes_it(
    contour: list[str], right: str, wrong: str, word: str
) -> None:
    ramp = "G1 X76. C20. F1500"
    sound = "\n".join([*HEAD[:-2], ramp, HEAD[-1], *contour, "G40 X70. C22.", *TAIL[1:]]) + "\n"
    assert told_of_small_cutter(sound) == []
    ((message, line),) = told_of_small_cutter(sound.replace(right, wrong))
    assert sound.splitlines()[line - 1] == right
    assert f"with {word} " in message


#: A hexagon with one side farther in, from a corner on; a turned one with leads on the extensions of two sides.
KEYED = [
    *("G42 X39.5 C-11.403 F200", "C11.403", "X0. C22.805", "X-35.5 C12.557", "C-12.557"),
    *("X0. C-22.805", "X39.5 C-11.403"),
]
TURNED = [
    *("G42 X39.404 C11.375 F150", "X26.269 C22.75", "X-26.269", "X-52.539 C0.", "X-26.269 C-22.75", "X26.269"),
    *("X52.539 C0.", "X39.404 C11.375"),
]


@pytest.mark.nightly
@looped(
    ("contour", "index", "wrong", "word"),
    [
        (KEYED, 0, "G42 X93.5 C-11.403 F200", "X39.5"),
        (KEYED, 0, "G42 X19.5 C-11.403 F200", "X39.5"),
        (KEYED, 6, "X93.5 C-11.403", "X39.5"),
        (TURNED, 6, "X525.39 C0.", "X52.539"),
        (TURNED, 3, "X-525.39 C0.", "X-52.539"),
    ],
)
@pytest.mark.parametrize("control", ["fanuc-30i", "doosan"])
def test_of_two_ends_that_may_be_wrong_the_one_off_the_shape_is(
    contour: list[str], index: int, wrong: str, word: str, control: str
) -> None:
    first, last = ("G1 X57.5 C-17.403 F1500", "G40 X58.892 C-16.197")
    if contour is TURNED:
        first, last = ("G1 X58.724 C14.643 F1500", "G40 X56.725 C16.375")
    right = [first, HEAD[-1], *contour, last]
    slipped = [*right[:2], *contour[:index], wrong, *contour[index + 1 :], last]
    for turn in (as_it_is, mirrored):
        for sound, lines in ((True, right), (False, slipped)):
            text = "\n".join([*HEAD[:-2], *turn(lines), *TAIL[1:]]) + "\n"
            in_both = ((text, "1:radius=4"), (tenth_in_inch(text), "1:radius=0.4"))
            for number, (written, tool) in enumerate(in_both):
                found = said_and_where(written, control, tool)
                assert len(found) == (not sound)
                for message, line in found:
                    assert line == len(HEAD) - 2 + 2 + index + 1
                    assert number or f"with {word}" in message


def tenth_in_inch(text: str) -> str:
    """A program with a tenth of each number, in inch: slips of the pen remain such."""
    text = re.sub(r"([XZCF])(-?[\d.]+)", lambda word: f"{word[1]}{round(float(word[2]) / 10, 4)}", text)
    return text.replace("G98", "G20 G98")


def said_and_where(text: str, control: str, tool: str) -> list[tuple[str, int]]:
    """What is said in which line."""
    findings = report_of(text, control, tool).findings
    return [(finding.message, finding.line) for finding in findings if finding.severity != "note"]


@pytest.mark.ci
def test_a_distance_that_is_wrong_is_not_explained_by_reading_all_of_them_as_positions() -> None:
    moves = ["X-17.966 C5.837", "X-11.103 C-15.282", "X11.103 C-15.282", "X17.966 C5.837", "X0 C18.89"]
    head = ["O1", "T0101", "G90 G94 G0 X60. Z2. C0", "G12.1", "G1 X20. C18.445 F800", "Z-4. F300"]
    path = ["G42 X13. C9.445 F170", "G91", *moves, "G90", "G40 X22. C11.445", "Z2.", "G13.1", "M30"]
    sound = "\n".join([*head, *path]) + "\n"
    assert report_of(sound, "mitsubishi-m700", "1:radius=5").findings == []
    (finding,) = report_of(sound.replace("X-11.103", "X-22.206"), "mitsubishi-m700", "1:radius=5").findings
    assert "with X-11.103 it would be a regular pentagon" in finding.message


@pytest.mark.ci
def test_no_other_number_is_named_where_another_pass_has_the_number() -> None:
    ramp = ["G1 X50.392 C13.166 F800"]
    passes = [line for z in ("Z-2.", "Z-4.") for line in (*ramp, z, *HEXAGON_CROSSED, "G40 X48.", "Z2.")]
    lines = [*HEAD[:-2], *passes, *TAIL[2:]]
    assert told_of_small_cutter("\n".join(lines) + "\n") == []
    last = len(lines) - lines[::-1].index("C15.238") - 1
    ((message, line),) = told_of_small_cutter("\n".join([*lines[:last], "C155.238", *lines[last + 1 :]]) + "\n")
    assert line == last + 1
    assert "C9.238" not in message


def told_of_small_cutter(text: str) -> list[tuple[str, int]]:
    """What is said in which line, with a cutter of 10 mm."""
    findings = report_of(text, "fanuc-30i", "1:radius=5").findings
    return [(finding.message, finding.line) for finding in findings if finding.severity != "note"]


@pytest.mark.nightly
@looped(
    ("contour", "rights", "wrongs", "words"),
    [
        (SMALL, ("C17.5", "X-35. C-20."), ("C71.5", "X-35. C-2."), ("C17.5", "C-20.")),
        (SMALL, ("X35. C20.", "C-17.5"), ("X53. C20.", "C-1.75"), ("X35.", "C-17.5")),
    ],
)
def test_two_words_that_make_it_symmetric_together_are_both_named(
    contour: list[str], rights: tuple[str, ...], wrongs: tuple[str, ...], words: tuple[str, ...]
) -> None:
    replaced = dict(zip(rights, wrongs, strict=True))
    slipped = [replaced.get(line, line) for line in contour]
    ramp = "G1 X76. C0. F1500"
    lines = [*HEAD[:-2], ramp, HEAD[-1], *slipped, "G40 X76.", *TAIL[1:]]
    said_there = {(lines[line - 1], message) for message, line in told_of_small_cutter("\n".join(lines) + "\n")}
    assert {line for line, _ in said_there} == {*wrongs}
    assert all(any(f"with {word}" in message for _, message in said_there) for word in words)


@pytest.mark.ci
@pytest.mark.parametrize(
    ("of_section", "of_run", "rows"), [(64, 512, 19_500), (0, 512, 0), (64, 0, 0)], ids=["rows", "section", "run"]
)
def test_edits_that_are_tried_are_counted_and_those_that_are_not_are_said(
    of_section: int, of_run: int, rows: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(hidden_findings, "OF_SECTION", of_section)
    monkeypatch.setattr(hidden_findings, "OF_RUN", of_run)
    lines = [*HEAD[:3], *["G4 P1"] * rows, *HEAD[3:], *ROUNDED, *TAIL]
    lines[lines.index("G3 X-34. C-10. R3.")] = "G3 X-34. C-10. R30."
    report = report_of("\n".join(lines) + "\n")
    assert report.findings
    (entry,) = (entry for entry in report.not_evaluated if entry.rule == "nearly-regular-contour")
    assert entry.reason.startswith(f"what explains the findings in the section of line {lines.index('G12.1') + 1} was")
    assert (entry.matters, entry.blocks) == (False, len(lines) - lines.index("G12.1") - 2)


@pytest.mark.parametrize("code", ["G2", "G3"])
def test_a_lead_with_its_chord_along_the_wall_is_like_no_other(code: str) -> None:
    """The R with which it would be tangent is infinite; a warning of numpy would fail the test."""
    lead = [*("G42 X36. C-20. F200", f"{code} X36. C-5. R20.", "G1 C10.", "X-36.", "C-10.", "X36.", "C-5.")]
    text = "\n".join([*HEAD, *lead, "G3 X56. C5. R10.", "G40 G1 X90. F1000", "Z2.", "G13.1", "G0 Z50.", "M30", ""])
    rules = {rule for _, rule in said(report_of(text, "fanuc-30i", "1:radius=4"))}
    assert "arc-not-tangent" not in rules
