// ---- colors: classes that are told apart by the color-blind and, as light and dark, in black and white ----

/** Viridis from light to dark, without its yellow, which is not seen on white. */
const SHADES = ["#7ad151", "#43bf71", "#22a884", "#21918c", "#2a788e", "#35608d", "#414487", "#440154"];
const ABOVE = "#d55e00";
const PLAIN = "#1b3a5c";
const UNKNOWN = "#767676";
const INK = "#1a1a1a";

/** What moves are colored by: a value for each, the bounds of its classes, how it is called. */
function coloringOf(section, name) {
  const { moves } = section;
  const units = unitsOf(section);
  if (name === "load" && moves.share.some((share) => share !== null)) {
    return { values: moves.share.map((share) => (share === null ? null : 100 * share)), from: 0, to: 100, title: "C, % of its limit" };
  }
  if (name === "load") {
    return { values: moves.c_feed, ...bounds(moves.c_feed.filter((_, move) => moves.role[move] !== "positioning"), true), title: "C, deg/min" };
  }
  if (name === "feed") {
    const values = moves.true_feed.map((feed, move) => {
      const real = feed === null ? moves.feed[move] : feed;
      return real === null || moves.role[move] === "positioning" ? null : real / section.scale;
    });
    return { values, ...bounds(values, false), title: `F, ${units.name}/min` };
  }
  return null;
}

function bounds(values, fromZero) {
  let from = fromZero ? 0 : Infinity;
  let to = -Infinity;
  for (const value of values) {
    if (value !== null) {
      from = Math.min(from, value);
      to = Math.max(to, value);
    }
  }
  if (!(to > from)) {
    to = Number.isFinite(to) ? to : 1;
    from = to > 0 ? 0 : to - 1;
  }
  return { from, to };
}

/** The class of each move: a number of SHADES, "above", or "unknown" where there is nothing to color it by. */
function classesOf(section, name) {
  const coloring = coloringOf(section, name);
  if (coloring === null) {
    return section.moves.line.map(() => "plain");
  }
  const { values, from, to } = coloring;
  const isLimited = coloring.title.includes("%");
  return values.map((value) => {
    if (value === null) {
      return "unknown";
    }
    if (isLimited && value > to * (1 + 1e-9)) {
      return "above";
    }
    const place = Math.floor(((value - from) / (to - from)) * SHADES.length);
    return Math.min(Math.max(place, 0), SHADES.length - 1);
  });
}

function colorOf(kind) {
  return { above: ABOVE, plain: PLAIN, unknown: UNKNOWN }[kind] || SHADES[kind];
}

/** A trace without points, for the sake of its bar of colors. */
function colorBar(section, name) {
  const coloring = coloringOf(section, name);
  if (coloring === null) {
    return [];
  }
  const colorscale = SHADES.flatMap((shade, place) => [
    [place / SHADES.length, shade],
    [(place + 1) / SHADES.length, shade],
  ]);
  return [{
    type: "scatter", mode: "markers", x: [null], y: [null], hoverinfo: "skip", showlegend: false,
    marker: {
      color: [coloring.from], cmin: coloring.from, cmax: coloring.to, colorscale, showscale: true,
      colorbar: { title: { text: coloring.title, side: "right" }, thickness: 12, len: 0.9, outlinewidth: 1, nticks: 5 },
    },
  }];
}
