"""Each key of [macro] decides something: changed, a program is executed or reported otherwise."""

from __future__ import annotations

from typing import Any

import msgspec
import pytest
from cases import looped
from polarcheck.errors import MachineError
from programs import machine_of, report_of, said, trace_of

from polarcheck.program.machines.macro_keys import Macro

_SUB = "M30\nO2\nG0 X#24 Z#4 U#7\nM99\n"
#: Key -> what it is changed to, and the program; X, Z and U of its rows, or what is said, are no longer the same.
KEYS: dict[str, tuple[Any, str]] = {
    "language": ("high-level", "R1=5\nG0 X=R1\nM30\n"),
    "parameter_letter": ("R", "G98 G0 X60. C0\nG12.1\nG1 X40. F200\nG3 X20. C10. R20.\nG1 X60.\nG13.1\nM30\n"),
    "master_spindle_word": ("SETMS", "SETMS(3)\nM3\nG0 X60. C0\nG12.1\nG1 X40. F200\nC10.\nX60.\nG13.1\nM30\n"),
    "named_words": ({"QX": "X"}, "G0 QX=5.\nM30\n"),
    "other_language": ("G290", "G290 X=5.\nG0 X5.\nM30\n"),
    "statements": ({"DWELL": "none"}, "DWELL\nG0 X5.\nM30\n"),
    "local_variables": ([[1, 26]], "#27=5.\nG0 X#27\nM30\n"),
    "common_variables": ([[100, 149]], "#150=5.\nG0 X#150\nM30\n"),
    "retained_variables": ([[500, 531]], "#600=5.\nG0 X#600\nM30\n"),
    "system_variables": ([[1000, 8999]], "#9500=5.\nG0 X#9500\nM30\n"),
    "read_only_variables": ([[4001, 4130]], "#5021=5.\nG0 X#5021\nM30\n"),
    "clock_variables": ([], "#3001=5.\nG0 X#3001\nM30\n"),
    "alarm_variables": ([], "#3000=1(STOP)\nG0 X5.\nM30\n"),
    "stop_variables": ([], "#3006=1(TURN)\nG0 X5.\nM30\n"),
    "tool_offset_variables": ([], "G98 G0 X60. C0\nG12.1\n#2001=.5\nG1 X40. F200\nX60.\nG13.1\nM30\n"),
    "work_offset_variables": ([], "G98 G0 X60. C0\nG12.1\n#5221=.5\nG1 X40. F200\nX60.\nG13.1\nM30\n"),
    "subprogram_calls": (["M198"], "M98 P2\n" + _SUB),
    "sequence_name_limit": (4, "GOTO NLOOP1\nG0 X5.\nNLOOP1 G0 X6.\nM2\n"),
    "sequence_word": ("", "M98 Q10\nM30\nN10 G0 X5.\nM99\n"),
    "local_calls": (["M97"], "M97 P10\nM30\nN10 G0 X5.\nM99\n"),
    "macro_calls": ([], "G65 P2 X5.\n" + _SUB),
    "modal_macro_calls": ([], "G66 P2 X5.\nG0 Z1.\n" + _SUB),
    "modal_macro_calls_each_block": ([], "G66.1 P2 G1 X5.\nG0 Z1.\n" + _SUB),
    "modal_macro_cancel": ([], "G66 P2 X5.\nG67\nG0 Z1.\n" + _SUB),
    "program_returns": (["M97"], "M98 P2\nM30\nO2\nG0 X5.\nM99\nG0 X6.\n"),
    "computed_increments": ({"G": 0.1, "M": 1, "S": 1, "T": 1, "X": 0.5}, "G0 X[5.3]\nM30\n"),
    "bracket_levels": (1, "#1=[[5.]]\nG0 X#1\nM30\n"),
    "loop_numbers": (4, "#1=0\nWHILE[#1 LT 2]DO4\n#1=#1+1\nEND4\nG0 X#1\nM30\n"),
    "loop_levels": (1, "WHILE[1 EQ 2]DO1\nWHILE[1 EQ 2]DO2\nEND2\nEND1\nG0 X5.\nM30\n"),
    "subprogram_levels": (1, "M98 P2\nM30\nO2\nM98 P3\nM99\nO3\nG0 X5.\nM99\n"),
    "macro_levels": (1, "G65 P2 A1.\nM30\nO2\nG65 P3 A1.\nM99\nO3\nG0 X5.\nM99\n"),
    "repeats_in_p": (False, "M98 P30002\n" + _SUB),
    "second_arguments": (False, "G65 P2 X5. I1. I2.\n" + _SUB),
    "signed_angles": (True, "G0 X[ATAN[-1]/[-1]]\nM30\n"),
    "largest_number": (100, "G0 X[20*20]\nM30\n"),
    "given": ({500: 5.0}, "G0 X#500\nM30\n"),
}


def outcome(program: str, changes: dict[str, Any]) -> tuple[Any, ...]:
    trace = trace_of(f"O1\n{program}", changes=changes)
    report = report_of(f"O1\n{program}", changes=changes)
    words = [[None if value != value else value for value in trace.blocks.word(address).tolist()] for address in "XZU"]
    messages = [(finding.line, finding.message) for finding in report.findings]
    return words, messages, [(entry.rule, entry.reason) for entry in report.not_evaluated]


