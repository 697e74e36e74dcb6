"""Writes XML as text. Text from a program is escaped, and stripped of characters that XML 1.0 does not allow."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from polarcheck.program.reading.excerpt import visible

HEAD = '<?xml version="1.0" encoding="UTF-8"?>\n'
_SPECIAL = str.maketrans({"&": "&amp;", "<": "&lt;", ">": "&gt;", '"': "&quot;"})


def element(name: str, attributes: dict[str, str | int], inside: Iterable[str] = (), depth: int = 0) -> Iterator[str]:
    """Yield the lines of an element; `inside` is written as it is."""
    written = "".join(f' {key}="{escaped(str(value))}"' for key, value in attributes.items())
    space = "  " * depth
    rest = iter(inside)
    first = next(rest, None)
    if first is None:
        yield f"{space}<{name}{written}/>\n"
        return
    yield f"{space}<{name}{written}>\n"
    yield first
    yield from rest
    yield f"{space}</{name}>\n"


def of_text(name: str, attributes: dict[str, str | int], lines: Iterable[str], depth: int = 0) -> str:
    """Return an element that holds lines of text."""
    written = "".join(f' {key}="{escaped(str(value))}"' for key, value in attributes.items())
    return f"{'  ' * depth}<{name}{written}>" + "\n".join(map(escaped, lines)) + f"</{name}>\n"


def escaped(text: str) -> str:
    """Escape text for use between tags and quotes."""
    return visible(text).translate(_SPECIAL)
