// ---- keys: what they do, and the list of them ----

/** The list of keys: what it is about, the keys, what they do. */
const KEYS = [
  ["Moves and findings", "\u2190 \u2192", "the move before, the next move"],
  ["Moves and findings", "Home End", "the first, the last move"],
  ["Moves and findings", "\u2191 \u2193", "the finding before, the next finding"],
  ["Moves and findings", "Esc", "choose nothing"],
  ["Player", "Space", "play, pause"],
  ["Player", ", .", "a little back, on"],
  ["Player", "< >", "slower, faster"],
  ["Player", "n", "the next section, at the end of one"],
  ["Face", "+ \u2212", "zoom in, out; also the wheel, and two fingers"],
  ["Face", "Shift \u2190 \u2192 \u2191 \u2193", "move the window; also by dragging"],
  ["Face", "0", "the whole face; also a double click"],
  ["Face", "d", "show or hide the drawing"],
  ["Face", "b", "sections side by side"],
  ["Measuring", "m", "begin, end"],
  ["Measuring", "\u2190 \u2192 \u2191 \u2193", "the next corner in this direction"],
  ["Measuring", "w", "at a corner: the walls that meet there"],
  ["Measuring", "Enter", "take the corner or wall; also a click"],
  ["Measuring", "Alt", "with the pointer: no snapping"],
  ["Measuring", "Esc", "let go of what is taken, then end"],
  ["Program", "/", "find text or a line number; Enter, Shift Enter: next hit, hit before"],
  ["Program", "\u2191 \u2193 Page Home End", "in the lines of the program: the next lines"],
  ["Program", "c", "copy the position at the pointer, or the end of the move, as words of the program"],
  ["Program", "l", "copy a link to the line"],
  ["Program", "?", "this list"],
];

/** The dialog with the list of keys. */
function keysDialog() {
  const dialog = document.createElement("dialog");
  dialog.id = "keys";
  const title = element("h2", "Keys");
  title.id = "keys-title";
  dialog.setAttribute("aria-labelledby", title.id);
  const table = element("table");
  let group = null;
  for (const [about, keys, does] of KEYS) {
    if (about !== group) {
      const head = element("th", about);
      head.colSpan = 2;
      head.scope = "colgroup";
      table.append(element("tr", "", head));
      group = about;
    }
    table.append(element("tr", "", element("td", "", element("kbd", keys)), element("td", does)));
  }
  title.append(button("Close", () => dialog.close()));
  dialog.append(title, table);
  dialog.addEventListener("click", (event) => {
    if (event.target === dialog) {
      dialog.close();
    }
  });
  document.body.append(dialog);
  return dialog;
}

/** Keys of the tools. hands: the tools of each program. */
function toolKeys(hands, state) {
  const dialog = keysDialog();
  const here = () => hands[state.chosen.program];
  const actions = {
    m: () => here().measure(), c: () => here().copy(), l: () => here().link(), "/": () => here().find(),
    d: () => here().drawing(), b: () => here().sides(), "+": () => here().zoom.in(), "=": () => here().zoom.in(),
    "-": () => here().zoom.out(), 0: () => here().zoom.whole(), "?": () => dialog.showModal(),
  };
  const shifted = { ArrowRight: "right", ArrowLeft: "left", ArrowUp: "up", ArrowDown: "down" };

  // Before other listeners: Esc ends measuring before it lets go of what is chosen.
  document.addEventListener("keydown", (event) => {
    const { target } = event;
    const isWritten = target instanceof Element && target.closest("input:not([type=range], [type=checkbox]), select, textarea");
    if (dialog.open) {
      event.stopPropagation();
    }
    if (event.ctrlKey || event.altKey || event.metaKey || isWritten || dialog.open) {
      return;
    }
    const action = actionOf(event);
    if (action) {
      event.preventDefault();
      event.stopPropagation();
      action();
    }
  }, true);

  function actionOf({ key, shiftKey }) {
    if (key === "Escape") {
      return here().isMeasuring() ? () => here().letGo() : undefined;
    }
    if (shiftKey && key in shifted) {
      return () => here().zoom[shifted[key]]();
    }
    return actions[shiftKey && key.length === 1 && key !== "?" && key !== "+" && key !== "/" ? "" : key];
  }
  return dialog;
}
