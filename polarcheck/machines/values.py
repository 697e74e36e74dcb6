"""What values of a profile or job can be, where a type alone does not say it; messages tell what was expected."""

from typing import Annotated, TypeAlias

import msgspec

from polarcheck.machines.fitting import EXPECTED

#: First and last number of each range.
Ranges: TypeAlias = list[tuple[int, int]]

Positive: TypeAlias = Annotated[float, msgspec.Meta(gt=0)]
NotNegative: TypeAlias = Annotated[float, msgspec.Meta(ge=0)]
Count: TypeAlias = Annotated[int, msgspec.Meta(ge=1)]
Codes: TypeAlias = Annotated[list[str], msgspec.Meta(min_length=1, extra={EXPECTED: "a list of codes, at least one"})]
Address: TypeAlias = Annotated[str, msgspec.Meta(pattern="^[A-Z]$", extra={EXPECTED: "an address, one letter"})]
AddressOrNone: TypeAlias = Annotated[
    str, msgspec.Meta(pattern="^[A-Z]?$", extra={EXPECTED: "an address, one letter, or none"})
]
Variable: TypeAlias = Annotated[int, msgspec.Meta(ge=1, extra={EXPECTED: "the number of a variable, 100 for #100"})]
#: Controls number their axes with two digits.
AxisNumber: TypeAlias = Annotated[
    int, msgspec.Meta(ge=1, le=99, extra={EXPECTED: "the number of an axis from 1 to 99"})
]


def ascend(table: msgspec.Struct, *pairs: tuple[str, str]) -> None:
    """Raises ValueError for a pair of keys of which the first is above the second; NaN is above nothing."""
    for low, high in pairs:
        least, most = getattr(table, low), getattr(table, high)
        if least > most:
            raise ValueError(f"{low} is {least:g}, above {high}, {most:g}")
