"""docs/report_fields.md: each field of the JSON report, from the types that hold it."""

from __future__ import annotations

import inspect
import itertools
import re
from collections.abc import Iterator, Mapping
from typing import Any

import msgspec

from generators.tables import GENERATED, row, rule_under
from polarcheck.foundation import finding
from polarcheck.reports.pages import json_schema
from polarcheck.reports.pages.markdown import prose

_BEGINNING = f"""# The fields of the JSON report

{GENERATED}

`json` is one object, the [report](#report). `jsonl` has the same objects, a line each, with `type` and `path`:
`finding`, `silenced`, `file`, and at the end `summary`, in which the fields of the report and of its summary stand
together. Lengths are mm and X is a radius, rates deg/min, feeds mm/min, times s, whatever the units of the program.
Lines and columns count from 1. What is null is unknown or does not apply; fields marked with * may be absent.
[values.md](values.md) has the names in `values` of a finding. `polarcheck schema` prints all this as JSON Schema.
"""

_FIELDS = re.compile(r"^(\w+(?:, \w+)*): ")
_TYPES = {"integer": "whole number", "null": "null", "array": "list", "object": "object"}


def text() -> str:
    """Return the page."""
    definitions = json_schema.schema("report")["$defs"]
    lines = [_BEGINNING]
    for name in _order(definitions, "Report"):
        kind = getattr(finding, name)
        about, meanings = documented(kind)
        above = kind.__mro__[1].__name__
        of_above = definitions.get(above, {"properties": {}})["properties"]
        more = f" It has all fields of [{above}](#{above.lower()}), and:" if of_above else ""
        lines += [f"## {name}", "", prose(about) + more, "", *rule_under("field", "type", "what it is")]
        lines += _rows(
            kind,
            {field: value for field, value in definitions[name]["properties"].items() if field not in of_above},
            meanings,
        )
        lines.append("")
    return "\n".join(lines).rstrip("\n") + "\n"


def _rows(kind: Any, fields: Mapping[str, Any], meanings: Mapping[str, str]) -> Iterator[str]:
    """Yield a row for each field; fields that their docstring explains together stand in one."""
    alike = itertools.groupby(fields.items(), lambda item: (meanings[item[0]], _type(item[1])))
    for (meaning, shown), items in alike:
        names = ", ".join(f"`{field}`{_may_be_absent(kind, field)}" for field, _ in items)
        yield row(names, shown, prose(meaning.removesuffix(".")))


def documented(kind: type) -> tuple[str, dict[str, str]]:
    """Return what a type is, and the meaning of each field, as its docstring and those of the types above it say."""
    about, meanings = "", dict[str, str]()
    for of_class in reversed(kind.__mro__):
        if not of_class.__module__.startswith("polarcheck."):
            continue
        about, _, body = (inspect.cleandoc(of_class.__doc__ or "") + "\n\n").partition("\n\n")
        names: list[str] = []
        for line in filter(None, body.splitlines()):
            begins = _FIELDS.match(line)
            if begins:
                names = begins[1].split(", ")
                meanings |= dict.fromkeys(names, line[begins.end() :])
            else:
                meanings |= {name: f"{meanings[name]} {line.strip()}" for name in names}
    return " ".join(about.split()), meanings


def _order(definitions: Mapping[str, Any], first: str) -> list[str]:
    """The types in the order in which a reader of the report meets them."""
    order: list[str] = []
    following = [first]
    while following:
        name = following.pop(0)
        if name not in order:
            order.append(name)
            found = _references(definitions[name]["properties"])
            following += found
    return order


def _references(value: Any) -> Iterator[str]:
    for key, part in value.items() if isinstance(value, dict) else ():
        if key == "$ref":
            yield part.rpartition("/")[2]
        yield from _references(part)
    for part in value if isinstance(value, list) else ():
        yield from _references(part)


def _may_be_absent(kind: Any, name: str) -> str:
    fields = {field.encode_name: field for field in msgspec.structs.fields(kind)}
    return " \\*" if fields[name].default is msgspec.UNSET else ""


def _type(value: Mapping[str, Any]) -> str:
    if "$ref" in value:
        name = value["$ref"].rpartition("/")[2]
        return f"[{name}](#{name.lower()})"
    if "anyOf" in value:
        return " or ".join(dict.fromkeys(map(_type, value["anyOf"])))
    if "enum" in value:
        return " or ".join(f"`{one}`" for one in value["enum"])
    if "const" in value:
        return f"`{value['const']}`"
    if value["type"] == "array":
        items = value.get("items") or None
        return f"list of {_type(items)}" if items else "list of two numbers"
    return _TYPES.get(value["type"], "text" if value["type"] == "string" else value["type"])
