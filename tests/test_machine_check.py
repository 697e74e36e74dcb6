"""`polarcheck machines check FILE`: sound or not, what has no effect, what is still open."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from test_cli import call

from polarcheck.machines.profiles import names
from polarcheck.reports.pages import new_machine


@pytest.fixture(autouse=True)
def _in_an_empty_folder(own_folder: None) -> None:
    pass


def checked(values: str, inherits: str = "fanuc-30i") -> list[str]:
    """The lines about a file that is sound."""
    Path("own.toml").write_text(f"inherits = '{inherits}'\n{values}\n", "utf-8")
    result = call("machines", "check", "own.toml")
    assert (result.exit_code, result.stderr) == (0, "")
    return [line.strip() for line in result.stdout.splitlines()]


def remarks(values: str) -> list[str]:
    """What is to look at."""
    lines = checked(values)
    begin = lines.index("to look at:") + 1 if "to look at:" in lines else 0
    return lines[begin : lines.index("still to be answered:")] if begin else []


def test_a_sound_file_is_one_line_and_what_is_open() -> None:
    lines = checked("[limits]\nc_feed = 3600\nx_maximum = { value = 130, source = 'plate', doubtful = true }")
    assert lines[0].startswith("own.toml: sound, inherits fanuc-30i < fanuc, 2 values of its own; in doubt: ")
    assert lines[0].endswith(", marked with ? by `polarcheck machines own.toml`")
    assert lines[1] == "still to be answered:"
    still = [line.partition(":")[0] for line in lines[2:]]
    assert "m_codes.c_axis_on" in still
    assert "limits.c_feed" not in still
    assert checked("[m_codes]\nc_axis_on = ['M35']")[0].split(", ")[2].startswith("1 value of its own; in doubt: ")


def test_nothing_is_open_where_all_is_answered() -> None:
    lines = checked(
        "[limits]\nc_feed = 3600\nc_acceleration = 7200\npolar_feed = 2000\nx_minimum = -10\nx_maximum = 200\n"
        "z_minimum = -500\nz_maximum = 300\n[m_codes]\nc_axis_on = ['M35']\nc_axis_off = ['M34']\n"
        "live_tool_on = ['M33']\nlive_tool_off = ['M32']\n[power_on]\nfeed_mode = 'G99'"
    )
    assert len(lines) == 1


@pytest.mark.parametrize(
    ("values", "told"),
    [
        ("[m_codes]\nlive_tool_on = ['M3']", "m_codes.live_tool_on: M3 is in m_codes.spindle_on, too; it is read as"),
        ("[m_codes]\nsub_spindle_on = ['m03']", "m_codes.spindle_on: M3 is in m_codes.sub_spindle_on, too"),
        ("[m_codes]\nc_axis_on = ['M35']\nsub_c_axis_on = ['M35']", "m_codes.c_axis_on: M35 is in m_codes.sub_c_axis"),
        ("[m_codes]\nc_axis_off = ['M34']", "m_codes.c_axis_off: without m_codes.c_axis_on it has no effect"),
        ("[m_codes]\nc_axis_unclamp = ['M34']", "m_codes.c_axis_unclamp: without m_codes.c_axis_clamp it has no"),
        ("[polar]\nallowed_codes = ['+G250']", "polar.allowed_codes: G250 is no code of this control"),
        ("[polar]\nallowed_codes = ['G1', 'G199']", "polar.allowed_codes: G199 is no code of this control"),
        ("[polar]\nallowed_codes = ['-G80']", "polar.allowed_codes: -G80 has no effect: G80 is not inherited"),
        ("[polar]\nallowed_codes = ['+g01']", "polar.allowed_codes: +g01 has no effect: g01 is inherited"),
        ("[g_codes]\nwork_offset = ['+G56']", "g_codes.work_offset: +G56 has no effect: G56 is inherited"),
        ("[limits]\npolar_feed_clamps = false", "limits.polar_feed_clamps: it has no effect: limits.polar_feed is not"),
        ("[limits]\noverride_share = 80", "limits.override_share: it has no effect: automatic_override is false"),
        ("[limits]\nc_feed = 100\nc_feed_harmless = 9", "limits.c_feed_harmless: it has no effect: limits.c_feed is"),
        ("[control]\naxes = ['X', 'Z', 'C']\n[polar]\nlinear_address = 'Z'", "polar.linear_address: it has no effect"),
        ("[compensation]\nstart_up_with_move = 'B'", "compensation.start_up_with_move: it has no effect: it counts"),
        ("[g_code_system_b]\ninch = ['G20']", "[g_code_system_b]: it has no effect: control.g_code_system is A"),
        ("[parameters]\n1430 = 9\n[limits]\nc_feed = 8", "parameters.1430: it does not set limits.c_feed: the file"),
        ("[severities]\novercut = 'off'\n[alarms]\novercut = 'A1'", "alarms.overcut: it has no effect: severities"),
        ("[alarm_codes]\nPS9999 = ['G0']", "alarm_codes.PS9999: it has no effect: no rule has this alarm in [alarms]"),
    ],
)  # fmt: skip
def test_what_has_no_effect_is_named(values: str, told: str) -> None:
    found = remarks(values)
    assert len(found) == 1
    assert found[0].startswith(told)


@pytest.mark.parametrize(
    "values",
    [
        "[m_codes]\nlive_tool_on = ['M3 P12']\nlive_tool_off = ['M5']",
        "[m_codes]\nlive_tool_on = ['M3']\nspindle_on = ['-M3']",
        "[polar]\nallowed_codes = ['+G250']\n[control]\nknown_codes = ['+G250']",
        "[limits]\noverride_share = 80\nautomatic_override = true",
        "[compensation]\nstart_up = 'C'\nstart_up_with_move = 'B'",
        "[g_code_system_b]\ninch = ['G20']\n[control]\ng_code_system = 'B'",
        "[alarms]\novercut = 'A1'\n[alarm_codes]\nA1 = ['G0']",
        "[parameters]\n1430 = 9",
    ],
)
def test_what_has_an_effect_is_not(values: str) -> None:
    assert remarks(values) == []


@pytest.mark.parametrize(
    ("values", "told"),
    [
        (
            "[m_codes]\nc_axis_on = ['M35']\nc_axis_off = ['M35']",
            "m_codes.c_axis_on: M35 is in m_codes.c_axis_off, too",
        ),
        (
            "[severities]\nrapid-in-pola = 'off'",
            "severities.rapid-in-pola: unknown rule 'rapid-in-pola'; did you mean r",
        ),
        (
            "[alarms]\nrapid = 'off'",
            "alarms.rapid: unknown rule 'rapid'; did you mean",
        ),
        ("[limits]\nc_feed = 0", "limits.c_feed: expected a number above 0, found 0"),
        ("[polar]\n5460 = 2", "unknown key polar.5460; it is a parameter of the control: write it under [parameters]"),
    ],
)
def test_a_file_that_is_not_sound_is_one_line_in_every_command(values: str, told: str) -> None:
    Path("own.toml").write_text(f"inherits = 'fanuc-30i'\n{values}\n", "utf-8")
    Path("a.nc").write_text("G98 G0 X60.\n", "utf-8")
    for command in (
        ("machines", "check", "own.toml"),
        ("machines", "own.toml"),
        ("machines", "new", "other", "--from", "own.toml"),
        ("check", "a.nc", "--machine", "own.toml"),
        ("trace", "a.nc", "--machine", "own.toml"),
        ("explain", "overcut", "--machine", "own.toml"),
    ):
        result = call(*command)
        assert (result.exit_code, result.stdout) == (2, ""), command
        assert re.match(rf"polarcheck: own\.toml:\d: {re.escape(told)}", result.stderr), command
        assert result.stderr.count("\n") == 1
    assert not Path("other.toml").exists()


@pytest.mark.parametrize("name", names())
def test_every_machine_of_ours_and_a_new_file_for_it_are_sound(name: str) -> None:
    assert call("machines", "check", name).stdout.startswith(f"{name}: sound, ")
    Path("own.toml").write_text(new_machine.text("own", name), "utf-8")
    told = call("machines", "check", "own.toml").stdout
    assert f"inherits {name}" in told
    assert ", 0 values of its own; " in told
    assert "to look at" not in told


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        (("check",), "machines check: expected the FILE"),
        (("new",), "machines new: expected the NAME of the new lathe"),
        (("check", "gone.toml"), "machine gone.toml: no such file"),
        (("check", "fanuk"), "unknown machine 'fanuk'; did you mean fanuc?; `polarcheck machines` lists them"),
        (("fanuc", "--from", "fanuc-30i"), "--from is for `machines new LATHE`"),
        (("check", "fanuc", "--from", "fanuc-30i"), "--from is for `machines new LATHE`"),
        (("show", "fanuc"), "fanuc: a second name is for `machines new LATHE` and `machines check FILE`"),
    ],
)
def test_what_is_asked_in_another_way_is_one_line(arguments: tuple[str, ...], told: str) -> None:
    result = call("machines", *arguments)
    assert (result.exit_code, result.stdout, result.stderr) == (2, "", f"polarcheck: {told}\n")
