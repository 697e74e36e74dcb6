"""Offset tables as controls punch them out, and their pages as text: what is taken, and what is told of the rest."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from cases import looped
from click.testing import CliRunner
from polarcheck.errors import JobError

from polarcheck.commands import main
from polarcheck.program.machines import offset_table

pytestmark = pytest.mark.usefixtures("own_folder")

NAME = "TOOLOFST.TXT"


def table(text: str | bytes, **more: Any) -> dict[str, tuple[float, int | None]]:
    """R and T by number."""
    Path(NAME).write_bytes(text if isinstance(text, bytes) else text.encode())
    return {
        number: (tool.radius, tool.nose)
        for number, tool in offset_table.read_offset_table(Path(NAME), NAME, **more).items()
    }


def refusal(text: str, **more: Any) -> str:
    with pytest.raises(JobError) as told:
        table(text, **more)
    return str(told.value)


# ---- punched out ----

LATHE = "G10 P10008 X-110.25 Z-55. R4. Q0\nG10 P8 X0. Z0. R-.05 Q0\nG10 P10012 X0 Z0 R.4 Q3\n"


@looped(
    "text",
    [
        LATHE,
        f"%\nO9999(OFFSETS)\n{LATHE}M30\n%\n",
        f"%\nO9999\n{LATHE}%\n\x1a",
        f"%\r\n:9999\r\n{LATHE}%\r\n".replace("\n", "\n\r\r"),
        LATHE.replace("\n", "\r"),
        LATHE.replace("G10", "N10 G90 G10").replace("\n", " (TOOL);\n"),
        LATHE.replace("\n", ""),
        LATHE.replace(" ", ""),
        LATHE.lower(),
        "(G10 P10008 R99.)\n" + LATHE,
        "G10 P0 X12.5 Z3.\nG10 L2 P1 X0 Z0\n" + LATHE,
        LATHE.encode("utf-16"),
        b"\xef\xbb\xbf" + LATHE.encode(),
        b"\0\0\0%\n(M\xdcLLER)\n" + LATHE.encode(),
    ],
)
def test_offsets_of_a_lathe_are_those_of_p_and_r(text: str | bytes) -> None:
    assert table(text) == {"8": (3.95, 0), "12": (0.4, 3)}


def test_of_the_memory_with_four_kinds_the_radius_is_that_of_d() -> None:
    """L10 and L11 are lengths there, L12 the geometry of the radius, L13 its wear."""
    text = "G10 L10 P1 R120.5\nG10 L11 P1 R-.1\nG10 L12 P1 R5.\nG10 L13 P1 R-.02\nG10 L10 P2 R80.\nG10 L12 P2 R3.\n"
    assert table(text) == {"1": (4.98, None), "2": (3.0, None)}


def test_of_a_lathe_with_two_kinds_l10_is_the_geometry() -> None:
    assert table("G10 L10 P8 X1. R4. Q3\nG10 L11 P8 X.05 R.1\n") == {"8": (4.1, 3)}


def test_of_two_blocks_for_one_value_the_last_counts() -> None:
    assert table("G10 P10008 R4.\nG10 P10008 R5.\n") == {"8": (5.0, None)}


@looped(
    ("text", "told"),
    [
        (f"{LATHE}T0808\n", f"{NAME}:4: expected a block such as G10 P10008 R0.375 Q0, found T0808"),
        (f"%\n{LATHE}G10 L50\n", f"{NAME}:5: P, the number of the offset, is missing: G10 L50"),
        (f"{LATHE}G10 L3 P1 R5.\n", f"{NAME}:4: L is known of 1, 2, 10 to 13 and 20: G10 L3 P1 R5."),
        (f"{LATHE}G10 P8 C.1\n", f"{NAME}:4: C changes R by a step, and R before it is not known: G10 P8 C.1"),
        (f"{LATHE}G10 P[#1] R5.\n", f"{NAME}:4: expected a block such as"),
        (f"{LATHE}G10 G91 P1 R5.\n", f"{NAME}:4: expected a block such as"),
        (f"{LATHE}G10 P10009 R4000.\n", f"{NAME}:4: offset 9: radius: expected a number from -1000 to 1000"),
        ("G10 L10 P1 X5.\n", "no offsets found; X and Z alone say nothing of R and T"),
        ("G20\n" + LATHE, f'{NAME}:1: G20: the table is in inch; give units = "inch" beside offsets'),
    ],
)
def test_what_is_not_understood_is_told_with_its_line(text: str, told: str) -> None:
    assert told in refusal(text)


def test_units_of_the_table_are_those_that_are_said() -> None:
    assert table("G21\n" + LATHE, units="mm") == table(LATHE)
    assert "G21: the table is in mm" in refusal("G21\n" + LATHE, units="inch")


# ---- a page as text ----

PAGE = """OFFSET / GEOMETRY            O1234 N00000
NO.       X         Z        R     T
G 001   -110.250  -55.000   0.800  3
G 002      0.000    0.000   0.000  0
G 008    -95.100  -40.000   4.000  0
"""
WEAR = """OFFSET / WEAR
NO.       X         Z        R     T
W 001     0.100    0.000   0.000  3
W 008     0.000    0.000  -0.050  0
ACTUAL POSITION (RELATIVE)
U   0.000    W   0.000
"""


def test_a_page_of_the_control_is_taken_as_it_stands() -> None:
    assert table(PAGE) == {"1": (0.8, 3), "2": (0.0, 0), "8": (4.0, 0)}
    assert table(PAGE + WEAR) == {"1": (0.8, 3), "2": (0.0, 0), "8": (3.95, 0)}
    assert table((PAGE + WEAR).replace("G 0", "0").replace("W 0", "0")) == table(PAGE + WEAR)
    Path(NAME).write_text(PAGE + WEAR)
    assert offset_table.read_offset_table(Path(NAME), NAME)["1"].x_wear == 0.1


@looped(
    "text",
    [
        "8 -95.1 -40.0 4.0 0\n12 0 0 0.4 3\n",
        "8\t-95,1\t-40,0\t4,0\t0\n12\t0\t0\t0,4\t3\n",
        "8;-95,1;-40,0;4,0;0\r\n12;0;0;0,4;3\r\n",
        "8,-95.1,-40.0,4.0,0\n12,0,0,.4,3\n",
        "8, -95.1, -40.0, 4.0, 0\n12, 0, 0, .4, 3\n",
        "008 -95,1 -40,0 4,0 0\n012 0 0 ,4 3\n",
        "G008 -95.1 -40. 4. 0.\nG012 0. 0. .4 3.\n",
        "Number;T;R\n8;0;4,0\n12;3;0,4\n",
        "NO\tX-AXIS\tZ-AXIS\tRADIUS\tTIP\n8\t1\t2\t4.0\t0\n12\t1\t2\t0.4\t3\n",
        '"No.","X","Z","Nose R","T"\n"8","1.0","2.0","4.0","0"\n"12","1.0","2.0","0.4","3"\n',
        "NO. X Y Z R T\n8 1. 2. 3. 4. 0\n12 1. 2. 3. .4 3\n",
        "8 -95.1 -40.0 4.0 0\n\n12 0 0 0.4 3\n\x1a",
    ],
)
def test_columns_are_parted_and_named_in_many_ways(text: str) -> None:
    assert table(text) == {"8": (4.0, 0), "12": (0.4, 3)}


def test_the_columns_of_a_fagor_control_are_read_by_their_names() -> None:
    assert table("D X Z R F I K\n8 -95.1 -40. 4. 3 .1 .2\n12 0. 0. .4 0 0. 0.\n") == {
        "8": (4.0, None),
        "12": (0.4, None),
    }


@looped(
    ("text", "told"),
    [
        (PAGE + "MILL 12 MM\n", f"{NAME}:6: expected an offset in columns (NO. X Z R T), found MILL 12 MM"),
        (PAGE + "G 009 1. 2. 3. 4. 5. 6.\n", f"{NAME}:6: expected NO. X Z R T, found G 009 1. 2. 3. 4. 5. 6."),
        (PAGE + "G 009 0.0 0.0 four 0\n", f"{NAME}:6: expected a number as R, found FOUR"),
        (PAGE + "G 009 0.0 0.0 4.0 12\n", f"{NAME}:6: offset 9: nose: expected a whole number from 0 to 9, found 12"),
        ("8,1,5,2,5,4,0,0\n", f"{NAME}:1: expected NO. X Z R T, found 8,1,5,2,5,4,0,0"),
        ("NO R R\n8 4. 4.\n", "two columns are R"),
        ("hello\n", "no offsets found; expected blocks such as G10 P10008 R0.375 Q0, or columns NO. X Z R T"),
        ("", "no offsets found"),
        ("NO X Z R T\n", "no offsets found"),
    ],
)
def test_a_line_among_the_offsets_that_is_none_is_told(text: str, told: str) -> None:
    assert told in refusal(text)


# ---- tool data of Siemens controls ----

TOOL_DATA = """%_N_TO1_TOA
;$PATH=/_N_NC_ACT_DIR
CHANDATA(1)
$TC_TP1[8]=1
$TC_DP1[8,1]=120
$TC_DP2[8,1]=9
$TC_DP3[8,1]=104.2
$TC_DP6[8,1]=4.0 ; $TC_DP6[8,1]=9
$TC_DP15[8,1]=-0.05
$TC_DP6[12,2]=0.4 $TC_DP1[12,2]=500 $TC_DP2[12,2]=3
M30
"""


@looped(
    "text",
    [
        TOOL_DATA,
        TOOL_DATA.replace("\n", "\r\n"),
        TOOL_DATA.replace("\n", "\r"),
        TOOL_DATA.replace("$", "N10 $").replace("=", " = ").replace("[", " [ ").replace(",", " , "),
        TOOL_DATA.lower(),
        "$TC_DP6[8,1]=4\n$TC_DP6[12,2]=.4\n$TC_DP1[8,1]=145.\n$TC_DP15[8,1]=-.05\n$TC_DP2[12,2]=3.\n$TC_DP1[12,2]=510",
    ],
)
def test_tool_data_give_r_of_each_edge_with_its_wear(text: str) -> None:
    assert table(text) == {"8": (3.95, 0), "12/2": (0.4, 3)}


@looped(
    ("text", "expected"),
    [
        ('$TC_TP2[3470]="mill_8"\n$TC_DP6[3470,1]=4.\n', {"MILL_8": (4.0, None)}),
        ('$TC_DP6[7,2]=4.\n$TC_TP2[7]="MILL;8"\n', {"MILL;8/2": (4.0, None)}),
        ("$TC_DP1[3,1]=700\n$TC_DP6[3,1]=80.\n$TC_DP6[4,1]=2.", {"4": (2.0, None)}),
        ("$TC_DP1[3,1]=205\n$TC_DP2[3,1]=9\n$TC_DP6[3,1]=2.", {"3": (2.0, None)}),
    ],
)
def test_tool_data_name_tools_and_their_types(text: str, expected: dict[str, Any]) -> None:
    assert table(text) == expected


@looped(
    ("text", "expected"),
    [
        ("$TC_DP6[8,1]=4.\n$TC_DP15[R103,1]=0.\n", f"{NAME}:2: expected the number of the tool"),
        ("$TC_DP6[8,EDGE]=4.\n", f"{NAME}:1: expected the number of the edge"),
        ("$TC_DP6[8,1]=R1\n", f"{NAME}:1: expected a number, such as $TC_DP6[8,1]=4.0, found $TC_DP6[8,1]=R1"),
        ("$TC_DP6[8,1]=4000.\n", f"{NAME}:1: offset 8: radius"),
        ("$TC_DP3[8,1]=104.\n", "no offsets found"),
        ("hello\n", "or tool data such as $TC_DP6[8,1]=4.0"),
    ],
)
def test_what_tool_data_do_not_say_is_refused(text: str, expected: str) -> None:
    assert expected in refusal(text)


def test_tool_data_of_the_command_line_reach_the_program() -> None:
    Path("a.mpf").write_text("T8 D2\nG0 X60 Z2 C0\nTRANSMIT\nG1 G41 X20 Y0 F200\nY-10\nG40 X30\nTRAFOOF\nM30\n")
    Path("TO1.TOA").write_text("$TC_DP1[8,2]=120\n$TC_DP6[8,2]=3.5\n$TC_DP15[8,2]=0.01\n")
    options = ["check", "a.mpf", "--offsets", "TO1.TOA", "--machine"]
    assert "offset 8/2 with R 3.51 mm (offset table)" in CliRunner().invoke(main, [*options, "siemens-transmit"]).stdout
    result = CliRunner().invoke(main, [*options, "fanuc"])
    assert result.exit_code == 2
    assert "the offset table has 8/2, an edge or name of a tool; this machine has offset numbers alone" in result.stderr


# ---- from the command line and from a job ----

RAMP = "T0808\nG98 G0 X60. C0\nG12.1\nG1 G41 X40. F200\nC-10.\nG40 X60.\nG13.1\n"


def test_an_offset_table_of_the_command_line_takes_the_place_of_that_of_the_job() -> None:
    Path("a.nc").write_text(RAMP)
    Path("old.txt").write_text("G10 P10008 R9.\nG10 P10009 R1.\n")
    Path("new.txt").write_text("NO R\n8 4,5\n")
    Path("polarcheck.toml").write_text("offsets = 'old.txt'\n[tools.7]\nradius = 2\n")
    shown = CliRunner().invoke(main, ["config", "show", "a.nc", "--offsets", "new.txt"]).stdout
    tools = [line for line in shown.splitlines() if line.startswith("tools.")]
    assert [line.split() for line in tools] == [
        ["tools.7.radius", "=", "2.0", "#", "polarcheck.toml:3"],
        ["tools.8.radius", "=", "4.5", "#", "command", "line", "--offsets"],
    ]


def test_a_broken_table_of_a_job_is_told_with_both_lines() -> None:
    Path("a.nc").write_text(RAMP)
    Path("t.txt").write_text("G10 P10008 R4.\nG10 P10009 R4000.\n")
    Path("polarcheck.toml").write_text("machine = 'fanuc'\noffsets = 't.txt'\n")
    result = CliRunner().invoke(main, ["check", "a.nc"])
    assert (result.exit_code, result.stdout) == (2, "")
    assert result.stderr == (
        "polarcheck: polarcheck.toml:2: offsets: t.txt:2: offset 9: radius: expected a number from -1000 to 1000,"
        " found 4000\n"
    )
