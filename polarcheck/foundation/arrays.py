"""The array types of the tables, each defined once, and look-ups in arrays."""

from __future__ import annotations

import functools
from collections.abc import Callable, Iterator, Sequence
from typing import TYPE_CHECKING, Any, ClassVar, Self, TypeAlias, TypeVar

import msgspec
import numpy as np
from numpy.typing import NDArray

_Number = TypeVar("_Number", bound=np.generic)

#: Up to this number of wanted values, one comparison per value is fastest.
_FEW = 4

#: A boolean per row, word, move or section.
Mask: TypeAlias = NDArray[np.bool_]
#: Values; NaN where the value is unknown.
Floats: TypeAlias = NDArray[np.float64]
#: Plane points, x + 1j*c [mm, X as radius]; NaN where the point is unknown.
Points: TypeAlias = NDArray[np.complex128]
#: Whole numbers: rows, words, blocks, lines, counts.
Rows: TypeAlias = NDArray[np.int64]
#: Small whole numbers: a state or a kind per row, such as Motion or Side.
States: TypeAlias = NDArray[np.int16]

if TYPE_CHECKING:
    from functools import cached_property as cached_property
else:

    class cached_property(functools.cached_property):  # noqa: N801  used as the one of the library
        """
        That of the library as it is since Python 3.12, without its lock: a table belongs to one thread.

        A small program has 500 of them, and the lock takes half of the time of each.
        """

        def __get__(self, instance, owner=None):
            """Compute the value at the first access."""
            if instance is None:
                return self
            value = instance.__dict__[self.attrname] = self.func(instance)
            return value


class Table(msgspec.Struct, frozen=True):
    """A table: each field is a column with one element per row, but for those that `_shared` names."""

    #: Fields that all rows share, such as one value per section: a selection of rows keeps them whole.
    _shared: ClassVar[tuple[str, ...]] = ()

    def __len__(self) -> int:
        return len(getattr(self, self.__struct_fields__[0]))

    def __getitem__(self, rows: NDArray[np.integer[Any]] | Mask | slice) -> Self:
        """The table of these rows: their numbers, a boolean per row, or a slice."""
        columns = {name: getattr(self, name)[rows] for name in self._columns()}
        return msgspec.structs.replace(self, **columns)

    @classmethod
    def concatenated(cls, tables: Sequence[Self]) -> Self:
        """The rows of several tables, one table after the other; what rows share is that of the first table."""
        columns = {name: np.concatenate([getattr(table, name) for table in tables]) for name in cls._columns()}
        return msgspec.structs.replace(tables[0], **columns)

    @classmethod
    def _columns(cls) -> list[str]:
        return [name for name in cls.__struct_fields__ if name not in cls._shared]


class Columns(msgspec.Struct, frozen=True, dict=True, eq=False):
    """Columns of one subject, computed when they are first read; the fields name the tables that they come from."""


def repeated(value: _Number, count: int) -> NDArray[_Number]:
    """
    Return a read-only column that repeats one value and takes the memory of one element (its stride is 0).

    Not for masks: NumPy processes contiguous booleans many at a time.
    """
    return np.ndarray(count, value.dtype, value.tobytes(), 0, (0,))


