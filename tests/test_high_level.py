"""Statements of a high-level language: each construct is simulated, told by its name, or harmless by the profile."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from cases import looped
from programs import moves_of, report_of, said, trace_of

from polarcheck.program.machines import profiles

#: The coverage counts all of its cases: each is a way of its own through the package.
pytestmark = pytest.mark.one_in(1)

OWN, ISO = "siemens-transmit", "siemens-iso"
NAN = float("nan")


def program(blocks: str) -> str:
    return blocks.replace(" / ", "\n") + "\n"


def executed(blocks: str, machine: str = OWN) -> list[str]:
    """The words of each executed row that has any."""
    trace = trace_of(program(blocks), machine)
    words, rows = trace.run.words, [[] for _ in range(len(trace))]  # type: list[list[str]]
    for row, address, value in zip(trace.run.row, words.address, words.value, strict=True):
        rows[row].append(f"{chr(address)}{value:.6g}")
    return [" ".join(row) for row in rows if row]


def told(blocks: str, machine: str = OWN) -> list[str]:
    """What is not evaluated."""
    return [entry.reason for entry in report_of(program(blocks), machine).not_evaluated]


#: Construct -> what is executed of it.
SIMULATED = {
    "R1=5 / G0 X=R1": ["G0 X5"],
    "R0=5 / G0 X=-R0": ["G0 X-5"],
    "R2=30 / G0 X=R2+5*SIN(R2)": ["G0 X32.5"],
    "R1=8 / G0 X=(R1+2)/2": ["G0 X5"],
    "R1=2 R2=R1+1 / G0 X=R1 Y=R2": ["G0 X2 Y3"],
    "R3=7 R1=3 / G0 X=R[R1]": ["G0 X7"],
    "R[1+1]=4 / G0 X=R2": ["G0 X4"],
    "G0 X=10 Y=-2.5": ["G0 X10 Y-2.5"],
    "G0 X=1EX1": ["G0 X10"],
    "g0 x=ic(5) y10": ["G0 X5 Y10"],
    "G0 C=DC(0) / G0 C=ACP(90) / G0 C=ACN(45)": ["G0 C0", "G0 C90", "G0 C45"],
    "G3 X1 Y2 I=AC(3) J=IC(4) CR=5": ["G3 X1 Y2 I3 J4 R5"],
    "R1=3 / M=R1 / S=R1*100 / F=R1+.5": ["M3", "S300", "F3.5"],
    "R1=1 / G=R1 X5": ["G1 X5"],
    "M1=3 S1=200": ["M3 S200"],
    "SPOS=45 / SPOS[1]=90 / SPOS=IC(10)": ["C45", "C90", "C10"],
    "C1=30": ["C30"],
    "G0 X=7 DIV 2 Y=7 MOD 4": ["G0 X3 Y3"],
    "G0 X=POT(3) Y=SQRT(16) Z=ABS(-2)": ["G0 X9 Y4 Z2"],
    "G0 X=TRUNC(-2.7) Y=ROUND(2.5) Z=EXP(0)": ["G0 X-2 Y3 Z1"],
    "G0 X=ATAN2(30,80) Y=ASIN(.5) Z=ACOS(0)": ["G0 X20.556 Y30 Z90"],
    "G0 X=MINVAL(3,2) Y=MAXVAL(3,2) Z=LN(1)": ["G0 X2 Y3 Z0"],
    "G0 X=COS(60) Y=TAN(45) Z=2*(3+1)": ["G0 X0.5 Y1 Z8"],
    "G0 X=12 B_AND 10 Y=12 B_OR 3 Z=12 B_XOR 10": ["G0 X8 Y15 Z6"],
    "G0 X='HA' Y='B101'": ["G0 X10 Y5"],
    "DEF REAL AA=1.5, BB / DEF INT CC=2 / DEF BOOL DD=TRUE / G0 X=AA Y=BB Z=CC+DD": ["G0 X1.5 Y0 Z3"],
    "GOTOF ON / X9 / ON: G0 X1": ["G0 X1"],
    "GOTOF N30 / X9 / N30 G0 X1": ["N30 G0 X1"],
    # Labels with the names of custom macro.
    "GOTOF END1 / X9 / END1: G0 X1": ["G0 X1"],
    "R1=1 / IF R1==1 GOTOF DO2 / X9 / N30 DO2 : G0 X1": ["G0 X1"],
    "R1=0 / END3: / R1=R1+1 / IF R1<2 GOTOB END3 / G0 X1": ["G0 X1"],
    "GOTO ON / X9 / ON: G0 X1": ["G0 X1"],
    "GOTOC NOWHERE / G0 X1": ["G0 X1"],
    "R1=5 / IF R1==5 GOTOF ON / X9 / ON: G0 X1": ["G0 X1"],
    "R1=0 / AGAIN: R1=R1+1 / G0 X=R1 / IF R1<3 GOTOB AGAIN": ["G0 X1", "G0 X2", "G0 X3"],
    "R1=0 / N5 R1=R1+1 / G0 X=R1 / IF (R1<2) AND NOT (R1>8) GOTOB N5": ["G0 X1", "G0 X2"],
    "R1=5 / IF R1<>5 / X9 / ELSE / G0 X1 / ENDIF": ["G0 X1"],
    "R1=5 / IF (R1>=5) OR (R1<=1) / G0 X1 / ELSE / X9 / ENDIF / G0 Y1": ["G0 X1", "G0 Y1"],
    "R1=5 / IF R1 / IF R1>9 / X9 / ENDIF / G0 X1 / ENDIF": ["G0 X1"],
    "R1=3 / WHILE R1>1 / R1=R1-1 / G0 X=R1 / ENDWHILE": ["G0 X2", "G0 X1"],
    "FOR R1=1 TO 2 / FOR R2=3 TO 4 / G0 X=R1 Y=R2 / ENDFOR / ENDFOR": [
        "G0 X1 Y3",
        "G0 X1 Y4",
        "G0 X2 Y3",
        "G0 X2 Y4",
    ],
    "FOR R1=3 TO 2 / X9 / ENDFOR / G0 X1": ["G0 X1"],
    "DEF INT NR / FOR NR=1 TO 2 / G0 X=NR / ENDFOR": ["G0 X1", "G0 X2"],
    "R1=0 / LOOP / R1=R1+1 / IF R1>2 GOTOF OUT / G0 X=R1 / ENDLOOP / OUT: G0 Y1": ["G0 X1", "G0 X2", "G0 Y1"],
    "R1=0 / REPEAT / R1=R1+1 / G0 X=R1 / UNTIL R1>=2": ["G0 X1", "G0 X2"],
    "PART: G0 X1 / G0 X2 / REPEAT PART P=2": ["G0 X1", "G0 X2"] * 3,
    "PART: G0 X1 / REPEAT PART": ["G0 X1"] * 2,
    "ONE: G0 X1 / TWO: G0 X2 / G0 X3 / REPEAT ONE TWO": ["G0 X1", "G0 X2", "G0 X3", "G0 X1", "G0 X2"],
    "ONE: G0 X1 / G0 X2 / REPEATB ONE P=2": ["G0 X1", "G0 X2", "G0 X1", "G0 X1"],
    "ONE: G0 X1 / ENDLABEL: G0 X2 / G0 X3 / REPEAT ONE": ["G0 X1", "G0 X2", "G0 X3", "G0 X1", "G0 X2"],
    "R2=2 / CASE R2 OF 1 GOTOF ONE 2 GOTOF TWO DEFAULT GOTOF ON / ONE: X9 / TWO: G0 X2 / ON: G0 Y1": [
        "G0 X2",
        "G0 Y1",
    ],
    "CASE 7 OF 1 GOTOF ONE DEFAULT GOTOF ON / ONE: X9 / ON: G0 Y1": ["G0 Y1"],
    ":10 G0 X=5": ["G0 X5"],
    "TRANSMIT / TRAFOOF": ["G12.1", "G13.1"],
    "TRANSMIT() / TRAFOOF()": ["G12.1", "G13.1"],
    "TRANSMIT(1) / trafoof": ["G12.1", "G13.1"],
    "G0 X5 ; TRANSMIT X=9": ["G0 X5"],
}
#: Construct -> what is told of it, by name.
NAMED = {
    "G0 C5=90": "C5, from line 1 on, is an axis that this lathe is not known to have",
    "T2=5": "T2=",
    "D2=1": "D2=",
    "G2 X1 Y2 I3 J4 TURN=2": "TURN=",
    "G2 X1 Y2 AR=90": "AR=",
    "G1 AP=30 RP=10": "AP=",
    "G1 X5 FB=100": "FB=",
    "CIP X1 Y2 I1=3 J1=4": "CIP",
    "CT X1": "CT",
    "ASPLINE X1": "ASPLINE",
    "KONT": "KONT",
    "DISC=50": "DISC=",
    "TRANSMIT(2) / TRAFOOF": "TRANSMIT(2)",
    "TRACYL(40)": "TRACYL",
    "CYCLE840(1,2,,3)": "CYCLE840",
    "CYCLE800()": "CYCLE800",
    "POCKET3(5,0)": "POCKET3",
    "MCALL CYCLE81(5,0,2)": "MCALL",
    'PCALL "/A/B"': "PCALL",
    "E_MI_CON(1)": "E_MI_CON",
    "F_MI_CON(1)": "F_MI_CON",
    "ID=1 WHENEVER $AA_IM[X]>5 DO $AC_OVR=0": "synchronized action with $AC_OVR",
    "$TC_DP6[1,1]=4": "$TC_DP6[1,1]=",
    "$P_UIFR[1]=CTRANS(X,10)": "$P_UIFR[1]=",
    "$MN_ANY=1": "$MN_ANY=",
    "$AA_OFF=1": "$AA_OFF=",
    "G0 X=$AA_IM[X]": "$AA_IM",
    "R1=$P_TOOLR": "$P_TOOLR",
    "G0 X=$MN_ANY": "$MN_ANY",
    "G0 X=GLOBAL_ONE": "GLOBAL_ONE",
    "GLOBAL_ONE=5": "GLOBAL_ONE=",
    "DEF REAL LIST[5]": "LIST[]",
    "LIST[1]=5": "LIST[1]=",
    "G0 X=LIST[1]": "LIST",
    "G0 X=OWN_FUNCTION(5)": "OWN_FUNCTION",
    "DEF STRING[9] TEXT / GOTOF TEXT": "TEXT",
    'GOTOF "ON"<<R1': 'GOTOF "ON"<<R1',
    "GOTOS": "GOTOS",
    "G291": "G291",
    "WHEN $AC_TIME>1 DO X=3": "synchronized action with X",
    "THIS IS A TEXT": "THIS IS A TEXT",
    "PROC ONE(VAR REAL AA)": "VAR",
    "SAVE": "SAVE",
    "DIAMCYCOF": "DIAMCYCOF",
    "X=CAC(3)": "CAC",
}
#: Constructs without bearing on the path, by macro.statements of the profile.
HARMLESS = [
    "STOPRE",
    "SOFT",
    "BRISK",
    "DRIVE",
    "SETMS(3)",
    "SETMS",
    'MSG("A ; B (C)")',
    'MSG("NO END',
    "MSG()",
    "G64 / G641 ADIS=0.05",
    "CFTCP",
    "FFWON",
    "FFWOF",
    "COMPOF",
    "NORM",
    "CUT2DF",
    "CDON",
    "LIMS=3000",
    "WAITM(1,1,2)",
    "M2=70",
    "M3=3",
    "M2=3 S2=1000",
    "S3=2000",
    "SPOS[2]=0",
    "SPOSA=90",
    'WORKPIECE(,"",,"CYLINDER",0,0,-50,-80,60)',
    'GROUP_BEGIN(0,"FACE",0,0)',
    "GROUP_END(0,0)",
    'F_HEAD("A",1)',
    'E_HEAD(0,"A")',
    "EXTERN POCKET(REAL,INT)",
    "CYCLE832(0.01,1,1)",
    "G290",
    "DIAMON / DIAMOF / DIAM90",
    "G0 C2=90",
    ";$PATH=/_N_WKS_DIR/_N_SHAFT_WPD",
    "AFTER: / G0 X5",
]


@pytest.mark.ci
@looped("blocks", SIMULATED, one_in=8)
def test_a_construct_is_simulated(blocks: str) -> None:
    report = report_of(program(f"{blocks} / M30"), OWN)
    assert executed(f"{blocks} / M30") == [*SIMULATED[blocks], "M30"]
    assert not report.not_evaluated
    assert not [finding for finding in report.findings if finding.severity != "note"]


#: Frames are simulated where the profile has words for them (test_frames.py), and told by their names elsewhere.
FRAMES = {
    "ATRANS X-2 Y10": "ATRANS",
    "TRANS": "TRANS",
    "ROT RPL=-45": "ROT",
    "AROT RPL=R1": "AROT",
    "SCALE X2": "SCALE",
    "MIRROR X0": "MIRROR",
    "G1 X5 G41 OFFN=1": "OFFN=",
}


@pytest.mark.nightly
@looped("blocks", FRAMES)
def test_frames_are_told_by_their_names_where_the_profile_has_no_words_for_them(blocks: str) -> None:
    assert any(entry.startswith(FRAMES[blocks]) for entry in told(f"{blocks} / M30", ISO))
    assert not [entry for entry in told(f"{blocks} / M30", OWN) if not entry.startswith("the value of RPL=R1")]


@pytest.mark.ci
@looped("blocks", NAMED, one_in=6)
def test_what_is_not_simulated_is_told_by_its_name(blocks: str) -> None:
    report = report_of(program(f"{blocks} / M30"), OWN)
    assert any(entry.reason.startswith(NAMED[blocks]) for entry in report.not_evaluated), report.not_evaluated
    assert not [finding for finding in report.findings if finding.severity == "error"]
    assert executed(f"{blocks} / M30")[-1] == "M30"


@pytest.mark.ci
@looped("blocks", HARMLESS, one_in=10)
@looped("machine", [OWN, ISO])
def test_what_has_no_bearing_is_silent(blocks: str, machine: str) -> None:
    if blocks == "G290" and machine == ISO:
        assert told("G290 / M30", ISO)
        return
    report = report_of(program(f"G0 X5 / {blocks} / G0 X7 / M30"), machine)
    assert not report.not_evaluated
    assert not [finding for finding in report.findings if finding.severity != "note"]
    assert executed(f"{blocks} / M30", machine)[-1] == "M30"


@pytest.mark.nightly
@pytest.mark.parametrize("name", [OWN, ISO])
def test_every_statement_of_a_profile_is_told_or_harmless(name: str) -> None:
    """By what the profile says of it, whatever stands behind it."""
    statements = profiles.load(name).machine.macro.statements
    native = profiles.load(name).machine.control.native_words
    for statement, effect in statements.items():
        written = (
            statement.replace("[*]", "[1]").replace("*", "X").replace("n=", "9=" if statement[1:] == "n=" else "n=")
        )
        if written in native or written in ("SPOS[1]=", "DO"):
            continue
        block = f"{written}1" if statement.endswith("=") else written
        # What was not executed is told whatever is asked.
        report = report_of(f"{block}\nM30\n", name, only=["empty-program"])
        found = [entry.reason for entry in report.not_evaluated]
        assert bool(found) == (effect not in ("none", "speeds", "calls")), (statement, found)


# ---- calls ----

CALLED = "%_N_TASCHE_SPF / PROC TASCHE(REAL AA, INT BB=4) SBLOF / DEF REAL CC=AA+1 / G0 X=AA Y=BB Z=CC / M17"
CALLS = {
    "TASCHE(3,5)": ["G0 X3 Y5 Z4", "M17"],
    "TASCHE(3)": ["G0 X3 Y4 Z4", "M17"],
    "R1=2 / TASCHE(R1*3,) P2": ["G0 X6 Y4 Z7", "M17"] * 2,
    'CALL "TASCHE"': ["G0 X0 Y4 Z1", "M17"],
    'CALL "/_N_SPF_DIR/_N_TASCHE_SPF"': ["G0 X0 Y4 Z1", "M17"],
    "tasche(1,1)": ["G0 X1 Y1 Z2", "M17"],
}


@pytest.mark.ci
@looped("call", CALLS)
def test_programs_are_called_by_name(call: str) -> None:
    whole = f"%_N_MAIN_MPF / {call} / M30 / {CALLED}"
    assert executed(whole) == [*CALLS[call], "M30"]
    assert said(report_of(program(whole), OWN)) == []


@looped("head", ["%_N_TASCHE_SPF", "%TASCHE_SPF", "% _N_TASCHE_SPF"])
def test_a_program_has_the_name_at_its_head(head: str) -> None:
    report = report_of(program(f"%_N_MAIN_MPF / TASCHE / M30 / {head} / G0 X=1/0 / M17"), OWN)
    assert [(finding.rule, finding.program) for finding in report.findings] == [("arithmetic-error", "TASCHE")]


def test_programs_are_called_by_l_and_have_variables_of_their_own() -> None:
    whole = "DEF REAL AA=5 / L100 P2 / G0 X=AA / M30 / %_N_L100_SPF / DEF REAL AA=7 / R1=AA / G0 X=R1 / RET"
    assert executed(whole) == ["G0 X7", "G0 X7", "G0 X5", "M30"]
    assert said(report_of(program(whole), OWN)) == []


def test_a_called_program_may_lie_in_a_folder(tmp_path: Path) -> None:
    for name, head in (("FLACHEN_26.SPF", ""), ("_N_OTHER_SPF", ""), ("L7.SPF", "%_N_L7_SPF\n")):
        (tmp_path / name).write_text(f"{head}G0 X6\nM17\n")
    job = {"run": {"subprograms": [str(tmp_path)]}}
    report = report_of("FLACHEN_26\nOTHER\nL7\nM30\n", OWN, job=job)
    assert said(report) == []
    assert trace_of("FLACHEN_26\nOTHER\nL7\nM30\n", OWN, job=job).blocks.word("X").tolist().count(6.0) == 3
    assert said(report_of("MISSING_1\nL8\nM30\n", OWN, job=job)) == [
        (1, "subprogram-missing"),
        (2, "subprogram-missing"),
    ]


# ---- faults ----


@pytest.mark.nightly
@looped(
    ("blocks", "expected"),
    [
        ("GOTOF NOWHERE / M30", [(1, "jump-target-missing")]),
        ("HERE: / GOTOF HERE / M30", [(2, "jump-target-missing")]),
        ("GOTOB THERE / THERE: M30", [(1, "jump-target-missing")]),
        ("GOTOF N7 / M30", [(1, "jump-target-missing")]),
        ("REPEAT NOWHERE / M30", [(1, "jump-target-missing")]),
        ("R1=1 / IF R1==1 / M30", [(2, "loop-unbalanced")]),
        ("ENDWHILE / M30", [(1, "loop-unbalanced")]),
        ("R1=1 / WHILE R1==2 / IF R1==1 / ENDWHILE / M30", [(3, "loop-unbalanced")]),
        ("X=(R1+2 / M30", [(1, "macro-syntax")]),
        ("R1= / M30", [(1, "macro-syntax")]),
        ("R1=5+ / M30", [(1, "macro-syntax")]),
        ("R1=ATAN2(5) / M30", [(1, "macro-syntax")]),
        ("R1=1/0 / M30", [(1, "arithmetic-error")]),
        ("HERE: G0 X5 / GOTOB HERE / M30", [(2, "endless-loop"), (3, "unreachable-block")]),
        ("LOOP / G0 X5 / ENDLOOP / M30", [(3, "endless-loop"), (4, "unreachable-block")]),
    ],
)
def test_a_fault_of_a_statement_is_one_finding(blocks: str, expected: list[tuple[int, str]]) -> None:
    found = [(line, rule) for line, rule in said(report_of(program(blocks), OWN)) if rule != "unreachable-block"]
    assert found == [one for one in expected if one[1] != "unreachable-block"]


@pytest.mark.ci
@looped(
    ("machine", "tool", "section"),
    [
        (OWN, "8/1:radius=4", "T8 D1 / G0 X60 Z5 / DIAMOF / TRANSMIT / G94 G1 X40 Y-20 F200 / G41 X12 Y-12 / X-12"
         " / {fault} / X12 / Y-25 / G40 X40 / TRAFOOF / M30"),
        ("fanuc", "1:radius=4,nose=0", "G98 T0101 / G0 X120. C0 Z5. / G12.1 / G1 X60. C-20. F200 / G41 X24. C-12."
         " / X-24. / {fault} / X24. / C-25. / G40 X80. / G13.1 / M30"),
    ], one_in=2,
)  # fmt: skip
@looped("value", ["", "12+", "[12"])
def test_where_a_word_cannot_be_read_nobody_knows_the_contour(
    machine: str, tool: str, section: str, value: str
) -> None:
    """What the contour does without the word is no second fault."""
    fault = f"Y={value}" if machine == OWN else f"C[{value}"
    whole = program(section.format(fault=fault))
    assert [finding.rule for finding in report_of(whole, machine, tool).findings] == ["macro-syntax"]


@looped(
    ("machine", "section"),
    [
        (OWN, "T1 D1 / G0 X60 Z5 / DIAMOF / TRANSMIT / G94 G1 X40 Y-20 F200 / X12 / Y=R99 / X20 / TRAFOOF / M30"),
        (
            "fanuc",
            "G98 T0101 / G0 X120. C0 Z5. / G12.1 / G1 X60. C-20. F200 / X50. / X24. / C#599 / X30. / G13.1 / M30",
        ),
    ],
)
def test_the_block_that_leaves_the_position_open_is_named(machine: str, section: str) -> None:
    reasons = [entry.reason for entry in report_of(program(section), machine).not_evaluated]
    assert any(f"{'Y=R99' if machine == OWN else 'C#599'} in line 7 leaves open" in reason for reason in reasons)
    assert not any("was not programmed before" in reason for reason in reasons)


@looped(("block", "closing"), [("X=(R1+2", ")"), ("X=AC(5", ")"), ("X=SIN(5", ")"), ("R[1+2=5", "]")])
def test_the_bracket_that_is_missing_is_the_one_to_write(block: str, closing: str) -> None:
    (finding,) = report_of(program(f"{block} / M30"), OWN).findings
    assert f"lacks a closing bracket {closing};" in finding.message


def test_a_parameter_that_does_not_exist_is_named_as_it_is_written() -> None:
    (finding,) = report_of("R1=-5\nX=R[R1]\nM30\n", OWN).findings
    assert (finding.line, finding.rule) == (2, "variable-out-of-range")
    assert finding.message.startswith("R[R1] (R-5) does not exist; this control has parameters from R0 on")


def test_words_of_the_language_were_misread() -> None:
    """M2=70 ended the program, words with = were dropped, ATRANS was T0000, SETMS no tool, D1 an error."""
    section = "G0 X40 Y0 / DIAMOF / TRANSMIT / G1 X=20 F200 / ATRANS X0 Y0 / G1 X20 Y0 / Y10 / TRAFOOF / M30"
    report = report_of(program(f"T1 D1 / M2=70 / SETMS(3) / {section}"), OWN, "1:radius=4")
    assert report.sections == 1
    assert not [finding.rule for finding in report.findings if finding.severity == "error"]
    assert not {"offset-changed-in-polar", "d-word-on-lathe"} & {finding.rule for finding in report.findings}
    trace = trace_of(program(f"T1 D1 / SETMS(3) / {section}"), OWN)
    assert (trace.tools.tool_called[trace.mode.in_polar] == trace.tools.tool_called[trace.mode.in_polar][0]).all()
    assert trace.blocks.word("X")[trace.mode.in_polar][0] == 20


EXAMPLE = """N10 T1 D1 G54 G17 G90 F5000 G94
N20 G0 X20 Z10 SPOS=45
N30 TRANSMIT
N40 ROT RPL=-45
N50 ATRANS X-2 Y10
N60 G1 X10 Y-10 G41 OFFN=1
N70 X-10
N80 Y10
N90 X10
N100 Y-10
N110 G0 Z20 G40 OFFN=0
N120 T2 D1 X15 Y-15
N130 TRAFOOF
N140 M30
"""


def test_the_example_of_the_manual_has_no_false_error() -> None:
    """A square by TRANSMIT with frames, after the pattern of the manual."""
    report = report_of(EXAMPLE.replace("N120 T2 D1 X15 Y-15\n", ""), OWN, "1:radius=2")
    # F5000 two millimeters from the center: the control slows down there.
    assert "c-feed-above-limit" in [one.rule for one in report.findings]
    assert not [one for one in report.findings if one.severity != "note"]


def test_the_dialect_keeps_its_own_words() -> None:
    text = """O0001
