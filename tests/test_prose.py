"""Text that stands in no parentheses: what is taken for it, what is left to the control, what is said of it."""

from __future__ import annotations

import re

import pytest
from cases import looped
from programs import SHARED, report_of, said, trace_of

from polarcheck.foundation.finding import FileReport
from polarcheck.program.machines import profiles
from polarcheck.program.reading.joining import joined
from polarcheck.program.reading.source import read_source
from polarcheck.program.reading.words import Text, read_words

RULE = "text-without-parentheses"
BUILDER = SHARED / "seeds" / "000_e3b190100e7e6eb2.txt"

#: A block and what of it is text.
TEXTS = [
    ("G0 X50. RAPID TO START", "RAPID TO START"),
    ("g0 x50. rapid to start", "rapid to start"),
    ("G0 X50.     RAPID", "RAPID"),
    ("G0 X50. - RAPID TO START", "- RAPID TO START"),
    ("M5\tStop", "Stop"),
    ("M5 -- Stop the spindle", "-- Stop the spindle"),
    ("M5Stop the spindle", "Stop the spindle"),
    ("M5Off, then go", "Off, then go"),
    ("G0X50.RAPID TO START", "RAPID TO START"),
    ("O0001 FLANSCH", "FLANSCH"),
    ("O0001 - FLANSCH 50 MM", "- FLANSCH 50 MM"),
    ("O0001 FLANSCH2", "FLANSCH2"),
    ("O0001 FLANGE(50)", "FLANGE(50)"),
    ("FLANSCH", "FLANSCH"),
    ("M8 KÜHLUNG EIN", "KÜHLUNG EIN"),
    ("M9 ARRÊT DE L'ARROSAGE", "ARRÊT DE L'ARROSAGE"),
    ("G12.1 极坐标插补开始", "极坐标插补开始"),
    ("G12.1 Включение интерполяции", "Включение интерполяции"),
    ("G0 X50. SAFE DIA = 40+10", "SAFE DIA = 40+10"),
    ("T0808 (MILL) When the R is set = 0, adjust it", "When the R is set = 0, adjust it"),
    ("GO X50. RAPID TO START", "RAPID TO START"),
    ('T0808 3/4" DIA CUTTER', '3/4" DIA CUTTER'),
    ("#100=5. RADIUS OF CUTTER", "RADIUS OF CUTTER"),
    ("IF[#1EQ2]GOTO 10 SKIP THE ROUGHING", "SKIP THE ROUGHING"),
    ("WHILE[#1LT5]DO1 LOOP OVER PASSES", "LOOP OVER PASSES"),
    ("G1 X#1 MOVE TO START", "MOVE TO START"),
    ("G0 X#100 Z#101 SAFE", "SAFE"),
    ("M98 P1000 L2 REPEAT 2 TIMES", "REPEAT 2 TIMES"),
    ("G50 S3000 MAX RPM", "MAX RPM"),
    ("M3 S1000 RPM", "RPM"),
    ("M3 CW", "CW"),
    ("# Title of the page", "# Title of the page"),
    ("## M5 Stop the spindle", "## M5 Stop the spindle"),
    ("PROGRAM: FLANGE", "PROGRAM: FLANGE"),
    ("G200 DRILLING", "DRILLING"),
    ("12: M5 Stop the main spindle", "Stop the main spindle"),
    ("Stop the main spindle\tM5", "Stop the main spindle"),
    ("RAPID TO START      G0 X50. Z2.", "RAPID TO START"),
    ("G0 RAPID X50.", "RAPID"),
    ("G0 X50. MOVE TO X50 AND Z5", "MOVE TO X50 AND Z5"),
    ("H7 FIT IS WANTED", "FIT IS WANTED"),
    ("If the offset is set then go on", "If the offset is set then go on"),
    ("Goto the start position for the next part", "Goto the start position for the next part"),
    ("M30 END OF PROGRAM", "END OF PROGRAM"),
    ("G1 F20. FEED IS AT 20% OF THE USUAL", "FEED IS AT 20% OF THE USUAL"),
    ("N10 (A) RAPID TO START (B)", "RAPID TO START (B)"),
    ("/2 G0 X5. SKIP ME", "SKIP ME"),
    ("G1 F20. THE FEED IS AT 20%", "THE FEED IS AT 20%"),
    ("| `M5` | Stop the spindle |", "| `+` | Stop the spindle |"),
    ("F100 MM/MIN", "MM/MIN"),
    ("-------- TOOL CHANGE --------", "-------- TOOL CHANGE --------"),
    ("!!! ACHTUNG !!!", "!!! ACHTUNG !!!"),
    ("| Code | Meaning |", "| Code | Meaning |"),
    ("|---|---|", "|---|---|"),
    ("| M5 | Stop the spindle |", "| + | Stop the spindle |"),
    ("<td>M5</td><td>Stop the spindle</td>", "<td> + </td><td>Stop the spindle</td>"),
]
#: What controls read, or what is wrong in another way.
LEFT = """
IF[#1EQ2]THEN#3=4
IF #1 EQ 2 GOTO 10
WHILE[#1LT5]DO1
END1
N10 GOTO 20
GOTON20
DO 1
POPEN
PCLOS
DPRNT[POS X#1[42]*TEXT AND MORE WORDS]
BPRNT[ABC DEF]
SETVN 101[ABC, DEF GHI]
#1=SIN[30]*SQRT[#2]
N100X5.Z1.
G71 P10 Q20 U0.4 W0.1 F0.3 D1.5
G65 P9010 A1. B2.
MSG("HELLO WORLD, GO ON")
MSG ("HELLO WORLD")
TRANSMIT
TRAFOOF
SETMS(2)
WAITM(1,1,2)
STOPRE
ATRANS X5 Z10
SPOS=0
R1=5 R2=SIN(R1)
G0 SUPA Z100 D0
G18 DIAMOF
G1 X50. RND=2
CYCLE95("CONTOUR",2,0.1)
DEF REAL DEPTH, WIDTH
DEF STRING[32] TOOLNAME, OTHERNAME
IF R1>5 GOTOF FINISH
REPEAT LABEL1 P=3
LABEL1:
START: G0 X5.
NOEX VC1=VC2+5
CALL OFACE
CALL OFACE FPX=50 FPZ=20
GOTO NLAP1
NLAP1 G81
G85 NLAP1 D4 U0.2 W0.1 F0.3
NAT01
OFACE
L X+50 FMAX
LBL 1
T="MILL 8 LEFT"
G28 U W
G28 UW
G0 XZ
GXZF
G2 XCIJ
G0 UWH
IF[#1GT5]GOTO 100
G0 X#1 NEND
#1=#2 MOD #3
GO X4O.
GO X50.
G1 XO ZO
XX YY
G0 X__ Z__
G0 XXX ZZZ
G0X—Z—M35
O<NAME OF IT>
M98 <PROGRAM NAME>
#<depth of cut>=5
/ G0 X5.
G17XC
G0 X50.MM
G1 X50,5
Ｇ０ Ｘ５０．
G0 X50.ÿÿÿÿ
""".strip().split("\n")


