// ---- pins: the findings on the face, numbered as in the list; those at one place share a pin ----

/** Height of a pin, width of a character, distance of a pin from its place [px]. */
const PIN = { height: 20, character: 7.2, padding: 12, away: 12 };
/** Places that are shown of one finding, pins of one face. */
const PIN_LIMITS = { places: 200, pins: 150 };

/**
 * The pins of a face. view: what sectionView returns; choose(finding): what a click does.
 * Returns show(): to be called after each change of the window, the size or the chosen finding.
 */
function pinsOf(box, picture, state, program, place, choose) {
  const face = box.querySelector(".face");
  const layer = element("div");
  layer.className = "pins";
  box.append(layer);
  const entries = [];
  for (const finding of picture.order) {
    const { section, places, severity, silenced } = picture.findings[finding];
    if (section === place) {
      places.slice(0, PIN_LIMITS.places).forEach((point) => entries.push({ finding, point, severity, silenced: Boolean(silenced) }));
    }
  }

  function show() {
    const plane = planeTransform(face);
    const chosen = state.chosen.program === program ? state.chosen.finding : null;
    const pins = clustersOf(entries, plane, picture.numbers).map((cluster) => pinElement(cluster, picture, chosen, choose));
    const hasFocus = layer.contains(document.activeElement) ? document.activeElement.dataset.findings : null;
    layer.replaceChildren(...pins);
    const again = hasFocus === null ? null : pins.find((pin) => pin.dataset.findings === hasFocus);
    if (again) {
      again.focus({ preventScroll: true });
    }
  }

  return show;
}

/** Pins that do not overlap: each has its findings in the order of the list, its text and its rectangle. */
function clustersOf(entries, plane, numbers) {
  const clusters = [];
  const { left, top, width, height } = plane;
  const cells = new Set();
  for (const { finding, point, severity, silenced } of entries) {
    const [x, y] = plane.toPx(...point);
    if (x < left || x > left + width || y < top || y > top + height) {
      continue;
    }
    // Many places of one finding are thinned before they are compared.
    const cell = `${finding} ${Math.round(x / 12)} ${Math.round(y / 12)}`;
    if (cells.has(cell)) {
      continue;
    }
    cells.add(cell);
    const single = placed({ findings: [finding], x, y, severity, silenced }, plane, numbers);
    const near = clusters.find((cluster) => overlap(cluster, single));
    if (near) {
      joined(near, single, plane, numbers);
    } else if (clusters.length < PIN_LIMITS.pins) {
      clusters.push(single);
    }
  }
  return apart(clusters, plane, numbers);
}

/** A pin that has grown may reach its neighbour: they become one, until none does. */
function apart(clusters, plane, numbers) {
  for (let place = 0; place < clusters.length; place += 1) {
    const other = clusters.findIndex((cluster, number) => number > place && overlap(clusters[place], cluster));
    if (other >= 0) {
      joined(clusters[place], clusters[other], plane, numbers);
      clusters.splice(other, 1);
      place = -1;
    }
  }
  return clusters;
}

function joined(cluster, other, plane, numbers) {
  const rank = (severity) => ["error", "warning", "note"].indexOf(severity);
  cluster.findings = [...new Set([...cluster.findings, ...other.findings])];
  cluster.severity = rank(other.severity) < rank(cluster.severity) ? other.severity : cluster.severity;
  cluster.silenced = cluster.silenced && other.silenced;
  placed(cluster, plane, numbers);
}

/** The text and the rectangle of a pin: above its place, below it at the upper edge. */
function placed(cluster, { left, top, width }, numbers) {
  cluster.text = runs(cluster.findings.map((finding) => numbers[finding]));
  const wide = Math.max(cluster.text.length * PIN.character + PIN.padding, PIN.height);
  cluster.wide = wide;
  cluster.isBelow = cluster.y - PIN.away - PIN.height < top;
  cluster.left = Math.min(Math.max(cluster.x - wide / 2, left), left + width - wide);
  cluster.top = cluster.isBelow ? cluster.y + PIN.away : cluster.y - PIN.away - PIN.height;
  return cluster;
}

function overlap(one, other) {
  return Math.abs(one.left + one.wide / 2 - other.left - other.wide / 2) < (one.wide + other.wide) / 2 + 1 && Math.abs(one.top - other.top) < PIN.height + 1;
}

/** Numbers in short, as "1, 3-7"; of many runs the first three and how many more. */
function runs(numbers) {
  const sorted = [...numbers].sort((a, b) => a - b);
  const parts = [];
  for (const number of sorted) {
    const last = parts[parts.length - 1];
    if (last && last[1] === number - 1) {
      last[1] = number;
    } else {
      parts.push([number, number]);
    }
  }
  const texts = parts.slice(0, 3).map(([from, to]) => (from === to ? `${from}` : to === from + 1 ? `${from}, ${to}` : `${from}\u2013${to}`));
  const more = parts.slice(3).reduce((sum, [from, to]) => sum + to - from + 1, 0);
  return texts.join(", ") + (more ? ` +${more}` : "");
}

function pinElement(cluster, picture, chosen, choose) {
  const first = cluster.findings.includes(chosen) ? cluster.findings[(cluster.findings.indexOf(chosen) + 1) % cluster.findings.length] : cluster.findings[0];
  const { findings } = cluster;
  const made = button(cluster.text, () => choose(first));
  const { severity, line, message } = picture.findings[findings[0]];
  made.className = `pin ${cluster.severity}${cluster.silenced ? " silenced" : ""}${cluster.isBelow ? " is-below" : ""}${findings.includes(chosen) ? " is-chosen" : ""}`;
  made.dataset.findings = findings.join(" ");
  made.title = findings.length > 1 ? `${findings.length} findings: ${cluster.text}` : `${severity}, line ${line}: ${message}`;
  made.setAttribute("aria-label", findings.length > 1 ? `Findings ${cluster.text}` : `Finding ${cluster.text}, ${severity}, line ${line}`);
  Object.assign(made.style, { left: `${cluster.left}px`, top: `${cluster.top}px`, width: `${cluster.wide}px` });
  const tip = element("span");
  tip.className = "tip";
  tip.style.left = `${Math.min(Math.max(cluster.x - cluster.left, 5), cluster.wide - 5)}px`;
  made.append(tip);
  return made;
}
