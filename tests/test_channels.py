"""A file with the programs of several channels: each runs for itself, and everything says to which it belongs."""

from __future__ import annotations

import itertools
import json
from pathlib import Path

import msgspec
import numpy as np
import pytest
from cases import looped
from click.testing import CliRunner
from programs import job_of, machine_of, moves_of, report_of, said

from polarcheck.checking import check
from polarcheck.columns.trace import Trace
from polarcheck.commands import main
from polarcheck.foundation.finding import FileReport, Finding
from polarcheck.program.machines import profiles
from polarcheck.program.reading.channel_texts import channels
from polarcheck.program.reading.source import read_source

FIRST = """G98 G40 G97
T0101
G0 X60. C0 Z5.
G12.1
G42 G1 X40. F200
C10.
G3 X30. C15. R5.
G1 X-40.
C-15.
X40.
C0
G40 X60.
G13.1
M30
"""
SECOND = """G20 G99 G40
T0202
G0 X3. C0
G98
G112
G41 G1 X2. F5.
C-.5
X-2.
C.5
X2.
C0
G40 X3.
G113
M30
"""
THIRD = """G98
#100=10.
T0303
G0 X50. C30.
WHILE[#100 LT 12.]DO1
G12.1
G1 X40. C#100 F100
X50.
G13.1
#100=#100+1
END1
M30
"""
PROGRAMS = {1: FIRST, 2: SECOND, 3: THIRD}
TOOLS = ("1:radius=2", "2:radius=0.1", "3:radius=3")
FANUCS = ("fanuc", "fanuc-16i", "fanuc-30i", "doosan", "turning-center")


def traces_of(program: str, machine: str = profiles.DEFAULT, *tools: str) -> dict[str, Trace]:
    """The executed program of each channel, by its name."""
    runs = check.read(program.encode(), machine_of(machine), job_of(*tools))
    return {tables["text"].source.channel: tables["trace"] for _, tables in runs}


def ends_of(program: str, *tools: str) -> dict[str, list[complex]]:
    """The ends of the moves of the tool center of each channel."""
    runs = check.read(program.encode(), machine_of("fanuc"), job_of(*tools))
    return {tables["text"].source.channel: tables["moves"].end.tolist() for _, tables in runs}


def places(report: FileReport) -> list[tuple[int, str, object]]:
    return [(found.line, found.rule, found.channel) for found in report.findings]


# ---- each channel is its twin ----


@pytest.mark.ci
@looped("order", list(itertools.permutations(PROGRAMS)), one_in=3)
def test_each_channel_gives_the_tool_center_path_of_a_file_of_its_own(order: tuple[int, ...]) -> None:
    file = "%\nO1000(PART)\n" + "".join(f"${number}\n{PROGRAMS[number]}" for number in order) + "%\n"
    found = ends_of(file, *TOOLS)
    assert sorted(found) == ["$1", "$2", "$3"]
    for number, program in PROGRAMS.items():
        twin = moves_of(f"%\nO1000(PART)\n{program}%\n", "fanuc", *TOOLS)
        assert len(twin.end)
        assert np.array_equal(found[f"${number}"], twin.end)


@pytest.mark.ci
def test_the_order_of_the_channels_makes_no_difference() -> None:
    reports = []
    for order in ((1, 2), (2, 1)):
        programs = {1: FIRST.replace("C10.", "G0 C10."), 2: SECOND.replace("C-.5", "C-.5 F.")}
        report = report_of("O1\n" + "".join(f"${number}\n{programs[number]}" for number in order), "fanuc", *TOOLS)
        reports.append(sorted((found.channel, found.rule, found.block) for found in report.findings))
    assert reports[0] == reports[1] == [("$1", "rapid-in-polar", "G0 C10."), ("$2", "bad-number", "C-.5 F.")]


