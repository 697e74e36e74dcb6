"""Odd values of every argument of the functions for Python are taken, or refused by a PolarcheckError in one line."""

from __future__ import annotations

import collections
import contextlib
import datetime
import decimal
import fractions
import inspect
import itertools
import math
import re
import types
import warnings
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from cases import looped
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from polarcheck.errors import PolarcheckError, PolarcheckWarning, RefusedError, UsageError

import polarcheck
from polarcheck.api.values import short

TEXT = "G98 G0 X60. C0 T0808\nG12.1\nG42 G1 X40. F100\nG1 C10.\nG40 X60.\nG13.1\nM30\n"
MANIFEST = """
title = "post"
features = ["first"]
[controls.fanuc]
machine = "fanuc"
[[case]]
feature = "first"
control = "fanuc"
program = "a.nc"
"""


class Odd:
    """A value of no known kind, which cannot even be shown."""

    def __repr__(self) -> str:
        raise RuntimeError("no text")


class NoPath:
    """Says that it is a path, and is none."""

    def __fspath__(self) -> Any:
        return 5


def nested(depth: int) -> Any:
    value: Any = 1.0
    for number in range(depth):
        value = [value] if number % 2 else {"radius": value}
    return value


CIRCLE: list[Any] = []
CIRCLE.append({"radius": CIRCLE})

#: Values that a caller may pass by mistake, or that reach a limit of Python, of a file system or of a library.
VALUES: list[Any] = [
    *(None, True, False, 0, -1, 1, 7, 2**31, 2**63, 2**64, 10**17, 10**18, 10**400, -(10**400), 10**5000),
    *(0.5, -0.0, 1e308, -1e308, 5e-324, math.nan, math.inf, -math.inf, 1j, 1.5 + 1j),
    *(
        "",
        " ",
        "a",
        "-",
        ".",
        "..",
        "/",
        "~",
        "\0",
        "a\0b",
        "a\nb",
        "\x1b[31m",
        "\u202e",
        "\ud800",
        "\udc80",
        "x" * 5000,
    ),
    *(
        "off",
        "all",
        "text",
        "fanuc",
        "a.nc",
        "none.nc",
        "utf-8",
        "rot13",
        "hex",
        "idna",
        "mm",
        "both",
        "::error::",
        "1,5",
    ),
    *(
        b"",
        b"a.nc",
        bytearray(b"a"),
        memoryview(b"a"),
        range(3),
        {1},
        frozenset("a"),
        (),
        [],
        {},
        ("a", 1),
        [None],
        [[]],
    ),
    *([1], ["a"], ["\0"], ["\ud800"], ["\udc80"], [""], [b"a"], [math.nan], [10**400], ["a"] * 100, [{}], [[{}]]),
    *(CIRCLE, CIRCLE[0], nested(11), nested(12), nested(13), nested(5000)),
    *(Odd(), NoPath(), object(), int, len, lambda: 1, Ellipsis, NotImplemented, polarcheck, inspect.signature(len)),
    *(decimal.Decimal("1.5"), decimal.Decimal("sNaN"), decimal.Decimal("1e999999"), decimal.Decimal("Infinity")),
    *(fractions.Fraction(1, 3), fractions.Fraction(10**400, 3), datetime.date(2020, 1, 1), datetime.timedelta(1)),
    *(np.float64("nan"), np.float32(1.5), np.int64(7), np.bool_(True), np.str_("a"), np.datetime64("2020-01-01")),
    *(np.array(1.0), np.array([1.0, 2.0]), np.eye(2), np.array(["a"]), np.array([], object), np.zeros((2, 0))),
    *(Path("a.nc"), Path("\0"), Path("\udc80"), types.MappingProxyType({8: 1.0}), collections.UserDict({8: 1.0})),
    *(collections.OrderedDict(radius=1.0), collections.deque(["a"]), collections.Counter("ab")),
    *(polarcheck.Tool(radius=1.0), polarcheck.Tool(radius="x"), polarcheck.WorkOffset(x=10**400)),  # type: ignore[arg-type]
    *(polarcheck.Stock(diameter=1e60), polarcheck.Stock(hexagon="x"), polarcheck.Stock(bore=10**400)),  # type: ignore[arg-type]
    *(polarcheck.Part(shape="x"), polarcheck.Part(shape="circle", diameter=10**400), polarcheck.Part(shape=Odd())),  # type: ignore[arg-type]
    polarcheck.Part(shape="polygon", sides=0, across_corners=9.0),
]
#: Keys of tables: some that keywords know, and some that none does.
KEYS: list[Any] = [
    *(
        8,
        "8",
        "radius",
        "nose",
        "limits.c_feed",
        "c_feed",
        "polar.on",
        "shape",
        "diameter",
        "hexagon",
        "drawing",
        "files",
    ),
    *("G54", "x", 500, "#500", "rules", "reason", "level", "overcut", "center", "layers", "sides", "tolerance", "bore"),
    *(None, True, 1.5, (1, 2), b"a", "", ".", "a.", ".a", "\0", "a\nb", "\ud800", "\udc80", 10**400, -1, 0, 10**5000),
    *(np.int64(8), np.float64(8.0), Path("a"), frozenset(), "x" * 5000),
]
#: A key beside every value, and every key beside a number.
TABLES = [{key: 1.0} for key in KEYS] + [
    {key: value}
    for value in VALUES
    for key in (8, "limits.c_feed", "c_feed", "hexagon", "G54", "overcut", "drawing", "rules", "unknown")
]


