"""
No value of any key of a machine file ends in an internal error: it is taken, or refused in one line. Nor does what is
taken in check, part, trace and feeds, on a program that uses the mode of that machine.
"""

from __future__ import annotations

import functools
import itertools
import json
import math
import random
from pathlib import Path
from typing import Any

import msgspec
import pytest
from polarcheck.errors import MachineError
from programs import job_of
from test_cli import call
from test_every_machine import HANDS

from polarcheck.checking import check
from polarcheck.files.settings import selection
from polarcheck.program.machines import profiles
from polarcheck.program.machines.machine import Machine
from polarcheck.reports.made_parts.part_report import part_of
from polarcheck.reports.pages import executed, machine_check, manual, new_machine
from polarcheck.rewrite.feeds import feed_page as feeds
from polarcheck.rewrite.feeds.table import FeedReport, feed_table
from polarcheck.rules.rule import load_all

pytestmark = pytest.mark.ci

#: Of each type of TOML, what people write and what nobody means.
VALUES = (
    *("true", "0", "1", "-1", "2", "3.5", "-0.0", "nan", "inf", "-inf", "1e308", "1e-300", "999999999999999999"),
    *(
        '""',
        '" "',
        '"X"',
        '"y"',
        '"C2"',
        '"\u00e9"',
        r'"\n"',
        '"G0"',
        '"+G0"',
        '"m35"',
        '"M08"',
        '"M3 P12"',
        '"radius"',
    ),
    *("[]", "[[]]", '[""]', '[" "]', '["G0"]', '["+G0"]', '["-G1"]', '["+G0", "-G1"]', '["+G0", "G1"]', '["m35"]'),
    *(
        '["M08"]',
        '["M3 P12"]',
        '["M3", "M3P12"]',
        '["G54-G59"]',
        '["-G54-G59"]',
        '["G1000"]',
        '["G0.5"]',
        '["M3 P1e5"]',
    ),
    *(
        '["X"]',
        '["x", "C"]',
        '["\u00e9"]',
        r'["\n"]',
        "[1]",
        "[1.5]",
        "[-1]",
        "[0, 9]",
        "[[1, 2]]",
        "[[2, 1]]",
        "[true]",
    ),
    *("[nan]", '["G0", 1]', "1979-05-27", "07:32:00", "{ }", "{ value = 1 }", '{ value = ["M3 P12"], source = 3 }'),
    *("{ value = nan, doubtful = 'x' }", '{ x = ["i", "j"] }', '{ g101 = "g01" }', '{ "M3 P12" = "G1" }'),
    *('{ TRANSMIT = "G12.1" }', "{ 100 = 1 }", "{ G = 0.1 }", '["+"]', '["-"]', '["+-G0"]', '["G10.9 X0"]', '"G18"'),
)
PROGRAM = """%
O1
T0101
G98 G0 X60. C0
M35
M3 P12 S500
G10 L10 P1 R1.
#500=1
M98 P2
G12.1
G1 G42 X40. F200
C10.
G3 X30. C5. R6.
G2 X20. C0 I3. J0
G4 P10
G17
G1 G40 X60.
G13.1
M5 P12
G250
M30
O2
G28 H0
M99
%
"""
#: One value of a key more: as text, in a list, as a key of a table.
TEXTS = (
    *(
        "",
        " ",
        "X",
        "Y",
        "C",
        "C2",
        "A",
        "H",
        "V",
        "XY",
        "x",
        "  X",
        "X ",
        "\u0130",
        "\u00df",
        "\u200b",
        "G0",
        "G12.1",
        "M30",
    ),
    *(
        "M3 P12",
        "G54-G59",
        "+G0",
        "-G1",
        "=",
        "%",
        "(",
        "O",
        "N",
        "T",
        "R",
        "F",
        "P",
        "L",
        "S",
        "M",
        "G",
        "E",
        "D",
        "I",
    ),
    *("/", "#", "R1", "TRANSMIT", "DIAMOF", "G10.9 X0", "$", "*", "A*", "IF", "GOTO", "0", "edge"),
)
NUMBERS = (0, 1, -1, 2, 3, 9, 24, 100, 1e-12, 1e49, -1e49, 10**12, math.inf, math.nan, 3.5)


