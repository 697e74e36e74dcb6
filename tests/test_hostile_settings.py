"""Job files, machine files, offset tables and options that nobody means: one line that names them, exit 2, no hang."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from cases import looped
from programs import machine_of, report_of
from test_cli import COMPENSATED, GOOD, call, findings, make, process

from polarcheck.foundation import bounded
from polarcheck.program.machines import offset_table, profiles, toml_text

needs_pipes = pytest.mark.skipif(sys.platform == "win32", reason="named pipes and devices are files of POSIX")
needs_links = pytest.mark.skipif(sys.platform == "win32", reason="links need a privilege there")

NINES = "9" * 5000
LONG = "a" * 5000


@pytest.fixture(autouse=True)
def _program(own_folder: None) -> None:
    make(a__nc=GOOD)


def refusal(*arguments: str) -> str:
    """The one line on standard error of a command that could not run."""
    result = call(*arguments)
    assert (result.exit_code, result.stdout) == (2, "")
    assert result.stderr.count("\n") == 1
    assert len(result.stderr) < 1100
    return result.stderr


def refusal_of_lathe(*arguments: str) -> str:
    """The same without the line of the machine file, which test_configuration is about."""
    return re.sub(r"(\.toml):\d+: ", r"\1: ", refusal(*arguments))


def refused_in_bounds(*arguments: str) -> str:
    """The same in a process of its own, which may have a GB of memory and a minute."""
    limits: dict[str, Any] = {}
    if sys.platform != "win32":
        import resource

        limits["preexec_fn"] = lambda: resource.setrlimit(resource.RLIMIT_AS, (1 << 30, 1 << 30))
    with process(*arguments, **limits) as running:
        try:
            out, error = running.communicate(timeout=60)
        except subprocess.TimeoutExpired:
            running.kill()
            raise
    assert (running.returncode, out) == (2, "")
    assert error.count("\n") == 1
    return error


# ---- TOML ----

NESTED = "tables or lists are nested more than 12 deep"
LONG_KEY = "a key has more than 12 parts: a."


@pytest.mark.ci
@pytest.mark.one_in(16)
@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("x = " + "[" * 500 + "]" * 500, NESTED),
        ("x = " + "{a = " * 500 + "1" + "}" * 500, NESTED),
        ("x = " + "[" * 200_000, NESTED),
        ("x = " + "[" * 13 + "]" * 13, NESTED),
        (".".join("a" * 100_000) + " = 1", LONG_KEY),
        (" . ".join("a" * 100_000) + " = 1", "a key has more than 12 parts: a . a"),
        ("[" + ".".join("a" * 100_000) + "]", LONG_KEY),
        ("[[" + ".".join("a" * 400) + "]]", LONG_KEY),
        ("x = {" + ".".join("a" * 400) + " = 1}", LONG_KEY),
        ("\n".join(f"a.k{number}" + ".a" * 400 + " = 1" for number in range(1000)), "has more than 12 parts: a.k"),
        (".".join(["a", '"b"', "'c'"] * 200) + " = 1", "a key has more than 12 parts: a.x.x.a"),
        ('x = """\n"""\n' + ".".join("a" * 400) + " = 1", LONG_KEY),
        ("x = " + NINES, "line 2: a whole number has at most 18 digits: x ="),
        ("x = " + "9_" * 5000 + "9", "line 2: a whole number has at most 18 digits: x ="),
        ("x = 0x" + "f" * 5000, "x: a whole number has at most 18 digits"),
        ("x.y = [1, {z = " + "9" * 400 + "}]", "x.y.z: a whole number has at most 18 digits"),
    ],
)  # fmt: skip
def test_toml_that_nobody_means(text: str, told: str) -> None:
    make(polarcheck__toml=f"# a file\n{text}")
    error = refused_in_bounds("check", "a.nc")
    assert error.startswith("polarcheck: polarcheck.toml: ")
    assert told in error
    # Of a machine likewise, and of a project: there in time and memory, too.
    Path("polarcheck.toml").rename("own.toml")
    assert told in refusal("check", "a.nc", "--machine", "own.toml")
    make(pyproject__toml=f"[tool.polarcheck]\n{text}")
    assert told in refusal("check", "a.nc").replace("tool.polarcheck.", "")


@pytest.mark.parametrize("name", ["polarcheck.toml", "pyproject.toml", "own.toml"])
@pytest.mark.parametrize("text", ["x = 'polarcheck'", "# polarcheck"])
def test_toml_larger_than_the_limit(name: str, text: str) -> None:
    make(**{name.replace(".", "__"): text.ljust(toml_text.LARGEST + 1, "\n")})
    error = refusal("check", "a.nc", *(["--machine", name] if name == "own.toml" else []))
    assert error == f"polarcheck: {name}: larger than 1 MB; no {'machine' if name == 'own.toml' else 'job'} file is\n"


@looped(
    "text",
    [
        "# " + "1." * 5000,
        "x = '" + "a." * 5000 + "'",
        'x = "' + "a." * 5000 + '\\"b.c"',
        'x = """\n' + "a." * 5000 + "\\\n'''\n\"\"\"\ny = 1",
        "x = '''\n" + "a." * 5000 + "\"\"\"\n'''",
        "[a.b.c.d.e.f.g.h.i.j.k]\nl = 1.5",
        "x = " + "[" * 12 + "]" * 12,
        "x = " + "9" * 18 + " # " + NINES,
        "x = ['" + NINES + "']",
        "x = 1979-05-27T07:32:00.999999Z",
    ],
)
def test_sound_toml_is_read_as_it_is(text: str) -> None:
    import tomllib

    assert toml_text.parsed(text) == tomllib.loads(text)


