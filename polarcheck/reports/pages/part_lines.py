"""The part that a program makes, as text for people and as JSON for other programs."""

from __future__ import annotations

import textwrap
from collections.abc import Iterator, Sequence
from typing import Any

import msgspec

from polarcheck.foundation.finding import FileReport
from polarcheck.program.reading.excerpt import head, visible
from polarcheck.reports.json import encoded
from polarcheck.reports.made_parts.shapes_in_series import in_series

#: The rule that compares a part with its drawing.
_RULE = "part-differs-from-drawing"
#: Labels are right-aligned to this column; the text begins three columns further.
_GUTTER = 10


def part_lines(file: FileReport) -> Iterator[tuple[str, str]]:
    """Yield label and text of each line on the part: `line 9`, and the shape that is made there."""
    if isinstance(file.part, msgspec.UnsetType):
        return
    if not file.part:
        yield "", "no polar section"
    for shape in in_series(file.part):
        channel = f"{shape.channel} " if shape.channel else ""
        yield f"{channel}line {shape.line}", shape.text
        for standing in shape.left_standing:
            yield "left", standing.text
        if shape.needs and shape.shape is not None:
            yield "but", shape.needs
        if shape.is_compared is False:
            yield "but", "compared with nothing: no [[part]] is for this section"
        if shape.as_meant:
            yield "but", shape.as_meant
    for section in file.compared or []:
        if section.agrees:  # otherwise there is a finding
            yield f"line {section.section_line}", section.text
    for missing in file.not_evaluated:
        # The lines of the shape already give other reasons, such as an unknown R.
        if file.compared is not msgspec.UNSET and missing.rule == _RULE and "compared with" in missing.reason:
            yield "but", missing.reason


def text(files: Sequence[FileReport], columns: int) -> str:
    """Return for each file its path, the part, where it differs from the drawing, and what could not be judged."""
    lines = []
    for file in files:
        lines.append(head(file.path))
        labelled = [*part_lines(file)]
        labelled += [(finding.severity, f"line {finding.line}: {finding.full_message}") for finding in file.findings]
        reasons = dict.fromkeys(gap.reason for gap in file.not_evaluated if gap.matters)
        labelled += [("not judged", reason) for reason in reasons]
        for label, said in labelled:
            room = columns - _GUTTER - 3
            first, *more = textwrap.wrap(visible(said), room, break_long_words=False, break_on_hyphens=False) or [""]
            lines.append(f"{label:>{_GUTTER}}   {first}")
            lines += [" " * (_GUTTER + 3) + line for line in more]
        lines.append("")
    return "".join(line + "\n" for line in lines)


def json(files: Sequence[FileReport]) -> str:
    """Return the same as JSON, with the names of the JSON report of `check`."""
    entries: list[dict[str, Any]] = [
        {
            "path": file.path,
            "machine": file.machine,
            **({"machine_file": file.machine_file} if file.machine_file else {}),
            "part": _list(file.part),
            "compared": _list(file.compared),
            "findings": file.findings,
            "not_evaluated": file.not_evaluated,
        }
        for file in files
    ]
    return encoded({"schema": 1, "files": entries}, indent=2) + "\n"


def _list(part: Any) -> list[Any]:
    return part if isinstance(part, list) else []
