"""Lines of characters in color."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from itertools import groupby

#: Takes a style of the report and a text; returns the text in color.
Paint = Callable[[str, str], str]


def plain(style: str, text: str) -> str:
    """Return the text without color."""
    return text


def painted(line: str, styles: Sequence[str], paint: Paint) -> str:
    """Return a line in color; styles: the style of each character, empty for none."""
    groups = groupby(zip(styles, line, strict=True), key=lambda pair: pair[0])
    return "".join(
        paint(style, text) if style else text
        for style, text in ((style, "".join(cell for _, cell in group)) for style, group in groups)
    )
