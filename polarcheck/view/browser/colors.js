// ---- colors: classes that the color-blind can distinguish and that, as light and dark, print in black and white ----

/** Number of shades: viridis, without the end that is too near to the paper. */
const SHADES = 8;
/** Upper bounds of the classes, in percent of a limit: most paths run far below it. */
const SHARES = [1, 3, 5, 10, 20, 40, 70, 100];

/**
 * What moves are colored by: values (one per move), bounds (the upper one of each class), title; null for one color.
 * isLimited: a value above the last bound is above the limit.
 */
function coloringOf(section, name) {
  const { moves } = section;
  const units = unitsOf(section);
  if (name === "load" && moves.share.some((share) => share !== null)) {
    return { values: moves.share.map((share) => (share === null ? null : 100 * share)), bounds: SHARES, title: "C rate, % of its limit", isLimited: true };
  }
  if (name === "load") {
    const values = moves.c_feed.map((value, move) => (moves.role[move] === "positioning" ? null : value));
    return { values, bounds: niceBounds(values), title: "C rate, deg/min", isLimited: false };
  }
  if (name === "feed") {
    const values = moves.true_feed.map((feed, move) => {
      const real = feed === null ? moves.feed[move] : feed;
      return real === null || moves.role[move] === "positioning" ? null : real / section.scale;
    });
    return { values, bounds: niceBounds(values), title: `F, ${units.name}/min`, isLimited: false };
  }
  return null;
}

/** Bounds of at most 8 classes: each value of its own if there are few, else round numbers on a logarithmic scale. */
function niceBounds(values) {
  const known = [...new Set(values.filter((value) => value !== null).map((value) => Number(value.toPrecision(4))))].sort((a, b) => a - b);
  if (known.length <= SHADES) {
    return known;
  }
  const [low, high] = [Math.max(known[0], known[known.length - 1] / 1e4), known[known.length - 1]];
  const round = [];
  for (let decade = Math.floor(Math.log10(low)); decade <= Math.ceil(Math.log10(high)); decade += 1) {
    round.push(...[1, 2, 5].map((digit) => Number((digit * 10 ** decade).toPrecision(1))));
  }
  const between = round.filter((bound) => bound > low && bound < high);
  const every = Math.ceil((between.length + 1) / SHADES);
  return [...between.filter((_, place) => place % every === every - 1), high].slice(-SHADES);
}

/** The class of each move: a number from 0, "above", "plain", or "unknown" where there is nothing to color it by. */
function classesOf(section, name) {
  const coloring = coloringOf(section, name);
  if (coloring === null) {
    return section.moves.line.map(() => "plain");
  }
  const { values, bounds, isLimited } = coloring;
  return values.map((value) => {
    if (value === null) {
      return "unknown";
    }
    const place = bounds.findIndex((bound) => value <= bound * (1 + 1e-4));
    return place >= 0 ? place : isLimited ? "above" : bounds.length - 1;
  });
}

/** The color of a class, of so many. */
function colorOf(kind, count) {
  if (typeof kind !== "number") {
    return color({ above: "--above", plain: "--path", unknown: "--unknown" }[kind]);
  }
  const shade = count < 2 ? SHADES - 3 : Math.round((kind * (SHADES - 1)) / (count - 1));
  return color(`--shade-${shade + 1}`);
}

/** What a class holds, in words. */
function classText(kind, bounds) {
  if (typeof kind !== "number") {
    return { above: "above", unknown: "not known" }[kind];
  }
  const text = (value) => (Number.isInteger(value) ? String(value) : rounded(value));
  return kind === 0 ? `to ${text(bounds[0])}` : `${text(bounds[kind - 1])}\u2013${text(bounds[kind])}`;
}
