"""
What can go wrong on our side. What is wrong in a program is a finding, never an exception.

    PolarcheckError
    |-- UsageError        an option or argument that means nothing
    |-- SourceError       a file that cannot be read
    |-- OutputError       a report that cannot be written
    |-- MachineError      a machine profile: unknown machine, key, type
    |-- JobError          polarcheck.toml, pyproject.toml, an offset table
    |-- StoppedError      nobody waits for the outcome any more
    |-- BaselineError     a file of known findings
    |-- ClusterError      a cluster that cannot check
    |-- TooHardError      a table that would take more than its bound of time or size
    |   `-- NoAnswerError     areas for which the geometry library finds no answer
    `-- RuleError         a rule without severity, message, docstring: a bug in a rule file
"""

from __future__ import annotations

from collections.abc import Iterable

#: From a part of a name with fewer letters none is guessed.
_LEAST = 3


class PolarcheckError(Exception):
    """Base of all; its text is one line that names the file or option, the key, and what was meant."""


class UsageError(PolarcheckError):
    """An option or argument that means nothing."""


class SourceError(PolarcheckError):
    """A program file that cannot be read."""


class OutputError(PolarcheckError):
    """A report that cannot be written, or must not be written where it would go."""


class MachineError(PolarcheckError):
    """A machine profile that cannot be used."""


class JobError(PolarcheckError):
    """A job file or offset table that cannot be used."""


class StoppedError(PolarcheckError):
    """A check of which nobody waits for the outcome any more."""


class BaselineError(PolarcheckError):
    """A file of known findings that cannot be used, or must not be written."""


class ClusterError(PolarcheckError):
    """A cluster that cannot be reached, has no workers, or does not answer any more."""


class TooHardError(PolarcheckError):
    """
    A table that would take more than its bound of time or size; its text is a reason for "not evaluated".

    The rules that compare it are not evaluated; all others are.
    """


class NoAnswerError(TooHardError):
    """Areas for which the geometry library finds no answer, since points of them all but meet."""


class RuleError(PolarcheckError):
    """A rule file that is not a rule; found when the rules are loaded."""


def suggestion(wrong: str, known: Iterable[str], most: int = 3) -> str:
    """
    `; did you mean fanuc-30i?`: the names that begin with what is written, in any case, else the one that is nearest,
    else those that hold it; empty where there is none.
    """
    names = {name.lower(): name for name in known}
    word = wrong.strip().lower()
    near = [word] if word in names else [name for name in names if name.startswith(word)]
    if not near or len(word) < _LEAST:
        import difflib

        near = difflib.get_close_matches(word, names, 1)
    if not near and len(word) >= _LEAST:
        near = [name for name in names if word in name]
    *others, last = [names[name] for name in near[:most]] or [""]
    return f"; did you mean {', '.join(others)}{' or ' if others else ''}{last}?" if last else ""
