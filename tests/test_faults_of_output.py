"""Whatever happens to a run and to what it writes: no file of the user's is lost, and what is finished is kept."""

from __future__ import annotations

import gc
import json
import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path
from typing import Any

import msgspec
import pytest
from test_jobs import UNVERIFIED

import polarcheck
from polarcheck.columns.trace import Trace
from polarcheck.files.batch import tasks as batch
from polarcheck.files.settings.of_programs import OfPrograms, Options
from polarcheck.rules.rule import load_all

pytestmark = pytest.mark.ci

GOOD = "G98 G0 X60. C0\nG12.1\nG1 X40. F200\nC5.\nC-5.\nG13.1\n"
RAPID = GOOD.replace("\nC5.", "\nG0 C5.")
ONLY = ("--select", "rapid-in-polar")

posix = pytest.mark.skipif(os.name == "nt", reason="there are no such signals, limits and devices")


@pytest.fixture(autouse=True)
def _programs(own_folder: None) -> None:
    for name, text in (("a.nc", RAPID), ("b.nc", GOOD)):
        Path(name).write_text(text)


def start(*arguments: str, **options: Any) -> subprocess.Popen[str]:
    """The command as a process."""
    environment = {**os.environ, "PYTHONPATH": os.fspath(Path(polarcheck.__file__).parent.parent)}
    given: dict[str, Any] = {"stdin": subprocess.DEVNULL, "stdout": subprocess.PIPE, "stderr": subprocess.PIPE}
    words = [sys.executable, "-m", "polarcheck", *arguments]
    return subprocess.Popen(words, text=True, env=environment, **{**given, **options})


def run(*arguments: str, **options: Any) -> tuple[int, str, str]:
    """Exit code, standard output, standard error of the command."""
    running = start(*arguments, **options)
    shown, told = running.communicate(timeout=120)
    return running.returncode, shown or "", told or ""


def bounded(name: str, most: int) -> Callable[[], None]:
    """What a process has to do at its start to have no more of something than this."""
    import resource

    return partial(resource.setrlimit, getattr(resource, name), (most, most))


# ---- the user's files ----


@pytest.mark.nightly
def test_a_report_never_takes_the_place_of_what_is_checked() -> None:
    Path("link.json").symlink_to("a.nc")
    os.link("a.nc", "twin.json")
    for output, said in (
        ("a.nc", "a.nc: it is read by this run"),
        ("./a.nc", "a.nc: it is read by this run"),
        ("link.json", "link.json: it is a.nc, which is read by this run"),
        ("twin.json", "twin.json: it is a.nc, which is read by this run"),
    ):
        told = f"polarcheck: -o {said}; name another file\n"
        assert run("check", "a.nc", "b.nc", "-o", f"json:{output}") == (2, "", told)
        assert Path("a.nc").read_text() == RAPID


@pytest.mark.nightly
def test_nor_of_what_settles_how_it_is_checked() -> None:
    Path("own").mkdir()
    texts = {
        "polarcheck.toml": 'offsets = "table.txt"\n[run]\nsubprograms = ["own"]\n',
        "table.txt": "G10 P10001 R4. Q0\n",
        "lathe.toml": 'inherits = "fanuc"\n',
        "more.txt": "G10 P10002 R4. Q0\n",
        "own/1234": "O1234\nM99\n",
    }
    for name, text in texts.items():
        Path(name).write_text(text)
    for name in texts:
        status, _, told = run(
            "check", "b.nc", "--machine", "lathe.toml", "--offsets", "more.txt", "-o", f"concise:{name}"
        )
        assert status == 2, name
        assert name in told
    assert {name: Path(name).read_text() for name in texts} == texts


@pytest.mark.one_in(5)
@pytest.mark.parametrize("name", ["new.nc", "O1234", "O1234.bak", "pyproject.toml", "x.MPF"])
def test_nor_has_it_the_name_of_a_program(name: str) -> None:
    status, _, told = run("check", "b.nc", "-o", f"json:{name}")
    assert (status, told.count("\n")) == (2, 1)
    assert "this is the name of a program or of a job file" in told
    assert not Path(name).exists()


