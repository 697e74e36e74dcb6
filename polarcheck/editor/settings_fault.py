"""The place in a settings file of what keeps programs from being checked, so that it is marked there, too."""

from __future__ import annotations

import os
import re
from collections.abc import Mapping
from pathlib import Path

from lsprotocol import types

from polarcheck.editor.diagnostics import NOT_CHECKED, SOURCE
from polarcheck.program.reading.excerpt import visible

#: An error in a file: its path, a line if it is known, and what is wrong.
_PLACE = re.compile(r"(.{1,400}?\.toml)(?::(\d{1,9}))?: (.*)", re.DOTALL)
#: No line of a settings file is longer than editors show; a range may end behind the line [characters].
_END_OF_LINE = 1000


def broken(error: str, read: Mapping[str, object]) -> tuple[str, types.Diagnostic] | None:
    """
    Return the URI of the settings file that an error names, and the diagnostic; None if it names none.

    read: the files that were read, by absolute path.
    """
    match = _PLACE.match(error)
    if match is None or os.path.abspath(match[1]) not in read:  # noqa: PTH100  Path.absolute leaves `..`
        return None
    line = max(int(match[2] or 1) - 1, 0)
    range_of_line = types.Range(types.Position(line, 0), types.Position(line, _END_OF_LINE))
    return Path(os.path.abspath(match[1])).as_uri(), types.Diagnostic(  # noqa: PTH100
        range=range_of_line,
        severity=types.DiagnosticSeverity.Error,
        code=NOT_CHECKED,
        source=SOURCE,
        message=visible(f"{match[3]}; programs with these settings are not checked"),
    )
