// @ts-check
/** The connection to the server: starts it, starts it again, and says what to do where that fails. */
"use strict";

const { spawn } = require("node:child_process");
const vscode = require("vscode");
const { CloseAction, ErrorAction, LanguageClient } = require("vscode-languageclient/node");
const { advice, commandLine } = require("./options");

/** A server that ends within this time after its start is not started again [ms]. */
const SHORTEST_LIFE = 10_000;
const MOST_RESTARTS = 3;

/** @typedef {import("./verdict").Verdict} Verdict */

class Client {
  /**
   * @param {vscode.LogOutputChannel} log
   * @param {(verdict: Verdict) => void} judged called with the verdict of each checked program
   * @param {(isRunning: boolean) => void} changed called when the server is ready, and when it has ended
   */
  constructor(log, judged, changed) {
    this.log = log;
    this.judged = judged;
    this.changed = changed;
    this.restarts = 0;
    /** @type {LanguageClient | undefined} */
    this.client = undefined;
    this.key = "";
    /** Starts and ends come one after the other. */
    this.queue = Promise.resolve();
  }

  get settings() {
    return vscode.workspace.getConfiguration("polarcheck");
  }

  get line() {
    const settings = this.settings;
    const folder = vscode.workspace.workspaceFolders?.find((open) => open.uri.scheme === "file")?.uri.fsPath ?? "";
    const line = commandLine(
      {
        path: settings.get("path", "polarcheck"),
        machine: settings.get("machine", ""),
        arguments: settings.get("arguments", []),
        trustedFolders: settings.get("trustedFolders", []),
      },
      folder,
    );
    return { ...line, folder };
  }

  /** The languages of NC programs. @returns {string[]} */
  get languages() {
    return this.settings.get("languages", ["gcode", "sinumerik"]);
  }

  /** Start the server, unless it has been started before. */
  begin() {
    if (!this.key) {
      this.key = "begun";
      this.restart();
    }
  }

  /** Start the server again if a setting that decides how it starts has changed. */
  configured() {
    if (this.key && this.key !== JSON.stringify([this.line, this.languages])) {
      this.restart();
    }
  }

  restart() {
    this.restarts = 0;
    this.queue = this.queue.then(() => this.end()).then(() => this.start());
    return this.queue;
  }

  async start() {
    const line = this.line;
    this.key = JSON.stringify([line, this.languages]);
    /** What the process has left behind. @type {{ code: number | null, said: string }} */
    const left = { code: null, said: "" };
    const begun = Date.now();
    const client = new LanguageClient("polarcheck", "polarcheck", () => this.spawned(line, left), {
      documentSelector: this.languages.flatMap((language) => [
        { scheme: "file", language },
        { scheme: "untitled", language },
      ]),
      outputChannel: this.log,
      synchronize: { configurationSection: "polarcheck" },
      initializationOptions: { inlayHints: this.settings.get("inlayHints", "off") },
      initializationFailedHandler: () => false,
      errorHandler: {
        error: () => ({ action: ErrorAction.Continue, handled: true }),
        closed: () => {
          if (client !== this.client) {
            return { action: CloseAction.DoNotRestart, handled: true };
          }
          this.changed(false);
          if (Date.now() - begun > SHORTEST_LIFE && this.restarts < MOST_RESTARTS) {
            this.restarts += 1;
            this.log.warn(`polarcheck has ended with ${left.code}, and is started again`);
            return { action: CloseAction.Restart, handled: true };
          }
          return { action: CloseAction.DoNotRestart, handled: true };
        },
      },
    });
    this.client = client;
    client.registerFeature({
      fillClientCapabilities: (capabilities) => {
        capabilities.experimental = { ...capabilities.experimental, polarcheck: { verdict: true } };
      },
      initialize: () => undefined,
      getState: () => ({ kind: "static" }),
      clear: () => undefined,
    });
    client.onNotification("polarcheck/verdict", (verdict) => this.judged(verdict));
    try {
      await client.start();
      this.changed(true);
    } catch (error) {
      this.log.error(error instanceof Error ? error.message : String(error));
      this.client = undefined;
      this.changed(false);
      // Not awaited: the message stays until somebody closes it.
      this.complain(advice(line.command, left.code, left.said));
    }
  }

  /**
   * The process of the server, once it runs.
   * @param {{ command: string, args: string[], folder: string }} line
   * @param {{ code: number | null, said: string }} left
   * @returns {Promise<import("node:child_process").ChildProcess>}
   */
  spawned({ command, args, folder }, left) {
    this.log.info(`${command} ${args.join(" ")}`);
    return new Promise((resolve, reject) => {
      const child = spawn(command, args, { cwd: folder || undefined, env: { ...process.env, PYTHONUTF8: "1" } });
      child.once("spawn", () => resolve(child));
      child.once("error", reject);
      child.once("exit", (code) => {
        left.code = code ?? -1;
      });
      child.stderr.setEncoding("utf8").on("data", (text) => {
        left.said = text.trim().split("\n").at(-1)?.trim() || left.said;
      });
    });
  }

  /** @param {string} message */
  async complain(message) {
    const chosen = await vscode.window.showErrorMessage(message, "Open Settings", "Show Log");
    if (chosen === "Open Settings") {
      await vscode.commands.executeCommand("workbench.action.openSettings", "polarcheck.path");
    } else if (chosen === "Show Log") {
      this.log.show();
    }
  }

  /**
   * Ask the server.
   * @param {string} method
   * @param {object} params
   * @param {vscode.CancellationToken} [token]
   * @returns {Promise<any>}
   */
  async request(method, params, token) {
    if (!this.client?.isRunning()) {
      throw new Error("polarcheck is not running: its log says why.");
    }
    return this.client.sendRequest(method, params, token);
  }

  async end() {
    const client = this.client;
    this.client = undefined;
    this.changed(false);
    if (client?.needsStop()) {
      await client.stop().catch((error) => this.log.warn(String(error)));
    }
    await client?.dispose().catch(() => undefined);
  }
}

module.exports = { Client };