@pytest.mark.one_in(33)
@pytest.mark.ci
@pytest.mark.parametrize(
    "file",
    [
        "O1\n$1\n{0}$2\n{1}",
        "O1\n $1 \n{0}\t$2\r\n{1}",
        "$1\nO1\n{0}$2\nO2\n{1}",
        "O1$1\n{0}O2$2\n{1}",
        "$1O1\n{0}$2O2\n{1}",
        "O0001(MAIN)\n$1(MAIN SPINDLE)\n{0}$2(SUB SPINDLE)\n{1}",
        "<PART>\n$1\n{0}$2\n{1}",
        "<PART-1>$1\n{0}<PART-2>$2\n{1}",
        "%\nO1\n$1\n{0}%\n$2\n{1}%\n",
        "O1;$1;\n{0};$2;\n{1}",
        "O1\n$2\n{1}$1\n{0}",
        "O1\nN1 $1\n{0}N2 $2\n{1}",
        "O1\n$1 !2L1\n{0}$2!1L1\n{1}",
        "O1\n$3\n{1}$1\n{0}",
    ],
)
@pytest.mark.parametrize("ending", ["\n", "\r\n", "\r"])
def test_marks_of_channels_as_they_are_written(file: str, ending: str) -> None:
    program = file.format(FIRST, SECOND).replace("\r\n", "\n").replace("\n", ending)
    found = ends_of(program, *TOOLS)
    assert said(report_of(program, "fanuc", *TOOLS)) == []
    twins = [moves_of(f"O1\n{one}", "fanuc", *TOOLS).end for one in (FIRST, SECOND)]
    assert [len(ends) for ends in found.values()] == [len(twin) for twin in twins]
    assert all(np.array_equal(ends, twin) for ends, twin in zip(found.values(), twins, strict=True))


def test_a_channel_that_comes_back_goes_on() -> None:
    head, tail = FIRST[: FIRST.index("C10.")], FIRST[FIRST.index("C10.") :]
    assert ends_of(f"O1\n$1\n{head}$2\n{SECOND}$1\n{tail}", *TOOLS) == ends_of(f"O1\n$1\n{FIRST}$2\n{SECOND}", *TOOLS)


def test_a_mode_left_open_does_not_reach_into_another_channel() -> None:
    file = f"O1\n$1\n{FIRST.replace('G13.1', '')}$2\nG98\nT0202\nG0 X50.\nG0 X60.\nM30\n"
    report = report_of(file, "fanuc", *TOOLS)
    assert places(report) == [(6, "polar-never-left", "$1")]


def test_what_is_in_force_is_that_of_the_channel_alone() -> None:
    file = f"O1\n$1\n{FIRST}$2\nG0 X60. C0\nG12.1\nG1 X40.\nC5.\nG13.1\nM30\n"
    report = report_of(file, "fanuc", *TOOLS)
    assert places(report) == [(19, "no-tool-offset-at-entry", "$2"), (20, "feed-missing-in-polar", "$2")]


def test_a_file_with_one_channel_names_none() -> None:
    report = report_of(f"O1\n$1\n{FIRST.replace('C10.', 'G0 C10.')}", "fanuc", *TOOLS)
    assert [(found.rule, found.channel) for found in report.findings] == [("rapid-in-polar", msgspec.UNSET)]
    assert report.polar_sections[0].channel is msgspec.UNSET
    assert b"channel" not in msgspec.json.encode(report)


def test_a_channel_without_a_program_is_none() -> None:
    report = report_of(f"$1\nO1\n{FIRST}$2\n(NOT USED)\n", "fanuc", *TOOLS)
    assert said(report) == []
    assert report.polar_sections[0].channel is msgspec.UNSET


@pytest.mark.ci
@looped("rest", ["", "\n", "(NOT USED)\n", "!1L1\n", "%\n"], one_in=2)
def test_nor_is_one_with_what_stands_before_all_of_them_alone(rest: str) -> None:
    report = report_of(f"%\nO1\n#500=1\n$1\n{FIRST}$2\n{rest}", "fanuc", *TOOLS)
    assert said(report) == []
    assert report.polar_sections[0].channel is msgspec.UNSET
    assert list(traces_of(f"O1\n$1\n{FIRST}$2\n{rest}$3\n")) == [""]


