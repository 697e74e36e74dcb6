#!/bin/bash
# npm junit-cli-report-viewer 3.0.0: a case with an error has the tick of one that passes, and does not count as failed.
set -eu
folder=$(mktemp -d); trap 'rm -rf "$folder"' EXIT; cd "$folder"
npm init -y > /dev/null
npm install --silent --no-audit --no-fund junit-cli-report-viewer@3.0.0
cat > run.cjs <<'END'
const assert = require("assert");
const fs = require("fs");
const { execFileSync } = require("child_process");
fs.writeFileSync("in.xml", `<testsuites tests="3" failures="1" errors="1"><testsuite name="O1.nc" tests="3" failures="1" errors="1">
<testcase name="fails"><failure message="m">t</failure></testcase><testcase name="unreadable"><error message="m">t</error></testcase>
<testcase name="passes"/></testsuite></testsuites>`);
const page = execFileSync("node_modules/.bin/junit-cli-report-viewer", ["in.xml"], { encoding: "utf8" });
console.log("junit-cli-report-viewer 3.0.0\n" + page);
const mark = (name) => page.match(new RegExp(`(\\S+) ${name}`))[1];
assert.match(page, /failed tests: 1/);
assert.strictEqual(mark("unreadable"), mark("passes"));
assert.notStrictEqual(mark("fails"), mark("passes"));
END
node run.cjs
