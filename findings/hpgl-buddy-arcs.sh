#!/bin/bash
# PyPI hpgl-buddy 1.8.0: the extent of a plot, checked against the sheet before plotting, leaves out arcs and circles and calls itself reliable.
set -eu
folder=$(mktemp -d); trap 'rm -rf "$folder"' EXIT; cd "$folder"
python3 -m venv python
python/bin/pip install -q --disable-pip-version-check hpgl-buddy==1.8.0 2> /dev/null
cat > run.py <<'END_OF_SCRIPT'
from hpgl_buddy.hpgl.analyze import plotted_extent
from hpgl_buddy.hpgl.parser import parse_hpgl

for plot, expected in (
    ("PU0,0;PD1000,0,1000,1000;", (0, 0, 1000, 1000)),
    ("PU0,0;PD1000,0;AA1000,1000,90;", (0, 0, 1000, 0)),
    ("PU5000,5000;CI4000;", (5000, 5000, 5000, 5000)),
):
    extent = plotted_extent(parse_hpgl(plot.encode()))
    seen = extent.xmin, extent.ymin, extent.xmax, extent.ymax
    print(f"hpgl-buddy 1.8.0, {plot} reaches from {seen[:2]} to {seen[2:]}, reliable: {extent.reliable}")
    assert seen == expected and extent.reliable, "changed"
END_OF_SCRIPT
python/bin/python run.py