@pytest.mark.nightly
def test_two_reports_have_two_files() -> None:
    status, _, told = run("check", "b.nc", *ONLY, "-o", "json:r.json", "-o", "concise:./r.json")
    assert (status, told) == (2, "polarcheck: -o r.json: two reports would be written to this file\n")
    status, _, told = run("check", "b.nc", "-o", "json:-")
    assert (status, told.count("--format chooses the report on standard output")) == (2, 1)
    assert not Path("-").exists()
    assert run("check", "b.nc", *ONLY, "-o", "json:r.json", "-o", "concise:r.txt")[0] == 0
    assert run("check", "b.nc", *ONLY, "-o", "json:r.json", "-o", "concise:r.txt")[0] == 0


# ---- what cannot be written ----


@pytest.mark.one_in(5)
@posix
@pytest.mark.parametrize(
    "arguments",
    [("check", "b.nc"), ("check", "b.nc", "--format", "json"), ("explain", "overcut"), ("--help",), ("--version",)],
)
def test_a_full_disk_behind_standard_output_is_one_line(arguments: tuple[str, ...]) -> None:
    with open("/dev/full", "w") as full:  # noqa: PTH123
        status, _, told = run(*arguments, stdout=full)
    assert (status, told) == (2, "polarcheck: standard output: No space left on device\n")


@pytest.mark.nightly
@posix
def test_standard_output_may_be_closed() -> None:
    status, _, told = run("check", "b.nc", *ONLY, "-o", "json:r.json", preexec_fn=partial(os.close, 1))
    assert (status, told) == (2, "polarcheck: standard output is closed\n")
    assert json.loads(Path("r.json").read_text())["summary"]["files"] == 1
    assert run("check", "b.nc", *ONLY, preexec_fn=partial(os.close, 2))[0] == 0


@posix
def test_a_full_disk_keeps_the_report_of_last_time_and_shows_this_one() -> None:
    Path("r.json").write_text("the last one")
    Path("many.nc").write_text(RAPID * 3000)
    most = bounded("RLIMIT_FSIZE", 100_000)
    outputs = ("-o", "json:r.json", "-o", "short:s.txt")
    status, shown, told = run("check", "many.nc", *ONLY, *outputs, preexec_fn=most)
    assert (status, told) == (2, "polarcheck: r.json: File too large\n")
    assert "1 file" in shown
    assert Path("s.txt").read_text()
    assert Path("r.json").read_text() == "the last one"
    assert {path.name for path in Path().iterdir()} == {"a.nc", "b.nc", "many.nc", "r.json", "s.txt"}


@pytest.mark.nightly
@posix
def test_where_nothing_can_be_written_is_said_and_the_report_is_shown() -> None:
    os.mkfifo("pipe")
    Path("folder").mkdir()
    for output in ("/proc/r.json", "pipe", "folder", "no/such/r.json", "a.nc/r.json", "/dev/full"):
        status, shown, told = run("check", "b.nc", *ONLY, "-o", f"json:{output}")
        assert status == 2, output
        assert told.startswith(f"polarcheck: {output}: ")
        assert told.count("\n") == 1
        assert "b.nc" in shown


@posix
def test_a_pipe_that_is_read_gets_the_report() -> None:
    os.mkfifo("pipe")
    reader = subprocess.Popen(["cat", "pipe"], stdout=subprocess.PIPE, text=True)
    handle = os.open("pipe", os.O_WRONLY)  # waits until it reads
    assert run("check", "b.nc", *ONLY, "-o", "json:pipe")[0] == 0
    os.close(handle)
    assert json.loads(reader.communicate(timeout=120)[0])["summary"]["files"] == 1


def own_descriptors(number: int) -> list[str]:
    """Paths by which a process may name a file that it has open."""
    Path("link").unlink(missing_ok=True)
    Path("link").symlink_to(f"/dev/fd/{number}")
    by_process = [f"/proc/self/fd/{number}"] if sys.platform == "linux" else []
    return [f"/dev/fd/{number}", "link", *by_process]


@posix
def test_a_pipe_that_the_shell_has_opened_gets_the_report() -> None:
    """`-o json:>(cat)` is /dev/fd/63, which leads to a pipe without a name."""
    reading, writing = os.pipe()
    outputs = own_descriptors(writing)
    for output in outputs:
        status, shown, told = run("check", "b.nc", *ONLY, "-o", f"json:{output}", pass_fds=(writing,))
        assert (status, told, "unverified  b.nc: " in shown) == (0, "", True), output
    os.close(writing)
    with open(reading) as pipe:  # noqa: PTH123
        text = pipe.read()
    assert text.count('"schema": 2,') == len(outputs)
    assert Path("link").is_symlink()


