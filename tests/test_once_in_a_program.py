"""One mistake that several sections repeat is one finding, with the lines of the others."""

from __future__ import annotations

import pytest
from cases import looped
from hexagon_program import CONTROLS, CUTTER, HEX, hexagon
from programs import report_of

_HEAD, _SECTION, _END = HEX.partition("G0 X60.")[0], HEX[HEX.index("G0 X60.") : HEX.index("G0 X100.")], "M5/M30"
#: Each with what is changed in every section, the rule, and what is told of the other two.
REPEATED = {
    "a point": (("X36. C0 F150", "X36 C0 F150"), "number-without-point", "; 2 more numbers have none"),
    "F": ((" F1000", ""), "feed-missing-in-polar", "; likewise in lines 23 and 38"),
    "the side": (("G42", "G41"), "side-of-compensation-mirrored", "; likewise in lines 25 and 40"),
    "feed per revolution": (
        ("G0 X60.", "G99 G0 X60."),
        "feed-per-revolution-in-polar",
        "; likewise in lines 23 and 38",
    ),
}
#: A G99 of mazak-eia is another code, and gsk-988 reads whole millimeters.
NOT_THERE = (("mazak-eia", "feed per revolution"), ("gsk-988", "a point"))


@pytest.mark.nightly
@looped(
    ("control", "name"),
    [(control, name) for control in CONTROLS for name in REPEATED if (control, name) not in NOT_THERE],
    one_in=2,
)
def test_a_mistake_of_three_sections_is_one_finding(control: str, name: str) -> None:
    (old, new), rule, told = REPEATED[name]
    section = _SECTION.replace(old, new)
    if name == "F":
        section = section.replace(" F200", "").replace(" F150", "")
    program = (_HEAD + section * 3 + _END).replace("/", "\n") + "\n"
    report = report_of(program, control, CUTTER)
    (found,) = [finding for finding in report.findings if finding.severity != "note"]
    assert (found.rule, told in found.message) == (rule, True), found.message


def test_a_silenced_number_stands_for_no_other() -> None:
    section = _SECTION.replace("X36. C0 F150", "X36 C0 F150")
    allowed = section.replace("F150", "F150 (POLARCHECK ALLOW NUMBER-WITHOUT-POINT MEANT SO)")
    program = (_HEAD + allowed + section * 2 + _END).replace("/", "\n") + "\n"
    report = report_of(program, "fanuc-30i", CUTTER)
    assert [(finding.rule, finding.line) for finding in report.findings] == [("number-without-point", 25)]


@pytest.mark.nightly
def test_a_cutter_too_large_for_ramps_and_an_arc_is_one_finding() -> None:
    """R 12 does not fit into R 4, nor into ramps of 10 mm; with a ramp of 3 mm that is told, too, since R 4 needs 4."""
    way = ("C0 F150/C10.392", "C0 F150/C2./G2 X34. C3.354 R4./G1 X36. C10.392")
    long = report_of(hexagon(way), "fanuc-30i", "1:radius=12,nose=0")
    (found,) = long.findings
    assert found.rule == "inside-arc-smaller-than-radius"
    assert {"start-up-shorter-than-radius", "cancel-shorter-than-radius"} <= {rule.rule for rule in found.follows}
    short = report_of(hexagon(way, ("G1 X56. F1000", "G1 X42. F1000")), "fanuc-30i", "1:radius=12,nose=0")
    assert {"start-up-shorter-than-radius", "inside-arc-smaller-than-radius"} <= {
        found.rule for found in short.findings
    }


@pytest.mark.nightly
@looped(
    ("change", "rule", "said"),
    [
        (("C20.785", "C-20,785"), "stray-character", "write -20.785"),
        (
            ("X-36. C10.392", "G3 X-36. C10.392 R30./C-9./G1"),
            "arc-without-center",
            ": G3 of line 13 is still in force, write G1",
        ),
        (("G12.1/", ""), "polar-never-entered", "write G12.1 before line 7, G1 X56. F1000"),
        (("G12.1/", "G40/M8/"), "polar-never-entered", "write G12.1 before line 9, G1 X56. F1000"),
        (
            ("G12.1/G1 X56. F1000/Z-4. F200/G42 X36. C0 F150", "G0 Z-4./G42/G1 X36. C0 F150"),
            "polar-never-entered",
            "write G12.1 before line 8, G42",
        ),
        (
            ("G12.1/G1 X56. F1000/Z-4. F200/G42 X36. C0", "G1 Z-4. F200/G42 G0 X40./G1 X36. C0"),
            "polar-never-entered",
            "write G12.1 before line 7, G1 Z-4. F200",
        ),
    ],
)
def test_what_is_to_be_written_and_where(change: tuple[str, str], rule: str, said: str) -> None:
    report = report_of(hexagon(change), "fanuc-30i", CUTTER)
    assert any(said in finding.message for finding in report.findings if finding.rule == rule), report.findings


