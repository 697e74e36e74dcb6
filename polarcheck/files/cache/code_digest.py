"""The digest of the code that judges programs."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator
from functools import cache
from importlib.util import find_spec

from polarcheck.foundation.digest import blake2b
from polarcheck.foundation.version import __version__

#: Libraries that compute results.
_LIBRARIES = ("numpy", "shapely", "msgspec")
_FOLDER = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))  # noqa: PTH100, PTH120


@cache
def code_digest() -> bytes:
    """Return the digest of the program that judges: version, size and time of each of its files, libraries, Python."""
    digest = blake2b(digest_size=8)
    for part in (__version__, sys.version, sys.platform, *sorted(_states(_FOLDER))):
        digest.update(part.encode("utf-8", "surrogatepass") + b"\0")
    for name in _LIBRARIES:
        spec = find_spec(name)
        if spec is not None and spec.origin:
            status = os.stat(spec.origin)  # noqa: PTH116  pathlib is slow
            digest.update(
                f"{name} {spec.origin} {status.st_size} {status.st_mtime_ns}\0".encode("utf-8", "surrogatepass")
            )
    return digest.digest()


def _states(folder: str) -> Iterator[str]:
    """Yield a text for each source file below a folder: its path, size and time."""
    with os.scandir(folder) as entries:
        for entry in entries:
            if entry.name.endswith((".py", ".toml", ".so", ".pyd")):
                status = entry.stat()
                yield f"{entry.path} {status.st_size} {status.st_mtime_ns}"
            elif "." not in entry.name and entry.name != "__pycache__" and entry.is_dir():
                yield from _states(entry.path)
