"""What a message says to write leads to the block that is wrong: single slips, and what may be known of them."""

from __future__ import annotations

import pytest
from cases import looped
from programs import report_of

HEAD = "O1 / T0101 / G98 G0 X70. Z2. C0 / G12.1 / G1 X60. F1500 / Z-5. / "
RAMP = "G42 X40. C0 F200 / "
SQUARE = "C20. / X-40. / C-20. / X40. / C0 / "
END = "G40 X60. F1500 / Z2. / G13.1 / M30"
SOUND = HEAD + RAMP + SQUARE + END
HEXAGON = "C10.392 / X0 C20.785 / X-36. C10.392 / C-10.392 / X0 C-20.785 / X36. C-10.392 / C0 / "


def messages(program: str, machine: str = "fanuc-30i", tool: str = "1:radius=4", **more: object) -> dict[str, str]:
    """What is reported by rule, above a note; the first of each."""
    report = report_of(program.replace(" / ", "\n") + "\n", machine, tool, **more)  # type: ignore[arg-type]
    findings = [finding for finding in report.findings if finding.severity != "note"]
    return {finding.rule: f"{finding.line}: {finding.message}" for finding in reversed(findings)}


def only(program: str, machine: str = "fanuc-30i", tool: str = "1:radius=4", **more: object) -> str:
    """The one message of a program."""
    (message,) = messages(program, machine, tool, **more).values()
    return message


@pytest.mark.nightly
@looped(
    ("old", "new", "says"),
    [
        # A closed contour: its start may be wrong as well as its end.
        (RAMP, "G42 X40. C2. F200 / ", "12: the contour ends at X40 C0, 2 mm before it is closed: write X40 C2 here"),
        (RAMP, "G42 X40. C1.5 F200 / ", "write X40 C1.5 here, or X40 C0 in line 7"),
        ("C0 / G40", "C-3. / G40", "write X40 C0 here, or X40 C-3 in line 7"),
        # A start-up that moves nowhere: the next block is the ramp.
        ("G1 X60. F1500", "G1 X40. F1500", "; G42 of line 7 moves nowhere, so that this block is the ramp"),
        # G40 a block too early.
        ("C20. / X-40.", "G40 C20. / X-40.", "is left by G40 of line 13, so delete the earlier one"),
        ("C0 / G40 X60.", "C0 / X60.", "15: G13.1 while G42 is in force"),
        # A block that moves nowhere uses up what the control reads ahead.
        ("X-40. / C-20.", "X-40. / X-40. / C-20.", "10: this block moves nowhere, its point is"),
        # F of a turning tool, written in the ramp.
        ("F200", "F.1", "0.1 mm/min here, by F.1 of line 7: this block alone takes"),
    ], one_in=4,
)  # fmt: skip
def test_one_slip(old: str, new: str, says: str) -> None:
    assert old in SOUND
    program, machine = SOUND.replace(old, new), "fanuc-30i"
    if "this block moves nowhere" in says:
        program, machine = program.replace("G12.1", "G112").replace("G13.1", "G113"), "lsis"
    assert says in only(program, machine)


@pytest.mark.ci
@looped(
    ("head", "says"),
    [
        ("G99", "G99 of line 2 is in force: write G98 in its place, or behind it before the polar mode"),
        ("G99 / M8", "G99 of line 2 is in force"),
        ("G98 / G99", "G99 of line 3 is in force"),
    ],
)
def test_feed_per_revolution(head: str, says: str) -> None:
    found = messages(SOUND.replace("O1 / ", f"O1 / {head} / ").replace("G98 G0", "G0"))
    assert says in found["feed-per-revolution-in-polar"]


POCKET = (
    "O1 / T0101{} / G98 G0 X8. Z2. C0 / G12.1 / G1 Z-5. F100 / G41 X30. F200 / C10. / X-30. / C-10. / X30. / C0 / "
    "G40 X8. F1500 / {} / G13.1 / {} / M30"
)


