"""
How the control calculates: the functions and operators of custom macro, each from numbers to a number.

A value is a float, None where a variable is vacant (#0, or never assigned), NaN where it is unknown. Angles are in
degrees here, as in the program. What a function cannot take gives its kind of fault instead of a number.

Sources: FANUC B-62754EN/01, chapter 16.3; the ranges of ASIN, ACOS and ATAN from parameter 6004#0 (NAT).
"""

from __future__ import annotations

import math
import operator
from collections.abc import Callable, Mapping, Sequence
from typing import Final, TypeAlias

import msgspec

from polarcheck.program.execution.kinds import FaultKind

Value: TypeAlias = float | None
UNKNOWN: Final = math.nan
#: NaN, too: the value of what has a fault, which is reported.
FAULTY: Final = float("nan")


class Unknown(float):
    """
    NaN, as the value of a variable that has none; what is calculated with it stays this value.

    variable: None where the value of something else is not known, as of a name of the control.
    """

    variable: int | None

    def __new__(cls, variable: int | None) -> Unknown:
        value = super().__new__(cls, UNKNOWN)
        value.variable = variable
        return value


class FromVacant(float):
    """A value that is calculated with a vacant variable, which counts as 0 there."""

    variable: int

    def __new__(cls, value: float, variable: int) -> FromVacant:
        result = super().__new__(cls, value)
        result.variable = variable
        return result


class Arithmetic(msgspec.Struct, frozen=True):
    """
    What differs between controls.

    signed_angles: ATAN[a]/[b] in -180..180 and ASIN in -90..90 (6004#0 NAT = 1), else in 0..360 and 270..90.
    largest: a result above it overflows; 1e47 in the older number format, 1e308 in the newer.
    """

    signed_angles: bool = False
    largest: float = 1e47


_NOISE: Final = 1e-12  # so far beyond its limit, an argument is a rounding error, which no two controls share


def round_to(value: float, increment: float) -> float:
    """Round half away from zero to a multiple of the increment; 1.2345 is a half, whatever its binary fraction is."""
    scale = round(1 / increment) if increment < 1 else 1 / increment
    scaled = abs(value) * scale
    if scaled > 1e15:
        return value
    return math.copysign(math.floor(scaled * (1 + 1e-15) + 0.5) / scale, value) + 0.0


def _quarters(angle: float) -> int | None:
    """How many right angles, where there is no rest: SIN[180] is 0, which radians would miss."""
    quarters = math.fmod(angle, 360.0) / 90
    return int(quarters) % 4 if quarters.is_integer() else None


def _sin(angle: float) -> float:
    quarters = _quarters(angle)
    return math.sin(math.radians(math.fmod(angle, 360.0))) if quarters is None else (0.0, 1.0, 0.0, -1.0)[quarters]


def _cos(angle: float) -> float:
    quarters = _quarters(angle)
    return math.cos(math.radians(math.fmod(angle, 360.0))) if quarters is None else (1.0, 0.0, -1.0, 0.0)[quarters]


def _tan(angle: float) -> float | FaultKind:
    return _sin(angle) / _cos(angle) if _cos(angle) else "zero-divide"


def _arc(function: Callable[[float], float]) -> Callable[[float], float | FaultKind]:
    def arc(a: float) -> float | FaultKind:
        return "arc-function-beyond-one" if abs(a) > 1 + _NOISE else math.degrees(function(max(-1.0, min(1.0, a))))

    return arc


def _arc_of_two(a: float, b: float) -> float:
    return math.degrees(math.atan2(a, b)) if a or b else UNKNOWN  # ATAN[0]/[0]: no source says


def _whole_numbers(function: Callable[[int, int], float | FaultKind]) -> Callable[[float, float], float | FaultKind]:
    """AND, OR, XOR and MOD take whole numbers of 32 bits; what is not whole is rounded first."""

    def whole(a: float, b: float) -> float | FaultKind:
        a, b = round_to(a, 1), round_to(b, 1)
        return "integer-overflow" if max(abs(a), abs(b)) >= 2**32 else function(int(a), int(b))

    return whole


def _remainder(a: int, b: int) -> float | FaultKind:
    return math.fmod(a, b) + 0.0 if b else "zero-divide"


def _binary(a: float) -> float | FaultKind:
    """BIN: the hexadecimal digits, read as a decimal number."""
    digits = f"{int(round_to(a, 1)):x}"
    return float(digits) if digits.isdecimal() and len(digits) <= 8 else "argument-out-of-range"


