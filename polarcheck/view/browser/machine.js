// ---- machine: the view along the spindle; the part turns about C, and the cutter stands on the X axis ----

/** Points of the path behind the cutter that are drawn by their rate of C. */
const TAIL = 160;
/** The radius of the view, as a share of the radius of the bar: room for jaws and the ring of degrees. */
const ROOM = 1.42;
/** The cutter is drawn up to so many radii of the bar from the center. */
const FARTHEST = 2;

/** The colors of the canvases, from the style of the page. */
function canvasColors() {
  const names = ["ink", "quiet", "paper", "metal", "jaw", "tool", "above", "calm", "path"];
  const floors = [1, 2, 3, 4, 5, 6].map((number) => color(`--floor-${number}`));
  return { ...Object.fromEntries(names.map((name) => [name, color(`--${name}`)])), floors };
}

/** A canvas of its own size in pixels of the screen, with its pen. */
function fitted(canvas) {
  const ratio = Math.min(window.devicePixelRatio || 1, 2);
  const [width, height] = [canvas.clientWidth, canvas.clientHeight];
  if (canvas.width !== Math.round(width * ratio) || canvas.height !== Math.round(height * ratio)) {
    canvas.width = Math.round(width * ratio);
    canvas.height = Math.round(height * ratio);
  }
  return { ratio, width, height };
}

/** The view as the machine does it: draw(moment) draws one moment and returns false while metal is behind. */
function machineView(canvas, section, line) {
  const units = unitsOf(section);
  const bar = barOf(section, line);
  let size = null;
  let palette = null;
  let body = null;
  let metal = null;
  let path = null;
  const highest = line.cFeed.reduce((most, rate) => (Math.abs(rate) > most ? Math.abs(rate) : most), 0);
  const [least, most] = line.machineX.reduce(([low, high], x) => [x < low ? x : low, x > high ? x : high], [0, 0]);

  /** Fit the view into its canvas; layers are drawn again. */
  function fit() {
    const next = fitted(canvas);
    palette = canvasColors();
    const room = ROOM * bar.radius;
    const cutter = section.radius || 0;
    const farthest = FARTHEST * bar.radius;
    const right = Math.max(room, Math.min(most + cutter, farthest));
    const left = Math.max(room, Math.min(cutter - least, farthest));
    const scale = Math.max(Math.min((next.width - 16) / (left + right), (next.height - 40) / (2 * room)), 1e-3);
    size = { ...next, scale, x: 8 + (next.width - 16 - scale * (left + right)) / 2 + left * scale, y: 8 + (next.height - 40) / 2 };
    const across = Math.min(2 * room * scale * next.ratio, MOST_PIXELS);
    const see = { middle: [0, 0], scale: across / (2 * room), width: across, height: across };
    metal = section.radius === null ? null : metalLayer(section, line, see, palette, true);
    body = chuckLayer(see, bar, section, line, palette);
    path = pathLayer(see, section, palette);
  }

  function draw(moment) {
    if (canvas.clientWidth === 0) {
      return true;
    }
    if (!size || size.width !== canvas.clientWidth || size.height !== canvas.clientHeight) {
      fit();
    }
    const isDone = metal === null || metal.paint(moment.play);
    const pen = canvas.getContext("2d");
    pen.setTransform(size.ratio, 0, 0, size.ratio, 0, 0);
    pen.clearRect(0, 0, size.width, size.height);
    pen.save();
    pen.translate(size.x, size.y);
    pen.save();
    pen.rotate(moment.turn || 0);
    const half = ROOM * bar.radius * size.scale;
    for (const layer of metal === null ? [body, path] : [body, metal.canvas, path]) {
      pen.drawImage(layer, -half, -half, 2 * half, 2 * half);
    }
    drawTail(pen, moment);
    pen.restore();
    drawAxis(pen);
    drawRotation(pen, moment);
    drawCutter(pen, moment);
    pen.restore();
    return isDone;
  }

  /** The last of the path, in the frame of the part: wider and in the color of the limit where C is too fast. */
  function drawTail(pen, moment) {
    if (!(moment.place >= 1)) {
      return;
    }
    const limit = section.c_limit === null ? highest : section.c_limit;
    const first = Math.max(moment.place - TAIL, 1);
    pen.lineCap = "round";
    for (let place = first; place <= moment.place; place += 1) {
      if (section.moves.role[line.move[place]] === "positioning" || line.kind[place] === JUMP) {
        continue;
      }
      const isLast = place === moment.place;
      const share = Math.abs(line.cFeed[place]) / limit;
      pen.globalAlpha = 0.25 + (0.75 * (place - first + 1)) / (moment.place - first + 1);
      pen.strokeStyle = share > 1 + 1e-9 ? palette.above : palette.calm;
      pen.lineWidth = share > 1 + 1e-9 ? 5 : 1.5 + 2.5 * Math.min(share || 0, 1);
      pen.beginPath();
      pen.moveTo(line.x[place - 1] * size.scale, -line.c[place - 1] * size.scale);
      pen.lineTo((isLast ? moment.x : line.x[place]) * size.scale, -(isLast ? moment.c : line.c[place]) * size.scale);
      pen.stroke();
    }
    pen.globalAlpha = 1;
  }

  /** The X axis with its scale; it stands still. */
  function drawAxis(pen) {
    const from = least < 0 ? -size.x + 8 : 0;
    const to = most > 0 || least === 0 ? size.width - size.x - 8 : 0;
    pen.strokeStyle = palette.ink;
    pen.fillStyle = palette.ink;
    pen.lineWidth = 1;
    pen.beginPath();
    pen.moveTo(from, 0);
    pen.lineTo(to, 0);
    pen.moveTo(0, -9);
    pen.lineTo(0, 9);
    pen.moveTo(-9, 0);
    pen.lineTo(9, 0);
    const step = tickStep(units.x(60 / size.scale)) / units.x(1);
    pen.font = "11px system-ui, sans-serif";
    pen.textAlign = "center";
    pen.textBaseline = "top";
    const ticks = [];
    for (let number = Math.ceil(from / size.scale / step); number * step * size.scale <= to; number += 1) {
      const x = number * step * size.scale;
      pen.moveTo(x, -4);
      pen.lineTo(x, 4);
      ticks.push([x, String(Number(units.x(number * step).toFixed(6)))]);
    }
    pen.stroke();
    for (const [x, text] of ticks) {
      outlined(pen, text, x, 7, palette);
    }
    const isRight = to > 0;
    pen.textAlign = isRight ? "right" : "left";
    pen.textBaseline = "bottom";
    outlined(pen, `X axis [${units.name}${section.diameter ? ", diameter" : ""}]`, isRight ? to : from, -Math.max((section.radius || 0) * size.scale, 6) - 4, palette);
  }

  /** An arrow about the bar in the sense in which the part turns, as long as its rate is high. */
  function drawRotation(pen, moment) {
    const isJump = moment.kind === JUMP;
    const limit = section.c_limit === null ? highest : section.c_limit;
    const share = isJump ? Infinity : Math.abs(moment.cFeed) / limit;
    if (!(share > 0.002)) {
      return;
    }
    const way = Math.sign((isJump ? line.turn[moment.place] - line.turn[moment.place - 1] : moment.cFeed * line.sense) || 1);
    const radius = (ROOM - 0.06) * bar.radius * size.scale;
    const from = -Math.PI / 2 - (way * Math.PI) / 9;
    const to = from + way * Math.min(0.08 + Math.sqrt(share) * 1.3, 2.6);
    pen.strokeStyle = share > 1 + 1e-9 ? palette.above : palette.calm;
    pen.fillStyle = pen.strokeStyle;
    pen.lineWidth = share > 1 + 1e-9 ? 6 : 4;
    pen.lineCap = "butt";
    pen.beginPath();
    pen.arc(0, 0, radius, from, to, way < 0);
    pen.stroke();
    pen.save();
    pen.translate(radius * Math.cos(to), radius * Math.sin(to));
    pen.rotate(to + (way > 0 ? Math.PI / 2 : -Math.PI / 2));
    pen.beginPath();
    pen.moveTo(11, 0);
    pen.lineTo(-2, -7);
    pen.lineTo(-2, 7);
    pen.fill();
    pen.restore();
  }

  function drawCutter(pen, moment) {
    if (!Number.isFinite(moment.machineX)) {
      return;
    }
    const x = moment.machineX * size.scale;
    const shown = Math.min(Math.max(x, 20 - size.x), size.width - size.x - 20);
    drawTool(pen, shown, 0, section.radius === null ? null : section.radius * size.scale, palette);
    const text = `X${units.length(moment.machineX * (section.diameter ? 2 : 1))}`;
    pen.font = "bold 12px system-ui, sans-serif";
    pen.textAlign = "center";
    pen.textBaseline = "top";
    const wide = pen.measureText(text).width / 2;
    const middle = Math.min(Math.max(shown, wide + 4 - size.x), size.width - size.x - wide - 4);
    pen.fillStyle = palette.ink;
    outlined(pen, text, middle, Math.min((section.radius || 0) * size.scale + 6, size.height - size.y - 16), palette);
  }

  return { draw, refit: () => { size = null; } };
}

