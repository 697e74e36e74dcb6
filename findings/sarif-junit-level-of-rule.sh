#!/bin/bash
# npm sarif-junit 1.1.4: a result without its own level passes, though its rule says error (and SARIF's default is warning); one let off by a suppression fails.
set -eu
folder=$(mktemp -d); trap 'rm -rf "$folder"' EXIT; cd "$folder"
npm init -y > /dev/null
npm install --silent --no-audit --no-fund sarif-junit@1.1.4
cat > run.cjs <<'END'
const assert = require("assert");
const fs = require("fs");
const { execFileSync } = require("child_process");
const result = (text, more) => ({ ruleId: "r", ruleIndex: 0, message: { text }, ...more,
  locations: [{ physicalLocation: { artifactLocation: { uri: "a.nc" }, region: { startLine: 3 } } }] });
const rules = [{ id: "r", defaultConfiguration: { level: "error" } }];
fs.writeFileSync("in.sarif", JSON.stringify({ version: "2.1.0", runs: [{ tool: { driver: { name: "t", rules } }, results: [
  result("by rule"), result("own", { level: "error" }), result("let off", { level: "error", suppressions: [{ kind: "inSource" }] })] }] }));
execFileSync("node_modules/.bin/sarif-junit", ["-i", "in.sarif", "-o", "out.xml"]);
const report = fs.readFileSync("out.xml", "utf8");
console.log("sarif-junit 1.1.4\n" + report);
assert.match(report, /<testsuites tests="3" failures="2"/);
assert.match(report, /name="by rule" file="a.nc"\/>/);
assert.match(report, /let off" file="a.nc">\s*<failure/);
END
node run.cjs
