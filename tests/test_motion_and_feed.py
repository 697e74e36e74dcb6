"""Arcs, feeds and the center of C beyond the examples of the pages: what gives way, and what is not evaluated."""

from __future__ import annotations

import re
from typing import Any

import pytest
from cases import looped
from programs import moves_of, report_of, said

from polarcheck.foundation.finding import FileReport

#: The coverage counts all of its cases: each is a way of its own through the package.
pytestmark = pytest.mark.one_in(1)

ENTRY = "O1 T0808\nG98 G0 X60. C0\nG12.1\n"


def report(program: str, *tools: str, name: str = "fanuc", **changes: dict[str, Any]) -> FileReport:
    return report_of(program, name, *tools, changes=changes, only=("feed", "motion"))


def reasons(found: FileReport) -> list[tuple[str, int]]:
    return [(entry.reason, entry.blocks) for entry in found.not_evaluated]


def test_an_arc_that_is_no_circle_has_no_rate_of_c() -> None:
    """R too small near the center: one finding, though C would be far too fast along any such arc."""
    found = report(ENTRY + "G1 X.2 C5. F1000\nG2 X.2 C-.1 R.5\n")
    assert said(found) == [(5, "arc-radius-too-small")]


def test_a_missing_c_is_not_taken_for_a_radius() -> None:
    """A quarter of a circle without its C closes by chance with X as a radius."""
    quarter = "G1 X40. C10. F200\nG3 X24. I-8. J6.\n"
    assert said(report(ENTRY + quarter)) == [(5, "arc-end-off-circle")]
    twice = report(ENTRY + quarter + "G1 X40. C10.\nG3 X24. I-8. J6.\n")
    assert said(twice) == [(5, "arc-end-off-circle")]
    assert twice.findings[0].message.endswith("; likewise in line 7")


def test_a_stop_at_the_center_is_reported_once() -> None:
    """The way to the center is named, not the way back; and so where the start of that way is not known."""
    assert said(report(ENTRY + "G1 X0 F200\nX60.\n")) == [(4, "path-through-center")]
    assert said(report("G12.1\nG1 X0 C0 F200\nX60.\n")) == [(2, "path-through-center")]
    assert said(report("O1\nG98 G0 X0 C0\nG12.1\nG1 X60. F200\nC5.\n")) == [(4, "path-through-center")]


ALONG_Z = "G1 X40. C16. F200\nZ-8.\n{}\nG1 X60.\n"
INCH_ALONG_Z = "G20\nG1 X2. C.8 F8.\nZ-.3\n{}\nG1 X3.\n"


ROUND = "G1 X50. F200\nZ-2.\nX40.\nG3 X-40. C0 R20.\n{}\nG3 X40. C0 R20.\n{}\nG1 X50.\nZ1.\n"


@looped(
    ("machine", "on", "off", "axis", "scale"),
    [
        ("fanuc", "G12.1", "G13.1", "C", 1),
        ("doosan", "G12.1", "G13.1", "C", 10),
        ("haas-lathe", "G112", "G113", "Y", 1),
    ],
)
def test_a_line_along_z_is_advised_where_it_leaves_no_contour_at_two_depths(
    machine: str, on: str, off: str, axis: str, scale: int
) -> None:
    for blocks, is_advised in ((("Z-5.", ""), False), (("Z-1.", ""), False), (("", "Z1."), True), (("Z1.", ""), True)):
        for sense in ("G3", "G2"):
            path = ROUND.format(*blocks).replace("G3", sense).replace("C", axis)
            if scale != 1:
                path = re.sub(r"([XZCYR])(-?[\d.]+)", lambda word: f"{word[1]}{float(word[2]) / scale}", path)
            text = f"{'G20' if scale != 1 else 'G21'} G98\nG0 X50. Z1. C0\n{on}\n{path}{off}\nM30\n"
            found = report_of(text, machine).findings
            (finding,) = (finding for finding in found if finding.rule == "arc-off-polar-plane")
            assert f": {sense} of line" in finding.message
            assert finding.message.endswith("is still in force" + ", write G1" * is_advised)


@pytest.mark.nightly
@looped(
    ("program", "arc"),
    [
        # 16 mm along C, which 5 mm do not reach: an arc of C and Z.
        (ALONG_Z, "G2 C0. Z-10. R5."),
        (ALONG_Z, "G3 X20. Z-10. R4."),
        (ALONG_Z, "G2 X30. W-2. R-2."),
        (ALONG_Z, "G2 H-16. Z-10. J-5."),
        (ALONG_Z, "G2 X36. Z-10. I-2. K0."),
        (ALONG_Z, "G3 X36. Z-10. I-2. K-2."),
        (ALONG_Z, "G3 X36. Z-10. K-2."),
        (ALONG_Z, "G2 C0. Z-10."),
        # C stays: by R that is no arc of the plane.
        (ALONG_Z, "G2 C16. Z-10. R2."),
        (INCH_ALONG_Z, "G2 C0. Z-.4 R.2"),
        (INCH_ALONG_Z, "G3 X1.2 Z-.4 R.1"),
    ],
)
def test_an_arc_of_z_and_one_axis_is_an_arc_of_another_plane(program: str, arc: str) -> None:
    found = report(ENTRY + program.format(arc))
    (line,) = (number for number, text in enumerate((ENTRY + program.format(arc)).split("\n"), 1) if text == arc)
    assert said(found) == [(line, "arc-off-polar-plane")]
    assert found.findings[0].alarm == "PS0021"


