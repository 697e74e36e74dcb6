#!/bin/bash
# PyPI python-hpgl 0.1.0: the pen commands take no place to go to: `PU0,0;` is an unknown command; `PU;PA0,0;` is read.
set -eu
folder=$(mktemp -d); trap 'rm -rf "$folder"' EXIT; cd "$folder"
python3 -m venv venv
venv/bin/pip install --quiet --disable-pip-version-check python-hpgl==0.1.0 2> /dev/null
cat > run.py <<'END_OF_FILE'
import io

import hpgl


def told(text):
    try:
        paths, *_ = hpgl.parse_hpgl(io.StringIO(text))
        return f"{len(paths)} path"
    except Exception as error:
        return str(error)


seen = [told("IN;SP1;PU;PA0,0;PD;PA100,0;"), told("IN;SP1;PU0,0;PD100,0;")]
print("python-hpgl 0.1.0, a line by PA, and by PU and PD alone:", seen)
assert seen == ["1 path", "Unknown HPGL command (0,)"]
END_OF_FILE
venv/bin/python run.py
