"""
Reports: a module for each format, from findings to str. Nothing here prints.

The module has a function of the name of the format, or `<format>_parts`, which gives the report file by file, or
`<format>_pieces`, which yields it.
"""

from __future__ import annotations

import importlib
import os
from collections.abc import Callable, Iterator, Mapping
from types import MappingProxyType, ModuleType
from typing import TYPE_CHECKING, Any, NamedTuple

if TYPE_CHECKING:
    from polarcheck.checking.settings import Settings
    from polarcheck.foundation.finding import FileReport, Report
    from polarcheck.rules.rule import Rule

SEVERITIES = ("error", "warning", "note")
#: Formats for people, in the encoding of the terminal, listed first; all others are UTF-8, for programs.
FOR_PEOPLE = ("text", "short", "concise")
#: Formats that hold one checked file each; several files need a folder.
PER_FILE = ("html",)
#: Formats that a wing makes: loaded late, as no room of the core imports a wing.
OF_WINGS = {"html": "polarcheck.view.html"}
_STYLES = {
    "error": "1;31",
    "warning": "1;33",
    "note": "1;36",
    "not evaluated": "1;35",
    "silenced": "1;35",
    "fail": "1;31",
    "unverified": "1;35",
    "unreadable": "1;31",
    "pass": "1;32",
    "message": "1",
    "aside": "2",
}


class Background(NamedTuple):
    """
    What a report may show beside its findings.

    lines: the source lines that have findings, by path and line number.
    rules: the rules by name.
    columns: the width of the terminal [characters].
    color: write in color.
    quiet: show findings only.
    command: the command line that checks a file with the same options; the file is appended.
    following: show the findings that follow from others, too.
    silenced: show silenced findings, too.
    dots: draw paths with Braille and block characters, else ASCII.
    settings: the settings of each file, by path.
    root: the absolute path of the repository, with slashes; empty if unknown.
    folder: the absolute path of the folder that paths are relative to, with slashes; empty if unknown.
    fixed: the number of fixes written into the files before this check.
    has_baseline: findings of a baseline are silenced, so that all others are new.
    drawn: the drawings of each program, by path, if they were requested.
    """

    lines: Mapping[str, Mapping[int, str]] = MappingProxyType({})
    rules: Mapping[str, Rule] = MappingProxyType({})
    columns: int = 100
    color: bool = False
    quiet: bool = False
    command: str = "polarcheck check"
    following: bool = False
    silenced: bool = False
    dots: bool = False
    settings: Mapping[str, Settings] = MappingProxyType({})
    root: str = ""
    folder: str = ""
    fixed: int = 0
    has_baseline: bool = False
    drawn: Mapping[str, Any] = MappingProxyType({})


class Parts(NamedTuple):
    """
    A report that is written file by file, as the checks finish.

    of_file: returns the text of a file; takes the source lines that have findings. Called once per file, in order.
    end: returns the text after all files.
    """

    of_file: Callable[[FileReport, Mapping[int, str]], str]
    end: Callable[[Report], str]


def formats() -> list[str]:
    """Return the names of the formats: the modules of this package and those of wings, those for people first."""
    modules = {name.removesuffix(".py") for name in os.listdir(__path__[0]) if name.endswith(".py")}  # noqa: PTH208
    names = modules - {"__init__"} | OF_WINGS.keys()
    return [*FOR_PEOPLE, *sorted(names.difference(FOR_PEOPLE))]


def render(form: str, report: Report, background: Background) -> str:
    """Return the report in a format."""
    function = getattr(_module(form), form, None)
    return str(function(report, background)) if function else "".join(pieces(form, report, background))


def parts(form: str, background: Background) -> Parts | None:
    """Return how a format is written file by file; None if it needs all files first."""
    make = getattr(_module(form), f"{form}_parts", None)
    return make(background) if make else None


def pieces(form: str, report: Report, background: Background) -> Iterator[str]:
    """Yield the text of render piece by piece, if the format can do so."""
    if of_format := getattr(_module(form), f"{form}_pieces", None):
        yield from of_format(report, background)
    elif of_files := parts(form, background):
        yield from of_each(of_files, report, background)
    else:
        yield str(getattr(_module(form), form)(report, background))


def of_each(parts: Parts, report: Report, background: Background) -> Iterator[str]:
    """Yield the parts of a report whose files are all checked."""
    for file in report.files:
        yield parts.of_file(file, background.lines.get(file.path, {}))
    yield parts.end(report)


def _module(form: str) -> ModuleType:
    return importlib.import_module(OF_WINGS.get(form, f"polarcheck.reports.{form}"))


def settings_lines(report: Report) -> Iterator[str]:
    """Yield one line on the settings that are not the default, if there are any."""
    settings = report.settings
    if settings.differing or settings.diff_base or (settings.sources or {}).keys() - {"machine"}:
        from polarcheck.reports.pages.settings_line import settings_line  # imported late: most runs have none

        yield from settings_line(report)


def painted(style: str, text: str) -> str:
    """Return the text in color for a terminal."""
    return f"\x1b[{_STYLES[style]}m{text}\x1b[0m" if text else text