@pytest.mark.nightly
@looped(
    ("changes", "rule", "line"),
    [
        ([("G40 X56./Z2. F1000/G13.1", "G13.1/G40 X56./Z2. F1000")], "polar-switched-in-offset-mode", 18),
        ([("G1 X56. F1000/Z-4. F200", "G1 Z-4. F200/X-56. F1000")], "uncompensated-cut-into-part", 9),
        ([("G1 X56. F1000/Z-4. F200", "G1 Z-4. F200/X-40. C5. F1000")], "uncompensated-cut-into-part", 9),
        ([("G1 X56. F1000", "G1 X-40. C5. F1000")], "c-feed-above-limit", 8),
        ([("G1 X56. F1000", "G1 X-56. F1000")], "path-through-center", 8),
        ([("G40 X56.", "G40 X-56. C1.")], "start-up-sweeps-contour", 18),
    ],
)
def test_a_lead_through_the_part_and_g13_1_before_g40_are_one_finding(
    changes: list[tuple[str, str]], rule: str, line: int
) -> None:
    report = report_of(hexagon(*changes), "fanuc-30i", CUTTER, changes={"limits": {"c_feed": 3600}})
    found = [finding for finding in report.findings if finding.severity != "note"]
    assert [(finding.rule, finding.line) for finding in found] == [(rule, line)]


@pytest.mark.ci
def test_a_high_f_before_a_ramp_through_a_corner_is_another_mistake() -> None:
    """A lead that is only too fast for its F does not explain a ramp that comes from the wrong side."""
    fast = ("G1 X56. F1000", "G1 X40. C-20. F9000/X56. C20. F1000")
    report = report_of(hexagon(fast), "fanuc-30i", CUTTER, changes={"limits": {"c_feed": 3600}})
    assert [finding.rule for finding in report.findings] == ["c-feed-above-limit"]
    swept = ("G42 X36. C0 F150", "G42 X36. C10.392 F150/C0")
    both = report_of(hexagon(fast, swept), "fanuc-30i", CUTTER, changes={"limits": {"c_feed": 3600}})
    assert "c-feed-above-limit" in {finding.rule for finding in both.findings}
    assert len(both.findings) > 1


@pytest.mark.ci
def test_a_missing_block_of_g40_behind_an_arc_is_one_finding() -> None:
    program = hexagon(("X36. C-10.392/C0/G40 X56./Z2.", "X36. C-10.392/G3 X33. C0 R20./Z2."))
    report = report_of(program, "fanuc-30i", CUTTER)
    rules = {finding.rule for finding in report.findings}
    assert "polar-switched-in-offset-mode" in rules
    assert "arc-off-polar-plane" not in rules


def test_g13_1_in_offset_mode_in_each_section_is_one_finding() -> None:
    section = _SECTION.replace("G40 X56.", "X56.")
    report = report_of((_HEAD + section * 3 + _END).replace("/", "\n") + "\n", "fanuc-30i", CUTTER)
    (found,) = (finding for finding in report.findings if finding.rule == "polar-switched-in-offset-mode")
    assert "; likewise in lines 35 and 50" in found.message, found.message


def test_without_g12_1_the_section_before_is_no_place_for_it() -> None:
    program = HEX.replace(
        "G13.1/G0 X100. Z50.",
        "G13.1/G1 X60. C0/X56./Z-4./G42 X36. F150 C0/C10.392/X0 C20.785/G40 X56./Z2./G13.1/G0 X100. Z50.",
    )
    report = report_of(program.replace("/", "\n"), "fanuc-30i", CUTTER)
    (found,) = (finding for finding in report.findings if finding.rule == "polar-never-entered")
    assert found.message.endswith("write G12.1 before line 21, G1 X60. C0")