def test_the_largest_file_is_read() -> None:
    make(own__toml="inherits = 'fanuc'\n#".ljust(toml_text.LARGEST, "x"))
    assert Path("own.toml").stat().st_size == toml_text.LARGEST
    assert call("check", "a.nc", "--machine", "own.toml").exit_code == 0


@looped(
    ("text", "told"),
    [
        ("[tool]\npolarcheck = 3\n", "tool.polarcheck: expected a table, found 3"),
        ("[tool]\npolarcheck = 2020-01-01\n", "tool.polarcheck: expected a table, found 2020-01-01"),
        ("[[tool.polarcheck]]\nmachine = 'fanuc'\n", "tool.polarcheck: expected a table, found [{'machine': 'fanuc'}]"),
        ("[tool]\npolarcheck.machin = 'fanuc'\n", "unknown key machin"),
        ("[ tool . polarcheck ]\nmachin = 'fanuc'\n", "unknown key machin"),
        ("tool.'polarcheck'.machin = 'fanuc'\n", "unknown key machin"),
        ("tool = {polarcheck = {machin = 'fanuc'}}\n", "unknown key machin"),
    ],
)  # fmt: skip
def test_a_job_in_pyproject_is_found_however_it_is_written(text: str, told: str) -> None:
    make(pyproject__toml=text)
    assert re.match(rf"polarcheck: pyproject\.toml(:\d)?: {re.escape(told)}", refusal("check", "a.nc"))


@pytest.mark.ci
@looped("text", ["tool = 3\n# polarcheck", "[tool]\nx = 'polarcheck'", "dependencies = [polarcheck", ""])
def test_what_others_write_into_pyproject_is_none_of_ours(text: str) -> None:
    make(pyproject__toml=text)
    assert call("check", "a.nc").exit_code == 0


