"""What the builder's guide to G12.1 (document 000) says, on its own programs and on variations of them."""

from __future__ import annotations

import re
from collections.abc import Callable

import pytest
from cases import looped
from guide_programs import METHOD_A, METHOD_B, PROGRAMS, SAMPLE, in_mm, without
from programs import Changes, machine_of, report_of, said

from polarcheck.rules.rule import load_all

MACHINE = "turning-center"


def found(program: str, *tools: str, job: Changes | None = None, machine: str = MACHINE) -> list[tuple[str, str, str]]:
    """The block, the rule and the severity of each finding."""
    report = report_of(program, machine, *tools, job=job)
    return [(finding.block, finding.rule, finding.severity) for finding in report.findings]


def errors_and_warnings(program: str, *tools: str, machine: str = MACHINE) -> list[tuple[str, str]]:
    return [(block, rule) for block, rule, severity in found(program, *tools, machine=machine) if severity != "note"]


def message(program: str, rule: str, *tools: str, job: Changes | None = None) -> str:
    """The one message of a rule."""
    [finding] = [one for one in report_of(program, MACHINE, *tools, job=job).findings if one.rule == rule]
    return finding.message


@pytest.mark.ci
@looped("name", PROGRAMS, one_in=2)
@looped("unit", ["inch", "mm"])
def test_the_programs_of_the_guide_are_right(name: str, unit: str) -> None:
    program, *tools = PROGRAMS[name]
    if unit == "mm":
        number, _, rest = tools[0].partition("=")
        program, tools[0] = in_mm(program), f"{number}={float(rest) * 25.4}"
    assert errors_and_warnings(program, *tools) == []


# ---- a section begins with G12.1 ----


@pytest.mark.ci
@looped("name", PROGRAMS, one_in=3)
@looped("compensated", [True, False])
@looped("machine", [MACHINE, "fanuc"])
def test_a_section_without_its_g12_1_is_one_finding(name: str, compensated: bool, machine: str) -> None:
    program, *tools = PROGRAMS[name]
    written = re.sub(r"G4[12] ", "", re.sub(r"^G40 X", "X", program, flags=re.MULTILINE).replace("G1 G40 X", "G1 X"))
    for number in range(program.count("G12.1")):
        wrong = without(program if compensated else written, "G12.1", number)
        assert errors_and_warnings(wrong, *tools, machine=machine) == [("G13.1", "polar-never-entered")]


def test_both_sections_without_g12_1_are_two() -> None:
    program = METHOD_A.replace("G12.1\n", "")
    assert errors_and_warnings(program, "1:radius=.25") == [("G13.1", "polar-never-entered")] * 2


ARC = "O1\nG20 G98 G97 T0101\nG0 X2. Z.1 C0\n{}G2 X-2. C.2 R1.01 F5.\n{}\nG13.1\nM30\n"


@looped("between", ["M9", "G0 Z1."])
def test_an_arc_of_c_belongs_into_the_mode(between: str) -> None:
    """Wherever it was left: no lathe turns C on an arc outside."""
    program = ARC.format("", between)
    assert errors_and_warnings(program, "1:radius=0", machine="fanuc") == [("G13.1", "polar-never-entered")]
    assert "C moves on an arc" in report_of(program, "fanuc").findings[-1].message


@pytest.mark.ci
@looped(
    "program",
    [
        ARC.format("G7.1 C1.\n", "G7.1 C0"),  # on a cylinder
        ARC.format("M98 P9000\n", "M9"),  # which may have entered it
        ARC.format("", "M9").replace("O1\nG20 G98 G97 T0101\n", "G20 G98\n"),  # as may what is not shown
        # C at feed is a groove round the diameter, and the G13.1 stands for safety.
        "O1\nG98 T0101\nG0 X60. C0\nG1 X50. F50\nC90. F500\nX60.\nG13.1\nM30\n",
        "O1\nG98 T0101\nG0 X60. C0\nG1 X50. F50\nC90. F500\nC0\nX60.\nG0 X100.\nG13.1\nM30\n",
        "O1\nG98 T0101\nG0 X60. C0\nG1 X50. F50\nC90. F500\nC0\nX60.\nG28 U0\nG13.1\nM30\n",
        "O1\nG98 T0101\nG0 X60. C0\nG1 X50. F50\nC90. F500\nC0\nX60.\nM1\nG13.1\nM30\n",
        "O1\nG98 T0101\nG0 X60. C0\nG1 X50. F50\nC90. F500\nC0\nX60.\nG40 G13.1\nM30\n",
        "O1\nG98 T0101\nG0 X60. C0\nG1 X50. F50\nC90. F500\nC0\nX60.\nT0202\nG13.1\nM30\n",
        "O1\nG98 T0101\nG0 X60. C0\nG1 C90. F500\nC0\nZ1.\nG13.1\nM30\n",
        # So is one that the tool leaves at feed, a helix, a spiral on the face: as lengths these C lie far outside.
        "O1\nG98 T0101\nG0 X62. C0\nG1 X58. F50\nC45. F800.\nC-45.\nX62.\nG13.1\nM30\n",
        "O1\nG98 T0101\nG0 X62. C0\nG1 X58. F50\nH-90. F800.\nH90.\nX62.\nG13.1\nM30\n",
        "O1\nG20 G98 T0101\nG0 X1.5 C0\nG1 X1.2 F4.\nC90. F300.\nC0\nX1.5 F40.\nG13.1\nM30\n",
        "O1\nG98 T0101\nG0 X62. C0\nG1 X58. F50\nZ-30. C360. F800.\nC720.\nX62.\nG13.1\nM30\n",
        "O1\nG98 T0101\nG0 X62. Z2. C0\nG1 Z-.2 F50\nX20. C3600. F800.\nC3960.\nX62.\nG13.1\nM30\n",
    ],
    one_in=2,
)
def test_what_is_no_contour_needs_no_g12_1(program: str) -> None:
    assert "polar-never-entered" not in [rule for _, rule in said(report_of(program, "fanuc"))]


