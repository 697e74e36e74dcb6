"""Contours that are nearly regular: one slip in a drawn contour is noticed, and what differs on purpose is silent."""

from __future__ import annotations

import cmath
import functools
import math
import random
import re
from collections.abc import Sequence

import pytest
from cases import looped
from drawn_regular import (
    MEANT,
    SLIPS,
    Contour,
    Style,
    blocks_of,
    corners,
    findings,
    regular_contour,
    style,
)
from programs import report_of

from polarcheck.columns.words.slips import slip_of

RULES = {"nearly-regular-contour", "diameter-radius-mixed"}
#: What moves no corner farther than this is no slip [mm].
_LEAST = 0.05


#: Contours that are drawn, and those of them that each slip is planted in.
_DRAWN, _OF_A_SLIP = 28, 14


@functools.cache
def sound_contour(seed: int) -> tuple[Contour, Style, list[str]] | None:
    """A drawn contour, its style and its blocks; None where something is found in it."""
    draw = random.Random(f"sound {seed}")  # noqa: S311 - programs that can be written again
    contour, how = regular_contour(draw), style(draw)._replace(compensated=True)
    blocks = blocks_of(contour, how)
    return None if findings(blocks, contour, how) else (contour, how, blocks)


@pytest.mark.nightly
@pytest.mark.parametrize("name", SLIPS)
def test_most_slips_in_a_regular_contour_are_noticed(name: str) -> None:
    noticed = written = 0
    first = [*SLIPS].index(name)
    for seed in range(_OF_A_SLIP):
        drawn = sound_contour((5 * first + seed) % _DRAWN)
        if drawn is None:
            continue
        contour, how, sound = drawn
        draw = random.Random(f"{name} {seed}")  # noqa: S311
        wrong = SLIPS[name](list(sound), draw)
        if wrong is None:
            continue
        before, after = corners(sound, contour, how), corners(wrong, contour, how)
        if len(before) == len(after) and max(abs(a - b) for a, b in zip(before, after, strict=True)) < _LEAST:
            continue
        written += 1
        noticed += bool(findings(wrong, contour, how))
    assert written > 3
    assert noticed >= 0.7 * written


@pytest.mark.ci
@pytest.mark.parametrize(
    "seeds",
    [
        # A cross with one longer arm: with another corner, one that is written would lie on a side.
        pytest.param((15, 26), id="unlike arms"),
        pytest.param(range(40), id="all", marks=pytest.mark.nightly),
    ],
)
def test_what_differs_on_purpose_is_silent(seeds: Sequence[int]) -> None:
    for seed in seeds:
        draw = random.Random(seed)  # noqa: S311
        contour, how = draw.choice(MEANT)(draw), style(draw)
        found = findings(blocks_of(contour, how), contour, how)
        assert not [message for rule, message in found if rule in RULES], (seed, contour.family)


@pytest.mark.ci
@looped(
    "contour",
    [
        # Arms of four lengths, of which two differ by half a millimeter.
        "X35. C-6.5/C6.5/X11./C21./X-11./C6.5/X-34./C-6.5/X-11./C-17./X11./C-6.5/X35.",
        "X43. C-5.5/C5.5/X14./C15.5/X-14./C5.5/X-41./C-5.5/X-14./C-15./X14./C-5.5/X43.",
        # A notch, which is no square with a quarter missing.
        "X35. C17.5/X-35./C-14.5/X0/C-17.5/X35./C17.5",
    ],
)
def test_a_side_that_lies_elsewhere_is_meant(contour: str) -> None:
    blocks = contour.replace("/", "\n")
    program = f"O1\nG21 G98 G40\nT0101\nG0 X90. Z2. C-30.\nG12.1\nG1 X70. C-30. F300\nZ-2.\nG42 {blocks}\n"
    report = report_of(f"{program}G40 X70. C30.\nG13.1\nM30\n", "fanuc", only=["nearly-regular-contour"])
    assert report.findings == []


