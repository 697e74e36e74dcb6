"""Limits memory, so that a file that needs more than there is fails alone, and the process goes on."""

from __future__ import annotations

import contextlib
import errno
import os
import sys
from pathlib import Path
from typing import Any

#: The largest share of the memory of the machine or the container; the rest is for the system.
_SHARE = 0.9
#: The least limit: the libraries alone take half of it [bytes].
_LEAST = 1_000_000_000
#: The files with the limit of a container, for cgroup 2 and 1.
_OF_CONTAINER = (Path("/sys/fs/cgroup/memory.max"), Path("/sys/fs/cgroup/memory/memory.limit_in_bytes"))
#: What NumPy with OpenBLAS and a small check need: private memory, and address space for libraries [bytes].
_DATA, _LIBRARIES = 64 * 2**20, 36 * 2**20


class _BeforeNumpy:
    """
    Raises MemoryError if NumPy is to be imported and too little memory is left (`ulimit -v`, `ulimit -d`).

    Otherwise OpenBLAS would end the process with exit code 1, which means findings.
    """

    def find_spec(self, fullname: str, path: Any, target: Any = None) -> None:
        """Find nothing: the next finders import the module."""
        if fullname == "numpy":
            import mmap

            try:
                # Shared memory counts for `ulimit -v` only. No page of either is ever touched.
                with mmap.mmap(-1, _DATA, flags=mmap.MAP_PRIVATE | mmap.MAP_ANONYMOUS), mmap.mmap(-1, _LIBRARIES):
                    pass
            except OSError as error:
                if error.errno == errno.ENOMEM:
                    raise MemoryError from None


def keep_room_for_numpy() -> None:
    """Turn lack of memory during the import of NumPy into an exception."""
    if os.name == "posix" and "numpy" not in sys.modules:
        sys.meta_path.insert(0, _BeforeNumpy())


def keep_within_memory(sharing: int = 1) -> None:
    """
    Limit the memory of the process to what there is; the system would grant more, and kill the process later.

    sharing: the number of processes that share it. A lower limit that is set already stays; without support of the
    system nothing is done.
    """
    try:
        import resource

        bound = int(_SHARE * min(_installed(), *map(_of_container, _OF_CONTAINER)))
        bound = max(bound // sharing, min(bound, _LEAST))
        now, highest = resource.getrlimit(resource.RLIMIT_DATA)
    except (ImportError, OSError, ValueError, AttributeError):
        return
    if bound < _LEAST or (now != resource.RLIM_INFINITY and now <= bound):
        return
    with contextlib.suppress(OSError, ValueError):
        resource.setrlimit(resource.RLIMIT_DATA, (bound, highest))


def _installed() -> float:
    return float(os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES"))


def _of_container(path: Path) -> float:
    """Return the memory of the container [bytes]; infinite if it has no limit."""
    try:
        return float(path.read_text("ascii"))
    except (OSError, ValueError):  # "max"
        return float("inf")
