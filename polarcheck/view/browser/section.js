// ---- section: the pictures of one section, drawn when they come into sight ----

/**
 * The pictures of a section. root: its element; picture: that of its program; state: that of the page; program, place:
 * its numbers.
 *
 * draw(): draws what is not drawn yet; plots(): the elements that are drawn by Plotly; closeUp(points, width): a window
 * of at least this width [mm] around points of the plane; whole(): all of it; back(): the window before closeUp, or
 * false without one.
 */
function sectionView(root, picture, state, program, place) {
  const section = picture.sections[place];
  const [face, rates] = [".face", ".rates"].map((name) => root.querySelector(name));
  const hasRates = section.rates.t.length > 1;
  const coloring = { name: "load", level: section.parts.length - 1 };
  const windows = [];
  const hidden = new Set();
  let isDrawn = false;
  let asked = null;
  let showLegend = () => {};
  let showPins = () => {};
  face.ofSection = section;

  function layoutOfFace() {
    return { ...faceLayout(section), shapes: shapesOnFace() };
  }

  /** The chosen move; the player draws it, and the cutter at a time, on its canvas. */
  function shapesOnFace() {
    return state.chosen.playing ? [] : chosenOnFace(section, moveHere(), state.chosen.time === null);
  }

  function moveHere() {
    const { chosen } = state;
    return chosen.program === program && chosen.section === place ? chosen.move : null;
  }

  function traces() {
    return faceTraces(section, coloring.level, coloring.name, coloring.hasNominal).map((trace) =>
      (hidden.has(trace.legendgroup || trace.name) ? { ...trace, visible: "legendonly" } : trace));
  }

  /** All of it again, in the window as it is: with other colours, or with other things drawn. */
  function redraw() {
    if (!isDrawn) {
      return;
    }
    const layout = layoutOfFace();
    const { "xaxis.range": x, "yaxis.range": y } = windowOf();
    Object.assign(layout.xaxis, { range: x });
    Object.assign(layout.yaxis, { range: y });
    Plotly.react(face, traces(), layout, OPTIONS);
    showLegend();
    if (hasRates) {
      Plotly.react(rates, rateTraces(section), { ...rateLayout(section), shapes: chosenInRates(section, moveHere()) }, RATE_OPTIONS);
    }
  }

  function toggle(name) {
    hidden[hidden.has(name) ? "delete" : "add"](name);
    redraw();
  }

  function draw() {
    if (isDrawn || root.hidden) {
      return;
    }
    isDrawn = true;
    Plotly.newPlot(face, traces(), layoutOfFace(), OPTIONS);
    listen(face);
    showLegend();
    planeTransform(face).onChange(showPins);
    showPins();
    if (hasRates) {
      Plotly.newPlot(rates, rateTraces(section), { ...rateLayout(section), shapes: chosenInRates(section, moveHere()) }, RATE_OPTIONS);
      listen(rates);
    }
  }

  function listen(plot) {
    plot.on("plotly_hover", (event) => {
      if (plot.classList.contains("is-measuring")) {
        return;
      }
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

  /** Change the layout of the face. What one action changes is drawn once: a choice, and the window that follows it. */
  function change(layout) {
    if (asked === null) {
      asked = {};
      queueMicrotask(() => {
        const all = asked;
        asked = null;
        Plotly.relayout(face, all);
      });
    }
    Object.assign(asked, layout);
  }

  function showChosen() {
    if (isDrawn && !root.hidden) {
      change({ shapes: shapesOnFace() });
      if (hasRates) {
        Plotly.relayout(rates, { shapes: chosenInRates(section, state.chosen.playing ? null : moveHere()) });
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
    if (!windows.length) {
      windows.push(windowOf());
    }
    change({
      "xaxis.range": [units.x(middle[0] - half), units.x(middle[0] + half)],
      "yaxis.range": [units.c(middle[1] - half), units.c(middle[1] + half)],
    });
  }

  /** A window around a finding at its own scale. */
  function zoomTo({ places, span, move }) {
    const points = places.length ? places.slice(0, 1) : move === null ? [] : wayOf(section, move);
    if (points.length) {
      closeUp(points, span || Math.max(4 * (section.radius || 0), 0.1 * (section.frame[2] - section.frame[0])));
    }
  }

  function whole() {
    windows.length = 0;
    Plotly.relayout(face, wholeFace(section));
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
    // One change of a plot takes longer than a frame of the player has.
    const goesOn = chosen.playing && before.playing;
    if (!goesOn && ["program", "section", "move", "finding", "time", "playing"].some((name) => chosen[name] !== before[name])) {
      showChosen();
    }
    if (chosen.view !== before.view && isDrawn && !root.hidden) {
      Plotly.Plots.resize(face);
    }
  });
  const view = {
    root, section, face, draw, redraw, toggle, coloring, closeUp, zoomTo, whole, back,
    hasBack: () => windows.length > 0,
    isDrawn: () => isDrawn, plots: () => (hasRates ? [face, rates] : [face]),
  };
  showLegend = legend(root.querySelector(".legend"), section, view);
  showPins = pinsOf(root.querySelector(".face-box"), picture, state, program, place, (finding) => state.choose({ program, finding }));
  onTheme(redraw);
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
