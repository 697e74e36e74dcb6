"""`--cluster`: a scheduler of dask.distributed, by its address."""

from __future__ import annotations

import contextlib
import importlib
import logging
import re
import socket
import warnings
from collections.abc import Iterator, Sequence
from typing import Any

from polarcheck.checking.batch import Task
from polarcheck.checking.remote import OnExecutor
from polarcheck.errors import CrewError

#: How long a scheduler may take to answer, and to have a worker [s].
_PATIENCE = 5
_ADDRESS = re.compile(r"(?:tcp|tls)://(?:\[([0-9A-Fa-f:]+)\]|([^/:\s]+)):([0-9]{1,5})/?", re.ASCII)


@contextlib.contextmanager
def crew(address: str, tasks: Sequence[Task], most: int) -> Iterator[OnExecutor]:
    """
    The workers of a cluster, until the end of the block.

    most: bytes of a file. Raises CrewError where the extra is not installed, nobody answers, or there is no worker.
    """
    with _client(address) as client:
        try:
            client.wait_for_workers(1, timeout=_PATIENCE)
            jobs = sum(client.nthreads().values())
        except OSError:  # that a time is over is one, too
            raise CrewError(
                f"--cluster {address}: the scheduler has no workers; `dask worker {address} --nthreads 1` starts one"
            ) from None
        # Two files of the same bytes are still two.
        yield OnExecutor(tasks, client.get_executor(pure=False), max(jobs, 1), most, f"the cluster at {address}")


@contextlib.contextmanager
def _client(address: str) -> Iterator[Any]:
    """The connection to a scheduler."""
    _look_for(address)
    try:
        connected = importlib.import_module("distributed").Client
    except ImportError:
        raise CrewError("--cluster needs dask.distributed, of the extra [cluster]: pip install distributed") from None
    # What goes wrong is told in one line, here.
    for name in ("distributed", "tornado"):
        logging.getLogger(name).setLevel(logging.CRITICAL)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        try:
            client = connected(address, timeout=_PATIENCE, set_as_default=False)
        except (OSError, ValueError, RuntimeError) as error:
            raise CrewError(f"--cluster {address}: what answers there is no scheduler: {_first_line(error)}") from None
        try:
            yield client
        finally:
            with contextlib.suppress(OSError, RuntimeError):
                client.close(timeout=_PATIENCE)


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
