"""The faults that benchmarks/mutants.py plants are one change each that a program can show; its list is up to date."""

from __future__ import annotations

import re
import subprocess
import sys
from collections import Counter
from pathlib import Path

import pytest
from cases import looped

BENCHMARKS = Path(__file__).parent.parent / "benchmarks"
sys.path.insert(0, str(BENCHMARKS))

import mutants  # noqa: E402
from mutations import Mutation, mutations  # noqa: E402

pytestmark = pytest.mark.ci


def planted(source: str) -> list[str]:
    """The source with each of its faults, in order; those of more than one line by their first."""
    text = source.encode()
    return [one.applied(text).decode() for one in mutations(text, "x.py")]


@looped(
    ("source", "expected"),
    [
        ("a < b", ["a <= b", "a >= b"]),
        ("a >= b", ["a < b", "a > b"]),
        ("a == b", ["a != b"]),
        ("((a) # <\n< (b))", ["((a) # <\n<= (b))", "((a) # <\n>= (b))"]),
        ("a is not b", ["a is b"]),
        ("a < 1e-9", ["a >= 1e-9"]),
        ("a < b + ROUNDING", ["a >= b + ROUNDING", "a < b - ROUNDING"]),
        ("_MOST = 7\na < _MOST", ["_MOST = 7\na <= _MOST", "_MOST = 7\na >= _MOST"]),
        ("a & ~b", ["a | ~b", "a & b"]),
        ("a and b", ["a or b"]),
        ("not a", ["a"]),
        ("-a + b * c", ["a + b * c", "-a - b * c", "-a + b / c"]),
        ("x = 0, 1, 2, 0.5, True, 4_000_000", ["0", "1", "2", "0.5", "True"]),
        ("a[i] = b", ["pass"]),
        ("a &= b", ["pass", "a |= b"]),
        ("a.append(b)", ["pass"]),
        ("np.minimum(a, b)", ["pass", "np.maximum(a, b)"]),
        ("x = a.any()", ["x = a.all()"]),
        ("x = b if a else c", ["x = b if (not (a)) else c"]),
        ("x = ERROR", ["x = ERROR.__class__.WARNING"]),
        ("x = Motion.CW", ["x = Motion.CCW"]),
        ("x = graded(error=a)", ["x = graded(warning=a)"]),
        ("x = graded(error=a, warning=b)", ["x = graded(error=a, note=b)"]),
        ("é, a < b", ["é, a <= b", "é, a >= b"]),
    ],
)
def test_each_fault_is_one_change(source: str, expected: list[str]) -> None:
    found = planted(source)
    if source.startswith("x = 0"):
        found = [one.old for one in mutations(source.encode(), "x.py")]
    assert found == expected


@looped(
    "source",
    [
        '"""Docstring of 1 < 2."""',
        "def f(a: Literal[0, 1]) -> tuple[int, 2]: ...",
        "from a import b",
        "if TYPE_CHECKING:\n    x = 1 < 2",
        "x = f'{a + 1}'",
        "raise_ = UsageError(a + 1)",
        "x = np.asarray(a, dtype=1 + 2, copy=False)",
        "x = round(a + b, 3)",
        "assert a < b",
        "@lru_cache(maxsize=1)\ndef f(): ...",
    ],
)
def test_what_no_program_could_show_is_left_alone(source: str) -> None:
    assert planted(source) == []


@pytest.mark.nightly
def test_faults_are_those_of_the_package_and_a_sample_is_the_same_for_a_seed() -> None:
    command = [sys.executable, BENCHMARKS / "mutants.py", "--list", "--count", "3", "--seed", "5", "--only", "rules"]
    first, second = (subprocess.run(command, capture_output=True, check=True, text=True).stdout for _ in range(2))
    assert first == second
    assert len(first.splitlines()) == 3
    assert all(line.startswith("polarcheck/rules/") for line in first.splitlines())


def test_a_name_that_is_no_room_and_no_file_is_refused() -> None:
    command = [sys.executable, BENCHMARKS / "mutants.py", "--list", "--only", "rulez"]
    found = subprocess.run(command, capture_output=True, text=True, check=False)
    assert found.returncode != 0
    rooms = "rules, compensation, metal, geometry, tables"
    assert found.stderr == f"rulez: neither a room ({rooms}) nor a file of the package\n"


def test_figures_take_the_place_of_the_row_of_their_room() -> None:
    others = "| rules | 9 | 1 | 8 | 0 | 1 | 88.9 % |"
    page = f"Above.\n\n{mutants.BEGIN}\n{others}\n| metal | 1 | 1 | 0 | 0 | 1 | 0.0 % |\n{mutants.END}\n\nBelow.\n"
    counts = {"metal": Counter(killed=37, timeout=1, equivalent=1, survived=2)}
    written = mutants.with_figures(page, counts, seed=7)
    assert (
        written
        == f"""Above.

{mutants.BEGIN}
| package | faults | seed | killed | equivalent | survived | score |
|---|---|---|---|---|---|---|
{others}
| metal | 41 | 7 | 38 | 1 | 2 | 95.0 % |
{mutants.END}

Below.
"""
    )
    assert mutants.with_figures(written, counts, seed=7) == written


def test_only_whole_rooms_have_a_row() -> None:
    command = [sys.executable, BENCHMARKS / "mutants.py", "--only", "geometry/rates.py", "--write", "page.md"]
    found = subprocess.run(command, capture_output=True, text=True, check=False)
    assert found.stderr == "--write: only for whole rooms (rules, compensation, metal, geometry, tables)\n"


@pytest.mark.nightly
def test_what_counts_as_equivalent_is_still_there() -> None:
    """And has a reason."""
    known = mutants.equivalent()
    assert all(known.values())
    files = {file for file, *_ in known}
    there: set[mutants.Key] = set()
    for file in files:
        found: list[Mutation] = mutations((mutants.ROOT / file).read_bytes(), file)
        there |= {mutants.key(one) for one in found}
    assert set(known) <= there


@pytest.mark.nightly
@pytest.mark.skipif(sys.platform == "win32", reason="runs are forks")
@pytest.mark.skipif(not (mutants.ROOT / ".git").exists(), reason="what is copied is what git lists")
def test_a_fault_is_killed_by_the_test_that_sees_it() -> None:
    place = "polarcheck/rules/compensation/cancel_on_arc.py"
    options = ["--only", place, "--count", "1", "--budget", "20", "--trust", "--verbose"]
    found = subprocess.run(
        [sys.executable, BENCHMARKS / "mutants.py", *options], capture_output=True, text=True, check=True
    )
    assert f"1/1 killed: {place}" in found.stdout
    assert re.search(r"tests/test_\w+\.py::", found.stdout)