@pytest.mark.ci
@looped(
    ("retract", "home", "says"),
    [
        ("Z-2.", "G0 X130. Z80.", "up from Z-2 of line 13"),
        ("M9", "G0 X130. Z80.", "up from Z-5 of line 5"),
        ("Z-.2", "G0 X99. Z50.", "up from Z-0.2 of line 13"),
    ],
)
def test_the_last_z_of_a_way_through_the_part(retract: str, home: str, says: str) -> None:
    assert says in messages(POCKET.format("", retract, home))["rapid-through-part"]


@pytest.mark.ci
@looped(
    ("comment", "job", "says"),
    [
        (" (D16)", {}, "R 4 mm is given for offset 1, the comment tells 8 mm: D16; measure the cutter, and"),
        (" (D4 END MILL)", {}, "R may be given as the diameter: measure the cutter"),
        (" (D.315 EM)", {}, "in inch the comment fits: G20 is missing"),
    ],
)  # fmt: skip
def test_the_other_cutter_in_a_pocket(comment: str, job: dict[str, object], says: str) -> None:
    found = messages(POCKET.format(comment, "Z2.", "G0 Z50."), job=job)
    assert list(found) == ["radius-contradicts-comment"]
    assert says in found["radius-contradicts-comment"]


def test_the_offset_of_the_other_cutter() -> None:
    job = {"tools": {"1": {"radius": 4}, "5": {"radius": 8}}}
    report = report_of(
        POCKET.format(" (D8 EM)", "Z2.", "G0 Z50.").replace("T0101", "T0105").replace(" / ", "\n"), "fanuc-30i", job=job
    )
    found = next(one.message for one in report.findings if one.rule == "radius-contradicts-comment")
    assert found.endswith("offset 1 has the R of the comment")


@looped("lead", ["X4. C-5.", "X-6. C-4.", "X.8 C-6."])
def test_a_way_that_strays_to_the_center_is_no_matter_of_f(lead: str) -> None:
    program = HEAD.replace("X60. F1500", "C-1. F300") + f"{lead} F90. / G42 X40. C-2. / " + SQUARE + END
    report = report_of(
        program.replace(" / ", "\n"),
        "fanuc-30i",
        "1:radius=4",
        changes={"limits": {"c_feed": 600}},
        only=["c-feed-above-limit"],
    )
    [found] = [finding for finding in report.findings if "F90." in finding.message]
    assert "the contour of this section lies farther out: look for a wrong coordinate" in found.message
    assert found.fix is None


@pytest.mark.nightly
@looped(
    ("behind", "says"),
    [
        ("M39", "write M35 or M5 on the retract, in place of M39 of line 18 if that is meant for it"),
        ("M8", "write M35 or M5 on the retract"),
        ("", "write M35 or M5 on the retract"),
    ],
)
def test_what_stops_the_live_tool(behind: str, says: str) -> None:
    program = SOUND.replace("G98 G0", "G97 S1000 M33 / G98 G0").replace("M30", f"G0 Z50. / {behind} / T0202 / M30")
    assert messages(program, "turning-center")["live-tool-never-stopped"].endswith(says)


@pytest.mark.nightly
@looped("late", ["T0202 / M35", "T0202 M35", "T0202 / G0 X99. / M35"])
def test_the_live_tool_is_stopped_too_late(late: str) -> None:
    program = SOUND.replace("G98 G0", "G97 S1000 M33 / G98 G0").replace("M30", f"G0 Z50. / {late} / M30")
    found = messages(program, "turning-center").get("live-tool-never-stopped", "write it before the tool change")
    assert found.endswith("write it before the tool change")


@looped("block", ["G0 X-40.", "G0 C-20.", "G00 C20."])
def test_g0_in_a_contour_is_g1_with_its_f(block: str) -> None:
    word = block.split()[1]
    program = (HEAD + RAMP + SQUARE).replace(f"{word} / ", f"{block} / G1 ", 1) + END
    report = report_of(program.replace(" / ", "\n"), "fanuc-30i", "1:radius=4", only=["rapid-in-polar"])
    found = report.findings[0]
    assert found.message.endswith("this block lies in a contour with G42: write G1 and leave F as it is")
    assert found.fix is not None
    assert [edit.text for edit in found.fix.edits] == ["G01" if "G00" in block else "G1"]


