// ---- findings: the list beside the drawing; the chosen one shows all that is known of it ----

/** Other lines of a finding that are listed at once. */
const ALSO = 60;

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
    const finding = findings[number];
    const view = finding.section === null ? undefined : sections.views[finding.section];
    if (view !== undefined && !view.root.hidden) {
      view.zoomTo(finding);
    }
  }

  for (const number of picture.order) {
    const { severity, silenced, line, message } = findings[number];
    const [badge, where, text] = [String(picture.numbers[number]), `line ${line}`, message].map((part) => element("span", part));
    [badge.className, where.className] = ["badge", "where"];
    const name = element("span", ` ${severity}${silenced ? ", silenced" : ""}: `);
    name.className = "only-read";
    where.append(name);
    const head = button("", () => choose(number));
    head.append(badge, where, text);
    const entry = element("li", "", head);
    entry.className = `${severity}${silenced ? " silenced" : ""}`;
    entry.dataset.finding = String(number);
    entries.set(number, entry);
    list.append(entry);
  }
  place.append(element("h2", countsOf(findings)), list);
  // The messages begin below each other.
  const digits = findings.reduce((most, { line }) => Math.max(most, String(line).length), 1);
  place.style.setProperty("--where", `${digits + 4.5}ch`);
  place.style.setProperty("--badge", `${String(findings.length).length * 8 + 9}px`);
  let open = null;
  state.subscribe((chosen) => {
    const now = chosen.program === program ? chosen.finding : null;
    if (now === open) {
      return;
    }
    [[open, false], [now, true]].filter(([number]) => number !== null).forEach(([number, isChosen]) => {
      const entry = entries.get(number);
      entry.classList.toggle("is-chosen", isChosen);
      entry.firstChild.setAttribute("aria-expanded", String(isChosen));
      entry.querySelectorAll(".unfolded").forEach((part) => part.remove());
      if (isChosen) {
        entry.append(unfolded(findings[number], (line) => state.choose({ program, line }), sections));
        showWithin(place, entry);
      }
    });
    open = now;
  });
  return { zoomTo };
}

/** Scroll a box, but not the page, so that an element of it is seen from its top. */
function showWithin(box, part) {
  const [outer, inner] = [box.getBoundingClientRect(), part.getBoundingClientRect()];
  const head = box.querySelector("h2");
  // The heading stays at the top, above what is scrolled.
  const top = outer.top + (head === null ? 0 : head.offsetHeight);
  if (inner.top < top || inner.height > outer.bottom - top) {
    box.scrollTop += inner.top - top;
  } else if (inner.bottom > outer.bottom) {
    box.scrollTop += inner.bottom - outer.bottom;
  }
}

function countsOf(findings) {
  const named = [["error", "errors"], ["warning", "warnings"], ["note", "notes"]].map(([one, many]) => {
    const count = findings.filter((finding) => finding.severity === one && !finding.silenced).length;
    return count ? `${count} ${count === 1 ? one : many}` : "";
  });
  const silenced = findings.filter((finding) => finding.silenced).length;
  return [...named, silenced ? `${silenced} silenced` : ""].filter(Boolean).join(", ") || "No findings";
}

/** All that is known of a finding, and its other lines as buttons. */
function unfolded(finding, chooseLine, sections) {
  const { rule, why, fix, alarm, silenced, also, section, places } = finding;
  const facts = [["Why", why], ["Fix", fix], ["Alarm", alarm], ["Rule", rule], ["Silenced", silenced]].filter(([, text]) => text);
  if (sections.views.length && (section === null || !places.length)) {
    facts.push(["Place", "its place on the face is not known"]);
  }
  const made = element("dl", "", ...pairs(facts));
  if (also.length) {
    const lines = element("dd");
    const add = (count) => lines.replaceChildren(
      ...also.slice(0, count).map((line) => button(String(line), () => chooseLine(line))),
      ...(also.length > count ? [button(`and ${also.length - count} more`, () => add(also.length))] : []),
    );
    add(ALSO);
    made.append(element("dt", "Also in lines"), lines);
  }
  const box = element("div", "", element("code", finding.block), made);
  box.className = "unfolded";
  return box;
}

/** The box of the chosen move: its facts, and the findings at its line. */
function chosenView(root, picture, state, program) {
  const box = root.querySelector(".chosen");
  function show(chosen) {
    const { section, move, line } = chosen;
    root.querySelector(".box").hidden = chosen.program !== program || line === null;
    if (chosen.program !== program || line === null) {
      return;
    }
    const at = move === null ? [["line", String(line)]] : factsOf(picture.sections[section], move);
    const hits = picture.order.filter((number) => {
      const finding = picture.findings[number];
      return finding.line === line || finding.also.includes(line);
    });
    box.replaceChildren(
      ...pairs(at),
      ...(hits.length ? pairs([[hits.length > 1 ? "findings" : "finding", hits.map((number) => picture.numbers[number]).join(", ")]]) : []),
    );
  }
  show(state.chosen);
  state.subscribe(show);
}
