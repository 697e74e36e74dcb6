// ---- plane: where points of the polar plane stand in the drawing of the face ----

/**
 * The plane of a face that is drawn: left, top, width, height of the plot [px, from the corner of the element of the
 * face]; scale [px per mm]; toPx(x, c) of a point [mm] and toPlane(px, py) back; onChange(view): view() is called after
 * each zoom, drag and change of size. The values are those of the moment at which they are read.
 */
function planeTransform(face) {
  const section = face.ofSection;
  const units = unitsOf(section);
  const [perX, perC] = [units.x(1), units.c(1)];
  const axes = () => face._fullLayout;
  return {
    get left() { return axes().xaxis._offset; },
    get top() { return axes().yaxis._offset; },
    get width() { return axes().xaxis._length; },
    get height() { return axes().yaxis._length; },
    get scale() { return perC * Math.abs(axes().yaxis.l2p(1) - axes().yaxis.l2p(0)); },
    toPx: (x, c) => {
      const { xaxis, yaxis } = axes();
      return [xaxis._offset + xaxis.l2p(x * perX), yaxis._offset + yaxis.l2p(c * perC)];
    },
    toPlane: (px, py) => {
      const { xaxis, yaxis } = axes();
      return [xaxis.p2l(px - xaxis._offset) / perX, yaxis.p2l(py - yaxis._offset) / perC];
    },
    onChange: (view) => {
      face.on("plotly_afterplot", view);
      face.on("plotly_relayouting", view);
    },
  };
}
