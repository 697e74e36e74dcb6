"""Broken messages, and messages at the wrong time: each gets the answer that the protocol has for it."""

from __future__ import annotations

import asyncio
import contextlib
import json
import os
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import pytest
from cases import looped
from lsp_editor import Editor
from test_cli import RAPID

from polarcheck.commands.server import _Settings
from polarcheck.editor import features, process
from polarcheck.editor.messages import NoEditorError, handle_all
from polarcheck.editor.server_session import Server

pytestmark = [pytest.mark.ci, pytest.mark.usefixtures("own_folder")]

INITIALIZE = {"processId": None, "rootUri": None, "capabilities": {}}
BEGIN = {"id": 1, "method": "initialize", "params": INITIALIZE}
HERE = {"textDocument": {"uri": "file:///w/O1.NC"}, "position": {"line": 0, "character": 0}}
HOVER = {"id": 7, "method": "textDocument/hover", "params": HERE}
SHUTDOWN = {"id": 2, "method": "shutdown"}


class Answers:
    """The messages that a server writes."""

    def __init__(self) -> None:
        self.messages: list[dict[str, Any]] = []

    def write(self, data: bytes) -> None:
        self.messages.append(json.loads(data.partition(b"\r\n\r\n")[2]))

    def close(self) -> None:
        """Close nothing."""


def wire(*messages: dict[str, Any] | list[Any] | bytes) -> bytes:
    """Messages with their headers; bytes go as they are."""
    framed = []
    for message in messages:
        if isinstance(message, dict):
            message = {"jsonrpc": "2.0", **message}
        data = message if isinstance(message, bytes) else json.dumps(message).encode()
        framed.append(data if isinstance(message, bytes) else b"Content-Length: %d\r\n\r\n%b" % (len(data), data))
    return b"".join(framed)


def answers(data: bytes) -> list[tuple[Any, int]]:
    """The answers to a stream: number, and code of the error or 0."""

    async def run() -> list[dict[str, Any]]:
        server = Server(_Settings(True, {}))
        features.register(server)
        written = Answers()
        server.protocol.set_writer(written)
        reader = asyncio.StreamReader(1 << 16)
        reader.feed_data(data)
        reader.feed_eof()
        try:
            await handle_all(reader, server.protocol)  # type: ignore[arg-type]
        except asyncio.IncompleteReadError:
            written.messages.append({"id": "broken off"})
        await asyncio.sleep(0)
        server.end()
        return written.messages

    written = asyncio.run(run())
    return [(one["id"], one.get("error", {}).get("code", 0)) for one in written if "method" not in one]


def asked(number: Any, method: str, **params: Any) -> dict[str, Any]:
    return {"id": number, "method": method, "params": params}


@looped(
    "message",
    [
        asked(7, "textDocument/hover", textDocument=5),
        asked(7, "textDocument/hover", **{**HERE, "position": {"line": "x", "character": 0}}),
        asked(7, "textDocument/hover", textDocument={"uri": "file:///a"}),
        {"id": 7, "method": "textDocument/hover"},
        {"id": 7, "method": "textDocument/codeAction", "params": []},
        asked(7, "completionItem/resolve"),
    ],
    one_in=2,
)
def test_wrong_parameters_are_answered(message: dict[str, Any]) -> None:
    assert answers(wire(BEGIN, message)) == [(1, 0), (7, -32602)]


def test_the_answer_names_the_place() -> None:
    with Editor() as editor:
        error = editor.ask("textDocument/hover", {**HERE, "position": {"line": [], "character": 0}})
        assert error["code"] == -32602
        assert "params.params.position.line" in error["message"]
        assert len(error["message"]) < 300


@pytest.mark.one_in(12)
@pytest.mark.parametrize(
    ("messages", "expected"),
    [
        ([HOVER], [(7, -32002)]),
        ([SHUTDOWN, BEGIN], [(2, -32002), (1, 0)]),
        ([asked(1, "initialize", capabilities=5), BEGIN], [(1, -32602), (1, 0)]),
        ([BEGIN, {**BEGIN, "id": 3}], [(1, 0), (3, -32600)]),
        ([BEGIN, SHUTDOWN, HOVER, {"method": "initialized", "params": {}}], [(1, 0), (2, 0), (7, -32600)]),
        ([BEGIN, SHUTDOWN, {**SHUTDOWN, "id": "again"}], [(1, 0), (2, 0), ("again", -32600)]),
        ([BEGIN, asked(8, "no/such")], [(1, 0), (8, -32601)]),
        ([BEGIN, {"id": 8, "method": "no/such"}], [(1, 0), (8, -32601)]),
        ([BEGIN, {"id": 8, "method": "$/no"}], [(1, 0), (8, -32601)]),
        ([BEGIN, {"method": "$/no"}, {"method": "no/such", "params": 5}], [(1, 0)]),
        ([{"method": "textDocument/didOpen", "params": {}}, BEGIN], [(1, 0)]),
        ([BEGIN, {"method": "textDocument/didOpen", "params": {}}], [(1, 0)]),
        ([BEGIN, {"method": "$/cancelRequest", "params": {"id": 99}}], [(1, 0)]),
        ([BEGIN, {"id": 99, "result": None}, {"id": 98, "error": {"code": 1, "message": ""}}], [(1, 0)]),
    ],
)
def test_what_is_not_allowed_now_is_refused(
    messages: Iterable[dict[str, Any]], expected: list[tuple[Any, int]]
) -> None:
    assert answers(wire(*messages)) == expected


