"""JSON Schema of feed tables, comparisons, rewritten programs, and of the manifest and the certificate of a post."""

from __future__ import annotations

import msgspec

from polarcheck.foundation.finding import VERDICTS
from polarcheck.program.machines.job import OfPrograms
from polarcheck.reports.pages.json_schema import OF_JOBS, Schema, describe, headed, without_nan
from polarcheck.rewrite.certify.manifest import DECIDED, Manifest
from polarcheck.rewrite.certify.results import SCHEMA, STATES, Certificate


def schema(name: str) -> Schema:
    """Return the schema of `feeds`, `comparison`, `rewriting`, `manifest` or `certificate`."""
    return headed(name, _MAKERS[name]())


def _feeds() -> Schema:
    # Imports NumPy, which the other schemas do not need.
    from polarcheck.rewrite.feeds.table import LIMITED_BY, FeedReport

    content: Schema = msgspec.json.schema(FeedReport)
    content["$defs"]["FeedReport"]["properties"]["schema"] = {"const": 1}
    content["$defs"]["FeedRow"]["properties"]["limited_by"] = {"enum": list(LIMITED_BY)}
    return content


def _comparison() -> Schema:
    from polarcheck.rewrite.compare.comparison_report import CHANGES, VERDICTS, ComparisonReport

    content: Schema = msgspec.json.schema(ComparisonReport)
    content["$defs"]["ComparisonReport"]["properties"]["schema"] = {"const": 1}
    content["$defs"]["Comparison"]["properties"]["verdict"] = {"enum": list(VERDICTS)}
    content["$defs"]["SectionPair"]["properties"]["change"] = {"enum": list(CHANGES)}
    return content


def _rewriting() -> Schema:
    from polarcheck.rewrite.writing.rewriting_report import COMMANDS, RewritingReport

    content: Schema = msgspec.json.schema(RewritingReport)
    properties = content["$defs"]["RewritingReport"]["properties"]
    properties["schema"] = {"const": 1}
    properties["command"] = {"enum": list(COMMANDS)}
    # What is not known is NaN, which JSON writes as null.
    content["$defs"]["Figure"]["properties"]["value"] = {"type": ["number", "null"]}
    return content


def _manifest() -> Schema:
    content: Schema = without_nan(msgspec.json.schema(Manifest))
    kinds = "Manifest", "Control", "Case"
    describe(content, {**dict.fromkeys(kinds, OfPrograms), **OF_JOBS})
    for kind in kinds:
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


_MAKERS = {
    "feeds": _feeds,
    "comparison": _comparison,
    "rewriting": _rewriting,
    "manifest": _manifest,
    "certificate": _certificate,
}
