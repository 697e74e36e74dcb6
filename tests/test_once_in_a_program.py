"""One mistake that several sections repeat is one finding, with the lines of the others."""

from __future__ import annotations

from cases import looped
from hexagon_program import CONTROLS, CUTTER, HEX
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
