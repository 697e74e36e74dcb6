"""`polarcheck schema`: the JSON Schemas of what is read and written."""

from __future__ import annotations

import click

from polarcheck.commands import options
from polarcheck.commands.output import show


@click.command(short_help="Show the JSON Schema of the report, the job or the machine.")
@click.argument("name", type=click.Choice(["report", "job", "machine"]), default="report")
@options.debug
def schema(name: str) -> None:
    """Show the JSON Schema of the JSON report, of polarcheck.toml (job) or of a machine profile."""
    from polarcheck.reports.pages import schema as schemas

    show(schemas.text(name).encode())
