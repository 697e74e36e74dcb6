// ---- face: the view onto the face, X to the right with its labels as in the program, C upwards ----

const DASHES = { positioning: "dash", "start up": "dashdot", cancel: "dashdot", unknown: "dot" };
/** These buttons alone: by itself the library offers one that sends the picture to its maker. */
const BUTTONS = [["toImage", "zoom2d", "pan2d", "zoomIn2d", "zoomOut2d", "resetScale2d"]];
const OPTIONS = { displaylogo: false, responsive: true, modeBarButtons: BUTTONS, scrollZoom: true, doubleClick: false };
/** So many arrows tell the direction of a path. */
const ARROWS = 14;
/** So many points of it, at least, can be pointed at. */
const POINTED = 3000;

/** All that is drawn of a section, but for what is chosen. */
function faceTraces(section, level, coloring, hasNominal = true) {
  const units = unitsOf(section);
  return [
    ...bar(section, units),
    ...parts(section, units, level),
    ...surroundings(section, units),
    ...(hasNominal ? nominalTraces(section, units) : []),
    line("programmed contour", section.programmed.x.map(units.x), section.programmed.c.map(units.c), { color: color("--ink"), width: 1 }),
    ...toolPath(section, units, coloring),
    ...directions(section, units),
    ...jumps(section),
    ...marks(section, units),
    ...ends(section, units),
    ...toPointAt(section, units),
  ];
}

/** The bar before milling, below everything. */
function bar(section, units) {
  if (!section.bar || !section.bar.length) {
    return [];
  }
  const { x, y } = rings([section.bar], units);
  return [{ ...line("bar", x, y, { color: color("--bar-edge"), width: 1 }), fill: "toself", fillcolor: color("--bar") }];
}

/** The center, where a move passes it: C would have to turn at once. */
function jumps(section) {
  const move = section.moves.jump.indexOf(true);
  return move < 0 ? [] : [{
    type: "scatter", mode: "markers", name: "C would have to turn at once", x: [0], y: [0], hoverinfo: "none", customdata: [{ move }],
    marker: { symbol: "star-diamond", size: 15, color: color("--above"), line: { color: color("--ink"), width: 1 } },
  }];
}

function line(name, x, y, style, more = {}) {
  return { type: "scatter", mode: "lines", name, x, y, line: style, hoverinfo: "skip", ...more };
}

/** Rings one after another, with gaps; the outside of each polygon runs one way and its holes the other. */
function rings(polygons, units) {
  const x = [];
  const y = [];
  for (const polygon of polygons) {
    polygon.forEach((ring, place) => {
      const way = turnOf(ring) > 0 === (place === 0) ? ring : [...ring].reverse();
      x.push(...way.map((point) => units.x(point[0])), null);
      y.push(...way.map((point) => units.c(point[1])), null);
    });
  }
  return { x, y };
}

/** Twice the area of a ring, positive where it runs counterclockwise. */
function turnOf(ring) {
  return ring.reduce((sum, [x, c], place) => {
    const [nextX, nextC] = ring[(place + 1) % ring.length];
    return sum + x * nextC - nextX * c;
  }, 0);
}

function parts(section, units, level) {
  return section.parts.filter((part, place) => place === level && part.polygons.length).map((part) => ({
    ...line("finished part", ...Object.values(rings(part.polygons, units)), { color: color("--part-edge"), width: part.known_outside ? 1 : 0 }),
    fill: "toself", fillcolor: color("--part"),
  }));
}

function circle(radius, units) {
  const angles = Array.from({ length: 145 }, (_, place) => (place * Math.PI) / 72);
  return [angles.map((angle) => units.x(radius * Math.cos(angle))), angles.map((angle) => units.c(radius * Math.sin(angle)))];
}

/** Stock, keep-out, the center of the spindle, and the ray from there on which C is 0. */
function surroundings(section, units) {
  const shapes = [];
  if (section.stock !== null && !(section.bar && section.bar.length)) {
    shapes.push(line("stock", ...circle(section.stock / 2, units), { color: color("--bar-edge"), width: 1.5, dash: "6px,3px" }));
  }
  if (section.keep_out !== null) {
    shapes.push(line("keep-out", ...circle(section.keep_out, units), { color: color("--above"), width: 1, dash: "dot" }, { fill: "toself", fillcolor: "rgba(213,94,0,0.15)" }));
  }
  const reach = reachOf(section);
  // The name of the ray stands away from both ends of the path.
  const away = (share) => Math.min(...pathEnds(section).map(([x, c]) => Math.hypot(x - share * reach, c)), reach);
  const named = [0.85, 0.6, 0.35].sort((one, other) => away(other) - away(one))[0] * reach;
  shapes.push({
    ...line("C = 0", [0, units.x(named), units.x(reach)], [0, 0, 0], { color: color("--axis"), width: 1, dash: "longdashdot" }, { showlegend: false }),
    // A marker that is not seen keeps the text off the ray.
    mode: "lines+markers+text", marker: { size: 10, opacity: 0 }, text: ["", "C = 0", ""], textposition: "bottom center", textfont: { color: color("--quiet"), size: 11 },
  });
  shapes.push({
    type: "scatter", mode: "markers", name: "spindle center", x: [0], y: [0], hoverinfo: "skip",
    marker: { symbol: "cross-thin", size: 18, line: { color: color("--ink"), width: 1.5 } },
  });
  return shapes;
}

