"""The report for other programs: a contract, with the schema `polarcheck schema report`."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import msgspec

from polarcheck.program.reading.file_names import with_characters

if TYPE_CHECKING:
    from collections.abc import Iterator

    from polarcheck.foundation.finding import FileReport, Report
    from polarcheck.reports import Background

#: Characters that JSON need not escape, but that control a terminal or an editor, or are invisible: escape sequences,
#: changes of direction, characters without width.
_ACTING = (
    *(*range(0x7F, 0xA0), 0xAD, 0x61C, 0x180E, *range(0x200B, 0x2010), *range(0x2028, 0x202F)),
    *(*range(0x2060, 0x2070), 0xFEFF, *range(0xFFF9, 0xFFFC)),
)
_ESCAPED = {number: f"\\u{number:04x}" for number in _ACTING}


def json(report: Report, background: Background | None = None) -> str:
    """Return the report as JSON, in the order of its fields; NaN is null."""
    if not isinstance(report.files, list):
        return "".join(json_pieces(report, background))
    files = [without_text(file) for file in report.files]
    return encoded(msgspec.structs.replace(report, files=files), indent=2) + "\n"


def without_text(file: FileReport) -> FileReport:
    """The report of a file without what is no part of the contract."""
    if file.makes is msgspec.UNSET and file.outline is msgspec.UNSET:
        return file
    return msgspec.structs.replace(file, makes=msgspec.UNSET, outline=msgspec.UNSET)


def encoded(value: Any, indent: int = 0) -> str:
    """Return any value as JSON without control characters, in one line unless it is indented; NaN is null."""
    try:
        text = msgspec.json.encode(value)
    except UnicodeEncodeError:
        text = msgspec.json.encode(_encodable(msgspec.to_builtins(value)))
    return (msgspec.json.format(text, indent=indent) if indent else text).decode().translate(_ESCAPED)


def json_pieces(report: Report, background: Background | None = None) -> Iterator[str]:
    """Yield the same text file by file."""
    head, no_files, end = json(msgspec.structs.replace(report, files=[])).partition('"files": []')
    before = '"files": [\n'
    yield head if report.files else head + no_files
    for number, file in enumerate(report.files):
        text = json(msgspec.structs.replace(report, files=[file]))
        # JSON escapes line ends in texts, so these two matches are at the top level.
        yield (",\n" if number else before) + text[text.index(before) + len(before) : text.rindex("\n  ]")]
    yield "\n  ]" + end if report.files else end


def _encodable(value: Any) -> Any:
    """Spell out unpaired surrogates, which some encodings can produce but JSON cannot hold."""
    if isinstance(value, str):
        return with_characters(value).encode("utf-8", "backslashreplace").decode()
    if isinstance(value, list):
        return [_encodable(element) for element in value]
    return {key: _encodable(element) for key, element in value.items()} if isinstance(value, dict) else value
