"""What an editor rewrites: formatting, and the N numbers of a program."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from cases import looped
from hypothesis import given, settings
from hypothesis import strategies as st
from lsp_editor import Editor, place
from lsprotocol import types
from polarcheck.errors import PolarcheckError
from test_editor_names import files
from test_editor_structure import document

from polarcheck.editor.open_text import OpenText
from polarcheck.editor.structure import renumbering, spacing

pytestmark = [pytest.mark.ci, pytest.mark.usefixtures("own_folder")]


def applied(text: OpenText, edits: list[types.TextEdit]) -> str:
    made = text.text
    for edit in sorted(edits, key=lambda one: text.offset(one.range.start), reverse=True):
        made = made[: text.offset(edit.range.start)] + edit.new_text + made[text.offset(edit.range.end) :]
    return made


def format_text(text: str, machine: str = "fanuc", shown: types.Range | None = None) -> str:
    made = document(text, machine)
    return applied(made.text, spacing.formatted(made, shown))


# ---- formatting ----

UNEVEN = """%
O0001(MAIN)
  N10G1X 10.Y5.(A  B)\x20\x20
N20  G1\tX5.    (ALIGNED)
/N30 G1
X1.,C2.  ,R1
WHILE[#1LT3]  DO1\x20
  #1=#1+1   (X)
END1
\x20\x20
T1;  M6
"""
EVEN = """%
O0001(MAIN)
N10 G1 X10. Y5. (A  B)
N20 G1 X5.    (ALIGNED)
/N30 G1
X1.,C2. ,R1
WHILE[#1LT3] DO1
  #1=#1+1   (X)
END1

T1;  M6
"""


@looped("end", ["\n", "\r\n", "\r", "\n\r\r"])
def test_blanks_stand_between_words_and_nowhere_else(end: str) -> None:
    assert format_text(UNEVEN.replace("\n", end)) == EVEN.replace("\n", end)
    assert format_text(EVEN.replace("\n", end)) == EVEN.replace("\n", end)


def test_lines_alone_are_formatted() -> None:
    shown = types.Range(types.Position(3, 4), types.Position(4, 0))
    expected = UNEVEN.replace("N20  G1\tX5.", "N20 G1 X5.")
    assert format_text(UNEVEN, shown=shown) == expected


@looped(
    ("machine", "text"),
    [
        ("fanuc", "DPRNT[X#1  Y]\nG1  X1..5\nMOVE THE  BAR\nG1\u20135X1.\n#3000=1(A  B)\n"),
        ("siemens-transmit", 'MSG("A   B")\nT="MILL  8"  M6\n%_N_A_MPF\n'),
        ("okuma-osp", "NLAP1  G0X1\n$A.MIN%\n"),
        ("citizen", "$1\nG1  X1.\n$2\nG1X2.\n$0\n"),
    ],
)
def test_what_is_no_plain_word_is_left_alone(machine: str, text: str) -> None:
    assert format_text(text, machine) == text


@pytest.mark.nightly
@settings(max_examples=60, deadline=None)
@given(
    st.lists(
        st.sampled_from(
            [
                *"GXYN ,/;(%#=[\n\r\t",
                "N10",
                "G1",
                "X 1.",
                "(A )",
                "O1",
                "\n",
                "\r\n",
                "GOTO 1",
                "\U0001f600",
                "R1=2",
                '"',
            ]
        ),
        max_size=25,
    ),
    st.sampled_from(["fanuc", "siemens-transmit", "okuma-osp", "citizen"]),
)
def test_formatting_changes_blanks_alone_and_once(parts: list[str], machine: str) -> None:
    text = "".join(parts)
    made = format_text(text, machine)
    assert made.replace(" ", "").replace("\t", "") == text.replace(" ", "").replace("\t", "")
    assert format_text(made, machine) == made


# ---- renumbering ----

JUMPS = """O0001
N1 G0 X1.
M98 P2
N5 G71 P7 Q9 U1.
N7 X1.
N9 X2.
N1000 IF[#1EQ1]GOTO1000
GOTO 5
M30
O2
M99 P1
"""
NUMBERED = """O0001
N10 G0 X1.
M98 P2
N20 G71 P30 Q40 U1.
N30 X1.
N40 X2.
N50 IF[#1EQ1]GOTO50
GOTO 20
M30
O2
M99 P10
"""


def renumbered(text: str, line: int = 1, machine: str = "fanuc", **others: str) -> dict[str, str]:
    made, workspace = files(text, machine, **others)
    edits = renumbering.renumber(made, types.Position(line, 0), workspace)
    texts = {"O1.NC": text, **{f"{name}.NC": content for name, content in others.items()}}
    return {
        uri.rpartition("/")[2]: applied(OpenText(texts[uri.rpartition("/")[2]]), of_uri)
        for uri, of_uri in edits.items()
    }


def test_numbers_and_all_that_leads_to_them_change() -> None:
    assert renumbered(JUMPS) == {"O1.NC": NUMBERED}
    assert renumbered(NUMBERED) == {}
    outside = JUMPS.replace("O2\nM99 P1\n", "")
    made = renumbered(outside, A="O2\nM99 P5\n")
    assert made == {"O1.NC": NUMBERED.replace("O2\nM99 P10\n", ""), "A.NC": "O2\nM99 P20\n"}
    assert renumbered("N0001 X1.\nN0007 X2.\nGOTO7\n", 0) == {"O1.NC": "N0010 X1.\nN0020 X2.\nGOTO20\n"}
    siemens = "N1 X1\nIF R1==1 GOTOF N3\nN2 X2\nN3 M30\n"
    assert renumbered(siemens, 0, "siemens-transmit") == {"O1.NC": "N10 X1\nIF R1==1 GOTOF N30\nN20 X2\nN30 M30\n"}
    many = "".join(f"N{number}\n" for number in range(1, 1502))
    assert renumbered(many, 0)["O1.NC"].endswith("N7500\nN7505\n")


@looped(
    ("text", "others", "reason"),
    [
        ("N1 X1.\nGOTO#1\n", {}, "line 2 computes the number that it goes to"),
        ("N1 X1.\nN1 X2.\nGOTO1\n", {}, "line 3 goes to N1, which 2 blocks have"),
        ("N1 X1.\nGOTO5\n", {}, "line 2 goes to N5, which no block has"),
        ("O1\nN5\nM98 P2\nO3\nN5\nM98 P2\nM30\n", {"A": "O2\nM99 P5\n"}, "line 2 of A.NC means N5 of other programs"),
        ("O1\nN5\nM98 P2\nM30\n", {"A": "O2\nM99 P#1\n"}, "line 2 of A.NC computes the number that it goes to"),
        ("".join(f"N{number}\n" for number in range(10_000)), {}, "10000 N numbers, and the largest possible is 9999"),
    ],
)  # fmt: skip
def test_what_is_not_known_is_refused(text: str, others: dict[str, str], reason: str) -> None:
    with pytest.raises(PolarcheckError, match=reason):
        renumbered(text, **others)


def test_the_action_says_beforehand_why_not() -> None:
    def title(text: str) -> Any:
        return renumbering.title(document(text), types.Position(0, 0))

    assert title("O0012\nN5 X1.\n") == ("Renumber the N numbers of O0012", "")
    assert title("N5 X1.\nGOTO#1\n") == (
        "Renumber the N numbers of the program",
        "line 2 computes the number that it goes to",
    )
    assert title("X1.\n") is None
    assert title("N10 X1.\nN20 X2.\n") is None


# ---- with an editor ----


def test_an_editor_formats_and_renumbers() -> None:
    with Editor(
        capabilities={
            "textDocument": {"codeAction": {"dataSupport": True, "resolveSupport": {"properties": ["edit"]}}},
        }
    ) as editor:
        program = editor.open("O1.NC", JUMPS)
        options = {"tabSize": 4, "insertSpaces": True}
        at_head = {"start": place(1, 0), "end": place(1, 0)}
        wanted = {"diagnostics": [], "only": ["refactor"]}
        asked = {"textDocument": {"uri": program}, "range": at_head, "context": wanted}
        (action,) = editor.ask("textDocument/codeAction", asked)
        assert (action["title"], action["kind"]) == ("Renumber the N numbers of O0001", "refactor.rewrite")
        resolved = editor.ask("codeAction/resolve", action)
        edits = resolved["edit"]["changes"][program]
        assert [one["newText"] for one in edits] == ["10", "20", "30", "40", "30", "40", "50", "50", "20", "10"]
        editor.change(program, 2, "N5X1.\n  GOTO#1\n")
        (refused,) = editor.ask("textDocument/codeAction", asked)
        assert refused["disabled"] == {"reason": "line 2 computes the number that it goes to"}
        document = {"textDocument": {"uri": program}, "options": options}
        assert [one["newText"] for one in editor.ask("textDocument/formatting", document)] == [" ", ""]
        first = {**document, "range": {"start": place(0, 0), "end": place(0, 5)}}
        assert len(editor.ask("textDocument/rangeFormatting", first)) == 1
        assert editor.ask("codeAction/resolve", {"title": "x"}) == {"title": "x"}


def test_an_editor_that_resolves_nothing_gets_the_edits_at_once() -> None:
    Path("A.NC").write_text("O0002\nM99 P5\n", "utf-8")
    with Editor() as editor:
        program = editor.open("O1.NC", "O1\nN5 X1.\nM98 P2\nM30\n")
        at_head = {"start": place(1, 0), "end": place(1, 0)}
        context = {"diagnostics": [], "only": ["refactor.rewrite"]}
        asked = {"textDocument": {"uri": program}, "range": at_head, "context": context}
        (action,) = editor.ask("textDocument/codeAction", asked)
        assert {uri.rpartition("/")[2]: len(edits) for uri, edits in action["edit"]["changes"].items()} == {
            "O1.NC": 1,
            "A.NC": 1,
        }
