"""Angles in the mode, and what goes wrong around it: in programs that are sound but for one thing."""

from __future__ import annotations

import pytest
from cases import looped
from programs import report_of

MM = "O1\nG21 G40 G97 G98 G18\nT0101\n"
INCH = MM.replace("G21", "G20")


def found(blocks: str, machine: str = "fanuc", *tools: str, head: str = MM) -> list[tuple[str, str, str]]:
    """The block, the rule and the message of each finding; `/` separates blocks, which stand behind the head."""
    program = f"{head}{blocks}/M30\n".replace("/", "\n")
    return [(finding.block, finding.rule, finding.message) for finding in report_of(program, machine, *tools).findings]


def said(blocks: str, machine: str = "fanuc", *tools: str, head: str = MM) -> list[tuple[str, str]]:
    return [(block, rule) for block, rule, _ in found(blocks, machine, *tools, head=head)]


TURN = "G0 X50. Z2. C0/G12.1/G1 X40. F200./{}/X50./G13.1"


@pytest.mark.nightly
@looped(
    ("steps", "head"),
    [
        ("C72./C144./C216./C288./C360.", MM),
        ("C72./C144./C216./C288./C360.", INCH),
        ("C-50./C-110./C-250./C-360.", MM),
        ("H72./H72./H72./H72./H72.", MM),
        ("C36./C72./C108./C144./C180.", MM),
        ("/".join(f"X{40 + step % 2}. C{step * 10}." for step in range(1, 721)), MM),
        ("/".join(f"C{step / 2}" for step in range(1, 721)), MM),
        ("#1=5./WHILE[#1LE360.]DO1/C#1/#1=#1+5./END1", MM),
    ],
    one_in=3,
)
def test_a_steady_way_to_360_is_an_angle(steps: str, head: str) -> None:
    assert [rule for _, rule in said(TURN.format(steps), head=head)] == ["degrees-in-polar"]


@pytest.mark.ci
@looped(
    "steps",
    [
        # A flat, in steps.
        "/".join(f"C{length}." for length in range(-20, 21, 4)),
        # The outer part of the section reaches as far.
        "X500./C60./C120./C180./X40./C0",
    ],
)
def test_a_flank_is_no_angle(steps: str) -> None:
    assert said(TURN.format(steps)) == []


def test_a_drilling_cycle_says_that_its_c_is_an_angle_again() -> None:
    blocks = "G0 X50. Z2. C0/G12.1/G1 X45. F200/{} X40. C90. Z-10. R2. F100/C180./G80/G13.1"
    for cycle in ("G83", "G81"):
        [(_, rule, message)] = found(blocks.format(cycle))
        assert (rule, message.partition(";")[2]) == (
            "code-not-allowed-in-polar",
            " write it before G12.1 or after G13.1, where its C is an angle again",
        )
    [(_, _, message)] = found(TURN.format("G97 S2000"))
    assert message.endswith("after G13.1")


# ---- a mode that was never entered ----

NEVER = "G0 X50. Z2. C0/{}/G1 C-10. F500./G42 X40./C10./G40 X50./{}"


@looped(
    ("before", "after", "machine"),
    [
        ("M5", "G13.1", "fanuc"),
        ("M5", "G113", "fanuc-16i"),
        ("M5", "G40 G13.1", "fanuc"),
        # The section before is over, and a G13.1 for safety begins none.
        ("G13.1", "G13.1", "fanuc-30i"),
        ("G12.1/G1 X40. F200./C10./X50./G13.1/G0 X50. C0", "G13.1", "fanuc"),
    ],
)
def test_the_end_of_a_mode_that_was_never_entered(before: str, after: str, machine: str) -> None:
    [(block, rule, message)] = found(NEVER.format(before, after), machine, "1:radius=4")
    assert (block, rule) == (after, "polar-never-entered")
    assert f"; write {'G112' if after == 'G113' else 'G12.1'} before line " in message
    assert message.endswith(", G1 C-10. F500.")


def test_it_names_the_first_line_that_turns() -> None:
    [(_, _, message)] = found(NEVER.format("M5", "G13.1"), "fanuc", "1:radius=4")
    assert "from line 8 on C moves" in message


