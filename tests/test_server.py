"""The language server as an editor meets it: a real client speaks to a real process over standard input and output."""

from __future__ import annotations

import asyncio
import contextlib
import json
import os
import signal
import subprocess
import sys
from collections.abc import AsyncIterator, Callable, Sequence
from functools import partial
from pathlib import Path
from typing import Any

import pytest
from lsprotocol import types
from pytest_lsp import LanguageClient, make_test_lsp_client
from test_cli import COMPENSATED, GOOD, IMPORTED_FROM, RAPID, call

pytestmark = [pytest.mark.ci, pytest.mark.usefixtures("own_folder")]

SERVER = ("-m", "polarcheck", "server")
ONLY_RAPID = ("--select", "rapid-in-polar,start-up-shorter-than-radius,wrong-dash")
#: Long enough for any machine: what is never said ends the test [s].
PATIENCE = 60
INITIALIZE = {"processId": None, "rootUri": None, "capabilities": {}}


def environment() -> dict[str, str]:
    return {**os.environ, "PYTHONPATH": IMPORTED_FROM, "PYTHONUTF8": "1"}


@contextlib.asynccontextmanager
async def session(
    *options: str,
    command: Sequence[str] = SERVER,
    folders: Sequence[str] = (".",),
    capabilities: types.ClientCapabilities | None = None,
) -> AsyncIterator[LanguageClient]:
    """A client with a server of its own, up to the end that the protocol asks for."""
    client = make_test_lsp_client()
    await client.start_io(sys.executable, *command, *options, env=environment())
    open_folders = [types.WorkspaceFolder(Path(folder).resolve().as_uri(), folder) for folder in folders]
    await client.initialize_session(
        types.InitializeParams(
            capabilities=capabilities or types.ClientCapabilities(),
            workspace_folders=open_folders,
            root_uri=open_folders[0].uri if open_folders else None,
        )
    )
    try:
        yield client
    finally:
        await client.shutdown_session()
        await client.stop()
    assert client._server is not None
    assert client._server.returncode == 0


class Document:
    """An open document, as its client sees it."""

    def __init__(self, client: LanguageClient, path: str, text: str, language: str = "gcode") -> None:
        self.client, self.text, self.version = client, text, 1
        self.uri = Path(path).absolute().as_uri() if ":" not in path else path
        self.named = types.TextDocumentIdentifier(self.uri)
        client.text_document_did_open(
            types.DidOpenTextDocumentParams(types.TextDocumentItem(self.uri, language, 1, text))
        )

    def type(self, line: int, character: int, end: int, text: str) -> None:
        """Replace some units of a line, the first being 0."""
        place = types.Range(types.Position(line, character), types.Position(line, end))
        self.change(types.TextDocumentContentChangePartial(place, text))

    def write(self, text: str) -> None:
        self.change(types.TextDocumentContentChangeWholeDocument(text))

    def change(
        self, change: types.TextDocumentContentChangePartial | types.TextDocumentContentChangeWholeDocument
    ) -> None:
        self.version += 1
        document = types.VersionedTextDocumentIdentifier(self.version, self.uri)
        self.client.text_document_did_change(types.DidChangeTextDocumentParams(document, [change]))

    async def marks(self, *codes: str) -> Sequence[types.Diagnostic]:
        """The marks of the document, once they are these."""

        def found() -> list[str] | None:
            marks = self.client.diagnostics.get(self.uri)
            return None if marks is None else [str(mark.code) for mark in marks]

        await until(lambda: found() == list(codes), found)
        return self.client.diagnostics[self.uri]

    async def hover(self, line: int, character: int) -> str:
        found = await self.client.text_document_hover_async(
            types.HoverParams(self.named, types.Position(line, character))
        )
        if found is None:
            return ""
        assert isinstance(found.contents, types.MarkupContent)
        return found.contents.value


async def until(holds: Callable[[], bool], told: Callable[[], object]) -> None:
    """Wait for something that the server says by itself."""
    try:
        async with asyncio.timeout(PATIENCE):
            while not holds():
                await asyncio.sleep(0.02)
    except TimeoutError:
        pytest.fail(f"there is only {told()}")


