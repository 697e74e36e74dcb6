"""
`pytest --accept` takes the present reports and paths as the golden ones; names of tests say what they are given.

Property tests take the same examples in each run, unless new ones are asked for with `--hypothesis-profile random`.
"""

from __future__ import annotations

import functools
import itertools
import math
import os
import sys
from collections import Counter
from collections.abc import Callable, Generator, Mapping, Set
from enum import Enum
from pathlib import Path
from typing import Any

import pytest
from hypothesis import HealthCheck, settings

# Hypothesis' own profile for CI draws the same examples in every run: whether the tests pass does not depend on luck.
# `pytest --hypothesis-profile random` draws new examples, and keeps those that fail in .hypothesis/ for the next run.
settings.load_profile("ci")
settings.register_profile(
    "random",
    settings.get_profile("default"),
    deadline=None,
    print_blob=True,
    suppress_health_check=[HealthCheck.too_slow],
)

#: Characters of one value in the name of a test.
LONGEST = 50
#: Cases of one test, written and drawn ones, that count for the coverage: more of them add next to nothing, and take
#: twice the time measured.
MEASURED, DRAWN = 6, 20
#: Files whose tests count whole: each case is another statement of a control's own language.
MEASURED_WHOLE = ("test_high_level", "test_user_tasks", "test_statement", "test_flow")
IS_MEASURED = pytest.StashKey[bool]()


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption(
        "--accept", action="store_true", dest="update_snapshots", help="take the present outcomes as golden ones"
    )
    parser.addoption("--installs", action="store_true", help="run the tests that install packages, too")


def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    for item in items:
        if item.get_closest_marker("installs") and not config.getoption("--installs"):
            item.add_marker(pytest.mark.skip(reason="--installs runs what installs packages"))
    cases: Counter[str] = Counter()
    for item in items:
        test = item.nodeid.partition("[")[0]
        cases[test] += 1
        item.stash[IS_MEASURED] = cases[test] <= MEASURED or item.path.stem in MEASURED_WHOLE
        drawn = getattr(getattr(item, "obj", None), "hypothesis", None)
        if drawn is not None and cases[test] == 1:
            drawn.inner_test = measured_at_first(drawn.inner_test)


def measured_at_first(test: Callable[..., None]) -> Callable[..., None]:
    """The test of one drawn example, of which no more than so many count for the coverage."""
    examples = itertools.count()

    @functools.wraps(test)
    def run(*arguments: Any, **named: Any) -> None:
        if next(examples) >= DRAWN:
            sys.settrace(None)  # pytest_runtest_call sets it again, behind the last example
        test(*arguments, **named)

    return run


@pytest.hookimpl(wrapper=True)
def pytest_runtest_call(item: pytest.Item) -> Generator[None, Any, Any]:
    """The mark no_cover of pytest-cov has no effect in the processes of pytest-xdist."""
    tracer = sys.gettrace()
    if not item.stash[IS_MEASURED]:
        sys.settrace(None)
    try:
        return (yield)
    finally:
        sys.settrace(tracer)


@pytest.fixture
def own_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The test works in an empty folder, and nothing of the environment is meant for polarcheck."""
    monkeypatch.chdir(tmp_path)
    for name in list(os.environ):
        if name.startswith("POLARCHECK_") or name in ("NO_COLOR", "FORCE_COLOR"):
            monkeypatch.delenv(name)


def pytest_make_parametrize_id(val: Any) -> str:
    """Programs in one line, tables and numbers as their values: `X1. Z2. X3.-9`, not `X1. Z2. X3.-expected0`."""
    text = _spelled(val).replace("\n", " ").strip().encode("unicode_escape").decode("ascii") or "nothing"
    return text if len(text) <= LONGEST else f"{text[: LONGEST - 3]}..."


def _spelled(value: Any) -> str:
    if isinstance(value, Enum):
        return value.name
    if isinstance(value, Mapping):
        return " ".join(f"{_spelled(key)}={_spelled(one)}" for key, one in value.items())
    if isinstance(value, list | tuple | Set):
        parts = [_spelled(one) for one in value]
        return " ".join(sorted(parts) if isinstance(value, Set) else parts)
    if isinstance(value, bytes):
        return value.decode("latin-1")
    if isinstance(value, complex):
        return "unknown" if math.isnan(abs(value)) else f"{value:g}"
    return str(getattr(value, "__name__", value))