def call(name: str) -> tuple[dict[str, Any], Any]:
    """Return arguments of a function that are right."""
    right: dict[str, dict[str, Any]] = {
        "certify": {"path": "post.toml"},
        "check": {"paths": ["a.nc"]},
        "compare": {"old": "a.nc", "new": "a.nc"},
        "compare_text": {"old": TEXT, "new": TEXT},
        "convert": {"path": "a.nc", "to": "haas-lathe"},
        "convert_text": {"text": TEXT, "to": "haas-lathe"},
        "machine": {"name": "fanuc"},
        "machine_names": {},
        "render": {"report": polarcheck.check_text("M30\n")},
    }
    if name == "polyline":
        return {}, polarcheck.trace_text(TEXT).polyline
    return right.get(name, {"text": TEXT} if name.endswith("_text") else {"path": "a.nc"}), getattr(polarcheck, name)


FUNCTIONS = [*(name for name in polarcheck.__all__ if inspect.isfunction(getattr(polarcheck, name))), "polyline"]
CLASSES = ["Tool", "Stock", "WorkOffset", "Part"]


def arguments_of(function: Any) -> list[str]:
    return list(inspect.signature(function).parameters)


def fault(function: Any, arguments: dict[str, Any]) -> str:
    """Return what is wrong with a call: neither a result nor a PolarcheckError of one line. Empty for neither."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", PolarcheckWarning)
        try:
            function(**arguments)
        except PolarcheckError as error:
            text = "".join(character for character in str(error) if not "\udc80" <= character <= "\udcff")
            if not text or not text.isprintable():
                return f"no line: {error!r}"
            if isinstance(error, UsageError) and not re.match(
                rf"(polarcheck\.)?{function.__name__}\b|no rule is left to check", text
            ):
                return f"names no function: {text}"
        except Exception as error:
            return f"{type(error).__name__}: {str(error)[:80]}"
    return ""


@pytest.fixture
def files(own_folder: None) -> None:
    """A program and a manifest."""
    Path("a.nc").write_text(TEXT, "utf-8")
    Path("post.toml").write_text(MANIFEST, "utf-8")


@pytest.mark.nightly
@pytest.mark.one_in(16)
@pytest.mark.parametrize("name", FUNCTIONS)
def test_any_value_of_any_argument_is_taken_or_refused_in_one_line(name: str, files: None) -> None:
    right, function = call(name)
    assert fault(function, right) == ""
    wrong = [
        f"{argument}={short(value)}: {text}"
        for argument in arguments_of(function)
        for value in itertools.chain(VALUES, TABLES)
        if (text := fault(function, {**right, argument: value}))
    ]
    assert wrong == []


def values() -> st.SearchStrategy[Any]:
    # By their numbers: Hypothesis shows what it draws from, and some of these cannot be shown.
    known = st.integers(0, len(VALUES) - 1).map(lambda number: VALUES[number])
    leaves = known | st.floats() | st.integers() | st.text(max_size=4) | st.binary(max_size=2)
    hashable = st.integers(0, len(KEYS) - 1).map(lambda number: KEYS[number])
    keys = hashable | st.text(max_size=3) | st.integers()
    return st.recursive(leaves, lambda inner: st.lists(inner, max_size=3) | st.dictionaries(keys, inner, max_size=3))


@pytest.mark.nightly
@pytest.mark.usefixtures("files")
@settings(max_examples=150, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(place=st.sampled_from(FUNCTIONS), number=st.integers(0, 40), value=values())
def test_drawn_values_are_taken_or_refused_in_one_line(place: str, number: int, value: Any) -> None:
    right, function = call(place)
    arguments = arguments_of(function)
    if arguments:
        assert fault(function, {**right, arguments[number % len(arguments)]: value}) == ""


@looped("name", CLASSES)
def test_values_of_any_kind_can_be_made_and_a_contradiction_is_an_error_of_usage(name: str) -> None:
    """Whether a value has the right type is for the function to say that takes it."""
    kind = getattr(polarcheck, name)
    for key in kind.__struct_fields__:
        for value in VALUES:
            try:
                kind(**{key: value})
            except UsageError as error:
                assert str(error).isprintable()  # noqa: PT017  most are made
    with pytest.raises(UsageError, match="stock: give diameter or hexagon, not both"):
        polarcheck.Stock(diameter=30.0, hexagon=27.0)


WRONG: list[tuple[str, dict[str, Any], str]] = [
    (
        "check_text",
        {"tools": {1: 10**400}},
        "tools.1: expected a number of 18 digits at most, found a number of 401 digits",
    ),
    ("check_text", {"config": "\0"}, r"config: no file can have the name '\x00'"),
    (
        "check_text",
        {"limits": CIRCLE},
        "limits.radius.radius.radius.radius.radius.radius: expected 12 tables and lists within each other at most",
    ),
    ("check_text", {"stock": {"a\nb": 1}}, r"stock: expected texts or whole numbers as keys, found 'a\nb'"),
    (
        "check_text",
        {"encoding": Odd()},
        "encoding: expected a text, a number, a list or a table, found <Odd instance",
    ),
    (
        "check_text",
        {"variables": {500: decimal.Decimal("sNaN")}},
        "variables.500: expected a number, found Decimal(",
    ),
    ("check_text", {"units": "\ud800"}, r"units: expected a text of characters, found '\ud800'"),
    ("check_text", {"tools": {8: polarcheck.Tool(radius="x")}}, "tools.8.radius: expected"),  # type: ignore[arg-type]
    ("check_text", {"part": polarcheck.Part(shape="x")}, "part.1.shape: expected"),  # type: ignore[arg-type]
    ("check_text", {"name": 5}, "name: expected the path of a program or folder, found 5"),
    ("check", {"max_size": -1}, "max_size: expected a whole number from 0, found -1"),
    ("check", {"max_size": "64"}, "max_size: expected a whole number from 0, found '64'"),
    ("check", {"force_exclude": 1}, "force_exclude: expected True or False, found 1"),
    ("check", {"processes": 10**400}, "processes: expected a number of 18 digits at most"),
    ("compare", {"tolerance": 1e308}, "tolerance: expected 10 mm at most, found 1e+308"),
    ("trace", {"which": ["tool"]}, "which: expected tool or programmed, found ['tool']"),
    ("trace_text", {"which": "cut"}, "which: expected tool or programmed, found 'cut'"),
    ("certify", {"path": None}, "expected the path of a manifest, found None"),
    ("certify", {"cases": [1]}, "cases: expected names, found [1]"),
    ("certify", {"cases": "nowhere"}, "cases nowhere: the manifest has no case of this name"),
    ("render", {"form": 1}, "form: expected one of text, short,"),
    ("render", {"report": None}, "expected a report of check, found NoneType"),
]


@pytest.mark.parametrize(("name", "given_", "text"), WRONG, ids=[text for *_, text in WRONG])
@pytest.mark.usefixtures("files")
def test_a_wrong_value_is_named_with_its_keyword(name: str, given_: dict[str, Any], text: str) -> None:
    right, function = call(name)
    with pytest.raises(UsageError) as caught:
        function(**{**right, **given_})
    assert str(caught.value).startswith((f"polarcheck.{name}(): {text}", f"polarcheck.{name}() {text}"))


@pytest.mark.one_in(3)
@pytest.mark.parametrize("name", [name for name in FUNCTIONS if name != "polyline"])
def test_none_changes_nothing(name: str, files: None) -> None:
    right, function = call(name)
    # A program that needs no rewriting is refused for that, and not for None.
    with contextlib.suppress(RefusedError):
        function(**right, **dict.fromkeys(argument for argument in arguments_of(function) if argument not in right))


def test_numbers_and_tables_of_other_libraries_are_values() -> None:
    tools = types.MappingProxyType({np.int64(8): fractions.Fraction(13, 2)})
    section = polarcheck.check_text(TEXT, tools=tools).polar_sections[0]
    assert section.radius == 6.5
    assert polarcheck.machine("fanuc", changes={"limits.c_feed": decimal.Decimal(3600)}).limits.c_feed == 3600.0


def test_a_fault_of_the_callers_own_code_is_raised() -> None:
    def broken() -> Iterator[str]:
        yield "text"
        raise ZeroDivisionError

    with pytest.raises(ZeroDivisionError):
        polarcheck.check_text(TEXT, select=broken())
