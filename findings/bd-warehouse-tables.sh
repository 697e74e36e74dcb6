#!/bin/bash
# PyPI bd-warehouse 0.4.0, tables of parts for turned shafts and bores: the retaining ring for a shaft of 48 (DIN 471) is 2 thick and its groove 1.85 wide, that for a bore of 82 (DIN 472) 3 and 2.65; the tap drills of M22 x 2.5 and M21 x 2 are 1 too small, 18.5 instead of 19.5.
set -eu
folder=$(mktemp -d); trap 'rm -rf "$folder"' EXIT; cd "$folder"
python3 -m venv python
python/bin/pip install -q --disable-pip-version-check --no-deps bd-warehouse==0.4.0 2> /dev/null
cat > run.py <<'END'
import csv
import glob
import re


def rows(name):
    with open(glob.glob(f"python/lib/python3*/site-packages/bd_warehouse/data/{name}.csv")[0]) as file:
        return list(csv.DictReader(file))


print("bd-warehouse 0.4.0")
for name, seen in (("din471", [("48", "2", "1.85")]), ("din472", [("82", "3", "2.65")])):
    table = rows(name)
    thick = [(row["d1"], row["s"], row["m"]) for row in table if float(row["s"]) >= float(row["m"])]
    print(f"{name}, {len(table)} rings: diameter, thickness of those thicker than their groove, its width: {thick}")
    assert thick == seen, "changed"
small = []
for row in rows("tap_hole_sizes"):
    metric = re.fullmatch(r"M([\d.]+)-([\d.]+)", row["Size"])
    if metric and float(row["Soft"]) < float(metric[1]) - float(metric[2]) - 0.15:
        small.append((row["Size"], row["Soft"]))
print("tap drills more than 0.15 below diameter less pitch:", small)
assert small == [("M21-2", "18"), ("M22-2.5", "18.5")], "changed"
END
python/bin/python run.py
