"""
An editor in this process: the server runs beside it in a thread, so that what it does is measured.

    with Editor("--machine", "fanuc-30i") as editor:
        program = editor.open("O1.NC", "G12.1\n")
        assert editor.marks(program, "polar-never-left")
"""

from __future__ import annotations

import json
import os
import queue
import threading
from collections.abc import Sequence
from pathlib import Path
from types import TracebackType
from typing import Any

import pytest

from polarcheck.commands import main
from polarcheck.editor import process

#: Long enough for any machine: what is never said ends the test [s].
PATIENCE = 60

Json = dict[str, Any]


def place(line: int, character: int) -> Json:
    return {"line": line, "character": character}


class Editor:
    """Speaks the protocol as it is on the wire; code: with which the command has ended."""

    def __init__(
        self, *options: str, folders: Sequence[str] = (".",), capabilities: Json | None = None, uri: str | None = None
    ) -> None:
        from_editor, self._out = os.pipe()
        self._in, to_editor = os.pipe()
        self._streams = process.Streams(from_editor, to_editor)
        self._options = ["server", *options]
        self._told: queue.Queue[Json | None] = queue.Queue()
        self._number = 0
        self.code: int | None = None
        #: By URI, the last marks of each document with the version that they are of.
        self.published: dict[str, tuple[int | None, list[Json]]] = {}
        #: All else that the server has said or asked by itself, by method.
        self.said: list[tuple[str, Any]] = []
        self._initialize = {
            "processId": None,
            "rootUri": uri,
            "capabilities": capabilities or {},
            "workspaceFolders": [{"uri": Path(one).resolve().as_uri(), "name": one} for one in folders],
        }

    def __enter__(self) -> Editor:
        with pytest.MonkeyPatch.context() as patched:
            patched.setattr(process, "take_streams", lambda: self._streams)
            self._server = threading.Thread(target=self._serve, daemon=True)
            self._server.start()
            threading.Thread(target=self._listen, daemon=True).start()
            self.capabilities = self.ask("initialize", self._initialize)["capabilities"]
        self.tell("initialized", {})
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, at: TracebackType | None) -> None:
        if self._server.is_alive() and error is None:
            assert self.ask("shutdown", None) is None
            self.tell("exit", None)
        os.close(self._out)
        self._server.join(PATIENCE)
        assert error is not None or not self._server.is_alive()

    def _serve(self) -> None:
        self.code = main.main(self._options, standalone_mode=False)

    def _listen(self) -> None:
        with os.fdopen(self._in, "rb") as told:
            while header := told.readline():
                length = int(header.partition(b":")[2])
                while told.readline().strip():
                    pass
                self._told.put(json.loads(told.read(length)))
        self._told.put(None)

    # ---- messages ----

    def _send(self, **body: Any) -> None:
        data = json.dumps({"jsonrpc": "2.0", **body}).encode()
        left = b"Content-Length: %d\r\n\r\n%b" % (len(data), data)
        while left:
            left = left[os.write(self._out, left) :]

    def tell(self, method: str, params: Any) -> None:
        """A notification."""
        self._send(method=method, params=params)

    def ask(self, method: str, params: Any) -> Any:
        """What is answered to a request, or the error."""
        self._number += 1
        number = self._number
        self._send(id=number, method=method, params=params)
        while True:
            told = self._next()
            if told.get("id") == number and "method" not in told:
                return told.get("error") or told.get("result")

    def _next(self) -> Json:
        """The next message; what the server asks is answered with nothing."""
        told = self._told.get(timeout=PATIENCE)
        assert told is not None, f"the server has ended with {self.code}"
        method = told.get("method")
        if method == "textDocument/publishDiagnostics":
            marks = told["params"]
            self.published[marks["uri"]] = marks.get("version"), marks["diagnostics"]
        elif method is not None:
            self.said.append((method, told.get("params")))
            if "id" in told:
                self._send(id=told["id"], result=None)
        return told

    # ---- documents ----

    def open(self, path: str, text: str, version: int = 1) -> str:
        """Open a file, or a document by its URI; gives the URI."""
        uri = path if ":" in path else Path(path).absolute().as_uri()
        item = {"uri": uri, "languageId": "gcode", "version": version, "text": text}
        self.tell("textDocument/didOpen", {"textDocument": item})
        return uri

    def change(self, uri: str, version: int, text: str, at: Sequence[int] = ()) -> None:
        """Write all of a text, or what stands in a line from one character to another."""
        change: Json = {"text": text}
        if at:
            line, start, end = at
            change["range"] = {"start": place(line, start), "end": place(line, end)}
        self.tell(
            "textDocument/didChange", {"textDocument": {"uri": uri, "version": version}, "contentChanges": [change]}
        )

    def close(self, uri: str) -> None:
        self.tell("textDocument/didClose", {"textDocument": {"uri": uri}})

    def asks(self, method: str, uri: str, line: int = 0, character: int = 0, **more: Any) -> Any:
        """A request about a place in a document."""
        return self.ask(
            f"textDocument/{method}", {"textDocument": {"uri": uri}, "position": place(line, character), **more}
        )

    def marks(self, uri: str, *codes: str) -> list[Json]:
        """The marks of a document, once they are these."""
        while [mark["code"] for mark in self.published.get(uri, (None, [{"code": ""}]))[1]] != list(codes):
            try:
                self._next()
            except queue.Empty:
                pytest.fail(f"there is only {self.published.get(uri)}")
        return self.published[uri][1]

    def wait_for(self, method: str) -> Any:
        """What the server says by itself."""
        while True:
            for said, params in self.said:
                if said == method:
                    return params
            self._next()
