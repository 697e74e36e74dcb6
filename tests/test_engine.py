"""The engine: tables handed over by name, and what rules return made into findings."""

from __future__ import annotations

import ast
import inspect
import re
import string
import textwrap
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import msgspec
import numpy as np
import pytest
from cases import looped
from polarcheck.errors import RuleError, TooHardError
from programs import machine_of, report_of, said, tables_of, tables_of_example

from polarcheck.checking.engine import LISTED, Engine
from polarcheck.columns.words.allow_comments import Allows
from polarcheck.foundation.finding import ERROR, NOTE, WARNING, Finding
from polarcheck.foundation.time_limit import keep_time, time_limit
from polarcheck.rules import rule as rule_module
from polarcheck.rules import tables
from polarcheck.rules.examples import Example, examples
from polarcheck.rules.hit import Hit
from polarcheck.rules.other_machine import OtherMachine
from polarcheck.rules.rule import Hits, Rule, graded, load_all, rule, rule_files
from polarcheck.rules.tables import (
    ARC,
    BAR,
    C_ACCELERATION,
    COMMENT,
    OF_CAUSE,
    OF_TEXT,
    PART,
    SECTION,
    SPANS,
    TABLES,
    X_ACCELERATION,
    Tables,
)

RULES = load_all()
#: Two sections, one begun by G112 and never left; a program of inch words before one in mm.
PROGRAM = """O1
G20 G98 T0101
G0 X2. C0
G12.1
G1 X1. F4
C.5
G13.1
M30
O2
G21 G98 T0101
G0 X60. C0
G112
G1 X40. F100
C5. M8
M30
"""


@pytest.fixture
def made() -> Tables:
    found = tables_of(PROGRAM)
    found.give("other_machine", OtherMachine(found))
    allows = Allows(found["text"], {rule.name: rule.group for rule in RULES.values()})
    found.give("allows", allows)
    found.give("unused_allows", allows.unused((), RULES))
    return found


def made_rule(function: Any, **options: Any) -> Rule:
    """A rule of a function, as a file under rules/polar would hold it."""
    function.__module__ = "polarcheck.rules.polar.test"
    options = {"severity": WARNING, "message": "here", **options}
    return rule(options.pop("severity"), options.pop("message"), **options)(function)


def findings(made: Tables, function: Any, details: Any = None, *others: Rule, **options: Any) -> list[Finding]:
    """What a rule of this function finds, with these details; others: rules that it may follow from."""
    one = made_rule(function, **options)
    if details:
        one = msgspec.structs.replace(one, companion={"details": details}.get)
    return [found for found in Engine(made, {}, [one, *others]).findings() if found.rule == one.name]


# ---- tables ----


def test_each_table_is_made_once_from_those_that_it_names(made: Tables) -> None:
    assert made["tool_center"] is made["tool_center"]
    assert made["tool_center"].trace is made["trace"]
    assert made["sections"] is made["trace"].mode.sections
    assert made["moves"] is made["tool_center"].moves
    assert made.arcs is made["arcs"]
    assert set(TABLES) <= set(made)


def test_a_table_that_nobody_makes_is_named_with_those_there_are(made: Tables) -> None:
    with pytest.raises(RuleError, match=r"there is no table 'trase'; tables are .*trace"):
        made["trase"]


def test_tables_of_the_text_are_made_of_nothing_that_runs() -> None:
    """What OF_TEXT names must hang on text, machine and job alone, and everything that does must be in it."""
    needed = {name: tables.parameters(maker.function) for name, maker in TABLES.items()}
    of_text = {"text", "words", "machine", "job"}
    while more := {name for name, parameters in needed.items() if set(parameters) <= of_text} - of_text:
        of_text |= more
    assert of_text == OF_TEXT


