#!/bin/bash
# PyPI meerk40t 0.9.9100, its reading of G-code: X and Y are converted from mm to its own units, I and J are not, and R is passed over: half a circle of radius 5 becomes the line between its ends.
set -eu
folder=$(mktemp -d); trap 'rm -rf "$folder"' EXIT; cd "$folder"
python3 -m venv python
python/bin/pip install -q --disable-pip-version-check numpy==2.4.6 2> /dev/null
python/bin/pip install -q --disable-pip-version-check --no-deps meerk40t==0.9.9100 2> /dev/null
cat > run.py <<'END_OF_SCRIPT'
from unittest.mock import MagicMock

from meerk40t.core.units import UNITS_PER_MM
from meerk40t.grbl.gcodejob import GcodeJob
from meerk40t.svgelements import Matrix


class Job(GcodeJob):
    def plot_location(self, x, y, power):
        self.places.append((x / UNITS_PER_MM, y / UNITS_PER_MM))
        super().plot_location(x, y, power)


print("meerk40t 0.9.9100: X and Y from G1 X10 on, mm")
for blocks, seen in (
    ("G1 X10 F100\nG1 X15 Y5\nG1 X20 Y0", ((10, 20), (0, 5))),
    ("G1 X10 F100\nG2 X20 Y0 I5 J0", ((10, 20), (0, 0))),
    ("G1 X10 F100\nG2 X20 Y0 R5", ((10, 20), (0, 0))),
):
    job = Job(driver=MagicMock(), units_to_device_matrix=Matrix())
    job.places = []
    for block in blocks.split("\n"):
        job.write(block + "\n")
    while not job.execute():
        pass
    extents = tuple((round(float(min(axis))) + 0, round(float(max(axis))) + 0) for axis in zip(*job.places))
    print(blocks.replace("\n", ", "), extents)
    assert extents == seen, "changed"
END_OF_SCRIPT
python/bin/python run.py
