"""What a rule is, and how rules are found. Nothing is registered: a file under rules/ is a rule."""

from __future__ import annotations

import functools
import importlib
import re
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

import msgspec

from polarcheck.checking.finding import ERROR, NOTE, WARNING, Severity
from polarcheck.errors import RuleError, UsageError

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from polarcheck.arrays import Mask as Mask
    from polarcheck.machines.job import Job as Job
    from polarcheck.machines.machine import Machine as Machine
    from polarcheck.machines.modal import Motion as Motion
    from polarcheck.reading.words import Text as Text
    from polarcheck.reading.words import Words as Words
    from polarcheck.table.trace import Trace as Trace

    #: A mask, or one Severity per row (0 for nothing), alone or with columns for the message.
    Hits = NDArray[Any] | tuple[NDArray[Any], dict[str, Any]]
else:
    Job = Machine = Trace = Text = Words = Mask = Hits = Any

__all__ = [
    "ERROR",
    "NOTE",
    "WARNING",
    "Example",
    "Hits",
    "Job",
    "Machine",
    "Mask",
    "Rule",
    "Severity",
    "Text",
    "Trace",
    "Words",
    "examples",
    "find",
    "load_all",
    "rule",
]

FOLDER = Path(__file__).parent.parent / "rules"

#: What the elements of a mask can stand for.
TABLES = (
    "rows",
    "words",
    "sections",
    "comments",
    "strays",
    "foreign",
    "dots",
    "outside",
    "programs",
    "faults",
    "files",
)


class Rule(msgspec.Struct, frozen=True):
    """
    One rule: its function and what is said about it.

    over: the table that the mask belongs to. at: addresses or codes of the words at fault; the whole block if empty or
    if the block has none of them; where they differ by row, the function returns a column `at` instead. needs: columns
    without which the rule cannot say anything where `where` holds.
    once: report only the first in each section or program. unless: rules that, firing in the same row, say it better.
    worst: of a block that ran often, the run with the highest value of this column is reported.
    """

    name: str
    group: str
    severity: Severity
    message: str
    function: Callable[..., Any]
    over: str
    at: tuple[str, ...]
    needs: tuple[str, ...]
    where: str
    once: str
    unless: tuple[str, ...]
    worst: str
    parameters: tuple[str, ...]

    @property
    def page(self) -> str:
        """The manual page: the docstring."""
        import inspect

        return inspect.getdoc(self.function) or ""

    @property
    def title(self) -> str:
        """The first line of the page, without the full stop."""
        return self.page.partition("\n")[0].rstrip(".")

    @property
    def source(self) -> str:
        """What the page names as its source."""
        found = re.search(r"^Source: (.*?)(?:\n\n|\Z)", self.page, re.MULTILINE | re.DOTALL)
        return " ".join(found[1].split()) if found else ""


def rule(
    severity: Severity,
    message: str,
    *,
    over: str = "rows",
    at: tuple[str, ...] = (),
    needs: tuple[str, ...] = (),
    where: str = "in_polar",
    once: str = "",
    unless: tuple[str, ...] = (),
    worst: str = "",
) -> Callable[[Callable[..., Any]], Rule]:
    """Make a rule of a function; see Rule. The function names what it compares: trace, machine, job, text, words."""

    def make(function: Callable[..., Any]) -> Rule:
        group = function.__module__.split(".")[-2]
        name = function.__name__.replace("_", "-")
        if over not in TABLES:
            raise RuleError(f"rule {name}: over={over!r}: expected one of {', '.join(TABLES)}")
        parameters = function.__code__.co_varnames[: function.__code__.co_argcount]
        return Rule(name, group, severity, message, function, over, at, needs, where, once, unless, worst, parameters)

    return make


@functools.cache
def load_all() -> dict[str, Rule]:
    """
    All rules by name, in order of group and name.

    Raises RuleError for a file under rules/ that holds no rule of its own name.
    """
    rules = {}
    for path in sorted(FOLDER.glob("*/*.py")):
        if path.stem == "__init__":
            continue
        module = importlib.import_module(f"polarcheck.rules.{path.parent.name}.{path.stem}")
        found = getattr(module, path.stem, None)
        if not isinstance(found, Rule):
            raise RuleError(f"rules/{path.parent.name}/{path.name}: no rule named {path.stem}")
        rules[found.name] = found
    return rules


_HEADING = re.compile(r"^(Bad|Good)((?:, (?:machine|tool|set) [^\n,:]+(?:[:=][^\n,]*)?)*):$", re.MULTILINE)
_EXPECT = re.compile(r"\(expect: ([a-z0-9, -]+)\)")


class Example(msgspec.Struct, frozen=True):
    """
    A program of a manual page and what must be said of it.

    `Bad, machine turning-center, tool 8:radius=9.5, set limits.c_feed=3600:` heads a program for that machine, tool and
    value. expected: (line, rule) for each `(expect: rule)` in it, which is no part of the program.
    """

    good: bool
    machine: str
    tools: tuple[str, ...]
    settings: tuple[str, ...]
    program: str
    expected: tuple[tuple[int, str], ...]


def examples(page: str) -> list[Example]:
    """The Bad and Good programs of a manual page, in order."""
    found = []
    for match in _HEADING.finditer(page):
        body = []
        for line in page[match.end() :].lstrip("\n").split("\n"):
            if line and not line.startswith("    "):
                break
            body.append(line[4:])
        text = "\n".join(body).rstrip("\n") + "\n"
        expected = [
            (number, name.strip())
            for number, line in enumerate(text.split("\n"), 1)
            for match_ in _EXPECT.finditer(line)
            for name in match_[1].split(",")
        ]
        options = [option.partition(" ")[::2] for option in match[2].split(", ")[1:]]
        program = re.sub(r"[ \t]*\(expect: [^)\n]*\)[ \t]*$", "", text, flags=re.MULTILINE)
        found.append(
            Example(
                match[1] == "Good",
                next((value for key, value in options if key == "machine"), ""),
                tuple(value for key, value in options if key == "tool"),
                tuple(value for key, value in options if key == "set"),
                program,
                tuple(expected),
            )
        )
    return found


def find(name: str, rules: dict[str, Rule]) -> list[Rule]:
    """
    The rules of a name or of a group (polar, feed, ...), in any case, with - or _.

    Raises UsageError with the nearest name for an unknown one.
    """
    wanted = name.strip().lower().replace("_", "-").rstrip("/")
    if wanted == "all":
        return list(rules.values())
    found = [rule for rule in rules.values() if wanted in (rule.name, rule.group)]
    if not found:
        import difflib

        known = [*rules, *{rule.group for rule in rules.values()}]
        near = difflib.get_close_matches(wanted, known, 1)
        raise UsageError(f"unknown rule {name!r}" + (f"; did you mean {near[0]}?" if near else ""))
    return found
