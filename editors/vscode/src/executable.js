// @ts-check
/**
 * Which file is started: never one that lies by chance in the folder that is open.
 *
 * Windows looks for a bare name in the working folder first, other systems where the PATH has an entry that is empty or
 * relative. So the PATH is searched here, and only its absolute folders.
 */
"use strict";

const fs = require("node:fs");
const path = require("node:path");

/**
 * @typedef {object} System
 * @property {boolean} isWindows
 * @property {string} folders the PATH
 * @property {(file: string) => boolean} isProgram
 */

/** @type {System} */
const HERE = {
  isWindows: process.platform === "win32",
  get folders() {
    return process.env.PATH ?? "";
  },
  isProgram: (file) => {
    try {
      fs.accessSync(file, fs.constants.X_OK);
      return fs.statSync(file).isFile();
    } catch {
      return false;
    }
  },
};

/**
 * True for a path that no working folder and no current drive changes.
 * @param {string} text
 * @param {boolean} isWindows
 */
function isWhole(text, isWindows) {
  return isWindows ? /^(?:[a-z]:[\\/]|[\\/]{2})/i.test(text) : text.startsWith("/");
}

/**
 * True for a bare name, which is looked for on the PATH.
 * @param {string} text
 * @param {boolean} isWindows
 */
function isName(text, isWindows) {
  return !(isWindows ? /[\\/:]/ : /\//).test(text);
}

/**
 * The path of the program to start; undefined where there is none.
 * @param {string} command a name on the PATH, a whole path, or one that counts from the folder
 * @param {string} folder of the workspace; empty without one
 * @param {System} [system]
 */
function executable(command, folder, system = HERE) {
  const { isWindows } = system;
  const { join, resolve } = isWindows ? path.win32 : path.posix;
  if (isWhole(command, isWindows)) {
    return command;
  }
  if (!isName(command, isWindows)) {
    return folder ? resolve(folder, command) : undefined;
  }
  // What needs a shell, as .cmd and .bat, is none: pip, pipx and uv write an .exe.
  const names = isWindows && !/\.(?:exe|com)$/i.test(command) ? [`${command}.com`, `${command}.exe`] : [command];
  return entries(system)
    .filter((entry) => isWhole(entry, isWindows))
    .flatMap((entry) => names.map((name) => join(entry, name)))
    .find(system.isProgram);
}

/**
 * The entries of the PATH. Windows has some in quotes, which may hold a semicolon.
 * @param {System} system
 */
function entries({ isWindows, folders }) {
  return isWindows ? (folders.match(/(?:"[^"]*"?|[^;"])+/g) ?? []).map((entry) => entry.replaceAll('"', "")) : folders.split(":");
}

module.exports = { executable, isName, isWhole };
