"""Files checked behind an executor, and by a real cluster of two processes, one of which is killed in the middle."""

from __future__ import annotations

import contextlib
import os
import signal
import socket
import subprocess
import sys
import threading
from collections.abc import Callable, Iterator
from concurrent.futures import Future, ThreadPoolExecutor
from pathlib import Path
from typing import Any

import pytest
from click.testing import CliRunner
from polarcheck.errors import ClusterError
from test_jobs import ENDLESS, FOREVER, GOOD, LONG, ONLY, RAPID, _is_busy, make, planned, run, start

import polarcheck
from polarcheck.commands import main
from polarcheck.files.batch import cluster, executors
from polarcheck.files.batch import tasks as batch
from polarcheck.files.batch.cluster import Answer, Batch, Cluster, check_batch

pytestmark = [pytest.mark.nightly, pytest.mark.usefixtures("own_folder")]

CLUSTER = """
import sys
from distributed import LocalCluster

if __name__ == "__main__":
    with LocalCluster(n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None) as cluster:
        print(cluster.scheduler_address, *(worker.pid for worker in cluster.workers.values()), flush=True)
        sys.stdin.read()
"""


class Executor(ThreadPoolExecutor):
    """One that does something else with some of the batches; they are counted from 0."""

    def __init__(self, acts: Callable[[int, Batch], Any] = lambda number, batch: None, workers: int = 2) -> None:
        super().__init__(workers)
        self._acts = acts
        self.sent: list[Batch] = []

    def submit(self, function: Any, /, *given: Any, **more: Any) -> Future[Any]:
        self.sent.append(given[0])
        number = len(self.sent) - 1

        def act() -> Any:
            done = self._acts(number, given[0])
            return function(*given, **more) if done is None else done

        return super().submit(act)


