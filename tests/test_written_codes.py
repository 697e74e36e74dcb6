"""Codes of a machine file as people write them, and lists that only say what differs from the inherited one."""

from __future__ import annotations

import re
import tomllib
from pathlib import Path
from typing import Any

import msgspec
import pytest
from cases import looped
from polarcheck.errors import MachineError
from programs import report_of, said

from polarcheck.program.machines import code_keys, profiles, written_codes
from polarcheck.program.machines.code_lists import FRAME_LISTS
from polarcheck.program.machines.machine import Machine

ALLOWED = profiles.load("fanuc-30i").machine.polar.allowed_codes


@pytest.fixture(autouse=True)
def _in_an_empty_folder(own_folder: None) -> None:
    pass


def load(text: str, name: str = "own.toml") -> profiles.Profile:
    Path(name).write_text(text, "utf-8")
    return profiles.load(name)


# ---- the form of a code ----


@looped(
    ("text", "plain"),
    [
        ("G98", "G98"), ("g98", "G98"), ("G098", "G98"), ("G00", "G0"), ("M08", "M8"), ("m035", "M35"),
        (" M 35 ", "M35"), ("M35\n", "M35\n"),
        ("g12.1", "G12.1"), ("G12.10", "G12.1"), ("G1.0", "G1"), ("g54-g59", "G54-G59"), ("G054 - G059", "G54-G59"),
        ("m3p12", "M3 P12"), ("M03 P012", "M3 P12"), ("M3  p12.", "M3 P12"), ("M3 P1.5", "M3 P1.5"),
        ("M3 Q-1", "M3 Q-1"),
        ("g10.9 x0", "G10.9 X0"), ("x", "X"), ("", ""), ("GO", "GO"), ("TRANSMIT", "TRANSMIT"), ("G", "G"),
        ("\u0661", "\u0661"), ("G12,1", "G12,1"), ("G1 G2", "G1 G2"),
    ],
)  # fmt: skip
def test_a_code_has_one_plain_form(text: str, plain: str) -> None:
    assert written_codes.plain(text) == plain


@looped(
    ("written", "key", "value"),
    [
        ("[m_codes]\nc_axis_on = ['m035']", "m_codes.c_axis_on", ["M35"]),
        ("[m_codes]\nprogram_end = ['M02', 'm030']", "m_codes.program_end", ["M2", "M30"]),
        ("[g_code_system_a]\nfeed_per_minute = ['g098']", "g_code_system_a.feed_per_minute", ["G98"]),
        ("[macro]\nsubprogram_calls = ['M098']", "macro.subprogram_calls", ["M98"]),
        ("[control]\nmotion_codes = { g101 = 'g01' }", "control.motion_codes", {"G101": "G1"}),
        ("[polar]\nvirtual_axis = 'y'", "polar.virtual_axis", "Y"),
        ("[polar]\nwords_beside_switch = ['x', 'g098']", "polar.words_beside_switch", ["X", "G98"]),
        ("[control]\naxes = ['x', 'z', 'c']", "control.axes", ["X", "Z", "C"]),
        ("[arcs]\nradius_word = 'l'", "arcs.radius_word", "L"),
        ("[g_codes]\nwork_offset = ['g54-g59']", "g_codes.work_offset", ["G54-G59"]),
        ("[control]\nx_radius_words = ['g10.9 x0', 'DIAMOF']", "control.x_radius_words", ["G10.9 X0", "DIAMOF"]),
    ],
)
def test_codes_may_be_written_as_in_a_program(written: str, key: str, value: Any) -> None:
    found = load(f"inherits = 'fanuc-30i'\n{written}\n").written
    group, _, name = key.partition(".")
    assert getattr(getattr(found, group), name) == value


def test_a_code_with_leading_zeros_ends_the_program() -> None:
    """It was passed over in silence: only the text of the list was compared with M2."""
    program = "%\nO1\nG98 G0 X60. C0\nG12.1\nG1 X40. F200\nC10.\nX60.\nG13.1\nM2\n%\n"
    for end, missing in (("M02", []), ("m2", []), ("M30", [(9, "program-end-missing")])):
        machine = load(f"inherits = 'fanuc-30i'\n[m_codes]\nprogram_end = ['{end}']\n").machine
        assert said(report_of(program, machine, only=["program-end-missing"])) == missing, end


