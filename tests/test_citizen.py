"""Programs as they are written for Citizen lathes: spindles by S1= to S4=, E = C with blanks, G16 of a cylinder."""

from __future__ import annotations

import pytest
from cases import looped
from programs import Changes, report_of, said, trace_of

from polarcheck.columns.modes import live_tool
from polarcheck.foundation.finding import FileReport

CONTOUR = """G1 X10. Y0 F200
G42 X6. Y0
Y3.
X-6.
Y-3.
X6.
Y0
G40 X10.
"""


def program(spindle: str = "M83 S3=3000", switch: str = "G12.1 D0 E=C", off: str = "M85") -> str:
    head = f"O1000\n$1\nG98 G40\n{spindle}\nM18\nG28 H0\nG0 X14. Z1. T1111\n"
    return f"{head}{switch}\nG17\n{CONTOUR}G13.1\nM20\n{off}\nM99\n"


def citizen(text: str, changes: Changes | None = None) -> FileReport:
    return report_of(text, "citizen", "11:radius=1,nose=0", changes=changes)


@pytest.mark.nightly
@looped(
    "spindle",
    [
        "M83 S3=3000",
        "S3=2500\nM83",
        "G97M83S3=3000T1100E0",
        "M3 S1=3000\nG0 Z5.\nS1=0\nG97 M83 S3 = 3000",
        "M3 S1=3000\nM5\nM80 S2500",
        "M23 S2=2000\nM83 S4=2000",
        "#100=2000\nM83 S3=#100",
        "M83 S3=[1000+500]",
        "G114.1 H1 D-2 E0\nG610\nG600\nG44\nM58 S3=3000\nG113",
    ],
    one_in=3,
)
def test_a_sound_program_passes(spindle: str) -> None:
    report = citizen(program(spindle))
    assert (report.verdict, said(report), report.not_evaluated) == ("pass", [], [])


@pytest.mark.ci
@looped("switch", ["G12.1 E = C D0", "G12.1D0E=C", "G12.1 E= C D0", "G 12.1 D 0 E =C", "G12.1\tE\t=\tC D0"], one_in=2)
def test_blanks_stand_anywhere(switch: str) -> None:
    report = citizen(program(switch=switch))
    assert (report.verdict, said(report), report.not_evaluated) == ("pass", [], [])


@looped(
    ("spindle", "speed"),
    [
        ("M83 S3=3000", 3000),
        ("S3=2500\nM3 S1=800\nM5\nM83", 2500),
        ("M83 S3=3000\nS2=500", 3000),
        ("M83 S4=1200", 1200),
        ("M80 S2500", 2500),
        ("M3 S1=3000\nM5", None),
    ],
)
def test_the_chip_load_is_that_of_the_live_tool(spindle: str, speed: float | None) -> None:
    trace = trace_of(program(spindle), "citizen")
    found = live_tool.speed(trace)[trace.mode.in_polar]
    assert all(found == speed) if speed else all(found != found)


def test_a_main_spindle_that_turns_is_told() -> None:
    report = citizen(program("M3 S1=3000\nM83 S3=3000"))
    assert said(report) == [(9, "main-spindle-running-at-entry")]


def test_the_head_of_a_post() -> None:
    """M codes, spindle, tool and index angle in one block; G44 names a spindle, and M18 needs no reference return."""
    head = "S1=0\nG97M58S3=4000T2700E0.\nG44\nG98 M18\nG0 Z1. T27\nG0 X16. C0\n"
    report = report_of(
        f"O1\n$1\n{head}G12.1D0E=C\nG17\n{CONTOUR}G13.1\nM20\nM60\nM99\n", "citizen", "27:radius=1,nose=0"
    )
    assert (said(report), report.not_evaluated) == ([], [])


@pytest.mark.ci
@looped("plane", ["G16 C9.0", "G19", "G16C9."])
def test_another_plane_of_the_mode_is_not_looked_at(plane: str) -> None:
    section = f"G12.1 E=C D0\n{plane}\nG1 Z-5. F200\nY5.\nG2 Y8. Z-8. R3.\nY0\nG13.1\n"
    report = citizen(f"O1\nM83 S3=3000\nM18\nG28 H0\nG98 G0 X20. Z5. T1111\n{section}M85\nM30\n")
    assert (said(report), [missing.reason.partition(":")[0] for missing in report.not_evaluated]) == (
        [],
        [f"the plane of {plane} in line 7 is not simulated"],
    )


@pytest.mark.ci
def test_the_next_section_is_looked_at_again() -> None:
    two = program().replace(
        "G13.1\n", "G13.1\nG0 X14. C0\nG12.1 D0 E=C\nG16 C9.\nG1 Z-5.\nG13.1\nG0 X14. C0\nG12.1 D0 E=C\nG0 X5.\nG13.1\n"
    )
    assert [rule for _, rule in said(citizen(two))] == ["rapid-in-polar"]


def test_other_lathes_do_not_have_the_words() -> None:
    report = report_of("O1\nG98 G0 X60. C0\nM3 S3=2000\nG12.1\nG1 X10. F200\nG13.1\nM30\n")
    assert any(missing.reason.startswith("S3, from line 3 on") for missing in report.not_evaluated)
