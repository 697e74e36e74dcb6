"""Files that a result depends on: repaired, replaced, written in two steps, or open in the editor and not yet saved."""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path

import pytest
from cases import looped
from lsp_editor import Editor
from test_cli import COMPENSATED, RAPID

from polarcheck.editor import server_session
from polarcheck.foundation import bounded, record

pytestmark = [pytest.mark.ci, pytest.mark.usefixtures("own_folder")]

ONLY = ("--select", "rapid-in-polar,start-up-shorter-than-radius,subprogram-missing")
TABLE = "%\nG10 P1 R4.\n%\n"
JOB = 'machine = "nl.toml"\noffsets = "table.txt"\n'
LATHE = 'inherits = "fanuc-30i"\n'


@pytest.fixture(autouse=True)
def quick(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(server_session, "_POLL_EVERY", 0.05)


def shop(**texts: str) -> None:
    files = {"polarcheck.toml": JOB, "table.txt": TABLE, "nl.toml": LATHE}
    for name, text in files.items():
        Path(name).write_text(text, "utf-8")


def rewritten(name: str, text: str) -> None:
    """Truncate, then write, as a transfer does."""
    Path(name).write_text("", "utf-8")
    Path(name).write_text(text, "utf-8")


def renamed(name: str, text: str) -> None:
    Path("new").write_text(text, "utf-8")
    Path("new").replace(name)


def in_the_same_moment(name: str, text: str) -> None:
    """The time of the file does not tell that it has changed."""
    status = Path(name).stat() if Path(name).exists() else None
    Path(name).write_text(text, "utf-8")
    if status is not None:
        os.utime(name, ns=(status.st_atime_ns, status.st_mtime_ns))


@pytest.mark.one_in(12)
@pytest.mark.parametrize("write", [rewritten, renamed, in_the_same_moment])
@pytest.mark.parametrize(
    ("name", "good", "broken"),
    [
        ("table.txt", TABLE, ""),
        ("table.txt", TABLE, TABLE.replace("G10", "G11")),
        ("polarcheck.toml", JOB, JOB + "[tools.1]\nradios = 4.0\n"),
        ("nl.toml", LATHE, 'inherits = "fanuc-30j"\n'),
    ],
)
def test_what_was_broken_once_is_good_again(
    write: Callable[[str, str], None], name: str, good: str, broken: str
) -> None:
    shop()
    Path(name).write_text(broken, "utf-8")
    with Editor(*ONLY) as editor:
        program = editor.open("O1.NC", COMPENSATED)
        editor.marks(program, "not-checked")
        write(name, good)
        assert editor.marks(program) == []
        write(name, broken)
        editor.marks(program, "not-checked")


def test_a_file_that_was_not_there_is_seen_when_it_comes() -> None:
    shop()
    Path("nl.toml").unlink()
    Path("table.txt").unlink()
    with Editor(*ONLY) as editor:
        program = editor.open("O1.NC", COMPENSATED)
        editor.marks(program, "not-checked")
        Path("nl.toml").write_text(LATHE, "utf-8")
        Path("table.txt").write_text(TABLE, "utf-8")
        assert editor.marks(program) == []


def test_a_file_written_between_reading_and_looking_again_is_not_missed() -> None:
    """What counts is the state of a file before it was read."""
    Path("t").write_text("half", "utf-8")
    with record.recorded(has_states=True) as recorded:
        bounded.read_file("t", 10, "")
        Path("t").write_text("whole", "utf-8")
    seen = recorded.seen
    assert seen
    assert all(record.unchanged(path, before) is None for path, before in seen.items())


def test_a_state_that_tells_nothing_is_compared_by_content(monkeypatch: pytest.MonkeyPatch) -> None:
    """File systems that count in seconds: size, time and number are as they were."""
    Path("t").write_text("R4.", "utf-8")
    monkeypatch.setattr(record, "version", lambda path: (10**18, 3, 1, 1))
    monkeypatch.setattr(record.time, "time_ns", lambda: 10**18 + 1)
    with record.recorded(has_states=True) as recorded:
        bounded.read_file("t", 10, "")
    path, seen = os.path.realpath("t"), recorded.seen
    assert seen
    assert record.unchanged(path, seen[path]) == seen[path]
    Path("t").write_text("R5.", "utf-8")
    assert record.unchanged(path, seen[path]) is None
    Path("t").write_text("R4.", "utf-8")
    monkeypatch.setattr(record.time, "time_ns", lambda: 10**18 + 10**10)
    later = record.unchanged(path, seen[path])
    assert later is not None
    assert later.content is None
    assert record.unchanged(path, later) == later
    Path("t").unlink()
    assert record.unchanged(path, seen[path]) is None


# ---- called programs that are not saved ----

MAIN = RAPID.replace("G0 C5.", "M98 P77")


@pytest.mark.nightly
def test_an_unsaved_subprogram_counts_for_its_callers() -> None:
    Path("sub").mkdir()
    Path("sub/O77.NC").write_text("O77\nG1 C5.\nM99\n", "utf-8")
    Path("polarcheck.toml").write_text('[run]\nsubprograms = ["sub"]\n', "utf-8")
    with Editor(*ONLY) as editor:
        program = editor.open("O1.NC", MAIN)
        assert editor.marks(program) == []
        called = editor.open("sub/O77.NC", "O77\n\n\nG0 C5.\nM99\n")
        editor.marks(program, "rapid-in-polar")
        editor.change(called, 2, "G1", (3, 0, 2))
        assert editor.marks(program) == []
        editor.change(called, 3, "(HEAD)\nO77\nG0 C5.\nM99\n")
        editor.marks(program, "rapid-in-polar")
        (target,) = editor.asks("definition", program, 3, 5)
        assert (target["uri"], target["range"]["start"]["line"]) == (called, 1)
        editor.close(called)
        assert editor.marks(program) == []


def test_a_subprogram_that_was_never_saved_counts_too() -> None:
    """And one by way of a link is the same file."""
    Path("sub").mkdir()
    Path("link").symlink_to("sub", target_is_directory=True)
    Path("polarcheck.toml").write_text('[run]\nsubprograms = ["sub"]\n', "utf-8")
    with Editor(*ONLY) as editor:
        program = editor.open("O1.NC", MAIN)
        editor.marks(program, "subprogram-missing")
        new = editor.open("link/O77.NC", "O77\nG0 C5.\nM99\n")
        editor.marks(program, "rapid-in-polar")
        editor.open("sub/O78.NC", "O78\nG0 C5.\nM99\n")
        editor.close(new)
        editor.marks(program, "subprogram-missing")


def test_settings_count_as_they_are_saved() -> None:
    """A tool table that is open as a text counts as it stands; a job file once it is saved."""
    shop()
    with Editor(*ONLY) as editor:
        program = editor.open("O1.NC", COMPENSATED)
        assert editor.marks(program) == []
        editor.open("polarcheck.toml", "machin = 1\n")
        table = editor.open("table.txt", TABLE.replace("R4.", "R40."))
        editor.marks(program, "start-up-shorter-than-radius")
        editor.close(table)
        assert editor.marks(program) == []


# ---- while settings are broken ----

TWO = "O1\nN10 G0 X60.\nM98 P2\nGOTO10\nM30\nO2\nG12.1\nG0 C5.\nG13.1\nM99\n"


@pytest.mark.nightly
@looped("was_good", [True, False])
def test_with_broken_settings_what_needs_none_still_works(was_good: bool) -> None:
    job = Path("polarcheck.toml")
    broken = "[tools.1]\nradius = 4.0\nradios = 4.0\n"
    job.write_text("" if was_good else broken, "utf-8")
    with Editor(*ONLY) as editor:
        program = editor.open("O1.NC", TWO)
        if was_good:
            editor.marks(program, "rapid-in-polar")
            job.write_text(broken, "utf-8")
            editor.tell("textDocument/didSave", {"textDocument": {"uri": job.absolute().as_uri()}})
        editor.marks(program, "not-checked")
        (mark,) = editor.marks(job.absolute().as_uri(), "not-checked")
        assert mark["range"]["start"]["line"] == 2
        assert mark["message"].startswith("unknown key tools.1.radios; did you mean radius?")
        assert [target["range"]["start"]["line"] for target in editor.asks("definition", program, 3, 5)] == [1]
        assert [symbol["name"] for symbol in editor.asks("documentSymbol", program)] == ["O0001", "O0002"]
        job.write_text("[tools.1]\nradius = 4.0\n", "utf-8")
        editor.marks(program, "rapid-in-polar")
        assert editor.marks(job.absolute().as_uri()) == []
        job.write_text("machine = \n", "utf-8")
        editor.marks(job.absolute().as_uri(), "not-checked")
        editor.close(program)
        assert editor.marks(job.absolute().as_uri()) == []


@pytest.mark.nightly
@looped(
    ("job", "options"),
    [
        ('machine = "siemens-transmit"\n[tools.1]\nradios = 4.0\n', ()),
        ('machine = "nl.toml"\nunknown = 1\n', ()),
        ("machine = \n", ("--machine", "siemens-transmit")),
    ],
)
def test_the_machine_of_broken_settings_is_still_the_one_of_the_text(job: str, options: tuple[str, ...]) -> None:
    Path("nl.toml").write_text('inherits = "siemens-transmit"\n', "utf-8")
    Path("polarcheck.toml").write_text(job, "utf-8")
    with Editor(*options) as editor:
        program = editor.open("A.MPF", "ANF:\nG0 X60\nGOTOB ANF\nM30\n")
        editor.marks(program, "not-checked")
        assert [target["range"]["start"]["line"] for target in editor.asks("definition", program, 2, 7)] == [0]


def test_without_any_usable_option_the_default_machine_is_left() -> None:
    with Editor("--machine", "no-such-lathe") as editor:
        program = editor.open("O1.NC", TWO)
        editor.marks(program, "not-checked")
        assert [symbol["name"] for symbol in editor.asks("documentSymbol", program)] == ["O0001", "O0002"]
