"""The values of findings are a contract: names, units, and numbers that are numbers."""

from __future__ import annotations

import functools
import json
import math
import string
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from cases import looped
from click.testing import CliRunner
from polarcheck.errors import RuleError
from programs import report_of, report_of_whole_example

from polarcheck.commands import main
from polarcheck.foundation.finding import Finding
from polarcheck.rules.examples import examples
from polarcheck.rules.message import as_data
from polarcheck.rules.rule import Rule, load_all
from polarcheck.rules.vocabulary import VOCABULARY, Kind, kinds

RULES = load_all()
TYPES: dict[Kind, tuple[type, ...]] = {
    Kind.TEXT: (str,),
    Kind.OFFSET: (int, str),
    Kind.COUNT: (int,),
    Kind.LINE: (int,),
    Kind.NUMBER: (int,),
}


def with_following(findings: list[Finding]) -> Iterator[Finding]:
    for finding in findings:
        yield finding
        yield from with_following(finding.follows)


@functools.cache
def values_in_examples(name: str) -> list[dict[str, Any]]:
    """The values of what a rule finds in its Bad examples."""
    bad = [example for example in examples(RULES[name].page) if not example.good]
    found = [one for example in bad for one in with_following(report_of_whole_example(example).findings)]
    return [one.values for one in found if one.rule == name]


@pytest.mark.ci
@looped("rule", RULES.values(), ids=list(RULES), one_in=96)
def test_each_value_of_a_rule_is_of_its_kind_and_seen_in_its_examples(rule: Rule) -> None:
    declared, shown = kinds(rule.values, rule.name), values_in_examples(rule.name)
    assert {name for one in shown for name in one} == declared.keys()
    for name, value in (pair for one in shown for pair in one.items()):
        assert type(value) in TYPES.get(declared[name], (float,)), (name, value)
        assert value not in ("", math.inf)


def test_each_name_is_of_a_rule_and_its_text_is_plain() -> None:
    assert {name for rule in RULES.values() for name in rule.values} == VOCABULARY.keys()
    assert len({meaning.text for meaning in VOCABULARY.values()}) == len(VOCABULARY)


def test_a_number_that_a_message_shows_is_a_value() -> None:
    """What a message shows in a format never stands in it alone; texts of it do."""
    for rule in RULES.values():
        shown = {name for _, name, form, _ in string.Formatter().parse(rule.message) if form}
        assert shown - {*rule.values} == _BY_ANOTHER_VALUE.get(rule.name, set()), rule.name


#: Numbers that are a value without their sign, rounded down as the message has them, or by another name.
_BY_ANOTHER_VALUE = {
    "inside-arc-smaller-than-radius": {"signed_radius"},
    "no-offset-intersection": {"signed_radius"},
    "plunge-at-positioning-feed": {"other_feed"},
    "blocks-faster-than-control": {"feed_of_series"},
    "c-acceleration-above-limit": {"allowed"},
    "x-acceleration-above-limit": {"allowed"},
}


def test_a_limit_has_the_kind_of_the_number_before_it() -> None:
    assert kinds(["c_feed", "code", "limit"])["limit"] is Kind.RATE
    assert kinds(["word", "limit"])["limit"] is Kind.COUNT
    with pytest.raises(RuleError, match="rule rapid-in-polar: speeds is no name"):
        kinds(["speeds"], "rapid-in-polar")


@looped(
    ("value", "kind", "data"),
    [
        (np.float64(1 / 3), Kind.LENGTH, 0.333333),
        (-0.0, Kind.LENGTH, 0.0),
        (np.int64(8), Kind.OFFSET, 8),
        ("MILL_8/1", Kind.OFFSET, "MILL_8/1"),
        (2.0, Kind.COUNT, 2),
        (math.nan, Kind.COUNT, None),
        (math.inf, Kind.LENGTH, None),
        (None, Kind.LINE, None),
        ("", Kind.TEXT, None),
    ],
)
def test_what_is_not_known_is_left_out(value: Any, kind: Kind, data: object) -> None:
    found = as_data(value, kind)
    assert (found, type(found)) == (data, type(data))