@pytest.mark.ci
@looped(("x", "c"), [("100.", "45."), ("80.", "55."), ("40.", "30.")])
def test_a_rectangle_longer_than_its_approach_is_a_contour(x: str, c: str) -> None:
    """C of a narrow one may pass X; no angle does so where X goes below 0."""
    contour = f"G1 C{c} F500.\nX20. F200.\nC-{c}\nX-20.\nC{c}\nX{x} F500.\nG13.1\nM30\n"
    program = f"O1\nG98 T0101\nG0 X{x} Z2. C0\n{contour}"
    assert errors_and_warnings(program, "1:radius=0", machine="fanuc") == [("G13.1", "polar-never-entered")]
    assert errors_and_warnings(program.replace("G1 C", "G12.1\nG1 C"), "1:radius=0", machine="fanuc") == []


# ---- the live tool ----

TURNED = "T0101\nG50 S3000\n{}\nG99 G0 X1. Z.1\nG1 Z-1. F.01\nG0 X5. Z5.\nM5\nM35\n"

AGAIN = SAMPLE.replace("%\nO0001\n", "M34\n{}").replace("S2000 ", "")


@pytest.mark.ci
@looped(
    ("wrong", "block"),
    [
        (SAMPLE.replace("S2000 ", ""), "G97 M33"),
        (SAMPLE.replace("S2000", "S0"), "G97 S0 M33"),
        (METHOD_A.replace("S1000 ", ""), "G97 M33"),
        # What was given was for the main spindle, or is a limit of its speed.
        (SAMPLE.replace("S2000 ", "").replace("M5\nM35\n", TURNED.format("G96 S200 M3"), 1), "G97 M33"),
        (SAMPLE.replace("S2000 ", "").replace("M5\nM35\n", TURNED.format("G97 S800\nM3"), 1), "G97 M33"),
        # It had its own before the main spindle took its.
        (METHOD_A.replace("M30\n%\n", "") + AGAIN.format(TURNED.format("G97 S800 M3")), "G97 M33"),
        (METHOD_A.replace("M30\n%\n", "") + AGAIN.format(TURNED.format("G96 S200 M3")), "G97 M33"),
    ],
    one_in=2,
)
def test_a_live_tool_wants_its_speed(wrong: str, block: str) -> None:
    assert errors_and_warnings(wrong, "8:radius=0", "1:radius=.25") == [(block, "live-tool-without-speed")]


@pytest.mark.ci
@looped(
    "right",
    [
        SAMPLE.replace("G97 S2000 M33", "G97 S2000\nM33"),
        SAMPLE.replace("G97 S2000 M33", "G97\nM33\nS2000"),
        SAMPLE.replace("S2000", "S#500"),
        SAMPLE.replace("M5\nM35\n", TURNED.format("G96 S200 M3"), 1),
        # What was given for it holds for the next tool.
        METHOD_A.replace("M30\n", "") + SAMPLE.replace("S2000 ", "").replace("%\nO0001\n", ""),
        # It may be given in what is not shown, or not executed.
        SAMPLE[SAMPLE.index("G97") : -2].replace("S2000 ", ""),
        SAMPLE.replace("G97 S2000 M33", "M98 P9000\nM33"),
        "%\nO1\nT0808\nM33\nG98 G0 X1. Z.1\nG1 Z-.5 F3.\nM30\n%\n",  # no section: M33 may be anything
    ],
    one_in=2,
)
def test_a_speed_that_may_be_meant_for_the_live_tool_is_enough(right: str) -> None:
    assert "live-tool-without-speed" not in [rule for _, rule, _ in found(right, "8:radius=0", "1:radius=.25")]