# ---- lists that differ ----


@looped(
    ("changes", "expected"),
    [
        (["+G93", "-G4"], [*(code for code in ALLOWED if code != "G4"), "G93"]),
        (["+g093"], [*ALLOWED, "G93"]),
        (["+G1"], ALLOWED),
        (["-G80"], ALLOWED),
        (["-G40-G42"], [code for code in ALLOWED if code not in ("G40", "G41", "G42")]),
        (["+ G0", "- G1"], [*(code for code in ALLOWED if code != "G1"), "G0"]),
        (["+G93", "-G93"], ALLOWED),
        ([], []),
    ],
)
def test_a_list_may_say_what_differs(changes: list[str], expected: list[str]) -> None:
    assert load(f"inherits = 'fanuc-30i'\n[polar]\nallowed_codes = {changes}\n").machine.polar.allowed_codes == expected
    over = profiles.load("fanuc-30i", {"polar": {"allowed_codes": changes}}).machine
    assert over.polar.allowed_codes == expected


def test_what_differs_is_put_into_the_nearest_list() -> None:
    load("inherits = 'fanuc-30i'\n[polar]\nallowed_codes = ['+G93', '-G4']\n", "shop.toml")
    own = load("inherits = 'shop.toml'\n[polar]\nallowed_codes = ['-G93', '+G80']\n").machine
    assert own.polar.allowed_codes == [*(code for code in ALLOWED if code != "G4"), "G80"]


def test_a_code_is_taken_out_of_a_range() -> None:
    own = load("inherits = 'fanuc'\n[g_codes]\nwork_offset = ['-G57']\n[control]\nknown_codes = ['-G2', '-G0']\n")
    assert own.machine.g_codes.work_offset == ["G54-G56", "G58-G59"]
    assert own.machine.control.known_codes[:2] == ["G1", "G3-G13"]
    assert said(report_of("G98 G0 X1.\nG57\n", own.machine, only=["unknown-code"])) == []


@looped(
    ("key", "before", "after"),
    [
        ("[m_codes]\nspindle_on = ['+M203']", "M203", ["main-spindle-running-at-entry"]),
        ("[m_codes]\nspindle_on = ['-M3']", "M3", []),
        ("[m_codes]\nspindle_on = ['+M3 P11', '-M3']", "M3", []),
        ("[m_codes]\nspindle_on = ['+M3 P11', '-M3']", "M3 P11", ["main-spindle-running-at-entry"]),
    ],
)
def test_lists_of_m_codes_likewise(key: str, before: str, after: list[str]) -> None:
    machine = load(f"inherits = 'fanuc-30i'\n{key}\n").machine
    program = f"G98 G0 X60. C0\n{before}\nG12.1\nG1 X40. F200\nC10.\nX60.\nG13.1\n"
    assert [rule for _, rule in said(report_of(program, machine, only=["setup"]))] == after


def test_a_lathe_that_allows_one_code_more() -> None:
    program = "G98 G0 X60. C0\nG12.1\nG1 X40. F200\n{}\nC10.\nX60.\nG13.1\n"
    more = load("inherits = 'fanuc-30i'\n[polar]\nallowed_codes = ['+G64']\n").machine
    less = load("inherits = 'fanuc-30i'\n[polar]\nallowed_codes = ['-G4']\n").machine
    asked = ["code-not-allowed-in-polar"]
    assert not report_of(program.format("G64"), more, only=asked).findings
    assert said(report_of(program.format("G64"), less, only=asked)) == [(4, "code-not-allowed-in-polar")]
    assert said(report_of(program.format("G4 P100"), less, only=asked)) == [(4, "code-not-allowed-in-polar")]
    assert not report_of(program.format("G4 P100"), more, only=asked).findings


