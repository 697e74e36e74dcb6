"""What comes from a program, a file name, a machine file, a job or an option is data, whoever prints it."""

from __future__ import annotations

import json
import os
import re
import sys
from pathlib import Path

import pytest
from cases import looped
from test_cli import call, process

from polarcheck.reports import PER_FILE, formats

#: Formats that hold many programs.
OF_MANY = [form for form in formats() if form not in PER_FILE]
#: Color, title and bell of a terminal, line ends, changes of direction, no width, CSI of one byte, delete; markup.
ACTING = (
    "\x1b[31mE\x1b]0;title\x07\nN\rR\u202eB\u2066\u200b\ufeff\x9b1mC\x7f\t"
    "[red]x[/red][link=http://localhost]l[/link]<script>alert(1)</script>"
)
IN_A_LINE = ACTING.replace("\n", "").replace("\r", "")
NAME = "a\x1b[31m\n\x07\u202e[red]<script>.nc"
PROGRAM = f"""%
O0001({IN_A_LINE})
T0101({IN_A_LINE})
G98 G0 X60. C0
G12.1
G1 G42 X40. F20000
G0 C5.
{ACTING}
M98 P77
M98 <A\x1b[31mB>
#1=[\x1b[31m
G112 \u202e
G1 C-5.
G13.1
M30
"""
SEEN = re.compile("[\x00-\x08\x0b-\x1f\x7f-\x9f\xad\u061c\u200b-\u200f\u2028-\u202e\u2060-\u206f\ufeff]")
#: What reports themselves paint with.
OWN_COLOR = re.compile(r"\x1b\[(?:0|1|2|1;3[1-6])m")


def toml(text: str) -> str:
    return json.dumps(text)


MACHINE = f"""inherits = "fanuc-30i"
title = {toml(ACTING)}
notes = [{toml(ACTING)}]
[alarms]
rapid-in-polar = {toml("PS0146" + ACTING)}
unknown-code = {toml("PS0010" + ACTING)}
[polar]
other_controls = {toml(ACTING)}
[limits]
c_feed = {{ value = 10, source = {toml(ACTING)}, doubtful = true }}
[known_parameters]
{toml("P" + ACTING)} = {{ title = {toml(ACTING)}, key = "limits.c_acceleration" }}
[parameters]
{toml("P" + ACTING)} = 5
"""
BROKEN_MACHINES = (
    f"inherits = {toml(ACTING)}",
    f"inherits = 'fanuc'\n[limits]\n{toml(ACTING)} = 3",
    f"inherits = 'fanuc'\n[{toml(ACTING)}]\nx = 3",
    f"inherits = 'fanuc'\n[control]\nx = {toml(ACTING)}",
    f"inherits = 'fanuc'\n[control]\nknown_codes = [{toml(ACTING)}]",
    f"inherits = 'fanuc'\n[control.native_words]\n{toml(ACTING)} = {toml(ACTING)}",
    f"inherits = 'fanuc'\n[alarms]\n{toml(ACTING)} = 'x'",
    f"inherits = 'fanuc'\n[parameters]\n{toml(ACTING)} = 1",
    f"inherits = 'fanuc'\n[parameters]\n5460 = {toml(ACTING)}",
    f"replaces = [{toml(ACTING)}]\ninherits = 'fanuc'",
    f"inherits = 'fanuc'\n{toml(ACTING)} = [",
)
BROKEN_JOBS = (
    f"machine = {toml(ACTING)}",
    f"offsets = {toml(ACTING)}",
    f"select = [{toml(ACTING)}]",
    f"[severities]\n{toml(ACTING)} = 'off'",
    f"[tools.{toml(ACTING)}]\nradius = 1",
    f"[run]\nsubprograms = [{toml(ACTING)}]",
    f"[work_offsets]\n{toml(ACTING)} = {{x = 1}}",
    f"{toml(ACTING)} = 1",
    f"units = {toml(ACTING)}",
)
OPTIONS = (
    *("--machine", "--set", "--tool", "--offsets", "--units", "--select", "--ignore", "--severity", "--format", "-o"),
    *("--encoding", "--block-skip", "--subprograms", "--config", "--max-blocks", "--max-seconds", "--extensions"),
)
OF_MACHINE = ("--machine", "x.toml")
#: File names on Windows hold none of these.
PATHS = ("a.nc",) if sys.platform == "win32" else ("a.nc", NAME)


