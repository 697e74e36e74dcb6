"""No value of any key of a machine file ends in an internal error: it is taken, or refused in one line."""

from __future__ import annotations

import itertools
import random
from pathlib import Path

import msgspec
import pytest
from programs import report_of
from test_cli import call

from polarcheck.checking.rule import load_all
from polarcheck.commands import selection
from polarcheck.errors import MachineError
from polarcheck.machines import profiles
from polarcheck.machines.machine import Machine
from polarcheck.reports.pages import machine_check, manual, new_machine

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
SHARE = 400


def assigned(key: str, value: str) -> str:
    """A machine file with one value."""
    table, _, name = key.partition(".")
    return f"[{table}]\n{name} = {value}\n" if name else f"{key} = {value}\n"


def is_taken(text: str) -> bool:
    """Whether a machine file is taken: then it is shown, looked at, inherited from and checked with."""
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
    assert report_of(PROGRAM, profile.machine, "1:radius=4", job={"run": {"max_seconds": 5}})
    return True


@pytest.mark.usefixtures("own_folder")
def test_any_value_of_any_key_is_taken_or_refused_in_one_line() -> None:
    drawn = random.Random(1).sample(list(itertools.product(KEYS, VALUES)), SHARE)  # noqa: S311
    bases = profiles.names()
    taken = 0
    for number, (key, value) in enumerate(drawn):
        inherits = "" if key == "inherits" else f'inherits = "{bases[number % len(bases)]}"\n'
        taken += is_taken(inherits + assigned(key, value))
    assert 0 < taken < SHARE


@pytest.mark.usefixtures("own_folder")
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
