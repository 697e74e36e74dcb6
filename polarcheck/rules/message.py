"""
The message of a finding: the template of its rule, filled with what stands at one place.

The form of a name in braces says what it is:
- `{feedrate.feed}`: a column of a table, at the row of the place; of `machine` and `job` the value itself;
- `{X}`: the last word of that address in the row, as it is written;
- any other: a value that the rule hands over (Hits.values), else a phrase, a function of that name in
  wording/phrases/<group of the rule>.py or wording/phrases/common.py.
The values of the finding stand beside it: a rule names them, and where each comes from, in the same forms. What is a
number there and no column is a measure, a function in wording/measures/<group of the rule>.py.
A phrase or a measure takes by their names the tables that it needs, and `place`, `row`, `index` (see Place), `at`, the
executed words at fault, or `count`, how many elements the finding stands for.

The format behind the colon is one of quantity.Quantity; `{feedrate.feed:feed/limit}` has as many digits as it takes to
tell the feed from the limit, another name of the message.
"""

from __future__ import annotations

import importlib
import string
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from polarcheck.foundation.errors import RuleError
from polarcheck.rules.places import Place
from polarcheck.rules.quantity import Quantity, in_row, rounded
from polarcheck.rules.rule import Hits, Rule
from polarcheck.rules.tables import Tables, parameters
from polarcheck.rules.vocabulary import Kind, kinds
from polarcheck.rules.wording.phrases.common import written

_PHRASES, _MEASURES = "polarcheck.rules.wording.phrases", "polarcheck.rules.wording.measures"
#: Tables of single values, which messages show as they are.
_SETTINGS = ("machine", "job")


def fill(
    rule: Rule, hits: Hits, tables: Tables, place: Place, at: list[int], count: int = 1
) -> tuple[str, dict[str, int | float | str]]:
    """
    The message at one place, and the values of the finding by name, those that are known (rules/vocabulary.py).

    at: the executed words at fault. count: how many elements the finding stands for. Raises RuleError for a name that
    stands for nothing.
    """
    template = _Template(rule, hits, tables, place, at, count)
    found = {
        name: as_data(template.source(rule.values[name]), kind) for name, kind in kinds(rule.values, rule.name).items()
    }
    return template.vformat(rule.message, (), {}), {name: value for name, value in found.items() if value is not None}


def as_data(value: Any, kind: Kind) -> int | float | str | None:
    """A value as a report holds it, in its unit; None where it is not known or does not apply."""
    if isinstance(value, str) or value is None:
        return value or None
    if not np.isfinite(value):
        return None
    return int(value) if kind.is_whole else rounded(value)


class _Template(string.Formatter):
    def __init__(self, rule: Rule, hits: Hits, tables: Tables, place: Place, at: list[int], count: int) -> None:
        self.rule, self.hits, self.tables = rule, hits, tables
        self.place = place
        self.given: dict[str, Any] = {"place": place, "row": place.row, "index": place.index, "at": at, "count": count}

    def source(self, path: str) -> Any:
        """The value that a path stands for: a name of a message, or a measure, and an attribute of it."""
        name, _, attribute = path.partition(".")
        measured = measure(name, self.rule.group)
        if measured is None:
            return self._value(path)
        value = called(measured, self.tables, self.given)
        return getattr(value, attribute) if attribute else value

    def get_field(self, field_name: str, args: Any, kwargs: Any) -> tuple[Any, str]:
        value = self._value(field_name)
        return value if field_name.partition(".")[0] in _SETTINGS else self._shown(value), field_name

    def format_field(self, value: Any, format_spec: str) -> str:
        form, is_compared, other = format_spec.partition("/")
        if not is_compared:
            return str(super().format_field(value, format_spec))
        values = (self._shown(one) for one in (value, self._value(other)))
        mine, its = (one if isinstance(one, Quantity) else None for one in values)
        if mine is None or its is None:
            raise RuleError(f"{self.rule.name}: {format_spec}: only numbers can be told apart")
        return mine.beside(its, form)

    def _value(self, name: str) -> Any:
        return self._column(name) if "." in name else self._named(name)

    def _column(self, path: str) -> Any:
        found = self.tables.column(path)
        return found[self.place.row] if isinstance(found, np.ndarray) else found

    def _named(self, name: str) -> Any:
        if len(name) == 1 and name.isupper():
            return written(self.tables["blocks"], self.tables["run"], self.place.row, name)
        if name not in self.hits.values:
            return called(phrase(name, self.rule.group), self.tables, self.given)
        value = self.hits.values[name]
        return value[self.place.index] if isinstance(value, np.ndarray | list) else value

    def _shown(self, value: Any) -> Any:
        value = value.item() if isinstance(value, np.generic) else value
        return value if isinstance(value, str | Quantity) else in_row(value, self.tables["lengths"], self.place.row)


def called(function: Callable[..., Any], tables: Mapping[str, Any], given: Mapping[str, Any]) -> Any:
    """A function with what its parameters name, given values first, then tables."""
    return function(*(given[name] if name in given else tables[name] for name in parameters(function)))


def phrase(name: str, group: str) -> Callable[..., Any]:
    """
    The phrase of this name for the rules of a group.

    Raises RuleError where there is none.
    """
    function = _function(f"{_PHRASES}.{group}", name) or _function(f"{_PHRASES}.common", name)
    if function is None:
        raise RuleError(
            f"{name} in a message of the group {group}: no value is handed over and there is no such phrase"
        )
    return function


def measure(name: str, group: str) -> Callable[..., Any] | None:
    """The measure of this name for the rules of a group; None where there is none."""
    return _function(f"{_MEASURES}.{group}", name)


def _function(module: str, name: str) -> Callable[..., Any] | None:
    """A function of a module; None where the module or the function is missing."""
    try:
        function: Callable[..., Any] | None = getattr(importlib.import_module(module), name, None)
    except ModuleNotFoundError:
        return None
    return function
