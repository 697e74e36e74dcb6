"""Radii as posts write them."""

from __future__ import annotations

import math

import pytest
from cases import looped
from programs import report_of, said, trace_of

from polarcheck.columns.words.radius_comments import radius_in
from polarcheck.foundation.finding import FileReport


@looped(
    ("comment", "inch", "radius"),
    [
        ('3/4" DIA. CUTTER', False, 0.375 * 25.4),
        ("3/4 DIA. CUTTER", True, 0.375 * 25.4),
        ("T8 D=12. CR=0. - ZMIN=-5. - FLAT END MILL", False, 6.0),
        ("D=.5 CR=.03", True, 0.25 * 25.4),
        ("R0.25", True, 0.25 * 25.4),
        ("Freza=12", False, 6.0),
        ("10MM END MILL", False, 5.0),
        ("1/2 INCH ENDMILL", False, 6.35),
        ("DIA 16", False, 8.0),
        ("ROUGH OD", False, None),
        ("CR=0.4", False, None),
        ("DRILL 3", False, None),
        ("OP10 REV 3", False, None),
        ("1/0 DIA", False, None),
        ("D9999.", False, None),
        ("DIA16", False, 8.0),
        ("DIAM.12,5", False, 6.25),
        ("RADIUS12", False, 12.0),
        ("T1 DIA12.5MM", True, 6.25),
        ("NO.3 10 - END  MILL", False, 5.0),
        ("1.2.3 DIA", False, None),
        ("EM10", False, 5.0),
        ("EM10", True, None),
        ("EM_0.750", True, 0.375 * 25.4),
        ("CUTTER 10", False, 5.0),
        ("D12 EM", False, 6.0),
        ("8MM DIA. CUTTER", False, 4.0),
        ("1/2 END MILL", True, 6.35),
        ("1/2 END MILL", False, 6.35),
        ("1-1/4 END MILL", True, 0.625 * 25.4),
        ("T9 END MILL D12", False, 6.0),
        ("TOOL 5 END MILL 12", False, 6.0),
        ("12MM 4 FLUTE CARBIDE END MILL", False, 6.0),
        ("HEX 24 AF, END MILL D12", False, 6.0),
        ("2 FLUTE END MILL 12", False, 6.0),
        ("SLOT DRILL 8", False, 4.0),
        ("CUTTER R5", False, 5.0),
        ("END MILL D12 R0.5", False, 6.0),
        ("8MM MILL", False, 4.0),
        ("FRAISE DIAMETRE 10", False, 5.0),
        ("BAR DIA 28", False, None),
        ('1.25" BORING BAR', True, None),
        ("BORING BAR DIA 16", False, None),
        ("JAW PRESSURE: 10 BAR", False, None),
        ("CHUCK ON 4.27 DIA", True, None),
        ("TOOL 5 END MILL", False, None),
        ("OP20 MILL", False, None),
        ("MILL 2 FLATS", False, None),
        ("MILL D30 BOSS", False, None),
        ("MILL HEX 24", False, None),
        ("END MILL 4 FLUTE", False, None),
        ("END MILL R0.5", False, None),
        ("NOSE RADIUS 0.8", False, None),
        ("CUTTER 8 PLACES", False, None),
        ("CHAMFER MILL 10", False, None),
        ('1/2" DIA 90 DEG SPOT DRILL', True, None),
        ("T8 D=12. CR=0. TAPER=118DEG - ZMIN=-5. - DRILL", False, None),
        ("DIA 30 BOSS", False, None),
        ("CUMMINS D6.7", False, None),
        ("ITEM 10", False, None),
        ("10 MILL OR 12 MILL EM16 D12 EM", False, None),
    ],
)
def test_radius_of_a_comment(comment: str, inch: bool, radius: float | None) -> None:
    found = radius_in(comment, inch)
    assert found == (None if radius is None else pytest.approx(radius))


@pytest.mark.ci
@looped("tool", ["1", "01", "T1", "0" * 5000 + "1", "9" * 5000, "1" * 8, "1" * 9], one_in=2)
def test_a_list_of_tools_takes_numbers_of_any_length(tool: str) -> None:
    program = f"O1\n(T{tool} D=20.)\nG21 G98 G18\nT0101\n{FLAT_MM.format(80, 80)}{END}"
    report = report_of(program, "fanuc", job=ASKED)
    taken = [found for found in report.findings if found.rule == "radius-from-comment"]
    assert bool(taken) == (tool.lstrip("0") == "1")


HOSTILE = (
    "1",
    "1 ",
    "1/",
    ".",
    "1-",
    "D",
    "D ",
    "DIA",
    "R = ",
    "T0",
    "IO",
    "A-B, ",
    "POLARCHECK ",
    "<A",
    "::",
    "\\",
    '"',
    "\x1b",
)


