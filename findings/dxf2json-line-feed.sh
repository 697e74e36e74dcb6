#!/bin/bash
# npm dxf2json 1.0.3: a DXF with line feeds alone has no entities and no header; with carriage returns it is read.
set -eu
folder=$(mktemp -d); trap 'rm -rf "$folder"' EXIT; cd "$folder"
npm init -y > /dev/null
npm install --silent --no-audit --no-fund dxf2json@1.0.3
cat > run.cjs <<'END'
const assert = require("assert");
const { DxfParser } = require("dxf2json");
const drawing = [0, "SECTION", 2, "HEADER", 9, "$INSUNITS", 70, 4, 0, "ENDSEC", 0, "SECTION", 2, "ENTITIES",
  0, "CIRCLE", 8, "0", 10, 1, 20, 2, 40, 5, 0, "ENDSEC", 0, "EOF", ""];
const count = async (end) => (await new DxfParser().parseContent(drawing.join(end))).ENTITIES.length;
Promise.all([count("\n"), count("\r\n")]).then((counts) => {
  console.log("dxf2json 1.0.3, one circle, LF and CR LF:", counts);
  assert.deepStrictEqual(counts, [0, 1]);
}).catch((error) => { console.error(error.message); process.exit(1); });
END
node run.cjs
