#!/bin/bash
# fig2dev 3.2.8b -L dxf: arcs of the drawing are left out without a word; circles become polylines of 72 lines.
set -eu
folder=$(mktemp -d); trap 'rm -rf "$folder"' EXIT; cd "$folder"
apt-get -qq download fig2dev=1:3.2.8b-3+deb12u2 2> /dev/null
dpkg -x fig2dev_*.deb unpacked
cat > drawing.fig <<'END_OF_DRAWING'
#FIG 3.2
Landscape
Center
Inches
Letter
100.00
Single
-2
1200 2
1 3 0 1 0 7 50 -1 -1 0.000 1 0.0000 2400 2400 1200 1200 2400 2400 3600 2400
5 1 0 1 0 7 50 -1 -1 0.000 0 1 0 0 6000.000 2400.000 7200 2400 6000 1200 4800 2400
2 1 0 1 0 7 50 -1 -1 0.000 0 0 -1 0 0 2
	 1200 7200 2400 7200
END_OF_DRAWING
unpacked/usr/bin/fig2dev -L dxf drawing.fig > drawing.dxf
seen=$(awk 'NR % 2 && $1 == 0 { getline; print $1; next } /ARC|POLYLINE|VERTEX|CIRCLE/ { print $1 }' drawing.dxf | grep -E '^(ARC|CIRCLE|LINE|POLYLINE|VERTEX)$' | sort | uniq -c | awk '{ print $1, $2 }')
echo "fig2dev 3.2.8b, a drawing of a circle, an arc and a line, in DXF:"
echo "$seen"
test "$seen" = "2 POLYLINE
74 VERTEX"
