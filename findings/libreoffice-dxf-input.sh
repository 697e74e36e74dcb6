#!/bin/bash
# LibreOffice Draw 7.4.7, its DXF input: arcs of a polyline (bulges) become straight, ELLIPSE and SPLINE are left out without a word, of an INSERT with three columns one is drawn, and a quarter seen from below (extrusion 0, 0, -1) becomes the other three quarters of its circle.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
folder=$(mktemp -d); trap 'rm -rf "$folder"' EXIT; cd "$folder"
. "$here/unpack_debian"
unpack_debian "libreoffice-draw=4:7.4.7-1+deb12u14"
office="$PWD/unpacked/usr/lib/libreoffice"
rm -f "$office/share/registry"
ln -s .registry "$office/share/registry"
sed -i "s#file:///usr/lib/libreoffice#file://$office#g; s#file:///etc/libreoffice/registry#file://$office/share/registry#g" "$office"/program/*rc
cat > run.py <<'END'
import os
import re
import subprocess

BELOW = " 210 0 220 0 230 -1"
BLOCK = "0 BLOCK 8 0 2 B 70 0 10 0 20 0 30 0 3 B 0 LINE 8 0 10 0 20 0 30 0 11 10 21 5 31 0 0 ENDBLK 8 0"
CORNERS = "10 0 20 0 30 0 10 0 20 10 30 0 10 20 20 10 30 0 10 20 20 0 30 0"
FRAME = "0 LINE 8 0 10 -100 20 -100 30 0 11 -100 21 -99 31 0 0 LINE 8 0 10 100 20 99 30 0 11 100 21 100 31 0"
CASES = (
    ("LINE to (10, 5)", "LINE 8 0 10 0 20 0 30 0 11 10 21 5 31 0", [(0, 0), (10, 5)]),
    ("LWPOLYLINE, half a circle from 10 to 20", "LWPOLYLINE 8 0 90 2 70 0 10 10 20 0 42 1 10 20 20 0", [(10, 0), (20, 0)]),
    ("ARC about (30, 0), radius 10, 0 to 90 degrees", "ARC 8 0 10 30 20 0 30 0 40 10 50 0 51 90", [(30, 0), (40, 10)]),
    ("the same from below, x from -40 to -30, y from 0 to 10", "ARC 8 0 10 30 20 0 30 0 40 10 50 0 51 90" + BELOW, [(-40, -10), (-20, 10)]),
    ("ELLIPSE, a quarter", "ELLIPSE 8 0 10 0 20 0 30 0 11 10 21 0 31 0 40 0.5 41 0 42 1.5707963", []),
    ("SPLINE", f"SPLINE 8 0 70 8 71 3 72 8 73 4 74 0 40 0 40 0 40 0 40 0 40 1 40 1 40 1 40 1 {CORNERS}", []),
    ("INSERT of a line to (10, 5), three columns 30 apart", "INSERT 8 0 2 B 10 0 20 0 30 0 70 3 44 30", [(0, 0), (10, 5)]),
)


def extents(page):
    """Least and greatest x and y of what is drawn beside the frame, which is 200 wide, about its middle."""
    lines = [tuple(map(float, line)) for line in re.findall(r'x1="(\d+)" y1="(\d+)" x2="(\d+)" y2="(\d+)"', page)]
    (left, low, _, _), (right, _, _, high) = lines[-2:]
    unit, middle = (right - left) / 200, ((left + right) / 2, (low + high) / 2)
    points = [point for x1, y1, x2, y2 in lines[:-2] for point in ((x1, y1), (x2, y2))]
    for path in re.findall(r' d="(M[^"]*)"', page):
        points += [(float(x), float(y)) for x, y in re.findall(r"(\d+),(\d+)", path)]
    places = [(round((x - middle[0]) / unit) + 0, round((middle[1] - y) / unit) + 0) for x, y in points]
    assert "<ellipse" not in page and "<poly" not in page, "changed"
    return [tuple(map(function, zip(*places))) for function in (min, max)] if places else []


for number, (_, entity, _) in enumerate(CASES):
    groups = f"0 SECTION 2 HEADER 9 $ACADVER 1 AC1015 0 ENDSEC 0 SECTION 2 BLOCKS {BLOCK} 0 ENDSEC 0 SECTION 2 ENTITIES 0 {entity} {FRAME} 0 ENDSEC 0 EOF"
    with open(f"{number}.dxf", "w") as file:
        file.write("\n".join(groups.split()) + "\n")
command = ["unpacked/usr/lib/libreoffice/program/soffice.bin", "--headless", "--norestore", f"-env:UserInstallation=file://{os.getcwd()}/profile", "--convert-to", "svg"]
command += [f"{number}.dxf" for number in range(len(CASES))]
if subprocess.run(command, capture_output=True, timeout=300).returncode == 81:  # it has made its settings and wants to be started again
    subprocess.run(command, check=True, capture_output=True, timeout=300)
print("LibreOffice Draw 7.4.7: least and greatest x and y")
for number, (what, _, seen) in enumerate(CASES):
    with open(f"{number}.svg") as file:
        drawn = file.read()
    found = extents(drawn[drawn.index('class="Page"') :])
    print(f"{what}: {found or 'nothing'}")
    assert found == seen, "changed"
END
export HOME="$PWD" SAL_USE_VCLPLUGIN=svp LD_LIBRARY_PATH="$office/program:$PWD/unpacked/usr/lib/x86_64-linux-gnu:$PWD/unpacked/lib/x86_64-linux-gnu"
/usr/bin/python3 run.py
