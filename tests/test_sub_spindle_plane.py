"""A section on the sub-spindle is judged as far as the profile says how that is programmed, and never in silence."""

from __future__ import annotations

import pytest
from cases import looped
from programs import moves_of, report_of, said

from polarcheck.foundation.finding import FileReport

TOOL = "1:radius=4,nose=0"
CONTOUR = """G1 G42 X{0}. F200
{2}10.
G3 X{1}. {2}20. R10.
G1 X-{1}.
G3 X-{0}. {2}10. R10.
G1 {2}-20.
X{0}.
{2}0
G40 X80.
"""
DOOSAN = "O1\nG21 G40 G97 G98\nT0101\nM{}35\nG28 H0\nG0 X80. Z5.\nG0 C0\nG12.1\n{}G13.1\nM{}34\nM30\n"
HAAS = "O1\nG21 G40 G97 G98\n{}\nM5\nM154\nT0101\nG17\nP2500 M133\nG0 X80. C0\nG112\n{}G113\nG18\nM135\nM155\nM30\n"
MAZAK = "O1\nG40 G97 {}\nT0101\n{}\nM5\n{}\nG0 X80. Z5.\nG0 U0\n{}\n{}\n{}G13.1\nM302\nM30\n"


def contour(axis: str = "C", mirrored: bool = False) -> str:
    text = CONTOUR.format(*((40, 20) if axis == "C" else (20, 10)), axis)
    if not mirrored:
        return text
    swapped = text.replace(f"{axis}-", "@").replace(axis, f"{axis}-").replace("@", axis)
    return swapped.replace("G3", "G2").replace("G42", "G41")


def told(report: FileReport) -> list[str]:
    """What is said of its sides and axes; of depths nothing is judged on any sub-spindle."""
    reasons = [each.reason for each in report.not_evaluated if "sub-spindle" in each.reason]
    return [reason for reason in reasons if "its face" not in reason]


def test_depths_on_a_sub_spindle_are_not_judged_and_that_is_told_without_weight() -> None:
    report = report_of(DOOSAN.format("1", contour(), "1"), "doosan", TOOL)
    (entry,) = [entry for entry in report.not_evaluated if "its face" in entry.reason]
    assert entry.reason.endswith("is on the sub-spindle: what is above and below its face is not known")
    assert not entry.matters


@pytest.mark.nightly
@looped("mirrored", [False, True])
def test_where_the_profile_says_that_it_is_programmed_as_the_main_spindle_it_is_judged_whole(mirrored: bool) -> None:
    main, sub = (DOOSAN.format(of, contour(mirrored=mirrored), of) for of in ("", "1"))
    assert moves_of(sub, "doosan", TOOL).end.tolist() == moves_of(main, "doosan", TOOL).end.tolist()
    for program in (main, sub):
        report = report_of(program, "doosan", TOOL)
        assert (said(report), report.verdict, told(report)) == ([], "pass", [])
    wrong = report_of(sub.replace("G42", "G41@").replace("G41\n", "G42").replace("G41@", "G41"), "doosan", TOOL)
    assert bool(wrong.findings) == (not mirrored)


@looped(("machine", "code"), [("colchester", "M135"), ("takisawa", "M176"), ("doosan", "M135")])
def test_where_it_does_not_say_so_the_sides_are_not_judged_and_it_is_told(machine: str, code: str) -> None:
    program = DOOSAN.format("", contour(), "").replace("M35", code).replace("G42", "G41")
    changes = {"polar": {"sub_spindle_plane": "unknown"}}
    report = report_of(program, machine, TOOL, changes=changes, only=["polar", "compensation"])
    assert not report.findings
    assert report.verdict == "unverified"
    (reason,) = told(report)
    assert "the section of line 8 is on the sub-spindle" in reason
    assert "sub_spindle_plane" in reason
    assert len([entry for entry in report.not_evaluated if entry.matters]) == 1


