// @ts-check
/** Which program is started: one of the PATH, or the one that the setting names, and never one that the open folder plants. */
"use strict";

const assert = require("node:assert");
const fs = require("node:fs");
const Module = require("node:module");
const os = require("node:os");
const path = require("node:path");
const { after, test } = require("node:test");
const { executable } = require("../src/executable");
const { commandLine, distrust } = require("../src/options");

const SETTINGS = { path: "polarcheck", machine: "", arguments: [], trustedFolders: [] };
const isPosix = process.platform !== "win32";

/**
 * A system with these programs. Only a whole path names one: any other is looked for in the open folder, where each is planted.
 * @param {boolean} isWindows
 * @param {string} folders
 * @param {string[]} programs
 */
function system(isWindows, folders, programs) {
  const { isAbsolute } = isWindows ? path.win32 : path.posix;
  return { isWindows, folders, isProgram: (/** @type {string} */ file) => !isAbsolute(file) || programs.includes(file) };
}

/** @param {string} folders @param {string[]} programs @param {string} [command] */
const onWindows = (folders, programs, command = "polarcheck") => executable(command, "C:\\shop", system(true, folders, programs));

/** @param {string} folders @param {string[]} programs @param {string} [command] */
const onPosix = (folders, programs, command = "polarcheck") => executable(command, "/shop", system(false, folders, programs));

const PLANTED = ["C:\\shop\\polarcheck.exe", "C:\\shop\\polarcheck.com", "C:\\shop\\polarcheck", "\\polarcheck.exe", "\\bin\\polarcheck.exe"];

test("on Windows only whole folders of the PATH are searched", () => {
  const program = "C:\\Python311\\Scripts\\polarcheck.exe";
  for (const relative of ["", ".", ".\\", "..", "bin", "C:", "C:bin", "\\", "\\bin", "/bin", "%TOOLS%", '"."', '""', "~"]) {
    assert.strictEqual(onWindows(relative, PLANTED), undefined, relative);
    assert.strictEqual(onWindows(`${relative};C:\\Python311\\Scripts;${relative}`, [...PLANTED, program]), program, relative);
  }
  assert.strictEqual(onWindows(";;", PLANTED), undefined);
});

test("on Windows a name has the ending of a program, and the first folder counts", () => {
  for (const [folder, file] of [
    ["C:\\a b", "C:\\a b\\polarcheck.exe"],
    ["c:/a/", "c:\\a\\polarcheck.exe"],
    ['"C:\\a;b"', "C:\\a;b\\polarcheck.exe"],
    ["\\\\server\\tools", "\\\\server\\tools\\polarcheck.exe"],
    ["C:\\a", "C:\\a\\polarcheck.com"],
  ]) {
    assert.strictEqual(onWindows(`C:\\none;${folder};D:\\later`, [file, "D:\\later\\polarcheck.exe"]), file);
  }
  assert.strictEqual(onWindows("C:\\a", ["C:\\a\\polarcheck.EXE"], "polarcheck.EXE"), "C:\\a\\polarcheck.EXE");
  assert.strictEqual(onWindows("C:\\a", ["C:\\a\\polarcheck-0.1.exe"], "polarcheck-0.1"), "C:\\a\\polarcheck-0.1.exe");
  // These need a shell.
  for (const script of ["polarcheck", "polarcheck.cmd", "polarcheck.bat", "polarcheck.ps1", "polarcheck.py"]) {
    assert.strictEqual(onWindows("C:\\a", [`C:\\a\\${script}`]), undefined);
    assert.strictEqual(onWindows("C:\\a", [`C:\\a\\${script}`], script), undefined);
  }
});

test("elsewhere only whole folders of the PATH are searched", () => {
  for (const relative of ["", ".", "./", "..", "bin", "~/bin"]) {
    assert.strictEqual(onPosix(relative, ["/shop/polarcheck"]), undefined);
    assert.strictEqual(onPosix(`${relative}:/none:/usr/bin:/bin`, ["/usr/bin/polarcheck", "/bin/polarcheck"]), "/usr/bin/polarcheck");
  }
  assert.strictEqual(onPosix("/usr/bin", ["/usr/bin/polarcheck.exe"]), undefined);
});

test("a path is taken as it is written, a relative one counts from the open folder", () => {
  for (const whole of ["C:\\venv\\Scripts\\polarcheck.exe", "d:/polarcheck", "\\\\server\\tools\\polarcheck.exe"]) {
    assert.strictEqual(onWindows("C:\\a", [], whole), whole);
  }
  assert.strictEqual(onPosix("/usr/bin", [], "/opt/polarcheck"), "/opt/polarcheck");
  assert.strictEqual(onWindows("C:\\a", [], "venv\\polarcheck.exe"), "C:\\shop\\venv\\polarcheck.exe");
  assert.strictEqual(onWindows("C:\\a", [], "./polarcheck.exe"), "C:\\shop\\polarcheck.exe");
  assert.strictEqual(onPosix("/usr/bin", [], "./polarcheck"), "/shop/polarcheck");
  assert.strictEqual(executable("./polarcheck", "", system(false, "/usr/bin", [])), undefined);
  // What remains of ${workspaceFolder}\polarcheck.exe where no folder is open.
  assert.strictEqual(executable("\\polarcheck.exe", "", system(true, "C:\\a", [])), undefined);
});