@pytest.mark.parametrize("one", RULES.values(), ids=list(RULES))
def test_every_name_of_a_rule_stands_for_something(one: Rule, made: Tables) -> None:
    needs = one.companion("needs")
    if needs:
        where, columns = tables.called(needs, made, {})
        assert {len(column) for column in (where, *columns.values())} == {len(made["trace"])}
    assert {name for names in one.follows.values() for name in names} <= set(RULES)
    for span in (*one.follows, one.once or "block"):
        column = SPANS[span]
        assert column is None or len(column(made)) == len(made["trace"])
    assert all(made["machine"].codes(name) for name in one.at if name.islower() and name not in ("on", "off"))
    handed, given = {*one.hits(made).values, *vars(Hit), "count"}, details_of(one)
    for function in filter(None, map(one.companion, ("details", "needs"))):
        assert {*tables.parameters(function)} <= {*made, "hit"}
    fields = {
        (name, (form or "").partition("/")[2]) for _, name, form, _ in string.Formatter().parse(one.message) if name
    }
    named = {*one.values, *(name for names in fields for name in names if name)}
    assert given <= named, "nobody needs them"
    assert {name for name in named - handed - given if not (len(name) == 1 and name.isupper())} == set()


def details_of(one: Rule) -> set[str]:
    """The names that the details of a rule have: a function returns a dict with each of them."""
    details = one.companion("details")
    if details is None:
        return set()
    (function,) = ast.parse(inspect.getsource(details)).body
    returned = [node.value for node in ast.walk(function) if isinstance(node, ast.Return)]
    (names,) = {
        tuple(ast.literal_eval(key) for key in value.keys if key) for value in returned if isinstance(value, ast.Dict)
    }
    assert all(isinstance(value, ast.Dict) for value in returned)
    return {*names}


# ---- what rules return ----


@pytest.mark.parametrize("one", RULES.values(), ids=list(RULES))
def test_a_rule_returns_a_mask_over_what_it_says(one: Rule, made: Tables) -> None:
    hits = one.hits(made)
    assert hits.mask.dtype == bool
    assert hits.at is None or len(hits.at) == len(made["trace"].run.words)
    for name, value in hits.values.items():
        assert isinstance(value, str | int | float) or len(value) == len(hits.mask), name
        assert not callable(value), name


def compares(function: ast.FunctionDef) -> bool:
    """Whether a rule compares columns: <, ==, &, |, ~ and their like in its body."""
    operators = (ast.BitAnd, ast.BitOr, ast.BitXor)
    return any(
        isinstance(node, ast.Compare)
        or (isinstance(node, ast.BinOp) and isinstance(node.op, operators))
        or (isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.Invert))
        for statement in function.body
        for node in ast.walk(statement)
    )


def test_rules_are_compiled_once_and_anew_when_one_has_changed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(rule_module, "__file__", str(tmp_path / "rule.py"))
    monkeypatch.setattr("sys.dont_write_bytecode", False)
    paths = [str(tmp_path / name) for name in ("first.py", "second.py")]

    def loaded() -> list[str]:
        return [code.co_consts[0] for code in rule_module._codes(paths)]

    for path in map(Path, paths):
        path.write_text(f"name = '{path.stem}'\n")
    assert loaded() == ["first", "second"]
    with monkeypatch.context() as patch:
        patch.setattr(rule_module, "_compiled", lambda path: pytest.fail("compiled again"))
        assert loaded() == ["first", "second"]
    Path(paths[1]).write_text("name = 'another'\n")
    assert loaded() == ["first", "another"]
    (kept,) = tmp_path.rglob("*.kept")
    kept.write_bytes(kept.read_bytes()[:-3])
    assert loaded() == ["first", "another"]


@looped("path", [*map(Path, rule_files())], ids=lambda path: path.stem)
def test_each_rule_compares_or_says_why_not(path: Path) -> None:
    text = path.read_text("utf-8")
    functions = (node for node in ast.parse(text).body if isinstance(node, ast.FunctionDef))
    (function,) = (node for node in functions if node.name == path.stem)
    says_why = "    # Compares nothing: " in text
    assert compares(function) != says_why


