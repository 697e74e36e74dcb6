"""Runs that are repeated: what is printed is what a fresh run prints, byte for byte, and any change is noticed."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest
from programs import ROOT
from test_cache import CHANGES, archive, write  # noqa: F401  a fixture
from test_cli import GOOD, RAPID, call

from polarcheck.files.cache import repeats, store
from polarcheck.files.cache.store import NAME

pytestmark = [pytest.mark.ci, pytest.mark.usefixtures("archive", "unnoted")]
#: Programs that depend on all files of the archive.
NAMED = ("a.nc", "calls.nc", "tool.nc", "cell/d.nc")
Printed = tuple[int, str, str]


@pytest.fixture
def unnoted(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(repeats, "_run", None)


def found(*words: str) -> Printed | None:
    """Return what is printed again, without a run."""
    repeated = repeats.find(["check", *words])
    if repeated is None:
        return None
    texts = {False: "", True: ""}
    for to_error, text in repeated[1]:
        texts[to_error] += text.decode() if isinstance(text, bytes) else text
    return repeated[0], texts[False], texts[True]


def run(*words: str) -> Printed:
    result = call("check", *words)
    return result.exit_code, result.stdout, result.stderr


def check(*words: str) -> Printed:
    """Print again, or else run."""
    return found(*words) or run(*words)


@pytest.mark.nightly
@pytest.mark.one_in(5)
@pytest.mark.parametrize("form", ["text", "short", "concise", "json", "jsonl"])
def test_what_is_printed_again_is_what_was_printed(form: str) -> None:
    words = (*NAMED, "--format", form, "--tool", "77:radius=4", "--color", "always")
    first = check(*words)
    assert "warning: --tool 77" in first[2]
    assert found(*words) == first == run(*words, "--no-cache")
    assert found(*words, "-q") is None


OTHERS: dict[str, Callable[[], None]] = {
    "a program as a link to one of the same content": lambda: _link(Path("a.nc"), Path("a2.nc")),
    "a job file above": write("../polarcheck.toml", "[limits]\nc_feed = 36\n"),
    "a pyproject.toml beside the programs": write("cell/pyproject.toml", "[tool.polarcheck]\nmachine = 'haas-lathe'\n"),
    "a folder of subprograms that is gone": lambda: Path("nearer").rmdir(),
}


def _link(path: Path, target: Path) -> None:
    path.rename(target)
    path.symlink_to(target)


#: Changes of what the programs do not depend on.
ELSEWHERE = ("a program that is new",)


@pytest.mark.nightly
@pytest.mark.parametrize("name", [*CHANGES, *OTHERS])
def test_each_file_that_a_run_has_looked_for_counts(name: str) -> None:
    words = (*NAMED, "--format", "json")
    first = check(*words)
    assert found(*words) == first
    (CHANGES | OTHERS)[name]()
    assert (found(*words) is not None) == (name in ELSEWHERE)
    again = run(*words)
    assert again == run(*words, "--no-cache")
    assert found(*words) in (again, None)


@pytest.mark.parametrize("name", ["POLARCHECK_MACHINE", "NO_COLOR", "TERM", "XDG_CONFIG_HOME"])
def test_the_environment_counts(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    first = check("a.nc")
    with monkeypatch.context() as patch:
        patch.setenv(name, "haas-lathe")
        assert found("a.nc") is None
    monkeypatch.setenv("OLDPWD", "elsewhere")
    assert found("a.nc") == first


def test_the_code_python_and_the_folder_count(monkeypatch: pytest.MonkeyPatch) -> None:
    first = check("a.nc")
    for target, name, value in (
        (repeats, "code_digest", lambda: b"another1"),
        (repeats.sys, "version", "3.99"),
        (repeats.sys, "path", ["/elsewhere"]),
    ):
        with monkeypatch.context() as patch:
            patch.setattr(target, name, value)
            assert found("a.nc") is None
    assert found("a.nc") == first
    os.link("a.nc", "cell/a.nc")
    monkeypatch.chdir("cell")
    assert found("a.nc") is None


def test_a_file_that_changes_during_the_run_is_no_base_of_it(monkeypatch: pytest.MonkeyPatch) -> None:
    keep = repeats.keep

    def changed(status: int) -> None:
        Path("a.nc").write_text("O0001\n" + RAPID + "M30\n")
        keep(status)

    monkeypatch.setattr(repeats, "keep", changed)
    check("a.nc")
    assert found("a.nc") is None


@pytest.mark.nightly
@pytest.mark.parametrize(
    "words",
    [
        *((".",), ("a.nc", "cell"), ("a.nc", "-o", "json:out.json"), ("a.nc", "--format", "html")),
        *(("a.nc", "--format", "github"), ("a.nc", "--no-cache"), ("a.nc", "--diff"), ("a.nc", "missing.nc")),
        *(("a.nc", "--max-seconds", "0.0000001"), ("a.nc", "--show-files"), ("a.nc", "--baseline", "known.json")),
    ],
)
def test_what_does_more_than_print_is_run(words: tuple[str, ...]) -> None:
    assert call("baseline", "create", "calls.nc", "-o", "known.json").exit_code == 0
    check("a.nc")
    check(*words)
    assert found(*words) is None


def test_what_cannot_be_trusted_is_run(tmp_path: Path) -> None:
    first = check("a.nc")
    assert found("a.nc") == first
    (kept,) = Path(NAME).rglob("run*.cache")
    data = kept.read_bytes()
    for broken in (b"", data[:40], data[:-1], data[:-1] + b"\0"):
        kept.write_bytes(broken)
        assert found("a.nc") is None
    kept.write_bytes(data)
    assert found("a.nc") == first
    key = Path(tmp_path, "user", "polarcheck", "cache-key")
    own = key.read_bytes()
    key.write_bytes(b"k" * 32)
    assert found("a.nc") is None
    key.write_bytes(own)
    Path(NAME).rename("elsewhere")
    assert found("a.nc") is None
    Path(NAME).symlink_to("elsewhere")
    assert found("a.nc") is None


def test_a_file_that_is_named_as_an_option_leads_to_no_cache() -> None:
    words = ("a.nc", "--cache-dir=planted")
    first = check(*words)
    assert found(*words) == first
    Path("--cache-dir=planted").touch()
    assert found(*words) is None


def test_where_a_cache_lies() -> None:
    for words in (("a.nc", "--cache-dir", "own"), ("--cache-dir=own", "a.nc"), ("--", "a.nc")):
        assert found(*words) is None
        assert check(*words) == found(*words)
    assert len([*Path("own").rglob("run*.cache")]) == 2
    Path("cell/polarcheck.toml").write_text("")
    assert check("cell/d.nc") == found("cell/d.nc")


def test_its_size_is_bounded(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(store, "LARGEST_RUN", 100)
    check("a.nc")
    assert found("a.nc") is None


#: Notes what a run opens or lists.
AUDITED = """
import json, os, sys
opened = set()
def note(event, arguments):
    if event in ("open", "os.scandir", "os.listdir") and isinstance(arguments[0], str):
        opened.add(os.path.realpath(arguments[0]))
