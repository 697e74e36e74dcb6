"""Programs with statements of user tasks: each construct is simulated, told as not evaluated by name, or harmless."""

from __future__ import annotations

import re

import numpy as np
import pytest
from cases import looped
from programs import moves_of, report_of, said, tables_of, trace_of

from polarcheck.columns.trace import Trace
from polarcheck.foundation.finding import FileReport
from polarcheck.program.execution.programs import Program, find_programs

#: The coverage counts all of its cases: each is a way of its own through the package.
pytestmark = pytest.mark.one_in(1)

LATHE = "okuma-osp"
CUTTER = "1:radius=0,nose=0"
HEAD = "$PART.MIN%\nO1\nG97 G40 G94 G50 S2000\nM110\nT0101\nG0 X100. C0 Z5.\n"
HEAD += "SB=2000 M13\nG137 C0\nG17\nG101 X40. Y0 F500\n"
TAIL = "\nG101 X30. Y5. F200\nG136\nG0 Z100.\nM12\nM109\nM2\nOSUB\nG101 Y=5+LX\nRTS\nO2000\nG101 Y8.\nRTS\n%\n"
FIRST = HEAD.count("\n") + 1


def run(body: str) -> tuple[FileReport, Trace]:
    program = HEAD + body + TAIL
    return report_of(program, LATHE, CUTTER), trace_of(program, LATHE, CUTTER)


def path(trace: Trace) -> list[tuple[float, float]]:
    """The points of the polar section between its first move and its last."""
    ends = trace.path.end[trace.mode.in_polar & trace.axes.moves_plane]
    return [(round(point.real, 3), round(point.imag, 3)) for point in ends[1:-1].tolist()]


SIMULATED = {
    "X=20": [(20, 0)],
    "X = 20 Y=2": [(20, 2)],
    "VC1=20\nX=VC1": [(20, 0)],
    "vc1=20\nx=vc1": [(20, 0)],
    "V1=2 VC1=20\nX=VC1 Y=-V1": [(20, -2)],
    "NOEX VC1=20\nNOEX X=VC1": [(20, 0)],
    "N10 VC1=20\nN20 X=VC1": [(20, 0)],
    "DIA=20\nX=DIA": [(20, 0)],
    "DIA=20\nX[DIA]": [(20, 0)],
    "DIA=20 LX=2\nX=DIA/LX Y3.": [(10, 3)],
    "VC1=5\nX=10+VC1*2": [(20, 0)],
    "VC1=2 VC2=3\nX=[VC1+VC2]*4": [(20, 0)],
    "VC1=3\nX=VC1*[VC1+3]+[2]": [(20, 0)],
    "X=-[-20]": [(20, 0)],
    "X=SQRT[400]": [(20, 0)],
    "X=ABS[-20]": [(20, 0)],
    "X=MOD[23,20]+17": [(20, 0)],
    "X=17+23 MOD 20": [(20, 0)],
    "X=ROUND[19.6]": [(20, 0)],
    "VC1=ROUND[19.5]\nX=VC1": [(20, 0)],
    "Y=ROUND[-2.6]": [(40, -3)],
    "X=FIX[20.9]": [(20, 0)],
    "X=FUP[19.2]": [(20, 0)],
    "X=SIN[30]*40": [(20, 0)],
    "X=COS[60]*40": [(20, 0)],
    "X=TAN[45]*20": [(20, 0)],
    "X=BIN[32]": [(20, 0)],
    "VC1=BCD[20]\nX=VC1-12": [(20, 0)],
    "X=[12 AND 5]+16": [(20, 0)],
    "CLEAR\nDEF WORK\nPS LC,[-400,0],[400,19]\nEND\nDRAW\nX20.": [(20, 0)],
    "N1 CLEAR\nN2 DEF WORK\nN3 PS LC, [0,0], [26,30]\nN4 PS RC,[0,0],[26,9],0\nN5 END\nN6 DRAW\nX20.": [(20, 0)],
    "MSG (TEXT)\nNMSG\nX20.": [(20, 0)],
    "V1=NOT[0] V2=DROUND[20.12]\nX20.": [(20, 0)],
    "X=ATAN[1]": [(45, 0)],
    "X=ATAN[1]/[2]": [(22.5, 0)],
    "Y=ATAN2[-1,1]": [(40, -45)],
    "GOTO NEND\nX99.\nNEND X20.": [(20, 0)],
    "GOTO N100\nX99.\nN100 X20.": [(20, 0)],
    "GOTO 100\nX99.\nN100 X20.": [(20, 0)],
    "VC1=1\nIF [VC1 EQ 1] NEND\nX99.\nNEND X20.": [(20, 0)],
    "VC1=1\nIF[VC1 NE 2] GOTO NEND\nX99.\nNEND X20.": [(20, 0)],
    "VC1=1\nIF VC1 LT 2 GOTO NEND\nX99.\nNEND X=20": [(20, 0)],
    "VC1=1\nIF [VC1 GE 1] N100\nX99.\nN100 X20.": [(20, 0)],
    "VC1=1 VC2=2\nIF [VC1 EQ 1 AND VC2 EQ 2] NEND\nX99.\nNEND X20.": [(20, 0)],
    "VC1=1 VC2=2\nIF [[VC1 EQ 1] AND [VC2 GT 2]] NEND\nX20.\nNEND": [(20, 0)],
    "VC1=1\nIF [VC1 EQ 2] OR [VC1 LE 1] NEND\nX99.\nNEND X20.": [(20, 0)],
    "VC1=1\nIF [VC1 EQ 1 EOR VC1 EQ 1] NEND\nX20.\nNEND": [(20, 0)],
    "LX=1\nIF LX NEND\nX99.\nNEND X20.": [(20, 0)],
    "IF LX NEND\nX20.\nNEND": [(20, 0)],
    "VC1=0\nNLP Y=VC1+1\nVC1=VC1+1\nIF [VC1 LT 3] NLP": [(40, 1), (40, 2), (40, 3)],
    "CALL O2000": [(40, 8)],
    "CALL O2000 Q2": [(40, 8), (40, 8)],
    "CALL OSUB LX=3": [(40, 8)],
    "CALL OSUB Q2 LX=3": [(40, 8), (40, 8)],
    "CALL OSUB\n$ LX=3": [(40, 8)],
    "MODIN O2000\nX20.\nMODOUT\nX10.": [(20, 0), (20, 8), (10, 8)],
    "X20.\n$ Y3.": [(20, 3)],
    "NLAB X20. (X=5)": [(20, 0)],
    "/NLAB VC1=20\nX20.": [(20, 0)],
}


