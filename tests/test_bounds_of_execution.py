"""
A bound of the check is no fault of the program: one warning, an unverified file, no finding that rests on what was
not executed.
"""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path

import msgspec
import pytest
from cases import looped
from click.testing import CliRunner
from programs import report_of, report_of_example, tables_of

from polarcheck.checking.check import verdict
from polarcheck.commands import main
from polarcheck.foundation.finding import FileReport, Finding
from polarcheck.rules.examples import Example, examples
from polarcheck.rules.rule import load_all

CUTTER = "1:radius=5"
BOUNDED = {"run": {"max_blocks": 2000, "max_statements": 400}}
ISO_HEAD = "G98 G40\nT0101\nG0 X60. C0 Z5.\n"
SIEMENS_HEAD = "G94 G40\nT1 D1\nG0 X60 C0 Z5\n"
OKUMA_HEAD = "G94 G40\nT0101\nG0 X60 C0 Z5\n"

#: Loops of 3000 turns, beyond BOUNDED, each of which changes something: the machine, the blocks before the mode, its
#: beginning, the loop, its end, and the blocks behind M30.
LOOPS = {
    "WHILE": ("fanuc", ISO_HEAD, "G12.1", "#1=0\nWHILE[#1LT3000]DO1\n#1=#1+1\nG1 X50. F200.\nEND1", "G13.1", ""),
    "WHILE without moves": ("fanuc-30i", ISO_HEAD, "G12.1", "#1=0\nWHILE[#1LT3000]DO1\n#1=#1+1\nEND1", "G13.1", ""),
    "WHILE in WHILE": (
        "haas-lathe",
        ISO_HEAD,
        "G112",
        "#1=0\nWHILE[#1LT60]DO1\n#1=#1+1\n#2=0\nWHILE[#2LT50]DO2\n#2=#2+1\nG1 X50. F200.\nEND2\nEND1",
        "G113",
        "",
    ),
    "IF GOTO": ("mazak-eia", ISO_HEAD, "G12.1", "#1=0\nN10 #1=#1+1\nG1 X50. F200.\nIF[#1LT3000]GOTO10", "G13.1", ""),
    "GOTO": ("doosan", ISO_HEAD, "G12.1", "#1=0\nN10 #1=#1+1\nIF[#1GE3000]GOTO20\nGOTO10\nN20", "G13.1", ""),
    "M98 L": ("fanuc", ISO_HEAD, "G12.1", "M98 P100 L1500", "G13.1", "O100\nG1 X50. F200.\nX51.\nM99\n"),
    "M98 in M98": (
        "mitsubishi-m700",
        ISO_HEAD,
        "G12.1",
        "M98 P100 L60",
        "G13.1",
        "O100\nM98 P200 L50\nM99\nO200\nG1 X50. F200.\nM99\n",
    ),
    "G65 L": ("fanuc", ISO_HEAD, "G12.1", "G65 P100 L1500 A1.", "G13.1", "O100\nG1 X[50.+#1] F200.\nM99\n"),
    "more calls than blocks": ("fanuc", ISO_HEAD, "G12.1", "M98 P100 L600", "G13.1", "O100\nG1 U.1 F200.\nM99\n"),
    "Siemens FOR": (
        "siemens-transmit",
        SIEMENS_HEAD,
        "TRANSMIT",
        "FOR R1=1 TO 3000\nG1 X50 F200\nENDFOR",
        "TRAFOOF",
        "",
    ),
    "Siemens WHILE": (
        "siemens-transmit",
        SIEMENS_HEAD,
        "TRANSMIT",
        "R1=0\nWHILE R1<3000\nR1=R1+1\nG1 X50 F200\nENDWHILE",
        "TRAFOOF",
        "",
    ),
    "Siemens UNTIL": (
        "siemens-transmit",
        SIEMENS_HEAD,
        "TRANSMIT",
        "R1=0\nREPEAT\nR1=R1+1\nG1 X50 F200\nUNTIL R1>=3000",
        "TRAFOOF",
        "",
    ),
    "Siemens LOOP": (
        "siemens-transmit",
        SIEMENS_HEAD,
        "TRANSMIT",
        "R1=0\nLOOP\nR1=R1+1\nIF R1>3000 GOTOF OUT\nENDLOOP\nOUT:",
        "TRAFOOF",
        "",
    ),
    "Siemens REPEAT": (
        "siemens-transmit",
        SIEMENS_HEAD,
        "TRANSMIT",
        "PART: G1 X50 F200\nX51\nREPEAT PART P=3000",
        "TRAFOOF",
        "",
    ),
    "Okuma IF": (
        "okuma-osp",
        OKUMA_HEAD,
        "G137 C0",
        "VC1=0\nN10 VC1=VC1+1\nG1 X50 F200\nIF[VC1 LT 3000]N10",
        "G136",
        "",
    ),
    "Okuma CALL": ("okuma-osp", OKUMA_HEAD, "G137 C0", "CALL O100 Q3000", "G136", "O100\nG1 X50 F200\nRTS\n"),
}