test("of a command it is known that the folder decides what it is", () => {
  const isOfFolder = (/** @type {string} */ written, /** @type {boolean} */ isWindows) =>
    commandLine({ ...SETTINGS, path: written }, isWindows ? "C:\\shop" : "/shop", isWindows ? "C:\\Users\\me" : "/home/me", isWindows).isOfFolder;
  for (const written of ["${workspaceFolder}/.venv/bin/polarcheck", "/opt/${workspaceFolder}", "./polarcheck", "bin/polarcheck", "../polarcheck"]) {
    assert(isOfFolder(written, false), written);
    assert(isOfFolder(written, true), written);
  }
  for (const written of [".\\polarcheck.exe", "C:polarcheck.exe", "\\polarcheck.exe", "venv\\polarcheck.exe"]) {
    assert(isOfFolder(written, true), written);
  }
  for (const written of ["", "polarcheck", "~/bin/polarcheck", "${userHome}/polarcheck"]) {
    assert(!isOfFolder(written, false), written);
    assert(!isOfFolder(written, true), written);
  }
  assert(!isOfFolder("/opt/polarcheck", false));
  assert(!isOfFolder("D:\\polarcheck.exe", true));
});

// ---- the client itself, in an editor that has nothing else ----

const folder = fs.realpathSync(fs.mkdtempSync(path.join(os.tmpdir(), "polarcheck-")));
after(() => fs.rmSync(folder, { recursive: true }));
const editor = {
  workspace: {
    isTrusted: false,
    workspaceFolders: [{ uri: { scheme: "file", fsPath: folder } }],
    getConfiguration: () => ({ get: (/** @type {string} */ name, /** @type {any} */ without) => (name === "path" ? editor.path : without) }),
  },
  path: "polarcheck",
  /** @type {string[]} */
  messages: [],
  window: { showErrorMessage: async (/** @type {string} */ message) => void editor.messages.push(message) },
};

/** A connection that starts the process of the server, and says what it wrote. */
class Connection {
  /** @param {string} _id @param {string} _name @param {() => Promise<import("node:child_process").ChildProcess>} started */
  constructor(_id, _name, started) {
    this.started = started;
  }
  registerFeature() {}
  onNotification() {}
  onDidChangeState() {}
  needsStop() {}
  async dispose() {}
  async start() {
    const child = await this.started();
    editor.messages.push(String((await child.stdout?.toArray())?.join("")).trim());
  }
}

/**
 * What is said as the server is started: the program that ran, or the message.
 * @param {string} command
 * @param {string} folders the PATH
 */
async function saidBy(command, folders) {
  const load = Reflect.get(Module, "_load");
  /** @type {Record<string, object>} */
  const replaced = { vscode: editor, "vscode-languageclient/node": { LanguageClient: Connection, State: {} } };
  Reflect.set(Module, "_load", (/** @type {string} */ name, /** @type {any[]} */ ...rest) => replaced[name] ?? load(name, ...rest));
  const { Client } = require("../src/client");
  Reflect.set(Module, "_load", load);
  const before = process.env.PATH;
  process.env.PATH = folders;
  editor.path = command;
  editor.messages = [];
  try {
    const quiet = { info: () => undefined, error: () => undefined };
    await new Client(/** @type {any} */ (quiet), () => undefined, () => undefined).restart();
    // The message comes once the process, where there is one, has ended.
    await new Promise((resolve) => setImmediate(resolve));
  } finally {
    process.env.PATH = before;
  }
  return editor.messages.join("\n");
}

/** @param {string} name */
function plant(name) {
  const file = path.join(folder, name);
  fs.mkdirSync(path.dirname(file), { recursive: true });
  fs.writeFileSync(file, `#!/bin/sh\necho "$0"\n`, { mode: 0o755 });
  return file;
}

test("a program that the open folder plants is not started, whatever the PATH has", { skip: !isPosix }, async () => {
  const planted = plant("polarcheck");
  for (const folders of ["", ".", ":", ":/usr/none", "/usr/none:", "./:/usr/none"]) {
    assert.match(await saidBy("polarcheck", folders), /^polarcheck is not installed, or not on the PATH \(polarcheck\)\. Install it/);
  }
  const right = plant("tools/polarcheck");
  assert.strictEqual(await saidBy("polarcheck", `.::bin:${path.dirname(right)}`), right);
  assert.strictEqual(await saidBy(planted, ""), planted);
});

test("in Restricted Mode no setting starts a program of the open folder", { skip: !isPosix }, async () => {
  const planted = plant("polarcheck");
  for (const command of ["${workspaceFolder}/polarcheck", "./polarcheck", "tools/../polarcheck"]) {
    editor.workspace.isTrusted = false;
    const said = await saidBy(command, "");
    assert.strictEqual(said, distrust(command.replace("${workspaceFolder}", folder)));
    assert.match(said, /Trust the folder, or name a whole path without \$\{workspaceFolder\} in the setting polarcheck\.path\.$/);
    editor.workspace.isTrusted = true;
    assert.strictEqual(await saidBy(command, ""), planted);
  }
});
