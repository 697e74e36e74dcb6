// ---- distances: what is measured of one shape, and between two, in mm of the plane ----

/** Walls are parallel if they turn against each other by less [rad], or leave each other by less along the shorter [mm]. */
const PARALLEL = 2e-4;
const PARALLEL_LEAST = 3e-4;
const PARALLEL_MOST = 0.01;
/** Arcs about centers this near each other have one center [mm]. */
const CONCENTRIC = 2e-3;

/**
 * What is measured: `rows` of [label, kind, value], and `between`, the two points of the distance, or null. Kinds are
 * length [mm], angle [deg], point and delta ([x, c] [mm]).
 */
function measured(first, second) {
  if (second === null) {
    return { rows: factsOfShape(first), between: null };
  }
  const order = ["point", "line", "arc"];
  if (order.indexOf(first.kind) > order.indexOf(second.kind)) {
    const turned = measured(second, first);
    return { ...turned, between: turned.between && [...turned.between].reverse() };
  }
  return {
    "point point": betweenPoints, "point line": fromPointToLine, "point arc": fromPointToArc,
    "line line": betweenLines, "line arc": fromLineToArc, "arc arc": betweenArcs,
  }[`${first.kind} ${second.kind}`](first, second);
}

function degrees(angle) {
  return (angle * 180) / Math.PI;
}

/** The direction of a way, from 0 to 360 deg. */
function directionOf(way) {
  const angle = degrees(Math.atan2(way[1], way[0]));
  return angle < -1e-9 ? angle + 360 : Math.abs(angle);
}

function factsOfShape(shape) {
  if (shape.kind === "point") {
    return [["at", "point", shape.at], ["from the center", "length", sizeOf(shape.at)], ["angle", "angle", directionOf(shape.at)]];
  }
  if (shape.kind === "line") {
    const way = minus(shape.to, shape.from);
    const away = Math.abs(cross(shape.from, way)) / sizeOf(way);
    return [
      ["length", "length", sizeOf(way)], ["angle", "angle", directionOf(way)],
      ["from the center", "length", away], ["twice that", "length", 2 * away],
    ];
  }
  return [
    ["radius", "length", shape.radius], ["diameter", "length", 2 * shape.radius], ["center", "point", shape.center],
    ["over", "angle", degrees(Math.abs(shape.sweep))],
  ];
}

function distanceBetween(label, from, to, more = []) {
  return { rows: [[label, "length", distanceOf(from, to)], ["", "delta", minus(to, from)], ...more], between: [from, to] };
}

function betweenPoints(first, second) {
  const way = minus(second.at, first.at);
  return distanceBetween("distance", first.at, second.at, [["angle", "angle", directionOf(way)]]);
}

/** The point of a whole line, beyond its ends, too, that is nearest to a point. */
function footOn(line, point) {
  const way = minus(line.to, line.from);
  const share = dot(minus(point, line.from), way) / dot(way, way);
  return [line.from[0] + share * way[0], line.from[1] + share * way[1]];
}

function isBeyond(line, point) {
  return distanceOf(nearestOn(line, point), point) > 1e-3;
}

function fromPointToLine(point, line) {
  const foot = footOn(line, point.at);
  return distanceBetween(isBeyond(line, foot) ? "to the line of the wall, beyond its end" : "to the wall", point.at, foot);
}

function betweenLines(first, second) {
  const ways = [first, second].map((line) => minus(line.to, line.from));
  const [short, long] = sizeOf(ways[0]) <= sizeOf(ways[1]) ? [first, second] : [second, first];
  const turn = Math.abs(Math.atan2(cross(...ways), dot(...ways)));
  const angle = Math.min(turn, Math.PI - turn);
  const leaves = sizeOf(minus(short.to, short.from)) * Math.sin(angle);
  if (angle <= PARALLEL || (angle <= PARALLEL_MOST && leaves <= PARALLEL_LEAST)) {
    const middle = [(short.from[0] + short.to[0]) / 2, (short.from[1] + short.to[1]) / 2];
    const foot = footOn(long, middle);
    const [from, to] = short === first ? [middle, foot] : [foot, middle];
    return distanceBetween("between the parallel walls", from, to);
  }
  const share = cross(minus(second.from, first.from), ways[1]) / cross(...ways);
  const meets = [first.from[0] + share * ways[0][0], first.from[1] + share * ways[0][1]];
  return { rows: [["between the walls", "angle", degrees(angle)], ["or", "angle", 180 - degrees(angle)], ["they meet at", "point", meets]], between: null };
}

/** From a point to an arc: its center, its circle, and the far side of that. */
function fromPointToArc(point, arc) {
  const away = distanceOf(point.at, arc.center);
  const near = away > 1e-9 ? onArc(arc, Math.atan2(point.at[1] - arc.center[1], point.at[0] - arc.center[0])) : onArc(arc, arc.start);
  return distanceBetween("to the arc", point.at, near, [
    ["to the far side of its circle", "length", away + arc.radius], ["to its center", "length", away],
  ]);
}

function fromLineToArc(line, arc) {
  const foot = footOn(line, arc.center);
  const away = distanceOf(foot, arc.center);
  const way = away > 1e-9 ? Math.atan2(foot[1] - arc.center[1], foot[0] - arc.center[0]) : directionOf(minus(line.to, line.from)) + Math.PI / 2;
  return distanceBetween("to the arc", foot, onArc(arc, way), [
    ["to the far side of its circle", "length", away + arc.radius], ["to its center", "length", away],
  ]);
}

function betweenArcs(first, second) {
  const way = minus(second.center, first.center);
  const apart = sizeOf(way);
  const angle = apart > CONCENTRIC ? Math.atan2(way[1], way[0]) : first.start + first.sweep / 2;
  if (apart <= CONCENTRIC) {
    return distanceBetween("between the arcs about one center", onArc(first, angle), onArc(second, angle));
  }
  // Of two circles, one within the other, the nearest sides lie on the same side of both centers.
  const isWithin = apart + Math.min(first.radius, second.radius) < Math.max(first.radius, second.radius);
  const side = isWithin && first.radius < second.radius ? angle + Math.PI : angle;
  const ends = [onArc(first, side), onArc(second, isWithin ? side : side + Math.PI)];
  const centers = [["between the centers", "length", apart], ["", "delta", way]];
  const outside = ["over both", "length", Math.max(apart + first.radius + second.radius, 2 * first.radius, 2 * second.radius)];
  const crosses = !isWithin && apart < first.radius + second.radius;
  if (crosses) {
    return { rows: [...centers, outside], between: [first.center, second.center] };
  }
  return { rows: [["between the arcs", "length", distanceOf(...ends)], ...centers, outside], between: ends };
}
