"""Letters O and I that stand for digits: what is read for them, what is said, and what is left as it is."""

from __future__ import annotations

import numpy as np
import pytest
from cases import looped
from programs import report_of, said, tables_of

from polarcheck.program.reading.letters import read_as_digits

READ = [
    ("GO X60.", "G0 X60."),
    ("GOX60.", "G0X60."),
    ("GOO X5.", "G00 X5."),
    ("GO1 X5.", "G01 X5."),
    ("GOZ5.", "G0Z5."),
    ("/GO X5.", "/G0 X5."),
    ("go x60.", "g0 x60."),
    ("X4O.", "X40."),
    ("X4O.5", "X40.5"),
    ("X1O.5", "X10.5"),
    ("X-O.5", "X-0.5"),
    ("X–O.5", "X–0.5"),
    ("X12.O", "X12.0"),
    ("XO.OO5", "X0.005"),
    ("F.O1", "F.01"),
    ("TO303", "T0303"),
    ("TOI01", "T0101"),
    ("MO9", "M09"),
    ("M3O", "M30"),
    ("MO", "M0"),
    ("N1O GO X5.", "N10 G0 X5."),
    ("NO5 G0 X1.", "N05 G0 X1."),
    ("XO ZO", "X0 Z0"),
    ("G1 XOZ5.", "G1 X0Z5."),
    ("G28 UO WO.", "G28 U0 W0."),
    ("G5O S2OOO", "G50 S2000"),
    ("G41 DO1 X5.", "G41 D01 X5."),
    ("M98 P1OOO", "M98 P1000"),
    ("OOO1", "O001"),
    ("O1OOO", "O1000"),
    (":1OO", ":100"),
    ("G4 PO", "G4 P0"),
    ("GO X60. Z--5.", "G0 X60. Z--5."),
    ("G1 X5.; GO ZO", "G1 X5.; G0 Z0"),
    ("XI0.", "X10."),
    ("X-I0.", "X-10."),
    ("GI X5.", "G1 X5."),
    ("G0I X5.", "G01 X5."),
    ("SI000 M3", "S1000 M3"),
    ("X4I.", "X41."),
    ("ZIO.", "Z10."),
    ("X-IO.", "X-10."),
    ("XIO", "X10"),
    ("GO X6O. ZIO.", "G0 X60. Z10."),
    ("G1 XIO.Z5.", "G1 X10.Z5."),
    ("G1 Z5.XIO.F20.", "G1 Z5.X10.F20."),
    ("G2 X1O.I5.K-O.5", "G2 X10.I5.K-0.5"),
]
LEFT = [
    *("O0001", "N10 O2", "N10O2", "/O2", "CALL O1", "CALL O1000 Q2", "M99O0810", "M30O0002", "T1O1"),
    *("GOTO 10", "GO TO N5", "GO 10", "GO10", "N5 GOTO10", "DO1", "N1 DO 2", "IF [#1 EQ 1] GO 10", "#1=ROUND[#2]"),
    *("G1 X#1 FOO", "GO X[#1]", "IF[#1 EQ 0]THEN #2=O1", "X1 MOD 2"),
    *("TOOL 5", "TOOL5", "COOL 1", "LOOP1", "FROM 0", "STOP", "NO. 5", "NO 5", "POS1", "G54 POS1", "LOT5"),
    *("G54 TO G59", "PROGRAM NO 5", "GO TO START", "NOEX G0 X5", "GOTOF N5", "STOPRE", "X1.2.O", "XOO O"),
    *("RADIO.", "RATIO", "G0 X5. RIO.", "X5. ZIOO.", "X5. ZOI."),
    *("G2X1.I.5K0", "X5.I0", "X5. I-2.", "X4I.5", "G3 X1. I 5.", "F.I5", "X5.\nI-2.", "IO. KO"),
]


def as_read(text: str) -> str:
    code = np.frombuffer(bytearray(text.replace("–", "\x96").encode("latin-1")), np.uint8)
    places = read_as_digits(code)
    assert np.all(np.diff(places) > 0)
    return code.tobytes().decode("latin-1").replace("\x96", "–")


@looped(("written", "meant"), READ)
def test_letters_are_read_as_digits(written: str, meant: str) -> None:
    assert as_read(written) == meant
    assert as_read(f"G0 X1.\n{written}\r\nM30") == f"G0 X1.\n{meant}\r\nM30"
    assert as_read(meant) == meant


@looped("written", LEFT)
def test_letters_are_left(written: str) -> None:
    assert as_read(written) == written
    assert as_read(f"G0 X1.\n{written}\n") == f"G0 X1.\n{written}\n"


def test_a_block_that_nobody_typed_is_left() -> None:
    assert as_read("GO" * 600) == "GO" * 600


HEAD = "O1\nG21 G40 G97 G98 G18\nT0101\nG0 X50. Z2. C0\nG12.1\nG1 X40. F200\nC10.\nX50. C0\nG13.1\n"
INCH = HEAD.replace("G21", "G20").replace("X50. Z2.", "X2. Z.1").replace("F200", "F8.")


def messages(program: str, machine: str = "fanuc") -> list[tuple[int, str, str]]:
    return [(found.line, found.rule, found.message) for found in report_of(program, machine).findings]


@pytest.mark.ci
@looped("head", [HEAD, INCH], one_in=24)
@looped("machine", ["fanuc", "fanuc-30i", "mitsubishi-m700"])
@looped(
    ("written", "meant"),
    [
        ("GO", "G0"),
        ("XO", "X0"),
        ("MO9", "M09"),
        ("TO303", "T0303"),
        ("Z1O.", "Z10."),
        ("M3O", "M30"),
        ("XI0.", "X10."),
        ("ZIO.", "Z10."),
    ],
)
def test_a_letter_is_the_only_finding(written: str, meant: str, machine: str, head: str) -> None:
    letter = "I for the digit 1" if "I" in written else "O for the digit 0"
    sound = [told for told in messages(f"{head}{meant}\nM30\n", machine) if told[0] != 10]
    told = messages(f"{head}{written}\nM30\n", machine)
    assert told == sorted([*sound, (10, "letter-for-digit", f"{written}: letter {letter}; write {meant}")])


def test_a_typed_program_of_letters_is_one_finding() -> None:
    program = "O1\nG21 G40 G97 G98 G18\nTO101\n" + "GO X6O. Z2.\nX5O.\n" * 10 + "M30\n"
    assert messages(program) == [(3, "letter-for-digit", "TO101: letter O for the digit 0; write T0101 (in 21 blocks)")]


def test_a_call_reads_digits_for_letters() -> None:
    program = "O1\nT0101\nM98 P1OO\nM30\nO100\nG0 X5.\nM99\n"
    assert said(report_of(program)) == [(3, "letter-for-digit")]
    assert tables_of(program)["trace"].blocks.line.tolist() == [1, 2, 3, 5, 6, 7, 4]


@looped(
    ("program", "programs"),
    [
        ("O1\nG0 X5. O2\nM30", ["O1"]),
        ("O1\nN10 M30\n/O2\nN10 O3 G0\nM30", ["O1", "O2", "O3"]),
        ("%O1\n%\nO2\nM30\n:3\nM99O0004\nM30 O5\nM30", ["O2", "O3", "O0004", "O5"]),
        ("O1\nG65 P1 X5. / O7\nM30", ["O1"]),
    ],
)
def test_only_an_o_at_the_head_of_a_block_begins_a_program(program: str, programs: list[str]) -> None:
    assert report_of(program).programs == programs
