"""The pages for editors: what they tell to copy is read from them, and tried on real output."""

from __future__ import annotations

import json
import re
import shutil
import subprocess
import sys
import tomllib
from pathlib import Path
from typing import Any

import click
import msgspec
import pytest
from programs import ROOT, report_of
from test_cli import RAPID, call

from polarcheck.commands import main
from polarcheck.files.batch import tasks as batch
from polarcheck.program.reading.walking import EXTENSIONS
from polarcheck.reports import Background, render

pytestmark = [pytest.mark.ci, pytest.mark.usefixtures("own_folder")]

PAGES = ROOT / "docs" / "editors"
TASKS: list[dict[str, Any]] = json.loads((PAGES / "tasks.json").read_text("utf-8"))["tasks"]
#: As they stand in a report; those of Windows are shown with slashes, but an editor may ask with its own.
PATHS = (
    "O1234",
    "inner folder/a b(1).nc",
    "C:/shop/O1.NC",
    "C:\\shop\\o 1.nc",
    "//server/share$/\u00fc#%/O1.NC",
    "/srv/12:34/a.nc",
    "a [rule] error: .nc",
    "./-x.nc",
)
#: Of each severity, with a message that holds what the pattern looks for.
NASTY = (
    RAPID.replace("C0\n", "C0 (A:1:2: error: B [c])\n").replace("G1 C", "g1 C") + "M98 P77\n(1:2: note: [x-y])#1=[\n"
)


def lines_of(path: str) -> tuple[list[str], list[Any]]:
    """The lines of a concise report under a path, and its findings."""
    file = msgspec.structs.replace(report_of(NASTY), path=path)
    report = batch.report([file], "fanuc")
    return render("concise", report, Background()).splitlines(), file.findings


@pytest.mark.parametrize("path", PATHS)
@pytest.mark.parametrize("task", TASKS, ids=lambda task: str(task["label"]))
def test_the_problem_matcher_finds_file_place_and_rule(task: dict[str, Any], path: str) -> None:
    pattern = task["problemMatcher"]["pattern"]
    lines, findings = lines_of(path)
    assert len(findings) > 2
    for line, found in zip(lines, findings, strict=True):
        match = re.fullmatch(pattern["regexp"], line)
        assert match is not None
        told = {key: match[group] for key, group in pattern.items() if key != "regexp"}
        assert told == {
            "file": path,
            "line": str(found.line),
            "column": str(found.column),
            "severity": found.severity,
            "message": found.message,
            "code": found.rule,
        }


def test_other_lines_are_no_findings() -> None:
    pattern = TASKS[0]["problemMatcher"]["pattern"]["regexp"]
    Path("a.nc").write_text(RAPID, "utf-8")
    for form in ("text", "json"):
        shown = call("check", "a.nc", "--format", form, "--color", "never").stdout
        assert not [line for line in shown.splitlines() if re.fullmatch(pattern, line)]


@pytest.mark.parametrize("task", TASKS, ids=lambda task: str(task["label"]))
@pytest.mark.parametrize("name", ["O1234", "a b.nc", *(["\u00fc:1.nc", "'$(x).nc"] if sys.platform != "win32" else [])])
def test_the_task_checks_the_program(task: dict[str, Any], name: str) -> None:
    path = Path(name).absolute()
    path.write_text(RAPID, "utf-8")
    assert task["command"] == "polarcheck"
    result = call(*(str(path) if word == "${file}" else word for word in task["args"]))
    assert result.exit_code == 1
    matches = [re.fullmatch(task["problemMatcher"]["pattern"]["regexp"], line) for line in result.stdout.splitlines()]
    assert matches
    assert {match and Path(match[1]).absolute() for match in matches} == {path}


def test_the_masks_of_notepad_match_each_severity() -> None:
    page = (PAGES / "notepadpp.md").read_text("utf-8")
    masks = re.findall(r"^    (%FILE%.*)$", page, re.MULTILINE)
    places = {"%FILE%": "(.+?)", "%LINE%": r"(\d+)", "%CHAR%": r"(\d+)", r"\*": ".*"}
    patterns = []
    for mask in masks:
        pattern = re.escape(mask)
        for written, meant in places.items():
            pattern = pattern.replace(written, meant)
        patterns.append(pattern)
    lines, findings = lines_of("C:/shop/O1.NC")
    assert {found.severity for found in findings} == {"error", "warning", "note"}
    for line, found in zip(lines, findings, strict=True):
        (match,) = [match for pattern in patterns if (match := re.fullmatch(pattern, line))]
        assert match.groups() == ("C:/shop/O1.NC", str(found.line), str(found.column))


