#!/bin/bash
# Inkscape 1.2.2, its gcodetools for lathes: the length of the part is X and its radius Z unless remapped, the ways between the cuts are G01 at twice the feed, and the end moves Y.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
folder=$(mktemp -d); trap 'rm -rf "$folder"' EXIT; cd "$folder"
. "$here/unpack_inkscape"
# A shaft of radius 10 from 100 to 60, with a shoulder of radius 20 from there to 40: the bottom of the page is its axis.
cat > shaft.svg <<'END'
<svg xmlns="http://www.w3.org/2000/svg" xmlns:inkscape="http://www.inkscape.org/namespaces/inkscape" width="200mm" height="100mm" viewBox="0 0 200 100">
<g inkscape:groupmode="layer" id="layer1" inkscape:label="shaft"><path id="shaft" d="M 100,90 L 60,90 L 60,80 L 40,80" style="fill:none;stroke:#000"/></g></svg>
END
extension other/gcodetools/gcodetools --active-tab='"orientation"' --orientation-points-count=2 --unit="G21 (All units in mm)" shaft.svg > oriented.svg
extension other/gcodetools/gcodetools --id=shaft --active-tab='"lathe"' --lathe-width=21 --lathe-fine-cut-width=0.5 --postprocessor=" " \
    --filename=shaft.ngc --directory="$folder" --add-numeric-suffix-to-filename=false oriented.svg > result.svg 2> messages
moves=$(grep -E '^G0[01]' shaft.ngc | sed -E 's/([XYZF]) ?(-?[0-9]+\.?[0-9]*)/\1\2/g; s/\.0+( |$)/ /g; s/ +/ /g; s/ $//' | uniq)
echo "Inkscape 1.2.2 gcodetools, lathe, stock of radius 21:"
echo "$moves" | head -6
echo ...
echo "$moves" | tail -3
seen="$(grep -c '^G01' <<< "$moves") G01, $(grep -c '^G00' <<< "$moves") G00: $(echo "$moves" | sed -n 4,5p | xargs), $(echo "$moves" | tail -1)"
test "$seen" = "125 G01, 1 G00: G01 X100 Z21 F400 G01 X40 Z21 F400, G00 X0 Y0" || { echo "changed: $seen"; exit 1; }