@looped(
    ("old", "new", "follows"),
    [("S2000", "S#100", "live-tool-without-speed"), ("C.5339 F60.", "C.5339 F#100", "feed-missing-in-polar")],
)
def test_a_variable_that_was_never_set_is_one_finding(old: str, new: str, follows: str) -> None:
    """What the control drops is missing: S of the live tool, F of the first move."""
    report = report_of(SAMPLE.replace(old, new, 1), MACHINE, "8:radius=0")
    [finding] = [one for one in report.findings if one.severity != "note"]
    assert (finding.rule, [one.rule for one in finding.follows]) == ("vacant-variable", [follows])


NEXT_TOOL = "M1\nT0202\nM35\nG0 X5. Z5.\nM30\n"


@pytest.mark.nightly
@looped(
    ("wrong", "block", "severity"),
    [
        (SAMPLE.replace("Z.1 M35", "Z.1"), "M30", "note"),
        (METHOD_B.replace("Z5. M35", "Z5."), "M30", "note"),
        (METHOD_A.replace("Z5. M35", "Z5.").replace("M1\nM30\n", NEXT_TOOL), "T0202", "warning"),
        (SAMPLE.replace("Z.1 M35", "Z.1").replace("M1\nM30\n", NEXT_TOOL), "T0202", "warning"),
    ],
    one_in=3,
)
def test_a_live_tool_is_stopped_after_its_section(wrong: str, block: str, severity: str) -> None:
    tools = "8:radius=0", "1:radius=.25"
    assert (block, "live-tool-never-stopped", severity) in found(wrong, *tools)
    assert len(errors_and_warnings(wrong, *tools)) == (severity == "warning")
    line = 1 + wrong.splitlines().index("G97 S2000 M33" if "T0808" in wrong else "G97 S1000 M33")
    assert f"M33 of line {line} was not stopped" in message(wrong, "live-tool-never-stopped", *tools)


@pytest.mark.ci
@looped(
    "right",
    [
        SAMPLE.replace("Z.1 M35", "Z.1").replace("M1\n", "M35\nM1\n"),
        SAMPLE.replace("Z.1 M35", "Z.1 M5"),
        SAMPLE.replace("Z.1 M35", "Z.1").replace("M1\nM30\n", "M35 T0202\nG0 X5. Z5.\nM30\n"),
        SAMPLE.replace("Z.1 M35", "Z.1").replace("M1\nM30\n", "M98 P9000\nM30\n"),  # which may stop it
        SAMPLE.replace("Z.1 M35", "Z.1").replace("M1\nM30\n", ""),  # nobody knows what follows
        SAMPLE.replace(
            "M1\nM30\n", "T0202\nM35\nG28 H0\nS900 M33\nG0 X1. Z.1\nG1 Z-.5 F3.\nG0 Z1.\nM30\n"
        ),  # no section
    ],
)
def test_a_live_tool_that_is_stopped_or_not_of_a_section(right: str) -> None:
    assert "live-tool-never-stopped" not in [rule for _, rule, _ in found(right, "8:radius=0")]


# ---- the feed after a section ----

#: The sample program without its G99, and work of a turning tool behind it.
CARRIED = SAMPLE.replace("G99 G0 X2.5", "G0 X2.5")
TURNING = "T0101\nM34\nG97 S800 M3\nG0 X1. Z.1\n{}\nG0 X5. Z5.\nM30\n"


@pytest.mark.ci
@looped(
    ("work", "block"),
    [
        ("G1 Z-.5 F.008", "G1 Z-.5 F.008"),
        ("G1 X.9\nZ-.5", "G1 X.9"),  # at the F60. of the section
        ("G90 X.9 Z-1. F.01\nX.8", "G90 X.9 Z-1. F.01"),
        ("G94 X0 Z0 F.008", "G94 X0 Z0 F.008"),
        ("G83 Z-1. F.004", "G83 Z-1. F.004"),
        ("G71 U.1 R.05\nG71 P10 Q20 U.02 W.01 F.012\nN10 G0 X.5\nG1 Z-1.\nN20 X1.", "G71 P10 Q20 U.02 W.01 F.012"),
    ],
    one_in=6,
)
def test_the_feed_of_a_mill_is_not_carried_into_turning(work: str, block: str) -> None:
    wrong = CARRIED.replace("M30\n", TURNING.format(work))
    assert errors_and_warnings(wrong, "8:radius=0") == [(block, "turning-feed-not-restored")]
    for right in (
        wrong.replace("G0 X2.5", "G99 G0 X2.5"),
        wrong.replace("G97 S800", "G99 G97 S800"),
        wrong.replace("T0101\n", "M98 P9000\nT0101\n"),  # which may say G99
    ):
        assert "turning-feed-not-restored" not in [rule for _, rule in errors_and_warnings(right, "8:radius=0")]