def test_the_virtual_axis_is_that_of_the_machine() -> None:
    blocks = "M154/M133 P500/G17/G0 X2. Y0/G1 G41 X1. F10./Y.5/Y-.5/G40 X2./G113"
    report = said(blocks, "haas-lathe", "1:radius=.1", head=INCH)
    assert report == [("G113", "polar-never-entered")]


@pytest.mark.ci
@looped(
    ("blocks", "head"),
    [
        # For safety, at the head, after a contour of turning, and after C has moved without compensation.
        ("G40 G13.1/G0 X50. Z2.", MM),
        ("G0 X50. Z2./G1 G42 X40. F200./Z-10./G40 X50./G40 G13.1", MM),
        ("G0 X50. Z2. C0/G1 C90. F200./G40 G13.1", MM),
        # The contour was of another tool.
        ("G0 X50. Z2. C0/G1 G42 X40. F200./C10./G40 X50./T0202/G40 G13.1", MM),
        # G12.1 may stand in what is not shown.
        ("G1 G42 X40. F200./C10./G40 X50./G13.1", ""),
        ("M98 P9000/G1 G42 X40. F200./C10./G40 X50./G13.1", MM),
        # On a cylinder.
        ("G0 X50. Z2. C0/G7.1 C25./G1 G42 Z-5. F200./C90./G40 Z2./G7.1 C0/G13.1", MM),
    ],
)
def test_what_needs_no_entry(blocks: str, head: str) -> None:
    assert "polar-never-entered" not in [rule for _, rule in said(blocks, head=head)]


# ---- F without a mode of feed ----

FLAT = "G0 X50. Z2. C0/G12.1/G1 X40. {}/C10./C-10./X50./G13.1"


@pytest.mark.nightly
@looped(
    ("feed", "head", "machine"),
    [
        ("F200", MM, "fanuc"),
        ("F5.", MM, "fanuc-16i"),
        ("F10.", INCH, "fanuc"),
        ("F.2", INCH, "fanuc-30i"),
        ("F200", MM, "siemens-iso"),
        ("F120", MM, "doosan"),
    ],
    one_in=3,
)
def test_f_of_which_nobody_knows_what_it_means(feed: str, head: str, machine: str) -> None:
    without = head.replace("G98 ", "")
    assert said(FLAT.format(feed), machine, head=without).count((f"G1 X40. {feed}", "feed-mode-unknown")) == 1
    per_minute = head if machine != "siemens-iso" else head.replace("G98", "G94")
    assert "feed-mode-unknown" not in [rule for _, rule in said(FLAT.format(feed), machine, head=per_minute)]


@pytest.mark.ci
@looped(
    ("feed", "head", "machine"),
    [
        ("F.2", MM, "fanuc"),
        ("F4.9", MM, "fanuc"),
        ("F.19", INCH, "fanuc"),
        ("F200", MM, "mitsubishi-m700"),
        ("F200", MM, "citizen"),
        # The manual's own examples have none.
        ("F200", MM, "gsk-988"),
        # An excerpt, and feed per minute of another G-code system.
        ("F200", "G21 G40\nT0101\n", "fanuc"),
        ("F200", MM + "G94\n", "fanuc"),
        ("F200", MM + "M98 P9000\n", "fanuc"),
        ("F200", MM + "G99\n", "fanuc"),
    ],
    one_in=12,
)
def test_f_that_may_be_meant_as_it_is(feed: str, head: str, machine: str) -> None:
    rules = [rule for _, rule in said(FLAT.format(feed), machine, head=head.replace("G98 ", ""))]
    assert "feed-mode-unknown" not in rules


# ---- no F in force ----


@looped(
    ("head", "machine", "expected"),
    [
        ("G98", "fanuc", "feed-missing-in-polar"),
        ("G98", "fanuc-16i", "feed-missing-in-polar"),
        ("G94", "mitsubishi-m700", "feed-missing-in-polar"),
        ("G95/G0 X50. Z2./G1 Z1. F.2", "mitsubishi-m700", "feed-lost-from-per-revolution"),
        ("G98/G0 X50. Z2./G1 Z1. F100", "fanuc", ""),
        ("G94/G0 X50. Z2./G1 Z1. F100", "mitsubishi-m700", ""),
    ],
    one_in=12,
)
@looped("move", ["G1 Z-5.", "G1 Z-.2"])
def test_the_first_move_at_feed_may_be_of_z_alone(head: str, machine: str, expected: str, move: str) -> None:
    blocks = f"{head}/G0 X50. Z2. C0/G12.1/{move}/X40. F200/C10./C-10./X50./G13.1"
    report = said(blocks, machine, head="O1\nG21 G40 G97 T0101\n")
    assert [entry for entry in report if entry[1].startswith("feed-")] == ([(move, expected)] if expected else [])


