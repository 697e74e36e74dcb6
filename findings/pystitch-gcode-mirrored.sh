#!/bin/bash
# PyPI pystitch 1.0.1: its G-code is mirrored in X and in Y: stitches at (20, 5) and (20, 15) are written at (-20, -5) and (-20, -15); the extents in its comments are not.
set -eu
folder=$(mktemp -d); trap 'rm -rf "$folder"' EXIT; cd "$folder"
python3 -m venv python
python/bin/pip install -q --disable-pip-version-check pystitch==1.0.1 2> /dev/null
cat > run.py <<'END_OF_SCRIPT'
import re
from pathlib import Path

import pystitch

pattern = pystitch.EmbPattern()
for x, y in ((20, 5), (20, 15)):
    pattern.add_stitch_absolute(pystitch.STITCH, 10 * x, 10 * y)  # in tenths of a millimetre
pattern.add_command(pystitch.END)
pystitch.write(pattern, "stitches.gcode")
text = Path("stitches.gcode").read_text()
moves = [[float(value) + 0.0 for value in move] for move in re.findall(r"G0 X(-?[0-9.]+) Y(-?[0-9.]+)", text)]
extents = [float(value) for value in re.findall(r"EXTENTS_(?:LEFT|RIGHT|TOP|BOTTOM):(-?[0-9.]+)", text)]
print("pystitch 1.0.1, stitches at (20, 5) and (20, 15): moves", moves, "extents", extents)
assert [-20, -5] in moves and [-20, -15] in moves and min(extents) >= 0, "changed"
END_OF_SCRIPT
python/bin/python run.py
