"""Selects rules and severities by names, groups and alarms, from the command line and from the job."""

import re
from collections.abc import Callable, Iterable, Sequence
from functools import partial
from typing import Any, NamedTuple

from polarcheck.foundation.errors import MachineError, UsageError, suggestion
from polarcheck.foundation.finding import SEVERITY_NAMES
from polarcheck.foundation.patterns import lazy_pattern
from polarcheck.program.machines.job import Job, level_of, names_of
from polarcheck.program.machines.machine import Machine
from polarcheck.program.machines.profiles import Profile
from polarcheck.rules import rule as all_rules
from polarcheck.rules.rule import Rule

LEVELS = ("error", "warning", "note", "off")
_ALARM = lazy_pattern(r"([A-Za-z]{0,3})\s?0*(\d{1,9})")

Rules = dict[str, Rule]
#: Returns the place of a key of a job: `polarcheck.toml:12`.
Place = Callable[[str], str]


class Names(NamedTuple):
    """
    What the command line, or the keywords of a Python function, say of rules.

    selected, ignored: names of rules, groups and alarms.
    levels: RULE=LEVEL.
    spelled: returns an option as its user writes it, for messages.
    """

    selected: Sequence[str] = ()
    ignored: Sequence[str] = ()
    levels: Sequence[str] = ()
    spelled: Callable[[str], str] = str


def select(names: Iterable[str], catalogue: Rules, machine: Machine) -> Rules:
    """
    Return the rules with these names, groups or alarms (PS0146, 146) of a machine.

    Raises UsageError for an unknown name.
    """
    selected: set[str] = set()
    for name in names:
        alarm = _ALARM.fullmatch(name.strip())
        rules = _of_alarm(alarm, catalogue, machine) if alarm else all_rules.find(name, catalogue)
        if not rules:
            raise UsageError(f"no rule is known to give alarm {name.strip()} on {machine.title}")
        selected.update(rule.name for rule in rules)
    return {name: rule for name, rule in catalogue.items() if name in selected}


def of_alarm(name: str, catalogue: Rules, machine: Machine) -> list[Rule]:
    """
    Return the rules with an alarm (PS0146, 146) of a machine, in the order of its profile; none for another name.

    Raises UsageError for an alarm that no rule gives.
    """
    alarm = _ALARM.fullmatch(name.strip())
    if alarm is None:
        return []
    select([name], catalogue, machine)
    return _of_alarm(alarm, catalogue, machine)


def _of_alarm(alarm: re.Match[str], catalogue: Rules, machine: Machine) -> list[Rule]:
    """Return the rules with an alarm on this machine; its letters and leading zeros may be left out."""
    letters, number = alarm[1].upper(), int(alarm[2])
    rules = []
    for name, text in machine.alarms.items():
        of_rule = _ALARM.fullmatch(text)
        if of_rule and name in catalogue and int(of_rule[2]) == number and letters in ("", of_rule[1].upper()):
            rules.append(catalogue[name])
    return rules


def chosen(names: Names, job: Job, where: Place, catalogue: Rules, machine: Machine) -> list[Rule]:
    """
    Return the rules to run; --select overrides what the job selects and ignores.

    where: returns the place of a key of the job.

    Raises UsageError, with the option or the key of the file, for an unknown name, and if no rule is left.
    """
    rules, without = catalogue, {}
    if names.selected:
        rules = _named(names.spelled("--select"), select, names.selected, catalogue, machine)
    else:
        if names_of(job.select):
            rules = _named(lambda: f"{where('select')}: select", select, names_of(job.select), catalogue, machine)
        without = _named(lambda: f"{where('ignore')}: ignore", select, names_of(job.ignore), catalogue, machine)
    without = without | _named(names.spelled("--ignore"), select, names.ignored, catalogue, machine)
    remaining = [rule for name, rule in rules.items() if name not in without]
    if not remaining:
        raise UsageError("no rule is left to check: all that are selected are ignored, too")
    return remaining


def severities(names: Names, job: Job, where: Place, catalogue: Rules, machine: Machine) -> dict[str, str]:
    """
    Return the severities that differ from the profile, by rule; a rule that is selected by its name is never off.

    where: returns the place of a key of the job.

    Raises UsageError, with the option or the key of the file.
    """
    of_job: dict[str, str] = {}
    for name, written in job.severities.items():
        of_job |= _named(partial(_of_severity, where, name), _levels, [(name, level_of(written))], catalogue, machine)
    of_command = _named(
        names.spelled("--severity"), _levels, [_pair(option) for option in names.levels], catalogue, machine
    )
    changed = of_job | of_command
    for name in names.selected:
        rule = catalogue.get(name.strip().lower().replace("_", "-"))
        if rule and rule.name not in of_command and rule.level({**machine.severities, **changed}) == "off":
            changed[rule.name] = SEVERITY_NAMES[rule.severity]
    return changed


def check_names(profile: Profile, catalogue: Rules) -> None:
    """Raise MachineError, with the file and the key, if a machine names an unknown rule."""
    faults = []
    for table, names in (("alarms", profile.machine.alarms), ("severities", profile.machine.severities)):
        for name in names:
            if name not in catalogue:
                key = f"{table}.{name}"
                near = suggestion(name, catalogue) or "; `polarcheck rules` lists them"
                faults.append(f"{profile.origins[key].profile}: {key}: unknown rule {name!r}{near}")
    if faults:
        raise MachineError(faults[0], faults[1:])


def _levels(pairs: Iterable[tuple[str, str]], catalogue: Rules, machine: Machine) -> dict[str, str]:
    """Return severities by rule, from those of rules, groups or alarms; the last one for a rule counts."""
    return {name: level for named, level in pairs for name in select([named], catalogue, machine)}


def _pair(option: str) -> tuple[str, str]:
    name, equals, level = (part.strip() for part in option.partition("="))
    if not equals or level.lower() not in LEVELS:
        raise UsageError(f"--severity {option}: expected RULE={'|'.join(LEVELS)}")
    return name, level.lower()


def _of_severity(where: Place, name: str) -> str:
    return f"{where(f'severities.{name}')}: severities"


def _named(title: str | Callable[[], str], function: Callable[..., dict[str, Any]], *arguments: Any) -> dict[str, Any]:
    """Call a function; its errors begin with the option or the key of the file, which is computed only then."""
    try:
        return function(*arguments)
    except UsageError as error:
        raise UsageError(f"{title if isinstance(title, str) else title()}: {error}") from None
