// ---- positions: points of the plane in the program's own words, and what is copied ----

/** A point of the plane [mm] in the axes of the program [mm], radius. */
function programmed({ writing }, [x, c], isWay = false) {
  const origin = isWay ? [0, 0] : writing.origin || [0, 0];
  const [dx, dc] = [x - origin[0], c - origin[1]];
  const turn = (-writing.turn * Math.PI) / 180;
  return [dx * Math.cos(turn) - dc * Math.sin(turn), dx * Math.sin(turn) + dc * Math.cos(turn)];
}

/** Both coordinates as numbers in the units of the program, diameters where it writes diameters. */
function coordinates(section, point, isWay = false) {
  const [x, c] = programmed(section, point, isWay);
  return [
    (x * (section.diameter ? 2 : 1)) / section.scale,
    (c * (section.writing.virtual_diameter ? 2 : 1)) / section.scale,
  ];
}

/** The name of an axis: C2 for C2=. */
function axisName(address) {
  return address.replace("=", "");
}

/** What a scale that counts from the center says where the program counts from elsewhere. */
function scaleNote({ writing: { origin, turn } }) {
  return origin !== null && origin[0] === 0 && origin[1] === 0 && turn === 0 ? "" : ", from the center of C";
}

/** A number as a program writes it, always with its point: 24.5, -3.2, 40. */
function writtenNumber(value, digits) {
  const text = value.toFixed(digits).replace(/0+$/, "");
  return /^-0\.$/.test(text) ? "0." : text;
}

/** A point of the plane as words of the program: X24.5 C-3.2. */
function wordsAt(section, point) {
  const { linear, virtual } = section.writing;
  const digits = section.units === "inch" ? 4 : 3;
  const [x, c] = coordinates(section, point).map((value) => writtenNumber(value, digits));
  return `${linear}${x} ${virtual}${c}`;
}

/** Why the words of a point may not be those of the program; empty if they are. */
function doubtOfWords(section) {
  return section.writing.origin === null ? "counted from the center: this section moves its zero" : "";
}

/** Copies a text, and says so; where the browser does not let it, shows the text to be copied by hand. */
async function copyText(text, say) {
  try {
    await navigator.clipboard.writeText(text);
    say(`copied: ${text}`);
    return;
  } catch {
    // No clipboard for this page: the older way is tried.
  }
  const field = element("textarea");
  field.value = text;
  field.setAttribute("aria-hidden", "true");
  field.className = "copied";
  const focused = document.activeElement;
  document.body.append(field);
  field.select();
  let isCopied = false;
  try {
    isCopied = document.execCommand("copy");
  } catch {
    isCopied = false;
  }
  field.remove();
  if (focused instanceof HTMLElement) {
    focused.focus();
  }
  say(isCopied ? `copied: ${text}` : `to copy: ${text}`);
}

/** A new element of a drawing within the page. */
function svgElement(name, attributes) {
  const space = Object.assign(document.createElement("template"), { innerHTML: "<svg></svg>" }).content.firstChild.namespaceURI;
  const made = document.createElementNS(space, name);
  Object.entries(attributes).forEach(([key, value]) => made.setAttribute(key, String(value)));
  return made;
}
