"""
What can go wrong on our side. What is wrong in a program is a finding, never an exception.

    PolarcheckError
    |-- UsageError        an option or argument that means nothing
    |-- SourceError       a file that cannot be read
    |-- MachineError      a machine profile: unknown machine, key, type
    |-- JobError          polarcheck.toml, pyproject.toml, an offset table
    `-- RuleError         a rule without severity, message, docstring: a bug in a rule file
"""


class PolarcheckError(Exception):
    """Base of all; its text is one line that names the file or option, the key, and what was meant."""


class UsageError(PolarcheckError):
    """An option or argument that means nothing."""


class SourceError(PolarcheckError):
    """A program file that cannot be read."""


class MachineError(PolarcheckError):
    """A machine profile that cannot be used."""


class JobError(PolarcheckError):
    """A job file or offset table that cannot be used."""


class RuleError(PolarcheckError):
    """A rule file that is not a rule; found when the rules are loaded."""
