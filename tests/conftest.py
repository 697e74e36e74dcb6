"""
`pytest --accept` takes the present reports and paths as the golden ones; names of tests say what they are given.

Property tests take the same examples in each run, unless new ones are asked for with `--hypothesis-profile random`.
"""

from __future__ import annotations

import gc
import importlib
import math
import os
import pkgutil
from collections import Counter
from collections.abc import Generator, Mapping, Set
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

# slipcover counts modules that are searched for; rules are loaded without a search (rules/rule.py).
if "SLIPCOVER_ENABLED" in os.environ:
    import polarcheck.rules

    for module in pkgutil.walk_packages(polarcheck.rules.__path__, "polarcheck.rules."):
        importlib.import_module(module.name)

# The commands that tests start write their bytecode: hundreds of processes would each compile the package.
os.environ.pop("PYTHONDONTWRITEBYTECODE", None)

#: Tests replace functions, which no cache knows of; test_cache.py tries the cache.
NO_CACHE = ("POLARCHECK_NO_CACHE", "1")
os.environ.update([NO_CACHE])

#: Characters of one value in the name of a test.
LONGEST = 50

#: Of a test of more cases than these, one in SHARE runs by default.
MANY_CASES, SHARE = 8, 12


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption(
        "--accept", action="store_true", dest="update_snapshots", help="take the present outcomes as golden ones"
    )
    parser.addoption("--installs", action="store_true", help="run the tests that install packages, too")


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """
    Before pytest deselects by markers: where all files run, all cases but a share are slow of a test of many.

    `one_in(5)` says which share of a test runs by default, `one_in(1)` that all cases do; the others are left out.
    """
    everything = [Path(argument).name for argument in config.args] == config.getini("testpaths")
    count = Counter(item.nodeid.partition("[")[0] for item in items)
    cases: Counter[str] = Counter()
    for item in items:
        if item.get_closest_marker("installs") and not config.getoption("--installs"):
            item.add_marker(pytest.mark.skip(reason="--installs runs what installs packages"))
        test = item.nodeid.partition("[")[0]
        share = item.get_closest_marker("one_in")
        is_many = everything and count[test] > MANY_CASES
        if share and cases[test] % share.args[0]:
            item.add_marker("left_out")
        elif not share and is_many and cases[test] % SHARE:
            item.add_marker("slow")
        cases[test] += 1


@pytest.hookimpl(wrapper=True)
def pytest_collection() -> Generator[None, Any, Any]:
    """The tests themselves are no garbage: looking for some among them took a third of the time of the collection."""
    gc.disable()
    try:
        return (yield)
    finally:
        gc.enable()
        gc.freeze()


@pytest.hookimpl(tryfirst=True)
def pytest_cmdline_main(config: pytest.Config) -> None:
    """One process takes the golden outcomes: several would write the same file."""
    if config.option.update_snapshots:
        config.option.numprocesses = 0


@pytest.fixture
def own_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The test works in an empty folder, and nothing of the environment is meant for polarcheck."""
    monkeypatch.chdir(tmp_path)
    for name in list(os.environ):
        if name.startswith("POLARCHECK_") or name in ("NO_COLOR", "FORCE_COLOR"):
            monkeypatch.delenv(name)
    monkeypatch.setenv(*NO_CACHE)


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
