"""Modules import in one direction only, and what a small run does not need is imported late."""

from __future__ import annotations

import ast
import subprocess
import sys
from pathlib import Path

import pytest

PACKAGE = Path(__file__).parent.parent / "polarcheck"
MODULES = sorted(PACKAGE.glob("*.py"))
LINE_LIMIT = 420


def imports(path: Path) -> set[str]:
    """The modules of the package that are imported at the top or inside functions, but not for types only."""
    tree = ast.parse(path.read_text("utf-8"))
    types_only = {
        id(node)
        for branch in ast.walk(tree)
        if isinstance(branch, ast.If) and "TYPE_CHECKING" in ast.unparse(branch.test)
        for node in ast.walk(branch)
    }
    found = set()
    for node in ast.walk(tree):
        if isinstance(node, ast.ImportFrom) and node.module and id(node) not in types_only:
            parts = node.module.split(".")
            if parts[0] == "polarcheck":
                found |= {parts[1]} if len(parts) > 1 else {alias.name for alias in node.names}
    return found - {"__version__"}


def test_imports_have_no_circles() -> None:
    graph = {path.stem: imports(path) for path in MODULES if path.stem != "__init__"}
    graph = {name: targets & set(graph) for name, targets in graph.items()}
    order: list[str] = []
    while len(order) < len(graph):
        ready = [name for name in graph if name not in order and graph[name] <= set(order)]
        assert ready, {name: graph[name] - set(order) for name in graph if name not in order}
        order += ready


@pytest.mark.parametrize("path", sorted(PACKAGE.rglob("*.py")), ids=lambda path: path.stem)
def test_modules_can_be_read_in_one_sitting(path: Path) -> None:
    assert len(path.read_text("utf-8").splitlines()) <= LINE_LIMIT


@pytest.mark.parametrize("path", sorted((PACKAGE / "rules").glob("*/*.py")), ids=lambda path: path.stem)
def test_rules_neither_loop_nor_load_numpy(path: Path) -> None:
    tree = ast.parse(path.read_text("utf-8"))
    assert imports(path) <= {"rule", "modal"}
    assert not any(isinstance(node, ast.For | ast.While) for node in ast.walk(tree))


@pytest.mark.parametrize(
    "arguments", [["--help"], ["explain", "rapid-in-polar"], ["rules"], ["machines"], ["machines", "fanuc"], ["schema"]]
)
def test_what_reads_no_program_loads_no_numpy(arguments: list[str]) -> None:
    code = (
        "import sys, polarcheck.cli\n"
        f"sys.argv = ['polarcheck', *{arguments!r}]\n"
        "try:\n    polarcheck.cli.run()\nexcept SystemExit as end:\n    assert not end.code, end.code\n"
        "assert not {'numpy', 'shapely'} & set(sys.modules)\n"
    )
    subprocess.run([sys.executable, "-c", code], check=True, capture_output=True)


def test_no_control_is_named_in_code() -> None:
    """A difference between controls is data; only comments and docstrings name a control, as their source."""
    controls = ("fanuc", "haas", "gsk", "mitsubishi", "okuma", "mazak", "siemens", "citizen", "doosan", "lsis")
    for path in PACKAGE.rglob("*.py"):
        tree = ast.parse(path.read_text("utf-8"))
        documents = {
            id(node.body[0].value)
            for node in ast.walk(tree)
            if isinstance(node, ast.Module | ast.FunctionDef | ast.ClassDef)
            and node.body
            and isinstance(node.body[0], ast.Expr)
        }
        for node in ast.walk(tree):
            if isinstance(node, ast.Constant) and isinstance(node.value, str) and id(node) not in documents:
                named = [name for name in controls if name in node.value.lower()]
                is_default = path.name == "machine.py" and node.value == "fanuc"
                assert not named or is_default, (path.name, node.value)
