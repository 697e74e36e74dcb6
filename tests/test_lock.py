"""The lock file for those who audit: made by .ci/lock.py, with a hash for each package."""

from __future__ import annotations

import re
import runpy
import subprocess
import sys

import pytest
from programs import ROOT

LOCK = ROOT / ".ci" / "lock.txt"
LINES = [line for line in LOCK.read_text("utf-8").splitlines() if not line.startswith("#")]


def numbers(version: str) -> tuple[int, ...]:
    return tuple(map(int, re.findall(r"\d+", version)))


def test_each_line_is_one_version_with_its_hash_and_names_no_host() -> None:
    assert len(LINES) > 10
    assert all(re.fullmatch(r"[a-z0-9-]+==[0-9][0-9a-z.+]* --hash=sha256:[0-9a-f]{64}", line) for line in LINES)
    assert sorted(set(LINES)) == LINES
    assert "://" not in LOCK.read_text("utf-8")


def test_the_lock_holds_what_pyproject_wants() -> None:
    """Where this fails, `python3.11 .ci/lock.py` writes it anew."""
    locked = dict(line.split(" ")[0].split("==") for line in LINES)
    wanted = runpy.run_path(str(ROOT / ".ci" / "lock.py"))["requirements"]()
    assert {"numpy", "distributed", "pygls", "ezdxf", "plotly"} <= {one.split(">=")[0] for one in wanted}
    for requirement in wanted:
        name, least = requirement.split(">=")
        assert numbers(locked[name]) >= numbers(least), requirement


@pytest.mark.installs
@pytest.mark.skipif(sys.platform != "linux" or sys.version_info[:2] != (3, 11), reason="the hashes are of other files")
def test_pip_takes_the_lock_with_its_hashes() -> None:
    options = ("--dry-run", "--ignore-installed", "--quiet", "--require-hashes", "-r", str(LOCK))
    subprocess.run([sys.executable, "-m", "pip", "install", *options], check=True, timeout=300)