def test_a_rule_that_only_returns_a_column_is_found_out() -> None:
    def passes_on(trace: Any) -> Any:
        return trace.mode.in_polar

    def compared(trace: Any) -> Any:
        return trace.mode.in_polar & trace.path.cuts

    for function, expected in ((passes_on, False), (compared, True)):
        (found,) = ast.parse(textwrap.dedent(inspect.getsource(function))).body
        assert isinstance(found, ast.FunctionDef)
        assert compares(found) == expected


def test_the_highest_severity_counts_where_several_hold() -> None:
    yes, no = np.array([True, True, False, False]), np.array([True, False, True, False])
    hits = graded(error=no, note=yes)
    assert hits.mask.tolist() == [True, True, True, False]
    assert hits.severity is not None
    assert hits.severity.tolist() == [ERROR, NOTE, ERROR, 0]  # type: ignore[union-attr]


def test_severities_of_a_rule_of_all_or_of_each() -> None:
    made = tables_of(PROGRAM)

    def own(trace: Any) -> Any:
        return trace.mode.enters

    def of_all(trace: Any) -> Any:
        return Hits(trace.mode.enters, NOTE)

    def of_each(trace: Any) -> Any:
        return graded(error=trace.blocks.codes("G12.1"), warning=trace.mode.enters)

    for function, expected in ((own, ["warning"] * 2), (of_all, ["note"] * 2), (of_each, ["error", "warning"])):
        assert [found.severity for found in findings(made, function)] == expected


def test_words_at_fault_by_mask_and_by_name() -> None:
    made = tables_of(PROGRAM)

    def by_mask(trace: Any) -> Any:
        return Hits(trace.blocks.codes("M8"), at=trace.blocks.words_at(trace.blocks.word_indices("C")))

    def by_name(trace: Any) -> Any:
        return trace.blocks.codes("M8")

    for function, options, columns in (
        (by_mask, {}, (1, 4)),
        (by_name, {"at": ("M",)}, (5, 7)),
        (by_name, {"at": ("C", "M")}, (1, 7)),
        (by_name, {"at": ("X",)}, (1, 7)),
        (by_name, {}, (1, 7)),
    ):
        (found,) = findings(made, function, **options)
        assert (found.line, found.column, found.end_column) == (14, *columns)


# ---- messages ----


@looped(
    ("text", "expected", "values", "data"),
    [
        ("F {feed:feed}", ["F 4 inch/min", "F 100 mm/min"], ("feed",), [101.6, 100.0]),
        ("{x:diameter}", ["1 inch", "40 mm"], ("x",), [12.7, 20.0]),
        ("{X} {F}", ["X1. F4", "X40. F100"], ("word",), ["X1.", "X40."]),
        ("{title}", ["FANUC lathe control"] * 2, ("limit",), [3, 3]),
        ("{depth:length}", ["0.0394 inch", "1 mm"], ("depth",), [1.0, 1.0]),
    ],
)
def test_names_in_a_message(text: str, expected: list[str], values: tuple[str, ...], data: list[Any]) -> None:
    def first_cut(trace: Any) -> Any:
        return Hits(trace.mode.first_in_section(trace.path.cuts), values={"depth": 1.0})

    def details(hit: Hit, feedrate: Any, path: Any, machine: Any) -> dict[str, Any]:
        limit = machine.macro.loop_numbers
        return {"feed": feedrate.feed[hit.row], "x": path.x[hit.row], "word": hit.written("X"), "limit": limit}

    found = findings(tables_of(PROGRAM), first_cut, details, message=text, values=values)
    assert [one.message for one in found] == expected
    assert [one.values for one in found] == [{values[0]: value} for value in data]


def test_a_name_that_stands_for_nothing_is_a_fault_of_the_rule() -> None:
    def entered(trace: Any) -> Any:
        return trace.mode.enters

    with pytest.raises(RuleError, match="nowhere in a message of entered"):
        findings(tables_of(PROGRAM), entered, message="{nowhere}")


