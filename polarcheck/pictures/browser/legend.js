// ---- legend: what the path is coloured by, and the finished part that is filled ----

const COLORINGS = { load: "by the rate of C", feed: "by F", none: "plain" };

/** The choices below a face. view: what sectionView returns. */
function legend(place, section, view) {
  const select = (name, text, options, value, act) => {
    const made = element("select");
    made.className = name;
    made.append(...options.map(([key, label]) => Object.assign(element("option", label), { value: key })));
    made.value = value;
    made.addEventListener("change", () => {
      act(made.value);
      view.redraw();
    });
    const label = element("label", `${text} `, made);
    return label;
  };
  const hasLimit = section.moves.share.some((share) => share !== null);
  const load = hasLimit ? "by the share of the limit of C" : "by the rate of C (no limit given)";
  const colorings = Object.entries({ ...COLORINGS, load });
  const levels = section.parts.map((part, level) => [String(level), part.z === null ? "Z not known" : `Z${unitsOf(section).length(part.z)}`]);
  if (!section.needs_radius) {
    place.append(select("coloring", "Colour", colorings, view.coloring.name, (name) => {
      view.coloring.name = name;
    }));
  }
  if (levels.length) {
    place.append(select("level", "Finished part at", [...levels, ["-1", "none"]], String(view.coloring.level), (level) => {
      view.coloring.level = Number(level);
    }));
  }
}
