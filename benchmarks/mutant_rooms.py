"""The rooms of the package in which benchmarks/mutants.py plants faults, and the tests that are likely to see them."""

from __future__ import annotations

import functools
import re
from fnmatch import fnmatch
from pathlib import Path

from mutations import Mutation

ROOT = Path(__file__).resolve().parent.parent
#: The folders of rules; what rules are written in stands beside them.
GROUPS = ("compensation", "feed", "macro", "metal", "motion", "polar", "setup", "silence", "text")
#: What is looked at, by patterns of files; the first that matches counts.
ROOMS = {
    "rules": tuple(f"polarcheck/rules/{group}/*" for group in GROUPS),
    "compensation": (
        "polarcheck/geometry/cutter_compensation/*",
        "polarcheck/columns/path/compensation.py",
        "polarcheck/columns/path/lengths.py",
        *(
            f"polarcheck/columns/*/{name}.py"
            for name in (
                "fitting",
                "infeed",
                "mirrored",
                "moves",
                "overcuts",
                "ramps",
                "slots",
                "tool_center",
            )
        ),
        *(f"polarcheck/columns/*/{name}.py" for name in ("coverage", "tangency", "trial", "uncompensated_cuts")),
    ),
    "metal": (
        *(f"polarcheck/geometry/polygons/{name}.py" for name in ("cleared", "finished_part", "standing_metal")),
        *(f"polarcheck/columns/*/{name}.py" for name in ("bar", "finished", "milled", "stock_comments", "workpiece")),
        "polarcheck/parts/*",
        "polarcheck/reports/made_parts/*",
    ),
    "geometry": ("polarcheck/geometry/*",),
    "tables": ("polarcheck/columns/*",),
}
#: Files of tests that see all of these rooms, the quickest and sharpest first.
TESTS = (
    "limits",
    "samples",
    "rules",
    "table_ramps",
    "table_overcuts",
    "table_slots",
    "table_infeed",
    "table_coverage",
    "table_*",
    "polar",
    "inside",
    "mesh",
    "finished_part",
    "metal",
    "stock_comments",
    "part",
    "part_*",
    "cleared",
    "left_standing",
    "parts",
    "makes",
    "deviations",
    "faces",
    "contour",
    "compensation",
    "missing_rules",
    "repairs",
    "builders_guide",
    "polar_sections",
    "one_cause",
    "one_cut",
    "modes",
    "motion_and_feed",
    "contour_families",
    "trace",
    "compare",
    "positions",
    "controls",
    "machine_keys",
    "macro_faults",
    "engine",
    "messages",
    "machines",
    "properties",
    "corpus",
)
#: Packages in which a module is followed to the modules that import it.
UPWARD = ("geometry", "columns", "parts")


def modules() -> list[str]:
    """The modules of the package, from the checkout."""
    return sorted(path.relative_to(ROOT).as_posix() for path in (ROOT / "polarcheck").rglob("*.py"))


def room_of(file: str) -> str:
    """The room of a file; for one that is in none the folder."""
    for room, patterns in ROOMS.items():
        if any(fnmatch(file, pattern) for pattern in patterns):
            return room
    return file.split("/")[1]


def promising(file: str) -> list[str]:
    """
    Parts of the names of tests that are likely to see a fault in a module, the most likely first.

    Those that are named as the module, or as one that imports it and so on upward, the examples of the rules that
    compare one of these tables, and the tests that name a rule of the nearest.
    """
    names = list(importers(file))
    for stem in upward(file):
        names += [f"test_{stem}.py", f"test_table_{stem}"]
    for stem in upward(file):
        names += [f"findings[{rule}]" for rule in rules_of(stem)]
    nearest = next((rules for stem in upward(file) if (rules := rules_of(stem))), [])
    names += naming(*nearest)
    if room_of(file) == "metal":
        names += ["test_metal.py", "test_finished_part.py", "test_part", "test_deviations.py"]
    if room_of(file) == "rules":
        stem = Path(file).stem.removesuffix("_repair")
        rule = stem.replace("_", "-")
        names = [f"findings[{rule}]", "test_repairs.py", "test_limits.py", "test_severities", rule, stem]
    return names


@functools.cache
def importers(file: str) -> list[str]:
    """The tests that import a module themselves."""
    return [name for name, text in tests().items() if import_of(file).search(text)]


@functools.cache
def tests() -> dict[str, str]:
    """The files of tests by name, and their text."""
    return {path.name: path.read_text("utf-8") for path in sorted((ROOT / "tests").glob("test_*.py"))}


@functools.cache
def naming(*rules: str) -> list[str]:
    """The tests that name one of these rules, those that name the fewest of all rules first."""
    known = [Path(one).stem.replace("_", "-") for one in modules() if room_of(one) == "rules"]
    found = [name for name, text in tests().items() if any(f'"{rule}"' in text for rule in rules)]
    return sorted(found, key=lambda name: sum(f'"{rule}"' in tests()[name] for rule in known))


@functools.cache
def upward(file: str) -> list[str]:
    """The name of a module, and those of the modules of UPWARD that import it and so on, the nearest first."""
    text = {one: (ROOT / one).read_text("utf-8") for one in modules() if one.split("/")[1] in UPWARD}
    found = [file]
    for one in found:  # grows
        found += [other for other in text if other not in found and import_of(one).search(text[other])]
    return [Path(one).stem for one in found]


def import_of(file: str) -> re.Pattern[str]:
    """A pattern of the statements that import a module."""
    package, stem = ".".join(Path(file).parent.parts), Path(file).stem
    return re.compile(rf"from {re.escape(package)}(\.{stem} import| import .*\b{stem}\b)")


@functools.cache
def rules_of(table: str) -> list[str]:
    """The names of the rules that compare a table."""
    rules = [ROOT / one for one in modules() if room_of(one) == "rules" and not one.endswith("__init__.py")]
    return [path.stem.replace("_", "-") for path in rules if re.search(rf"\b{table}: ", path.read_text("utf-8"))]


def batches(one: Mutation) -> list[list[str]]:
    """Files of tests for a mutation: of those that are promising, and of all the rest."""
    paths = [path for name in TESTS for path in sorted((ROOT / "tests").glob(f"test_{name}.py"))]
    files = [path.relative_to(ROOT).as_posix() for path in dict.fromkeys(paths)]
    names = promising(one.file)
    near = [f"tests/{name}" for name in importers(one.file)]
    near += [f"tests/{path.name}" for path in sorted((ROOT / "tests").glob("test_*.py")) if path.name in names]
    near += [file for file in files if any(name in file for name in names)]
    if any("findings[" in name for name in names):
        near.append("tests/test_rules.py")
    if room_of(one.file) == "rules":
        near += [file for file in files if names[-2] in (ROOT / file).read_text("utf-8")]
    near = list(dict.fromkeys(near))
    return [near, [*files, *(file for file in near if file not in files)]]
