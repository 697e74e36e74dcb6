#!/bin/bash
# PyPI dxf2svg 0.1.4: an ARC is drawn as its whole circle.
set -eu
folder=$(mktemp -d); trap 'rm -rf "$folder"' EXIT; cd "$folder"
python3 -m venv venv
venv/bin/pip install --quiet --disable-pip-version-check dxf2svg==0.1.4 2> /dev/null
venv/bin/python - <<'END'
import ezdxf
from dxf2svg.pycore import save_svg_from_dxf

drawing = ezdxf.new("R2000")
drawing.modelspace().add_line((0, -5), (10, 5))
drawing.modelspace().add_arc((0, 0), 5, 0, 90)
drawing.saveas("quarter.dxf")
save_svg_from_dxf("quarter.dxf", "quarter.svg")
with open("quarter.svg", encoding="utf-8") as picture:
    shapes = [text.split(" ")[0] for text in picture.read().split("<") if text.startswith(("circle", "line ", "path", "arc"))]
print("dxf2svg 0.1.4, a line and an arc of 90 degrees become:", shapes)
assert shapes == ["line", "circle"]
END
