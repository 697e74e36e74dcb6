"""Reads the messages of the editor, and answers those that are broken as the protocol demands."""

from __future__ import annotations

import asyncio
import json
import re
from typing import Any

from cattrs import transform_error
from pygls.exceptions import (
    JsonRpcException,
    JsonRpcInvalidParams,
    JsonRpcInvalidRequest,
    JsonRpcMethodNotFound,
    JsonRpcParseError,
)

from polarcheck.editor.protocol import Protocol
from polarcheck.program.reading.excerpt import shortened, visible

#: The header that counts. It may follow the rest of a message whose length was wrong.
_LENGTH = re.compile(rb"Content-Length[ \t]*+:[ \t]*+(\d{1,12})[ \t]*+\r?\n?$", re.IGNORECASE)
_OTHER = re.compile(rb"(?!Content-Length)[\w-]{1,100}+[ \t]*+:[ -~\t]*+\r?\n?$", re.IGNORECASE)
#: The longest text on wrong parameters [characters].
_LONGEST_FAULT = 200
#: The longest message: no editor sends a longer text [bytes].
_LONGEST = 1 << 28
#: Lines without the end of a header, after which nobody can be an editor.
_MOST_LINES = 1000


class NoEditorError(Exception):
    """What comes in is not what an editor sends; the text says what."""


async def handle_all(reader: asyncio.StreamReader, protocol: Protocol) -> None:
    """
    Handle all messages up to the end of the stream.

    A message that is broken off ends the session, too: raises asyncio.IncompleteReadError. Raises NoEditorError if
    there is no message to be found.
    """
    while (length := await _length(reader, protocol)) is not None:
        body = await reader.readexactly(length)
        try:
            message = json.loads(body)
        except (ValueError, RecursionError) as error:
            protocol.refuse(JsonRpcParseError(f"the body is not JSON: {error}"))
            continue
        handle(message, protocol)


def handle(message: Any, protocol: Protocol) -> None:
    """Handle one message; whatever it is, it is answered if it is a request."""
    fault = _fault(message)
    if fault:
        protocol.refuse(JsonRpcInvalidRequest(fault), _number(message))
        return
    try:
        if "method" in message:
            protocol.admit(message)
        protocol.handle_message(_structured(message, protocol))
    except JsonRpcException as error:
        if "method" in message and "id" in message:
            protocol.refuse(error, _number(message))
        elif not isinstance(error, JsonRpcMethodNotFound):  # a notification that is not known is ignored
            protocol.report(error)


def _structured(message: dict[str, Any], protocol: Protocol) -> Any:
    """Return a message in its type. Raises JsonRpcInvalidParams, which names the place."""
    try:
        return protocol.structure_message(message)
    except JsonRpcException as error:
        faults = transform_error(error.__cause__ or error, path="params")
        fault = shortened(str(faults[0]) if faults else str(error), _LONGEST_FAULT)
        raise JsonRpcInvalidParams(f"Invalid Params: {visible(fault)}") from error


def _number(message: Any) -> int | str | None:
    """Return the number of a request; None if it has none that can be repeated."""
    number = message.get("id") if isinstance(message, dict) else None
    return number if isinstance(number, int | str) and not isinstance(number, bool) else None


def _fault(message: Any) -> str:
    """Return what is wrong with the outer form of a message; empty if it is a request, notification or response."""
    if not isinstance(message, dict):
        return "a message is one JSON object"
    if message.get("jsonrpc") != "2.0":
        return 'a message has "jsonrpc": "2.0"'
    if "method" in message and not isinstance(message["method"], str):
        return "method is not a string"
    if "method" not in message and not {"result", "error"} & message.keys():
        return "a message has a method, a result or an error"
    if "id" in message and _number(message) is None:
        return "id is neither a number nor a string"
    return ""


async def _length(reader: asyncio.StreamReader, protocol: Protocol) -> int | None:
    """
    Return the length of the next body; None at the end of the stream.

    Lines that are no header are skipped up to the next length, with one answer that says so.
    """
    length: int | None = None
    has_begun = is_refused = False
    for _ in range(_MOST_LINES):
        try:
            line = await reader.readline()
        except ValueError:  # longer than the reader's limit
            line = b"\0"
        if not line:
            return None
        match = _LENGTH.search(line)
        is_blank = not line.strip()
        if is_blank and length is not None:
            return length
        if match and int(match[1]) <= _LONGEST:
            length, is_broken = int(match[1]), False
        else:
            # Blank lines between messages do no harm.
            is_broken = has_begun if is_blank else _OTHER.match(line) is None
        has_begun = not is_blank
        if is_broken and not is_refused:
            is_refused = True
            protocol.refuse(JsonRpcParseError("the header of a message has no valid Content-Length"))
    raise NoEditorError("what comes in has no headers of messages")
