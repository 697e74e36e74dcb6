#!/bin/bash
# PyPI gerbyx 0.3.0: the format that a drill file (Excellon) states is replaced by a guess, with a warning: METRIC,TZ with X010000 is a hole at 100 mm instead of 10, INCH,LZ with X01 at 254 instead of 25.4; of a Gerber file in inch, X1 is at 1 mm, and an arc of a quarter by G74 runs about a point on the other side.
set -eu
folder=$(mktemp -d); trap 'rm -rf "$folder"' EXIT; cd "$folder"
python3 -m venv python
python/bin/pip install -q --disable-pip-version-check gerbyx==0.3.0 2> /dev/null
cat > run.py <<'END_OF_SCRIPT'
import contextlib
import io

with contextlib.redirect_stdout(io.StringIO()), contextlib.redirect_stderr(io.StringIO()):
    from gerbyx.dispatcher import process_file

GERBER = "%FSLAX34Y34*%\n%MOMM*%\n%ADD10C,0.1*%\nD10*\nG01*\nX100000Y0D02*\n"


def extents(name, text):
    """Least and greatest X and Y of what is drawn, mm by its default, without the tool."""
    with open(name, "w") as file:
        file.write(text)
    with contextlib.redirect_stdout(io.StringIO()), contextlib.redirect_stderr(io.StringIO()):
        shapes = process_file(name).geometries
    left, bottom, right, top = shapes[0].bounds if len(shapes) == 1 else (None,) * 4
    return round((left + right) / 2, 1) + 0, round((bottom + top) / 2, 1) + 0, round(right - left, 1)


print("gerbyx 0.3.0: middle of the hole or arc, and its width")
for what, name, text, seen in (
    ("METRIC,TZ X010000Y005000", "a.drl", "M48\nMETRIC,TZ\nT1C1.0\n%\nT1\nX010000Y005000\nM30\n", (100, 50, 1)),
    ("INCH,LZ X01Y005", "b.drl", "M48\nINCH,LZ\nT1C.039\n%\nT1\nX01Y005\nM30\n", (254, 127, 1)),
    ("METRIC X10.0Y5.0", "c.drl", "M48\nMETRIC\nT1C1.0\n%\nT1\nX10.0Y5.0\nM30\n", (10, 5, 1)),
    ("Gerber in inch, flash of 0.1 at X1", "d.gbr", "%FSLAX24Y24*%\n%MOIN*%\n%ADD11C,0.1*%\nD11*\nX10000Y0D03*\nM02*\n", (1, 0, 0.1)),
    ("G75 G03 X0 Y10 I-10 from (10, 0)", "e.gbr", GERBER + "G75*\nG03*\nX0Y100000I-100000J0D01*\nM02*\n", (5, 5, 10.1)),
    ("G74 G03 X0 Y10 I10 from (10, 0)", "f.gbr", GERBER + "G74*\nG03*\nX0Y100000I100000J0D01*\nM02*\n", (20, 0, 32.4)),
):
    found = extents(name, text)
    print(f"{what}: {found}")
    assert found == seen, "changed"
END_OF_SCRIPT
python/bin/python run.py
