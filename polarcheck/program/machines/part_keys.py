"""What a program is meant to make: a shape with its numbers, or a drawing, as [[part]] in a job file gives it."""

import math
from collections.abc import Mapping
from types import MappingProxyType
from typing import Annotated, Literal

import msgspec

from polarcheck.foundation.errors import enumerated
from polarcheck.program.machines.value_types import KeyedError, are_numbers

#: Sides of each shape that is regular and has a name.
SIDES: Mapping[str, int] = MappingProxyType(
    {
        "triangle": 3, "square": 4, "pentagon": 5, "hexagon": 6, "heptagon": 7, "octagon": 8, "nonagon": 9,
        "decagon": 10, "hendecagon": 11, "dodecagon": 12,
    }
)  # fmt: skip
#: Lengths in the units of the file; no lathe is larger.
_LARGEST = 20_000
_PLACED = ("center", "turned", "inside")
_CORNERS = ("corner_radius", "chamfer")
_REGULAR = ("across_flats", "across_corners", *_CORNERS, *_PLACED)
#: The keys of each shape, without those that every part may have.
_KEYS: Mapping[str, tuple[str, ...]] = {
    **dict.fromkeys(SIDES, _REGULAR),
    "polygon": ("sides", *_REGULAR),
    "circle": ("diameter", "center", "inside"),
    "rectangle": ("width", "length", *_CORNERS, *_PLACED),
    "flat": ("distance", "diameter", "turned"),
    "flats": ("across_flats", "distance", "count", "diameter", "turned"),
    "slot": ("width", "length", "corner_radius", "center", "turned"),
}
#: The keys of each shape that it cannot be without, one of each row.
_NEEDED: Mapping[str, tuple[tuple[str, ...], ...]] = {
    **dict.fromkeys(SIDES, (("across_flats", "across_corners"),)),
    "polygon": (("sides",), ("across_flats", "across_corners")),
    "circle": (("diameter",),),
    "rectangle": (("width",), ("length",)),
    "flat": (("distance",),),
    "flats": (("across_flats", "distance"),),
    "slot": (("width",),),
}
_OF_SHAPES = frozenset(key for keys in _KEYS.values() for key in keys)
#: Keys of lengths, which are in the units of their file.
LENGTHS = (
    *("across_flats", "across_corners", "diameter", "width", "length", "distance", "corner_radius", "chamfer"),
    *("center", "z", "tolerance"),
)

Shape = Literal[
    "triangle", "square", "pentagon", "hexagon", "heptagon", "octagon", "nonagon", "decagon", "hendecagon", "dodecagon",
    "polygon", "circle", "rectangle", "flat", "flats", "slot",
]  # fmt: skip
Size = Annotated[float, msgspec.Meta(gt=0, le=_LARGEST)]
Coordinate = Annotated[float, msgspec.Meta(ge=-_LARGEST, le=_LARGEST)]


