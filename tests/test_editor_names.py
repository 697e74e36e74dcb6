"""References and rename of N numbers, labels, variables and programs, in a document and over files."""

from __future__ import annotations

import asyncio
import re
from pathlib import Path
from typing import Any

import pytest
from cases import looped
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from lsp_editor import Editor, place
from polarcheck.errors import PolarcheckError

from polarcheck.commands.server import _Settings
from polarcheck.editor.buffers import Buffer
from polarcheck.editor.open_text import OpenText
from polarcheck.editor.server_session import Server
from polarcheck.editor.structure import reference_search, renaming
from polarcheck.editor.structure.document import Document
from polarcheck.editor.structure.workspace import Opened, Workspace
from polarcheck.program.machines import profiles

pytestmark = [pytest.mark.ci, pytest.mark.usefixtures("own_folder")]

MAIN = """%
O0001(MAIN)
N10 G98 G0 X60. C0
M98 P2
N20 G65 P3 A1.
IF[#101EQ1]GOTO20
G71 P10 Q20 U0.5
M98 P30002
#101=#102+1
GOTO 10
M30
O2
M99 P10
O0003
#1=#1+1
#101=0
M99
%
"""


def files(text: str, machine: str = "fanuc", **others: str) -> tuple[Document, Workspace]:
    """A document, with other files saved beside it."""
    here = Path().resolve()
    for name, content in others.items():
        Path(f"{name}.NC").write_text(content, "utf-8", newline="")
    profile = profiles.load(machine).machine
    document = Document((here / "O1.NC").as_uri(), here / "O1.NC", OpenText(text), profile)
    return document, Workspace(document, (), [here], lambda _: (profile, ()))


def cursor(text: str) -> tuple[str, Any]:
    """The text without the ^ before the cursor, and its position."""
    at = text.index("^")
    bare = text[:at] + text[at + 1 :]
    return bare, OpenText(bare).position(at)


def used(text: str, machine: str = "fanuc", **others: str) -> list[str]:
    """The lines that refer to what stands behind ^, in other files with their name."""
    bare, position = cursor(text)
    document, workspace = files(bare, machine, **others)
    found = reference_search.references(document, position, workspace, with_declaration=True)
    lines = []
    for one in found:
        name = one.uri.rpartition("/")[2]
        lines.append(f"{'' if name == 'O1.NC' else name + ':'}{one.range.start.line + 1}")
    return lines


def renamed(text: str, new: str, machine: str = "fanuc", **others: str) -> dict[str, str]:
    """Each file with its changes."""
    bare, position = cursor(text)
    document, workspace = files(bare, machine, **others)
    made = {}
    for uri, edits in renaming.rename(document, position, new, workspace).items():
        name = uri.rpartition("/")[2]
        shown = document.text if name == "O1.NC" else OpenText(others[name.removesuffix(".NC")])
        changed = shown.text
        for edit in sorted(edits, key=lambda one: shown.offset(one.range.start), reverse=True):
            start, end = shown.offset(edit.range.start), shown.offset(edit.range.end)
            changed = changed[:start] + edit.new_text + changed[end:]
        made[name] = changed
    return made


def at(pattern: str, text: str = MAIN) -> str:
    """A text with the cursor before what matches."""
    match = re.search(pattern, text)
    assert match
    return text[: match.start()] + "^" + text[match.start() :]


# ---- references ----


@looped(
    ("where", "lines"),
    [
        ("N10", ["3", "7", "10", "13"]),
        ("10\nM30", ["3", "7", "10", "13"]),
        ("P10\nO0003", ["3", "7", "10", "13"]),
        ("N20", ["5", "6", "7"]),
        ("#101EQ", ["6", "9", "16"]),
        ("#1=", ["15", "15"]),
        ("O2\n", ["4", "8", "12"]),
        ("P30002", ["4", "8", "12"]),
        ("P3 A1", ["5", "14"]),
        ("G98", []),
    ],
)
def test_all_uses_of_a_name_are_found(where: str, lines: list[str]) -> None:
    assert used(at(where)) == lines


