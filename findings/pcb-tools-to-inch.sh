#!/bin/bash
# PyPI pcb-tools 0.1.6: to_inch of a drill file converts its tools, and leaves its holes in millimetres: a hole of 0.039 inch at X10 inch instead of X0.394.
set -eu
folder=$(mktemp -d); trap 'rm -rf "$folder"' EXIT; cd "$folder"
python3 -m venv python
python/bin/pip install -q --disable-pip-version-check pcb-tools==0.1.6 2> /dev/null
cat > run.py <<'END_OF_SCRIPT'
import gerber

file = gerber.loads("M48\nMETRIC,TZ\nT1C1.000\n%\nG90\nG05\nT1\nX010000Y005000\nX020000Y005000\nM30\n", "holes.drl")


def holes():
    return [round(tool.diameter, 4) for tool in file.tools.values()], [hit.position for hit in file.hits]


before = holes()
file.to_inch()
after = holes()
print("pcb-tools 0.1.6, diameters and places in mm:", *before)
print("behind to_inch, units", file.units + ":", *after)
assert before == ([1.0], [(10.0, 5.0), (20.0, 5.0)]) and after == ([0.0394], before[1]) and file.units == "inch", "changed"
END_OF_SCRIPT
python/bin/python run.py
