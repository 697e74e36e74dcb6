"""`polarcheck schema`: the JSON Schemas of reports, job files, machine files, feed tables and traces."""

from __future__ import annotations

import click

from polarcheck.commands import options
from polarcheck.commands.output import show


@click.command(short_help="Show the JSON Schema of the report, the job, the machine, the feed table or the trace.")
@click.argument("name", type=click.Choice(["report", "job", "machine", "feeds", "trace"]), default="report")
@options.debug
def schema(name: str) -> None:
    """Show the JSON Schema of the JSON report, of polarcheck.toml (job), of a machine profile, feed table or trace."""
    from polarcheck.reports.pages import schema as schemas

    show(schemas.text(name).encode())