def test_it_is_carried_within_the_work_of_the_mill_too() -> None:
    wrong = CARRIED.replace("G0 X2.5\n", "G0 X2.5\nG1 Z-.5 F.008\nG0\n")
    assert errors_and_warnings(wrong, "8:radius=0") == [("G1 Z-.5 F.008", "turning-feed-not-restored")]
    said_of_it = message(wrong, "turning-feed-not-restored", "8:radius=0")
    assert said_of_it.startswith("F.008 is 0.008 inch a minute in this move: G98 of line 14 is still in force")


def test_an_f_in_a_block_of_its_own_is_told_where_it_moves() -> None:
    wrong = CARRIED.replace("M30\n", TURNING.format("F.008\nG1 Z-.5"))
    assert errors_and_warnings(wrong, "8:radius=0") == [("G1 Z-.5", "turning-feed-not-restored")]


def test_a_program_in_mm_is_judged_alike() -> None:
    program = in_mm(CARRIED.replace("M30\n", TURNING.format("G1 Z-.5 F.008")))
    assert errors_and_warnings(program, "8:radius=0") == [("G1 Z-12.7 F0.2032", "turning-feed-not-restored")]
    program = in_mm(CARRIED.replace("M30\n", TURNING.format("G1 Z-.5 F3.")))
    assert errors_and_warnings(program, "8:radius=0") == []


def test_each_g98_is_carried_once() -> None:
    work = TURNING.format("G1 Z-.5 F.008\nX1.1\nZ-.6 F.006").replace("M30\n", "")
    again = CARRIED[CARRIED.index("M5\n") :].replace("M1\nM30\n", TURNING.format("G1 Z-.5 F.008"))
    program = CARRIED.replace("M1\nM30\n%\n", f"{work}G99\n{again}")
    assert errors_and_warnings(program, "8:radius=0") == [("G1 Z-.5 F.008", "turning-feed-not-restored")] * 2


@pytest.mark.ci
@looped(
    "work",
    [
        TURNING.format("G92 X.9 Z-1. F.05\nX.88"),
        TURNING.format("G76 P010060 Q50 R20\nG76 X.9 Z-1. P500 Q200 F.05"),
        TURNING.format("G32 Z-1. F.05"),
        TURNING.format("G1 Z-.5 F5."),  # a feed per minute, as for a bar puller
        TURNING.format("G98 G1 Z-.5 F.008"),  # which is said anew
        "T0909\nM35\nG28 H0\nS3000 M33\nG0 X1. Z.1\nG1 Z-.5 F3.\nG0 Z1. M35\nM30\n",
        "T0909\nM35\nG28 H0\nS3000 M33\nG0 X1. Z.1\nG83 Z-.5 F1.5\nG80 G0 Z1. M35\nM30\n",
    ],
    one_in=2,
)
def test_a_feed_per_minute_that_is_meant_is_right(work: str) -> None:
    assert errors_and_warnings(CARRIED.replace("M30\n", work), "8:radius=0") == []


@pytest.mark.ci
@looped("machine", ["fanuc", "haas-lathe", "mazak-eia", "siemens-iso", "okuma-osp", "gsk-988"], one_in=4)
def test_the_procedure_is_that_of_one_builder(machine: str) -> None:
    program = CARRIED.replace("S2000 ", "").replace("Z.1 M35", "Z.1").replace("M30\n", TURNING.format("G1 Z-.5 F.008"))
    rules = {"live-tool-without-speed", "live-tool-never-stopped", "turning-feed-not-restored"}
    assert rules <= {rule for _, rule, _ in found(program, "8:radius=0")}
    assert not rules & {rule for _, rule, _ in found(program, "8:radius=0", machine=machine)}


# ---- R, the feed mode, the plane ----


@pytest.mark.ci
@looped("radius", ["-.005", ".005", "0", "-.0098", ".0098"], one_in=3)
@looped("unit", ["inch", "mm"])
def test_r_is_adjusted_either_plus_or_minus(radius: str, unit: str) -> None:
    """Beside a comment that tells the cutter, too."""
    given = f"{float(radius) * (25.4 if unit == 'mm' else 1)}"
    program = SAMPLE if unit == "inch" else in_mm(SAMPLE)
    assert found(program, f"8:radius={given}") == []


@pytest.mark.ci
@looped("radius", [".245", ".255"])
@looped("program", [METHOD_A, METHOD_B])
def test_so_is_the_r_of_a_program_of_the_part(program: str, radius: str) -> None:
    assert errors_and_warnings(program.replace("T0101", "T0101 (1/2 INCH END MILL)"), f"1:radius={radius}") == []


BY_REVOLUTION = re.sub(r"F60\.", "F.03", SAMPLE).replace("F7.", "F.0035")


@pytest.mark.ci
@looped("before", ["", "G99\n"])
def test_feed_is_per_minute_or_per_revolution(before: str) -> None:
    """G99 in the mode is allowed, and a note at most: F hangs on a spindle that is the C axis."""
    program = BY_REVOLUTION.replace("G98", "G99" if not before else "").replace("X2.15\n", f"X2.15\n{before}", 1)
    assert [(rule, severity) for _, rule, severity in found(program, "8:radius=0")] == [
        ("feed-per-revolution-in-polar", "note")
    ]
    assert found(SAMPLE.replace("G1 G98", "G1").replace("G40\n", "G40 G98\n", 1), "8:radius=0") == []


