#!/bin/bash
# npm @flatten-js/polygon-offset 1.1.4 with @flatten-js/core 1.6.15, which its range allows: each offset raises.
set -eu
folder=$(mktemp -d); trap 'rm -rf "$folder"' EXIT; cd "$folder"
npm init -y > /dev/null
npm install --silent --no-audit --no-fund @flatten-js/polygon-offset@1.1.4 @flatten-js/core@1.6.15
cat > run.cjs <<'END'
const assert = require("assert");
const { Polygon, point } = require("@flatten-js/core");
const offset = require("@flatten-js/polygon-offset").default;
const polygon = new Polygon([point(0, 0), point(100, 0), point(100, 60), point(0, 60)]);
console.log("peer range:", require("@flatten-js/polygon-offset/package.json").peerDependencies);
assert.throws(() => offset(polygon, 4), (error) => {
  console.log("raised:", error.message);
  return error.message.includes("isSegment is not a function");
});
END
node run.cjs
