"""The settings that are left of a program while its job file cannot be used, for what an editor shows of its text."""

from __future__ import annotations

import contextlib
import os
import re
from collections.abc import Iterator
from pathlib import Path

import msgspec

from polarcheck.checking.settings import Settings
from polarcheck.files.settings.job_files import Nearest
from polarcheck.files.settings.of_programs import OfPrograms, Options
from polarcheck.foundation.errors import PolarcheckError
from polarcheck.program.machines import profiles, toml_text

#: The machine of a job file, before its first table.
_MACHINE = re.compile(r"^[ \t]*+machine[ \t]*+=[ \t]*+[\"']([^\"'\n]{1,200}+)[\"']", re.MULTILINE)
_TABLE = re.compile(r"^[ \t]*+\[", re.MULTILINE)


def fallback(path: Path, options: Options) -> Settings:
    """Return settings without any job file: the options, and the machine that the nearest job file names, if usable."""
    for machine in _machines(path, options):
        with contextlib.suppress(PolarcheckError):
            changed = msgspec.structs.replace(options, use_config=False, config=None, machine=machine)
            return OfPrograms(changed)(str(path))
    return OfPrograms(Options(use_config=False))(str(path))


def _machines(path: Path, options: Options) -> Iterator[str | None]:
    """Yield the machines to try."""
    if options.machine is None and options.use_config:
        nearest = None
        with contextlib.suppress(PolarcheckError):
            nearest = options.config or Nearest().of(path)
        text = ""
        if nearest is not None:
            with contextlib.suppress(ValueError):
                text = toml_text.text_of(nearest, "job file")
        table = _TABLE.search(text)
        match = _MACHINE.search(text, 0, table.start() if table else len(text))
        if match is not None and nearest is not None:
            is_built_in = match[1] in profiles.names()
            yield match[1] if is_built_in else os.path.join(nearest.parent, match[1])  # noqa: PTH118
    yield options.machine
