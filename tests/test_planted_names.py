"""Names of files that begin as options: no command takes one as an option, whoever passes it."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import click
import pytest
from cases import looped
from test_cli import GOOD, RAPID, RAPID_ONLY, call, check, make
from test_completion import values

from polarcheck.commands import main, wildcards

pytestmark = pytest.mark.usefixtures("own_folder")

of_posix = pytest.mark.skipif(sys.platform == "win32", reason="names with colons, links and wildcards of POSIX")

PLANTED = ("--fail-on=never", "-ojson:NOTES", "--fix", "--exit-zero", "-h", "-q", "--no-such", "-part.nc", "--", "-")


def commands_with_paths() -> list[tuple[str, ...]]:
    """All commands that take an argument, those of groups, too, as the words that call them."""
    words = []
    for name, command in main.commands.items():
        inner = command.commands if isinstance(command, click.Group) else {"": command}
        words += [(name, *filter(None, [verb])) for verb, one in inner.items() if has_argument(one)]
    return words


def has_argument(command: click.Command) -> bool:
    return any(isinstance(parameter, click.Argument) for parameter in command.params)


def plant(*names: str) -> None:
    for name in names:
        Path(f"./{name}").parent.mkdir(parents=True, exist_ok=True)
        Path(f"./{name}").write_text("")


def refusal(name: str) -> str:
    meaning = {"-": "standard input", "--": "the end of the options"}.get(name, "an option")
    return f"polarcheck: {name}: would be taken as {meaning}, but a file has this name; write ./{name} for the file\n"


@pytest.mark.parametrize("command", commands_with_paths())
@pytest.mark.parametrize("name", ["--fail-on=never", "-o", "--help", "-"])
def test_every_command_refuses_an_option_that_is_the_name_of_a_file(command: tuple[str, ...], name: str) -> None:
    make(a__nc=GOOD)
    plant(name)
    for arguments in ([name], [name, "a.nc"], ["a.nc", name], ["check", "a.nc", name]):
        result = call(*command, *arguments)
        assert (result.exit_code, result.stdout, result.stderr) == (2, "", refusal(name))


def test_commands_of_groups_are_among_them() -> None:
    words = commands_with_paths()
    assert {("check",), ("baseline", "create"), ("config", "show"), ("machines",), ("certify",)} <= set(words)
    assert len(words) > 15


@of_posix
@pytest.mark.parametrize("name", PLANTED)
def test_a_name_is_refused_wherever_it_stands_and_nothing_is_done(name: str) -> None:
    make(a__nc=RAPID, NOTES="mine")
    plant(name)
    for arguments in ((name, "a.nc"), ("a.nc", name), (*RAPID_ONLY, "a.nc", name), ("--strict", name, "a.nc")):
        result = check(*arguments, given="M30")
        assert (result.exit_code, result.stdout, result.stderr) == (2, "", refusal(name))
    assert Path("NOTES").read_text() == "mine"
    assert Path("a.nc").read_text() == RAPID


@of_posix
@looped("name", ["-ojson:out/NOTES", "--config=/tmp/x.toml", "--fix/../a.nc"])
def test_a_name_with_folders_is_that_of_a_file_as_it_is_spelled(name: str) -> None:
    make(a__nc=GOOD)
    plant(name)
    assert check(name, "a.nc").stderr == refusal(name)


@of_posix
def test_folders_and_links_that_lead_nowhere_have_names_too() -> None:
    make(a__nc=GOOD)
    Path("--fix").mkdir()
    assert check("--fix", "a.nc").stderr == refusal("--fix")
    Path("--quiet").symlink_to("nowhere")
    assert check("--quiet", "a.nc").stderr == refusal("--quiet")


@pytest.mark.ci
def test_paths_that_cannot_be_options_are_read() -> None:
    make(a__nc=GOOD)
    plant("--fix")
    for name in ("--fail-on=never", "-part.nc", "-"):
        Path(f"./{name}").write_text(RAPID)
    for arguments in (["--", "--fail-on=never"], ["./--fail-on=never"], ["--", "-part.nc", "a.nc"], ["./-"]):
        assert check(*RAPID_ONLY, *arguments).exit_code == 1
    assert Path("a.nc").read_text() == GOOD
    # Standard input is what `-` means behind `--`, too.
    assert check(*RAPID_ONLY, "--", "a.nc", "-").stderr == refusal("-")


def test_the_second_mark_is_a_path() -> None:
    Path("--").write_text(RAPID)
    assert check(*RAPID_ONLY, "--", "--").stderr == refusal("--")
    Path("--").rename("-- ")
    assert "--: No such file" in check("--", "--").stderr


def test_values_of_options_are_no_options() -> None:
    make(a__nc=GOOD)
    Path("-old.nc").write_text(RAPID)
    plant("-5", "--tool")
    assert check(*RAPID_ONLY, "--exclude", "-old.nc", ".").exit_code == 0
    assert "-5: expected" in check("--set", "-5", "a.nc").stderr
    # A flag has no value: what stands behind it may be an option.
    assert check("--quiet", "--tool", "8:radius=3", "a.nc").stderr == refusal("--tool")


def test_options_without_a_file_of_that_name_are_options() -> None:
    make(a__nc=RAPID)
    plant("fix", "sub/--fail-on=never", "--fail-on")
    assert check(*RAPID_ONLY, "--fail-on=never", "a.nc").exit_code == 0
    assert check(*RAPID_ONLY, "-", given=RAPID).exit_code == 1
    assert call("--version").exit_code == 0


def test_a_command_that_takes_no_path_has_its_options() -> None:
    plant("--help", "--debug")
    for words in (["rules", "--help"], ["--help"], ["--debug", "rules"]):
        assert call(*words).exit_code == 0


def test_what_wildcards_name_on_windows_is_refused_too() -> None:
    make(a__nc=GOOD)
    plant("--fail-on=never")
    assert wildcards.expanded(["check", "*"]) == ["check", "--fail-on=never", "a.nc"]
    assert call(*wildcards.expanded(["check", "*"])).stderr == refusal("--fail-on=never")


def test_completion_goes_on_where_a_file_has_the_name_of_an_option() -> None:
    plant("--quiet")
    assert "--fail-on" in values("check --quiet", "--fai")


@pytest.mark.ci
@of_posix
@pytest.mark.parametrize("name", ["--fail-on=never", "--exit-zero", "-ojson:NOTES", "--fix"])
def test_wildcards_of_a_shell_give_no_options(name: str) -> None:
    make(a__nc=RAPID, NOTES="mine")
    plant(name)
    line = f'"{sys.executable}" -m polarcheck check *'
    done = subprocess.run(["sh", "-c", line], capture_output=True, text=True, check=False)
    assert (done.returncode, done.stdout, done.stderr) == (2, "", refusal(name))
    assert (Path("NOTES").read_text(), Path("a.nc").read_text()) == ("mine", RAPID)
