"""What the user has set that decides verdicts and exit codes, as reports say it under `settings`."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

from polarcheck.checking.settings import Settings
from polarcheck.files.settings.job_layers import Merged
from polarcheck.foundation.finding import Decided, RunSettings
from polarcheck.foundation.version import __version__
from polarcheck.program.machines.job import level_of, names_of, reason_of
from polarcheck.program.reading.files import display_path

#: Keys of a job that an option of the same name overrides.
_PLAIN = ("inline", "fail_on", "max_warnings", "strict")
#: The option of each value.
OPTIONS = {
    "machine": "--machine",
    "changes": "--set",
    "select": "--select",
    "ignore": "--ignore",
    "severities": "--severity",
    "inline": "--inline",
    "fail_on": "--fail-on",
    "max_warnings": "--max-warnings",
    "strict": "--strict",
    "baseline": "--baseline",
}


def shared(of_files: Iterable[Settings], diff_base: str | None = None) -> RunSettings:
    """
    Return the settings that the files of a run share.

    of_files: those of each file. diff_base: the commit since which a file must have changed.
    """
    distinct = list({id(settings): settings.decided for settings in of_files}.values()) or [Decided()]
    values = {name: [getattr(decided, name) for decided in distinct] for name in Decided.__struct_fields__}
    differing = [name for name, of_each in values.items() if any(value != of_each[0] for value in of_each)]
    common = {name: None if name in differing else of_each[0] for name, of_each in values.items()}
    return RunSettings(version=__version__, diff_base=diff_base, differing=differing, **common)


def decided(
    machine: str,
    baseline: Path | None,
    options: Mapping[str, Any],
    named: Mapping[str, str],
    merged: Merged,
    configuration: Sequence[str],
) -> Decided:
    """
    Return what decides, with the origin of each value that is not the default.

    machine: its name or file, as given by the user.
    baseline: the file of known findings.
    options: values of the OPTIONS; empty or None if not set.
    named: what has set an option, where that is not the option.
    merged: the job of the job files.
    configuration: the files of settings.
    """
    job = merged.job
    values: dict[str, Any] = {key: getattr(job, key) for key in _PLAIN}
    values |= {key: options[key] for key in _PLAIN if options[key] is not None}
    # --select counts in place of what the job selects and ignores.
    values["select"] = [*options["select"]] or names_of(job.select)
    values["ignore"] = [*([] if options["select"] else names_of(job.ignore)), *options["ignore"]]
    pairs = [option.partition("=") for option in options["severities"]]
    of_options = {name.strip(): level.strip().lower() for name, _, level in pairs}
    values["severities"] = {name: level_of(level) for name, level in job.severities.items()} | of_options
    of_job = {name: level for name, level in job.severities.items() if name not in of_options}
    reasons = {f"severities.{name}": reason_of(level) for name, level in of_job.items()}
    reasons |= {} if options["select"] else {key: reason_of(getattr(job, key)) for key in ("select", "ignore")}
    return Decided(
        machine=display_path(machine),
        changes=options["changes"],
        baseline=None if baseline is None else display_path(baseline),
        configuration=[display_path(path) for path in configuration],
        sources=dict(_sources(options, named, merged)),
        reasons={key: reason for key, reason in reasons.items() if reason},
        **values,
    )


def _sources(options: Mapping[str, Any], named: Mapping[str, str], merged: Merged) -> Iterator[tuple[str, str]]:
    """Yield key and origin of each value that the user has set: an option, a variable, or a file."""
    for key, option in OPTIONS.items():
        if key == "severities":
            of_job = {f"severities.{name}" for name in merged.job.severities}
            yield from (
                (name, display_path(merged.origins[name].title)) for name in sorted(of_job & merged.origins.keys())
            )
        if options[key] not in (None, ()):
            yield key, named.get(key, option).strip(" =")
        elif key in merged.origins:
            # The file alone: to find the line, the text of each job file would be read once more.
            yield key, display_path(merged.origins[key].title)
