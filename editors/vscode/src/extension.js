// @ts-check
/** polarcheck in VS Code: the server, the status bar with the verdict, and the picture beside the program. */
"use strict";

const vscode = require("vscode");
const { Client } = require("./client");
const { Picture } = require("./picture");
const { details, text } = require("./verdict");

/** @typedef {import("./verdict").Verdict} Verdict */

/** @type {Client | undefined} */
let client;

/** @param {vscode.ExtensionContext} context */
function activate(context) {
  const log = vscode.window.createOutputChannel("polarcheck", { log: true });
  const bar = vscode.window.createStatusBarItem("polarcheck.verdict", vscode.StatusBarAlignment.Left, 50);
  bar.name = "polarcheck: verdict";
  /** Programs whose encoding is in doubt. @type {Set<string>} */
  const warned = new Set();
  /** By URI, the verdict of each open program. @type {Map<string, Verdict>} */
  const verdicts = new Map();
  /** @type {import("./client").State} */
  let state = "starting";
  /** @type {Picture | undefined} */
  let picture;

  /** @param {vscode.TextDocument | undefined} document */
  const isProgram = (document) =>
    document !== undefined &&
    ["file", "untitled"].includes(document.uri.scheme) &&
    started.languages.includes(document.languageId);

  const show = () => {
    const document = vscode.window.activeTextEditor?.document;
    vscode.commands.executeCommand("setContext", "polarcheck.isProgram", isProgram(document));
    if (!isProgram(document) || !document) {
      bar.hide();
      return;
    }
    const verdict = verdicts.get(document.uri.toString());
    const tooltip = new vscode.MarkdownString("", true);
    tooltip.isTrusted = { enabledCommands: ["polarcheck.showPicture", "polarcheck.restart", "polarcheck.showLog"] };
    const links = "[Show Picture](command:polarcheck.showPicture) | [Show Log](command:polarcheck.showLog) | [Restart](command:polarcheck.restart)";
    if (state !== "ended") {
      bar.text = text(verdict);
      bar.command = "workbench.actions.view.problems";
      (verdict ? details(verdict) : [state === "starting" ? "polarcheck is starting." : "The program is being checked."]).forEach((line) => tooltip.appendText(line).appendMarkdown("  \n"));
    } else {
      bar.text = "$(circle-slash) polarcheck is not running";
      bar.command = "polarcheck.showLog";
    }
    tooltip.appendMarkdown(`\n${links}`);
    bar.tooltip = tooltip;
    bar.accessibilityInformation = { label: `polarcheck: ${bar.text.replace(/\$\([^)]*\)/g, "").trim()}` };
    bar.show();
  };

  const started = new Client(
    log,
    (verdict) => {
      // The server writes addresses as the editor has; both are compared as the editor writes them.
      const uri = vscode.Uri.parse(verdict.uri).toString();
      verdicts.set(uri, verdict);
      if (picture?.uri.toString() === uri) {
        picture.checked();
      }
      show();
    },
    (changed) => {
      state = changed;
      verdicts.clear();
      show();
      if (state === "ended") {
        picture?.ended();
      }
    },
  );
  client = started;

  /** Start the server with the first program: in most windows there is none. @param {vscode.TextDocument} document */
  const start = (document) => {
    if (isProgram(document)) {
      started.begin();
      warn(document);
    }
  };

  /**
   * Bytes that are no UTF-8 are lost once a program is saved that was read as UTF-8: say so before.
   * @param {vscode.TextDocument} document
   */
  const warn = async (document) => {
    const name = document.uri.toString();
    if (warned.has(name) || !document.getText().includes("\ufffd")) {
      return;
    }
    warned.add(name);
    const chosen = await vscode.window.showWarningMessage(
      `${document.fileName.split(/[\\/]/).at(-1)} has characters that are not in its encoding; saving it would lose them. Reopen it as Western (ISO 8859-1), or in the encoding of the control.`,
      "Change Encoding",
    );
    if (chosen) {
      await vscode.window.showTextDocument(document);
      await vscode.commands.executeCommand("workbench.action.editor.changeEncoding");
    }
  };

  const showPicture = () => {
    const document = vscode.window.activeTextEditor?.document;
    if (!isProgram(document) || !document) {
      vscode.window.showInformationMessage("polarcheck: open an NC program first; the picture is of the program in the editor.");
      return;
    }
    if (picture) {
      picture.panel.reveal(undefined, true);
      if (picture.uri.toString() !== document.uri.toString()) {
        picture.show(document.uri);
      }
    } else {
      picture = new Picture(started, document.uri, () => {
        picture = undefined;
      });
    }
  };

  context.subscriptions.push(
    log,
    bar,
    { dispose: () => picture?.dispose() },
    vscode.commands.registerCommand("polarcheck.showPicture", showPicture),
    vscode.commands.registerCommand("polarcheck.restart", () => started.restart()),
    vscode.commands.registerCommand("polarcheck.showLog", () => log.show()),
    vscode.window.onDidChangeActiveTextEditor((editor) => {
      show();
      // The picture is that of the program at hand.
      if (picture && editor && isProgram(editor.document) && picture.uri.toString() !== editor.document.uri.toString()) {
        picture.show(editor.document.uri);
      }
    }),
    vscode.workspace.onDidOpenTextDocument((document) => start(document)),
    vscode.workspace.onDidCloseTextDocument((document) => verdicts.delete(document.uri.toString())),
    vscode.workspace.onDidChangeConfiguration((event) => {
      if (event.affectsConfiguration("polarcheck")) {
        started.configured();
        vscode.workspace.textDocuments.forEach(start);
        show();
      }
    }),
    vscode.workspace.onDidGrantWorkspaceTrust(() => started.configured()),
  );
  show();
  vscode.workspace.textDocuments.forEach(start);
}

async function deactivate() {
  await client?.end();
}

module.exports = { activate, deactivate };
