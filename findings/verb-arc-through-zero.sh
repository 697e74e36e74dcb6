#!/bin/bash
# npm verb-nurbs-web 2.1.3: an arc from 350 to 10 degrees is a whole circle; from 350 to 370 it has its 20 degrees.
set -eu
folder=$(mktemp -d); trap 'rm -rf "$folder"' EXIT; cd "$folder"
npm init -y > /dev/null
npm install --silent --no-audit --no-fund verb-nurbs-web@2.1.3
cat > run.cjs <<'END'
const assert = require("assert");
const { Arc } = require("verb-nurbs-web").geom;
const degrees = (from, to) => {
  const arc = new Arc([0, 0, 0], [1, 0, 0], [0, 1, 0], 5, (from * Math.PI) / 180, (to * Math.PI) / 180);
  return Math.round((arc.length() / 5) * (180 / Math.PI));
};
const through = degrees(350, 10), beyond = degrees(350, 370);
console.log("verb-nurbs-web 2.1.3, arc 350 to 10:", through, "degrees; 350 to 370:", beyond);
assert.deepStrictEqual([through, beyond], [360, 20]);
END
node run.cjs
