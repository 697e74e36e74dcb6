"""`polarcheck schema`: the JSON Schemas of reports, job files, machine files, feed tables and traces."""

from __future__ import annotations

import click

from polarcheck.commands import options
from polarcheck.commands.output import show


@click.command(
    short_help="Show the JSON Schema of the report, the job, the machine, feed table, trace or a comparison."
)
@click.argument(
    "name", type=click.Choice(["report", "job", "machine", "feeds", "trace", "comparison"]), default="report"
)
@options.debug
def schema(name: str) -> None:
    """Show the JSON Schema of the report, polarcheck.toml (job), a machine profile, feed table, trace or comparison."""
    from polarcheck.reports.pages import schema as schemas

    show(schemas.text(name).encode())
