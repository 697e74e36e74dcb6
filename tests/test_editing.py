"""A session as the messages on the wire are; tests/test_server.py has the same with a real client and a process."""

from __future__ import annotations

import os
import time
from pathlib import Path

import pytest
from cases import looped
from lsp_editor import Editor, place
from test_cli import COMPENSATED, RAPID

from polarcheck.checking import check
from polarcheck.commands import server as command
from polarcheck.editor import diagnostics
from polarcheck.foundation import record

pytestmark = pytest.mark.usefixtures("own_folder")

ONLY_RAPID = ("--select", "rapid-in-polar,start-up-shorter-than-radius,wrong-dash")


@pytest.mark.nightly
def test_all_that_an_editor_asks_is_answered() -> None:
    with Editor(*ONLY_RAPID, "--machine", "fanuc-30i") as editor:
        program = editor.open("O1.NC", RAPID + "GOTO10\nN10 M30\n")
        (mark,) = editor.marks(program, "rapid-in-polar")
        assert mark["range"] == {"start": place(3, 0), "end": place(3, 2)}
        assert editor.published[program][0] == 1
        assert editor.asks("hover", program, 3, 1)["contents"]["value"].startswith("rapid-in-polar (polar, error")
        assert "F 200 mm/min" in editor.asks("hover", program, 2, 1)["contents"]["value"]
        assert editor.asks("hover", program, 99) is None
        (lens,) = editor.asks("codeLens", program)
        assert lens["range"]["start"] == place(1, 0)
        (symbol,) = editor.asks("documentSymbol", program)
        assert [inner["name"] for inner in symbol["children"]] == ["G12.1", "N10"]
        (target,) = editor.asks("definition", program, 6, 5)
        assert (target["uri"], target["range"]["start"]) == (program, place(7, 0))
        context = {"diagnostics": [], "only": ["quickfix"]}
        (allow,) = (
            one
            for one in editor.asks("codeAction", program, range=mark["range"], context=context)
            if "Allow" in one["title"]
        )
        (edit,) = allow["edit"]["changes"][program]
        assert edit["newText"] == " (POLARCHECK ALLOW RAPID-IN-POLAR )"
        others = {"diagnostics": [], "only": ["refactor.extract"]}
        assert editor.asks("codeAction", program, range=mark["range"], context=others) == []
        editor.change(program, 2, "G0 C5. (POLARCHECK ALLOW ", (3, 0, 6))
        items = editor.asks("completion", program, 3, 25)
        (item,) = (one for one in items if one["label"] == "RAPID-IN-POLAR")
        assert "G12.1" in editor.ask("completionItem/resolve", item)["documentation"]["value"]
        editor.change(program, 3, RAPID.replace("G0 C5.", "G1 C5."))
        assert editor.marks(program) == []
        editor.close(program)
        assert editor.asks("hover", program, 2, 1) is None
        assert editor.asks("completion", program, 3, 25) == []
        editor.change(program, 4, "of a document that is not open")
        editor.close("file:///never/open")
    assert editor.code == 0


@pytest.mark.ci
def test_a_buffer_without_a_file_and_one_outside_have_the_options_alone() -> None:
    Path("open").mkdir()
    Path("polarcheck.toml").write_text("machin = 1\n", "utf-8")
    Path("open/polarcheck.toml").write_text("[tools.1]\nradius = 40.0\n", "utf-8")
    with Editor(*ONLY_RAPID, "--tool", "2:radius=4", folders=["open"]) as editor:
        editor.marks(editor.open("untitled:Untitled-1", COMPENSATED), "start-up-shorter-than-radius")
        outside = editor.open("O1.NC", COMPENSATED.replace("T0101", "T0202"))
        assert editor.marks(outside) == []
        # The folder is opened, too: its settings count from then on.
        folder = {"uri": Path().resolve().as_uri(), "name": "."}
        event = {"event": {"added": [folder], "removed": []}}
        editor.tell("workspace/didChangeWorkspaceFolders", event)
        editor.marks(outside, "not-checked")


