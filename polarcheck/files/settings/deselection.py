"""
Rules of weight that do not run: which selection keeps them from it, and what the verdict says of that.

A rule has weight where its severity is warning or error by the profile and the job file. A profile or a job file that
switches it off with a reason takes its weight; an option, or a file without a reason, leaves the verdict unverified.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from typing import NamedTuple

from polarcheck.files.settings.job_layers import Merged
from polarcheck.files.settings.selection import Names, Rules, select
from polarcheck.foundation.errors import first_of
from polarcheck.program.machines.job import level_of, names_of, reason_of
from polarcheck.program.machines.machine import Machine
from polarcheck.program.machines.profiles import Profile
from polarcheck.program.reading.files import display_path
from polarcheck.rules.rule import Rule

#: Levels of rules whose findings fail a file.
_WEIGHTY = ("error", "warning")
#: As many names of an option are shown.
_NAMED = 3
#: What to write in a job file, so that the verdict stays as it is.
_LEVEL, _RULES = '{ level = "off", reason = "..." }', '{ rules = ["..."], reason = "..." }'
_DESELECTED = "deselected"


class _Switch(NamedTuple):
    """
    Why a rule does not run, or as a note only.

    how: deselected, switched off, lowered to a note.
    cause: the option, or the place in a file.
    """

    how: str
    cause: str


def deselected(
    names: Names,
    named: Mapping[str, str],
    merged: Merged,
    profile: Profile,
    catalogue: Rules,
    rules: Sequence[Rule],
    levels: Mapping[str, str],
) -> list[str]:
    """
    Return a line for each selection that keeps rules of weight from running.

    names: those of the command line, or of a Python function.
    named: what has set an option, where that is not the option: `POLARCHECK_SELECT=` by `select`.
    merged: the job.
    catalogue, rules: all rules, and those that run.
    levels: the severities that differ from those of the profile.
    """
    final = {**profile.machine.severities, **levels}
    run = {rule.name for rule in rules if rule.level(final) in _WEIGHTY}
    if len(run) == len(catalogue):
        return []
    finder = _Finder(names, named, merged, profile, catalogue)
    switches: dict[_Switch, list[str]] = {}
    for rule in catalogue.values():
        if rule.name not in run and (switch := finder.switch(rule)) is not None:
            switches.setdefault(switch, []).append(rule.name)
    return [_line(switch, names) for switch, names in switches.items()]


def _line(switch: _Switch, names: Sequence[str]) -> str:
    """Return a line such as `130 rules were deselected by --select polar-never-left`."""
    who = f"{names[0]} was" if len(names) == 1 else f"{len(names)} rules were"
    return f"{who} {switch.how} by {switch.cause}"


class _Finder:
    """Finds what keeps a rule from running; the weight of a rule is decided on the way."""

    def __init__(
        self, options: Names, named: Mapping[str, str], merged: Merged, profile: Profile, catalogue: Rules
    ) -> None:
        machine, job = profile.machine, merged.job
        self._options, self._named, self._merged, self._profile = options, named, merged, profile
        self._selected = _names(options.selected, catalogue, machine) if options.selected else None
        self._ignored = _names(options.ignored, catalogue, machine)
        of_job = names_of(job.select)
        self._selected_by_job = _names(of_job, catalogue, machine) if of_job else None
        self._ignored_by_job = _names(names_of(job.ignore), catalogue, machine)
        self._of_job = {name: key for key in job.severities for name in _names([key], catalogue, machine)}
        pairs = [(option.partition("=")[0].strip(), option) for option in options.levels]
        self._of_options = {name: option for key, option in pairs for name in _names([key], catalogue, machine)}

    def switch(self, rule: Rule) -> _Switch | None:
        """Return what keeps a rule of weight from running as an error or warning; None for one without weight."""
        name, job = rule.name, self._merged.job
        level, switch = rule.level({}), None
        of_profile = self._profile.machine.severities.get(name)
        if of_profile is not None:
            origin = self._profile.origins.get(f"severities.{name}")
            if _lowers(level, of_profile) and origin is not None and not origin.source:
                switch = _Switch(_how(of_profile), f"severities.{name} of {origin.profile}, which gives no source")
            else:
                level = of_profile
        key = self._of_job.get(name)
        if key is not None:
            written = job.severities[key]
            if _lowers(level, level_of(written)) and not reason_of(written):
                switch = _Switch(_how(level_of(written)), self._without_reason(f"severities.{key}", _LEVEL))
            else:
                level, switch = level_of(written), None
        if level not in _WEIGHTY:
            return None
        for list_of_job, names, is_out in (
            ("select", job.select, self._selected_by_job is not None and name not in self._selected_by_job),
            ("ignore", job.ignore, name in self._ignored_by_job),
        ):
            if is_out and reason_of(names):
                return None
            if is_out and self._selected is None:
                switch = _Switch(_DESELECTED, self._without_reason(list_of_job, _RULES))
        option = self._of_options.get(name, "")
        level = option.rpartition("=")[2].strip().lower()
        if option and level not in _WEIGHTY:
            switch = _Switch(_how(level), self._cause("severities", [option]))
        if self._selected is not None and name not in self._selected:
            switch = _Switch(_DESELECTED, self._cause("select", self._options.selected))
        if name in self._ignored:
            switch = _Switch(_DESELECTED, self._cause("ignore", self._options.ignored))
        return switch

    def _cause(self, key: str, names: Sequence[str]) -> str:
        """Return the option or variable with its value, shortened."""
        option = "--severity" if key == "severities" else f"--{key}"
        return f"{self._named.get(key) or f'{self._options.spelled(option)} '}{first_of(names, _NAMED, ',')}"

    def _without_reason(self, key: str, form: str) -> str:
        # The file alone: to find the line, its text would be read once more for each check.
        file = display_path(self._merged.origins[key].title)
        return f"{key} of {file}, which gives no reason; {form} keeps the pass"


def _names(names: Sequence[str], catalogue: Rules, machine: Machine) -> Collection[str]:
    return select(names, catalogue, machine).keys() if names else ()


def _lowers(before: str, after: str) -> bool:
    """Return True if a severity takes a rule that fails files out of these."""
    return before in _WEIGHTY and after not in _WEIGHTY


def _how(level: str) -> str:
    return "switched off" if level == "off" else f"lowered to a {level}"
