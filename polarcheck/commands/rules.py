"""`polarcheck rules`: the catalogue."""

from __future__ import annotations

import click

from polarcheck.commands import options
from polarcheck.commands.output import show


@click.command
@options.text_or_json
@options.debug
def rules(form: str) -> None:
    """List all rules: severity, name, title."""
    from polarcheck.reports.pages import manual
    from polarcheck.rules.rule import load_all

    show(manual.catalogue(load_all()) if form == "text" else manual.catalogue_json(load_all()).encode())