# ---- rapid traverse through the center ----

AFTER = "G0 X50. Z2. C0/G12.1/G1 X40. F200./C10./C-10./X-50./G13.1/{}"


@pytest.mark.nightly
@looped(
    ("blocks", "at"),
    [
        ("G0 X-60.", "G0 X-60."),
        ("G0 Z50./X-60. Z60.", "X-60. Z60."),
        ("G0 U-120.", "G0 U-120."),
        ("G0 Z50./X60./T0101/X-5./X-60./X60.", "X-5."),
    ],
    one_in=2,
)
@looped("head", [MM, INCH])
def test_rapid_traverse_to_the_other_side(blocks: str, at: str, head: str) -> None:
    assert said(AFTER.format(blocks), head=head) == [(at, "rapid-through-center")]


@pytest.mark.nightly
@looped(
    "blocks",
    [
        "G0 X60.",
        "G0 X0/G1 Z-5.",
        "G0 X60./G1 X-1.6",
        "G0 Z50./T0202/G0 X-60.",
        "G28 U-5.",
        "G53 X-200.",
    ],
    one_in=2,
)
def test_x_above_0_or_not_in_rapid_or_of_another_tool(blocks: str) -> None:
    assert said(AFTER.format(blocks)) == []


def test_rapid_traverse_below_0_before_the_mode_is_another_matter() -> None:
    assert said("G0 X60. Z2./X-1./X60.") == []


# ---- D before the mode ----


@pytest.mark.ci
@looped("block", ["D1", "N5 D8", "T0101 D1"], one_in=3)
@looped("machine", ["fanuc", "fanuc-30i"])
def test_d_before_the_mode(block: str, machine: str) -> None:
    blocks = f"{block}/G0 X60. Z2. C-15./G12.1/G1 C15. F500./G41 X40. F200./C-15./G40 X60./G13.1"
    assert said(blocks, machine, "1:radius=4") == [(block, "d-word-on-lathe")]
    assert said(blocks, machine, "1:radius=.1", head=INCH) == [(block, "d-word-on-lathe")]


@looped(
    "blocks",
    [
        "D1/G0 X60. Z2./G1 X40. F.2",
        "G71 P1 Q2 U.4 W.1 D2. F.2",
        "D1/T0202/G0 X60. Z2. C0/G12.1/G1 X40. F200./C5./X60./G13.1",
    ],
)
def test_d_that_belongs_to_no_section(blocks: str) -> None:
    assert "d-word-on-lathe" not in [rule for _, rule in said(blocks)]


def test_d_above_the_first_tool_may_be_meant_for_it() -> None:
    blocks = "D1/T0101/G0 X60. Z2. C-15./G12.1/G1 C15. F500./G41 X40. F200./C-15./G40 X60./G13.1"
    assert said(blocks, head="O1\nG21 G40 G97 G98 G18\n") == [("D1", "d-word-on-lathe")]


# ---- offsets as variables ----

ASSIGNED = "G0 X50. Z2. C0/G12.1/G1 X40. F200./{}/C10./C-10./X50./G13.1"


@pytest.mark.nightly
@looped(
    ("block", "rule"),
    [
        ("#2001=.5", "offset-changed-in-polar"),
        ("#2201=4.", "offset-changed-in-polar"),
        ("#[2700+1]=#[2700+1]-.1", "offset-changed-in-polar"),
        ("#15001=0", "offset-changed-in-polar"),
        ("#5221=.1", "origin-shifted-in-polar"),
        ("#5201=0", "origin-shifted-in-polar"),
        ("IF[1EQ1]THEN #7001=.1", "origin-shifted-in-polar"),
        ("#[5201+20]=.1", "origin-shifted-in-polar"),
        ("#2501=.1", "origin-shifted-in-polar"),
        ("#10008=.1", "offset-changed-in-polar"),
        ("#14001=.1", "offset-changed-in-polar"),
        ("#2301=0", "offset-changed-in-polar"),
    ],
    one_in=12,
)
@looped("machine", ["fanuc", "fanuc-16i", "haas-lathe"])
def test_an_offset_assigned_in_the_mode(block: str, rule: str, machine: str) -> None:
    blocks = ASSIGNED.format(block)
    if machine == "haas-lathe":
        blocks = "G17/M154/M133 P500/" + blocks.replace("C", "Y").replace("Y0", "C0", 1).replace("12.1", "112").replace(
            "13.1", "113"
        )
    assert said(blocks, machine, head=MM if machine != "haas-lathe" else MM.replace(" G18", "")) == [(block, rule)]


