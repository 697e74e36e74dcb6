#!/bin/bash
# PyPI gCodeGen 1.1.1: a leading minus takes the whole sum, -3+5 is -8; 2**3**2 is 64, from left to right; each word is written with two digits, so that X1.2345, which is "copied unchangedly", becomes X1.23, and X.5 becomes X5.00 with a message.
set -eu
folder=$(mktemp -d); trap 'rm -rf "$folder"' EXIT; cd "$folder"
python3 -m venv python
# It asks for any antlr4 runtime; with those newer than 4.9 it cannot be imported.
python/bin/pip install -q --disable-pip-version-check gCodeGen==1.1.1 antlr4-python3-runtime==4.9.3 2> /dev/null
cat > run.py <<'END_OF_SCRIPT'
import contextlib
import io

from antlr4 import InputStream
from gCodeGen import gCodeGen

print("gCodeGen 1.1.1")
for program, seen in (
    ("G0 X(5-3)", "X2.00"),
    ("G0 X(-3+5)", "X-8.00"),
    ("G0 X(0-3+5)", "X2.00"),
    ("G0 X(2**3**2)", "X64.00"),
    ("G0 X(1/3)", "X0.33"),
    ("G0 X1.2345", "X1.23"),
    ("G0 X.5", "X5.00"),
):
    with contextlib.redirect_stdout(io.StringIO()) as output, contextlib.redirect_stderr(io.StringIO()):
        gCodeGen.run(InputStream(program + "\n"))
    written = output.getvalue().split()[-1]
    print(program, "->", written)
    assert written == seen, "changed"
END_OF_SCRIPT
python/bin/python run.py
