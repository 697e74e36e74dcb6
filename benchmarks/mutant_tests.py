"""
What pytest does for a mutant (`pytest -p mutant_tests`), told by the environment.

MUTANT_NAMES: parts of names of tests with line feeds between, the most promising first. MUTANT_BATCH: 0 for the tests
with one of them in their name, in that order; 1 for all others. In both, the tests that the default run leaves
out come last.
MUTANT_SECONDS: of processor time; no test begins after it.
"""

from __future__ import annotations

import os
import time

import pytest

_NAMES = os.environ.get("MUTANT_NAMES", "").split("\n")
_BATCH = int(os.environ.get("MUTANT_BATCH", "1"))
_SECONDS = float(os.environ.get("MUTANT_SECONDS", "inf"))


def pytest_configure() -> None:
    """No search for a smaller example: any that fails will do."""
    from hypothesis import Phase, settings

    settings.register_profile("mutants", phases=[Phase.explicit, Phase.generate], database=None, deadline=None)
    settings.load_profile("mutants")


def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """The tests of this batch, the most promising first, those that the default run leaves out behind all others."""
    place = [next((at for at, name in enumerate(_NAMES) if name in item.nodeid), len(_NAMES)) for item in items]
    chosen = [number for number, at in enumerate(place) if (at == len(_NAMES)) == bool(_BATCH)]
    config.hook.pytest_deselected(items=[item for number, item in enumerate(items) if number not in set(chosen)])
    is_late = [any(map(item.get_closest_marker, ("ci", "nightly"))) for item in items]
    items[:] = [items[number] for number in sorted(chosen, key=lambda number: (is_late[number], place[number]))]


@pytest.hookimpl(tryfirst=True)
def pytest_runtest_protocol(item: pytest.Item) -> bool | None:
    """Nothing more once the time is spent."""
    return True if time.process_time() > _SECONDS else None
