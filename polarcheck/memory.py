"""Memory: a file that needs more than the machine has is one that cannot be checked, and takes no other with it."""

from __future__ import annotations

import contextlib
import errno
import os
import sys
from pathlib import Path
from typing import Any

#: Of what the machine or the container has this is ours at most; the system wants the rest.
_SHARE = 0.9
#: Less than this is no bound to keep: the libraries alone take half of it [bytes].
_LEAST = 1_000_000_000
#: Where containers say what they may take, in the newer and the older form.
_OF_CONTAINER = (Path("/sys/fs/cgroup/memory.max"), Path("/sys/fs/cgroup/memory/memory.limit_in_bytes"))
#: What NumPy with OpenBLAS and a small check take: memory of their own, and address space for libraries [bytes].
_DATA, _LIBRARIES = 64 * 2**20, 36 * 2**20


class _BeforeNumpy:
    """
    Raises MemoryError where NumPy is about to be imported and too little memory is left (`ulimit -v`, `ulimit -d`).

    OpenBLAS ends the whole process there, with the exit code 1, which means findings.
    """

    def find_spec(self, fullname: str, path: Any, target: Any = None) -> None:
        """Finds nothing: the finders behind this one do."""
        if fullname == "numpy":
            import mmap

            try:
                # What is shared counts for `ulimit -v` only. No page of either is ever used.
                with mmap.mmap(-1, _DATA, flags=mmap.MAP_PRIVATE | mmap.MAP_ANONYMOUS), mmap.mmap(-1, _LIBRARIES):
                    pass
            except OSError as error:
                if error.errno == errno.ENOMEM:
                    raise MemoryError from None


def keep_room_for_numpy() -> None:
    """Have an import of NumPy that there is no memory for be an exception."""
    if os.name == "posix" and "numpy" not in sys.modules:
        sys.meta_path.insert(0, _BeforeNumpy())


def keep_within_memory(sharing: int = 1) -> None:
    """
    Have more memory than there is refused, where the system would give it and end the whole process later.

    sharing: how many processes share it. A bound that is lower already stays as it is; on systems without such bounds
    nothing is done.
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
    """The memory of the container [bytes]; infinite where it has no bound of its own."""
    try:
        return float(path.read_text("ascii"))
    except (OSError, ValueError):  # "max"
        return float("inf")