@looped(
    ("machine", "text", "lines"),
    [
        ("siemens-transmit", '^ANF: X1\nGOTOB ANF\nREPEAT ANF P=3\nMSG("ANF")\n;ANF\nM30\n', ["1", "2", "3"]),
        ("siemens-transmit", "DEF REAL WIDTH=5\nX=^WIDTH\nWIDTH=WIDTH*2\nM30\n", ["1", "2", "3", "3"]),
        ("siemens-transmit", "R1=5\nX=^R1 R1=R01+R11\nM30\n", ["1", "2", "2", "2"]),
        ("siemens-transmit", "L100\n^L100 P2\nSUB(1)\nM30\n", ["1", "2"]),
        ("okuma-osp", "$A.MIN%\nO1\n^NLAP1 G0 X1\nIF [VC1 EQ 1] NLAP1\nG85 NLAP1 D2\nM2\n", ["3", "4", "5"]),
        ("okuma-osp", "O1\nVC1=2\nX=^VC1+VC12\nM2\n", ["2", "3"]),
        ("fanuc", "O1\nG75 X1. P^1000 Q2000\nN1000\nN2000\nM30\n", []),
        ("fanuc", "O1\nN5 (N5 \U0001f600) #5=1\nGOTO^5\nM30\n", ["2", "3"]),
        ("haas-lathe", "O1\nM97 P^100\nM30\nN100 X1.\nM99\n", ["2", "4"]),
    ],
)
def test_names_are_those_of_the_language(machine: str, text: str, lines: list[str]) -> None:
    assert used(text, machine) == lines


def test_uses_are_found_in_other_files() -> None:
    caller = "O0100\nM98 P2\n#101=1\nN10 X1.\n(P2)\nM30\n"
    own = "O0200\nM98 P2\n#101=1\nM30\nO2\nM99\n"
    assert used(at("O2\n"), A=caller, B=own) == ["4", "8", "12", "A.NC:2"]
    Path("B.NC").unlink()
    assert used(at("#101"), A=caller) == ["6", "9", "16", "A.NC:3"]
    assert used(at("P10\n"), A=caller) == ["3", "7", "10", "13", "A.NC:4"]
    assert used("O1\n#5^00=1\nM30\n", C="O9\nX#500\nM30\n") == ["2", "C.NC:2"]
    assert used("O1\nM98 P7^7\nM30\n", O77="G0 X1.\nM99\n", D="O5\nM98 P0077\nM30\n") == ["2", "D.NC:2"]


# ---- rename ----

_LINES = [
    *("N10 X1.", "N20 (N10 \U0001f600) G71 P10 Q20", "GOTO 10", "IF[#100EQ#2]GOTO20", "#100=#100+#2", "M98 P2", "O2"),
    *("M99 P10", "M99", "G65 P2 A1.", "#2=1", "M30", "/N30 GOTO10", "O3", "M98 P3", "WHILE[#2LT5]DO1", "END1"),
]


@looped(
    ("where", "new", "changes"),
    [
        ("N10", "N15", [("N10", "N15"), ("P10 Q", "P15 Q"), ("GOTO 10", "GOTO 15"), ("M99 P10", "M99 P15")]),
        ("P3 A1", "33", [("P3 A1", "P33 A1"), ("O0003", "O0033")]),
        ("O2\n", "O0005", [("P2\n", "P5\n"), ("P30002", "P30005"), ("O2\n", "O5\n")]),
        ("#101EQ", "#110", [("#101", "#110")]),
    ],
)
def test_a_rename_changes_every_use(where: str, new: str, changes: list[tuple[str, str]]) -> None:
    expected = MAIN
    for before, after in changes:
        expected = expected.replace(before, after)
    assert renamed(at(where), new) == {"O1.NC": expected}


def test_a_rename_changes_other_files_and_keeps_their_line_ends() -> None:
    caller = "O0100 (\U0001f600)\r\n(\U0001f600) M98 P0002 (P2)\r\nM30\r\n"
    made = renamed(at("O2\n"), "7", A=caller)
    assert made["A.NC"] == caller.replace("M98 P0002", "M98 P0007")
    assert renamed("^ANF: X1\nGOTOB ANF\nM30\n", "Start", "siemens-transmit") == {
        "O1.NC": "Start: X1\nGOTOB Start\nM30\n"
    }
    assert renamed("R1=2\nX=^R1\nM30\n", "r7", "siemens-transmit") == {"O1.NC": "R7=2\nX=R7\nM30\n"}
    assert renamed(at("N10"), "10") == {}


