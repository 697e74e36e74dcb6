#!/bin/bash
# npm @tracespace/parser and plotter 5.0.0-alpha.0: R4X2.0 behind a hole at X10 (Excellon: four more, 2 mm apart) is one hole at X2.
set -eu
folder=$(mktemp -d); trap 'rm -rf "$folder"' EXIT; cd "$folder"
npm init -y > /dev/null
npm install --silent --no-audit --no-fund @tracespace/parser@5.0.0-alpha.0 @tracespace/plotter@5.0.0-alpha.0
cat > run.mjs <<'END_OF_SCRIPT'
import assert from "assert";
import { createParser } from "@tracespace/parser";
import { plot } from "@tracespace/plotter";

const parser = createParser();
parser.feed("M48\nMETRIC,TZ\nT1C1.000\n%\nT1\nX10.0Y5.0\nR4X2.0\nM30\n");
const holes = plot(parser.result()).children.map(({ shape }) => [shape.cx, shape.cy]);
console.log("@tracespace/plotter 5.0.0-alpha.0, X10.0Y5.0 and R4X2.0:", holes);
assert.deepStrictEqual(holes, [[10, 5], [2, 5]]);
END_OF_SCRIPT
node run.mjs