# ---- a session ----


@pytest.mark.asyncio
async def test_a_program_is_written_with_it() -> None:
    Path("sub").mkdir()
    Path("sub/O77.NC").write_text("O77\nM99\n", "utf-8")
    Path("polarcheck.toml").write_text('machine = "fanuc-30i"\n[run]\nsubprograms = ["sub"]\n', "utf-8")
    async with session(*ONLY_RAPID) as client:
        program = Document(client, "O1.NC", RAPID + "M98 P77\nM30\n")
        (mark,) = await program.marks("rapid-in-polar")
        assert mark.range == types.Range(types.Position(3, 0), types.Position(3, 2))
        assert "alarm PS0146" in mark.message

        assert (await program.hover(3, 1)).startswith("rapid-in-polar (polar, error, alarm PS0146")
        assert "F 200 mm/min" in await program.hover(2, 0)
        lenses = await client.text_document_code_lens_async(types.CodeLensParams(program.named))
        assert lenses is not None
        assert [lens.range.start.line for lens in lenses] == [1]
        (location,) = await client.text_document_definition_async(
            types.DefinitionParams(program.named, types.Position(6, 5))
        )
        assert location.uri == Path("sub/O77.NC").resolve().as_uri()
        (symbol,) = await client.text_document_document_symbol_async(types.DocumentSymbolParams(program.named))
        assert [inner.name for inner in symbol.children] == ["G12.1"]
        selected = types.CodeActionParams(program.named, mark.range, types.CodeActionContext([mark]))
        offered = await client.text_document_code_action_async(selected)
        assert offered is not None
        assert offered[-1].title == "Allow rapid-in-polar here"
        others = types.CodeActionContext([mark], only=[types.CodeActionKind.Refactor])
        assert not await client.text_document_code_action_async(
            types.CodeActionParams(program.named, mark.range, others)
        )

        program.type(3, 6, 6, " (POLARCHECK ALLOW ")
        offered_names = await client.text_document_completion_async(
            types.CompletionParams(program.named, types.Position(3, 25))
        )
        assert isinstance(offered_names, Sequence)
        (item,) = (one for one in offered_names if one.label == "RAPID-IN-POLAR")
        page = (await client.completion_item_resolve_async(item)).documentation
        assert isinstance(page, types.MarkupContent)
        assert "G12.1" in page.value
        program.type(3, 25, 25, "RAPID-IN-POLAR PROVEN)")
        await program.marks()

        program.type(3, 0, 47, "G0 C5.")
        await program.marks("rapid-in-polar")
        program.type(3, 1, 2, "1")
        assert not await program.marks()

        client.text_document_did_close(types.DidCloseTextDocumentParams(program.named))
        assert await program.hover(2, 0) == ""
        assert not await client.text_document_code_lens_async(types.CodeLensParams(program.named))


# ---- settings ----


