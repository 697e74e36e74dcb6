// ---- timeline: where the tool and the axes are at each moment of a section ----

/** Kinds of intervals: of known time; of a move whose time is not known; the turn of C at once at the center. */
const STEADY = 0;
const ASSUMED = 1;
const JUMP = 2;
/** The rate at which a move is shown whose time and F are not known [mm/s], and the bounds of its duration [s]. */
const SHOWN_RATE = 60;
const SHORTEST_SHOWN = 0.15;
const LONGEST_SHOWN = 20;
/** How long the turn of C at the center is shown [s]; at the machine it would take no time. */
const JUMP_SHOWN = 1.5;
/** A place nearer to the center than this has no direction [mm]. */
const AT_CENTER = 1e-6;

/**
 * The points of a section in the order of time, as columns of numbers; NaN is unknown.
 *
 * play: the time on the slider [s]: that of the machine, and the intervals that are shown longer or whose time is not
 * known. time: that of the machine [s]. x, c: the tool center on the plane [mm]. z, machineX [mm]. angle: of the C axis
 * [deg]. turn: of the tool about the center, as seen from the part [rad]. sense: 1 where C rises as the tool goes
 * counterclockwise about the center, else -1. cFeed [deg/min]. xFeed, feed [mm/min]. move: in the table of moves. kind:
 * of the interval that ends at the point.
 */
function timelineOf(section) {
  const rows = pointsInTime(section);
  const count = rows.length;
  const line = { count, move: new Int32Array(count), kind: new Uint8Array(count), turn: new Float64Array(count), sense: section.sense };
  for (const name of ["play", "time", "x", "c", "z", "angle", "machineX", "cFeed", "xFeed", "feed"]) {
    line[name] = Float64Array.from(rows, (row) => (row[name] === null || row[name] === undefined ? NaN : row[name]));
  }
  rows.forEach((row, place) => {
    line.move[place] = row.move;
    line.kind[place] = row.kind;
  });
  fillTurns(line, section.entry_known ? section.entry : NaN);
  line.length = count ? line.play[count - 1] : 0;
  line.duration = count ? line.time[count - 1] : 0;
  line.isAssumed = line.kind.includes(ASSUMED);
  return line;
}

/** The points of the rates, and between them those of moves whose time is not known. */
function pointsInTime(section) {
  const { rates, moves } = section;
  const rows = [];
  const along = pathOfMoves(section);
  let place = 0;
  let shift = 0;
  const pushRate = () => {
    const row = {
      play: rates.t[place] + shift, time: rates.t[place], x: rates.x[place], c: rates.c[place], z: rates.z[place],
      angle: rates.angle[place], machineX: rates.machine_x[place], cFeed: rates.c_feed[place], xFeed: rates.x_feed[place],
      feed: rates.feed[place], move: rates.move[place], kind: STEADY,
    };
    if (row.x !== null && row.c !== null) {
      if (isJump(rows.at(-1), row)) {
        shift += JUMP_SHOWN;
        row.play += JUMP_SHOWN;
        row.kind = JUMP;
      }
      rows.push(row);
    }
    place += 1;
  };
  for (let move = 0; move < moves.line.length; move += 1) {
    while (place < rates.t.length && (rates.t[place] === null || rates.move[place] < move)) {
      place += 1;
    }
    if (rates.move[place] === move) {
      while (place < rates.t.length && (rates.t[place] === null || rates.move[place] === move)) {
        if (rates.t[place] === null) {
          place += 1;
        } else {
          pushRate();
        }
      }
    } else if (moves.time[move] === null) {
      const before = rows.length ? rows.at(-1).play : 0;
      rows.push(...assumedRows(section, move, along.get(move), rows.at(-1)));
      shift += rows.length ? rows.at(-1).play - before : 0;
    }
  }
  return rows;
}

/** True where C turns at once: between two points at one time, at the center. */
function isJump(before, row) {
  return Boolean(before) && row.time - before.time < 1e-9 && Math.hypot(row.x - before.x, row.c - before.c) < 0.01 &&
    before.angle !== null && row.angle !== null && Math.abs(row.angle - before.angle) > 90;
}

/** The points of the drawn path of each move of unknown time: that of the tool or, without it, the programmed one. */
function pathOfMoves(section) {
  const paths = new Map();
  for (const path of [section.programmed, section.tool]) {
    const found = new Map();
    path.x.forEach((x, place) => {
      const move = path.move[place];
      if (x !== null && move !== null && section.moves.time[move] === null) {
        if (!found.has(move)) {
          found.set(move, []);
        }
        found.get(move).push([x, path.c[place]]);
      }
    });
    found.forEach((points, move) => paths.set(move, points));
  }
  return paths;
}