@looped(
    ("message", "expected"),
    [
        ([], (None, -32600)),
        ([BEGIN], (None, -32600)),
        ({"id": 7}, (7, -32600)),
        ({"id": 7, "method": 5}, (7, -32600)),
        ({"id": 7, "jsonrpc": "1.0", "method": "shutdown"}, (7, -32600)),
        ({"id": [7], "method": "shutdown"}, (None, -32600)),
        ({"id": None, "method": "shutdown"}, (None, -32600)),
    ],
    one_in=2,
)
def test_what_is_no_message_is_refused(message: Any, expected: tuple[Any, int]) -> None:
    assert answers(wire(BEGIN, message, HOVER))[:2] == [(1, 0), expected]


@pytest.mark.one_in(12)
@pytest.mark.parametrize(
    "broken",
    [
        b"Content-Length: 3\r\n\r\n{]}",
        b"Content-Length: 2\r\n\r\n\xff\xff",
        b"Content-Length: 20000\r\n\r\n" + b"[" * 20000,
        b"Content-Length: x\r\n\r\n{}",
        b"Content-Length: -5\r\n\r\n",
        b"Content-Length: 99999999999\r\n\r\n{}",
        b"Content-Type: none\r\n\r\n{}",
        b"G12.1\nG1 X40.\n\n",
        b"x" * 200_000 + b"\n",
    ],
)
def test_after_a_broken_message_the_next_one_counts(broken: bytes) -> None:
    assert answers(wire(BEGIN, broken, SHUTDOWN)) == [(1, 0), (None, -32700), (2, 0)]


@looped(
    "head", [b"content-length:%d\r\n\r\n", b"Content-Length: %d\n\n", b"Content-Type: x\r\nContent-Length: %d\r\n\r\n"]
)
def test_headers_are_read_as_they_may_be_written(head: bytes) -> None:
    data = json.dumps({"jsonrpc": "2.0", **BEGIN}).encode()
    assert answers(head % len(data) + data + b"\r\n" + wire(SHUTDOWN)) == [(1, 0), (2, 0)]


def test_what_breaks_off_or_never_begins_ends_the_session() -> None:
    assert answers(wire(BEGIN) + b"Content-Length: 99\r\n\r\n{") == [(1, 0), ("broken off", 0)]
    with pytest.raises(NoEditorError, match="no headers of messages"):
        answers(b"G12.1\n" * 5000)


@pytest.mark.nightly
def test_a_request_can_be_cancelled() -> None:
    Path("polarcheck.toml").write_text("", "utf-8")
    with Editor() as editor:
        program = editor.open("O1.NC", RAPID * 300)
        editor._send(id="slow", method="textDocument/codeLens", params={"textDocument": {"uri": program}})
        editor.tell("$/cancelRequest", {"id": "slow"})
        while (answer := editor._next()).get("id") != "slow":
            pass
        assert answer["error"]["code"] == -32800
        assert editor.asks("codeLens", program)


@pytest.mark.parametrize("late", [b"", b"more"])
def test_the_end_of_a_session_prints_nothing(late: bytes, caplog: pytest.LogCaptureFixture) -> None:
    """Neither what the editor has left unanswered, nor what comes after the end of the server's output."""
    Path("O1.NC").write_text(RAPID, "utf-8")
    wanted = {"workspace": {"configuration": True, "didChangeWatchedFiles": {"dynamicRegistration": True}}}

    async def run() -> None:
        server = Server(_Settings(True, {}))
        features.register(server)
        source, to_server = os.pipe()
        from_server, sink = os.pipe()
        begin = {**BEGIN, "params": {**INITIALIZE, "capabilities": wanted}}
        os.write(to_server, wire(begin, {"method": "initialized", "params": {}}))
        serving = asyncio.ensure_future(process._serve(server, process.Streams(source, sink)))
        while b"client/registerCapability" not in await asyncio.to_thread(os.read, from_server, 1 << 16):
            pass
        if late:
            os.close(from_server)
            os.write(to_server, wire({**HOVER, "params": None}) * 2)
            await asyncio.sleep(0.05)
            with contextlib.suppress(OSError):
                os.write(to_server, late)
        os.close(to_server)
        await serving

    asyncio.run(run())
    assert [record.getMessage() for record in caplog.records if record.name == "asyncio"] == []
