#!/bin/bash
# dia 0.97.3, its HP-GL: an arc of 87 degrees is plotted by 447, a whole turn more, and 10 cm are 10000 plotter units (25 cm).
set -eu
here=$(cd "$(dirname "$0")" && pwd)
folder=$(mktemp -d); trap 'rm -rf "$folder"' EXIT; cd "$folder"
. "$here/unpack_dia"
# A line of 10 cm, and an arc between the same ends whose height is 2 cm: radius 7.25, 87.2 degrees.
cat > drawing.dia <<'END'
<?xml version="1.0" encoding="UTF-8"?>
<dia:diagram xmlns:dia="http://www.lysator.liu.se/~alla/dia/"><dia:layer name="Background" visible="true" active="true">
<dia:object type="Standard - Line" version="0" id="O0"><dia:attribute name="obj_pos"><dia:point val="0,0"/></dia:attribute>
<dia:attribute name="conn_endpoints"><dia:point val="0,0"/><dia:point val="10,0"/></dia:attribute></dia:object>
<dia:object type="Standard - Arc" version="0" id="O1"><dia:attribute name="obj_pos"><dia:point val="0,0"/></dia:attribute>
<dia:attribute name="conn_endpoints"><dia:point val="0,0"/><dia:point val="10,0"/></dia:attribute>
<dia:attribute name="curve_distance"><dia:real val="2"/></dia:attribute></dia:object></dia:layer></dia:diagram>
END
convert_by_dia drawing.dia drawing.dxf
convert_by_dia drawing.dia drawing.hpgl
arc=$(paste -sd' ' drawing.dxf | grep -oE '50 226\.[0-9]+ +51 313\.[0-9]+' | tr -s ' ')
plot=$(grep -E 'PU|PD|AA' drawing.hpgl | sed 's/SP[0-9];//' | xargs)
echo "dia 0.97.3, the arc in DXF: $arc; line and arc in HP-GL: $plot"
test "$arc; $plot" = "50 226.397 51 313.603; PU0,0;PD10000,0; PU0,0;PD;AA5000,5250,447;" || { echo changed; exit 1; }