def text_of(program: str | bytes) -> Text:
    return read_words(read_source(program if isinstance(program, bytes) else program.encode()))


def texts(program: str | bytes) -> list[str]:
    text = text_of(program)
    places = zip(text.prose.start.tolist(), text.prose.end.tolist(), strict=True)
    return [text.source.excerpt(start, end) for start, end in places]


def addresses(text: Text) -> str:
    return "".join(map(chr, text.words.address))


@pytest.mark.ci
@looped(("block", "expected"), TEXTS)
def test_text_beside_a_block(block: str, expected: str) -> None:
    head = "O0002\n" if not block.startswith("O") else ""
    assert "+".join(part.strip() for part in texts(f"{head}{block}\nM30\n")) == expected.replace(" + ", "+")
    assert addresses(text_of(f"{head}{block}\nM30\n"))[-1:] == "M"


@looped("block", LEFT)
def test_what_is_no_text_in_no_parentheses(block: str) -> None:
    assert texts(f"O0002\n{block}\nM30\n") == []


@pytest.mark.ci
@looped("name", profiles.names())
def test_words_of_every_controls_own_language_are_left(name: str) -> None:
    machine = profiles.load(name).machine
    words = [*machine.control.native_words, *machine.polar.on_of_other_controls]
    lettered = [word for word in words if re.search("[A-Z]{2}", word)]
    assert [word for word in lettered if texts(f"O1\n{word}\nG0 {word}\nM30\n")] == []


@looped("encoding", ["latin-1", "utf-8", "utf-16"])
def test_text_in_every_encoding(encoding: str) -> None:
    assert texts("O1\nM8 KÜHLUNG FÜR DEN FRÄSER\nM30\n".encode(encoding)) == ["KÜHLUNG FÜR DEN FRÄSER"]


def test_chinese_in_an_encoding_that_is_not_named() -> None:
    found = texts("O1\nG12.1 极坐标插补\nX5. 铣\nM30\n".encode("gbk"))
    assert [part.encode("latin-1").decode("gbk") for part in found] == ["极坐标插补"]


