"""What shells complete: the answers to their questions, and the shells themselves where they are installed."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import click
import pytest
from cases import looped
from click.testing import CliRunner, Result
from shells import COMMANDS, Typed, is_there, put_command, put_told
from test_cli import call, process

from polarcheck.commands import NAMES, completing, completion, main
from polarcheck.program.machines import profiles
from polarcheck.reports import formats
from polarcheck.rules.rule import load_all

pytestmark = [pytest.mark.ci, pytest.mark.usefixtures("own_folder")]

BREAKS = " \t\n\"'><=;|&(:"


def answer(words: str, word: str, shell: str = "zsh") -> list[tuple[str, ...]]:
    """The lines that a shell is told, in fields, for a word behind words that are complete."""
    told = {"COMP_WORDS": "\n".join(["polarcheck", *words.split()]), "POLARCHECK_WORD": word}
    return asked(shell, told)


def ask(shell: str, told: dict[str, str]) -> Result:
    told = {**told, "_POLARCHECK_COMPLETE": f"{shell}_complete"}
    return CliRunner().invoke(main, [], env=told, prog_name="polarcheck")


def answer_to_bash(line: str) -> list[tuple[str, ...]]:
    return asked("bash", {"COMP_WORDS": line, "POLARCHECK_BREAKS": BREAKS})


def asked(shell: str, told: dict[str, str]) -> list[tuple[str, ...]]:
    result = ask(shell, told)
    assert (result.exit_code, result.stderr) == (0, "")
    return [tuple(line.split("\x1f")) for line in result.stdout.splitlines() if line]


def values(words: str, word: str) -> list[str]:
    return [fields[1] for fields in answer(words, word) if fields[0] in ("word", "part")]


# ---- what is answered ----


def test_commands_are_completed_with_what_they_do() -> None:
    assert values("", "") == list(NAMES)
    assert answer("", "expl") == [
        ("word", "explain", "Show the manual page of a rule, a group, an alarm or a verdict.")
    ]


def test_every_option_of_check_is_completed() -> None:
    lines = re.findall(r"^  (?:-\w, )?(--.+?)(?:  |$)", call("check", "--help").stdout, re.MULTILINE)
    shown = {name for line in lines for name in re.findall(r"--[a-z-]+", line)}
    assert len(shown) > 20
    assert set(values("check", "--")) == shown


def test_rules_and_groups_are_those_that_there_are() -> None:
    rules = load_all()
    groups = {rule.group for rule in rules.values()}
    found = {fields[1]: fields[2] for fields in answer("check --select", "")}
    assert set(found) == {*rules, *groups}
    assert {name: found[name] for name in rules} == {name: rule.title for name, rule in rules.items()}


def test_behind_a_comma_one_more_rule_is_completed() -> None:
    assert answer("check --ignore", "polar,rapid-in-p") == [
        ("head", "polar,"),
        ("word", "rapid-in-polar", "Rapid traverse in the polar mode"),
    ]


def test_a_severity_is_completed_behind_its_rule() -> None:
    assert answer("check --severity", "rapid-in-p")[0][:2] == ("part", "rapid-in-polar=")
    assert answer("check --severity", "rapid-in-polar=n") == [("head", "rapid-in-polar="), ("word", "note", "")]


def test_machines_are_the_built_in_ones_and_files() -> None:
    found = answer("check --machine", "")
    assert [fields[1] for fields in found if fields[0] == "word"] == profiles.names()
    assert [fields[2] for fields in found if fields[0] == "word"] == [
        profiles.load(name).machine.title for name in profiles.names()
    ]
    assert found[-1] == ("files", "", ".toml")
    assert values("machines", "") == ["check", "new", *profiles.names()]
    assert answer("machines check", "la") == [("files", "la", ".toml")]


def test_an_option_may_have_its_value_behind_an_equals_sign() -> None:
    assert answer("check", "--machine=haa") == [
        ("head", "--machine="),
        ("word", "haas-lathe", "Haas lathe"),
        ("files", "haa", ".toml"),
    ]


def test_a_report_is_a_format_and_then_a_file() -> None:
    assert values("check -o", "") == [f"{name}:" for name in formats()]
    assert answer("check -o", "json:out") == [("head", "json:"), ("files", "out", "")]
    assert answer("check --output", "json:C:\\out") == [("head", "json:"), ("files", "C:\\out", "")]
    assert values("check --format", "") == formats()


@looped(
    ("words", "word", "expected"),
    [
        ("check", "O12", ("files", "O12", "")),
        ("check a.nc", "two words", ("files", "two words", "")),
        ("trace", "", ("files", "", "")),
        ("check --offsets", "T", ("files", "T", "")),
        ("check --config", "p", ("files", "p", "")),
        ("check --subprograms", "su", ("folders", "su")),
        ("check --", "-x", ("files", "-x", "")),
    ],
)
def test_files_are_left_to_the_shell(words: str, word: str, expected: tuple[str, ...]) -> None:
    assert answer(words, word) == [expected]


def test_keys_of_a_machine_and_of_a_tool_are_completed() -> None:
    assert "limits.c_feed=" in values("check --set", "limits.")
    assert answer("check --tool", "8:ra") == [("head", "8:"), ("part", "radius=", "")]
    assert answer("check --tool", "8:radius=4,n") == [("head", "8:radius=4,"), ("part", "nose=", "")]
    assert answer("check --tool", "8:radius=") == []
    assert answer("trace --encoding", "shift")[0][1] == "shift_jis"


def test_pages_are_rules_groups_and_verdicts() -> None:
    assert {"rapid-in-polar", "polar", "unverified"} <= set(values("explain", ""))


def test_nonsense_is_answered_by_nothing() -> None:
    assert values("chekc", "") == list(NAMES)
    assert answer("check --machine a b --nonsense", "--for") != []
    assert ask("zsh", {"COMP_WORDS": "polarcheck\n./O1.NC", "POLARCHECK_WORD": "x"}).stdout == ""


@looped(
    ("line", "expected"),
    [
        ("polarcheck check --machine=haas-l", ("word", "haas-lathe")),
        ("polarcheck check -o json:my\\ fi", ("files", "my fi")),
        ("polarcheck check 'my fi", ("files", "my fi")),
        ("polarcheck check 'my ", ("files", "my ")),
        ("polarcheck check my\\ ", ("files", "my ")),
        ("polarcheck check my\\\\ ", ("files", "")),
        ("polarcheck check 'a b' ", ("files", "")),
        ('polarcheck check "a\\"b\' ', ("files", "a\"b' ")),
    ],
)
def test_bash_is_understood_up_to_the_cursor(line: str, expected: tuple[str, str]) -> None:
    assert answer_to_bash(line)[0][:2] == expected


def test_bash_keeps_what_stands_before_its_own_break_of_the_word() -> None:
    assert answer_to_bash("polarcheck check --select polar,rapid-in-p")[0] == ("head", "polar,")
    assert answer_to_bash("polarcheck check --select=polar,rapid-in-p")[0] == ("head", "polar,")
    assert answer_to_bash("polarcheck check -o 'json:o")[0] == ("head", "json:")


def commands_of(command: click.Command) -> Iterator[click.Command]:
    yield command
    if isinstance(command, click.Group):
        context = click.Context(command)
        for name in command.list_commands(context):
            found = command.get_command(context, name)
            assert found is not None
            yield from commands_of(found)


def test_every_value_says_what_it_is() -> None:
    """A metavar that completion does not know is one of which no shell can say how it goes on."""
    for command in commands_of(main):
        for parameter in command.params:
            is_option = isinstance(parameter, click.Option)
            if isinstance(parameter.type, click.types.StringParamType):
                known = completing.OPTIONS if is_option else completing.ARGUMENTS
                assert completing.metavar(parameter) in known, (command.name, parameter.name)


@pytest.mark.one_in(6)
@pytest.mark.parametrize(
    "words", ["", "check --select", "check --machine", "explain", "check", "check --set", "check -o"]
)
def test_a_completion_loads_neither_the_rules_nor_numpy(words: str) -> None:
    code = (
        "import sys, polarcheck.commands\n"
        "try:\n    polarcheck.commands.run()\nexcept SystemExit as end:\n    assert not end.code, end.code\n"
        "assert not {'numpy', 'shapely', 'rich', 'polarcheck.rules.polar.rapid_in_polar'} & set(sys.modules)\n"
    )
    told = {"COMP_WORDS": "\n".join(["polarcheck", *words.split()]), "_POLARCHECK_COMPLETE": "fish_complete"}
    done = subprocess.run([sys.executable, "-c", code], env={**os.environ, **told}, capture_output=True, text=True)
    assert (done.returncode, done.stderr) == (0, "")
    assert done.stdout


# ---- the scripts ----


@looped("shell", completion.SHELLS, one_in=2)
def test_the_script_of_each_shell_is_shown_as_it_is(shell: str) -> None:
    done = process("completion", shell)
    told, errors = done.communicate(timeout=60)
    assert (done.returncode, errors) == (0, "")
    assert told == (completion.FOLDER / f"polarcheck.{shell}").read_text("utf-8")
    assert f"{shell}_complete" in told
    assert told.isascii()
    assert "\r" not in told


def test_there_is_a_script_for_each_shell_and_no_other() -> None:
    assert sorted(path.suffix[1:] for path in completion.FOLDER.iterdir()) == sorted(completion.SHELLS)
    assert call("completion", "tcsh").exit_code == 2


@pytest.mark.skipif(shutil.which("bash") is None, reason="bash is not installed")
def test_the_script_for_bash_has_no_fault_of_syntax() -> None:
    done = subprocess.run(["bash", "-n", os.fspath(completion.FOLDER / "polarcheck.bash")], capture_output=True)
    assert (done.returncode, done.stderr) == (0, b"")


TYPED = {
    "compl": "completion",
    "check --mach": "check --machine",
    "check --machine fanuc-3": "check --machine fanuc-30i",
    "check --machine=fanuc-3": "check --machine=fanuc-30i",
    "check --machine lath": "check --machine lathe3.toml",
    "check -o gith": "check -o github:",
    "check -o json:repo": "check -o json:report.txt",
    "check --severity rapid-in-polar=no": "check --severity rapid-in-polar=note",
    "check --select polar,rapid-in-p": "check --select polar,rapid-in-polar",
    "check --subprograms inn": "check --subprograms inner",
    "check O1": "check O1234.NC",
    "check ~/O1": "check {home}/O1234.NC",
    "explain unv": "explain unverified",
}
#: Lines with blanks in their names: what is typed, and the last word.
WITH_BLANKS = {
    "check my": "my part.nc",
    "check 'my": "my part.nc",
    "check two\\ words/i": "two words/inside.nc",
    "check -o text:my": "text:my part.nc",
}


@pytest.mark.nightly
@pytest.mark.parametrize("shell", COMMANDS)
def test_a_real_shell_completes(shell: str, tmp_path: Path) -> None:
    if not is_there(shell):
        pytest.skip(f"{shell} is not installed")
    put_command(tmp_path / "bin")
    put_told(tmp_path / "bin")
    for name in ("my part.nc", "report.txt", "lathe3.toml", "O1234.NC"):
        (tmp_path / name).touch()
    for name in ("two words", "inner"):
        (tmp_path / name).mkdir()
    (tmp_path / "two words" / "inside.nc").touch()
    typed = Typed(shell, tmp_path / "bin", tmp_path)
    try:
        for line, outcome in TYPED.items():
            words = [word.rstrip("/") for word in typed.words(f"polarcheck {line}")]
            assert words == ["polarcheck", *outcome.format(home=tmp_path).split()], line
        for line, last in WITH_BLANKS.items():
            assert typed.words(f"polarcheck {line}")[-1] == last, line
    finally:
        typed.close()


def test_without_a_shell_one_line_names_those_that_there_are() -> None:
    result = call("completion")
    assert result.exit_code == 2
    assert result.stderr.endswith("Choose from: bash, zsh, fish, powershell\n")
    assert "\\x" not in result.stderr