def test_a_phrase_of_a_section_knows_its_row_and_its_index() -> None:
    """A rule over sections was handed the number of the section as a row: of a G112 it said G12.1."""

    (missing,) = [one for one in report_of(PROGRAM).findings if one.rule == "polar-never-left"]
    assert missing.message == "polar mode is never left: G113 is missing before line 15, M30"


# ---- one finding per place ----


def x_words(words: Any) -> Any:
    return words.address == ord("X")


def has_y(trace: Any) -> Any:
    return trace.blocks.has("Y")


def only_sections(sections: Any) -> Any:
    return sections.left


def test_a_finding_follows_whatever_its_rule_and_the_cause_are_over() -> None:
    made = tables_of("G21\n" * 3 + "G1 X1. Y1. Z1. U1. W1. H1.\nG1 X2.\n" + "G4 X1.\n" * 5)
    causes = made_rule(has_y), made_rule(only_sections, over="sections")
    follows = {"block": ("has-y", "only-sections")}
    found = Engine(made, {}, [made_rule(x_words, over="words", follows=follows), *causes]).findings()
    assert [(one.rule, one.line) for one in found] == [
        *(("x-words", line) for line in (5, 6, 7, 8, 9, 10)),
        ("has-y", 4),
    ]
    assert [(one.rule, one.line) for one in found[-1].follows] == [("x-words", 4)]


def test_a_finding_follows_only_a_cause_that_is_reported() -> None:
    made = tables_of("G1 X1. Y1.\n")
    (found,) = findings(made, x_words, over="words", follows={"block": ("has-y",)})
    assert (found.line, found.follows) == (1, [])


def test_the_cause_is_as_severe_as_the_worst_that_follows() -> None:
    made = tables_of("G1 X1. Y1.\nG1 X1.\n")
    cause = made_rule(has_y, severity=NOTE)
    effect = made_rule(x_words, severity=ERROR, over="words", follows={"block": ("has-y",)})
    alone, raised = Engine(made, {}, [effect, cause]).findings()
    assert (alone.rule, alone.line, alone.severity) == ("x-words", 2, "error")
    assert (raised.rule, raised.severity, [one.severity for one in raised.follows]) == ("has-y", "error", ["error"])


def test_what_nobody_can_decide_fails_no_file_whatever_its_severity() -> None:
    alone = "O1\nG98 G0 X60. C0\nG112\nG0 X70.\nM30\n"
    followed = alone.replace("G0 X70.", "G1 X40. F200\nY5.\nG113")
    for level in ("warning", "error"):
        given = {"severities": {"polar-code-of-another-control": level}}
        assert report_of(alone, "okuma-osp", job=given).verdict == "unverified"
        assert report_of(followed, "okuma-osp", job=given).verdict == "fail"


@pytest.mark.ci
def test_a_section_of_both_runs_is_one_with_the_worst_of_each() -> None:
    program = "O1\nG21 G98 T0101\nG0 X60. C0\nG12.1\nG1 X40. C5. F300\n{}\nX60. C0\nG13.1\nM30\n"
    run, skipped = (report_of(program.format(text)).polar_sections[0] for text in ("X-40.", "N1"))
    (both,) = report_of(program.format("/X-40.")).polar_sections
    assert both.nearest == min(run.nearest or 0, skipped.nearest or 0) < max(run.nearest or 0, skipped.nearest or 0)
    assert (both.c_feed, both.c_feed_line) == (run.c_feed, 7)
    assert both.time == max(run.time or 0, skipped.time or 0)


