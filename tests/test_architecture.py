"""Packages import in the order of the data, modules in no circle, and what a small run does not need comes late."""

from __future__ import annotations

import ast
import functools
import gc
import re
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest
from cases import looped

from polarcheck.rules.rule import rule_files

PACKAGE = Path(__file__).parent.parent / "polarcheck"
#: From the top down; each may import those below it, and those that stand beside it in one tuple not. The wings stand
#: above the core: `reports` and what is below it import none of them.
ORDER = (
    ("__main__",),
    ("commands",),
    ("api",),
    ("editor",),
    ("rewrite", "view"),
    ("reports",),
    ("files",),
    ("checking",),
    ("rules",),
    ("parts",),
    ("columns",),
    ("program",),
    ("geometry",),
    ("foundation",),
)
FLOOR = {name: number for number, names in enumerate(reversed(ORDER)) for name in names}

Imports = dict[str, set[str]]


def modules(folder: Path) -> dict[str, Path]:
    """The modules of a package by dotted name, without the name of the package itself; a package is its __init__."""
    found = {}
    for path in sorted(folder.rglob("*.py")):
        parts = path.relative_to(folder).with_suffix("").parts
        found[".".join(parts[:-1] if parts[-1] == "__init__" else parts)] = path
    return found


def nodes_of(path: Path) -> list[ast.AST]:
    """The nodes of a module, itself first."""
    return nodes_in(path.read_text("utf-8"))


@functools.cache
def nodes_in(text: str) -> list[ast.AST]:
    """The nodes of a module with this text; several tests walk each."""
    return list(ast.walk(ast.parse(text)))


@functools.cache
def imports_of_package() -> Imports:
    return imports(PACKAGE)


def imports(folder: Path) -> Imports:
    """
    Every import of a module of the package by another: at the top, in functions, under TYPE_CHECKING, by
    import_module with a constant name. `from polarcheck.geometry import plane` imports geometry.plane.
    """
    known = modules(folder)
    found: Imports = {}
    gc.disable()  # the nodes are no garbage: looking for some among them took two thirds of the time
    for name, path in known.items():
        here = name if path.name == "__init__.py" else name.rpartition(".")[0]
        found[name] = set(_targets(nodes_of(path), here, known)) - {name, ""}
    gc.freeze()
    gc.enable()
    return found


def _targets(nodes: list[ast.AST], here: str, known: dict[str, Path]) -> Iterator[str]:
    for node in nodes:
        if isinstance(node, ast.Import):
            names = [alias.name for alias in node.names]
        elif isinstance(node, ast.ImportFrom):
            parts = here.split(".")[: len(here.split(".")) - node.level + 1] if node.level else []
            stem = ".".join([*(["polarcheck", *parts] if node.level else []), *([node.module] if node.module else [])])
            names = [f"{stem}.{alias.name}" for alias in node.names]
        elif isinstance(node, ast.Constant) and isinstance(node.value, str) and node.value.startswith("polarcheck."):
            names = [node.value.partition(":")[0]]
        else:
            continue
        for name in names:
            inside = name.removeprefix("polarcheck").removeprefix(".") if name.startswith("polarcheck") else ""
            if inside in known:
                yield inside
            elif inside.rpartition(".")[0] in known:
                yield inside.rpartition(".")[0]


def upward(found: Imports) -> list[str]:
    """The imports that point to a package above, or to one beside."""
    wrong = []
    for name, targets in found.items():
        own = name.partition(".")[0]
        for target in targets:
            other = target.partition(".")[0]
            if own and own != other and FLOOR[other] >= FLOOR[own]:
                wrong.append(f"{name} imports {target}")
    return sorted(wrong)


def circles(found: Imports) -> list[str]:
    """The modules on a circle or between two: what is left when loose ends are taken away, again and again."""
    left = {name: set(targets) for name, targets in found.items()}
    while True:
        imported = set().union(*left.values()) if left else set()
        free = [name for name, targets in left.items() if not targets & left.keys() or name not in imported]
        if not free:
            return sorted(left)
        for name in free:
            del left[name]


def test_every_package_has_its_floor() -> None:
    assert {name.partition(".")[0] for name in modules(PACKAGE)} - {""} == set(FLOOR)


@pytest.mark.ci
def test_the_editor_imports_one_wing_alone() -> None:
    of_editor = {name: found for name, found in imports_of_package().items() if name.startswith("editor")}
    assert of_editor
    of_wings = {target for found in of_editor.values() for target in found if target.startswith(("rewrite", "view"))}
    assert of_wings == {"view.program_page"}


#: The table of formats names the one that a wing makes, and loads it late.
LATE_BY_NAME = ["reports imports view.html"]