def _coded_decimal(a: float) -> float | FaultKind:
    """BCD: the decimal digits, read as a hexadecimal number."""
    digits = f"{round_to(a, 1):.0f}"
    return float(int(digits, 16)) if digits.isdecimal() and len(digits) <= 8 else "argument-out-of-range"


def _power(a: float, b: float) -> float | FaultKind:
    if a == 0 and b < 0:
        return "zero-divide"
    if a < 0 and not b.is_integer():
        return "argument-out-of-range"
    return math.pow(a, b)


_OPERATIONS: Final[Mapping[str, Callable[..., float | FaultKind]]] = {
    "NEGATE": lambda a: 0.0 - a,
    "+": operator.add,
    "-": operator.sub,
    "*": operator.mul,
    "/": lambda a, b: a / b if b else "zero-divide",
    "MOD": _whole_numbers(_remainder),
    "AND": _whole_numbers(operator.and_),
    "OR": _whole_numbers(operator.or_),
    "XOR": _whole_numbers(operator.xor),
    "GT": operator.gt,
    "LT": operator.lt,
    "GE": operator.ge,
    "LE": operator.le,
    "BOTH": lambda a, b: a and b,
    "EITHER": lambda a, b: a or b,
    "ONE": operator.ne,
    "SIN": _sin,
    "COS": _cos,
    "TAN": _tan,
    "ASIN": _arc(math.asin),
    "ACOS": _arc(math.acos),
    "ATAN": lambda a: math.degrees(math.atan(a)),
    "ATAN2": _arc_of_two,
    "SQRT": lambda a: math.sqrt(max(a, 0.0)) if a >= -_NOISE else "negative-square-root",
    "ABS": abs,
    "FIX": lambda a: float(math.trunc(a)),
    "FUP": lambda a: float(math.ceil(a) if a > 0 else math.floor(a)),
    "LN": lambda a: math.log(a) if a > 0 else "logarithm-not-positive",
    "EXP": math.exp,
    "BIN": _binary,
    "BCD": _coded_decimal,
    "POW": _power,
    "WHOLE": lambda a: round_to(a, 1),
    "SQUARE": lambda a: a * a,
    "LEAST": min,
    "GREATEST": max,
    "DIV": lambda a, b: float(math.trunc(a / b)) if b else "zero-divide",
    "NOT": operator.not_,
    "B_NOT": lambda a: float(~int(round_to(a, 1))),
    "JOIN": lambda a, b: UNKNOWN,  # strings are not followed
    "ADP": lambda a: UNKNOWN,  # it asks whether an argument of the call was written with a point
    "NAMED": lambda a: UNKNOWN,  # a system variable by its name, or a function that is not calculated
}


_OF_TWO: Final = (
    *("EQ", "NE", "GT", "LT", "GE", "LE", "+", "-", "OR", "XOR", "*", "/", "AND", "MOD", "BOTH", "EITHER", "ONE"),
    *("ATAN2", "POW", "DIV", "LEAST", "GREATEST", "JOIN"),
)
#: How many values a step of a calculation takes, by its name; 1 where it is not listed.
OPERAND_COUNTS: Final[Mapping[str, int]] = {"number": 0, **dict.fromkeys(_OF_TWO, 2)}


def calculate(name: str, operands: Sequence[Value], arithmetic: Arithmetic, increment: float) -> float | FaultKind:
    """
    The result of one function or operator, or its kind of fault. Conditions are 1, 0, or NaN for unknown.

    A vacant operand counts as 0; only EQ and NE tell it from 0. Unknown gives unknown, unless the other side decides.
    increment: what ROUND rounds to.
    """
    if (name == "BOTH" and False in operands) or (name == "EITHER" and True in operands):
        return name == "EITHER"
    if any(operand != operand for operand in operands):
        return UNKNOWN
    if name in ("EQ", "NE"):
        a, b = operands
        same = a == b if a is not None and b is not None else a is b
        return same == (name == "EQ")
    numbers = [operand or 0.0 for operand in operands]
    if name == "ROUND":
        return round_to(numbers[0], increment)
    try:
        result = _OPERATIONS[name](*numbers)
    except OverflowError:
        return "overflow"
    if isinstance(result, str):
        return result
    if name in ("ASIN", "ATAN2") and not arithmetic.signed_angles and result < 0:
        return (result + 360.0) % 360.0
    return "overflow" if abs(result) > arithmetic.largest else result + 0.0
