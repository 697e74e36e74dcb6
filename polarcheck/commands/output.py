"""Printing: results go to standard output, all else to standard error; and what the terminal takes."""

from __future__ import annotations

import contextlib
import errno
import os
import sys
from collections.abc import Iterable
from typing import TextIO

import click

from polarcheck.errors import OutputError

ON_WINDOWS = os.name == "nt"
#: Width of reports that go anywhere but to a terminal, and the widest that is good to read [characters].
COLUMNS = 100
#: Of what an exception says [characters].
_MOST_SAID = 200
#: A longer line on standard error is cut in its middle: what is wrong stands at its end [characters].
_LONGEST, _HEAD, _TAIL = 1000, 300, 500


def show(text: str | bytes, color: bool | None = None, to_error: bool = False) -> bool:
    """
    Write to standard output; whether anybody still reads. If nobody does, the exit code is all that is left to say.

    color: whether escapes for color stay in the text; None where only a terminal shows them. to_error: to standard
    error, where standard output holds something else. Raises OutputError where
    it cannot be written: a full disk, a closed output.
    """
    if to_error:
        with contextlib.suppress(OSError, ValueError):
            click.echo(text, nl=False, err=True, color=color)
        return True
    if sys.stdout is None:
        raise OutputError("standard output is closed")
    if ON_WINDOWS and isinstance(text, bytes) and is_terminal(sys.stdout):
        # The console takes characters in any code page, and bytes in its own only.
        text = text.decode("utf-8", "replace")
    try:
        click.echo(text, nl=False, color=color)
        sys.stdout.flush()
    except OSError as error:
        abandon_output()
        if nobody_reads(error):
            return False
        raise OutputError(f"standard output: {error.strerror or error}") from None
    return True


def nobody_reads(error: OSError) -> bool:
    """Return True if the reader of the output is gone; Windows reports an invalid argument."""
    return isinstance(error, BrokenPipeError) or (ON_WINDOWS and error.errno == errno.EINVAL)


def is_of_echo(error: BaseException) -> bool:
    """Tells whether an error came while click was writing, so that standard output is at fault."""
    entry = error.__traceback__
    while entry is not None and entry.tb_frame.f_code is not click.echo.__code__:
        entry = entry.tb_next
    return entry is not None


def abandon_output() -> None:
    """Discard the rest of standard output: at its end Python would try to write it once more, and fail."""
    with contextlib.suppress(OSError, ValueError, AttributeError):
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


def say(message: str) -> None:
    """One line on standard error, whatever the message holds."""
    _tell(f"polarcheck: {message}")


def warn(message: str) -> None:
    """The same for what does not change the exit code."""
    say(f"warning: {message}")


def said_of_bug(error: Exception, with_traceback: bool) -> list[str]:
    """Return the lines of an internal error for `say_lines`, with the traceback if requested."""
    if with_traceback:
        import traceback

        return [line for text in traceback.format_exception(error) for line in text.splitlines()]
    from polarcheck.reading.excerpt import shortened

    where = "".join(f", {note}" for note in getattr(error, "__notes__", ()))
    said = f"{type(error).__name__}: {shortened(str(error), _MOST_SAID)}{where}"
    return [f"polarcheck: internal error: {said}; run with --debug for the traceback"]


def say_lines(lines: Iterable[str]) -> None:
    """Lines on standard error, without a name before them."""
    for line in lines:
        _tell(line)


def _tell(line: str) -> None:
    """Write a line in which nothing acts on a terminal, or in the log of a CI job."""
    # Its tables of characters are a library that most runs do not need.
    from polarcheck.reading.excerpt import visible, without_commands

    shown = without_commands(visible(line))
    if len(shown) > _LONGEST:
        shown = f"{shown[:_HEAD]} ... {shown[-_TAIL:]}"
    # Where nobody can be told, the exit code is left.
    with contextlib.suppress(OSError, ValueError):
        click.echo(shown, err=True)


def is_terminal(stream: TextIO | None) -> bool:
    """Return True if a standard stream is a terminal; a process may be started without the stream."""
    return stream is not None and stream.isatty()


def in_color(choice: str) -> bool:
    """--color, else NO_COLOR, else FORCE_COLOR, else whether it is a terminal."""
    if choice != "auto":
        return choice == "always"
    if os.environ.get("NO_COLOR"):
        return False
    return bool(os.environ.get("FORCE_COLOR")) or (is_terminal(sys.stdout) and os.environ.get("TERM") != "dumb")


def columns() -> int:
    """The width of a report on standard output [characters]."""
    if not is_terminal(sys.stdout):
        return COLUMNS
    import shutil

    return min(shutil.get_terminal_size().columns, COLUMNS)


def draws_dots() -> bool:
    """Return True if standard output can encode block and Braille characters."""
    import codecs

    encoding = getattr(sys.stdout, "encoding", None) or "ascii"
    is_unicode = codecs.lookup(encoding).name.startswith("utf")
    return is_unicode and os.environ.get("TERM") != "dumb"
