#!/bin/bash
# npm junit-report-merger 9.0.4: suites of one name out of two files become one; counts are added, the time is not.
set -eu
folder=$(mktemp -d); trap 'rm -rf "$folder"' EXIT; cd "$folder"
npm init -y > /dev/null
npm install --silent --no-audit --no-fund junit-report-merger@9.0.4
cat > run.cjs <<'END'
const assert = require("assert");
const fs = require("fs");
const { mergeFiles } = require("junit-report-merger");
const report = `<testsuites><testsuite name="O1.nc" tests="2" failures="1" time="1.5">
<testcase name="a" time="1"><failure message="m">t</failure></testcase><testcase name="b" time="0.5"/></testsuite></testsuites>`;
fs.writeFileSync("first.xml", report);
fs.writeFileSync("second.xml", report);
mergeFiles("merged.xml", ["first.xml", "second.xml"]).then(() => {
  const suites = fs.readFileSync("merged.xml", "utf8").match(/<testsuites? .*>/g);
  console.log("junit-report-merger 9.0.4:", suites);
  assert.strictEqual(suites.length, 2);
  assert.ok(suites.every((suite) => suite.includes('tests="4"') && suite.includes('failures="2"') && suite.includes('time="1.5"')));
}).catch((error) => { console.error(error.message); process.exit(1); });
END
node run.cjs
