// ---- choosing: by keys, and by the rows of the table of findings ----

/** programs: for each its picture, its sections and its list of findings. */
function chooser(programs, state) {
  const { chosen } = state;

  function showFinding(program, finding) {
    state.choose({ program, finding });
    programs[program].list.zoomTo(finding);
  }

  function stepFinding(way) {
    const { order } = programs[chosen.program].picture;
    if (order.length) {
      const from = chosen.finding === null ? (way > 0 ? -1 : order.length) : order.indexOf(chosen.finding);
      showFinding(chosen.program, order[Math.min(Math.max(from + way, 0), order.length - 1)]);
    }
  }

  function stepMove(way) {
    const count = programs[chosen.program].picture.sections[chosen.section].moves.line.length;
    const from = chosen.move === null ? (way > 0 ? -1 : count) : chosen.move;
    state.choose({ move: Math.min(Math.max(from + way, 0), count - 1) });
  }

  function letGo() {
    state.choose({ move: null, finding: null, line: null, time: null });
  }

  /** What a key does; undefined leaves it to the browser. Up and down scroll until something is chosen. */
  function actionOf(key) {
    const isChosen = chosen.line !== null;
    if (key === "Escape") {
      return letGo;
    }
    if ((key === "ArrowUp" || key === "ArrowDown") && isChosen) {
      return () => stepFinding(key === "ArrowDown" ? 1 : -1);
    }
    const section = programs[chosen.program].picture.sections[chosen.section];
    if (!section || !section.moves.line.length) {
      return undefined;
    }
    const go = (move) => () => state.choose({ move });
    const steps = { ArrowRight: () => stepMove(1), ArrowLeft: () => stepMove(-1) };
    return isChosen ? { ...steps, Home: go(0), End: go(section.moves.line.length - 1) }[key] : steps[key];
  }

  document.addEventListener("keydown", (event) => {
    const isWritten = event.target instanceof Element && event.target.closest("select, input, textarea");
    if (event.defaultPrevented || event.ctrlKey || event.altKey || event.metaKey || event.shiftKey || (isWritten && event.key !== "Escape")) {
      return;
    }
    const row = event.target instanceof Element ? event.target.closest("tr[data-finding]") : null;
    const chooses = row && (event.key === "Enter" || event.key === " ");
    const action = chooses ? () => showFinding(Number(row.dataset.picture), Number(row.dataset.finding)) : actionOf(event.key);
    if (action) {
      event.preventDefault();
      action();
    }
  });
  document.querySelectorAll("tr[data-finding]").forEach((row) => {
    row.tabIndex = 0;
    row.addEventListener("click", () => {
      if (!String(getSelection())) {
        showFinding(Number(row.dataset.picture), Number(row.dataset.finding));
      }
    });
    state.subscribe((now) => {
      row.classList.toggle("is-chosen", now.program === Number(row.dataset.picture) && now.finding === Number(row.dataset.finding));
    });
  });
}
