// ---- words: values as text, in the units of the program ----

/** What turns mm of the polar plane into what stands in the program, and into words. */
function unitsOf(section) {
  const { scale, units } = section;
  const factor = (section.diameter ? 2 : 1) / scale;
  const digits = units === "inch" ? 4 : 3;
  const length = (value) => (value === null ? "not known" : (value / scale).toFixed(digits));
  return {
    name: units,
    x: (value) => (value === null ? null : value * factor),
    c: (value) => (value === null ? null : value / scale),
    /** How many times as long one unit of C is as one of X: what equal scales need. */
    ratio: section.diameter ? 2 : 1,
    length,
    /** A point in the words of the program, with all digits. */
    point: (place) => {
      const { linear, virtual } = section.writing;
      const words = place.includes(null) ? null : coordinates(section, place).map((value) => value.toFixed(digits).replace(/^-(0\.0*)$/, "$1"));
      return words === null ? "not known" : `${linear}${words[0]} ${virtual}${words[1]}`;
    },
    /** A length along X as the program writes X, a diameter or a radius. */
    onX: (value) => length(value * factor * scale),
    feed: (value) => (value === null ? "not known" : `${rounded(value / scale)} ${units}/min`),
    span: ([from, to]) => (from === to ? length(to) : `${length(from)} to ${length(to)}`),
  };
}

/** A number with as many digits as one looks at. */
function rounded(value) {
  const digits = Math.abs(value) >= 100 ? 0 : Math.abs(value) >= 10 ? 1 : 2;
  return value.toFixed(digits);
}

function rateOfC(value) {
  return value === null ? "not known" : `${rounded(value)} deg/min`;
}

/** Label and text of all that is known of a move: the same words beside the pointer and in the box of the chosen move. */
function factsOf(section, move) {
  const { moves } = section;
  const units = unitsOf(section);
  const feed = units.feed(moves.feed[move]);
  const real = moves.true_feed[move];
  const share = moves.share[move];
  return [
    ["line", moves.number[move] ? `${moves.line[move]}, ${moves.number[move]}` : String(moves.line[move])],
    ["block", moves.block[move]],
    ["move", moves.role[move]],
    ["to, part", `${units.point(moves.end[move])} (tool center)`],
    ["to, machine", machinePoint(section, move)],
    ["Z", units.span(moves.z[move])],
    ["F", real === null || real === moves.feed[move] ? feed : `${feed}, in truth ${units.feed(real)}`],
    ["nearest", `${units.length(moves.nearest[move])} ${units.name} from the center`],
    ["C rate", rateText(section, move) + (share === null ? "" : `, ${percent(share)} of its limit`)],
    ["X rate", units.feed(moves.x_feed[move])],
    ["time", timeOf(moves.begin[move], moves.time[move])],
  ].filter(([label, text]) => label !== "nearest" || !text.startsWith("not known"));
}

/** Where the axes of the machine stand at the end of a move. */
function machinePoint(section, move) {
  const [x, c] = section.moves.end[move];
  const angle = section.moves.angle[move][1];
  if (x === null || c === null) {
    return "not known";
  }
  const units = unitsOf(section);
  const side = section.rates.machine_x.some((value) => value !== null && value < -1e-6) ? -1 : 1;
  const turned = angle === null ? "C angle not known" : `C angle ${angle.toFixed(3)} deg${section.entry_known ? "" : " (C taken as 0 at the start)"}`;
  return `X axis ${units.onX(side * Math.hypot(x, c))}, ${turned}`;
}

function rateText(section, move) {
  return section.moves.jump[move] ? "C would have to turn 180 deg at once at the center" : rateOfC(section.moves.c_feed[move]);
}

function percent(share) {
  return `${share < 0.1 ? (100 * share).toPrecision(1) : Math.round(100 * share)} %`;
}

function timeOf(begin, time) {
  if (time === null) {
    return "not known";
  }
  return begin === null ? `${time.toFixed(2)} s` : `${time.toFixed(2)} s, from ${begin.toFixed(2)} s`;
}

/** A new element; what it says is text, whatever stands in it. */
function element(name, text = "", ...children) {
  const made = document.createElement(name);
  made.textContent = text;
  made.append(...children);
  return made;
}

/** Call an action with the value of a slider, once per frame: a slider moves more often than is drawn. */
function onSlider(slider, action) {
  let isDue = false;
  slider.addEventListener("input", () => {
    if (!isDue) {
      isDue = true;
      requestAnimationFrame(() => {
        isDue = false;
        action(Number(slider.value));
      });
    }
  });
}

/** Pairs of label and text as the entries of a list of definitions. */
function pairs(facts) {
  return facts.flatMap(([label, text]) => [element("dt", label), element("dd", text)]);
}

/** A button with a text and what it does. */
function button(text, act) {
  const made = element("button", text);
  made.type = "button";
  made.addEventListener("click", act);
  return made;
}
