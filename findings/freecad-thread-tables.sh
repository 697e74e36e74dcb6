#!/bin/bash
# FreeCAD 0.20.2, the tables for thread milling: the external thread M27 x 2 has a major diameter of up to 29.962, M35 x 1.5 (6G) a least minor diameter above its greatest, and the pitch diameter of 2-6 (2A) belongs to another thread.
set -eu
folder=$(mktemp -d); trap 'rm -rf "$folder"' EXIT; cd "$folder"
apt-get -qq download freecad-common=0.20.2+dfsg1-4+deb12u1 2> /dev/null
dpkg -x freecad-common_*.deb unpacked
cat > run.py <<'END_OF_SCRIPT'
"""Prints the rows that contradict themselves: a limit above its other one, or a pitch diameter that is not 0.6495 P below the major one."""
import csv
import glob
import os

seen = []
for path in sorted(glob.glob("unpacked/usr/share/freecad/Mod/Path/Data/Threads/*.csv")):
    for row in csv.DictReader(open(path)):
        limits = {name: float(row[name]) for name in row if name.startswith("d")}
        pitch, inch = (1 / float(row["tpi"]), 1) if "tpi" in row else (float(row["pitch"]), 25.4)
        end = "Max" if "external" in path else "Min"
        apart = limits["dMajor" + end] - limits["dPitch" + end] - 0.649519 * pitch
        swapped = [kind for kind in ("Major", "Pitch", "Minor") if limits[f"d{kind}Min"] > limits[f"d{kind}Max"]]
        if abs(apart) > 0.0006 * inch or swapped:
            seen.append((os.path.basename(path)[:-4], row["name"], row["dMajor" + end], row["dPitch" + end], row["dMinorMin"], row["dMinorMax"]))
print("FreeCAD 0.20.2: table, thread, major and pitch diameter (greatest), minor diameter (least, greatest)")
print(*seen, sep="\n")
assert seen == [
    ("imperial-external-2A", "9/16-14", "0.5510", "0.5146", "0.4751", "0.4760"),
    ("imperial-external-2A", "2-6", "1.9971", "1.8528", "1.7065", "1.7245"),
    ("metric-external-4G6G", "M27 x 2", "29.962", "25.663", "24.325", "24.797"),
    ("metric-external-6G", "M35 x 1.5", "34.968", "33.994", "33.92", "33.344"),
], "changed"
END_OF_SCRIPT
python3 run.py
