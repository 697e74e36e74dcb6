"""`--diff-base`: which programs a change concerns, in repositories of git that are real."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import time
from pathlib import Path

import pytest
from programs import machine_of
from test_cli import call, make

from polarcheck.commands.diff_base import narrowed
from polarcheck.files import git as git_of_polarcheck
from polarcheck.program.execution.dependence import calls_one_of
from polarcheck.program.reading import source

pytestmark = pytest.mark.ci

GOOD = "O0001\nG98 G0 X60. C0\nG12.1\nG1 X40. F200\nC5.\nG13.1\nM30\n"
ONLY = ("--select", "rapid-in-polar")

posix = pytest.mark.skipif(sys.platform == "win32", reason="Windows has no such names and links")


def git(*words: str, folder: str = ".") -> str:
    settings = ("user.name=a", "user.email=a@localhost", "commit.gpgsign=false", "init.defaultBranch=main", "gc.auto=0")
    given = [word for setting in settings for word in ("-c", setting)]
    nobody = {"GIT_CONFIG_GLOBAL": os.devnull, "GIT_CONFIG_NOSYSTEM": "1"}
    done = subprocess.run(
        ["git", "-C", folder, *given, *words], capture_output=True, text=True, check=True, env={**os.environ, **nobody}
    )
    return done.stdout


def commit(*paths: str) -> None:
    git("add", "-A", *paths)
    git("commit", "-q", "-m", "x", "--allow-empty")


@pytest.fixture(autouse=True)
def _repository(own_folder: None) -> None:
    git("init", "-q", "-b", "main")
    make(a__nc=GOOD, b__nc=GOOD, c__nc=GOOD)
    commit()


def checked(*arguments: str, ref: str = "HEAD", paths: tuple[str, ...] = (".",), code: int = 0) -> list[str]:
    """The paths that are checked, sorted."""
    result = call("check", *paths, *ONLY, "--diff-base", ref, "--format", "json", "-q", *arguments)
    assert result.exit_code == code, result.output
    return sorted(file["path"] for file in json.loads(result.stdout)["files"])


def refused(*paths: str, ref: str = "main") -> str:
    """The one line of a run that cannot tell."""
    result = call("check", *(paths or (".",)), "--diff-base", ref)
    assert (result.exit_code, result.stdout) == (2, "")
    (line,) = result.stderr.splitlines()
    return line.removeprefix("polarcheck: --diff-base ")


# ---- what has changed itself ----


def test_nothing_has_changed() -> None:
    result = call("check", ".", "--diff-base", "HEAD")
    assert (result.exit_code, result.stdout) == (0, "")
    assert result.stderr == (
        "polarcheck: --diff-base HEAD: nothing to check: none of 3 programs has changed, nor calls or is judged by "
        "what has\n"
    )
    assert json.loads(call("check", ".", "--diff-base", "HEAD", "--format", "json").stdout)["files"] == []


def test_committed_staged_unstaged_and_untracked_programs_have_changed() -> None:
    make(committed__nc=GOOD)
    commit()
    make(staged__nc=GOOD, a__nc=GOOD + "(X)\n")
    git("add", "staged.nc")
    make(untracked__nc=GOOD)
    assert checked(ref="HEAD~1") == ["a.nc", "committed.nc", "staged.nc", "untracked.nc"]
    assert checked() == ["a.nc", "staged.nc", "untracked.nc"]
    assert checked(paths=("b.nc", "a.nc")) == ["a.nc"]


def test_how_many_are_left_is_told() -> None:
    make(a__nc=GOOD + "(X)\n")
    result = call("check", ".", *ONLY, "--diff-base", "HEAD", "--tool", "8:radius=4")
    assert result.stderr == (
        "polarcheck: --diff-base HEAD: 1 of 3 programs to check: changed, or calling or judged by what has\n"
    )
    assert narrowed([], lambda path: [], None, None, 1, True) == []


def test_findings_of_what_has_not_changed_fail_nothing() -> None:
    make(a__nc=GOOD.replace("\nC5.", "\nG0 C5."))
    commit()
    make(b__nc=GOOD + "(X)\n")
    assert checked() == ["b.nc"]
    assert checked(ref="HEAD~1", code=1) == ["a.nc", "b.nc"]


def test_a_file_that_git_does_not_keep_may_have_changed() -> None:
    Path(".gitignore").write_text("out/\n")
    commit()
    Path("out").mkdir()
    Path("out", "d.nc").write_text(GOOD)
    assert checked() == ["out/d.nc"]


def test_a_renamed_program_has_changed() -> None:
    git("mv", "a.nc", "new.nc")
    assert checked() == ["new.nc"]


def test_a_branch_is_compared_with_where_it_has_left_the_other() -> None:
    git("checkout", "-q", "-b", "work")
    make(a__nc=GOOD + "(X)\n")
    commit()
    git("checkout", "-q", "main")
    make(b__nc=GOOD + "(Y)\n")
    commit()
    git("checkout", "-q", "work")
    assert checked(ref="main") == ["a.nc"]


@posix
def test_names_of_all_kinds() -> None:
    names = ["b\u00f6hmisch \u89d2.nc", 'quo"te.nc', "tab\t\n.nc", "-x.nc", os.fsdecode(b"\xff.nc")]
    for name in names:
        Path(name).write_text(GOOD)
    commit()
    assert checked() == []
    for name in names:
        Path(name).write_text(GOOD + "(X)\n")
    assert len(checked()) == len(names)


def test_in_a_subfolder_and_from_outside(monkeypatch: pytest.MonkeyPatch) -> None:
    Path("sub").mkdir()
    Path("sub", "d.nc").write_text(GOOD)
    commit()
    Path("sub", "d.nc").write_text(GOOD + "(X)\n")
    make(a__nc=GOOD + "(X)\n")
    root = Path.cwd()
    monkeypatch.chdir("sub")
    assert checked() == ["d.nc"]
    assert checked(paths=("..",)) == ["../a.nc", "../sub/d.nc"]
    monkeypatch.chdir("/")
    assert checked(paths=(str(root),)) == [(root / "a.nc").as_posix(), (root / "sub/d.nc").as_posix()]


def test_each_repository_is_asked_for_its_own() -> None:
    for name in ("one", "two"):
        Path(name).mkdir()
        git("init", "-q", "-b", "main", folder=name)
        Path(name, "d.nc").write_text(GOOD)
        Path(name, "e.nc").write_text(GOOD)
        git("add", "-A", folder=name)
        git("commit", "-q", "-m", "x", folder=name)
    Path("one", "d.nc").write_text(GOOD + "(X)\n")
    assert checked() == ["one/d.nc"]


@posix
def test_a_link_has_changed_where_that_has_to_which_it_leads() -> None:
    Path("far").mkdir()
    Path("far", "target.txt").write_text(GOOD)
    Path("link.nc").symlink_to("far/target.txt")
    commit()
    assert checked(paths=("link.nc",)) == []
    Path("far", "target.txt").write_text(GOOD + "(X)\n")
    assert checked(paths=("link.nc",)) == ["link.nc"]


def test_standard_input_is_always_checked() -> None:
    result = call("check", "-", *ONLY, "--diff-base", "HEAD", "--format", "json", given=GOOD)
    assert [file["path"] for file in json.loads(result.stdout)["files"]] == ["-"]


def test_a_hook_of_git_says_nothing_of_the_repository(monkeypatch: pytest.MonkeyPatch) -> None:
    make(a__nc=GOOD + "(X)\n")
    monkeypatch.setenv("GIT_DIR", "/nowhere/.git")
    monkeypatch.setenv("GIT_INDEX_FILE", "/nowhere/index")
    assert checked() == ["a.nc"]


# ---- what calls it, or is judged by it ----


def with_subprograms() -> None:
    """m calls n, which calls O9001; by_name calls FACE; computed calls what a variable says; b calls nothing."""
    Path("subs").mkdir()
    texts = {
        "m.nc": "O0010\nM98 P9000\nM30\n",
        "by_name.nc": "O0011\nM98 <FACE>\nM30\n",
        "computed.nc": "O0012\n#1=#5\nG65 P#1\nM30\n",
        "last.nc": "O0013\nG65 P9002 A1.\nM30\n",
        "subs/O9000.nc": "O9000\nM98 P9001\nM99\n",
        "subs/9001.NC": "O9001\nG4 P1\nM99\n",
        "subs/O9002": "O9002\nG4 P1\nM99\n",
        "subs/FACE.nc": "O<FACE>\nG4 P1\nM99\n",
        "subs/O9005.nc": "O9005\nM99\n",
        "polarcheck.toml": '[run]\nsubprograms = ["subs"]\n',
    }
    for path, text in texts.items():
        Path(path).write_text(text)
    commit()
    assert checked() == []


@pytest.mark.one_in(3)
@pytest.mark.parametrize(
    ("path", "callers"),
    [
        ("subs/O9000.nc", ["computed.nc", "m.nc", "subs/O9000.nc"]),
        ("subs/9001.NC", ["computed.nc", "m.nc", "subs/9001.NC", "subs/O9000.nc"]),
        ("subs/O9002", ["computed.nc", "last.nc", "subs/O9002"]),
        ("subs/FACE.nc", ["by_name.nc", "computed.nc", "subs/FACE.nc"]),
        ("subs/O9005.nc", ["computed.nc", "subs/O9005.nc"]),
    ],
)
def test_a_program_is_checked_where_one_that_it_calls_has_changed(path: str, callers: list[str]) -> None:
    with_subprograms()
    Path(path).write_text(Path(path).read_text() + "(X)\n")
    assert checked() == callers


def test_so_it_is_where_one_is_gone_or_renamed() -> None:
    with_subprograms()
    git("mv", "subs/9001.NC", "subs/old9001.nc")
    assert checked() == ["computed.nc", "m.nc", "subs/O9000.nc", "subs/old9001.nc"]
    commit()
    Path("subs", "FACE.nc").unlink()
    assert checked() == ["by_name.nc", "computed.nc"]


@posix
def test_so_it_is_where_a_link_leads_to_another_version() -> None:
    with_subprograms()
    Path("subs", "v").mkdir()
    Path("subs", "v", "face_2.txt").write_text("O<FACE>\nM99\n")
    Path("subs", "FACE.nc").unlink()
    Path("subs", "FACE.nc").symlink_to("v/face_2.txt")
    commit()
    Path("subs", "v", "face_2.txt").write_text("O<FACE>\nG4 P1\nM99\n")
    assert "by_name.nc" in checked()
    assert "m.nc" not in checked()


def test_a_program_that_cannot_be_read_is_left_to_its_check() -> None:
    with_subprograms()
    Path("subs", "FACE.nc").write_text("O<FACE>\nM99\n")
    result = call("check", "m.nc", "--diff-base", "HEAD", "--max-size", "5")
    assert result.exit_code == 2
    assert "polarcheck: m.nc: " in result.stderr


def test_channels_and_texts_without_calls() -> None:
    machine = machine_of("fanuc-30i")
    text = source.read_source(b"O0001\nM98 P9000\nM30\n", "a.nc")
    assert calls_one_of(text, machine, ["."], ["O9000.nc"])
    assert not calls_one_of(text, machine, ["."], [])
    assert not calls_one_of(source.read_source(GOOD.encode(), "a.nc"), machine, ["."], ["O9000.nc"])


@pytest.mark.parametrize("path", ["polarcheck.toml", "lathe.toml", "base.toml", "table.tbl"])
def test_what_a_program_is_judged_by_concerns_all_that_it_applies_to(path: str) -> None:
    Path("cell").mkdir()
    texts = {
        "cell/d.nc": GOOD,
        "cell/e.nc": GOOD,
        "cell/polarcheck.toml": 'machine = "lathe.toml"\noffsets = "table.tbl"\n',
        "cell/lathe.toml": 'inherits = "base.toml"\n',
        "cell/base.toml": 'inherits = "fanuc-30i"\n',
        "cell/table.tbl": "%\nG10 P1 R4.\n%\n",
    }
    for name, text in texts.items():
        Path(name).write_text(text)
    commit()
    assert checked() == []
    changed = Path("cell", path)
    changed.write_text(changed.read_text().replace("\n", "\n\n", 1))
    assert checked() == ["cell/d.nc", "cell/e.nc"]
    assert checked(paths=("cell/d.nc", "a.nc")) == ["cell/d.nc"]


def test_a_job_file_that_is_gone_concerns_all_below_it() -> None:
    Path("cell/deep").mkdir(parents=True)
    Path("cell/deep/d.nc").write_text(GOOD)
    Path("cell/polarcheck.toml").write_text('machine = "fanuc-30i"\n')
    commit()
    Path("cell/polarcheck.toml").unlink()
    assert checked() == ["cell/deep/d.nc"]


# ---- what git cannot tell ----


def test_without_a_repository(tmp_path_factory: pytest.TempPathFactory) -> None:
    folder = tmp_path_factory.mktemp("outside")
    (folder / "d.nc").write_text(GOOD)
    assert refused(str(folder / "d.nc")) == f"main: {(folder / 'd.nc').as_posix()} lies in no git repository"


def test_without_git(monkeypatch: pytest.MonkeyPatch) -> None:
    Path("git").write_text("#!/bin/sh\nexit 0\n")
    Path("git").chmod(0o755)
    for path in ("", "/nowhere", f".{os.pathsep}/nowhere"):
        monkeypatch.setenv("PATH", path)
        assert refused() == "main: git is not installed, or not on the PATH"


@posix
def test_a_git_that_cannot_be_run(monkeypatch: pytest.MonkeyPatch) -> None:
    Path("bin").mkdir()
    Path("bin", "git").write_bytes(b"\x7fELF")
    Path("bin", "git").chmod(0o755)
    monkeypatch.setenv("PATH", str(Path("bin").absolute()))
    assert refused().startswith("main: git: ")
    Path("bin", "git").write_text("#!/bin/sh\necho 'fatal: \x1b[31mno' >&2; exit 128\n")
    assert "\x1b" not in refused()


def test_an_unknown_commit_is_named_with_the_nearest_branch() -> None:
    git("branch", "release-2")
    assert refused(ref="mian") == f"mian: git knows no such commit in {Path.cwd().as_posix()}; did you mean main?"
    assert refused(ref="release-3").endswith("; did you mean release-2?")
    for ref in ("-n", "--output=x", "", " "):
        assert refused(ref=ref) == f"{ref!r}: expected a commit, a branch or a tag, such as main"
    assert not Path("x").exists()


def test_a_shallow_clone_without_the_commit() -> None:
    make(a__nc=GOOD + "(X)\n")
    commit()
    git("clone", "-q", "--depth", "1", Path.cwd().as_uri(), "clone")
    assert refused("clone", ref="HEAD~1").startswith("HEAD~1: the clone is shallow and has no such commit: fetch it")
    Path("clone", "b.nc").write_text(GOOD + "(Y)\n")
    assert checked(paths=("clone",)) == ["clone/b.nc"]


def test_without_a_common_commit_all_differences_count() -> None:
    git("checkout", "-q", "--orphan", "other")
    make(b__nc=GOOD + "(Y)\n")
    commit()
    assert checked(ref="main") == ["b.nc"]


# ---- repositories of strangers ----


@pytest.fixture
def plant() -> str:
    """The path of a program that leaves the file `ran` in the top folder when anything runs it."""
    planted = Path(".git", "planted")
    planted.write_text(f"#!/bin/sh\ntouch '{Path.cwd()}/ran'\nexit 1\n")
    planted.chmod(0o755)
    return str(planted.absolute())


def has_run() -> bool:
    """Whether the planted program has run since the last call."""
    ran = Path("ran").exists()
    Path("ran").unlink(missing_ok=True)
    return ran


def try_git(*words: str) -> None:
    """A plain git, which may fail: shows that a plant works."""
    subprocess.run(["git", *words], stdin=subprocess.DEVNULL, capture_output=True, check=False, timeout=60)


def touch(*paths: str, seconds: int) -> None:
    """Give files another time and the same content, so that git has to compare the content."""
    for path in paths:
        os.utime(path, (seconds, seconds))


@pytest.mark.one_in(5)
@posix
@pytest.mark.parametrize("driver", ["nc", "NC.2", "f\u00fcr-nc", "'$x'"])
@pytest.mark.parametrize("kind", ["clean", "process"])
@pytest.mark.parametrize("required", ["true", "false"])
def test_no_filter_is_run(plant: str, driver: str, kind: str, required: str) -> None:
    git("config", f"filter.{driver}.{kind}", plant)
    git("config", f"filter.{driver}.required", required)
    Path(".git", "info", "attributes").write_text(f"*.nc filter={driver}\n", "utf-8")
    touch("a.nc", seconds=1)
    Path("b.nc").write_text(GOOD.replace("C5.", "C6."))  # of the same size
    try_git("diff", "HEAD")
    assert has_run()
    touch("a.nc", seconds=2)
    assert checked() == ["b.nc"]
    assert not has_run()


@posix
@pytest.mark.parametrize("key", ["core.fsmonitor", "diff.external", "diff.nc.textconv", "diff.nc.command"])
def test_no_monitor_and_no_diff_program_is_run(plant: str, key: str) -> None:
    git("config", key, plant)
    Path(".git", "info", "attributes").write_text("*.nc diff=nc\n")
    make(a__nc=GOOD + "(X)\n")
    try_git("diff", "HEAD")
    assert has_run()
    assert checked() == ["a.nc"]
    assert not has_run()


@posix
def test_no_pager_editor_prompt_or_verifier_is_run(plant: str) -> None:
    for key in (
        "core.pager",
        "core.editor",
        "core.askPass",
        "gpg.program",
        "core.alternateRefsCommand",
        "pager.status",
    ):
        git("config", key, plant)
    make(a__nc=GOOD + "(X)\n")
    assert checked() == ["a.nc"]
    assert refused(ref="mian").startswith("mian: git knows no such commit")
    assert not has_run()


@posix
def test_no_program_of_an_included_configuration_or_of_the_user_is_run(
    plant: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    Path(".git", "more").write_text(f'[filter "more"]\n\tclean = {plant}\n')
    Path(".git", "of_user").write_text(f'[filter "lfs"]\n\tprocess = {plant}\n\trequired\n')
    Path(".git", "info", "attributes").write_text("a.nc filter=more\nb.nc filter=lfs\n")
    git("config", f"includeIf.gitdir:{Path.cwd()}/.path", str(Path(".git", "more").absolute()))
    monkeypatch.setenv("GIT_CONFIG_GLOBAL", str(Path(".git", "of_user").absolute()))
    monkeypatch.setenv("GIT_EXTERNAL_DIFF", plant)
    for path in ("a.nc", "b.nc"):
        touch(path, seconds=1)
        try_git("status")
        assert has_run()
    touch("a.nc", "b.nc", seconds=2)
    assert checked() == []
    make(b__nc=GOOD + "(X)\n")
    assert checked() == ["b.nc"]
    assert not has_run()


def test_a_file_whose_content_a_filter_has_changed_counts_as_changed() -> None:
    """What git-lfs keeps is a pointer: without the filter a file that is compared anew differs from it."""
    git("config", "filter.short.clean", "sed 1q")
    Path(".gitattributes").write_text("a.nc filter=short\n")
    touch("a.nc", seconds=1)
    commit()
    assert checked() == []
    touch("a.nc", seconds=2)
    assert checked() == ["a.nc"]


def test_a_filter_that_cannot_be_emptied_is_refused() -> None:
    git("config", "filter.a=b.clean", "cat")
    said = f"HEAD: {Path.cwd().as_posix()}: rename filter.a=b in the configuration of git: = in a name"
    assert refused(ref="HEAD") == said


@posix
def test_nothing_is_written_and_no_hook_is_run(plant: str) -> None:
    Path(".git", "hooks").mkdir(exist_ok=True)
    for name in ("post-index-change", "reference-transaction", "post-checkout", "pre-auto-gc"):
        Path(".git", "hooks", name).symlink_to(plant)
    touch("a.nc", seconds=1)
    try_git("diff")
    assert has_run()
    touch("a.nc", seconds=2)
    before = Path(".git", "index").read_bytes()
    assert checked() == []
    assert Path(".git", "index").read_bytes() == before
    assert not has_run()


@posix
def test_no_filter_of_a_submodule_is_run(plant: str) -> None:
    Path("sub").mkdir()
    git("init", "-q", "-b", "main", folder="sub")
    Path("sub", "d.nc").write_text(GOOD)
    git("add", "-A", folder="sub")
    git("commit", "-q", "-m", "x", folder="sub")
    commit()
    git("config", "filter.of_sub.clean", plant, folder="sub")
    Path("sub", ".git", "info", "attributes").write_text("*.nc filter=of_sub\n")
    touch("sub/d.nc", seconds=1)
    try_git("status")
    assert has_run()
    touch("sub/d.nc", seconds=2)
    assert checked(paths=("a.nc", "b.nc")) == []
    assert checked() == []
    assert not has_run()


def with_submodule() -> None:
    """A submodule `subs`, in which all has changed since the commit that the repository names of it."""
    git("init", "-q", "-b", "main", "subs")
    for name in ("O9000.nc", "O9001.nc"):
        Path("subs", name).write_text(f"{name[:5]}\nM99\n")
    git("add", "-A", folder="subs")
    git("commit", "-q", "-m", "x", folder="subs")
    Path("m.nc").write_text("O0010\nM98 P9000\nM30\n")
    Path("polarcheck.toml").write_text('[run]\nsubprograms = ["subs"]\n')
    commit()
    assert checked() == []


@posix
@pytest.mark.parametrize("way", ["clean", "process", "monitor", "hook"])
def test_nothing_of_a_changed_submodule_is_run_or_written(plant: str, way: str) -> None:
    with_submodule()
    if way == "monitor":
        git("config", "core.fsmonitor", plant, folder="subs")
    elif way == "hook":
        for name in ("post-index-change", "reference-transaction"):
            Path("subs/.git/hooks").mkdir(exist_ok=True)
            Path("subs/.git/hooks", name).symlink_to(plant)
    else:
        git("config", f"filter.of_sub.{way}", plant, folder="subs")
        Path("subs/.git/info/attributes").write_text("* filter=of_sub\n")
    touch("subs/O9001.nc", seconds=1)
    try_git("-C", "subs", "status")
    assert has_run()
    touch("subs/O9001.nc", seconds=2)
    Path("subs/O9000.nc").write_text("O9000\nG4 X1.\nM99\n")
    before = Path("subs/.git/index").read_bytes()
    assert {"m.nc", "subs/O9000.nc"} <= {*checked()} <= {"m.nc", "subs/O9000.nc", "subs/O9001.nc"}
    assert Path("subs/.git/index").read_bytes() == before
    assert not has_run()


@pytest.mark.nightly
def test_a_submodule_of_which_git_says_nothing_counts_as_changed() -> None:
    """Its commit is not there, as in a clone that is shallow; its configuration is broken; it is no repository."""
    with_submodule()
    everything = ["a.nc", "b.nc", "c.nc", "m.nc", "subs/O9000.nc", "subs/O9001.nc"]
    git("update-index", "--cacheinfo", f"160000,{'1' * 40},subs")
    git("commit", "-q", "-m", "x")
    assert checked() == everything
    git("update-index", "--cacheinfo", f"160000,{git('rev-parse', 'HEAD', folder='subs').strip()},subs")
    git("commit", "-q", "-m", "x")
    assert checked() == []
    git("config", "filter.a=b.clean", "cat", folder="subs")
    assert checked() == everything
    git("config", "--unset", "filter.a=b.clean", folder="subs")
    assert checked() == []
    assert checked(paths=("subs",)) == []


def test_the_commit_is_that_of_the_repository_around_a_submodule() -> None:
    """A submodule has no commit of this name, or another one."""
    with_submodule()
    git("branch", "before")
    Path("subs/O9000.nc").write_text("O9000\nG4 X1.\nM99\n")
    git("commit", "-q", "-a", "-m", "y", folder="subs")
    commit()
    for paths in ((".",), ("m.nc", "subs")):
        assert checked(ref="before", paths=paths) == ["m.nc", "subs/O9000.nc"]
    assert checked(ref="before", paths=("subs",)) == ["subs/O9000.nc"]
    assert checked(ref="before", paths=("m.nc",)) == ["m.nc"]
    assert checked() == []


@posix
def test_a_pyproject_that_says_nothing_of_polarcheck_concerns_nobody() -> None:
    Path("pyproject.toml").write_text("[project]\nname = 'a'\n")
    commit()
    Path("pyproject.toml").write_text("[project]\nname = 'b'\n")
    assert checked() == []
    commit()
    assert checked(ref="HEAD~1") == []
    Path("pyproject.toml").write_text("[tool.polarcheck]\nunits = 'mm'\n")
    assert checked() == ["a.nc", "b.nc", "c.nc"]
    commit()
    Path("pyproject.toml").write_text("[project]\nname = 'b'\n")
    assert checked() == ["a.nc", "b.nc", "c.nc"]


def lose(name: str) -> None:
    """Take an object away from the repository, which says that a remote named origin promises it."""
    key = git("rev-parse", name).strip()
    path = Path(".git", "objects", key[:2], key[2:])
    path.chmod(0o666)
    path.unlink()
    git("config", "core.repositoryFormatVersion", "1")
    git("config", "extensions.partialClone", "origin")
    git("config", "remote.origin.promisor", "true")


#: How git comes to run a program when it fetches; {plant} is its path.
TRANSPORTS = {
    "ext": {"remote.origin.url": "ext::{plant}", "protocol.ext.allow": "always"},
    "rewritten": {"remote.origin.url": "x:y", "url.ext::{plant} .insteadOf": "x:", "protocol.allow": "always"},
    "ssh": {"remote.origin.url": "ssh://localhost/x", "core.sshCommand": "{plant}"},
    "proxy": {"remote.origin.url": "git://localhost/x", "core.gitProxy": "{plant}"},
    "a folder": {"remote.origin.url": ".", "remote.origin.uploadpack": "{plant}"},
}


@pytest.mark.one_in(3)
@posix
@pytest.mark.parametrize("transport", TRANSPORTS)
@pytest.mark.parametrize("lost", ["HEAD~1", "HEAD~1^{tree}", "HEAD~1:sub", "HEAD~1:sub/d.nc"])
def test_a_missing_object_is_never_fetched(plant: str, transport: str, lost: str) -> None:
    Path("sub").mkdir()
    Path("sub", "d.nc").write_text(GOOD)
    commit()
    Path("sub", "d.nc").write_text(GOOD + "(X)\n")
    commit()
    lose(lost)
    for key, value in TRANSPORTS[transport].items():
        git("config", key.replace("{plant}", plant), value.replace("{plant}", plant))
    try_git("diff", "HEAD~1")
    assert has_run()
    if lost == "HEAD~1:sub/d.nc":  # the content of a file is not needed to tell that it differs
        assert checked(ref="HEAD~1") == ["sub/d.nc"]
    else:
        lacks = "the clone is partial and lacks objects, which are not fetched here"
        assert refused(ref="HEAD~1").endswith(f": {lacks}: if you trust it, run git diff HEAD~1 first")
    assert not has_run()


def test_a_repository_without_an_object_that_nobody_promises_is_one_line() -> None:
    lose("HEAD^{tree}")
    for key in ("extensions.partialClone", "remote.origin.promisor"):
        git("config", "--unset", key)
    assert refused(ref="HEAD").startswith("HEAD: git diff-index: ")


def test_a_folder_of_git_that_is_none_does_not_hide_what_has_changed() -> None:
    """Git would take the repository above it, and its names would mean other files."""
    Path("sub", ".git").mkdir(parents=True)
    Path("sub", "d.nc").write_text(GOOD)
    here = Path.cwd().as_posix()
    said = f"HEAD: {here}/sub: its .git belongs to the work tree {here}"
    assert refused("sub", ref="HEAD") == said


def test_a_work_tree_elsewhere_does_not_hide_what_has_changed() -> None:
    Path("elsewhere").mkdir()
    git("config", "core.worktree", str(Path("elsewhere").absolute()))
    make(a__nc=GOOD + "(X)\n")
    assert refused(ref="HEAD").startswith("HEAD: ")


def test_files_in_which_git_looks_for_no_changes_may_have_changed() -> None:
    git("update-index", "--assume-unchanged", "a.nc")
    git("update-index", "--skip-worktree", "b.nc", "c.nc")
    make(a__nc=GOOD + "(X)\n", b__nc=GOOD + "(Y)\n")
    Path("c.nc").unlink()
    assert checked() == ["a.nc", "b.nc"]


def test_a_repository_of_somebody_else_is_refused_as_git_refuses_it(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("GIT_TEST_ASSUME_DIFFERENT_OWNER", "1")
    monkeypatch.setenv("GIT_CONFIG_GLOBAL", os.devnull)
    assert "dubious ownership" in refused(ref="HEAD")
    Path(".git", "of_user").write_text(f"[safe]\n\tdirectory = {Path.cwd().as_posix()}\n")
    monkeypatch.setenv("GIT_CONFIG_GLOBAL", str(Path(".git", "of_user").absolute()))
    assert checked() == []


@posix
def test_a_git_that_hangs_is_ended_with_what_it_has_started(monkeypatch: pytest.MonkeyPatch) -> None:
    Path("bin").mkdir()
    Path("bin", "git").write_text("#!/bin/sh\nsleep 600 &\necho $! $$ > pids\nwait\n")
    Path("bin", "git").chmod(0o755)
    monkeypatch.setenv("PATH", f"{Path('bin').absolute()}{os.pathsep}{os.environ['PATH']}")
    monkeypatch.setattr(git_of_polarcheck, "TIME_LIMIT", 0.5)
    assert refused() == "main: git rev-parse: no answer within 0.5 s"
    for number in Path("pids").read_text().split():
        assert is_gone(int(number))


@posix
def test_a_configuration_that_never_ends_is_given_up(monkeypatch: pytest.MonkeyPatch) -> None:
    os.mkfifo(".git/endless")
    git("config", "include.path", "endless")
    monkeypatch.setattr(git_of_polarcheck, "TIME_LIMIT", 0.5)
    assert refused() == "main: git rev-parse: no answer within 0.5 s"


def is_gone(number: int) -> bool:
    """Whether a process ends in a minute; what is left of it until somebody asks for its exit code is no process."""
    for _ in range(1200):
        try:
            status = Path(f"/proc/{number}/stat").read_text() if sys.platform == "linux" else ""
            os.kill(number, 0)
        except OSError:
            return True
        if status.rpartition(")")[2].split()[:1] == ["Z"]:
            return True
        time.sleep(0.05)
    return False
