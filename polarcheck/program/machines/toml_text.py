"""TOML that nobody vouches for: job files, machine files and values of options, within bounds that are named."""

from __future__ import annotations

import re
from collections.abc import Iterator
from os import PathLike
from typing import Any

from polarcheck.foundation import bounded
from polarcheck.foundation.patterns import lazy_pattern

#: Of a job file or machine file, which have some kB [bytes].
LARGEST = 1_000_000
#: Levels of tables and lists, and parts of a key with points: no file of ours has more than four.
_LEVELS = 12
#: Digits of a whole number; TOML itself ends at 2**63.
_DIGITS = 18
_LARGEST_NUMBER = 10**_DIGITS
_TOO_LONG = f"a whole number has at most {_DIGITS} digits"
_SHOWN = 40

_STRING_OR_COMMENT = lazy_pattern(
    r'"""(?:[^\\]|\\.)*?(?:"""|\\?\Z)' + r"|'''.*?(?:'''|\Z)" + r'|"(?:[^"\\\n]|\\.)*+"?' + r"|'[^'\n]*+'?|#[^\n]*+",
    re.DOTALL,
)
# tomllib takes time and memory by the square of the parts. Nothing here goes back, which would cost the same.
_LONG_KEY = lazy_pattern(rf"(?<![\w-])[\w-]++(?:[ \t]*+\.[ \t]*+[\w-]++){{{_LEVELS}}}", re.ASCII)
_LONG_NUMBER = lazy_pattern(r"(?<![\d_])\d[\d_]{1000,}+")

#: 3401#0, the bit of a parameter, as a key without quotes.
_BIT = r"^[ \t]*+(\w{1,20}#\w{1,20})[ \t]*+="

_UNIT = r"[ \t]*+((?:mm|deg|1)/min|mm|inches|inch|in|deg|°|\"|''|[”″])?[ \t]*+"
#: 1,5 for 1.5, be it with a unit behind it.
_COMMA = lazy_pattern(rf"=[ \t]*+([-+]?)(\d{{0,9}}+),(\d{{1,9}}+){_UNIT}(?:#.*)?$", re.IGNORECASE)
#: .5, 4., 08, 3/16 and 1 3/16 as a value, be it with a unit behind it.
_NUMBER = lazy_pattern(
    r"[=\[,][ \t]*+([-+]?)(?:(?:(\d{1,9})[ \t-]+)?(\d{1,9})[ \t]*+/[ \t]*+(\d{1,9})|(\d{0,9})\.?(\d{0,9}))"
    rf"{_UNIT}(?=[,\]}}#]|$)",
    re.IGNORECASE,
)
#: M35 without quotes.
_UNQUOTED = lazy_pattern(r"[=\[,][ \t]*+([A-Za-z][\w.-]{0,20}+)[ \t]*+(?:[,\]#]|$)")

#: A key without its value, as a commented line of a written file is when only its # was taken away.
_BARE = lazy_pattern(r"[ \t]*+([\w.-]{1,40}+)[ \t]*+=[ \t]*+(?:#.*)?$")


def read_toml(path: str | PathLike[str], what: str, *, pipes: bool = False) -> dict[str, Any]:
    """
    The table of a file. what: `job file`, for the message. pipes: whether it may be a pipe.

    Raises ValueError, which says in one line what is wrong, but not with which file.
    """
    return parsed(text_of(path, what, pipes=pipes))


def text_of(path: str | PathLike[str], what: str, *, pipes: bool = False) -> str:
    """
    The text of a file in any encoding of an editor; lines end with LF. Arguments and errors as of read_toml.
    """
    try:
        data = bounded.read_file(path, LARGEST, f"no {what} is", pipes=pipes)
    except OSError as error:
        raise ValueError(error.strerror or str(error)) from None
    return bounded.decoded(data).replace("\r\n", "\n")


