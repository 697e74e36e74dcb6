#!/bin/bash
# PyPI loobric-linuxcnc 0.7.0: of a line of a tool table, `D.5` and `Z-.25` are lost without a word (tool without diameter and offset); a line in lower case, which LinuxCNC reads, stops the whole table.
set -eu
folder=$(mktemp -d); trap 'rm -rf "$folder"' EXIT; cd "$folder"
python3 -m venv python
python/bin/pip install -q --disable-pip-version-check loobric-linuxcnc==0.7.0 2> /dev/null
cat > run.py <<'END_OF_SCRIPT'
import loobric_linuxcnc as table

seen = [table.generate_tool_table_line(table.parse_tool_table_line(line)) for line in ("T6 P6 D0.5 Z-0.25", "T6 P6 D.5 Z-.25")]
try:
    table.parse_tool_table("T1 P1 D8\nt3 p3 d6")
except table.ToolTableError as error:
    seen.append(str(error))
print("loobric-linuxcnc 0.7.0, D0.5 Z-0.25, D.5 Z-.25, and t3 p3 d6:", *seen, sep="\n")
assert seen == ["T6 P6 D+0.500000 Z-0.250000", "T6 P6", "Error at line 2: Missing tool number in line: t3 p3 d6"], "changed"
END_OF_SCRIPT
python/bin/python run.py