@pytest.mark.ci
def test_what_stands_before_the_first_channel_is_in_all_of_them() -> None:
    head = "O1\nG98 G40\nT0101\nG0 X60. C0\n"
    body = "G12.1\nG1 X40. F200\nC10.\nX60.\nG13.1\nM30\n"
    report = report_of(f"{head}$1\n{body}$2\n{body}", "fanuc", *TOOLS)
    assert said(report) == []
    assert report.sections == 2
    # What is wrong there is told once, and of no channel.
    report = report_of(f"{head}G0 X--5.\n$1\n{body}$2\n{body}", "fanuc", *TOOLS)
    assert (5, "bad-number", msgspec.UNSET) in places(report)
    assert [rule for _, rule, _ in places(report)].count("bad-number") == 1


# ---- flow ----


SUBPROGRAM = "G12.1\nG1 X40. F200\nC10.\nX60.\nG13.1\nM99\n"
CALLS = "G98 G40\nT0{0}0{0}\nG0 X60. C0\nM98 P2000\nM30\n"


@pytest.mark.ci
@looped(
    "file",
    [
        f"O1\n$1\n{CALLS.format(1)}O2000\n{SUBPROGRAM}$2\n{CALLS.format(2)}",
        f"O1\n$1\n{CALLS.format(1)}$2\n{CALLS.format(2)}O2000\n{SUBPROGRAM}",
        f"O2000\n{SUBPROGRAM}O1\n$1\n{CALLS.format(1)}$2\n{CALLS.format(2)}",
        f"$1\nO1\n{CALLS.format(1)}O2000\n{SUBPROGRAM}$2\nO1\n{CALLS.format(2)}O2000\n{SUBPROGRAM}",
    ],
    one_in=3,
)
def test_a_call_finds_its_program_in_every_channel(file: str) -> None:
    report = report_of(file, "fanuc", *TOOLS)
    assert said(report) == []
    twin = moves_of(f"O1\n{CALLS.format(1)}O2000\n{SUBPROGRAM}", "fanuc", *TOOLS)
    assert all(np.array_equal(ends[: len(twin.end)], twin.end) for ends in ends_of(file, *TOOLS).values())


def test_a_fault_in_a_program_that_two_channels_call_is_told_once() -> None:
    file = f"O1\n$1\n{CALLS.format(1)}$2\n{CALLS.format(2)}O2000\n{SUBPROGRAM.replace('C10.', 'G0 C10.')}"
    (found,) = report_of(file, "fanuc", *TOOLS).findings
    assert (found.rule, found.line, found.section_line, found.channel) == ("rapid-in-polar", 17, 15, "$2")
    assert found.program == "O2000"
    lines = {number: trace.blocks.line_in_file[trace.mode.leaves].tolist() for number, trace in traces_of(file).items()}
    assert lines == {"$1": [19], "$2": [19]}


@pytest.mark.nightly
@looped("channel", [1, 2])
def test_a_program_that_another_channel_calls_runs_there_alone(channel: int) -> None:
    # By itself it would lack the F and the tool of its caller.
    program = f"O2000\n{SUBPROGRAM.replace(' F200', '')}"
    caller = CALLS.format(1).replace("M98", "G98 G1 X61. F100\nM98")
    regions = {1: caller, 2: FIRST.replace("T0101", "T0202")}
    regions[channel] += program
    report = report_of(f"O1\n$1\n{regions[1]}$2\n{regions[2]}", "fanuc", *TOOLS)
    assert said(report) == []
    assert report.sections == 2
    wrong = f"O1\n$1\n{regions[1]}$2\n{regions[2]}".replace("\nC10.\nX60.\nG13.1\nM99", "\nG0 C10.\nX60.\nG13.1\nM99")
    assert places(report_of(wrong, "fanuc", *TOOLS))[0][1:] == ("rapid-in-polar", f"${channel}")


