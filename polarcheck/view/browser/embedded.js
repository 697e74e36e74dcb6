// ---- embedded: the page in a view of an editor, where it follows the cursor and leads to blocks ----

/**
 * In a browser it does nothing. Messages of the editor: { kind: "line", line } as its cursor moves; { kind: "keep" }
 * before it draws the page anew, { kind: "restore", kept } after it. Those of the page: { kind: "ready" };
 * { kind: "line", line } as something is chosen on it; { kind: "kept", kept }.
 */
function embedded(state, memory) {
  if (typeof acquireVsCodeApi !== "function") {
    return;
  }
  const editor = acquireVsCodeApi();
  let isFollowing = false;

  function follow(change) {
    isFollowing = true;
    try {
      change();
    } finally {
      isFollowing = false;
    }
  }

  /** The colors of the editor, which puts them into the class of the body. */
  function dress() {
    const { classList } = document.body;
    const isLight = classList.contains("vscode-light") || classList.contains("vscode-high-contrast-light");
    theme(isLight ? "light" : "dark");
  }

  window.addEventListener("message", ({ data }) => {
    if (!data) {
      return;
    }
    if (data.kind === "line" && Number.isInteger(data.line) && data.line !== state.chosen.line) {
      follow(() => state.choose({ program: 0, line: data.line }));
    } else if (data.kind === "keep") {
      editor.postMessage({ kind: "kept", kept: memory.keep() });
    } else if (data.kind === "restore") {
      follow(() => memory.restore(data.kept));
    }
  });
  state.subscribe((chosen, before) => {
    if (!isFollowing && chosen.line !== null && chosen.line !== before.line) {
      editor.postMessage({ kind: "line", line: chosen.line });
    }
  });
  // The editor chooses the colors.
  document.querySelectorAll("button.theme").forEach((made) => made.remove());
  dress();
  new MutationObserver(dress).observe(document.body, { attributeFilter: ["class"] });
  editor.postMessage({ kind: "ready" });
}
