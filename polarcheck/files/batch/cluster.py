"""
`--cluster`: files checked by the workers of a dask.distributed scheduler, given by its address.

The workers may have no file in common with this machine. So the programs are read here and sent as bytes. The settings
and the programs that may be called are sent once to each worker.
"""

from __future__ import annotations

import contextlib
import functools
import hashlib
import importlib
import logging
import pickle
import re
import shutil
import socket
import tempfile
import threading
import warnings
import zlib
from collections import Counter, OrderedDict
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import CancelledError, Executor, Future
from pathlib import Path
from typing import Any, TypeVar

import msgspec

from polarcheck.checking.settings import Settings
from polarcheck.files.batch.executors import Sent, packed
from polarcheck.files.batch.tasks import Outcome, Task, forget, outcome, unreadable
from polarcheck.foundation.errors import ClusterError, SourceError, why
from polarcheck.foundation.version import __version__
from polarcheck.program.execution import called_programs
from polarcheck.program.reading import files

#: Limits of one submission, each of which costs some milliseconds on a cluster [files, bytes].
_MOST, _MOST_BYTES = 100, 5_000_000
#: Number of settings that a worker remembers.
_REMEMBERED = 64
#: Limit of all subprograms that a job may call [bytes].
_MOST_CALLED = 200_000_000
#: Time without an outcome after which the scheduler is asked whether it still answers [s].
_QUIET = 5.0
#: Longest wait for a connection, and for a first worker [s].
_PATIENCE = 5
#: Longest wait for a handshake or an answer, and for a cancellation; the client alone might wait for ever [s].
_LONGEST = 10
_TO_CANCEL = 5.0
#: Exceptions of the client if the scheduler no longer answers; TimeoutError is an OSError.
_NO_ANSWER = (OSError, RuntimeError, CancelledError)
_ADDRESS = re.compile(r"(?:tcp|tls)://(?:\[([0-9A-Fa-f:]+)\]|([^/:\s]+)):([0-9]{1,5})/?", re.ASCII)
Value = TypeVar("Value")


# ---- the connection ----


@contextlib.contextmanager
def workers(address: str, tasks: Sequence[Task], most: int) -> Iterator[Cluster]:
    """
    The workers of a cluster, until the end of the block.

    most: bytes of a file. Raises ClusterError where the extra is not installed, nothing answers, or no worker is there.
    """
    with _client(address) as client:
        ask = functools.partial(_ask, client)
        try:
            ask()
        except _NO_ANSWER:
            raise ClusterError(f"--cluster {address}: the scheduler answered at first, and does not any more") from None
        try:
            in_time(lambda: client.wait_for_workers(1, timeout=_PATIENCE), _LONGEST)
            count = sum(in_time(client.nthreads, _LONGEST).values())
        except _NO_ANSWER:
            raise ClusterError(
                f"--cluster {address}: the scheduler has no workers; `dask worker {address} --nthreads 1` starts one"
            ) from None
        # pure=False: two files with the same bytes are checked and reported separately.
        executor = client.get_executor(pure=False)
        yield Cluster(tasks, executor, max(count, 1), most, f"the cluster at {address}", ask)


def _ask(client: Any) -> None:
    """Raises one of _NO_ANSWER where the scheduler does not answer in time."""
    in_time(lambda: client.sync(client.scheduler.identity), _LONGEST)


@contextlib.contextmanager
def _client(address: str) -> Iterator[Any]:
    """The connection to a scheduler."""
    _verify_port(address)
    try:
        connected = importlib.import_module("distributed").Client
    except ImportError:
        raise ClusterError(
            "--cluster needs dask.distributed, of the extra [cluster]: pip install distributed"
        ) from None
    # What goes wrong is reported in one line, here; each logger of distributed has a level and a handler of its own.
    logging.disable(logging.CRITICAL)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        try:
            client = in_time(lambda: connected(address, timeout=_PATIENCE, set_as_default=False), _LONGEST)
        except TimeoutError:
            reason = f"who accepts there did not answer as a scheduler within {_LONGEST} s"
            raise ClusterError(f"--cluster {address}: {reason}") from None
        except (OSError, ImportError, RuntimeError) as error:
            reason = str(error).partition("\n")[0] or type(error).__name__
            raise ClusterError(f"--cluster {address}: what answers there is no scheduler: {reason}") from None
        except Exception:  # garbage from the port can raise anything: MemoryError, AssertionError
            raise ClusterError(f"--cluster {address}: what answers there is no scheduler") from None
        try:
            yield client
        finally:
            with contextlib.suppress(*_NO_ANSWER):
                in_time(lambda: client.close(timeout=_PATIENCE), _LONGEST)