/** Text that can be read over lines. */
function outlined(pen, text, x, y, palette) {
  pen.save();
  pen.strokeStyle = palette.paper;
  pen.lineWidth = 3;
  pen.lineJoin = "round";
  pen.strokeText(text, x, y);
  pen.restore();
  pen.fillText(text, x, y);
}

/** The cutter as a disk with its center; without R the center alone. */
function drawTool(pen, x, y, radius, palette) {
  pen.strokeStyle = palette.ink;
  pen.lineWidth = 1.5;
  if (radius !== null) {
    pen.globalAlpha = 0.8;
    pen.fillStyle = palette.tool;
    pen.beginPath();
    pen.arc(x, y, radius, 0, 2 * Math.PI);
    pen.fill();
    pen.globalAlpha = 1;
    pen.stroke();
  }
  const arm = radius === null ? 8 : Math.min(Math.max(radius / 2, 3), 8);
  pen.beginPath();
  pen.moveTo(x - arm, y);
  pen.lineTo(x + arm, y);
  pen.moveTo(x, y - arm);
  pen.lineTo(x, y + arm);
  pen.stroke();
  pen.fillStyle = palette.ink;
  pen.beginPath();
  pen.arc(x, y, radius === null ? 4 : 2, 0, 2 * Math.PI);
  pen.fill();
}

/** A round step of a scale, at least as long as `least`. */
function tickStep(least) {
  const power = 10 ** Math.floor(Math.log10(least));
  return [1, 2, 5, 10].map((factor) => factor * power).find((step) => step >= least);
}
