// ---- shapes: the points, lines and arcs of a picture that can be pointed at and measured, in mm of the plane ----

/** Chords of an arc turn less than this at each point [rad]. */
const ARC_TURN = 0.21;
/** The points of an arc are this far from its center, but for so much [mm]: where G2 ends beside its circle they are not. */
const ON_ARC = 5e-3;
/** Points this near a circle lie on it: a length [mm], and a share of its radius. */
const ON_CIRCLE_LEAST = 3e-4;
const ON_CIRCLE = 2e-5;
/** Chords of an arc lie this near it: a length [mm], and a share of its radius. Flats of a polygon do not. */
const SAG_LEAST = 0.03;
const SAG = 5e-4;
/** Points are taken within this share of the reach: walls between near corners can be taken, too. */
const POINT_REACH = 0.75;
/** The chords of an arc are at most so many times as long as its first ones. */
const CHORDS = 1.6;
/** Blocks of straight moves, at least, of which an arc is read. */
const BLOCKS_OF_ARC = 6;

/**
 * A shape is { kind, name, layer, ... }: a "point" with `at`; a "line" with `from` and `to`; an "arc" with `center`,
 * `radius`, `start` and `sweep` [rad], where a sweep of 2 pi is a circle. Points are [x, c].
 */
function pointShape(at, name, layer) {
  return { kind: "point", at, name, layer };
}

function lineShape(from, to, name, layer) {
  return { kind: "line", from, to, name, layer };
}

function arcShape(center, radius, start, sweep, name, layer) {
  return { kind: "arc", center, radius, start, sweep, name, layer };
}

function circleShape(radius, name, layer) {
  return arcShape([0, 0], radius, 0, 2 * Math.PI, name, layer);
}

const minus = (a, b) => [a[0] - b[0], a[1] - b[1]];
const sizeOf = (a) => Math.hypot(a[0], a[1]);
const distanceOf = (a, b) => Math.hypot(a[0] - b[0], a[1] - b[1]);
const cross = (a, b) => a[0] * b[1] - a[1] * b[0];
const dot = (a, b) => a[0] * b[0] + a[1] * b[1];

/** The points at which shapes end, and the centers of arcs. */
function pointsOf(shapes) {
  const points = [];
  const seen = new Set();
  const add = (at, name, layer) => {
    const key = `${at[0].toFixed(4)},${at[1].toFixed(4)}`;
    if (!seen.has(key)) {
      seen.add(key);
      points.push(pointShape(at, name, layer));
    }
  };
  for (const shape of shapes) {
    if (shape.kind === "point") {
      add(shape.at, shape.name, shape.layer);
    }
    endsOf(shape).forEach((end) => add(end, `corner, ${shape.name}`, shape.layer));
  }
  for (const shape of shapes) {
    if (shape.kind === "arc") {
      add(shape.center, `center of the arc, ${shape.name}`, shape.layer);
    }
  }
  return points;
}

function endsOf(shape) {
  if (shape.ends) {
    return shape.ends;
  }
  if (shape.kind === "line") {
    return [shape.from, shape.to];
  }
  if (shape.kind === "arc" && Math.abs(shape.sweep) < 2 * Math.PI - 1e-9) {
    return [onArc(shape, shape.start), onArc(shape, shape.start + shape.sweep)];
  }
  return [];
}

function onArc({ center, radius }, angle) {
  return [center[0] + radius * Math.cos(angle), center[1] + radius * Math.sin(angle)];
}

/** The shapes of a path: a line or an arc for each move; of many short lines along one arc the arc. */
function shapesOfPath(path, moves, name, layer) {
  const shapes = [];
  let chords = [];
  const flush = () => {
    shapes.push(...arcsOfChords(chords, name, layer));
    chords = [];
  };
  let place = 1;
  while (place < path.x.length) {
    const move = path.move[place];
    const first = place;
    while (place + 1 < path.x.length && path.move[place + 1] === move && path.x[place] !== null && path.x[place + 1] !== null) {
      place += 1;
    }
    if (path.x[first - 1] === null || path.x[first] === null) {
      flush();
    } else {
      const points = [];
      for (let at = first - 1; at <= place; at += 1) {
        points.push([path.x[at], path.c[at]]);
      }
      const center = centerOf(moves, move, points);
      if (center !== null) {
        flush();
        shapes.push(arcThrough(points, center, `${name}, line ${moves.line[move]}`, layer));
      } else if (points.length === 2) {
        if (distanceOf(points[0], points[1]) > 0) {
          chords.push({ from: points[0], to: points[1], line: moves.line[move] });
        }
      } else {
        flush();
        shapes.push(...chordsOfMove(points, `${name}, line ${moves.line[move]}`, layer));
      }
    }
    place += 1;
  }
  flush();
  return shapes;
}