sys.addaudithook(note)
import atexit
atexit.register(lambda: print(json.dumps(["click" in sys.modules, sorted(opened)]), file=sys.stderr))
from polarcheck.__main__ import run
run()
"""


def audited(*words: str) -> tuple[int, str, bool, set[str]]:
    """Exit code, standard output, True if click was loaded, and what was opened."""
    process = subprocess.run(
        [sys.executable, "-c", AUDITED, "check", *words],
        capture_output=True,
        text=True,
        check=False,
        env=os.environ | {"PYTHONPATH": str(ROOT)},
    )
    uses_click, opened = json.loads(process.stderr.splitlines()[-1])
    return process.returncode, process.stdout, uses_click, set(opened)


def test_a_process_repeats_without_the_command_line_and_rests_on_all_that_it_has_opened() -> None:
    Path("a.nc").write_text("O0001\n" + GOOD + "M30\n")
    first, second = (audited(*NAMED, "--jobs", "1") for _ in range(2))
    assert first[:3] == (*second[:2], True)
    assert second[2] is False
    # Files below a folder of subprograms are opened relative to it.
    here = os.path.realpath(os.curdir)
    names = {os.path.basename(path) for path in first[3] if path.startswith(here + os.sep) and NAME not in path}  # noqa: PTH119
    assert {"TOOLS.TXT", "subs", "O9001", "base.toml", "d.nc"} <= names
    assert names <= {os.path.basename(path) for path in second[3]}  # noqa: PTH119


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="no device that is always full")
def test_a_full_disk_is_one_line_again() -> None:
    for _ in range(2):
        audited("a.nc")
        with Path("/dev/full").open("w") as full:
            command = [sys.executable, "-m", "polarcheck", "check", "a.nc"]
            environment = os.environ | {"PYTHONPATH": str(ROOT)}
            ended = subprocess.run(command, stdout=full, stderr=subprocess.PIPE, check=False, env=environment)
        assert (ended.returncode, ended.stderr) == (2, b"polarcheck: standard output: No space left on device\n")
