"""`polarcheck schema`: the JSON Schemas of reports, job files, machine files, feed tables and traces."""

from __future__ import annotations

import click

from polarcheck.commands import options
from polarcheck.commands.output import show

_NAMES = ("report", "job", "machine", "feeds", "trace", "comparison", "rewriting", "manifest", "certificate")
#: Those of rewrite/schemas.py.
_REWRITTEN = ("feeds", "comparison", "rewriting", "manifest", "certificate")


@click.command(short_help="Show the JSON Schema of a report, the job, a machine, feed table, trace, ...")
@click.argument("name", type=click.Choice(_NAMES), default="report")
@options.debug
def schema(name: str) -> None:
    """
    Show a JSON Schema: of a report, polarcheck.toml (job), a machine profile, a feed table, a trace, a comparison,
    what comes of rewriting a program, or the manifest and the certificate of a post.
    """
    from polarcheck.reports.pages import json_schema as schemas

    if name in _REWRITTEN:
        from polarcheck.rewrite.schemas import schema as of_wing

        content = of_wing(name)
    else:
        content = schemas.schema(name)
    show(schemas.as_text(content).encode())