@pytest.mark.ci
@looped(
    ("old", "new"),
    [
        ("G40\n", "G18 G40\n"),
        ("X2.15\n", "X2.15\nG18\n"),
        ("G12.1\n", "G12.1\nG18\n"),
        ("G12.1\nG1", "G12.1\nG18 G1"),
        ("Z-.88\n", "Z-.88\nG18\n"),
        ('G40\nG13.1\nG30 U0 W0\nG28 H0\nT0808 (3/4" DIA. CUTTER)\nG97 S2000 M33\nG0Z.1 C0 M8\nX2.15\nG12.1\n', None),
    ],
    one_in=2,
)
def test_g18_in_the_mode_or_before_it_satisfies_the_guide(old: str, new: str | None) -> None:
    """So does the default plane of the lathe, and G18 as the first block in the mode after G17."""
    new = old.replace("G40", "G40 G17").replace("G12.1\n", "G12.1\nG18\n") if new is None else new
    assert old in SAMPLE
    assert found(SAMPLE.replace(old, new, 1), "8:radius=0") == []


@pytest.mark.ci
@looped(
    ("old", "new", "block", "rule"),
    [
        ("G12.1\n", "G12.1\nG17\n", "G17", "plane-selected-in-polar"),
        ("Z-.88\n", "Z-.88\nG19\n", "G19", "plane-selected-in-polar"),
        ("X2.15\n", "G17 X2.15\n", "G12.1", "plane-wrong-at-entry"),
        ("X2.15\n", "G19 X2.15\n", "G12.1", "plane-wrong-at-entry"),
    ],
)
def test_only_g17_and_g19_are_wrong(old: str, new: str, block: str, rule: str) -> None:
    assert errors_and_warnings(SAMPLE.replace(old, new, 1), "8:radius=0") == [(block, rule)]


# ---- the offset of the cutter ----


@pytest.mark.ci
@looped(
    ("old", "new"),
    [
        ('T0808 (3/4" DIA. CUTTER)\n', 'T0808 (3/4" DIA. CUTTER)\nD08\n'),
        ('T0808 (3/4" DIA. CUTTER)\n', "T0808 D08\n"),
        ('T0808 (3/4" DIA. CUTTER)\n', "D08\nT0808\n"),
        ("S2000 M33", "S2000 M33 D8"),
        ("X2.15\n", "G0 X2.15 D8\n"),
        ("G12.1\n", "G12.1\nD8\n"),
        ("G1 G41 X1.75", "G1 G41 D8 X1.75"),
    ],
    one_in=2,
)
def test_d_calls_nothing_on_a_lathe(old: str, new: str) -> None:
    [(_, rule, severity)] = found(SAMPLE.replace(old, new, 1), "8:radius=0")
    assert (rule, severity) == ("d-word-on-lathe", "error")


@pytest.mark.ci
@looped(
    "before",
    [
        "G71 U.1 R.05\nG71 P10 Q20 U.02 W.01 D1000 F.01",
        "G76 X.9 Z-1. K.03 D100 F.05",
        "G83 Z-1. D100 F3.",
        "G65 P9000 D8",
        "G200 D8",
        "M200 D8",
        "G101 X1. D8",
    ],
    one_in=2,
)
def test_a_cycle_or_a_call_has_a_d_of_its_own(before: str) -> None:
    program = SAMPLE.replace("X2.15\n", f"{before}\nG0 X2.15\n", 1)
    assert "d-word-on-lathe" not in [rule for _, rule, _ in found(program, "8:radius=0")]


def test_a_nose_that_is_not_given_has_no_weight() -> None:
    report = report_of(SAMPLE, MACHINE, "8:radius=0")
    assert [(one.rule, one.matters) for one in report.not_evaluated] == [("nose-type-not-zero", False)]
    assert report.verdict == "pass"
    assert report_of(SAMPLE, MACHINE, "8:radius=0", "8:nose=0").not_evaluated == []


@pytest.mark.ci
@looped(
    ("machine", "nose", "allowed"), [(MACHINE, 3, "0"), (MACHINE, 9, "0"), ("fanuc", 3, "0 or 9"), ("fanuc", 9, "")]
)
def test_the_nose_type_is_that_of_the_machine(machine: str, nose: int, allowed: str) -> None:
    findings = report_of(SAMPLE, machine, "8:radius=0", f"8:nose={nose}").findings
    assert [(one.rule, one.message.rpartition("must be ")[2]) for one in findings] == (
        [("nose-type-not-zero", allowed)] if allowed else []
    )


def test_the_page_of_the_nose_type_speaks_of_no_other_machine() -> None:
    assert "9" not in load_all()["nose-type-not-zero"].page.partition("Source:")[0]


