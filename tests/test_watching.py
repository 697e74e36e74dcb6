"""`--watch`: real processes that see real files change."""

from __future__ import annotations

import contextlib
import queue
import signal
import subprocess
import sys
import threading
from collections.abc import Iterator
from functools import partial
from pathlib import Path
from typing import Any

import pytest
from test_jobs import ENDLESS, FOREVER, GOOD, ONLY, RAPID, UNVERIFIED, planned, run, start

from polarcheck.commands import watching
from polarcheck.files.batch import tasks as batch

pytestmark = [
    pytest.mark.ci,
    pytest.mark.usefixtures("own_folder"),
    pytest.mark.skipif(sys.platform == "win32", reason="ends the process by a signal of POSIX"),
]
WATCHING = "polarcheck: watching for changes; Ctrl-C ends\n"


class Watched:
    """A process with --watch: what it writes to both of its outputs, which are one here, round by round."""

    def __init__(self, running: subprocess.Popen[str]) -> None:
        self.running = running
        self._lines: queue.Queue[str] = queue.Queue()
        self._thread = threading.Thread(target=self._read)
        self._thread.start()

    def _read(self) -> None:
        for line in self.running.stdout or ():
            self._lines.put(line)

    def round(self) -> list[str]:
        """The lines up to the end of a round."""
        lines = []
        while (line := self.line()) != WATCHING:
            lines.append(line)
        return lines

    def line(self) -> str:
        """The next line."""
        return self._lines.get(timeout=120)

    def end(self, number: int = signal.SIGINT) -> int:
        """The exit code after a signal."""
        self.running.send_signal(number)
        status = self.running.wait(60)
        self._thread.join(60)
        return status


@contextlib.contextmanager
def watched(*arguments: str) -> Iterator[Watched]:
    heed = partial(signal.signal, signal.SIGINT, signal.SIG_DFL)
    words = ("check", *arguments, *ONLY, "--format", "concise", "--watch")
    with start(*words, preexec_fn=heed, stderr=subprocess.STDOUT) as running:
        found = Watched(running)
        try:
            yield found
        finally:
            running.kill()


def test_what_changes_is_checked_again_and_the_rest_is_shown_as_it_was() -> None:
    Path("f").mkdir()
    Path("f/a.nc").write_text(RAPID)
    Path("f/b.nc").write_text(RAPID)
    with watched("f", "-o", "json:f/r.json") as found:
        assert [line[:13] for line in found.round()] == ["f/a.nc:4:1: e", "f/b.nc:4:1: e"]

        Path("f/a.nc").write_text(GOOD)
        said = found.round()
        assert sum(line.startswith("polarcheck: f/a.nc changed, ") for line in said) == 1
        assert [line[:13] for line in said if not line.startswith("polarcheck")] == ["f/b.nc:4:1: e"]

        Path("f/new.nc").write_text("\n" + RAPID)
        assert [line[:15] for line in found.round() if line.startswith("f/")] == ["f/b.nc:4:1: err", "f/new.nc:5:1: e"]

        Path("f/b.nc").unlink()
        assert [line[:15] for line in found.round() if line.startswith("f/")] == ["f/new.nc:5:1: e"]
        assert Path("f/r.json").read_text().count('"path"') == 2
        assert found.end() == 0


@pytest.mark.nightly
def test_settings_and_called_programs_count() -> None:
    Path("f").mkdir()
    Path("subs").mkdir()
    Path("subs/O0100.nc").write_text("O0100\nG1 C5.\nM99\n")
    Path("f/a.nc").write_text(RAPID.replace("G0 C5.", "M98 P100"))
    with watched("f") as found:
        assert found.round() == [UNVERIFIED]
        Path("f/polarcheck.toml").write_text('[run]\nsubprograms = ["../subs"]\n')
        found.round()
        Path("subs/O0100.nc").write_text("O0100\nG0 C5.\nM99\n")
        assert [line for line in found.round() if "in O0100.nc, line 2" in line]
        Path("f/polarcheck.toml").write_text("[run]\nsubprogram = []\n")
        assert [line for line in found.round() if "subprogram" in line and "f/polarcheck.toml" in line]
        Path("f/polarcheck.toml").write_text(
            '[run]\nsubprograms = ["../subs"]\n[severities]\nrapid-in-polar = "note"\n'
        )
        assert [line for line in found.round() if "f/a.nc:4:1: note: in O0100.nc, line 2" in line]
        assert found.end(signal.SIGTERM) == 143


