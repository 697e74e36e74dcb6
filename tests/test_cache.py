"""`.polarcheck_cache`: what is used again is what a fresh run finds, byte for byte, and nothing else is used again."""

from __future__ import annotations

import errno
import io
import json
import os
import shutil
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from click.testing import Result
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from test_cli import GOOD, RAPID, call

from polarcheck.files.batch import tasks
from polarcheck.files.cache import digests, outcomes, store
from polarcheck.files.cache.store import NAME, Store
from polarcheck.reports import formats

pytestmark = pytest.mark.usefixtures("archive")

CALLS = "O0002\nG98 G0 X60. C0\nG12.1\nG1 X40. F200\nM98 P9001\nG13.1\nM30\n"
COMPENSATED = "O0003\nT0808\nG98 G0 X60. C0\nG12.1\nG1 G41 X40. F200\nC-10.\nC10.\nX60.\nG40 X80.\nG13.1\nM30\n"
OPEN = "O0004\nT0909\nG98 G0 X60. C0\nG12.1\nG1 G42 X40. F200\nC-10.\nG40 X80.\nG13.1\nM30\n"
TABLE = "%\nG10 L10 P8 R4.\n%\n"
JOB = """machine = "lathe.toml"
offsets = "TOOLS.TXT"
[run]
subprograms = ["nearer", "subs"]
"""


