"""Many files by several processes: the output is that of one, and whoever is lost on the way takes nothing along."""

from __future__ import annotations

import contextlib
import gc
import json
import multiprocessing
import multiprocessing.queues
import os
import signal
import struct
import subprocess
import sys
import time
from collections.abc import Iterator
from functools import partial
from pathlib import Path
from typing import Any

import msgspec
import pytest
from cases import looped
from polarcheck.errors import ClusterError
from programs import ROOT

import polarcheck
from polarcheck import reports
from polarcheck.columns.trace import Trace
from polarcheck.commands import progress
from polarcheck.files.batch import batch_run, executors
from polarcheck.files.batch import tasks as batch
from polarcheck.files.settings.of_programs import OfPrograms, Options
from polarcheck.foundation.finding import UNREADABLE
from polarcheck.rules.rule import load_all

RAPID = "G98 G0 X60. C0\nG12.1\nG1 X40. F200\nG0 C5.\nG1 C-5.\nG13.1\n"
GOOD = RAPID.replace("G0 C5.", "C5.")
#: Formats that hold many programs.
OF_MANY = [form for form in reports.formats() if form not in reports.PER_FILE]
#: Runs until a bound ends it.
ENDLESS = "#1=0\nWHILE[#1LT1]DO1\n#2=#2+1\nEND1\nM30\n"
FOREVER = ("--max-seconds", "600", "--max-statements", "1000000000000", "--max-blocks", "1000000000000")
#: For a second or two, and to the same statement wherever that is.
LONG = ("--max-seconds", "600", "--max-statements", "60000", "--max-blocks", "1000000000000")
ONLY = ("--select", "rapid-in-polar")
#: What --format concise says on standard error where a rule, here one that ONLY deselects, leaves a program unverified.
UNVERIFIED = "polarcheck: warning: some files are unverified; --format text says why, and what to give\n"
posix = pytest.mark.skipif(sys.platform == "win32", reason="signals and /proc of POSIX")
linux = pytest.mark.skipif(sys.platform != "linux", reason="forks, and looks into /proc")

pytestmark = [pytest.mark.ci, pytest.mark.usefixtures("own_folder")]


def start(*arguments: str, **options: Any) -> subprocess.Popen[str]:
    environment = {**os.environ, "PYTHONPATH": os.fspath(Path(polarcheck.__file__).parent.parent)}
    pipes = {"stdin": subprocess.DEVNULL, "stdout": subprocess.PIPE, "stderr": subprocess.PIPE, **options}
    words = [sys.executable, "-m", "polarcheck", *arguments]
    return subprocess.Popen(words, env=environment, text=True, encoding="utf-8", **pipes)


def run(*arguments: str, **options: Any) -> tuple[int, str, str]:
    given = options.pop("input", None)
    running = start(*arguments, **({"stdin": subprocess.PIPE} if given is not None else {}), **options)
    shown, told = running.communicate(given, timeout=120)
    return running.returncode, shown, told


def make(count: int) -> None:
    """Programs of which each third has a finding."""
    Path("f").mkdir()
    for number in range(count):
        Path(f"f/{number:03}.nc").write_text(GOOD if number % 3 else RAPID)


def planned(*paths: str) -> list[batch.Task]:
    chosen = Options(select=["rapid-in-polar"])
    return batch.plan(paths, OfPrograms(chosen), (), pytest.fail, pytest.fail)


def by_processes(tasks: list[batch.Task], workers: int = 2, method: str = "fork") -> list[batch.Outcome]:
    return list(executors.outcomes(tasks, executors.Processes(tasks, workers, method=method)))


def paths_of(found: list[batch.Outcome]) -> list[str]:
    return [outcome.report.path for outcome in found if outcome.report]


def unreadable(found: list[batch.Outcome]) -> dict[str, str]:
    """The files whose reports say that they were not checked, and why."""
    told = [outcome.report for outcome in found if outcome.report]
    return {report.path: report.reason or "" for report in told if report.verdict == UNREADABLE}


