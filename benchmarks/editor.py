"""
How long an editor waits: from a change to its diagnostics, and for answers about the cursor, at several sizes.

    python benchmarks/editor.py [--blocks 500 --blocks 20000] [--rounds 40]

The server runs as a process of its own, and is asked as an editor asks. Printed are the median and the longest of all
rounds [ms]; times depend on the machine, so that no test asserts them.
"""

from __future__ import annotations

import argparse
import json
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from types import TracebackType
from typing import Any

Json = dict[str, Any]

#: How the time from a change to its diagnostics is named.
AFTER_A_KEY = "diagnostics after a key"
#: Requests about a place: the method, and what stands in the line before the cursor is there.
CURSOR = (
    ("textDocument/hover", ""),
    ("textDocument/definition", ""),
    ("textDocument/completion", "G"),
    ("textDocument/completion", "GOTO1"),
)


class Client:
    """An editor that waits for each answer."""

    def __init__(self, folder: Path) -> None:
        command = [sys.executable, "-m", "polarcheck", "server", "--tool", "1:radius=4"]
        self.process = subprocess.Popen(command, cwd=folder, stdin=subprocess.PIPE, stdout=subprocess.PIPE)
        self.number = 0
        self.ask("initialize", {"processId": None, "rootUri": folder.as_uri(), "capabilities": {}})
        self.tell("initialized", {})

    def __enter__(self) -> Client:
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, at: TracebackType | None) -> None:
        self.ask("shutdown", None)
        self.tell("exit", None)
        self.process.communicate(timeout=10)

    def send(self, **body: Any) -> None:
        assert self.process.stdin is not None
        data = json.dumps({"jsonrpc": "2.0", **body}).encode()
        self.process.stdin.write(b"Content-Length: %d\r\n\r\n%b" % (len(data), data))
        self.process.stdin.flush()

    def tell(self, method: str, params: Any) -> None:
        """Send a notification."""
        self.send(method=method, params=params)

    def ask(self, method: str, params: Any) -> Any:
        """Return the answer to a request."""
        self.number += 1
        self.send(id=self.number, method=method, params=params)
        while (message := self.read()).get("id") != self.number or "method" in message:
            pass
        assert "error" not in message, message["error"]
        return message["result"]

    def read(self) -> Json:
        """Return the next message."""
        assert self.process.stdout is not None
        length = 0
        while line := self.process.stdout.readline().strip():
            name, _, value = line.partition(b":")
            length = int(value) if name.lower() == b"content-length" else length
        message: Json = json.loads(self.process.stdout.read(length))
        return message

    def marks(self, version: int) -> None:
        """Wait for the diagnostics of a version."""
        while (message := self.read()).get("method") != "textDocument/publishDiagnostics" or (
            message["params"].get("version") != version
        ):
            pass


def program(blocks: int) -> str:
    """Return a program with one long contour."""
    body = "".join(f"N{block} G1 X{40 + block % 7 * 0.1:.1f} C{block % 11 * 0.1:.1f}\n" for block in range(1, blocks))
    return f"O1\nG98 G0 X60. C0 T0101\nG12.1\nG1 X41. F200\n{body}X60.\nG13.1\nM30\n"


def measured(blocks: int, rounds: int, folder: Path) -> dict[str, list[float]]:
    """Return the times of each kind of answer [ms]."""
    text = program(blocks)
    uri = (folder / "O1.NC").as_uri()
    lines = text.count("\n")
    times: dict[str, list[float]] = {}

    def note(name: str, begin: float) -> None:
        times.setdefault(name, []).append(1000 * (time.perf_counter() - begin))

    with Client(folder) as client:
        item = {"uri": uri, "languageId": "gcode", "version": 1, "text": text}
        client.tell("textDocument/didOpen", {"textDocument": item})
        client.marks(1)
        version = 1
        for turn in range(rounds):
            line = lines * (turn + 1) // (rounds + 2)
            document = {"textDocument": {"uri": uri}}
            for method, typed in CURSOR:
                place = {"line": line, "character": len(typed) or 5}
                if typed:
                    version += 1
                    change(client, uri, version, line, (0, 0), typed)
                begin = time.perf_counter()
                client.ask(method, {**document, "position": place})
                note(f"{method.partition('/')[2]} {typed}".strip(), begin)
                if typed:
                    version += 1
                    change(client, uri, version, line, (0, len(typed)), "")
            if turn < rounds // 4:
                version += 1
                begin = time.perf_counter()
                change(client, uri, version, line, (0, 0), " ")
                client.marks(version)
                note(AFTER_A_KEY, begin)
            client.ask("textDocument/hover", {**document, "position": {"line": 0, "character": 0}})
    return times


def change(client: Client, uri: str, version: int, line: int, span: tuple[int, int], text: str) -> None:
    """Replace some characters of a line."""
    first, last = ({"line": line, "character": character} for character in span)
    changes = [{"range": {"start": first, "end": last}, "text": text}]
    document = {"uri": uri, "version": version}
    client.tell("textDocument/didChange", {"textDocument": document, "contentChanges": changes})


def main() -> None:
    """Print a table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--blocks", type=int, action="append", help="sizes of the program")
    parser.add_argument("--rounds", type=int, default=40, help="places that are asked about")
    asked = parser.parse_args()
    for blocks in asked.blocks or [500, 20_000]:
        with tempfile.TemporaryDirectory() as folder:
            for name, times in measured(blocks, asked.rounds, Path(folder).resolve()).items():
                print(f"{blocks:6d} blocks  {name:28s} median {statistics.median(times):7.1f}  max {max(times):7.1f}")


if __name__ == "__main__":
    main()