def test_no_key_is_forgotten() -> None:
    assert [field.name for field in msgspec.structs.fields(Macro)] == list(KEYS)


@pytest.mark.ci
@looped("key", KEYS, one_in=15)
def test_changing_a_key_changes_a_result(key: str) -> None:
    value, program = KEYS[key]
    high_level = ("other_language", "statements", "master_spindle_word")
    tasks = dict.fromkeys(("named_words", "sequence_name_limit"), "user-task")
    language = {**tasks, **dict.fromkeys(high_level, "high-level")}.get(key)
    others = {"language": language} if language else {}
    assert outcome(program, {"macro": others}) != outcome(program, {"macro": {**others, key: value}})


def test_program_ends_are_those_of_the_machine() -> None:
    """Also in a program that runs straight, in a computed word, and for what counts as a subprogram."""
    ends = {"m_codes": {"program_end": ["M60"]}}
    for program in ("O1\nG0 X1.\nM60\nG0 X2.\n", "O1\n#1=60\nG0 X1.\nM#1\nG0 X2.\n"):
        whole, ended = (trace_of(program, changes=changes) for changes in (None, ends))
        assert ended.blocks.starts.sum() > whole.blocks.starts.sum() or len(ended) < len(whole)
    unknown = "O1\n#500=#1\nIF[#1 EQ 0]GOTO 5\nN5 {}\nM99\n"
    assert not report_of(unknown.format("M60"), changes=ends).not_evaluated
    assert report_of(unknown.format("M30"), changes=ends).not_evaluated


@pytest.mark.ci
@looped("end", ["M2", "M02", "M30", "M99"])
def test_an_end_in_a_block_with_macro_ends_the_program(end: str) -> None:
    program = f"%\nO1\nG0 Z5.\n#1=5.\nG0 X#1 {end}\n%\n"
    assert not report_of(program).findings
    assert [finding.rule for finding in report_of(program.replace(end, "M3")).findings] == ["program-end-missing"]


@looped(
    ("program", "expected"),
    [
        ("G21\nG0 X[1.23456]\nM30\n", 1.235),
        ("G20\nG0 X[1.23456]\nM30\n", 1.2346),
        ("G0 X[1.23456]\nM30\n", 1.235),
        ("#1=20\nG#1\nG0 X[1.23456]\nM30\n", 1.2346),
        ("M98 P2\nG0 X[1.23456]\nM30\nO2\nG20\nM99\n", 1.2346),
        ("G20\nG21\nG4 X1.\nG0 X[1.23456]\nM30\n", 1.235),
    ],
)
def test_a_computed_length_is_rounded_to_the_least_increment_of_its_unit(program: str, expected: float) -> None:
    trace = trace_of(f"O1\n{program}")
    assert trace.blocks.word("X")[~(trace.blocks.word("X") != trace.blocks.word("X"))][-1] == expected


def test_the_unit_is_that_of_the_job_where_the_program_says_none() -> None:
    program = "O1\nG0 X[1.23456]\nM30\n"
    assert trace_of(program, job={"program_units": "inch"}).blocks.word("X")[1] == 1.2346
    assert trace_of(program, changes={"control": {"units": "inch"}}).blocks.word("X")[1] == 1.2346
    assert trace_of(program, changes={"control": {"least_increment": 0.01}}).blocks.word("X")[1] == 1.23


@looped(
    ("key", "value", "said_of_it"),
    [
        ("macro_calls", ["CALL"], "expected a G or M code"),
        ("computed_increments", {"G": 0}, "above 0"),
        ("local_variables", [[1]], "length 2"),
    ],
)
def test_what_is_no_code_or_range_is_refused(key: str, value: Any, said_of_it: str) -> None:
    with pytest.raises(MachineError, match=said_of_it):
        machine_of(changes={"macro": {key: value}})


_WITH_NUMBERS = (
    *(
        "M98P{}",
        "G65 P{} A1.",
        "M98 P2 L{}",
        "M99 P{}",
        "GOTO {}",
        "T{}",
        "N{} G0 X1.",
        "M{}",
        "G{}",
        "G66P{}",
        "#{}=1",
    ),
    *(
        "G0 X#{}",
        "M98 P[{}]",
        "T[{}]",
        "G[{}]",
        "#1={}\nM98 P#1 L#1",
        "DO{}\nEND{}",
        "/{} G0 X1.",
        "O{}",
        "S{}",
        "<O{}>",
    ),
)


#: 20 digits, 309 (ten times that is no float), and 400 (which no float holds).
@pytest.mark.ci
@looped("digits", ["1" + "0" * 19, "1" + "0" * 308, "9" * 400], one_in=15)
@looped("block", _WITH_NUMBERS)
def test_a_number_of_any_length_is_a_finding_and_no_warning(block: str, digits: str) -> None:
    report = report_of("O1\nG0 X50.\n" + block.replace("{}", digits) + "\nM30\nO2\nM99\n")
    assert report.findings or block in ("T[{}]", "G[{}]", "/{} G0 X1.", "<O{}>")
    report_of(f"O{digits}\nM98 P{digits}\nM30\n")


def test_a_call_of_twenty_digits_names_no_program() -> None:
    report = report_of("O1\nM98P10000000000000000000\nM30\n")
    assert said(report) == [(2, "too-many-digits")]
    assert [one.rule for one in report.findings[0].follows] == ["subprogram-missing"]