@pytest.mark.asyncio
async def test_changes_of_settings_are_taken() -> None:
    """Told by the editor, which is asked to where it can, or seen by the server itself: network drives tell nobody."""
    watching = types.DidChangeWatchedFilesClientCapabilities(dynamic_registration=True)
    of_workspace = types.WorkspaceClientCapabilities(
        did_change_watched_files=watching, code_lens=types.CodeLensWorkspaceClientCapabilities(refresh_support=True)
    )
    asked: list[str] = []
    async with session(*ONLY_RAPID, capabilities=types.ClientCapabilities(workspace=of_workspace)) as client:

        @client.feature(types.CLIENT_REGISTER_CAPABILITY)
        def register(params: types.RegistrationParams) -> None:
            asked.extend(one.method for one in params.registrations)

        @client.feature(types.WORKSPACE_CODE_LENS_REFRESH)
        def refresh(*params: object) -> None:
            asked.append(types.WORKSPACE_CODE_LENS_REFRESH)

        program = Document(client, "O1.NC", COMPENSATED)
        await program.marks("not-evaluated")
        methods = {types.WORKSPACE_DID_CHANGE_WATCHED_FILES, types.WORKSPACE_CODE_LENS_REFRESH}
        await until(lambda: methods <= set(asked), lambda: asked)
        Path("polarcheck.toml").write_text("[tools.1]\nradius = 4.0\n", "utf-8")
        await program.marks()
        Path("polarcheck.toml").write_text("[tools.1]\nradius = 40.0\n", "utf-8")
        await program.marks("start-up-shorter-than-radius")
        Path("polarcheck.toml").write_text("[tools.1]\nradios = 4.0\n", "utf-8")
        changed = types.FileEvent(Path("polarcheck.toml").absolute().as_uri(), types.FileChangeType.Changed)
        client.workspace_did_change_watched_files(types.DidChangeWatchedFilesParams([changed]))
        (mark,) = await program.marks("not-checked")
        assert "did you mean radius?" in mark.message
        Path("polarcheck.toml").unlink()
        await program.marks("not-evaluated")
        # A document of settings is no program.
        job = Document(client, "polarcheck.toml", "[tools.1]\nradius = 4.0\n", "toml")
        assert await job.hover(0, 1) == ""
        assert not client.diagnostics.get(job.uri)


# ---- what nobody vouches for ----

#: Starts the server with a note of every file that it opens and every folder that it lists.
WATCHED = """
import os, sys
notes = os.open(sys.argv.pop(1), os.O_WRONLY | os.O_APPEND | os.O_CREAT)
def note(event, given):
    if event in ("open", "os.listdir", "os.scandir") and isinstance(given[0], (str, bytes, os.PathLike)):
        os.write(notes, (os.fsdecode(given[0]) + "\\n").encode())
sys.addaudithook(note)
from polarcheck.commands import run
sys.argv = ["polarcheck", "server", *sys.argv[1:]]
run()
"""


@pytest.mark.asyncio
async def test_it_opens_nothing_outside_its_folders(tmp_path: Path) -> None:
    """A folder of programs that somebody has sent: its settings point to where they have no business."""
    shop = tmp_path / "shop"
    (shop / "w" / "inner").mkdir(parents=True)
    (shop / "named").mkdir()
    (shop / "named" / "O77.NC").write_text("O77\nG0 C5.\nM99\n", "utf-8")
    for name in ("polarcheck.toml", "secret.txt", "secret.toml", "named/secret.txt"):
        (shop / name).write_text("[tools.1]\nradius = 40.0\n", "utf-8")
    texts = {
        "a": 'offsets = "../../secret.txt"\n',
        "b": 'machine = "../../secret.toml"\n',
        "c": 'extend = "../../polarcheck.toml"\n',
        "d": f"offsets = '{shop / 'secret.txt'}'\n",
        "e": '[run]\nsubprograms = ["../../named"]\n',
        "t": 'machine = "../../lathes/nl.toml"\n',
    }
    (shop / "lathes").mkdir()
    (shop / "lathes" / "nl.toml").write_text('inherits = "fanuc-30i"\n', "utf-8")
    if sys.platform != "win32":
        texts["f"] = "[tools.1]\nradius = 40.0\n"
    for name, text in texts.items():
        (shop / "w" / name).mkdir()
        (shop / "w" / name / "polarcheck.toml").write_text(text, "utf-8")
    if sys.platform != "win32":
        (shop / "w" / "f" / "polarcheck.toml").unlink()
        (shop / "w" / "f" / "polarcheck.toml").symlink_to(shop / "secret.toml")
    notes = tmp_path / "notes"
    command = ("-c", WATCHED, str(notes))
    trusts = ("--trust", str(shop / "lathes"))
    async with session(*ONLY_RAPID, *trusts, command=command, folders=[str(shop / "w")]) as client:
        for name in texts:
            program = RAPID.replace("G0 C5.", "M98 P77") if name == "e" else RAPID
            opened_one = Document(client, str(shop / "w" / name / "O1.NC"), program)
            (mark,) = await opened_one.marks("rapid-in-polar" if name in "et" else "not-checked")
            assert ("lies outside the folders that are open" in mark.message) == (name not in "et")
        plain = Document(client, str(shop / "w" / "O1.NC"), GOOD)
        assert not await plain.marks()
    opened = {Path(line) for line in notes.read_text("utf-8").splitlines()}
    in_shop = {path.relative_to(shop).parts[0] for path in opened if path.is_relative_to(shop)}
    # Below these it goes from folder to folder, each opened in the one before it.
    assert in_shop == {"w", "named", "lathes"}
    below = {path.name for path in opened if not path.is_absolute()}
    assert {"polarcheck.toml", "O77.NC", "nl.toml"} <= below
    assert not {name for name in below if name.startswith("secret")}