def test_the_configuration_of_helix_starts_the_server() -> None:
    (block,) = re.findall(r"```toml\n(.*?)```", (PAGES / "helix.md").read_text("utf-8"), re.DOTALL)
    written = tomllib.loads(block)
    (language,) = written["language"]
    (server,) = (written["language-server"][name] for name in language["language-servers"])
    assert server["command"] == "polarcheck"
    assert server["args"][0] in main.commands
    endings = {f".{kind}" for kind in language["file-types"] if isinstance(kind, str)}
    assert endings <= set(EXTENSIONS)


@pytest.mark.skipif(shutil.which("nvim") is None, reason="there is no Neovim here")
@pytest.mark.skipif(sys.platform == "win32", reason="the page names the executable as Unix does")
def test_neovim_shows_findings_with_the_configuration_of_the_page() -> None:
    programs, new, old = re.findall(r"```lua\n(.*?)```", (PAGES / "neovim.md").read_text("utf-8"), re.DOTALL)
    is_new = "vim.lsp.config" in subprocess.run(
        ["nvim", "--headless", "-u", "NONE", "-c", "lua print(vim.lsp.config and 'vim.lsp.config' or '')", "-c", "q"],
        stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=60,
    ).stdout  # fmt: skip
    command = json.dumps([sys.executable, "-m", "polarcheck", "server"]).replace("[", "{").replace("]", "}")
    init = (new if is_new else f"vim.g.do_filetype_lua = 1\n{old}").replace('{ "polarcheck", "server" }', command)
    Path("init.lua").write_text(programs + init, "utf-8")
    Path("O0001.nc").write_text(RAPID, "utf-8")
    script = (
        "lua vim.wait(60000, function() return #vim.diagnostic.get(0) > 0 end, 50) "
        "for _, mark in ipairs(vim.diagnostic.get(0)) do io.write(mark.code .. ' ') end"
    )
    shown = subprocess.run(
        ["nvim", "--headless", "-u", "init.lua", "O0001.nc", "-c", script, "-c", "qa!"],
        capture_output=True, text=True, timeout=120,
    ).stdout  # fmt: skip
    assert "rapid-in-polar" in shown


@pytest.mark.nightly
@pytest.mark.skipif(shutil.which("emacs") is None, reason="there is no Emacs here")
@pytest.mark.skipif(sys.platform == "win32", reason="the page names the executable as Unix does")
def test_emacs_marks_the_words_of_findings_with_the_configuration_of_the_page() -> None:
    (init,) = re.findall(r"```elisp\n(.*?)```", (PAGES / "emacs.md").read_text("utf-8"), re.DOTALL)
    emacs = ["emacs", "--batch", "-f", "package-initialize", "-l"]
    if subprocess.run([*emacs, "eglot"], capture_output=True, check=False, timeout=60).returncode:
        pytest.skip("this Emacs has no eglot")
    command = f'{json.dumps(sys.executable)} "-m" "polarcheck" "server"'
    Path("init.el").write_text(init.replace('"polarcheck" "server"', command), "utf-8")
    Path("O0001.nc").write_text(RAPID.replace("G0 C5.", "(\U0001d6fc) G0 C5."), "utf-8")
    script = """(let ((eglot-sync-connect 60) (tries 0))
      (find-file "O0001.nc") (run-hooks 'post-command-hook)
      (while (and (< (setq tries (1+ tries)) 600) (null (flymake-diagnostics))) (accept-process-output nil 0.1))
      (dolist (mark (flymake-diagnostics))
        (princ (format "%s %s\n" (buffer-substring (flymake-diagnostic-beg mark) (flymake-diagnostic-end mark))
          (flymake-diagnostic-text mark)))))"""
    shown = subprocess.run([*emacs, "init.el", "--eval", script], capture_output=True, text=True, timeout=120).stdout
    assert re.search(r"^G0 .*rapid-in-polar", shown, re.MULTILINE)


@pytest.mark.parametrize("page", sorted(PAGES.glob("*.md")), ids=lambda page: page.stem)
def test_options_and_links_of_the_pages_are_there(page: Path) -> None:
    text = page.read_text("utf-8")
    known = {
        written
        for name in ("server", "check")
        for parameter in main.commands[name].params
        if isinstance(parameter, click.Option)
        for written in parameter.opts
    }
    assert set(re.findall(r"(?<![\w-])--[a-z][a-z-]+", text)) <= known
    for target in re.findall(r"\]\(([^)]+)\)", text):
        name, _, anchor = target.partition("#")
        linked = page.parent / name if name else page
        assert linked.is_file()
        if not anchor:
            continue
        headings = re.findall(r"^#+ (.+)$", linked.read_text("utf-8"), re.MULTILINE)
        assert anchor in [heading.lower().replace(" ", "-") for heading in headings]
