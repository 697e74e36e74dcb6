// ---- measuring: distances on the face, between points and walls that the pointer or the keys take ----

/** The pointer takes what is this near [px]. */
const REACH = 12;
/** A pointer that moves less than this between down and up clicks [px]. */
const CLICK = 4;

const MEASURE_HINT = "Click two corners, walls or points; one arc for its radius. Keys: arrows go from corner to corner, W to a wall there, Enter takes it. Alt: without snapping. Esc ends.";

/** What can be pointed at in a section, at the level of the part that is shown; with what it was made for. */
function targetsOf(section, level, hasDrawing) {
  const walls = [...shapesOfPath(section.programmed, section.moves, "contour", "programmed")];
  if (hasDrawing) {
    section.drawing.forEach((drawn) => {
      drawn.rings.forEach((ring) => walls.push(...shapesOfRing(ring, drawn.title, "drawing")));
      drawn.lines.forEach((line) => walls.push(...shapesOfRing(line, drawn.title, "drawing", false)));
    });
  }
  section.marks.forEach((mark, place) => mark.rings.forEach((ring) => walls.push(...shapesOfRing(ring, `area ${place + 1}`, "mark"))));
  (section.parts[level] ? section.parts[level].polygons : []).forEach((rings) => rings.forEach((ring) => walls.push(...shapesOfRing(ring, "finished part", "part"))));
  if (!section.needs_radius) {
    walls.push(...shapesOfPath(section.tool, section.moves, "tool center", "tool"));
  }
  if (section.stock !== null) {
    walls.push(circleShape(section.stock / 2, "stock", "bar"));
  }
  section.bar.slice(section.stock === null ? 0 : 1).forEach((ring) => walls.push(...shapesOfRing(ring, "bar", "bar")));
  if (section.keep_out !== null) {
    walls.push(circleShape(section.keep_out, "keep-out", "bar"));
  }
  walls.forEach(boxed);
  return { walls, points: [pointShape([0, 0], "center of C", "center"), ...pointsOf(walls)] };
}

