#!/bin/bash
# PyPI viaconstructor 0.7.0, its HP-GL input: an arc (AA, AR) is drawn on another side of its circle, with a line to where it begins: from (10, 0) by 90 degrees about 0 it runs from (0, -10) to (10, 0); circles (CI) are left out without a word.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
folder=$(mktemp -d); trap 'rm -rf "$folder"' EXIT; cd "$folder"
. "$here/unpack_viaconstructor"
run_viaconstructor <<'END'
from viaconstructor.input_plugins.hpglread import DrawReader

print("viaconstructor 0.7.0: the first line, and where the drawing ends")
for plot, seen in (
    ("PU0,0;PD400,0,400,400;", [(0, 0), (10, 0), (10, 10)]),
    ("PU400,0;PD;AA0,0,90;", [(10, 0), (0, -10), (10, 0)]),
    ("PU400,0;PD;AR-400,0,90;", [(10, 0), (0, -10), (10, 0)]),
    ("PU0,400;PD;AA0,0,90;", [(0, 10), (-10, 0), (0, -10)]),
    ("PU0,0;CI400;", []),
):
    with open("plot.hpgl", "w") as file:
        file.write(plot)
    with contextlib.redirect_stdout(io.StringIO()):
        lines = DrawReader("plot.hpgl", None).get_segments()
    corners = [lines[0].start, lines[0].end, lines[-1].end] if lines else []
    corners = [(round(float(x)) + 0, round(float(y)) + 0) for x, y, *_ in corners]
    print(plot, corners)
    assert corners == seen, "changed"
END