@contextlib.contextmanager
def rule_that(acts: Any, monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """A rule that does something in whatever process it runs."""

    def rapid(trace: Trace) -> Any:
        acts(trace.text.source.path)
        return trace.mode.in_polar & False

    known = load_all()
    rule = msgspec.structs.replace(known["rapid-in-polar"], function=rapid, parameters=("trace",))
    monkeypatch.setitem(known, "rapid-in-polar", rule)
    yield


# ---- the same output ----


@pytest.fixture(scope="module")
def archive(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Programs with findings and without, settings of their own, called programs, one that is gone, one too large."""
    folder = tmp_path_factory.mktemp("archive")
    for number in range(3):
        for sample in ("rapid_in_polar", "hexagon", "degrees", "narrow_groove"):
            text = (ROOT / "sample_programs" / f"{sample}.nc").read_bytes()
            (folder / f"{number}-{sample}.nc").write_bytes(text)
    (folder / "own").mkdir()
    (folder / "subs").mkdir()
    (folder / "subs" / "O0100.nc").write_text("O0100\nG0 C5.\nM99\n")
    (folder / "own" / "polarcheck.toml").write_text(
        'machine = "haas-lathe"\n[tools.1]\nradius = 4\n[run]\nsubprograms = ["../subs"]\n'
    )
    (folder / "own" / "calls.nc").write_text(RAPID.replace("G0 C5.", "M98 P100"))
    (folder / "own" / "umlaut-\u00e4.nc").write_text(RAPID)
    (folder / "link.nc").symlink_to(folder / "nowhere.nc")
    (folder / "large.nc").write_text(GOOD + "\n" * 200_000)
    return folder


@posix
def test_several_processes_say_what_one_says(archive: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(archive)
    words = ("check", ".", "--tool", "1:radius=5", "--max-size", "100k", "--format", "concise")
    reports = {}
    for jobs in ("1", "3"):
        folder = tmp_path / jobs
        folder.mkdir()
        files = [part for form in OF_MANY for part in ("-o", f"{form}:{folder / form}")]
        reports[jobs] = run(*words, "--jobs", jobs, *files), {form: (folder / form).read_text() for form in OF_MANY}
    (status, shown, errors), written = reports["1"]
    assert status == 2
    assert "link.nc: No such file" in errors
    assert "large.nc: larger than 100 kB" in errors
    assert "rapid-in-polar" in shown
    assert all("rapid-in-polar" in report for report in written.values())
    assert reports["3"] == reports["1"]


@pytest.mark.nightly
def test_processes_that_are_spawned_get_all_they_need() -> None:
    make(5)
    Path("f/polarcheck.toml").write_text('machine = "haas-lathe"\n[tools.8]\nradius = 4.0\n')
    tasks = planned("f")
    assert by_processes(tasks, 2, "spawn") == list(batch.one_by_one(tasks))


@pytest.mark.nightly
@linux
def test_standard_input_stands_among_many_files() -> None:
    make(4)
    paths = ("f/000.nc", "-", "f/001.nc", "f/003.nc")
    one = run("check", *paths, *ONLY, "--jobs", "1", "--format", "concise", input=RAPID)
    assert "-:4:1: error" in one[1]
    assert run("check", *paths, *ONLY, "--jobs", "2", "--format", "concise", input=RAPID) == one


@pytest.mark.nightly
@linux
def test_a_pipe_of_the_shell_stands_among_many_files() -> None:
    make(4)
    reading, writing = os.pipe()
    os.write(writing, RAPID.encode())
    os.close(writing)
    pipe = f"/dev/fd/{reading}"
    words = ("check", "f", pipe, *ONLY, "--jobs", "2", "--format", "concise")
    status, shown, told = run(*words, pass_fds=(reading,))
    os.close(reading)
    assert (status, told) == (1, UNVERIFIED)
    assert f"{pipe}:4:1: error" in shown


# ---- who is lost ----


@linux
def test_a_file_that_ends_its_process_is_told_and_the_others_are_whole(monkeypatch: pytest.MonkeyPatch) -> None:
    make(30)

    def acts(path: str) -> None:
        if path == "f/004.nc":
            os.kill(os.getpid(), signal.SIGKILL)

    with rule_that(acts, monkeypatch):
        found = by_processes(planned("f"))
    assert len(found) == 30
    assert [outcome.failure for outcome in found if outcome.failure] == [
        "f/004.nc: could not be checked: its process ended"
    ]
    assert paths_of(found) == [f"f/{number:03}.nc" for number in range(30)]
    assert unreadable(found) == {"f/004.nc": "could not be checked: its process ended"}


@pytest.mark.nightly
@linux
def test_all_files_that_end_their_process_are_told(monkeypatch: pytest.MonkeyPatch) -> None:
    make(12)

    def acts(path: str) -> None:
        if path < "f/006.nc":
            os._exit(3)

    with rule_that(acts, monkeypatch):
        found = by_processes(planned("f"), 3)
    assert [bool(outcome.failure) for outcome in found] == [True] * 6 + [False] * 6


@pytest.mark.nightly
@linux
def test_a_process_that_ends_beside_others_costs_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    make(30)
    sharing: list[int] = []

    def acts(path: str) -> None:
        if path in ("f/000.nc", "f/011.nc", "f/029.nc") and sharing != [1]:
            os.kill(os.getpid(), signal.SIGKILL)

    monkeypatch.setattr(executors, "keep_within_memory", sharing.append)
    with rule_that(acts, monkeypatch):
        tasks = planned("f")
        found = by_processes(tasks, 3)
    assert not [outcome.failure for outcome in found if outcome.failure]
    assert paths_of(found) == [task.path for task in tasks]


@linux
def test_a_file_that_has_too_little_memory_with_others_gets_all_of_it(monkeypatch: pytest.MonkeyPatch) -> None:
    make(10)
    sharing = []

    def acts(path: str) -> None:
        if (path == "f/003.nc" and sharing != [1]) or path == "f/007.nc":
            raise MemoryError

    monkeypatch.setattr(executors, "keep_within_memory", sharing.append)
    with rule_that(acts, monkeypatch):
        found = by_processes(planned("f"))
    assert [outcome.failure for outcome in found if outcome.failure] == [
        "f/007.nc: there is not enough memory to check it"
    ]


@linux
def test_a_result_that_there_is_no_memory_to_send_costs_its_file_alone(monkeypatch: pytest.MonkeyPatch) -> None:
    make(6)

    def packed(outcome: batch.Outcome) -> executors.Sent:
        if outcome.report and outcome.report.path == "f/003.nc":
            raise MemoryError
        return executors.Sent(outcome)

    monkeypatch.setattr(executors, "packed", packed)
    tasks = planned("f")
    found = by_processes(tasks)
    assert [outcome.failure for outcome in found if outcome.failure] == [
        "f/003.nc: could not be checked: its process ended"
    ]
    assert paths_of(found) == [task.path for task in tasks]
    assert unreadable(found) == {"f/003.nc": "could not be checked: its process ended"}


@linux
@pytest.mark.parametrize("bug", [ZeroDivisionError("by zero"), ClusterError("none of ours")], ids=["plain", "own"])
def test_a_bug_keeps_its_traceback(bug: Exception, monkeypatch: pytest.MonkeyPatch) -> None:
    make(3)

    def acts(path: str) -> None:
        if path == "f/001.nc":
            raise bug

    with rule_that(acts, monkeypatch):
        found = by_processes(planned("f"))
    told = found[1].bug
    assert (type(told), str(told)) == (type(bug), str(bug))
    assert told is not None
    assert told.__notes__ == ["while checking f/001.nc"]
    assert "in acts" in str(told.__cause__)
    assert "rapid" in str(told.__cause__)


def test_a_bug_that_cannot_be_sent_is_told_all_the_same() -> None:
    class OddError(Exception):
        def __init__(self, one: int, two: int) -> None:
            super().__init__(f"{one} and {two}")

    bug = OddError(1, 2)
    bug.add_note("while checking a.nc")
    told = executors.packed(batch.Outcome(bug=bug)).unpacked().bug
    assert told is not None
    assert (type(told), str(told), told.__notes__) == (RuntimeError, "OddError: 1 and 2", ["while checking a.nc"])


@pytest.mark.nightly
@linux
@pytest.mark.parametrize("fails", ["at once", "to start"])
def test_without_processes_this_one_checks(fails: str, monkeypatch: pytest.MonkeyPatch) -> None:
    make(5)

    def refused(*given: Any) -> None:
        raise OSError("no more processes")

    if fails == "to start":
        monkeypatch.setattr("multiprocessing.process.BaseProcess.start", refused)
    monkeypatch.setattr(executors, "keep_within_memory", lambda sharing: os._exit(1))
    tasks = planned("f")
    assert by_processes(tasks, 4) == list(batch.one_by_one(tasks))


@linux
def test_fewer_processes_check_where_the_system_gives_no_more(monkeypatch: pytest.MonkeyPatch) -> None:
    make(9)
    own, started = os.getpid(), []
    start_process = multiprocessing.process.BaseProcess.start

    def limited(process: Any) -> None:
        if len(multiprocessing.active_children()) >= 2:
            raise OSError("no more processes")
        start_process(process)
        started.append(process)

    def acts(path: str) -> None:
        assert os.getpid() != own

    monkeypatch.setattr("multiprocessing.process.BaseProcess.start", limited)
    with rule_that(acts, monkeypatch):
        tasks = planned("f")
        found = by_processes(tasks, 5)
    assert paths_of(found) == [task.path for task in tasks]
    assert len(started) == 2 + 2
    assert not multiprocessing.active_children()


@linux
def test_what_may_have_ended_a_process_is_not_checked_by_this_one(monkeypatch: pytest.MonkeyPatch) -> None:
    make(15)
    own = os.getpid()

    def acts(path: str) -> None:
        if path == "f/002.nc":
            assert os.getpid() != own
            os.kill(os.getpid(), signal.SIGKILL)

    begin = executors._begin
    begun = Path("begun")

    def begins_once(*given: Any) -> None:
        if begun.exists():
            os._exit(1)
        begun.touch()
        begin(*given)

    monkeypatch.setattr(executors, "_begin", begins_once)
    with rule_that(acts, monkeypatch):
        tasks = planned("f")
        found = by_processes(tasks, 1)
    lost = [outcome.failure for outcome in found if outcome.failure]
    # The files that were submitted with it may have done it as well.
    assert lost == [f"f/{number:03}.nc: could not be checked: its process ended" for number in range(2, 2 + len(lost))]
    assert 1 <= len(lost) <= executors._AHEAD
    assert paths_of(found) == [task.path for task in tasks]
    assert [f"{path}: {reason}" for path, reason in unreadable(found).items()] == lost


@pytest.mark.nightly
@linux
def test_a_process_that_dies_within_an_answer_stops_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    """The thread of the executor waits for the rest of the answer then, and sees nothing else."""
    make(8)
    check = executors.outcome

    def breaks_off(task: batch.Task, most: int) -> batch.Outcome:
        if task.path == "f/003.nc" and not Path("once").exists():
            Path("once").touch()
            (queue,) = (one for one in gc.get_objects() if type(one) is multiprocessing.queues.SimpleQueue)
            os.write(queue._writer.fileno(), struct.pack("!i", 1000) + bytes(10))
            os.kill(os.getpid(), signal.SIGKILL)
        return check(task, most)

    monkeypatch.setattr(executors, "outcome", breaks_off)
    tasks = planned("f")
    assert by_processes(tasks) == list(batch.one_by_one(tasks))
    assert Path("once").exists()


@linux
def test_large_files_are_checked_one_at_a_time(monkeypatch: pytest.MonkeyPatch) -> None:
    make(12)
    for number in (0, 1, 4, 5, 6):
        Path(f"f/{number:03}.nc").write_text(GOOD + "\n" * 2000)
    monkeypatch.setattr(executors.Processes, "large", 1000)

    def acts(path: str) -> None:
        if Path(path).stat().st_size > 1000:
            Path("large").touch(exist_ok=False)  # raises where another one is being checked
            time.sleep(0.05)
            Path("large").unlink()

    with rule_that(acts, monkeypatch):
        tasks = planned("f")
        found = by_processes(tasks, 3)
    assert paths_of(found) == [task.path for task in tasks]


# ---- interrupts ----


def children(process: int) -> list[int]:
    """The processes that a process has started, of which there is a while none."""
    with contextlib.suppress(OSError):
        return [int(one) for one in Path(f"/proc/{process}/task/{process}/children").read_text().split()]
    return []


def are_gone(processes: list[int]) -> bool:
    """Within a time in which a machine under any load ends a process."""
    end = time.monotonic() + 60
    while time.monotonic() < end:
        if not any(Path(f"/proc/{one}").exists() and not _is_dead(one) for one in processes):
            return True
        time.sleep(0.05)
    return False


def _is_dead(process: int) -> bool:
    with contextlib.suppress(OSError):
        return Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()[0] == "Z"
    return True


def begun(*more: str, **options: Any) -> tuple[subprocess.Popen[str], list[int], str]:
    """A run that comes to its last but one file and stays there, its workers, and what it has shown until then."""
    make(30)
    Path("f/028.nc").write_text(ENDLESS)
    words = ("check", "f", *ONLY, "--jobs", "2", "--format", "concise", *FOREVER, *more)
    running = start(*words, start_new_session=True, **options)
    assert running.stdout is not None
    shown = "".join(running.stdout.readline() for _ in range(10))
    return running, children(running.pid), shown


@pytest.mark.one_in(4)
@linux
@pytest.mark.parametrize(
    ("number", "status", "how"), [(signal.SIGINT, 130, "interrupted"), (signal.SIGTERM, 143, "terminated")]
)
@pytest.mark.parametrize("to_all", [True, False], ids=["terminal", "process"])
def test_an_interrupt_keeps_what_is_finished(number: int, status: int, how: str, to_all: bool) -> None:
    heed = partial(signal.signal, number, signal.SIG_DFL)
    running, workers, shown = begun("-o", "json:r.json", preexec_fn=heed)
    assert "f/027.nc:4:1: error" in shown
    assert workers
    if to_all and number == signal.SIGINT:
        os.killpg(running.pid, number)
    else:
        running.send_signal(number)
    _, told = running.communicate(timeout=60)
    assert running.returncode == status
    assert are_gone(workers)
    # Whether the last file is finished by then is a matter of luck.
    ends = [f"polarcheck: {how} after {count} of 30 files; these are reported\n{UNVERIFIED}" for count in (28, 29)]
    assert told in ends
    count = 28 + ends.index(told)
    report = json.loads(Path("r.json").read_text())
    others = [f"f/{number:03}.nc" for number in range(30) if number != 28]
    assert [file["path"] for file in report["files"]] == others[:count]
    assert report["interrupted"] == {
        "reason": f"{how} after {count} of 30 files; these are reported",
        "checked": count,
        "planned": 30,
        "next_path": "f/028.nc",
    }
    assert report["summary"]["unreadable"] == 0


@pytest.mark.nightly
@linux
def test_nobody_is_left_behind_where_the_first_process_is_killed() -> None:
    running, workers, _ = begun()
    running.kill()
    _, told = running.communicate(timeout=120)
    assert told == ""
    assert len(workers) == 2
    assert are_gone(workers)


def _is_busy(process: int) -> bool:
    """It works for a tenth of a second, in which it waits for nothing but a processor."""

    def states() -> list[list[str]]:
        threads = Path(f"/proc/{process}/task").glob("*/stat")
        return [thread.read_text().rpartition(")")[2].split() for thread in threads]

    def used() -> int:
        return sum(int(thread[11]) for thread in states())

    before = used()
    while used() <= before + 10:
        if all(thread[0] == "S" for thread in states()):
            return False
        time.sleep(0.01)
    return True


@pytest.mark.nightly
@linux
def test_a_worker_that_somebody_kills_costs_nothing() -> None:
    make(40)
    Path("f/020.nc").write_text(ENDLESS)
    words = ("check", "f", *ONLY, "--format", "json", *LONG)
    running = start(*words, "--jobs", "2")
    end = time.monotonic() + 60
    while len(workers := children(running.pid)) < 2 and time.monotonic() < end:
        time.sleep(0.01)
    os.kill(workers[0], signal.SIGKILL)
    shown, told = running.communicate(timeout=120)
    assert (running.returncode, shown, told) == run(*words, "--jobs", "1")


# ---- when it pays ----


def forms_of(tasks: list[batch.Task], seconds: float, monkeypatch: pytest.MonkeyPatch) -> tuple[int, int]:
    """How many files this process checks, and how many others do, where each takes so long on a clock of its own."""
    clock = [0.0]
    here, elsewhere = [], []

    def checked(task: batch.Task, most: int) -> batch.Outcome:
        clock[0] += seconds
        here.append(task)
        return batch.Outcome()

    def by_others(tasks: list[batch.Task], most: int, workers: int) -> Iterator[batch.Outcome]:
        elsewhere.extend(tasks)
        yield from (batch.Outcome() for _ in tasks)

    monkeypatch.setattr(batch_run.time, "monotonic", lambda: clock[0])
    monkeypatch.setattr(batch_run, "cores", lambda: 2)
    monkeypatch.setattr(batch, "outcome", checked)
    monkeypatch.setattr(batch_run, "_by_processes", by_others)
    with batch_run.outcomes(tasks, 1000, 0) as found:
        assert len(list(found)) == len(tasks)
    return len(here), len(elsewhere)


@linux
def test_a_run_begins_alone_and_calls_others_where_they_pay(monkeypatch: pytest.MonkeyPatch) -> None:
    make(60)
    tasks = planned("f")
    assert forms_of(tasks, 0.001, monkeypatch) == (60, 0)
    assert forms_of(tasks, 0.05, monkeypatch) == (1, 59)
    assert forms_of(tasks[:20], 0.05, monkeypatch) == (1, 19)  # a hook with 20 programs of 500 blocks
    assert forms_of(tasks[:6], 0.05, monkeypatch) == (6, 0)
    assert forms_of(tasks[:2], 3.0, monkeypatch) == (2, 0)
    assert forms_of(tasks[:3], 3.0, monkeypatch) == (1, 2)


def test_large_files_do_not_wait_for_each_other(monkeypatch: pytest.MonkeyPatch) -> None:
    make(3)
    for path in Path("f").iterdir():
        path.write_text(GOOD + "\n" * 300_000)
    assert forms_of(planned("f"), 0.001, monkeypatch) == (0, 3)


@pytest.mark.nightly
@looped("value", ["-1", "two", "1.5", "", "1025", "\u0663"])
def test_a_number_of_jobs_that_is_none_is_refused(value: str) -> None:
    Path("a.nc").write_text(GOOD)
    status, shown, told = run("check", "a.nc", f"--jobs={value}")
    assert (status, shown) == (2, "")
    assert "expected a number of processes up to 1024, or auto" in told


@pytest.mark.nightly
@looped("value", ["0", "auto", "AUTO", "1", "7"])
def test_a_number_of_jobs_is_taken(value: str) -> None:
    Path("a.nc").write_text(GOOD)
    assert run("check", "a.nc", *ONLY, "-q", f"-j{value}") == (0, "", "")


# ---- the bar ----


def test_the_bar_tells_rate_and_what_is_left() -> None:
    assert progress.line(120, 400, 2.0) == "[#######-----------------] 120 of 400 files, 60 files/s, 0:05 left"
    assert progress.line(1, 40_000, 2.0).endswith("1 of 40000 files, 0.5 files/s, 22:13:18 left")
    assert progress.line(400, 400, 0.0).endswith(", 0:00 left")


@pytest.mark.nightly
@linux
def test_the_bar_makes_way_for_the_report_and_leaves_nothing() -> None:
    import pty

    make(20)
    Path("f/001.nc").write_text(ENDLESS)
    master, terminal = pty.openpty()
    words = ("check", "f", *ONLY, "--max-seconds", "2", *FOREVER[2:], "--jobs", "1", "--format", "concise")
    running = start(*words, stdout=terminal, stderr=terminal)
    os.close(terminal)
    written = b""
    with contextlib.suppress(OSError):  # how a terminal ends
        while some := os.read(master, 4096):
            written += some
    os.close(master)
    assert running.wait(60) in (1, 2)
    shown = written.decode()
    assert "of 20 files, " in shown
    screen = [line.rpartition("\r")[2] for line in shown.replace("\r\n", "\n").split("\n")]
    assert not [line for line in screen if "files/s" in line]
    assert len([line for line in screen if line.startswith("f/")]) == 7
