#!/bin/bash
# npm bezier-js 6.1.4: arcs() raises TypeError for a curve shaped like an S; a bow becomes arcs.
set -eu
folder=$(mktemp -d); trap 'rm -rf "$folder"' EXIT; cd "$folder"
npm init -y > /dev/null
npm install --silent --no-audit --no-fund bezier-js@6.1.4
cat > run.cjs <<'END'
const assert = require("assert");
const { Bezier } = require("bezier-js");
const bow = new Bezier(0, 0, 0, 20, 30, 20, 30, 0).arcs(0.1), s = new Bezier(0, 0, 30, 0, 0, 20, 30, 20);
console.log("bezier-js 6.1.4, threshold 0.1: a bow becomes", bow.length, "arcs");
assert.ok(bow.length > 1);
assert.throws(() => s.arcs(0.1), (error) => {
  console.log("an S raises:", error.message);
  return error instanceof TypeError;
});
END
node run.cjs