def test_imports_go_downwards_only() -> None:
    assert upward(imports_of_package()) == LATE_BY_NAME


def test_the_top_shows_the_rooms_alone() -> None:
    rooms = {*FLOOR, "__init__"} - {"__main__"}
    shown = {path.name for path in PACKAGE.iterdir()} - {"__pycache__"}
    assert shown == {*(rooms - {"__init__"}), "__init__.py", "__main__.py", "py.typed"}


def test_each_room_says_what_it_is_for() -> None:
    modules_of_rooms = [nodes_of(path)[0] for path in PACKAGE.rglob("__init__.py")]
    assert all(ast.get_docstring(module) for module in modules_of_rooms if isinstance(module, ast.Module))


def test_imports_have_no_circles() -> None:
    late = dict(line.split(" imports ") for line in LATE_BY_NAME)
    assert not circles({name: found - {late.get(name)} for name, found in imports_of_package().items()})


@pytest.fixture
def house(tmp_path: Path) -> Path:
    """Two rooms and a module each, to plant faults in."""
    for name in ("columns/__init__", "columns/trace", "checking/__init__", "checking/engine"):
        path = tmp_path / f"{name}.py"
        path.parent.mkdir(exist_ok=True)
        path.write_text("", "utf-8")
    (tmp_path / "checking" / "engine.py").write_text("from polarcheck.columns.trace import Trace\n", "utf-8")
    assert not upward(imports(tmp_path))
    assert not circles(imports(tmp_path))
    return tmp_path


@looped(
    "planted",
    [
        "from polarcheck.checking.engine import Engine",
        "from polarcheck.checking import engine",
        "import polarcheck.checking.engine",
        "from ..checking import engine",
        "def late():\n    from polarcheck.checking import engine",
        "from typing import TYPE_CHECKING\nif TYPE_CHECKING:\n    from polarcheck.checking.engine import Engine",
        "import typing\nif typing.TYPE_CHECKING:\n    import polarcheck.checking.engine as engine",
        "import importlib\nengine = importlib.import_module('polarcheck.checking.engine')",
    ],
)
def test_a_planted_upward_import_is_seen(house: Path, planted: str) -> None:
    (house / "columns" / "trace.py").write_text(planted + "\n", "utf-8")
    assert upward(imports(house)) == ["columns.trace imports checking.engine"]
    assert circles(imports(house)) == ["checking.engine", "columns.trace"]


@looped("planted", ["from polarcheck.columns import trace", "from . import trace"])
def test_a_planted_circle_inside_a_package_is_seen(house: Path, planted: str) -> None:
    (house / "columns" / "trace.py").write_text(
        "if TYPE_CHECKING:\n    from polarcheck.columns.moves import Moves\n", "utf-8"
    )
    (house / "columns" / "moves.py").write_text(planted + "\n", "utf-8")
    assert circles(imports(house)) == ["columns.moves", "columns.trace"]
    assert not upward(imports(house))


ARRAY_TYPES = ("Mask", "Floats", "Points", "Rows", "States")


@pytest.mark.ci
def test_array_types_are_defined_once() -> None:
    assigned = {
        path.name
        for path in PACKAGE.rglob("*.py")
        for node in nodes_of(path)
        if isinstance(node, ast.Assign | ast.AnnAssign)
        for target in (node.targets if isinstance(node, ast.Assign) else [node.target])
        if isinstance(target, ast.Name) and target.id in ARRAY_TYPES
    }
    assert assigned == {"arrays.py"}


@pytest.mark.ci
def test_rules_neither_loop_nor_load_numpy() -> None:
    """The function of the rule; its details are made for a finding, and import what they need."""
    allowed = {"rules.rule", "rules.causes", "foundation.states", "geometry.tolerances"}
    for path in map(Path, rule_files()):
        name = ".".join(path.relative_to(PACKAGE).with_suffix("").parts)
        tree = ast.parse(path.read_text("utf-8"))
        (function,) = (node for node in tree.body if isinstance(node, ast.FunctionDef) and node.name == path.stem)
        run = [node for node in tree.body if node is function or isinstance(node, ast.Import | ast.ImportFrom)]
        nodes = [inner for node in run for inner in ast.walk(node)]
        targets = set(_targets(nodes, name.rpartition(".")[0], modules(PACKAGE))) - {""}
        assert not targets - allowed, name
        assert not any(isinstance(node, ast.For | ast.While) for node in ast.walk(function)), name


