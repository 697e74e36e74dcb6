"""JSON Schema of the manifest and of the certificate, from the types that read and write them."""

from __future__ import annotations

import msgspec

from polarcheck.certification.manifest import DECIDED, Manifest
from polarcheck.certification.results import SCHEMA, STATES, Certificate
from polarcheck.finding import VERDICTS
from polarcheck.reports.pages.schema import DIALECT, Schema, without_nan

NAMES = ("manifest", "certificate")


def schema(name: str) -> Schema:
    """Return the schema of `manifest` or `certificate`."""
    content = _manifest() if name == "manifest" else _certificate()
    return {"$schema": DIALECT, "$id": f"urn:polarcheck:{name}:1", **content}


def _manifest() -> Schema:
    content: Schema = without_nan(msgspec.json.schema(Manifest))
    for kind in ("Manifest", "Control", "Case"):
        for key in DECIDED:
            del content["$defs"][kind]["properties"][key]
    return content


def _certificate() -> Schema:
    content: Schema = without_nan(msgspec.json.schema(Certificate))
    definitions = content["$defs"]
    definitions["Certificate"]["properties"]["schema"] = {"const": SCHEMA}
    definitions["CaseResult"]["properties"]["state"] = definitions["Cell"]["properties"]["state"] = {"enum": [*STATES]}
    definitions["CaseResult"]["properties"]["expected"] = {"enum": [*VERDICTS]}
    return content