@pytest.fixture(autouse=True)
def nothing_remembered(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(cluster, "_REMEMBER", cluster._Remembered())


def through(executor: Executor, tasks: list[batch.Task], jobs: int = 2) -> list[batch.Outcome]:
    with executor:
        return list(executors.outcomes(tasks, Cluster(tasks, executor, jobs, batch.files.LARGEST, "the cluster")))


def test_any_executor_gives_what_one_process_gives() -> None:
    make(30)
    Path("f/own").mkdir()
    Path("f/own/polarcheck.toml").write_text('machine = "haas-lathe"\n')
    Path("f/own/a.nc").write_text(RAPID)
    Path("f/link.nc").symlink_to("nowhere")
    tasks = planned("f")
    found = through(Executor(), tasks)
    assert found == list(batch.one_by_one(tasks))
    assert sum(bool(one.failure) for one in found) == 1


def test_settings_are_sent_to_each_once() -> None:
    make(60)
    tasks = planned("f")
    assert len({id(task.settings) for task in tasks}) == 1
    # A second worker may come to its files before the first has read the settings, and asks for them again.
    executor = Executor(workers=1)
    through(executor, tasks, 1)
    assert len(executor.sent) > 4
    assert [len(sent.settings) for sent in executor.sent] == [1] + [0] * (len(executor.sent) - 1)


def test_who_does_not_know_the_settings_gets_them() -> None:
    make(60)
    executor = Executor(lambda number, sent: cluster._REMEMBER._known.clear() if number == 5 else None)
    tasks = planned("f")
    assert through(executor, tasks, 1) == list(batch.one_by_one(tasks))
    # How many batches are on their way when they are forgotten is a matter of luck.
    assert 2 <= [len(sent.settings) for sent in executor.sent].count(1) < len(executor.sent)


def test_settings_and_their_folders_are_forgotten_in_their_turn(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(cluster, "_REMEMBERED", 1)
    Path("subs").mkdir()
    Path("subs/O0100.nc").write_text("O0100\nM99\n")
    make(1)
    Path("f/polarcheck.toml").write_text('[run]\nsubprograms = ["../subs"]\n')
    packed = cluster.pack(planned("f")[0].settings)
    first = cluster._REMEMBER("first", packed)
    assert first is not None
    (folder,) = map(Path, first.job.run.subprograms)
    assert [path.name for path in folder.iterdir()] == ["O0100.nc"]
    assert cluster._REMEMBER("second", packed) is not None
    assert cluster._REMEMBER("first") is None
    assert not folder.exists()


def test_called_programs_are_sent() -> None:
    Path("subs").mkdir()
    Path("subs/O0100.nc").write_text("O0100\nM98 P200\nM99\n")
    Path("subs/O0200").write_text("O0200\nG0 C5.\nM99\n")
    Path("subs/secret").symlink_to("/etc/hostname")
    make(3)
    Path("f/polarcheck.toml").write_text('[run]\nsubprograms = ["../subs"]\n')
    for path in Path("f").glob("*.nc"):
        path.write_text(RAPID.replace("G0 C5.", "M98 P100"))
    tasks = planned("f")
    expected = list(batch.one_by_one(tasks))
    assert expected[0].report is not None
    assert "in O0200, line 2" in expected[0].report.findings[0].message

    def acts(number: int, sent: Batch) -> None:
        if Path("subs").exists():
            Path("subs").rename("gone")

    assert through(Executor(acts), tasks, 1) == expected
    sent = cluster.pack(tasks[0].settings)
    assert sorted(cluster.called_programs.contents("gone")) == ["O0100.nc", "O0200"]
    assert len(sent) < 100_000


def test_too_many_called_programs_are_not_sent(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(cluster, "_MOST_CALLED", 1_000_000)
    Path("subs").mkdir()
    Path("subs/O0100.nc").write_text("O0100\n" + "\n" * 2_000_000)
    make(3)
    Path("f/polarcheck.toml").write_text('[run]\nsubprograms = ["../subs"]\n')
    with pytest.raises(ClusterError, match=r"subs: 2 MB of subprograms are too much to be sent.*; 0 of 3 files"):
        through(Executor(), planned("f"))


# ---- what goes wrong ----


def failing(error: BaseException, when: Callable[[int, Batch], bool]) -> Executor:
    def acts(number: int, sent: Batch) -> None:
        if when(number, sent):
            raise error

    return Executor(acts)


def test_what_was_lost_is_sent_again() -> None:
    make(40)
    tasks = planned("f")
    executor = failing(OSError("gone"), lambda number, sent: number in (0, 3))
    assert through(executor, tasks) == list(batch.one_by_one(tasks))


def test_a_file_that_ends_who_checks_it_is_told() -> None:
    make(40)
    tasks = planned("f")
    executor = failing(OSError("gone"), lambda number, sent: any(path == "f/003.nc" for path, _, _ in sent.items))
    found = through(executor, tasks)
    assert [one.failure for one in found if one.failure] == ["f/003.nc: could not be checked: its process ended"]
    assert len(found) == 40


def test_a_cluster_that_is_gone_leaves_what_is_finished() -> None:
    make(40)
    tasks = planned("f")
    executor = failing(cluster.CancelledError(), lambda number, sent: number > 4)
    told: list[str] = []
    with executor:
        workers = Cluster(tasks, executor, 2, batch.files.LARGEST, "the cluster")
        checked = batch.gather(executors.outcomes(tasks, workers), told.append, lambda bug: pytest.fail(str(bug)))
    (line,) = told
    assert line == f"the cluster is gone; {len(checked.files)} of 40 files were checked"
    assert 0 < len(checked.files) < 40
    assert [file.path for file in checked.files] == sorted(file.path for file in checked.files)


@pytest.mark.parametrize(
    ("error", "line"),
    [
        (ModuleNotFoundError("No module named 'polarcheck'"), "is wanted on all workers: No module named 'polarcheck'"),
        (cluster.CancelledError(), "the cluster is gone; 0 of 3 files were checked"),
    ],
)
def test_what_no_worker_can_do_is_told_in_a_line(error: BaseException, line: str) -> None:
    make(3)
    with pytest.raises(ClusterError) as told:
        through(failing(error, lambda number, sent: True), planned("f"))
    assert line in str(told.value)


def test_an_executor_that_takes_no_more_is_told() -> None:
    make(3)
    executor = Executor()
    executor.shutdown()
    with pytest.raises(ClusterError, match="the cluster takes no more files: cannot schedule new futures"):
        through(executor, planned("f"))


def test_another_version_is_told() -> None:
    make(3)
    with pytest.raises(ClusterError, match=rf"a worker has polarcheck 9.9, this is {polarcheck.__version__}"):
        through(Executor(lambda number, sent: Answer("9.9")), planned("f"))
    assert check_batch(Batch("9.9", [], {})) == Answer(polarcheck.__version__)


def test_without_the_extra_it_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "distributed", None)
    make(1)
    with socket.create_server(("127.0.0.1", 0)) as server:
        address = f"tcp://127.0.0.1:{server.getsockname()[1]}"
        result = CliRunner().invoke(main, ["check", "f", "--cluster", address])
    assert result.exit_code == 2
    assert (
        result.stderr
        == "polarcheck: --cluster needs dask.distributed, of the extra [cluster]: pip install distributed\n"
    )


@pytest.mark.parametrize(
    ("address", "line"),
    [
        ("tcp://127.0.0.1:1", "no scheduler answers there: Connection refused"),
        ("nowhere", "expected tcp://HOST:PORT"),
        ("http://127.0.0.1:80", "expected tcp://HOST:PORT"),
        ("tcp://127.0.0.1:99999", "no scheduler answers there"),
        ("tcp://no.such.host.invalid:80", "no scheduler answers there"),
    ],
)
def test_an_address_where_nobody_is_takes_seconds_at_most(address: str, line: str) -> None:
    make(1)
    status, shown, told = run("check", "f", "--cluster", address)
    assert (status, shown) == (2, "")
    assert told.startswith(f"polarcheck: --cluster {address}: ")
    assert line in told
    assert told.count("\n") == 1


IMPATIENT = """
import os
from polarcheck.files.batch import cluster
from polarcheck.commands import run

in_time = cluster.in_time
cluster.in_time = lambda call, seconds: in_time(call, 1 if os.path.exists("silent") else 60)
cluster._LONGEST, cluster._PATIENCE, cluster._QUIET = 1, 60, 0.5
run()
"""


def start_impatient(*arguments: str) -> subprocess.Popen[str]:
    """polarcheck that waits for a scheduler for a second once there is a file `silent`, and long until then."""
    words = [sys.executable, "-c", IMPATIENT, *arguments]
    environment = {**os.environ, "PYTHONPATH": os.fspath(Path(polarcheck.__file__).parent.parent)}
    pipes = {"stdin": subprocess.DEVNULL, "stdout": subprocess.PIPE, "stderr": subprocess.PIPE}
    return subprocess.Popen(words, env=environment, text=True, encoding="utf-8", **pipes)  # type: ignore[call-overload]


#: What a port that is no scheduler says to whoever connects, and whether it closes then.
NO_SCHEDULER = {
    "nothing": (b"", False),
    "nothing, and closes": (b"", True),
    "a page": (b"HTTP/1.1 400 Bad Request\r\n\r\n" * 50, False),
    "a page, and closes": (b"HTTP/1.1 400 Bad Request\r\n\r\n" * 50, True),
    "zeros": (bytes(4096), False),
    "the greatest length": (b"\xff" * 64, False),
    "one byte to come": (b"\1" + bytes(7), False),
}


@contextlib.contextmanager
def port_that_says(said: bytes, closes: bool) -> Iterator[str]:
    connections: list[socket.socket] = []

    def serve() -> None:
        with contextlib.suppress(OSError):
            while True:
                connection, _ = server.accept()
                connections.append(connection)
                with contextlib.suppress(OSError):
                    connection.sendall(said)
                if closes:
                    connection.close()

    with socket.create_server(("127.0.0.1", 0)) as server:
        threading.Thread(target=serve, daemon=True).start()
        try:
            yield f"tcp://127.0.0.1:{server.getsockname()[1]}"
        finally:
            for connection in connections:
                connection.close()


@pytest.mark.parametrize("kind", NO_SCHEDULER)
def test_a_port_that_is_no_scheduler_is_one_line(kind: str) -> None:
    make(1)
    Path("silent").touch()
    with port_that_says(*NO_SCHEDULER[kind]) as address:
        running = start_impatient("check", "f", "--cluster", address)
        shown, told = running.communicate(timeout=60)
    assert (running.returncode, shown) == (2, "")
    assert told.startswith(f"polarcheck: --cluster {address}: ")
    assert "did not answer as a scheduler within 1 s" in told or "what answers there is no scheduler" in told
    assert told.count("\n") == 1


def test_an_executor_that_answers_no_more_leaves_what_is_finished(monkeypatch: pytest.MonkeyPatch) -> None:
    """Nor is it asked to take its work back, for which it would have to answer."""
    monkeypatch.setattr(cluster, "_QUIET", 0.01)
    make(40)
    tasks = planned("f")
    silent = threading.Event()

    def acts(number: int, sent: Batch) -> None:
        if number > 4:
            silent.wait(60)

    def ask() -> None:
        raise TimeoutError

    told: list[str] = []
    with Executor(acts) as executor:
        workers = Cluster(tasks, executor, 2, batch.files.LARGEST, "the cluster", ask)
        checked = batch.gather(executors.outcomes(tasks, workers), told.append, lambda bug: pytest.fail(str(bug)))
        silent.set()
    assert told == [f"the cluster does not answer any more; {len(checked.files)} of 40 files were checked"]


def test_a_call_is_given_up_after_its_time_and_else_gives_or_raises_what_it_does() -> None:
    never = threading.Event()
    with pytest.raises(TimeoutError):
        cluster.in_time(lambda: never.wait(60), 0.01)
    never.set()
    assert cluster.in_time(lambda: 3, 60) == 3
    with pytest.raises(ZeroDivisionError):
        cluster.in_time(lambda: 1 / 0, 60)


# ---- a real one ----


@contextlib.contextmanager
def running_cluster(folder: Path, workers: int) -> Iterator[tuple[str, list[int], subprocess.Popen[str]]]:
    """The address of a scheduler, the processes of its workers, and its own process."""
    script = folder / "cluster.py"
    script.write_text(CLUSTER.replace("n_workers=2", f"n_workers={workers}"))
    environment = {
        **os.environ,
        "PYTHONPATH": os.fspath(Path(polarcheck.__file__).parent.parent),
        "DASK_TEMPORARY_DIRECTORY": os.fspath(folder),
    }
    pipes = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE, "stderr": subprocess.DEVNULL}
    with subprocess.Popen([sys.executable, str(script)], env=environment, text=True, cwd=folder, **pipes) as running:  # type: ignore[call-overload]
        address, *processes = running.stdout.readline().split()
        try:
            yield address, list(map(int, processes)), running
        finally:
            running.stdin.close()
            with contextlib.suppress(subprocess.TimeoutExpired):
                running.wait(60)
            running.kill()


@pytest.fixture(scope="module")
def real_cluster(tmp_path_factory: pytest.TempPathFactory) -> Iterator[tuple[str, list[int]]]:
    """The address of the scheduler, and two workers in processes of their own."""
    with running_cluster(tmp_path_factory.mktemp("cluster"), 2) as (address, workers, _):
        yield address, workers


@pytest.mark.nightly
@pytest.mark.skipif(sys.platform != "linux", reason="looks into /proc")
def test_a_worker_that_is_killed_loses_nothing(real_cluster: tuple[str, list[int]]) -> None:
    address, workers = real_cluster
    make(24)
    for number in (3, 9, 17):
        Path(f"f/{number:03}.nc").write_text(ENDLESS)
    Path("f/003.nc").write_text(RAPID)
    words = ("check", "f", *ONLY, "--format", "json", *LONG)
    running = start(*words, "--cluster", address)
    while not (busy := [worker for worker in workers if _is_busy(worker)]):
        assert running.poll() is None
    os.kill(busy[0], signal.SIGKILL)
    shown, told = running.communicate(timeout=120)
    assert (running.returncode, shown, told) == run(*words, "--jobs", "1")


def test_a_cluster_reads_no_file_of_ours(real_cluster: tuple[str, list[int]]) -> None:
    """Its workers stand in another folder: what is read there would be another file, or none."""
    make(4)
    Path("g").mkdir()
    Path("g/bad.nc").write_text(GOOD)
    Path("g/bad.nc").chmod(0)
    words = ("check", "f", "g", "-", "--max-size", "10k", *ONLY)
    found = run(*words, "--cluster", real_cluster[0], input=RAPID)
    assert found == run(*words, "--jobs", "1", input=RAPID)
    assert "-:4:1: error" in found[1]


@pytest.fixture
def scheduler(tmp_path: Path) -> Iterator[tuple[str, int, subprocess.Popen[str]]]:
    """The address of a scheduler, its one worker and its own process, for a test that stops it."""
    with running_cluster(tmp_path, 1) as (address, (worker,), running):
        try:
            yield address, worker, running
        finally:
            running.send_signal(signal.SIGCONT)


@pytest.mark.nightly
@pytest.mark.skipif(sys.platform != "linux", reason="stops a process and looks into /proc")
def test_a_scheduler_that_is_stopped_is_one_line(scheduler: tuple[str, int, subprocess.Popen[str]]) -> None:
    """In the middle of a run, and before the next one."""
    address, worker, process = scheduler
    make(2)
    for path in Path("f").glob("*.nc"):
        path.write_text(ENDLESS)
    running = start_impatient("check", "f", *ONLY, *FOREVER, "--cluster", address)
    while not _is_busy(worker):
        assert running.poll() is None
    process.send_signal(signal.SIGSTOP)
    Path("silent").touch()
    shown, told = running.communicate(timeout=240)
    assert (running.returncode, shown) == (2, "")
    assert told == f"polarcheck: the cluster at {address} does not answer any more; 0 of 2 files were checked\n"

    running = start_impatient("check", "f", "--cluster", address)
    shown, told = running.communicate(timeout=60)
    assert (running.returncode, shown) == (2, "")
    assert told.endswith("who accepts there did not answer as a scheduler within 1 s\n")
