// ---- canvas: what moves on the view onto the face, drawn over the plot ----

/** How much of the metal covers the plot below it. */
const METAL_OVER_FACE = 0.42;

/** The canvas over the face, of which it covers the plot: draw(moment, hasMetal) draws one moment and returns false while metal is behind. */
function faceCanvas(canvas, face, section, line, plane) {
  let metal = null;
  let palette = null;
  let seen = "";

  /** The part of the plane in sight, in pixels of the canvas. */
  function fit() {
    const ratio = Math.min(window.devicePixelRatio || 1, 2);
    const { left, top, width, height } = plane;
    const now = [left, top, width, height, ratio, plane.scale, ...plane.toPx(0, 0)].join(" ");
    if (now === seen) {
      return ratio;
    }
    seen = now;
    Object.assign(canvas.style, { left: `${face.offsetLeft + left}px`, top: `${face.offsetTop + top}px`, width: `${width}px`, height: `${height}px` });
    canvas.width = Math.round(width * ratio);
    canvas.height = Math.round(height * ratio);
    palette = canvasColors();
    metal = null;
    return ratio;
  }

  function layer(ratio) {
    if (metal === null && section.radius !== null) {
      const [zeroX, zeroY] = plane.toPx(0, 0);
      const shrink = Math.min(1, MOST_PIXELS / (Math.max(plane.width, plane.height) * ratio)) * ratio;
      const middle = [(plane.left + plane.width / 2 - zeroX) / plane.scale, (zeroY - plane.top - plane.height / 2) / plane.scale];
      const see = { middle, scale: plane.scale * shrink, width: plane.width * shrink, height: plane.height * shrink };
      metal = metalLayer(section, line, see, palette, false);
    }
    return metal;
  }

  function clear() {
    canvas.getContext("2d").clearRect(0, 0, canvas.width, canvas.height);
    canvas.hidden = true;
  }

  function draw(moment, hasMetal) {
    if (!(plane.width > 0)) {
      return true;
    }
    canvas.hidden = false;
    const ratio = fit();
    const pen = canvas.getContext("2d");
    pen.setTransform(ratio, 0, 0, ratio, 0, 0);
    pen.clearRect(0, 0, plane.width, plane.height);
    const swept = hasMetal ? layer(ratio) : null;
    const isDone = swept === null || swept.paint(moment.play);
    if (swept !== null) {
      pen.globalAlpha = METAL_OVER_FACE;
      pen.drawImage(swept.canvas, 0, 0, plane.width, plane.height);
      pen.globalAlpha = 1;
    }
    const at = (x, c) => {
      const [across, down] = plane.toPx(x, c);
      return [across - plane.left, down - plane.top];
    };
    drawBlock(pen, moment, at);
    if (Number.isFinite(moment.x) && Number.isFinite(moment.c)) {
      const [x, y] = at(moment.x, moment.c);
      pen.strokeStyle = palette.quiet;
      pen.lineWidth = 1;
      pen.setLineDash([5, 4]);
      pen.beginPath();
      pen.moveTo(...at(0, 0));
      pen.lineTo(x, y);
      pen.stroke();
      pen.setLineDash([]);
      drawTool(pen, x, y, section.radius === null ? null : section.radius * plane.scale, palette);
    }
    return isDone;
  }

  /** The path of the move that runs. */
  function drawBlock(pen, moment, at) {
    pen.strokeStyle = palette.tool;
    pen.lineWidth = 4;
    pen.beginPath();
    let first = moment.place;
    while (first > 1 && line.move[first - 1] === moment.move) {
      first -= 1;
    }
    for (let place = Math.max(first, 1); place < line.count && line.move[place] === moment.move; place += 1) {
      pen.moveTo(...at(line.x[place - 1], line.c[place - 1]));
      pen.lineTo(...at(line.x[place], line.c[place]));
    }
    pen.stroke();
  }

  return { draw, clear, refit: () => { seen = ""; } };
}
