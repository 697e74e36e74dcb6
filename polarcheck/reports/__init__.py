"""Reports: a module for each format with a function of the same name, from findings to str. Nothing is printed here."""

from __future__ import annotations

import importlib
from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import Path
from types import MappingProxyType, ModuleType
from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from polarcheck.checking.rule import Rule
    from polarcheck.checking.settings import Settings
    from polarcheck.finding import FileReport, Report
    from polarcheck.pictures.picture import Drawn

SEVERITIES = ("error", "warning", "note")
#: Formats that come in the encoding of a terminal, and that one looks for first; all others are UTF-8, for programs.
FOR_PEOPLE = ("text", "short", "concise")
#: Formats that hold one file; many need a folder.
OF_ONE = ("html",)
_STYLES = {
    "error": "1;31",
    "warning": "1;33",
    "note": "1;36",
    "not evaluated": "1;35",
    "silenced": "1;35",
    "fail": "1;31",
    "unverified": "1;35",
    "pass": "1;32",
    "message": "1",
    "aside": "2",
}


class Background(NamedTuple):
    """
    What a report may show beside its findings.

    lines: by path and line number, those that findings stand in. rules: by name. columns: the width of the terminal.
    quiet: findings only. command: what checks a file behind it as these were checked. following: whether what follows
    from a finding is shown, too. silenced: whether what is silenced is. dots: whether paths are drawn with characters
    of dots and blocks, else ASCII. settings: what applied to a file, by its path. failures: a line each on what could
    not be read, or went wrong. root, folder: of the repository, and the one that paths begin in; absolute, with
    slashes, empty where they are not known. fixed: how many fixes were written into the files before. has_baseline:
    whether findings of a baseline are silenced, so that others are new. drawn: by path, what is drawn of a program,
    where that was asked for.
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
    failures: Sequence[str] = ()
    root: str = ""
    folder: str = ""
    fixed: int = 0
    has_baseline: bool = False
    drawn: Mapping[str, Drawn] = MappingProxyType({})


class Parts(NamedTuple):
    """
    A report that is written file by file, as they are finished.

    of_file: what is said of a file, given the lines that its findings stand in; to be called once for each, in their
    order. end: what is said behind all of them.
    """

    of_file: Callable[[FileReport, Mapping[int, str]], str]
    end: Callable[[Report], str]


def formats() -> list[str]:
    """The names of the formats: the modules of this package, those for people first."""
    found = {path.stem for path in Path(__file__).parent.glob("*.py")} - {"__init__"}
    return [*FOR_PEOPLE, *sorted(found.difference(FOR_PEOPLE))]


def render(form: str, report: Report, background: Background) -> str:
    """The report in one of the formats."""
    function = getattr(_module(form), form)
    return str(function(report, background))


def parts(form: str, background: Background) -> Parts | None:
    """How a format is written file by file; None where it must know all files first."""
    make = getattr(_module(form), f"{form}_parts", None)
    return make(background) if make else None


def pieces(form: str, report: Report, background: Background) -> Iterator[str]:
    """The same text as that of render, of many files bit by bit, where the format can do so."""
    of_format = getattr(_module(form), f"{form}_pieces", None)
    yield from of_format(report, background) if of_format else (render(form, report, background),)


def of_each(parts: Parts, report: Report, background: Background) -> Iterator[str]:
    """A report in parts, of files that are all there."""
    for file in report.files:
        yield parts.of_file(file, background.lines.get(file.path, {}))
    yield parts.end(report)


def _module(form: str) -> ModuleType:
    return importlib.import_module(f"polarcheck.reports.{form}")


def counted(number: int, noun: str) -> str:
    """`1 error`, `2 errors`, `2 fixes`."""
    ending = "" if number == 1 else "es" if noun.endswith("x") else "s"
    return f"{number} {noun}{ending}"


def painted(style: str, text: str) -> str:
    """The text in color for a terminal."""
    return f"\x1b[{_STYLES[style]}m{text}\x1b[0m" if text else text
