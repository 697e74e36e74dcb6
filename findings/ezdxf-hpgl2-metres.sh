#!/bin/bash
# PyPI ezdxf 1.4.5, hpgl2.to_dxf: plotter units (0.025 mm) are written as they are below a header that says metres: a line of 25 mm is 1000 m.
set -eu
folder=$(mktemp -d); trap 'rm -rf "$folder"' EXIT; cd "$folder"
python3 -m venv python
python/bin/pip install -q --disable-pip-version-check ezdxf==1.4.5 pillow==12.0.0 2> /dev/null
cat > run.py <<'END_OF_SCRIPT'
from ezdxf import units
from ezdxf.addons.hpgl2 import api

drawing = api.to_dxf(b"\x1b%1BIN;SP1;PU0,0;PD1000,0;PU;")
(line,) = drawing.modelspace().query("LINE")
length, unit = line.dxf.start.distance(line.dxf.end), units.unit_name(drawing.units)
print("ezdxf 1.4.5, 1000 plotter units (25 mm) in DXF:", length, unit)
assert (round(length, 9), unit) == (1000, "Meters"), "changed"
END_OF_SCRIPT
python/bin/python run.py