/** The measuring of a program. Returns whether it is on, and what switches it. */
function measuringView(state, program, sections, hand) {
  const toggle = hand.toggle("Measure", "m", () => (isOn ? end() : begin()));
  const boxes = sections.views.map((view) => measuringBox(view.face.parentElement));
  const cache = new Map();
  let isOn = false;
  let taken = [];
  let cursor = null;
  let downAt = null;
  let isByKeys = false;

  const placeOf = () => sections.views.indexOf(sections.shown());
  const here = () => boxes[placeOf()];

  function targets() {
    const view = sections.shown();
    const { level } = view.coloring;
    const key = `${placeOf()} ${level} ${hand.hasDrawing()}`;
    if (!cache.has(key)) {
      cache.set(key, targetsOf(view.section, level, hand.hasDrawing()));
    }
    return cache.get(key);
  }

  function begin() {
    const view = sections.shown();
    if (!view) {
      return;
    }
    if (state.chosen.view === "machine") {
      state.choose({ program, view: "face" });
    }
    view.draw();
    isOn = true;
    toggle.setAttribute("aria-pressed", "true");
    boxes.forEach((box) => box.switchOn(true));
    show();
    here().panel.scrollIntoView({ block: "nearest" });
    here().root.focus({ preventScroll: true });
  }

  function end() {
    [isOn, taken, cursor] = [false, [], null];
    toggle.setAttribute("aria-pressed", "false");
    boxes.forEach((box) => box.switchOn(false));
    show();
  }

  function take() {
    if (cursor !== null) {
      taken = taken.length === 2 ? [cursor] : [...taken, cursor];
      show();
    }
  }

  /** Esc lets go of what is taken, and ends without. */
  function letGo() {
    if (taken.length) {
      taken = [];
      show();
    } else {
      end();
    }
  }

  function show() {
    const view = sections.shown();
    if (!view || !here()) {
      return;
    }
    here().show(isOn, view, taken, cursor);
  }

  function pointAt(event) {
    const { left, top } = here().root.getBoundingClientRect();
    const plane = planeTransform(sections.shown().face);
    const place = plane.toPlane(event.clientX - left, event.clientY - top);
    const { points, walls } = targets();
    isByKeys = false;
    const hit = event.altKey ? null : nearestShape(points, walls, place, REACH / plane.scale);
    cursor = hit === null ? { shape: pointShape(place, "free point", "free"), at: place } : hit;
  }

  boxes.forEach((box) => {
    const { root: place } = box;
    place.addEventListener("pointermove", (event) => {
      if (isOn && event.pointerType !== "touch" && !(event.buttons & 1)) {
        pointAt(event);
        show();
      }
    });
    place.addEventListener("pointerleave", () => {
      if (isOn && cursor !== null && !isByKeys) {
        cursor = null;
        show();
      }
    });
    place.addEventListener("pointerdown", (event) => {
      downAt = isOn && event.isPrimary && event.button === 0 && !event.target.closest("button, .modebar") ? [event.clientX, event.clientY] : null;
    }, true);
    // Plotly covers the page while the button is down: the window sees where it goes up.
    window.addEventListener("pointerup", (event) => {
      if (downAt !== null && box === here() && distanceOf(downAt, [event.clientX, event.clientY]) < CLICK) {
        downAt = null;
        pointAt(event);
        take();
        place.focus({ preventScroll: true });
      }
    }, true);
    box.copy.addEventListener("click", () => copyText(box.text(), hand.say));
    box.clear.addEventListener("click", letGo);
    place.addEventListener("keydown", (event) => {
      const action = isOn && event.target === place && !event.ctrlKey && !event.metaKey && !event.altKey && !event.shiftKey ? keyAction(event.key) : undefined;
      if (action) {
        event.preventDefault();
        event.stopPropagation();
        action();
      }
    });
  });

  function keyAction(key) {
    const ways = { ArrowRight: [1, 0], ArrowLeft: [-1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };
    if (key in ways) {
      return () => goTo(ways[key]);
    }
    return { Enter: take, w: nextWall, W: nextWall }[key];
  }

  /** The cursor goes to the next corner in a direction. */
  function goTo(way) {
    const { points } = targets();
    const view = sections.shown();
    const plane = planeTransform(view.face);
    const from = cursor === null ? plane.toPlane(plane.left + plane.width / 2, plane.top + plane.height / 2) : cursor.at;
    const next = nextPoint(points, from, way);
    if (next !== null) {
      [cursor, isByKeys] = [{ shape: next, at: next.at }, true];
      const [px, py] = plane.toPx(...next.at);
      if (px < plane.left || py < plane.top || px > plane.left + plane.width || py > plane.top + plane.height) {
        moveWindow(view, [px - plane.left - plane.width / 2, py - plane.top - plane.height / 2]);
      }
      show();
    }
  }

  /** At a corner the cursor goes through the walls that meet there. */
  function nextWall() {
    if (cursor === null) {
      return;
    }
    const near = targets().walls.filter((wall) => distanceOf(nearestOn(wall, cursor.at), cursor.at) < 1e-3);
    if (near.length) {
      cursor = { shape: near[(near.indexOf(cursor.shape) + 1) % near.length], at: cursor.at };
      show();
    }
  }

  let seen = placeOf();
  state.subscribe((chosen) => {
    if (chosen.program === program && seen !== placeOf()) {
      seen = placeOf();
      [taken, cursor] = [[], null];
      show();
    }
  });
  sections.views.forEach((view) => whenDrawn(view, () => planeTransform(view.face).onChange(() => isOn && view === sections.shown() && show())));
  return {
    toggle: () => (isOn ? end() : begin()), isOn: () => isOn, letGo,
    /** Where the cursor of measuring stands, to be copied. */
    at: () => (isOn && cursor !== null ? cursor.at : null),
  };
}

/** The corner that is nearest in a direction; those beside it count as farther. */
function nextPoint(points, from, way) {
  let best = null;
  let least = Infinity;
  for (const point of points) {
    const step = minus(point.at, from);
    const along = dot(step, way);
    const away = sizeOf(step);
    if (along > 0.35 * away && away > 1e-4) {
      const cost = (away * away) / along;
      if (cost < least) {
        [best, least] = [point, cost];
      }
    }
  }
  return best;
}

/** What measuring shows over a face: the marks, and the result in words. */
function measuringBox(root) {
  const svg = svgElement("svg", { class: "measure", "aria-hidden": "true" });
  const panel = element("div");
  panel.className = "measured";
  panel.hidden = true;
  const words = element("dl");
  const spoken = element("div", "", words);
  spoken.setAttribute("aria-live", "polite");
  const [copy, clear] = [button("Copy", () => {}), button("Clear", () => {})];
  const buttons = element("div", "", copy, clear);
  buttons.className = "buttons";
  panel.append(spoken, buttons);
  root.append(svg);
  root.parentElement.before(panel);

  function switchOn(isOn) {
    root.classList.toggle("is-measuring", isOn);
    root.querySelector(".face").classList.toggle("is-measuring", isOn);
    if (isOn) {
      root.tabIndex = 0;
      root.setAttribute("role", "application");
      root.setAttribute("aria-label", `Measuring on the face. ${MEASURE_HINT}`);
    } else {
      ["tabindex", "role", "aria-label"].forEach((name) => root.removeAttribute(name));
    }
  }

  function show(isOn, view, taken, cursor) {
    panel.hidden = !isOn;
    svg.replaceChildren();
    if (!isOn) {
      return;
    }
    const [first, second] = taken;
    const other = second || (first && cursor !== null && cursor.shape !== first.shape ? cursor : null);
    const result = first ? measured(first.shape, other ? other.shape : null) : null;
    const plane = planeTransform(view.face);
    taken.forEach((one) => svg.append(...drawnShape(one, plane, "taken")));
    if (cursor !== null && !second) {
      svg.append(...drawnShape(cursor, plane, "cursor"));
    }
    if (result && result.between) {
      svg.append(drawnLine(result.between.map((point) => plane.toPx(...point)), "between"));
    }
    words.replaceChildren(...pairs(wordsOfMeasure(view.section, first, other, cursor, result)));
    buttons.hidden = !first;
    if (first) {
      words.querySelector("dd").className = "result";
    }
  }

  const text = () => [...words.querySelectorAll("dd")].map((value) => `${value.previousSibling.textContent} ${value.textContent}`.trim()).join("\n");
  return { root, panel, switchOn, show, copy, clear, text };
}

/** Label and text of what is measured, in the units of the program; the result first. */
function wordsOfMeasure(section, first, other, cursor, result) {
  const named = (one) => (one.shape.kind === "point" ? `${one.shape.name}, ${wordsAt(section, one.at)}` : one.shape.name);
  if (!first) {
    return cursor === null ? [["", MEASURE_HINT]] : [["here", named(cursor)], ["", MEASURE_HINT]];
  }
  return [
    ...result.rows.flatMap(([label, kind, value]) => measureInWords(section, label, kind, value)),
    ["from", named(first)], ...(other ? [["to", named(other)]] : []),
  ];
}

function measureInWords(section, label, kind, value) {
  const units = unitsOf(section);
  const length = (size) => `${units.length(size)} ${units.name}`;
  if (kind === "length") {
    return [[label, length(value)]];
  }
  if (kind === "angle") {
    return [[label, `${value.toFixed(3)} deg`]];
  }
  if (kind === "point") {
    return [[label, wordsAt(section, value)]];
  }
  const digits = units.name === "inch" ? 4 : 3;
  const names = [section.writing.linear, section.writing.virtual].map(axisName);
  const sizes = coordinates(section, value, true).map((size) => size.toFixed(digits).replace(/^-(0\.0*)$/, "$1"));
  return names.map((name, axis) => {
    const isDiameter = axis ? section.writing.virtual_diameter : section.diameter;
    return [`d${name}`, `${sizes[axis]} ${units.name}${isDiameter ? ", as a diameter" : ""}`];
  });
}

function drawnLine(points, name) {
  return svgElement("polyline", { class: name, points: points.map((point) => point.map((value) => value.toFixed(1)).join(",")).join(" ") });
}

function drawnDot([x, y], name) {
  return svgElement("circle", { class: name, cx: x.toFixed(1), cy: y.toFixed(1), r: 5 });
}

function drawnShape({ shape, at }, plane, name) {
  const px = (point) => plane.toPx(...point);
  if (shape.kind === "point") {
    return [drawnDot(px(at), name)];
  }
  if (shape.kind === "line") {
    return [drawnLine([px(shape.from), px(shape.to)], `${name} wall`)];
  }
  const count = Math.max(Math.ceil(Math.abs(shape.sweep) * 20), 2);
  const points = Array.from({ length: count + 1 }, (_, place) => px(onArc(shape, shape.start + (place / count) * shape.sweep)));
  return [drawnLine(points, `${name} wall`), drawnDot(px(shape.center), `${name} center`)];
}