@pytest.mark.ci
@looped("uri", [True, False])
def test_without_folders_that_of_the_session_or_of_the_file_counts(uri: bool) -> None:
    Path("polarcheck.toml").write_text("[tools.1]\nradius = 40.0\n", "utf-8")
    with Editor(*ONLY_RAPID, folders=[], uri=Path().resolve().as_uri() if uri else None) as editor:
        editor.marks(editor.open("O2.NC", COMPENSATED), "start-up-shorter-than-radius")
        new = editor.open("untitled:Untitled-1", COMPENSATED)
        editor.marks(new, "start-up-shorter-than-radius" if uri else "not-evaluated")


@pytest.mark.ci
@looped(("units", "before"), [("utf-8", 7), ("utf-16", 5), ("utf-32", 4)], one_in=2)
def test_an_editor_chooses_how_characters_are_counted(units: str, before: int) -> None:
    with Editor(*ONLY_RAPID, capabilities={"general": {"positionEncodings": [units]}}) as editor:
        assert editor.capabilities["positionEncoding"] == units
        program = editor.open("O1.NC", RAPID.replace("G0 C5.", "(\U0001f600) G0 C5."))
        (mark,) = editor.marks(program, "rapid-in-polar")
        assert mark["range"] == {"start": place(3, before), "end": place(3, before + 2)}
        # Lines that end for Python and for no editor, and places that are not there.
        editor.change(program, 2, "\x85\u2028\x0b1", (3, before + 1, before + 2))
        editor.change(program, 3, "G1 C5.", (3, 0, 10_000))
        editor.change(program, 4, "(END)", (99, 0, 5))
        assert editor.marks(program) == []


@pytest.mark.ci
def test_settings_are_read_anew_when_they_change() -> None:
    dynamic = {"didChangeWatchedFiles": {"dynamicRegistration": True}, "codeLens": {"refreshSupport": True}}
    with Editor(*ONLY_RAPID, capabilities={"workspace": dynamic}) as editor:
        program = editor.open("O1.NC", COMPENSATED)
        editor.marks(program, "not-evaluated")
        (watched,) = editor.wait_for("client/registerCapability")["registrations"]
        assert watched["method"] == "workspace/didChangeWatchedFiles"
        editor.wait_for("workspace/codeLens/refresh")
        Path("polarcheck.toml").write_text("[tools.1]\nradius = 4.0\n", "utf-8")
        editor.tell("workspace/didChangeWatchedFiles", {"changes": []})
        assert editor.marks(program) == []
        Path("polarcheck.toml").write_text("[tools.1]\nradius = 40.0\n", "utf-8")
        editor.tell("textDocument/didSave", {"textDocument": {"uri": program}})
        editor.marks(program, "start-up-shorter-than-radius")
        Path("polarcheck.toml").rename("polarcheck.toml.old")
        editor.tell("workspace/didChangeConfiguration", {"settings": {}})
        editor.marks(program, "not-evaluated")  # seen by the server itself
        editor.open("polarcheck.toml", "[tools.1]\nradius = 4.0\n")
        assert editor.asks("hover", Path("polarcheck.toml").absolute().as_uri(), 1, 1) is None


@pytest.mark.ci
def test_called_programs_are_watched_where_they_lie() -> None:
    Path("sub").mkdir()
    Path("polarcheck.toml").write_text('[run]\nsubprograms = ["sub"]\n', "utf-8")
    with Editor("--select", "rapid-in-polar,subprogram-missing") as editor:
        program = editor.open("O1.NC", RAPID.replace("G0 C5.", "M98 P77"))
        editor.marks(program, "subprogram-missing")
        Path("sub/O77.NC").write_text("O77\nG0 C5.\nM99\n", "utf-8")
        editor.marks(program, "rapid-in-polar")
        Path("sub/O77.NC").write_text("O77\nG1 C5. (GOOD)\nM99\n", "utf-8")
        assert editor.marks(program) == []


