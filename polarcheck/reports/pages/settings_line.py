"""The settings of a run that are not defaults, in one line."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any

from polarcheck.foundation.errors import first_of
from polarcheck.program.reading.excerpt import visible

if TYPE_CHECKING:
    from polarcheck.foundation.finding import Report, RunSettings

#: Settings that change verdicts or the exit code, in the order of the line. Others stand in the JSON report only.
_SHOWN = (
    *("changes", "select", "ignore", "severities", "inline", "baseline"),
    *("fail_on", "max_warnings", "strict", "diff_base"),
)
#: As many values of a setting are shown.
_NAMED = 5


def settings_line(report: Report) -> Iterator[str]:
    """Yield the line, such as `settings: select overcut (--select), fail_on never (POLARCHECK_FAIL_ON)`, if any."""
    facts = [fact for name in _SHOWN if (fact := _fact(report.settings, name))]
    if facts:
        yield visible(f"settings: {', '.join(facts)}")


def _fact(settings: RunSettings, name: str) -> str:
    """Return a setting with its origin; empty for a default."""
    if name in settings.differing:
        return f"{name} differs between the files (--format json)"
    value, sources = getattr(settings, name), settings.sources or {}
    if name == "diff_base":
        return f"diff_base {value} (--diff-base)" if value else ""
    if "sources" in settings.differing:
        return f"{name} {_text(value)}" if value not in _DEFAULTS[name] else ""
    named = [source for key, source in sources.items() if key == name or key.startswith(f"{name}.")]
    return f"{name} {_text(value)} ({', '.join(named)})" if named else ""


#: Values that are left out where it is unknown whether they were set.
_DEFAULTS: Mapping[str, Sequence[Any]] = {
    **{name: ([], (), {}) for name in ("changes", "select", "ignore", "severities")},
    "inline": (True,),
    "baseline": (None,),
    "fail_on": ("warning",),
    "max_warnings": (None,),
    "strict": (False,),
}


def _text(value: Any) -> str:
    if isinstance(value, Mapping):
        value = [f"{key}={level}" for key, level in value.items()]
    if isinstance(value, list | tuple):
        return first_of(value, _NAMED, " ")
    return str(value).lower() if isinstance(value, bool) else str(value)
