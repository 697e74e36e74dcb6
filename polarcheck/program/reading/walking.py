"""Which files of a folder are NC programs, and which others may be: a walk reads the first, and names the others."""

from __future__ import annotations

import itertools
import os
import re
import stat
from collections.abc import Callable, Collection, Iterable, Iterator
from pathlib import Path
from typing import Literal, NamedTuple

from polarcheck.program.reading.files import STANDARD_INPUT, display_path

EXTENSIONS = (
    *(".nc", ".ncc", ".cnc", ".tap", ".eia", ".min", ".mpf", ".spf", ".ngc", ".prg"),
    *(".ptp", ".dnc", ".fnc", ".iso", ".din", ".pim", ".gcode", ".gco", ".g"),
)
#: Further endings of NC programs and subprograms, which mean other things elsewhere, too.
_OTHERS = (
    ".sub .ssb .sbp .msb .lib .ncd .ncf .ncg .ncp .anc .cls .dat .fan .fgc .gc .gcd .gp .hnc .knc .mpr "
    ".mpt .out .p .pit .pm .prf .pu1 .pu2 .s .rol .tcn .tp .txt .xpi .arc .wpd .001 .002 .003 .bak .old"
)
_OTHER_EXTENSIONS = frozenset(_OTHERS.split())
#: Endings of what is never a program, though lines of a program may stand at its head: documents, data, code, copies.
_DOCUMENTS = (
    ".md .rst .adoc .tex .html .htm .xml .json .jsonl .toml .yml .yaml .ini .cfg .csv .tsv .sarif .log "
    ".py .pyc .js .ts .css .c .cpp .sh .bat .ps1 .pdf .png .jpg .jpeg .gif .bmp .svg .tif .tiff .webp "
    ".doc .docx .xls .xlsx .dxf .dwg .step .stp .stl .igs .iges .zip .gz .7z .tar .exe .dll .so .orig "
    ".rej .diff .patch .lock .db .ipynb .ambr"
)
_NO_PROGRAMS = frozenset(_DOCUMENTS.split())
_SKIPPED_FOLDERS = frozenset(("node_modules", "__pycache__"))
#: Folders of git and of polarcheck itself, which never hold programs.
_NO_WORD = frozenset((".git", ".polarcheck_cache"))
#: O1234, O0001(SB12 RG FRONT), O1234.bak: as controls and transfer programs name what they punch out; but no pages.
_O_NAME = r"(?i)O\d{2,8}(?:\([^)]*\))?(?:\.(?!orig$|html?$)[^.~]*)?"
#: O1234-REV, O0001_version1, 4711: a number of a program with more behind it.
_NUMBERED = r"(?i)O?\d{2,8}(?!\d).{0,100}"
_SNIFFED = frozenset(("", ".txt"))
_SNIFFED_BYTES, _MOST_SNIFFED_BYTES = 4096, 65536
_HEAD = r"%(?!PDF|!|%)|\$[\w-]{1,40}\.(?i:MIN|SUB|SSB|LIB|MSB)%|[O:]\s?\d{1,8}\b"
#: The same in a file whose ending says nothing: a % begins comments of other languages.
_STRICT_HEAD = (
    r"%\s*(?:\Z|[\r\n]|[O:]\s?\d{1,8}\b|_N_)|\$[\w-]{1,40}\.(?i:MIN|SUB|SSB|LIB|MSB)%|O\s?\d{2,8}\s*(?:\(|;|[\r\n]|\Z)"
)
_BLOCK = re.compile(r"(?i)/?\d?\s*(?:N\s?\d+\s*)?(?:[A-Z]\s?[-+]?(?:\d+(?:\.\d*)?|\.\d+)\s*)+(?:\([^)]*\)\s*)*;?")
_WITH_CODE = re.compile(r"(?i)[^(]*\b[GM]\d")
#: Of a line without blanks around it.
_COMMENT = re.compile(r"(?:\([^)]*+\)\s*+)++;?|;.*")
_BLOCKS_NEEDED, _LINES_LOOKED_AT = 2, 10
#: Entries of excluded folders that are counted; a folder is excluded because it is large, too.
_MOST_EXCLUDED = 50_000

Reason = Literal["ending", "excluded", "folder", "device", "offset table"]
#: Of a folder: the pattern that excludes a name in it, of a folder or not, and where it stands; empty for none. None
#: where nothing can be excluded.
ExcludedIn = Callable[[str], Callable[[str, bool], str] | None]


