// ---- choosing: one move, one finding, or none; everything on the page shows the same ----

function chooser(programs) {
  const chosen = { program: 0, section: null, move: null, finding: null };

  function viewOf(program, section) {
    return programs[program].views[section];
  }

  function rowOf(program, finding) {
    return document.querySelector(`tr[data-picture="${program}"][data-finding="${finding}"]`);
  }

  /** The findings of a move, as they are told. */
  function messagesAt(program, section, move) {
    return programs[program].findings
      .filter((finding) => finding.section === section && finding.move !== null && finding.line === lineOf(program, section, move))
      .map((finding) => `${finding.severity}: ${finding.message} [${finding.rule}]`);
  }

  function lineOf(program, section, move) {
    return viewOf(program, section).section.moves.line[move];
  }

  function findingAt(program, section, move) {
    const line = lineOf(program, section, move);
    const found = programs[program].findings.findIndex(
      (finding) => finding.section === section && finding.move !== null && finding.line === line,
    );
    return found < 0 ? null : found;
  }

  function set(program, section, move, finding) {
    if (chosen.section !== null && (chosen.program !== program || chosen.section !== section)) {
      viewOf(chosen.program, chosen.section).show(null, []);
    }
    if (chosen.finding !== null && rowOf(chosen.program, chosen.finding)) {
      rowOf(chosen.program, chosen.finding).classList.remove("is-chosen");
      rowOf(chosen.program, chosen.finding).removeAttribute("aria-current");
    }
    Object.assign(chosen, { program, section, move, finding });
    if (section !== null) {
      viewOf(program, section).show(move, move === null ? [] : messagesAt(program, section, move));
    }
    if (finding !== null && rowOf(program, finding)) {
      rowOf(program, finding).classList.add("is-chosen");
      rowOf(program, finding).setAttribute("aria-current", "true");
    }
  }

  function chooseMove(program, section, move) {
    set(program, section, move, findingAt(program, section, move));
  }

  /** A finding of what is not drawn is chosen, too; its row is all that shows it. */
  function chooseFinding(program, place) {
    const finding = programs[program].findings[place];
    const isDrawn = finding.section !== null && viewOf(program, finding.section) !== undefined;
    set(program, isDrawn ? finding.section : null, isDrawn ? finding.move : null, place);
    const view = isDrawn ? viewOf(program, finding.section) : null;
    if (view && finding.move !== null) {
      view.draw();
      view.root.querySelector(".drawings").scrollIntoView({ block: "nearest" });
    } else {
      rowOf(program, place).scrollIntoView({ block: "nearest" });
    }
  }

  /** The section to step in: that of the chosen move, else the first in sight. */
  function stepped() {
    if (chosen.section !== null) {
      return viewOf(chosen.program, chosen.section);
    }
    const views = programs.flatMap((program) => program.views);
    return views.find((view) => view.root.getBoundingClientRect().bottom > 0) || views[0];
  }

  function stepFinding(way) {
    const count = programs[chosen.program].findings.length;
    if (count) {
      const from = chosen.finding === null ? (way > 0 ? -1 : count) : chosen.finding;
      chooseFinding(chosen.program, Math.min(Math.max(from + way, 0), count - 1));
    }
  }

  function letGo() {
    set(chosen.program, chosen.section, null, null);
    chosen.section = null;
  }

  /** What a key does; undefined leaves it to the browser. Up and down scroll until something is chosen. */
  function actionOf(key) {
    const view = stepped();
    const isChosen = chosen.move !== null || chosen.finding !== null;
    if (key === "Escape") {
      return letGo;
    }
    if ((key === "ArrowUp" || key === "ArrowDown") && isChosen) {
      return () => stepFinding(key === "ArrowDown" ? 1 : -1);
    }
    if (!view || !view.section.moves.line.length) {
      return undefined;
    }
    const { picture, section } = view.root.dataset;
    const last = view.section.moves.line.length - 1;
    const go = (move) => () => chooseMove(Number(picture), Number(section), move);
    const steps = { ArrowRight: () => view.step(1), ArrowLeft: () => view.step(-1) };
    return isChosen ? { ...steps, Home: go(0), End: go(last) }[key] : steps[key];
  }

  document.addEventListener("keydown", (event) => {
    const isWritten = event.target instanceof Element && event.target.closest("select, input, textarea");
    if (event.ctrlKey || event.altKey || event.metaKey || event.shiftKey || (isWritten && event.key !== "Escape")) {
      return;
    }
    const row = event.target instanceof Element ? event.target.closest("tr[data-finding]") : null;
    const chooses = row && (event.key === "Enter" || event.key === " ");
    const action = chooses ? () => chooseFinding(Number(row.dataset.picture), Number(row.dataset.finding)) : actionOf(event.key);
    if (action) {
      event.preventDefault();
      action();
    }
  });
  document.querySelectorAll("tr[data-finding]").forEach((row) => {
    row.tabIndex = 0;
    row.addEventListener("click", () => {
      if (!String(getSelection())) {
        chooseFinding(Number(row.dataset.picture), Number(row.dataset.finding));
      }
    });
  });
  return chooseMove;
}
