#!/bin/bash
# PyPI cadquery-ocp-novtk 8.0.1.1.0 (OpenCASCADE): BRepOffsetAPI_MakeOffset draws a slot round an open line of two elements, one behind the other too; a line of one element has no offset.
set -eu
folder=$(mktemp -d); trap 'rm -rf "$folder"' EXIT; cd "$folder"
python3 -m venv venv
venv/bin/pip install --quiet --disable-pip-version-check --only-binary :all: cadquery-ocp-novtk==8.0.1.1.0 2> /dev/null
cat > run.py <<'END_OF_FILE'
from OCP.BRepBuilderAPI import BRepBuilderAPI_MakePolygon
from OCP.BRepOffsetAPI import BRepOffsetAPI_MakeOffset
from OCP.GeomAbs import GeomAbs_Arc
from OCP.gp import gp_Pnt


def done(*points):
    polygon = BRepBuilderAPI_MakePolygon()
    for x, y in points:
        polygon.Add(gp_Pnt(x, y, 0))
    offset = BRepOffsetAPI_MakeOffset(polygon.Wire(), GeomAbs_Arc, False)
    offset.Perform(4)
    return offset.IsDone()


bent, collinear, straight = done((0, 0), (20, 0), (20, 20)), done((0, 0), (10, 0), (20, 0)), done((0, 0), (20, 0))
print(f"cadquery-ocp-novtk 8.0.1.1.0, offset by 4 done: bent {bent}, two lines in one direction {collinear}, of one line {straight}")
assert (bent, collinear, straight) == (True, True, False)
END_OF_FILE
venv/bin/python run.py