@looped(
    ("text", "told"),
    [
        ("[tools.1]\nradius = inf\n", "tools.1.radius: expected a number from -1000 to 1000, found inf"),
        ("[tools.1]\nradius = nan\n", "tools.1.radius: expected a number from -1000 to 1000, found nan"),
        ("[tools.1]\nradius = 1e308\n", "tools.1.radius: expected a number from -1000 to 1000, found 1e+308"),
        (f"[tools.1]\nradius = {NINES}.0\n", "tools.1.radius: expected a number from -1000 to 1000, found inf"),
        ("[tools.1]\nradius = 10:00:00\n", "tools.1.radius: expected a number from -1000 to 1000, found 10:00:00"),
        (f"[tools.{NINES}]\nradius = 5\n", "999"),
        (f"[run.variables]\n{NINES} = 5\n", "999"),
        ("[run.variables]\n100 = 2020-01-01\n", "run.variables.100: expected a number, found 2020-01-01"),
        ("[limits]\nc_feed = 2020-01-01\n", "limits.c_feed: expected a number or true or false, found 2020-01-01"),
        ("[limits]\nc_feed = 1e308\n", "limits.c_feed: expected a number above 0, up to 1e+50, found 1e+308"),
        ("[limits]\nc_feed = 5e-324\n", "limits.c_feed: expected a number above 0, found 4.94"),
        ("machine = 2020-01-01T00:00:00Z\n", "machine: expected a text, found 2020-01-01 00:00:00+00:00"),
        ("machine = 'a\\u0000b'\n".replace("'", '"'), "machine: unknown machine 'a\\x00b'"),
        ('machine = "a\\u0000b.toml"\n', "machine: machine a\\x00b.toml: no such file"),
        (f"machine = '{LONG}'\n", "`polarcheck machines` lists them"),
        (f"machine = '{LONG}.toml'\n", "no such file"),
        ("machine = '.'\n", "machine: unknown machine '.'"),
        ('offsets = "a\\u0000b"\n', "offsets: a\\x00b: no file can have this name"),
        (f"offsets = '{LONG}'\n", "name too long" if sys.platform != "win32" else "offsets: "),
        ("offsets = '.'\n", "offsets: .: is a folder, not a file" if sys.platform != "win32" else "offsets: ."),
        ('[run]\nsubprograms = ["a\\u0000b"]\n', "run.subprograms: there is no folder 'a\\x00b'"),
        (f"[run]\nsubprograms = ['{LONG}']\n", "run.subprograms: "),
        ("[run]\nsubprograms = ['a.nc']\n", "run.subprograms: there is no folder 'a.nc'"),
    ],
)  # fmt: skip
def test_a_job_with_values_that_nobody_means(text: str, told: str) -> None:
    make(polarcheck__toml=text)
    error = refusal("check", "a.nc")
    assert re.match(r"polarcheck: polarcheck\.toml(:\d)?: ", error)
    assert told in error


# ---- what is no file ----


@pytest.mark.one_in(12)
@needs_pipes
@pytest.mark.parametrize("kind", ["folder", "pipe", "itself", "nowhere"])
@pytest.mark.parametrize("place", ["job", "config", "machine", "of-job", "inherits", "offsets", "of-job-offsets"])
def test_what_is_no_file_is_said_to_be_none(kind: str, place: str) -> None:
    name = "polarcheck.toml" if place == "job" else "x.toml"
    make_one: dict[str, Callable[[Path], None]] = {
        "folder": Path.mkdir,
        "pipe": os.mkfifo,
        "itself": lambda path: path.symlink_to(path.name),
        "nowhere": lambda path: path.symlink_to("gone"),
    }
    make_one[kind](Path(name))
    if place == "of-job":
        make(polarcheck__toml="machine = 'x.toml'\n")
    if place == "of-job-offsets":
        make(polarcheck__toml="offsets = 'x.toml'\n")
    make(child__toml="inherits = 'x.toml'\n")
    options = {"config": ["--config", name], "machine": ["--machine", name], "offsets": ["--offsets", name],
               "inherits": ["--machine", "child.toml"]}  # fmt: skip
    told = {"folder": ("is a folder", "is a directory"), "pipe": ("pipe",),
            "itself": ("symbolic links", "does not exist"), "nowhere": ("No such file", "does not exist")}  # fmt: skip
    error = (refused_in_bounds if kind == "pipe" else refusal)("check", "a.nc", *options.get(place, []))
    assert name in error
    assert any(words in error for words in told[kind])


@pytest.mark.one_in(12)
@pytest.mark.ci
@needs_pipes
@pytest.mark.parametrize("device", ["/dev/zero", "/dev/random"])
@pytest.mark.parametrize("place", ["--config", "--machine", "--offsets", "machine", "offsets", "inherits"])
def test_a_device_has_no_end(device: str, place: str) -> None:
    make(own__toml=f"inherits = '{device}'\n")
    if place in ("machine", "offsets"):
        make(polarcheck__toml=f"{place} = '{device}'\n")
    options = {"inherits": ["--machine", "own.toml"]}.get(place, [place, device] if place.startswith("-") else [])
    assert refused_in_bounds("check", "a.nc", *options).endswith(f"{device}: is a device, not a file\n")


