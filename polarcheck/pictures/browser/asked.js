// ---- asked: what the drawing asks for, under the path ----

const ASKED = "#7a2e8e";

/** The lines of the drawing as traces of the face. */
function askedTraces(section, units) {
  return section.drawing.map((drawn) => {
    const x = drawn.lines.flatMap((path) => [...path.map((point) => units.x(point[0])), null]);
    const y = drawn.lines.flatMap((path) => [...path.map((point) => units.c(point[1])), null]);
    const depth = drawn.z === null ? "" : ` at Z${units.length(drawn.z)}`;
    return line(`drawing ${drawn.title}${depth}`, x, y, { color: ASKED, width: 2, dash: "8px,3px,2px,3px" });
  });
}
