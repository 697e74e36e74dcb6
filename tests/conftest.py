"""
`pytest --accept` takes the present reports and paths as the golden ones; names of tests say what they are given.

Property tests take the same examples in each run, unless new ones are asked for with `--hypothesis-profile random`.
"""

from __future__ import annotations

import gc
import importlib
import os
import pkgutil
import re
from collections import Counter
from collections.abc import Generator
from pathlib import Path
from typing import Any

import pytest
from cases import name_of, run
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

#: Of a test of more cases than these, one in SHARE runs before the nightly run.
MANY_CASES, SHARE = 8, 12

#: What `pytest` alone collects at most: beyond it, tests take their cases in loops (cases.looped) or wait for .ci/run.
MOST_CASES = 3000


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption(
        "--accept", action="store_true", dest="update_snapshots", help="take the present outcomes as golden ones"
    )
    parser.addoption("--installs", action="store_true", help="run the tests that install packages, too")


#: How `pytest` runs alone, and how it does where files are named.
ALONE, OF_FILES = "not ci and not nightly", "not nightly"


def runs_all_files(config: pytest.Config) -> bool:
    return [Path(argument).name for argument in config.args] == config.getini("testpaths")


def pytest_configure(config: pytest.Config) -> None:
    if config.option.markexpr == ALONE and not runs_all_files(config):
        config.option.markexpr = OF_FILES
    run.is_nightly = "not nightly" not in config.option.markexpr
    run.stops_at_failure = config.option.maxfail == 1


def pytest_ignore_collect(collection_path: Path, config: pytest.Config) -> bool | None:
    """A module of which all tests are `ci` or `nightly` is not even loaded where these do not run."""
    if config.option.markexpr != ALONE or collection_path.suffix != ".py":
        return None
    return (
        bool(re.search(r"^pytestmark = \[?\s*pytest\.mark\.(ci|nightly)\b", collection_path.read_text("utf-8"), re.M))
        or None
    )


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """
    Before pytest deselects by markers: where all files run, all cases but a share are `nightly` of a test of many.

    `one_in(5)` says which share of a test runs before the nightly run; `one_in(1)` that all cases do.
    """
    everything = runs_all_files(config)
    count = Counter(item.nodeid.partition("[")[0] for item in items)
    cases: Counter[str] = Counter()
    for item in items:
        if item.get_closest_marker("installs") and not config.getoption("--installs"):
            item.add_marker(pytest.mark.skip(reason="--installs runs what installs packages"))
        test = item.nodeid.partition("[")[0]
        is_many = everything and count[test] > MANY_CASES
        one_in = item.get_closest_marker("one_in")
        if cases[test] % (one_in.args[0] if one_in else SHARE if is_many else 1):
            item.add_marker("nightly")
        cases[test] += 1
    quick = sum(not any(map(item.get_closest_marker, ("ci", "nightly"))) for item in items)
    if quick > MOST_CASES:
        raise pytest.UsageError(f"{quick} cases are neither ci nor nightly; at most {MOST_CASES} may be")


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
    return name_of(val)
