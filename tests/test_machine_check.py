"""`polarcheck machines check FILE`: sound or not, what has no effect, what is still open."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from cases import looped
from test_cli import call

from polarcheck.program.machines.profiles import names
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


@pytest.mark.ci
@looped(
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


@looped(
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


@pytest.mark.nightly
@looped(
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


#: A file with a fault in nearly every line, and what is said of each.
_FAULTS = (
    ('inherits = "fanuc30i"', ["inherits: unknown machine 'fanuc30i'; did you mean fanuc-30i?"]),
    ('colour = "red"', ["unknown key colour"]),
    ("[limits]", []),
    ("c_fed = 3600", ["unknown key limits.c_fed; did you mean c_feed?"]),
    ("x_maximum = 1,5  # from the plate", ["Expected newline", "write 1.5, with a decimal point"]),
    ("z_minimum = 8.0", ["limits: z_minimum is 8, above z_maximum, 3"]),
    ("z_maximum = 3.0", []),
    ("c_feed = 0", ["limits.c_feed: expected a number above 0, found 0"]),
    ("c_acceleration = { value = 100, doubtful = 'no' }", ["limits.c_acceleration.doubtful: expected true or false"]),
    ("[m_codes]", []),
    ('c_axis_on = ["M35"]', ["m_codes.c_axis_on: M35 is in m_codes.c_axis_off, too"]),
    ('c_axis_off = ["M35", "35"]', ["m_codes.c_axis_off: '35' is no code"]),
    ("live_tool_on = [M33]", ["Invalid value", 'write "M33", in quotes']),
    ("[power_on]", []),
    ('feed_mode = "G17"', ["power_on.feed_mode: G17 selects no feed_mode; codes are"]),
    ("[parameters]", []),
    ("9999 = 1", ["parameters: no meaning is known for 9999"]),
    ('1430 = "x"', ["parameters.1430: expected a number, not x"]),
    ("3401#6 = 1", ['write "3401#6" in quotes']),
    ("[alarm_codes]", []),
    (
        'PS0146 = ["thread_cuting", "G0", "rapidd"]',
        ["'thread_cuting' is neither a code nor a list of codes; did you mean thread_cutting?", "mean rapid?"],
    ),
    ("[severities]", []),
    ('overcut = "of"', ["severities.overcut: expected error, warning, note or off, found 'of'"]),
    ('rapid-in-pola = "off"', ["severities.rapid-in-pola: unknown rule 'rapid-in-pola'; did you mean rapid-in-polar?"]),
    ("[limit]", ["unknown table [limit]; did you mean limits?"]),
    ("c_feed = 3", []),
)


def test_all_faults_of_a_file_are_said_in_one_run_each_with_its_line() -> None:
    Path("own.toml").write_text("\n".join(line for line, _ in _FAULTS), "utf-8")
    result = call("machines", "check", "own.toml")
    assert (result.exit_code, result.stdout) == (2, "")
    said: dict[int, str] = {}
    for line in result.stderr.splitlines():
        number = int(line.split(":")[2])
        said[number] = said.get(number, "") + line
    # Of two keys that contradict each other, and of two lists with one code, either may be named.
    assert [bool(faults) for _, faults in _FAULTS] == [number in said for number in range(1, len(_FAULTS) + 1)]
    for number, (_, faults) in enumerate(_FAULTS, 1):
        for fault in faults:
            assert fault in said[number]


@looped(
    ("values", "lines"),
    [
        # Behind a table that cannot be read nobody knows where a key belongs; a line that is no key may be anything.
        ("[limits\nc_fed = 3\n", [2]),
        ("[limits]\nc_fed = 3\n[limits]\nc_feed = 0\n", [4]),
        ("what is this\n", [2]),
        # A list that does not end is said at the line behind it.
        ('[m_codes]\nc_axis_on = ["M35"\nlive_tool_on = ["33"]\n', [4, 4]),
        ("[limits]\nc_feed = 3\nc_feed = 0\nx_feed = 0\n", [4, 5]),
        ('[alarm_codes]\nPS0146 = ["a1", "b2"]\n[m_codes]\nlive_tool_on = ["M1"]\nlive_tool_off = ["M1"]\n', [3, 3, 5]),
    ],
)
def test_faults_that_hide_others_are_said_without_guessing(values: str, lines: list[int]) -> None:
    Path("own.toml").write_text(f"inherits = 'fanuc-30i'\n{values}", "utf-8")
    result = call("machines", "check", "own.toml")
    assert (result.exit_code, result.stdout) == (2, "")
    assert [int(line.split(":")[2]) for line in result.stderr.splitlines()] == lines


def test_a_fault_in_the_file_that_a_file_inherits_from_is_said_beside_its_own() -> None:
    Path("shop.toml").write_text("inherits = 'fanuc-30i'\n[limits]\nc_fed = 3\n", "utf-8")
    Path("own.toml").write_text("inherits = 'shop.toml'\n[limits]\nx_fed = 3\n", "utf-8")
    lines = call("machines", "check", "own.toml").stderr.splitlines()
    assert any("shop.toml:3: unknown key limits.c_fed" in line for line in lines)


@pytest.mark.ci
@looped("name", names(), one_in=4)
def test_every_machine_of_ours_and_a_new_file_for_it_are_sound(name: str) -> None:
    assert call("machines", "check", name).stdout.startswith(f"{name}: sound, ")
    Path("own.toml").write_text(new_machine.text("own", name), "utf-8")
    told = call("machines", "check", "own.toml").stdout
    assert f"inherits {name}" in told
    assert ", 0 values of its own; " in told
    assert "to look at" not in told


@pytest.mark.parametrize("name", names())
def test_the_short_file_has_ten_questions_whose_answers_count(name: str) -> None:
    result = call("machines", "new", "own", "--from", name, "--short")
    assert (result.exit_code, result.stderr) == (0, "")
    text = Path("own.toml").read_text("utf-8")
    assert re.findall(r"^# (\d+)\. ", text, re.MULTILINE) == [str(number) for number in range(1, 11)]
    assert max(map(len, text.splitlines())) <= 100
    answered = re.sub(r"^#(?=\w+ = )", "", text, flags=re.MULTILINE)
    Path("own.toml").write_text(answered, "utf-8")
    result = call("machines", "check", "own.toml")
    assert result.exit_code == 0
    assert f"{len(re.findall('^[a-z_]+ = ', answered, re.MULTILINE)) - 2} values of its own" in result.stdout


@looped(
    ("arguments", "told"),
    [
        (("check",), "machines check: expected the FILE"),
        (("new",), "machines new: expected the NAME of the new lathe"),
        (("check", "gone.toml"), "machine gone.toml: no such file"),
        (("check", "fanuk"), "unknown machine 'fanuk'; did you mean fanuc?"),
        (("fanuc", "--from", "fanuc-30i"), "--from is for `machines new LATHE`"),
        (("check", "fanuc", "--from", "fanuc-30i"), "--from is for `machines new LATHE`"),
        (("show", "fanuc"), "fanuc: a second name is for `machines new LATHE` and `machines check FILE`"),
    ],
)
def test_what_is_asked_in_another_way_is_one_line(arguments: tuple[str, ...], told: str) -> None:
    result = call("machines", *arguments)
    assert (result.exit_code, result.stdout, result.stderr) == (2, "", f"polarcheck: {told}\n")