@pytest.mark.nightly
@looped("body", SIMULATED, one_in=18)
def test_it_is_simulated(body: str) -> None:
    report, trace = run(body)
    assert path(trace) == SIMULATED[body]
    assert {rule for _, rule in said(report)} <= {"unreachable-block", "path-through-center"}
    assert [entry.reason for entry in report.not_evaluated if entry.rule == "all"] == []


@looped("end", ["NEND M02", "/NEND X200 M30", "NEND M2 (END)"])
def test_a_name_and_the_end_of_the_program_stand_in_one_block(end: str) -> None:
    report = report_of(f"VC1=1\nG0 X200\nIF [VC1 EQ 1] NEND\nG0 X300\n{end}\n", "okuma-osp")
    assert (said(report), report.not_evaluated) == ([], [])


@pytest.mark.ci
def test_values_of_a_call_are_calculated_before_it_and_gone_behind_it() -> None:
    assert path(run("VC1=1\nCALL OSUB LX=VC1+2\nX=VC1*20")[1]) == [(40, 8), (20, 8)]
    assert said(run("CALL OSUB LX=3\nX=LX")[0]) == [(FIRST + 1, "vacant-variable")]
    assert path(run("LX=3\nCALL OSUB\nX=LX*10")[1]) == [(40, 8), (30, 8)]


