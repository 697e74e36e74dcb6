// @ts-check
/** The picture of a program in a view beside it: it follows the cursor, and a click in it leads to the block. */
"use strict";

const path = require("node:path");
const vscode = require("vscode");

/** How long the picture waits for the next check, and for the cursor to rest [ms]. */
const PAUSE = 200;
const CURSOR_PAUSE = 30;
/** How long the page may take to say what is to be kept of it [ms]. */
const LONGEST_KEEP = 300;

/**
 * @typedef {object} Client
 * @property {(method: string, params: object, token?: vscode.CancellationToken) => Promise<any>} request
 */

class Picture {
  /**
   * @param {Client} client
   * @param {vscode.Uri} uri of the program
   * @param {() => void} closed called once the view is closed
   */
  constructor(client, uri, closed) {
    this.client = client;
    this.uri = uri;
    this.library = "";
    /** The line that editor and picture both show, from 1; 0 for none. */
    this.line = 0;
    this.isStale = true;
    /** The page of the program is there, and answers. */
    this.isReady = false;
    /** @type {any} */
    this.kept = undefined;
    /** @type {(kept: any) => void} */
    this.answer = () => undefined;
    /** @type {ReturnType<typeof setTimeout> | undefined} */
    this.waiting = undefined;
    /** @type {ReturnType<typeof setTimeout> | undefined} */
    this.resting = undefined;
    /** @type {vscode.CancellationTokenSource | undefined} */
    this.asking = undefined;
    this.panel = vscode.window.createWebviewPanel(
      "polarcheck.picture",
      "polarcheck",
      { viewColumn: vscode.ViewColumn.Beside, preserveFocus: true },
      { enableScripts: true, retainContextWhenHidden: true, localResourceRoots: [] },
    );
    this.subscriptions = [
      this.panel.onDidDispose(() => {
        this.subscriptions.forEach((subscription) => subscription.dispose());
        clearTimeout(this.waiting);
        clearTimeout(this.resting);
        this.asking?.cancel();
        closed();
      }),
      this.panel.onDidChangeViewState(() => this.panel.visible && this.isStale && this.refresh(0)),
      this.panel.webview.onDidReceiveMessage((message) => this.received(message)),
      vscode.window.onDidChangeTextEditorSelection((event) => this.moved(event.textEditor)),
    ];
    this.show(uri);
  }

  /**
   * Show a program.
   * @param {vscode.Uri} uri
   */
  show(uri) {
    this.uri = uri;
    this.line = 0;
    this.isReady = false;
    this.kept = undefined;
    this.panel.title = `Picture of ${path.posix.basename(uri.path)}`;
    this.refresh(0);
  }

  /**
   * Ask for the page again, after a delay [ms]; later if the view is hidden.
   * @param {number} delay
   */
  refresh(delay) {
    this.isStale = true;
    this.asking?.cancel();
    clearTimeout(this.waiting);
    if (this.panel.visible) {
      this.waiting = setTimeout(() => this.ask(), delay);
    }
  }

  /** The program has been checked. */
  checked() {
    this.refresh(PAUSE);
  }

  /** The server has ended; another one may have another library. */
  ended() {
    this.library = "";
    this.refresh(0);
  }

  async ask() {
    const asking = (this.asking = new vscode.CancellationTokenSource());
    const { webview } = this.panel;
    const uri = this.uri.toString();
    try {
      if (!this.library) {
        const { path: library } = await this.client.request("polarcheck/library", {}, asking.token);
        const file = vscode.Uri.file(library);
        webview.options = { enableScripts: true, localResourceRoots: [vscode.Uri.joinPath(file, "..")] };
        this.library = webview.asWebviewUri(file).toString();
      }
      const params = { uri, library: this.library, sources: webview.cspSource };
      const { html } = await this.client.request("polarcheck/picture", params, asking.token);
      const kept = await this.keep();
      if (asking === this.asking && !asking.token.isCancellationRequested) {
        this.isStale = false;
        this.kept = kept;
        this.isReady = false;
        webview.html = html;
      }
    } catch (error) {
      // A newer check asks again.
      const code = error instanceof Error && "code" in error ? error.code : 0;
      if (asking === this.asking && !asking.token.isCancellationRequested && code !== -32801 && code !== -32800) {
        this.isStale = false;
        this.isReady = false;
        webview.html = reason(error instanceof Error ? error.message : String(error));
      }
    }
  }

