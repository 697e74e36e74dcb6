"""The call hierarchy of programs over files, and the hints at the ends of blocks."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from cases import looped
from lsp_editor import Editor, place
from lsprotocol import types
from test_cli import COMPENSATED
from test_editor_features import judged_of
from test_editor_names import MAIN, files

from polarcheck.editor import inlay_hints
from polarcheck.editor.structure import call_tree

pytestmark = [pytest.mark.ci, pytest.mark.usefixtures("own_folder")]


# ---- calls ----


def test_calls_are_followed_both_ways() -> None:
    made, workspace = files(MAIN, A="O0100\nM98 P2\nM98 P50002\nM30\n", O9="(NO HEAD)\nM98 P1\nM99\n")
    (second,) = call_tree.prepare(made, types.Position(3, 5), workspace)
    assert (second.name, second.detail, second.range.start.line) == ("O0002", "O1.NC", 11)
    calls = call_tree.incoming(made, second.data, workspace)
    assert [(one.from_.name, [span.start.line for span in one.from_ranges]) for one in calls] == [
        ("O0001", [3, 7]),
        ("O0100", [1, 2]),
    ]
    (first,) = call_tree.prepare(made, types.Position(2, 5), workspace)
    called = call_tree.outgoing(made, first.data, workspace)
    assert [(one.to.name, len(one.from_ranges)) for one in called] == [("O0002", 2), ("O0003", 1)]
    (caller,) = call_tree.incoming(made, first.data, workspace)
    assert caller.from_.name == "O9.NC"
    assert call_tree.incoming(made, ["", 999], workspace) == []


@looped(
    ("machine", "text", "names"),
    [
        ("siemens-transmit", '%_N_A_MPF\nSUB(1)\nCALL "SUB"\nM30\n%_N_SUB_SPF\nM17\n', [("SUB", 2)]),
        ("okuma-osp", "O1\nCALL O2 Q3\nCALL OFACE\nM2\nO2\nRTS\nOFACE\nRTS\n", [("O0002", 1), ("OFACE", 1)]),
        ("fanuc", "O1\nM98 P1\nM98 P77\nM30\n", [("O0001", 1)]),
    ],
)
def test_calls_are_those_of_the_language(machine: str, text: str, names: list[tuple[str, int]]) -> None:
    made, workspace = files(text, machine)
    (item,) = call_tree.prepare(made, types.Position(0, 0), workspace)
    found = call_tree.outgoing(made, item.data, workspace)
    assert [(one.to.name, len(one.from_ranges)) for one in found] == names


def test_an_editor_follows_calls_into_files_that_are_not_open() -> None:
    Path("A.NC").write_text("O0100\nM98 P2\nM30\n", "utf-8")
    Path("B.NC").write_text("O0200\nM98 P100\nM30\n", "utf-8")
    with Editor() as editor:
        program = editor.open("O1.NC", MAIN)
        (second,) = editor.asks("prepareCallHierarchy", program, 11, 1)
        calls = editor.ask("callHierarchy/incomingCalls", {"item": second})
        assert [one["from"]["name"] for one in calls] == ["O0001", "O0100"]
        (caller,) = editor.ask("callHierarchy/incomingCalls", {"item": calls[1]["from"]})
        assert caller["from"]["name"] == "O0200"
        (called,) = editor.ask("callHierarchy/outgoingCalls", {"item": caller["from"]})
        assert called["to"]["name"] == "O0100"
        elsewhere = {**second, "uri": "file:///etc/hostname"}
        assert editor.ask("callHierarchy/incomingCalls", {"item": elsewhere}) == []


# ---- hints ----

WHOLE = types.Range(types.Position(0, 0), types.Position(50, 0))


def hints(text: str, what: str, shown: types.Range = WHOLE, **asked: object) -> list[tuple[int, str, str]]:
    found = inlay_hints.inlay_hints(judged_of(text, **asked), shown, what)
    return [(one.position.line + 1, str(one.label), str(one.tooltip)) for one in found]


@pytest.mark.nightly
def test_hints_are_angle_or_highest_feed_of_blocks_in_the_mode() -> None:
    options = {"tools": ["1:radius=4"], "changes": ["limits.c_feed=3600"]}
    angles = hints(COMPENSATED, "c_angle", **options)
    feeds = hints(COMPENSATED, "highest_feed", **options)
    lines = [line for line, _, _ in angles]
    assert 5 in lines
    assert all(3 < line < COMPENSATED[: COMPENSATED.index("G13.1")].count("\n") + 1 for line in lines)
    assert all(re.fullmatch(r"C -?\d+\.\d\d\u00b0", label) for _, label, _ in angles)
    assert all(re.fullmatch(r"F [\d.]+ mm/min", label) for _, label, _ in feeds)
    assert hints(COMPENSATED, "c_angle", types.Range(types.Position(4, 0), types.Position(4, 3)), **options) == [
        one for one in angles if one[0] == 5
    ]
    assert hints(COMPENSATED, "off", **options) == []
    assert hints(COMPENSATED, "highest_feed") == []  # neither limit nor R is known


def test_a_block_of_several_runs_says_which_its_hint_is_of() -> None:
    program = "G98 G0 X60. C0\nG12.1\n#1=0\nWHILE[#1LT3]DO1\nG1 C[10.+#1*5.] F100\n#1=#1+1\nEND1\nG13.1\nM30\n"
    ((line, label, remark),) = hints(program, "c_angle")
    assert (line, label, remark) == (5, "C 18.43\u00b0", "C axis behind this block, the first of 3 runs")
    ((_, _, remark),) = hints(program, "highest_feed", changes=["limits.c_feed=3600"])
    assert remark == "highest F here, the lowest of 3 runs"


def test_the_editor_switches_hints() -> None:
    abilities = {"workspace": {"inlayHint": {"refreshSupport": True}, "configuration": True}}
    with Editor(capabilities=abilities) as editor:
        program = editor.open("O1.NC", COMPENSATED)
        whole = {"textDocument": {"uri": program}, "range": {"start": place(0, 0), "end": place(50, 0)}}
        assert editor.ask("textDocument/inlayHint", whole) == []
        editor.tell("workspace/didChangeConfiguration", {"settings": {"polarcheck": {"inlayHints": "c_angle"}}})
        editor.wait_for("workspace/inlayHint/refresh")
        assert editor.ask("textDocument/inlayHint", whole)[0]["label"].startswith("C ")
        for nothing in ({"polarcheck": {"inlayHints": "other"}}, None, {"polarcheck": 5}, []):
            editor.tell("workspace/didChangeConfiguration", {"settings": nothing})
        assert editor.ask("textDocument/inlayHint", whole) == []


def test_hints_can_be_chosen_at_the_start() -> None:
    editor = Editor()
    editor._initialize["initializationOptions"] = {"inlayHints": "c_angle"}
    with editor:
        program = editor.open("O1.NC", COMPENSATED)
        whole = {"textDocument": {"uri": program}, "range": {"start": place(0, 0), "end": place(50, 0)}}
        assert len(editor.ask("textDocument/inlayHint", whole)) == 3
