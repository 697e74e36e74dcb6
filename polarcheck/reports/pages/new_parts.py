"""The [[part]] entries that `polarcheck init --part` writes: what programs make now, as a start."""

from __future__ import annotations

import textwrap
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import msgspec

from polarcheck.foundation.finding import FileReport, MadeShape
from polarcheck.parts.job_entry import NoEntryError, job_entry
from polarcheck.program.reading.excerpt import visible
from polarcheck.reports.pages.new_job import toml

_COLUMNS = 100


def text(files: Sequence[FileReport], units: Mapping[str, str | None]) -> str:
    """
    Return the entries of programs, with a comment on each; what [[part]] has no shape for is a comment alone.

    units: of the job file of each program, by its path; None where it names none, so that those of the program apply.
    """
    lines = [line for file in files for line in _of_file(file, units.get(file.path))]
    return "".join(f"{visible(line)}\n" for line in lines)


def _of_file(file: FileReport, units: str | None) -> Iterator[str]:
    yield from _prose(f"What {file.path} makes now, as `polarcheck part` tells it: compare it with the drawing.")
    for finding in file.findings:
        yield from _prose(f"{file.path}, line {finding.line}: {finding.severity}: {finding.full_message}")
    shapes = [] if isinstance(file.part, msgspec.UnsetType) else file.part
    if not shapes:
        yield from _prose(f"{file.path} has no polar section.")
    entries = [_entry(file, shape, units) for shape in shapes]
    places = [(shape.channel, shape.line, shape.z) for shape in shapes]
    without = {label for label, entry in zip(places, entries, strict=True) if isinstance(entry, str)}
    for shape, label, entry in zip(shapes, places, entries, strict=True):
        yield ""
        channel = f"{shape.channel} " if shape.channel else ""
        yield from _prose(f"{channel}line {shape.line}: {shape.text}")
        if isinstance(entry, str):
            yield from _prose(f'No [[part]] says this: {entry}; a drawing does (drawing = "part.dxf").')
            continue
        if shape.needs:
            yield from _prose(f"but {shape.needs}")
        if label in without:
            yield from _prose("What else lies there has no [[part]], and would differ from this one:")
        mark = "#" if label in without else ""
        yield f"{mark}[[part]]"
        yield from (f"{mark}{key} = {_value(value)}" for key, value in entry.items())
    yield ""


def _entry(file: FileReport, shape: MadeShape, units: str | None) -> dict[str, Any] | str:
    """Return the keys of an entry, or why there is none."""
    sections = [section for section in file.polar_sections if section.channel == shape.channel]
    lines = [section.line for section in sections]
    if units is None:
        units = sections[lines.index(shape.line)].units if shape.line in lines else "mm"
    stock = file.stock
    bar = stock.diameter if stock is not None and stock.diameter == stock.largest else None
    try:
        entry = job_entry(shape, bar, inch=units == "inch")
    except NoEntryError as error:
        return str(error)
    if len(lines) > 1 and len(shape.sections) == 1 and lines.count(shape.line) == 1:
        entry["section"] = lines.index(shape.line) + 1
    return {**entry, "files": [_pattern(file.path.rpartition("/")[2])]}


def _value(value: object) -> str:
    return f"[{', '.join(map(toml, value))}]" if isinstance(value, list) else toml(value)


def _pattern(name: str) -> str:
    """A pattern that matches this name alone; * and ? are no characters of names that a control writes."""
    return name.replace("[", "[[]")


def _prose(text: str) -> list[str]:
    return [f"# {line}" for line in textwrap.wrap(text, _COLUMNS - 2, break_on_hyphens=False, break_long_words=False)]