  /**
   * What is to be kept of the page as it is drawn anew: its window, what is chosen and how it is shown.
   * @returns {Promise<any>}
   */
  keep() {
    if (!this.isReady) {
      return Promise.resolve(this.kept);
    }
    this.panel.webview.postMessage({ kind: "keep" });
    return new Promise((resolve) => {
      this.answer = resolve;
      setTimeout(() => resolve(this.kept), LONGEST_KEEP);
    });
  }

  /**
   * A message of the page; it may be anything.
   * @param {any} message
   */
  received(message) {
    if (message?.kind === "kept") {
      this.answer(message.kept);
    } else if (message?.kind === "ready") {
      this.isReady = true;
      if (this.kept) {
        this.panel.webview.postMessage({ kind: "restore", kept: this.kept });
      }
      this.line = 0;
      const editor = this.editor();
      if (editor) {
        this.moved(editor);
      }
    } else if (message?.kind === "line" && Number.isInteger(message.line)) {
      this.reveal(message.line);
    }
  }

  /** The editor that shows the program. */
  editor() {
    return vscode.window.visibleTextEditors.find((editor) => editor.document.uri.toString() === this.uri.toString());
  }

  /**
   * Lead to a block, without taking the focus from the picture.
   * @param {number} line from 1
   */
  async reveal(line) {
    const shown = this.editor();
    const options = { viewColumn: shown?.viewColumn ?? vscode.ViewColumn.One, preserveFocus: true };
    const editor = shown ?? (await vscode.window.showTextDocument(await vscode.workspace.openTextDocument(this.uri), options));
    if (line < 1 || line > editor.document.lineCount) {
      return;
    }
    this.line = line;
    const { range } = editor.document.lineAt(line - 1);
    if (editor.selection.active.line !== line - 1) {
      editor.selection = new vscode.Selection(range.start, range.start);
    }
    editor.revealRange(range, vscode.TextEditorRevealType.InCenterIfOutsideViewport);
  }

  /**
   * The cursor has moved.
   * @param {vscode.TextEditor} editor
   */
  moved(editor) {
    const follows = vscode.workspace.getConfiguration("polarcheck").get("picture.followsCursor", true);
    if (!follows || editor.document.uri.toString() !== this.uri.toString()) {
      return;
    }
    clearTimeout(this.resting);
    this.resting = setTimeout(() => {
      const line = editor.selection.active.line + 1;
      if (line !== this.line) {
        this.line = line;
        this.panel.webview.postMessage({ kind: "line", line });
      }
    }, CURSOR_PAUSE);
  }

  dispose() {
    this.panel.dispose();
  }
}

/**
 * A page with a reason instead of a picture; the reason is text, not markup.
 * @param {string} text
 */
function reason(text) {
  const signs = new Map([["&", "&amp;"], ["<", "&lt;"], [">", "&gt;"], ['"', "&quot;"], ["'", "&#39;"]]);
  const escaped = text.replace(/[&<>"']/g, (sign) => signs.get(sign) || "");
  const policy = "default-src 'none'; style-src 'unsafe-inline'";
  return `<!DOCTYPE html><html lang="en"><head><meta charset="utf-8"><meta http-equiv="Content-Security-Policy" content="${policy}"></head><body><h1>No picture</h1><p>${escaped}</p></body></html>`;
}

module.exports = { Picture, reason };
