"""
The tool page of a control, copied as text: a line for each offset, with its number, X, Z, R and T in columns.

    OFFSET / GEOMETRY
    NO.       X         Z        R    T
    G 001   -110.250  -55.000   0.800  3

Columns are parted by blanks, tabs, semicolons or commas. A line with their names may stand before them; else they are
in this order. G and W before a number, or a title, tell geometry from wear.
"""

from __future__ import annotations

import re
from collections.abc import Iterator

import msgspec

#: X of no wear, whatever its unit.
LARGEST_WEAR = 100.0
_SHOWN = 40
#: In this order where no line names them; Y may be left out, and what stands at the end.
_USUAL = ("number", "x", "z", "radius", "nose")
#: The names of columns, without signs: as pages of several controls have them.
_NAMES = {
    **dict.fromkeys(("NO", "N", "NR", "NUM", "NUMBER", "OFFSET", "OFFSETNO", "TOOL", "TOOLNO", "#", "D"), "number"),
    **dict.fromkeys(("X", "XAXIS", "XAXISM"), "x"),
    **dict.fromkeys(("Z", "ZAXIS", "ZAXISM"), "z"),
    **dict.fromkeys(("Y", "YAXIS", "C", "CAXIS", "H", "LENGTH", "COMMENT", "NAME"), "other"),
    **dict.fromkeys(("R", "RADIUS", "NOSER", "NOSERADIUS", "TIPR", "TIPRADIUS", "CUTTERRADIUS"), "radius"),
    **dict.fromkeys(("T", "TIP", "Q", "NOSE", "NOSETYPE", "TIPDIR", "TIPDIRECTION", "DIRECTION"), "nose"),
}
_OFFSET = re.compile(r"([GW]?)[-_ ]?0*+(\d{1,8})\.?")
_NUMBER = re.compile(r"[-+]?(?:\d{1,15}[.,]?\d{0,15}|[.,]\d{1,15})")
#: Below the offsets a page shows where the axes are.
_END = ("ACTUAL POSITION", "RELATIVE", "ABSOLUTE")
#: A page has lines of this length at most [characters].
_LONGEST = 1000


class Entry(msgspec.Struct, frozen=True):
    """A value of an offset, by its key: radius, nose or x, of the geometry or of the wear; and its line."""

    line: int
    offset: str
    is_geometry: bool
    key: str
    value: float


class NotUnderstoodError(Exception):
    """A line that nobody understands. is_certain: of a table that is one, whatever else stands in it."""

    def __init__(self, line: int, text: str, is_certain: bool = False) -> None:
        super().__init__(text)
        self.line, self.is_certain = line, is_certain


def entries(text: str) -> Iterator[Entry]:
    """The values of a page in capitals. Raises NotUnderstoodError for a line among the offsets that is none."""
    columns: list[str] | None = None
    is_wear = began = False
    lines = text.split("\n") if "\n" in text else text.split("\r")
    for number, line in enumerate(lines, 1):
        cells = _cells(line[:_LONGEST].strip("\r\x1a% \t"))
        if not cells:
            continue
        if line.strip().startswith(_END):
            return
        named = _columns(cells)
        if named is not None:
            columns = named
        elif _OFFSET.fullmatch(cells[0]) is not None and (len(cells) > 1):
            began = True
            yield from _of_line(number, line, cells, columns, is_wear)
        elif "WEAR" in line or "GEOM" in line:
            is_wear = "WEAR" in line
        elif began:
            raise NotUnderstoodError(number, f"expected an offset in columns ({_order(columns)}), found {short(line)}")


def _cells(line: str) -> list[str]:
    """The cells of a line; the letter before a number belongs to it."""
    if ";" in line or "\t" in line:
        cells = re.split(r"[;\t]", line)
    elif re.search(r",\s", line) or not re.search(r"\S\s+\S", line):
        cells = line.split(",")
    else:
        cells = line.split()
    cells = [cell.strip().strip("\"'") for cell in cells]
    while cells and not cells[-1]:
        cells.pop()
    if len(cells) > 1 and cells[0] in ("G", "W"):
        cells[:2] = [f"{cells[0]} {cells[1]}"]
    return cells


def _columns(cells: list[str]) -> list[str] | None:
    """Return the columns if the cells name them; None for another line."""
    names = [_NAMES.get(re.sub(r"[^A-Z#]", "", cell), "") for cell in cells]
    return names if "radius" in names and not any(map(_NUMBER.fullmatch, cells)) else None


def _of_line(line: int, text: str, cells: list[str], columns: list[str] | None, is_wear: bool) -> Iterator[Entry]:
    names = columns or list(_USUAL)
    if "number" not in names:
        names = ["number", *names]
    if len(cells) > len(names) or names.count("radius") > 1 or (columns is None and len(cells) < len(_USUAL) - 1):
        said = "two columns are R" if names.count("radius") > 1 else f"expected {_order(columns)}"
        is_certain = columns is not None or len(cells) >= len(_USUAL) - 1
        raise NotUnderstoodError(line, f"{said}, found {short(text)}", is_certain)
    given = dict(zip(names, cells, strict=False))
    match = _OFFSET.fullmatch(given["number"])
    if match is None:
        raise NotUnderstoodError(line, f"expected the number of an offset, found {short(given['number'])}")
    is_geometry = match[1] == "G" or (not match[1] and not is_wear)
    for key in ("radius", "nose", "x"):
        written = given.get(key, "")
        if not written or not int(match[2]):
            continue
        if _NUMBER.fullmatch(written) is None:
            raise NotUnderstoodError(line, f"expected a number as {_TITLES[key]}, found {short(written)}")
        yield Entry(line, str(int(match[2])), is_geometry, key, float(written.replace(",", ".")))


_TITLES = {"number": "NO.", "x": "X", "z": "Z", "radius": "R", "nose": "T", "other": "...", "": "..."}


def _order(columns: list[str] | None) -> str:
    return " ".join(_TITLES[name] for name in columns or _USUAL)


def short(line: str) -> str:
    """What a message shows of a line."""
    text = " ".join(line[: 4 * _SHOWN].split())
    return text if len(text) <= _SHOWN else f"{text[:_SHOWN]}..."
