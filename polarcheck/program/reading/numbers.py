"""Reads the numbers of words from text without blanks. Faults are marked, never raised."""

from __future__ import annotations

import enum

import msgspec
import numpy as np
from numpy.typing import NDArray

from polarcheck.foundation.arrays import Floats, Mask, Table, column_at
from polarcheck.foundation.states import plain
from polarcheck.program.reading.source import DASH, Bytes, Positions

Masks = NDArray[np.uint64]


@plain
class NumberFault(enum.IntEnum):
    """The fault of a word."""

    NONE = 0
    NO_DIGITS = 1
    TWO_POINTS = 2
    TWO_SIGNS = 3
    SIGN_AFTER_DIGITS = 4
    NO_ADDRESS = 5
    WRONG_DASH = 6
    BLANK_INSIDE = 7


class Numbers(Table, frozen=True):
    """
    The numbers of words, one element each.

    value: float64, NaN where there are no digits.
    decimals: number of digits behind the point.
    digits: number of all digits.
    has_point: C20. and C20 differ on a control.
    fault: uint8, NumberFault.
    """

    value: Floats
    decimals: NDArray[np.int32]
    digits: NDArray[np.int32]
    has_point: Mask
    fault: NDArray[np.uint8]


_POINT, _PLUS, _MINUS, _ZERO = b".+-0"
_IS_SIGN = np.isin(np.arange(256), (_PLUS, _MINUS, DASH))
_POWERS = 10.0 ** np.arange(23)

#: A number is read from its last eight characters at once; a longer one digit by digit.
_EIGHT = 8


def _in_each(byte: int) -> np.uint64:
    """A word of memory with the same byte in all places."""
    return np.uint64(byte * 0x0101010101010101)


#: The last 0 to 8 of eight characters.
_LAST = np.array([0, *(2**64 - 2 ** (64 - 8 * count) for count in range(1, 9))], np.uint64)
#: Takes the lowest bit of byte k to the number k + 1 in the highest four bits.
_TO_PLACE = np.uint64(sum((k + 1) << (60 - 8 * k) for k in range(8)) & (2**64 - 1))
#: By place of the point (0 for none): decimals, and by what to divide; the point itself is read as a 0 at the end. Two
#: points give any place; such numbers are read again.
_DECIMALS = np.array([0, 7, 6, 5, 4, 3, 2, 1, *[0] * 8], np.int32)
_DIVISOR = np.array([1.0, *_POWERS[8:0:-1], *[1.0] * 7])


def read_numbers(code: Bytes, start: Positions, end: Positions) -> Numbers:
    """
    Read the numbers at the positions from start to end of a text, without an address.

    code: signs, digits and points there, and another character behind each number.
    """
    written = np.flatnonzero(end > start)
    if 2 * len(written) < len(start):  # text in no parentheses
        return _with_empty(len(start), written, read_numbers(code, start[written], end[written]))
    first = code[start]
    signed = (first == _MINUS) | (first == _PLUS) | (first == DASH)
    length = end - start - signed
    padded = np.concatenate((np.zeros(_EIGHT, np.uint8), code))
    window = np.ndarray((len(code) + 1,), f"V{_EIGHT}", padded.data, strides=(1,))
    last = _LAST[np.minimum(length, _EIGHT)]
    eight: Masks = window[end].view("<u8") & last

    # The top bit of each byte that is a point; exact, no carry leaves a byte.
    differs = eight ^ _in_each(_POINT)
    points = ~(((differs & _in_each(0x7F)) + _in_each(0x7F)) | differs) & _in_each(0x80)
    point = points >> np.uint64(7)
    below_point = point - np.uint64(1)
    above_point = ~(points | (points - np.uint64(1)))
    # Digits have 3 in their upper half, points 2.
    upper = (last & _in_each(0x30)) - (point << np.uint64(4))
    odd = (length > _EIGHT) | (points & (points - np.uint64(1)) != 0) | (eight & _in_each(0xF0) != upper)
    decimal_place = ((point * _TO_PLACE) >> np.uint64(60)).astype(np.intp)
    has_point = decimal_place > 0
    value = _eight_digits((eight & below_point) | ((eight & above_point) >> np.uint64(8))) / _DIVISOR[decimal_place]

    value[(first == _MINUS) | (first == DASH)] *= -1
    fault = np.where(first == DASH, np.uint8(NumberFault.WRONG_DASH), np.uint8(NumberFault.NONE))
    decimals = _DECIMALS[decimal_place]
    numbers = Numbers(value, decimals, (length - has_point).astype(np.int32), has_point, fault)
    if odd.any():
        _read_odd(numbers, code, start, end, np.flatnonzero(odd))
    empty = np.flatnonzero(numbers.digits == 0)
    numbers.value[empty] = np.nan
    numbers.fault[empty] = NumberFault.NO_DIGITS
    return numbers