def test_words_beside_text_are_read_and_letters_for_digits_among_them() -> None:
    text = text_of("O1\nGO X4O. Z2. RAPID TO START (HERE)\nM30\n")
    assert addresses(text) == "OGXZM"
    assert text.words.value.tolist() == [1, 0, 40, 2, 30]
    assert len(text.letters) == 2


def test_the_doubtful_is_text_where_much_is() -> None:
    """An `ON`, an `End`, a number in a wrapped line: alone they are bad numbers, in a column they are its text."""
    column = "G0 X50.\tRAPID TO START\nM8\tCOOLANT\nM3 S500\tSPINDLE TURNS\n"
    assert texts(f"O1\n{column}M8\tON\nM30\tEnd\n")[-2:] == ["ON", "End"]
    assert texts("O1\nM8\tON\nM30\tEnd\n") == []
    wrapped = f"O1\n{column}G1 Z-1. F20.\tThe feed of\nF20. is for steel\nX2.\tX50 is the start\nM30\n"
    assert texts(wrapped)[-3:] == ["The feed of", "F20. is for steel", "X50 is the start"]


def test_a_column_of_line_numbers_costs_no_word() -> None:
    rows = "1\tG0 X50.\tRAPID TO START\n2\tM8\tCOOLANT ON\n3\tM3 S500\tSPINDLE TURNS\n4\tM30\tEnd\n"
    assert addresses(text_of(rows)).replace("\0", "") == "GXMMSM"
    assert texts(rows) == ["RAPID TO START", "COOLANT ON", "SPINDLE TURNS", "End"]


def test_comments_and_foreign_characters_in_the_text_are_part_of_it() -> None:
    report = report_of("%\nO1\nG0 X50. RAPID (NOTE – NO CUT)\nM30\n%\n")
    assert said(report) == [(3, RULE)]


def test_a_lone_remark() -> None:
    (found,) = report_of("%\nO1\nT0101\nG0 X50. RAPID TO START\nM30\n%\n").findings
    assert found.message == (
        "text that stands in no parentheses: `RAPID TO START`; the control reads each letter as an address and stops; "
        "put it in parentheses or delete it"
    )
    assert (found.line, found.column, found.end_column, found.alarm) == (4, 9, 23, "PS0004")


def test_a_remark_in_a_statement_leaves_the_statement() -> None:
    program = (
        "O1\nT0101\n#1=40. RADIUS OF CUTTER\nG0 X#1 MOVE TO START\nIF[#1GT5]GOTO 20 SKIP THE REST\nG0 X99.\nN20 M30\n"
    )
    assert said(report_of(program)) == [(3, RULE)]
    assert trace_of(program).blocks.line.tolist()[-1] == 7
    assert 6 not in trace_of(program).blocks.line


def test_what_nested_comments_leave_over_follows_from_them() -> None:
    report = report_of("%\nO1\nG0 X50. (FIRST (SECOND) THIRD PART)\nM30\n%\n")
    assert said(report) == [(3, "comment-nested")]
    both = report_of("%\nO1\nG0 X50. (FIRST (SECOND) THIRD PART)\nM8 COOLANT ON\nM30\n%\n")
    assert said(both) == [(3, "comment-nested"), (4, RULE)]


def test_a_description_in_a_called_file_stays_with_it() -> None:
    files = [text_of("O1\nM98 P2\nM30\n"), text_of("O2\nM5 STOP THE SPINDLE\nM99\n")]
    text = joined(files)
    (start,), (end,) = text.prose.start.tolist(), text.prose.end.tolist()
    assert text.source.excerpt(start, end) == "STOP THE SPINDLE"


@looped(
    ("program", "expected"),
    [
        ("0 BEGIN PGM FLAT MM\n1 TOOL CALL 1 Z S5000\n2 L X+10 R0 FMAX M3\n3 END PGM FLAT MM\n", "other-dialect"),
        ("o100 sub\nG0 X5\no100 endsub\no100 call\nM2\n", "other-dialect"),
        (";LAYER:0\nM104 S200\nG92 E0\nG1 X10 Y10 E5 F300\nhere the skirt begins\nG1 X20 E10\n", "other-dialect"),
    ],
)
def test_files_in_other_languages_are_told_as_such(program: str, expected: str) -> None:
    assert [rule for _, rule in said(report_of(program))] == [expected]


HOSTILE = [
    "AB" * 500_000,
    "AB " * 300_000,
    "AB CD\n" * 100_000,
    "|\n" * 200_000,
    "| a | b " * 100_000,
    "</b><b>" * 100_000,
    "<b " * 300_000 + "</",
    ("stop it" + "   X5" * 700 + "!\n") * 100,
    ("#1=2 " + "A B CD EF [ " * 300 + "\n") * 100,
    "X5.\tstop it here\n" * 50_000,
    "GO " * 300_000 + "STOP IT",
    "A 1 " * 300_000 + "STOP IT",
]


