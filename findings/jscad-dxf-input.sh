#!/bin/bash
# npm @jscad/dxf-deserializer 2.3.30: an INSERT is passed over, and the block is drawn where it was defined, once; the bulge of a POLYLINE becomes a straight line, that of an LWPOLYLINE an arc.
set -eu
folder=$(mktemp -d); trap 'rm -rf "$folder"' EXIT; cd "$folder"
npm init -y > /dev/null
npm install --silent --no-audit --no-fund @jscad/dxf-deserializer@2.3.30 @jscad/modeling@2.13.0
cat > run.cjs <<'END'
const assert = require("assert");
const { deserialize } = require("@jscad/dxf-deserializer");
const { measureBoundingBox } = require("@jscad/modeling").measurements;
const section = (name, body) => ["0", "SECTION", "2", name, ...body, "0", "ENDSEC"];
const line = ["0", "LINE", "8", "0", "10", "0", "20", "0", "11", "5", "21", "0"];
const block = ["0", "BLOCK", "8", "0", "2", "B", "70", "0", "10", "0", "20", "0", ...line, "0", "ENDBLK", "8", "0"];
const insert = (x) => ["0", "INSERT", "8", "0", "2", "B", "10", x, "20", "50", "41", "2"];
const vertex = (x, bulge) => ["0", "VERTEX", "8", "0", "10", x, "20", "0", "42", bulge];
const extents = (...sections) =>
  [deserialize({ output: "geometry", filename: "drawing.dxf" }, [...sections.flat(), "0", "EOF", ""].join("\n"))].flat(9)
    .map((geometry) => measureBoundingBox(geometry).map((corner) => corner.slice(0, 2).map((value) => Math.round(value * 1000) / 1000 + 0)));
for (const [what, sections, seen] of [
  ["a block of a line, inserted at (100, 50) and (200, 50)", [section("BLOCKS", block), section("ENTITIES", [...insert("100"), ...insert("200")])], [[[0, 0], [5, 0]]]],
  ["LWPOLYLINE of half a circle", [section("ENTITIES", ["0", "LWPOLYLINE", "8", "0", "90", "2", "70", "0", "10", "0", "20", "0", "42", "1", "10", "10", "20", "0"])], [[[0, -5], [10, 0]]]],
  ["POLYLINE of half a circle", [section("ENTITIES", ["0", "POLYLINE", "8", "0", "66", "1", "70", "0", ...vertex("0", "1"), ...vertex("10", "0"), "0", "SEQEND"])], [[[0, 0], [10, 0]]]],
]) {
  const found = extents(...sections);
  console.log("@jscad/dxf-deserializer 2.3.30,", what, JSON.stringify(found));
  assert.deepStrictEqual(found, seen);
}
END
node run.cjs