T0101
M2=3
MSG("FACE (A)")
#1=50.
G0 X=R1 Z#1 (COMMENT X=9)
IF [#1 EQ 50.] GOTO 10
X99.
N10 G0 Z5.
WHILE [#1 LT 52.] DO1
#1=#1+1.
END1
M98 P5
FLACHEN_26
M30
O0005
G0 X7.
M99
%_N_FLACHEN_26_SPF
G0 X8.
M17
"""
    report = report_of(text, ISO)
    assert [finding.rule for finding in report.findings if finding.severity != "note"] == []
    assert [x for x in trace_of(text, ISO).blocks.word("X").tolist() if x == x] == [7.0, 8.0]


def test_the_other_language_is_told_and_comes_back() -> None:
    assert any("G290" in reason for reason in told("G0 X5 / G290 / STOPRE / G291 / M30", ISO))
    assert not told("G0 X5 / G290 / STOPRE / M30", OWN)


# ---- twins ----

FANUC_CONTOUR = """G1 G42 X40. F200
C10.
G3 X20. C20. R10.
G1 X-40.
C-10.
G3 X-20. C-20. I10. J0
G1 X40.
C0
G40 X60.
"""
FANUC = f"O1\nG98 G40 T0101\nG0 X60. C0\nG12.1\n{FANUC_CONTOUR}{FANUC_CONTOUR}G13.1\nM30\n"
TWIN_OWN = """%_N_TWIN_MPF
DEF REAL HALF=20
R1=10 R2=R1*2 R5=0
T1 D1 G451
G0 X60 Y0
DIAMOF
TRANSMIT
NEXT:
R5=R5+1
G1 G42 X=HALF F=100+R1*10
IF R5==1
Y=IC(R1)
ELSE
Y10
ENDIF
G3 X=R1 Y=R2 CR=R1
G1 X=-R2
DOWN(R1+R2)
G3 X=AC(-10) Y=IC(-10) I=AC(-10) J=AC(-10)
G1 X=R2
Y0
G40 X30
IF R5<2 GOTOB NEXT
TRAFOOF
DIAMON
M30
%_N_DOWN_SPF
PROC DOWN(REAL STEP)
Y=IC(-STEP)
M17
"""
TWIN_ISO = """O1
R1=10 R2=R1*2 R5=0
G94 G90 G40 T0101
G0 X60. C0
G12.1
AGAIN: R5=R5+1
G1 G42 X=R2*2 F200
C=IC(R1)
G3 X=2*R1 C=R2 R10.
G1 X=-R2*2
C=AC(-R1)
G3 X=IC(R2) C=IC(-R1) I=AC(-R2) J=AC(-10)
FOR R7=1 TO 2
G1 X=IC(15*2)
ENDFOR
C0
G40 X60.
IF R5<2 GOTOB AGAIN
G13.1
M30
"""


@pytest.mark.nightly
@looped(("machine", "text"), [(OWN, TWIN_OWN), (ISO, TWIN_ISO)])
@looped("radius", [0, 4])
def test_a_program_and_its_twin_have_one_path(machine: str, text: str, radius: int) -> None:
    tool = f"1:radius={radius}"
    ours, twin = moves_of(text, machine, tool), moves_of(FANUC, "fanuc", tool)
    if machine == ISO:  # its last line is in two pieces
        keep = np.abs(ours.end - ours.start) > 0
        assert keep.all()
        assert ours.start[0] == pytest.approx(twin.start[0])
        assert set(np.round(twin.end, 3)) <= set(np.round(ours.end, 3))
        assert np.abs(ours.end - ours.start)[np.isnan(ours.center)].sum() == pytest.approx(
            np.abs(twin.end - twin.start)[np.isnan(twin.center)].sum()
        )
        return
    assert len(ours) == len(twin)
    for name in ("start", "end", "center", "feed", "c_feed"):
        np.testing.assert_allclose(getattr(ours, name), getattr(twin, name), atol=1e-9, err_msg=name)
    report = report_of(text, machine, tool)
    assert not [entry for entry in report.not_evaluated if entry.matters]
    assert not [finding for finding in report.findings if finding.severity == "error"]


def test_distances_of_words_count_beside_the_modal_ones() -> None:
    section = "G91 G1 X=AC(5) Y3 F100 / X1 Y=AC(2) / G90 X=IC(2) Y=IC(-1)"
    blocks = f"T1 D1 / G0 X20 Y0 / DIAMOF / TRANSMIT / {section} / TRAFOOF / M30"
    trace = trace_of(program(blocks), OWN)
    inside = trace.path.end[trace.mode.in_polar]
    np.testing.assert_allclose(inside, [5 + 3j, 6 + 2j, 8 + 1j])
    angles = trace_of(program("G0 C30 / G0 C=IC(15) / G91 C10 / C=DC(90) / M30"), OWN).path.c_angle
    np.testing.assert_allclose(angles[:4], [30, 45, 55, 90])


def test_a_diameter_of_coordinates_alone() -> None:
    blocks = "DIAM90 / G90 G0 X20 / X=IC(5) / G91 X1 / G90 X30 / DIAMON / X=IC(4) / DIAMOF / X7 / M30"
    x = trace_of(program(blocks), OWN).path.x
    np.testing.assert_allclose(x[1:9], [10, 15, 16, 15, 15, 17, 17, 7])


# ---- hostile ----


@pytest.mark.ci
@looped(
    "text",
    [
        "X=(" * 20000 + "\nM30\n",
        "R1=" + "(" * 50000 + "1" + ")" * 50000 + "\nM30\n",
        "R1=" + "-" * 50000 + "1\nM30\n",
        'MSG("' * 5000 + "\nM30\n",
        "HERE:\nGOTOB HERE\n",
        "HERE: R1=R1+1\nGOTOB HERE\n",
        "IF R1\n" * 3000 + "ENDWHILE\n" * 3000 + "M30\n",
        "LOOP\nR1=5\nR2=R2+1\nENDLOOP\nM30\n",
        "AA: REPEAT AA P=99999999\nM30\n",
        "AA: G0 X1\nREPEAT AA P=2\nREPEAT AA P=2\nREPEAT AA P=2\nM30\n",
        "=\n==\n=X\nX=\n[[[\n$\n''\n\"\nR[\nR[]=\nDEF\nPROC\nCASE\nFOR\nGOTOF\nIF\nREPEAT\nCALL\nT=\"\nM30\n",
        "".join(f"NAME_{number}=1\n" for number in range(2000)) + "M30\n",
        "L1\n" * 500 + "M30\n%_N_L1_SPF\nL1\nM17\n",
        "".join(f"%_N_P{number}_SPF\nP{number + 1}\nM17\n" for number in range(300)),
        "G1 X5 " + "(G290)" * 30000 + "\nM30\n",
        "DEF REAL " + ",".join(f"AA{number}" for number in range(20000)) + "\nM30\n",
    ],
    one_in=16,
)
def test_hostile_blocks_end_and_give_a_report(text: str) -> None:
    job = {"run": {"max_blocks": 2000, "max_statements": 20000}}
    report = report_of(text, OWN, job=job)
    assert report.blocks >= 0
    assert len(report.findings) < 5000
