// @ts-check
/** How polarcheck is started: the settings of the editor as a command line. */
"use strict";

const os = require("node:os");
const path = require("node:path");
const { isName, isWhole } = require("./executable");

/**
 * @typedef {object} Settings
 * @property {string} path
 * @property {string} machine
 * @property {string[]} arguments
 * @property {string[]} trustedFolders
 */

/**
 * Put the folder that is open and the user's own in the place of `${workspaceFolder}` and `~`.
 * @param {string} text
 * @param {string} folder of the workspace; empty without one
 * @param {string} [home]
 */
function expanded(text, folder, home = os.homedir()) {
  const inside = text.replaceAll("${workspaceFolder}", () => folder).replaceAll("${userHome}", () => home);
  return inside === "~" || inside.startsWith("~/") || inside.startsWith("~\\") ? home + inside.slice(1) : inside;
}

/**
 * The command that starts the server; isOfFolder: which program that is depends on the folder of the workspace.
 * @param {Settings} settings
 * @param {string} folder of the workspace; empty without one
 * @param {string} [home]
 * @param {boolean} [isWindows]
 */
function commandLine(settings, folder, home, isWindows = process.platform === "win32") {
  /** @param {string} text */
  const whole = (text) => expanded(text, folder, home);
  const machine = settings.machine.trim();
  const command = whole(settings.path.trim()) || "polarcheck";
  return {
    command,
    isOfFolder:
      settings.path.includes("${workspaceFolder}") || !(isName(command, isWindows) || isWhole(command, isWindows)),
    args: [
      "server",
      ...(machine ? ["--machine", whole(machine)] : []),
      ...settings.trustedFolders.flatMap((trusted) => ["--trust", path.normalize(whole(trusted))]),
      ...settings.arguments.map(whole),
    ],
  };
}

/**
 * What to do in Restricted Mode where the program to start is of the folder, in one line.
 * @param {string} command
 */
function distrust(command) {
  return `polarcheck is not running: ${command} is of a folder that you do not trust. Trust the folder, or name a whole path without \${workspaceFolder} in the setting polarcheck.path.`;
}

/**
 * What to do where polarcheck does not start, in one line.
 * @param {string} command
 * @param {number | null} code its exit code; null where it could not be started
 * @param {string} said its last line of standard error
 */
function advice(command, code, said) {
  if (code === null) {
    return `polarcheck is not installed, or not on the PATH (${command}). Install it, in a checkout with: pip install ".[server,plot]" - or name its executable in the setting polarcheck.path.`;
  }
  if (!said) {
    return `polarcheck is not running: ${command} ended with ${code}.`;
  }
  // Its messages begin with its name; a bug ends with the name of an error.
  if (!/^polarcheck\b|^\w*Error\b/.test(said) || said.includes("No such command")) {
    return `${command} is another program, or a polarcheck that is too old: it ended with "${said.slice(0, 200)}". The setting polarcheck.path names the executable.`;
  }
  return `polarcheck is not running: ${said.replace(/^polarcheck: /, "")}`;
}

module.exports = { advice, commandLine, distrust, expanded };