@pytest.mark.nightly
@looped("machine", ["fanuc", "okuma-osp", "siemens-transmit"], one_in=14)
@looped("repeated", HOSTILE)
def test_hostile_comments_of_any_kind_are_checked_by_their_length(repeated: str, machine: str) -> None:
    """A check whose work grew with the square of these would not end while anybody waits."""
    comment = f"1{repeated * (100_000 // len(repeated))} X"
    form = f"; {comment}" if machine == "siemens-transmit" else f"({comment})"
    program = f"{form}\nG21 G98 G18\nT0101 {form}\n{FLAT_MM.format(80, 80)}{END}"
    assert report_of(program, machine, job=ASKED).verdict in ("pass", "unverified", "fail")


# ---- a comment that tells the cutter of a path of its center ----

ASKED = {"radius_from_comments": True}
INCH = "O1\nG20 G40 G97 G98 G18\nT0808 (3/4 DIA. CUTTER)\n"
MM = "O1\nG21 G40 G97 G98 G18\nT0303 (D=20. END MILL)\n"
#: A flat of 1 inch or 30 mm, from a start-up and to an offset cancel at given diameters.
FLAT_INCH = "G0 X{0} Z.1 C0\nG12.1\nG1 C.5 F50.\nG41 X2. F7.\nC-.5\nG40 X{1} F50.\nG13.1\n"
FLAT_MM = "G0 X{0} Z2. C0\nG12.1\nG1 C15. F500\nG41 X50. F200\nC-15.\nG40 X{1}\nG13.1\n"
END = "G0 Z50.\nM30\n"


def asked(program: str, *tools: str) -> FileReport:
    return report_of(program + END, "fanuc", *tools, job=ASKED)


def untaken(report: FileReport) -> list[tuple[str, int]]:
    """What is not evaluated of ramps."""
    return [(one.reason, one.blocks) for one in report.not_evaluated if one.rule == "start-up-shorter-than-radius"]


@pytest.mark.nightly
@looped(
    ("program", "taken", "offset"),
    [
        (INCH + FLAT_INCH.format("2.6", "2.6"), "0.375 inch", 8),
        (INCH + FLAT_INCH.format("2.4", "2.74"), "0.375 inch", 8),
        (MM + FLAT_MM.format("65.", "65."), "10 mm", 3),
        (MM + FLAT_MM.format("69.", "52."), "10 mm", 3),
    ],
    one_in=3,
)
def test_ramps_all_shorter_than_the_cutter_are_those_of_its_center(program: str, taken: str, offset: int) -> None:
    report = asked(program)
    assert said(report) == [(3, "radius-from-comment")]
    (note,) = report.findings
    assert note.severity == "note"
    assert note.values == {"offset": offset, "radius": 0}
    assert f"in place of {taken}" in note.message
    assert f"--tool {offset}:radius=" in note.message
    ((reason, blocks),) = untaken(report)
    assert f"R of offset {offset} is taken as 0" in reason
    assert blocks == 2
    assert report.verdict == "unverified"
    trace = trace_of(program + END, job=ASKED)
    assert set(trace.compensation.radius[trace.compensation.compensates]) == {0.0}
    assert not math.isnan(trace.offsets.cutter_diameter[trace.compensation.compensates][0]), "the cutter itself has one"
    # A radius of a job is believed.
    told = asked(program, f"{offset}:radius={taken.split()[0]}")
    (found,) = told.findings
    assert found.rule == "start-up-shorter-than-radius"
    assert "cancel-shorter-than-radius" in [follower.rule for follower in found.follows]
    assert untaken(told) == []


@pytest.mark.ci
@looped(
    ("program", "radius", "expected"),
    [
        # One ramp that is long enough for the cutter, and one that is not.
        (MM + FLAT_MM.format("70.", "69."), 10, [(9, "cancel-shorter-than-radius")]),
        (INCH + FLAT_INCH.format("2.74", "2.75"), 9.525, [(7, "start-up-shorter-than-radius")]),
        (MM + FLAT_MM.format("70.", "70."), 10, []),
    ],
)
def test_where_one_ramp_is_long_enough_the_other_is_a_fault(
    program: str, radius: float, expected: list[tuple[int, str]]
) -> None:
    report = asked(program)
    assert said(report) == [(3, "radius-from-comment"), *expected]
    assert report.findings[0].values["radius"] == radius
    assert untaken(report) == []


def test_each_section_is_judged_by_its_own_ramps() -> None:
    report = asked(MM + FLAT_MM.format("65.", "65.") + FLAT_MM.format("80.", "80."))
    assert said(report) == [(3, "radius-from-comment")]
    assert "but 0 in the polar mode of line 5" in report.findings[0].message
    assert [blocks for _, blocks in untaken(report)] == [2]
    # A section without ramps says nothing.
    plain = "G0 X80. C0\nG12.1\nG1 X50. F200\nC5.\nX80.\nG13.1\n"
    assert "in place of" in asked(MM + FLAT_MM.format("65.", "65.") + plain).findings[0].message
