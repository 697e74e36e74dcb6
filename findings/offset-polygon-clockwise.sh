#!/bin/bash
# npm offset-polygon 0.9.2: a positive offset "adds margin" to a counter-clockwise polygon only; a clockwise one shrinks.
set -eu
folder=$(mktemp -d); trap 'rm -rf "$folder"' EXIT; cd "$folder"
npm init -y > /dev/null
npm install --silent --no-audit --no-fund offset-polygon@0.9.2
cat > run.cjs <<'END'
const assert = require("assert");
const area = (points) => Math.abs(points.reduce((sum, p, i) => {
  const q = points[(i + 1) % points.length];
  return sum + p.x * q.y - p.y * q.x;
}, 0)) / 2;
const rectangle = [{ x: 0, y: 0 }, { x: 100, y: 0 }, { x: 100, y: 60 }, { x: 0, y: 60 }];
import("offset-polygon").then(({ default: library }) => {
  const offset = library.default || library;
  const areas = [area(offset(rectangle, 4)), area(offset([...rectangle].reverse(), 4))];
  console.log("offset-polygon 0.9.2, 100 by 60 with a margin of 4, counter-clockwise and clockwise:", areas);
  assert.deepStrictEqual(areas, [7344, 4784]);
});
END
node run.cjs
