#!/bin/bash
# npm @microsoft/sarif-multitool 5.7.0: merge drops the notifications of a log without results, even with --merge-empty-logs, and of one whose results all stand in another.
set -eu
folder=$(mktemp -d); trap 'rm -rf "$folder"' EXIT; cd "$folder"
npm init -y > /dev/null
npm install --silent --no-audit --no-fund @microsoft/sarif-multitool@5.7.0
cat > run.cjs <<'END'
const assert = require("assert");
const fs = require("fs");
const { execFileSync } = require("child_process");
const write = (name, results) => fs.writeFileSync(`${name}.sarif`, JSON.stringify({ version: "2.1.0", runs: [{
  tool: { driver: { name: "t", version: "1.0" } }, automationDetails: { id: `nightly/${name}` },
  invocations: [{ executionSuccessful: true, toolExecutionNotifications: [{ message: { text: `${name}: a program was not read` } }] }],
  results: results.map((text) => ({ ruleId: "r", message: { text },
    locations: [{ physicalLocation: { artifactLocation: { uri: `${text}.nc` }, region: { startLine: 3 } } }] })) }] }));
write("first", ["a"]); write("other", ["b"]); write("same", ["a"]); write("empty", []);
const env = { ...process.env, DOTNET_SYSTEM_GLOBALIZATION_INVARIANT: "1" };
const told = (name, ...options) => {
  execFileSync("node_modules/.bin/sarif-multitool", ["merge", "first.sarif", `${name}.sarif`, "-o", name + options.length, ...options], { env });
  const { runs } = JSON.parse(fs.readFileSync(`${name}${options.length}/merged.sarif`, "utf8"));
  return runs.flatMap((run) => run.invocations).flatMap((one) => one.toolExecutionNotifications).length;
};
const counts = [told("other"), told("same"), told("empty"), told("empty", "--merge-empty-logs")];
console.log("sarif-multitool 5.7.0, notifications of two logs, the second with other results, the same, none, none with --merge-empty-logs:", counts);
assert.deepStrictEqual(counts, [2, 1, 1, 1]);
END
node run.cjs
