#!/bin/bash
# npm gcanvas 0.0.37: a quarter of a circle, 0 to 90 degrees, is written as G2 and so cuts the other three quarters; lines keep their Y.
set -eu
folder=$(mktemp -d); trap 'rm -rf "$folder"' EXIT; cd "$folder"
npm init -y > /dev/null
npm install --silent --no-audit --no-fund gcanvas@0.0.37
cat > run.cjs <<'END'
const assert = require("assert");
const Canvas = require("gcanvas");
const GcodeDriver = require("gcanvas/lib/drivers/gcode");
const blocks = (draw) => {
  const written = [];
  const canvas = new Canvas(new GcodeDriver({ write: (text) => written.push(text) }, {}));
  draw(canvas);
  canvas.stroke();
  return written.map((text) => text.trim()).filter((text) => text !== "G90");
};
const arc = blocks((canvas) => canvas.arc(0, 0, 5, 0, Math.PI / 2, false));
const line = blocks((canvas) => { canvas.moveTo(5, 0); canvas.lineTo(0, 5); });
console.log("gcanvas 0.0.37, arc 0 to 90 degrees:", arc, "line:", line);
assert.deepStrictEqual(arc, ["G0 X5 Y0", "G2 X0 Y5 Z0 I-5 J0"]);
assert.match(line[1], /^G1 X0 Y5/);
END
node run.cjs
