"""Lines of characters in color."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from itertools import groupby

#: A style of the report and a text to the text in color.
Paint = Callable[[str, str], str]


def plain(style: str, text: str) -> str:
    """No color."""
    return text


def painted(line: str, styles: Sequence[str], paint: Paint) -> str:
    """A line in color; styles: of each character, empty for none."""
    groups = groupby(zip(styles, line, strict=True), key=lambda pair: pair[0])
    return "".join(
        paint(style, text) if style else text
        for style, text in ((style, "".join(one for _, one in group)) for style, group in groups)
    )
