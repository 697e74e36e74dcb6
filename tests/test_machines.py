"""Profiles are data: every value has its source and its use; what is wrong in a user's file is said in one line."""

from __future__ import annotations

import math
import re
from pathlib import Path
from typing import Any

import msgspec
import pytest
from cases import looped
from click.testing import CliRunner, Result
from polarcheck.errors import MachineError
from programs import report_of

from polarcheck.commands import main
from polarcheck.foundation import states as modal
from polarcheck.foundation.finding import ERROR
from polarcheck.program.machines import code_tables, profiles
from polarcheck.program.machines.machine import Machine, OwnMachine, meanings
from polarcheck.program.machines.parameters import Origin
from polarcheck.program.machines.renamed import RENAMED
from polarcheck.reports.pages import new_machine
from polarcheck.rules.rule import load_all

PACKAGE = Path(__file__).parent.parent / "polarcheck"
GROUPS = [field for field in msgspec.structs.fields(Machine) if isinstance(field.type, type)]
GROUPS = [field for field in GROUPS if issubclass(field.type, msgspec.Struct)]
#: Severities of rules that hang on a value of the profile.
HANGS_ON = {
    "polar.allowed_codes": (
        *("code-not-allowed-in-polar", "rapid-in-polar", "plane-selected-in-polar"),
        *("tool-length-offset-in-polar", "origin-shifted-in-polar"),
    ),
    "polar.plane_before": ("plane-wrong-at-entry",),
    "polar.virtual_axis": ("wrong-axis-address-in-polar",),
    "polar.virtual_axis_of_other_controls": ("wrong-axis-address-in-polar",),
    "polar.words_beside_switch": ("polar-switch-not-alone",),
    "polar.main_spindle_must_stop": ("main-spindle-running-at-entry",),
    "polar.center_words": ("arc-end-off-circle", "arc-word-of-other-plane", "arc-without-center"),
    "polar.x": ("diameter-radius-mixed",),
    "control.g_code_system": ("incremental-word-of-other-code-system",),
    "control.unknown_codes_are_errors": ("unknown-code",),
    "control.known_codes": ("unknown-code",),
    "feed.carried_into_polar": ("feed-lost-from-per-revolution",),
    "arcs.sweep_limit": ("arc-sweep-above-limit",),
    "compensation.nose_types": ("nose-type-not-zero",),
    "m_codes.live_tool_on": ("live-tool-stopped-in-cut",),
}
#: What a control permits, and not what the part or the lathe does: no error where an alarm in doubt alone tells of it.
PERMITTED = (
    *(
        "polar-switched-in-offset-mode",
        "modal-state-wrong-at-entry",
        "offset-changed-in-polar",
        "origin-shifted-in-polar",
    ),
    *("tool-length-offset-in-polar", "plane-selected-in-polar", "code-not-allowed-in-polar", "rapid-in-polar"),
    *("polar-entered-twice", "c-axis-not-referenced", "wrong-axis-address-in-polar"),
)
#: Controls whose own manual stands behind every rule.
OWN_RULES = ("fanuc", "fanuc-16i", "fanuc-30i")


@pytest.fixture(autouse=True)
def _in_an_empty_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)


def field_names(group: str) -> list[str]:
    return [key.name for field in GROUPS if field.name == group for key in msgspec.structs.fields(field.type)]


def load(text: str) -> profiles.Profile:
    Path("own.toml").write_text(text, "utf-8")
    return profiles.load("own.toml")


def machines(*arguments: str) -> Result:
    return CliRunner().invoke(main, ["machines", *arguments], prog_name="polarcheck")


def complaint(text: str) -> str:
    with pytest.raises(MachineError) as caught:
        load(text)
    message = str(caught.value)
    assert "\n" not in message
    return message


# ---- the built-in profiles ----


@looped("name", profiles.names())
def test_every_value_has_a_source(name: str) -> None:
    profile = profiles.load(name)
    without = [key for key, origin in profile.origins.items() if not origin.source and key not in ("title", "notes")]
    assert not without


@looped("name", profiles.names())
def test_every_value_that_is_known_is_in_the_profile(name: str) -> None:
    """What has no origin is a default of the program, which only says that nothing is known."""
    profile = profiles.load(name)
    table = msgspec.to_builtins(profile.machine)
    for field in GROUPS:
        for key, value in table[field.name].items():
            if f"{field.name}.{key}" not in profile.origins:
                assert value != value or not value, f"{field.name}.{key}"


@pytest.mark.parametrize("field", GROUPS, ids=lambda field: field.name)
def test_every_key_says_what_it_means_in_the_class_and_in_the_file(field: msgspec.structs.FieldInfo) -> None:
    if field.name in ("g_code_system_b", "g_code_system_c"):
        pytest.skip("said at system A")
    text = (PACKAGE / "program" / "machines" / "fanuc.toml").read_text("utf-8")
    table = text.partition(f"\n[{field.name}]\n")[2].partition("\n[")[0]
    said = meanings(field.type)
    assert list(said) == [key.name for key in msgspec.structs.fields(field.type)]
    for key, meaning in said.items():
        at_its_line = (f"# {meaning}\n{key} = ", f"# {key}: {meaning}\n", f"  # {meaning}\n")
        found = re.search(rf"(?:^#.*\n)?^(?:# )?{key}(?: =|:).*\n", table, re.MULTILINE)
        assert found
        assert any(text in found[0] for text in at_its_line), key


