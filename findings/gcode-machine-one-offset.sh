#!/bin/bash
# PyPI gcode-machine 1.0.3: an arc with I alone (J0 left out) is refused: "No offsets in plane".
set -eu
folder=$(mktemp -d); trap 'rm -rf "$folder"' EXIT; cd "$folder"
python3 -m venv venv
venv/bin/pip install --quiet --disable-pip-version-check gcode-machine==1.0.3 2> /dev/null
venv/bin/python - <<'END'
from gcode_machine import GcodeMachine


def lines(block: str) -> str:
    machine = GcodeMachine()
    machine.do_fractionize_arcs = True
    machine.set_line(block)
    machine.strip()
    machine.tidy()
    machine.parse_state()
    try:
        return f"{len(machine.fractionize())} lines"
    except Exception as error:
        return str(error)


both, alone = lines("G2 X10 Y0 I5 J0 F100"), lines("G2 X10 Y0 I5 F100")
print("gcode-machine 1.0.3, I5 J0:", both, "; I5:", alone)
assert both.endswith("lines") and "No offsets in plane" in alone
END
