#!/bin/bash
# npm test-results-parser 0.4.6: of a JUnit report, skipped cases do not count into the total, and the reason why a case is skipped is lost.
set -eu
folder=$(mktemp -d); trap 'rm -rf "$folder"' EXIT; cd "$folder"
npm init -y > /dev/null
npm install --silent --no-audit --no-fund test-results-parser@0.4.6
cat > report.xml <<'END_OF_REPORT'
<testsuites tests="4" failures="1" errors="0" skipped="2" time="1"><testsuite name="a.nc" tests="4" failures="1" errors="0" skipped="2" time="1">
<testcase name="r1" classname="a.nc"/><testcase name="r2" classname="a.nc"><failure message="too deep">line 3</failure></testcase>
<testcase name="r3" classname="a.nc"><skipped message="the tool is not known"/></testcase>
<testcase name="r4" classname="a.nc"><skipped message="the stock is not known"/></testcase></testsuite></testsuites>
END_OF_REPORT
cat > run.cjs <<'END_OF_SCRIPT'
const assert = require("assert");
const { parse } = require("test-results-parser");
const result = parse({ type: "junit", files: ["report.xml"] });
const { total, passed, failed, skipped } = result;
console.log("test-results-parser 0.4.6, of 4 cases (1 passes, 1 fails, 2 skipped):", { total, passed, failed, skipped });
assert.deepStrictEqual({ total, passed, failed, skipped }, { total: 2, passed: 1, failed: 1, skipped: 2 });
assert.ok(JSON.stringify(result).includes("too deep"));
assert.ok(!JSON.stringify(result).includes("is not known"));
END_OF_SCRIPT
node run.cjs
