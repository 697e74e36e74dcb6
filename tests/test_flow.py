"""Macro programs run as their written-out twins do, and no program runs for ever."""

from __future__ import annotations

import math
import time
from pathlib import Path

import msgspec
import numpy as np
import pytest

from polarcheck.checking import check
from polarcheck.checking.finding import FileReport
from polarcheck.checking.rule import load_all
from polarcheck.machines import profiles
from polarcheck.machines.job import Job, Running, with_tool
from polarcheck.table.trace import Trace

MACHINE = profiles.load("fanuc").machine
JOB = with_tool(Job(), "1:radius=4")
RULES = list(load_all().values())


def job_of(run: Running | None) -> Job:
    return msgspec.structs.replace(JOB, run=run or Running())


def trace_of(program: str, run: Running | None = None) -> Trace:
    return check.read_traces(program.encode(), MACHINE, job_of(run))[0][1]


def report_of(program: str, run: Running | None = None) -> FileReport:
    return check.check_file(program.encode(), MACHINE, job_of(run), RULES)


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


@pytest.mark.parametrize("sides", range(3, 13))
def test_polygon_runs_as_its_written_out_twin(sides: int) -> None:
    macro, plain = trace_of(polygon_macro(sides)), trace_of(polygon_plain(sides))
    ours, theirs = macro.tool_moves, plain.tool_moves
    moving = [moves.length > 1e-6 for moves in (ours, theirs)]
    ours, theirs = ours.chosen(moving[0]), theirs.chosen(moving[1])
    assert len(ours) == len(theirs)
    np.testing.assert_array_equal(ours.kind, theirs.kind)
    np.testing.assert_allclose(ours.end, theirs.end, atol=2e-3)
    np.testing.assert_allclose(ours.feed, theirs.feed)

    def said(program: str) -> list[tuple[str, str]]:
        return [(finding.rule, finding.message) for finding in report_of(program).findings]

    assert said(polygon_macro(sides)) == said(polygon_plain(sides))


def test_words_and_positions_are_those_of_the_unrolled_program() -> None:
    loop = "#1=0\nWHILE[#1 LT 4]DO1\n#1=#1+1\nG1 X[50.-#1] F100\nW-[#1/2]\nEND1\n"
    macro = f"O1\nG0 X50. Z5.\n{loop}M98 P2 L2\nM30\nO2\nU1.5\nM99\n"
    plain = "O1\nG0 X50. Z5.\n" + "".join(f"G1 X{50 - i}. F100\nW-{i / 2}\n" for i in range(1, 5)) + "U1.5\nU1.5\nM30\n"
    ours, theirs = trace_of(macro), trace_of(plain)
    rows = ours.has("X", "Z", "U", "W")
    others = theirs.has("X", "Z", "U", "W")
    for address in "XZUWF":
        np.testing.assert_array_equal(ours.word(address)[rows], theirs.word(address)[others])
    np.testing.assert_allclose(ours.x[rows], theirs.x[others])
    np.testing.assert_allclose(ours.z[rows], theirs.z[others])


ENDLESS = {
    "while": "O2\n#1=0\nWHILE[1 EQ 1]DO1\n#1=#1+1\nG0 X5.\nEND1\nM30\n",
    "goto itself": "O2\nN1 GOTO 1\nM30\n",
    "repeats": "O2\nM98 P3 L99999999\nM30\nO3\nG0 X1.\nM99\n",
    "mutual": "O2\n#1=1\nN5 #1=#1+1\nG0 X1.\nGOTO 6\nN6 GOTO 5\nM30\n",
}


@pytest.mark.parametrize("program", ENDLESS.values(), ids=list(ENDLESS))
def test_what_never_ends_is_one_finding(program: str) -> None:
    found = [finding.rule for finding in report_of(program).findings if finding.rule != "unreachable-block"]
    assert found == ["endless-loop"]


