#!/bin/bash
# npm kld-intersections 0.7.0: a line that touches a circle has no point in common with it; two circles that touch have theirs twice.
set -eu
folder=$(mktemp -d); trap 'rm -rf "$folder"' EXIT; cd "$folder"
npm init -y > /dev/null
npm install --silent --no-audit --no-fund kld-intersections@0.7.0
cat > run.cjs <<'END'
const assert = require("assert");
const { ShapeInfo, Intersection } = require("kld-intersections");
const circle = (x, radius) => ShapeInfo.circle({ center: [x, 0], radius });
const line = (y) => ShapeInfo.line({ p1: [-9, y], p2: [9, y] });
const counts = [line(4), line(5), circle(8, 3)].map((other) => Intersection.intersect(circle(0, 5), other).points.length);
console.log("kld-intersections 0.7.0, points on a circle of 5, of a line at 4, a line at 5, a circle of 3 at 8:", counts);
assert.deepStrictEqual(counts, [2, 0, 2]);
END
node run.cjs