/** The chords of a move that is no arc about one center, as where G2 ends beside its circle; its ends are its corners. */
function chordsOfMove(points, name, layer) {
  return points.slice(1).map((to, at) => ({
    ...lineShape(points[at], to, name, layer),
    ends: [...(at === 0 ? [points[0]] : []), ...(at + 2 === points.length ? [to] : [])],
  }));
}

/** Lines that lead on from each other as shapes. */
function arcsOfChords(chords, name, layer) {
  if (!chords.length) {
    return [];
  }
  const way = [chords[0].from, ...chords.map((chord) => chord.to)];
  const shapes = [];
  let place = 0;
  while (place < chords.length) {
    const last = endOfArc(way, place);
    if (last >= place + BLOCKS_OF_ARC) {
      const lines = `lines ${chords[place].line} to ${chords[last - 1].line}`;
      shapes.push(arcThrough(way.slice(place, last + 1), circleThrough(threeOf(way, place, last)), `${name}, ${lines}`, layer));
      place = last;
    } else {
      shapes.push(lineShape(way[place], way[place + 1], `${name}, line ${chords[place].line}`, layer));
      place += 1;
    }
  }
  return shapes;
}

/** The center of the arc that these points of a move lie on; null for lines. */
function centerOf(moves, move, points) {
  for (let at = move; at < moves.line.length && moves.line[at] === moves.line[move]; at += 1) {
    const center = moves.center[at];
    if (center !== null && center !== undefined) {
      const radii = points.map((point) => distanceOf(point, center));
      const most = Math.max(...radii);
      if (most > 0 && most - Math.min(...radii) <= ON_ARC) {
        return center;
      }
    }
  }
  return null;
}

/** The arc about a center from the first of points along all of them. */
function arcThrough(points, center, name, layer) {
  const angles = points.map((point) => Math.atan2(point[1] - center[1], point[0] - center[0]));
  const sweep = angles.slice(1).reduce((sum, angle, place) => sum + turnedTo(angles[place], angle), 0);
  const radius = points.reduce((sum, point) => sum + distanceOf(point, center), 0) / points.length;
  return arcShape(center, radius, angles[0], sweep, name, layer);
}

/** The turn from one angle to another one, from -pi to pi. */
function turnedTo(from, to) {
  const turn = (to - from) % (2 * Math.PI);
  return turn > Math.PI ? turn - 2 * Math.PI : turn < -Math.PI ? turn + 2 * Math.PI : turn;
}

/** The shapes of a ring of chords: where points lie on a circle, its arc. isClosed: the last point leads to the first. */
function shapesOfRing(ring, name, layer, isClosed = true) {
  const points = ring.filter((point, place) => place === 0 || distanceOf(point, ring[place - 1]) > 1e-9);
  if (points.length > 1 && distanceOf(points[0], points[points.length - 1]) <= 1e-9) {
    points.pop();
  }
  if (points.length < 2) {
    return [];
  }
  const from = isClosed ? firstCorner(points) : 0;
  const way = isClosed ? [...points.slice(from), ...points.slice(0, from + 1)] : points;
  const shapes = [];
  let place = 0;
  while (place + 1 < way.length) {
    const last = endOfArc(way, place);
    if (last > place + 2) {
      shapes.push(arcThrough(way.slice(place, last + 1), circleThrough(threeOf(way, place, last)), name, layer));
      place = last;
    } else {
      shapes.push(lineShape(way[place], way[place + 1], name, layer));
      place += 1;
    }
  }
  return shapes;
}

/** A point of a ring where it turns more than an arc does; 0 if it does so nowhere. */
function firstCorner(points) {
  const count = points.length;
  const found = points.findIndex((point, place) => {
    const before = minus(point, points[(place + count - 1) % count]);
    const after = minus(points[(place + 1) % count], point);
    return Math.abs(Math.atan2(cross(before, after), dot(before, after))) > ARC_TURN;
  });
  return Math.max(found, 0);
}

/** The last point up to which the points from a place on lie on one circle, with chords as an arc has them. */
function endOfArc(way, place) {
  let last = place + 1;
  const turnAt = (at) => {
    const [before, after] = [minus(way[at], way[at - 1]), minus(way[at + 1], way[at])];
    return Math.atan2(cross(before, after), dot(before, after));
  };
  const chord = (at) => distanceOf(way[at], way[at - 1]);
  // The line before an arc is no chord of it, nor is the line behind it.
  if (place + 2 >= way.length || chord(place + 1) > CHORDS * chord(place + 2)) {
    return last;
  }
  const longest = CHORDS * Math.max(chord(place + 1), chord(place + 2));
  const sense = Math.sign(turnAt(place + 1));
  while (last + 1 < way.length && chord(last + 1) <= longest && sense * turnAt(last) > 0 && Math.abs(turnAt(last)) <= ARC_TURN && isOneArc(way, place, last + 1)) {
    last += 1;
  }
  return last;
}

