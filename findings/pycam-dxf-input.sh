#!/bin/bash
# PyPI pycam 0.6.4 under Python 3, which it is for: every DXF drawing has "no supported elements": the names of elements are compared as bytes with text; read as text the same line is there.
set -eu
folder=$(mktemp -d); trap 'rm -rf "$folder"' EXIT; cd "$folder"
python3 -m venv python
python/bin/pip install -q --disable-pip-version-check --no-deps pycam==0.6.4 2> /dev/null
tr ' ' '\n' <<< "0 SECTION 2 ENTITIES 0 LINE 8 0 10 0 20 0 30 0 11 10 21 5 31 0 0 ENDSEC 0 EOF" > drawing.dxf
cat > run.py <<'END'
import sys
from unittest.mock import MagicMock

sys.modules.update({name: MagicMock() for name in ("gi", "gi.repository", "OpenGL", "OpenGL.GL", "OpenGL.GLU", "OpenGL.GLUT")})
from pycam.Importers.DXFImporter import DXFParser, import_model

with open("drawing.dxf") as text:
    lines = len(DXFParser(text).get_model()["lines"])
model = import_model("drawing.dxf")
print("pycam 0.6.4, a drawing of one line:", model, "read as text:", lines)
assert (model, lines) == (None, 1), "changed"
END
python/bin/python -W ignore run.py 2> messages || { cat messages; exit 1; }
