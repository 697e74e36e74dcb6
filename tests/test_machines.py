"""Profiles are data: every value has its source and its use; what is wrong in a user's file is said in one line."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import msgspec
import pytest
from click.testing import CliRunner, Result
from programs import report_of

from polarcheck.checking.finding import ERROR
from polarcheck.checking.rule import load_all
from polarcheck.commands import main
from polarcheck.errors import MachineError
from polarcheck.machines import profiles
from polarcheck.machines.machine import Machine
from polarcheck.machines.parameters import Origin
from polarcheck.reports.pages import controls, new_machine

PACKAGE = Path(__file__).parent.parent / "polarcheck"
GROUPS = [field for field in msgspec.structs.fields(Machine) if isinstance(field.type, type)]
GROUPS = [field for field in GROUPS if issubclass(field.type, msgspec.Struct)]
#: What shows profiles without using them.
SHOWN = ("machine.py", "manual.py", "schema.py", "new_machine.py", "controls.py")
#: Severities of rules that hang on a value of the profile.
HANGS_ON = {
    "polar.allowed_codes": "code-not-allowed-in-polar",
    "polar.plane_before": "plane-wrong-at-entry",
    "arcs.sweep_limit": "arc-sweep-above-limit",
}


@pytest.fixture(autouse=True)
def _in_an_empty_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)


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


@pytest.mark.parametrize("name", profiles.names())
def test_every_value_has_a_source(name: str) -> None:
    profile = profiles.load(name)
    without = [key for key, origin in profile.origins.items() if not origin.source and key not in ("title", "notes")]
    assert not without


@pytest.mark.parametrize("name", profiles.names())
def test_every_value_that_is_known_is_in_the_profile(name: str) -> None:
    """What has no origin is a default of the program, which only says that nothing is known."""
    profile = profiles.load(name)
    table = msgspec.to_builtins(profile.machine)
    for field in GROUPS:
        for key, value in table[field.name].items():
            if f"{field.name}.{key}" not in profile.origins:
                assert value != value or not value, f"{field.name}.{key}"


@pytest.mark.parametrize("field", GROUPS, ids=lambda field: field.name)
def test_every_key_is_used(field: msgspec.structs.FieldInfo) -> None:
    code = "".join(path.read_text("utf-8") for path in PACKAGE.rglob("*.py") if path.name not in SHOWN)
    code += Path(PACKAGE / "machines" / "profiles.py").read_text("utf-8").partition("class Profile")[2]
    unused = [key.name for key in msgspec.structs.fields(field.type) if not re.search(rf"\.{key.name}\b", code)]
    assert not unused


@pytest.mark.parametrize("name", profiles.names())
def test_what_is_in_doubt_makes_no_error(name: str) -> None:
    profile = profiles.load(name)
    rules = load_all()
    severities = profile.machine.severities
    for key, origin in profile.origins.items():
        group, _, rule = key.partition(".")
        if group == "severities" and origin.doubtful:
            assert severities[rule] != "error", key
        value = getattr(getattr(profile.machine, group, None), rule, None)
        if origin.doubtful and value and key in HANGS_ON and HANGS_ON[key] in rules:
            of_rule = "error" if rules[HANGS_ON[key]].severity == ERROR else "less"
            assert severities.get(HANGS_ON[key], of_rule) != "error", key


@pytest.mark.parametrize("name", profiles.names())
def test_alarms_of_another_control_are_not_inherited(name: str) -> None:
    profile = profiles.load(name)
    for key, origin in profile.origins.items():
        if key.startswith("alarms."):
            families = {"fanuc": ("fanuc", "fanuc-16i", "fanuc-30i", "turning-center", "doosan")}
            assert name in families.get(origin.profile, (origin.profile, *profiles.names()))
            assert origin.profile in profile.chain


@pytest.mark.parametrize("name", profiles.names())
def test_parameters_set_what_there_is(name: str) -> None:
    """Every setting of every parameter gives a machine that can be loaded."""
    for parameter, meaning in profiles.load(name).machine.meanings.items():
        for setting in (*meaning.values, *([12] if meaning.key else [])):
            number = int(setting) if str(setting).isdecimal() else setting
            changed = profiles.load(name, {"parameters": {parameter: number}})
            for key in meaning.values.get(str(setting), {meaning.key: None} if meaning.key else {}):
                assert changed.origins[key].source.startswith(f"parameter {parameter} = ")


def test_the_table_of_controls_is_up_to_date() -> None:
    """`python -m polarcheck.reports.pages.controls > docs/controls.md` writes it anew."""
    assert (PACKAGE.parent / "docs" / "controls.md").read_text("utf-8") == controls.text()


# ---- files of the user's own ----


def test_the_nearest_profile_counts() -> None:
    Path("shop.toml").write_text("inherits = 'fanuc-30i'\n[limits]\nc_feed = 3600\nkeep_out = 0.5\n", "utf-8")
    profile = load("inherits = 'shop.toml'\n[limits]\nc_feed = { value = 7200, source = 'plate' }\n")
    assert profile.chain == ("own.toml", "shop.toml", "fanuc-30i", "fanuc")
    assert (profile.machine.limits.c_feed, profile.machine.limits.keep_out) == (7200, 0.5)
    assert profile.origins["limits.c_feed"] == Origin("own.toml", "plate")
    assert profile.origins["limits.keep_out"].profile == "shop.toml"
    assert profiles.load("own.toml", {"limits": {"c_feed": 100}}).machine.limits.c_feed == 100


def test_tables_of_another_control_can_be_left_behind() -> None:
    own = load("inherits = 'fanuc'\nreplaces = ['alarms', 'severities']\n[alarms]\nrapid-in-polar = 'A1'\n")
    assert own.machine.alarms == {"rapid-in-polar": "A1"}
    assert not own.machine.severities
    assert "alarms.unknown-code" not in own.origins


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("inherits = 'fanuk'", "unknown machine 'fanuk'; did you mean fanuc?"),
        ("inherits = 'own.toml'", "own.toml: inherits from itself"),
        ("inherits = 3", "own.toml: inherits: expected the name of a machine"),
        ("inherits = 'gone.toml'", "machine gone.toml: no such file"),
        ("title = 'x'", "own.toml: "),
        ("inherits = 'fanuc'\n[limit]\nc_feed = 1", "own.toml: unknown table [limit]; did you mean limits?"),
        ("inherits = 'fanuc'\n[limits]\nc_fed = 1", "own.toml: unknown key limits.c_fed; did you mean c_feed?"),
        ("inherits = 'fanuc'\n[limits]\nc_feed = '1'", "own.toml: limits.c_feed: expected `float`, got `str`"),
        ("inherits = 'fanuc'\n[limits]\nc_feed = { v = 1 }", "own.toml: limits.c_feed: expected value, source and"),
        ("inherits = 'fanuc'\n[polar]\nx = 'radial'", "own.toml: polar.x: invalid enum value 'radial'"),
        ("inherits = 'fanuc'\n[polar]\ncenter_words = ['I']", "own.toml: polar.center_words: "),
        ("inherits = 'fanuc'\nreplaces = ['limits']", "own.toml: replaces: expected a list of alarms, meanings,"),
        ("inherits = 'fanuc'\nreplaces = 3", "own.toml: replaces: expected a list of"),
        ("inherits = 'fanuc'\nlimits = 3", "own.toml: limits: expected `object`, got `int`"),
        ("inherits = 'fanuc'\nparameters = 3", "own.toml: parameters: expected `object`, got `int`"),
        ("inherits = 'fanuc'\n[parameters]\n'5451#1' = 1", "own.toml: parameters: no meaning is known for 5451#1; did"),
        ("inherits = 'fanuc'\n[parameters]\n'5450#1' = 2", "own.toml: parameters.5450#1: expected 0 or 1, not 2"),
        ("inherits = 'fanuc'\n[parameters]\n1422 = 'much'", "own.toml: parameters.1422: expected a number, not much"),
        ("inherits = 'fanuc'\n[meanings]\n1 = 1\n[parameters]\n1 = 1", "own.toml: meanings: Expected `object`"),
        ("inherits = 'fanuc'\n[control]\nnative_words = { AB = 'G12.1' }", "own.toml: control: native_words: 'G12"),
        ("inherits = 'fanuc'\n[control]\nmotion_codes = { G101 = 'M3' }", "own.toml: control: motion_codes: G101 ="),
        ("inherits = ", "own.toml: "),
    ],
)  # fmt: skip
def test_what_is_wrong_is_said_in_one_line(text: str, said: str) -> None:
    assert complaint(text).startswith(said)


# ---- control parameters ----


@pytest.mark.parametrize(
    ("name", "parameters", "values"),
    [
        ("fanuc-16i", {"1422": 3600}, {"limits.c_feed": 3600}),
        ("fanuc-30i", {"1430": 7200}, {"limits.c_feed": 7200}),
        ("fanuc", {"3401#0": 1}, {"control.number_without_point": "whole-unit"}),
        ("fanuc", {"3401#6": 1, "3401#7": 0}, {"control.g_code_system": "B"}),
        ("fanuc", {"3401#7": 1}, {"control.g_code_system": "C"}),
        ("fanuc", {"3410": 20}, {"arcs.tolerance": 0.02}),
        ("fanuc", {"5003#1": 1, "5003#0": 1}, {"compensation.start_up": "C", "compensation.start_up_moving": "B"}),
        ("fanuc", {"19625": 6}, {"compensation.read_ahead": 6}),
        ("fanuc", {"5450#1": 1, "5462": 2000}, {"limits.automatic_override": True, "limits.polar_feed": 2000}),
        ("fanuc", {"5463": 0}, {"limits.override_share": 90}),
        ("fanuc", {"1056": 70}, {"limits.override_share": 70}),
        ("fanuc", {"5450#0": 1}, {"polar.virtual_axis_is": "diameter"}),
        ("gsk-988", {"5450#6": 1, "5460": 2, "5461": 4}, {"polar.x": "radius", "polar.linear_axis": 2}),
        ("gsk-988", {"5450#1": 1, "5462": 500}, {"limits.automatic_override": True, "limits.polar_feed": 500}),
        ("mitsubishi-m700", {"1517": 0}, {"polar.virtual_axis": "Y", "polar.other_virtual_axis": ["C", "H"]}),
        ("mitsubishi-m700", {"1517": 1, "1516": "C"}, {"polar.virtual_axis": "C"}),
        ("mitsubishi-m700", {"8111": 0, "1019": 1}, {"polar.x": "radius", "control.x": "diameter"}),
        ("mitsubishi-m700", {"8111": 1, "1019": 1}, {"polar.x": "diameter", "control.x": "diameter"}),
        ("mitsubishi-m700", {"1533": "Y"}, {"polar.center_words": ("J", "K")}),
        ("mitsubishi-m700", {"1533": "Z"}, {"polar.center_words": ("K", "I")}),
        ("haas-lathe", {"162": "off"}, {"control.number_without_point": "least-increment"}),
    ],
)  # fmt: skip
def test_a_parameter_sets_what_it_stands_for(name: str, parameters: dict[str, Any], values: dict[str, Any]) -> None:
    profile = profiles.load(name, {"parameters": parameters})
    for key, value in values.items():
        group, _, last = key.partition(".")
        assert getattr(getattr(profile.machine, group), last) == value


def test_a_value_beside_a_parameter_counts() -> None:
    own = "inherits = 'fanuc'\n[parameters]\n1422 = 3600\n[limits]\nc_feed = 100\n"
    assert load(own).machine.limits.c_feed == 100
    assert profiles.load("own.toml", {"parameters": {"1422": 50}}).machine.limits.c_feed == 50


# ---- a file for a lathe of one's own ----


@pytest.mark.parametrize("name", profiles.names())
def test_a_new_profile_can_be_read_empty_and_filled_in(name: str) -> None:
    text = new_machine.text("NL2000", name)
    of_parent = profiles.load(name).machine
    assert repr(msgspec.structs.replace(load(text).machine, title=of_parent.title)) == repr(of_parent)
    filled = load(re.sub(r"^#(?=[\w\"])", "", text, flags=re.MULTILINE))
    assert filled.machine.limits.c_feed == 3600
    assert filled.machine.title == "NL2000"
    assert max(map(len, text.splitlines())) < 200


def test_a_profile_of_ones_own_checks() -> None:
    profile = load("inherits = 'fanuc-16i'\n[parameters]\n1422 = 3600\n")
    program = "G98 G0 X60. C0\nG12.1\nG1 X4. C5. F100\nC-5. F500\nG13.1\n"
    findings = report_of(program, profile.machine).findings
    assert [(finding.rule, finding.severity) for finding in findings] == [("c-feed-above-limit", "error")]


def test_machines_new_writes_the_file() -> None:
    found = machines("new", "NL2000", "--from", "fanuc-30i")
    assert (found.exit_code, found.stdout) == (0, "NL2000.toml written; check with --machine NL2000.toml\n")
    assert profiles.load("NL2000.toml").chain == ("NL2000.toml", "fanuc-30i", "fanuc")
    assert machines("fanuc", "NL2000").exit_code == 2


@pytest.mark.parametrize(
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