@pytest.mark.ci
def test_many_calls_of_another_channel_read_it_once() -> None:
    calls = "".join(f"M98 P{number}\n" for number in range(1000, 1400))
    programs = "".join(f"O{number}\nG0 X{number}.\nM99\n" for number in range(1000, 1400))
    traces = traces_of(f"$1\nO1\n{calls}M30\n$2\nO2\nG0 X5.\nM30\n{programs}")
    assert len(traces["$1"]) == 400 * 4 + 2
    assert len(traces["$1"].text.source.parts) == 1


def test_a_program_ends_with_m99() -> None:
    file = f"O1\n$1\n{FIRST.replace('M30', 'M99')}$2\n{SECOND.replace('M30', 'M99')}"
    assert said(report_of(file, "fanuc", *TOOLS)) == []


@pytest.mark.nightly
@looped("channel", [1, 2])
def test_block_skip_of_one_channel(channel: int) -> None:
    skipped = {number: PROGRAMS[number] for number in (1, 2)}
    skipped[channel] = (
        skipped[channel].replace("G1 X-40.", "/G0 X-40.\nG1 X-40.").replace("\nX-2.", "\n/G0 X-2.\nG1 X-2.")
    )
    file = f"O1\n$1\n{skipped[1]}$2\n{skipped[2]}"
    (found,) = report_of(file, "fanuc", *TOOLS).findings
    assert (found.rule, found.channel) == ("rapid-in-polar", f"${channel}")
    assert found.message.endswith("(with block skip off)")


@pytest.mark.nightly
def test_common_variables_of_another_channel_are_not_vacant() -> None:
    reads = "G98 G40\nT0202\nG0 X60. C0\nG12.1\nG1 X40. F200\nC#{0}\nX60.\nG13.1\nM30\n"
    for number in (101, 501):
        file = f"O1\n$1\n#{number}=10.\n{FIRST}$2\n{reads.format(number)}"
        report = report_of(file, "fanuc", *TOOLS)
        assert said(report) == []
        assert report.verdict == "unverified"
        assert {missing.channel for missing in report.not_evaluated if missing.matters} == {"$2"}
        # The job knows better, and what the channel itself assigns is known.
        assert report_of(file, "fanuc", *TOOLS, job={"run": {"variables": {str(number): 10}}}).verdict == "pass"
        own = file.replace("$2\n", f"$2\n#{number}=10.\n")
        assert report_of(own, "fanuc", *TOOLS).verdict == "pass"
    # A local variable belongs to its channel.
    local = report_of(f"O1\n$1\n#1=10.\n{FIRST}$2\n{reads.format(1)}", "fanuc", *TOOLS)
    assert "vacant-variable" in {rule for _, rule in said(local)}


# ---- waits ----


@pytest.mark.one_in(36)
@pytest.mark.ci
@pytest.mark.parametrize("wait", ["!2L1", "!1L10", "!L3", "!1", "!12L2", "! 2 L 1", "!2l1", "!2L1!3L1", "!9L99999"])
@pytest.mark.parametrize(
    "block",
    ["{}", "/{}", "N10{}", "{}G1 X39.", "G1 X39.{}", "G1{}X39.", "#101=5 {}", "IF[#101GT0]GOTO5 {}", "{}(WAIT)"],
)
def test_a_wait_is_a_comment(wait: str, block: str) -> None:
    head, tail = "O1\nT0101\nG98 G0 X60. C0\nG12.1\nG1 X40. F200\n", "\nC10.\nX60.\nG13.1\nM30\n"
    if "GOTO" in block:
        head, tail = head.replace("T0101", "T0101\n#101=1"), tail.replace("X60.", "N5 X60.")
    waits, plain = f"{head}{block.format(wait)}{tail}", f"{head}{block.format(' ')}{tail}"
    assert said(report_of(waits, "fanuc", *TOOLS)) == []
    assert np.array_equal(moves_of(waits).end, moves_of(plain).end)


