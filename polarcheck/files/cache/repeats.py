"""
Whole runs of `check` that are repeated: what they printed is printed again, before anything large is imported.

A run is repeated if its command line, working folder, environment, streams, Python and the code are the same, and each
file and folder that it read, listed or looked for is as it was, by content. Whatever is in doubt is run.
"""

from __future__ import annotations

import marshal
import os
import stat
import sys
from collections.abc import Iterator, Sequence
from typing import Any

from polarcheck.files.cache.code_digest import code_digest
from polarcheck.files.cache.store import NAME, Store, folder_key, user_key
from polarcheck.foundation import record
from polarcheck.foundation.digest import blake2b

#: Bytes of a digest.
_SIZE = 16
#: The only command that is repeated.
_COMMAND = "check"
_OPTION, _VARIABLE = "--cache-dir", "POLARCHECK_CACHE_DIR"
#: Variables that shells set anew for each command.
_OF_SHELLS = ("_", "OLDPWD", "SHLVL")

#: True for standard error, and what was written to it at once.
Piece = tuple[bool, str | bytes]


class _Run:
    """
    The run of this process.

    pieces: what it has printed.
    """

    def __init__(self, words: Sequence[str]) -> None:
        """words: of the command line. Raises OSError."""
        self.words = words
        self.key = _digest([words, os.getcwd(), _environment(), _streams(), _python()])  # noqa: PTH109  pathlib is slow
        self.pieces: list[Piece] = []

    def store(self) -> Store | None:
        """Return the cache that has something of this version of the code, the nearest one; None without any."""
        named = _named_folder(self.words)
        for folder in [named] if named else _folders(self.words):
            if os.path.isdir(folder):  # noqa: PTH112  pathlib is slow
                store = Store(folder, code_digest(), b"", links=bool(named))
                if store.is_own_folder():
                    key = folder_key(named) if named else user_key()
                    return Store(folder, code_digest(), key, links=bool(named)) if key else None
        return None


_run: _Run | None = None


def find(words: Sequence[str]) -> tuple[int, list[Piece]] | None:
    """
    Return the exit code of the same run, and what it has printed.

    Return None if the command has to run; what it prints is noted from then on. words: of the command line.
    """
    global _run
    if words[:1] != [_COMMAND] or any(word.startswith("-") and os.path.lexists(word) for word in words):
        return None
    try:
        _run = _Run(words)
        store = _run.store()
        data = None if store is None else store.run(_run.key)
        if data is None:
            return None
        status, pieces, states = marshal.loads(data)  # noqa: S302  the file has the seal of the user
        return (status, pieces) if all(_state(path) == state for path, state in states) else None
    except (AttributeError, ImportError, OSError, ValueError):
        return None


def is_noting() -> bool:
    """Return True if this run may be kept."""
    return _run is not None


def note(text: str | bytes, *, to_error: bool) -> None:
    """Note what is printed."""
    if _run is not None:
        _run.pieces.append((to_error, text))


def drop() -> None:
    """Keep nothing of this run."""
    global _run
    _run = None


def keep(status: int) -> None:
    """Keep the run that ends now, unless something of what it has read changed meanwhile. status: the exit code."""
    read = record.current()
    if _run is None or read is None or read.seen is None:
        return
    try:
        states = [(path, _state(path)) for path in read.paths]
        for path in read.paths:
            if record.unchanged(path, read.seen[os.path.abspath(path)]) is None:  # noqa: PTH100  pathlib is slow
                return
        store = _run.store()
        if store is not None:
            store.put_run(_run.key, marshal.dumps((status, _run.pieces, states)))
    except (KeyError, OSError, ValueError):
        return


def _digest(value: Any) -> bytes:
    return blake2b(repr(value).encode("utf-8", "surrogatepass"), digest_size=_SIZE).digest()


def _environment() -> list[tuple[str, str]]:
    return sorted((name, value) for name, value in os.environ.items() if name not in _OF_SHELLS)


def _python() -> list[Any]:
    return [sys.version, sys.executable, tuple(sys.flags), sys.path]


def _streams() -> list[Any]:
    """Return what a report depends on of standard output and standard error. Raises OSError where it is not known."""
    values: list[Any] = []
    for stream in (sys.stdout, sys.stderr):
        is_terminal = stream.isatty()
        if is_terminal and os.name == "nt":
            raise OSError("a console has its own encoding")
        values += [stream.encoding, is_terminal and tuple(os.get_terminal_size(stream.fileno()))]
    return values


def _named_folder(words: Sequence[str]) -> str:
    """Return the folder of the cache that the command line names, or the environment; empty for none."""
    named = os.environ.get(_VARIABLE, "")
    for number, word in enumerate(words):
        if word == "--":
            break
        if word.startswith(f"{_OPTION}="):
            named = word.partition("=")[2]
        elif word == _OPTION:
            named = "".join(words[number + 1 : number + 2])
    return named


def _folders(words: Sequence[str]) -> Iterator[str]:
    """Yield where the cache may lie: in the working folder, and from the first file that is named upwards."""
    yield NAME
    folder = os.path.abspath(next((word for word in words[1:] if os.path.isfile(word)), os.curdir))  # noqa: PTH100, PTH113
    while (outer := os.path.dirname(folder)) != folder:  # noqa: PTH120
        folder = outer
        yield os.path.join(folder, NAME)  # noqa: PTH118


def _state(path: str) -> tuple[str, bytes] | None:
    """
    Return the place of a file or folder, with all links resolved, and the digest of its content or of its names.

    None if there is none. Raises OSError for what is neither, or cannot be read.
    """
    if not os.path.lexists(path):
        return None
    real = os.path.realpath(path)
    mode = os.stat(real).st_mode  # noqa: PTH116  pathlib is slow
    if stat.S_ISDIR(mode):
        return real, _digest(sorted(os.listdir(real)))  # noqa: PTH208
    if not stat.S_ISREG(mode):
        raise OSError("neither a file nor a folder")
    with open(real, "rb") as file:  # noqa: PTH123
        return real, record.digest(file.read())
