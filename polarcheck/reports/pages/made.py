"""What programs make, as text for people and as JSON for other programs."""

from __future__ import annotations

import textwrap
from collections.abc import Iterator, Sequence
from typing import Any

import msgspec

from polarcheck.finding import FileReport
from polarcheck.reading.excerpt import visible, without_commands
from polarcheck.reports.json import encoded

#: The rule that compares a part with its drawing.
_RULE = "part-differs-from-drawing"
#: Lines of the text begin with the label, right-aligned up to here; what it labels stands three further.
_GUTTER = 10


def made(file: FileReport) -> Iterator[tuple[str, str]]:
    """Label and text of each line on what a file makes: `line 9`, and what is made there."""
    if isinstance(file.part, msgspec.UnsetType):
        return
    if not file.part:
        yield "", "no polar section"
    for shape in file.part:
        channel = f"{shape.channel} " if shape.channel else ""
        yield f"{channel}line {shape.line}", shape.text
        for left in shape.left_standing:
            yield "left", left.text
        if shape.needs and shape.shape is not None:
            yield "but", shape.needs
    for one in file.compared or []:
        if one.agrees:  # else a finding says so
            yield f"line {one.section_line}", one.text
    for missing in file.not_evaluated:
        # That R is not known, or walls are tangled, is said of the shape.
        if file.compared is not msgspec.UNSET and missing.rule == _RULE and "compared with" in missing.reason:
            yield "but", missing.reason


def text(files: Sequence[FileReport], columns: int) -> str:
    """Of each file its path, below it what it makes, where that differs from its drawing, what could not be judged."""
    shown = []
    for file in files:
        shown.append(visible(file.path))
        labelled = [*made(file)]
        labelled += [(found.severity, f"line {found.line}: {found.told}") for found in file.findings]
        missing = dict.fromkeys(missing.reason for missing in file.not_evaluated if missing.matters)
        labelled += [("not judged", reason) for reason in missing]
        for label, said in labelled:
            room = columns - _GUTTER - 3
            first, *more = textwrap.wrap(visible(said), room, break_long_words=False, break_on_hyphens=False) or [""]
            shown.append(f"{label:>{_GUTTER}}   {first}")
            shown += [" " * (_GUTTER + 3) + line for line in more]
        shown.append("")
    return without_commands("".join(line + "\n" for line in shown))


def json(files: Sequence[FileReport]) -> str:
    """The same as data, in the terms of the JSON report of `check`."""
    told: list[dict[str, Any]] = [
        {
            "path": file.path,
            "machine": file.machine,
            "part": _list(file.part),
            "compared": _list(file.compared),
            "findings": file.findings,
            "not_evaluated": file.not_evaluated,
        }
        for file in files
    ]
    return encoded({"schema": 1, "files": told}, indent=2) + "\n"


def _list(part: Any) -> list[Any]:
    return part if isinstance(part, list) else []
