"""
`--diff-base` and `--with-callers` beside two full checks of drawn archives.

What a program says differently after a change is always checked; a change that concerns no program has none checked.
"""

from __future__ import annotations

import json
import os
import stat
import sys
from pathlib import Path
from typing import Any

import pytest
from cases import looped
from drawn_repositories import CHANGES, UNRELATED, Archive
from test_cli import call
from test_diff_base import git

pytestmark = [
    pytest.mark.nightly,
    pytest.mark.usefixtures("own_folder"),
    pytest.mark.skipif(sys.platform == "win32", reason="Windows has no such links"),
]


def reports(*words: str) -> dict[str, Any]:
    """The reports by path; none if the run cannot begin."""
    result = call("check", *words, "--format", "json", "-q", "--no-cache")
    return {file["path"]: file for file in json.loads(result.stdout)["files"]} if result.stdout else {}


def differing(before: dict[str, Any], after: dict[str, Any]) -> set[str]:
    return {path for path, report in after.items() if before.get(path) != report}


def named_by_a_hook() -> list[str]:
    """The names that pre-commit gives: changed files that are there, and no links, folders or submodules."""
    names = git("diff", "--cached", "--name-only", "-z", "--no-renames", "--diff-filter=ACMT").split("\0")
    return [name for name in names if name and stat.S_ISREG(os.lstat(name).st_mode)]


def held() -> set[str]:
    return set(git("ls-files", "-z", "--recurse-submodules").split("\0"))


def narrowed(seed: int, change: Any, *options: str) -> tuple[set[str], set[str], set[str], set[str]]:
    """What differs, what --diff-base checks, what differs of what git holds, what --with-callers checks."""
    archive = Archive(seed)
    before = reports(".", *options)
    assert len(before) > 10
    change(archive)
    after = reports(".", *options)
    differs = differing(before, after)
    since = {*reports(".", "--diff-base", "HEAD", *options)}
    git("add", "-A")
    in_hook = {*reports("--with-callers", *named_by_a_hook(), *options)}
    return differs, since, differs & held(), in_hook


def verify(seed: int, kind: str, *options: str) -> None:
    differs, since, differs_for_git, in_hook = narrowed(seed, CHANGES[kind], *options)
    assert differs, "this change shows in no report"
    assert differs <= since
    assert differs_for_git <= in_hook


@looped("kind", ["pyproject without its table", "submodule behind a link edited in place"])
def test_no_program_that_says_something_else_is_left_out(kind: str) -> None:
    verify(2, kind, "--select", "rapid-in-polar")


@pytest.mark.one_in(16)
@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("kind", CHANGES)
def test_of_many_drawn_archives_none_is_left_out(kind: str, seed: int) -> None:
    verify(seed, kind)


@pytest.mark.one_in(7)
@pytest.mark.parametrize("kind", UNRELATED)
def test_a_change_that_concerns_no_program_has_none_checked(kind: str) -> None:
    differs, since, _, in_hook = narrowed(1, UNRELATED[kind], "--select", "rapid-in-polar")
    assert (differs, since, in_hook) == (set(), set(), set())


@pytest.mark.nightly
@pytest.mark.parametrize("kind", ["link of a drawing", "machine edited", "offset table edited", "extended job edited"])
def test_cells_that_a_change_is_none_of_are_left_out(kind: str) -> None:
    _, since, _, in_hook = narrowed(2, CHANGES[kind])
    assert since == in_hook
    # A table that no job names looks like a program, and may have been the table of a job before.
    assert {Path(path).parts[0] for path in since - {"tables/t2"}} == {"one"}
    assert Path("two").is_dir()
