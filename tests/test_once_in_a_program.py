"""One mistake that several sections repeat is one finding, with the lines of the others."""

from __future__ import annotations

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


@looped(
    ("control", "name"),
    [(control, name) for control in CONTROLS for name in REPEATED if (control, name) not in NOT_THERE],
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
    ],
)
def test_what_is_to_be_written_and_where(change: tuple[str, str], rule: str, said: str) -> None:
    report = report_of(hexagon(change), "fanuc-30i", CUTTER)
    assert any(said in finding.message for finding in report.findings if finding.rule == rule), report.findings