/** How far the ray of C = 0 is drawn [mm]: to the right of the frame. */
function reachOf({ frame }) {
  return Math.max(frame[2] - 0.02 * (frame[2] - frame[0]), 0.2 * (frame[2] - frame[0]));
}

/** The path of the tool center, a trace for each kind of move and class of color. */
function toolPath(section, units, coloring) {
  const classes = classesOf(section, coloring);
  const count = (coloringOf(section, coloring) || { bounds: [] }).bounds.length;
  const { tool, moves } = section;
  const groups = new Map();
  for (let place = 1; place < tool.x.length; place += 1) {
    if (tool.x[place] === null || tool.x[place - 1] === null) {
      continue;
    }
    const move = tool.move[place];
    const role = moves.role[move];
    const kind = role === "positioning" && classes[move] !== "above" ? "plain" : classes[move];
    const key = `${role} ${kind}`;
    if (!groups.has(key)) {
      groups.set(key, { role, kind, x: [], y: [], last: -1 });
    }
    const group = groups.get(key);
    if (group.last !== place - 1) {
      group.x.push(null, units.x(tool.x[place - 1]));
      group.y.push(null, units.c(tool.c[place - 1]));
    }
    group.x.push(units.x(tool.x[place]));
    group.y.push(units.c(tool.c[place]));
    group.last = place;
  }
  const named = new Set();
  const limited = [...groups.values()].some(({ kind }) => kind === "above")
    ? [line("above the limit of C", [null], [null], { color: color("--above"), width: 5 })] : [];
  return [...limited, ...[...groups.values()].map(({ role, kind, x, y }) => {
    const name = nameOf(role);
    const isFirst = !named.has(name);
    named.add(name);
    const isCut = role === "cut" || role === "corner";
    const width = kind === "above" ? 5 : isCut ? 3 : role === "positioning" ? 1.3 : 2.2;
    const style = { color: role === "unknown" ? color("--unknown") : colorOf(kind, count), width, dash: DASHES[role] || "solid" };
    return line(name, x, y, style, { legendgroup: name, showlegend: isFirst });
  })];
}

function nameOf(role) {
  const names = { cut: "tool center", corner: "tool center", "start up": "ramp on", cancel: "ramp off", unknown: "tool center not known" };
  return names[role] || role;
}

/** Arrows along the path, as far from each other as its length allows; ramps have theirs, open ones. */
function directions(section, units) {
  const { tool, moves } = section;
  const chosen = { solid: [], ramp: [] };
  let total = 0;
  const pieces = [];
  for (let place = 1; place < tool.x.length; place += 1) {
    if (tool.x[place] === null || tool.x[place - 1] === null) {
      continue;
    }
    const [dx, dc] = [tool.x[place] - tool.x[place - 1], tool.c[place] - tool.c[place - 1]];
    const length = Math.hypot(dx, dc);
    const role = moves.role[tool.move[place]];
    if (!length) {
      continue;
    }
    const isRamp = role === "start up" || role === "cancel";
    // Ramps on and off may be one line; their arrows then stand apart.
    const along = isRamp ? 0.35 : 0.5;
    const middle = [units.x(tool.x[place - 1] + along * dx), units.c(tool.c[place - 1] + along * dc), (Math.atan2(dx, dc) * 180) / Math.PI];
    if (isRamp) {
      chosen.ramp.push(middle);
    } else {
      pieces.push({ middle, from: total, to: total + length });
      total += length;
    }
  }
  let next = total / ARROWS / 2;
  for (const piece of pieces) {
    if (piece.to >= next) {
      chosen.solid.push(piece.middle);
      next = piece.to + total / ARROWS / 2;
    }
  }
  const evenly = chosen.ramp.filter((_, place) => place % Math.ceil(chosen.ramp.length / ARROWS) === 0);
  return [arrows(chosen.solid, "arrow", 10), arrows(evenly, "arrow-open", 12)].filter((trace) => trace.x.length);
}

