"""The offset table of a control: in G10 blocks, as tool data, or its page copied as text."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any, Literal

from polarcheck.foundation import bounded
from polarcheck.foundation.errors import JobError
from polarcheck.program.machines import offset_page, tool_data
from polarcheck.program.machines.job import PunchedTool, Tool
from polarcheck.program.machines.offset_page import Entry, NotUnderstoodError, short
from polarcheck.program.machines.value_types import MisfitError, fitted

#: A table of 10,000 offsets has half a megabyte [bytes].
_LARGEST = 16_000_000
_COMMENT = re.compile(r"\([^)\n]*+\)?")
_IS_PUNCHED = re.compile(r"G0*+10(?!\d)")
# A block ends with its line, or where the next one begins; CR is a line end, too, where a transfer took the LF.
_BLOCK_END = re.compile(r"[\n\r;]|(?<=[^\s\n])[^\S\n\r]*+(?=G0*+10(?!\d))")
_WORD = re.compile(r"\s*+([A-Z])\s*+([-+]?(?:\d++\.?\d*+|\.\d++))")
#: What may stand around the blocks: the frame of a program, sequence numbers, absolute input, data input ended.
_FRAME = re.compile(r"\s*+(?:%.*|[O:]\s*+\d++.*|(?:N\s*+\d++\s*+)?(?:(?:M0*+(?:2|30|99)|G0*+(?:11|90))(?!\d)\s*+)*)")
_UNITS = re.compile(r"\s*+(?:N\s*+\d++\s*+)?G(2[01])(?!\d)\s*+")
_DIGITS = 8
_SHOWN = 40
#: P10001 is the geometry of offset 1, P1 its wear (B-63524EN/01 p. 285).
_GEOMETRY = 10000
#: By L: geometry or wear of a lathe's offset or, beside those of radii, of a length; of radii alone; others are none.
_OF_LATHE = {10: True, 11: False, 1: False}
_OF_RADII = {12: True, 13: False}
_WORK_OFFSETS = (2, 20)
_EXPECTED = "expected a block such as G10 P10008 R0.375 Q0"

Units = Literal["mm", "inch"]


def read_offset_table(path: Path, title: str, *, pipes: bool = False, units: Units | None = None) -> dict[str, Tool]:
    """
    The offsets of a table by offset number; R of geometry and wear are added, X of the wear is kept by itself.

    A table is what the control punches out (`G10 P10008 X.. Z.. R.. Q..`, `G10 L12 P8 R..`, `$TC_DP6[8,1]=..`), or its
    page as text: number, X, Z, R and T in columns. Lengths are in the units of the table. units: which these are said
    to be, where the table names its own. pipes: whether it may be a pipe, as a shell hands over `<(...)`. Raises
    JobError, which names the title, for a file that cannot be read or holds no offset, and the line for what cannot be
    understood.
    """
    try:
        data = bounded.read_file(path, _LARGEST, "no offset table is", pipes=pipes)
        text = bounded.decoded(data, "latin-1").replace("\0", "").upper()
    except OSError as error:
        raise JobError(f"{title}: {error.strerror}") from None
    except ValueError as error:
        raise JobError(f"{title}: {error}") from None
    plain = _COMMENT.sub(" ", text)
    entries: list[Entry] = []
    problem: NotUnderstoodError | None = None
    try:
        for entry in _entries(text, plain, units):
            entries.append(entry)
    except NotUnderstoodError as error:
        problem = error
    if problem is not None and (entries or problem.is_certain):
        raise JobError(f"{title}:{problem.line}: {problem}")
    if not entries:
        raise JobError(
            f"{title}: no offsets found; expected blocks such as G10 P10008 R0.375 Q0, or columns NO. X Z R T,"
            " or tool data such as $TC_DP6[8,1]=4.0"
        )
    return _tools(entries, title)


def _entries(text: str, plain: str, units: Units | None) -> Iterator[Entry]:
    if tool_data.IS_TOOL_DATA.search(text):
        return tool_data.entries(text)
    return _punched(plain, units) if _IS_PUNCHED.search(plain) else offset_page.entries(text)


def _punched(text: str, units: Units | None) -> Iterator[Entry]:
    """Yield the values that G10 blocks set. Raises NotUnderstoodError for any other block."""
    words: list[tuple[int, str, dict[str, str]]] = []
    problem: NotUnderstoodError | None = None
    for line, block in _blocks(text):
        try:
            if _IS_PUNCHED.search(block) is None:
                _check_other(line, block, units)
            else:
                words.append((line, block, _words(line, block)))
        except NotUnderstoodError as error:
            problem = problem or error
    has_radii = any(_number(letters.get("L")) in _OF_RADII for _, _, letters in words)
    for line, block, letters in words:
        if problem is not None and problem.line < line:
            break
        yield from _of_block(line, block, letters, has_radii)
    if problem is not None:
        raise problem


def _blocks(text: str) -> Iterator[tuple[int, str]]:
    """The blocks with the numbers of their lines."""
    ends = "\n" if "\n" in text else "\r"
    start, line = 0, 1
    for match in _BLOCK_END.finditer(text):
        block = text[start : match.start()]
        if block.strip():
            yield line, block
        line += text.count(ends, start, match.end())
        start = match.end()
    if text[start:].strip("\x1a \t"):
        yield line, text[start:]


def _check_other(line: int, block: str, units: Units | None) -> None:
    """Raises NotUnderstoodError for what is neither the frame of a program nor units that are said elsewhere."""
    said = _UNITS.fullmatch(block)
    if said:
        declared = "inch" if said[1] == "20" else "mm"
        if units != declared:
            raise NotUnderstoodError(
                line, f'G{said[1]}: the table is in {declared}; give units = "{declared}" beside offsets', True
            )
    elif _FRAME.fullmatch(block.strip("\x1a")) is None:
        raise NotUnderstoodError(line, f"{_EXPECTED}, found {short(block)}")


def _words(line: int, block: str) -> dict[str, str]:
    """
    The words of a block by address, the last of each; G10, G90 and N left out.

    Raises NotUnderstoodError where something else is there.
    """
    words: dict[str, str] = {}
    end = 0
    while match := _WORD.match(block, end):
        if match[1] == "G" and float(match[2]) not in (10, 90):
            break
        if match[1] != "G":
            words[match[1]] = match[2]
        end = match.end()
    words.pop("N", None)
    if block[end:].strip("\x1a \t/"):
        raise NotUnderstoodError(line, f"{_EXPECTED}, found {short(block)}")
    return words


def _of_block(line: int, block: str, words: dict[str, str], has_radii: bool) -> Iterator[Entry]:
    kind = _number(words.get("L"))
    if kind in _WORK_OFFSETS:
        return
    if "P" not in words or "C" in words or kind not in (None, *_OF_LATHE, *_OF_RADII):
        why = "L" if kind is not None and "P" in words and "C" not in words else "C" if "C" in words else "P"
        said = {
            "L": "L is known of 1, 2, 10 to 13 and 20",
            "C": "C changes R by a step, and R before it is not known",
            "P": "P, the number of the offset, is missing",
        }
        raise NotUnderstoodError(line, f"{said[why]}: {short(block)}", True)
    written = words["P"].partition(".")[0].lstrip("+0")
    if not written.isdecimal() and written:
        raise NotUnderstoodError(line, f"P{short(words['P'])} is no number of an offset", True)
    if len(written) > _DIGITS:
        raise NotUnderstoodError(line, f"P{written[:_SHOWN]}... is no number of an offset", True)
    above, number = divmod(int(written or 0), _GEOMETRY)
    is_geometry = bool(above) if kind is None else {**_OF_LATHE, **_OF_RADII}[kind]
    if not number or (has_radii and kind in _OF_LATHE):
        return  # of the work shift, or of lengths
    for address, key in (("R", "radius"), ("X", "x"), ("Q", "nose")):
        if address in words:
            yield Entry(line, str(number), is_geometry, key, float(words[address]))


def _number(written: str | None) -> int | None:
    return None if written is None else int(float(written)) if len(written) <= _DIGITS else -1


def _tools(entries: Iterable[Entry], title: str) -> dict[str, Tool]:
    """The offsets of all entries; of two for the same value the last counts."""
    given: dict[str, dict[str, dict[bool, float]]] = {}
    lines: dict[str, int] = {}
    for entry in entries:
        given.setdefault(entry.offset, {}).setdefault(entry.key, {})[entry.is_geometry] = entry.value
        lines[entry.offset] = entry.line
    tools: dict[str, Tool] = {}
    for offset, keys in sorted(given.items(), key=lambda item: (len(item[0]), item[0])):
        if "radius" not in keys and "nose" not in keys:
            continue
        table: dict[str, Any] = {}
        if "radius" in keys:
            table["radius"] = sum(keys["radius"].values())
        if "nose" in keys:
            nose = keys["nose"].get(True, keys["nose"].get(False, 0.0))
            # The control writes T with a point; what is too large stays as it is, for the message.
            table["nose"] = int(nose) if abs(nose) < _GEOMETRY and nose == int(nose) else nose
        x_wear = keys.get("x", {}).get(False)
        # Wear is small: what is not is where a tool has been touched off, be it in least increments.
        if x_wear is not None and abs(x_wear) < offset_page.LARGEST_WEAR:
            table["x_wear"] = x_wear
        try:
            tools[offset] = fitted(table, PunchedTool)
        except MisfitError as misfit:
            raise JobError(f"{title}:{lines[offset]}: offset {offset}: {misfit}") from None
    if not tools:
        raise JobError(f"{title}: no offsets found; X and Z alone say nothing of R and T")
    return tools