def test_a_chain_of_causes_ends_at_its_first() -> None:
    """What follows from a finding that follows itself is listed under the one that stands alone."""

    def has_u(trace: Any) -> Any:
        return trace.blocks.has("U")

    made = tables_of("G1 X1. Y1. U1.\n")
    chain = [
        made_rule(x_words, over="words", follows={"block": ("has-y",)}),
        made_rule(has_y, follows={"program": ("has-u",)}),
        made_rule(has_u),
    ]
    (found,) = Engine(made, {}, chain).findings()
    assert (found.rule, [one.rule for one in found.follows]) == ("has-u", ["has-y", "x-words"])


def test_a_cause_reaches_to_the_end_of_its_section_and_no_further() -> None:
    made = tables_of(PROGRAM)

    def begins(trace: Any) -> Any:
        return trace.mode.enters & (trace.blocks.program == 0)

    def has_c(trace: Any) -> Any:
        return trace.blocks.has("C") & (trace.mode.in_polar | trace.mode.leaves)

    cause, effect = made_rule(begins), made_rule(has_c, follows={"section": ("begins",)})
    found = Engine(made, {}, [cause, effect]).findings()
    assert [(one.rule, one.line) for one in found] == [("begins", 4), ("has-c", 14)]
    assert [one.line for one in found[0].follows] == [6]


def test_causes_go_round_in_no_circle() -> None:
    # What follows from a row above follows from no row below, so that no circle can close.
    edges = {
        name: {cause for span, names in one.causes(RULES).items() for cause in names if span not in OF_CAUSE}
        for name, one in RULES.items()
    }
    while leaves := {name for name, causes in edges.items() if not causes & set(edges)}:
        edges = {name: causes for name, causes in edges.items() if name not in leaves}
    assert not edges


def test_a_block_that_ran_often_is_one_finding_at_its_worst_run() -> None:
    made = tables_of("O1\n#1=0\nWHILE[#1LT3]DO1\nG1 X#1 F1\n#1=#1+1\nEND1\nM30\n")

    def has_x(trace: Any) -> Any:
        return trace.blocks.has("X")

    def farthest(trace: Any) -> Any:
        return Hits(trace.blocks.has("X"), worst=trace.path.x)

    def x_there(hit: Hit) -> dict[str, Any]:
        return {"x": hit.trace.path.x[hit.row]}

    (found,) = findings(made, farthest, x_there, message="{x:.1f}")
    assert (found.count, found.message) == (3, "1.0")
    (first,) = findings(made, has_x, x_there, message="{x:.1f}")
    assert (first.count, first.message) == (3, "0.0")


# ---- the text once, the runs each ----


@pytest.mark.ci
def test_what_hangs_on_the_text_alone_is_looked_for_once(monkeypatch: pytest.MonkeyPatch) -> None:
    program = "O1\nG21 G98 T0101\n/G0 X60. C0 X61.\nG12.1\nG1 X40. F100\nG0 X50.\nG13.1\nM30\n"
    seen: list[str] = []
    hits = Rule.hits

    def counted(one: Rule, made: Any) -> Hits:
        # A program with an edit is another one.
        seen.extend([one.name] if made["trace"].text.source.data == program.encode() else [])
        return hits(one, made)

    monkeypatch.setattr(Rule, "hits", counted)
    report = report_of(program)
    assert {seen.count(name) for name, one in RULES.items() if one.of_text} == {1}
    assert seen.count("rapid-in-polar") == 2
    assert said(report)[:2] == [(3, "word-repeated"), (4, "x-unknown-at-entry")]
    told = {found.rule: "(with block skip on)" in found.message for found in report.findings}
    assert told["x-unknown-at-entry"]
    assert not told["word-repeated"]
    assert not told["rapid-in-polar"]