function arrows(places, symbol, size) {
  return {
    type: "scatter", mode: "markers", x: places.map((place) => place[0]), y: places.map((place) => place[1]),
    hoverinfo: "skip", showlegend: false,
    marker: { symbol, size, angle: places.map((place) => place[2]), color: color("--ink"), line: { color: color("--ink"), width: 1.5 } },
  };
}

const MARKED = {
  overcut: { name: "cut too much", property: "--above", shape: "/" },
  left: { name: "left standing", property: "--left", shape: "\\" },
};

/** What is cut too much or left standing: hatched, with its number in the table at its place. */
function marks(section, units) {
  return Object.entries(MARKED).flatMap(([kind, { name, property, shape }]) => {
    const ink = color(property);
    const hits = section.marks.map((mark, place) => ({ ...mark, number: place + 1 })).filter((mark) => mark.kind === kind);
    if (!hits.length) {
      return [];
    }
    const areas = rings(hits.map((mark) => mark.rings).filter((ring) => ring.length), units);
    const hatched = {
      ...line(name, areas.x, areas.y, { color: ink, width: 1 }, { legendgroup: name, showlegend: false }),
      fill: "toself", fillcolor: "rgba(255,255,255,0)", fillpattern: { shape, fgcolor: ink, bgcolor: "rgba(0,0,0,0)", size: 6, solidity: 0.35 },
    };
    const places = {
      type: "scatter", mode: "markers+text", name, legendgroup: name, hoverinfo: "none",
      x: hits.map((mark) => units.x(mark.place[0])), y: hits.map((mark) => units.c(mark.place[1])),
      text: hits.map((mark) => letterOf(mark.number - 1)), textposition: "bottom right", textfont: { color: ink, size: 13 },
      customdata: hits.map((mark) => ({ mark: mark.number - 1 })),
      marker: { symbol: kind === "overcut" ? "x-thin" : "star-triangle-dhits-open", size: 10, color: ink, line: { color: ink, width: 2 } },
    };
    return areas.x.length ? [hatched, places] : [places];
  });
}

/** The letter of a mark, as in its table: A to Z, then A1. */
function letterOf(place) {
  return String.fromCharCode(65 + (place % 26)) + (place >= 26 ? Math.floor(place / 26) : "");
}

/** Where the path begins and ends: places in its columns, none without a path. */
function pathEnds(section) {
  const path = section.tool.x.length ? section.tool : section.programmed;
  const known = path.x.map((_, place) => place).filter((place) => path.x[place] !== null);
  return (known.length ? [known[0], known[known.length - 1]] : []).map((place) => [path.x[place], path.c[place]]);
}

/** The marks of both ends: one word where they are as good as at one place. */
function ends(section, units) {
  const points = pathEnds(section);
  if (!points.length) {
    return [];
  }
  const [x0, , x1] = section.frame;
  const [[startX, startC], [endX, endC]] = points;
  const isOne = Math.hypot(startX - endX, startC - endC) < 0.05 * (x1 - x0);
  const texts = isOne ? ["start, end", ""] : ["start", "end"];
  const common = { type: "scatter", hoverinfo: "skip", showlegend: false };
  const named = points.map(([x, c], place) => ({
    ...common, mode: "markers+text", x: [units.x(x)], y: [units.c(c)],
    // The text stands towards the middle, where there is room for it, and below: pins stand above. A marker that is not
    // seen keeps it off the ramps and their arrows.
    text: [texts[place]], textposition: `bottom ${x > (x0 + x1) / 2 ? "left" : "right"}`,
    textfont: { color: color("--ink"), size: 12 }, marker: { size: 24, opacity: 0 },
  }));
  const marked = points.map(([x, c], place) => ({
    ...common, mode: "markers", x: [units.x(x)], y: [units.c(c)],
    marker: { symbol: ["circle-open", "square-open"][place], size: [12, 9][place], color: color("--ink"), line: { color: color("--ink"), width: 2 } },
  }));
  return [...named, ...marked];
}

/** Points along the path that the pointer finds; nothing is seen of them. */
function toPointAt(section, units) {
  const path = section.tool.x.length ? section.tool : section.programmed;
  let total = 0;
  for (let place = 1; place < path.x.length; place += 1) {
    if (path.x[place] !== null && path.x[place - 1] !== null) {
      total += Math.hypot(path.x[place] - path.x[place - 1], path.c[place] - path.c[place - 1]);
    }
  }
  const points = { x: [], y: [], move: [] };
  for (let place = 1; place < path.x.length; place += 1) {
    if (path.x[place] === null || path.x[place - 1] === null) {
      continue;
    }
    const [dx, dc] = [path.x[place] - path.x[place - 1], path.c[place] - path.c[place - 1]];
    const count = Math.max(Math.ceil((Math.hypot(dx, dc) / total) * POINTED) || 1, 1);
    for (let part = 0; part < count; part += 1) {
      const along = (part + 0.5) / count;
      points.x.push(units.x(path.x[place - 1] + along * dx));
      points.y.push(units.c(path.c[place - 1] + along * dc));
      points.move.push(path.move[place]);
    }
  }
  return [line("", points.x, points.y, { width: 0, color: "rgba(0,0,0,0)" }, {
    hoverinfo: "none", showlegend: false, customdata: points.move.map((move) => ({ move })),
  })];
}

