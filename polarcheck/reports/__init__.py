"""Reports: a module for each format with a function of the same name, from findings to str. Nothing is printed here."""

from __future__ import annotations

import importlib
from collections.abc import Mapping
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from polarcheck.checking.finding import Report
    from polarcheck.checking.rule import Rule

SEVERITIES = ("error", "warning", "note")


class Background(NamedTuple):
    """
    What a report may show beside its findings.

    lines: by path and line number, those that findings stand in. rules: by name. columns: the width of the terminal.
    quiet: findings only.
    """

    lines: Mapping[str, Mapping[int, str]] = MappingProxyType({})
    rules: Mapping[str, Rule] = MappingProxyType({})
    columns: int = 100
    color: bool = False
    quiet: bool = False


def formats() -> list[str]:
    """The names of the formats: the modules of this package."""
    return sorted(path.stem for path in Path(__file__).parent.glob("*.py") if path.stem != "__init__")


def render(form: str, report: Report, background: Background) -> str:
    """The report in one of the formats."""
    function = getattr(importlib.import_module(f"polarcheck.reports.{form}"), form)
    return str(function(report, background))


def counted(number: int, noun: str) -> str:
    """`1 error`, `2 errors`."""
    return f"{number} {noun}" if number == 1 else f"{number} {noun}s"