@pytest.mark.ci
@looped("wait", ["M200", "M200 P12", "M100P123", "M82"], one_in=2)
def test_a_wait_by_an_m_code_is_no_fault(wait: str) -> None:
    file = f"O1\n$1\n{FIRST.replace('G13.1', f'G13.1{chr(10)}{wait}')}$2\n{wait}\n{SECOND}"
    assert said(report_of(file, "fanuc", *TOOLS)) == []


def test_a_wait_does_not_end_what_is_read_ahead() -> None:
    waits = FIRST.replace("C10.", "!2L1\n!2L2\n!2L3\nC10.")
    assert said(report_of(f"O1\n{waits}", "fanuc", *TOOLS)) == []


# ---- what is no mark ----


@pytest.mark.parametrize("machine", FANUCS)
@pytest.mark.parametrize(
    ("block", "rule"),
    [
        ("G0 X61. $", "stray-character"),
        ("G0 X61. $2", "stray-character"),
        ("$", "stray-character"),
        ("!", "stray-character"),
        ("G0 X61. !", "stray-character"),
        ("$0", "bad-number"),
        ("$99", "bad-number"),
        ("$1.5", "bad-number"),
        ("$$2", "bad-number"),
        ("!A", "bad-number"),
    ],
)
def test_what_is_no_mark_is_a_stray_character(machine: str, block: str, rule: str) -> None:
    program = f"O1\nT0101\nG98 G0 X60. C0\n{block}\nM30\n"
    report = report_of(program, machine)
    assert (4, rule) in said(report)
    assert report.findings[0].channel is msgspec.UNSET


@looped("comment", ["($2)", "(WAIT !2L1)", "(A\n", "G0 X60. ($1 AND $2)", "($1\n$)"])
def test_what_stands_in_a_comment_is_no_mark(comment: str) -> None:
    source = read_source(f"O1\n{comment}\nG0 X60.\nM30\n".encode())
    assert channels(source, "$") == [source]


def test_marks_behind_the_end_of_the_file_are_none() -> None:
    source = read_source(b"O1\n$1\nM30\n\x1a$2\nM30\n")
    assert channels(source, "$") == [source]


@looped("machine", ["haas-lathe", "gsk-988", "lsis"])
def test_a_control_without_channels_reads_them_as_before(machine: str) -> None:
    report = report_of("O1\n$1\nG0 X60.\nM30\n$2\nG0 X60.\nM30\n", machine)
    assert report.findings
    assert all(found.channel is msgspec.UNSET for found in report.findings)
    assert {line for line, rule in said(report) if rule in ("stray-character", "bad-number")} >= {2}


@looped("machine", ["okuma-osp", "siemens-iso", "siemens-transmit"])
def test_where_the_language_has_the_mark_it_parts_no_channels(machine: str) -> None:
    report = report_of("O1\nG0 X60.\nX=$1\nM30\n", machine)
    assert report.findings or report.not_evaluated
    assert all(found.channel is msgspec.UNSET for found in (*report.findings, *report.not_evaluated))


def test_remarks_and_comments_stand_in_the_order_of_the_file() -> None:
    # A remark above took the place of the comment, which was read as a part of the statement.
    program = "O1\nT0101 ; FIRST TOOL\nG98 G0 X60. C0\n#1=0 (A [ COMMENT)\nG12.1\nG1 X40. F200\nC10.\nG13.1\nM30\n"
    assert said(report_of(program, "fanuc", *TOOLS)) == []


# ---- hostile ----


@pytest.mark.one_in(7)
@pytest.mark.nightly
@pytest.mark.parametrize(
    "line", ["$1\n", "$1\n$2\n", "O1$1\n!2L1\n", "$9 !1\n", "$1!1L1!2L2(A)\n", "N1 $3;$4;\n", "!1L1;"]
)
def test_very_many_marks(line: str) -> None:
    report = report_of("O1\n" + line * 100_000, "fanuc", job={"run": {"max_seconds": 60}})
    assert not {"stray-character", "bad-number"} & {rule for _, rule in said(report)}
    assert len(report.findings) < 20


