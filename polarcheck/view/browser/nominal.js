// ---- nominal: the part of the job, as drawings and shapes give it, under the path ----

/** The lines of drawings and shapes as traces of the face. */
function nominalTraces(section, units) {
  return section.drawing.map((drawn) => {
    const x = pathsOf(drawn).flatMap((path) => [...path.map((point) => units.x(point[0])), null]);
    const y = pathsOf(drawn).flatMap((path) => [...path.map((point) => units.c(point[1])), null]);
    const depth = drawn.z === null ? "" : ` at Z${units.length(drawn.z)}`;
    return line(`drawing ${drawn.title}${depth}`, x, y, { color: color("--drawing"), width: 2, dash: "8px,3px,2px,3px" });
  });
}

/** The curves of a drawing, closed ones with their first point at their end. */
function pathsOf({ lines, rings }) {
  return [...lines, ...rings.map((ring) => [...ring, ring[0]])];
}
