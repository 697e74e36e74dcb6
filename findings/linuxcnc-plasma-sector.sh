#!/bin/bash
# LinuxCNC 2.9.0~pre1, sector.py of its shapes for plasma cutting: the kerf widens the arc about the apex of the cut lines and leaves the sides where they are: with a kerf of 2, a sector of radius 50 measures 49.59 in its middle at 90 degrees, and 47.59 at 270; without a kerf both measure 50, and a circle is right with one.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
folder=$(mktemp -d); trap 'rm -rf "$folder"' EXIT; cd "$folder"
. "$here/unpack_rs274"
cat > run.py <<'END'
import re
import sys
from math import hypot, radians, sin

sys.path.insert(0, "unpacked/usr/lib/python3/dist-packages")
from plasmac import circle, sector


class Numbers:
    """What the shapes ask of the window that shows them."""

    def conv_is_float(self, text):
        return True, float(text)

    def conv_is_int(self, text):
        return True, int(text)


def radius_of_cut(shape, *values):
    with open("before.ngc", "w") as program:
        program.write("(new)\n")
    assert not shape.preview(Numbers(), "part.tmp", "part.ngc", "before.ngc", 0, "steel", "G21", "M30", "0", "0", *values)
    with open("part.ngc") as program:
        return hypot(*map(float, re.search(r"g2 .* i(\S+) j(\S+)", program.read()).groups()))


for kerf in (0, 2):
    size = radius_of_cut(circle, True, "0", "0", kerf, True, False, "0", 0, 60, "100", []) - kerf / 2
    print(f"linuxcnc-uspace 2.9.0~pre1, kerf {kerf}, radius of a part: circle of 100", round(size, 2))
    assert abs(size - 50) < 0.01, "changed"
    for angle, seen in ((90, (50, 49.59)), (270, (50, 47.59))):
        # The sides of the part lie half a kerf beside the cut lines, which meet in (0, 0), so its own apex lies on the line that halves the angle.
        apex = kerf / 2 / sin(radians(angle / 2))
        size = radius_of_cut(sector, "0", "0", kerf, True, "50", str(angle), "0") - kerf / 2 - apex
        print(f"sector of {angle} degrees, radius 50, in its middle:", round(size, 2))
        assert abs(size - seen[kerf > 0]) < 0.01, "changed"
END
/usr/bin/python3 run.py