@pytest.mark.ci
@looped(
    ("program", "old", "new"),
    [
        (SAMPLE, "G1 G41 X1.75F7. (1)\n", "G41\nG1 X1.75F7.\n"),
        (SAMPLE, "G1 G41 X1.75F7. (1)\nZ-.88\n", "G1 G41 Z-.88 F7.\nX1.75\n"),
        (METHOD_A, "G1 G41 X1.0 F5.\n", "G42\nG41\nX1.0 F5.\n"),
        (METHOD_B, "G1 G41 X1.0 F5.\n", "G41 C.4153\nX1.0 F5.\n"),  # where it stands already
    ],
    one_in=2,
)
def test_g41_belongs_beside_the_move_that_begins_the_offset(program: str, old: str, new: str) -> None:
    assert old in program
    report = report_of(program.replace(old, new, 1), MACHINE, "8:radius=0", "1:radius=.25")
    [finding] = [one for one in report.findings if one.rule == "start-up-without-move"]
    assert finding.severity == "note"
    assert not [one for one in report.findings if one.severity != "note"]
    assert "start-up-without-move" not in {
        rule for _, rule, _ in found(program.replace(old, new, 1), "8:radius=0", "1:radius=.25", machine="fanuc")
    }


@pytest.mark.ci
@looped(
    ("old", "new", "reason"),
    [
        ("X2.15\n", "X2.15\nG10 P8 U-.005\n", "G10 P8 U-.005 in line 12 leaves open where X stands"),
        ("X2.15\n", "X2.15\nG55\n", "G55 in line 12 leaves open where X stands"),
        ("X2.15\n", "X2.15\nG28 U0\n", "G28 U0 in line 12 leaves open where X stands"),
        ("X2.15\n", "X#500\n", "X#500 in line 11 leaves open where X stands"),
        ("X2.15\n", "", "X was not programmed before the polar mode"),
        ("X2.15\nG12.1\n", "G12.1 X2.15\n", "X was not programmed before the polar mode"),
    ],
    one_in=2,
)
def test_what_leaves_the_position_open_is_named(old: str, new: str, reason: str) -> None:
    program = SAMPLE.replace("G30 U0 W0\n", "", 1).replace(old, new, 1)
    reasons = {one.reason for one in report_of(program, MACHINE, "8:radius=.05", "8:nose=0").not_evaluated}
    remedy = "before it" if "not programmed" in reason else "after it"
    assert f"the position is not known: {reason}; write G0 X... {remedy}" in reasons


def test_a_start_up_that_is_too_short_is_one_finding() -> None:
    program = METHOD_A.replace("G1 G41 X1.0 F5.\n", "G41\nX1.0 F5.\n", 1).replace("X1.8\n", "X1.4\n", 1)
    [finding] = [one for one in report_of(program, MACHINE, "1:radius=.25").findings if one.severity == "error"]
    assert finding.rule == "start-up-shorter-than-radius"
    assert [one.rule for one in finding.follows] == ["start-up-without-move"]
    never = METHOD_A.replace("G1 G41 X1.0 F5.\nZ - .375 (depth of cut)\nC-0.4153\nG40", "G41\nG40", 1)
    assert [rule for _, rule, _ in found(never, "1:radius=.25")].count("start-up-without-move") == 0


# ---- feeds ----

RULE = "feed-outside-recommended-range"
TOOLS = ("8:radius=0", "1:radius=.25")


def of_feed(program: str, *tools: str, job: Changes | None = None) -> list[str]:
    """The blocks in which an F is outside what the guide recommends."""
    return [block for block, rule, _ in found(program, *(tools or TOOLS), job=job) if rule == RULE]


@pytest.mark.ci
@looped("program", [SAMPLE, METHOD_A, METHOD_B], one_in=2)
@looped("convert", [str, in_mm])
def test_the_feeds_of_the_guide_are_its_recommendation(program: str, convert: Callable[[str], str]) -> None:
    """F20. for positioning and F60. on the way round the part included."""
    assert of_feed(convert(program)) == []


@pytest.mark.ci
@looped("feed", ["10.5", "20.", "30.", "45.", "60."], one_in=12)
@looped(
    ("program", "old", "block", "why"),
    [
        (SAMPLE, "X1.75F7.", "G1 C-.5339 (2)", "it is as near to the center as that of line 19"),
        (SAMPLE, "G1 C.5339 F7.", "G1 C.5339 F{} (4)", "it is as near to the center as that of line 17"),
        (METHOD_A, "X1.0 F5.", "C-0.4153", "no move along this contour is slower"),
        (METHOD_B, "F5.\nG40", "G1 C0.4153 F{}", "it is as near to the center as that of line 16"),
    ],
)
def test_a_cut_at_more_than_the_feed_for_cutting_is_told(
    feed: str, program: str, old: str, block: str, why: str
) -> None:
    new = re.sub(r"F\d+\.", f"F{feed}", old)
    wrong = program.replace(old, new, 1)
    assert of_feed(wrong) == [block.format(feed)]
    text = message(wrong, RULE, *TOOLS)
    where = "between the two ranges" if float(feed) < 30 else "a feed for positioning"
    assert f" is {feed.rstrip('.')} inch/min, {where}, and this move cuts: {why}; recommended" in text
    assert text.endswith("1 to 10 inch/min for cutting, 30 to 60 inch/min for positioning")


