// ---- embedded: the page in a view of an editor, where it follows the cursor and leads to blocks ----

/**
 * In a browser it does nothing. The editor sends { kind: "line", line } as its cursor moves; the page sends the same as
 * something is chosen on it, and { kind: "ready" } once it can follow.
 */
function embeddedView(root, picture, state, program) {
  if (typeof acquireVsCodeApi !== "function" || program > 0) {
    return;
  }
  const editor = acquireVsCodeApi();
  const kept = editor.getState() || {};
  let isFollowing = false;

  window.addEventListener("message", ({ data }) => {
    if (data && data.kind === "line" && Number.isInteger(data.line) && data.line !== state.chosen.line) {
      isFollowing = true;
      try {
        state.choose({ program, line: data.line });
      } finally {
        isFollowing = false;
      }
    }
  });
  state.subscribe((chosen, before) => {
    if (chosen.view !== before.view) {
      editor.setState({ view: chosen.view });
    }
    if (!isFollowing && chosen.line !== null && chosen.line !== before.line) {
      editor.postMessage({ kind: "line", line: chosen.line });
    }
  });
  // After the first choice of the page itself.
  setTimeout(() => {
    if (["face", "machine", "both"].includes(kept.view)) {
      state.choose({ view: kept.view });
    }
    editor.postMessage({ kind: "ready" });
  });
}