@pytest.mark.ci
@looped(
    "arc", ["G2 C0. Z-10. R8.", "G2 C0. Z-10. R20.", "G2 C0. Z-10. J-8.", "G3 X20. Z-10. R5.", "G2 C0. W-2. I0 J-8."]
)
def test_an_arc_whose_other_axis_stays_is_a_helix(arc: str) -> None:
    assert said(report(ENTRY + ALONG_Z.format(arc))) == [(6, "helical-arc-in-polar")]


def test_a_helix_of_both_axes_that_is_no_circle_is_said_to_be_none() -> None:
    arc = "G2 X30. C0. Z-10. R5."
    assert said(report(ENTRY + ALONG_Z.format(arc))) == [(6, "arc-radius-too-small"), (6, "helical-arc-in-polar")]


def test_helical_arcs_are_errors_where_the_builder_forbids_them() -> None:
    program = ENTRY + "G1 X40. C10. F5.\nG3 X20. C20. R10. Z-1.\n"
    severity = {name: report(program, name=name).findings[-1].severity for name in ("fanuc", "turning-center")}
    assert severity == {"fanuc": "warning", "turning-center": "error"}


@looped(
    ("program", "texts"),
    [
        ("G20 G98 G0 X2.5 C0\nG12.1\nG1 C1\n", ["C1 has no decimal point: the control takes it as 0.0001 inch"]),
        ("G98 G0 X60. C5\nG12.1\n", ["C5 has no decimal point: the control takes it as 0.005 deg"]),
        (
            "G98 G0 X60. C0\nG12.1\nG1 C1 F200\nX40\nX50.5 C3\n",
            ["C1 has no decimal point: the control takes it as 0.001 mm; 2 more numbers have none"],
        ),
        (
            "G98 G0 X60000 C0\nG12.1\nG1 C1000 F200\n",
            [
                "X60000 has no decimal point: the control takes it as 60 mm; the whole program is read in least "
                "increments, 2 of its coordinates have no point"
            ],
        ),
        (
            "G98 G1 X60 F200\nG0 X60. C0\nG12.1\nG1 X50.\n",
            ["X60 has no decimal point: the control takes it as 0.06 mm"],
        ),
    ],
)
def test_number_without_point_says_what_it_is_taken_as(program: str, texts: list[str]) -> None:
    found = report(program).findings
    assert [finding.message for finding in found if finding.rule == "number-without-point"] == texts


POINTED = "{units}G98 G0 X60. C0\n{before}G12.1\nG1 X40. F20.\nC10.\n{inside}C-10.\nX60.\nG13.1\n{behind}"
WHOLE = POINTED.replace(". ", " ").replace(".\n", "\n").replace("F20\n", "F20.\n")


def places(program: str) -> list[tuple[complex, ...]]:
    """Where the moves of the tool center begin and end."""
    moves = moves_of(program)
    return list(zip(moves.start.tolist(), moves.end.tolist(), strict=True))


@pytest.mark.nightly
@looped("base", [POINTED, WHOLE], ids=["with points", "without"], one_in=20)
@looped("units", ["", "G20 "], ids=["mm", "inch"])
@looped("place", ["before", "inside", "behind"])
@looped(
    "frame",
    ["{}", "O1\n{}M30\n", "O1\nM98 P2\nM30\nO2\n{}M99\n", "O1\nG0 X60000\nZ50000\nZ-2000\nM30\nO2\n{}M30\n"],
    ids=["excerpt", "program", "called", "second program"],
)
def test_one_large_number_without_a_point_is_a_slip(base: str, units: str, place: str, frame: str) -> None:
    """It was taken for a sign that all numbers count least increments: all shrank to a thousandth, without a word."""
    without = dict.fromkeys(("before", "inside", "behind"), "M8\n") | {"units": units}
    clean, slip = frame.format(base.format(**without)), frame.format(base.format(**without | {place: "Z1000\n"}))
    assert places(slip) == places(clean)
    told, before = ({(one.line, one.severity, one.message) for one in report(text).findings} for text in (slip, clean))
    if base == WHOLE:
        # All numbers but F lack their points, which is one finding at the first of the section: it counts one more.
        [(line, severity, message)] = before - told
        assert "; 4 more numbers have none" in message
        assert told - before == {(line, severity, message.replace("; 4 more", "; 5 more"))}
        return
    takes = f"the control takes it as {'0.1 inch' if units else '1 mm'}"
    line = slip.split("\n").index("Z1000") + 1
    assert told - before == {(line, "warning", f"Z1000 has no decimal point: {takes}")}


def test_a_word_in_a_loop_is_reported_once() -> None:
    program = ENTRY + "#1=0\nWHILE[#1LT3]DO1\nG1 X40. C5 F200\nC-5.\nX50.\n#1=#1+1\nEND1\nG13.1\nM30\n"
    assert said(report(program)) == [(6, "number-without-point")]