def _verify_port(address: str) -> None:
    """Raises ClusterError where nothing listens on the port; the client would take many times as long to find out."""
    match = _ADDRESS.fullmatch(address)
    if match is None:
        raise ClusterError(f"--cluster {address}: expected tcp://HOST:PORT, as the scheduler shows it when it starts")
    try:
        socket.create_connection((match[1] or match[2], int(match[3])), _PATIENCE).close()
    except (OSError, OverflowError, UnicodeError) as error:
        raise ClusterError(f"--cluster {address}: no scheduler answers there: {why(error)}") from None


def in_time(function: Callable[[], Value], seconds: float) -> Value:
    """
    Call a function that may never return. Returns its value or raises its exception, or TimeoutError after this time.

    A call that has not returned by then goes on in its thread.
    """
    future: Future[Value] = Future()

    def run() -> None:
        try:
            future.set_result(function())
        except Exception as error:
            future.set_exception(error)
        except BaseException:  # asyncio.CancelledError, for which callers have no handler
            future.set_exception(CancelledError())

    threading.Thread(target=run, daemon=True).start()
    return future.result(seconds)


# ---- what is sent ----


class Batch(msgspec.Struct, frozen=True):
    """
    Files for a worker.

    version: of polarcheck.
    items: path, key of the settings and bytes of each file.
    settings: packed settings by key, only those that the worker may not have yet.
    """

    version: str
    items: list[tuple[str, str, bytes]]
    settings: dict[str, bytes]


class Answer(msgspec.Struct, frozen=True):
    """
    The answer of a worker.

    version: of polarcheck.
    outcomes: one per file of the batch.
    unknown: keys of settings that the worker does not have; nothing is checked then.
    """

    version: str
    outcomes: list[Sent] = []
    unknown: list[str] = []


class Cluster:
    """The workers behind an executor, which read no file of this machine."""

    most_files, most_bytes, large = _MOST, _MOST_BYTES, float("inf")

    def __init__(
        self,
        tasks: Sequence[Task],
        executor: Executor,
        count: int,
        most: int,
        name: str,
        ask: Callable[[], None] = lambda: None,
    ) -> None:
        """
        count: number of workers. most: bytes of a file. name: the cluster in messages. ask: raises one of _NO_ANSWER
        if the scheduler no longer answers.
        """
        self.count, self.patience = count, _QUIET
        self.death: tuple[type[Exception], ...] = (Exception,)  # executors of a cluster have exceptions of their own
        self._tasks, self._executor, self._most, self._name, self._ask = tasks, executor, most, name, ask
        self._futures: set[Future[Answer]] = set()
        self._unreadable: dict[int, Outcome] = {}
        self._packed: dict[int, tuple[str, bytes]] = {}
        self._times_sent = Counter[str]()

    def submit(self, numbers: list[int], alone: bool) -> Future[Answer]:
        """Read files and send them. Raises ClusterError where subprograms are too large, or nothing is accepted."""
        items, settings = [], {}
        for number in numbers:
            task = self._tasks[number]
            try:
                data = files.read_program(task.path, self._most)
            except SourceError as error:
                self._unreadable[number] = unreadable(task, str(error))
                continue
            if id(task.settings) not in self._packed:
                content = pack(task.settings)
                self._packed[id(task.settings)] = hashlib.sha256(content).hexdigest(), content
            key, content = self._packed[id(task.settings)]
            items.append((task.path, key, data))
            if self._times_sent[key] < self.count:  # later each worker is likely to have them, or asks for them
                settings[key] = content
        self._times_sent.update(settings.keys())
        try:
            future = self._executor.submit(check_batch, Batch(__version__, items, settings))
        except Exception as error:  # of any executor that is shut down or broken
            raise ClusterError(f"{self._name} takes no more files: {error or type(error).__name__}") from error
        self._futures.add(future)
        return future

    def outcomes(self, future: Future[Answer], numbers: list[int]) -> list[Outcome] | None:
        """The outcomes of a submission; None where the worker did not have the settings, which are sent once more."""
        self._futures.discard(future)
        try:
            answer = future.result()
        except CancelledError:
            raise ClusterError(f"{self._name} is gone") from None
        except ImportError as error:
            raise ClusterError(f"{self._name}: polarcheck {__version__} is wanted on all workers: {error}") from None
        if answer.version != __version__:
            raise ClusterError(f"{self._name}: a worker has polarcheck {answer.version}, this is {__version__}")
        if answer.unknown:
            for key in answer.unknown:
                self._times_sent[key] = 0
            return None
        checked = iter(answer.outcomes)
        return [
            self._unreadable.pop(number) if number in self._unreadable else next(checked).unpacked()
            for number in numbers
        ]

    def verify(self) -> None:
        """Raises ClusterError where the scheduler does not answer any more."""
        try:
            self._ask()
        except _NO_ANSWER:
            self._futures.clear()  # to cancel them, it would have to answer
            raise ClusterError(f"{self._name} does not answer any more") from None

    def close(self) -> None:
        """Cancel what is in flight."""
        futures = list(self._futures)
        self._futures.clear()
        if futures:
            with contextlib.suppress(TimeoutError):  # the client of a cluster waits for the answer
                in_time(lambda: [future.cancel() for future in futures], _TO_CANCEL)


