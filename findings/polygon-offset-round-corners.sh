#!/bin/bash
# npm polygon-offset 0.3.2: round corners come nearer than asked, 3.85 where 4 was asked: two fans of segments that do not meet.
set -eu
folder=$(mktemp -d); trap 'rm -rf "$folder"' EXIT; cd "$folder"
npm init -y > /dev/null
npm install --silent --no-audit --no-fund polygon-offset@0.3.2
cat > run.cjs <<'END'
const assert = require("assert");
const Offset = require("polygon-offset");
const rings = new Offset().data([[0, 0], [100, 0], [100, 60], [0, 60], [0, 0]]).margin(4);
const ring = Array.isArray(rings[0][0][0]) ? rings[0][0] : rings[0];
const distances = ring.map(([x, y]) => Math.hypot(Math.max(-x, 0, x - 100), Math.max(-y, 0, y - 60)));
const nearest = Math.min(...distances).toFixed(3);
console.log("polygon-offset 0.3.2, 100 by 60, margin 4:", ring.length, "points, the nearest at", nearest, "(five segments: 3.951)");
assert.strictEqual(nearest, "3.852");
END
node run.cjs