class Part(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """
    What one contour should be, as a shape with its numbers or as a drawing; NaN and None are not given.

    Lengths are in the units of the file, x is a radius, angles are in deg from C0.

    shape: with its numbers; polygon needs sides
    drawing: DXF file, relative to this file, in place of a shape
    sides: of a polygon
    count: of flats; 2 unless given
    across_flats: twice the distance from the center to a side
    across_corners: twice the distance from the center to a sharp corner
    diameter: of a circle, or of the round that flats are milled on
    width: of a slot or rectangle
    length: along turned; of a slot over its round ends
    distance: from the center to a flat
    corner_radius: R of the corners
    chamfer: what a corner takes off each of its sides
    turned: from C0 to the normal of a flat, or along a length [deg]; else any
    center: x, as a radius, and c of the middle
    inside: a pocket, the part stands around it
    z: of the contour; else the deepest
    tolerance: how far the part may differ; 0.02 mm unless given
    layers: of the drawing: only what lies on these; else all that show a contour
    section: the polar section, 1 for the first; else any
    files: of which programs: patterns of names or paths as under [[programs]]; else all
    """

    shape: Shape | None = None
    drawing: str | None = None
    sides: Annotated[int, msgspec.Meta(ge=3, le=360)] | None = None
    count: Annotated[int, msgspec.Meta(ge=2, le=360)] | None = None
    across_flats: Size = math.nan
    across_corners: Size = math.nan
    diameter: Size = math.nan
    width: Size = math.nan
    length: Size = math.nan
    distance: Size = math.nan
    corner_radius: Size = math.nan
    chamfer: Size = math.nan
    turned: Annotated[float, msgspec.Meta(ge=-360, le=360)] = math.nan
    center: tuple[Coordinate, Coordinate] = (0.0, 0.0)
    inside: bool = False
    z: Coordinate = math.nan
    tolerance: Size = math.nan
    layers: list[str] = []
    section: Annotated[int, msgspec.Meta(ge=1, le=10**6)] | None = None
    files: Annotated[list[str], msgspec.Meta(min_length=1)] = []

    def __post_init__(self) -> None:
        if not self._fits_types():
            return
        given = [name for name in sorted(_OF_SHAPES) if self._is_given(name)]
        if self.drawing is not None:
            if self.shape is not None or given:
                raise KeyedError("shape" if self.shape else given[0], "a part has a drawing or a shape, not both")
            return
        if self.layers:
            raise KeyedError("layers", "a drawing has layers, a shape has none")
        if self.shape is None:
            raise KeyedError("", f"expected drawing = a DXF file, or shape = {enumerated(_KEYS, 'or')}")
        keys = _KEYS[self.shape]
        for key in given:
            if key not in keys:
                raise KeyedError(key, f"no key of the shape {self.shape}, which has {enumerated(keys, 'or')}")
        for alternatives in _NEEDED[self.shape]:
            stated = [key for key in alternatives if key in given]
            if not stated:
                raise KeyedError("", f"the shape {self.shape} needs {enumerated(alternatives, 'or')}")
            if len(stated) > 1:
                raise KeyedError(stated[1], f"the shape {self.shape} has {enumerated(stated, 'or')}, not both")
        if "corner_radius" in given and "chamfer" in given:
            raise KeyedError("chamfer", "a corner has corner_radius or chamfer, not both")
        self._check_room()

    def _fits_types(self) -> bool:
        """Return False for a part made in Python of other types; the function that takes it says what is wrong."""
        texts = [text for text in (self.shape, self.drawing) if text is not None]
        given = {name: getattr(self, name) for name in _OF_SHAPES if getattr(self, name) is not _DEFAULTS[name]}
        center = given.pop("center", ())
        are_kinds = all(isinstance(text, str) for text in texts) and isinstance(self.layers, list)
        if not (are_kinds and isinstance(center, tuple | list) and are_numbers(*center, *given.values())):
            return False
        return self.shape in (None, *_KEYS) and self.sides != 0

    def _is_given(self, key: str) -> bool:
        value = getattr(self, key)
        return bool(value != _DEFAULTS[key] and value == value)

    def _check_room(self) -> None:
        """Raises KeyedError for numbers that fit no such shape."""
        if self.shape in ("flat", "flats") and self.diameter <= 2 * self.apothem:
            raise KeyedError("diameter", f"a round of this diameter has no flat {self.apothem:g} from its center")
        if self.shape == "slot":
            if self.length < self.width:
                raise KeyedError("length", "a slot is at least as long as it is wide")
            if self._is_given("corner_radius") and not self._is_given("length"):
                raise KeyedError("corner_radius", "a slot without length goes through, and has no corners")
        of_radius = self.apothem if self.count_of_sides else min(self.width, self.length) / 2
        of_chamfer = of_radius * math.tan(math.pi / self.count_of_sides) if self.count_of_sides else of_radius
        for key, most in (("corner_radius", of_radius), ("chamfer", of_chamfer)):
            if getattr(self, key) > most:
                raise KeyedError(key, f"expected {most:g} at most, found {getattr(self, key):g}")

    @property
    def count_of_sides(self) -> int:
        """The number of sides of a regular polygon or of flats; 0 for other shapes."""
        if self.shape in ("flats", "flat"):
            return self.count or (2 if self.shape == "flats" else 1)
        return SIDES.get(self.shape or "", self.sides or 0)

    @property
    def apothem(self) -> float:
        """The distance from the center to a side or flat; NaN for other shapes."""
        if not math.isnan(self.across_corners):
            return self.across_corners / 2 * math.cos(math.pi / self.count_of_sides)
        return self.distance if math.isnan(self.across_flats) else self.across_flats / 2

    @property
    def is_pocket(self) -> bool:
        """The part stands around it."""
        return self.inside or self.shape == "slot"


class DrawnPart(Part, frozen=True):
    """
    One whose drawing has been read.

    curves: as in drawing.Drawing. scale: mm per unit of it; NaN where it has the units of the program. passed_over:
    curves of the drawing that could not be read, with their count.
    """

    curves: tuple[tuple[complex, ...], ...] = ()
    scale: float = math.nan
    passed_over: str = ""


#: Of a part of which nothing is given; made late, since the class checks what it is given.
_DEFAULTS = {field.name: field.default for field in msgspec.structs.fields(Part)}
