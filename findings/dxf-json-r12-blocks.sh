#!/bin/bash
# npm dxf-json 0.14.1, and @mlightcad/dxf-json 1.2.8 that came of it: an R12 drawing that defines a block has no entities, without a word: its ENDBLK is looked for with a subclass marker, which R12 does not have.
set -eu
folder=$(mktemp -d); trap 'rm -rf "$folder"' EXIT; cd "$folder"
npm init -y > /dev/null
npm install --silent --no-audit --no-fund dxf-json@0.14.1 @mlightcad/dxf-json@1.2.8
cat > run.cjs <<'END'
const assert = require("assert");
const line = ["0", "LINE", "8", "0", "10", "0", "20", "0", "11", "10", "21", "0"];
const entities = ["0", "SECTION", "2", "ENTITIES", ...line, ...line, "0", "ENDSEC", "0", "EOF", ""];
const block = (end) => ["0", "SECTION", "2", "BLOCKS", "0", "BLOCK", "8", "0", "2", "HOLE", "70", "0", "10", "0", "20", "0", "3", "HOLE",
  ...line, "0", "ENDBLK", "8", "0", ...end, "0", "ENDSEC"];
const drawings = { "without a block": [], "with a block, R12": block([]), "with a block, marker behind its end": block(["100", "AcDbBlockEnd"]) };
for (const name of ["dxf-json", "@mlightcad/dxf-json"]) {
  const { DxfParser } = require(name);
  const counts = Object.entries(drawings).map(([what, blocks]) => [what, new DxfParser().parseSync([...blocks, ...entities].join("\n")).entities.length]);
  console.log(name, "two lines, entities found:", counts);
  assert.deepStrictEqual(counts.map(([, count]) => count), [2, 0, 2]);
}
END
node run.cjs