@pytest.fixture
def archive(own_folder: None, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Programs that depend on a subprogram, a chain of machine files and an offset table, in a folder with a cache."""
    monkeypatch.delenv("POLARCHECK_NO_CACHE")
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "user"))
    monkeypatch.setenv("LOCALAPPDATA", str(tmp_path / "user"))
    Path("archive").mkdir()
    monkeypatch.chdir("archive")
    fill()


def fill() -> None:
    for folder in ("subs", "nearer", "cell"):
        Path(folder).mkdir(exist_ok=True)
    texts = {
        "a.nc": "O0001\n" + GOOD + "M30\n",
        "calls.nc": CALLS,
        "tool.nc": COMPENSATED,
        "cell/d.nc": OPEN,
        "subs/O9001": "O9001\nG1 C5.\nM99\n",
        "TOOLS.TXT": TABLE,
        "polarcheck.toml": JOB,
        "lathe.toml": 'inherits = "base.toml"\n',
        "base.toml": 'inherits = "fanuc-30i"\n[limits]\nc_feed = 36000\n',
    }
    for name, text in texts.items():
        Path(name).write_text(text)


@pytest.fixture
def checked(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """The paths of the programs that are really checked, from now on."""
    paths: list[str] = []
    fresh = tasks._check

    def noted(task: tasks.Task, data: bytes) -> object:
        paths.append(task.path)
        return fresh(task, data)

    monkeypatch.setattr(tasks, "_check", noted)
    return paths


def check(*arguments: str, **environment: str) -> Result:
    return call("check", *(arguments or (".",)), "--jobs", "1", **environment)


def shown(result: Result) -> tuple[int, str, str]:
    assert result.exit_code in (0, 1, 2), result.output
    return result.exit_code, result.stdout, result.stderr


@pytest.mark.nightly
@pytest.mark.one_in(11)
@pytest.mark.parametrize("form", formats())
def test_reports_from_the_cache_are_those_of_a_fresh_run(form: str, checked: list[str]) -> None:
    paths = ["tool.nc"] if form == "html" else ["."]
    fresh = shown(check(*paths, "--format", form, "--no-cache"))
    assert not Path(NAME).exists()
    assert shown(check(*paths, "--format", form)) == fresh
    checked.clear()
    assert shown(check(*paths, "--format", form)) == fresh
    # Pictures are larger than their programs: they are drawn anew.
    assert checked == (["tool.nc"] if form == "html" else [])


@pytest.mark.nightly
@pytest.mark.one_in(3)
@pytest.mark.parametrize("options", [("--part", "--show-silenced"), ("--baseline", "known.json"), ("--statistics",)])
def test_what_is_added_to_reports_or_taken_from_them(options: tuple[str, ...], checked: list[str]) -> None:
    Path("a.nc").write_text("O0001\n(POLARCHECK ALLOW-FILE RAPID-IN-POLAR known)\n" + RAPID + "M30\n")
    assert call("baseline", "create", "calls.nc", "-o", "known.json").exit_code == 0
    checked.clear()
    fresh = shown(check("a.nc", "tool.nc", "calls.nc", *options, "--no-cache"))
    for _ in range(2):
        assert shown(check("a.nc", "tool.nc", "calls.nc", *options)) == fresh
    assert sorted(checked) == sorted(2 * ["a.nc", "tool.nc", "calls.nc"])


@pytest.mark.ci
def test_a_fixed_program_is_another_one() -> None:
    Path("a.nc").write_text("O0001\n" + GOOD.replace("C-5.", "C\u20135.") + "M30\n")
    before = shown(check("a.nc"))
    check("a.nc", "--fix", "--unsafe-fixes")
    after = shown(check("a.nc"))
    assert before != after == shown(check("a.nc", "--no-cache"))


def write(name: str, text: str) -> Callable[[], None]:
    return lambda: _write(Path(name), text)


def _write(path: Path, text: str) -> None:
    """Write a file; its time and size say nothing of its content."""
    before = path.stat() if path.exists() else None
    path.parent.mkdir(exist_ok=True)
    path.write_text(text)
    if before is not None:
        os.utime(path, ns=(before.st_atime_ns, before.st_mtime_ns))


CHANGES: dict[str, Callable[[], None]] = {
    "a program, of the same size and time": write("a.nc", "O0001\n" + GOOD.replace("\nC5.", "\nG0C5") + "M30\n"),
    "a program that is new": write("new.nc", "O0005\n" + RAPID + "M30\n"),
    "a program that is gone": lambda: Path("a.nc").unlink(),
    "a subprogram": write("subs/O9001", "O9001\nG0 C5.\nM99\n"),
    "a subprogram that is gone": lambda: Path("subs/O9001").unlink(),
    "a subprogram in a nearer folder": write("nearer/9001.nc", "G0 C5.\nM99\n"),
    "a subprogram that comes before in its folder": write("subs/9001.NC", "G0 C5.\nM99\n"),
    "a machine file that another inherits": write("base.toml", 'inherits = "fanuc-30i"\n[limits]\nc_feed = 36\n'),
    "the machine file": write("lathe.toml", 'inherits = "base.toml"\n[limits]\nc_feed = 36\n'),
    "an offset table": write("TOOLS.TXT", "%\nG10 L10 P8 R44.\n%\n"),
    "the job file": write("polarcheck.toml", JOB.replace("lathe.toml", "haas-lathe")),
    "severities": write(
        "polarcheck.toml", JOB + "[severities]\npolar-never-left = 'off'\nno-finishing-allowance = 'error'\n"
    ),
    "a nearer job file": write("cell/polarcheck.toml", "machine = 'haas-lathe'\n"),
    "the job file is gone": lambda: Path("polarcheck.toml").unlink(),
    "an encoding": write("polarcheck.toml", "encoding = 'utf-16-le'\n" + JOB),
}


@pytest.mark.nightly
@pytest.mark.one_in(15)
@pytest.mark.parametrize("name", CHANGES)
def test_what_has_changed_is_checked_again(name: str) -> None:
    before = shown(check(".", "--format", "json"))
    CHANGES[name]()
    after = shown(check(".", "--format", "json"))
    assert after == shown(check(".", "--format", "json", "--no-cache"))
    assert after != before


@pytest.mark.nightly
@settings(max_examples=12, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(st.lists(st.sampled_from(list(CHANGES)), min_size=1, max_size=4))
def test_changes_in_any_order(names: list[str]) -> None:
    """Of one example to the next the cache stays, as in an archive that goes back to what it was."""
    for path in ("nearer", "subs", "cell"):
        shutil.rmtree(path)
    Path("new.nc").unlink(missing_ok=True)
    fill()
    for name in names:
        try:
            CHANGES[name]()
        except FileNotFoundError:
            continue
        assert shown(check(".", "--format", "json")) == shown(check(".", "--format", "json", "--no-cache"))


@pytest.mark.nightly
@pytest.mark.one_in(11)
@pytest.mark.parametrize(
    ("arguments", "environment"),
    [
        *((("--select", "rapid-in-polar"), {}), (("--fail-on", "never"), {}), (("--machine", "haas-lathe"), {})),
        *((("--set", "limits.c_feed=36"), {}), (("--tool", "8:radius=44"), {}), (("--max-size", "20"), {})),
        *((("--no-config",), {}), (("--block-skip", "off", "--strict"), {}), ((), {"POLARCHECK_IGNORE": "all-tools"})),
        *(((), {"POLARCHECK_MACHINE": "haas-lathe"}), (("--severity", "no-finishing-allowance=error"), {})),
    ],
)
def test_options_and_the_environment_count(arguments: tuple[str, ...], environment: dict[str, str]) -> None:
    check(".")
    fresh = shown(check(".", *arguments, "--format", "json", "--no-cache", **environment))
    assert shown(check(".", *arguments, "--format", "json", **environment)) == fresh
    assert shown(check(".", *arguments, "--format", "json", **environment)) == fresh


@pytest.mark.ci
def test_programs_are_known_by_their_path(checked: list[str], monkeypatch: pytest.MonkeyPatch) -> None:
    """Two files of one content are two programs, and a report names a file as the command line does."""
    shutil.copy("a.nc", "copy.nc")
    assert [file["path"] for file in json.loads(check("a.nc", "copy.nc", "--format", "json").stdout)["files"]] == [
        "a.nc",
        "copy.nc",
    ]
    checked.clear()
    monkeypatch.chdir("cell")
    (file,) = json.loads(check("../a.nc", "--format", "json").stdout)["files"]
    assert (file["path"], checked) == ("../a.nc", ["../a.nc"])
    assert not Path(NAME).exists()
    assert json.loads(check("../a.nc", "--format", "json").stdout)["files"] == [file]
    assert checked == ["../a.nc"]


@pytest.mark.ci
def test_where_it_lies(tmp_path: Path) -> None:
    check("--no-config", "a.nc")
    assert Path(NAME, ".gitignore").read_text() == "*\n"
    assert Path(NAME, "CACHEDIR.TAG").read_text().startswith("Signature: 8a477f597d28d172789f06886806bc55")
    Path("cell/polarcheck.toml").write_text("")
    check("cell")
    assert Path("cell", NAME).is_dir()
    check("a.nc", "--cache-dir", str(tmp_path / "elsewhere"))
    check("a.nc", POLARCHECK_CACHE_DIR=str(tmp_path / "environment"))
    assert (tmp_path / "elsewhere" / "cache-key").stat().st_size == 32
    assert (tmp_path / "environment").is_dir()


@pytest.mark.nightly
def test_what_is_never_kept(checked: list[str], monkeypatch: pytest.MonkeyPatch) -> None:
    """What has ended by its time, what could not be read, a bug, standard input."""
    for _ in range(2):
        check("a.nc", "--max-seconds", "0.0000001")
        call("check", "-", "--stdin-filename", "a.nc", given=GOOD)
        check("a.nc", "--max-size", "2")
    assert checked == ["a.nc", "-", "a.nc", "-"]
    monkeypatch.setattr("polarcheck.checking.check.check_runs", lambda *given: 1 / 0)
    assert check("tool.nc").exit_code == 3
    assert not entries()


def entries() -> list[Path]:
    return sorted(Path(NAME).rglob("*.cache"))


@pytest.mark.nightly
def test_a_broken_cache_is_ignored(checked: list[str]) -> None:
    fresh = shown(check())
    assert entries()
    for data in (b"", b"\0" * 10_000, b"\x81\xc4\x10" + b"A" * 16):
        for path in entries():
            path.write_bytes(data)
        checked.clear()
        assert shown(check()) == fresh
        assert len(checked) == 5
    for path in entries():
        path.unlink()
        path.mkdir()
    assert shown(check()) == fresh


@pytest.mark.nightly
def test_a_cache_of_somebody_else_makes_nothing_pass(checked: list[str], tmp_path: Path) -> None:
    """A cache can come with an archive; a verdict of it would be that of whoever wrote it."""
    check()
    checked.clear()
    Path(tmp_path, "user", "polarcheck", "cache-key").write_bytes(b"k" * 32)
    check()
    assert len(checked) == 5
    checked.clear()
    first, second, *_ = entries()
    first.write_bytes(second.read_bytes())
    check()
    assert checked


@pytest.mark.nightly
@pytest.mark.skipif(sys.platform == "win32", reason="links need more than files there")
def test_a_link_is_never_followed(tmp_path: Path) -> None:
    (tmp_path / "other").mkdir()
    Path(NAME).symlink_to(tmp_path / "other")
    check()
    assert not list((tmp_path / "other").iterdir())
    Path(NAME).unlink()
    check()
    (tmp_path / "precious").write_text("precious")
    for path in entries():
        path.unlink()
        path.symlink_to(tmp_path / "precious")
    (version,) = {path.parent for path in entries()}
    check()
    assert (tmp_path / "precious").read_text() == "precious"
    shutil.rmtree(version)
    version.symlink_to(tmp_path / "other")
    check()
    assert not list((tmp_path / "other").iterdir())


def full_disk(monkeypatch: pytest.MonkeyPatch, after: int) -> None:
    """Let the disk be full once so many files of the cache have been written."""
    count = 0

    class Full(io.BufferedWriter):
        def write(self, data: Any) -> int:
            nonlocal count
            count += 1
            if count > after:
                raise OSError(errno.ENOSPC, "No space left on device")
            return super().write(data)

    monkeypatch.setattr(store.os, "fdopen", lambda descriptor, mode: Full(io.FileIO(descriptor, mode)))


def git_takes() -> list[str]:
    """What git would take in, of the cache."""
    subprocess.run(["git", "init", "-q"], check=True)
    words = ["git", "ls-files", "--others", "--exclude-standard", NAME]
    return subprocess.run(words, capture_output=True, text=True, check=True).stdout.split()


@pytest.mark.one_in(5)
@pytest.mark.ci
@pytest.mark.parametrize("after", range(5))
def test_a_full_disk_leaves_no_cache_that_git_takes_in(
    after: int, checked: list[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    with monkeypatch.context() as patch:
        full_disk(patch, after)
        full = shown(check())
    assert git_takes() == []
    assert not list(Path(NAME).rglob("*.new"))
    whole = {path.name: path.stat().st_size > 0 for path in Path(NAME).glob("*") if path.is_file()}
    assert whole == dict.fromkeys((".gitignore", "CACHEDIR.TAG")[: max(after - 1, 0)], True)  # the key comes first
    assert shown(check()) == full
    assert Path(NAME, ".gitignore").read_text() == "*\n"
    assert git_takes() == []
    checked.clear()
    check()
    assert checked == []


@pytest.mark.nightly
@pytest.mark.parametrize("content", ["", "*", "!*\n", "* \n!a\n", "*\n" * 500])
@pytest.mark.parametrize("name", [".gitignore", "CACHEDIR.TAG"])
def test_a_file_that_says_what_the_folder_is_is_written_anew(name: str, content: str) -> None:
    check()
    before = Path(NAME, name).read_text()
    Path(NAME, name).write_text(content)
    check()  # all is known, and nothing else is written
    assert Path(NAME, name).read_text() == before


@pytest.mark.nightly
def test_the_folder_that_the_user_names_keeps_what_it_says() -> None:
    Path("mine").mkdir()
    for content, left in (("out\n", "out\n"), ("", "*\n")):
        Path("mine", ".gitignore").write_text(content)
        check(".", "--cache-dir", "mine")
        assert Path("mine", ".gitignore").read_text() == left
        shutil.rmtree(next(path for path in Path("mine").iterdir() if path.is_dir()))


@pytest.mark.skipif(sys.platform == "win32" or not os.getuid(), reason="root may write everywhere")
def test_a_folder_that_cannot_be_written() -> None:
    fresh = shown(check())
    shutil.rmtree(NAME)
    Path().chmod(0o500)
    try:
        assert shown(check()) == fresh
    finally:
        Path().chmod(0o700)


def test_without_a_place_for_the_key_nothing_is_kept(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "user").write_text("no folder")
    assert check("a.nc").exit_code == 1
    assert not Path(NAME).exists()
    monkeypatch.setenv("XDG_CACHE_HOME", "relative")
    monkeypatch.setenv("HOME", "relative")
    monkeypatch.setenv("LOCALAPPDATA", "")
    assert store.user_key() is None


@pytest.mark.nightly
def test_an_older_version_is_removed(checked: list[str]) -> None:
    old = Path(NAME, "0123456789abcdef")
    old.mkdir(parents=True)
    (old / "00.cache").write_bytes(b"old")
    other = Path(NAME, "fedcba9876543210")
    other.mkdir()
    (other / "notes.txt").write_text("of somebody")
    check()
    assert not old.exists()
    assert (other / "notes.txt").exists()


def test_its_size_is_bounded(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(store, "LARGEST", 1000)
    folder = str(tmp_path / "kept")

    def stored() -> Store:
        return Store(folder, b"version1", b"k" * 32)

    keys = [b"\0" + bytes([number]) * 15 for number in range(40)]
    for key in keys:
        one = stored()
        if one.get(keys[0]):
            one.use(keys[0])
        one.put(key, b"x" * 50)
        one.write()
    left = [key for key in keys if stored().get(key)]
    assert left == [keys[0], *keys[-len(left) + 1 :]]
    one = stored()
    one.put(keys[0], b"x" * 600)
    one.write()
    assert len(stored().get(keys[0]) or b"") == 50


def test_two_processes_at_once(tmp_path: Path) -> None:
    folder, first, second = str(tmp_path / "kept"), b"\0" * 16, b"\0" + b"\1" * 15
    one, other = (Store(folder, b"version1", b"k" * 32) for _ in range(2))
    assert (one.get(first), other.get(first)) == (None, None)
    one.put(first, b"of one")
    other.put(second, b"of the other")
    one.write()
    other.write()
    assert [Store(folder, b"version1", b"k" * 32).get(key) for key in (first, second)] == [b"of one", b"of the other"]
    assert not list(Path(folder).rglob("*.new"))


@pytest.mark.nightly
def test_an_interrupted_run_keeps_what_it_has_finished(checked: list[str], monkeypatch: pytest.MonkeyPatch) -> None:
    fresh = tasks._check

    def interrupted(task: tasks.Task, data: bytes) -> object:
        if task.path == "cell/d.nc":
            raise KeyboardInterrupt
        return fresh(task, data)

    monkeypatch.setattr(tasks, "_check", interrupted)
    assert check().exit_code == 130
    monkeypatch.setattr(tasks, "_check", fresh)
    checked.clear()
    check()
    assert checked == ["cell/d.nc", "subs/O9001", "tool.nc"]


def test_values_without_a_digest() -> None:
    for value in (object(), lambda: None, iter([])):
        with pytest.raises(digests.NoDigestError):
            list(digests._pieces(value))
    values: tuple[object, ...] = (
        None,
        0,
        False,
        0.0,
        "",
        b"",
        (),
        [],
        {},
        set(),
        "0",
        "None",
        {"a": 1},
        [("a", 1)],
        Path("a"),
        ["a"],
    )
    assert len({b"".join(digests._pieces(value)) for value in values}) == len(values)
    assert b"".join(digests._pieces({"b", "a"})) == b"".join(digests._pieces({"a", "b"}))


def test_outcomes_that_cannot_be_read_back_are_not_kept() -> None:
    assert outcomes._encoded(tasks.Outcome(failure="cannot be read")) is None
