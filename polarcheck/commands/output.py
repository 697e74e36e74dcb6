"""Printing: results go to standard output, all else to standard error; and the abilities of the terminal."""

from __future__ import annotations

import contextlib
import errno
import os
import sys
from collections.abc import Iterable, Sequence
from typing import TextIO

import click

from polarcheck.files.cache import repeats
from polarcheck.foundation.errors import OutputError

ON_WINDOWS = os.name == "nt"
#: The width of reports outside a terminal, and the largest width on one [characters].
COLUMNS = 100
#: The longest text of an exception that is shown [characters].
_LONGEST_ERROR = 200
#: A longer line on standard error is cut in the middle, since its end says what is wrong [characters].
_LONGEST, _HEAD, _TAIL = 1000, 300, 500
#: The colors of the lines of a diff, by their signs.
_OF_DIFF = {"-": "31", "+": "32", "@": "36"}


def show(text: str | bytes, color: bool | None = None, to_error: bool = False) -> bool:
    """
    Write to standard output; return False once the reader has gone, and writing more is useless.

    text: a str is for people, and no line of it is a command to the log of a CI job; bytes are data, as they are.
    color: keep the escapes for color; None keeps them on a terminal only.
    to_error: write to standard error, since standard output holds something else.

    Raises OutputError if it cannot be written: a full disk, a closed output.
    """
    if isinstance(text, str) and ("::" in text or "##" in text):
        from polarcheck.program.reading.excerpt import without_commands

        text = without_commands(text)
    repeats.note(text, to_error=to_error)
    if to_error:
        with contextlib.suppress(OSError, ValueError):
            click.echo(text, nl=False, err=True, color=color)
        return True
    if sys.stdout is None:
        raise OutputError("standard output is closed")
    if ON_WINDOWS and isinstance(text, bytes) and is_terminal(sys.stdout):
        # The console accepts any characters, but bytes in its own code page only.
        text = text.decode("utf-8", "replace")
    try:
        click.echo(text, nl=False, color=color)
        sys.stdout.flush()
    except OSError as error:
        repeats.drop()
        abandon_output()
        if nobody_reads(error):
            return False
        raise OutputError(f"standard output: {error.strerror or error}") from None
    return True


def show_diff(lines: Sequence[str], color: bool) -> None:
    """Write the lines of a unified diff to standard output, if there are any. Raises OutputError as `show` does."""
    if color:
        lines = [f"\x1b[{_OF_DIFF[line[0]]}m{line}\x1b[0m" if line[0] in _OF_DIFF else line for line in lines]
    if lines:
        show("".join(f"{line}\n" for line in lines), color or None)


def nobody_reads(error: OSError) -> bool:
    """Return True if the reader of the output has gone, which Windows reports as an invalid argument."""
    return isinstance(error, BrokenPipeError) or (ON_WINDOWS and error.errno == errno.EINVAL)


def is_of_echo(error: BaseException) -> bool:
    """Return True if click raised an error while writing, so that standard output is at fault."""
    entry = error.__traceback__
    while entry is not None and entry.tb_frame.f_code is not click.echo.__code__:
        entry = entry.tb_next
    return entry is not None


def abandon_output() -> None:
    """Discard pending output, which Python would otherwise try to write again at its end, and fail."""
    with contextlib.suppress(OSError, ValueError, AttributeError):
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


def say(message: str) -> None:
    """Write one line to standard error, whatever the message holds."""
    _write_error(f"polarcheck: {message}")


def warn(message: str) -> None:
    """Write a warning to standard error; it does not change the exit code."""
    say(f"warning: {message}")


def bug_lines(error: Exception, with_traceback: bool) -> list[str]:
    """Return the lines on an internal error, for `say_lines`."""
    if with_traceback:
        import traceback

        return [line for text in traceback.format_exception(error) for line in text.splitlines()]
    from polarcheck.program.reading.excerpt import shortened

    where = "".join(f", {note}" for note in getattr(error, "__notes__", ()))
    summary = f"{type(error).__name__}: {shortened(str(error), _LONGEST_ERROR)}{where}"
    return [f"polarcheck: internal error: {summary}; run with --debug for the traceback"]


def say_lines(lines: Iterable[str]) -> None:
    """Write lines to standard error, without a name before them."""
    for line in lines:
        _write_error(line)


def _write_error(line: str) -> None:
    """Write a line to standard error without characters that control a terminal or the log of a CI job."""
    # Imported late: most runs do not need its tables of characters.
    from polarcheck.program.reading.excerpt import visible, without_commands

    text = without_commands(visible(line))
    if len(text) > _LONGEST:
        text = f"{text[:_HEAD]} ... {text[-_TAIL:]}"
    repeats.note(f"{text}\n", to_error=True)
    # If standard error is closed, only the exit code reports the error.
    with contextlib.suppress(OSError, ValueError):
        click.echo(text, err=True)


def is_terminal(stream: TextIO | None) -> bool:
    """Return True if a standard stream is a terminal; a process may be started without the stream."""
    return stream is not None and stream.isatty()


def in_color(choice: str) -> bool:
    """Decide on color: --color, else NO_COLOR, else FORCE_COLOR, else color on a terminal only."""
    if choice != "auto":
        return choice == "always"
    if os.environ.get("NO_COLOR"):
        return False
    return bool(os.environ.get("FORCE_COLOR")) or (is_terminal(sys.stdout) and os.environ.get("TERM") != "dumb")


def columns() -> int:
    """Return the width of a report on standard output [characters]."""
    if not is_terminal(sys.stdout):
        return COLUMNS
    import shutil

    return min(shutil.get_terminal_size().columns, COLUMNS)


def draws_dots() -> bool:
    """Return True if standard output can show Braille and block characters, not only ASCII."""
    import codecs

    encoding = getattr(sys.stdout, "encoding", None) or "ascii"
    is_unicode = codecs.lookup(encoding).name.startswith("utf")
    return is_unicode and os.environ.get("TERM") != "dumb"