/** True if the points between two places lie on one circle; a few of them are looked at. */
function isOneArc(way, first, last) {
  const count = last - first;
  if (count < 3) {
    return true;
  }
  const center = circleThrough(threeOf(way, first, last));
  if (center === null) {
    return false;
  }
  const radius = distanceOf(way[first], center);
  const half = distanceOf(way[last], way[last - 1]) / 2;
  if (radius - Math.sqrt(Math.max(radius * radius - half * half, 0)) > Math.max(SAG_LEAST, SAG * radius)) {
    return false;
  }
  return [1, count >> 2, (3 * count) >> 2, count - 1].every(
    (at) => Math.abs(distanceOf(way[first + at], center) - radius) <= ON_CIRCLE_LEAST + ON_CIRCLE * radius,
  );
}

/** The first, a middle and the last point between two places; where these come near each other again, thirds. */
function threeOf(way, first, last) {
  const middle = (first + last) >> 1;
  if (distanceOf(way[first], way[last]) > distanceOf(way[first], way[middle])) {
    return [way[first], way[middle], way[last]];
  }
  const third = Math.floor((last - first) / 3);
  return [way[first], way[first + third], way[first + 2 * third]];
}

/** The center of the circle through three points; null if they lie on a line. */
function circleThrough([a, b, d]) {
  const [p, q] = [minus(b, a), minus(d, a)];
  const twice = 2 * cross(p, q);
  if (Math.abs(twice) <= 1e-9 * sizeOf(p) * sizeOf(q)) {
    return null;
  }
  const [pp, qq] = [dot(p, p), dot(q, q)];
  return [a[0] + (q[1] * pp - p[1] * qq) / twice, a[1] + (p[0] * qq - q[0] * pp) / twice];
}

/** The point of a shape that is nearest to a point. */
function nearestOn(shape, point) {
  if (shape.kind === "point") {
    return shape.at;
  }
  if (shape.kind === "line") {
    const way = minus(shape.to, shape.from);
    const share = dot(minus(point, shape.from), way) / (dot(way, way) || 1);
    const along = Math.min(Math.max(share, 0), 1);
    return [shape.from[0] + along * way[0], shape.from[1] + along * way[1]];
  }
  const angle = Math.atan2(point[1] - shape.center[1], point[0] - shape.center[0]);
  const along = (shape.sweep < 0 ? shape.start - angle : angle - shape.start) % (2 * Math.PI);
  if ((along < 0 ? along + 2 * Math.PI : along) <= Math.abs(shape.sweep) + 1e-9) {
    return onArc(shape, angle);
  }
  const ends = endsOf(shape);
  return distanceOf(point, ends[0]) <= distanceOf(point, ends[1]) ? ends[0] : ends[1];
}

/** The shape, with the box that it lies in: x, c of its lower and of its upper corner. */
function boxed(shape) {
  const points = shape.kind === "line" ? [shape.from, shape.to]
    : [-1, 1].map((side) => [shape.center[0] + side * shape.radius, shape.center[1] + side * shape.radius]);
  shape.box = [0, 1].flatMap((end) => [0, 1].map((axis) => Math[end ? "max" : "min"](points[0][axis], points[1][axis])));
  return shape;
}

/** What is nearest to a point within a reach [mm]: a point before a wall; of walls in one place the first. */
function nearestShape(points, walls, place, reach) {
  let found = null;
  let least = POINT_REACH * reach;
  for (const shape of points) {
    const away = Math.hypot(shape.at[0] - place[0], shape.at[1] - place[1]);
    if (away < least) {
      [found, least] = [shape, away];
    }
  }
  if (found !== null) {
    return { shape: found, at: found.at };
  }
  let at = place;
  least = reach;
  for (const shape of walls) {
    const { box } = shape;
    if (place[0] < box[0] - least || place[1] < box[1] - least || place[0] > box[2] + least || place[1] > box[3] + least) {
      continue;
    }
    const on = nearestOn(shape, place);
    const away = distanceOf(on, place);
    if (away < least - (found === null ? 0 : 0.01 * reach)) {
      [found, least, at] = [shape, away, on];
    }
  }
  return found === null ? null : { shape: found, at };
}