def program_of(base: str) -> str:
    """A program for a machine that uses its mode, with much beside it that a changed key may give another meaning."""
    hand = HANDS[base]
    line, clockwise, counterclockwise = hand.codes
    inside, outside, axis = hand.factor, hand.outside, hand.axis
    return f"""{hand.head}
{hand.comment}
G0 X{30 * outside}. C0 Z5.
G10 L10 P1 R5.
#500=1
M98 P2
{hand.on}
{line} X{28 * inside}. F200.
G41 X{20 * inside}. {axis}0
{axis}10.
{counterclockwise} X{10 * inside}. {axis}12. {hand.arc}20.
{clockwise} X0 {axis}14. I-3. J0
{line} X-{10 * inside}. Z-1.
Y5.
H2. U1. V1.
Q1. A10. B5. W1.
G0 X-{20 * inside}.
G4 P10
G17
{line} {axis}-10.
X{20 * inside}.
{axis}2.
G40 X{30 * inside}.
{hand.off}
G0 Z50.
G28 U0
M5 P12
G250
M30
O2
G28 H0
M99
"""


def _keys() -> list[str]:
    """All keys of all tables, some of those that hold names, and some that there are not."""
    keys = ["inherits", "replaces", "unknown", "polar.unknown", "alarms.rapid-in-polar", "severities.rapid-in-polar"]
    keys += ["alarm_codes.PS0146", "known_parameters.5460", "parameters.5460", 'parameters."5450#2"', "parameters.1430"]
    for field in msgspec.structs.fields(Machine):
        is_table = isinstance(field.type, type) and issubclass(field.type, msgspec.Struct)
        own = [f"{field.name}.{key.name}" for key in msgspec.structs.fields(field.type)] if is_table else []
        keys += own or [field.name]
    return keys


KEYS = _keys()
SHARE = 250
NEARLY = 25


def assigned(key: str, value: str) -> str:
    """A machine file with one value."""
    table, _, name = key.partition(".")
    return f"[{table}]\n{name} = {value}\n" if name else f"{key} = {value}\n"


def is_taken(text: str, program: str) -> bool:
    """Whether a machine file is taken: then it is shown, looked at, inherited from, and programs run on it."""
    Path("own.toml").write_text(text, "utf-8")
    try:
        profile = profiles.load("own.toml")
        selection.check_names(profile, load_all())
    except MachineError as error:
        refused = str(error)
    else:
        refused = ""
    if refused:
        assert refused.startswith("own.toml: ")
        assert "\n" not in refused
        return False
    assert manual.profile_text(profile)
    assert machine_check.text(profile, load_all())
    assert new_machine.text("new", "own.toml")
    run_commands(profile.machine, program)
    return True


def run_commands(machine: Machine, program: str) -> None:
    """What check, part, trace and feeds do with a program."""
    job = job_of("1:radius=4", job={"run": {"max_seconds": 5}})
    runs = check.read(program.encode(), machine, job)
    report = check.check_runs(runs, list(load_all().values()))
    part_of(report, runs)
    tables = [of_run for _, of_run in runs]
    for of_run in tables:
        for which in ("tool", "programmed"):
            list(executed.as_csv(executed.moves(of_run["trace"], of_run["tool_center"], which)))
        assert list(executed.as_jsonl(executed.rows(of_run["trace"], of_run["tool_center"])))
    assert feeds.text(FeedReport(schema=1, path="-", machine="", tables=[feed_table(one) for one in tables]))


@pytest.mark.nightly
@pytest.mark.usefixtures("own_folder")
def test_any_value_of_any_key_is_taken_or_refused_in_one_line() -> None:
    drawn = random.Random(1).sample(list(itertools.product(KEYS, VALUES)), SHARE)  # noqa: S311
    bases = profiles.names()
    taken = 0
    for number, (key, value) in enumerate(drawn):
        base = bases[number % len(bases)]
        inherits = "" if key == "inherits" else f'inherits = "{base}"\n'
        taken += is_taken(inherits + assigned(key, value), program_of(base))
    assert 0 < taken < SHARE


@functools.cache
def values_in_use(key: str) -> list[Any]:
    """The values that our machines have for a key."""
    table, _, name = key.partition(".")
    found = []
    for profile in profiles.built_in():
        value = json.loads(msgspec.json.encode(getattr(profile.machine, table, None)))
        found.append(value.get(name) if name and isinstance(value, dict) else value)
    return [value for value in found if value is not None] or [""]


def changed(value: Any, chance: random.Random) -> Any:
    """The value of a key, with something in it that is nearly one."""
    if isinstance(value, bool):
        return not value
    if isinstance(value, int | float):
        return chance.choice((*NUMBERS, value + 1, value * 2))
    if isinstance(value, str):
        return chance.choice((*TEXTS, value + value, value.lower(), value[:-1], f"{value} "))
    if isinstance(value, list):
        place = chance.randrange(len(value) + 1)
        return chance.choice(
            (
                [],
                value[:place] + value[place + 1 :],
                [*value, *value[:1]],
                value[::-1],
                [*value[:place], chance.choice(TEXTS), *value[place:]],
                [changed(one, chance) if at == place else one for at, one in enumerate(value)],
            )
        )
    assert isinstance(value, dict)
    if not value or chance.random() < 0.25:
        return value | {chance.choice(TEXTS): chance.choice(TEXTS)}
    key = chance.choice(list(value))
    other = key if chance.random() < 0.5 else str(changed(str(key), chance))
    return {name: one for name, one in value.items() if name != key} | {other: changed(value[key], chance)}