/** The chosen move and the cutter at its end, as shapes: these alone are drawn again where another one is chosen. */
function chosenOnFace(section, move, hasCutter) {
  if (move === null) {
    return [];
  }
  const units = unitsOf(section);
  const way = wayOf(section, move).map(([x, c]) => [units.x(x), units.c(c)]);
  const path = way.map(([x, y], place) => `${place ? "L" : "M"}${x},${y}`).join(" ");
  const shapes = way.length > 1 ? [
    { type: "path", path, line: { color: color("--halo"), width: 9 }, layer: "above" },
    { type: "path", path, line: { color: color("--ink"), width: 4.5 }, layer: "above" },
  ] : [];
  const [x, c] = section.moves.end[move];
  const radius = section.radius;
  if (hasCutter && x !== null && c !== null && radius !== null && section.moves.role[move] !== "unknown") {
    shapes.push({
      type: "circle", x0: units.x(x - radius), x1: units.x(x + radius), y0: units.c(c - radius), y1: units.c(c + radius),
      line: { color: color("--ink"), width: 1.5 }, fillcolor: color("--cutter"), layer: "above",
    });
  }
  return shapes;
}

/** The points of a move; where thinning has left none of it, its ends. */
function wayOf(section, move) {
  const { tool, moves } = section;
  const first = firstAt(tool.move, move);
  const way = [];
  for (let place = first; place < tool.x.length && (tool.move[place] === move || tool.move[place] === null); place += 1) {
    if (tool.move[place] === move && tool.x[place] !== null) {
      if (!way.length && place > 0 && tool.x[place - 1] !== null) {
        way.push([tool.x[place - 1], tool.c[place - 1]]);
      }
      way.push([tool.x[place], tool.c[place]]);
    }
  }
  return way.length > 1 ? way : [moves.start[move], moves.end[move]].filter(([x, c]) => x !== null && c !== null);
}

/** The first place of a column that rises, with gaps, at which it has reached a value. */
function firstAt(column, value) {
  let [low, high] = [0, column.length];
  while (low < high) {
    const middle = (low + high) >> 1;
    let known = middle;
    while (known < high && column[known] === null) {
      known += 1;
    }
    if (known < high && column[known] < value) {
      low = known + 1;
    } else {
      high = middle;
    }
  }
  while (low < column.length && column[low] === null) {
    low += 1;
  }
  return low;
}

/** The ranges of the axes that show all that is drawn. */
function wholeFace(section) {
  const units = unitsOf(section);
  const [x0, c0, x1, c1] = section.frame;
  return { "xaxis.range": [units.x(x0), units.x(x1)], "yaxis.range": [units.c(c0), units.c(c1)] };
}

function faceLayout(section) {
  const units = unitsOf(section);
  const isNarrow = document.documentElement.clientWidth < 600;
  const axis = {
    showgrid: true, gridcolor: color("--grid"), zeroline: true, zerolinecolor: color("--axis"), showline: true, linecolor: color("--axis"),
    mirror: true, ticks: "outside", tickcolor: color("--axis"), nticks: isNarrow ? 6 : 11, constrain: "range",
  };
  const { "xaxis.range": x, "yaxis.range": y } = wholeFace(section);
  return {
    margin: isNarrow ? { l: 52, r: 6, t: 6, b: 38 } : { l: 68, r: 10, t: 10, b: 42 }, paper_bgcolor: color("--paper"), plot_bgcolor: color("--paper"),
    hovermode: "closest", hoverdistance: 24, font: { family: "system-ui, sans-serif", size: isNarrow ? 10 : 12, color: color("--ink") }, dragmode: "pan",
    modebar: { bgcolor: "rgba(0,0,0,0)", color: color("--quiet"), activecolor: color("--ink") }, showlegend: false,
    xaxis: { ...axis, range: x, title: { text: `${axisName(section.writing.linear)} [${units.name}, ${section.diameter ? "diameter" : "radius"}${scaleNote(section)}]`, standoff: 6 } },
    yaxis: { ...axis, range: y, title: { text: `${axisName(section.writing.virtual)} [${units.name}${scaleNote(section)}]`, standoff: 4 }, scaleanchor: "x", scaleratio: units.ratio },
    shapes: [],
  };
}
