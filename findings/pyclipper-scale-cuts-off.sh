#!/bin/bash
# PyPI pyclipper 1.4.0: scale_to_clipper cuts off instead of rounding: 0.29 by 100 becomes 28.
set -eu
folder=$(mktemp -d); trap 'rm -rf "$folder"' EXIT; cd "$folder"
python3 -m venv venv
venv/bin/pip install --quiet --disable-pip-version-check pyclipper==1.4.0 2> /dev/null
venv/bin/python - <<'END'
from pyclipper import scale_from_clipper, scale_to_clipper

values = (0.29, -0.29, 1.13)
scaled = [scale_to_clipper(value, 100) for value in values]
print("pyclipper 1.4.0, by 100:", dict(zip(values, scaled)), "and back:", [scale_from_clipper(value, 100) for value in scaled])
assert scaled == [28, -28, 112]
END
