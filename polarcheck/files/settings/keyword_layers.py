"""The keywords of a Python function as settings: the values of a job file, which lie over the files that are read."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import msgspec

from polarcheck.files.settings.declarations import SETTINGS
from polarcheck.files.settings.job_layers import Layer, PartLayer, Written
from polarcheck.foundation.errors import UsageError
from polarcheck.program.machines.job import Job
from polarcheck.program.machines.value_types import MisfitError, fitted

#: The keyword of each option.
_KEYWORDS = {setting.flag: setting.name for setting in SETTINGS.values()}


class Keywords(msgspec.Struct, frozen=True):
    """
    The keywords of a Python function.

    function: its name, for messages.
    layers: the values of a job among them.
    changes: the values of the machine among them, by table and key.
    """

    function: str
    layers: tuple[Layer, ...]
    changes: Mapping[str, Mapping[str, Any]]

    def spelled(self, option: str) -> str:
        """Return an option as its user writes it, for messages: --select, or `polarcheck.check(): select`."""
        return f"{self.function}: {_KEYWORDS.get(option, option[2:].replace('-', '_'))}"


class _Spoken(Written):
    """The place of every keyword: the function that it is given to. Paths are relative to the working folder."""

    def __init__(self, function: str) -> None:
        super().__init__(Path(function), "")

    def at(self, key: str) -> str:
        """Return the place of a key."""
        return str(self.path)


def keywords(function: str, table: Mapping[str, Any], changes: Mapping[str, Any]) -> Keywords:
    """
    Return the keywords of a function.

    table: the values of a job, as in polarcheck.toml.
    changes: values of the machine by TABLE.KEY, as in `--set`.

    Raises UsageError, which names the function and the keyword, for a value that does not fit.
    """
    try:
        fitted(table, Job)
    except MisfitError as misfit:
        raise UsageError(f"{function}: {str(misfit).removeprefix('run.')}") from None
    tables: dict[str, dict[str, Any]] = {}
    for key, value in changes.items():
        group, _, name = key.partition(".") if isinstance(key, str) else ("", "", "")
        if not group or not name:
            raise UsageError(f"{function}: changes: expected keys TABLE.KEY as limits.c_feed, found {key!r}")
        tables.setdefault(group, {})[name] = value
    source = _Spoken(function)
    parts = [PartLayer(source, part, number) for number, part in enumerate(table.get("part", ()), 1)]
    return Keywords(function, (Layer(source, table), *parts), tables)
