"""What an editor shows of one word, and offers for the next one: on machines of several languages."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from cases import looped
from lsp_editor import Editor, place
from lsprotocol import types

from polarcheck.commands import server as command
from polarcheck.editor import actions
from polarcheck.editor.analysis import Analysis, judge
from polarcheck.editor.hover_text import hover
from polarcheck.editor.open_text import OpenText
from polarcheck.editor.structure.document import Document
from polarcheck.editor.words.completions import completions
from polarcheck.program.machines import profiles

pytestmark = [pytest.mark.ci, pytest.mark.usefixtures("own_folder")]


def at_mark(text: str) -> tuple[str, types.Position]:
    """A text, and the place of the | in it."""
    before, after = text.split("|")
    return before + after, types.Position(before.count("\n"), len(before.rpartition("\n")[2]))


def judged_of(text: str, **asked: Any) -> Analysis:
    return judge(OpenText(text), Path("O1.NC").absolute(), command._Settings(True, asked), [])


def shown(text: str, **asked: Any) -> str:
    """The hover at the mark."""
    written, position = at_mark(text)
    asked.setdefault("select", ["rapid-in-polar"])
    found = hover(judged_of(written, **asked), position, False)
    if found is None:
        return ""
    assert isinstance(found.contents, types.MarkupContent)
    return found.contents.value


HEAD = "O1\nG21 G98 G0 X60. C0 T0101\n"
FANUC = {"machine": "fanuc-30i", "tools": ["1:radius=4"]}


@looped(
    ("text", "first", "others"),
    [
        (
            "O1\nG21 G98 |G0 X60. C0\n",
            "G0: rapid traverse\n",
            ["source: G code lists of B-62754EN/01", "modal: group of motion"],
        ),
        (
            HEAD + "G12.1\nG1 X40. F200\n|G41 X30.\nG13.1\n",
            "G41: cutter compensation, tool to the left",
            ["in the polar mode: allowed", "in force: G1 G41 G21 G98"],
        ),
        (HEAD + "G1|2.1\nG1 X40. F200\n", "G12.1: polar coordinate interpolation on\n", ["B-62764EN/01 p. 51"]),
        (HEAD + "G0 G0|03 X1.\n", "G3: circular interpolation, counterclockwise\n", ["before it G0"]),
        (HEAD + "M|30\n", "M30: end of program", []),
        (HEAD + "M|77\n", "M77\n", ["not in the profile", "[m_codes] of a machine file"]),
        (HEAD + "G|999\n", "", []),
        (HEAD + "G12.1\nG1 X4|0. F200\n", "X: X axis, a diameter (coordinate)\n", ["position behind it: X 40 mm"]),
        (HEAD + "G12.1\nG1 C1|0. F200\n", "C: virtual axis, a length as a radius and no angle", []),
        (HEAD + "G12.1\nG1 H1|0. F200\n", "H: virtual axis, a length as a radius and no angle (distance)", []),
        (HEAD + "C9|0.\n", "C: rotary axis [deg]\n", []),
        (HEAD + "H9|0.\n", "H: rotary axis [deg], incremental\n", []),
        (HEAD + "Z1|5\n", "", []),
        (HEAD + "G0 W|1.\n", "W: Z axis (distance)\n", []),
        (HEAD + "G12.1\nG1 X40. |F200\n", "F: feed per minute along the path in the plane of X and C [mm/min]", []),
        (HEAD + "G99 G1 Z1. |F.2\n", "F: feed per revolution [mm/rev]", []),
        ("O1\nG20 G98 G1 X1. |F8.\n", "F: feed per minute [inch/min]", []),
        (HEAD + "|T0101\n", "T: tool and tool offset", ["tool offset: 1, R 4 mm (command line)"]),
        (HEAD + "G97 |S1000\n", "S: spindle speed [1/min]", []),
        (HEAD + "G96 |S200\n", "S: surface speed, since G96 is in force", []),
        (HEAD + "|N10 M30\n", "N: sequence number", []),
        ("|O1\nG0 X1.\n", "O: program number", []),
        (HEAD + "G12.1\nG2 X40. C0 |R5. F100\n", "R: radius of an arc", []),
        (HEAD + "G12.1\nG2 X40. C0 |I5. J0 F100\n", "I: center of an arc", []),
        (HEAD + "G4 |P500\n", "P: time of the dwell\n", []),
        (HEAD + "G4 |X2.\n", "X: time of the dwell\n", []),
        (HEAD + "G71 |U2. R.5\n", "U: a number for G71, which says what it means", []),
        (HEAD + "G32 Z-5. |F1.5\n", "F: lead of the thread\n", []),
        (HEAD + "G76 X50. Z-20. P1200 Q300 |F1.5\n", "F: lead of the thread\n", []),
        (HEAD + "G43 |H1\n", "H: number of the tool offset\n", []),
        (HEAD + "G83 X5. |R2. Q1.\n", "R: a number for G83", []),
        (HEAD + "G83 |X5. R2. Q1.\n", "X: X axis, a diameter", []),
        (HEAD + "G65 P2 |A1. F3.\nM30\nO2\nM99\n", "A: argument of the macro, #1 there", []),
        (HEAD + "G65 P2 A1. |F3.\nM30\nO2\nM99\n", "F: argument of the macro, #9 there", []),
        (HEAD + "G65 P2 |I1.\nM30\nO2\nM99\n", "I: argument of the macro\n", []),
        (HEAD + "M98 |P2\nM30\nO2\nM99\n", "P: number of the program that is called", []),
        (HEAD + "M98 P2\nM30\nO2\nM99 |P10\n", "P: number of the block of the caller", []),
        (HEAD + "G5|0 S2500\n", "G50: sets the coordinates of the present position or, with S alone", []),
        (HEAD + "M|0\n", "M0: program stop; the control does not read ahead", []),
        (HEAD + "G0 ,|C5.\n", "", []),
    ],
    one_in=5,
)
def test_a_word_shows_what_it_means_here(text: str, first: str, others: list[str]) -> None:
    found = shown(text, **FANUC)
    assert found.startswith(first)
    assert all(other in found for other in others)


@looped("text", ["(G1 |X5.)\n", "O1 (G|0)\n", "%|\n", HEAD + "\n|\n"])
def test_where_there_is_no_word_none_is_shown(text: str) -> None:
    assert ": " not in shown(text, **FANUC).partition("\n")[0]


@looped(
    ("text", "facts"),
    [
        ("O1\n|#101=2.5\nG0 X#101\nM30\n", ["common variable", "2.5, set here"]),
        ("O1\n#101=2.5\nG0 X|#101\nM30\n", ["value at its first run: 2.5, set in line 2"]),
        ("O1\n#101=2.5\n#102=|#101*2\nM30\n", ["value at its first run: 2.5, set in line 2"]),
        ("O1\n#101=2.5\n#102=#101*2\n#101=7\nG0 X|#102\nM30\n", ["value at its first run: 5, set in line 3"]),
        ("O1\nG65 P2 A3.\nG0 X|#1\nM30\nO2\nG0 X#1\nM99\n", ["local variable"]),
        ("O1\nG65 P2 A3.\nM30\nO2\nG0 X|#1\nM99\n", ["local variable", "first run: 3, set in line 2"]),
        ("O1\n#1=#5221\nG0 X|#1\nM30\n", ["first run: not known, set in line 2"]),
        ("O1\n#1=#0\nG0 X5. C|#1\nM30\n", ["first run: vacant, set in line 2"]),
        ("O1\n#100=|#2001\nM30\n", ["system variable: tool offset"]),
        ("O1\n|#3000=1(WRONG)\nM30\n", ["ends the program with an alarm"]),
        ("O1\n#1=|#0\nM30\n", ["always vacant"]),
        (
            "O1\n#101=2\nWHILE[|#101GT0]DO1\n#101=#101-1\nEND1\nM30\n",
            ["behind the first run of line 2: 2, set in line 2"],
        ),
        ("O1\n#101=2\nG0 X5.\nIF[|#101GT0]GOTO5\nN5 M30\n", ["behind the first run of line 3: 2, set in line 2"]),
        ("O1\n#101=30\nGOTO|#101\nN30 M30\n", ["behind the first run of line 2: 30"]),
    ],
)
def test_a_variable_shows_what_it_holds(text: str, facts: list[str]) -> None:
    found = shown(text, machine="fanuc-30i")
    assert found.startswith("#")
    assert all(fact in found for fact in facts), found


def test_a_code_that_counts_for_its_block_is_not_in_force() -> None:
    assert "G50" not in shown(HEAD + "G50 S2500\nG0 X|50.\nM30\n", **FANUC)


def test_a_value_of_a_caller_is_no_value_of_the_macro() -> None:
    assert "first run" not in shown("O1\n#1=5.\nG65 P2 B3.\nM30\nO2\nG0 X|#1\nM99\n", machine="fanuc-30i")


def test_a_word_of_the_own_language_of_a_control_is_explained() -> None:
    found = shown("G94 G0 X60 C0\nTRANS|MIT\nG1 X40 F200\nTRAFOOF\n", machine="siemens-transmit")
    assert found.startswith("TRANSMIT (G12.1): polar coordinate interpolation on\n")
    assert shown("R|1=5\nG0 X=R1\nM30\n", machine="siemens-transmit").startswith("R")


def test_beside_a_finding_the_page_comes_first_and_the_word_below() -> None:
    found = shown(HEAD + "G12.1\nG1 X40. F200\n|G0 C5.\nG13.1\n", **FANUC)
    assert found.startswith("rapid-in-polar (polar, error")
    assert "G0: rapid traverse\n" in found
    assert "not among the codes that may be used" in found


def test_without_a_result_nothing_is_said_of_a_machine_that_may_be_another() -> None:
    Path("polarcheck.toml").write_text("machin = 1\n", "utf-8")
    here = Path().absolute()
    judged = judge(OpenText(HEAD), here / "O1.NC", command._Settings(False, {}), [here])
    assert hover(judged, types.Position(1, 1), False) is None


# ---- completion ----


def offered(text: str, machine: str = "fanuc-30i", folder: str = "", **asked: Any) -> dict[str, str]:
    """The labels with their details, in the order of the editor."""
    written, position = at_mark(text)
    document = Document(
        "file:///w/O1.NC",
        Path("O1.NC"),
        OpenText(written),
        profiles.load(machine).machine,
        [folder] if folder else [],
    )
    settings = judged_of("", machine=machine, **asked).settings
    found = completions(document, settings, position)
    return {item.label: item.detail or "" for item in sorted(found.items, key=lambda item: str(item.sort_text))}


def test_codes_of_this_control_are_offered_with_their_meaning() -> None:
    found = offered("O1\nG96 S100\nG|\n")
    assert list(found)[:2] == ["G12.1", "G112"]
    assert found["G12.1"] == "polar coordinate interpolation on"
    assert found["G41"].startswith("cutter compensation, tool to the left")
    assert "G137" not in found
    assert "G137" in offered("G1|\n", "okuma-osp")
    assert "G7.1" in offered("G7|\n")
    assert "G68.4" not in offered("G|\n")
    assert "G68.4" in offered("G68|\n")
    assert "M30" in offered("G0 X1. M|\n")
    assert "M77" not in offered("M|\n")
    assert offered("TRAN|\n", "siemens-transmit")["TRANSMIT"] == "polar coordinate interpolation on"


@looped(
    "text",
    ["(G|)\n", "G0 (T|\n", "G0 X|\n", "N1|\n", "G1 X1. F|\n", "|\n", "G0 |\n", "O1 (GOTO |\n", "SELECTG|\n"],
    one_in=3,
)
def test_elsewhere_nothing_is_offered(text: str) -> None:
    assert offered(text) == {}
    assert offered("; G|\n", "siemens-iso") == {}


def test_tools_are_offered_with_their_radius() -> None:
    found = offered("T0808(MILL 8)\nG0 X1.\nT|\n", tools=["8:radius=4", "12:radius=2.5"])
    assert found == {
        "T0808": "R 4 mm (command line), MILL 8",
        "T1212": "R 2.5 mm (command line)",
        "T": "",
    } or found == {
        "T0808": "R 4 mm (command line), MILL 8",
        "T1212": "R 2.5 mm (command line)",
    }
    assert "T303" in offered("T303 (BORE)\nT3|\n")


JUMPS = "O1\nN10 G0 X1.\nN20 M98 P2\n{}\nM30\nO2\nN30 G0 X5. (BACK)\nM99\n"


@pytest.mark.parametrize(
    ("block", "expected"),
    [
        ("GOTO|", {"10": "N10 G0 X1.", "20": "N20 M98 P2"}),
        ("GOTO 2|", {"20": "N20 M98 P2"}),
        ("IF[#1EQ1]GOTO1|", {"10": "N10 G0 X1."}),
        ("G71 P1|", {"10": "N10 G0 X1."}),
        ("G71 P10 Q|", {"10": "N10 G0 X1.", "20": "N20 M98 P2"}),
        ("M98 P|", {"2": "", "77": "O0077.NC", "78": "78.nc"}),
        ("G65 A1. P7|", {"77": "O0077.NC", "78": "78.nc"}),
        ("M99 P|", {"30": "N30 G0 X5."}),
    ],
)
def test_targets_are_offered_with_their_blocks(block: str, expected: dict[str, str]) -> None:
    Path("sub").mkdir()
    for name in ("O0077.NC", "78.nc", "notes.txt"):
        Path("sub", name).write_text("", "utf-8")
    assert offered(JUMPS.format(block), folder="sub") == expected


def test_labels_are_offered_by_their_names() -> None:
    found = offered("ANF:\nG0 X60\nN20 G1 X5\nENDE: M17\nGOTOF |\n", "siemens-transmit")
    assert list(found) == ["ANF", "ENDE", "N20"]


def test_variables_of_the_program_and_of_the_settings_are_offered() -> None:
    found = offered("#101=5.\n#103=#101*2\nG0 X#|\n")
    assert list(found)[:2] == ["#101", "#103"]
    assert found["#101"] == "#101=5.: common variable, vacant at power-on"
    assert found["#3000"] == "system variable: ends the program with an alarm"
    assert list(offered("R1=5\nR12=R1\nG0 X=R1|\n", "siemens-transmit")) == ["R1", "R12"]


@looped(
    ("program", "line", "title", "block"),
    [
        ("G98 G0 X60. C0\nG12.1\nG1 X40. F200\nC8,660\nX60. C0\nG13.1\nM30\n", 3, "Write a decimal point", "C8.660"),
        ("G98 G0 X60. C0\nG12.1\nG1 X40. F200\nG0 C5.\nG13.1\nM30\n", 3, "Write G1, with the F in force", "G1 C5."),
        ("G98 G0 X60. C0\nG12.1\nX50.\nG1 X40. F200\nG13.1\nM30\n", 2, "Write G1 with F200", "G1 X50. F200"),
        ("G98 G0 X60. C0\nG12.1 M8\nG1 X40. F200\nX60.\nG13.1\nM30\n", 1, "Write G12.1 in a block of its own", "G12.1"),
    ],
)
def test_an_editor_offers_the_fixes_of_the_command_line(program: str, line: int, title: str, block: str) -> None:
    judged = judged_of(program, machine="fanuc-30i")
    selected = types.Range(types.Position(line, 0), types.Position(line, 20))
    offered_here = actions.actions(judged, "file:///w/O1.NC", 1, selected, False)
    (edit,) = (one.edit for one in offered_here if one.title.partition(" (moves")[0] == title)
    assert edit is not None
    assert edit.changes is not None
    text = judged.text
    for change in sorted(edit.changes["file:///w/O1.NC"], key=lambda one: -text.offset(one.range.start)):
        text = text.changed([types.TextDocumentContentChangePartial(change.range, change.new_text)])
    assert text.text.split("\n")[line] == block


def test_an_editor_gets_words_and_their_lists() -> None:
    with Editor("--machine", "fanuc-30i", "--tool", "8:radius=4") as editor:
        program = editor.open("O1.NC", "O1\nG0 X60.\nM30\n")
        editor.marks(program)
        assert {"#", "G", "T"} <= set(editor.capabilities["completionProvider"]["triggerCharacters"])
        assert editor.asks("hover", program, 1, 1)["contents"]["value"].startswith("G0: rapid traverse\n")
        assert editor.asks("hover", program, 1, 1)["range"] == {"start": place(1, 0), "end": place(1, 2)}
        editor.change(program, 2, "T\nM30", (2, 0, 3))
        (item,) = (one for one in editor.asks("completion", program, 2, 1)["items"] if one["label"] == "T0808")
        assert item["textEdit"] == {"newText": "T0808", "range": {"start": place(2, 0), "end": place(2, 1)}}
        assert item["detail"] == "R 4 mm (command line)"
        assert editor.ask("completionItem/resolve", item)["label"] == "T0808"