@looped(
    ("written", "meant", "kind"),
    [
        ("13.586", 13.856, "two digits are swapped"),
        ("-13.524", -13.254, "two digits are swapped"),
        ("17.321", -17.321, "the sign is wrong"),
        ("1.7321", 17.321, "the point is at the wrong place"),
        ("133.856", 13.856, "a digit is too many"),
        ("15.5", 15.0, "a digit is too many"),
        ("3.856", 13.856, "a digit is missing"),
        ("15.", 30.0, "it is half or twice as large"),
        ("28.", 30.0, None),
    ],
)
def test_a_slip_of_the_pen(written: str, meant: float, kind: str | None) -> None:
    slip = slip_of(written, meant, 0.002)
    assert (slip.kind if slip else None) == kind


@pytest.mark.ci
@looped(
    ("written", "how"),
    [("X1.0426", "two digits are swapped"), ("X1.0346", "a digit is wrong"), ("X1.246", "a digit is missing")],
)
def test_the_number_that_is_meant_has_all_of_its_digits(written: str, how: str) -> None:
    """A pentagon in inch: the X of its point stands nowhere else in the contour."""
    points = [cmath.rect(0.5123, 2 * math.pi * number / 5) for number in range(5)]
    middle = (points[0] + points[-1]) / 2
    corner = [f"X{2 * point.real:.4f} C{point.imag:.4f}" for point in (middle, *points, middle)]
    blocks = "\n".join(corner).replace("X1.0246", written)
    program = f"O1\nG20 G98 G40\nT0101\nG0 X4. Z.1 C-1.\nG12.1\nG1 Z-.1 F8.\nG42 {blocks}\nG40 X4. C-1.\nG13.1\nM30\n"
    (slip,) = report_of(program, "fanuc", "1:radius=.05", only=["nearly-regular-contour"]).findings
    assert f"{how}: with X1.0246 it would be a regular pentagon" in slip.message


@pytest.mark.ci
@looped(
    ("written", "how"),
    [
        ("X-25.6", "a digit is wrong"),
        ("X-25.5", "a digit is wrong"),
        ("X-24.5", "two digits are swapped"),
        ("X-5.4", "a digit is missing"),
        ("X-2.54", "the point is at the wrong place"),
    ],
)
def test_a_number_that_one_slip_writes_exactly_is_none_of_another_that_is_near(written: str, how: str) -> None:
    """A hexagon of 22 mm across flats with 25.4 as whole tenths: 25.46 is near, and a missing digit would make it."""
    program = (
        "O1\nG21 G98 G40\nT0101\nG0 X140. Z5. C0\nG12.1\nG1 Z-2. F5000\nG1 G42 X25.4 F700\nX12.7 C11.\nX-12.7 C11.\n"
        f"{written} C0\nX-12.7 C-11.\nX12.7 C-11.\nX25.4 C0\nX12.7 C11.\nG1 G40 X140. C0 F5000\nG13.1\nM30\n"
    )
    (slip,) = report_of(program, "fanuc", "1:radius=3", only=["nearly-regular-contour"]).findings
    assert f"{how}: with X-25.4 it would be a regular hexagon" in slip.message


@pytest.mark.ci
def test_a_block_of_increments_that_stands_there_twice_is_told() -> None:
    """A heptagon, which begins and ends in the middle of a side."""
    blocks = (
        "H8.678/U-27.138 H10.821/U-33.841 H-3.862/U-15.06 H-15.637/U-15.06 H-15.637/U15.06 H-15.637/U33.841 H-3.862/"
        "U27.138 H10.821/H8.678"
    ).replace("/", "\n")
    program = f"O1\nT0101\nG98 G0 X80. Z2. C0\nG12.1\nG1 Z-4. F300\nG42 X36.039 F180\n{blocks}\nG40 X80.\nG13.1\nM30\n"
    (slip,) = report_of(program, "fanuc", "1:radius=2", only=["nearly-regular-contour"]).findings
    assert slip.line == 11
    assert "it stands there twice: without it it would be closed" in slip.message


