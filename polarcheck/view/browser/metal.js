// ---- metal: what stands of the bar at each moment, drawn as the cutter sweeps over it ----

/** Intervals that are swept in one frame, at most: what is behind follows in the next frames. */
const SWEPT_PER_FRAME = 600;
/** Intervals of one stroke of the pen. */
const PER_STROKE = 120;
/** Pictures of earlier moments that are stored, so that going back begins near by. */
const STORED = 8;
/** A tip less far below the face than this cuts nothing [mm]. */
const CLEARANCE = 0.01;
/** Pixels of a layer along each side, at most. */
const MOST_PIXELS = 1100;

/** The radius of the bar, and whether it is known or only what the tool reaches [mm]. */
function barOf(section, line) {
  const face = faceOf(section);
  let reach = 0;
  for (const ring of section.bar) {
    ring.forEach(([x, c]) => {
      reach = Math.max(reach, Math.hypot(x, c));
    });
  }
  reach = reach || (section.stock || 0) / 2;
  if (reach > 0) {
    return { radius: reach, isKnown: true };
  }
  const { role } = section.moves;
  const cuts = ["cut", "corner", "unknown"].some((name) => role.includes(name)) ? ["cut", "corner", "unknown"] : ["start up", "cancel", "positioning"];
  for (let place = 1; place < line.count; place += 1) {
    if (cutsAt(section, line, place, face) && cuts.includes(role[line.move[place]])) {
      reach = Math.max(reach, Math.hypot(line.x[place], line.c[place]));
    }
  }
  for (const part of section.parts.filter((each) => each.known_outside)) {
    part.polygons.forEach((polygon) => polygon[0].forEach(([x, c]) => {
      reach = Math.max(reach, Math.hypot(x, c));
    }));
  }
  return { radius: (reach || 10) * 1.02, isKnown: false };
}

/**
 * Z of the face of the bar [mm]: where nothing says another one Z0 or, if no move goes below, the highest Z; Infinity
 * if all moves have one Z, so that it does not say which of them cut.
 */
function faceOf(section) {
  if (typeof section.face === "number") {
    return section.face;
  }
  let [lowest, highest] = [Infinity, -Infinity];
  for (const z of section.moves.z.flat()) {
    if (z !== null) {
      lowest = Math.min(lowest, z);
      highest = Math.max(highest, z);
    }
  }
  if (lowest < -CLEARANCE) {
    return 0;
  }
  return lowest < highest - CLEARANCE ? highest : Infinity;
}

/** True where metal is taken in the interval that ends at a point; where Z does not say it, by the role of the move. */
function cutsAt(section, line, place, face) {
  const z = Math.min(line.z[place - 1], line.z[place]);
  return Number.isFinite(z) && Number.isFinite(face) ? z < face - CLEARANCE : section.moves.role[line.move[place]] !== "positioning";
}

/** The depths of cut, from the face down, at most six of them; what is deeper is darker. */
function shadeOf(z, face, deepest, palette) {
  const depth = Number.isFinite(face) && deepest < face && z <= face ? Math.min((face - z) / (face - deepest), 1) : 1;
  return palette.floors[Math.min(Math.floor(depth * palette.floors.length), palette.floors.length - 1)];
}

/**
 * A layer with the metal that stands, in the frame of the part.
 *
 * see: {middle: [x, c], scale: pixels per mm, width, height} of the layer. A floor shows how deep a cut is; without
 * floors what is cut is gone. paint(play) brings the layer to a time on the slider and returns true once it is there.
 */