@looped("name", profiles.names())
def test_what_is_in_doubt_makes_no_error(name: str) -> None:
    profile = profiles.load(name)
    for key, origin in profile.origins.items():
        group, _, last = key.partition(".")
        if not origin.doubtful:
            continue
        if group == "severities":
            assert profile.machine.severities[last] != "error", key
        if origin.profile in OWN_RULES:
            continue
        if getattr(getattr(profile.machine, group, None), last, None):
            for rule in HANGS_ON.get(key, ()):
                assert not is_error_in_doubt(profile, rule), (key, rule)
        if group == "alarms" and last in PERMITTED:
            assert not is_error_in_doubt(profile, last), key


def is_error_in_doubt(profile: profiles.Profile, rule: str) -> bool:
    """The rule is an error there, and the profile does not say by what that is beyond doubt."""
    origin = profile.origins.get(f"severities.{rule}")
    if origin is not None:
        return profile.machine.severities[rule] == "error" and origin.doubtful
    return load_all()[rule].severity == ERROR


@pytest.mark.ci
@looped("name", profiles.names(), one_in=3)
def test_what_is_known_without_a_page_is_in_doubt_and_shown_so(name: str) -> None:
    profile = profiles.load(name)
    shown = machines(name).output
    for key, origin in profile.origins.items():
        if re.search("from knowledge|not at hand|not confirmed|as on other controls|follows from", origin.source):
            assert origin.doubtful or "M700V" in origin.source or "ISO Milling" in origin.source, key
            assert key in shown or key.partition(".")[2] in shown


@looped(
    "name",
    [
        *("gsk-988", "mitsubishi-m700", "haas-lathe", "okuma-osp", "mazak-eia", "citizen", "lsis"),
        *("siemens-iso", "siemens-transmit", "mazak-quick-turn", "mazak-integrex", "hurco", "fagor-8055t"),
    ],
)
def test_alarms_of_another_control_are_not_inherited(name: str) -> None:
    alarms = {key: origin.profile for key, origin in profiles.load(name).origins.items() if key.startswith("alarms.")}
    assert not {"fanuc", "fanuc-16i", "fanuc-30i"} & set(alarms.values()), alarms


@pytest.mark.one_in(12)
@pytest.mark.parametrize("name", profiles.names())
def test_parameters_set_what_there_is(name: str) -> None:
    """Every setting of every parameter gives a machine that can be loaded."""
    for parameter, meaning in profiles.load(name).machine.known_parameters.items():
        for setting in (*meaning.values, *(["B" if meaning.is_letter else 12] if meaning.key else [])):
            number = int(setting) if str(setting).isdecimal() else setting
            changed = profiles.load(name, {"parameters": {parameter: number}})
            for key in meaning.values.get(str(setting), {meaning.key: None} if meaning.key else {}):
                assert changed.origins[key].source.startswith(f"parameter {parameter} = ")


# ---- files of the user's own ----


def test_the_nearest_profile_counts() -> None:
    Path("shop.toml").write_text("inherits = 'fanuc-30i'\n[limits]\nc_feed = 3600\nkeep_out = 0.5\n", "utf-8")
    profile = load("inherits = 'shop.toml'\n[limits]\nc_feed = { value = 7200, source = 'plate' }\n")
    assert profile.chain == ("own.toml", "shop.toml", "fanuc-30i", "fanuc")
    assert (profile.machine.limits.c_feed, profile.machine.limits.keep_out) == (7200, 0.5)
    assert profile.origins["limits.c_feed"] == Origin("own.toml", "plate")
    assert profile.origins["limits.keep_out"].profile == "shop.toml"
    assert profiles.load("own.toml", {"limits": {"c_feed": 100}}).machine.limits.c_feed == 100


def test_a_table_can_say_the_source_of_its_values_once() -> None:
    own = load(
        "inherits = 'fanuc'\n[limits]\nsource = 'plate'\ndoubtful = true\nc_feed = 3600\n"
        "keep_out = { value = 1, source = 'guess' }\nx_maximum = { value = 90, doubtful = false }\n"
        "[alarms]\nsource = 'list'\nrapid-in-polar = 'A1'\n[parameters]\nsource = 'screen'\n3410 = 20\n"
    )
    assert own.origins["limits.c_feed"] == Origin("own.toml", "plate", True)
    assert own.origins["limits.keep_out"] == Origin("own.toml", "guess", True)
    assert own.origins["limits.x_maximum"] == Origin("own.toml", "plate", False)
    assert own.origins["alarms.rapid-in-polar"] == Origin("own.toml", "list")
    assert own.machine.alarms.get("source") is None
    assert own.machine.parameters == {"3410": 20}
    assert own.machine.arcs.tolerance == 0.02


