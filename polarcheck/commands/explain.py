"""`polarcheck explain`: the manual pages of rules, and the words of a verdict."""

from __future__ import annotations

from typing import TYPE_CHECKING

import click

from polarcheck.commands import options
from polarcheck.commands.output import show

if TYPE_CHECKING:
    from polarcheck.checking.settings import Settings


@click.command(short_help="Show the manual page of a rule, a group, an alarm or a verdict.")
@click.argument("rule")
@click.argument("program", metavar="[FILE]", required=False)
@options.machine
@options.max_size
@options.debug
def explain(rule: str, program: str | None, machine: str | None, max_size: int) -> None:
    """
    Show the manual page of a RULE, or of the rules of a group.

    Of an alarm, PS0146 or 146, the page of the rule that most programs mean is shown, and the names of the other rules
    that give it; with FILE the pages of those rules that report something in this program. The words of a verdict have
    pages, too: pass, unverified, fail.
    """
    from polarcheck.reports.pages import verdicts

    page = verdicts.page(rule)
    if page:
        show(page)
        return
    from polarcheck.files.settings import selection
    from polarcheck.files.settings.of_programs import OfPrograms, Options, default_machine
    from polarcheck.reports.pages import manual
    from polarcheck.rules.rule import load_all

    applied = OfPrograms(Options(machine=machine))(program) if program else None
    profile = applied.machine if applied else default_machine(machine)[1]
    alarm = selection.of_alarm(rule, load_all(), profile)
    if alarm and applied and program:
        reported = _reported(program, applied, max_size)
        alarm.sort(key=lambda rule_of_alarm: rule_of_alarm.name not in reported)
        count = max(sum(rule_of_alarm.name in reported for rule_of_alarm in alarm), 1)
        show(manual.alarm_pages(alarm, count, profile))
    elif alarm:
        show(manual.alarm_pages(alarm, 1, profile))
    else:
        show(manual.pages(selection.select([rule], load_all(), profile).values(), profile))


def _reported(program: str, applied: Settings, max_size: int) -> set[str]:
    """The rules that report something in a program."""
    from polarcheck.checking import check
    from polarcheck.foundation.memory import keep_within_memory
    from polarcheck.foundation.time_limit import seconds_for, time_limit
    from polarcheck.program.reading import files

    keep_within_memory()
    data = files.read_program(program, max_size)
    with time_limit(seconds_for(len(data), applied.job.run.max_seconds)):
        runs = check.read(data, applied.machine, applied.job, files.display_path(program), applied.encoding)
        return {finding.rule for finding in check.check_runs(runs, applied.rules, applied.severities).findings}
