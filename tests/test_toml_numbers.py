"""Numbers as people write them into a job file or a machine file, and what is said of those that TOML does not read."""

from __future__ import annotations

import pytest
from cases import looped

from polarcheck.files.settings.of_programs import toml_value
from polarcheck.foundation.errors import JobError, UsageError
from polarcheck.program.machines.job import Job, from_table, with_tool
from polarcheck.program.machines.toml_text import parsed


@pytest.mark.ci
@looped(
    ("line", "hint"),
    [
        ("radius = .1875", "write 0.1875"),
        ("radius = 4.", "write 4.0"),
        ("radius = 3/16", "write 0.1875"),
        ("radius = -.5 # wear", "write -0.5"),
        ("radius = 1 3/16", "write 1.1875"),
        ("radius = 1-3/16", "write 1.1875"),
        ("radius = 3 / 16", "write 0.1875"),
        ('radius = 3/16"', 'write 0.1875, without "'),
        ("radius = 4.5 mm", "write 4.5, without mm"),
        ("radius = 4mm", "write 4, without mm"),
        ("c_feed = 3600 deg/min", "write 3600, without deg/min"),
        ("radius = 08", "write 8"),
        ("a = { radius = .5, nose = 0 }", "write 0.5"),
        ("a = [1.5, 4., 3]", "write 4.0"),
        ("radius = 1,5", "write 1.5, with a decimal point"),
        ("radius = M35", 'write "M35", in quotes'),
        ("radius = +.5", "write 0.5"),
        ("radius = 1000.", "write 1000.0"),
        ("radius = 5/8 in", "write 0.625, without in"),
        ('radius = 1 1/2"', 'write 1.5, without "'),
        ("radius = 1/2''", "write 0.5, without ''"),
        ("radius = 1/2”", "write 0.5, without ”"),
        ("radius = 0,5mm", "write 0.5, with a decimal point and without mm"),
        ("radius = ,5 # wear", "write 0.5, with a decimal point"),
        ('radius = 0,5"', 'write 0.5, with a decimal point and without "'),
        ("angle = 30°", "write 30, without °"),
    ],
)
def test_the_message_says_what_to_write(line: str, hint: str) -> None:
    with pytest.raises(ValueError, match="at line 2") as caught:
        parsed(f"[tools.8]\n{line}\n")
    assert str(caught.value).endswith(f"; {hint}")


@looped(
    ("text", "key"),
    [("[tools.8]\nradius = 8.0\n[tools.8]\n", "tools.8"), ("[tools.8]\nradius = 8.0\nradius = 7.0\n", "radius")],
)
def test_what_stands_twice_is_named(text: str, key: str) -> None:
    with pytest.raises(ValueError, match="at line 3") as caught:
        parsed(text)
    assert str(caught.value).endswith(f"; {key} stands above, too: keep one of both")


@looped(
    ("table", "hint"),
    [
        ({"run": {"subprograms": "subs"}}, "found 'subs'; write [\"subs\"]"),
        ({"exclude": "a\\*"}, "found 'a\\\\*'; write ['a\\*']"),
        ({"programs": {"files": ["O12*"]}}, "found a table; write [[programs]]"),
        ({"stock": {"diameter": 60.0, "hexagon": 40.0}}, "polarcheck.toml: stock: give diameter or hexagon, not both"),
    ],
)
def test_of_other_values_the_form_is_named(table: dict[str, object], hint: str) -> None:
    with pytest.raises(JobError) as caught:
        from_table(table, "polarcheck.toml")
    assert str(caught.value).endswith(hint)


@looped("line", ["radius = 3/0", "radius = 4 ..", "radius = .", "radius = 1.5 x", "radius = 1,234.5"])
def test_of_what_is_no_number_nothing_is_said(line: str) -> None:
    with pytest.raises(ValueError, match="at line 2") as caught:
        parsed(f"[tools.8]\n{line}\n")
    assert "write" not in str(caught.value)


@looped(
    ("value", "hint"),
    [
        ("3/16", "write 0.1875"),
        ("8mm", "write 8, without mm"),
        (".5", "write 0.5"),
        ("4.", "write 4.0"),
        ("0,5", "write 0.5, with a decimal point"),
        ("0,5 mm", "write 0.5, with a decimal point and without mm"),
        ("4.5", "write 4.5, without quotes"),
    ],
)
def test_so_does_that_of_a_text_in_quotes(value: str, hint: str) -> None:
    with pytest.raises(JobError) as caught:
        from_table({"tools": {"8": {"radius": value}}}, "polarcheck.toml")
    assert str(caught.value).endswith(f"found {value!r}; {hint}")


@looped(("value", "hint"), [("3/16", "write 0.1875"), ("8mm", "write 8, without mm"), ('1/2"', 'write 0.5, without "')])
def test_so_does_that_of_an_option(value: str, hint: str) -> None:
    with pytest.raises(UsageError) as caught:
        with_tool(Job(), f"8:radius={value}")
    assert str(caught.value).endswith(f"found {value!r}; {hint}")


@looped("value", ["big", "8 x", "3/0", ""])
def test_of_other_texts_nothing_is_said(value: str) -> None:
    with pytest.raises(JobError) as caught:
        from_table({"tools": {"8": {"radius": value}}}, "polarcheck.toml")
    assert str(caught.value).endswith(f"found {value!r}")


@looped(("text", "value"), [(".5", 0.5), ("4.", 4.0), ("-.25", -0.25), ("4", 4), ("3/16", "3/16"), (".", ".")])
def test_an_option_takes_short_numbers(text: str, value: object) -> None:
    assert toml_value(text) == value
