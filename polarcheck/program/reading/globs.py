"""
Patterns of files, as job files have them: `O12*.nc`, `lathe7/**`.

A pattern without a slash is a name, of a file or of a folder, wherever it lies below the folder of the job file; one
with a slash begins at that folder. One that means a folder means all that lies in it. `*` and `?` stand for characters
of a name, `[0-9]` for one of some, `**` for any folders. Capitals make no difference, nor does which slash is written:
programs are named by controls, on file systems and by people that do not agree on either.
"""

from __future__ import annotations

import os
import re
from collections.abc import Iterator, Sequence

_WILD = re.compile(r"[*?\[]")
#: Of a [ that nothing closes, all up to the end is one piece: else each further [ would be searched to the end, too.
_PIECE = re.compile(r"\*+|\?|\[(!?)(\]?[^\]/]*+)\]|(\[[^\]/]*+\Z)|.", re.DOTALL)
_NOTHING: frozenset[int] = frozenset()


class Globs:
    """
    Some patterns, by their numbers, and the folder that they begin at. Which of them match is asked for by thousands
    of files: what their folders say is found once for each folder.

    base: a real path. patterns: all of which is_pattern is true.
    """

    def __init__(self, base: str, patterns: Sequence[str]) -> None:
        self._base = folded(base)
        self._names: dict[str, set[int]] = {}
        self._paths: dict[str, set[int]] = {}
        self._wild_names: list[tuple[re.Pattern[str], int]] = []
        self._wild_paths: list[tuple[re.Pattern[str], int]] = []
        self._folders_only: set[int] = set()
        self._of_folder: dict[str, frozenset[int]] = {}
        for number, pattern in enumerate(patterns):
            self._add(pattern, number)

    def __bool__(self) -> bool:
        return bool(self._names or self._paths or self._wild_names or self._wild_paths)

    def of_file(self, folder: str, name: str) -> frozenset[int]:
        """The numbers of the patterns that match a file, by itself or by a folder around it. folder: a real path."""
        return self.of_folder(folder) | self.itself(folder, name, is_folder=False)

    def of_folder(self, folder: str) -> frozenset[int]:
        """Return the numbers of patterns that match a folder or a folder around it, from the base on."""
        if folder in self._of_folder:
            return self._of_folder[folder]
        passed = []
        inner = folder
        while inner not in self._of_folder:
            outer, name = os.path.split(inner)
            if not name or f"{self._base.rstrip('/')}/".startswith(f"{folded(inner).rstrip('/')}/"):
                self._of_folder[inner] = _NOTHING
                break
            passed.append((outer, name, inner))
            inner = outer
        numbers = self._of_folder[inner]
        for outer, name, inner in reversed(passed):
            numbers = numbers | self.itself(outer, name, is_folder=True)
            self._of_folder[inner] = numbers
        return numbers

    def itself(self, folder: str, name: str, *, is_folder: bool) -> frozenset[int]:
        """Return the numbers of patterns that match an entry of a folder, whether or not the folder itself matches."""
        name_folded = folded(name)
        numbers: set[int] = set()
        numbers |= self._names.get(name_folded, numbers)
        numbers |= {number for pattern, number in self._wild_names if pattern.fullmatch(name_folded)}
        if self._paths or self._wild_paths:
            path = f"{folded(folder).rstrip('/')}/{name_folded}"
            numbers |= self._paths.get(path, numbers)
            numbers |= {number for pattern, number in self._wild_paths if pattern.fullmatch(path)}
        if numbers and not is_folder:
            numbers -= self._folders_only
        return frozenset(numbers)

    def _add(self, pattern: str, number: int) -> None:
        written = folded(pattern.replace("\\", "/"))
        text = written.rstrip("/")
        if written != text:
            self._folders_only.add(number)
        if "/" not in text and text not in (".", "..", "**"):
            if _WILD.search(text):
                self._wild_names.append((_compiled([text]), number))
            else:
                self._names.setdefault(text, set()).add(number)
            return
        parts = self._from_root(text)
        if any(map(_WILD.search, parts)):
            self._wild_paths.append((_compiled(parts), number))
        else:
            self._paths.setdefault("/".join(parts), set()).add(number)

    def _from_root(self, text: str) -> list[str]:
        """The parts of a pattern from the root on, what is said of the base as it stands and not as a pattern."""
        is_absolute = text.startswith("/") or re.match("[a-z]:/", text) is not None
        parts = [] if is_absolute else [_WILD.sub(lambda match: f"[{match[0]}]", part) for part in _split(self._base)]
        for part in _split(text):
            if part == ".." and parts:
                parts.pop()
            elif part != ".":
                parts.append(part)
        return parts


def is_pattern(text: str) -> bool:
    """Return True for a usable pattern. `!`, which elsewhere includes files again, and `[z-a]` are not."""
    if not text.strip("/\\ ") or text.startswith("!"):
        return False
    try:
        Globs("", [text])
    except re.error:
        return False
    return True


def folded(path: str) -> str:
    """A path as it is compared: with `/`, without capitals, its accents as one character each."""
    text = path if os.sep == "/" else path.replace(os.sep, "/")
    if text.isascii():
        return text.lower()
    import unicodedata

    return unicodedata.normalize("NFC", text).lower()


def _split(path: str) -> list[str]:
    """The parts of a path; the first is empty where it begins at the root."""
    first, *remaining = path.split("/")
    return [first, *(part for part in remaining if part)]


def _compiled(parts: Sequence[str]) -> re.Pattern[str]:
    """
    The expression of a pattern. What stands between two `**`, or two `*` of a name, is taken where it comes first, and
    never looked for again: whatever else is written, that costs no time without end.
    """
    runs: list[list[str]] = [[]]
    for part in parts:
        if part != "**":
            runs[-1].append(_of_name(part))
        elif runs[-1] or len(runs) == 1:
            runs.append([])
    first, *between, last = ["/".join(run) for run in runs] if len(runs) > 1 else ["", "/".join(runs[0])]
    text = f"{first}/" if first or (len(runs) > 1 and runs[0]) else ""
    text += "".join(f"(?>{_FOLDERS}?{inner}/)" for inner in between)
    if len(runs) > 1:
        text += f"{_FOLDERS}{last}" if last else ".+"
    else:
        text += last
    return re.compile(text, re.DOTALL)


_FOLDERS = "(?:[^/]*+/)*"


def _of_name(part: str) -> str:
    chunks = [""]
    for piece in _pieces(part):
        if piece[0].startswith("*"):
            chunks.append("")
        else:
            chunks[-1] += _translated(piece)
    first, *following = chunks
    if not following:
        return first
    *between, last = following
    return first + "".join(f"(?>[^/]*?{chunk})" for chunk in between) + f"[^/]*{last}"


def _pieces(part: str) -> Iterator[re.Match[str]]:
    """The stars, lists and other signs of a part; a [ that nothing closes stands for itself."""
    for piece in _PIECE.finditer(part):
        if piece[3]:
            yield from _PIECE.finditer(piece[3].replace("[", "[[]"))
        else:
            yield piece


def _translated(piece: re.Match[str]) -> str:
    """A sign or a list of signs that is no star."""
    if piece[0] == "?":
        return "[^/]"
    if piece[2]:
        # A sign that stands twice may be an operation on sets some day: Python warns of it.
        inside = re.sub(r"([\\\[\]^&~|])", r"\\\1", piece[2]).replace("--", r"-\-")
        return f"[{'^/' if piece[1] else ''}{inside}]"
    return re.escape(piece[0])
