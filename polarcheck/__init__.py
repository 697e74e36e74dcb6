"""
polarcheck: checks NC programs that use polar coordinate interpolation, before the lathe does.

    >>> import polarcheck
    >>> report = polarcheck.check("O1234.NC", machine="fanuc-30i", tools={8: 6.35})
    >>> trace = polarcheck.trace("O1234.NC", tools={8: 6.35})

All that is public is listed in `polarcheck.__all__`; docs/api.md says what is promised. A function is imported when it
is first used: `import polarcheck` alone loads no other module.
"""

from __future__ import annotations

import sys
from types import ModuleType
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from polarcheck.api.certificates import certify as certify
    from polarcheck.api.checks import check as check
    from polarcheck.api.checks import check_text as check_text
    from polarcheck.api.comparisons import compare as compare
    from polarcheck.api.comparisons import compare_text as compare_text
    from polarcheck.api.feed_tables import Feeds as Feeds
    from polarcheck.api.feed_tables import feeds as feeds
    from polarcheck.api.feed_tables import feeds_text as feeds_text
    from polarcheck.api.lathes import machine as machine
    from polarcheck.api.lathes import machine_names as machine_names
    from polarcheck.api.pages import plot as plot
    from polarcheck.api.pages import plot_text as plot_text
    from polarcheck.api.parts import MadePart as MadePart
    from polarcheck.api.parts import part as part
    from polarcheck.api.parts import part_text as part_text
    from polarcheck.api.rendering import render as render
    from polarcheck.api.rewritings import Rewritten as Rewritten
    from polarcheck.api.rewritings import compensate as compensate
    from polarcheck.api.rewritings import compensate_text as compensate_text
    from polarcheck.api.rewritings import convert as convert
    from polarcheck.api.rewritings import convert_text as convert_text
    from polarcheck.api.rewritings import roll as roll
    from polarcheck.api.rewritings import roll_text as roll_text
    from polarcheck.api.rewritings import unroll as unroll
    from polarcheck.api.rewritings import unroll_text as unroll_text
    from polarcheck.api.traces import Move as Move
    from polarcheck.api.traces import Trace as Trace
    from polarcheck.api.traces import trace as trace
    from polarcheck.api.traces import trace_text as trace_text
    from polarcheck.foundation import errors as errors
    from polarcheck.foundation.finding import FileReport as FileReport
    from polarcheck.foundation.finding import Finding as Finding
    from polarcheck.foundation.finding import Report as Report
    from polarcheck.foundation.version import __version__ as __version__
    from polarcheck.program.machines.job import Stock as Stock
    from polarcheck.program.machines.job import Tool as Tool
    from polarcheck.program.machines.job import WorkOffset as WorkOffset
    from polarcheck.program.machines.machine import Machine as Machine
    from polarcheck.program.machines.part_keys import Part as Part
    from polarcheck.rewrite.certify.results import Certificate as Certificate
    from polarcheck.rewrite.compare.comparison_report import Comparison as Comparison


#: What is public, and the module of each; the imports above tell type checkers the same.
_MODULES = {
    name: module
    for module, names in {
        "api.certificates": "certify",
        "api.checks": "check check_text",
        "api.comparisons": "compare compare_text",
        "api.rewritings": "compensate compensate_text convert convert_text roll roll_text unroll unroll_text Rewritten",
        "api.feed_tables": "feeds feeds_text Feeds",
        "api.lathes": "machine machine_names",
        "api.parts": "part part_text MadePart",
        "api.pages": "plot plot_text",
        "api.rendering": "render",
        "api.traces": "trace trace_text Move Trace",
        "rewrite.compare.comparison_report": "Comparison",
        "rewrite.certify.results": "Certificate",
        "foundation.finding": "FileReport Finding Report",
        "program.machines.machine": "Machine",
        "program.machines.part_keys": "Part",
        "program.machines.job": "Stock Tool WorkOffset",
        "foundation.version": "__version__",
    }.items()
    for name in names.split()
}
__all__ = [*_MODULES, "errors"]


if not TYPE_CHECKING:  # a name that is not public is an error for type checkers, too

    def __getattr__(name: str) -> Any:
        """Import what is public when it is first used."""
        import importlib

        if name == "errors":
            return importlib.import_module("polarcheck.foundation.errors")
        if name not in _MODULES:
            raise AttributeError(f"module 'polarcheck' has no attribute {name!r}")
        value = getattr(importlib.import_module(f"polarcheck.{_MODULES[name]}"), name)
        globals()[name] = value
        return value


class _Errors(ModuleType):
    """The public name of `foundation.errors`, as in `from polarcheck.errors import UsageError`; loads it when used."""

    def __getattr__(self, name: str) -> Any:
        from polarcheck.foundation import errors

        return getattr(errors, name)


sys.modules["polarcheck.errors"] = _Errors("polarcheck.errors")


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