def test_a_program_that_calls_itself_and_brackets_without_end_are_one_finding() -> None:
    brackets = f"O2\n#1={'[' * 10_000}1{']' * 10_000}\nM30\n"
    for program in ("O2\nM98 P2\nM30\n", brackets):
        assert [finding.rule for finding in report_of(program).findings] == ["nesting-too-deep"]


def test_bounds_are_kept() -> None:
    began = time.monotonic()
    report = report_of(ENDLESS["while"], Running(max_blocks=10**9, max_statements=10**9, max_seconds=0.2))
    assert [finding.rule for finding in report.findings] == ["endless-loop"]
    assert "0.2 seconds" in report.findings[0].message
    assert time.monotonic() - began < 60  # it ends at all; how fast is a matter of benchmarks


def test_block_skip_is_judged_both_ways() -> None:
    program = HEAD + "G12.1\nG1 X60. F1500\n/G0 X50.\nG1 C5.\nG13.1\nM30\n"
    messages = {f.rule: f.message for f in report_of(program).findings}
    assert messages["rapid-in-polar"].endswith("(with block skip off)")
    assert not report_of(program, Running(block_skip="on")).findings
    assert [f.rule for f in report_of(program, Running(block_skip="off")).findings] == ["rapid-in-polar"]
    later = HEAD + "G12.1\nG1 X60. F1500 /G40\nC5.\nG13.1\nM30\n"
    on = trace_of(later, Running(block_skip="on"))
    assert not on.codes("G40").any()


def test_a_called_program_is_found_in_the_folders_only(tmp_path: Path) -> None:
    main = HEAD + "M98 P1234\nG12.1\nG1 X60. F1500\nC5.\nG13.1\nM30\n"
    (tmp_path / "outside").mkdir()
    (tmp_path / "outside" / "O1234").write_text("%\nO1234\nG0 X70.\nM99\n%\n")
    (tmp_path / "folder").mkdir()
    options = Running(subprograms=[str(tmp_path / "folder")])
    assert next(f.rule for f in report_of(main, options).findings) == "subprogram-missing"
    (tmp_path / "folder" / "1234.NC").write_bytes(b"%\r\nO1234\r\nG0 X70.\r\nM99\r\n%\r\n")
    assert not report_of(main, options).findings
    (tmp_path / "folder" / "1234.NC").write_bytes(b"G0 X70.\nG12.1\nG1 X60. F100\nG0 C5.\nG13.1\nG0 X70. C0\nM99\n")
    (found,) = [f for f in report_of(main, options).findings if f.rule == "rapid-in-polar"]
    assert (found.line, found.block) == (5, "M98 P1234")
    assert found.message.startswith("in 1234.NC, line 5, G0 C5.")


def test_a_loop_counts_a_finding_and_shows_its_worst_run() -> None:
    loop = "WHILE[#1 LT 5]DO1\n#1=#1+1\nX[20.-4*#1] F2000\nC[#1]\nC0\nEND1\n"
    program = HEAD + f"#1=0\nG12.1\nG1 X60. F1500\n{loop}X60.\nG13.1\nM30\n"
    slow = profiles.load("fanuc", {"limits": {"c_feed": 3600}}).machine
    report = check.check_file(program.encode(), slow, JOB, RULES)
    found = [f for f in report.findings if f.rule == "c-feed-above-limit"]
    assert all(f.count > 1 for f in found)
    assert len({f.line for f in found}) == len(found)


def test_modal_call_runs_after_each_move() -> None:
    program = "O1\nG66 P2 A5.\nG0 X50.\nX60.\nG67\nX70.\nM30\nO2\nZ#1\nG0 Z0\nM99\n"
    trace = trace_of(program)
    np.testing.assert_array_equal(trace.word("Z")[trace.has("Z")], [5.0, 0.0, 5.0, 0.0])
    assert not report_of(program).findings


def test_return_with_p_goes_to_the_caller() -> None:
    trace = trace_of("O1\nM98 P2\nG0 X1.\nN10 G0 X2.\nM30\nO2\nG0 X5.\nM99 P10\n")
    np.testing.assert_array_equal(trace.word("X")[trace.has("X")], [5.0, 2.0])
