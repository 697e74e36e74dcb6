"""JSON Schema of the report, of polarcheck.toml and of machine profiles, from the types that read and write them."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from typing import Any

import msgspec

from polarcheck.foundation.finding import SCHEMA, SILENCED_BY, VERDICTS, Report, Severity
from polarcheck.program.machines.job import Job, Programs, Running, Stock, Tool
from polarcheck.program.machines.machine import Machine, meanings
from polarcheck.program.machines.part_keys import Part
from polarcheck.rules.vocabulary import VOCABULARY, Kind

DIALECT = "https://json-schema.org/draft/2020-12/schema"

Schema = dict[str, Any]

#: The JSON types of the values that have no unit.
_TYPES: dict[Kind | None, str | list[str]] = {
    Kind.COUNT: "integer",
    Kind.LINE: "integer",
    Kind.NUMBER: "integer",
    Kind.OFFSET: ["integer", "string"],
    Kind.TEXT: "string",
}


def schema(name: str) -> Schema:
    """Return the schema of `report`, `job`, `machine` or `trace`."""
    content = {"report": _report, "job": _job, "machine": _machine, "trace": _trace}[name]()
    return headed(name, content, SCHEMA if name == "report" else 1)


def headed(name: str, content: Schema, number: int = 1) -> Schema:
    """Return a schema with its dialect and its identifier, which ends with the number of its version."""
    return {"$schema": DIALECT, "$id": f"urn:polarcheck:{name}:{number}", **content}


def as_text(content: Schema) -> str:
    """Return any schema as JSON."""
    return msgspec.json.format(msgspec.json.encode(content), indent=2).decode() + "\n"


def _report() -> Schema:
    content: Schema = without_nan(msgspec.json.schema(Report))
    definitions = content["$defs"]
    for kind in ("Finding", "Silenced"):
        definitions[kind]["properties"]["values"] = _values()
        definitions[kind]["properties"]["severity"] = {"enum": [level.name.lower() for level in reversed(Severity)]}
    definitions["Silenced"]["properties"]["by"] = {"enum": list(SILENCED_BY)}
    definitions["FileReport"]["properties"]["verdict"] = {"enum": list(VERDICTS)}
    for name in ("makes", "outline"):  # no part of the contract
        del definitions["FileReport"]["properties"][name]
    del definitions["Outline"]
    definitions["Report"]["properties"]["schema"] = {"const": SCHEMA}
    return content


def _values() -> Schema:
    """Return the schema of the values of a finding: each name with its type and unit."""
    properties: Schema = {}
    for name, (kind, meaning) in VOCABULARY.items():
        types = _TYPES.get(kind)
        unit = f" [{kind.value}]" if kind and types is None else ""
        properties[name] = {"type": types or "number", "description": f"{meaning}{unit}"}
    return {"type": "object", "properties": properties, "additionalProperties": False, "default": {}}


def _trace() -> Schema:
    # Imports NumPy, which the other schemas do not need.
    from polarcheck.reports.pages.trace_report import OF_LINES, SCHEMA, UNITS, TraceReport

    content: Schema = msgspec.json.schema(TraceReport)
    report, move = content["$defs"]["TraceReport"], content["$defs"]["Move"]
    report["properties"]["schema"] = {"const": SCHEMA}
    report["properties"]["units"] = {"const": UNITS}
    report["properties"]["requested"] = {"enum": ["tool", "programmed"]}
    move["properties"]["path"] = {"enum": ["tool", "programmed"]}
    move["properties"]["kind"] = {"enum": ["line", "cw", "ccw"]}
    for name in ("start", "end", "center", "z", "x_axis", "c_axis"):
        _as_pair(move["properties"][name])
    for name, unit in UNITS.items():
        move["properties"][name]["description"] = unit
    move["required"] = [name for name in move["required"] if name not in OF_LINES]
    return content


def _as_pair(value: Schema) -> None:
    for schema in (value, *value.get("anyOf", ())):
        if schema.get("type") == "array":
            schema |= {"minItems": 2, "maxItems": 2}


def _job() -> Schema:
    content: Schema = without_nan(msgspec.json.schema(Job))
    describe(content, {"Job": Job, "Programs": Programs, **OF_JOBS})
    for kind in ("Job", "Programs"):
        content["$defs"][kind]["properties"]["limits"] = {"$ref": "#/$defs/Limits"}
    limits = without_nan(msgspec.json.schema(Machine))["$defs"]["Limits"]
    content["$defs"]["Limits"] = {**limits, "required": []}
    return content


#: Tables of a job file that a manifest has, too.
OF_JOBS: dict[str, type] = {kind.__name__: kind for kind in (Tool, Stock, Running, Part)}


def describe(content: Schema, kinds: Mapping[str, type]) -> None:
    """Put into each table of the schema, by its name, what the docstring of a type says of its keys."""
    for name, kind in kinds.items():
        table = content["$defs"][name]
        if name == kind.__name__:
            table["description"] = re.split(r"\n+\w+: ", table["description"])[0]
        for key, meaning in meanings(kind).items():
            value = table["properties"][key]
            optional = value.get("anyOf", ())
            if {"type": "null"} in optional:
                optional[0] = {"description": meaning, **optional[0]}
            else:
                table["properties"][key] = {"description": meaning, **value}


def _machine() -> Schema:
    """
    Return the schema of a machine file.

    It sets some values of the machine, each bare or with its source, and names the profile that it inherits from.
    """
    content: Schema = without_nan(msgspec.json.schema(Machine))
    machine = content["$defs"]["Machine"]["properties"]
    for kind in {field.type for field in msgspec.structs.fields(Machine) if "$ref" in machine[field.name]}:
        table, meaning = content["$defs"][kind.__name__], meanings(kind)
        properties = {
            key: _sourced(value) | ({"description": meaning[key]} if key in meaning else {})
            for key, value in table["properties"].items()
        }
        table |= {"required": [], "properties": {**_OF_TABLES, **properties}}
        table["description"] = table.get("description", "").partition("\n")[0]
    for key, value in machine.items():
        if value.get("type") == "object":
            value["additionalProperties"] = _sourced(value["additionalProperties"])
            value["properties"] = _OF_TABLES
        elif "$ref" not in value:
            machine[key] = _sourced(value)
    for key, description in meanings(Machine).items():
        machine[key]["description"] = description
    content["$defs"]["Machine"] |= {"required": [], "description": "A lathe, or what makes it differ from another one."}
    for key, (kind, description) in _OF_FILES.items():
        machine[key] = {"description": description, **kind}
    return content


#: Keys that stand in a file but not in the merged profile.
_OF_FILES: dict[str, tuple[Schema, str]] = {
    "inherits": ({"type": "string"}, "the name of a built-in machine, or a TOML file"),
    "replaces": ({"type": "array", "items": {"type": "string"}}, "tables of which nothing is inherited"),
}
#: Keys that any table of a file may have.
_OF_TABLES: dict[str, Schema] = {
    "source": {"type": "string", "description": "of those values of the table that name none of their own"},
    "doubtful": {"type": "boolean", "description": "whether those values that do not say it themselves are in doubt"},
}


def _sourced(value: Schema) -> Schema:
    properties = {"value": value, "source": {"type": "string"}, "doubtful": {"type": "boolean"}}
    wrapped = {"type": "object", "properties": properties, "required": ["value"], "additionalProperties": False}
    return {"anyOf": [{key: part for key, part in value.items() if key != "default"}, wrapped]}


def without_nan(value: Any) -> Any:
    """Remove defaults that are NaN (unknown), which JSON cannot hold."""
    if isinstance(value, list):
        return [without_nan(element) for element in value]
    if not isinstance(value, dict):
        return value
    return {key: without_nan(element) for key, element in value.items() if not (key == "default" and _has_nan(element))}


def _has_nan(value: Any) -> bool:
    if isinstance(value, dict):
        return any(map(_has_nan, value.values()))
    return isinstance(value, float) and math.isnan(value)
