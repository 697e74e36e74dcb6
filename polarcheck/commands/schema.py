"""`polarcheck schema`: the JSON Schemas of reports, job files, machine files, feed tables and traces."""

from __future__ import annotations

import click

from polarcheck.commands import options
from polarcheck.commands.output import show

_NAMES = ("report", "job", "machine", "feeds", "trace", "comparison")


@click.command(short_help="Show the JSON Schema of a report, the job, a machine, feed table, trace or comparison.")
@click.argument("name", type=click.Choice(_NAMES), default="report")
@options.debug
def schema(name: str) -> None:
    """Show the JSON Schema of a report, polarcheck.toml (job), a machine profile, feed table, trace or comparison."""
    from polarcheck.reports.pages import schema as schemas

    show(schemas.text(name).encode())
