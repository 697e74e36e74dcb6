"""The examples of docs/reports.md and docs/ci.md say what is printed and what can be written."""

from __future__ import annotations

import re
import shlex
from pathlib import Path

import click
import pytest
from programs import ROOT
from test_cli import call

from polarcheck import __version__
from polarcheck.commands import main
from polarcheck.reports import formats

pytestmark = pytest.mark.usefixtures("own_folder")

REPORTS = ROOT / "docs" / "reports.md"
CI = ROOT / "docs" / "ci.md"
CONSOLE = re.compile(r"```console\n\$ polarcheck (.*)\n((?:.*\n)*?)```\n")
PROGRAM = re.compile(r"```nc\n((?:.*\n)*?)```\n")


def examples() -> list[tuple[str, str]]:
    """Command lines and what stands below them."""
    return CONSOLE.findall(REPORTS.read_text("utf-8"))


@pytest.mark.parametrize(("line", "shown"), examples(), ids=lambda text: text[:60])
def test_what_is_shown_is_what_is_printed(line: str, shown: str) -> None:
    program = PROGRAM.search(REPORTS.read_text("utf-8"))
    assert program
    Path("O0007.NC").write_text(program[1], "utf-8")
    result = call(*shlex.split(line))
    assert (result.exit_code, result.stderr) == (1, "")
    assert result.stdout == shown.replace('"0.1.0"', f'"{__version__}"')


def test_each_format_is_told_of() -> None:
    text = REPORTS.read_text("utf-8")
    assert re.findall(r"^\| `(\w+)` \|", text, re.MULTILINE) == [
        *("text", "short", "concise", "json", "jsonl", "sarif", "github", "gitlab", "junit", "checkstyle", "html")
    ]
    assert {*re.findall(r"^\| `(\w+)` \|", text, re.MULTILINE)} == {*formats()}
    assert len(examples()) == 6


@pytest.mark.parametrize("page", [REPORTS, CI], ids=lambda path: path.name)
def test_options_on_the_pages_are_options(page: Path) -> None:
    with click.Context(main) as ctx:
        check = main.get_command(ctx, "check")
    assert check
    known = {name for parameter in check.params for name in parameter.opts}
    words = re.findall(r"(?<![\w-])(--[a-z][a-z-]*)", page.read_text("utf-8"))
    assert words
    of_others = {"--all-files"}
    assert {*words} - known <= of_others


@pytest.mark.parametrize("page", [REPORTS, CI], ids=lambda path: path.name)
def test_links_lead_to_files(page: Path) -> None:
    for target in re.findall(r"\]\(([^)#]+)", page.read_text("utf-8")):
        assert (page.parent / target).exists(), target


def test_yaml_on_the_page_can_be_read() -> None:
    yaml = pytest.importorskip("yaml")
    pieces = re.findall(r"```yaml\n((?:.*\n)*?)```\n", CI.read_text("utf-8"))
    assert len(pieces) == 3
    for piece in pieces:
        assert yaml.safe_load(piece.replace("<this repository>", "x"))


def test_what_the_page_gives_to_the_action_are_its_inputs() -> None:
    yaml = pytest.importorskip("yaml")
    inputs = yaml.safe_load((ROOT / "action.yml").read_text("utf-8"))["inputs"]
    text = CI.read_text("utf-8")
    given = text[text.index("        with:\n") :].partition("```")[0]
    assert {*re.findall(r"^ {10}([a-z-]+):", given, re.MULTILINE)} <= {*inputs}
    for name in ("paths", "diff-base", "upload"):
        assert name in inputs
        assert f"`{name}" in text