@pytest.mark.one_in(4)
@posix
@pytest.mark.parametrize("by_pipe", [True, False])
@pytest.mark.parametrize(("output", "number"), [("/dev/stdout", 1), ("/dev/stderr", 2)])
def test_a_report_goes_behind_what_a_standard_stream_holds(output: str, number: int, by_pipe: bool) -> None:
    """A file into which the shell leads the stream is not replaced: it would lose what is there, and what follows."""
    if by_pipe:
        _, *streams = run("check", "a.nc", *ONLY, "-o", f"json:{output}")
        text = streams[number - 1]
    else:
        with open("r.txt", "w+") as file:  # noqa: PTH123
            file.write("first\n")
            file.flush()
            run("check", "a.nc", *ONLY, "-o", f"json:{output}", **{("stdout", "stderr")[number - 1]: file})
            file.seek(0)
            text = file.read()
        assert text.startswith("first\n")
    assert text.count('"schema": 2,') == 1
    assert ("error: G0 cannot be used" in text) == (number == 1)


@pytest.mark.nightly
@posix
def test_a_descriptor_that_cannot_be_written_is_one_line() -> None:
    for output, said in (
        ("/dev/fd/0", "Bad file descriptor"),
        ("/dev/fd/99", "Bad file descriptor"),
        ("/dev/fd/9999999999999999999999", ""),
    ):
        with open(os.devnull) as unwritable:  # noqa: PTH123
            status, shown, told = run("check", "b.nc", *ONLY, "-o", f"json:{output}", stdin=unwritable)
        assert (status, told.count("\n"), "unverified  b.nc: " in shown) == (2, 1, True), told
        assert told.startswith(f"polarcheck: {output}: {said}")


@posix
def test_a_reader_of_a_report_who_goes_away_changes_no_exit_code() -> None:
    reading, writing = os.pipe()
    os.close(reading)
    assert run("check", "b.nc", *ONLY, "-o", f"json:/dev/fd/{writing}", pass_fds=(writing,))[::2] == (0, "")
    os.close(writing)


@posix
def test_two_reports_to_one_stream_are_refused() -> None:
    status, shown, told = run("check", "b.nc", "-o", "json:/dev/stdout", "-o", "sarif:/dev/fd/1")
    assert (status, shown) == (2, "")
    assert told == "polarcheck: -o /dev/fd/1: two reports would be written to this file\n"


_WRITES = """
import sys
from pathlib import Path
from polarcheck.program.reading import files
print("begun", flush=True)
while True:
    for letter in "xy":
        files.write(Path("r.json"), letter * 3_000_000)
"""


@posix
def test_a_kill_leaves_the_old_report_or_the_new_one() -> None:
    whole = {"z", "x" * 3_000_000, "y" * 3_000_000}
    Path("r.json").write_text("z")
    for number in range(6):
        environment = {**os.environ, "PYTHONPATH": os.fspath(Path(polarcheck.__file__).parent.parent)}
        words = [sys.executable, "-c", _WRITES]
        with subprocess.Popen(words, env=environment, stdout=subprocess.PIPE, text=True) as running:
            assert running.stdout is not None
            running.stdout.readline()
            time.sleep(0.003 * number)
            running.kill()
        assert Path("r.json").read_text() in whole


@pytest.mark.nightly
def test_two_runs_may_write_one_report() -> None:
    Path("more.nc").write_text(RAPID * 200)
    running = [start("check", name, *ONLY, "-o", "json:r.json") for name in ("a.nc", "b.nc", "more.nc", "a.nc")]
    for one in running:
        one.communicate(timeout=120)
    (found,) = json.loads(Path("r.json").read_text())["files"]
    assert found["path"] in ("a.nc", "b.nc", "more.nc")
    assert {path.name for path in Path().iterdir()} == {"a.nc", "b.nc", "more.nc", "r.json"}


# ---- interrupts ----


@pytest.mark.nightly
@posix
@pytest.mark.parametrize(
    ("number", "status", "how"), [(signal.SIGINT, 130, "interrupted"), (signal.SIGTERM, 143, "terminated")]
)
def test_what_is_finished_is_kept(number: int, status: int, how: str) -> None:
    """A shell that starts something in the background has it ignore the interrupt, which is inherited."""
    heed = partial(signal.signal, number, signal.SIG_DFL)
    arguments = ("check", "a.nc", "b.nc", "-", "--format", "concise", *ONLY, "-o", "json:r.json")
    running = start(*arguments, stdin=subprocess.PIPE, preexec_fn=heed)
    assert running.stdin is not None
    # More than a pipe holds: once it is written, the process is reading it, and without an end it waits for more.
    running.stdin.write(GOOD + "\n" * 2**20)
    running.stdin.flush()
    running.send_signal(number)
    shown, told = running.communicate(timeout=60)
    assert running.returncode == status
    reason = f"{how} after 2 of 3 files; these are reported"
    assert told == f"polarcheck: {reason}\n{UNVERIFIED}"
    assert "a.nc:4:1: error" in shown
    report = json.loads(Path("r.json").read_text())
    assert [(file["path"], file["verdict"]) for file in report["files"]] == [("a.nc", "fail"), ("b.nc", "unverified")]
    assert report["interrupted"] == {"reason": reason, "checked": 2, "planned": 3, "next_path": "-"}


