#!/bin/bash
# npm @security-alert/sarif-to-markdown 1.11.1: all results of a rule show the message of its first; a result without a level is left out.
set -eu
folder=$(mktemp -d); trap 'rm -rf "$folder"' EXIT; cd "$folder"
npm init -y > /dev/null
npm install --silent --no-audit --no-fund @security-alert/sarif-to-markdown@1.11.1
cat > run.cjs <<'END'
const assert = require("assert");
const { sarifToMarkdown } = require("@security-alert/sarif-to-markdown");
const result = (ruleId, text, startLine, more) => ({ ruleId, message: { text }, ...more,
  locations: [{ physicalLocation: { artifactLocation: { uri: "a.nc" }, region: { startLine } } }] });
const log = { version: "2.1.0", runs: [{ tool: { driver: { name: "t", rules: [
  { id: "r", shortDescription: { text: "s" }, defaultConfiguration: { level: "error" } }, { id: "plain", shortDescription: { text: "s" } }] } }, results: [
  result("r", "radius too small", 3, { level: "error" }), result("r", "radius too large", 7, { level: "error" }), result("plain", "no level", 9)] }] };
const [{ body }] = sarifToMarkdown({ title: "T", owner: "o", repo: "r", branch: "b", sourceRoot: "" })(log);
console.log("sarif-to-markdown 1.11.1\n" + body.split("## Rules")[0]);
assert.ok(body.includes("radius too small") && body.includes("#L3") && body.includes("#L7"));
assert.ok(!body.includes("radius too large") && !body.includes("no level"));
END
node run.cjs