#: Construct -> how it is named, and whether the verdict waits for it.
NAMED = {
    "VZOFX=10": ("VZOFX=10", True),
    "VZOFZ=10": ("VZOFZ=10", False),
    "VTOFX[5]=VTOFX[5]+.2": ("VTOFX[5]=VTOFX[5]+.2", True),
    "VZSHZ=VZSHZ+1": ("VZSHZ=VZSHZ+1", False),
    "VLMON[5]=30": ("VLMON[5]=30", False),
    "VDOUT[1]=1 VINTG=2": ("VDOUT[1]=1", False),
    "CALL O=VC1": ("CALL O=VC1", True),
    "GET VC1": ("GET VC1", True),
    "PUT 'A'": ("PUT 'A'", True),
    "READ 1": ("READ 1", True),
    "WRITE LX": ("WRITE LX", True),
    "PSELECT O1": ("PSELECT O1", True),
    "WHILE [VC1 LT 2]": ("WHILE", True),
    "TURN": ("TURN", True),
    "X20. TURN": ("TURN", True),
    "SB2000": ("SB2000", True),
    "X=": ("X=", True),
    "X==2": ("X=", True),
    "Y=VC1 X=": ("X=", True),
    "X=#1": ("X=", True),
    "IF [VC1 EQ 1]": ("IF [VC1 EQ 1]", True),
    "IF NEND": ("IF NEND", True),
    "GOTO VC1": ("GOTO VC1", True),
    "CALL": ("CALL", True),
    "DIA": ("DIA", True),
}


@pytest.mark.nightly
@looped("body", NAMED, one_in=6)
def test_it_is_named_where_it_is_not_simulated(body: str) -> None:
    report, _ = run(body)
    name, matters = NAMED[body]
    told = {entry.reason: entry.matters for entry in report.not_evaluated if entry.rule == "all"}
    assert told.get(f"{name} is not simulated") is matters
    assert report.verdict == ("unverified" if matters else "pass")


#: Words that belong to cycles, or that the control itself looks after.
@pytest.mark.ci
@looped("body", ["DA=1 X20.", "X20. QA=5", "SA=20 X20.", "SB=3000 X20.", "NAT03\nX20.", "NOEX X20."], one_in=2)
def test_it_is_harmless(body: str) -> None:
    report, trace = run(body)
    assert path(trace) == [(20, 0)]
    assert (report.verdict, said(report)) == ("pass", [])


@pytest.mark.ci
@looped(
    "body",
    [
        *("X=VC1", "X=VZOFX", "VC1=VTOFX[2]\nX=VC1", "X=V5+1", "VC1=1\nX=VC1*VSIOZ"),
        *("X=NOT[20]", "V1=NOT VC1\nX=V1+1", "X=DROUND[20.12]", "X=DFIX[20.12] Y3."),
    ],
    one_in=3,
)
def test_what_is_not_known_is_not_evaluated(body: str) -> None:
    report, trace = run(body)
    assert said(report) == []
    assert report.verdict == "unverified"
    assert re.search("nan", str(path(trace)))


def test_a_condition_with_a_value_that_is_not_known_is_said_to_be_open() -> None:
    report, trace = run("VC1=1\nIF [NOT[VC1] EQ 0] NEND\nX20.\nNEND")
    assert path(trace) == [(20, 0)]
    assert ["depends on a value that is not known" in entry.reason for entry in report.not_evaluated] == [True]


@pytest.mark.ci
@looped(
    ("arc", "sweep"),
    [
        ("G103 X0 Y20. L20.", 90),
        ("G103 X0 Y20. L20. CALRG", 270),
        ("CALRG G103 X=0 Y20. L=VC1", 270),
        ("G103 X-20. L20.", 180),
    ],
)
def test_a_word_takes_the_larger_of_two_arcs(arc: str, sweep: int) -> None:
    """An arc of 180 deg by L is a warning, one of more by the word for it is none."""
    program = HEAD + f"VC1=20\nX20.\n{arc}" + TAIL
    arcs = tables_of(program, LATHE, CUTTER)["arcs"]
    assert arcs.sweep[~np.isnan(arcs.sweep)].round(6).tolist() == [sweep]
    told = [one.severity for one in report_of(program, LATHE, CUTTER).findings if "arc" in one.rule]
    assert told == ["warning"] * (sweep == 180)