@pytest.mark.ci
@looped(
    "arguments", [["--help"], ["explain", "rapid-in-polar"], ["rules"], ["machines"], ["machines", "fanuc"], ["schema"]]
)
def test_what_reads_no_program_loads_no_numpy(arguments: list[str]) -> None:
    code = (
        "import sys, polarcheck.commands\n"
        f"sys.argv = ['polarcheck', *{arguments!r}]\n"
        "try:\n    polarcheck.commands.run()\nexcept SystemExit as end:\n    assert not end.code, end.code\n"
        "assert not {'numpy', 'shapely'} & set(sys.modules)\n"
    )
    subprocess.run([sys.executable, "-c", code], check=True, capture_output=True, cwd=PACKAGE.parent)


#: What only findings, other options, many faces or drawings need; each takes longer than the check of a small file.
LATE = (
    *("shapely", "numpy.ma", "rich", "plotly", "ezdxf", "multiprocessing", "_hashlib"),
    *("polarcheck.geometry.polygons", "polarcheck.geometry.material_left", "polarcheck.geometry.comparison"),
    *("polarcheck.geometry.overcuts.cuts", "polarcheck.geometry.overcuts.own_loop"),
    *("polarcheck.rules.message", "polarcheck.rules.hit", "polarcheck.rules.repair"),
    "polarcheck.columns.words.allow_comments",
    *(
        "polarcheck.files.baselines.baseline",
        "polarcheck.reports.made_parts.part_report",
        "polarcheck.files.batch.executors",
    ),
    *("polarcheck.program.execution.macro", "polarcheck.view", "polarcheck.rewrite.fixes", "polarcheck.editor"),
)
#: Modules of the package beside those of rules, of which each takes a third of a millisecond: 232 are what the path of
#: a program with one compensated contour goes through, and a few more may come. Tests run without the cache (2 more).
MODULES_OF_A_SMALL_CHECK = 238


@pytest.mark.ci
def test_a_clean_check_of_a_small_program_loads_little() -> None:
    code = (
        "import sys, polarcheck.commands\n"
        "sys.argv = ['polarcheck', 'check', 'sample_programs/hexagon.nc']\n"
        "try:\n    polarcheck.commands.run()\nexcept SystemExit as end:\n    assert not end.code, end.code\n"
        "print(*sys.modules, sep='\\n', file=sys.stderr)\n"
    )
    run = subprocess.run(
        [sys.executable, "-c", code], check=True, capture_output=True, text=True, cwd=PACKAGE.parent, encoding="utf-8"
    )
    loaded = run.stderr.split()
    assert "polarcheck.columns.contour.overcuts" in loaded
    ours = {name.removeprefix("polarcheck.") for name in LATE if name.startswith("polarcheck.")}
    assert ours <= set(modules(PACKAGE))
    assert not set(LATE) & set(loaded)
    rules = {*map(Path, rule_files())}
    of_rules = {f"polarcheck.{name}" for name, path in modules(PACKAGE).items() if path in rules}
    own = [name for name in loaded if name.startswith("polarcheck.") and name not in of_rules]
    assert len(own) <= MODULES_OF_A_SMALL_CHECK


@pytest.mark.ci
def test_no_control_is_named_in_code() -> None:
    """A difference between controls is data; only comments and docstrings name a control, as their source."""
    controls = ("fanuc", "haas", "gsk", "mitsubishi", "okuma", "mazak", "siemens", "citizen", "doosan", "lsis", "hurco")
    controls += ("fagor", "takisawa", "colchester")
    for path in PACKAGE.rglob("*.py"):
        documents = {
            id(node.body[0].value)
            for node in nodes_of(path)
            if isinstance(node, ast.Module | ast.FunctionDef | ast.ClassDef)
            and node.body
            and isinstance(node.body[0], ast.Expr)
        }
        for node in nodes_of(path):
            if isinstance(node, ast.Constant) and isinstance(node.value, str) and id(node) not in documents:
                named = [name for name in controls if name in node.value.lower()]
                is_default = path.name == "profiles.py" and node.value == "fanuc"
                assert not named or is_default, (path.name, node.value)


def test_the_modules_of_the_document_exist() -> None:
    text = (PACKAGE.parent / "docs" / "architecture.md").read_text("utf-8")
    paths = {path.relative_to(PACKAGE).as_posix() for path in PACKAGE.rglob("*.py")}

    def missing(text: str, room: str) -> list[str]:
        """The modules that text names and that are neither in the room nor at the path that it gives."""
        named = re.findall(r"`(?:polarcheck/)?((?:\w+/)*\w+\.py)`", text.replace("`tests/", "`#"))
        return [
            name
            for name in named
            if name not in paths and not any(f"/{path}".endswith(f"/{name}") and room in path for path in paths)
        ]

    assert missing(text, "") == []
    rooms = re.findall(r"^\| `((?:\w+/)+)` \|(.*)$", text, re.MULTILINE)
    assert len(rooms) > len(ORDER) - 3
    assert [(room, missing(row, room)) for room, row in rooms if missing(row, room)] == []