def pack(settings: Settings) -> bytes:
    """
    Settings with all programs in their folders of subprograms, as bytes.

    Raises ClusterError where these are too large.
    """
    folders = [called_programs.contents(folder) for folder in settings.job.run.subprograms]
    size = sum(len(data) for folder in folders for data in folder.values())
    if size > _MOST_CALLED:
        named = ", ".join(files.display_path(folder) for folder in settings.job.run.subprograms)
        raise ClusterError(
            f"{named}: {size / 1e6:.0f} MB of subprograms are too much to be sent; name folders with less"
        )
    return zlib.compress(pickle.dumps((settings, folders), pickle.HIGHEST_PROTOCOL), 1)


# ---- in a worker ----


def check_batch(batch: Batch) -> Answer:
    """Check files in a worker."""
    if batch.version != __version__:
        return Answer(__version__)
    for key, content in batch.settings.items():
        _REMEMBER(key, content)
    keys = {key for _, key, _ in batch.items}
    settings = {key: remembered for key in keys if (remembered := _REMEMBER(key)) is not None}
    if unknown := sorted(keys - settings.keys()):
        return Answer(__version__, unknown=unknown)
    outcomes = []
    for path, key, data in batch.items:
        outcomes.append(packed(outcome(Task(path, settings[key]), data=data)))
        forget()
    return Answer(__version__, outcomes)


class _Remembered:
    """The last settings that were sent to this process, with the folders of their subprograms."""

    def __init__(self) -> None:
        self._known: OrderedDict[str, tuple[Settings, Path | None]] = OrderedDict()

    def __call__(self, key: str, content: bytes | None = None) -> Settings | None:
        """The settings of a key, None if unknown; content: the packed settings, to remember them first."""
        if key not in self._known and content is not None:
            self._known[key] = _unpacked(content)
            while len(self._known) > _REMEMBERED:
                _, (_, folder) = self._known.popitem(last=False)
                _remove(folder)
        if key not in self._known:
            return None
        self._known.move_to_end(key)
        return self._known[key][0]


_REMEMBER = _Remembered()


def _unpacked(content: bytes) -> tuple[Settings, Path | None]:
    # Safe enough: whoever may send settings to a cluster may run any Python code on it.
    settings, folders = pickle.loads(zlib.decompress(content))  # noqa: S301
    if not folders:
        return settings, None
    import atexit

    unpacked = Path(tempfile.mkdtemp(prefix="polarcheck-"))
    atexit.register(functools.partial(_remove, unpacked))
    paths = []
    for number, contents in enumerate(folders):
        folder = unpacked / str(number)
        folder.mkdir()
        for name, data in contents.items():
            (folder / name).write_bytes(data)
        paths.append(called_programs.MovedFolder(str(folder), settings.job.run.subprograms[number]))
    run = msgspec.structs.replace(settings.job.run, subprograms=paths)
    job = msgspec.structs.replace(settings.job, run=run)
    return msgspec.structs.replace(settings, job=job), unpacked


def _remove(folder: Path | None) -> None:
    if folder is not None:
        shutil.rmtree(folder, ignore_errors=True)
