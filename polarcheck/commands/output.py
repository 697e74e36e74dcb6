"""Printing: results go to standard output, all else to standard error; and what the terminal takes."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterable

import click

#: Width of reports that go anywhere but to a terminal, and the widest that is good to read [characters].
COLUMNS = 100


def show(text: str | bytes, color: bool | None = None) -> None:
    """
    Write to standard output; if nobody reads on, the exit code is all that is left to say.

    color: whether escapes for color stay in the text; None where only a terminal shows them.
    """
    try:
        click.echo(text, nl=False, color=color)
        sys.stdout.flush()
    except BrokenPipeError:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


def say(message: str) -> None:
    """One line on standard error, whatever the message holds."""
    _tell(f"polarcheck: {message}")


def warn(message: str) -> None:
    """The same for what does not change the exit code."""
    say(f"warning: {message}")


def say_lines(texts: Iterable[str]) -> None:
    """The lines of texts on standard error, without a name before them."""
    for text in texts:
        for line in text.splitlines():
            _tell(line)


def _tell(line: str) -> None:
    """Write a line in which nothing acts on a terminal."""
    # Its tables of characters are a library that most runs do not need.
    from polarcheck.reading.excerpt import visible

    click.echo(visible(line), err=True)


def in_color(choice: str) -> bool:
    """--color, else NO_COLOR, else FORCE_COLOR, else whether it is a terminal."""
    if choice != "auto":
        return choice == "always"
    if os.environ.get("NO_COLOR"):
        return False
    return bool(os.environ.get("FORCE_COLOR")) or (sys.stdout.isatty() and os.environ.get("TERM") != "dumb")


def columns() -> int:
    """The width of a report on standard output [characters]."""
    if not sys.stdout.isatty():
        return COLUMNS
    import shutil

    return min(shutil.get_terminal_size().columns, COLUMNS)
