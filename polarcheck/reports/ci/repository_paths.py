"""Paths as CI systems need them: from the root of the repository, whatever the working folder."""

from __future__ import annotations

import posixpath
import re
from typing import TYPE_CHECKING
from urllib.parse import quote

from polarcheck.program.reading.excerpt import visible
from polarcheck.program.reading.file_names import spelled, unspelled
from polarcheck.program.reading.files import STANDARD_INPUT

if TYPE_CHECKING:
    from polarcheck.reports import Background

_DRIVE = re.compile(r"[A-Za-z]:/")


def from_root(path: str, background: Background) -> str:
    """Return a path relative to the root of the repository, without `./`; absolute for a file outside it."""
    return path if path == STANDARD_INPUT else visible(spelled(_from_root(path, background)))


def uri(path: str, background: Background) -> str:
    """Return the same path as a URI: relative inside the repository, its bytes percent-encoded."""
    if path == STANDARD_INPUT:
        return path
    raw = _from_root(path, background)
    try:
        data = raw.encode("utf-8", "surrogateescape")
    except UnicodeEncodeError:  # unpaired surrogates, which Windows allows in names
        data = raw.encode("utf-8", "surrogatepass")
    if _DRIVE.match(raw):
        return f"file:///{raw[0]}:{quote(data[2:])}"
    return ("file://" if raw.startswith("/") else "") + quote(data)


def _from_root(path: str, background: Background) -> str:
    raw = unspelled(path)
    is_absolute = raw.startswith("/") or _DRIVE.match(raw)
    whole = posixpath.normpath(raw if is_absolute else posixpath.join(background.folder, raw))
    root = background.root.rstrip("/") + "/"
    if background.root and whole.startswith(root):
        return whole.removeprefix(root)
    return whole if is_absolute or whole.startswith("../") or _is_outside(raw) else posixpath.normpath(raw)


def _is_outside(raw: str) -> bool:
    return posixpath.normpath(raw).startswith("../")
