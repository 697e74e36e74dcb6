"""`polarcheck server`: the language server for editors."""

from __future__ import annotations

import importlib.util
import os
from pathlib import Path
from typing import Any

import click

from polarcheck.commands import options
from polarcheck.commands.options import option
from polarcheck.commands.output import say
from polarcheck.foundation.errors import UsageError

_NEEDED = ("pygls", "lsprotocol")


@click.command(short_help="Show findings in an editor while a program is written.")
@options.executing("programs")
@options.judging
@option(
    "--trust", type=click.Path(exists=True, file_okay=False, path_type=Path), multiple=True, metavar="FOLDER",
    help="Files are opened in this folder, too, not only in the folders of the editor.",
)  # fmt: skip
@option("--stdio", is_flag=True, help="Speak over standard input and output, as always.")
@options.debug
@click.pass_context
def server(ctx: click.Context, /, no_config: bool, trust: tuple[Path, ...], stdio: bool, **arguments: Any) -> None:
    """
    Show findings in an editor while a program is written: a language server on standard input and output.

    An editor starts it; docs/editors/ says how. It marks findings, shows manual pages and the state of each block, and
    offers fixes. Settings are those of `check`: the polarcheck.toml nearest to a program, over it these options.

    Files are opened in the folders that are open in the editor, and nowhere else: but for what these options name, and
    the folders of subprograms that a polarcheck.toml names.
    """
    ctx.exit(_serve(no_config, trust, arguments))


def _serve(no_config: bool, trust: tuple[Path, ...], arguments: dict[str, Any]) -> int:
    if not all(map(importlib.util.find_spec, _NEEDED)):
        raise UsageError("the server needs pygls, of the extra [server]: pip install pygls")
    import gc

    from polarcheck.editor import process
    from polarcheck.foundation.memory import keep_within_memory

    try:
        streams = process.take_streams()
    except OSError as error:
        raise UsageError(f"standard input or output: {error.strerror}: an editor starts the server") from None
    if os.isatty(streams.source):
        say("an editor starts the server, and speaks to it over standard input; Ctrl-C ends it")
    from polarcheck.editor.features import register
    from polarcheck.editor.server_session import Server

    # The server runs for hours, so garbage is collected, which other commands leave to the end of the process.
    gc.enable()
    keep_within_memory()
    session = Server(_Settings(no_config, arguments), _trusted(trust, arguments))
    register(session)
    return process.serve(session, streams)


class _Settings:
    """
    Returns the settings of a program, read again each time: that takes milliseconds, and they are never stale.

    The modules are imported on the first call: an editor waits for the answer to its first message, which needs none.
    Threads may call it at the same time.
    """

    def __init__(self, no_config: bool, arguments: dict[str, Any]) -> None:
        self._use_config, self._arguments = not no_config, arguments

    def __call__(self, path: Path) -> Any:
        from polarcheck.files.settings.of_programs import OfPrograms

        return OfPrograms(self._options())(str(path))

    def fallback(self, path: Path) -> Any:
        """Return the settings that are left while the job file of a program cannot be used."""
        from polarcheck.files.settings.fallback import fallback

        return fallback(path, self._options())

    def _options(self) -> Any:
        from polarcheck.files.settings.of_programs import Options

        return Options(use_config=self._use_config, **self._arguments)


def _trusted(trust: tuple[Path, ...], arguments: dict[str, Any]) -> list[Path]:
    """Return the folders that the command line names, and those of the files that it names."""
    files = [arguments["config"], arguments["offsets"]]
    if arguments["machine"] and os.path.isfile(arguments["machine"]):  # noqa: PTH113  Path.is_file raises for some names
        files.append(Path(arguments["machine"]))
    folders = [Path(os.path.realpath(file)).parent for file in files if file is not None]
    return [*trust, *folders, *map(Path, arguments["subprograms"])]
