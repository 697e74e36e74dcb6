"""
What programs, machines and jobs may look like, for hypothesis: words, blocks, contours, offsets, whole programs that
look sound or wild, settings as tables and as TOML, and the programs at hand made worse.
"""

from __future__ import annotations

import functools
import string
from typing import Any

import msgspec
from fuzz_mutations import NUMBERS, WORDS, mutated
from fuzz_setups import SETUPS
from fuzz_targets import seeds
from hypothesis import strategies as st

from polarcheck.program.machines.job import Job
from polarcheck.program.machines.machine import Machine

ADDRESSES = "GMXYZCUVWHIJKRFSTNOPQLEABD"
#: Which of fuzz_targets.SETUPS.
setups = st.integers(0, len(SETUPS) - 1)


def lengths(low: float = -100, high: float = 100) -> st.SearchStrategy[str]:
    """A length as programs write it, to a thousandth."""
    return st.integers(round(low * 1000), round(high * 1000)).map(lambda n: f"{n / 1000:.3f}".rstrip("0"))


numbers = st.one_of(lengths(), st.sampled_from(NUMBERS), st.integers(0, 9999).map(str), st.floats().map(str))
words = st.one_of(st.builds(str.__add__, st.sampled_from(ADDRESSES), numbers), st.sampled_from(WORDS))
#: Blocks of any words, with and without blanks, comments and block skip.
blocks = st.builds(
    lambda head, found, between, tail: head + between.join(found) + tail,
    st.sampled_from(["", "", "", "N10 ", "/", "/2 ", "  "]),
    st.lists(words, max_size=5),
    st.sampled_from(["", " ", " ", "  ", "\t"]),
    st.sampled_from(["", "", "", "(A)", ";", " (CUTTER 8. DIA)", "\r"]),
)


@st.composite
def contours(draw: st.DrawFn) -> list[str]:
    """Blocks of a contour from X60 C0 and back: lines, arcs by R and by I and J, that may come to nothing sensible."""
    found = []
    for _ in range(draw(st.integers(1, 12))):
        code = draw(st.sampled_from(["G1", "G1", "G1", "G2", "G3", ""]))
        x, c = draw(lengths(-80, 80)), draw(lengths(-40, 40))
        block = draw(st.sampled_from([f"X{x} C{c}", f"X{x}", f"C{c}", f"U{x}", f"X{x} H{c}"]))
        if code in ("G2", "G3"):
            block += draw(st.one_of(lengths(0, 60).map("R{}".format), lengths(-30, 30).map("I{0} J{0}".format)))
        found.append(f"{code} {block}{draw(st.sampled_from(['', '', '', ' F100', ' F5000', ' F.1', ' Z-1.']))}".strip())
    return [*found, "G1 X60. C0"]


@st.composite
def sound_programs(draw: st.DrawFn) -> bytes:
    """Programs as a post writes them, with cutter compensation on one side or off; what they cut may be nonsense."""
    side = draw(st.sampled_from(["G41", "G42", ""]))
    unit = draw(st.sampled_from(["G21", "G20", ""]))
    head = ["%", "O0001", f"{unit} G40 G97 G98 G18", "T0101", "G0 X80. C0 Z2."]
    section = ["G12.1", f"G1 {side} X60. C0 F200", *draw(contours()), f"G1 {'G40' if side else ''} X80.", "G13.1"]
    again = section * draw(st.integers(1, 3))
    end = draw(st.sampled_from(["\n", "\r\n", "\n\r\r"]))
    return end.join([*head, *again, "G0 X100.", "M30", "%", ""]).encode()


@st.composite
def wild_programs(draw: st.DrawFn) -> bytes:
    """Any blocks, some of them a section, in any order, with calls and jumps among them."""
    some = st.one_of(blocks, blocks, st.sampled_from(["G12.1", "G13.1", "G1 G41 X30.", "G40", "M99", "O2", "%", "M30"]))
    found = draw(st.lists(some, max_size=40))
    return draw(st.sampled_from(["\n", "\r\n", ";\n", "\r"])).join(found).encode()


@st.composite
def worse_programs(draw: st.DrawFn) -> bytes:
    """A sample program, the example of a rule or a real program, mutated (mutations.py)."""
    found = _programs()
    return mutated(draw(st.sampled_from(found)), draw(st.randoms(use_true_random=False)), found)


@functools.cache
def _programs() -> list[bytes]:
    return seeds("whole")


def programs() -> st.SearchStrategy[bytes]:
    """All of these."""
    return st.one_of(sound_programs(), wild_programs(), worse_programs())


