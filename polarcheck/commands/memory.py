"""Memory: a file that needs more than the machine has is one that cannot be checked, and takes no other with it."""

from __future__ import annotations

import contextlib
import os
from pathlib import Path

#: Of what the machine or the container has this is ours at most; the system wants the rest.
_SHARE = 0.9
#: Less than this is no bound to keep: the libraries alone take half of it [bytes].
_LEAST = 1_000_000_000
#: Where containers say what they may take, in the newer and the older form.
_OF_CONTAINER = (Path("/sys/fs/cgroup/memory.max"), Path("/sys/fs/cgroup/memory/memory.limit_in_bytes"))


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
