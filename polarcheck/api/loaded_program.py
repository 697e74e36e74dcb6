"""One program, from a file or a text, with the settings that apply to it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from typing import Any, NamedTuple

import msgspec

from polarcheck.api.keywords import PathName, options, path_of
from polarcheck.api.values import whole
from polarcheck.checking import check
from polarcheck.checking.settings import Settings
from polarcheck.files.settings.of_programs import OfPrograms, Options
from polarcheck.foundation.errors import UsageError
from polarcheck.foundation.time_limit import seconds_for, time_limit
from polarcheck.program.reading import files
from polarcheck.rules.tables import Tables

#: The name of a text that has none.
NAMELESS = "text"


class Program(NamedTuple):
    """
    A program.

    path: as it is reported.
    data: its bytes.
    settings: what applies to it.
    """

    path: str
    data: bytes
    settings: Settings

    @contextmanager
    def runs(self) -> Iterator[Sequence[tuple[str, Tables]]]:
        """Yield its runs as check.read returns them. Their columns are computed inside: its time is limited."""
        settings = self.settings
        with time_limit(seconds_for(len(self.data), settings.job.run.max_seconds)):
            yield check.read(self.data, settings.machine, settings.job, self.path, settings.encoding)


def of_file(path: str, options: Options, max_size: int) -> Program:
    """
    Return the program of a file, or of standard input (`-`).

    Raises SourceError, UsageError, JobError or MachineError in one line.
    """
    settings = OfPrograms(options)(path)
    return Program(files.display_path(path), files.read_program(path, max_size), settings)


class Call(NamedTuple):
    """
    A call of a function for Python.

    function: its name, for messages.
    kind: the TypedDict of the keywords that it takes.
    values: the keywords.
    more: further fields of the options.
    """

    function: str
    kind: type
    values: Mapping[str, Any]
    more: Mapping[str, Any] = {}

    def of_path(self, path: PathName, max_size: int) -> Program:
        """Return the program of a file. Raises SourceError, UsageError, JobError and MachineError in one line."""
        name = path_of(self.function, path)
        most = whole(f"{self.function}: max_size", max_size, 0, files.LARGEST)
        return of_file(name, options(self.function, self.kind, self.values, **self.more), most)

    def name_of(self, name: str | None) -> str:
        """Return the path of a text. Raises UsageError for what is none."""
        return NAMELESS if name is None else path_of(f"{self.function}: name", name)

    def of_text(self, text: str | bytes, name: str) -> Program:
        """
        Return the program of a text. Raises as of_path does.

        A job file applies to it only if `config` names one, or if `use_config` asks for the nearest to the name.
        """
        if not isinstance(text, str | bytes):
            raise UsageError(f"{self.function}: expected a program as str or bytes, found {type(text).__name__}")
        path = self.name_of(name)
        values = self.values if "config" in self.values else {"use_config": False, **self.values}
        settings = OfPrograms(options(self.function, self.kind, values, **self.more))(path)
        if isinstance(text, str):
            text, settings = (
                text.encode("utf-8", "backslashreplace"),
                msgspec.structs.replace(settings, encoding="utf-8"),
            )
        return Program(files.display_path(path), text, settings)

    def with_one_state(self) -> Call:
        """Return the call of a function that runs a program once: block skip is off unless a keyword sets it."""
        given = self.values.get("block_skip")
        skip = "off" if given is None else given
        if isinstance(skip, str) and skip == "both":
            raise UsageError(f"{self.function}: block_skip: expected on or off, found both")
        return self._replace(values={**self.values, "block_skip": skip})