@pytest.mark.ci
def test_it_names_the_variable() -> None:
    [(_, _, message)] = found(ASSIGNED.format("#[2000+12]=.5"))
    assert message == "tool offset changed in the polar mode by #2012; write it before G12.1 or after G13.1"
    [(_, _, message)] = found(ASSIGNED.format("#5241=.5"), head=INCH)
    assert message.startswith("#5241 changes the coordinate system in the polar mode")


@pytest.mark.nightly
@looped(
    ("blocks", "behind", "block", "rule"),
    [
        ("#100=1/WHILE[#100LT4]DO1/#[2000+#100]=.1/#100=#100+1/END1", "", "#[2000+#100]=.1", "offset-changed-in-polar"),
        ("#100=2/#[5201+20*#100]=.1", "", "#[5201+20*#100]=.1", "origin-shifted-in-polar"),
        ("M98 P2", "O2/#5221=.5/M99", "#5221=.5", "origin-shifted-in-polar"),
        ("M98 P30002", "O2/#10001=#10001-.1/M99", "#10001=#10001-.1", "offset-changed-in-polar"),
        ("G65 P2 A2008. B.5", "O2/#[#1]=#2/M99", "#[#1]=#2", "offset-changed-in-polar"),
        ("G65 P2 A7021. B.5", "O2/#[#1]=#2/M99", "#[#1]=#2", "origin-shifted-in-polar"),
    ],
    one_in=2,
)
def test_an_offset_assigned_in_the_mode_by_a_loop_or_a_call(blocks: str, behind: str, block: str, rule: str) -> None:
    program = f"{MM}{ASSIGNED.format(blocks)}/M30/{behind}".replace("/", "\n")
    [finding] = report_of(program).findings
    assert (finding.block, finding.rule) == (block, rule)


@pytest.mark.nightly
@looped(
    "blocks",
    [
        # Outside the mode, other variables, and in the branch that does not run.
        "#2001=.5/#5221=0/" + ASSIGNED.format("G4 X1.") + "/#2001=0",
        ASSIGNED.format("#100=2001/#501=#2001/#1=5221"),
        ASSIGNED.format("IF[1EQ2]THEN #2001=.5"),
    ],
)
def test_an_offset_left_alone_in_the_mode(blocks: str) -> None:
    assert said(blocks) == []


def test_an_assignment_is_a_row_that_moves_nothing() -> None:
    blocks = "G0 X50. Z2. C-15./G12.1/G1 C15. F500./G41 X40. F200./C5./#2001=.1/C-15./G40 X50./G13.1"
    assert said(blocks, "fanuc", "1:radius=2") == [("#2001=.1", "offset-changed-in-polar")]


# ---- an origin that can be computed ----

SHIFTED = "{}/G0 X50. Z2. C0/G12.1/G1 X40. F200./C10./C-10./X50./G13.1"
G92 = "O1\nG21 G40 G97 G94 G18\nT0101\n"