@pytest.mark.ci
@looped("feed", ["1.", "10.", "12.", "20.", "30.", "60."], one_in=12)
@looped(
    ("program", "old"),
    [
        (SAMPLE, "G1 G98 C.5339 F60."),
        (SAMPLE, "R1.025 F60."),
        (SAMPLE, "G40 X-2.15 F60."),
        (METHOD_A, "C0.4153 F20."),
        (METHOD_A, "G40 X1.8 F20."),
        (METHOD_B, "R.650 F60."),
    ],
)
def test_positioning_goes_at_any_feed_of_the_ranges_and_between(feed: str, program: str, old: str) -> None:
    assert of_feed(program.replace(old, re.sub(r"F\d+\.", f"F{feed}", old), 1)) == []


@pytest.mark.ci
@looped(("feed", "where"), [(".9", "below"), ("60.5", "above")], one_in=4)
@looped("old", ["G98 C.5339 F60.", "X1.75F7.", "R1.025 F60.", "G40 X-2.15 F60."])
def test_beyond_both_ranges_any_move_is_told(feed: str, where: str, old: str) -> None:
    wrong = SAMPLE.replace(old, re.sub(r"F\d+\.", f"F{feed}", old), 1)
    assert len(of_feed(wrong)) == 1
    assert f"inch/min, {where} both ranges" in message(wrong, RULE, *TOOLS)


@pytest.mark.ci
def test_each_f_of_a_section_is_told_once() -> None:
    every = METHOD_A.replace("F5.", "F40.")
    assert of_feed(every) == ["C-0.4153", "C-0.4153"]
    more = SAMPLE.replace("G1 C.5339 F7. (4)\n", "G1 C.2 F40.\nC0 F50.\nC.2 F40.\nC.5339\n")
    assert of_feed(more) == ["G1 C.2 F40.", "C0 F50."]


@pytest.mark.ci
@looped(("diameter", "cuts"), [(1.25, False), (1.29, False), (1.31, True), (1.4, True)], one_in=8)
@looped("convert", [str, in_mm])
def test_given_stock_decides_whether_the_way_round_cuts(
    diameter: float, cuts: bool, convert: Callable[[str], str]
) -> None:
    """The arc of the guide leads the edge of the cutter round a circle of 1.3 inch."""
    unit = 1 if convert is str else 25.4
    job = {"stock": {"diameter": diameter * unit}}
    for program, tools in (
        (METHOD_B, [f"1:radius={0.25 * unit}"]),
        (SAMPLE, ["8:radius=0", f"8:diameter={0.75 * unit}"]),
    ):
        assert len(of_feed(convert(program), *tools, job=job)) == cuts
    slow = METHOD_B.replace("F60.", "F5.")
    assert of_feed(convert(slow), f"1:radius={0.25 * unit}", job=job) == []


def test_a_cut_outside_the_stock_is_none() -> None:
    """With the stock given, what is as near as a cut counts no more."""
    program = METHOD_B.replace("G1 C0.4153 F5.", "G1 C0.4153 F40.")
    assert of_feed(program, job={"stock": {"diameter": 1.25}}) == ["G1 C0.4153 F40."]
    assert of_feed(program, job={"stock": {"diameter": 0.9}}) == []


@pytest.mark.ci
@looped(
    ("blocks", "told"),
    [
        # A lead in and a lead out on arcs, whose ends lie on the contour; then the contour itself.
        ("G1 X1.4 C.6153 F40.\nG41 X1.4 C.2 F40.\nG3 X1. C0 R.2\nG1 C-.4 F5.\nG3 X1.4 C-.6 R.2 F40.\nG1 G40 X2.", []),
        ("G1 C.6 F40.\nG41 X1. F5.\nC-.6\nX-1. F40.\nC.6 F5.\nX.9 F40.\nG40 X2.4", []),
        # Above the depth of the cuts.
        ("G1 C.6 F40.\nG41 X1. F40.\nC-.6\nC.6\nZ-.3 F5.\nC-.6\nG40 X2.4", []),
        # A polygon in chords, each of which is nearest at an end.
        ("G1 C.1 F40.\nG41 X1.1 F5.\nX1.08 C.15\nX1. C.25 F40.\nX.8 C.37\nX.6 C.45 F5.\nG40 X2.4", ["X1. C.25 F40."]),
    ],
    one_in=2,
)
def test_leads_and_moves_in_the_air_are_no_cuts(blocks: str, told: list[str]) -> None:
    program = f"T0101\nM5\nM35\nG28 H0\nG97 S900 M33\nG98 G0 X2.4 Z.1 C0\nG12.1\n{blocks}\nG13.1\n"
    assert of_feed(program, "1:radius=.05") == told