def test_each_rule_is_asked_once(monkeypatch: pytest.MonkeyPatch) -> None:
    order: list[str] = []
    hits = Rule.hits

    def noted(one: Rule, made: Any) -> Hits:
        order.append(one.name)
        return hits(one, made)

    monkeypatch.setattr(Rule, "hits", noted)
    section = "G98 G0 X60. C0\nG12.1\nG1 X40. F100\nG3 X20. C0 R30.\nG13.1\n"
    limits = {"limits": {"c_acceleration": 500.0, "x_acceleration": 50.0}}
    job = {"part": [{"shape": "square", "across_flats": 40.0}], "stock": {"diameter": 60.0}}
    report_of(f"(SECTIONS WITH AN ARC)\n{section}{section}#1=1/0\n", changes=limits, job=job)
    off = {name for name, rule in RULES.items() if rule.level(machine_of().severities) == "off"}
    of_allows = {name for name, rule in RULES.items() if rule.group == "silence"}
    assert sorted(order) == sorted(set(RULES) - off - of_allows)


def test_advice_is_given_where_somebody_names_its_severity() -> None:
    program = "G98 G0 X60. C0\nG12.1\nG1 X40. F100\nC10.\nX-40.\nG13.1\n"
    for severities, expected in (({}, []), ({"no-compensation-in-polar": "warning"}, ["warning"])):
        own = msgspec.structs.replace(machine_of(), severities=severities)
        found = [one.severity for one in report_of(program, own).findings if one.rule == "no-compensation-in-polar"]
        assert found == expected
    assert sorted(one.name for one in RULES.values() if one.is_advice) == [
        "no-compensation-in-polar", "size-by-x-offset", "start-up-without-move", "turning-feed-not-restored",
    ]  # fmt: skip


def test_a_rule_names_what_it_is_over() -> None:
    with pytest.raises(RuleError, match="expected one of rows, words"):
        made_rule(lambda trace: trace.mode.in_polar, over="moves")


def test_functions_take_what_they_name_and_nothing_else() -> None:
    def phrase(trace: Any, row: int) -> str:
        return f"{trace.name} {row}"

    given = {"row": 3, "index": 5, "at": [], "place": None}
    assert tables.called(phrase, {"trace": SimpleNamespace(name="t")}, given) == "t 3"


# ---- bounds ----


class Slow:
    """A table that nobody can wait for."""

    @property
    def depth(self) -> Any:
        """A column that takes too long."""
        raise TooHardError("the depth takes too long")


def test_a_rule_whose_table_takes_too_long_is_not_evaluated_and_all_others_are(made: Tables) -> None:
    made.give("slow", Slow())

    def hopeless(slow: Slow) -> Any:
        return slow.depth

    def mode_entered(trace: Any) -> Any:
        return trace.mode.enters

    engine = Engine(made, {}, [made_rule(hopeless), made_rule(mode_entered)])
    assert [(found.rule, found.line) for found in engine.findings()] == [("mode-entered", 4), ("mode-entered", 12)]
    (missing,) = engine.unlisted
    assert (missing.rule, missing.reason) == ("hopeless", "the depth takes too long")
    assert missing.matters
    assert missing.blocks == np.count_nonzero(made["trace"].mode.in_polar)


def test_what_a_message_needs_may_take_too_long_too(made: Tables) -> None:
    """Nothing follows from a rule that was given up only when its message was made."""
    made.give("slow", Slow())

    def mode_entered(trace: Any) -> Any:
        return trace.mode.enters

    def mode_left(trace: Any) -> Any:
        return trace.mode.enters

    told = made_rule(mode_left, follows={"block": ("mode-entered",)})
    details = {"details": lambda hit, slow: {"depth": slow.depth}}
    hopeless = msgspec.structs.replace(made_rule(mode_entered, message="{depth}"), companion=details.get)
    engine = Engine(made, {}, [hopeless, told])
    assert [(found.rule, found.line) for found in engine.findings()] == [("mode-left", 4), ("mode-left", 12)]
    assert [missing.rule for missing in engine.unlisted] == ["mode-entered"]


