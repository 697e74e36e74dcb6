// ---- section: the pictures of one section, drawn when they come into sight ----

/** The pictures of a section, and what shows a move in all of them. choose: what to call when a move is pointed at. */
function sectionView(root, section, choose) {
  const find = (name) => root.querySelector(`.${name}`);
  const [face, rates, slider] = ["face", "rates", "step"].map(find);
  const count = section.moves.line.length;
  const hasRates = section.rates.t.length > 1;
  let isDrawn = false;
  let shown = null;
  let showRow = () => {};

  function level() {
    return find("level").value === "" ? -1 : Number(find("level").value);
  }

  function redraw() {
    Plotly.react(face, faceTraces(section, level(), find("coloring").value), face.layout, OPTIONS);
  }

  function draw() {
    if (isDrawn) {
      return;
    }
    isDrawn = true;
    const layout = { ...faceLayout(section), shapes: chosenOnFace(section, shown) };
    Plotly.newPlot(face, faceTraces(section, level(), find("coloring").value), layout, OPTIONS);
    listen(face);
    if (hasRates) {
      Plotly.newPlot(rates, rateTraces(section), { ...rateLayout(section), shapes: chosenInRates(section, shown) }, { ...OPTIONS, displayModeBar: false });
      listen(rates);
    }
  }

  function listen(plot) {
    plot.on("plotly_hover", (event) => {
      const { move, mark } = event.points[0].customdata;
      tell(mark === undefined ? factsOf(section, move) : markFacts(section, mark), event.event);
    });
    plot.on("plotly_unhover", () => tell(null));
    plot.on("plotly_click", (event) => {
      const { move, mark } = event.points[0].customdata;
      const found = mark === undefined ? move : moveOfMark(section, mark);
      if (found !== null) {
        choose(found);
      }
    });
  }

  function show(move, messages) {
    shown = move;
    slider.value = String(move === null ? 0 : move);
    find("count").textContent = move === null ? `${count} moves` : `${move + 1} of ${count}`;
    find("chosen").replaceChildren(
      ...pairs(move === null ? [["", "Point at the path, or choose a move, a finding, or a place in time."]] : factsOf(section, move)),
      ...pairs(messages.map((message) => ["found", message])),
    );
    showRow(move);
    if (isDrawn) {
      Plotly.relayout(face, { shapes: chosenOnFace(section, move) });
      if (hasRates) {
        Plotly.relayout(rates, { shapes: chosenInRates(section, move) });
      }
    }
  }

  /** The face from near by, around points of the plane. */
  function closeUp(points, least) {
    const units = unitsOf(section);
    const [x, c] = [0, 1].map((axis) => points.map((point) => point[axis]));
    const middle = [x, c].map((values) => (Math.min(...values) + Math.max(...values)) / 2);
    const half = Math.max(...[x, c].map((values) => Math.max(...values) - Math.min(...values)), least) * 0.75;
    draw();
    Plotly.relayout(face, {
      "xaxis.range": [units.x(middle[0] - half), units.x(middle[0] + half)],
      "yaxis.range": [units.c(middle[1] - half), units.c(middle[1] + half)],
    });
  }

  section.parts.forEach((part, place) => {
    const option = element("option", part.z === null ? "Z not known" : `Z${unitsOf(section).length(part.z)}`);
    option.value = String(place);
    find("level").append(option);
  });
  find("level").append(Object.assign(element("option", "none"), { value: "" }));
  find("level").value = section.parts.length ? String(section.parts.length - 1) : "";
  find("of-level").hidden = !section.parts.length;
  if (!section.moves.share.some((share) => share !== null)) {
    find("coloring").options[0].textContent = "by the rate of C (no limit given)";
  } else {
    find("coloring").options[0].textContent = "by the share of the limit of C";
  }
  if (section.needs_radius) {
    find("coloring").parentElement.hidden = true;
  }
  slider.max = String(Math.max(count - 1, 0));
  find("level").addEventListener("change", redraw);
  find("coloring").addEventListener("change", redraw);
  let isAsked = false;
  slider.addEventListener("input", () => {
    // A slider moves faster than pictures are drawn.
    if (!isAsked) {
      isAsked = true;
      requestAnimationFrame(() => {
        isAsked = false;
        choose(Number(slider.value));
      });
    }
  });
  const step = (way) => choose(Math.min(Math.max((shown === null ? (way > 0 ? -1 : count) : shown) + way, 0), count - 1));
  find("back").addEventListener("click", () => step(-1));
  find("on").addEventListener("click", () => step(1));
  find("closer").addEventListener("click", () => {
    if (shown !== null && wayOf(section, shown).length) {
      closeUp(wayOf(section, shown), section.radius === null ? 1 : 2 * section.radius);
    }
  });
  find("whole").addEventListener("click", () => {
    Plotly.relayout(face, { "xaxis.autorange": true, "yaxis.autorange": true });
  });
  root.querySelectorAll("tr[data-mark]").forEach((row) => {
    row.addEventListener("click", () => {
      const mark = section.marks[Number(row.dataset.mark)];
      const found = moveOfMark(section, Number(row.dataset.mark));
      if (found !== null) {
        choose(found);
      }
      closeUp([mark.place, ...mark.rings.flat()], 4 * mark.depth);
    });
  });
  rates.hidden = !hasRates;
  root.querySelector(".drawings").hidden = false;
  showRow = moveTable(find("moves"), section, choose);
  show(null, []);
  return { root, section, draw, show, step, isDrawn: () => isDrawn, plots: () => (hasRates ? [face, rates] : [face]) };
}

function markFacts(section, place) {
  const mark = section.marks[place];
  return [[MARKED[mark.kind].name, mark.text], ["lines", mark.lines.join(", ")], ["at", unitsOf(section).point(mark.place)]];
}

/** The first move of the block that a mark is told of, null where none is drawn. */
function moveOfMark(section, place) {
  const found = section.moves.line.indexOf(section.marks[place].lines[0]);
  return found < 0 ? null : found;
}

/** What the pointer is at, beside it; nothing for null. */
function tell(facts, event = null) {
  const box = document.getElementById("told");
  box.hidden = facts === null;
  if (facts === null) {
    return;
  }
  box.replaceChildren(...pairs(facts));
  const { clientWidth, clientHeight } = document.documentElement;
  const [x, y] = [event.clientX, event.clientY];
  box.style.left = `${x + 18 + box.offsetWidth > clientWidth ? Math.max(x - 14 - box.offsetWidth, 0) : x + 18}px`;
  box.style.top = `${Math.max(Math.min(y + 14, clientHeight - box.offsetHeight - 4), 0)}px`;
}
