"""What a program sets of tool offsets by itself: R, nose type and X, by G10 and by system variables."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from cases import looped
from programs import report_of, said, trace_of

from polarcheck.files.settings.of_programs import OfPrograms, Options
from polarcheck.foundation.finding import PolarSection

MM = "O1\nG21 G40 G97 G98 G18\n"
#: The sample program of the builder's guide, with blocks before and behind its T word.
GUIDE = """O1
G20 G40 G98
{}
M5
M35
G28 H0
T0808{}
{}
G97 S2000 M33
G0 Z.1 C0
X{}
G12.1
G1 C.5339 F60.
G1 G41 X1.75 F7.
Z-.88
G1 C-.5339
G2 X-1.75 R1.025 F60.
G1 C.5339 F7.
G1 G40 X-{} F60.
G13.1
G99 G0 X3.
Z.1 M35
M30
"""
#: The way from 1.75 to 2.6 on the diameter is .425, which R .375 needs.
FAR, AS_PRINTED = "2.6", "2.15"
#: Outside round a half of a square, as shown by `radius`.
SECTION = "G0 X100. Z2. C0\nG12.1\nG1 G42 X60. F200\nC20.\nG40 X100.\nG13.1\n"


def guide(before: str = "", behind: str = "", comment: str = "", x: str = FAR) -> str:
    lines = (text.replace("/", "\n") for text in (before, behind))
    first, second = lines
    return GUIDE.format(first, comment, second, x, x)


def sections(blocks: str, machine: str = "fanuc", *tools: str, head: str = MM, **more: Any) -> list[PolarSection]:
    program = f"{head}{blocks}\n{SECTION}M30\n".replace("/", "\n")
    return report_of(program, machine, *tools, **more).polar_sections


def taken(blocks: str, machine: str = "fanuc", *tools: str, **more: Any) -> tuple[float | None, str]:
    """R of the only section, and where it is from."""
    [found] = sections(blocks, machine, *tools, **more)
    return found.radius, found.radius_source


def reasons(program: str, machine: str = "fanuc", *tools: str) -> set[tuple[str, bool]]:
    return {(entry.reason, entry.matters) for entry in report_of(program, machine, *tools).not_evaluated}


# ---- the document's own program ----


def test_the_sample_program_with_a_radius_of_its_own() -> None:
    report = report_of(guide("G10 P8 R.375 Q0", comment=' (3/4" DIA. CUTTER)'), "turning-center")
    assert (report.verdict, said(report)) == ("pass", [])
    [section] = report.polar_sections
    assert (section.offset, section.radius, section.radius_source) == (8, pytest.approx(9.525), "program")
    assert report.not_evaluated == []


def test_the_nose_type_of_a_turning_tool_is_an_error_that_names_the_block() -> None:
    report = report_of(guide("G10 P8 R.375 Q3"), "turning-center")
    [found] = report.findings
    assert (found.rule, found.line) == ("nose-type-not-zero", 14)
    assert found.message == ("offset 8 is set by G10 P8 R.375 Q3 in line 3 to nose type T3; for a mill it must be 0")


@pytest.mark.nightly
@looped("tools", [(), ("8:radius=0",), ("8:radius=.2,nose=0",)], one_in=2)
def test_ramps_that_its_own_radius_does_not_fit(tools: tuple[str, ...]) -> None:
    """As printed the program is that of the tool center: with R .375 its ramps are too short."""
    report = report_of(guide("G10 P8 R.375", x=AS_PRINTED), "turning-center", *tools)
    (found,) = report.findings
    assert found.rule == "start-up-shorter-than-radius"
    assert "cancel-shorter-than-radius" in [follower.rule for follower in found.follows]
    assert "with R 0.375 inch, set by G10 P8 R.375 in line 3, it needs 0.75 inch" in found.message


def test_the_size_adjusted_by_its_own_radius() -> None:
    report = report_of(guide("G10 P8 C-.005", x=AS_PRINTED), "turning-center", "8:radius=0,nose=0")
    assert (report.verdict, said(report)) == ("pass", [])
    assert report.polar_sections[0].radius == pytest.approx(-0.127)


# ---- which R ----


@pytest.mark.nightly
@looped(
    ("blocks", "radius"),
    [
        ("G10 P1 R4.\nT0101", 4),
        ("T0101\nG10 P1 R4.", 4),
        ("T0101\nG10 P10001 R4.", 4),
        ("G10 P10001 R4. Q0\nG10 P1 R-.1\nT0101", 3.9),
        ("G10 P1 R-.1\nG10 P10001 R4.\nT0101", 3.9),
        ("G10 P10001 R4.\nG10 P1 R.5\nT0101", 4.5),
        ("G10 P1 R4.\nG10 P1 C-.1\nG10 P1 C-.1\nT0101", 3.8),
        ("G10 P10001 R4.\nG10 P10001 C.5\nT0101", 4.5),
        ("G10 P1 R4.\nG10 P1 R5.\nT0101", 5),
        ("G10 P1 R-4.\nT0101", -4),
        ("G10 P2 R9.\nG10 P1 R4.\nG10 P3 R8.\nT0101", 4),
        ("G10 P1 R4000\nT0101", 4),
        ("G10 P1 R0 Q0\nT0101", 0),
        ("G10 P1 R-.1 Q0\nT0101", -0.1),
        # The form of mills, and that of other builders' lathes.
        ("G10 L12 P1 R4.\nT0101", 4),
        ("G10 L12 P1 R4.\nG10 L13 P1 R-.1\nT0101", 3.9),
        ("G10 L10 P1 R125.\nG10 L12 P1 R4.\nG10 L11 P1 R.1\nT0101", 4),
        ("G10 L10 P1 X0 Z0 R4. Q0\nG10 L11 P1 R-.1\nT0101", 3.9),
        # Variables.
        ("#2201=4.\nT0101", 4),
        ("#12001=4.\nT0101", 4),
        ("#2901=4.\n#2201=-.1\nT0101", 3.9),
        ("#17001=4.\n#12001=#12001-.1\nT0101", 3.9),
        ("#17001=4.\n#17001=#17001-.1\nT0101", 3.9),
        ("#1=2900\n#[#1+1]=8.*.5\nT0101", 4),
        ("IF[1EQ1]THEN #2901=4.\nT0101", 4),
        ("#1=0\nWHILE[#1LT4]DO1\n#1=#1+1\n#[2900+#1]=#1*4\nEND1\nT0101", 4),
        ("#1=4.\nG10 P1 R#1\nT0101", 4),
        ("#2901=#500\n#2901=4.\nT0101", 4),
    ],
    one_in=12,
)
@looped("inch", [False, True])
def test_the_radius_that_the_program_sets(blocks: str, radius: float, inch: bool) -> None:
    # What is set is read in the units of its block, whatever those of the section are.
    blocks, head = (f"G21\n{blocks}\nG20", MM.replace("G21", "G20")) if inch else (blocks, MM)
    assert taken(blocks, head=head) == (pytest.approx(radius), "program")


def test_lengths_are_in_the_units_of_their_block() -> None:
    head = MM.replace("G21", "G20")
    assert taken("G10 P1 R.25\nT0101\nG21", head=head) == (pytest.approx(6.35), "program")
    assert taken("G10 P1 R2500\nT0101\nG21", head=head) == (pytest.approx(6.35), "program")
    assert taken("#2901=.25\nT0101\nG21", head=head) == (pytest.approx(6.35), "program")


@pytest.mark.nightly
@looped(
    ("blocks", "expected"),
    [
        ("G10 P1 R4.", (4, "program")),
        ("G10 P10001 R3.", (3, "program")),
        ("G10 P1 C-.1", (2.9, "program")),
        ("#2201=#2201-.1", (2.9, "program")),
        ("G10 P1 R-.1", (2.9, "program")),
        # Wear that is cleared, other values of the offset, other offsets: R is still that of the job.
        ("G10 P1 X0 Z0 R0", (3, "job")),
        ("G10 P1 X-.1", (3, "job")),
        ("G10 P2 R4.", (3, "job")),
        ("G10 L2 P1 X0", (3, "job")),
        ("G10 L3 P1 R4.", (3, "job")),
        ("G10 L10 P1 R150.", (3, "job")),
        ("#2001=.1", (3, "job")),
        ("IF[1EQ2]THEN #2901=4.", (3, "job")),
    ],
    one_in=6,
)
@looped("first", [True, False])
def test_what_the_program_sets_takes_the_place_of_the_job(
    blocks: str, expected: tuple[float, str], first: bool
) -> None:
    blocks = f"{blocks}\nT0101" if first else f"T0101\n{blocks}"
    assert taken(blocks, job={"tools": {"1": {"radius": 3}}}) == (pytest.approx(expected[0]), expected[1])


@looped(
    ("blocks", "machine", "expected"),
    [
        ("G91 G10 P1 R-.1\nG90\nT0101", "siemens-iso", (2.9, "program")),
        ("G90 G10 P1 R4.\nT0101", "siemens-iso", (4, "program")),
        ("G10 L10 P1 R4.\nT0101", "haas-lathe", (4, "program")),
        ("G10 L11 P1 R-.1\nT0101", "haas-lathe", (2.9, "program")),
        ("#2201=4.\nT0101", "haas-lathe", (4, "program")),
        ("#2901=-.1\nT0101", "haas-lathe", (2.9, "program")),
        # G10 is something else, or says nothing without L.
        ("G10 P1 R4.\nT0101", "haas-lathe", (3, "command line")),
        ("G10 P1 R4.\nT0101", "okuma-osp", (3, "command line")),
        ("G10 P1 R4.\nT1 D1", "siemens-transmit", (3, "command line")),
    ],
)
def test_the_radius_on_other_controls(blocks: str, machine: str, expected: tuple[float, str]) -> None:
    trace = trace_of(f"O1\nG21 G94\n{blocks}\nM30\n", machine, "1:radius=3")
    assert trace.offsets.radius_of_offset[-2] == pytest.approx(expected[0])
    assert (trace.offsets.radius_set_in[-2] >= 0) == (expected[1] == "program")


def test_from_its_block_on_for_each_tool_and_program() -> None:
    blocks = ["T0101", "G10 P1 R4.", "G10 P2 R5.", "T0202", "T0101", "G10 P1 R6.", "M30", "O2", "T0101", "M30"]
    trace = trace_of("O1\nG21\n" + "\n".join(blocks), "fanuc", "1:radius=3")
    assert trace.offsets.radius_of_offset[2:].tolist() == pytest.approx(
        [3, 4, 4, 5, 4, 6, 6, float("nan"), 3, 3], nan_ok=True
    )


@pytest.mark.ci
def test_in_a_called_program_and_behind_a_block_skip() -> None:
    called = f"{MM}M98 P2\nT0101\n{SECTION}M30\nO2\nG10 P1 R4.\nM99\n"
    [section] = report_of(called).polar_sections
    assert (section.radius, section.radius_source) == (4, "program")
    skipped = f"{MM}/G10 P1 R20.\nT0101\n{SECTION}M30\n".replace("X60.", "X70.")
    rules = [found.rule for found in report_of(skipped, "fanuc", "1:radius=4").findings]
    assert "start-up-shorter-than-radius" in rules


def test_what_is_set_in_the_mode_is_one_finding_and_changes_nothing_else() -> None:
    blocks = SECTION.replace("C20.\n", "C10.\nG10 P1 R30.\nC20.\n")
    report = report_of(f"{MM}T0101\n{blocks}{SECTION}M30\n", "fanuc", "1:radius=4")
    assert [found.rule for found in report.findings] == ["offset-changed-in-polar"]
    assert [section.radius for section in report.polar_sections] == [4, 4]


# ---- what is not known ----


@pytest.mark.ci
@looped(
    ("block", "reason"),
    [
        (
            "G10 P8 R#500",
            "G10 P8 R#500 in line 3 sets it to a value that is not known; give its variables as [run.variables] in "
            "polarcheck.toml, "
            "or write the number",
        ),
        (
            "#2908=#501/2",
            "#2908=#501/2 in line 3 sets it to a value that is not known; give its variables as [run.variables] in "
            "polarcheck.toml, "
            "or write the number",
        ),
        (
            "G10 P8 C-.005",
            "G10 P8 C-.005 in line 3 sets wear or a difference alone; give --tool 8:radius=... or [tools.8] radius in "
            "polarcheck.toml",
        ),
        (
            "G10 P8 R.005",
            "G10 P8 R.005 in line 3 sets wear or a difference alone; give --tool 8:radius=... or [tools.8] radius in "
            "polarcheck.toml",
        ),
    ],
)
def test_a_radius_that_cannot_be_known(block: str, reason: str) -> None:
    report = report_of(guide(block).replace("#501\n2", "#501/2"), "turning-center", "8:nose=0")
    assert (report.verdict, said(report)) == ("unverified", [])
    assert {entry.reason for entry in report.not_evaluated} == {f"no radius for offset 8: {reason}"}
    assert report.polar_sections[0].radius_source == "none"


def test_what_is_not_known_is_not_that_of_the_job() -> None:
    assert taken("G10 P1 R#500/T0101", "fanuc", "1:radius=4") == (None, "none")
    assert taken("G10 P1 R#500/T0101", job={"run": {"variables": {"500": 5.0}}}) == (5, "program")


def test_a_nose_type_that_cannot_be_known_has_no_weight() -> None:
    found = reasons(guide("G10 P8 R.375 Q#500"), "turning-center")
    assert {matters for _, matters in found} == {False}
    assert any("no nose type for offset 8: G10 P8 R.375 Q#500 in line 3" in reason for reason, _ in found)


@looped(
    ("blocks", "nose"),
    [
        ("G10 P1 Q3\nT0101", 3),
        ("G10 P10001 Q0\nT0101", 0),
        ("G10 P1 Q3\nT0101\n#2301=0", 0),
        ("T0101\n#13001=9", 9),
        ("T0101\nG10 P2 Q3", 2),
        ("G10 L10 P1 Q3\nT0101", 3),
    ],
)
def test_the_nose_type(blocks: str, nose: int) -> None:
    assert trace_of(f"{MM}{blocks}\n", "fanuc", "1:nose=2").offsets.nose[-1] == nose


# ---- comments ----


@pytest.mark.nightly
@looped("block", ["G10 P8 R.375", "G10 P8 R.37", "G10 P10008 R.375 Q0/G10 P8 R-.005"], one_in=4)
@looped("first", [True, False])
def test_a_comment_that_agrees(block: str, first: bool) -> None:
    places = (block, "") if first else ("", block)
    program = guide(*places, comment=' (3/4" DIA. CUTTER)')
    for job in ({}, {"radius_from_comments": True}):
        report = report_of(program, "turning-center", job=job)
        assert (said(report), report.polar_sections[0].radius_source) == ([], "program")


@pytest.mark.nightly
@looped("first", [True, False])
@looped("tools", [(), ("8:radius=.375",)])
def test_a_comment_that_contradicts(first: bool, tools: tuple[str, ...]) -> None:
    places = ("G10 P8 R.25", "") if first else ("", "G10 P8 R.25")
    [found] = report_of(guide(*places, comment=' (3/4" DIA. CUTTER)'), "turning-center", *tools).findings
    assert found.message == (
        f"R 0.25 inch is set for offset 8 by G10 P8 R.25 in line {3 if first else 8}, the comment tells 0.375 inch: "
        '3/4" DIA. CUTTER; measure the cutter, and correct the one that is wrong'
    )


def test_a_comment_that_the_program_adjusts() -> None:
    report = report_of(
        guide(behind="G10 P8 C-.005", comment=' (3/4" DIA. CUTTER)'),
        "turning-center",
        job={"radius_from_comments": True},
    )
    assert said(report) == []
    assert report.polar_sections[0].radius == pytest.approx(0.37 * 25.4)


# ---- the size by the X offset ----

TOOL = "8:radius=.375,nose=0"


@looped(
    ("block", "word", "column"),
    [
        ("G10 P8 U-.005", "U-.005", 8),
        ("G10 P8 X-.005", "X-.005", 8),
        ("G10 P10008 U.01", "U.01", 12),
        ("G10 L11 P8 X.02 Z0", "X.02", 12),
        ("#2008=-.005", "#2008", 1),
        ("#2008=#2008-.005", "#2008", 1),
        ("#[10000+8]=.003", "#10008", 1),
        ("#2708=#2708+.01", "#2708", 1),
        ("#15008=#15008+.01", "#15008", 1),
        ("#2008=#500", "#2008", 1),
    ],
    one_in=12,
)
@looped("first", [True, False])
def test_a_size_that_the_x_offset_is_to_keep(block: str, word: str, column: int, first: bool) -> None:
    places = (block, "") if first else ("", block)
    report = report_of(guide(*places), "turning-center", TOOL)
    [found] = report.findings
    assert (found.rule, found.severity, found.line) == ("size-by-x-offset", "note", 3 if first else 8)
    assert found.column == column
    assert found.message.startswith(f"{word} changes X of offset 8, which shifts the shape and leaves its size")
    # By how much #500 shifts it nobody knows.
    assert report.verdict == ("unverified" if "#500" in block else "pass")


@looped(
    "block",
    [
        "G10 P8 X0 Z-.01",
        "G10 P8 U0",
        "G10 P10008 X-5.25 Z-3.",
        "G10 P8 X-5.25 Z-3. R.375",
        "G10 P9 U-.005",
        "G10 P8 W-.005 C.001",
        "G10 L2 P1 X0",
        "#2008=0",
        "#2009=-.005",
        "#2708=-5.25",
        "#2108=.1",
    ],
    one_in=12,
)
def test_offsets_that_keep_no_size(block: str) -> None:
    report = report_of(guide(block), "turning-center", TOOL)
    assert said(report) == []


@pytest.mark.nightly
def test_the_size_of_turned_diameters_and_on_other_machines() -> None:
    turned = "O1\nG20\nG10 P8 U-.005\nT0808\nG0 X2.\nG1 Z-1. F.01\nM30\n"
    assert "size-by-x-offset" not in [found.rule for found in report_of(turned, "turning-center").findings]
    for machine in ("fanuc", "mitsubishi-m700", "siemens-iso", "haas-lathe"):
        found = report_of(guide("G10 P8 U-.005"), machine, TOOL).findings
        assert "size-by-x-offset" not in [one.rule for one in found]


# ---- the wear in X of the job ----


@pytest.mark.nightly
@looped(
    ("table", "block", "expected"),
    [
        ("G10 P8 X-.005 Z0 R0 Q0\nG10 P10008 X-5.25 R.375 Q0", "", True),
        ("G10 P8 X-.005 R.375 Q0", "", True),
        ("G10 P8 X0 Z-.01 R0 Q0\nG10 P10008 X-5.25 R.375 Q0", "", False),
        ("G10 P8 X-5.25 R.375 Q0", "", False),
        ("G10 P8 X-152400 R.375 Q0\nG10 P9 X99999999999999999999 R.1", "", False),
        ("G10 P9 X-.005 R.1 Q0\nG10 P10008 X-5.25 R.375 Q0", "", False),
        # The program sets its own.
        ("G10 P8 X-.005 Z0 R0 Q0\nG10 P10008 X-5.25 R.375 Q0", "G10 P8 X0", False),
    ],
    one_in=2,
)
def test_the_wear_in_x_of_an_offset_table(tmp_path: Path, table: str, block: str, expected: bool) -> None:
    (tmp_path / "offsets.txt").write_text(f"%\n{table}\n%\n")
    (tmp_path / "polarcheck.toml").write_text("offsets = 'offsets.txt'\n")
    report = report_of(
        guide(block), "turning-center", job=OfPrograms(Options(config=tmp_path / "polarcheck.toml"))("part.nc").job
    )
    message = "the wear in X of the offset table, -0.005 inch, changes X of offset 8"
    assert [(found.rule, found.line, message in found.message) for found in report.findings] == (
        [("size-by-x-offset", 7, True)] if expected else []
    )
    assert report.polar_sections[0].radius == pytest.approx(9.525)


def test_the_wear_in_x_of_a_job() -> None:
    tools = {"8": {"radius": 9.525, "nose": 0, "x_wear": -0.1}}
    report = report_of(guide(), "turning-center", job={"units": "mm", "tools": tools})
    [found] = report.findings
    assert found.message.startswith("the wear in X of the offset table, -0.0039 inch, changes X of offset 8")
    assert not report_of(guide(), "fanuc", job={"units": "mm", "tools": tools}).findings


@pytest.mark.nightly
@looped("setting", ["G10 P#500 R.3", "#[#500+2200]=.3", "G10 L12 P#500 R4."])
def test_an_offset_whose_number_is_not_known(setting: str) -> None:
    """It may be the one in force: nobody can say that its R is as the job gives it."""
    program = f"O1\n{setting}\nT0808\nG98 G0 X60. C0\nG12.1\nG1 G41 X40. F200\nC-10.\nG40 X60.\nG13.1\nM30\n"
    report = report_of(program, "fanuc", "8:radius=4")
    (entry,) = [entry for entry in report.not_evaluated if entry.matters]
    reason = "#500 has no value for P#500 of line 2" if "P#" in setting else f"which offset {setting} in line 2 sets"
    assert entry.reason.startswith(reason)
    assert (report.verdict, report.polar_sections[0].radius) == ("unverified", 4.0)
    behind = program.replace(f"{setting}\n", "").replace("M30", f"{setting}\nM30")
    assert not [entry for entry in report_of(behind, "fanuc", "8:radius=4").not_evaluated if entry.matters]


def test_a_variable_whose_number_is_known_by_the_job_is_no_question() -> None:
    program = "O1\n#[#500+2200]=.1\nT0808\nG98 G0 X60. C0\nG12.1\nG1 G41 X40. F200\nC-10.\nG40 X60.\nG13.1\nM30\n"
    report = report_of(program, "fanuc", "8:radius=4", job={"run": {"variables": {"500": 8}}})
    assert report.polar_sections[0].radius == pytest.approx(4.1)
    assert not [entry for entry in report.not_evaluated if entry.matters]


@pytest.mark.nightly
@looped(
    ("calls", "number"),
    [
        ("T05.01 T00 M6", 5),
        ("T05.01 T02.01 M6/T02/G43 Z5. H#3020", 5),
        ("T012T000M6", 12),
        ("T105 T012 M6", 105),
        ("T05/T0 M6/T05/M6", 5),
        ("T0505 M6", 5),
        ("T0505", 5),
    ],
    one_in=3,
)
def test_t_beside_m6_is_the_tool_of_an_integrex(calls: str, number: int) -> None:
    """The first T of the block is the tool and the number of its R; the second one, and a T alone, prepare the next."""
    assert taken(calls, "mazak-integrex", f"{number}:radius=5", head="O1\nG21 G40 G97 G94 G17\n") == (5, "command line")
    program = f"O1\nG21 G40 G97 G94 G17\n{calls}\nG61.1\n{SECTION}M30\n".replace("/", "\n")
    found = {finding.rule for finding in report_of(program, "mazak-integrex", f"{number}:radius=5").findings}
    assert not found & {"word-repeated", "offset-number-missing", "unknown-code", "offset-changed-in-polar"}


def test_three_tools_are_no_tool_change_and_a_quick_turn_has_none() -> None:
    for machine, calls in (("mazak-integrex", "T1 T2 T3 M6"), ("mazak-quick-turn", "T0505 T0606")):
        report = report_of(f"O1\nG21\n{calls}\nM30\n", machine)
        assert [finding.rule for finding in report.findings] == ["word-repeated"]