@looped(
    ("text", "new", "reason"),
    [
        (at("N10"), "20", "N20 is there already, in line 5"),
        (at("N10"), "1.5", "'1.5': expected a number of up to eight digits, as N100"),
        (at("N10"), "\x1b[31m", r"expected a number"),
        (at("O2\n"), "3", "O0003 is there already, in line 14"),
        (at("O2\n"), "12345", "line 4: P has the repeats before the last four digits, so expected four at most"),
        (at("O2\n"), "0", "expected a number from 1 on"),
        ("O1\nM98 P^2\nO2\nO2\n", "3", "O0002 is in line 4, too: it is not known which of them is called"),
        (at("#1="), "#2", None),
        (at("#1=", MAIN.replace("A1.", "A1. B2.")), "#2", "line 5 gives #1 its value by A: change the call first"),
        (at("#101"), "#102", "#102 is there already, in line 9"),
        (at("#101"), "#501", "#101 is common, #501 is retained"),
        ("O1\n#1^00=#[#1+5]\nM30\n", "#110", "line 2 computes the number of a variable: it may be #100"),
        ("O1\nN1^0\nGOTO#1\nM30\n", "15", "line 3 computes the number that it goes to: it may be N10"),
        ("O1\nX#5^021\nM30\n", "5", "#5021 is no variable of programs: system"),
        ("O1\nX#[#_^UFO[1]]\nM30\n", "5", "no variable of programs: system"),
        ("O1\nX^1.\n", "5", "there is no N number, label, variable or program here"),
        ("O1\nN5 M98 P2\nM30\nO3\nN^5 M98 P2\nM30\nO2\nM99 P5\n", "6", "line 8 means N5 of the program in line 1, too"),
        ("O1\nM98 P2\nM98 P#1\nM30\n^O2\nM99\n", "6", "line 3 computes the program that it calls: it may be O0002"),
    ],
)  # fmt: skip
def test_what_would_change_the_program_is_refused(text: str, new: str, reason: str | None) -> None:
    if reason is None:
        reason = "line 5 gives #1 its value by A: change the call first"
    with pytest.raises(PolarcheckError) as refused:
        renamed(text, new)
    assert reason in str(refused.value)
    assert str(refused.value).isprintable()


@looped(
    ("machine", "text", "new", "reason"),
    [
        ("siemens-transmit", "^ANF: X1\nGOTOB ANF\nEND1: M30\n", "END1", "END1 is there already, in line 3"),
        ("siemens-transmit", "^ANF: X1\nGOTOB ANF\nM30\n", "A B", "expected a name, as ENDE"),
        ("okuma-osp", "O1\n^NLAP1 X1\nGOTO NLAP1\nM2\n", "LAP", "expected N and up to four letters and digits"),
    ],
)
def test_labels_are_refused_in_their_language(machine: str, text: str, new: str, reason: str) -> None:
    with pytest.raises(PolarcheckError, match=reason):
        renamed(text, new, machine)


