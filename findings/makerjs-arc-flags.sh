#!/bin/bash
# npm makerjs 0.19.2, importer.fromSVGPathData: an arc whose flags stand without a blank (a5 5 0 0110 0, as minifiers write) has a center and angles of NaN; with blanks it is right.
set -eu
folder=$(mktemp -d); trap 'rm -rf "$folder"' EXIT; cd "$folder"
npm init -y > /dev/null
npm install --silent --no-audit --no-fund makerjs@0.19.2
cat > run.cjs <<'END'
const assert = require("assert");
const { importer } = require("makerjs");
for (const [data, seen] of [
  ["M0 0a5 5 0 0 1 10 0", { origin: [5, 0], startAngle: 0, endAngle: 180 }],
  ["M0 0a5 5 0 0110 0", { origin: [NaN, NaN], startAngle: NaN, endAngle: NaN }],
]) {
  const { origin, startAngle, endAngle } = Object.values(importer.fromSVGPathData(data).paths)[0];
  console.log("makerjs 0.19.2,", data, "becomes", { origin, startAngle, endAngle });
  assert.deepStrictEqual({ origin, startAngle, endAngle }, seen);
}
END
node run.cjs
