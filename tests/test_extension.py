"""The extension for VS Code: what it declares, and its tests in node, which speak with the server of this checkout."""

from __future__ import annotations

import json
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest
from cases import looped
from programs import ROOT

from polarcheck import __version__
from polarcheck.program.reading.walking import EXTENSIONS

pytestmark = pytest.mark.ci

EXTENSION = ROOT / "editors" / "vscode"
DECLARED: dict[str, Any] = json.loads((EXTENSION / "package.json").read_text("utf-8"))
CONTRIBUTED = DECLARED["contributes"]
SOURCES = "\n".join(path.read_text("utf-8") for path in sorted((EXTENSION / "src").glob("*.js")))

needs_node = pytest.mark.skipif(
    shutil.which("node") is None or not (EXTENSION / "node_modules").is_dir(),
    reason="node is missing, or `npm ci --ignore-scripts` has not run in editors/vscode",
)


def node(*command: str, **options: Any) -> str:
    """What a command in the folder of the extension prints; it must end with 0."""
    environment = {**os.environ, "POLARCHECK_PYTHON": sys.executable}
    result = subprocess.run(
        command, cwd=EXTENSION, env=environment, capture_output=True, text=True, timeout=300, **options
    )
    assert result.returncode == 0, result.stdout + result.stderr
    return result.stdout


@pytest.mark.nightly
@needs_node
def test_grammar_and_client_in_node() -> None:
    assert "# fail 0" in node("npm", "--silent", "test")


@needs_node
def test_a_program_that_a_folder_plants_is_not_started() -> None:
    assert "# fail 0" in node("node", "--test", "test/executable.test.js")


def test_the_extension_starts_one_program_whose_path_it_has_searched() -> None:
    assert re.findall(r'const (.*) = require\("(?:node:)?child_process"\)', SOURCES) == ["{ spawn }"]
    assert re.findall(r"\bspawn\((\w+)", SOURCES) == ["program"]
    assert "const program = isRefused ? undefined : executable(command, folder);" in SOURCES
    # vscode-languageclient searches the PATH itself where it is given a command, and ends such a process by name.
    assert 'new Connection("polarcheck", "polarcheck", () => this.spawned(line, left)' in SOURCES


@pytest.mark.nightly
@needs_node
def test_the_package_is_built_from_checked_types(tmp_path: Path) -> None:
    node("npm", "--silent", "run", "types")
    target = tmp_path / "polarcheck.vsix"
    node("npm", "--silent", "run", "package", "--", "--out", str(target))
    names = node(sys.executable, "-m", "zipfile", "-l", str(target))
    for name in ("dist/extension.js", "icon.png", "readme.md", "LICENSE.txt", "syntaxes/gcode.tmLanguage.json"):
        assert f"extension/{name}" in names
    assert "node_modules" not in names
    assert ".test.js" not in names


def test_what_npm_makes_stays_out_of_the_source_distribution() -> None:
    # hatchling reads the .gitignore of the root alone.
    patterns = [set((folder / ".gitignore").read_text("utf-8").split()) for folder in (EXTENSION, ROOT)]
    assert patterns[0] <= patterns[1]


def test_programs_of_check_are_programs_of_the_editor() -> None:
    declared = {ending for language in CONTRIBUTED["languages"] for ending in language["extensions"]}
    assert set(EXTENSIONS) <= declared
    # Endings of other languages are left to them.
    assert not declared & {".txt", ".m", ".s", ".p", ".lib", ".out", ".dat", ".bak", ".py"}


@looped(
    ("first", "language"),
    [
        ("%", "gcode"),
        ("%O1234", "gcode"),
        ("O1234", "gcode"),
        ("O0001(SHAFT)", "gcode"),
        (":77", "gcode"),
        ("%_N_SHAFT_MPF", "sinumerik"),
        ("%!PS-Adobe-3.0", None),
        ("% a comment of TeX", None),
        ("%PDF-1.7", None),
        ("O", None),
        ("Once upon a time", None),
        ("# Title", None),
    ],
)
def test_first_lines_say_the_language(first: str, language: str | None) -> None:
    matching = [each["id"] for each in CONTRIBUTED["languages"] if re.search(each["firstLine"], first)]
    assert matching == ([] if language is None else [language])


@looped(
    ("language", "block", "words"),
    [
        ("gcode", "N10G1X-10.5C#101F[#2*3]", ["N10", "G1", "X-10.5", "C", "#101", "F", "#2", "3"]),
        ("gcode", "IF[#1EQ2]GOTO100", ["IF", "#1", "EQ", "2", "GOTO", "100"]),
        ("gcode", "(ALLOW RAPID-IN-POLAR)", ["ALLOW", "RAPID", "IN", "POLAR"]),
        ("sinumerik", "G1 X=IC(5) R12=$AA_IM[X]", ["G1", "X", "IC", "5", "R12", "$AA_IM", "X"]),
        ("sinumerik", "LOOP1: GOTOF ENDE", ["LOOP1", "GOTOF", "ENDE"]),
    ],
)
def test_words_are_those_of_a_control(language: str, block: str, words: list[str]) -> None:
    configuration = json.loads((EXTENSION / "language-configuration" / f"{language}.json").read_text("utf-8"))
    assert re.findall(configuration["wordPattern"], block) == words


def test_settings_and_commands_are_declared_used_and_explained() -> None:
    readme = (EXTENSION / "README.md").read_text("utf-8")
    page = (ROOT / "docs" / "editors" / "vscode.md").read_text("utf-8")
    settings = CONTRIBUTED["configuration"]["properties"]
    for name in settings:
        assert f"`{name}`" in readme
        assert f"`{name}`" in page
        # vscode-languageclient reads trace.server itself.
        assert f'get("{name.removeprefix("polarcheck.")}"' in SOURCES or name == "polarcheck.trace.server"
    assert set(re.findall(r'registerCommand\("([^"]+)"', SOURCES)) == {
        command["command"] for command in CONTRIBUTED["commands"]
    }
    restricted = set(DECLARED["capabilities"]["untrustedWorkspaces"]["restrictedConfigurations"])
    assert restricted == {name for name, each in settings.items() if each["scope"] == "machine-overridable"}


def test_versions_license_and_lock_file_agree() -> None:
    lock = json.loads((EXTENSION / "package-lock.json").read_text("utf-8"))
    assert DECLARED["version"] == lock["version"] == __version__
    assert lock["packages"][""]["devDependencies"] == DECLARED["devDependencies"]
    # The registry is that of whoever installs.
    assert not [name for name, package in lock["packages"].items() if "resolved" in package]
    assert (EXTENSION / "LICENSE").read_text("utf-8") == (ROOT / "LICENSE").read_text("utf-8")
