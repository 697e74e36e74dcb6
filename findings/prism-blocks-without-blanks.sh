#!/bin/bash
# npm prismjs 1.30.0: its G-code colors G1 and X5 in `N10 G1 X5`; in `N10G1X5` neither.
set -eu
folder=$(mktemp -d); trap 'rm -rf "$folder"' EXIT; cd "$folder"
npm init -y > /dev/null
npm install --silent --no-audit --no-fund prismjs@1.30.0
cat > run.cjs <<'END'
const assert = require("assert");
const Prism = require("prismjs");
require("prismjs/components/prism-gcode");
const tokens = (block) =>
  Prism.tokenize(block, Prism.languages.gcode).filter((token) => token.type).map((token) => token.type + " " + token.content);
const apart = tokens("N10 G1 X5"), together = tokens("N10G1X5");
console.log("prismjs 1.30.0\nN10 G1 X5:", apart, "\nN10G1X5:", together);
assert.deepStrictEqual(apart, ["property N", "keyword G1", "property X"]);
assert.deepStrictEqual(together, ["property N"]);
END
node run.cjs
