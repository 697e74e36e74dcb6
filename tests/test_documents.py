"""What the documents name is there."""

from __future__ import annotations

import re
import runpy
from itertools import groupby
from operator import attrgetter

import pytest
from cases import looped
from polarcheck.errors import RuleError
from programs import ROOT, tables_of

from polarcheck.reports.pages import executed
from polarcheck.rules.rule import load_all
from polarcheck.rules.tables import Tables

TESTS = "\n".join(path.read_text("utf-8") for path in sorted((ROOT / "tests").glob("test_*.py")))
RELIABILITY = (ROOT / "docs" / "reliability.md").read_text("utf-8")
STATEMENTS = [
    [cell.strip() for cell in line.strip("|").split(" | ")]
    for line in (ROOT / "docs" / "documents.md").read_text("utf-8").splitlines()
    if re.match(r"\| \d", line)
]
BEYOND = re.compile(r"beyond a static check: \S+")


@pytest.mark.nightly
def test_every_fault_has_a_test() -> None:
    """Each row of the tables of faults names at least one, and each that is named is one."""
    faults, *_ = RELIABILITY.partition("<!-- mutation scores: begin -->")
    rows = [line for line in faults.splitlines() if line.startswith("| ") and not line.startswith("| fault ")]
    assert len(rows) >= 50
    for row in rows:
        named = re.findall(r"`(test_\w+)`", row)
        assert named, row
        for name in named:
            assert re.search(rf"^def {name}\(", TESTS, re.MULTILINE), name


@looped(
    "name",
    ["README.md", "SECURITY.md", "CONTRIBUTING.md", "docs/reliability.md", "docs/architecture.md", "docs/documents.md"],
)
def test_links_and_scripts_of_a_document_are_there(name: str) -> None:
    text = (ROOT / name).read_text("utf-8")
    folder = (ROOT / name).parent
    for target in re.findall(r"\]\(((?!https?:)[^)#\s]+)", text):
        assert (folder / target).exists(), target
    for script in re.findall(r"\b((?:benchmarks|tests)/\w+\.py)", text):
        assert (ROOT / script).exists(), script


def test_statements_of_the_five_documents_are_numbered_in_order() -> None:
    assert {len(row) for row in STATEMENTS} == {3}
    numbers = [tuple(map(int, row[0].split("-"))) for row in STATEMENTS]
    assert len(numbers) >= 231
    assert [document for document, _ in groupby(numbers, key=lambda number: number[0])] == [0, 1, 2, 3, 4]
    for _, rows in groupby(numbers, key=lambda number: number[0]):
        own = [number for _, number in rows]
        assert own == list(range(1, len(own) + 1))


@pytest.mark.nightly
def test_each_statement_is_covered_by_what_there_is() -> None:
    """A rule, a test, a column, a key of a machine, a field of the trace; or a reason why no check can cover it."""
    tables = tables_of("G98 G0 X40. C0\nG12.1\nG1 X30. F100\nC5.\nG13.1\n")
    for number, _, covered in STATEMENTS:
        named = re.findall(r"`([^`]+)`", covered)
        assert (named and covered == ", ".join(f"`{name}`" for name in named)) != (BEYOND.match(covered) is not None), (
            number
        )
        for name in named:
            assert name.startswith("polarcheck ") or is_there(name, tables), f"{number}: {name}"


def is_there(name: str, tables: Tables) -> bool:
    if name.startswith("test_"):
        return re.search(rf"^def {name}\(", TESTS, re.MULTILINE) is not None
    if name.startswith("move."):
        return name.removeprefix("move.") in executed.Move.__struct_fields__
    if "." not in name:
        return name in load_all()
    try:
        attrgetter(name)(tables)
    except (AttributeError, RuleError):
        return False
    return True


@looped("name", ["rapid-in-polars", "test_printed", "move.x", "trace.ends", "tracer.end", "machine.polar.planes"])
def test_what_is_not_there_is_not_taken(name: str) -> None:
    assert not is_there(name, tables_of("G0 X1.\n"))


def test_statements_refer_to_earlier_ones_alone() -> None:
    for place, (number, text, _) in enumerate(STATEMENTS):
        for other in re.findall(r"\b\d{3}-\d+\b", text):
            assert other in [row[0] for row in STATEMENTS[:place]], f"{number}: {other}"


def test_one_block_is_shown_as_it_goes_through_the_program() -> None:
    """`python docs/make.py` writes the page anew."""
    made = runpy.run_path(str(ROOT / "docs" / "generators" / "one_block.py"))["page"]()
    assert made == (ROOT / "docs" / "one_block.md").read_text("utf-8")