def in_toml(value: Any) -> str:
    """A value as it is written in TOML."""
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, list):
        return f"[{', '.join(map(in_toml, value))}]"
    if isinstance(value, dict):
        return f"{{ {', '.join(f'{json.dumps(str(key))} = {in_toml(one)}' for key, one in value.items())} }}"
    return json.dumps(value) if isinstance(value, str) else str(value)


@pytest.mark.nightly
@pytest.mark.usefixtures("own_folder")
@pytest.mark.parametrize("seed", range(4))
def test_what_is_nearly_a_value_in_use_is_taken_without_harm_or_refused(seed: int) -> None:
    """Most values of the test above are of the wrong kind: these reach the programs."""
    chance = random.Random(seed)  # noqa: S311
    taken = 0
    for _ in range(NEARLY):
        key, base = chance.choice(KEYS[1:]), chance.choice(profiles.names())  # all but inherits, which stands above
        value = changed(chance.choice(values_in_use(key)), chance)
        taken += is_taken(f'inherits = "{base}"\n{assigned(key, in_toml(value))}', program_of(base))
    assert taken > NEARLY / 4


@pytest.mark.one_in(12)
@pytest.mark.usefixtures("own_folder")
@pytest.mark.parametrize(
    ("value", "is_sound"),
    [
        ('[""]', False),
        ('["", "V"]', False),
        ('["Y", "V", ""]', False),
        ('["", ""]', False),
        ('[" "]', False),
        ('["YV"]', False),
        ('["\u00df"]', False),
        ('["\u200b", "V"]', False),
        ('["Y", ""]', True),
        ('["Y"]', True),
        ('["C2", "H", "Y"]', True),
        ("[]", True),
    ],
)
def test_addresses_of_other_controls_are_pairs_that_begin_with_one(value: str, is_sound: bool) -> None:
    def load(base: str) -> Machine:
        table = f"[polar]\nvirtual_axis_of_other_controls = {value}\n"
        Path("own.toml").write_text(f'inherits = "{base}"\n{table}', "utf-8")
        return profiles.load("own.toml").machine

    for base in ("fanuc", "citizen", "mazak-integrex", "siemens-transmit"):
        if is_sound:
            run_commands(load(base), program_of(base))
        else:
            with pytest.raises(MachineError, match="virtual_axis_of_other_controls"):
                load(base)
    found = call("machines", "check", "own.toml")
    assert found.exit_code == (0 if is_sound else 2)
    assert is_sound or found.stderr.count("\n") == 1


@pytest.mark.usefixtures("own_folder")
@pytest.mark.one_in(12)
@pytest.mark.parametrize(
    "values",
    [
        '[m_codes]\nlive_tool_on = ["M3 P12"]',
        '[m_codes]\nlive_tool_on = ["m03p12", "M33"]\nlive_tool_off = ["M5 P12"]',
        '[m_codes]\nspindle_on = []\nspindle_off = []',
        '[polar]\nvirtual_axis = "C2"',
        '[polar]\nvirtual_axis = "Y"',
        '[polar]\nvirtual_axis = 2',
        '[polar]\nallowed_codes = ["+G0"]',
        '[polar]\nallowed_codes = ["+G0", "G1"]',
        '[polar]\nallowed_codes = []',
        '[polar]\nallowed_codes = [[]]',
        '[limits]\nc_feed = nan',
        '[polar]\nvirtual_axis_incremental = ""',
        '[power_on]\nplane = "G18"\nmotion = "g00"',
        '"5460" = 2',
        '[parameters]\n5460 = 2',
        '[severities]\nrapid-in-pola = "off"',
    ],
)  # fmt: skip
def test_no_command_ends_in_an_internal_error(values: str) -> None:
    Path("own.toml").write_text(f'inherits = "fanuc-30i"\n{values}\n', "utf-8")
    Path("a.nc").write_text(PROGRAM, "utf-8")
    codes = {
        call(*command).exit_code
        for command in (
            ("machines", "own.toml"),
            ("machines", "check", "own.toml"),
            ("machines", "new", "n", "--from", "own.toml"),
        )
    }
    assert codes in ({0}, {2})
    found = call("check", "a.nc", "--machine", "own.toml", "--tool", "1:radius=4").exit_code
    assert found in ((0, 1) if codes == {0} else (2,))
