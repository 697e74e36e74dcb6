"""The basis of a verdict in a few lines: the lathe, what was looked at, and each polar section."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from polarcheck.checking.quantity import Quantity
from polarcheck.reports import counted

if TYPE_CHECKING:
    from polarcheck.finding import FileReport, PolarSection

#: At most this many sections are listed; the others are counted. The JSON report has them all.
_LISTED = 5
_INSIDE = "polar sections"


def resting(file: FileReport) -> Iterator[str]:
    """Yield lines; the first names the lathe and what was looked at. Yields nothing if nothing was looked at."""
    if not file.looked_at:
        return
    outside = [part for part in file.looked_at if part != _INSIDE]
    named = f"{', '.join(outside[:-1])} and {outside[-1]} only" if len(outside) > 1 else "".join(outside)
    looked_at = f"{_INSIDE}; outside them {named}" if _INSIDE in file.looked_at else named
    yield f"rests on {file.machine}; looked at: {looked_at}"
    for section in file.polar_sections[:_LISTED]:
        yield _section(section)
    more = len(file.polar_sections) - _LISTED
    if more > 0:
        yield f"and {counted(more, 'more section')}: --format json lists them"
    light = dict.fromkeys(missing.reason for missing in file.not_evaluated if not missing.matters)
    for reason in light:
        yield f"not judged, but without weight: {reason}"


def _section(section: PolarSection) -> str:
    facts = [section.units, _radius(section)]
    if section.nearest is not None:
        facts.append(f"nearest {_length(section.nearest, section)}")
    facts.append(_rate(section))
    if section.ramp_used is not None:
        facts.append(f"ramps used up to {100 * section.ramp_used:.0f} %")
    if section.time is not None:
        facts.append(f"{section.time:.0f} s")
    channel = f" in channel {section.channel}" if section.channel else ""
    return f"section of line {section.line}{channel}: {', '.join(fact for fact in facts if fact)}"


def _radius(section: PolarSection) -> str:
    if section.offset is None:
        return "no offset"
    if section.radius is None:
        return f"offset {section.offset}, R not known"
    return f"offset {section.offset} with R {_length(section.radius, section)} ({section.radius_source})"


def _rate(section: PolarSection) -> str:
    limit = "no limit given" if section.c_feed_limit is None else f"limit {section.c_feed_limit:.0f}"
    if section.c_feed is None:
        return f"rate of C not known ({limit})"
    if section.c_feed_line is None:
        return f"C does not turn ({limit})"
    return f"C at most {section.c_feed:.0f} deg/min in line {section.c_feed_line} ({limit})"


def _length(value: float, section: PolarSection) -> str:
    """Return a length [mm] in the units of the program."""
    return f"{Quantity(value, section.units == 'inch', diameter=False):length}"
