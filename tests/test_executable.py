"""The executable has in it all that polarcheck finds by listing its folders; .ci/executable.py builds and tries it."""

from __future__ import annotations

import ast
import os
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
from programs import ROOT

from polarcheck.commands import NAMES, completion
from polarcheck.program.machines import profiles
from polarcheck.reports import OF_WINGS, formats
from polarcheck.rules.rule import load_all

SPEC = ROOT / ".ci" / "executable.spec"

pytestmark = [pytest.mark.ci, pytest.mark.skipif(not SPEC.exists(), reason="builds from a checkout")]


@pytest.fixture(scope="module")
def analysis() -> dict[str, Any]:
    """What the file tells PyInstaller to take."""
    told: dict[str, Any] = {}

    def take(scripts: list[str], **options: Any) -> SimpleNamespace:
        told.update(options, scripts=scripts)
        return SimpleNamespace(pure=[], scripts=[], binaries=[], datas=[])

    def ignore(*arguments: Any, **options: Any) -> None:
        pass

    names = {"SPECPATH": os.fspath(SPEC.parent), "Analysis": take, "EXE": ignore, "PYZ": ignore, "COLLECT": ignore}
    exec(compile(SPEC.read_text("utf-8"), SPEC.name, "exec"), names)  # noqa: S102  a file of this project
    return told


def test_all_that_is_loaded_by_name_is_in_it(analysis: dict[str, Any]) -> None:
    modules = set(analysis["hiddenimports"])
    assert {rule.function.__module__ for rule in load_all().values()} <= modules
    assert {OF_WINGS.get(name, f"polarcheck.reports.{name}") for name in formats()} <= modules
    assert {f"polarcheck.commands.{name}" for name in NAMES} <= modules
    files = [path.relative_to(ROOT).with_suffix("") for path in (ROOT / "polarcheck").rglob("*.py")]
    assert modules == {".".join(path.parts).removesuffix(".__init__") for path in files}


def test_the_sources_lie_in_it_where_folders_are_listed(analysis: dict[str, Any]) -> None:
    assert analysis["module_collection_mode"] == {"polarcheck": "pyz+py"}


def test_machines_and_scripts_are_in_it(analysis: dict[str, Any]) -> None:
    found = {f"{folder}/{Path(source).name}".replace(os.sep, "/") for source, folder in analysis["datas"]}
    assert {f"polarcheck/program/machines/{name}.toml" for name in profiles.names()} <= found
    assert {f"polarcheck/commands/completions/polarcheck.{shell}" for shell in completion.SHELLS} <= found
    assert not any(name.endswith((".py", ".pyc")) for name in found)


def test_a_worker_of_the_executable_checks_nothing_anew(analysis: dict[str, Any]) -> None:
    """On Windows a worker is the program once more, from its first line."""
    (script,) = analysis["scripts"]
    calls = [node for node in ast.walk(ast.parse(Path(script).read_text("utf-8"))) if isinstance(node, ast.Call)]
    assert [ast.unparse(call.func) for call in calls] == ["multiprocessing.freeze_support", "run"]