@pytest.mark.nightly
@looped(("machine", "axis"), [("fanuc-30i", "C"), ("haas-lathe", "Y"), ("okuma-osp", "Y")])
def test_an_angle_among_the_points_of_a_hexagon(machine: str, axis: str) -> None:
    on, off = {"fanuc-30i": ("G12.1", "G13.1"), "haas-lathe": ("G112", "G113"), "okuma-osp": ("G137 C0", "G136")}[
        machine
    ]
    scale = 1 if machine == "fanuc-30i" else 2
    contour = "".join(
        f"X{x / scale:g} {axis}{c} / "
        for x, c in ((36, 10.392), (0, 20.785), (-36, "60."), (-36, -10.392), (0, -20.785), (36, -10.392), (36, 0))
    )
    line = "G101" if machine == "okuma-osp" else "G1"
    program = f"O1 / T0101 / G98 G94 G0 X80. Z2. C0 / {on} / {line} Z-5. F200 / G42 X{36 / scale:g} {axis}0 / {contour}"
    program = (
        program.replace("G98 G94", "G98" if machine != "okuma-osp" else "G94")
        + f"G40 X{70 / scale:g} / Z2. / {off} / M30"
    )
    report = report_of(program.replace(" / ", "\n"), machine, "1:radius=4", only=["nearly-regular-contour"])
    [finding] = report.findings
    assert (
        f"{axis}60. does not fit the rest of the contour, it looks like an angle: with {axis}10.392" in finding.message
    )


@pytest.mark.nightly
@looped(("tool", "line"), [("T0105", 2), ("T0105 (EM)", 2), ("M8 / T0105", 3)])
def test_a_ramp_that_is_too_short_names_the_offset_of_another_tool(tool: str, line: int) -> None:
    found = messages(SOUND.replace("T0101", tool).replace("G1 X60.", "G1 X52."), tool="5:radius=8")
    assert f"with R 8 mm of T0105 in line {line} it needs" in found["start-up-shorter-than-radius"]


@pytest.mark.nightly
def test_a_ramp_that_would_be_long_enough_in_inch() -> None:
    program = SOUND.replace("X60.", "X2.").replace("X40.", "X1.5").replace("X-40.", "X-1.5").replace("20.", ".75")
    found = messages(program, tool="1:radius=3.175")["start-up-shorter-than-radius"]
    told = "; neither G20 nor G21 stands above it: in inch it would be long enough; it begins at X2 C0 of line 5"
    assert found.endswith(told)
    found = messages(program.replace("O1 / ", "O1 / G21 / "), tool="1:radius=3.175")["start-up-shorter-than-radius"]
    assert "G20" not in found


def test_a_mode_that_is_left_and_entered_again() -> None:
    program = SOUND.replace("C0 / G40 X60.", "C4. / G40 X60. / G13.1 / G12.1 / G1 X70.")
    program = program.replace("Z2. / G13.1 / M30", "G42 X40. F200 / " + SQUARE + "G40 X60. / Z2. / G13.1 / M30")
    found = messages(program)["c-elsewhere-at-entry"]
    assert "nothing moves between G13.1 of line 14 and G12.1: delete both, or write C with the approach" in found


@pytest.mark.ci
@looped(
    ("arc", "says"),
    [
        ("G3 X20. C20. R10. / G0 X0 C30. R10.", "and R belongs to an arc: write G3 and leave F as it is"),
        ("G0 X20. C20. R10.", "and R belongs to an arc: write G2 or G3 and leave F as it is"),
        ("G0 X20. C20. I-10. J0", "and I belongs to an arc: write G2 or G3 and leave F as it is"),
    ],
)
def test_g0_beside_words_of_an_arc_is_an_arc(arc: str, says: str) -> None:
    program = HEAD + RAMP + f"C10. / {arc} / G1 X-40. / C-20. / X40. / C0 / " + END
    report = report_of(program.replace(" / ", "\n"), "fanuc-30i", "1:radius=4", only=["rapid-in-polar"])
    [finding] = report.findings
    assert finding.message.endswith(says)
    assert finding.fix is None