@pytest.mark.nightly
@looped(
    ("blocks", "name", "shift"),
    [
        ("G10 L2 P1 X.5/G54", "G10 on G54", "0.5"),
        ("G10 L2 P1 X.5", "G10 on G54", "0.5"),
        ("G10 L2 P2 X-1./G54/G55", "G10 on G55", "-1"),
        ("G10 L2 P3 X.5/G10 L2 P3 U.25/G56", "G10 on G56", "0.75"),
        ("G10 L20 P4 X.2/G54.1 P4", "G10 on G54.1 P4", "0.2"),
        ("G10 L2 P0 X.1", "G10 P0", "0.1"),
        ("G10 P0 U.1", "G10 P0", "0.1"),
        ("G0 X2.6/G50 X2.5", "G50", "0.1"),
        ("G0 X2.6/Z5./G1 U.4 F.1/G50 X2.5", "G50", "0.5"),
        ("G50 U.5", "G50", "-0.5"),
        ("G0 X60./G50 U-.5/G50 U.25", "G50", "0.25"),
        ("G10 L2 P1 X.5/G52 X.25/G50 U-.25", "G10 on G54 and G52 and G50", "1"),
        # What is added to the way from the reference position.
        ("G10 L2 P1 X-260.5/G10 L2 P1 U.5", "G10 on G54", "0.5"),
        ("G10 L2 P1 X-260.5/#5221=#5221+.5/G54", "#5221", "0.5"),
        ("#5221=-260.5/#5221=[#5221-.25]", "#5221", "-0.25"),
        ("#5221=#5221+.5", "#5221", "0.5"),
        ("G10 L2 P1 U-260.5/G10 L2 P1 U.1", "G10 on G54", "0.1"),
        # Variables of work offsets, computed ones too.
        ("#5221=.5", "#5221", "0.5"),
        ("#[5201+20*2]=-1./G55", "#5241", "-1"),
        ("#5201=.1", "#5201", "0.1"),
        ("#2501=.1", "#2501", "0.1"),
        ("#7061=.2/G54.1 P4", "#7061", "0.2"),
        ("#7061=.2/G54 P4", "#7061", "0.2"),
        ("G10 L20 P4 X.2/G54 P4", "G10 on G54.1 P4", "0.2"),
        ("#1=0/WHILE[#1LT5]DO1/#5221=#5221+.1/#1=#1+1/END1", "#5221", "0.5"),
        ("G10 L2 P1 X.5/#5221=.25", "#5221", "0.25"),
        ("#5221=.25/G10 L2 P1 U.25", "G10 on G54", "0.5"),
        ("G10 P0 X.1/G10 L2 P0 X.2", "G10 P0", "0.3"),
        # A G52 that was never cancelled after the section before; a preset takes it back, another G52 sets it.
        ("G52 X1./G0 X60. C0/G12.1/G13.1/G0 X80.", "G52", "1"),
        ("G52 X1./G50.3 X0/G52 X.5", "G52", "0.5"),
        ("G50 U.5/G50.3 X0/G52 X.5", "G52", "0.5"),
    ],
    one_in=20,
)
@looped(("head", "unit"), [(MM, "mm"), (INCH, "inch")])
def test_an_origin_that_the_program_moves(blocks: str, name: str, shift: str, head: str, unit: str) -> None:
    *_, (block, rule, message) = found(SHIFTED.format(blocks), head=head)
    assert (block, rule) == ("G12.1", "origin-off-center")
    distance = f"{float(shift) / 2:g} {unit} off the spindle axis, X {shift} {unit} as a diameter,"
    assert message == f"{name} puts X0 {distance} at G12.1"


@pytest.mark.nightly
@looped("blocks", ["G0 X30./G92 X29.8", "G91 G92 X.2/G90", "G10 L2 P1 X.5/G54", "G90 G10 L2 P1 X1./G54"], one_in=2)
def test_an_origin_in_g_code_system_b(blocks: str) -> None:
    changes = ("siemens-iso", "mazak-eia") if "G10" in blocks else ("siemens-iso",)
    for machine in changes:
        assert ("G12.1", "origin-off-center") in said(SHIFTED.format(blocks), machine, head=G92)


@pytest.mark.nightly
@looped(
    "blocks",
    [
        "G10 L2 P1 X0/G54",
        "G10 L2 P1 X.5/G10 L2 P1 X0/G54",
        "G10 L2 P2 X.5/G54",
        "G10 L2 P1 Z-.5/G54",
        # The way from the reference position of the lathe, and a tool offset.
        "G10 L2 P1 X-260.5/G54",
        "G10 P1 X.5",
        "G10 L10 P1 X.5",
        # Where X stands is what is set, or is not known.
        "G0 X2.6/G50 X2.6",
        "G50 X200. Z100.",
        "G28 U0/G50 X250.",
        "G50 S2000",
        "G50 U.5/G50 U-.5",
        # Each tool has an origin of its own.
        "G0 X200./G50 X198.5/T0202",
        "G0 X200./G50 X198.5 T0202",
        "G10 L2 P1 X.5/M98 P9000",
        "G10 L2 P1 X-260.5/G10 L2 P1 X-260.",
        "G10 L2 P1 X-260.5/G10 L2 P1 U.5/G10 L2 P1 U-.5",
        "#5221=-260.5/G54",
        "#5221=.5/#5221=0",
        "#5221=.5/G55",
        "#5222=.5/#5223=-1.",
        "#7061=.2/G54.1 P5",
        "#2601=1.",
        "#2001=.5",
        "#5221=#5221+0",
        "#5221=#5222-#5222",
        "G52 X1./G50.3 X0",
        "G50 U.5/G50.3 U0",
        "G52 C5.",
        "G10 L2 P1 C30.",
    ],
    one_in=12,
)
def test_an_origin_at_the_center_or_unknown(blocks: str) -> None:
    assert "origin-off-center" not in [rule for _, rule in said(SHIFTED.format(blocks))]


