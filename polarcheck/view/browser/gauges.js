// ---- gauges: axes and rates of one moment, as numbers and as bars against their limits ----

/** A bar without a limit is full at the highest rate of the section. */
function gaugesView(box, section, line) {
  const units = unitsOf(section);
  const written = section.diameter ? 2 : 1;
  const largest = (column) => column.reduce((most, value) => (Math.abs(value) > most ? Math.abs(value) : most), 0);
  const length = (value) => (Number.isFinite(value) ? units.length(value) : "not known");
  const numbers = [
    ["C angle", "angle", "deg", (now) => (Number.isFinite(now.angle) ? (now.angle + 0).toFixed(3) : "not known")],
    ["X axis", "axis", `${units.name}${section.diameter ? ", diameter" : ""}`, (now) => length(now.machineX * written)],
    ["Z", "z", units.name, (now) => length(now.z)],
    ["part", "part", units.name, (now) => (Number.isFinite(now.x + now.c) ? units.point([now.x, now.c]) : "not known")],
  ];
  const bars = [
    ["C rate", "c_feed", "deg/min", 1, section.c_limit, largest(line.cFeed), (now) => now.cFeed],
    ["X rate", "x_feed", `${units.name}/min`, section.scale, section.x_limit, largest(line.xFeed), (now) => now.xFeed],
    ["F", "feed", `${units.name}/min`, section.scale, section.feed_limit, largest(line.feed), (now) => now.feed],
  ];
  const shown = numbers.map(([label, name, unit, textOf]) => {
    const value = element("output");
    value.dataset.value = name;
    box.append(gauge(label, value, unit));
    return (now) => write(value, textOf(now));
  });
  const scaled = bars.map(([label, name, unit, scale, limit, highest, rateOf]) => {
    const value = element("output");
    value.dataset.value = name;
    const fill = element("i");
    const track = element("span", "", fill);
    track.className = "track";
    const full = limit === null ? highest : limit;
    const row = gauge(label, value, limit === null ? unit : `of ${rounded(limit / scale)} ${unit}`, track);
    row.title = limit === null ? "No limit is given; the bar is full at the highest rate of the section." : "The mark on the bar is the limit.";
    row.classList.toggle("has-limit", limit !== null);
    box.append(row);
    return {
      number: (now) => write(value, now.kind === JUMP && name === "c_feed" ? "180 deg at once" : Number.isFinite(rateOf(now)) ? rounded(rateOf(now) / scale) : "not known"),
      bar: (now) => {
        const share = now.kind === JUMP && name === "c_feed" ? Infinity : full > 0 ? Math.abs(rateOf(now)) / full || 0 : 0;
        // The limit stands at 80 % of a bar, so that there is room above it.
        const drawn = Math.min(share * (limit === null ? 1 : 0.8), 1);
        fill.style.transform = `scaleX(${drawn.toFixed(4)})`;
        row.classList.toggle("above", limit !== null && share > 1 + 1e-9);
      },
    };
  });
  return {
    /** Bars follow each frame, numbers where they can be read. */
    show(now, hasNumbers) {
      scaled.forEach((each) => each.bar(now));
      if (hasNumbers) {
        shown.forEach((each) => each(now));
        scaled.forEach((each) => each.number(now));
      }
    },
  };
}

function gauge(label, value, unit, ...more) {
  // Numbers that change in each frame are read out only when they are asked for.
  value.setAttribute("aria-live", "off");
  value.setAttribute("aria-label", label);
  const row = element("div", "", element("span", label), value, element("span", unit), ...more);
  row.className = "gauge";
  return row;
}

function write(box, text) {
  if (box.textContent !== text) {
    box.textContent = text;
  }
}