def program_of(loop: str, in_mode: bool = True) -> tuple[str, str]:
    machine, head, on, turns, off, behind = LOOPS[loop]
    path = f"G1 C5. F200.\nX60.\n{off}\nG0 Z50.\nM30\n{behind}"
    return machine, f"O1\n{head}" + (f"{on}\n{turns}\n{path}" if in_mode else f"{turns}\n{on}\n{path}")


def with_following(findings: list[Finding]) -> Iterator[Finding]:
    for finding in findings:
        yield finding
        yield from finding.follows


def rules_and_severities(report: FileReport) -> list[tuple[str, str]]:
    return [(found.rule, found.severity) for found in with_following(report.findings)]


def of_bound(report: FileReport) -> list[tuple[str, str]]:
    return [one for one in rules_and_severities(report) if one[0] in ("endless-loop", "polar-never-left")]


@pytest.mark.nightly
@looped("in_mode", [True, False], ids=["in the mode", "before the mode"], one_in=32)
@looped("loop", LOOPS)
def test_a_bound_within_the_mode_is_one_warning_and_leaves_the_file_unverified(loop: str, in_mode: bool) -> None:
    machine, program = program_of(loop, in_mode)
    whole = report_of(program, machine, CUTTER, job={"run": {"max_blocks": 10**6, "max_statements": 10**6}})
    report = report_of(program, machine, CUTTER, job=BOUNDED)
    assert of_bound(whole) == []
    assert of_bound(report) == [("endless-loop", "warning")]
    assert set(rules_and_severities(report)) - {("endless-loop", "warning")} <= set(rules_and_severities(whole))
    of_bounds = [found for found in report.findings if found.rule == "endless-loop"]
    assert verdict(of_bounds, report.not_evaluated) == "unverified"


#: Loops in which nothing changes that could end them.
ENDLESS = {
    "WHILE": ("fanuc", ISO_HEAD, "G12.1", "#1=0\nWHILE[#1LT6]DO1\nG1 X50. F200.\nEND1", "G13.1", ""),
    "GOTO": ("fanuc", ISO_HEAD, "G12.1", "N10 G1 X50. F200.\nGOTO10", "G13.1", ""),
    "LOOP": ("siemens-transmit", SIEMENS_HEAD, "TRANSMIT", "LOOP\nG1 X50 F200\nENDLOOP", "TRAFOOF", ""),
}


@pytest.mark.ci
@looped("loop", ENDLESS)
def test_a_loop_in_which_nothing_changes_is_an_error_with_all_that_follows(loop: str) -> None:
    machine, head, on, turns, off, _ = ENDLESS[loop]
    report = report_of(f"O1\n{head}{on}\n{turns}\nG1 X60.\n{off}\nM30\n", machine, CUTTER, job=BOUNDED)
    assert of_bound(report) == [("endless-loop", "error"), ("polar-never-left", "error")]
    assert report.verdict == "fail"


#: 40 turns, and a bound that none of them is below.
AT_ONCE = {"run": {"max_statements": 9}}
LOOP = "#199=0\nWHILE[#199LT40]DO3\n#199=#199+1\nEND3\n"
#: What the whole run shows elsewhere: it reports one finding of a section, or one for what follows from it.
SHOWN_ELSEWHERE = {
    "c-feed-above-limit",
    "feed-outside-recommended-range",
    "rapid-in-polar",
    "code-not-allowed-in-polar",
}
#: Rules that look at what follows in their section or program.
LOOKING_AHEAD = (
    "no-compensation-in-polar",
    "second-axis-never-programmed",
    "linear-axis-never-programmed",
    "contour-open-with-infeed",
    "plane-wrong-at-entry",
    "no-tool-offset-at-entry",
    "x-unknown-at-entry",
    "start-up-shorter-than-radius",
    "cancel-shorter-than-radius",
    "contour-not-closed",
    "radius-from-comment",
    "allow-without-effect",
)