@pytest.mark.nightly
def test_an_interrupt_of_the_first_round_ends_it_too() -> None:
    Path("f").mkdir()
    for number in range(12):
        Path(f"f/{number:02}.nc").write_text(ENDLESS if number else RAPID)
    with watched("f", "-o", "json:r.json", *FOREVER, "--jobs", "1") as found:
        assert found.line().startswith("f/00.nc:4:1: error")
        assert found.end() == 0
        assert found.line() == "polarcheck: interrupted after 1 of 12 files; these are reported\n"
    assert Path("r.json").read_text().count('"path"') == 1


def test_standard_input_cannot_be_watched() -> None:
    assert run("check", "-", "--watch", input=RAPID) == (
        2, "", "polarcheck: --watch: standard input comes once; name a file or folder\n",
    )  # fmt: skip


@pytest.mark.one_in(3)
@pytest.mark.parametrize("other", ["--fix", "--diff", "--diff-base=HEAD"])
def test_one_look_is_not_watched(other: str) -> None:
    Path("a.nc").write_text(GOOD)
    said = f"polarcheck: --watch: not with {other.partition('=')[0]}, which is for one look\n"
    assert run("check", "a.nc", "--watch", other) == (2, "", said)


@pytest.mark.nightly
def test_a_first_run_that_cannot_begin_ends_it() -> None:
    Path("polarcheck.toml").write_text("nonsense = 1\n")
    Path("a.nc").write_text(GOOD)
    status, shown, told = run("check", "a.nc", "--watch")
    assert (status, shown) == (2, "")
    assert "nonsense" in told
    assert "watching" not in told


@pytest.mark.nightly
def test_only_what_has_changed_is_checked() -> None:
    Path("f/g").mkdir(parents=True)
    Path("subs").mkdir()
    Path("subs/O0100.nc").write_text("O0100\nM99\n")
    Path("f/g/polarcheck.toml").write_text('[run]\nsubprograms = ["../../subs"]\n')
    for name in ("f/a.nc", "f/b.nc", "f/g/c.nc", "f/g/d.nc"):
        Path(name).write_text(RAPID)
    seen = watching.Seen(["f"])
    checked: list[str] = []

    @contextlib.contextmanager
    def check(tasks: Any) -> Iterator[Any]:
        checked.extend(task.path for task in tasks)
        yield batch.one_by_one(tasks)

    def again() -> list[str]:
        checked.clear()
        with seen.outcomes(planned("f"), check) as outcomes:
            found = [outcome.report.path for outcome in outcomes if outcome.report]
        assert found == [task.path for task in planned("f")]
        assert seen.changed() == []
        return checked

    assert again() == ["f/a.nc", "f/b.nc", "f/g/c.nc", "f/g/d.nc"]
    assert again() == []
    Path("f/b.nc").write_text(GOOD + "\n")
    assert seen.changed() == ["f/b.nc"]
    assert again() == ["f/b.nc"]
    Path("subs/O0100.nc").write_text("O0100\nG4 X1.\nM99\n")
    assert again() == ["f/g/c.nc", "f/g/d.nc"]
    Path("subs/O0200.nc").write_text("O0200\nM99\n")
    assert again() == ["f/g/c.nc", "f/g/d.nc"]
    Path("f/e.nc").write_text(GOOD)
    assert seen.changed() == ["f"]
    assert again() == ["f/e.nc"]
    Path("polarcheck.toml").write_text('machine = "haas-lathe"\n')
    assert any(path.endswith("polarcheck.toml") for path in seen.changed())
    assert again() == ["f/a.nc", "f/b.nc", "f/e.nc"]


@pytest.mark.nightly
def test_a_job_file_beside_the_programs_is_named_once() -> None:
    Path("a.nc").write_text(RAPID)
    Path("polarcheck.toml").write_text("strict = false\n")
    with watched("a.nc") as found:
        found.round()
        Path("polarcheck.toml").write_text("strict = true\n")
        told = [line for line in found.round() if " changed, " in line]
        assert len(told) == 1
        assert told[0].startswith("polarcheck: polarcheck.toml changed, ")
