#!/bin/bash
# npm clipper2-js 1.2.4: the offset of a rectangle is no rectangle: corners are left out.
set -eu
folder=$(mktemp -d); trap 'rm -rf "$folder"' EXIT; cd "$folder"
npm init -y > /dev/null
npm install --silent --no-audit --no-fund clipper2-js@1.2.4
cat > run.cjs <<'END'
const assert = require("assert");
const { Clipper, EndType, JoinType, Paths64 } = require("clipper2-js");
const paths = new Paths64();
paths.push(Clipper.makePath([0, 0, 100000, 0, 100000, 60000, 0, 60000]));
const areas = ["Miter", "Round"].map((join) => {
  const [offset] = Clipper.InflatePaths(paths, 4000, JoinType[join], EndType.Polygon);
  console.log(join, JSON.stringify(offset.slice(0, 6)));
  return Math.round(Math.abs(Clipper.area(offset)) / 1e6);
});
console.log("clipper2-js 1.2.4, 100 by 60 outwards by 4: miter, round:", areas, "right: 7344, 7330");
assert.deepStrictEqual(areas, [6651, 6678]);
END
node run.cjs