def cut_examples(rule: str) -> Iterator[tuple[Example, Example]]:
    """Examples with a loop behind each of their blocks: run to their end, and broken off in the loop."""
    for example in examples(load_all()[rule].page):
        lines = example.program.splitlines(keepends=True)
        for at in range(1, len(lines)):
            whole = msgspec.structs.replace(example, program="".join([*lines[:at], LOOP, *lines[at:]]))
            yield whole, msgspec.structs.replace(whole, settings=(*whole.settings, "job.run.max_statements=9"))


@pytest.mark.ci
@looped("rule", LOOKING_AHEAD, one_in=12)
def test_nothing_is_reported_that_rests_on_what_a_bound_has_cut_off(rule: str) -> None:
    broken_off = 0
    for whole, cut in cut_examples(rule):
        report = report_of_example(cut)
        if "endless-loop" not in {found.rule for found in with_following(report.findings)}:
            continue  # the program does not come to the loop, or its control has no WHILE
        broken_off += 1
        places = {(found.rule, found.line) for found in with_following(report.findings)}
        places = {(name, line) for name, line in places if name not in {*SHOWN_ELSEWHERE, "endless-loop"}}
        if places:
            places -= {(found.rule, found.line) for found in with_following(report_of_example(whole).findings)}
        assert not places, f"{places} in\n{cut.program}"
    assert broken_off > 3


@pytest.mark.ci
def test_the_missing_axis_and_the_time_of_a_cut_section_are_not_known() -> None:
    program = "O1\nG98 T0101\nG0 X60. C0\nG12.1\nG1 X-50. F200.\nX50.\nX-50.\n" + LOOP + "C5.\nX60.\nG13.1\nM30\n"
    report = report_of(program, "fanuc", CUTTER, job=AT_ONCE)
    assert [found.rule for found in report.findings if "never" in found.rule] == []
    assert [section.time for section in report.polar_sections] == [None]
    (section,) = report_of(program, "fanuc", CUTTER).polar_sections
    assert section.time


def test_the_mode_that_a_tool_change_ends_is_reported_before_a_bound_too() -> None:
    program = "O1\nG98 T0101\nG0 X60. C0\nG12.1\nG1 X50. F200.\nC5.\nT0202\nG0 X60.\n" + LOOP + "G13.1\nM30\n"
    report = report_of(program, "fanuc", CUTTER, job=AT_ONCE)
    assert ("polar-never-left", "error") in rules_and_severities(report)


@looped("own", ["#500=#500+1\n", ""], ids=["changes a variable", "changes none"])
def test_behind_calls_that_run_once_positions_and_variables_are_not_known(own: str) -> None:
    program = f"O1\n#500=1\nG0 X60. Z5.\nM98 P100 L5000\nX[50.+#500]\nZ3.\nM30\nO100\nU1.\n{own}M99\n"
    trace = tables_of(program, "fanuc", job=BOUNDED)["trace"]
    behind = trace.blocks.line == 5
    assert trace.blocks.line.tolist().count(9) == 1
    assert (trace.path.x[behind] != trace.path.x[behind]).all() == bool(own)
    assert trace.path.z[trace.blocks.line == 6].tolist() == [3.0]


def test_what_rests_on_calls_that_run_once_asks_for_more_blocks_and_for_no_variable() -> None:
    rest = "G12.1\nG1 X[40.+#500] F100.\nC5.\nX60.\nIF[#500EQ4]GOTO10\nX50.\nN10 G13.1\nM30\n"
    head = "O1\nG98 T0101\nG0 X60. Z2. C0\n#500=1\n"
    program = f"{head}M98 P100 L5000\nG0 X60. C0\n{rest}O100\n#500=#500+1\nM99\n"
    report = report_of(program, "fanuc", CUTTER, job=BOUNDED)
    assert [found.rule for found in report.findings] == ["endless-loop"]
    reasons = [one.reason for one in report.not_evaluated if one.matters]
    asked = "line 5, which is run once here, may give it; --max-blocks lets it run"
    assert sum(asked in reason for reason in reasons) >= 2
    moves = f"{head}{rest.replace('[40.+#500]', '40.')}".replace("#500=1\n", "M98 P100 L5000\n") + "O100\nG0 U1.\nM99\n"
    reasons += [one.reason for one in report_of(moves, "fanuc", CUTTER, job=BOUNDED).not_evaluated if one.matters]
    assert any("M98 P100 L5000, which is run once here; --max-blocks lets it run" in reason for reason in reasons)
    assert not any("[run.variables]" in reason or "--subprograms" in reason for reason in reasons)