def test_without_compensation_nobody_knows_what_cuts() -> None:
    program = METHOD_A.replace("G41 ", "").replace("G40 X1.8", "X1.8")
    assert of_feed(program) == ["G1 G98 C0.4153 F20."] * 2
    texts = [one.message for one in report_of(program, MACHINE, *TOOLS).findings if one.rule == RULE]
    assert all("between the two ranges; recommended" in text for text in texts)


def test_an_unknown_radius_takes_nothing_from_it() -> None:
    assert of_feed(METHOD_A.replace("F5.", "F40.", 1), "8:radius=0") == ["C-0.4153"]
    assert of_feed(METHOD_B, "8:radius=0") == []


@pytest.mark.ci
@looped(
    ("feed", "shown"),
    [("25.", "25 mm"), ("25.4", ""), ("250.", ""), ("254.", ""), ("254.0001", "254.0001 mm"), ("254.5", "254.5 mm")],
    one_in=3,
)
def test_limits_in_mm_are_true_as_they_are_shown(feed: str, shown: str) -> None:
    program = in_mm(METHOD_A).replace("F127.", f"F{feed}", 1)
    assert len(of_feed(program, "1:radius=6.35")) == bool(shown)
    if shown:
        text = message(program, RULE, "1:radius=6.35")
        assert f" is {shown}/min, " in text
        assert text.endswith("25.4 to 254 mm/min for cutting, 762 to 1524 mm/min for positioning")


@pytest.mark.ci
def test_limits_of_a_lathe_of_ones_own_are_rounded_to_what_lies_within() -> None:
    """250 mm is 9.84252 inch: 9.8425 is within, 9.8426 is not."""
    changes = {"feed": {"cutting_maximum": 250.0, "cutting_minimum": 33.333}}
    for feed, is_told in (("9.8425", False), ("9.8426", True), ("1.3124", False), ("1.3123", True)):
        report = report_of(METHOD_A.replace("F5.", f"F{feed}", 1), machine_of(MACHINE, changes), "1:radius=.25")
        told = [one.message for one in report.findings if one.rule == RULE]
        assert len(told) == is_told
        assert all("recommended in the polar mode: 1.3124 to 9.8425 inch/min for cutting" in text for text in told)


@looped(
    ("feed", "where", "recommended"),
    [
        ({"cutting_minimum": 25.4, "cutting_maximum": 254.0}, "above the range", "1 to 10 inch/min for cutting"),
        ({"positioning_minimum": 254.0, "positioning_maximum": 508.0}, "above the range", "10 to 20 inch/min for pos"),
    ],
)
def test_one_range_alone(feed: dict[str, float], where: str, recommended: str) -> None:
    program = METHOD_A.replace("X1.0 F5.", "X1.0 F40.", 1)
    report = report_of(program, "fanuc", *TOOLS, changes={"feed": feed}, job={"program_units": "inch"})
    [finding] = [one for one in report.findings if one.rule == RULE]
    assert f"40 inch/min, {where}" in finding.message
    assert f"recommended in the polar mode: {recommended}" in finding.message


# ---- the approach ----


@pytest.mark.nightly
@looped("convert", [str, in_mm])
def test_the_approach_is_od_and_cutter_and_clearance(convert: Callable[[str], str]) -> None:
    """X2.15 of the sample is 1.3 + .75 + .1, X1.8 of the methods 1.25 + .5 + .05."""
    unit, name = (1, "inch") if convert is str else (25.4, "mm")
    cutter = "8:radius=0", f"8:diameter={0.75 * unit}", f"1:radius={0.25 * unit}"

    def told(program: str, diameter: float, clearance: float) -> list[tuple[str, str]]:
        job = {"stock": {"diameter": diameter * unit, "clearance": clearance * unit}}
        findings = report_of(convert(program), MACHINE, *cutter, job=job).findings
        return [(one.severity, one.message) for one in findings if one.rule == "approach-inside-stock"]

    assert told(SAMPLE, 1.3, 0.1) == []
    assert told(METHOD_A, 1.25, 0.05) == told(METHOD_B, 1.25, 0.05) == []
    [(severity, text)] = told(SAMPLE, 1.3, 0.2)
    numbers = [f"{number * unit:.3f}".rstrip("0").rstrip(".") for number in (1.3, 0.75, 0.2, 2.25)]
    assert severity == "warning"
    assert text.endswith(
        "stock {0} {4}, cutter {1} {4} and clearance {2} {4} need {3} {4} or more".format(*numbers, name)
    )
    assert [severity for severity, _ in told(SAMPLE, 1.5, 0.1)] == ["error"]