LIMIT = "FANUC lathe control gives no limit of the C axis; highest rate found {} deg/min, line {}"
REMEDY = ": give the lathe's own, --set limits.c_feed=..."


def test_the_highest_rate_is_told_where_there_is_nothing_to_compare_it_with() -> None:
    program = ENTRY + "G1 C10. F1000\nX-60.\nC-10.\n"
    assert reasons(report(program)) == [(LIMIT.format(5730, 5) + REMEDY, 3)]
    assert reasons(report(program, limits={"c_feed": 3600})) == []
    inch = "O1 T0808\nG20 G98 G0 X2.4 C0\nG12.1\nG1 C.1 F10.\nX-2.4\n"
    assert reasons(report(inch)) == [(LIMIT.format(5730, 5) + REMEDY, 2)]


@pytest.mark.ci
@looped("name", ["fanuc", "gsk-988", "turning-center"], one_in=3)
def test_a_rate_that_every_c_axis_manages_needs_no_limit(name: str) -> None:
    """57.3 deg is a radian: with F628.3 at 10 mm from the center C turns at 3,600 deg/min."""
    program = "O1\nG21 G98 G0 X60. C0\nG12.1\nG1 C10. F{}\nX-60.\n"
    needs = [report_of(program.format(feed), name).not_evaluated for feed in (100, 628.3, 628.4)]
    assert [len(entries) for entries in needs] == [0, 0, 1]
    assert needs[2][0].reason.endswith("highest rate found 3600 deg/min, line 5" + REMEDY)
    assert report_of(program.format(628.4), name, changes={"limits": {"c_feed_harmless": 4000}}).not_evaluated == []


def test_why_the_rate_of_c_is_not_known() -> None:
    """The radius, the feed, the position: each with what to do about it; nothing where a finding says it already."""
    limits = {"c_feed": 3600}
    compensated = ENTRY + "G1 C10. F200\nG41 X40.\nC-10.\nG40 X60.\n"
    text = "no radius for T0808: give --tool 8:radius=... or [tools.8] radius in polarcheck.toml"
    assert reasons(report(compensated, limits=limits)) == [(text, 3)]
    assert reasons(report(compensated, "8:radius=4", limits=limits)) == []
    per_revolution = report(ENTRY + "G1 G99 C10. F.2\n", limits=limits)
    assert reasons(per_revolution) == [
        ("the feed is not known: F is per revolution of a spindle; write feed per minute before it, G98", 1)
    ]
    excerpt = report("G12.1\nG1 X40. C10.\nC5.\n", limits=limits)
    assert said(excerpt) == []
    assert reasons(excerpt) == [
        ("the position is not known: X was not programmed before the polar mode; write G0 X... before it", 1),
        ("the feed is not known: no F is in force; write one before the cutting move", 1),
    ]
    called = reasons(report("G12.1\nG1 G42 X40. C10. F200\nC5.\nG40 X60.\nG13.1\nM99\n", limits=limits))
    assert [reason for reason, _ in called] == [
        "the position is not known: X was not programmed before the polar mode; check the program that calls this one, "
        "or write G0 X... before it",
        "no radius: no tool offset is in force; check the program that calls this one, or call one before the polar "
        "mode, as in T0808",
    ]
    missing = report(ENTRY + "G1 C10.\n", limits=limits)
    assert (said(missing), reasons(missing)) == ([(4, "feed-missing-in-polar")], [])


def test_feed_of_the_mode_is_per_minute_where_the_control_takes_nothing_else() -> None:
    program = "O1\nG99 G0 X60. C0\nG1 Z-5. F.2\nG12.1\nX4. C5. F500\nC-5.\nG13.1\n"
    changes: dict[str, Any] = {"limits": {"c_feed": 3600}, "feed": {"carried_into_polar": "per-minute-only"}}
    assert said(report(program, **changes)) == [(6, "c-feed-above-limit")]


def test_travel_in_the_mode_is_the_distance_of_the_tool_center() -> None:
    """Compensation counts, and one way out is one finding."""
    program = ENTRY + "G1 C20. F200\nG41 X50.\nC-20.\nX-50.\nG40 C-60.\n"
    limits = {"x_maximum": 37}
    assert said(report(program, "8:radius=4", limits=limits)) == [(6, "travel-limit")]
    assert said(report(program, "8:radius=0", limits=limits)) == [(8, "travel-limit")]
    assert [blocks for _, blocks in reasons(report(program, limits=limits | {"c_feed": 9000}))] == [4, 4]


@looped("across", [1.6, 8])
def test_degrees_are_seen_on_a_thin_pin_too(across: float) -> None:
    """Within 0.8 mm of the center, and within 4 mm."""
    program = f"G98 G0 X{across} C0\nG12.1\nG1 X{across} F200\nC45.\nC90.\nC135.\nX{across}\nG13.1\n"
    (finding,) = report_of(program, "fanuc", "1:radius=1", only=["degrees-in-polar"]).findings
    assert f"lies within {across / 2:g} mm of the center" in finding.message
