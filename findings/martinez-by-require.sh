#!/bin/bash
# npm martinez-polygon-clipping 0.8.1: by require every operation raises "is not a constructor"; by import they work.
set -eu
folder=$(mktemp -d); trap 'rm -rf "$folder"' EXIT; cd "$folder"
npm init -y > /dev/null
npm install --silent --no-audit --no-fund martinez-polygon-clipping@0.8.1
cat > run.cjs <<'END'
const assert = require("assert");
const required = require("martinez-polygon-clipping");
const left = [[[0, 0], [2, 0], [2, 1], [0, 1], [0, 0]]], right = [[[1, 0], [3, 0], [3, 1], [1, 1], [1, 0]]];
import("martinez-polygon-clipping").then((imported) => {
  console.log("martinez-polygon-clipping 0.8.1, imported:", JSON.stringify(imported.intersection(left, right)));
  for (const operation of ["intersection", "union", "diff", "xor"]) {
    assert.throws(() => required[operation](left, right), /is not a constructor/);
    console.log("required:", operation, "raises");
  }
}).catch((error) => { console.error(error.message); process.exit(1); });
END
node run.cjs