def _with_empty(count: int, index: Positions, numbers: Numbers) -> Numbers:
    """These numbers at their index among `count` ones, the others of which have no characters."""
    result = faulty_numbers(count, NumberFault.NO_DIGITS)
    for column, written in zip(msgspec.structs.astuple(result), msgspec.structs.astuple(numbers), strict=True):
        column[index] = written
    return result


def faulty_numbers(count: int, fault: NumberFault) -> Numbers:
    """So many numbers without characters, which have the same fault."""
    nothing = np.zeros(count, np.int32)
    faults = np.full(count, fault, np.uint8)
    return Numbers(np.full(count, np.nan), nothing, nothing.copy(), np.zeros(count, bool), faults)


def _eight_digits(eight: Masks) -> Floats:
    """
    The whole number of eight ASCII digits in one word of memory, zero bytes being zeros, in three multiplications.

    Source: D. Lemire, "Quickly parsing eight digits", 2018.
    """
    value = eight & _in_each(0x0F)
    value = (value * np.uint64(2561)) >> np.uint64(8)
    value = ((value & np.uint64(0x00FF00FF00FF00FF)) * np.uint64(6553601)) >> np.uint64(16)
    value = ((value & np.uint64(0x0000FFFF0000FFFF)) * np.uint64(42949672960001)) >> np.uint64(32)
    return value.astype(np.float64)


def _read_odd(numbers: Numbers, code: Bytes, start: Positions, end: Positions, index: Positions) -> None:
    """Read numbers digit by digit: long ones, and those with misplaced signs or points."""
    length = end[index] - start[index]
    first = np.cumsum(length) - length
    count = len(index)
    word = np.repeat(np.arange(count, dtype=np.int32), length)
    characters = code[np.arange(length.sum()) + (start[index] - first)[word]]
    is_point, is_sign = characters == _POINT, _IS_SIGN[characters]
    is_digit = ~(is_point | is_sign)

    digit_word = word[is_digit]
    digits = np.bincount(digit_word, minlength=count)
    last_digit = np.cumsum(digits)
    exponent = np.minimum(last_digit[digit_word] - 1 - np.arange(len(digit_word)), len(_POWERS) - 1)
    mantissa = np.bincount(digit_word, (characters[is_digit] - float(_ZERO)) * _POWERS[exponent], minlength=count)
    digits_before = np.cumsum(is_digit)
    points = np.bincount(word[is_point], minlength=count)
    signs = np.bincount(word[is_sign], minlength=count)
    decimals = column_at(count, word[is_point], last_digit[word[is_point]] - digits_before[is_point], 0)
    value = mantissa / _POWERS[np.minimum(decimals, len(_POWERS) - 1)]
    negative = np.bincount(word[is_sign & (characters != _PLUS)], minlength=count) > 0
    started = (digits_before > (last_digit - digits)[word]) | (np.cumsum(is_point) > (np.cumsum(points) - points)[word])
    late = np.bincount(word[is_sign & started], minlength=count) > 0
    dashes = np.bincount(word[characters == DASH], minlength=count) > 0

    fault = np.where(dashes, NumberFault.WRONG_DASH, NumberFault.NONE)
    fault = np.where(late, NumberFault.SIGN_AFTER_DIGITS, fault)
    fault = np.where(signs > 1, NumberFault.TWO_SIGNS, fault)
    numbers.fault[index] = np.where(points > 1, NumberFault.TWO_POINTS, fault)
    numbers.value[index] = np.where(negative, -value, value)
    numbers.digits[index] = digits
    numbers.decimals[index] = decimals
    numbers.has_point[index] = points > 0