#: A hexagon in increments and one in positions, on a control with G90 and G91.
_STEPS = "G91 C10.392/X-36. C10.392/X-36. C-10.392/C-20.784/X36. C-10.392/X36. C10.392/C10.392/"
_POSITIONS = HEX[HEX.index("C10.392") : HEX.index("G40 X56.")]


@pytest.mark.ci
@looped(
    ("path", "says"),
    [
        (_STEPS + "G40 X56./Z-8. F200/G42 X36. F150/" + _POSITIONS, "; G91 of line 11 is still in force: write G90"),
        (_STEPS + "G90 G40 X56./Z-8. F200/G42 X36. F150/" + _POSITIONS, ""),
    ],
)
def test_a_forgotten_g90(path: str, says: str) -> None:
    program = HEX.replace("G21 G98 G40", "G90 G21 G94 G40").replace(_POSITIONS, path)
    changes = {"control": {"g_code_system": "B"}}
    report = report_of(program.replace("/", "\n"), "fanuc-30i", CUTTER, changes=changes)
    assert bool(report.findings) == bool(says)
    assert any(says in finding.message for finding in report.findings) or not says


@pytest.mark.ci
def test_a_missing_line_behind_an_arc_is_written_with_its_code() -> None:
    program = (
        "O1/G21 G98 G40/T0101/G97 S3000 M13/G28 H0/G0 X80. Z2. C0/G12.1/G1 X70. F1000/Z-4. F200/G42 X36. F150/C14./"
        "G3 X28. C18. R4./G3 X-36. C14. R4./G1 C-14./G3 X-28. C-18. R4./G1 X28./G3 X36. C-14. R4./G1 C0/G40 X70./"
        "Z2. F1000/G13.1/G0 X100. Z50./M5/M30"
    )
    report = report_of(program.replace("/", "\n"), "fanuc-30i", CUTTER)
    messages = [one.message for finding in report.findings for one in (finding, *finding.follows)]
    assert any(
        "with G1 X-28. C18. in a block of its own before this one, it would" in message for message in messages
    ), messages


@pytest.mark.ci
@pytest.mark.parametrize("without_depth", range(4))
def test_one_of_four_pockets_that_is_cut_in_air_is_one_finding(without_depth: int) -> None:
    centers = ((40, 0), (0, 20), (-40, 0), (0, -20))
    pockets = "".join(
        f"G1 X{x}. C{c}. F1500/{'' if number == without_depth else 'Z-3.'} F60/G41 X{x + 12}. F120/G3 I-6. J0/"
        f"G1 G40 X{x}./Z2. F1500/"
        for number, (x, c) in enumerate(centers)
    )
    program = f"O1/G21 G98 G40/T0808/G97 S3000 M13/G28 H0/G0 X50. C0 Z2./G12.1/{pockets}G13.1/G0 X100. Z50./M5/M30"
    report = report_of(program.replace("/", "\n"), "fanuc-30i", "8:radius=3,nose=0")
    found = [finding for finding in report.findings if finding.severity != "note"]
    assert [finding.rule for finding in found] == ["cut-in-air"], found
    assert "at Z2 of line" in found[0].message
    assert "a Z word for the depth is missing" in found[0].message


@pytest.mark.ci
@pytest.mark.parametrize("lost", ["G1 X70. F1000", "G1 X70. F1000/Z-4. F200", "Z-4. F200"])
def test_the_first_blocks_of_a_section_that_are_lost_are_one_finding(lost: str) -> None:
    program = (
        "O1/G21 G98 G40/T0101/G97 S3000 M13/G28 H0/G0 X80. Z2. C0/G12.1/G1 X70. F1000/Z-4. F200/G42 X36. F150/C14./"
        "G3 X28. C18. R4./G1 X-28./G3 X-36. C14. R4./G1 C-14./G3 X-28. C-18. R4./G1 X28./G3 X36. C-14. R4./G1 C0/"
        "G40 X70./Z2. F1000/G13.1/G0 X100. Z50./M5/M30"
    )
    for text, count in ((program, 0), (program.replace(f"/{lost}/", "/"), 1)):
        report = report_of(text.replace("/", "\n"), "fanuc-30i", CUTTER)
        assert len([finding for finding in report.findings if finding.severity != "note"]) == count, report.findings