class Skipped(NamedTuple):
    """
    What a walk did not read.

    path: a file that may be a program by its look, or a folder.
    reason: why.
    by: the pattern that excludes it, and where it stands; else empty.
    programs: the number of programs, in an excluded folder.
    is_least: there may be more.
    """

    path: str
    reason: Reason
    by: str = ""
    programs: int = 1
    is_least: bool = False

    @property
    def ending(self) -> str:
        """Return the ending as it is written; empty without."""
        return os.path.splitext(self.path)[1]  # noqa: PTH122  Path.suffix differs for names that end in a point


def extensions(names: Iterable[str]) -> list[str]:
    """Extensions as they are compared: lower case, with the point."""
    return [f".{name.strip().lower().lstrip('.')}" for name in names if name.strip(" .")]


def walk(
    folder: str,
    endings_of: Collection[str] | Callable[[str], Collection[str]],
    failed: Callable[[str], None],
    excluded_in: ExcludedIn | None = None,
    skipped: Callable[[Skipped], None] | None = None,
) -> Iterator[str]:
    """
    The programs below a folder, in order of their names, as paths that begin with the folder as it is given.

    Hidden files and folders are passed over; a folder that links lead to twice is entered once.

    endings_of: the extensions, or a function for those of a folder.
    failed: is told, in one line, of folders that cannot be read.
    excluded_in: says of a folder what of it is passed over.
    skipped: is told of each file that may be a program by its look and is not read, and of each folder not entered.
    """
    entered = _Entered()
    excluded = _Excluded()
    # Folders can be nested deeper than functions: the innermost one stands at the end.
    stack = [_entries(folder, entered, failed, excluded_in)]
    endings = [endings_of(folder) if callable(endings_of) else endings_of]
    while stack:
        entry, by = next(stack[-1], _END)
        if entry is None:
            stack.pop()
            endings.pop()
            continue
        path = entry.path if folder != "." else entry.path.removeprefix(f".{os.sep}")
        is_folder = _is_folder(entry)
        if entry.name.startswith(".") or entry.name in _SKIPPED_FOLDERS:
            if skipped is not None and is_folder and entry.name not in _NO_WORD:
                skipped(Skipped(path, "folder", programs=0))
        elif by:
            if skipped is not None:
                excluded.tell(path, by, endings[-1], skipped, is_folder=is_folder)
        elif is_folder:
            stack.append(_entries(path, entered, failed, excluded_in))
            endings.append(endings_of(path) if callable(endings_of) else endings_of)
        elif is_program(path, endings[-1]):
            yield path if path != STANDARD_INPUT else entry.path
        elif skipped is not None and may_be_program(path, endings[-1]):
            skipped(Skipped(path, "device" if _is_special(path) else "ending"))


_Entries = Iterator[tuple[os.DirEntry[str] | None, str]]
_END: tuple[None, str] = (None, "")


class _Entered:
    """Folders that were entered, by what they are; links can lead to one of them twice."""

    def __init__(self) -> None:
        self._seen: set[tuple[int, int] | str] = set()

    def is_new(self, folder: str) -> bool:
        """Return True at the first call for a folder. Raises OSError where it cannot be looked at."""
        status = Path(folder).stat()
        # Some network drives of Windows number nothing: there all folders would be one.
        identity = (status.st_dev, status.st_ino) if status.st_ino else os.path.realpath(folder)
        if identity in self._seen:
            return False
        self._seen.add(identity)
        return True


def _entries(folder: str, entered: _Entered, failed: Callable[[str], None], excluded_in: ExcludedIn | None) -> _Entries:
    """
    Return the entries of a folder by name, each with the pattern that excludes it, or with an empty text.

    There are none if it was entered before or cannot be read.
    """
    try:
        entries = _by_name(folder) if entered.is_new(folder) else []
    except OSError as error:
        failed(f"{display_path(folder)}: {error.strerror}")
        return iter(())
    excluded_by = excluded_in(folder) if excluded_in is not None and entries else None
    if excluded_by is None:
        return ((entry, "") for entry in entries)
    return ((entry, excluded_by(entry.name, _is_folder(entry))) for entry in entries)


def _by_name(folder: str) -> list[os.DirEntry[str]]:
    with os.scandir(folder) as entries:
        return sorted(entries, key=lambda entry: entry.name)


class _Excluded:
    """Counts the programs that patterns exclude, up to a bound of entries."""

    def __init__(self) -> None:
        self._entered, self._left = _Entered(), _MOST_EXCLUDED

    def tell(
        self, path: str, by: str, endings: Collection[str], skipped: Callable[[Skipped], None], *, is_folder: bool
    ) -> None:
        """Tell of a file that may be a program, or of a folder with the number of its programs."""
        if is_folder:
            skipped(Skipped(path, "excluded", by, self._count(path, endings), is_least=self._left <= 0))
        elif may_be_program(path, endings):
            skipped(Skipped(path, "excluded", by))

    def _count(self, folder: str, endings: Collection[str]) -> int:
        """Return the number of programs in an excluded folder; what is hidden and what cannot be read has none."""
        count, folders = 0, [folder]
        while folders and self._left > 0:
            inner = folders.pop()
            try:
                entries = _by_name(inner) if self._entered.is_new(inner) else []
            except OSError:
                continue
            self._left -= len(entries)
            for entry in entries:
                if entry.name.startswith(".") or entry.name in _SKIPPED_FOLDERS:
                    continue
                if _is_folder(entry):
                    folders.append(entry.path)
                else:
                    count += is_program(entry.path, endings)
        return count