FAST = """G98 G0 X60. C0
G12.1
G1 X4. C5. F100
C-5. F500
G13.1
"""
INCH = """G20 G98 G0 X2.4 C0
G12.1
G1 X.16 C.2 F4.
C-.2 F20.
G13.1
"""


@looped(("program", "feed", "nearest"), [(FAST, 500.0, 2.0), (INCH, 508.0, 2.032)])
def test_c_feed_limit_and_highest_feed_are_numbers_in_mm_and_deg(program: str, feed: float, nearest: float) -> None:
    (found,) = report_of(program, changes={"limits": {"c_feed": 3600}}, only=["c-feed-above-limit"]).findings
    values = found.values
    assert values["c_feed"] == pytest.approx(math.degrees(feed / nearest))
    assert (values["limit"], values["feed"], values["nearest"]) == (3600.0, feed, nearest)
    allowed = 3600 * math.radians(nearest)
    assert 0.98 * allowed < values["highest_feed"] < allowed


def test_the_highest_feed_is_one_that_the_rule_takes() -> None:
    limits = {"limits": {"c_feed": 3600}}
    (found,) = report_of(FAST, changes=limits, only=["c-feed-above-limit"]).findings
    assert not report_of(FAST.replace("F500", f"F{found.values['highest_feed']}"), changes=limits).findings


def test_without_a_limit_there_is_none_in_the_values() -> None:
    (found,) = report_of(FAST.replace("F500", "F50000"), only=["c-feed-above-limit"]).findings
    assert found.values.keys() == {"c_feed", "feed", "nearest"}


# ---- the machine is its id, its file stands beside it ----


def shown(*arguments: str) -> Any:
    return json.loads(CliRunner().invoke(main, arguments, catch_exceptions=False).stdout)


@pytest.mark.nightly
@pytest.mark.parametrize(
    ("machine", "named"), [("fanuc-30i", ("fanuc-30i", None)), ("lathes/nl2000.toml", ("nl2000", "lathes/nl2000.toml"))]
)
def test_the_machine_is_its_id_in_every_report(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, machine: str, named: tuple[str, str | None]
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("lathes").mkdir()
    Path("lathes/nl2000.toml").write_text("inherits = 'fanuc-30i'\ntitle = 'Our NL 2000'\n", "utf-8")
    Path("a.nc").write_text(FAST.replace("C-5. F500", "G0 C-5."), "utf-8")
    options = ("a.nc", "--no-config", "--machine", machine, "--format")
    report, part = shown("check", *options, "json"), shown("part", *options, "json")
    for file in (*report["files"], *part["files"]):
        assert (file["machine"], file.get("machine_file")) == named
    (run,) = shown("check", *options, "sarif")["runs"]
    assert {one["properties"]["machine"] for one in (run, *run["results"])} == {named[0]}
    in_others = (
        report["machine"],
        shown("feeds", *options, "json")["machine"],
        shown("trace", *options, "json")["machine"],
    )
    assert in_others == (named[0],) * 3


def test_two_machine_files_of_one_name_are_two_machines(tmp_path: Path) -> None:
    for folder in ("a", "b"):
        (tmp_path / folder).mkdir()
        (tmp_path / folder / "lathe.toml").write_text("inherits = 'fanuc'\n", "utf-8")
        (tmp_path / folder / "polarcheck.toml").write_text("machine = 'lathe.toml'\n", "utf-8")
        (tmp_path / folder / "o.nc").write_text(FAST, "utf-8")
    report = shown("check", str(tmp_path), "--format", "json")
    assert report["machine"] is None
    assert [file["machine"] for file in report["files"]] == ["lathe", "lathe"]
    assert len({file["machine_file"] for file in report["files"]}) == 2
