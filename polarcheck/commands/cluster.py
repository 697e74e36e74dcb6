"""`--cluster`: a scheduler of dask.distributed, by its address."""

from __future__ import annotations

import contextlib
import importlib
import logging
import warnings
from collections.abc import Iterator, Sequence
from typing import Any

from polarcheck.checking.batch import Task
from polarcheck.checking.remote import OnExecutor
from polarcheck.errors import CrewError

#: How long a scheduler may take to answer, and to have a worker [s].
_PATIENCE = 5


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
        except (OSError, TimeoutError):
            raise CrewError(
                f"--cluster {address}: the scheduler has no workers; start some with `dask worker`"
            ) from None
        # The same program twice is still two files.
        yield OnExecutor(tasks, client.get_executor(pure=False), jobs, most, f"the cluster at {address}")


@contextlib.contextmanager
def _client(address: str) -> Iterator[Any]:
    try:
        connected: Any = importlib.import_module("distributed").Client
    except ImportError:
        raise CrewError('--cluster needs dask.distributed: pip install "polarcheck[cluster]"') from None
    # What goes wrong is told in one line, here.
    logging.getLogger("distributed").setLevel(logging.CRITICAL)
    logging.getLogger("tornado").setLevel(logging.CRITICAL)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        try:
            client = connected(address, timeout=_PATIENCE, set_as_default=False)
        except (OSError, TimeoutError):
            raise CrewError(f"--cluster {address}: no scheduler answers there") from None
        except (ValueError, ImportError, RuntimeError) as error:
            raise CrewError(f"--cluster {address}: expected tcp://HOST:PORT ({error})") from None
        try:
            yield client
        finally:
            with contextlib.suppress(OSError, TimeoutError, RuntimeError):
                client.close(timeout=_PATIENCE)