@st.composite
def statements(draw: st.DrawFn) -> bytes:
    """Macro statements, well formed or nearly so."""
    variable = st.sampled_from(["#1", "#2", "#100", "#500", "#0", "#5041", "#[#1]", "#3000", "#33", "#99999", "#<A>"])
    value = st.one_of(variable, numbers)
    function = st.sampled_from(["SIN", "COS", "TAN", "ATAN", "SQRT", "ABS", "BIN", "BCD", "ROUND", "FIX", "LN", "EXP"])
    operator = st.sampled_from(["+", "-", "*", "/", "MOD", "AND", "OR", "XOR", "EQ", "LT", "GE", ",", "]", "[", ""])
    expression = st.recursive(
        value,
        lambda inner: st.one_of(
            st.builds("{}{}{}".format, inner, operator, inner),
            st.builds("[{}{}{}]".format, inner, operator, inner),
            st.builds("{}[{}]".format, function, inner),
            st.builds("ATAN[{}]/[{}]".format, inner, inner),
            st.builds("POW[{},{}]".format, inner, inner),
        ),
        max_leaves=8,
    )
    forms = [
        "{0}={1}",
        "IF[{0}]GOTO{1}",
        "IF[{0}]THEN#1={1}",
        "WHILE[{0}]DO1",
        "END1",
        "GOTO{0}",
        "X[{0}]C{1}",
        "G65P2A{0}",
    ]
    found = draw(st.lists(st.builds(str.format, st.sampled_from(forms), expression, expression), max_size=12))
    return "\n".join(["O1", *found, "N10 X1.", "M30", "O2", "M99"]).encode()


def offset_tables() -> st.SearchStrategy[bytes]:
    """What a control punches out, more or less."""
    line = st.builds("G10 P{} X{} Z{} R{} Q{}".format, numbers, numbers, numbers, numbers, numbers)
    return st.lists(line, max_size=6).map(lambda found: "\n".join(["%", *found, "%"]).encode())


def _values() -> st.SearchStrategy[Any]:
    plain = st.one_of(
        st.booleans(), st.integers(-(2**70), 2**70), st.integers(-5, 5000), st.floats(), st.text(max_size=20)
    )
    known = st.sampled_from(["mm", "inch", "both", "G12.1", "M30", "G54", "radius", "fanuc", "off", "note", "polar"])
    value = st.one_of(plain, known)
    return st.one_of(value, value, st.lists(value, max_size=3), st.dictionaries(_names, value, max_size=3))


_names = st.one_of(
    st.text(string.ascii_lowercase + "_-. 1", max_size=12), st.sampled_from(["1", "8", "G54", "500", "x"])
)


def _tables(kind: type[msgspec.Struct]) -> st.SearchStrategy[dict[str, Any]]:
    """Tables with keys of a type and, in its tables, with keys of those; the values may fit or not."""
    keys = {field.name: field.type for field in msgspec.structs.fields(kind)}
    inner = {
        name: st.one_of(
            _values(),
            st.dictionaries(st.sampled_from([*wanted.__struct_fields__, "no_such_key"]), _values(), max_size=4),
        )
        for name, wanted in keys.items()
        if isinstance(wanted, type) and issubclass(wanted, msgspec.Struct)
    }
    chosen = st.sampled_from([*keys, "no_such_key"])
    return st.lists(chosen, max_size=4, unique=True).flatmap(
        lambda names: st.fixed_dictionaries({name: inner.get(name, _values()) for name in names})
    )


jobs = _tables(Job)
machines = _tables(Machine)


def toml(table: dict[str, Any]) -> bytes:
    """A table as TOML, as far as TOML can say it."""
    return "".join(f"{_key(name)} = {_toml(value)}\n" for name, value in table.items()).encode("utf-8", "replace")


def _key(name: str) -> str:
    return msgspec.json.encode(name.encode("utf-8", "replace").decode()).decode()


def _toml(value: Any) -> str:
    if isinstance(value, dict):
        return "{" + ", ".join(f"{_key(name)} = {_toml(one)}" for name, one in value.items()) + "}"
    if isinstance(value, list):
        return "[" + ", ".join(map(_toml, value)) + "]"
    if isinstance(value, bool):
        return str(value).lower()
    return _key(value) if isinstance(value, str) else str(value)


#: Settings as files.
setting_files = st.one_of(
    st.one_of(jobs, machines).map(toml), st.binary(max_size=200), st.text(max_size=200).map(str.encode)
)
