"""The report for other programs: a contract, whose schema is `polarcheck schema report`."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import msgspec

from polarcheck.reading.names import with_characters

if TYPE_CHECKING:
    from polarcheck.checking.finding import Report
    from polarcheck.reports import Background

#: What would act on a terminal or an editor, and JSON allows to stand as it is: escape sequences, changes of direction.
_ESCAPED = {
    number: f"\\u{number:04x}"
    for span in ((0x7F, 0xA0), (0x200E, 0x2010), (0x2028, 0x202F), (0x2066, 0x206A))
    for number in range(*span)
}


def json(report: Report, background: Background | None = None) -> str:
    """The report as JSON, in the order of its fields; NaN is null."""
    try:
        text = msgspec.json.encode(report)
    except UnicodeEncodeError:
        text = msgspec.json.encode(_encodable(msgspec.to_builtins(report)))
    return msgspec.json.format(text, indent=2).decode().translate(_ESCAPED) + "\n"


def _encodable(value: Any) -> Any:
    """Half characters, which some encodings can spell but JSON cannot hold, are spelled out."""
    if isinstance(value, str):
        return with_characters(value).encode("utf-8", "backslashreplace").decode()
    if isinstance(value, list):
        return [_encodable(element) for element in value]
    return {key: _encodable(element) for key, element in value.items()} if isinstance(value, dict) else value