def parsed(text: str) -> dict[str, Any]:
    """
    The table of a text, not nested deeper and without longer numbers than anybody means.

    Raises ValueError, which says in one line what is wrong.
    """
    import tomllib

    long_key = _LONG_KEY.search(_STRING_OR_COMMENT.sub(_blank, text))
    if long_key:
        raise ValueError(f"a key has more than {_LEVELS} parts: {long_key[0][:_SHOWN]}...")
    try:
        table = tomllib.loads(text)
    except RecursionError:
        raise ValueError(_too_deep("")) from None
    except tomllib.TOMLDecodeError as error:
        raise ValueError(f"{error}{_hint(text, str(error))}") from None
    except ValueError as error:  # a number that Python does not read: its own text means nothing to a setter
        raise ValueError(_long_number(text) or str(error)) from None
    for key, value, level in _values(table):
        if level > _LEVELS:
            raise ValueError(_too_deep(key))
        if isinstance(value, int) and abs(value) >= _LARGEST_NUMBER:
            raise ValueError(f"{key}: {_TOO_LONG}")
    return table


def _hint(text: str, said: str) -> str:
    """What to write in the line at fault."""
    if "'\\'" in said:
        return "; write / between folders, or the text in single quotes"
    number = re.search(r"\bline (\d+)", said)
    line = text.split("\n")[min(int(number[1]), text.count("\n") + 1) - 1] if number else ""
    if "twice" in said or "overwrite" in said:
        key = line.partition("=")[0].strip("[] \t")
        return f"; {key[:_SHOWN]} stands above, too: keep one of both"
    if bit := re.match(_BIT, line):
        return f'; write "{bit[1]}" in quotes: # begins a comment'
    if bare := _BARE.match(line):
        return f'; "{bare[1]}" has no value behind the =: write one, or # before the line'
    if written := _written_number(line):
        return f"; write {written}"
    if code := _UNQUOTED.search(line):
        return f'; write "{code[1]}", in quotes'
    return ""


def number_hint(text: str) -> str:
    """`; write 0.5` for a text that was given as a number; empty if it is none."""
    is_quoted = re.fullmatch(r"[-+]?\d{1,9}(?:\.\d{1,9})?", text.strip())
    written = _written_number(f"= {text}") or (f"{text.strip()}, without quotes" if is_quoted else "")
    return f"; write {written}" if written else ""


def _written_number(line: str) -> str:
    """The first number of a line that TOML does not read, as it is to be written; empty without one."""
    if comma := _COMMA.search(line):
        without = f" and without {comma[4]}" if comma[4] else ""
        return f"{comma[1]}{comma[2] or 0}.{comma[3]}, with a decimal point{without}"
    for match in _NUMBER.finditer(line):
        sign, whole, above, below, before, behind, unit = (group or "" for group in match.groups())
        sign = sign.replace("+", "")
        without = f", without {unit}" if unit else ""
        if below.strip("0"):
            value = int(whole or 0) + int(above) / int(below)
            return f"{sign}{value:.10g}{without}"
        is_whole = "." not in match[0]
        is_odd = unit or before[:1] == "0" != before or not (is_whole or (before and behind))
        if (before or behind) and is_odd:
            return f"{sign}{int(before or 0)}{'' if is_whole else f'.{behind or 0}'}{without}"
    return ""


def _blank(match: re.Match[str]) -> str:
    """A text may be part of a key; a comment is not."""
    return "" if match[0].startswith("#") else "x"


def _too_deep(key: str) -> str:
    return f"{key}{': ' if key else ''}tables or lists are nested more than {_LEVELS} deep"


def _long_number(text: str) -> str:
    match = _LONG_NUMBER.search(text)
    if match is None:
        return ""
    line = text.count("\n", 0, match.start()) + 1
    before = text[: match.start()].rpartition("\n")[2].strip()
    return f"line {line}: {_TOO_LONG}: {before[:_SHOWN]} {match[0][:_SHOWN]}..."


def _values(table: dict[str, Any]) -> Iterator[tuple[str, Any, int]]:
    """All values with their keys and levels, those on the deepest level that is allowed without what is in them."""
    todo: list[tuple[str, Any, int]] = [(key, value, 1) for key, value in reversed(table.items())]
    while todo:
        key, value, level = todo.pop()
        yield key, value, level
        if isinstance(value, dict):
            todo += [(f"{key}.{name}", inner, level + 1) for name, inner in reversed(value.items())]
        elif isinstance(value, list):
            todo += [(key, inner, level + 1) for inner in reversed(value)]
