"""`--cluster`: a scheduler of dask.distributed, by its address."""

from __future__ import annotations

import contextlib
import functools
import importlib
import logging
import re
import socket
import warnings
from collections.abc import Iterator, Sequence
from concurrent.futures import CancelledError
from typing import Any

from polarcheck.checking.batch import Task
from polarcheck.checking.remote import OnExecutor, in_time
from polarcheck.errors import CrewError

#: How long a scheduler may take to accept a connection, and to have a worker [s].
_PATIENCE = 5
#: How long it may take to shake hands and to answer a question; the client itself waits for some answers for ever [s].
_LONGEST = 10
#: What the client raises where nobody answers any more; TimeoutError is an OSError.
_NO_ANSWER = (OSError, RuntimeError, CancelledError)
_ADDRESS = re.compile(r"(?:tcp|tls)://(?:\[([0-9A-Fa-f:]+)\]|([^/:\s]+)):([0-9]{1,5})/?", re.ASCII)


@contextlib.contextmanager
def crew(address: str, tasks: Sequence[Task], most: int) -> Iterator[OnExecutor]:
    """
    The workers of a cluster, until the end of the block.

    most: bytes of a file. Raises CrewError where the extra is not installed, nobody answers, or there is no worker.
    """
    with _client(address) as client:
        ask = functools.partial(_question, client)
        try:
            ask()
        except _NO_ANSWER:
            raise CrewError(f"--cluster {address}: the scheduler answered at first, and does not any more") from None
        try:
            in_time(lambda: client.wait_for_workers(1, timeout=_PATIENCE), _LONGEST)
            jobs = sum(in_time(client.nthreads, _LONGEST).values())
        except _NO_ANSWER:
            raise CrewError(
                f"--cluster {address}: the scheduler has no workers; `dask worker {address} --nthreads 1` starts one"
            ) from None
        # Two files of the same bytes are still two.
        executor = client.get_executor(pure=False)
        yield OnExecutor(tasks, executor, max(jobs, 1), most, f"the cluster at {address}", ask)


def _question(client: Any) -> None:
    """Raises one of _NO_ANSWER where the scheduler does not answer in time."""
    in_time(lambda: client.sync(client.scheduler.identity), _LONGEST)


@contextlib.contextmanager
def _client(address: str) -> Iterator[Any]:
    """The connection to a scheduler."""
    _look_for(address)
    try:
        connected = importlib.import_module("distributed").Client
    except ImportError:
        raise CrewError("--cluster needs dask.distributed, of the extra [cluster]: pip install distributed") from None
    # What goes wrong is reported in one line, here; each logger of distributed has a level and a handler of its own.
    logging.disable(logging.CRITICAL)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        try:
            client = in_time(lambda: connected(address, timeout=_PATIENCE, set_as_default=False), _LONGEST)
        except TimeoutError:
            said = f"who accepts there did not answer as a scheduler within {_LONGEST} s"
            raise CrewError(f"--cluster {address}: {said}") from None
        except (OSError, ImportError, RuntimeError) as error:
            raise CrewError(f"--cluster {address}: what answers there is no scheduler: {_first_line(error)}") from None
        except Exception:  # from garbage the client reads anything: a length beyond all memory, a failed assertion
            raise CrewError(f"--cluster {address}: what answers there is no scheduler") from None
        try:
            yield client
        finally:
            with contextlib.suppress(*_NO_ANSWER):
                in_time(lambda: client.close(timeout=_PATIENCE), _LONGEST)


def _look_for(address: str) -> None:
    """Raises CrewError where nobody answers: the client would take many times as long to find out."""
    found = _ADDRESS.fullmatch(address)
    if found is None:
        raise CrewError(f"--cluster {address}: expected tcp://HOST:PORT, as the scheduler shows it when it starts")
    try:
        socket.create_connection((found[1] or found[2], int(found[3])), _PATIENCE).close()
    except (OSError, OverflowError, UnicodeError) as error:
        said = getattr(error, "strerror", None) or error
        raise CrewError(f"--cluster {address}: no scheduler answers there: {said}") from None


def _first_line(error: Exception) -> str:
    return str(error).partition("\n")[0] or type(error).__name__