@pytest.mark.nightly
def test_without_compensation_there_is_no_side_to_ask_for() -> None:
    plain = contour().replace("G42 ", "").replace("G40 ", "G1 ")
    program = DOOSAN.format("", plain, "").replace("M35", "M176").replace("M34", "M175")
    report = report_of(program, "takisawa", TOOL, changes={"limits": {"c_feed": 100}})
    assert "c-feed-above-limit" in {rule for _, rule in said(report)}
    assert not told(report)


@pytest.mark.nightly
@looped("between", ["", "M134\n"])
def test_the_main_spindle_is_judged_again_once_it_is_the_c_axis(between: str) -> None:
    first = DOOSAN.format("1", contour(), "1").removesuffix("M30\n").replace("M134\n", between)
    program = first + DOOSAN.format("", contour(), "").removeprefix("O1\n")
    changes = {"polar": {"sub_spindle_plane": "unknown"}}
    report = report_of(program, "doosan", TOOL, changes=changes)
    assert len(told(report)) == 1
    radii = [section.radius for section in report.polar_sections]
    assert radii == [None, 4.0]


@pytest.mark.nightly
@looped(
    ("swap", "judged"),
    [("G14", False), ("G14\nG15", True), ("G15", True), ("G14\nG15\nG14", False), ("N5 G14 M9", False)],
    one_in=3,
)
def test_swapped_spindles_of_a_haas_are_told_by_name(swap: str, judged: bool) -> None:
    report = report_of(HAAS.format(swap, contour("Y")), "haas-lathe", TOOL)
    assert not [found for found in report.findings if found.severity != "note"]
    assert bool(told(report)) != judged
    assert (report.verdict == "pass") == judged


@pytest.mark.nightly
@looped(
    ("machine", "feed", "engage", "plane", "on"),
    [
        ("mazak-quick-turn", "G98", "M300", "G91\nG17 XU\nG90", "G12.1"),
        ("mazak-quick-turn", "G98", "M300", "G17 UH", "G12.1"),
        ("mazak-quick-turn", "G98", "M8", "G17XU", "G12.1"),
        ("mazak-integrex", "G94 G90", "M300", "G17 XC", "G12.1 P2"),
        ("mazak-integrex", "G94 G90", "M300", "G17 XC", "G12.1"),
        ("mazak-eia", "G94 G90", "M300", "G17 XU", "G12.1 P2"),
    ],
)
def test_a_mazak_names_the_axes_of_its_sub_spindle_otherwise(
    machine: str, feed: str, engage: str, plane: str, on: str
) -> None:
    live = {"mazak-quick-turn": "M203 S3000", "mazak-integrex": "M3 S3000"}.get(machine, "M8")
    program = MAZAK.format(feed, engage, live, plane, on, contour("U"))
    if machine == "mazak-quick-turn":
        program = program.replace("G91\n", "").replace("\nG90", "")
    report = report_of(program, machine, TOOL)
    assert not [found for found in report.findings if found.severity != "note"], said(report)
    assert report.verdict == "unverified"
    (reason,) = told(report)
    assert "nothing of it is judged" in reason


@pytest.mark.nightly
@looped("on", ["G12.1", "G12.1 P2"])
def test_a_sub_spindle_of_a_mazak_with_the_usual_axes_is_followed_but_for_its_sides(on: str) -> None:
    program = MAZAK.format("G94 G90", "M300", "M3 S3000", "G17 XC", on, contour()).replace("U0", "C0")
    program = program.replace("M302", "M5\nM302")
    report = report_of(program, "mazak-integrex", TOOL)
    assert (said(report), report.verdict, len(told(report))) == ([], "unverified", 1)
    assert "on which side" in told(report)[0]
    plain = report_of(program.replace("G42 ", "").replace("G40 X", "G1 X"), "mazak-integrex", TOOL)
    assert (said(plain), plain.verdict) == ([], "pass")


def test_the_main_spindle_of_a_mazak_is_followed() -> None:
    program = MAZAK.format("G98", "M200", "M203 S3000", "G17 XC", "G12.1", contour())
    program = program.replace("U0", "C0").replace("M302", "M205\nM202")
    report = report_of(program, "mazak-quick-turn", TOOL)
    assert (said(report), report.verdict) == ([], "pass")