def test_tables_of_another_control_can_be_left_behind() -> None:
    own = load("inherits = 'fanuc'\nreplaces = ['alarms', 'severities']\n[alarms]\nrapid-in-polar = 'A1'\n")
    assert own.machine.alarms == {"rapid-in-polar": "A1"}
    assert not own.machine.severities
    assert "alarms.unknown-code" not in own.origins


@pytest.mark.ci
@looped(
    ("text", "said"),
    [
        ("inherits = 'fanuk'", "own.toml: inherits: unknown machine 'fanuk'; did you mean fanuc?"),
        ("inherits = 'own.toml'", "own.toml: inherits from itself"),
        ("", 'own.toml: the file is empty; write inherits = "fanuc" or another machine'),
        ("# of the lathe by the door\n", "own.toml: the file is empty; write inherits"),
        ("title = 'lathe 7'", 'own.toml: control is missing; inherits = "fanuc" or another machine would give it'),
        ("inherits = 3", "own.toml: inherits: expected the name of a machine"),
        ("inherits = 'gone.toml'", "own.toml: inherits: machine gone.toml: no such file"),
        ("title = 'x'", "own.toml: control is missing"),
        ("inherits = 'fanuc'\n[limit]\nc_feed = 1", "own.toml: unknown table [limit]; did you mean limits?"),
        ("inherits = 'fanuc'\n[limits]\nc_fed = 1", "own.toml: unknown key limits.c_fed; did you mean c_feed?"),
        ("inherits = 'fanuc'\n[limits]\nc_feed = '1'", "own.toml: limits.c_feed: expected a number above 0, found '1'"),
        ("inherits = 'fanuc'\n[limits]\nc_feed = { v = 1 }", "own.toml: limits.c_feed: expected value, source and"),
        ("inherits = 'fanuc'\n[polar]\nx = 'radial'", "own.toml: polar.x: expected diameter or radius, found 'radial'"),
        ("inherits = 'fanuc'\n[polar]\ncenter_words = ['I']", "own.toml: polar.center_words: "),
        ("inherits = 'fanuc'\nreplaces = ['limits']", "own.toml: replaces: expected a list of alarms, alarm_"),
        ("inherits = 'fanuc'\nreplaces = 3", "own.toml: replaces: expected a list of"),
        ("inherits = 'fanuc'\nlimits = 3", "own.toml: limits: expected a table, found 3"),
        ("inherits = 'fanuc'\nparameters = 3", "own.toml: parameters: expected a table, found 3"),
        ("inherits = 'fanuc'\n[parameters]\n'5451#1' = 1", "own.toml: parameters: no meaning is known for 5451#1; did"),
        ("inherits = 'fanuc'\n[parameters]\n'5450#1' = 2", "own.toml: parameters.5450#1: expected 0 or 1, not 2"),
        ("inherits = 'fanuc'\n[parameters]\n1422 = 'much'", "own.toml: parameters.1422: expected a number, not much"),
        ("inherits = 'fanuc'\n[known_parameters]\n1 = 1\n[parameters]\n1 = 1", "own.toml: known_parameters.1: expect"),
        ("inherits = 'fanuc'\n[control]\nnative_words = { AB = 'G12.1' }", "own.toml: control: native_words: 'G12"),
        ("inherits = 'fanuc'\n[control]\nx_radius_words = ['RA']", "own.toml: control: native_words: 'G.1' has no"),
        (
            f"inherits = 'fanuc'\n[control]\nx_radius_words = {list('ABCDEFGHIJKLMNOPQRS')}",
            "own.toml: control: no more than 18",
        ),
        ("inherits = 'fanuc'\n[control]\nmotion_codes = { G101 = 'M3' }", "own.toml: control: motion_codes: G101 ="),
        ("inherits = 'fanuc'\n[g_codes]\nrapid = ['GO']", "own.toml: g_codes.rapid: 'GO' is no code"),
        ("inherits = 'fanuc'\n[g_codes]\nrapid = ['G0', 'G12.15']", "own.toml: g_codes.rapid: 'G12.15' is no code"),
        ("inherits = 'fanuc'\n[m_codes]\nlive_tool_on = ['33']", "own.toml: m_codes.live_tool_on: '33' is no code"),
        ("inherits = 'fanuc'\n[m_codes]\nprogram_end = ['M2-M3']", "own.toml: m_codes.program_end: 'M2-M3' is no code"),
        ("inherits = 'fanuc'\n[g_code_system_a]\nfeed_per_minute = ['G94']",
         "own.toml: g_code_system_a.feed_per_minute: G94 is in g_code_system_a.facing_cycle, too"),
        ("inherits = 'fanuc'\n[macro]\nmodal_macro_calls = ['G67']",
         "own.toml: macro.modal_macro_calls: G67 is in macro.modal_macro_cancel, too"),
        ("inherits = 'fanuc'\n[polar]\nallowed_codes = ['G1', 'ROT']", "own.toml: polar.allowed_codes: 'ROT' is no"),
        ("inherits = 'fanuc'\n[g_codes]\nline = ['G0']", "own.toml: g_codes.line: G0 is in g_codes.rapid, too"),
        ("inherits = 'fanuc'\n[g_codes]\nrapid = ['G0', 'G33']\n[control]\ng_code_system = 'B'",
         "own.toml: g_codes.rapid: G33 is in g_code_system_b.thread_cutting, too"),
        ("inherits = ", "own.toml: "),
    ],
)  # fmt: skip
def test_what_is_wrong_is_said_in_one_line(text: str, said: str) -> None:
    assert complaint(text).startswith(said)