# ---- what goes wrong ----

#: A check that prints, has a bug, or never ends, as the program asks for.
TROUBLED = """
import sys, time
from polarcheck.checking import check
from polarcheck.foundation.time_limit import keep_time
sound = check.check_runs
def troubled(found, *more):
    text = found[0][1]["text"].source.text
    print("printed by a check")
    if "(BUG)" in text:
        raise ZeroDivisionError("a bug\\x1b[31m")
    while "(SLOW)" in text:
        time.sleep(0.01)
        keep_time()
    return sound(found, *more)
check.check_runs = troubled
from polarcheck.commands import run
sys.argv = ["polarcheck", "server", *sys.argv[1:]]
run()
"""


@pytest.mark.nightly
@pytest.mark.asyncio
async def test_a_bug_or_a_long_check_is_not_the_end() -> None:
    async with session(*ONLY_RAPID, command=("-c", TROUBLED)) as client:
        program = Document(client, "O1.NC", RAPID + "(BUG)\n")
        (mark,) = await program.marks("not-checked")
        assert "internal error of polarcheck: ZeroDivisionError: a bug" in mark.message
        assert "\x1b" not in mark.message
        program.type(6, 5, 5, "(BUG)")
        await until(lambda: len(client.log_messages) > 1, lambda: client.log_messages)
        (message,) = client.messages  # once, however often it is checked
        assert message.message.startswith("polarcheck: internal error: ZeroDivisionError")
        assert "Traceback" in client.log_messages[0].message
        assert not any("\x1b" in logged.message for logged in client.log_messages)
        program.write(RAPID)
        await program.marks("rapid-in-polar")
        await _keeps_nobody_from_typing(client)


async def _keeps_nobody_from_typing(client: LanguageClient) -> None:
    """A long check is stopped as soon as the text is another, and its outcome is never shown."""
    program = Document(client, "O2.NC", RAPID + "(SLOW)\n")
    asked = asyncio.ensure_future(program.hover(3, 1))
    await asyncio.sleep(0.3)
    assert not asked.done()
    assert program.uri not in client.diagnostics
    for _ in range(3):
        program.type(6, 6, 6, " ")
    program.type(6, 0, 99, "M30")
    await program.marks("rapid-in-polar")
    assert (await asked).startswith("rapid-in-polar")
    # Closed while it is checked: whoever asks gets an answer, and the session ends in time.
    program.type(6, 0, 0, "(SLOW)")
    asked = asyncio.ensure_future(program.hover(3, 1))
    await asyncio.sleep(0.3)
    client.text_document_did_close(types.DidCloseTextDocumentParams(program.named))
    assert await asked == ""
    Document(client, "O3.NC", "(SLOW)")


# ---- the process ----


def message(**body: Any) -> bytes:
    data = json.dumps({"jsonrpc": "2.0", **body}).encode()
    return b"Content-Length: %d\r\n\r\n%b" % (len(data), data)


SHUTDOWN, EXIT = message(id=2, method="shutdown"), message(method="exit")
BEGIN = message(id=1, method="initialize", params=INITIALIZE)


