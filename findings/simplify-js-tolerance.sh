#!/bin/bash
# npm simplify-js 1.2.4: a point may lie 0.19 from the result of tolerance 0.1: two passes, each with the whole of it.
set -eu
folder=$(mktemp -d); trap 'rm -rf "$folder"' EXIT; cd "$folder"
npm init -y > /dev/null
npm install --silent --no-audit --no-fund simplify-js@1.2.4
cat > run.cjs <<'END'
const assert = require("assert");
const simplify = require("simplify-js");
const height = 0.19;
const points = [[0, 0], [5, 0.099], [5, height], [10, 0]].map(([x, y]) => ({ x, y }));
const once = simplify(points, 0.1, true), twice = simplify(points, 0.1);
console.log("simplify-js 1.2.4, tolerance 0.1, a point at", height, "over a line; high quality:", once.length, "points; else:", twice.length);
assert.strictEqual(once.length, 3);
assert.deepStrictEqual(twice, [points[0], points[3]]);
END
node run.cjs
