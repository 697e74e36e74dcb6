"""Names of files that a command would take as options: hooks and wildcards of a shell pass whatever name a file has."""

from __future__ import annotations

import os
from collections.abc import Iterable

import click

from polarcheck.foundation.errors import UsageError

#: The end of the options: arguments behind it are paths.
_END = "--"
#: What an argument means that is no option, and begins as one.
_MEANINGS = {"-": "standard input", _END: "the end of the options"}


def refuse(command: click.Command, arguments: Iterable[str]) -> None:
    """
    Raise UsageError for an argument of a command that begins with `-`, and is the name of a file, too.

    The values of options and the paths behind `--` are let through, since they are no options. `-` is standard input
    behind `--`, too. A command without arguments is given no names.
    """
    remaining = iter(arguments)
    if isinstance(command, click.Group):
        name = next((argument for argument in remaining if not argument.startswith("-")), "")
        command = command.commands.get(name, command)
    if not any(isinstance(parameter, click.Argument) for parameter in command.params):
        return
    before_values = {
        flag
        for parameter in command.params
        if isinstance(parameter, click.Option) and not parameter.is_flag
        for flag in parameter.opts
    }
    is_behind_end = False
    for argument in remaining:
        if argument.startswith("-") and (argument == "-" or not is_behind_end) and os.path.lexists(argument):
            meaning = _MEANINGS.get(argument, "an option")
            raise UsageError(
                f"{argument}: would be taken as {meaning}, but a file has this name; write ./{argument} for the file"
            )
        if argument == _END:
            is_behind_end = True
        elif argument in before_values and not is_behind_end:
            next(remaining, None)