def _is_folder(entry: os.DirEntry[str]) -> bool:
    try:
        return entry.is_dir()
    except OSError:
        return False


def is_program(path: str, endings: Collection[str]) -> bool:
    """Return True if a file of a folder is an NC program, by its extension, its name, or its first lines."""
    if has_name_of_program(path, endings):
        return not _is_special(path)
    return _suffix(path) in _SNIFFED and not _is_special(path) and _looks_like_program(path)


def has_name_of_program(path: str, endings: Collection[str]) -> bool:
    """Return True for the name of an NC program: one of these extensions, or an O-number."""
    return _suffix(path) in endings or re.fullmatch(_O_NAME, Path(path).name) is not None


def is_by_look(path: str) -> bool:
    """Return True for a program that a folder has by its first lines alone: its name may be that of anything."""
    return _suffix(path) in _SNIFFED and not has_name_of_program(path, ())


def may_be_program(path: str, endings: Collection[str]) -> bool:
    """Return True for a program, and for a file that may be one by its name and first lines, whatever its ending."""
    if has_name_of_program(path, endings):
        return True
    suffix, name = _suffix(path), Path(path).name
    if suffix in _NO_PROGRAMS or name.endswith("~") or _is_special(path):
        return False
    text = _head(path)
    if suffix in _SNIFFED and _reads_as_program(text, _HEAD):
        return True
    if suffix in EXTENSIONS or suffix in _OTHER_EXTENSIONS or re.fullmatch(_NUMBERED, name):
        return _reads_as_program(text, _STRICT_HEAD, blocks_needed=1, with_code=True)
    return bool(suffix) and _reads_as_program(text, _STRICT_HEAD, with_code=True)


def is_known_ending(ending: str) -> bool:
    """Return True for an ending that speaks for an NC program, so that no name need explain it."""
    return ending.lower() in EXTENSIONS or ending.lower() in _OTHER_EXTENSIONS


def _suffix(path: str) -> str:
    return os.path.splitext(path)[1].lower()  # noqa: PTH122  Path.suffix differs for names that end in a point


def _is_special(path: str) -> bool:
    """A pipe or device, which would be read for ever. A broken link is not: that it cannot be read must be said."""
    try:
        return not stat.S_ISREG(Path(path).stat().st_mode)
    except OSError:
        return False


def _looks_like_program(path: str) -> bool:
    return _reads_as_program(_head(path), _HEAD)


def _reads_as_program(text: str, head: str, blocks_needed: int = _BLOCKS_NEEDED, *, with_code: bool = False) -> bool:
    """
    Return True if a text begins as a program does, or has so many blocks in its first lines that are no comments.

    with_code: one of these blocks has a G or M word.
    """
    if re.match(head, text):
        return True
    lines = (line.strip("\0\r \t") for line in text.split("\n"))
    first = itertools.islice((line for line in lines if not _COMMENT.fullmatch(line)), _LINES_LOOKED_AT)
    blocks = [line for line in first if _BLOCK.fullmatch(line)]
    return len(blocks) >= blocks_needed and (not with_code or any(map(_WITH_CODE.match, blocks)))


def _head(path: str) -> str:
    """Return the first bytes of a file as text, more of them where all of these are comments; empty if unreadable."""
    try:
        with open(path, "rb", opener=_not_waiting) as file:
            data = file.read(_SNIFFED_BYTES) or b""
            if data.lstrip(b"\xef\xbb\xbf\0 \t\r\n")[:1] in (b"(", b";") and len(data) == _SNIFFED_BYTES:
                data += file.read(_MOST_SNIFFED_BYTES - _SNIFFED_BYTES) or b""
    except OSError:
        return ""
    wide = data.startswith((b"\xff\xfe", b"\xfe\xff"))
    return data.decode("utf-16" if wide else "latin-1", "replace").lstrip("\ufeff\xef\xbb\xbf\0\x11\x12\x13\x14 \t\r\n")


def _not_waiting(path: str, flags: int) -> int:
    """Open what may have become a pipe since it was looked at."""
    return os.open(path, flags | getattr(os, "O_NONBLOCK", 0))