@needs_pipes
@pytest.mark.parametrize("option", ["--config", "--offsets"])
def test_a_pipe_from_the_shell_is_read(option: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(bounded, "_PATIENCE", 60_000)
    make(a__nc=COMPENSATED)
    text = {"--config": "[tools.1]\nradius = 15\n", "--offsets": "G10 P10001 R15.\n"}[option]
    os.mkfifo("pipe")
    with subprocess.Popen(["sh", "-c", 'printf "%s" "$0" > pipe', text]):
        assert findings("a.nc", "--select", "start-up-shorter-than-radius", option, "pipe")


# ---- machines that inherit ----


def test_inheritance_in_a_circle() -> None:
    make(a__toml="inherits = 'b.toml'", b__toml="inherits = 'a.toml'", c__toml="inherits = 'c.toml'")
    assert refusal_of_lathe("machines", "a.toml") == "polarcheck: a.toml: inherits from itself, by way of b.toml\n"
    assert refusal_of_lathe("machines", "c.toml") == "polarcheck: c.toml: inherits from itself\n"
    Path("d").mkdir()
    make(e__toml="inherits = 'd/../e.toml'")
    assert refusal_of_lathe("machines", "e.toml").endswith("e.toml: inherits from itself\n")


@needs_links
def test_inheritance_in_a_circle_through_links() -> None:
    Path("d").mkdir()
    Path("d/d").symlink_to(".")
    Path("d/link.toml").symlink_to("../a.toml")
    make(a__toml="inherits = 'd/link.toml'")
    assert refusal_of_lathe("machines", "a.toml") == "polarcheck: d/link.toml: inherits from itself\n"


def test_inheritance_without_end() -> None:
    for number in range(1000):
        Path(f"m{number}.toml").write_text(f"inherits = 'm{number + 1}.toml'\n", "utf-8")
    make(m1000__toml="inherits = 'fanuc'\n")
    assert "m0.toml: inherits from more than 9 files, one behind the other" in refusal_of_lathe("machines", "m0.toml")
    assert call("machines", "m992.toml").exit_code == 0


@looped(
    ("text", "told"),
    [
        ("inherits = 'gone'", "own.toml: inherits: unknown machine 'gone'"),
        (f"inherits = '{LONG}'", "own.toml: inherits: unknown machine 'aaa"),
        ('inherits = "a\\u0000.toml"', "own.toml: inherits: machine a\\x00.toml: no such file"),
        ("inherits = 2020-01-01", "own.toml: inherits: expected the name of a machine"),
    ],
)
def test_inheritance_from_nothing(text: str, told: str) -> None:
    make(own__toml=text)
    assert told in refusal_of_lathe("machines", "own.toml")


# ---- values of machines ----


@pytest.mark.one_in(12)
@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("[control]\nknown_codes = ['G0-G999999999']", "control.known_codes: 'G0-G999999999' is no code"),
        ("[g_codes]\nrapid = ['G0-G999999999']", "g_codes.rapid: 'G0-G999999999' is no code"),
        (f"[g_codes]\nrapid = ['G{NINES}']", "is no code"),
        ("[polar]\non = ['G999999999']\noff = ['G13.1']", "polar.on: 'G999999999' is no code"),
        ("[polar]\nwords_beside_switch = ['G0-G999999999']", "polar.words_beside_switch: 'G0-G999999999' is no code"),
        ("[polar]\nwords_beside_switch = ['\u4e00']", "polar.words_beside_switch: '\u4e00' is no code"),
        ("[polar]\non_of_other_controls = ['G0-G999']", "polar.on_of_other_controls: 'G0-G999' is no code"),
        ("[polar]\non_of_other_controls = ['\u4e00']", "expected letters and signs of ASCII"),
        ("[polar]\nvirtual_axis_of_other_controls = ['YY']", "expected an address, one letter"),
        ('[polar]\nvirtual_axis = "Y\\n"', "expected an address, one letter"),
        ("[macro]\nsubprogram_calls = ['M999999999']", "'M999999999': expected a G or M code"),
        (f"[macro]\nmacro_calls = ['G{NINES}']", "expected a G or M code"),
        ("[macro]\nmodal_macro_calls = ['G\u0661\u0661']", "expected a G or M code"),
        ("[macro.computed_increments]\nX = 5e-324", "macro.computed_increments.X: expected a number above 0"),
        ("[control]\nleast_increment = 5e-324", "control.least_increment: expected a number above 0"),
        ("[control]\nleast_increment = 1e308", "control.least_increment: expected a number above 0, up to 1e+50"),
        ("[control]\ndigit_limit = 900000000000000000", "digit_limit: expected a whole number of 1 or more, up to"),
        ("[compensation]\nread_ahead = 900000000000000000", "whole number of 2 or more, up to 1e+09"),
        ("[compensation]\novercut_tolerance = 1e308", "overcut_tolerance: expected a number from 0.0001 to 1000"),
        ("[compensation]\novercut_tolerance = 0", "overcut_tolerance: expected a number from 0.0001 to 1000, found 0"),
        ("[limits]\nx_minimum = -1e308", "limits.x_minimum: expected a number, up to 1e+50"),
        ("[control.motion_codes]\nG5-G9 = 'G1'", "G5-G9 = 'G1': expected a G code"),
        ("[control.native_words]\n'\u4e00\u4e00\u4e00\u4e00\u4e00' = 'G12.1'", "expected letters and signs of ASCII"),
        ("[control.native_words]\nABCDEFG = '\u4e00'", "expected letters and signs of ASCII"),
        ("[control]\nline_comments = '\u4e00'", "control.line_comments: expected one character or none"),
        (f"[control]\nline_comments = '{'(' * 5000}'", "control.line_comments: expected one character or none"),
        ("[control]\nx_radius_words = ['G10.9 X']", "control.x_radius_words: expected a code, a code with a word"),
        ("[alarms]\n" + "\n".join(f"a{number} = ''" for number in range(50_000)), "alarms.a0: unknown rule 'a0'"),
        ("[alarms]\n" + "\n".join(f"a{number} = ''" for number in range(100_000)), "larger than 1 MB"),
        ("[parameters]\n5460 = " + "9" * 400, "parameters.5460: a whole number has at most 18 digits"),
        ("[parameters]\n5460 = 1e308", "parameters.5460: polar.linear_axis: expected the number of an axis"),
        ("[title]\nx = 1", "title: expected a text, found a table"),
        (
            "[known_parameters.x]\ntitle = 'x'\nvalues.1 = {'limits.c_feed' = '= title.x'}\n[parameters]\nx = 1",
            "parameters.x: limits.c_feed: expected a number above 0",
        ),
    ],
)  # fmt: skip
def test_a_machine_with_values_that_nobody_means(text: str, told: str) -> None:
    make(own__toml=f"inherits = 'fanuc-30i'\n{text}\n")
    error = refusal_of_lathe("check", "a.nc", "--machine", "own.toml")
    assert error.startswith("polarcheck: own.toml: ")
    assert told in error