@pytest.mark.ci
@looped(
    ("values", "said"),
    [
        ("[limits]\nc_feed = -3", "limits.c_feed: expected a number above 0, found -3"),
        ("[limits]\nc_feed = '3600,5'", "limits.c_feed: expected a number above 0, found '3600,5'; write 3600.5, with"),
        ("[limits]\nc_feed = inf", "limits.c_feed: expected a number above 0, found inf"),
        ("[limits]\nx_minimum = -inf", "limits.x_minimum: expected a number, found -inf"),
        ("[limits]\nkeep_out = -1", "limits.keep_out: expected a number of 0 or more, found -1"),
        ("[limits]\noverride_share = nan", "limits.override_share: expected a number above 0, found nan"),
        ("[limits]\nx_maximum = -20", "limits.x_maximum: expected a number above 0, found -20"),
        ("[limits]\nx_maximum = 0", "limits.x_maximum: expected a number above 0, found 0"),
        ("[limits]\nx_minimum = 50\nx_maximum = 20", "limits: x_minimum is 50, above x_maximum, 20"),
        ("[feed]\ncutting_minimum = 9\ncutting_maximum = 8", "feed: cutting_minimum is 9, above cutting_maximum, 8"),
        ("[parameters]\n1422 = -5", "parameters.1422: limits.c_feed: expected a number above 0, found -5"),
        ("[parameters]\n1422 = nan", "parameters.1422: limits.c_feed: expected a number above 0, found nan"),
        ("[parameters]\n'5450#2' = \"\\n\"", "parameters.5450#2: expected 0 or 1, not '\\n'"),
        ("[parameters]\n5461 = 1", "parameters.5461: polar: linear_axis and rotary_axis are both 1; expected two axes"),
        ("[parameters]\n5460 = 4\n5461 = 4", "parameters.5460 and parameters.5461: polar: linear_axis and rotary_"),
        ("[parameters]\n5461 = 0", "parameters.5461: polar.rotary_axis: expected the number of an axis from 1 to 24"),
        ("[polar]\nrotary_axis = 1", "polar: linear_axis and rotary_axis are both 1; expected two axes"),
        ("[alarm_codes]\nPS0146 = ['G12,1']", "alarm_codes.PS0146: 'G12,1' is neither a code nor a list of codes"),
        ("[alarm_codes]\nPS0146 = ['cycles']", "alarm_codes.PS0146: 'cycles' is neither a code nor a list of codes"),
        ("c_feed = 1", "unknown key c_feed; did you mean limits.c_feed?"),
        ("inherit = 'fanuc'", "unknown key inherit; did you mean inherits?"),
        ("machine = 'fanuc'", "unknown key machine; it belongs to the job, polarcheck.toml"),
        ("[tools.8]\nradius = 4", "unknown table [tools]; it belongs to the job, polarcheck.toml"),
        ("[parameters]\n3401#0 = 1", "Expected '=' after a key in a key/value pair at column 5; write"),
        ("'5460' = 2", "unknown key 5460; it is a parameter of the control: write it under [parameters]"),
        ("[polar]\n5460 = 2", "unknown key polar.5460; it is a parameter of the control: write it under [parameters]"),
        ("[limits]\n'3401#0' = 1", "unknown key limits.3401#0; it is a parameter of the control: write it under [par"),
        ("[m_codes]\nc_axis_on = ['M35']\nc_axis_off = ['m035']", "m_codes.c_axis_on: M35 is in m_codes.c_axis_off"),
        ("[m_codes]\nspindle_on = ['+M5']", "m_codes.spindle_on: M5 is in m_codes.spindle_off, too"),
        ("[m_codes]\nlive_tool_on = ['M3 P12']\nlive_tool_off = ['M3P12']", "m_codes.live_tool_on: M3 P12 is in m_co"),
        ("[polar]\nc_feed = 1", "unknown key polar.c_feed; did you mean limits.c_feed?"),
        ("[polar]\non = []", "polar.on: expected a list of codes, at least one, found []"),
        ("[polar]\nvirtual_axis = 'G'", "polar.virtual_axis: expected an address, one letter or the name of"),
        ("[polar]\nvirtual_axis = 'x'", "polar.virtual_axis is X, which is the linear axis"),
        ("[polar]\nvirtual_axis = 'Y'\nlinear_address = 'Y'", "polar.virtual_axis is Y, which is the linear axis"),
        ("[control]\nnamed_axes = { C1 = 'Q' }", "control.named_axes.C1: expected the address of an axis, one letter"),
        ("[control]\nchannel_mark = 'A'", "control.channel_mark: expected one character that stands in no word"),
        ("[control]\nwait_mark = '('", "control.wait_mark: expected one character that stands in no word"),
        ("[control]\nchannel_mark = '$'\nwait_mark = '$'", "control: channel_mark and wait_mark are both $"),
        ("[limits]\nc_feed = { value = 1, doubtful = 'no' }", "limits.c_feed.doubtful: expected true or false, fo"),
        ("[limits]\ndoubtful = 1", "limits.doubtful: expected true or false, found 1"),
        ("[parameters]\n1430 = '2'", "parameters.1430: expected a number, not '2'"),
        ("[polar]\nvirtual_axis = 'Y-1'", "polar.virtual_axis: expected an address, one letter or the name of"),
        ("[polar]\ncenter_words = ['I']", "polar.center_words: expected a table, found ['I']"),
        ("[compensation]\nread_ahead = -3", "compensation.read_ahead: expected a whole number of 2 or more, found -3"),
        ("[compensation]\nnose_types = [12]", "compensation.nose_types: expected a whole number from 0 to 9, found 12"),
        ("[control]\noffset_digits = 0", "control.offset_digits: expected a whole number from 1 to 4, found 0"),
        ("[control]\nunknown_codes_are_errors = 'no'", "control.unknown_codes_are_errors: expected true or false, fo"),
        ("[arcs]\nsweep_limit = 400", "arcs.sweep_limit: expected a number above 0, 360 at most, found 400"),
        ("[macro]\ngiven = { 0 = 1 }", "macro.given.0: expected the number of a variable, 100 for #100, found 0"),
        ("[macro]\nlocal_variables = [[33, 1]]", "macro: local_variables: the range 33 to 1 ends before it begins"),
    ], one_in=2,
)  # fmt: skip
def test_values_that_make_no_sense_are_refused(values: str, said: str) -> None:
    said_of_text = "own.toml:3: " if said.startswith("Expected") else "own.toml: "
    assert complaint(f"inherits = 'fanuc'\n{values}\n").startswith(f"{said_of_text}{said}")