/** The points of a move whose time is not known: along its path at its F, and without F at a rate of this page. */
function assumedRows(section, move, path = [], before) {
  const { moves } = section;
  const isKnown = (point) => point[0] !== null && point[1] !== null;
  const points = [moves.start[move], ...path, moves.end[move]].filter(isKnown);
  if (!points.length) {
    return [];
  }
  const [from, to] = moves.z[move];
  let length = 0;
  const reached = points.map((point, place) => {
    const last = points[Math.max(place - 1, 0)];
    length += Math.hypot(point[0] - last[0], point[1] - last[1]);
    return length;
  });
  const rise = from === null || to === null ? 0 : Math.abs(to - from);
  const feed = moves.role[move] === "positioning" ? null : moves.feed[move];
  const rate = feed ? feed / 60 : SHOWN_RATE;
  const seconds = Math.min(Math.max(Math.max(length, rise) / rate, SHORTEST_SHOWN), LONGEST_SHOWN);
  const begin = before ? before.play : 0;
  return points.map(([x, c], place) => {
    const share = length ? reached[place] / length : place / Math.max(points.length - 1, 1);
    return {
      play: begin + share * seconds, time: before ? before.time : 0, x, c, z: from === null || to === null ? to : from + share * (to - from),
      angle: null, machineX: null, cFeed: null, xFeed: null, feed: moves.feed[move], move, kind: ASSUMED,
    };
  });
}

/**
 * Fill the turn of the tool about the center. It follows from the place on the plane and, where that is the center,
 * from the angle of C. Where the axes are not known, they are continued along the path. entry: C where the tool is on
 * the x of the plane [deg].
 */
function fillTurns(line, entry) {
  const { count, x, c, angle, machineX, turn } = line;
  const { sense } = line;
  let before = 0;
  let lastAngle = NaN;
  let side = 1;
  for (let place = 0; place < count; place += 1) {
    const away = Math.hypot(x[place], c[place]);
    side = machineX[place] < 0 ? -1 : machineX[place] > 0 ? 1 : side;
    const turned = (sense * (angle[place] - lastAngle) * Math.PI) / 180;
    const expected = before + (Number.isFinite(turned) ? turned : 0);
    turn[place] = away < AT_CENTER ? expected : nearestTurn(Math.atan2(c[place] * side, x[place] * side), expected);
    if (Number.isNaN(machineX[place])) {
      machineX[place] = side * away;
    }
    if (Number.isNaN(angle[place])) {
      const [from, since] = Number.isNaN(lastAngle) ? [entry, 0] : [lastAngle, before];
      angle[place] = from + (sense * (turn[place] - since) * 180) / Math.PI;
    }
    lastAngle = angle[place];
    before = turn[place];
  }
}

/** An angle with the whole turns that bring it nearest to another one [rad]. */
function nearestTurn(value, to) {
  return value + 2 * Math.PI * Math.round((to - value) / (2 * Math.PI));
}

/** The first number from low to high whose value in a rising column is not below this one; high where none is. */
function firstFrom(column, value, low, high) {
  while (low < high) {
    const middle = (low + high) >> 1;
    if (column[middle] >= value) {
      high = middle;
    } else {
      low = middle + 1;
    }
  }
  return low;
}

/** The number of the point that ends the interval with this time on the slider, at least 1. */
function intervalAt(line, play, guess = 1) {
  if (guess >= 1 && guess < line.count && line.play[guess - 1] < play && play <= line.play[guess]) {
    return guess;
  }
  return firstFrom(line.play, play, 1, line.count - 1);
}

/** The time on the slider at a time of the machine. */
function playAtTime(line, time) {
  const low = firstFrom(line.time, time, 0, line.count - 1);
  const before = Math.max(low - 1, 0);
  const span = line.time[low] - line.time[before];
  const share = span > 0 ? Math.min(Math.max((time - line.time[before]) / span, 0), 1) : 1;
  return line.play[before] + share * (line.play[low] - line.play[before]);
}

/** The time on the slider at the end of a move; of a move that is not on it, at the end of the one before. */
function playAtEndOf(line, move) {
  let low = 0;
  let high = line.count;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (line.move[middle] > move) {
      high = middle;
    } else {
      low = middle + 1;
    }
  }
  return low ? line.play[low - 1] : 0;
}

/** Write into `moment` what holds at a time on the slider. */
function momentAt(line, play, moment) {
  if (line.count < 2) {
    moment.place = 0;
    moment.move = line.count ? line.move[0] : -1;
    return moment;
  }
  const place = intervalAt(line, play, moment.place);
  const span = line.play[place] - line.play[place - 1];
  const share = span > 0 ? Math.min(Math.max((play - line.play[place - 1]) / span, 0), 1) : 1;
  for (const name of ["time", "x", "c", "z", "angle", "machineX", "turn", "cFeed", "xFeed", "feed"]) {
    const [from, to] = [line[name][place - 1], line[name][place]];
    moment[name] = from === to ? to : from + share * (to - from);
  }
  const isSameMove = line.move[place - 1] === line.move[place];
  if (!isSameMove || Number.isNaN(moment.cFeed)) {
    // Rates jump from one move to the next.
    for (const name of ["cFeed", "xFeed", "feed"]) {
      moment[name] = share < 1 && isSameMove ? line[name][place - 1] : line[name][place];
    }
  }
  Object.assign(moment, { place, play, share, move: line.move[place], kind: line.kind[place] });
  return moment;
}
