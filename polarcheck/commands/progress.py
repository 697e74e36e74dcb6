"""A bar on a terminal, when there is something to wait for."""

from __future__ import annotations

import sys
import time
from collections.abc import Generator, Sequence
from typing import TypeVar

from polarcheck.commands.output import is_terminal

#: Nobody needs a bar for less than this [s].
_PATIENCE = 1.0

Element = TypeVar("Element")


def watched(elements: Sequence[Element], is_shown: bool) -> Generator[Element, None, None]:
    """The elements one after the other; a bar on stderr, if that is a terminal, appears after the first second."""
    if not is_shown or not is_terminal(sys.stderr):
        yield from elements
        return
    begun = time.monotonic()
    for done, element in enumerate(elements):
        if time.monotonic() - begun > _PATIENCE:
            yield from _with_bar(elements, done)
            return
        yield element


def _with_bar(elements: Sequence[Element], done: int) -> Generator[Element, None, None]:
    from rich.console import Console
    from rich.progress import BarColumn, MofNCompleteColumn, Progress, TimeRemainingColumn

    columns = (BarColumn(), MofNCompleteColumn(), TimeRemainingColumn())
    with Progress(*columns, console=Console(stderr=True), transient=True) as progress:
        task = progress.add_task("", total=len(elements), completed=done)
        for element in elements[done:]:
            yield element
            progress.advance(task)
