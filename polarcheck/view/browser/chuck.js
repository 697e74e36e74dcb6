// ---- chuck: what turns with the part in the view of the machine, drawn once ----

function layerOf(see) {
  const canvas = document.createElement("canvas");
  canvas.width = Math.max(Math.round(see.width), 1);
  canvas.height = Math.max(Math.round(see.height), 1);
  const pen = canvas.getContext("2d");
  pen.translate(canvas.width / 2, canvas.height / 2);
  return { canvas, pen };
}

/** What turns with the part but is not cut: three jaws of the chuck, the degrees of C, and the mark of C0. */
function chuckLayer(see, bar, section, line, palette) {
  const { canvas, pen } = layerOf(see);
  const radius = bar.radius * see.scale;
  const zero = zeroOf(line);
  pen.save();
  // Math angles go up on the screen.
  pen.rotate(-zero);
  pen.fillStyle = palette.jaw;
  for (let jaw = 0; jaw < 3; jaw += 1) {
    pen.save();
    // Between the degrees that are written.
    pen.rotate((line.sense * -Math.PI) / 4 + (jaw * 2 * Math.PI) / 3);
    pen.globalAlpha = 0.55;
    pen.fillRect(radius * 1.01, -radius * 0.13, radius * 0.2, radius * 0.26);
    pen.restore();
  }
  pen.strokeStyle = palette.quiet;
  pen.fillStyle = palette.quiet;
  pen.lineWidth = Math.max(radius / 250, 1);
  if (section.radius === null) {
    // No layer of metal covers it.
    pen.setLineDash([radius / 30, radius / 30]);
    pen.beginPath();
    pen.arc(0, 0, radius, 0, 2 * Math.PI);
    pen.stroke();
    pen.setLineDash([]);
  }
  const ring = radius * 1.26;
  pen.beginPath();
  pen.arc(0, 0, ring, 0, 2 * Math.PI);
  pen.stroke();
  const font = Math.min(Math.max(radius * 0.065, 9), radius * 0.11);
  pen.font = `${font}px system-ui, sans-serif`;
  pen.textAlign = "center";
  pen.textBaseline = "middle";
  for (let degrees = 0; degrees < 360; degrees += 10) {
    const isLong = degrees % 30 === 0;
    pen.save();
    pen.rotate((-line.sense * degrees * Math.PI) / 180);
    pen.beginPath();
    pen.moveTo(ring, 0);
    pen.lineTo(ring - radius * (isLong ? 0.04 : 0.02), 0);
    pen.stroke();
    if (isLong && degrees) {
      pen.translate(ring - radius * 0.1, 0);
      pen.rotate(Math.PI / 2);
      pen.fillText(String(degrees), 0, 0);
    }
    pen.restore();
  }
  pen.fillStyle = palette.above;
  pen.beginPath();
  pen.moveTo(radius * 1.01, 0);
  pen.lineTo(ring, -radius * 0.05);
  pen.lineTo(ring, radius * 0.05);
  pen.fill();
  pen.translate(ring + font * 0.2, 0);
  pen.fillStyle = palette.ink;
  pen.font = `bold ${font * 1.15}px system-ui, sans-serif`;
  pen.textBaseline = "bottom";
  pen.rotate(Math.PI / 2);
  pen.fillText("C0", 0, 0);
  pen.restore();
  return canvas;
}

/** The direction on the part, as an angle on the plane, that lies on the X axis where the C axis is at 0 [rad]. */
function zeroOf(line) {
  const place = line.angle.findIndex((angle, number) => Number.isFinite(angle) && Math.hypot(line.x[number], line.c[number]) > AT_CENTER);
  return place < 0 ? 0 : line.turn[place] - (line.sense * line.angle[place] * Math.PI) / 180;
}

/** The programmed contour, and the axes of the program, which turn with the part. */
function pathLayer(see, section, palette) {
  const { canvas, pen } = layerOf(see);
  const { x, c } = section.programmed;
  pen.lineWidth = Math.max(see.width / 700, 1);
  pen.strokeStyle = palette.path;
  pen.beginPath();
  let isDown = false;
  x.forEach((value, place) => {
    if (value === null) {
      isDown = false;
      return;
    }
    const [across, up] = [value * see.scale, -c[place] * see.scale];
    if (isDown) {
      pen.lineTo(across, up);
    } else {
      pen.moveTo(across, up);
      isDown = true;
    }
  });
  pen.stroke();
  const long = see.width * 0.12;
  pen.lineWidth *= 1.5;
  pen.strokeStyle = palette.ink;
  pen.fillStyle = palette.ink;
  pen.font = `bold ${Math.max(see.width * 0.022, 10)}px system-ui, sans-serif`;
  pen.textAlign = "center";
  pen.textBaseline = "middle";
  for (const [name, across, up] of [["X", 1, 0], ["C", 0, -1]]) {
    pen.beginPath();
    pen.moveTo(0, 0);
    pen.lineTo(across * long, up * long);
    pen.lineTo((across * 0.88 - up * 0.05) * long, (up * 0.88 + across * 0.05) * long);
    pen.moveTo(across * long, up * long);
    pen.lineTo((across * 0.88 + up * 0.05) * long, (up * 0.88 - across * 0.05) * long);
    pen.stroke();
    pen.fillText(name, across * long * 1.2, up * long * 1.2);
  }
  return canvas;
}