@looped(
    "values",
    [
        "[limits]\nx_minimum = -50\nz_minimum = -400\nz_maximum = -5",
        "[limits]\nkeep_out = 0",
        "[parameters]\n5460 = 2\n5461 = 4",
        "[macro]\ngiven = { 100 = -5 }",
        "[compensation]\ntangent_tolerance = 0",
    ],
)
def test_values_that_make_sense_are_taken(values: str) -> None:
    load(f"inherits = 'fanuc'\n{values}\n")


@looped(
    ("base", "said"),
    [
        ("", 'base.toml: the file is empty; write inherits = "fanuc" or another machine; shop.toml inherits from it'),
        (
            "title = 'x'\n",
            'base.toml: limits.c_feed_harmless is missing; inherits = "fanuc" or another machine would give it',
        ),
        ("inherits = 'own.toml'\n", "own.toml: inherits from itself, by way of shop.toml, base.toml"),
    ],
)
def test_a_fault_of_a_file_that_others_inherit_is_told_of_that_file(base: str, said: str) -> None:
    Path("base.toml").write_text(base, "utf-8")
    Path("shop.toml").write_text("inherits = 'base.toml'\n[limits]\nc_feed = 3600\n", "utf-8")
    assert complaint("inherits = 'shop.toml'\n") == said


def test_a_profile_can_say_that_it_does_not_know() -> None:
    Path("shop.toml").write_text("inherits = 'fanuc'\n[limits]\nc_feed = 3600\nx_maximum = 90\n", "utf-8")
    own = load("inherits = 'shop.toml'\n[limits]\nc_feed = { value = nan, source = 'other motor' }\n")
    assert math.isnan(own.machine.limits.c_feed)
    assert own.machine.limits.x_maximum == 90
    assert own.origins["limits.c_feed"] == Origin("own.toml", "other motor")
    with pytest.raises(MachineError, match=r"^--set: limits\.c_feed: expected a number above 0, found nan$"):
        profiles.load("own.toml", [("--set", {"limits": {"c_feed": math.nan}})])


@looped(
    ("name", "said"),
    [
        ("haas", "did you mean haas-lathe?"),
        ("FANUC-30i", "did you mean fanuc-30i?"),
        ("Siemens", "did you mean siemens-iso or siemens-transmit?"),
        ("30i", "did you mean fanuc-30i?"),
        ("mazac-eia", "did you mean mazak-eia?"),
    ],
)
def test_a_machine_is_suggested_by_a_part_of_its_name(name: str, said: str) -> None:
    with pytest.raises(MachineError, match=re.escape(f"unknown machine {name!r}; {said}")):
        profiles.load(name)


