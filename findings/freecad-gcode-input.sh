#!/bin/bash
# FreeCAD 0.20.2, its G-code input (gcode_pre): G20 is left out, so that an inch program is read in mm; a block without blanks (G1X50Y5) is lost, and X60 behind it belongs to the arc before; behind `G90 G0 X5` all moves are named G90, which moves nothing. Path.setFromGCode takes `G1 X10`, `X5` for one move to X5.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
folder=$(mktemp -d); trap 'rm -rf "$folder"' EXIT; cd "$folder"
. "$here/unpack_freecad"
seen=$(run_freecad <<'END'
sys.modules["FreeCADGui"] = MagicMock()
with contextlib.redirect_stdout(io.StringIO()):
    reader = importlib.import_module("PathScripts.post.gcode_pre")
for program in ("G20\nG1 X1\n", "G2 X10 Y0 I5\nG1X50Y5\nX60\n", "G90 G0 X5\nX6\nX7\n"):
    path = Path.Path([Path.Command(block) for block in reader.parse(program)])
    print(" / ".join(program.split("\n")[:-1]), "->", "; ".join(command.toGCode() for command in path.Commands), "| length", round(path.Length, 3))
path = Path.Path()
path.setFromGCode("G91\nG1 X10\nX5\n")
print("setFromGCode G91 / G1 X10 / X5 ->", "; ".join(command.toGCode() for command in path.Commands))
END
)
expect "FreeCAD 0.20.2, programs as they are read" "$seen" "G20 / G1 X1 -> G1 X1.000000 | length 1.0
G2 X10 Y0 I5 / G1X50Y5 / X60 -> G2 I5.000000 X10.000000 Y0.000000; G2 X60.000000 | length 15.708
G90 G0 X5 / X6 / X7 -> G90 G0.000000 X5.000000; G90 X6.000000; G90 X7.000000 | length 0.0
setFromGCode G91 / G1 X10 / X5 -> G91; G1 X5.000000"
