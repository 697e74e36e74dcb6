"""What an editor shows of the structure of a program: outline, folding, colors."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from cases import looped
from hypothesis import given, settings
from hypothesis import strategies as st
from lsp_editor import Editor, place
from lsprotocol import types

from polarcheck.editor.color_names import KINDS, MODIFIERS
from polarcheck.editor.open_text import OpenText
from polarcheck.editor.structure import folding, symbols, token_colors
from polarcheck.editor.structure.document import Document
from polarcheck.program.machines import profiles

pytestmark = [pytest.mark.ci, pytest.mark.usefixtures("own_folder")]

MILLED = """%
O0001(PLATE)
(FIRST)
(SECOND)
T0101(MILL D8)
N10 G98 G0 X60. C0 (START)
M98 P2
G12.1
G1 X5. F100.
WHILE[#1LT2]DO1
#1=#1+1
END1
G13.1
T0100
T0202
N20 G65 P3 A1.
IF[#1EQ1]GOTO20
M30
O2(SUB)
M99 P10
%
"""


def document(text: str, machine: str = "fanuc", units: str = "utf-16") -> Document:
    return Document("file:///w/O1.NC", Path("/w/O1.NC"), OpenText(text, units), profiles.load(machine).machine)


def lines_of(found: list[types.DocumentSymbol], depth: int = 0) -> list[str]:
    """Each symbol with its detail and lines, what lies inside it behind more blanks."""
    shown = []
    for one in found:
        assert one.range.start <= one.selection_range.start <= one.selection_range.end <= one.range.end
        for inner in one.children or ():
            assert one.range.start <= inner.range.start <= inner.range.end <= one.range.end
        lines = f"{one.range.start.line + 1}-{one.range.end.line + 1}"
        shown.append(f"{' ' * depth}{one.name} | {one.detail or ''} | {lines}")
        shown += lines_of(list(one.children or []), depth + 1)
    return shown


# ---- outline ----


def test_programs_tools_sections_and_blocks_are_the_outline() -> None:
    assert lines_of(symbols.symbols(document(MILLED))) == [
        "O0001 | PLATE | 2-18",
        " T0101 | MILL D8 | 5-14",
        "  N10 | START | 6-6",
        "  G12.1 |  | 8-13",
        " T0202 |  | 15-18",
        "  N20 |  | 16-16",
        "O0002 | SUB | 19-20",
    ]


@looped(
    ("machine", "text", "expected"),
    [
        pytest.param(
            "siemens-transmit",
            '%_N_SHAFT_MPF\nT="MILL_8" M6 ; CUTTER\nTRANSMIT\nG1 X5\nTRAFOOF\nENDE: M30\n%_N_SUB_SPF\nM17\n',
            [
                "<SHAFT> |  | 1-6",
                ' T="MILL_8" M6 | CUTTER | 2-6',
                "  TRANSMIT |  | 3-5",
                "  ENDE |  | 6-6",
                "<SUB> |  | 7-8",
            ],
            id="siemens",
        ),
        pytest.param(
            "okuma-osp",
            "$A.MIN%\nO0001\nNLAP1 G0 X10 (START)\nG137 C0\nX20\nG136\nM2\nOFACE\nRTS\n",
            ["O0001 |  | 2-7", " NLAP1 | START | 3-3", " G137 C0 |  | 4-6", "<OFACE> |  | 8-9"],
            id="okuma",
        ),
        pytest.param("fanuc", "G0 X1.\nN5 X2.\n", ["O1.NC |  | 1-2", " N5 |  | 2-2"], id="no head"),
        pytest.param("fanuc", "", [], id="nothing"),
    ],
)
def test_the_outline_is_in_the_language_of_the_control(machine: str, text: str, expected: list[str]) -> None:
    found = lines_of(symbols.symbols(document(text, machine)))
    assert found == expected


def test_numbers_at_every_block_are_no_outline() -> None:
    """Only those with a comment, and those that something leads to."""
    blocks = [f"N{number} X{number}." for number in range(1, 200)]
    blocks[9] += " (DRILL)"
    text = "O1\n" + "\n".join(blocks) + "\nGOTO 50\nM30\n"
    assert lines_of(symbols.symbols(document(text))) == ["O0001 |  | 1-202", " N10 | DRILL | 11-11", " N50 |  | 51-51"]


# ---- folding ----


def folded(text: str, machine: str = "fanuc", most: int | None = None) -> list[tuple[int, int, str]]:
    found = folding.folding_ranges(document(text, machine), most)
    return [(one.start_line + 1, one.end_line + 1, one.kind.value if one.kind else "") for one in found]  # type: ignore[union-attr]


def test_programs_tools_sections_loops_and_comments_fold() -> None:
    whole = [
        *((2, 18, "region"), (3, 4, "comment"), (5, 14, "region")),
        *((8, 13, "region"), (10, 12, ""), (15, 18, "region"), (19, 20, "region")),
    ]
    assert folded(MILLED) == whole
    assert folded(MILLED.replace("\n", "\r\n")) == whole
    assert folded(MILLED, most=2) == whole[:2]


def test_structures_of_a_high_level_language_fold() -> None:
    program = "IF R1==1\nX1\nELSE\nX2\nX3\nENDIF\nREPEAT\nX4\nUNTIL R1==2\nFOR R2=1 TO 5\nX5\nENDFOR\nM30\n"
    found = [one[:2] for one in folded(program, "siemens-transmit")]
    assert found == [(1, 13), (1, 2), (3, 6), (7, 9), (10, 12)]


# ---- colors ----


def colors_of(made: Document, data: list[int] | None = None) -> list[tuple[int, str, str]]:
    """Line, characters and kind of each token, with its modifiers behind."""
    numbers = token_colors.full(made) if data is None else data
    lines = made.text.text.replace("\r\n", "\n").replace("\r", "\n").split("\n")
    line = character = 0
    found = []
    for after, relative, length, kind, modifiers in zip(*(numbers[at::5] for at in range(5)), strict=True):
        line, character = line + after, relative if after else character + relative
        encoded = lines[line].encode("utf-16-le")
        characters = encoded[2 * character : 2 * (character + length)].decode("utf-16-le")
        assert length > 0
        assert len(characters.encode("utf-16-le")) == 2 * length
        names = [name for bit, name in enumerate(MODIFIERS) if modifiers >> bit & 1]
        found.append((line + 1, characters, " ".join([KINDS[kind], *names])))
    return found


@looped("end", ["\n", "\r\n", "\r"])
def test_each_word_has_the_color_of_what_it_is(end: str) -> None:
    text = "O1 (\U0001f600)\nN10 G1 X-6.5 ,C2 M8\n/T0101 S500\n#100=SIN[#_UOFST]\nIF[#1EQ2]GOTO10\nG65 P#3\n"
    found = colors_of(document(text.replace("\n", end)))
    assert found == [
        *((1, "O1", "namespace declaration"), (1, "(\U0001f600)", "comment")),
        *((2, "N10", "label declaration"), (2, "G1", "function"), (2, "X", "property"), (2, "-6.5", "number")),
        *((2, ",C", "property"), (2, "2", "number"), (2, "M8", "method")),
        *((3, "/", "keyword skipped"), (3, "T", "enumMember skipped"), (3, "0101", "number skipped")),
        *((3, "S", "parameter skipped"), (3, "500", "number skipped")),
        *((4, "#100", "variable"), (4, "=", "operator"), (4, "SIN", "keyword"), (4, "#_UOFST", "variable readonly")),
        *((5, "IF", "keyword"), (5, "#1", "variable"), (5, "EQ", "operator"), (5, "2", "number")),
        *((5, "GOTO", "keyword"), (5, "10", "number"), (6, "G65", "function"), (6, "P", "property")),
        (6, "#3", "variable"),
    ]


@looped(
    ("machine", "text", "expected"),
    [
        (
            "siemens-transmit",
            'A1: R1=R2 G1 X=R1 R5 ;C\nGOTOF ENDE\nMSG("A;B")\n',
            "A property,1 number,R1 variable,= operator,R2 variable,G1 function,X property,= operator,R1 variable,"
            'R property,5 number,;C comment,GOTOF keyword,ENDE label,MSG namespace,"A;B" string',
        ),
        (
            "okuma-osp",
            "NLAP1 VC1=DIA+1\nIF [VC1 EQ 1] NLAP1\nCALL O12 Q3\n",
            "VC1 variable,= operator,DIA variable,+ operator,1 number,IF keyword,VC1 variable,EQ operator,1 number,"
            "NLAP1 label,CALL keyword,O12 namespace,Q property,3 number",
        ),
    ],
)
def test_colors_are_those_of_the_language(machine: str, text: str, expected: str) -> None:
    found = [f"{characters} {kind}" for _, characters, kind in colors_of(document(text, machine))]
    assert ",".join(one for one in found if "declaration" not in one) == expected


def test_colors_of_lines_and_differences_are_those_of_the_whole() -> None:
    before = document(MILLED)
    whole = colors_of(before)
    shown = token_colors.within(before, types.Range(types.Position(7, 3), types.Position(9, 1)))
    assert colors_of(before, shown) == [one for one in whole if 8 <= one[0] <= 10]
    after = document(MILLED.replace("G1 X5.", "G1 X5. C2."))
    old, new = token_colors.full(before), token_colors.full(after)
    (edit,) = token_colors.difference(old, new)
    assert [*old[: edit.start], *(edit.data or []), *old[edit.start + edit.delete_count :]] == new
    assert len(edit.data or []) <= 15
    assert token_colors.difference(old, old) == []
    assert token_colors.difference([], new)[0].data == new


@pytest.mark.nightly
@settings(max_examples=60, deadline=None)
@given(st.text(st.sampled_from("%ON0123456789GXT#[]=()/;.\n\r\"':RIFGOTDW \U0001f600\u2013"), max_size=80), st.data())
def test_no_text_is_too_strange(text: str, data: Any) -> None:
    made = document(text, data.draw(st.sampled_from(["fanuc", "siemens-transmit", "okuma-osp", "citizen"])))
    numbers = token_colors.full(made)
    assert all(length > 0 for length in numbers[2::5])
    lines_of(symbols.symbols(made))
    folding.folding_ranges(made)


# ---- with an editor ----


def test_the_structure_needs_neither_check_nor_good_settings() -> None:
    Path("polarcheck.toml").write_text("machin = 1\n", "utf-8")
    with Editor() as editor:
        program = editor.open("O1.NC", MILLED)
        of_document = {"textDocument": {"uri": program}}
        outline = editor.ask("textDocument/documentSymbol", of_document)
        assert [one["name"] for one in outline] == ["O0001", "O0002"]
        assert len(editor.ask("textDocument/foldingRange", of_document)) == 7
        whole = editor.ask("textDocument/semanticTokens/full", of_document)
        editor.change(program, 2, "G", (7, 0, 0))
        changed = editor.ask(
            "textDocument/semanticTokens/full/delta", {**of_document, "previousResultId": whole["resultId"]}
        )
        assert len(changed["edits"]) == 1
        seen = {"start": place(1, 0), "end": place(2, 0)}
        assert len(editor.ask("textDocument/semanticTokens/range", {**of_document, "range": seen})["data"]) % 5 == 0
        again = editor.ask("textDocument/semanticTokens/full/delta", {**of_document, "previousResultId": "0"})
        assert again["data"]
        assert editor.capabilities["semanticTokensProvider"]["full"] == {"delta": True}
        assert editor.capabilities["semanticTokensProvider"]["range"] is True
