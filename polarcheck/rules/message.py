"""
The message of a finding: the template of its rule, filled with what stands at one hit.

A name in braces is a value that the rule returns (Hits.values), else one of its details, else a property of the hit
(rules/hit.py); `{X}` is the last word of that address in the row, as it is written. The values of the finding are
names of the same kind.

The format behind the colon is one of quantity.Quantity; `{feed:feed/limit}` has as many digits as it takes to tell the
feed from the limit, another name of the message.
"""

from __future__ import annotations

import string
from collections.abc import Mapping
from typing import Any

import numpy as np

from polarcheck.foundation.errors import RuleError
from polarcheck.rules.hit import Hit
from polarcheck.rules.quantity import Quantity, rounded
from polarcheck.rules.rule import Hits, Rule
from polarcheck.rules.tables import Tables, called
from polarcheck.rules.vocabulary import Kind, kinds


def fill(rule: Rule, hits: Hits, tables: Tables, hit: Hit) -> tuple[str, dict[str, int | float | str]]:
    """
    The message of one hit, and the values of the finding by name, those that are known (rules/vocabulary.py).

    Raises RuleError for a name that stands for nothing.
    """
    template = _Template(rule, hits, tables, hit)
    found = {name: as_data(template.value(name), kind) for name, kind in kinds(rule.values, rule.name).items()}
    return template.vformat(rule.message, (), {}), {name: value for name, value in found.items() if value is not None}


def as_data(value: Any, kind: Kind) -> int | float | str | None:
    """A value as a report holds it, in its unit; None where it is not known or does not apply."""
    if isinstance(value, str) or value is None:
        return value or None
    if not np.isfinite(value):
        return None
    return int(value) if kind.is_whole else rounded(value)


class _Template(string.Formatter):
    def __init__(self, rule: Rule, hits: Hits, tables: Tables, hit: Hit) -> None:
        self.rule, self.hits, self.hit = rule, hits, hit
        self.details = details_of(rule, tables, hit)

    def get_field(self, field_name: str, args: Any, kwargs: Any) -> tuple[Any, str]:
        return self._shown(self.value(field_name)), field_name

    def format_field(self, value: Any, format_spec: str) -> str:
        form, is_compared, other = format_spec.partition("/")
        if not is_compared:
            return str(super().format_field(value, format_spec))
        its = self._shown(self.value(other))
        if not isinstance(value, Quantity) or not isinstance(its, Quantity):
            raise RuleError(f"{self.rule.name}: {format_spec}: only numbers can be told apart")
        return value.beside(its, form)

    def value(self, name: str) -> Any:
        """What a name of the message stands for."""
        if name in self.hits.values:
            value = self.hits.values[name]
            return value[self.hit.index] if isinstance(value, np.ndarray | list) else value
        if name in self.details:
            return self.details[name]
        if len(name) == 1 and name.isupper():
            return self.hit.written(name)
        if not hasattr(Hit, name):
            raise RuleError(f"{name} in a message of {self.rule.name}: neither the rule nor its details have it")
        return getattr(self.hit, name)

    def _shown(self, value: Any) -> Any:
        value = value.item() if isinstance(value, np.generic) else value
        return value if isinstance(value, str | Quantity) else self.hit.quantity(value)


def details_of(rule: Rule, tables: Tables, hit: Hit) -> Mapping[str, Any]:
    """The details of one hit; empty for a rule without any."""
    function = rule.companion("details")
    return called(function, tables, {"hit": hit}) if function else {}
