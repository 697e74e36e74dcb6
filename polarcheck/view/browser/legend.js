// ---- legend: what is drawn, each with a switch; the classes of the colours; which part is filled ----

const COLORINGS = { load: "by C rate", feed: "by F", none: "plain" };

/** The choices and the legend below a face. view: what sectionView returns. Returns show(), to be called after drawing. */
function legend(place, section, view) {
  const select = (name, text, options, value, act) => {
    const made = element("select");
    made.className = name;
    made.append(...options.map(([key, label]) => Object.assign(element("option", label), { value: key })));
    made.value = value;
    made.addEventListener("change", () => {
      act(made.value);
      view.redraw();
    });
    return element("label", `${text} `, made);
  };
  const names = element("div");
  names.className = "names";
  const classes = element("div");
  classes.className = "classes";
  const levels = section.parts.map((part, level) => [String(level), part.z === null ? "Z not known" : `Z${unitsOf(section).length(part.z)}`]);
  const choices = element("div");
  choices.className = "choices";
  if (section.tool.x.length) {
    choices.append(select("coloring", "Path", Object.entries(COLORINGS), view.coloring.name, (name) => {
      view.coloring.name = name;
    }));
  }
  if (levels.length) {
    choices.append(select("level", "Part at", [...levels, ["-1", "none"]], String(view.coloring.level), (level) => {
      view.coloring.level = Number(level);
    }));
  }
  place.append(choices, classes, names);

  return () => {
    showClasses(classes, section, view.coloring.name);
    showNames(names, view);
  };
}

/** The classes of the colours that occur. */
function showClasses(place, section, name) {
  const coloring = section.tool.x.length ? coloringOf(section, name) : null;
  if (coloring === null) {
    place.replaceChildren();
    return;
  }
  const { role, start, end } = section.moves;
  const isDrawn = (move) => role[move] !== "positioning" && String(start[move]) !== String(end[move]);
  const counts = new Set(classesOf(section, name).filter((kind, move) => kind === "above" || isDrawn(move) || section.moves.center[move] !== null));
  const kinds = [...coloring.bounds.keys(), "above", "unknown"].filter((kind) => counts.has(kind));
  const made = kinds.map((kind) => {
    const text = element("span", classText(kind, coloring.bounds));
    text.className = "class";
    text.prepend(swatch(colorOf(kind, coloring.bounds.length), kind === "above" ? 5 : 3));
    return text;
  });
  place.replaceChildren(element("span", `${coloring.title}:`), ...made);
  place.hidden = !made.length;
}

function swatch(ink, height) {
  const made = element("i");
  Object.assign(made.style, { background: ink, height: `${height}px` });
  return made;
}

/** A switch for each name that the plot draws. */
function showNames(place, view) {
  const traces = new Map();
  view.face.data.forEach((trace, number) => {
    const key = trace.legendgroup || trace.name;
    if (trace.name && !["C = 0", "above the limit of C"].includes(trace.name)) {
      traces.set(key, [...(traces.get(key) || []), number]);
    }
  });
  place.replaceChildren(...[...traces].map(([name, numbers]) => {
    const isOn = view.face.data[numbers[0]].visible !== "legendonly";
    const made = button(name, () => {
      view.toggle(name);
    });
    made.setAttribute("aria-pressed", String(isOn));
    made.prepend(symbolOf(view.face.data[numbers[0]]));
    return made;
  }));
}

/** A small picture of how a trace is drawn. */
function symbolOf(trace) {
  const made = element("i");
  const { line = {}, marker = {}, mode } = trace;
  if (mode && mode.includes("markers")) {
    made.textContent = { "cross-thin": "+", "x-thin": "\u00d7", "star-triangle-down-open": "\u25bd", "star-diamond": "\u2726" }[marker.symbol] || "\u25cb";
    made.className = "sign";
    made.style.color = (marker.line && marker.line.color) || marker.color;
  } else if (trace.fill && trace.fillcolor) {
    Object.assign(made.style, { background: trace.fillcolor, border: `1px solid ${line.color}`, height: "10px" });
  } else {
    const isDashed = line.dash && line.dash !== "solid";
    Object.assign(made.style, { height: "0", borderTop: `${Math.min(line.width, 4)}px ${isDashed ? "dashed" : "solid"} ${line.color}` });
  }
  return made;
}
