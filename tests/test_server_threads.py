"""The threads of the server: what each of them needs at first, all at the same moment."""

from __future__ import annotations

import subprocess
import sys

import pytest

pytestmark = pytest.mark.ci

AT_ONCE = """
import sys, threading
from pathlib import Path
from polarcheck.rules.rule import load_all
from polarcheck.commands.server import _Settings

settings = _Settings(False, {})
sys.setswitchinterval(1e-6)
failures = []

def run():
    try:
        FUNCTION
    except Exception as error:
        failures.append(repr(error))

threads = [threading.Thread(target=run) for _ in range(3)]
[thread.start() for thread in threads]
[thread.join() for thread in threads]
print(failures)
"""


@pytest.mark.parametrize("function", ["load_all()", "settings(Path('a.nc'))"])
def test_threads_may_need_the_same_for_the_first_time_at_once(function: str) -> None:
    command = [sys.executable, "-c", AT_ONCE.replace("FUNCTION", function)]
    result = subprocess.run(command, capture_output=True, text=True, timeout=120)
    assert (result.returncode, result.stdout) == (0, "[]\n"), result.stderr
