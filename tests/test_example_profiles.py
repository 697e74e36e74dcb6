"""The profiles of hypothesis that conftest.py registers."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

pytestmark = pytest.mark.nightly

TEST = """
from hypothesis import given, strategies as st

@given(st.integers())
def test_drawn(number):
    with open("drawn.txt", "a") as file:
        file.write(f"{number}\\n")
"""


def drawn_examples(folder: Path, *options: str, environment: dict[str, str]) -> str:
    plugins = ("-p", "no:cacheprovider", "-p", "_hypothesis_pytestplugin")
    command = [sys.executable, "-m", "pytest", "-q", *plugins, "-c", "pytest.ini", *options, "."]
    environment |= {"PYTEST_DISABLE_PLUGIN_AUTOLOAD": "1"}
    subprocess.run(command, cwd=folder, env=environment, check=True, timeout=120, stdout=subprocess.PIPE)
    drawn = folder / "drawn.txt"
    examples = drawn.read_text()
    drawn.unlink()
    return examples


@pytest.mark.parametrize("ci", [False, True])
def test_each_run_draws_the_same_examples_unless_new_ones_are_asked_for(tmp_path: Path, ci: bool) -> None:
    """Hypothesis itself chooses by CI in the environment; the profiles of conftest.py mean the same there."""
    (tmp_path / "pytest.ini").write_text("[pytest]\n")
    (tmp_path / "conftest.py").write_bytes(Path(__file__).with_name("conftest.py").read_bytes())
    (tmp_path / "cases.py").write_bytes(Path(__file__).with_name("cases.py").read_bytes())
    (tmp_path / "test_drawn.py").write_text(TEST)
    environment = {name: value for name, value in os.environ.items() if name != "CI"} | ({"CI": "true"} if ci else {})
    first, second = (drawn_examples(tmp_path, environment=environment) for _ in range(2))
    assert len(first.splitlines()) > 20
    assert first == second
    assert drawn_examples(tmp_path, "--hypothesis-profile", "random", environment=environment) != first
