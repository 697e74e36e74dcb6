"""What is taken as the same; without NumPy, since rules name it."""

from __future__ import annotations

#: The arithmetic shifts a point by no more than this [mm]; a thousandth of the least increment.
ROUNDING = 1e-6
#: Values that differ by no more than this share are the same: the last bits of their formulas differ by that.
SHARE = 1e-9
#: R up to this [mm], of either sign, is no cutter: it adjusts the path of one's center (builder's guide to G12.1).
ADJUSTMENT = 0.254
#: A length below this [mm] is no movement, and an arc whose ends are so near to each other is a full circle.
ZERO = 1e-9
#: Points nearer than this [mm] are one point, and lines so near to each other touch: both may be shifted by ROUNDING.
TOUCH = 2e-6
#: Ends of walls nearer than this [mm] are one corner. Where walls are cut, a point moves by up to TOUCH to the node
#: that it becomes part of, and the areas of GEOS move it again.
CORNER = 10 * TOUCH
#: Crossings that a contour may have for each of its walls, and beyond that.
CROSSINGS, FREE_CROSSINGS = 4, 1000
#: Farther from the center than this [mm] reaches no lathe; what is there would take the digits of all else.
FARTHEST = 1e5
#: The same for the centers of arcs: of 1e9 seven digits are left behind the point.
FARTHEST_CENTER = 1e9
#: Chords that the arcs of a loop may have, each once, and those of a file.
CHORDS, CHORDS_OF_FILE = 400_000, 4_000_000
