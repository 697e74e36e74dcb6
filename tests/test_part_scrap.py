"""Programs that make scrap beside what their job asks for, and their sound twins; each in four ways."""

from __future__ import annotations

import re
from collections.abc import Callable
from typing import Any, NamedTuple

import pytest
from cases import looped
from programs import report_of, tables_of

from polarcheck.foundation.finding import FileReport
from polarcheck.reports.made_parts.compared_contours import compared

pytestmark = pytest.mark.ci

RULE = "part-differs-from-drawing"
HEAD = "G21 G40 G98 T0303\n"


class Case(NamedTuple):
    """
    A program, a block to a slash, and the part that it should make.

    slips: what is replaced for scrap, each by itself, and what is said then.
    """

    program: str
    part: dict[str, Any]
    radius: float
    slips: dict[tuple[str, str], str]
    stock: float = 0.0


def hexagon(z: float) -> str:
    corners = "C8.660/X0 C17.321/X-30. C8.660/C-8.660/X0 C-17.321/X30. C-8.660/C0"
    return f"G1 X80. C0 F500/Z{z}/G42 X30. F90./{corners}/G40 X80./"


def flat(c: str, x: str) -> str:
    return f"G0 X60. Z2. {c}/G12.1/G1 C-30. F500/Z-4./G42 X{x} C-25. F90./C25./G40 X60. C30./Z2./G13.1/"


SLOT = "G0 X50. Z-4. C0/G12.1/G1 G41 C5. F90./X-50./C-5./X50./G40 C0/G13.1/"
ROUND = "G0 X40. Z2. C0/G12.1/G1 C20. F500/Z-4./G41 X16. C16. F90./C-16./G40 X40./G13.1/"
CENTER = "G1 X40. C0/Z-4./X26. F90./C6.5/G3 X13. C13. R6.5/G1 X-13./G3 X-26. C6.5 R6.5/G1 C-6.5/G3 X-13. C-13. R6.5/"

CASES: dict[str, Case] = {
    "slot": Case(
        SLOT,
        {"shape": "slot", "width": 10.0, "turned": 0.0},
        3.0,
        {
            ("G41", "G42"): "too much",
            ("X50./G40", "X-50./G40"): "too much stays",
            ("C-5.", "C-4.9"): "0.1 mm",
        },
        stock=40.0,
    ),
    "two flats": Case(
        flat("C0", "24.") + flat("C180.", "24."),
        {"shape": "flats", "across_flats": 24.0, "count": 2, "diameter": 32.0, "turned": 0.0},
        8.0,
        {
            ("C180.", "C0"): "4 mm",
            ("C180.", "C175."): "too much",
            (flat("C180.", "24."), flat("C180.", "26.")): "1 mm",
            (flat("C180.", "24."), ""): "4 mm",
        },
    ),
    "three flats": Case(
        flat("C0", "20.") + flat("C120.", "20.") + flat("C240.", "20."),
        {"shape": "triangle", "across_flats": 20.0, "turned": 0.0},
        8.0,
        {
            ("C240.", "C220."): "too much",
            (flat("C240.", "20."), ""): "too much stays",
            (flat("C120.", "20."), flat("C120.", "20.1")): "0.05",
        },
        stock=30.0,
    ),
    "one flat": Case(
        ROUND,
        {"shape": "flat", "distance": 8.0, "diameter": 20.0, "turned": 0.0},
        3.0,
        {("C-16.", "C-2."): "1.04", ("X16.", "X16.2"): "0.1 mm"},
    ),
    "hexagon": Case(
        "G0 X80. Z2. C0/G12.1/" + hexagon(-3.0) + hexagon(-6.0) + "G13.1/",
        {"shape": "hexagon", "across_flats": 30.0, "turned": 0.0},
        4.0,
        {
            ("X0 C-17.321", "X0 C-7.321"): "too much is cut away",
            (hexagon(-3.0), hexagon(-3.0).replace("X-30. C8.660", "X-29.9 C8.660")): "too much is cut away",
            ("G42", "G1"): "it makes: hexagon, 22.000 across flats",
            ("C0/G12.1", "C7./G12.1"): "would fit turned by -7 deg",
        },
    ),
    "center path": Case(
        "G0 X80. Z2. C0/G12.1/" + CENTER + "G1 X13./G3 X26. C-6.5 R6.5/G1 C0/X40./G13.1/",
        {"shape": "square", "across_flats": 20.0, "turned": 0.0, "corner_radius": 3.5},
        3.0,
        {
            ("C-13. R6.5/", "C-13. R6.5/G1 C-12.5/C-13./"): "too much is cut away",
            ("C0/G12.1", "C20./G12.1"): "too much",
            ("X-26.", "X-25.8"): "too much is cut away",
        },
    ),
}