#: A bar with a flat by R and by I and J, and a plate with round corners: C as it is meant.
WITH_FLAT = ["G42 X21. F200", "C12.073", "G3 X-32. C0 R16.", "X21. C-12.073 R16.", "G1 C0"]
BY_CENTERS = ["G42 X25.2 F100", "C17.421", "G3 X-43. C0 I-12.6 J-17.421", "X25.2 C-17.421 I21.5 J0", "G1 C0"]
PLATE = [
    *("G42 X60. F150", "C9.5", "G3 X53. C13. R3.5", "G1 X-53.", "G3 X-60. C9.5 R3.5"),
    *("G1 C-9.5", "G3 X-53. C-13. R3.5", "G1 X53.", "G3 X60. C-9.5 R3.5", "G1 C0"),
]


@pytest.mark.parametrize(("machine", "scale"), [("fanuc-30i", 1), ("doosan", 10)])
def test_c_that_is_written_as_a_diameter_is_told_by_its_arcs(machine: str, scale: int) -> None:
    """The second time in inch, on the other side of the X axis."""
    exchanged = {"G2": "G3", "G3": "G2", "G42": "G41"}
    for contour in (WITH_FLAT, BY_CENTERS, PLATE):
        for factor, is_told in ((1, False), (2, True)):
            lines = [f"G{22 - min(scale, 2)} G98 T0101", "G0 X90. Z2. C0", "G12.1", "G1 X80. F500", "Z-2.", *contour]
            text = "\n".join([*lines, "G40 X80.", "Z2.", "G13.1", "M30", ""])
            if scale > 1:
                text = re.sub(r"\bG(?:2|3|42)\b", lambda code: exchanged[code[0]], text)
                text = re.sub(r"([CJ])(-?)(?=[1-9])", lambda word: word[1] + "-" * (not word[2]), text)
            text = re.sub(
                r"([XZCRIJF])(-?[\d.]+)",
                lambda word: f"{word[1]}{float(word[2]) * (factor if word[1] == 'C' else 1) / scale:.4f}",  # noqa: B023
                text,
            )
            found = report_of(text, machine, f"1:radius={3 / scale}").findings
            told = [
                (finding.rule, finding.message.partition(";")[2]) for finding in found if finding.severity != "note"
            ]
            assert told == [("diameter-radius-mixed", " write C half as large")] * is_told


#: A free shape by arcs with R, with C in degrees.
IN_DEGREES = (
    "G41 X38.649 C-0.228 F120.\nC344.22\nG2 X36.45 C336.279 R3.5\nG1 X2.599 C273.104\nG2 X-4.958 C264.16 R3.\n"
    "G1 X-42.462 C207.621\nG2 X-45.859 C198.304 R4.\nG1 X-43.478 C151.838\nG2 X-39.872 C143.526 R4.\n"
    "G1 X-8.709 C99.908\nG2 X-2.668 C93.09 R2.5\nG1 X35.935 C23.251\nG2 X38.649 C13.72 R4.\nG1 C359.324\n"
)


@pytest.mark.parametrize("mirrored", [False, True])
def test_arcs_that_fit_with_half_of_c_by_chance_say_nothing_of_it(mirrored: bool) -> None:
    """Steps of angles are about as long as these R; halved, no arc would go on smoothly from the lines beside it."""
    contour = IN_DEGREES
    if mirrored:
        contour = re.sub(r"C(-?)(?=\d)", lambda word: "C" + "-" * (not word[1]), contour)
        contour = contour.replace("G2", "G3").replace("G41", "G42")
    text = f"G21 G98 T0101\nG0 X77. Z2. C0\nG12.1\nG1 X70. F500\nZ-3.\n{contour}G40 X70. F800.\nZ2.\nG13.1\nM30\n"
    rules = [finding.rule for finding in report_of(text, "gsk-988", "1:radius=3").findings]
    assert "arc-radius-too-small" in rules
    assert "diameter-radius-mixed" not in rules


@pytest.mark.parametrize("radius", ["0", "#500", "-3.5"])
def test_arcs_of_any_r_are_compared_with_half_of_c(radius: str) -> None:
    contour = IN_DEGREES.replace("R4.", f"R{radius}")
    text = f"G21 G98 T0101\nG0 X77. Z2. C0\nG12.1\nG1 X70. F500\n{contour}G40 X70.\nG13.1\n"
    assert "diameter-radius-mixed" not in [finding.rule for finding in report_of(text).findings]
