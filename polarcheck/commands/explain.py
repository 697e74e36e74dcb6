"""`polarcheck explain`: the manual pages of rules, and the words of a verdict."""

from __future__ import annotations

import click

from polarcheck.commands import options
from polarcheck.commands.output import show


@click.command(short_help="Show the manual page of a rule, a group, an alarm or a verdict.")
@click.argument("rule")
@options.machine
@options.debug
def explain(rule: str, machine: str | None) -> None:
    """
    Show the manual page of a RULE, or of the rules of a group or of an alarm: PS0146, 146.

    The words of a verdict have pages, too: pass, unverified, fail.
    """
    from polarcheck.reports.pages import verdicts

    page = verdicts.page(rule)
    if page:
        show(page)
        return
    from polarcheck.checking.rule import load_all
    from polarcheck.commands import selection, settings
    from polarcheck.reports.pages import manual

    _, profile = settings.default_machine(machine)
    show(manual.pages(selection.select([rule], load_all(), profile).values(), profile))
