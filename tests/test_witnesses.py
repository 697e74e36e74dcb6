"""Slips that the rest of a program shows, its like blocks or the numbers of a loop; and sound programs like them."""

from __future__ import annotations

import re

import pytest
from cases import looped
from programs import report_of, said

#: A hexagon of 27 mm across flats, milled with R 4 down to Z-4.
HEXAGON = """%
O1
G21 G98 G40
T0808
G97 S2000 M13
G0 X60. Z2. C0
G12.1
G1 X60. F1500
Z-4. F200
G42 X27. F250
C7.794
X0 C15.588
X-27. C7.794
C-7.794
X0 C-15.588
X27. C-7.794
C0
G40 X60.
Z2. F1500
G13.1
G0 Z50.
M30
%
"""
CONTOUR = HEXAGON[HEXAGON.index("G42") : HEXAGON.index("Z2. F1500")]
#: The same in a subprogram that is repeated three times, one increment deeper each time.
REPEATED = HEXAGON.replace("Z-4. F200\n" + CONTOUR, "Z0 F200\nM98 P30100\n").replace(
    "M30\n", f"M30\nO100\nG1 W-2. F200\n{CONTOUR}M99\n"
)
#: The same in a loop of macro.
LOOP = HEXAGON.replace("Z-4. F200\n" + CONTOUR, f"#1=1.\nWHILE[#1LE4.]DO1\nZ-#1 F200\n{CONTOUR}#1=#1+1.\nEND1\n")
#: A pass that block skip leaves out.
OPTIONAL = HEXAGON.replace(
    "Z2. F1500\nG13.1",
    "Z2. F1500\n" + re.sub("^", "/", f"Z-4.1 F200\n{CONTOUR}Z2. F1500", flags=re.MULTILINE) + "\nG13.1",
)
#: Three slots at one depth.
SLOTS = HEXAGON.replace(
    "Z-4. F200\n" + CONTOUR,
    "".join(f"X30. C-{c}. F1500\nZ-3. F60\nX-30. F200\nZ2. F1500\n" for c in (16, 12, 8)),
)
#: Three round pockets at one depth.
POCKETS = HEXAGON.replace(
    "Z-4. F200\n" + CONTOUR,
    "".join(
        f"X{x}. C{c}. F1500\nZ-3. F60\nG41 X{x + 12}. F80\nG3 I-6.\nG1 G40 X{x}.\nZ2. F1500\n"
        for x, c in ((24, -14), (24, 0), (24, 14))
    ),
)


def inch(program: str) -> str:
    """The same program in inch."""
    return re.sub(
        r"([XCZRIJFW])(-?\d+\.?\d*)(?=\s)",
        lambda word: f"{word[1]}{float(word[2]) / 25.4:.4f}",
        program.replace("G21", "G20"),
    )


def slipped(program: str, before: str, after: str) -> str:
    assert before in program
    return program.replace(before, after, 1)


@pytest.mark.nightly
@looped(
    ("program", "before", "after", "line", "rule"),
    [
        (HEXAGON, "G0 X60. Z2. C0", "G0 X27.2 Z-3. C0", 6, "rapid-through-part"),
        (HEXAGON, "G0 X60. Z2. C0", "G0 X30. C0\nZ-4.", 7, "rapid-through-part"),
        (HEXAGON, "X-27. C7.794", "G13.1\nX-27. C7.794", 13, "polar-switched-in-offset-mode"),
        (REPEATED, "W-2.", "Z-2.", 18, "cut-in-air"),
        (LOOP, "Z-#1", "Z-4.", 13, "cut-in-air"),
        (LOOP, "#1LE4.", "#1GE4.", 10, "unreachable-block"),
        (LOOP, "#1LE4.", "#1LE-4.", 10, "unreachable-block"),
        (LOOP, "#1LE4.", "1GT4.", 10, "unreachable-block"),
        (OPTIONAL, "/X-27.", "X-27.", 24, "block-skip-missing"),
        (OPTIONAL, "/X0 C-15.588", "X0 C-15.588", 26, "block-skip-missing"),
        (SLOTS, "Z2. F1500\nX30. C-12.", "X30. C-12.", 12, "lift-missing-between-cuts"),
        (SLOTS, "C-12. F1500\nZ-3. F60", "C-12. F1500\nZ-3.", 14, "plunge-at-positioning-feed"),
        (POCKETS, "Z2. F1500\nX24. C0.", "X24. C0.", 14, "lift-missing-between-cuts"),
        (POCKETS, "G3 I-6.", "G3 I-12.", 12, "circle-center-doubled"),
        (POCKETS, "G3 I-6.", "G3 I-5.", 12, "circle-center-doubled"),
    ],
)  # fmt: skip
def test_the_rest_of_the_program_says_what_was_meant(
    program: str, before: str, after: str, line: int, rule: str
) -> None:
    radius = 1.5 if program in (SLOTS, POCKETS) else 4
    assert said(report_of(program, "fanuc-30i", f"8:radius={radius},nose=0")) == []
    report = report_of(slipped(program, before, after), "fanuc-30i", f"8:radius={radius},nose=0")
    assert said(report) == [(line, rule)]
    converted = report_of(inch(slipped(program, before, after)), "fanuc-30i", f"8:radius={radius / 25.4:.4f},nose=0")
    assert said(converted) == [(line, rule)]


@pytest.mark.ci
@looped(
    ("program", "before", "after"),
    [
        # Options that are off, counts of no passes, and what a loop before has left are no slips.
        (LOOP, "#1=1.\nWHILE[#1LE4.]", "#2=0\n#1=1.\nWHILE[#1LE#2]"),
        (LOOP, "#1=1.\nWHILE[#1LE4.]", "#1=1.\nIF[#1EQ1.]THEN #1=9.\nWHILE[#1LE4.]"),
        (LOOP, "#1=1.\nWHILE[#1LE4.]DO1\nZ-#1", "#1=3.\nWHILE[#1LE4.]DO1\nZ-4."),
        # The lift may stand among the optional blocks without /, since it moves nothing where they are skipped.
        (OPTIONAL, "/Z2. F1500", "Z2. F1500"),
        (SLOTS, "Z2. F1500\nG13.1", "G13.1"),
        # A pocket of another size, to which the lead is shorter, too.
        (POCKETS, "G41 X36. F80\nG3 I-6.", "G41 X34. F80\nG3 I-5."),
    ],
)
def test_what_has_no_witness_stays_silent(program: str, before: str, after: str) -> None:
    radius = 1.5 if program in (SLOTS, POCKETS) else 4
    assert said(report_of(slipped(program, before, after), "fanuc-30i", f"8:radius={radius},nose=0")) == []