def inch(program: str) -> str:
    """The same with its lengths in inch."""
    program = program.replace("G21", "G20")
    inside = False
    lines = []
    for line in program.splitlines():
        inside = (inside or "G12.1" in line) and "G13.1" not in line
        letters = "XZCRF" if inside else "XZRF"
        lines.append(re.sub(rf"([{letters}])(-?[0-9.]+)", lambda m: f"{m[1]}{float(m[2]) / 25.4:.6f}", line))
    return "\n".join(lines) + "\n"


def of_haas(program: str) -> str:
    """The same for a control that writes Y in the mode, and X as a radius."""
    parts = re.split(r"(G12\.1|G13\.1)", program)
    inside = [re.sub(r"X([-0-9.]+)", lambda m: f"X{float(m[1]) / 2:.4f}", part) for part in parts[2::4]]
    inside = [re.sub(r"C(?=[-0-9.])", "Y", part) for part in inside]
    parts[2::4] = inside
    return "".join(parts).replace("G12.1", "G112").replace("G13.1", "G113")


def turned(program: str, by: float) -> str:
    """The same with C at the beginning of each section so much farther."""
    return re.sub(r"C([-0-9.]+)(?=\nG12\.1)", lambda m: f"C{float(m[1]) + by:.3f}", program)


WAYS: dict[str, tuple[str, Callable[[str], str], float]] = {
    "as it is": ("fanuc", str, 0.0),
    "inch": ("fanuc-30i", inch, 0.0),
    "turned": ("fanuc", lambda program: turned(program, 35.0), 35.0),
    "another control": ("haas-lathe", of_haas, 0.0),
}


def checked(case: Case, text: str, way: str) -> FileReport:
    machine, change, by = WAYS[way]
    part = {**case.part, "turned": case.part["turned"] + by}
    job = {"units": "mm", "part": [part], **({"stock": {"diameter": case.stock}} if case.stock else {})}
    program = change(HEAD + text.replace("/", "\n") + "M30\n")
    return report_of(program, machine, f"3:radius={case.radius}", job=job, only=[RULE])


@looped("way", WAYS, one_in=15)
@looped("name", CASES)
def test_a_sound_program_agrees(name: str, way: str) -> None:
    report = checked(CASES[name], CASES[name].program, way)
    assert [finding.message for finding in report.findings] == []
    assert [missing.reason for missing in report.not_evaluated] == []


@looped("way", WAYS, one_in=76)
@looped(("name", "slip"), [(name, slip) for name in CASES for slip in CASES[name].slips])
def test_scrap_does_not(name: str, slip: tuple[str, str], way: str) -> None:
    case = CASES[name]
    assert slip[0] in case.program
    findings = checked(case, case.program.replace(*slip, 1 if slip[0] != "G42" else -1), way).findings
    assert len(findings) == 1
    expected = case.slips[slip]
    if way == "as it is" or not re.search(r"\d", expected):
        assert expected in findings[0].message


@looped("turn", [None, 20.0])
def test_an_angle_that_cannot_be_compared_is_told_as_that(turn: float | None) -> None:
    """C at G12.1 is not known, or the part does not say how it is turned."""
    case = CASES["hexagon"]
    program = case.program if turn is None else case.program.replace("Z2. C0/G12.1", "Z2./G12.1")
    part = {"shape": "hexagon", "across_flats": 30.0, **({} if turn is None else {"turned": turn})}
    text = HEAD + program.replace("/", "\n") + "M30\n"
    (found,) = compared(tables_of(text, "fanuc", "3:radius=4", job={"units": "mm", "part": [part]}))
    assert found.agrees
    why = "[[part]] has no turned" if turn is None else "C at line 3 is not known"
    assert found.angle_not_compared == why
    assert found.text.endswith(f"; its angle was not compared: {why}")


def test_a_pocket_along_whose_walls_alone_the_program_mills_is_not_evaluated() -> None:
    """Its middle may be gone before; where the bar is given, it stands."""
    pocket = "G0 X20. Z2. C0/G12.1/G1 Z-4. F90./G41 X40./C20./X-40./C-20./X40./C0/G40 X20./Z2./G13.1/"
    case = Case(pocket, {"shape": "square", "across_flats": 40.0, "inside": True, "turned": 0.0}, 3.0, {})
    report = checked(case, pocket, "as it is")
    assert not report.findings
    (missing,) = report.not_evaluated
    assert "whether its middle is cleared before is not known" in missing.reason
    (found,) = checked(case._replace(stock=80.0), pocket, "as it is").findings
    assert "too much stays" in found.message


def test_sections_whose_angles_to_each_other_are_not_known_are_compared_each_by_itself() -> None:
    section = "G0 X10. Z2./G12.1/G1 C0 F300/Z{}/G41 X20./C10./X-20./C-10./X20./C0/G40 X10./Z2./G13.1/"
    text = HEAD + (section.format("-4.") + section.format("-6.")).replace("/", "\n") + "M30\n"
    part = {"shape": "square", "across_flats": 20.0, "inside": True, "turned": 45.0}
    found = compared(tables_of(text, "fanuc", "3:radius=3", job={"units": "mm", "part": [part]}))
    assert [(one.z, one.agrees) for one in found] == [(-6.0, True)]