function metalLayer(section, line, see, palette, hasFloors) {
  const canvas = document.createElement("canvas");
  canvas.width = Math.max(Math.round(see.width), 1);
  canvas.height = Math.max(Math.round(see.height), 1);
  const pen = canvas.getContext("2d");
  const bar = barOf(section, line);
  const face = faceOf(section);
  const deepest = line.z.reduce((least, z) => (z < least ? z : least), Infinity);
  const stored = [];
  let swept = 0;
  let place = 1;

  const left = (x) => canvas.width / 2 + (x - see.middle[0]) * see.scale;
  const top = (c) => canvas.height / 2 - (c - see.middle[1]) * see.scale;

  function restart() {
    pen.globalCompositeOperation = "source-over";
    pen.clearRect(0, 0, canvas.width, canvas.height);
    pen.fillStyle = palette.metal;
    pen.fillRect(0, 0, canvas.width, canvas.height);
    swept = 0;
    place = 1;
  }

  function goBack(play) {
    const nearest = stored.filter((each) => each.swept <= play).at(-1);
    restart();
    if (nearest) {
      pen.clearRect(0, 0, canvas.width, canvas.height);
      pen.drawImage(nearest.copy, 0, 0);
      ({ swept, place } = nearest);
    }
  }

  function stroke(shade) {
    pen.strokeStyle = shade;
    pen.stroke();
  }

  /** Sweep on to a time, over `most` intervals; return how many they were. */
  function sweep(play, most) {
    pen.globalCompositeOperation = hasFloors ? "darken" : "destination-out";
    pen.lineWidth = 2 * section.radius * see.scale;
    let shade = null;
    let inStroke = 0;
    let done = 0;
    for (; place < line.count && swept < play && done < most; done += 1) {
      const [begin, end] = [line.play[place - 1], line.play[place]];
      const to = Math.min(play, end);
      const z = Math.min(line.z[place - 1], line.z[place]);
      const next = cutsAt(section, line, place, face) ? shadeOf(z, face, deepest, palette) : null;
      if (shade !== null && (next !== shade || inStroke >= PER_STROKE)) {
        stroke(shade);
        shade = null;
      }
      if (next !== null) {
        if (shade === null) {
          pen.beginPath();
          pen.moveTo(...pointAt(Math.max(swept, begin)));
          shade = next;
          inStroke = 0;
        }
        const [x, y] = pointAt(to);
        // A stroke without length draws nothing.
        pen.lineTo(x + 0.01, y);
        inStroke += 1;
      }
      swept = Math.max(to, swept);
      if (end <= play) {
        place += 1;
      }
    }
    if (shade !== null) {
      stroke(shade);
    }
    return done;
  }

  function pointAt(play) {
    const [begin, end] = [line.play[place - 1], line.play[place]];
    const share = end > begin ? (play - begin) / (end - begin) : 1;
    return [
      left(line.x[place - 1] + share * (line.x[place] - line.x[place - 1])),
      top(line.c[place - 1] + share * (line.c[place] - line.c[place - 1])),
    ];
  }

  function paint(play) {
    if (play < swept) {
      goBack(play);
    }
    const step = line.length / STORED;
    let room = SWEPT_PER_FRAME;
    while (swept < play && place < line.count && room > 0) {
      // A copy is stored at even times, so that the sweep rests there.
      const due = step * (Math.floor(swept / step + 1e-9) + 1);
      room -= Math.max(sweep(Math.min(play, due), room), 1);
      if (swept >= due && !stored.some((each) => Math.abs(each.swept - swept) < step / 2)) {
        stored.push({ copy: copyOf(canvas), swept, place });
        stored.sort((one, other) => one.swept - other.swept);
      }
    }
    return swept >= play || place >= line.count;
  }

  // Nothing is drawn beyond the bar.
  pen.clip(outlineOf(section, bar, left, top, see.scale), "evenodd");
  pen.lineCap = "round";
  pen.lineJoin = "round";
  restart();
  return { canvas, see, paint };
}

/** The outline of the bar in pixels, its bore included. */
function outlineOf(section, bar, left, top, scale) {
  const outline = new Path2D();
  for (const ring of section.bar) {
    ring.forEach(([x, c], place) => (place ? outline.lineTo(left(x), top(c)) : outline.moveTo(left(x), top(c))));
    outline.closePath();
  }
  if (!section.bar.length) {
    outline.arc(left(0), top(0), bar.radius * scale, 0, 2 * Math.PI);
  }
  return outline;
}

function copyOf(canvas) {
  const copy = document.createElement("canvas");
  copy.width = canvas.width;
  copy.height = canvas.height;
  copy.getContext("2d").drawImage(canvas, 0, 0);
  return copy;
}
