#!/bin/bash
# PyPI pyiges 0.3.4: a line whose entry names a matrix (124: moved by 100 along X) is given where it was before it, and an arc that names none, as most do, raises KeyError when it is asked for its matrix or drawn.
set -eu
folder=$(mktemp -d); trap 'rm -rf "$folder"' EXIT; cd "$folder"
python3 -m venv python
python/bin/pip install -q --disable-pip-version-check pyiges==0.3.4 2> /dev/null
cat > run.py <<'END_OF_SCRIPT'
import pyiges

# Kind, parameters and the entry of the matrix (0: none) of each entity.
ENTITIES = (
    (124, "1.,0.,0.,100.,0.,1.,0.,0.,0.,0.,1.,0.", 0),
    (110, "0.,0.,0.,10.,0.,0.", 1),
    (100, "0.,0.,0.,10.,0.,0.,10.", 1),
    (100, "0.,0.,0.,10.,0.,0.,10.", 0),
)


def fixed(text, section, number):
    return f"{text:<72}{section}{number:7d}\n"


def fields(*values):
    return "".join(f"{value:>8}" for value in values)


entries, parameters = "", ""
for number, (kind, values, matrix) in enumerate(ENTITIES, 1):
    entry = 2 * number - 1
    entries += fixed(fields(kind, number, 0, 0, 0, 0, matrix, 0, "00000000"), "D", entry)
    entries += fixed(fields(kind, 0, 0, 1, 0, "", "", "", 0), "D", entry + 1)
    parameters += fixed(f"{f'{kind},{values};':<64}{entry:8d}", "P", number)
with open("part.igs", "w") as file:
    file.write(fixed("part", "S", 1) + fixed("1H,,1H;,4Hpart,4Hpart,1Hx,1Hx,32,38,6,308,15,4Hpart,1.0,2,2HMM,1,0.01,", "G", 1))
    file.write(fixed("15H20261128.000000,0.0001,100.0,1Hx,1Hx,11,0,15H20261128.000000;", "G", 2))
    file.write(entries + parameters + fixed(f"S{1:7d}G{2:7d}D{len(ENTITIES) * 2:7d}P{len(ENTITIES):7d}", "T", 1))

drawing = pyiges.read("part.igs")
ends = drawing.lines()[0].coordinates.tolist()
moved, plain = drawing.circular_arcs()
try:
    without = plain.transform
except KeyError as error:
    without = repr(error)
print("pyiges 0.3.4, line from 0 to 10 moved by 100:", ends)
print("arc with a matrix, its matrix moves X by", moved.transform.t1, "and without one:", without)
assert ends == [[0, 0, 0], [10, 0, 0]] and moved.transform.t1 == 100 and without == "KeyError(0)", "changed"
END_OF_SCRIPT
python/bin/python run.py