def spoken(given: bytes) -> tuple[int, bytes, bytes]:
    done = subprocess.run(
        [sys.executable, *SERVER], input=given, capture_output=True, timeout=PATIENCE, env=environment()
    )
    return done.returncode, done.stdout, done.stderr


@pytest.mark.one_in(5)
@pytest.mark.parametrize(
    ("given", "code"),
    [
        (BEGIN + SHUTDOWN + EXIT, 0),
        (BEGIN + EXIT, 1),
        (BEGIN, 1),
        (BEGIN + b"Content-Length: 99\r\n\r\n{", 1),
        (b"G12.1\n" * 100, 1),
    ],
    ids=["said so", "did not say so", "gone", "broken off", "no editor"],
)
def test_it_ends_with_its_editor(given: bytes, code: int) -> None:
    status, out, error = spoken(given)
    assert status == code
    assert b"Traceback" not in error
    assert out == b"" or out.startswith(b"Content-Length: ")


@pytest.mark.nightly
def test_broken_messages_end_nothing() -> None:
    broken = b"Content-Length: 3\r\n\r\n{]}" + b"Content-Length: 2\r\n\r\n[]" + message(method="no/such")
    unknown = message(id=7, method="textDocument/hover", params={"textDocument": 5})
    status, out, _ = spoken(BEGIN + broken + unknown + message(id=8, method="no/such") + SHUTDOWN + EXIT)
    assert status == 0
    assert out.count(b'"id": 2') == 1


@pytest.mark.nightly
@pytest.mark.skipif(sys.platform == "win32", reason="signals of POSIX")
@pytest.mark.parametrize(("number", "code"), [("SIGTERM", 143), ("SIGINT", 130)])
def test_it_ends_when_it_is_told_to(number: str, code: int) -> None:
    pipes = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE, "stderr": subprocess.PIPE}
    # What is started in the background has the interrupt ignored, which is inherited.
    heed = partial(signal.signal, getattr(signal, number), signal.SIG_DFL)
    with subprocess.Popen([sys.executable, *SERVER], env=environment(), preexec_fn=heed, **pipes) as running:
        assert running.stdin is not None
        assert running.stdout is not None
        running.stdin.write(BEGIN)
        running.stdin.flush()
        assert running.stdout.readline().startswith(b"Content-Length: ")
        running.send_signal(getattr(signal, number))
        assert running.wait(PATIENCE) == code


@pytest.mark.nightly
@pytest.mark.skipif(sys.platform == "win32", reason="pipes of POSIX")
def test_an_editor_that_reads_no_more_is_gone() -> None:
    pipes = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE, "stderr": subprocess.PIPE}
    with subprocess.Popen([sys.executable, *SERVER], env=environment(), **pipes) as running:
        assert running.stdin is not None
        assert running.stdout is not None
        running.stdout.close()
        running.stdin.write(BEGIN)
        running.stdin.flush()
        assert running.wait(PATIENCE) == 1


@pytest.mark.nightly
@pytest.mark.skipif(sys.platform == "win32", reason="a shell of POSIX closes streams")
def test_without_streams_it_says_who_starts_it() -> None:
    command = f"{sys.executable} -m polarcheck server <&-"
    done = subprocess.run(["sh", "-c", command], capture_output=True, text=True, timeout=PATIENCE, env=environment())
    assert done.returncode in (1, 2)
    assert "Traceback" not in done.stderr


def test_without_the_extra_it_says_what_to_install(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "pygls", None)
    result = call("server")
    assert (result.exit_code, result.stdout) == (2, "")
    assert result.stderr == "polarcheck: the server needs pygls, of the extra [server]: pip install pygls\n"


def test_the_first_answer_needs_no_tables() -> None:
    """An editor waits for it; what a check needs is loaded behind it."""
    code = (
        "import sys, polarcheck.editor.process, polarcheck.editor.server_session, polarcheck.commands.server\n"
        "assert not {'numpy', 'shapely', 'rich', 'polarcheck.checking.check'} & set(sys.modules)\n"
    )
    subprocess.run([sys.executable, "-c", code], check=True, env=environment())
