"""What is in force when a program begins and selects nothing: as the lathe powers on, where its profile says so."""

from __future__ import annotations

from typing import Any

import pytest
from cases import looped
from polarcheck.errors import MachineError
from programs import report_of, said, trace_of

from polarcheck.foundation.states import Motion
from polarcheck.program.machines import profiles

WHOLE = "O1\nG98 X60. C0 F200\nG12.1\nX40.\nC10.\nX60.\nG13.1\nM30\n"


def power_on(**values: str) -> dict[str, Any]:
    return {"power_on": values}


@looped(
    ("code", "motion", "rules"),
    [
        ("", Motion.NONE, []),
        ("G1", Motion.LINE, []),
        ("G0", Motion.RAPID, [(4, "rapid-in-polar")]),
        ("g00", Motion.RAPID, [(4, "rapid-in-polar")]),
    ],
)
def test_the_first_words_move_as_the_lathe_powers_on(code: str, motion: Motion, rules: list[tuple[int, str]]) -> None:
    assert trace_of(WHOLE, changes=power_on(motion=code)).modal.state("motion")[0] == motion
    found = report_of(WHOLE, changes=power_on(motion=code), only=["rapid-in-polar", "code-not-allowed-in-polar"])
    assert said(found) == rules


def test_what_the_program_selects_counts() -> None:
    trace = trace_of(WHOLE.replace("G98", "G98 G1"), changes=power_on(motion="G0", plane="G18"))
    assert trace.modal.state("motion").tolist() == [Motion.RAPID] + [Motion.LINE] * 7
    assert trace.modal.state("plane").tolist() == [18] * 8
    selected = WHOLE.replace("G98", "G17 G98")
    assert trace_of(selected, changes=power_on(plane="G18")).modal.state("plane").tolist() == [18] + [17] * 7


def test_each_program_of_a_file_begins_so() -> None:
    trace = trace_of(WHOLE.replace("G98", "G17 G98") + WHOLE.replace("O1", "O2"), changes=power_on(plane="G18"))
    assert trace.modal.state("plane")[trace.blocks.starts].tolist() == [18, 18]
    assert trace.modal.state("plane")[-1] == 18


@looped(
    ("plane", "program", "rules"),
    [
        ("", WHOLE, []),
        ("G17", WHOLE, []),
        ("G18", WHOLE, [(3, "plane-wrong-at-entry")]),
        ("G18", WHOLE.replace("G12.1", "G17\nG12.1"), []),
        ("G18", WHOLE.removeprefix("O1\n"), []),
    ],
)
def test_the_plane_of_a_whole_program(plane: str, program: str, rules: list[tuple[int, str]]) -> None:
    changes = {**power_on(plane=plane), "polar": {"plane_before": ["G17"]}}
    assert said(report_of(program, changes=changes, only=["plane-wrong-at-entry"])) == rules


@pytest.mark.nightly
@looped(("code", "rule"), [("", "feed-mode-unknown"), ("G98", None), ("G99", "feed-per-revolution-in-polar")])
def test_what_f_means_is_known_where_the_lathe_says_it(code: str, rule: str | None) -> None:
    program = "O1\nG0 X60. C0\nG12.1\nG1 X40. F200\nC10.\nX60.\nG13.1\nM30\n"
    found = report_of(
        program, changes=power_on(feed_mode=code), only=["feed-mode-unknown", "feed-per-revolution-in-polar"]
    )
    assert [name for _, name in said(found)] == ([rule] if rule else [])
    excerpt = report_of(program.removeprefix("O1\n").removesuffix("M30\n"), changes=power_on(feed_mode=code))
    assert "feed-per-revolution-in-polar" not in [name for _, name in said(excerpt)]


def test_distances_or_coordinates() -> None:
    changes = {"control": {"g_code_system": "B"}, **power_on(distance="G91")}
    assert trace_of(WHOLE.replace("G98", "G94"), changes=changes).modal.incremental[0]


@looped(
    ("key", "code", "told"),
    [
        ("plane", "G98", "power_on.plane: G98 selects no plane; codes are G17, G18, G19"),
        ("feed_mode", "G1", "power_on.feed_mode: G1 selects no feed_mode; codes are G93, G98, G99"),
        ("distance", "G91", "power_on.distance: G91 selects no distance; codes are none"),
        ("motion", "M3", "power_on.motion: expected a G code, or none, found 'M3'"),
        ("motion", "G0 X1", "power_on.motion: expected a G code, or none, found 'G0 X1'"),
    ],
)
def test_a_code_of_another_group_is_one_line(key: str, code: str, told: str) -> None:
    with pytest.raises(MachineError) as caught:
        profiles.load("fanuc", {"power_on": {key: code}})
    assert str(caught.value) == f"the command line or job: {told}"