def is_uniform(values: NDArray[Any]) -> bool:
    """Return True if all values are equal, or all are NaN."""
    if values.dtype == np.bool_:  # `all` and `any` stop at the first value that differs
        return bool(values.all() if values[0] else not values.any())
    if is_repeated(values):
        return True
    first, last = values[0], values[-1]
    if first == first and first != values[len(values) // 2]:  # spares most columns the comparison of each value
        return False
    if first == last:
        return bool((values == first).all())
    return bool(first != first and last != last and (values != values).all())


def is_repeated(column: NDArray[Any]) -> bool:
    """Return True if a column, which is not empty, is one value that `repeated` gives to each row."""
    return column.strides == (0,) and len(column) > 0


def computed(function: Callable[..., NDArray[_Number]], *columns: NDArray[Any]) -> NDArray[_Number]:
    """Apply a function to columns row by row; only once if all of them are `repeated`."""
    if all(map(is_repeated, columns)):
        return repeated(function(*(column[:1] for column in columns))[0], len(columns[0]))
    return function(*columns)


def ranges(count: Rows) -> tuple[Rows, Rows]:
    """Return, for groups of `count` elements one after another, the group of each element, and its number in it."""
    group = np.repeat(np.arange(len(count)), count)
    return group, np.arange(len(group)) - np.repeat(np.cumsum(count) - count, count)


def stretch(column: NDArray[np.signedinteger[Any]], first: int, end: int) -> tuple[int, int]:
    """
    Return the slice (low, high) of a rising column with the values from `first` up to, not including, `end`.

    For repeated scalar look-ups: matching the dtype saves a copy of the column per call.
    """
    low, high = column.searchsorted(np.array((first, end), column.dtype)).tolist()
    return low, high


def mask_at(count: int, places: NDArray[Any] | Sequence[int]) -> Mask:
    """Return a mask of so many elements that is True at some places, given by number or as a mask."""
    mask = np.zeros(count, bool)
    mask[places] = True
    return mask


def column_at(
    count: int, places: NDArray[Any] | Sequence[int], values: Any, remaining: complex | np.generic
) -> NDArray[Any]:
    """
    Return a column of so many elements with these values at some places, given by number or as a mask.

    remaining: the value elsewhere; its type is that of the column.
    """
    column = np.full(count, remaining)
    column[places] = values
    return column


def folded(fold: np.ufunc, group: Rows, values: NDArray[_Number], count: int, none: float) -> NDArray[_Number]:
    """
    Return the least, the largest or another fold of the values of each of so many groups.

    group: int[n], the number of the group of each value. Neighbours of a group are folded first, which spares time.
    none: the value that the fold begins with, and that of a group without values.
    """
    result = np.full(count, none, values.dtype)
    first = first_in_run(group).nonzero()[0]
    if len(first):
        fold.at(result, group[first], fold.reduceat(values, first))
    return result


# np.unique, np.median and, for some arguments, np.isin import numpy.ma, 5 to 10 % of the time of a small check.


def median(values: NDArray[Any]) -> float:
    """Return the median of numbers; NaN if one of them is NaN."""
    rising = np.sort(values)  # NaN is last
    middle = rising[[(len(rising) - 1) // 2, len(rising) // 2]]
    return float(rising[-1] if rising[-1] != rising[-1] else middle.sum() / 2)


def side_by_side(*columns: NDArray[Any]) -> Iterator[tuple[Any, ...]]:
    """Return the elements of columns of the same length row by row, as values of Python."""
    return zip(*(column.tolist() for column in columns), strict=True)


def first_in_run(*columns: NDArray[Any]) -> Mask:
    """Return a mask of the first element of each run of elements that are equal in all of these columns."""
    first, *others = columns
    begins = np.empty(len(first), bool)
    begins[:1] = True
    np.not_equal(first[1:], first[:-1], out=begins[1:])
    for column in others:
        begins[1:] |= column[1:] != column[:-1]
    return begins


def last_in_run(*columns: NDArray[Any]) -> Mask:
    """Return a mask of the last element of each run of elements that are equal in all of these columns."""
    return np.concatenate((first_in_run(*columns)[1:], (True,)))[: len(columns[0])]


def runs(*columns: NDArray[Any]) -> tuple[Rows, Rows]:
    """Return the index of the first and of the last element of each run of equal elements."""
    return first_in_run(*columns).nonzero()[0], last_in_run(*columns).nonzero()[0]


def different(values: NDArray[_Number]) -> NDArray[_Number]:
    """Return the distinct values, rising; none of them may be NaN."""
    rising = np.sort(values, axis=None)
    return rising[first_in_run(rising)]


def first_of_each(values: NDArray[Any]) -> tuple[Rows, Rows]:
    """
    Return the index of the first of each distinct value, by rising value, and the number of the value of each element.

    None of the values may be NaN. As np.unique, whose stable sort takes twice as long.
    """
    order = values.argsort()
    ordered = values[order]
    begins = first_in_run(ordered)
    number = np.empty(len(values), np.int64)
    number[order] = begins.cumsum() - 1
    return np.minimum.reduceat(order, begins.nonzero()[0]) if len(values) else order, number


def is_among(values: NDArray[Any], choices: Sequence[float | str] | NDArray[Any]) -> Mask:
    """Return a mask of the values that are among the choices. For few values np.isin takes ten times as long."""
    if len(choices) <= _FEW:
        matches = np.zeros(np.shape(values), bool)
        for value in choices:
            matches |= values == value
        return matches
    if values.dtype == np.uint8:
        return np.asarray(mask_at(256, np.array(choices, np.intp))[values])
    ordered = np.sort(np.array(choices))
    return np.asarray(ordered[np.minimum(ordered.searchsorted(values), len(ordered) - 1)] == values)
