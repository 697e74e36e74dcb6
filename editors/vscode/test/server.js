// @ts-check
/** An editor for tests: it starts the server of this checkout, and speaks the protocol with it. */
"use strict";

const { spawn } = require("node:child_process");
const path = require("node:path");
const { pathToFileURL } = require("node:url");
const { StreamMessageReader, StreamMessageWriter, createMessageConnection } = require("vscode-jsonrpc/node");

/** The Python that has polarcheck: of the checkout, unless POLARCHECK_PYTHON names another. */
const PYTHON = process.env.POLARCHECK_PYTHON || path.join(__dirname, "..", "..", "..", ".venv", "bin", "python");

class Session {
  /**
   * @param {string[]} options of `polarcheck server`
   * @param {string} folder
   */
  constructor(options, folder) {
    this.folder = folder;
    this.child = spawn(PYTHON, ["-m", "polarcheck", ...options], { cwd: folder });
    this.connection = createMessageConnection(new StreamMessageReader(this.child.stdout), new StreamMessageWriter(this.child.stdin));
    /** Notifications that nobody has waited for, by method. @type {Map<string, any[]>} */
    this.said = new Map();
    /** @type {Map<string, ((params: any) => void)[]>} */
    this.waiting = new Map();
    this.connection.onNotification((method, params) => {
      const waits = this.waiting.get(method)?.shift();
      if (waits) {
        waits(params);
      } else {
        this.said.set(method, [...(this.said.get(method) ?? []), params]);
      }
    });
    this.connection.onRequest(() => null);
    this.connection.listen();
  }

  /** @param {object} [options] of the initialization */
  async begin(options = {}) {
    const result = await this.connection.sendRequest("initialize", {
      processId: process.pid,
      rootUri: null,
      workspaceFolders: [{ uri: pathToFileURL(this.folder).href, name: "programs" }],
      capabilities: { experimental: { polarcheck: { verdict: true } }, textDocument: { hover: { contentFormat: ["markdown"] } } },
      initializationOptions: options,
    });
    await this.connection.sendNotification("initialized", {});
    return result.capabilities;
  }

  /**
   * The next notification of a method.
   * @param {string} method
   * @returns {Promise<any>}
   */
  async next(method) {
    const said = this.said.get(method) ?? [];
    if (said.length) {
      return said.shift();
    }
    return new Promise((resolve) => this.waiting.set(method, [...(this.waiting.get(method) ?? []), resolve]));
  }

  /**
   * @param {string} name
   * @param {string} text
   */
  async open(name, text) {
    const uri = pathToFileURL(path.join(this.folder, name)).href;
    await this.connection.sendNotification("textDocument/didOpen", { textDocument: { uri, languageId: "gcode", version: 1, text } });
    return uri;
  }

  /** The exit code. @returns {Promise<number | null>} */
  async end() {
    const ended = new Promise((resolve) => this.child.once("exit", resolve));
    await this.connection.sendRequest("shutdown");
    await this.connection.sendNotification("exit");
    this.connection.end();
    return ended;
  }
}

module.exports = { PYTHON, Session };
