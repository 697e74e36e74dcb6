"""`--stdin-filename`: checks standard input as if it were a file, such as the unsaved text of an editor."""

from __future__ import annotations

import os
from collections.abc import Sequence
from typing import Any

import click

from polarcheck.commands.options import option
from polarcheck.foundation.errors import UsageError
from polarcheck.program.reading import files


def _named(ctx: click.Context, parameter: click.Parameter, value: str | None) -> str | None:
    if value is None:
        return None
    if value in ("", files.STANDARD_INPUT) or "\0" in value or value.endswith(("/", os.sep)) or os.path.isdir(value):  # noqa: PTH112  Path.is_dir raises for some names
        raise click.BadParameter(f"{value!r}: expected the name of a program, such as O1234.NC")
    return value


filename = option(
    "--stdin-filename", callback=_named, metavar="FILE",
    help="Judge and report standard input (-) as this file.",
)  # fmt: skip


def judged_as(paths: Sequence[str], filename: str | None) -> dict[str, Any]:
    """
    Return the arguments of tasks.plan for standard input.

    Raises UsageError if a name is given, but standard input is not read.
    """
    if filename is None:
        return {}
    if files.STANDARD_INPUT not in paths:
        raise UsageError(f"--stdin-filename {filename}: expected - among the paths, which reads standard input")
    return {"standard_input": filename}
