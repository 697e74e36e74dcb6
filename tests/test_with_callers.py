"""`--with-callers`: the programs that changed files concern, as the hook asks for them before a commit."""

from __future__ import annotations

import json
import os
import shutil
from pathlib import Path

import pytest
from cases import looped
from test_cli import call
from test_diff_base import GOOD, ONLY, commit, git

from polarcheck.files import git as git_of_polarcheck

CALLER = "O0002\nG98 G0 X60. C0\nG12.1\nG1 X40. F200\nM98 P9001\nG13.1\nM30\n"
JOB = "machine = 'lathe.toml'\noffsets = 'TOOLOFST'\n[run]\nsubprograms = ['subs', 'more']\n"

pytestmark = pytest.mark.usefixtures("archive")


@pytest.fixture
def archive(own_folder: None) -> None:
    git("init", "-q", "-b", "main")
    for cell in ("one", "two"):
        for folder in ("subs", "more"):
            Path(cell, folder).mkdir(parents=True)
        Path(cell, "calls.nc").write_text(CALLER)
        Path(cell, "plain.nc").write_text(GOOD)
        Path(cell, "subs", "README").write_text("Called programs.")
        Path(cell, "subs", "O9001").write_text("O9001\nG1 C5.\nM99\n")
        Path(cell, "TOOLOFST").write_text("%\nG10 L10 P8 R4.\n%\n")
        Path(cell, "lathe.toml").write_text("inherits = 'fanuc-30i'\n")
        Path(cell, "polarcheck.toml").write_text(JOB)
    commit()


def checked(*paths: str, code: int = 0) -> list[str]:
    """The paths that are checked."""
    result = call("check", "--with-callers", *paths, *ONLY, "--format", "json", "-q")
    assert result.exit_code == code, result.output
    return [file["path"] for file in json.loads(result.stdout)["files"]]


ALL_OF_ONE = ["one/calls.nc", "one/plain.nc", "one/subs/O9001"]


@pytest.mark.ci
@looped(
    ("changed", "concerned"),
    [
        ("one/subs/O9001", ["one/calls.nc", "one/subs/O9001"]),
        ("one/plain.nc", ["one/plain.nc"]),
        *((f"one/{name}", ALL_OF_ONE) for name in ("TOOLOFST", "lathe.toml", "polarcheck.toml")),
        ("README.md", []),
    ],
    one_in=3,
)
def test_a_changed_file_concerns_the_programs_that_use_it(changed: str, concerned: list[str]) -> None:
    assert checked(changed) == concerned


def test_a_changed_subprogram_fails_its_callers() -> None:
    Path("one/subs/O9001").write_text("O9001\nG0 C5.\nM99\n")
    result = call("check", "--with-callers", "one/subs/O9001", *ONLY)
    assert result.exit_code == 1
    assert "one/calls.nc:5" in result.stdout
    assert result.stderr.startswith("polarcheck: --with-callers: 2 of 6 programs to check: changed, or calling")


@pytest.mark.ci
def test_a_subprogram_that_is_gone_concerns_its_callers() -> None:
    """No hook names it: it is missing beside what the last commit holds."""
    git("rm", "-q", "one/subs/O9001")
    assert checked() == ["one/calls.nc"]
    result = call("check", "--with-callers", "--select", "subprogram-missing")
    assert result.exit_code == 1
    assert "subprogram-missing, alarm" in result.stdout
    commit()
    assert checked() == []
    # Between two commits, as in CI.
    os.environ["PRE_COMMIT_FROM_REF"] = "HEAD~1"
    try:
        assert checked() == ["one/calls.nc"]
    finally:
        del os.environ["PRE_COMMIT_FROM_REF"]
    assert checked("one/subs/O9001") == ["one/calls.nc"]


@pytest.mark.ci
def test_a_renamed_subprogram_and_a_job_file_that_is_gone() -> None:
    git("mv", "one/subs/O9001", "one/subs/O9002")
    assert checked("one/subs/O9002") == ["one/calls.nc", "one/subs/O9002"]
    git("mv", "one/subs/O9002", "one/subs/O9001")
    git("rm", "-q", "one/polarcheck.toml")
    # Without the job, nothing says that the offset table is no program.
    assert checked() == ["one/TOOLOFST", *ALL_OF_ONE]


def test_a_new_subprogram_that_shadows_another() -> None:
    Path("one/more/9001.NC").write_text("G0 C5.\nM99\n")
    git("add", "-A")
    assert checked("one/more/9001.NC") == ["one/calls.nc", "one/more/9001.NC"]


@pytest.mark.nightly
def test_it_takes_the_files_that_a_walk_takes() -> None:
    """Endings of polarcheck.toml, names of programs, and what looks like one; without the excluded."""
    Path("one/polarcheck.toml").write_text(JOB)
    Path("polarcheck.toml").write_text("extensions = ['sub']\nexclude = ['old']\n")
    texts = {"P.SUB": GOOD, "O1234": GOOD, "plain": GOOD, "notes.txt": "Dear all", "NOTES": "Dear all", "a.xyz": GOOD}
    for name, text in texts.items():
        Path(name).write_text(text)
    Path("old").mkdir()
    Path("old", "b.sub").write_text("G0")
    assert checked(*texts, "old/b.sub") == ["O1234", "P.SUB", "plain"]
    git("add", "-A")
    walked = {file["path"] for file in json.loads(call("check", ".", "--format", "json").stdout)["files"]}
    assert {"O1234", "P.SUB", "plain"} == {path for path in walked if "/" not in path}


@pytest.mark.ci
def test_programs_that_the_commit_does_not_hold_are_no_matter_of_it() -> None:
    Path("one/draft.nc").write_text(CALLER)
    assert checked("one/subs/O9001") == ["one/calls.nc", "one/subs/O9001"]
    git("add", "one/draft.nc")
    assert checked("one/subs/O9001") == ["one/calls.nc", "one/draft.nc", "one/subs/O9001"]


@pytest.mark.ci
def test_before_the_first_commit_and_without_a_repository() -> None:
    shutil.rmtree(".git")
    assert checked("one/subs/O9001") == ["one/calls.nc", "one/subs/O9001"]
    assert checked() == []
    git("init", "-q", "-b", "main")
    git("add", "-A")
    assert checked("one/plain.nc", "one/gone.nc") == ["one/plain.nc"]
    nowhere = git_of_polarcheck.Reference("--with-callers:", "-x")
    assert git_of_polarcheck.staged(os.getcwd(), nowhere).paths == set()  # noqa: PTH109


@looped(
    ("arguments", "line"),
    [
        (("one",), "one: expected the names of changed files"),
        (("-",), "-: expected the names of changed files"),
        (("../a.nc",), "../a.nc: lies outside of the current folder, whose programs are checked"),
        (("a.nc", "--diff-base", "main"), "not with --diff-base, which chooses programs, too"),
        (("a.nc", "--watch"), "not with --watch, which chooses programs, too"),
    ],
)
def test_what_is_refused(arguments: tuple[str, ...], line: str) -> None:
    result = call("check", "--with-callers", *arguments)
    assert (result.exit_code, result.stderr) == (2, f"polarcheck: --with-callers: {line}\n")


def test_without_it_a_path_is_needed() -> None:
    result = call("check")
    assert result.exit_code == 2
    assert "Missing argument 'PATH...'" in result.stderr


def test_an_error_of_git_names_the_option(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PATH", "")
    result = call("check", "--with-callers", "one/plain.nc")
    assert (result.exit_code, result.stderr) == (
        2,
        "polarcheck: --with-callers: HEAD: git is not installed, or not on the PATH\n",
    )
