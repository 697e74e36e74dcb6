// ---- findings: the list beside the drawing; the chosen one shows all that is known of it ----

/** The list of findings. sections: what sectionsView returns. */
function findingsView(root, picture, state, program, sections) {
  const place = root.querySelector(".list");
  const { findings } = picture;
  const list = element("ol");
  const entries = new Map();

  function choose(finding) {
    state.choose({ program, finding });
    zoomTo(finding);
  }

  function zoomTo(number) {
    const { section, move, places, span } = findings[number];
    const view = section === null ? undefined : sections.views[section];
    if (view === undefined) {
      return;
    }
    const points = places && places.length ? places : move === null ? [] : wayOf(view.section, move);
    if (points.length) {
      view.closeUp(points.slice(0, 1), span || Math.max(4 * (view.section.radius || 1), 1));
    }
  }

  for (const number of picture.order) {
    const finding = findings[number];
    const head = element("button");
    head.type = "button";
    head.append(element("span", String(picture.numbers[number])), element("span", `line ${finding.line}`), element("span", finding.message));
    head.addEventListener("click", () => choose(number));
    const entry = element("li", "", head);
    entry.className = `${finding.severity}${finding.silenced ? " silenced" : ""}`;
    entry.dataset.finding = String(number);
    entries.set(number, entry);
    list.append(entry);
  }
  place.append(element("h2", findings.length ? `Findings: ${findings.length}` : "No findings"), list);
  state.subscribe((chosen) => {
    entries.forEach((entry, number) => {
      const isChosen = chosen.program === program && chosen.finding === number;
      if (entry.classList.contains("is-chosen") !== isChosen) {
        entry.classList.toggle("is-chosen", isChosen);
        entry.firstChild.setAttribute("aria-current", String(isChosen));
        if (isChosen) {
          entry.scrollIntoView({ block: "nearest" });
        }
      }
    });
  });
  return { zoomTo };
}

/** The box of the chosen move: its facts, and the findings at its line. */
function chosenView(root, picture, state, program) {
  const box = root.querySelector(".chosen");
  function show(chosen) {
    if (chosen.program !== program) {
      return;
    }
    const { section, move, line } = chosen;
    const at = move === null ? [] : factsOf(picture.sections[section], move);
    const hint = picture.sections.length ? "Point at the path, or choose a move, a finding, or a place in time." : "";
    const facts = line === null ? [["", hint]] : at.length ? at : [["line", String(line)]];
    const here = picture.findings.filter((finding) => line !== null && (finding.line === line || (finding.also || []).includes(line)));
    box.replaceChildren(...pairs(facts), ...pairs(here.map((finding) => [finding.severity, `${finding.message} [${finding.rule}]`])));
  }
  show(state.chosen);
  state.subscribe(show);
}