@pytest.mark.ci
@looped("program", HOSTILE, ids=[program[:12] for program in HOSTILE], one_in=10)
def test_no_text_takes_long(program: str) -> None:
    """In time that grows as the text does: where it grew as the square, these would take hours."""
    text = text_of(program)
    assert len(text.prose) <= len(text.blocks) * 2


# ---- the sample program of the builder's guide, copied with its descriptions ----


def table() -> str:
    """The program as the guide prints it: the block, a tab, what it does."""
    if not BUILDER.exists():
        pytest.skip(f"{BUILDER} is not there")
    _, _, rest = BUILDER.read_text(encoding="utf-8").partition("## SAMPLE PROGRAM")
    program, _, _ = rest.partition("### Notes")
    return "\n".join(line for line in program.splitlines() if line) + "\n"


def checked(program: str) -> FileReport:
    """The program holds the path of the tool center, as the guide says: R is 0 at first."""
    return report_of(program, "turning-center", "8:radius=0")


def first_column(line: str) -> str:
    return line.partition("\t")[2] + "\t" + line.partition("\t")[0]


LAYOUTS = {
    "as printed": lambda line: line,
    "blanks for the tab": lambda line: line.replace("\t", "    "),
    "a single blank": lambda line: line.replace("\t", " "),
    "a dash": lambda line: line.replace("\t", " - "),
    "upper case": str.upper,
    "lower case text": lambda line: line.partition("\t")[0] + "\t" + line.partition("\t")[2].lower(),
    "description first": first_column,
    "Markdown": lambda line: "| " + line.replace("\t", " | ") + " |",
    "HTML": lambda line: "<tr><td>" + line.replace("\t", "</td><td>") + "</td></tr>",
    "description below": lambda line: line.replace("\t", "\n"),
    "wrapped": lambda line: re.sub(r" (?=The X-axis|\(No cutting|When the|as needed|X-axis position)", "\n", line),
}


@pytest.mark.ci
@looped("layout", LAYOUTS, one_in=3)
def test_the_sample_of_the_guide_copied_with_its_descriptions_is_one_finding(layout: str) -> None:
    program = "\n".join(map(LAYOUTS[layout], table().splitlines())) + "\n"
    report = checked(program)
    assert [rule for _, rule in said(report)] == [RULE]
    (found,) = report.findings
    assert "first `stop the main spindle" in found.message.lower()
    assert found.count >= 23 or "in 23 blocks" in found.message or "in 2" in found.message
    assert len(report.polar_sections) == 1


@pytest.mark.nightly
@looped("layout", ["as printed", "blanks for the tab", "Markdown", "HTML", "description below"])
def test_a_real_fault_beside_the_descriptions_is_found(layout: str) -> None:
    program = table().replace("Z-.88\t", "G0 Z-.88\t")
    assert program != table()
    report = checked("\n".join(map(LAYOUTS[layout], program.splitlines())) + "\n")
    assert [rule for _, rule in said(report)] == [RULE, "rapid-in-polar"]


def test_the_sample_of_the_guide_with_line_numbers_is_two_findings() -> None:
    numbered = "".join(f"{number}: {line}\n" for number, line in enumerate(table().splitlines(), 1))
    assert said(checked(numbered)) == [(1, "bad-number"), (1, RULE)]


def test_the_page_of_the_guide_with_two_programs_in_a_block_says_what_it_is() -> None:
    if not BUILDER.exists():
        pytest.skip(f"{BUILDER} is not there")
    text = BUILDER.read_text(encoding="utf-8")
    page = text[text.index("<b>Cutting Method") : text.index("## SAMPLE PROGRAM")]
    rules = [rule for _, rule in said(report_of(page, "turning-center", "1:radius=.25"))]
    assert rules.count(RULE) == 1
    assert len(rules) < 20


@looped("machine", ["siemens-transmit", "siemens-iso", "okuma-osp"])
def test_where_statements_have_names_text_is_one_of_them_and_told_as_such(machine: str) -> None:
    report = report_of("G0 X50. RAPID TO START\nM30\n", machine)
    assert not [found for found in report.findings if found.rule == RULE]
    assert report.verdict != "pass"


def test_tags_alone_are_shown_as_they_stand() -> None:
    (found,) = report_of("<html><body>\nG0 X50.\nM30\n</body></html>\n").findings
    assert (found.rule, "first `<html><body>`" in found.message) == (RULE, True)
