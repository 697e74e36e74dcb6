#!/bin/bash
# npm @tracespace/parser 5.0.0-next.0: a drill file (Excellon) ends at the % that closes its header: tools are read, holes are not; with M95 in its place they are.
set -eu
folder=$(mktemp -d); trap 'rm -rf "$folder"' EXIT; cd "$folder"
npm init -y > /dev/null
npm install --silent --no-audit --no-fund @tracespace/parser@5.0.0-next.0
cat > run.mjs <<'END_OF_SCRIPT'
import assert from "assert";
import { createParser } from "@tracespace/parser";

function holes(headerEnd) {
  const parser = createParser();
  parser.feed(`M48\nMETRIC,TZ\nT1C1.000\n${headerEnd}\nT1\nX10.0Y5.0\nX20.0Y5.0\nM30\n`);
  return parser.results().children.filter((node) => node.type === "graphic").length;
}

const seen = { "%": holes("%"), M95: holes("M95") };
console.log("@tracespace/parser 5.0.0-next.0, holes read of 2, by what ends the header:", seen);
assert.deepStrictEqual(seen, { "%": 0, M95: 2 });
END_OF_SCRIPT
node run.mjs
