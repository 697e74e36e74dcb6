"""Macro programs run as their written-out twins do, and no program runs for ever."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
from cases import looped
from clocks import Clock
from programs import report_of, said, tables_of, trace_of

#: The coverage counts all of its cases: each is a way of its own through the package.
pytestmark = pytest.mark.one_in(1)

CUTTER = "1:radius=4"
HEAD = """O0001
T0101
G98 G0 X90. C0
Z5.
"""


def polygon_macro(sides: int) -> str:
    """A polygon of 40 mm across flats with corners of 3 mm, in one loop; G42, counterclockwise."""
    return (
        HEAD
        + f"""#1={sides}
#2=40.
#3=3.
#4=#2/2-#3
#5=180/#1
#6=#4*TAN[#5]
#7=0
G12.1
G1 X90. C0 F1500
G42 X#2 F200
WHILE[#7 LT #1]DO1
#8=#7*360/#1
#10=#4+#3
X[2*[#10*COS[#8]-#6*SIN[#8]]] C[#10*SIN[#8]+#6*COS[#8]]
#7=#7+1
#9=#7*360/#1
G3 X[2*[#10*COS[#9]+#6*SIN[#9]]] C[#10*SIN[#9]-#6*COS[#9]] R#3
G1
END1
C0
G40 X90.
G13.1
G0 Z50.
M30
"""
    )


def polygon_plain(sides: int) -> str:
    inner, corner = 40.0 / 2 - 3.0, 3.0
    half = inner * math.tan(math.pi / sides)
    lines = [HEAD + "G12.1", "G1 X90. C0 F1500", "G42 X40. F200"]

    def point(angle: float, along: float) -> str:
        far = inner + corner
        x = 2 * (far * math.cos(angle) - along * math.sin(angle))
        c = far * math.sin(angle) + along * math.cos(angle)
        return f"X{x:.3f} C{c:.3f}"

    for side in range(sides):
        lines.append("G1 " + point(2 * math.pi * side / sides, half))
        lines.append("G3 " + point(2 * math.pi * (side + 1) / sides, -half) + f" R{corner}")
    return "\n".join([*lines, "G1 C0", "G40 X90.", "G13.1", "G0 Z50.", "M30"]) + "\n"


@pytest.mark.ci
@looped("sides", range(3, 13), one_in=10)
def test_polygon_runs_as_its_written_out_twin(sides: int) -> None:
    macro, plain = (tables_of(program(sides), "fanuc", CUTTER) for program in (polygon_macro, polygon_plain))
    ours, theirs = macro["moves"], plain["moves"]
    moving = [moves.length > 1e-6 for moves in (ours, theirs)]
    ours, theirs = ours[moving[0]], theirs[moving[1]]
    assert len(ours) == len(theirs)
    np.testing.assert_array_equal(ours.kind, theirs.kind)
    np.testing.assert_allclose(ours.end, theirs.end, atol=2e-3)
    np.testing.assert_allclose(ours.feed, theirs.feed)

    reports = [report_of(program(sides), "fanuc", CUTTER) for program in (polygon_macro, polygon_plain)]
    said = [[(finding.rule, finding.message) for finding in report.findings] for report in reports]
    assert said[0] == said[1]


def test_words_and_positions_are_those_of_the_unrolled_program() -> None:
    loop = "#1=0\nWHILE[#1 LT 4]DO1\n#1=#1+1\nG1 X[50.-#1] F100\nW-[#1/2]\nEND1\n"
    macro = f"O1\nG0 X50. Z5.\n{loop}M98 P2 L2\nM30\nO2\nU1.5\nM99\n"
    plain = "O1\nG0 X50. Z5.\n" + "".join(f"G1 X{50 - i}. F100\nW-{i / 2}\n" for i in range(1, 5)) + "U1.5\nU1.5\nM30\n"
    ours, theirs = trace_of(macro), trace_of(plain)
    rows = ours.blocks.has("X", "Z", "U", "W")
    others = theirs.blocks.has("X", "Z", "U", "W")
    for address in "XZUWF":
        np.testing.assert_array_equal(ours.blocks.word(address)[rows], theirs.blocks.word(address)[others])
    np.testing.assert_allclose(ours.path.x[rows], theirs.path.x[others])
    np.testing.assert_allclose(ours.path.z[rows], theirs.path.z[others])


ENDLESS = {
    "while": "O2\n#1=0\nWHILE[1 EQ 1]DO1\n#1=#1+1\nG0 X5.\nEND1\nM30\n",
    "goto itself": "O2\nN1 GOTO 1\nM30\n",
    "repeats": "O2\nM98 P3 L99999999\nM30\nO3\nG0 X1.\nM99\n",
    "mutual": "O2\n#1=1\nN5 #1=#1+1\nG0 X1.\nGOTO 6\nN6 GOTO 5\nM30\n",
}


@pytest.mark.ci
@looped("program", ENDLESS.values(), ids=list(ENDLESS), one_in=2)
def test_what_never_ends_is_one_finding(program: str) -> None:
    report = report_of(program, job={"run": {"max_statements": 5000}})
    assert [finding.rule for finding in report.findings if finding.rule != "unreachable-block"] == ["endless-loop"]


def test_a_program_that_calls_itself_and_brackets_without_end_are_one_finding() -> None:
    brackets = f"O2\n#1={'[' * 10_000}1{']' * 10_000}\nM30\n"
    for program in ("O2\nM98 P2\nM30\n", brackets):
        assert [finding.rule for finding in report_of(program).findings] == ["nesting-too-deep"]


def test_a_fault_before_the_mode_belongs_to_no_section() -> None:
    head, mode = "O1\nG98 T0101\nG0 X60. C0\nM98 P2\nM30\nO2\n", "G12.1\nG1 X40. F100.\nC10.\nG13.1\nG0 C0\n"
    for body in (f"M98 P2\n{mode}", f"{mode}M98 P2\n"):
        (found,) = report_of(f"{head}{body}M99\n").findings
        assert (found.rule, found.section_line) == ("nesting-too-deep", None)
    (found,) = report_of(head + mode.replace("C10.", "M98 P2\nC10.") + "M99\n").findings
    assert (found.rule, found.section_line) == ("nesting-too-deep", 7)


#: So high that none is reached before the one under test.
UNBOUNDED = {"max_blocks": 10**9, "max_statements": 10**9, "max_seconds": 1e9}


@pytest.mark.ci
@looped(
    ("bound", "text", "blocks"),
    [
        ({"max_blocks": 1000}, "1000 blocks more than the file has", 1008),
        ({"max_statements": 1000}, "1000 macro statements and calls more than the file has", 338),
    ],
)
def test_bounds_are_kept(bound: dict[str, int], text: str, blocks: int) -> None:
    """A turn of the loop is one block and three statements; what the file has itself is eight and five, each thrice.

    A last row stands for what is not executed.
    """
    report = report_of(ENDLESS["while"], job={"run": {**UNBOUNDED, **bound}})
    assert [finding.rule for finding in report.findings] == ["endless-loop"]
    assert f"after {text};" in report.findings[0].message
    assert blocks <= report.blocks <= blocks + 2


def test_time_is_a_bound(monkeypatch: pytest.MonkeyPatch) -> None:
    """On a clock that goes on by a second whenever somebody looks at it, so that the work is counted, not the time."""
    Clock(float).use(monkeypatch)
    report = report_of(ENDLESS["while"], job={"run": {**UNBOUNDED, "max_seconds": 5}})
    assert [finding.rule for finding in report.findings] == ["endless-loop"]
    assert "after 5 seconds;" in report.findings[0].message
    assert report.blocks < 1000


@pytest.mark.ci
@looped("lines", ["#100=#100+1.5", "G0 X50.\nM98 P2", "/G0 X50."])
def test_no_file_is_too_long_by_what_is_written_in_it(lines: str) -> None:
    program = "O1\n" + f"{lines}\n" * 400 + "M30\nO2\nG1 X40. F100\nM99\n"
    report = report_of(program, job={"run": {"max_blocks": 1200, "max_statements": 200}}, only=["macro", "polar"])
    assert said(report) == []
    assert report.verdict == "pass"


@pytest.mark.ci
def test_who_comes_to_a_bound_is_not_said_to_be_wrong() -> None:
    """It may end a turn later: the file is unverified, and only what comes back with nothing changed never ends."""
    counts = "O1\n#1=0\nWHILE[#1LT900]DO1\n#1=#1+1\nG0 X50.\nEND1\nM30\n"
    assert report_of(counts, only=["macro"]).verdict == "pass"
    report = report_of(counts, only=["macro"], job={"run": {"max_blocks": 400}})
    assert [(found.rule, found.severity) for found in report.findings] == [("endless-loop", "warning")]
    assert report.verdict == "unverified"
    report = report_of(counts.replace("#1=#1+1\n", ""), only=["macro"])
    assert [(found.rule, found.severity) for found in report.findings] == [("endless-loop", "error")]
    assert report.verdict == "fail"


@pytest.mark.ci
def test_block_skip_is_judged_both_ways() -> None:
    program = HEAD + "G12.1\nG1 X60. F1500\n/G0 X50.\nG1 C5.\nG13.1\nM30\n"
    messages = {f.rule: f.message for f in report_of(program).findings}
    assert messages["rapid-in-polar"].endswith("(with block skip off)")
    assert not report_of(program, job={"run": {"block_skip": "on"}}).findings
    assert [f.rule for f in report_of(program, job={"run": {"block_skip": "off"}}).findings] == ["rapid-in-polar"]
    later = HEAD + "G12.1\nG1 X60. F1500 /G40\nC5.\nG13.1\nM30\n"
    on = trace_of(later, job={"run": {"block_skip": "on"}})
    assert not on.blocks.codes("G40").any()


def test_a_called_program_is_found_in_the_folders_only(tmp_path: Path) -> None:
    main = HEAD + "M98 P1234\nG12.1\nG1 X60. F1500\nC5.\nG13.1\nM30\n"
    (tmp_path / "outside").mkdir()
    (tmp_path / "outside" / "O1234").write_text("%\nO1234\nG0 X70.\nM99\n%\n")
    (tmp_path / "folder").mkdir()
    job = {"run": {"subprograms": [str(tmp_path / "folder")]}}
    assert next(f.rule for f in report_of(main, job=job).findings) == "subprogram-missing"
    (tmp_path / "folder" / "1234.NC").write_bytes(b"%\r\nO1234\r\nG0 X70.\r\nM99\r\n%\r\n")
    assert not report_of(main, job=job).findings
    (tmp_path / "folder" / "1234.NC").write_bytes(b"G0 X70.\nG12.1\nG1 X60. F100\nG0 C5.\nG13.1\nG0 X70. C0\nM99\n")
    (found,) = [f for f in report_of(main, job=job).findings if f.rule == "rapid-in-polar"]
    assert (found.line, found.block) == (5, "M98 P1234")
    assert found.message.startswith("in 1234.NC, line 4, G0 C5.")


@pytest.mark.nightly
def test_a_loop_counts_a_finding_and_shows_its_worst_run() -> None:
    loop = "WHILE[#1 LT 5]DO1\n#1=#1+1\nX[20.-4*#1] F2000\nC[#1]\nC0\nEND1\n"
    program = HEAD + f"#1=0\nG12.1\nG1 X60. F1500\n{loop}X60.\nG13.1\nM30\n"
    report = report_of(program, changes={"limits": {"c_feed": 3600}})
    found = [f for f in report.findings if f.rule == "c-feed-above-limit"]
    # The fifth run goes to X0: through the center, which another rule says.
    assert [(f.line, f.count, f.values["nearest"]) for f in found] == [(11, 2, 2)]


def test_modal_call_runs_after_each_move() -> None:
    program = "O1\nG66 P2 A5.\nG0 X50.\nX60.\nG67\nX70.\nM30\nO2\nZ#1\nG0 Z0\nM99\n"
    trace = trace_of(program)
    np.testing.assert_array_equal(trace.blocks.word("Z")[trace.blocks.has("Z")], [5.0, 0.0, 5.0, 0.0])
    assert not report_of(program).findings


def test_return_with_p_goes_to_the_caller() -> None:
    trace = trace_of("O1\nM98 P2\nG0 X1.\nN10 G0 X2.\nM30\nO2\nG0 X5.\nM99 P10\n")
    np.testing.assert_array_equal(trace.blocks.word("X")[trace.blocks.has("X")], [5.0, 2.0])


@pytest.mark.nightly
def test_an_endless_program_is_no_fault_of_those_behind_it() -> None:
    """The statements of the whole file were counted: every program behind a run-in cycle was endless, too."""
    endless = "O{0}\nN10 G0 X50.\nX60.\n#1=#1+1\nGOTO10\nM30\n"
    sound = "O{0}\n#1=0\nWHILE[#1LT9]DO1\n#1=#1+1\nEND1\nG0 X50.\nM30\n"
    job = {"run": {"max_statements": 5000}}
    report = report_of(endless.format(1) + sound.format(2) + sound.format(3), job=job)
    assert [(found.line, found.rule) for found in report.findings] == [(5, "endless-loop")]
    many = "".join(endless.format(number) for number in range(1, 9)) + sound.format(9)
    lines = [found.line for found in report_of(many, job=job).findings if found.rule == "endless-loop"]
    assert len(lines) == 8
    assert max(lines) <= 48


def test_a_loop_that_waits_for_what_is_not_known_is_not_evaluated() -> None:
    waits = "O1\nN10 G0 X50.\nIF[#1005EQ1]GOTO20\nX60.\nGOTO10\nN20 M30\n"
    report = report_of(waits)
    assert (said(report), report.verdict) == ([], "unverified")
    assert [entry.reason.partition(" and is")[0] for entry in report.not_evaluated] == [
        "the condition depends on a value that is not known,"
    ]
    assert said(report_of(waits.replace("IF[#1005EQ1]GOTO20\n", ""))) != []
    other = report_of(waits + "O2\nN10 G0 X50.\nGOTO10\nM30\n")
    assert [found.rule for found in other.findings if found.severity == "error"] == ["endless-loop"]


@looped(
    ("machine", "program", "line"),
    [
        ("fanuc", "O1\nIF[#500 EQ 1]GOTO 99\nG0 X5.\nN9 M30\n", 2),
        ("siemens-transmit", "G0 X5\nIF R1==1 GOTOF MISSING\nM30\n", 2),
        ("okuma-osp", "G0 X5.\nIF [VC1 EQ 1] NMISS\nM2\n", 2),
    ],
)
def test_a_target_is_looked_for_where_nobody_knows_the_condition(machine: str, program: str, line: int) -> None:
    assert said(report_of(program, machine)) == [(line, "jump-target-missing")]


@looped("jump", ["GOTO #1", "GOTO #501", "GOTO 9"])
def test_a_target_that_may_be_there_is_none(jump: str) -> None:
    assert said(report_of(f"O1\nIF[#500 EQ 1]{jump}\nG0 X5.\nN9 M30\n")) == []
