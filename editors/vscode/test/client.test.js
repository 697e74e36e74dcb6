// @ts-check
/** The server as the extension starts it: its command line, findings, the verdict, the picture; and what is said where it does not start. */
"use strict";

const assert = require("node:assert");
const { spawnSync } = require("node:child_process");
const fs = require("node:fs");
const os = require("node:os");
const path = require("node:path");
const { after, before, test } = require("node:test");
const { advice, commandLine, expanded } = require("../src/options");
const { details, text } = require("../src/verdict");
const { PYTHON, Session } = require("./server");

const RAPID = "O0001\nG98 G0 X60. C0\nG12.1\nG1 X40. F100.\nG0 C5.\nG1 C0\nG13.1\nM30\n";
const SETTINGS = { path: "polarcheck", machine: "", arguments: [], trustedFolders: [] };

const folder = fs.realpathSync(fs.mkdtempSync(path.join(os.tmpdir(), "polarcheck-")));
const line = commandLine({ ...SETTINGS, machine: "fanuc-30i", trustedFolders: ["${workspaceFolder}/../tools"] }, folder);
fs.mkdirSync(path.join(folder, "..", "tools"), { recursive: true });
const session = new Session(line.args, folder);

before(() => session.begin());
after(async () => {
  assert.strictEqual(await session.end(), 0);
  fs.rmSync(folder, { recursive: true });
});

test("findings, verdict and picture of a program", async () => {
  const uri = await session.open("O0001.NC", RAPID);
  const { diagnostics } = await session.next("textDocument/publishDiagnostics");
  assert(diagnostics.some((/** @type {any} */ finding) => finding.code === "rapid-in-polar" && finding.range.start.line === 4));
  const verdict = await session.next("polarcheck/verdict");
  assert.strictEqual(verdict.uri, uri);
  assert.match(verdict.machine, /\(fanuc-30i\)$/);
  assert.match(text(verdict), /^\$\(error\) fail: \d error/);
  const { path: library } = await session.connection.sendRequest("polarcheck/library", {});
  assert(fs.statSync(library).size > 1_000_000);
  const { html } = await session.connection.sendRequest("polarcheck/picture", { uri, library: "https://x.example/p.js", sources: "https://x.example" });
  assert.match(html, /<script src="https:\/\/x\.example\/p\.js"><\/script>/);
  assert.match(html, /rapid-in-polar/);
});

test("a picture of what is not open is refused with a reason", async () => {
  await assert.rejects(session.connection.sendRequest("polarcheck/picture", { uri: "file:///none.nc" }), /not open/);
});

test("settings become a command line, each entry one word of it", () => {
  assert.deepStrictEqual(commandLine(SETTINGS, ""), { command: "polarcheck", isOfFolder: false, args: ["server"] });
  const settings = { path: "${workspaceFolder}/.venv/bin/polarcheck", machine: "~/my lathe.toml", arguments: ["--set", "limits.c_feed=3600"], trustedFolders: ["/srv/$(x)"] };
  assert.deepStrictEqual(commandLine(settings, "/shop", "/home/me"), {
    command: "/shop/.venv/bin/polarcheck",
    isOfFolder: true,
    args: ["server", "--machine", "/home/me/my lathe.toml", "--trust", path.normalize("/srv/$(x)"), "--set", "limits.c_feed=3600"],
  });
  assert.strictEqual(expanded("a~b $& ${workspaceFolder}", "$&$1"), "a~b $& $&$1");
});

test("where it does not start, one line says what to do", () => {
  assert.match(advice("polarcheck", null, ""), /not installed, or not on the PATH .* pip install .* polarcheck\.path/);
  assert.match(advice("git", 1, "revert"), /^git is another program, .* ended with "revert"/);
  assert.match(advice("polarcheck", 2, "polarcheck: No such command 'server'."), /too old/);
  assert.match(advice("polarcheck", 1, "ModuleNotFoundError: No module named 'polarcheck'"), /not running: ModuleNotFoundError/);
  const { status, stderr } = spawnSync(PYTHON, ["-m", "polarcheck", "server", "--nonsense"], { encoding: "utf8", input: "" });
  assert.match(advice("polarcheck", status, stderr.trim().split("\n").at(-1) ?? ""), /^polarcheck is not running: No such option '--nonsense'/);
  assert.strictEqual(advice("x", 1, ""), "polarcheck is not running: x ended with 1.");
});

test("the status bar and its tooltip say the verdict in words", () => {
  const verdict = { uri: "", version: 1, verdict: "pass", errors: 0, warnings: 0, notes: 1, sections: 2, machine: "Lathe (l)", reasons: [] };
  assert.strictEqual(text(undefined), "$(sync~spin) polarcheck");
  assert.strictEqual(text(verdict), "$(pass) pass: 1 note");
  assert.strictEqual(text({ ...verdict, verdict: "fail", warnings: 2, notes: 0 }), "$(warning) fail: 2 warnings");
  assert.strictEqual(text({ ...verdict, verdict: "$(bug)" }), "$(question) unknown verdict: 1 note");
  assert.deepStrictEqual(details({ ...verdict, notes: 0 }), ["Verdict: pass", "Findings: no findings", "Polar sections: 2", "Machine: Lathe (l)"]);
  const reasons = Array.from({ length: 10 }, (_, at) => `reason ${at}`);
  const said = details({ ...verdict, verdict: "unverified", reasons });
  assert.strictEqual(said.at(-1), "and 2 more reasons");
  assert(said.includes("Not evaluated: reason 0"));
  assert.deepStrictEqual(details({ ...verdict, verdict: "not checked", notes: 0, machine: "", reasons: ["broken"] }), ["Verdict: not checked", "broken"]);
});