@pytest.mark.ci
def test_markdown_is_for_those_who_show_it() -> None:
    shows = {"textDocument": {"hover": {"contentFormat": ["markdown", "plaintext"]}, "publishDiagnostics": {}}}
    with Editor(
        *ONLY_RAPID, capabilities={**shows, "workspace": {"workspaceEdit": {"documentChanges": True}}}
    ) as editor:
        program = editor.open("O1.NC", RAPID, 7)
        (mark,) = editor.marks(program, "rapid-in-polar")
        shown = editor.asks("hover", program, 3, 1)["contents"]
        assert shown["kind"] == "markdown"
        assert shown["value"].startswith("**rapid-in-polar**, alarm ")
        action = editor.asks("codeAction", program, range=mark["range"], context={"diagnostics": []})[-1]
        (change,) = action["edit"]["documentChanges"]
        assert change["textDocument"] == {"uri": program, "version": 7}


@pytest.mark.ci
def test_a_bug_in_a_check_or_an_answer_is_told(monkeypatch: pytest.MonkeyPatch) -> None:
    sound = check.check_runs

    def troubled(*given: object) -> object:
        raise ZeroDivisionError("\x1b[31m")

    with Editor(*ONLY_RAPID) as editor:
        monkeypatch.setattr(check, "check_runs", troubled)
        program = editor.open("O1.NC", RAPID)
        (mark,) = editor.marks(program, "not-checked")
        assert mark["message"].endswith("internal error of polarcheck: ZeroDivisionError: \\x1b[31m")
        assert editor.wait_for("window/showMessage")["message"].startswith("polarcheck: internal error: ZeroDivision")
        assert "Traceback" in editor.wait_for("window/logMessage")["message"]
        monkeypatch.setattr(check, "check_runs", sound)
        monkeypatch.setattr(diagnostics, "_not_evaluated", troubled)
        editor.change(program, 2, RAPID + "\n")
        assert editor.asks("hover", program, 2, 1) is not None
        monkeypatch.undo()
        editor.change(program, 3, RAPID)
        editor.marks(program, "rapid-in-polar")
        assert editor.ask("no/such", {})["code"] == -32601


def test_memory_that_is_not_there_ends_no_session(monkeypatch: pytest.MonkeyPatch) -> None:
    def full(*given: object) -> object:
        raise MemoryError

    with Editor(*ONLY_RAPID) as editor:
        monkeypatch.setattr(check, "check_runs", full)
        (mark,) = editor.marks(editor.open("O1.NC", RAPID), "not-checked")
        assert "there is not enough memory to check this program" in mark["message"]


def test_who_waits_for_a_document_that_is_closed_gets_an_answer(monkeypatch: pytest.MonkeyPatch) -> None:
    """And what was typed meanwhile is what counts."""
    sound = check.check_runs
    slow = [True]

    def waiting(*given: object) -> object:
        from polarcheck.foundation.time_limit import keep_time

        while slow[0]:
            time.sleep(0.01)
            keep_time()
        return sound(*given)  # type: ignore[arg-type]

    monkeypatch.setattr(check, "check_runs", waiting)
    with Editor(*ONLY_RAPID) as editor:
        program = editor.open("O1.NC", RAPID)
        other = editor.open("O2.NC", RAPID)
        for version in range(2, 6):
            editor.change(program, version, RAPID + "\n" * version)
        editor.close(other)
        assert editor.asks("codeLens", other) == []
        slow[0] = False
        editor.marks(program, "rapid-in-polar")
        assert editor.published[program][0] == 5
        assert editor.published[other][1] == []


def test_what_the_options_name_is_trusted_with_what_lies_beside_it(tmp_path: Path) -> None:
    for name in ("a/job.toml", "b/table.txt", "c/nl.toml"):
        (tmp_path / name).parent.mkdir()
        (tmp_path / name).write_text("", "utf-8")
    asked = {"config": tmp_path / "a/job.toml", "offsets": tmp_path / "b/table.txt", "subprograms": ["s"]}
    found = command._trusted((tmp_path / "t",), {**asked, "machine": str(tmp_path / "c/nl.toml")})
    real = Path(os.path.realpath(tmp_path))
    assert found == [tmp_path / "t", real / "a", real / "b", real / "c", Path("s")]
    nothing = {"config": None, "offsets": None, "subprograms": [], "machine": "fanuc"}
    assert command._trusted((), nothing) == []


def test_files_that_have_no_name_are_not_there() -> None:
    Path("a").write_text("", "utf-8")
    first, second, third = map(record.version, ["a", "no", "a\0b"])
    assert first is not None
    assert second is None
    assert third is None