@pytest.mark.nightly
@looped(
    ("blocks", "cause"),
    [
        ("#5221=#500", "#5221"),
        ("#5221=#5221+#500", "#5221"),
        ("#5221=#5021", "#5221"),
        ("#5221=ABS[#5221]", "#5221"),
        ("#5201=-#500/#5221=.5", "#5201"),
        ("#2501=#500", "#2501"),
        ("G10 L2 P1 X#500", "G10 on G54"),
        ("G10 L2 P1 U[#500/2]", "G10 on G54"),
        ("G10 L20 P2 X#500/G54.1 P2", "G10 on G54.1 P2"),
        ("G52 X#500", "G52"),
        ("G50 U#500", "G50"),
        ("G0 X80./G50 X#500", "G50"),
        ("G52 X#500/#5221=#501", "#5221 and G52"),
    ],
    one_in=12,
)
def test_an_origin_that_is_set_to_what_is_not_known(blocks: str, cause: str) -> None:
    program = f"{MM}{SHIFTED.format(blocks.replace('[#500/2]', '[#500*2]'))}/M30\n".replace("/", "\n")
    report = report_of(program)
    assert [finding.rule for finding in report.findings] == []
    [entry] = [entry for entry in report.not_evaluated if entry.rule == "origin-off-center"]
    assert entry.reason.startswith(f"where X0 lies is not known: {cause} sets X to a value that is not known; give its")
    assert report.verdict == "unverified"
    given = report_of(program, job={"run": {"variables": {"500": 0.0, "501": 0.0, "5021": 0.0, "5221": 0.0}}})
    assert not given.not_evaluated


@pytest.mark.nightly
@looped(
    "blocks", ["G10 L2 P1 X#500/G10 L2 P1 X0", "#5221=#500/G55", "G52 X#500/G52 X0", "G52 X#500/G50.3 X0", "G50 X#500"]
)
def test_an_unknown_value_that_does_not_count(blocks: str) -> None:
    report = report_of(f"{MM}{SHIFTED.format(blocks)}/M30\n".replace("/", "\n"))
    assert not [entry for entry in report.not_evaluated if entry.rule == "origin-off-center"]


@pytest.mark.nightly
def test_what_the_program_sets_takes_the_place_of_the_job() -> None:
    job = {"work_offsets": {"G54": {"x": 0.5}}}

    def rules(blocks: str) -> list[str]:
        program = f"{MM}{SHIFTED.format(blocks)}/M30\n".replace("/", "\n")
        return [finding.rule for finding in report_of(program, job=job).findings]

    assert rules("G54") == ["origin-off-center"]
    assert rules("G10 L2 P1 X0") == []
    assert rules("G10 L2 P1 U-.5") == []


@looped(("block", "expected"), [("G53 G0 Z0.", []), ("G53 Z0", []), ("G53 G0 X0. Z0.", ["origin-shifted-in-polar"])])
def test_z_of_the_machine_alone_may_stand_in_the_mode_of_a_haas(block: str, expected: list[str]) -> None:
    head = "O1\nG20 G98 G97 T101\nM133 P1500\nM154\nG17\nG0 X3. Z.2 C0\nG112\nG1 X2.5 Y0. F20.\nZ-.1\nX2.\n"
    text = f"{head}{block}\nG113\nG18\nM155\nM135\nM30\n"
    rules = [finding.rule for finding in report_of(text, "haas-lathe", "1:radius=.25").findings]
    assert [
        rule for rule in rules if rule in ("origin-shifted-in-polar", "code-not-allowed-in-polar", "rapid-in-polar")
    ] == expected
