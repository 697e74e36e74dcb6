"""docs/values.md: the names of the values of findings, and which of them each rule gives."""

from __future__ import annotations

from collections.abc import Mapping

from generators.tables import GENERATED, row, rule_under
from polarcheck.reports.pages.markdown import prose
from polarcheck.rules.rule import Rule
from polarcheck.rules.vocabulary import LIMIT, VOCABULARY, Kind, kinds

_BEGINNING = f"""# The values of findings

{GENERATED}

Each finding of `json`, `jsonl` and `sarif` has `values`: the numbers of its message, and the codes, words and names in
it, under names that stay. A message may be worded anew, its values are a contract.

- The same name is the same thing in every rule, in the same unit, whatever the units of the program: an inch program
  gives mm, and X is a radius.
- Numbers are numbers, rounded to six decimals. What has no unit here is text.
- A value that is not known, or does not apply, is left out: a C rate without a limit in the profile has no `{LIMIT}`.
- `{LIMIT}` has the unit of the number before it in the second table.

`polarcheck rules --format json` has the values of each rule with their units, `polarcheck schema` has them as JSON
Schema.
"""

#: Kinds of whole numbers and text, which have no unit, in words.
_NO_UNIT = {
    Kind.COUNT: "a count",
    Kind.LINE: "a line",
    Kind.NUMBER: "a whole number",
    Kind.OFFSET: "a whole number, or text",
    Kind.TEXT: "text",
}


def text(rules: Mapping[str, Rule]) -> str:
    """Return the page."""
    lines = [_BEGINNING, "## The names", "", *rule_under("name", "unit", "what it is")]
    lines += [
        row(f"`{name}`", unit(meaning.kind) if meaning.kind else "of the number before it", prose(meaning.text))
        for name, meaning in sorted(VOCABULARY.items())
    ]
    lines += ["", "## The rules", "", "Rules that are not listed have no values.", "", *rule_under("rule", "values")]
    lines += [
        row(
            f"[{rule.name}](rules/{rule.group}/{rule.name}.md)",
            ", ".join(map(_shown, *zip(*of_rule.items(), strict=True))),
        )
        for rule, of_rule in ((rule, kinds(rule.values)) for rule in rules.values())
        if of_rule
    ]
    return "\n".join(lines) + "\n"


def unit(kind: Kind) -> str:
    """Return the unit of a kind, or what its values are."""
    return _NO_UNIT.get(kind, kind.value)


def _shown(name: str, kind: Kind) -> str:
    return f"`{name}`" if kind in _NO_UNIT else f"`{name}` {kind.value}"