@pytest.mark.nightly
@looped(
    ("body", "rule"),
    [
        ("X=1/0", "arithmetic-error"),
        ("X=SQRT[-4]", "arithmetic-error"),
        ("X=[VC1+2", "macro-syntax"),
        ("VC1=5 X=[VC1+2", "macro-syntax"),
        ("VC1=12 AND 10+1", "ambiguous-precedence"),
        ("X=LX", "vacant-variable"),
        ("GOTO NFAR", "jump-target-missing"),
        ("GOTO N77", "jump-target-missing"),
        ("IF [1 EQ 1] NFAR", "jump-target-missing"),
        ("CALL O77", "subprogram-missing"),
        ("CALL OFAR", "subprogram-missing"),
    ],
    one_in=5,
)
def test_a_fault_is_one_finding_in_its_block(body: str, rule: str) -> None:
    assert said(run(body)[0])[0] == (FIRST, rule)
    assert {other for _, other in said(run(body)[0])} <= {rule, "unreachable-block", "polar-never-left"}


def test_six_digits_of_t_are_offset_of_r_tool_and_tool_offset() -> None:
    trace = trace_of("O1\nT020105\nM1\nT010203\nM1\nT000304\nM1\nT0405\nM2\n", LATHE, "2:radius=3")
    rows = trace.blocks.has("T")
    assert trace.tools.tool[rows].tolist() == [1, 2, 3, 4]
    assert trace.tools.offset_number[rows].tolist() == [2, 1, 0, 5]
    assert trace.tools.tool_offset_number[rows].tolist() == [5, 3, 4, 5]
    assert trace.compensation.radius[rows].tolist()[0] == 3
    assert trace_of("O1\nT020105\nM30\n").tools.offset_number.tolist()[1:] == [5, 5]


def test_names_are_those_of_programs_and_blocks() -> None:
    """They are no bad numbers, wherever they stand, and a block with a name keeps its words."""
    tables = tables_of("$A.MIN%\nOFACE\nNAT01 G81\nG85 NAT01 D4 F.35 U.4 W.1\nNEND M2\n%\n", LATHE)
    assert not tables["words"].is_unreadable.any()
    assert tables["trace"].run.words.address.tobytes() == b"GGDFUWM"
    assert [program.name for program in tables_names("OFACE (TOP)\nM2\nO12\nM2\n")] == ["OFACE", None]
    assert tables_names("$A.MIN%\nO1\nM2\n%\n")[0].has_head


def tables_names(program: str) -> list[Program]:
    return find_programs(trace_of(program, LATHE).text).programs


# ---- the same part in both languages ----

CONTOUR = """{head}
G0 X120. C0 Z5.
{on}
{line} X{x60} {axis}0 F1500
{line} {side} X{x20} {axis}0 F200
{line} {axis}{ten}
{ccw} X{x10} {axis}{twenty} {arc}10.
{line} X-{x20}
{call}
{line} {axis}0
{line} G40 X{x60}
{off}
G0 Z100.
M5
{end}
"""
OWN = CONTOUR.format(
    head="$TWIN.MIN%\nO1\nVC1=10 VC2=VC1*2\nHALF=[VC2+20]/2\nG97 G40 G94\nM110\nT010101\nSB=1000 M13",
    on="G137 C0\nG17",
    off="G136",
    line="G101",
    ccw="G103",
    axis="Y",
    arc="L",
    side="{side}",
    x60="60.",
    x20="=VC2 ",
    x10="=VC1 ",
    ten="=VC1",
    twenty="=HALF",
    call="VC5=0\nNLP CALL ODOWN LX=VC2\nVC5=VC5+1\nIF [VC5 LT 1] NLP\nIF [VC5 EQ 1] NEND\nX99.\nNEND",
    end="M12\nM109\nM2\nODOWN\nIF [LX GT 100] NSKP\nG101 Y=-LX\nG101 X=LX\nNSKP RTS",
).replace("X-=VC2 ", "X=-VC2 ")
FANUC = CONTOUR.format(
    head="O1\nG97 G40 G98\nT0101\nM3 S1000",
    on="G12.1",
    off="G13.1",
    line="G1",
    ccw="G3",
    axis="C",
    arc="R",
    side="{side}",
    x60="120.",
    x20="40.",
    x10="20.",
    ten="10.",
    twenty="20.",
    call="M98 P2",
    end="M30\nO2\nG1 C-20.\nG1 X40.\nM99",
)


