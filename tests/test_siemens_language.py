"""Words of the language of Siemens controls: what is told as wrong, what moves nothing, and what is not evaluated."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from cases import looped
from programs import report_of, trace_of

from polarcheck.foundation.finding import FileReport

#: The coverage counts all of its cases: each is a way of its own through the package.
pytestmark = pytest.mark.one_in(1)

MACHINE = "siemens-transmit"
PROGRAM = """T8 D1
G94 S2=1000 M2=3
DIAMOF
{before}G0 X40 C0 Z5
TRANSMIT
G17
{inside}G1 G42 X20 Y1 F300
Y10
X-10
Y-10
X20
Y1
G40 X40
TRAFOOF
M30
"""


def report(before: str = "", inside: str = "", machine: str = MACHINE, **more: Any) -> FileReport:
    text = PROGRAM.format(before=f"{before}\n" * bool(before), inside=f"{inside}\n" * bool(inside))
    return report_of(text, machine, "8:radius=4,nose=0", **more)


def rules(of: FileReport) -> list[str]:
    return [finding.rule for finding in of.findings]


# ---- habits of other languages ----


@pytest.mark.ci
@looped("block", ["R1 5", "N20 R99 .5", "r12 7", "R5"])
def test_a_parameter_takes_its_value_by_equal(block: str) -> None:
    assert rules(report(block)) == ["equal-sign-missing"]


@pytest.mark.nightly
@looped("block", ["R1=5", "R1 = -5", "R[3]=5", "R1=R2", "ROT RPL=10\nROT"])
def test_with_equal_nothing_is_told(block: str) -> None:
    assert rules(report(block)) == []


@pytest.mark.ci
def test_the_radius_of_an_arc_is_no_r() -> None:
    arc = "G1 X30 F300\nG3 X0 Y30 {}\nG1 X40 Y0"
    assert rules(report(inside=arc.format("R30"))) == ["equal-sign-missing"]
    assert rules(report(inside=arc.format("CR=30"))) == []
    assert rules(report(inside=arc.format("CR=R1+30"), before="R1=0")) == []


@pytest.mark.ci
@looped(
    ("before", "count"),
    [("(HEXAGON)", 1), ("(ONE)\nX50 (TWO)\n( THREE )", 3), ("N10 G0 X50 (RAPID)", 1)],
)
def test_text_in_parentheses_is_told_once(before: str, count: int) -> None:
    (finding,) = report(before).findings
    assert finding.rule == "comment-in-parentheses"
    assert finding.line == 4
    assert (f"in {count} blocks" in finding.message) == (count > 1)


@pytest.mark.nightly
@looped(
    "before",
    ["X=(R1+2)", "R1=(2+3)*4", 'MSG("(ROUGHING)")', "; (HEXAGON)", "CYCLE832(0.01,1)", "OSCTRL[Z]=(1+2,4)", "SETMS(2)"],
    one_in=2,
)
def test_parentheses_of_the_language_are_no_comment(before: str) -> None:
    assert rules(report(before)) == []


def test_behind_g291_and_in_the_iso_mode_it_is_a_comment() -> None:
    assert rules(report("G291\n(TEXT)\nG290")) == []
    assert rules(report("G291\n(TEXT)\nG290\n(MORE)")) == ["comment-in-parentheses"]
    iso = "G94\n(TEXT)\nG0 X60. C0\nG12.1\nG1 X40. F200\nC10.\nX60.\nG13.1\nM30\n"
    assert "comment-in-parentheses" not in rules(report_of(iso, "siemens-iso"))


# ---- predefined procedures and synchronized actions ----


@pytest.mark.nightly
@looped(
    "block",
    [
        'DELETE(RESULT,"/_N_WKS_DIR/_N_A_MPF")',
        'WRITE(RESULT,"LOG","PART DONE")',
        'READ(RESULT,"LOG",1,1,LINE)',
        "OSCTRL[Z]=(1+2,4)",
        "OSCTRL[Z] = (0, 16+32)",
        "OSP1[Z]=10 OSP2[Z]=20",
        "CANCEL(1,2)",
        "FNORM",
        "FPRAON(S1,S2)",
        "NEWCONF",
        "WHEN $AA_IW[X]>20 DO M8",
        "IDS=1 EVERY $A_IN[1]==1 DO $A_OUT[2]=1 $AC_MARKER[1]=2",
        "ID=2 FROM $A_IN[1]==1 DO POS[U]=100",
        "DO $R5=$AA_IM[Z]",
    ],
    one_in=9,
)
def test_what_moves_no_axis_of_the_plane_is_passed_over(block: str) -> None:
    for before, inside in ((block, ""), ("", block)):
        found = report(before, inside)
        assert (rules(found), found.verdict) == ([], "pass")


@pytest.mark.nightly
@looped(
    ("block", "reason"),
    [
        ("ID=1 WHENEVER ($R1==0) DO $AC_OVR=0", "synchronized action with $AC_OVR is not simulated"),
        ("IDS=1 EVERY $A_IN[1]==1 DO F=100", "synchronized action with F is not simulated"),
        ("WHEN TRUE DO POS[X]=3", "synchronized action with X is not simulated"),
        ("ID=3 WHEN $A_IN[1]==1 DO MOV[C]=1", "synchronized action with C is not simulated"),
        ("EVERY $A_IN[1]==1 DO DELDTG", "synchronized action with DELDTG is not simulated"),
        ('EXECSTRING("X50")', "EXECSTRING is not simulated"),
        ("GEOAX(2,Y)", "GEOAX is not simulated"),
    ],
    one_in=4,
)
def test_what_moves_the_axes_or_sets_the_feed_is_not_evaluated(block: str, reason: str) -> None:
    for before, inside in ((block, ""), ("", block)):
        found = report(before, inside)
        assert (rules(found), found.verdict) == ([], "unverified")
        assert reason in [missing.reason for missing in found.not_evaluated]


# ---- spindles ----


@pytest.mark.ci
@looped(
    ("before", "is_main"),
    [
        ("SETMS(3)\nM3 S2000", False),
        ("N10 SETMS(2) M3", False),
        ("SETMS(2)\nM3\nSETMS(1)", False),
        ("M3 S2000", True),
        ("SETMS(3)\nSETMS\nM3", True),
        ("SETMS()\nM4 S500", True),
        ("M3\nSETMS(3)\nM5", True),
    ],
    one_in=2,
)
def test_m3_is_that_of_the_master_spindle(before: str, is_main: bool) -> None:
    assert rules(report(before)) == ["main-spindle-running-at-entry"] * is_main


# ---- programs with parameters ----


@looped(
    ("call", "head", "end"),
    [
        ("CUT(20)", "PROC CUT(REAL A)", 20 + 3j),
        ("CUT(20,5)", "PROC CUT(REAL A, REAL B) DISPLOF", 20 + 5j),
        ("CUT(20)", "PROC CUT(REAL A, REAL B=7)", 20 + 7j),
        ("R1=20\nCUT(R1)", "PROC CUT(REAL AA, INT BB=4)", 20 + 4j),
    ],
)
def test_arguments_have_their_values(call: str, head: str, end: complex, tmp_path: Path) -> None:
    names = head.partition("(")[2].replace(",", " ").replace("=", " ").replace(")", " ").split()
    virtual = names[3] if len(names) > 3 else "3"
    body = f"{head}\nG1 X={names[1]} Y={virtual} F300\nRET\n"
    (tmp_path / "CUT.SPF").write_text(body)
    text = f"T8 D1\nG94\nDIAMOF\nG0 X40 C0 Z5\nTRANSMIT\nG17\n{call}\nTRAFOOF\nM30\n"
    trace = trace_of(text, MACHINE, job={"run": {"subprograms": [str(tmp_path)]}})
    assert trace.path.end[trace.path.on_plane].tolist() == [end]


def test_a_head_with_a_letter_is_read() -> None:
    assert rules(report_of("PROC X(REAL A)\n" + PROGRAM.format(before="", inside=""), MACHINE, "8:radius=4")) == []


# ---- what stands before and behind the sections of a whole program ----


@pytest.mark.nightly
@looped(
    "before",
    [
        "G0 SUPA X300 Z400",
        "SUPA G0 Z=R1",
        "G96 S150\nG94 S2=796 M2=3",
        "G96 S150 LIMS=3000\nG97",
        "POS[C]=0",
        "POSA[C]=30",
        'CYCLE95("CONTOUR",2,0.1,0.1,0,0.3,0.2,0.1,9)',
        "CYCLE97(2,1,0,-20,30,30,0,0,1.2,0.1,30,0,5,1,3,1)",
        "MCALL CYCLE83(5,0,2,-20)\nX30 C0\nX30 C90\nMCALL",
        "MCALL",
        "HOLES2(0,0,20,0,60,6)",
    ],
    one_in=3,
)
def test_what_stands_outside_the_mode_leaves_the_section_alone(before: str) -> None:
    found = report(before)
    assert (rules(found), found.verdict) == ([], "pass")


@pytest.mark.ci
@looped("block", ["CYCLE81(5,0,2,-20)", "HOLES1(0,0,20,0,60,6)"])
def test_a_cycle_matters_where_nothing_says_the_position_behind_it(block: str) -> None:
    text = PROGRAM.format(before="", inside="").replace("TRANSMIT", f"{block}\nTRANSMIT")
    assert report_of(text, MACHINE, "8:radius=4,nose=0").verdict == "unverified"
    assert report(inside=block).verdict == "unverified"


def test_g96_alone_is_still_in_force() -> None:
    assert rules(report("G94\nG96 S150")) == ["modal-state-wrong-at-entry"]


def test_x_may_be_open_at_transmit() -> None:
    """The first move in the mode positions both axes: public post, `T= D1`, `TRANSMIT`, `G0 X40 Y10`."""
    text = PROGRAM.format(before="", inside="G0 X40 Y0 Z5\n").replace("G0 X40 C0 Z5\nTRANSMIT", "G0 Z5\nTRANSMIT")
    found = report_of(text, MACHINE, "8:radius=4,nose=0")
    assert found.verdict == "pass"
    assert {finding.severity for finding in found.findings} <= {"note"}


@looped("block", ["G110 X0 Y0", "G53 G0 Z50", "SUPA G0 Z50"])
def test_poles_and_z_of_the_machine_may_stand_in_the_mode(block: str) -> None:
    assert rules(report(inside=f"{block}\nG0 Z5")) == []


def test_a_helix_is_an_ordinary_move() -> None:
    text = (
        "T8 D1\nG94\nDIAMOF\nG0 X20 C0 Z5\nTRANSMIT\nG17\nG1 X20 Y0 F300\nG3 X20 Y0 Z-5 I-20 J0\nG0 Z20\nTRAFOOF\nM30\n"
    )
    assert rules(report_of(text, MACHINE, "8:radius=4,nose=0")) == []


def test_call_block_runs_the_blocks_between_two_labels() -> None:
    contour = "LABEL1:\nG1 G42 X20 Y1 F300\nY10\nX-10\nY-10\nX20\nY1\nG40 X40\nLABEL0:\n"
    head, foot = "T8 D1\nG94\nDIAMOF\nG0 X40 C0 Z5\nTRANSMIT\nG17\n", "TRAFOOF\nM30\n"
    called = head + "CALL BLOCK LABEL1 TO LABEL0\n" + foot + contour + "M17\n"
    ours, theirs = (trace_of(text, MACHINE, "8:radius=4") for text in (called, head + contour + foot))
    assert ours.path.end[ours.path.on_plane].tolist() == theirs.path.end[theirs.path.on_plane].tolist()


# ---- messages ----


@pytest.mark.ci
@looped(
    "block",
    [
        "WHILE R1<5",
        "IF R1==1",
        "ENDIF",
        "LOOP",
        "FOR R1=1 TO 5",
        "X=R1+",
        "R[-1]=5",
        "R99999999=5",
        "X=(R1",
        "G0 X=R99",
    ],
    one_in=3,
)
def test_no_message_has_words_of_custom_macro(block: str) -> None:
    found = report(block)
    texts = [finding.message for finding in found.findings] + [missing.reason for missing in found.not_evaluated]
    for word in ("#", "custom macro", "macro statement", "500 = 1.5", "run.variables", "END of its own number", " DO "):
        assert not [text for text in texts if word in text]


# ---- blanks in numbers, and lists of axes ----


@pytest.mark.nightly
@looped("block", ["G1 X-10 10", "G1 X-5.1 0", "X5. 1", "N20 G1 Y4 .5 ; 3 4", "X1\t2"])
def test_a_blank_inside_a_number_is_a_syntax_error(block: str) -> None:
    assert "bad-number" in rules(report(block))
    assert "bad-number" not in rules(report(block, machine="siemens-iso"))
    assert "bad-number" not in rules(report(f"G291\n{block}\nG290"))


@looped("block", ["G1 X=15 0", "R1=5 X10 10", "R1=5 5"])
def test_so_it_is_beside_statements(block: str) -> None:
    assert rules(report(block)) == ["macro-syntax"]


@pytest.mark.ci
@looped("block", ["X 40", "X= 15", "Z -5", "N10 G1 X40 Y 1", "T 8", "G1 Z=5 ; 1 2"])
def test_a_blank_behind_an_address_is_none(block: str) -> None:
    assert rules(report(block)) == []


@pytest.mark.ci
@looped("block", ["OSCILL[Z]=(X)", "OSCILL[Z]=( X )", "OSCILL[Z]=(X,Y,Z)", "OSCILL[Z]=(C2)", "OSCILL[Z]=(SP1)"])
def test_a_list_of_axes_is_no_expression(block: str) -> None:
    of = report(block)
    assert (rules(of), [missing.reason for missing in of.not_evaluated if missing.matters]) == ([], [])


@pytest.mark.ci
def test_a_value_in_parentheses_still_is_one() -> None:
    assert rules(report("R1=(X)")) == ["macro-syntax"]
    assert rules(report("OSCTRL[Z]=(3+")) == ["macro-syntax"]


# ---- X of a program without DIAMON and DIAMOF ----


@pytest.mark.ci
@looped(
    ("words", "changes", "diameter"),
    [
        ("", {}, 62.4),
        ("", {"control": {"x": "diameter"}}, 31.2),
        ("", {"control": {"x": "radius"}}, 62.4),
        ("", {"parameters": {"20150[28]": 2}}, 31.2),
        ("", {"parameters": {"20150[28]": 1}}, 62.4),
        ("", {"control": {"x": "diameter"}, "parameters": {"20150[28]": 1}}, 31.2),
        ("DIAMON\n", {}, 31.2),
        ("DIAMOF\n", {"control": {"x": "diameter"}}, 62.4),
    ],
)
def test_x_of_the_owner_is_that_of_programs_without_a_word(
    words: str, changes: dict[str, Any], diameter: float
) -> None:
    trace = trace_of(f"{words}G0 X31.2 Z5\nM30\n", MACHINE, changes=changes)
    assert 2 * np.nanmax(trace.path.x) == pytest.approx(diameter)


# ---- spindles by their number ----


@pytest.mark.nightly
@looped(
    ("before", "is_said"),
    [
        ("S2=2000", True),
        ("S3 = 1500\nM1=5", True),
        ("N5 S2=500*4", True),
        ("S2=2000 M3=3", True),
        ("S2=2000 M2=3", False),
        ("M2=4\nS2=2000", False),
        ("S2=300\nS3=2000 M3=3", False),
        ("SETMS(2)\nS2=2000\nM3", False),
        ("S2=0", False),
        ("S2=R1", False),
        ("G26 S2=2000", False),
        ("G4 S2=3", False),
    ],
)
def test_a_spindle_with_a_speed_is_started_by_its_number(before: str, is_said: bool) -> None:
    text = PROGRAM.replace("S2=1000 M2=3", before).format(before="", inside="")
    found = rules(report_of(text, MACHINE, "8:radius=4,nose=0"))
    assert found == ["live-tool-stopped-in-cut"] * is_said


# ---- quotes of print ----


@pytest.mark.nightly
@looped("encoding", ["utf-8", "cp1252", "utf-16"])
@looped(
    "block",
    ["MSG(“ROUGH”)", "MSG(‘ROUGH’)", "MSG(„ROUGH (1); 2“)", "T=“MILL” D1", "MSG(“A”)\nMSG(“B”)", "MSG(”ROUGH”) ; A"],
)
def test_printed_quotes_are_named_once_and_read_as_plain_ones(block: str, encoding: str) -> None:
    text = PROGRAM.format(before=f"{block}\n", inside="").replace("T8 D1", "" if "T=" in block else "T8 D1")
    tools = "8:radius=4,nose=0", "MILL/1:radius=4,nose=0"
    found = report_of(text.encode(encoding), MACHINE, *tools)
    assert (rules(found), [missing for missing in found.not_evaluated if missing.matters]) == (["stray-character"], [])


@looped("block", ['MSG("TOOL “A” OR ‘B’")', "; “A” ‘B’", 'MSG("A") ; “B”'])
def test_printed_quotes_in_text_are_text(block: str) -> None:
    assert "stray-character" not in rules(report(block))


@looped("block", ["TN=’MILL’", "NOEX PUT ‘TEXT’", "VC1=‘5’"])
def test_so_they_are_on_an_okuma(block: str) -> None:
    assert rules(report_of(f"O1\nG0 X100 Z100\n{block}\nM2\n", "okuma-osp")) == ["stray-character"]
    plain = block.replace("’", "'").replace("‘", "'")
    assert rules(report_of(f"O1\nG0 X100 Z100\n{plain}\nM2\n", "okuma-osp")) == []
