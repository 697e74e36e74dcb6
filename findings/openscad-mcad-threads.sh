#!/bin/bash
# MCAD 2019.05 of OpenSCAD, nuts_and_bolts.scad: the thread of M2 has a major diameter of 1.6, and a comma that is missing behind M20 makes its nut 15 high instead of 16, those of M24 and M30 -1, and that of M36 undefined.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
folder=$(mktemp -d); trap 'rm -rf "$folder"' EXIT; cd "$folder"
. "$here/unpack_debian"
unpack_debian openscad=2021.01-6
unpack_debian openscad-mcad=2019.05-1
export LD_LIBRARY_PATH="$PWD/unpacked/usr/lib/x86_64-linux-gnu" OPENSCADPATH="$PWD/unpacked/usr/share/openscad/libraries" HOME="$PWD"
cat > table.scad <<'END'
include <MCAD/nuts_and_bolts.scad>
for (size = [2, 3, 8, 16, 20, 24, 30, 36])
    echo(str("M", size), COURSE_METRIC_BOLT_MAJOR_THREAD_DIAMETERS[size], METRIC_NUT_THICKNESS[size]);
END
unpacked/usr/bin/openscad -o table.echo table.scad 2> messages
echo "MCAD 2019.05: thread, its major diameter, height of its nut"
cat table.echo
seen=$(sed 's/ECHO: //; s/"//g' table.echo | xargs)
test "$seen" = "M2, 1.6, 1.6 M3, 2.98, 2.4 M8, 7.972, 6.5 M16, 15.962, 13 M20, 19.958, 15 M24, 23.952, -1 M30, 29.947, -1 M36, 35.94, undef" || { echo changed; exit 1; }