@pytest.mark.nightly
@looped(
    "changes",
    [
        {"macro": {"bracket_levels": 10**9, "macro_levels": 10**9, "loop_levels": 10**9, "loop_numbers": 10**9}},
        {"macro": {"local_variables": [[1, 10**17]], "system_variables": [[0, 10**17]]}},
        {"control": {"digit_limit": 10**9, "word_limit": 10**9, "m_code_limit": 10**9}},
        {"compensation": {"read_ahead": 10**9}},
        {"polar": {"virtual_axis_incremental": ""}},
    ],
)
def test_limits_as_high_as_they_go(changes: dict[str, Any]) -> None:
    macro = "O1\n#1=[1+2]\nG65 P2 A1.\nM30\nO2\nWHILE[#1 LT 3]DO1\n#1=#1+1\nEND1\nM99\n"
    assert not report_of(macro, changes=changes).findings
    assert not report_of(GOOD, changes=changes, only=["polar"]).findings


def test_a_machine_of_its_own_that_asks_for_what_there_is_not() -> None:
    make(own__toml="inherits = 'fanuc'\n[known_parameters.x]\ntitle = 'x'\nkey = 'gone.key'\nfactor = 0\n")
    assert call("machines", "new", "NL", "--from", "own.toml").exit_code == 0
    assert machine_of("NL.toml")


# ---- offset tables ----


def table(text: str) -> dict[str, float]:
    Path("offsets.txt").write_bytes(text.encode())
    return {
        number: tool.radius
        for number, tool in offset_table.read_offset_table(Path("offsets.txt"), "offsets.txt").items()
    }


@looped(
    "text",
    [
        "%\nG10 P10001 X0 Z0 R1. Q0\nG10 P10002 X0 Z0 R2. Q3\n%\n",
        "G10P10001R1.\r\nG10P10002R2.\r\n",
        "G10P10001R1.\n\r\rG10P10002R2.\n\r\r",
        "G10P10001R1.\rG10P10002R2.\r",
        "G10P10001R1.;G10P10002R2.;",
        "G10P10001R1.G10P10002R2.",
        "G10P1R1.\nG10 P2 R1.5\nG10 P10002 R.5",
    ],
)
def test_each_block_is_an_offset_of_its_own(text: str) -> None:
    assert table(text) == {"1": 1, "2": 2}