@pytest.mark.nightly
@settings(max_examples=25, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(st.lists(st.sampled_from(_LINES), min_size=1, max_size=12), st.sampled_from(["\n", "\r\n"]), st.data())
def test_a_rename_back_gives_the_same_program(lines: list[str], end: str, data: Any) -> None:
    """And in between all that was named is named, and nothing else."""
    text = end.join(["O1", *lines, ""])
    hits = list(re.finditer(r"(?<=[NPQO#])\d+|(?<=GOTO)\d+", text))
    hit = data.draw(st.sampled_from(hits))
    marked = text[: hit.start()] + "^" + text[hit.start() :]
    try:
        after = renamed(marked, "7" * len(hit[0]))
    except PolarcheckError:
        return
    changed = after["O1.NC"]
    again = changed[: hit.start()] + "^" + changed[hit.start() :]
    assert used(again) == used(marked)
    assert renamed(again, hit[0])["O1.NC"] == text


def test_two_programs_of_a_number_cannot_be_told_apart() -> None:
    with pytest.raises(PolarcheckError, match=r"O0077 is in line 1 of B.NC, too"):
        renamed("O1\nM98 P7^7\nM30\n", "78", A="O77\nM99\n", B="O77\nX1.\nM99\n")


def test_files_outside_the_folders_are_not_opened() -> None:
    Path("inside").mkdir()
    Path("outside.NC").write_text("O9\nM98 P2\nM30\n", "utf-8")
    Path("inside/link.NC").symlink_to(Path("outside.NC").resolve())
    here = Path("inside").resolve()
    document = Document(
        (here / "O1.NC").as_uri(), here / "O1.NC", OpenText("O2\nM99\n"), profiles.load("fanuc").machine
    )
    workspace = Workspace(document, (), [here], lambda _: (document.machine, ()))
    found = reference_search.references(document, OpenText("").position(0), workspace, with_declaration=True)
    assert len(found) == 1
    assert workspace.is_complete


def test_an_open_document_counts_before_its_file() -> None:
    bare, position = cursor(at("O2\n"))
    document, workspace = files(bare, A="O9\nM30\n")
    path = Path("A.NC").resolve()
    opened = [Opened(path.as_uri(), path, OpenText("O9\n\nM98 P2\n"))]
    workspace = Workspace(document, opened, [path.parent], lambda _: (document.machine, ()))
    found = reference_search.references(document, position, workspace, with_declaration=False)
    assert [(one.uri == path.as_uri(), one.range.start.line) for one in found] == [(False, 3), (False, 7), (True, 2)]


# ---- with an editor ----


def test_an_editor_finds_and_renames_over_files() -> None:
    Path("A.NC").write_text("O0100\nM98 P2\nM30\n", "utf-8")
    Path("polarcheck.toml").write_text("machin = 1\n", "utf-8")
    abilities = {
        "workspace": {"workspaceEdit": {"documentChanges": True}},
        "textDocument": {"rename": {"prepareSupport": True}},
    }
    with Editor(capabilities=abilities) as editor:
        program = editor.open("O1.NC", MAIN, version=3)
        found = editor.asks("references", program, 11, 1, context={"includeDeclaration": False})
        assert [one["range"]["start"]["line"] for one in found] == [3, 7, 1]
        marked = editor.asks("documentHighlight", program, 5, 4)
        assert [(one["range"]["start"]["line"], one["kind"]) for one in marked] == [(5, 2), (8, 3), (15, 3)]
        led = editor.asks("definition", program, 5, 4)
        assert [one["range"]["start"]["line"] for one in led] == [8, 15]
        assert [one["range"]["start"]["line"] for one in editor.asks("definition", program, 3, 5)] == [11]
        ready = editor.asks("prepareRename", program, 11, 1)
        assert ready == {"range": {"start": place(11, 1), "end": place(11, 2)}, "placeholder": "2"}
        assert editor.asks("prepareRename", program, 2, 5) is None
        edit = editor.asks("rename", program, 11, 1, newName="7")
        versions = [(one["textDocument"]["version"], len(one["edits"])) for one in edit["documentChanges"]]
        assert versions == [(3, 3), (None, 1)]
        refused = editor.asks("rename", program, 2, 1, newName="20")
        assert (refused["code"], refused["message"]) == (-32803, "N20 is there already, in line 5")
        assert editor.capabilities["renameProvider"] == {"prepareProvider": True}


# ---- in time ----


def test_names_are_read_before_somebody_asks() -> None:
    """Once nobody has typed for a moment; of two keys the second counts."""

    async def run() -> list[str]:
        server = Server(_Settings(True, {}))
        buffer = Buffer("file:///w/O1.NC", Path("/w/O1.NC"), OpenText("O1\nN5 GOTO5\n"), 1)
        server.buffers.open[buffer.uri] = buffer
        server.documents.read_ahead(buffer.uri)
        server.documents.read_ahead(buffer.uri)
        reading = server.documents._reading
        assert reading is not None
        await reading
        server.end()
        return [one.shown for one in server.documents._known[buffer.uri][1]._cached["mentions"][0].all]

    assert asyncio.run(run()) == ["O0001", "N5", "N5"]
