"""
What can go wrong on our side. What is wrong in a program is a finding, never an exception.

    PolarcheckError
    |-- UsageError        an option or argument that means nothing
    |-- SourceError       a file that cannot be read
    |-- OutputError       a report that cannot be written
    |-- MachineError      a machine profile: unknown machine, key, type
    |-- JobError          polarcheck.toml, pyproject.toml, an offset table
    |-- StoppedError      the check was cancelled
    |-- RefusedError      a program that is not rewritten, since the result would not be the same
    |-- BaselineError     a file of known findings
    |-- ClusterError      a cluster that cannot check
    |-- TooHardError      a table that would exceed its limit of time or size
    |   `-- NoAnswerError     areas for which the geometry library finds no answer
    `-- RuleError         a rule without severity, message, docstring: a bug in a rule file
"""

from collections.abc import Iterable, Sequence
from typing import NamedTuple

__name__ = "polarcheck.errors"  # the public name of the module, which tracebacks and filters of warnings show

#: The fewest letters of a partial name for which a suggestion is made.
_LEAST = 3


class PolarcheckError(Exception):
    """Base of all errors; its text is one line that names the file or option, the key, and what was expected."""

    def __str__(self) -> str:
        """Return the text with all that would end the line, or act on a terminal, spelled out."""
        return one_line(super().__str__())


class PolarcheckWarning(UserWarning):
    """What the command line would write to standard error beside a report, for callers of the functions for Python."""


class UsageError(PolarcheckError):
    """An option or argument without a meaning."""


class SourceError(PolarcheckError):
    """A program file that cannot be read."""


class OutputError(PolarcheckError):
    """A report that cannot be written, or must not be written where it would go."""


class MachineError(PolarcheckError):
    """
    A machine profile that cannot be used.

    others: further faults that were seen together with it, each in one line of the same form.
    """

    def __init__(self, text: str, others: Iterable[str] = ()) -> None:
        super().__init__(text)
        self.others = tuple(others)


class JobError(PolarcheckError):
    """A job file or offset table that cannot be used."""


class StoppedError(PolarcheckError):
    """A check was cancelled, since its result is no longer needed."""


class Refusal(NamedTuple):
    """Why a program is not rewritten. line: in the original, from 1; 0 for the whole program. text: what it says."""

    line: int
    text: str


class RefusedError(PolarcheckError):
    """
    A program that is not rewritten as it was asked for, since the result would not be the same.

    refusals: the reasons.
    """

    def __init__(self, refusals: Iterable[Refusal]) -> None:
        self.refusals = tuple(refusals)
        super().__init__(
            "; ".join(f"line {fault.line}: {fault.text}" if fault.line else fault.text for fault in self.refusals)
        )


class BaselineError(PolarcheckError):
    """A file of known findings that cannot be used, or must not be written."""


class CertificateError(PolarcheckError):
    """A manifest or a golden trace that cannot be used, or must not be written."""


class ClusterError(PolarcheckError):
    """A cluster that cannot be reached, has no workers, or does not answer any more."""


class TooHardError(PolarcheckError):
    """
    A table that would exceed its limit of time or size; its text is a reason for "not evaluated".

    The rules that compare this table are not evaluated; all others are.
    """


class NoAnswerError(TooHardError):
    """Areas that the geometry library cannot compute, since some of their points nearly coincide."""


class RuleError(PolarcheckError):
    """A rule file that is not a valid rule; raised when the rules are loaded."""


def why(error: Exception) -> str:
    """Return what the system says of an error; of any other one its text."""
    return str(getattr(error, "strerror", None) or error)


def one_line(text: str) -> str:
    """Return a text as the message of an error shows it."""
    return text if text.isprintable() else "".join(map(_visible, text))


def _visible(character: str) -> str:
    """Return a character of a message as `\\x1b` if it acts; bytes of the names of files stay as Python holds them."""
    number = ord(character)
    if character.isprintable() or 0xDC80 <= number <= 0xDCFF:
        return character
    return escaped(number)


def escaped(number: int) -> str:
    """Return a character that cannot be shown, or a byte, as its number: `\\x1b`, `\\u202e`."""
    return f"\\x{number:02x}" if number < 256 else f"\\u{number:04x}" if number < 65536 else f"\\U{number:08x}"


def enumerated(names: Iterable[str], last: str = "and") -> str:
    """Return names in words: `G1, G2 and G3`. last: the word before the last one."""
    *others, final = names
    return f"{', '.join(others)} {last} {final}" if others else final


def first_of(names: Sequence[str], most: int, separator: str = ", ") -> str:
    """Return the first names, and how many more there are: `a, b and 3 more`."""
    more = f" and {len(names) - most} more" if len(names) > most else ""
    return separator.join(names[:most]) + more


def counted(number: int, noun: str) -> str:
    """`1 error`, `2 errors`, `2 fixes`."""
    ending = "" if number == 1 else "es" if noun.endswith("x") else "s"
    return f"{number} {noun}{ending}"


def consecutive(numbers: Iterable[int]) -> list[list[int]]:
    """Return rising numbers in groups, each of numbers that follow each other."""
    groups: list[list[int]] = []
    for number in numbers:
        if groups and number == groups[-1][-1] + 1:
            groups[-1].append(number)
        else:
            groups.append([number])
    return groups


def suggestion(wrong: str, candidates: Iterable[str], most: int = 3) -> str:
    """
    Return a hint such as `; did you mean fanuc-30i?`; empty if no candidate is similar.

    In this order: the names that begin with the written one, in any case; else the nearest name; else the names that
    contain it. most: how many names are listed.
    """
    names = {name.lower(): name for name in candidates}
    word = wrong.strip().lower()
    near = [word] if word in names else [name for name in names if name.startswith(word)]
    if not near or len(word) < _LEAST:
        import difflib

        near = difflib.get_close_matches(word, names, 1)
    if not near and len(word) >= _LEAST:
        near = [name for name in names if word in name]
    return f"; did you mean {enumerated([names[name] for name in near[:most]], 'or')}?" if any(near) else ""