@pytest.mark.one_in(11)
@pytest.mark.parametrize(
    ("text", "told"),
    [
        (f"G10 P10001 R{NINES}", "offset 1: radius: expected a number from -1000 to 1000, found inf"),
        (f"G10 P10001 Q{NINES}", "offset 1: nose: expected a whole number from 0 to 9, found inf"),
        (f"G10 P10001 R-{NINES} R{NINES}", "offset 1: radius: expected a number from -1000 to 1000, found inf"),
        (f"G10 P{NINES} R1.", "P99999999"),
        (f"G10 P{'0' * 5000}1 R-1001.", "offset 1: radius: expected a number from -1000 to 1000, found -1001"),
        ("G10 P10001" + " " * 3_000_000, "no offsets found"),
        ("G10 " * 500_000, "offsets.txt:1: P, the number of the offset, is missing: G10"),
        ("G10 P1" + "A" * 3_000_000, "no offsets found"),
        (f"G10 L{NINES} P1 R1.", "offsets.txt:1: L is known of"),
        ("x" * 16_000_001, "larger than 16 MB; no offset table is"),
        ("G10 P10001 R1." + " " * 50_000_000, "larger than 16 MB; no offset table is"),
    ],
)
def test_an_offset_table_that_nobody_means(text: str, told: str) -> None:
    make(offsets__txt=text)
    assert told in refusal("check", "a.nc", "--offsets", "offsets.txt")


# ---- the command line ----


@looped(
    "arguments",
    [
        ["check", "a.nc", "--tool", f"1:radius={NINES}"],
        ["check", "a.nc", "--tool", f"{NINES}:radius=5"],
        ["check", "a.nc", "--tool", f"T{NINES}:radius=5"],
        ["check", "a.nc", "--tool", f"1:nose={NINES}"],
        ["check", "a.nc", "--tool", "1:radius=1e308"],
        ["check", "a.nc", "--set", f"limits.c_feed={NINES}"],
        ["check", "a.nc", "--set", f"limits.c_feed={'9' * 400}"],
        ["check", "a.nc", "--set", f"limits.c_feed={'[' * 50_000}"],
        ["check", "a.nc", "--set", f"control.x=1\n{'a.' * 30_000}a = 1"],
        ["check", "a.nc", "--set", f"{'a.' * 50_000}a=1"],
        ["check", "a.nc", "--select", f"PS{NINES}"],
        ["check", "a.nc", "--ignore", NINES],
        ["check", "a.nc", "--severity", f"{NINES}=off"],
        ["explain", NINES],
    ],
)
def test_numbers_without_end_on_the_command_line(arguments: list[str]) -> None:
    option = arguments[2] if len(arguments) > 2 else "unknown rule"
    assert option in refusal(*arguments)


@pytest.mark.ci
@looped(
    "option",
    [
        *(
            "--machine",
            "--set",
            "--tool",
            "--offsets",
            "--units",
            "--select",
            "--ignore",
            "--severity",
            "--format",
            "-o",
        ),
        *("--encoding", "--block-skip", "--subprograms", "--config", "--max-blocks", "--max-seconds", "--fail-on"),
        *("--color", "command", "path", "explain", "machines", "new", "trace", "schema", "option"),
    ],
    one_in=3,
)
@looped("word", ["9" * 100_000, "json:limits.c_feed=" + "x" * 100_000])
def test_arguments_without_end(option: str, word: str) -> None:
    """What is wrong with them is said in a line that one can read."""
    others = {"command": [word], "path": ["check", word], "explain": ["explain", word], "machines": ["machines", word],
              "new": ["machines", "new", word], "trace": ["trace", word], "schema": ["schema", word],
              "option": ["check", "a.nc", f"--{word}"]}  # fmt: skip
    result = call(*others.get(option, ["check", "a.nc", option, word]))
    assert result.exit_code == 2
    assert result.stderr.count("\n") == 1
    assert len(result.stderr) < 1100


def test_the_end_of_a_line_without_end_is_shown() -> None:
    assert refusal("check", "a.nc", "--machine", LONG).endswith("`polarcheck machines` lists them\n")


def test_alarms_are_found_with_leading_zeros() -> None:
    assert call("explain", "0" * 100 + "146").exit_code == 0
    assert call("explain", "PS0146").exit_code == 0


def test_the_built_in_machines_are_within_all_limits() -> None:
    for name in profiles.names():
        text = (profiles.FOLDER / f"{name}.toml").read_text("utf-8")
        assert toml_text.parsed(text)
        assert len(text) < toml_text.LARGEST / 10
