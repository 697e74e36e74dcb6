#!/bin/bash
# npm @jscad/svg-deserializer 2.5.14: transform="matrix(...)" is passed over, a rotation about a point gives NaN, and an arc whose flags stand without a blank (a20 20 0 0140 0, as minifiers write) is left out; translate, scale and the same arc with blanks are right.
set -eu
folder=$(mktemp -d); trap 'rm -rf "$folder"' EXIT; cd "$folder"
npm init -y > /dev/null
npm install --silent --no-audit --no-fund @jscad/svg-deserializer@2.5.14 @jscad/modeling@2.13.0
cat > run.cjs <<'END'
const assert = require("assert");
const { deserialize } = require("@jscad/svg-deserializer");
const { measureBoundingBox } = require("@jscad/modeling").measurements;
const extent = (drawn) => {
  const drawing = `<svg xmlns="http://www.w3.org/2000/svg" width="100mm" height="100mm" viewBox="0 0 100 100">${drawn}</svg>`;
  const geometries = [deserialize({ output: "geometry", target: "path", filename: "drawing.svg" }, drawing)].flat(9);
  return measureBoundingBox(geometries[0]).map((corner) => corner.slice(0, 2).map((value) => Math.round(value * 1000) / 1000));
};
const rectangle = (transform) => `<g transform="${transform}"><rect x="5" y="5" width="20" height="10"/></g>`;
for (const [drawn, seen] of [
  [rectangle("translate(10 20)"), [[15, -35], [35, -25]]],
  [rectangle("matrix(1 0 0 1 10 20)"), [[5, -15], [25, -5]]],
  [rectangle("rotate(90 50 50)"), [[NaN, NaN], [NaN, NaN]]],
  ['<path d="M10 50a20 20 0 0 1 40 0"/>', [[10, -50], [50, -30]]],
  ['<path d="M10 50a20 20 0 0140 0"/>', [[10, -50], [10, -50]]],
]) {
  const found = extent(drawn);
  console.log("@jscad/svg-deserializer 2.5.14,", drawn, "from and to:", found);
  assert.deepStrictEqual(found, seen);
}
END
node run.cjs
