"""What the documents name is there."""

from __future__ import annotations

import re

import pytest
from programs import ROOT

TESTS = "\n".join(path.read_text("utf-8") for path in sorted((ROOT / "tests").glob("test_*.py")))
RELIABILITY = (ROOT / "docs" / "reliability.md").read_text("utf-8")


def test_every_fault_has_a_test() -> None:
    """Each row of the tables names at least one, and each that is named is one."""
    rows = [line for line in RELIABILITY.splitlines() if line.startswith("| ") and not line.startswith("| fault ")]
    assert len(rows) >= 50
    for row in rows:
        named = re.findall(r"`(test_\w+)`", row)
        assert named, row
        for name in named:
            assert re.search(rf"^def {name}\(", TESTS, re.MULTILINE), name


@pytest.mark.parametrize(
    "name", ["README.md", "SECURITY.md", "CONTRIBUTING.md", "docs/reliability.md", "docs/architecture.md"]
)
def test_links_and_scripts_of_a_document_are_there(name: str) -> None:
    text = (ROOT / name).read_text("utf-8")
    folder = (ROOT / name).parent
    for target in re.findall(r"\]\(((?!https?:)[^)#\s]+)", text):
        assert (folder / target).exists(), target
    for script in re.findall(r"\b((?:benchmarks|tests)/\w+\.py)", text):
        assert (ROOT / script).exists(), script