@pytest.fixture(autouse=True)
def _with_all_that_could_act(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    for path in PATHS:
        Path(path).write_bytes(PROGRAM.encode())
    Path("x.toml").write_text(MACHINE, "utf-8")
    for number, text in enumerate(BROKEN_MACHINES):
        Path(f"m{number}.toml").write_text(text, "utf-8")
    for number, text in enumerate(BROKEN_JOBS):
        Path(f"j{number}.toml").write_text(text, "utf-8")


def checks() -> list[tuple[str, ...]]:
    found: list[tuple[str, ...]] = []
    for form in OF_MANY:
        for path in PATHS:
            options = ("--format", form, "--tool", "1:radius=4", "--show-following")
            found += [("check", path, *OF_MACHINE, *options, "--color", color) for color in ("never", "always")]
    found += [("check", path, *OF_MACHINE, "--diff", "--unsafe-fixes") for path in PATHS]
    return found


def others() -> list[tuple[str, ...]]:
    rules = ("rapid-in-polar", "unknown-code", "PS0146", "polar", "setup", "unverified", ACTING)
    found: list[tuple[str, ...]] = [("explain", *OF_MACHINE, rule) for rule in rules]
    found += [
        ("machines",),
        ("machines", "x.toml"),
        ("machines", ACTING),
        ("machines", "new", "NL", "--from", "x.toml"),
    ]
    found += [
        ("machines", "new", "NL", "--from", ACTING),
        ("machines", "new", ACTING),
        ("machines", "new", ACTING, ACTING),
    ]
    found += [("rules",), ("rules", "--format", "json"), ("schema",), ("schema", ACTING), (ACTING,), ("check", ACTING)]
    found += [("machines", f"m{number}.toml") for number in range(len(BROKEN_MACHINES))]
    found += [("explain", "polar", "--machine", f"m{number}.toml") for number in range(len(BROKEN_MACHINES))]
    found += [("check", "a.nc", "--config", f"j{number}.toml") for number in range(len(BROKEN_JOBS))]
    words = (ACTING, f"1:radius={ACTING}", f"limits.c_feed={ACTING}", f"rapid-in-polar={ACTING}")
    found += [("check", "a.nc", option, word) for option in OPTIONS for word in words]
    for path in PATHS:
        for way in ((), ("--path", "tool")):
            found += [("trace", path, *OF_MACHINE, "--format", form, *way) for form in ("csv", "jsonl")]
    return found


def acting(data: bytes, color: bool = False) -> list[str]:
    """What acts in an output, with what stands around it."""
    text = data.decode("utf-8")
    text = OWN_COLOR.sub("", text) if color else text
    return [text[max(found.start() - 40, 0) : found.end() + 20] for found in SEEN.finditer(text)]


@pytest.mark.ci
@pytest.mark.parametrize("arguments", [*checks(), *others()], ids=lambda words: " ".join(map(repr, words))[:80])
def test_nothing_acts(arguments: tuple[str, ...]) -> None:
    result = call(*arguments)
    assert result.exit_code in (0, 1, 2)
    assert not acting(result.stdout_bytes, "always" in arguments)
    assert not acting(result.stderr_bytes)
    # Nor does a line end of theirs make a line of its own: each line of ours begins with the name.
    assert all(line.startswith("polarcheck: ") for line in result.stderr.splitlines())
    assert not re.search(r"^(?:N\\x0d|NR)", result.stdout, re.MULTILINE)


@pytest.mark.ci
@pytest.mark.one_in(12)
@pytest.mark.parametrize("form", OF_MANY)
def test_nothing_acts_in_a_file_that_is_written(form: str) -> None:
    call("check", *PATHS, *OF_MACHINE, "-o", f"{form}:out")
    assert Path("out").stat().st_size
    assert not acting(Path("out").read_bytes())


@pytest.mark.nightly
def test_nothing_acts_in_the_bytes_of_a_process() -> None:
    """Whatever stands between click and the terminal, markup is no color even where color is asked for."""
    with process("check", *PATHS, *OF_MACHINE, "--color", "always") as running:
        out, error = running.communicate(timeout=120)
    assert running.returncode == 1
    assert "[red]x[/red]" in out
    assert not acting(OWN_COLOR.sub("", out).encode())
    assert not acting(error.encode())


def test_a_new_machine_takes_over_nothing_that_acts() -> None:
    assert call("machines", "new", "NL\u202e\x7f", "--from", "x.toml").exit_code == 0
    made = next(path for path in Path().iterdir() if path.name.startswith("NL"))
    assert not acting(made.read_bytes())
    result = call("machines", os.fspath(made))
    assert result.exit_code == 0
    assert "title" in result.stdout


@pytest.mark.ci
def test_the_messages_hold_what_was_written() -> None:
    """Spelled out, not left out: else the user does not find it."""
    assert "\\x1b[31mE" in call("explain", *OF_MACHINE, "rapid-in-polar").stdout
    assert "\\u202e" in call("machines", "x.toml").stdout
    report = json.loads(call("check", *PATHS, *OF_MACHINE, "--format", "json").stdout)
    assert report["files"][-1]["path"] == PATHS[-1]


# ---- the log of a CI job ----

#: The runner of GitHub reads a command from a line that begins with ::, behind blanks as well, else from ##[ in it.
OF_RUNNER = re.compile(r"^\s*::(?!(?:error|warning|notice) title=|group::|endgroup::$)", re.MULTILINE)
OLD_OF_RUNNER = re.compile(r"^(?!::).*##\[", re.MULTILINE)
#: Formats that hold names and texts as they are: a reader of data takes them, and they are written into files.
OF_DATA = {"json", "jsonl", "sarif", "gitlab", "junit", "checkstyle"}
COMMANDS = (
    *("::stop-commands::x.nc", "  ::add-mask::x.nc", "\t::add-mask::x.nc", "a\n::error::x.nc", "a\r::error::x.nc"),
    *("##[add-path]x.nc", "a ##[group]x.nc", f"{'a' * 90} ::error::x.nc", "::", ":::x.nc"),
)
OF_FILES = (
    *(("check", "--format", form, "--show-following") for form in OF_MANY),
    *(("part",), ("check", "--show", "path"), ("check", "--format", "short", "--color", "never")),
)
without_such_names = pytest.mark.skipif(sys.platform == "win32", reason="no file of Windows has : in its name")


@pytest.mark.nightly
@pytest.mark.one_in(13)
@without_such_names
@pytest.mark.parametrize("arguments", OF_FILES, ids=" ".join)
def test_no_line_of_a_report_is_a_command_of_a_ci_log(arguments: tuple[str, ...]) -> None:
    for name in COMMANDS:
        Path(name).write_bytes(f"{PROGRAM}(::error::x)\n::error::x\n(##[error]x)\nG12.1 ##[error]x\n".encode())
    result = call(*arguments, "--", *COMMANDS)
    assert result.exit_code in (0, 1)
    assert "x.nc" in result.stdout
    assert not OF_RUNNER.search(result.stdout)
    assert OF_DATA & {*arguments} or not OLD_OF_RUNNER.search(result.stdout)
    assert not OF_RUNNER.search(result.stderr)
    assert not OLD_OF_RUNNER.search(result.stderr)


@pytest.mark.one_in(12)
@pytest.mark.ci
@without_such_names
@pytest.mark.parametrize("name", COMMANDS)
def test_no_line_on_one_file_is_a_command_of_a_ci_log(name: str) -> None:
    for arguments in (("check", name), ("check", f"{name}.gone"), ("feeds", name), ("trace", name), ("init", name)):
        Path(name).write_bytes(PROGRAM.encode())
        result = call(arguments[0], "--", *arguments[1:])
        assert not OF_RUNNER.search(result.stdout)
        assert not OF_RUNNER.search(result.stderr)


@pytest.mark.ci
@without_such_names
@looped("form", ["concise", "short"])
def test_a_path_that_would_be_a_command_still_leads_to_its_file(form: str) -> None:
    Path("::x.nc").write_bytes(PROGRAM.encode())
    first = call("check", "--format", form, "::x.nc").stdout.splitlines()[0]
    path = re.split(r":\d+:\d+: ", first)[0]
    assert path == "./::x.nc"
    assert Path(path).is_file()
