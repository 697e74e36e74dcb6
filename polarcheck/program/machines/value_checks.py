"""Value checks of profiles and jobs that a type cannot express; their messages say what was expected."""

from typing import Annotated, TypeAlias

import msgspec

from polarcheck.program.machines.value_types import EXPECTED, LARGEST, MOST, SMALLEST

#: First and last number of each range.
Ranges: TypeAlias = list[tuple[int, int]]

Positive: TypeAlias = Annotated[float, msgspec.Meta(gt=SMALLEST, le=LARGEST)]
NotNegative: TypeAlias = Annotated[float, msgspec.Meta(ge=0, le=LARGEST)]
Length: TypeAlias = Annotated[float, msgspec.Meta(ge=-LARGEST, le=LARGEST)]
Count: TypeAlias = Annotated[int, msgspec.Meta(ge=1, le=MOST)]
Codes: TypeAlias = Annotated[list[str], msgspec.Meta(min_length=1, extra={EXPECTED: "a list of codes, at least one"})]


def text_meta(pattern: str, expected: str) -> msgspec.Meta:
    """What a text of a type matches as a whole, and how messages name it."""
    # `$` alone lets a line end pass.
    return msgspec.Meta(pattern=f"^{pattern}$(?!\\n)", extra={EXPECTED: expected})


#: What a program can hold in any encoding.
Plain: TypeAlias = Annotated[str, text_meta("[ -~]*", "letters and signs of ASCII")]
CharacterOrNone: TypeAlias = Annotated[str, text_meta("[!-~]?", "one character or none")]
#: What begins a mark of channels: no letter, digit or sign that words, comments and statements are made of.
MarkOrNone: TypeAlias = Annotated[
    str, text_meta("[!\"$&':<>?@\\\\^_`{|}~]?", "one character that stands in no word, as $ or !, or none")
]
SwitchWord: TypeAlias = Annotated[
    str,
    text_meta("[!-~]+( [A-Z][-+]?[0-9]+([.][0-9]*)?)?", "a code, a code with a word as in G10.9 X0, or a native word"),
]
NumberedWord: TypeAlias = Annotated[str, text_meta("[A-Z][0-9]{1,4}", "a letter and a whole number, as in D0")]
CodeOrNone: TypeAlias = Annotated[str, text_meta("(G[0-9]{1,3}([.][0-9])?)?", "a G code, or none")]
Address: TypeAlias = Annotated[str, text_meta("[A-Z]", "an address, one letter")]
AddressOrNone: TypeAlias = Annotated[str, text_meta("[A-Z]?", "an address, one letter, or none")]
#: An axis that is written with `=`: by a letter and a number, as C2=10.
AxisName: TypeAlias = Annotated[str, text_meta("[A-Z][A-Z0-9]{1,7}", "the name of an axis with a number, as C2")]
#: The speed of a spindle that is written with `=`: S3=2000.
SpindleWord: TypeAlias = Annotated[str, text_meta("S[0-9]{1,2}", "S with the number of a spindle, as S3")]
#: What such an axis is here: no letter of another meaning on every lathe, as F and G.
AxisLetterOrNone: TypeAlias = Annotated[str, text_meta("[ABCEHU-Z]?", "the address of an axis, one letter, or none")]
CornerAddress: TypeAlias = Annotated[str, text_meta(",[A-Z]", "an address with its comma, as ,R")]
#: An axis by one letter, or by such a name.
_NAME, _AXIS = "[ABCHU-Z][A-Z]{0,5}[0-9]{1,2}", "an address, one letter or the name of an axis as C2"
AxisAddress: TypeAlias = Annotated[str, text_meta(f"([A-EHPQU-Z]|{_NAME})", _AXIS)]
AxisAddressOrNone: TypeAlias = Annotated[str, text_meta(f"([A-EHPQU-Z]|{_NAME})?", f"{_AXIS}, or none")]
RotaryAddress: TypeAlias = Annotated[str, text_meta(f"([ABCH]|{_NAME})", "A, B, C or H, or the name of an axis as C2")]
LanguageCode: TypeAlias = Annotated[str, text_meta("(?:[GM][0-9]+)?", "a code such as G290, or none")]
Variable: TypeAlias = Annotated[int, msgspec.Meta(ge=1, extra={EXPECTED: "the number of a variable, 100 for #100"})]
#: No control of a lathe has more axes in a path.
MOST_AXES = 24
AxisNumber: TypeAlias = Annotated[
    int, msgspec.Meta(ge=1, le=MOST_AXES, extra={EXPECTED: f"the number of an axis from 1 to {MOST_AXES}"})
]


def ascend(table: msgspec.Struct, *pairs: tuple[str, str]) -> None:
    """Raises ValueError for a pair of keys of which the first is above the second; NaN is above nothing."""
    for low, high in pairs:
        least, most = getattr(table, low), getattr(table, high)
        if least > most:
            raise ValueError(f"{low} is {least:g}, above {high}, {most:g}")
