#!/bin/bash
# npm @jscad/gcode-deserializer 0.2.1: a block with X0 or Y0 is passed over: three corners of a path at 0 are lost; 100 farther out it keeps them.
set -eu
folder=$(mktemp -d); trap 'rm -rf "$folder"' EXIT; cd "$folder"
npm init -y > /dev/null
npm install --silent --no-audit --no-fund @jscad/gcode-deserializer@0.2.1
cat > run.mjs <<'END_OF_SCRIPT'
import assert from "assert";
import gcode from "@jscad/gcode-deserializer";

// The points of the path, which the package moves by -100.
function path(shift) {
  const corners = [[1, 5], [10, 5], [10, 0], [0, 0], [0, 5], [5, 5]];
  const lines = corners.map(([x, y], number) => `G1 X${x + shift} Y${y + shift} E${number}`);
  const text = gcode.deserialize(`G21\nG90\nG0 Z1\n${lines.join("\n")}\n`, undefined, { output: "csg", addMetaData: false });
  return JSON.parse(text.match(/\[\[.*?\]\]/)[0]).map(([x, y]) => [x + 100 - shift, y + 100 - shift]);
}

const seen = { near: path(0), far: path(100) };
console.log("@jscad/gcode-deserializer 0.2.1, (1, 5), (10, 5), (10, 0), (0, 0), (0, 5), (5, 5), as it is and 100 farther out:", JSON.stringify(seen));
assert.deepStrictEqual(seen, { near: [[1, 5], [10, 5], [5, 5]], far: [[1, 5], [10, 5], [10, 0], [0, 0], [0, 5], [5, 5]] });
END_OF_SCRIPT
node run.mjs
