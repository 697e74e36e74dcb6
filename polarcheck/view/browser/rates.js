// ---- rates: C, X and F over the time of a section, with the limits of the machine ----

/** Below this share of its limit a curve would be flattened by the line of the limit, which then stands as words. */
const NEAR_LIMIT = 0.3;
/** Jumps that are marked. */
const JUMPS = 100;
const RATE_OPTIONS = { displaylogo: false, responsive: true, displayModeBar: false, doubleClick: "reset+autosize" };

function rateRows(section) {
  const units = unitsOf(section);
  const { rates } = section;
  const inUnits = (column) => column.map((value) => (value === null ? null : value / section.scale));
  const limit = (value, scale) => (value === null ? null : value / scale);
  return [
    { label: "C", unit: "deg/min", values: rates.c_feed, limit: limit(section.c_limit, 1), axis: "y", domain: [0.75, 1], color: color("--rate-c") },
    { label: "X", unit: `${units.name}/min`, values: inUnits(rates.x_feed), limit: limit(section.x_limit, section.scale), axis: "y2", domain: [0.38, 0.63], color: color("--rate-x") },
    { label: "F", unit: `${units.name}/min`, values: inUnits(rates.feed), limit: limit(section.feed_limit, section.scale), axis: "y3", domain: [0, 0.26], color: color("--rate-f") },
  ];
}

function rateTraces(section) {
  const customdata = section.rates.move.map((move) => ({ move }));
  return rateRows(section).map((row) => ({
    type: "scatter", mode: "lines", name: row.label, x: section.rates.t, y: row.values, yaxis: row.axis,
    line: { color: row.color, width: 1.6 }, hoverinfo: "none", showlegend: false, customdata,
  }));
}

function highest(values) {
  return values.reduce((most, value) => (value === null ? most : Math.max(most, Math.abs(value))), 0);
}

/** The times at which C would have to turn at once: a rate is not known there [s]. */
function jumpTimes({ rates }) {
  const times = rates.t.filter((time, place) => time !== null && rates.move[place] !== null && rates.c_feed[place] === null);
  return [...new Set(times)].slice(0, JUMPS);
}

/** A line across the curve of C at each jump. */
function jumpsInRates(section) {
  const ink = color("--above");
  const shapes = jumpTimes(section).map((time) => ({
    type: "line", xref: "x", x0: time, x1: time, yref: "y domain", y0: 0, y1: 1, line: { color: ink, width: 2.5 },
  }));
  const annotations = shapes.slice(0, 1).map(({ x0 }) => ({
    xref: "x", x: x0, yref: "y domain", y: 0.94, yanchor: "top", xanchor: x0 > 0.5 * (section.time || 0) ? "right" : "left", showarrow: false,
    text: "C would have to turn 180 deg at once", font: { size: 11, color: color("--above-text") }, bgcolor: color("--paper"),
  }));
  return { shapes, annotations };
}

/** The limits as lines, on both sides where the curve has both; and the jumps of C. */
function limitsOf(section) {
  const { shapes, annotations } = jumpsInRates(section);
  for (const row of rateRows(section)) {
    const isNear = row.limit !== null && highest(row.values) >= NEAR_LIMIT * row.limit;
    const text = row.limit === null ? "no limit given" : `limit ${rounded(row.limit)}`;
    const hasBoth = row.values.some((value) => value < 0);
    for (const side of isNear ? [1, -1].slice(0, hasBoth ? 2 : 1) : []) {
      shapes.push({
        type: "line", xref: "paper", x0: 0, x1: 1, yref: row.axis, y0: side * row.limit, y1: side * row.limit,
        line: { color: color("--above"), width: 1.5, dash: "dash" },
      });
    }
    annotations.push({
      xref: "paper", x: 1, xanchor: "right", yref: `${row.axis} domain`, y: 1, yanchor: "bottom", showarrow: false,
      text: isNear ? `- - ${text}` : text, font: { size: 10, color: isNear ? color("--above-text") : color("--quiet") },
    }, {
      xref: "paper", x: 0, xanchor: "left", yref: `${row.axis} domain`, y: 1, yanchor: "bottom", showarrow: false,
      text: `${row.label === "F" ? "F" : `${row.label} rate`}, ${row.unit}`, font: { size: 11, color: row.color },
    });
  }
  return { shapes, annotations };
}

function rateLayout(section) {
  const axis = { gridcolor: color("--grid"), zerolinecolor: color("--axis"), showline: true, linecolor: color("--axis"), mirror: true, ticks: "outside" };
  const { shapes, annotations } = limitsOf(section);
  const layout = {
    margin: { l: 56, r: 10, t: 18, b: 38 }, paper_bgcolor: color("--paper"), plot_bgcolor: color("--paper"), hovermode: "x", hoverdistance: -1,
    font: { family: "system-ui, sans-serif", size: 11, color: color("--ink") }, dragmode: "zoom", shapes, annotations,
    xaxis: { ...axis, title: { text: "time [s]", standoff: 4 }, anchor: "y3", rangemode: "tozero" },
  };
  rateRows(section).forEach((row, place) => {
    // A limit that is drawn belongs to what the axis shows.
    const known = row.values.filter((value) => value !== null);
    let [low, high] = known.reduce(([least, most], value) => [Math.min(least, value), Math.max(most, value)], [0, 0]);
    if (row.limit !== null && highest(row.values) >= NEAR_LIMIT * row.limit) {
      [low, high] = [low < 0 ? Math.min(low, -row.limit) : low, Math.max(high, row.limit)];
    }
    const room = 0.08 * (high - low) || 1;
    layout[place ? `yaxis${place + 1}` : "yaxis"] = {
      ...axis, domain: row.domain, nticks: 5,
      range: [low < 0 ? low - room : low, high + room],
    };
  });
  return layout;
}

/** The limits, and a band over the time of the chosen move. */
function chosenInRates(section, move) {
  const { shapes } = limitsOf(section);
  const begin = move === null ? null : section.moves.begin[move];
  if (begin === null || begin === undefined) {
    return shapes;
  }
  return [...shapes, {
    type: "rect", xref: "x", x0: begin, x1: begin + (section.moves.time[move] || 0), yref: "paper", y0: 0, y1: 1,
    fillcolor: color("--band"), line: { color: color("--ink"), width: 1 }, layer: "below",
  }];
}
