// ---- sides: all sections beside each other, small; a column for each channel ----

const SMALL = 150;

/** The small faces of a program, in their own region; hidden until they are wanted. */
function sidesView(root, picture, state, program, sections, hand) {
  const channels = [...new Set(picture.sections.map((section) => section.channel))];
  if (picture.sections.length < 2) {
    return { toggle: () => {}, isOffered: false };
  }
  const grid = element("div");
  grid.className = "sides";
  grid.hidden = true;
  grid.setAttribute("role", "group");
  grid.setAttribute("aria-label", "All sections");
  grid.id = `p${program}sides`;
  root.querySelector(".stage .bar").after(grid);
  const toggle = hand.toggle("Side by side", "b", () => switchTo(grid.hidden));
  toggle.setAttribute("aria-controls", grid.id);
  const small = new Map();

  function make() {
    const longest = Math.max(...picture.sections.map((section) => section.time || 0));
    for (const channel of channels) {
      const column = element("div");
      column.className = "column";
      if (channels.length > 1) {
        column.append(element("strong", channel ? `channel ${channel}` : "one channel"));
      }
      const row = element("div");
      row.className = "faces";
      picture.sections.forEach((section, place) => {
        if (section.channel === channel) {
          const face = smallFace(section, longest, picture.findings.filter((finding) => finding.section === place && !finding.silenced));
          face.addEventListener("click", () => state.choose({ program, section: place }));
          small.set(place, face);
          row.append(face);
        }
      });
      column.append(row);
      grid.append(column);
    }
    grid.classList.toggle("of-channels", channels.length > 1);
  }

  function show() {
    small.forEach((face, place) => {
      face.setAttribute("aria-pressed", String(sections.views[place] === sections.shown()));
    });
  }

  function switchTo(isShown) {
    if (!small.size) {
      make();
    }
    grid.hidden = !isShown;
    toggle.setAttribute("aria-pressed", String(isShown));
    show();
    const shown = [...small.values()].find((face) => face.getAttribute("aria-pressed") === "true");
    if (isShown && shown) {
      shown.scrollIntoView({ block: "nearest" });
    }
  }

  state.subscribe((now, before) => {
    if (now.section !== before.section && !grid.hidden) {
      show();
    }
  });
  return { toggle: () => switchTo(grid.hidden), isOffered: true };
}

/** A button with the face of a section: the part, the path, where findings are, and its time beside the longest [s]. */
function smallFace(section, longest, findings) {
  const face = button("", () => {});
  face.className = "small-face";
  const [x0, c0, x1, c1] = section.frame;
  const size = Math.max(x1 - x0, c1 - c0) || 1;
  const [left, top] = [(x0 + x1 - size) / 2, (c0 + c1 + size) / 2];
  const px = ([x, c]) => `${(((x - left) / size) * SMALL).toFixed(1)} ${(((top - c) / size) * SMALL).toFixed(1)}`;
  const svg = svgElement("svg", { viewBox: `0 0 ${SMALL} ${SMALL}`, "aria-hidden": "true" });
  const ring = (points) => `M${points.map(px).join("L")}Z`;
  const part = section.parts[section.parts.length - 1];
  if (part) {
    svg.append(svgElement("path", { class: "part", "fill-rule": "evenodd", d: part.polygons.flat().filter((points) => points.length).map(ring).join("") }));
  }
  const path = section.tool.x.length && !section.needs_radius ? section.tool : section.programmed;
  svg.append(svgElement("path", { class: "path", d: thinPath(path, px) }));
  svg.append(svgElement("path", { class: "zero", d: `M${px([0, 0])}m-4 0h8m-4-4v8` }));
  for (const [x, c] of findings.flatMap((finding) => (finding.places || []).slice(0, 1)).filter(([x, c]) => x !== null && c !== null).slice(0, 50)) {
    const [cx, cy] = px([x, c]).split(" ");
    svg.append(svgElement("circle", { class: "fault", cx, cy, r: 4 }));
  }
  const time = section.time === null ? "" : `, ${section.time.toFixed(1)} s`;
  const faults = findings.length ? `, ${findings.length} finding${findings.length > 1 ? "s" : ""}` : "";
  const label = element("span", `${section.title}${time}${faults}`);
  const bar = element("i");
  bar.style.width = `${longest > 0 ? (100 * (section.time || 0)) / longest : 0}%`;
  face.append(svg, bar, label);
  return face;
}

/** A path of at most some 2,000 points: more are not seen in a small picture. */
function thinPath(path, px) {
  const step = Math.max(Math.ceil(path.x.length / 2000), 1);
  let text = "";
  let isBegun = false;
  for (let place = 0; place < path.x.length; place += 1) {
    const isGap = path.x[place] === null;
    const isLast = place + 1 === path.x.length || path.x[place + 1] === null;
    if (isGap) {
      isBegun = false;
    } else if (!isBegun || isLast || place % step === 0) {
      text += `${isBegun ? "L" : "M"}${px([path.x[place], path.c[place]])}`;
      isBegun = true;
    }
  }
  return text;
}