@pytest.mark.nightly
def test_programs_before_one_that_is_broken_off_keep_all_their_rows() -> None:
    head = "O1\nG0 X60.\n" + "X61.\n" * 40 + "M98 P3 L1500\nM30\n"
    endless = "O2\n#1=0\nWHILE[#1LT90000]DO1\n#1=#1+1\nX1.\nEND1\nM30\nO3\n" + "X7.\n" * 10 + "M99\n"
    trace = tables_of(head + endless, "fanuc")["trace"]
    lines = trace.blocks.line.tolist()
    assert lines.count(head.count("\n") + 9) == 1500
    assert 10_000 <= lines.count(head.count("\n") + 5) <= 10_100


def test_a_silenced_bound_is_not_evaluated() -> None:
    """Who does not ask for the rule, or has answered for it, has no verified file for that."""
    program = f"O1\nG0 X50.\n{LOOP}M30\n"
    allowed = program.replace("END3", "END3 (POLARCHECK ALLOW ENDLESS-LOOP: COUNTS PARTS)")
    reports = [
        report_of(program, "fanuc", job=AT_ONCE, only=["polar"]),
        report_of(allowed, "fanuc", job=AT_ONCE),
    ]
    for report in reports:
        assert report.verdict == "unverified"
        assert [found.rule for found in report.findings if found.severity != "note"] == []
        (missing,) = [one for one in report.not_evaluated if one.matters]
        assert "the rest is not executed (--max-statements)" in missing.reason
        assert "line 6" in missing.reason


@pytest.mark.usefixtures("own_folder")
def test_a_bound_in_a_baseline_is_not_evaluated() -> None:
    Path("a.nc").write_text(f"O1\nG0 X50.\n{LOOP}M30\n")
    options = ["a.nc", "--machine", "fanuc", "--max-statements", "9"]
    assert CliRunner().invoke(main, ["baseline", "create", *options]).exit_code == 0
    result = CliRunner().invoke(
        main, ["check", *options, "--baseline", "polarcheck-baseline.json", "--format", "json", "--strict"]
    )
    assert result.exit_code == 1
    (file,) = json.loads(result.stdout)["files"]
    assert (file["verdict"], file["findings"]) == ("unverified", [])
    assert [one["reason"].startswith("line 6: END3 is still reached") for one in file["not_evaluated"]] == [True]


#: Steps much shorter than R: the tool center runs back in each, but for the corner with the next one.
STEPS = "G1 G42 X40. F100.\nC5.\nX39.9\nC5.1\nX39.8\nC5.2\n"
HEAD_OF_STEPS = "O1\nG98 T0101\nG0 X60. C0\nG12.1\n"


@pytest.mark.ci
@looped(
    ("program", "rules"),
    [
        (HEAD_OF_STEPS + STEPS + "M99\n", []),
        (HEAD_OF_STEPS + STEPS + "M30\n", ["polar-never-left"]),
        (HEAD_OF_STEPS + STEPS + "X50.\nC9.\nG40 X60.\nG13.1\nM30\n", ["interference"]),
        (
            HEAD_OF_STEPS + "#1=0\nG1 G42 X40. F9.\nWHILE[#1LT99]DO1\nC[5.+#1*.1]\nX[40.-#1*.1]\n#1=#1+1\nEND1\nM30\n",
            ["endless-loop"],
        ),
    ],
)
def test_the_corner_behind_the_last_move_of_a_section_that_goes_on_elsewhere_is_not_known(
    program: str, rules: list[str]
) -> None:
    for blocks in (50, 51, 52):
        report = report_of(program, "fanuc-30i", CUTTER, job={"run": {"max_blocks": blocks}})
        assert [found.rule for found in report.findings] == rules