# ---- what goes wrong in one file ----


def checked(bad: Exception, monkeypatch: pytest.MonkeyPatch) -> tuple[batch.Checked, list[str], list[Exception]]:
    """Three files, the second of which makes a rule raise; what is told and what is a bug."""

    def rapid(trace: Trace) -> Any:
        if trace.text.source.path == "b.nc":
            raise bad
        return trace.mode.in_polar & False

    known = load_all()
    faulty = msgspec.structs.replace(known["rapid-in-polar"], function=rapid, parameters=("trace",))
    monkeypatch.setitem(known, "rapid-in-polar", faulty)
    Path("c.nc").write_text(GOOD)
    told: list[str] = []
    bugs: list[Exception] = []
    tasks = batch.plan(["a.nc", "b.nc", "c.nc"], OfPrograms(Options()), (), told.append, told.append)
    return batch.gather(batch.one_by_one(tasks), told.append, bugs.append), told, bugs


def test_a_bug_costs_its_file_only(monkeypatch: pytest.MonkeyPatch) -> None:
    found, told, bugs = checked(ZeroDivisionError("division by zero"), monkeypatch)
    assert [(file.path, file.verdict, file.reason or "") for file in found.files] == [
        ("a.nc", "pass", ""),
        ("b.nc", "unreadable", "a fault of polarcheck: ZeroDivisionError: division by zero"),
        ("c.nc", "pass", ""),
    ]
    assert told == []
    assert [(type(bug), bug.__notes__) for bug in bugs] == [(ZeroDivisionError, ["while checking b.nc"])]


def test_too_little_memory_costs_its_file_only(monkeypatch: pytest.MonkeyPatch) -> None:
    found, told, bugs = checked(MemoryError(), monkeypatch)
    assert [(file.path, file.verdict, file.reason or "") for file in found.files] == [
        ("a.nc", "pass", ""),
        ("b.nc", "unreadable", "there is not enough memory to check it"),
        ("c.nc", "pass", ""),
    ]
    assert told == ["b.nc: there is not enough memory to check it"]
    assert bugs == []


@pytest.mark.nightly
@posix
def test_a_file_that_needs_more_memory_than_there_is_costs_itself_only() -> None:
    Path("huge.nc").write_text(GOOD + "G0 X1.5 Z2.5\n" * 3_000_000)
    status, shown, told = run(
        "check", "a.nc", "huge.nc", "b.nc", *ONLY, "--format", "concise", "-o", "json:r.json",
        preexec_fn=bounded("RLIMIT_DATA", 500_000_000),
    )  # fmt: skip
    why = "there is not enough memory to check it"
    assert (status, told) == (2, f"polarcheck: huge.nc: {why}\n{UNVERIFIED}")
    assert "a.nc:4:1: error" in shown
    assert f"huge.nc:1:1: error: {why} [unreadable]\n" in shown
    files = json.loads(Path("r.json").read_text())["files"]
    assert [(file["path"], file["verdict"], file.get("reason")) for file in files] == [
        ("a.nc", "fail", None),
        ("huge.nc", "unreadable", why),
        ("b.nc", "unverified", None),
    ]


@pytest.mark.nightly
def test_no_table_of_a_file_outlives_the_next() -> None:
    told: list[str] = []
    (task,) = batch.plan(["a.nc"], OfPrograms(Options()), (), told.append, told.append)
    living = []

    def tasks() -> Iterator[batch.Task]:
        for _ in range(5):
            living.append(sum(isinstance(one, Trace) for one in gc.get_objects()))
            yield task

    gc.collect()
    gc.disable()
    try:
        batch.gather(batch.one_by_one(tasks()), told.append, print)
    finally:
        gc.enable()
    assert living[2] == living[3] == living[4] <= living[0] + 1
