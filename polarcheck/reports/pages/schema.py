"""JSON Schema of the report, of polarcheck.toml and of machine profiles, from the types that read and write them."""

from __future__ import annotations

import math
from typing import Any

import msgspec

from polarcheck.checking.finding import Report, Severity
from polarcheck.machines.job import Job
from polarcheck.machines.machine import Machine

DIALECT = "https://json-schema.org/draft/2020-12/schema"
VERDICTS = ("pass", "fail", "unverified")

Schema = dict[str, Any]


def schema(name: str) -> Schema:
    """The schema of `report`, `job` or `machine`."""
    made = {"report": _report, "job": _job, "machine": _machine}[name]()
    return {"$schema": DIALECT, "$id": f"urn:polarcheck:{name}:1", **made}


def text(name: str) -> str:
    """The same as JSON."""
    return msgspec.json.format(msgspec.json.encode(schema(name)), indent=2).decode() + "\n"


def _report() -> Schema:
    made: Schema = _without_nan(msgspec.json.schema(Report))
    definitions = made["$defs"]
    definitions["Finding"]["properties"]["severity"] = {"enum": [level.name.lower() for level in reversed(Severity)]}
    definitions["FileReport"]["properties"]["verdict"] = {"enum": list(VERDICTS)}
    definitions["Report"]["properties"]["schema"] = {"const": 1}
    return made


def _job() -> Schema:
    made: Schema = _without_nan(msgspec.json.schema(Job))
    job = made["$defs"]["Job"]["properties"]
    job["tools"]["propertyNames"] = {"pattern": "^[0-9]+$"}
    job["limits"] = {"$ref": "#/$defs/Limits"}
    limits = _without_nan(msgspec.json.schema(Machine))["$defs"]["Limits"]
    made["$defs"]["Limits"] = {**limits, "required": []}
    return made


def _machine() -> Schema:
    """A profile as a file holds it: a part of the machine, each value bare or with its source, and what it inherits."""
    made: Schema = _without_nan(msgspec.json.schema(Machine))
    machine = made["$defs"]["Machine"]["properties"]
    groups = {value["$ref"].rpartition("/")[2] for value in machine.values() if "$ref" in value}
    for name in groups:
        properties = made["$defs"][name]["properties"]
        made["$defs"][name] |= {"required": [], "properties": {key: _sourced(properties[key]) for key in properties}}
    for key, value in machine.items():
        if value.get("type") == "object":
            value["additionalProperties"] = _sourced(value["additionalProperties"])
        elif "$ref" not in value:
            machine[key] = _sourced(value)
    made["$defs"]["Machine"]["required"] = []
    for key, (kind, description) in _OF_FILES.items():
        machine[key] = {"description": description, **kind}
    return made


#: Keys that stand in a file but not in the merged profile.
_OF_FILES: dict[str, tuple[Schema, str]] = {
    "inherits": ({"type": "string"}, "the name of a built-in machine, or a TOML file"),
    "replaces": ({"type": "array", "items": {"type": "string"}}, "tables of which nothing is inherited"),
}


def _sourced(value: Schema) -> Schema:
    properties = {"value": value, "source": {"type": "string"}, "doubtful": {"type": "boolean"}}
    wrapped = {"type": "object", "properties": properties, "required": ["value"], "additionalProperties": False}
    return {"anyOf": [{key: part for key, part in value.items() if key != "default"}, wrapped]}


def _without_nan(value: Any) -> Any:
    """Without the defaults that JSON cannot hold: NaN, which stands for unknown."""
    if isinstance(value, list):
        return [_without_nan(element) for element in value]
    if not isinstance(value, dict):
        return value
    return {
        key: _without_nan(element) for key, element in value.items() if not (key == "default" and _has_nan(element))
    }


def _has_nan(value: Any) -> bool:
    if isinstance(value, dict):
        return any(map(_has_nan, value.values()))
    return isinstance(value, float) and math.isnan(value)
