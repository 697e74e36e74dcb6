// @ts-check
/** The connection to the server: starts it, starts it again, and says what to do where that fails. */
"use strict";

const { spawn } = require("node:child_process");
const vscode = require("vscode");
const { CloseAction, ErrorAction, LanguageClient, State: ClientState } = require("vscode-languageclient/node");
const { executable } = require("./executable");
const { advice, commandLine, distrust } = require("./options");

/** A server that ends within this time after its start is not started again [ms]. */
const SHORTEST_LIFE = 10_000;
const MOST_RESTARTS = 3;
/** How long a process that no longer answers may take to end before the message about it [ms]. */
const LONGEST_END = 2_000;

/** @typedef {import("./verdict").Verdict} Verdict */
/** @typedef {{ code: number | null, said: string, ended: Promise<void> }} Left */
/** @typedef {"starting" | "running" | "ended"} State */

/** It writes into the log alone: the messages that people see are ours. */
class Connection extends LanguageClient {
  /**
   * @param {string} message
   * @param {any} [data]
   */
  error(message, data) {
    super.error(message, data, false);
  }
}

class Client {
  /**
   * @param {vscode.LogOutputChannel} log
   * @param {(verdict: Verdict) => void} judged called with the verdict of each checked program
   * @param {(state: State) => void} changed called when the server begins to start, is ready, and has ended
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
    return { ...line, folder, isRefused: line.isOfFolder && !vscode.workspace.isTrusted };
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
    /** What the process has left behind; ended: once it has. @type {Left} */
    const left = { code: null, said: "", ended: Promise.resolve() };
    const begun = Date.now();
    let hasComplained = false;
    const fail = async () => {
      if (!hasComplained) {
        hasComplained = true;
        await Promise.race([left.ended, new Promise((resolve) => setTimeout(resolve, LONGEST_END).unref())]);
        this.complain(line.isRefused ? distrust(line.command) : advice(line.command, left.code, left.said));
      }
    };
    const client = new Connection("polarcheck", "polarcheck", () => this.spawned(line, left), {
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
          this.changed("ended");
          if (Date.now() - begun > SHORTEST_LIFE && this.restarts < MOST_RESTARTS) {
            this.restarts += 1;
            this.log.warn(`polarcheck has ended with ${left.code}, and is started again`);
            return { action: CloseAction.Restart, handled: true };
          }
          fail();
          return { action: CloseAction.DoNotRestart, handled: true };
        },
      },
    });
    this.client = client;
    this.changed("starting");
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
      client.onDidChangeState(({ newState }) => {
        if (newState === ClientState.Running && client === this.client) {
          this.changed("running");
        }
      });
      await client.start();
    } catch (error) {
      this.log.error(error instanceof Error ? error.message : String(error));
      this.client = undefined;
      this.changed("ended");
      // Not awaited: the message stays until somebody closes it.
      fail();
    }
  }

  /**
   * The process of the server, once it runs.
   * @param {{ command: string, args: string[], folder: string, isRefused: boolean }} line
   * @param {Left} left
   * @returns {Promise<import("node:child_process").ChildProcess>}
   */
  async spawned({ command, args, folder, isRefused }, left) {
    const program = isRefused ? undefined : executable(command, folder);
    if (program === undefined) {
      throw new Error(isRefused ? distrust(command) : advice(command, null, ""));
    }
    this.log.info(`${program} ${args.join(" ")}`);
    return new Promise((resolve, reject) => {
      const child = spawn(program, args, { cwd: folder || undefined, env: { ...process.env, PYTHONUTF8: "1" } });
      child.once("spawn", () => resolve(child));
      child.once("error", reject);
      left.ended = new Promise((ended) => {
        // "close" comes once all is read that it has said; -1: ended by a signal.
        child.once("close", (code) => {
          left.code = child.pid === undefined ? null : code ?? -1;
          ended();
        });
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
    await this.queue;
    if (!this.client?.isRunning()) {
      throw new Error("polarcheck is not running: its log says why.");
    }
    return this.client.sendRequest(method, params, token);
  }

  async end() {
    const client = this.client;
    this.client = undefined;
    this.changed("ended");
    if (client?.needsStop()) {
      await client.stop().catch((error) => this.log.warn(String(error)));
    }
    await client?.dispose().catch(() => undefined);
  }
}

module.exports = { Client };
