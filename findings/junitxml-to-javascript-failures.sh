#!/bin/bash
# npm junitxml-to-javascript 1.1.4: a case with a failure and skipped is skipped; of two failures no message is left.
set -eu
folder=$(mktemp -d); trap 'rm -rf "$folder"' EXIT; cd "$folder"
npm init -y > /dev/null
npm install --silent --no-audit --no-fund junitxml-to-javascript@1.1.4
cat > run.cjs <<'END'
const assert = require("assert");
const Parser = require("junitxml-to-javascript");
const report = `<testsuite name="O1.nc" tests="3" failures="3">
<testcase name="both"><failure message="error">e</failure><skipped message="not evaluated"/></testcase>
<testcase name="two"><failure message="first">1</failure><failure message="second">2</failure></testcase>
<testcase name="one"><failure message="error">e</failure></testcase></testsuite>`;
new Parser().parseXMLString(report).then(({ testsuites: [suite] }) => {
  const cases = suite.testCases.map(({ name, result, message }) => [name, result, message].join(" | "));
  console.log("junitxml-to-javascript 1.1.4:", cases);
  assert.deepStrictEqual(cases, ["both | skipped | not evaluated", "two | failed | ", "one | failed | error"]);
}).catch((error) => { console.error(error.message); process.exit(1); });
END
node run.cjs