@pytest.mark.nightly
@looped("side", ["G41", "G42"], one_in=2)
@looped("radius", ["0", "4"])
def test_a_program_and_its_twin_have_one_tool_center_path(side: str, radius: str) -> None:
    tool, changes = f"1:radius={radius},nose=0", {"compensation": {"read_ahead": 10}}
    own = moves_of(OWN.replace("{side}", side), LATHE, tool)
    twin = moves_of(FANUC.replace("{side}", side), "fanuc", tool, changes=changes)
    assert len(own.start) == len(twin.start) > 7
    for column in ("start", "end", "kind", "feed"):
        np.testing.assert_allclose(getattr(own, column), getattr(twin, column), atol=1e-9)
    np.testing.assert_allclose(np.nan_to_num(own.center), np.nan_to_num(twin.center), atol=1e-9)
    assert said(report_of(OWN.replace("{side}", "G42"), LATHE, tool)) == []


def test_the_direction_of_the_new_axis_turns_the_whole_plane() -> None:
    plain, turned = (
        trace_of(OWN.replace("{side}", "G42").replace("G137 C0", on), LATHE, CUTTER) for on in ("G137 C0", "G137 C90.")
    )
    inside = plain.mode.in_polar & plain.axes.moves_plane
    np.testing.assert_allclose(turned.path.c_angle[inside], plain.path.c_angle[inside] + 90)


# ---- hostile files ----


@pytest.mark.nightly
@looped(
    "program",
    [
        "VC1=VC1+1\n" * 1_500,
        "X=" + "[" * 80_000 + "\n",
        "X=" + "[" * 10_000 + "1" + "]" * 10_000 + "\n",
        "X=" + "1+" * 80_000 + "1\n",
        "IF [" + "1 EQ 1 AND " * 50_000 + "1 EQ 1] NEND\n",
        "N" * 300_000 + "\n",
        "X=" + "A" * 300_000 + "\n",
        "CALL O" + "A" * 300_000 + "\n",
        "NLP GOTO NLP\n" * 1000,
        "NA GOTO NB\nNB GOTO NA\n",
        "VC1=0\nNA VC1=VC1+1\nGOTO NA\n",
        "OA1\nCALL OA1\nRTS\n",
        "$" * 40_000 + "\n" + "\n$" * 40_000,
        "NAT01 " * 40_000 + "\n",
        "X=VC1 " * 40_000 + "\n",
        "=" * 40_000 + "\n",
    ],
    ids=range(16),
    one_in=16,
)
def test_it_ends_in_bounded_time(program: str) -> None:
    report = report_of(HEAD + program + "G136\nM2\n", LATHE, CUTTER)
    assert max((len(entry.reason) for entry in report.not_evaluated), default=0) < 1000
    assert max((len(found.message) for found in report.findings), default=0) < 2000


def test_a_jump_to_itself_is_one_endless_loop() -> None:
    assert said(report_of("O1\nNBAC GOTO NBAC\nM2\n", LATHE))[0] == (2, "endless-loop")


@pytest.mark.ci
@looped("stop", ["M1", "M01", "M0", "/CALL OBAR\nM1"])
def test_a_jump_back_over_a_stop_begins_the_next_part(stop: str) -> None:
    """The frame of shop programs with a bar feeder: no loop that never ends, and no section that runs twice."""
    frame = f"$A.MIN%\n{stop}\nNBAR\nCLEAR\nDEF WORK\nPS LC,[-400,0],[400,19]\nEND\nDRAW\n{stop}\n"
    program = frame + "".join(HEAD.splitlines(keepends=True)[2:]) + "G101 X30.\nG136\nM12\nM109\nM5\nGOTO NBAR\n%\n"
    report = report_of(program, LATHE, CUTTER)
    assert {rule for _, rule in said(report)} <= {"subprogram-missing", "program-end-missing"}
    assert report.sections == 1


@looped("jump", ["GOTO NCUT", "IF [1 EQ 1] NCUT", "IF [1 EQ 1] GOTO NCUT"])
def test_a_jump_is_shown_with_the_name_that_it_goes_to(jump: str) -> None:
    (finding,) = (
        one for one in report_of(f"O1\nNCUT G0 X100.\n{jump}\nM2\n", LATHE).findings if one.rule == "endless-loop"
    )
    assert finding.message.startswith(f"{jump} comes back here")