@looped(
    ("values", "told"),
    [
        ("[polar]\nallowed_codes = ['+G0', 'G1']", "polar.allowed_codes: 'G1' beside '+G0': write + or - before each"),
        ("[polar]\nallowed_codes = ['G1', '-G0']", "polar.allowed_codes: 'G1' beside '-G0': write + or - before each"),
        ("[polar]\nallowed_codes = ['+G0', 3]", "polar.allowed_codes: 3 beside '+G0': write + or - before each"),
        ("[polar]\nallowed_codes = ['+GO']", "polar.allowed_codes: 'GO' is no code"),
        ("[polar]\nallowed_codes = ['-GO']", "polar.allowed_codes: '-GO': 'GO' is no code"),
        ("[polar]\nallowed_codes = ['+']", "polar.allowed_codes: '' is no code"),
        ("[polar]\nallowed_codes = ['++G0']", "polar.allowed_codes: '+G0' is no code"),
        ("[polar]\non = ['-G12.1', '-G112']", "polar.on: expected a list of codes, at least one, found []"),
    ],
)
def test_what_means_nothing_is_one_line(values: str, told: str) -> None:
    with pytest.raises(MachineError) as caught:
        load(f"inherits = 'fanuc-30i'\n{values}\n")
    assert str(caught.value).startswith(f"own.toml: {told}")
    assert "\n" not in str(caught.value)


@looped(
    ("changes", "inherited", "idle"),
    [
        (["+G1", "+G93"], ["G1"], ["+G1"]),
        (["-G80", "-G1"], ["G1"], ["-G80"]),
        (["-G56"], ["G54-G59"], []),
        (["+G56"], ["G54-G59"], ["+G56"]),
        (["+G0"], None, []),
        (["-G0"], None, ["-G0"]),
        (["G0"], ["G0"], []),
        ("G0", ["G0"], []),
    ],
)
def test_changes_that_change_nothing_are_known(changes: Any, inherited: Any, idle: list[str]) -> None:
    assert written_codes.without_effect(changes, inherited) == idle


@looped("path", sorted(profiles.FOLDER.glob("*.toml")), ids=lambda path: path.stem)
def test_our_own_files_hold_the_plain_form(path: Path) -> None:
    """They are taken as they are: every run of a check reads them."""
    tables = tomllib.loads(path.read_text("utf-8"))
    for table, values in tables.items():
        for key, said_of_it in values.items() if isinstance(values, dict) else ():
            value = said_of_it["value"] if isinstance(said_of_it, dict) and "value" in said_of_it else said_of_it
            if isinstance(value, list) and any(map(written_codes.is_change, value)):
                value = [change[1:] for change in value]
            assert written_codes.taken(f"{table}.{key}", value, None) == value, f"{table}.{key}"


#: Lists of texts that hold no codes.
_OF_ADDRESSES = {
    "arcs.corner_words",
    "control.axes",
    "polar.not_simulated_beside",
    "polar.virtual_axis_of_other_controls",
    # Blocks, as they are written.
    *("writing.before", "writing.behind", "writing.behind_end"),
    *("writing.program_head", "writing.program_end", "writing.archive_heads"),
}


def test_every_list_of_texts_is_one_of_codes_or_of_addresses() -> None:
    tables = [table for table in msgspec.structs.fields(Machine) if hasattr(table.type, "__struct_fields__")]
    found = {
        f"{table.name}.{key.name}"
        for table in tables
        for key in msgspec.structs.fields(table.type)
        if re.match(r"(typing\.Annotated\[)?list\[(typing\.Annotated\[)?str", str(key.type))
    }
    assert found - code_keys.EVERY == _OF_ADDRESSES


#: What a control's own language writes as words, and axis words with a code.
_OTHER_WORDS = {f"g_codes.{key}" for key in FRAME_LISTS} | {f"control.{key}" for key in code_keys.TYPED["control"]}


@pytest.mark.ci
@looped("key", sorted(code_keys.EVERY - _OTHER_WORDS), one_in=3)
def test_what_is_no_code_is_refused_in_one_line(key: str) -> None:
    table, _, name = key.partition(".")
    with pytest.raises(MachineError) as raised:
        profiles.load("fanuc", {table: {name: ["G1.1.1"]}})
    assert f"{table}" in str(raised.value)
    assert "G1.1.1" in str(raised.value)