@looped("table", ["alarms", "severities"])
@looped(
    ("rule", "said"),
    [("rapid_in_polar", "; did you mean rapid-in-polar?"), ("nope", "; `polarcheck rules` lists them")],
)
def test_a_rule_that_there_is_not_is_refused(table: str, rule: str, said: str) -> None:
    Path("own.toml").write_text(f"inherits = 'fanuc'\n[{table}]\n{rule} = 'off'\n", "utf-8")
    Path("lathe.toml").write_text("inherits = 'own.toml'\n", "utf-8")
    found = machines("lathe.toml")
    assert (found.exit_code, found.stdout) == (2, "")
    assert found.stderr == f"polarcheck: own.toml:3: {table}.{rule}: unknown rule {rule!r}{said}\n"


@looped(("old", "new"), RENAMED.items())
def test_an_old_name_is_told_the_new_one(old: str, new: str) -> None:
    group, _, key = old.partition(".")
    assert complaint(f"inherits = 'fanuc'\n[{group}]\n{key or 'x'} = 1") == f"own.toml: {old} is now {new}"
    group, _, key = new.partition(".")
    assert group in Machine.__struct_fields__
    assert not key or key in field_names(group)


def test_old_names_are_told_wherever_they_stand(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(RENAMED, "limits.c_rate", "limits.c_feed")
    told = "limits.c_rate is now limits.c_feed"
    with pytest.raises(MachineError, match=f"^the command line or job: {told}$"):
        profiles.load("fanuc", {"limits": {"c_rate": 1}})
    meaning = "[known_parameters]\n1 = { value = { title = '', key = 'limits.c_rate' } }\n[parameters]\n1 = 2"
    assert complaint(f"inherits = 'fanuc'\n{meaning}") == f"own.toml: {told}"
    assert complaint("inherits = 'fanuc'\nreplaces = ['meanings']") == "own.toml: meanings is now known_parameters"


@pytest.mark.ci
@looped("name", profiles.names(), one_in=2)
@looped("system", "ABC")
def test_built_in_lists_hold_codes(name: str, system: str) -> None:
    profiles.load(name, {"control": {"g_code_system": system}})  # changes are checked, and what they are made to


# ---- control parameters ----


@looped(
    ("name", "parameters", "values"),
    [
        ("fanuc-16i", {"1422": 3600}, {"limits.c_feed": 3600}),
        ("fanuc-30i", {"1430": 7200}, {"limits.c_feed": 7200}),
        ("fanuc", {"3401#0": 1}, {"control.number_without_point": "whole-unit"}),
        ("fanuc", {"3401#6": 1, "3401#7": 0}, {"control.g_code_system": "B"}),
        ("fanuc", {"3401#7": 1}, {"control.g_code_system": "C"}),
        ("fanuc", {"3410": 20}, {"arcs.tolerance": 0.02}),
        ("fanuc", {"5003#1": 1, "5003#0": 1}, {"compensation.start_up": "C", "compensation.start_up_with_move": "B"}),
        ("fanuc", {"19625": 6}, {"compensation.read_ahead": 6}),
        ("fanuc", {"5450#1": 1, "5462": 2000}, {"limits.automatic_override": True, "limits.polar_feed": 2000}),
        ("fanuc", {"5463": 0}, {"limits.override_share": 90}),
        ("fanuc", {"1056": 70}, {"limits.override_share": 70}),
        ("fanuc", {"5450#0": 1}, {"polar.virtual_axis_programming": "diameter"}),
        ("gsk-988", {"5450#6": 1, "5460": 2, "5461": 4}, {"polar.x": "radius", "polar.linear_axis": 2}),
        ("gsk-988", {"5450#1": 1, "5462": 500}, {"limits.polar_feed_clamps": True, "limits.polar_feed": 500}),
        ("gsk-988", {"5450#1": 1, "5462": 500}, {"limits.automatic_override": False}),
        ("gsk-988", {"5450#1": 0, "5462": 500}, {"limits.polar_feed_clamps": False, "limits.polar_feed": 500}),
        ("mitsubishi-m700", {"1517": 0}, {"polar.virtual_axis": "Y", "polar.virtual_axis_incremental": "V"}),
        ("mitsubishi-m700", {"1517": 0}, {"polar.virtual_axis_of_other_controls": ["C", "H"]}),
        ("mitsubishi-m700", {"1517": 1, "1516": "C"}, {"polar.virtual_axis": "C"}),
        ("mitsubishi-m700", {"8111": 0, "1019": 1}, {"polar.x": "radius", "control.x": "diameter"}),
        ("mitsubishi-m700", {"8111": 1, "1019": 1}, {"polar.x": "diameter", "control.x": "diameter"}),
        ("mitsubishi-m700", {"1533": "Y"}, {"polar.linear_address": "Y"}),
        ("mitsubishi-m700", {"1533": "Z"}, {"polar.linear_address": "Z"}),
        ("haas-lathe", {"162": "off"}, {"control.number_without_point": "least-increment"}),
    ],
)  # fmt: skip
def test_a_parameter_sets_what_it_stands_for(name: str, parameters: dict[str, Any], values: dict[str, Any]) -> None:
    profile = profiles.load(name, {"parameters": parameters})
    for key, value in values.items():
        group, _, last = key.partition(".")
        assert getattr(getattr(profile.machine, group), last) == value


_NO_ROTARY = "own.toml: parameters.1516: polar.rotary_address: expected A, B, C or H, or the name of an axis as C2"


@looped(
    ("given", "said"),
    [
        ("z", f"{_NO_ROTARY}, found 'Z'"),
        ("F", f"{_NO_ROTARY}, found 'F'"),
        (5, "own.toml: parameters.1516: expected a letter from A to Z, not 5"),
        ("AB", "own.toml: parameters.1516: expected a letter from A to Z, not AB"),
    ],
)
def test_a_name_that_no_rotary_axis_has_is_one_clear_line(given: str | int, said: str) -> None:
    with pytest.raises(MachineError) as error:
        load(f"inherits = 'mitsubishi-m700'\n[parameters]\n1516 = {given!r}\n")
    assert str(error.value) == said
    assert load("inherits = 'mitsubishi-m700'\n[parameters]\n1516 = 'c'\n").machine.polar.virtual_axis == "C"


def test_a_value_beside_a_parameter_counts() -> None:
    own = "inherits = 'fanuc'\n[parameters]\n1422 = 3600\n[limits]\nc_feed = 100\n"
    assert load(own).machine.limits.c_feed == 100
    assert profiles.load("own.toml", {"parameters": {"1422": 50}}).machine.limits.c_feed == 50


# ---- a file for a lathe of one's own ----


@pytest.mark.one_in(12)
@pytest.mark.parametrize("name", profiles.names())
def test_a_new_profile_can_be_read_empty_and_filled_in(name: str) -> None:
    text = new_machine.text("NL2000", name)
    of_parent = profiles.load(name).machine
    of_new = load(text).machine
    assert isinstance(of_new, OwnMachine)
    values = {field: getattr(of_new, field) for field in Machine.__struct_fields__}
    assert repr(Machine(**{**values, "title": of_parent.title})) == repr(of_parent)
    filled = load(re.sub(r"^#(?=[\w\"])", "", text, flags=re.MULTILINE))
    assert filled.machine.limits.c_feed == 3600
    assert filled.machine.title == "NL2000"
    assert max(map(len, text.splitlines())) < 200


@pytest.mark.one_in(3)
@pytest.mark.nightly
@pytest.mark.parametrize("name", ["fanuc-30i", "siemens-transmit", "okuma-osp"])
def test_each_answer_of_a_new_profile_can_be_taken_alone(name: str) -> None:
    lines = new_machine.text("NL2000", name).splitlines()
    answers = [index for index, line in enumerate(lines) if re.match(r"#[\w\"]", line)]
    of_rules = [index for index in answers if lines[index][1:].partition(" = ")[0] in load_all()]
    assert len(of_rules) >= 2 * len(load_all())
    for index in (*(index for index in answers if index not in of_rules), *of_rules[::17]):
        load("\n".join([*lines[:index], lines[index][1:], *lines[index + 1 :]]))


@pytest.mark.ci
@looped(
    "answer",
    [
        *(
            "#c_feed = 3600 ",
            '#c_axis_on = ["M35"]  # the spindle',
            '#c_axis_clamp = ["M210"]',
            '#sub_c_axis_on = ["M135"]',
        ),
        *('#spindle_on = ["M3","M4"]', '#motion = "G0"', '#plane = "G18"', '#feed_mode = "G99"', '#virtual_axis = "C"'),
        *('#allowed_codes = ["+G93","-G80"]', '#known_codes = ["+G150"]', '#rapid-in-polar = "PS0146"', "#axes = []"),
        *('#rapid-in-polar = "error"', '#"1430" = 3600 ', "#main_spindle_must_stop = false", '#units = "mm"'),
    ],
    one_in=2,
)
def test_a_new_profile_asks_what_a_shop_has_to_say(answer: str) -> None:
    text = new_machine.text("NL2000", "fanuc-30i")
    assert f"\n{answer}" in text
    assert 'live_tool_on = ["M3 P12"]' in text
    assert "[tools.8]" in text


def test_a_profile_of_ones_own_checks() -> None:
    profile = load("inherits = 'fanuc-16i'\n[parameters]\n1422 = 3600\n")
    program = "G98 G0 X60. C0\nG12.1\nG1 X4. C5. F100\nC-5. F500\nG13.1\n"
    findings = report_of(program, profile.machine).findings
    assert [(finding.rule, finding.severity) for finding in findings] == [("c-feed-above-limit", "error")]


def test_machines_new_writes_the_file() -> None:
    found = machines("new", "NL2000", "--from", "fanuc-30i")
    assert (found.exit_code, found.stdout.partition(";")[0]) == (0, "NL2000.toml written")
    assert "polarcheck machines check NL2000.toml" in found.stdout
    assert profiles.load("NL2000.toml").chain == ("NL2000.toml", "fanuc-30i", "fanuc")
    assert machines("fanuc", "NL2000").exit_code == 2


@looped(
    ("arguments", "told"),
    [
        (["NL2000"], "NL2000.toml is there already"),
        (["NL2000.toml"], "NL2000.toml is there already"),
        (["NL2001", "--from", "gone"], "unknown machine 'gone'; `polarcheck machines` lists them"),
    ],
)
def test_a_new_profile_replaces_no_file(arguments: list[str], told: str) -> None:
    Path("NL2000.toml").write_text("own", "utf-8")
    found = machines("new", *arguments)
    assert (found.exit_code, found.stdout, found.stderr) == (2, "", f"polarcheck: {told}\n")
    assert [path.name for path in Path().iterdir()] == ["NL2000.toml"]
    assert Path("NL2000.toml").read_text("utf-8") == "own"


# ---- G codes by what they do ----


@looped(
    ("system", "expected"),
    [
        ("A", {"G90": ("motion", 9), "G20": ("units", 20), "G98": ("feed_mode", 94), "G99": ("feed_mode", 95)}),
        ("B", {"G90": ("distance", 90), "G77": ("motion", 9), "G94": ("feed_mode", 94), "G98": ("", 0)}),
        ("C", {"G20": ("motion", 9), "G70": ("units", 20), "G71": ("units", 21), "G91": ("distance", 91)}),
    ],
)
def test_the_profile_lists_the_modal_groups(system: str, expected: dict[str, tuple[str, int]]) -> None:
    of_all = {
        "G0": ("motion", 0), "G3": ("motion", 3), "G2.2": ("motion", 9), "G18": ("plane", 18), "G40": ("side", 40),
        "G42": ("side", 42), "G93": ("feed_mode", 93), "G96": ("speed", 96), "G97": ("speed", 0),
        "G57": ("work_offset", 57), "G54.1": ("work_offset", 54), "G83.5": ("drilling", 83), "G80": ("drilling", 0),
        "G51": ("scaling", 51), "G68.1": ("rotation", 68), "G51.1": ("mirror", 51), "G69": ("mirror", 0),
        "G66.1": ("modal_call", 66), "G4": ("", 0),
    }  # fmt: skip
    machine = profiles.load("fanuc", {"control": {"g_code_system": system}}).machine
    names, group_of, state_of = code_tables.modal_tables(machine)
    for word, (group, state) in (of_all | expected).items():
        number = code_tables.code(word)
        assert (group_of[number], state_of[number]) == (names.index(group) + 1 if group else 0, state), word


@looped(("system", "setting"), [("A", "G50"), ("B", "G92"), ("C", "G92")])
def test_the_profile_lists_the_codes_whose_axis_words_are_no_move(system: str, setting: str) -> None:
    machine = profiles.load("fanuc", {"control": {"g_code_system": system}}).machine
    found = code_tables.code_set(code for key in modal.NO_MOVE for code in machine.codes(key))
    for word in ("G4", "G10", "G28", "G30", "G52", "G53", "G65", "G66.1", "G107", "G73", setting):
        assert found[code_tables.code(word)], word
    for word in ("G0", "G1", "G2", "G40", "G41", "G54", "G98", "G99", "G12.1"):
        assert not found[code_tables.code(word)], word
    assert machine.codes("coordinate_setting") == [setting]


def test_a_machine_without_feed_per_minute_is_told_in_words() -> None:
    """No list of codes is so important that an empty one may break a message."""
    program = "O1\nG99 G0 X60. C0\nG12.1\nG1 X40. F0.2\nC5.\nG13.1\nM30\n"
    changes = {"g_code_system_a": {"feed_per_minute": []}}
    told = [found.message for found in report_of(program, "fanuc", changes=changes, only=["feed"]).findings]
    assert any("feed per minute" in message for message in told)


def test_a_profile_is_parsed_once_and_anew_when_it_has_changed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "lathe.toml"
    path.write_text("[limits]\nc_feed = 36\n")
    read = profiles._built_in.__wrapped__
    monkeypatch.setattr("sys.dont_write_bytecode", True)
    assert read(path) == {"limits": {"c_feed": 36}}
    assert [*tmp_path.iterdir()] == [path]
    monkeypatch.setattr("sys.dont_write_bytecode", False)
    assert read(path) == {"limits": {"c_feed": 36}}
    (kept,) = tmp_path.rglob("*.kept")
    assert [*kept.parent.iterdir()] == [kept]
    with monkeypatch.context() as patch:
        patch.setattr("tomllib.loads", lambda text: pytest.fail("parsed again"))
        assert read(path) == {"limits": {"c_feed": 36}}
    path.write_text("[limits]\nc_feed = 37\n")
    assert read(path) == {"limits": {"c_feed": 37}}
    kept.write_bytes(kept.read_bytes()[:-3])
    assert read(path) == {"limits": {"c_feed": 37}}