@pytest.mark.nightly
def test_nine_channels() -> None:
    file = "O1\n" + "".join(f"${number}\n{FIRST}" for number in range(9, 0, -1))
    report = report_of(file, "fanuc", *TOOLS)
    assert said(report) == []
    assert [section.channel for section in report.polar_sections] == [f"${number}" for number in range(9, 0, -1)]


@pytest.mark.nightly
def test_other_bytes_than_of_ascii_keep_their_places() -> None:
    file = f"O1(H\u00dcLSE \u2013 1)\n$1\n(\u00c4)\n{FIRST}$2\n{SECOND.replace('C-.5', 'G0 C-.5')}"
    for encoding in ("utf-8", "latin-1", "utf-16"):
        data = file.encode(encoding, "replace")
        (found,) = (one for one in report_of(data, "fanuc", *TOOLS).findings if one.severity == "error")
        assert (found.line, found.column, found.block, found.channel) == (25, 1, "G0 C-.5", "$2")


# ---- reports ----


FAULTY = f"O1\n$1\n{FIRST.replace('C10.', 'G0 C10.')}$2\n{SECOND}"


@pytest.fixture(autouse=True)
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)


def said_by(command: str, *options: str) -> str:
    Path("a.nc").write_text(FAULTY, "utf-8")
    return CliRunner().invoke(main, [command, "a.nc", "--tool", "1:radius=2", *options]).stdout


@pytest.mark.nightly
def test_reports_name_the_channel() -> None:
    assert "at   a.nc:8:1, channel $1\n" in said_by("check")
    assert said_by("check", "--format", "concise").startswith("a.nc:8:1: error: $1: G0 cannot")
    assert "at   a.nc, channel $2, " in said_by("check")
    report = json.loads(said_by("check", "--format", "json"))["files"][0]
    assert [found["channel"] for found in report["findings"]] == ["$1"]
    assert [section["channel"] for section in report["polar_sections"]] == ["$1", "$2"]
    assert {missing["channel"] for missing in report["not_evaluated"]} == {"$1", "$2"}


@pytest.mark.ci
@looped("path", [(), ("--path", "tool"), ("--path", "programmed")])
def test_the_trace_names_the_channel(path: tuple[str, ...]) -> None:
    items = [json.loads(line) for line in said_by("trace", "--format", "jsonl", *path).splitlines()]
    assert [name for name, _ in itertools.groupby(item["channel"] for item in items)] == ["$1", "$2"]
    head, *rows = said_by("trace", *path).splitlines()
    at = head.split(",").index("channel")
    assert [row.split(",")[at] for row in rows] == [item["channel"] for item in items]


@pytest.mark.ci
def test_a_finding_and_what_follows_from_it_are_of_one_channel() -> None:
    file = f"O1\n$1\n{FIRST}$2\n{FIRST.replace('T0101', 'T0202').replace('C10.', 'Y10.')}"
    report = report_of(file, "fanuc", *TOOLS)

    def channels_of(found: Finding) -> set[object]:
        return {found.channel}.union(*map(channels_of, found.follows))

    assert report.findings
    assert all(channels_of(found) == {"$2"} for found in report.findings)


@pytest.mark.ci
@looped("ends", ["M99", "M30"])
def test_the_mode_is_open_where_the_main_program_of_a_channel_ends(ends: str) -> None:
    """M99 begins the program of a channel again; of a file of its own it may return to a caller that has the G13.1."""
    section = "G98 G0 X60. C0\nG12.1\nG1 X10. F200\nC5.\nX60. C0\n"
    report = report_of(f"O1\n$1\nT0101\n{section}{ends}\n$2\nT0202\n{ends}\n")
    assert said(report) == [(5, "polar-never-left")]
    called = f"O1\n$1\nT0101\nM98 P9\nG13.1\n{ends}\nO9\n{section}M99\n$2\nT0202\n{ends}\n"
    assert said(report_of(called)) == []