def test_a_cause_whose_reach_takes_too_long_explains_nothing(made: Tables, monkeypatch: pytest.MonkeyPatch) -> None:
    made.give("slow", Slow())
    monkeypatch.setitem(SPANS, "slow", lambda tables: tables["slow"].depth)

    def mode_entered(trace: Any) -> Any:
        return trace.mode.enters

    def mode_left(trace: Any) -> Any:
        return trace.mode.enters

    rules = [made_rule(mode_entered), made_rule(mode_left, follows={"slow": ("mode-entered",)})]
    assert len(Engine(made, {}, rules).findings()) == 4


def test_time_is_kept_only_inside_a_limit() -> None:
    keep_time()
    with time_limit(1e6):
        keep_time()
        with (
            time_limit(-1),
            pytest.raises(TooHardError, match=r"longer than -1 s of .*, or -10 s in all: --max-seconds gives it more"),
        ):
            keep_time()
        keep_time()
    keep_time()


@pytest.mark.ci
def test_findings_beyond_the_limit_are_counted() -> None:
    """Nobody reads more than a thousand of one rule, and a report of hostile text stays small."""
    many = tables_of("O1\n" + "".join(f"G0 X{number}.\n" for number in range(1100)) + "M30\n")
    many.give("other_machine", OtherMachine(many))

    def x_written(trace: Any) -> Any:
        return trace.blocks.has("X")

    engine = Engine(many, {}, [made_rule(x_written)])
    assert len(engine.findings()) == LISTED == 1000
    (missing,) = engine.unlisted
    assert (missing.reason, missing.blocks) == ("only the first 1000 of 1100 findings are listed", 100)
    assert not missing.matters


#: What takes from the text of a program all that a rule may need (Rule.only_with).
TAKEN_AWAY = {
    SECTION: (r"G0*1[23]\.1|G11[23]|G10[123]|G13[67]|TRANSMIT|TRAFOOF|G7[.]1|G268|G269", ""),
    ARC: (r"G0*[23](?![\d.])", "G1"),
    COMMENT: (r"\([^()\n]*\)|;[^\n]*", ""),
}
#: The settings of an example that give what a rule may need.
SETTINGS = {
    PART: "job.part",
    BAR: "job.stock",
    C_ACCELERATION: "limits.c_acceleration",
    X_ACCELERATION: "limits.x_acceleration",
}


def without(what: str, example: Example) -> Example:
    """An example without its sections, arcs or comments, or without the settings that give the part, bar or limit."""
    if what in SETTINGS:
        settings = tuple(setting for setting in example.settings if not setting.startswith(SETTINGS[what]))
        return msgspec.structs.replace(example, settings=settings)
    return msgspec.structs.replace(example, program=re.sub(*TAKEN_AWAY[what], example.program))


@pytest.mark.ci
@looped("what", [*TAKEN_AWAY, *SETTINGS], one_in=4)
def test_rules_that_are_not_run_would_find_nothing(what: str) -> None:
    """Each example of each rule that is not run without a section, arc, bar and so on, with that taken away."""
    tried = set()
    for one in RULES.values():
        if what not in one.only_with:
            continue
        for example in examples(one.page):
            found = tables_of_example(without(what, example))
            if not found.has(one.only_with):
                assert not one.hits(found).mask.any(), (one.name, example.program)
                tried.add(one.name)
    names = {one.name for one in RULES.values() if what in one.only_with}
    assert len(tried) > 0.9 * len(names), names - tried


def test_rules_that_a_program_cannot_break_make_no_tables() -> None:
    turning = tables_of("O1\nG21 G99 T0101\nG0 X60. Z2.\nG1 Z-20. F.2\nM30\n")
    turning.give("other_machine", OtherMachine(turning))
    allows = Allows(turning["text"], {rule.name: rule.group for rule in RULES.values()})
    turning.give("allows", allows)
    turning.give("unused_allows", allows.unused((), RULES))
    assert not Engine(turning, {}, RULES.values()).findings()
    made = {name for name, _ in turning.computed()}
    assert made >= {"trace", "written", "procedure"}
    assert not made & {"regularity", "coverage", "air_cuts", "slots", "part_comments", "tool_comments", "tangency"}
