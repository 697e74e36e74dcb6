"""Drawn programs with one number of a section made unknown: none passes, is like another one, or is rewritten."""

from __future__ import annotations

import random
import re
from pathlib import Path

import pytest
from cases import looped
from click.testing import CliRunner
from programs import report_of, tables_of
from setter_programs import DIALECTS, drawn

from polarcheck.commands import main

_WORD = re.compile(r"(?<![A-Z#=])([GXYZCUVWHIJKRFT])()(-?\d+\.?\d*|-?\.\d+)(?![\d.])")
_NAMED = re.compile(r"(?<![A-Z=])(CR|[XYZCIJLF])(=?)(-?\d+\.?\d*|-?\.\d+)(?![\d.])")
_COMMENT = re.compile(r"\([^)]*\)|;.*")
#: By the beginning of a machine: its words, and a variable of it; None where it has none that a program can name.
_LANGUAGES: dict[str, tuple[re.Pattern[str], str] | None] = {
    "siemens-transmit": (_NAMED, "=R{}"),
    "okuma": (_NAMED, "=VC{}"),
    "siemens": None,
    "hurco": None,
}
_CHANGED = 3


def language_of(machine: str) -> tuple[re.Pattern[str], str] | None:
    """The words of a machine that may be unknown, and how a variable stands in them."""
    return next((value for name, value in _LANGUAGES.items() if machine.startswith(name)), (_WORD, "#{}"))


#: Every second program is of a machine that the seed draws.
_MACHINES = [name for machine in DIALECTS if language_of(machine) for name in (machine, "")]


def programs_of(seed: int, machine: str = "") -> tuple[str, list[str], str, list[tuple[str, str]]]:
    """A machine, its cutters, a sound program, and the same with one word of a section as #900 and as #901."""
    program = drawn(seed, machine or _MACHINES[seed % len(_MACHINES)])
    text, machine, tools = program.text(), program.machine, program.tools()
    language = language_of(machine)
    if language is None or report_of(text, machine, *tools).verdict != "pass":
        return machine, tools, text, []
    pattern, variable = language
    trace, lines = tables_of(text, machine, *tools)["trace"], text.splitlines()
    places = [
        (line - 1, match)
        for line in sorted({int(line) for line in trace.blocks.line[trace.mode.in_polar]})
        for match in pattern.finditer(_COMMENT.sub(lambda comment: " " * len(comment[0]), lines[line - 1]))
    ]
    chosen = random.Random(seed).sample(places, min(_CHANGED, len(places)))  # noqa: S311
    changed = []
    for line, match in chosen:
        head, tail = lines[line][: match.end(1)], lines[line][match.end() :]
        both = (
            "\n".join([*lines[:line], f"{head}{variable.format(number)}{tail}", *lines[line + 1 :]])
            for number in (900, 901)
        )
        changed.append((next(both) + "\n", next(both) + "\n"))
    return machine, tools, text, changed


@pytest.mark.ci
@looped(("seed", "machine"), [(1150, "mitsubishi-m700"), (1270, "colchester"), (535, ""), (746, "")])
def test_what_an_unknown_section_would_make_is_no_fault_elsewhere(seed: int, machine: str) -> None:
    machine, tools, _, changed = programs_of(seed, machine)
    for text, _ in changed:
        report = report_of(text, machine, *tools)
        assert (report.verdict, [finding.rule for finding in report.findings if finding.severity != "note"]) == (
            "unverified",
            [],
        ), text


@pytest.mark.nightly
@looped("seed", range(700), one_in=140)
def test_a_check_never_passes_and_names_no_other_fault(seed: int) -> None:
    machine, tools, _, changed = programs_of(seed)
    for text, _ in changed:
        report = report_of(text, machine, *tools)
        found = [(finding.rule, finding.line) for finding in report.findings if finding.severity != "note"]
        assert (report.verdict, found) == ("unverified", []), text


@pytest.mark.nightly
@looped("seed", range(120), one_in=120)
def test_no_comparison_says_the_same_and_no_rewriter_writes(seed: int, tmp_path: Path) -> None:
    machine, tools, sound, changed = programs_of(seed)
    of_tools = ["--no-config", *(option for tool in tools for option in ("--tool", tool))]
    options = ["--machine", machine, *of_tools]
    target = "fanuc-30i" if machine == "haas-lathe" else "haas-lathe"
    for texts in changed:
        files = [str(tmp_path / f"{number}.nc") for number in range(3)]
        for file, text in zip(files, (*texts, sound), strict=True):
            Path(file).write_text(text, "utf-8")
        for other in files[1:]:
            result = CliRunner().invoke(main, ["compare", *options, files[0], other])
            assert result.exit_code in (1, 2), texts[0]
            assert "the same" not in result.stdout, texts[0]
        for command in (
            ["unroll", *options],
            ["compensate", *options],
            ["compensate", "--center", *options],
            ["roll", *options],
            ["convert", "--from", machine, "--to", target, *of_tools],
        ):
            result = CliRunner().invoke(main, [*command, files[0]])
            assert (result.exit_code, result.stdout) == (2, ""), (command, texts[0])
        result = CliRunner().invoke(main, ["check", "--fix", "--unsafe-fixes", *options, files[0]])
        assert Path(files[0]).read_text("utf-8") == texts[0], result.output
