// ---- section: the pictures of one section, drawn when they come into sight ----

/**
 * The pictures of a section. root: its element; state: that of the page; program, place: its numbers.
 *
 * draw(): draws what is not drawn yet; plots(): the elements that are drawn by Plotly; closeUp(points, width): a window
 * of at least this width [mm] around points of the plane; whole(): all of it; back(): the window before closeUp, or
 * false without one.
 */
function sectionView(root, section, state, program, place) {
  const [face, rates] = [".face", ".rates"].map((name) => root.querySelector(name));
  const hasRates = section.rates.t.length > 1;
  const coloring = { name: "load", level: section.parts.length - 1 };
  const windows = [];
  let isDrawn = false;
  face.ofSection = section;

  function layoutOfFace() {
    return { ...faceLayout(section), shapes: chosenOnFace(section, moveHere()) };
  }

  function moveHere() {
    const { chosen } = state;
    return chosen.program === program && chosen.section === place ? chosen.move : null;
  }

  function redraw() {
    if (isDrawn) {
      Plotly.react(face, faceTraces(section, coloring.level, coloring.name, coloring.isAsked), face.layout, OPTIONS);
    }
  }

  function draw() {
    if (isDrawn || root.hidden) {
      return;
    }
    isDrawn = true;
    Plotly.newPlot(face, faceTraces(section, coloring.level, coloring.name, coloring.isAsked), layoutOfFace(), OPTIONS);
    listen(face);
    if (hasRates) {
      Plotly.newPlot(rates, rateTraces(section), { ...rateLayout(section), shapes: chosenInRates(section, moveHere()) }, { ...OPTIONS, displayModeBar: false, scrollZoom: false, doubleClick: "reset+autosize" });
      listen(rates);
    }
  }

  function listen(plot) {
    plot.on("plotly_hover", (event) => {
      const { move, mark } = event.points[0].customdata;
      showHover(mark === undefined ? factsOf(section, move) : markFacts(section, mark), event.event);
    });
    plot.on("plotly_unhover", () => showHover(null));
    plot.on("plotly_click", (event) => {
      const { move, mark } = event.points[0].customdata;
      const hit = mark === undefined ? move : moveOfMark(section, mark);
      if (hit !== null && !plot.classList.contains("is-measuring")) {
        state.choose({ program, section: place, move: hit, ...(plot === rates ? { time: event.points[0].x } : {}) });
      }
    });
  }

  function showChosen() {
    if (isDrawn && !root.hidden && !state.chosen.playing) {
      Plotly.relayout(face, { shapes: chosenOnFace(section, moveHere()) });
      if (hasRates) {
        Plotly.relayout(rates, { shapes: chosenInRates(section, moveHere()) });
      }
    }
  }

  function windowOf() {
    const { xaxis, yaxis } = face._fullLayout;
    return { "xaxis.range": [...xaxis.range], "yaxis.range": [...yaxis.range] };
  }

  function closeUp(points, width) {
    draw();
    const units = unitsOf(section);
    const [x, c] = [0, 1].map((axis) => points.map((point) => point[axis]));
    const middle = [x, c].map((values) => (Math.min(...values) + Math.max(...values)) / 2);
    const half = Math.max(...[x, c].map((values) => 1.2 * (Math.max(...values) - Math.min(...values))), width) / 2;
    windows.push(windowOf());
    Plotly.relayout(face, {
      "xaxis.range": [units.x(middle[0] - half), units.x(middle[0] + half)],
      "yaxis.range": [units.c(middle[1] - half), units.c(middle[1] + half)],
    });
  }

  function whole() {
    windows.length = 0;
    Plotly.relayout(face, { "xaxis.autorange": true, "yaxis.autorange": true });
  }

  function back() {
    const last = windows.pop();
    return last === undefined ? false : Plotly.relayout(face, last);
  }

  root.querySelectorAll("tr[data-mark]").forEach((row) => {
    row.addEventListener("click", () => {
      const mark = section.marks[Number(row.dataset.mark)];
      const move = moveOfMark(section, Number(row.dataset.mark));
      if (move !== null) {
        state.choose({ program, section: place, move });
      }
      closeUp([mark.place, ...mark.rings.flat()], 4 * mark.depth);
    });
  });
  rates.hidden = !hasRates;
  root.querySelector(".drawings").hidden = false;
  state.subscribe((chosen, before) => {
    if (["program", "section", "move", "playing"].some((name) => chosen[name] !== before[name])) {
      showChosen();
    }
  });
  const view = {
    root, section, face, draw, redraw, coloring, closeUp, whole, back,
    isDrawn: () => isDrawn, plots: () => (hasRates ? [face, rates] : [face]),
  };
  legend(root.querySelector(".legend"), section, view);
  return view;
}

function markFacts(section, place) {
  const mark = section.marks[place];
  return [[MARKED[mark.kind].name, mark.text], ["lines", mark.lines.join(", ")], ["at", unitsOf(section).point(mark.place)]];
}

/** The first move of the block that a mark belongs to, null where none is drawn. */
function moveOfMark(section, place) {
  const move = section.moves.line.indexOf(section.marks[place].lines[0]);
  return move < 0 ? null : move;
}

/** The facts of the place under the pointer, beside it; null hides them. */
function showHover(facts, event = null) {
  const box = document.getElementById("hover");
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
