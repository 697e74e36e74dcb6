"""The basis of a verdict in a few lines: the lathe, what was looked at, and each polar section."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

from polarcheck.foundation.errors import counted, enumerated, first_of
from polarcheck.foundation.finding import radius_origin
from polarcheck.rules.quantity import Quantity

if TYPE_CHECKING:
    from polarcheck.foundation.finding import FileReport, KnownStock, PolarSection

#: At most this many sections, or keys of the machine, are listed; the others are counted. JSON has them all.
_LISTED = 5
_INSIDE = "polar sections"


def resting(file: FileReport) -> Iterator[str]:
    """Yield lines; the first names the lathe and what was looked at. Yields nothing if nothing was looked at."""
    if not file.looked_at:
        return
    outside = [part for part in file.looked_at if part != _INSIDE]
    named = f"{enumerated(outside)} only" if len(outside) > 1 else "".join(outside)
    looked_at = f"{_INSIDE}; outside them {named}" if _INSIDE in file.looked_at else named
    yield f"rests on {file.machine}; looked at: {looked_at}"
    for section in file.polar_sections[:_LISTED]:
        yield _section(section)
    more = len(file.polar_sections) - _LISTED
    if more > 0:
        yield f"and {counted(more, 'more section')}: --format json lists them"
    if file.stock is not None:
        yield _stock(file.stock, file.polar_sections)
    light = dict.fromkeys(missing.reason for missing in file.not_evaluated if not missing.matters)
    for reason in light:
        yield f"not judged, but without weight: {reason}"
    if file.doubtful:
        yield _doubtful(file)


def _doubtful(file: FileReport) -> str:
    """Name keys of the machine that no manual proves, the first of them where there are many."""
    parameters = file.doubtful_parameters or {}
    keys = [f"{key} (parameter {parameters[key]})" if key in parameters else key for key in file.doubtful]
    return f"doubtful in {file.machine}: {first_of(keys, _LISTED)}"


def _section(section: PolarSection) -> str:
    facts = [section.units, _radius(section)]
    if section.nearest is not None:
        facts.append(f"nearest {_length(section.nearest, section)}")
    facts.append(_rate(section))
    if section.ramp_used is not None:
        facts.append(f"ramps used up to {100 * section.ramp_used:.0f} %")
    if section.time is not None:
        facts.append(f"{section.time:.0f} s")
    elif section.time_not_known and section.c_feed is not None:
        seconds = f"{section.time_known:.0f} s without" if section.time_known else "time not known:"
        facts.append(f"{seconds} {', '.join(section.time_not_known)}")
    channel = f" in channel {section.channel}" if section.channel else ""
    return f"section of line {section.line}{channel}: {', '.join(fact for fact in facts if fact)}"


def _stock(stock: KnownStock, sections: Sequence[PolarSection]) -> str:
    """`bar 27.7 mm turned in lines 8 to 11, face at Z0 turned in line 6`, in the units of the first section."""
    inch = any(section.units == "inch" for section in sections[:1])
    facts = []
    if stock.diameter is not None:
        facts.append(f"bar {_stock_length(stock.diameter, inch)} {_known_by(stock.source, stock.line, stock.end_line)}")
    if stock.bore:
        facts.append(f"bore {_stock_length(stock.bore, inch)}")
    if stock.face is not None:
        source = "turning" if stock.face_line else "job"
        face = _stock_length(stock.face, inch).partition(" ")[0]
        facts.append(f"face at Z{face} {_known_by(source, stock.face_line, stock.face_end_line)}")
    elif stock.diameter is not None:
        facts.append("face not known, taken at Z0 where sections cut below it")
    return ", ".join(facts)


def _known_by(source: str, line: int | None, end_line: int | None) -> str:
    if source == "turning":
        return f"turned in {f'line {line}' if line == end_line else f'lines {line} to {end_line}'}"
    return "of [stock]" if source == "job" else f"by the comment of line {line}"


def _stock_length(value: float, inch: bool) -> str:
    return f"{Quantity(value, inch, diameter=False):length}"


def _radius(section: PolarSection) -> str:
    if section.offset is None:
        return "no offset"
    if section.radius is None:
        return f"offset {section.offset}, R not known"
    return f"offset {section.offset} with R {_length(section.radius, section)} ({radius_origin(section.radius_source)})"


def _rate(section: PolarSection) -> str:
    limit = "no limit given" if section.c_feed_limit is None else f"limit {section.c_feed_limit:.0f}"
    rotary = section.rotary or "C"
    if section.c_feed is None:
        return f"rate of {rotary} not known ({limit})"
    at_center = f"no angle at the center, in line {section.center_line}" if section.center_line else ""
    if section.c_feed_line is None:
        return f"{rotary} has {at_center} ({limit})" if at_center else f"{rotary} does not turn ({limit})"
    and_at_center = f", and {at_center}" if at_center else ""
    return f"{rotary} at most {section.c_feed:.0f} deg/min in line {section.c_feed_line}{and_at_center} ({limit})"


def _length(value: float, section: PolarSection) -> str:
    """Return a length [mm] in the units of the program."""
    return f"{Quantity(value, section.units == 'inch', diameter=False):length}"
