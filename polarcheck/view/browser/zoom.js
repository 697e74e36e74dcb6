// ---- zoom: the wheel, two fingers, dragging and keys on the face ----

/** A key zooms by this factor, and moves by this share of the window. */
const ZOOM_STEP = 1.5;
const MOVE_STEP = 0.2;
/** The least and the largest window [mm]. */
const WINDOW = [1e-3, 1e5];

/** Calls a function once a view of a section is drawn. */
function whenDrawn(view, act) {
  if (view.isDrawn()) {
    act();
    return;
  }
  const watch = new MutationObserver(() => {
    if (view.face._fullLayout && view.face.on) {
      watch.disconnect();
      act();
    }
  });
  watch.observe(view.face, { childList: true, subtree: true });
}

/** The window of a face as ranges of its axes, moved by [px] and scaled about a point [px from the corner of the face]. */
function windowOf(view, [dx, dy], factor = 1, about = null) {
  const { xaxis, yaxis } = view.face._fullLayout;
  const [px, py] = about === null ? [xaxis._offset + xaxis._length / 2, yaxis._offset + yaxis._length / 2] : about;
  const range = (axis, at, moved) => [0, axis._length].map((end) => {
    const place = at - axis._offset;
    return axis.p2r(place + (end - place) / factor + moved);
  });
  const [left, right] = range(xaxis, px, dx);
  // The vertical axis counts pixels from its top.
  const [top, bottom] = range(yaxis, py, dy);
  return { "xaxis.range": [left, right], "yaxis.range": [bottom, top] };
}

function moveWindow(view, way) {
  return Plotly.relayout(view.face, windowOf(view, way));
}

function zoomWindow(view, factor, about = null) {
  const plane = planeTransform(view.face);
  const size = plane.width / plane.scale / factor;
  if (size >= WINDOW[0] && size <= WINDOW[1]) {
    Plotly.relayout(view.face, windowOf(view, [0, 0], factor, about));
  }
}

/** Zoom of all faces of a program. */
function zoomView(sections) {
  sections.views.forEach((view) => {
    whenDrawn(view, () => view.face.on("plotly_doubleclick", () => !view.face.classList.contains("is-measuring") && view.whole()));
    pinched(view);
  });
  const act = (change) => () => {
    const view = sections.shown();
    if (view) {
      view.draw();
      change(view, planeTransform(view.face));
    }
  };
  const move = (dx, dy) => act((view, plane) => moveWindow(view, [dx * MOVE_STEP * plane.width, dy * MOVE_STEP * plane.height]));
  const actions = {
    in: act((view) => zoomWindow(view, ZOOM_STEP)), out: act((view) => zoomWindow(view, 1 / ZOOM_STEP)), whole: act((view) => view.whole()),
    right: move(1, 0), left: move(-1, 0), up: move(0, -1), down: move(0, 1),
  };
  return actions;
}

/** Two fingers zoom and move the face; one finger is dragged as by a mouse. */
function pinched(view) {
  const { face } = view;
  let last = null;
  let next = null;

  const fingers = ({ touches }) => {
    const { left, top } = face.getBoundingClientRect();
    const [a, b] = [0, 1].map((finger) => [touches[finger].clientX - left, touches[finger].clientY - top]);
    return { middle: [(a[0] + b[0]) / 2, (a[1] + b[1]) / 2], apart: Math.max(distanceOf(a, b), 1) };
  };

  function redraw() {
    if (next === null || last === null) {
      return;
    }
    const way = minus(last.middle, next.middle);
    const factor = next.apart / last.apart;
    [last, next] = [next, null];
    Plotly.relayout(face, windowOf(view, way.map((part) => part / factor), factor, last.middle));
  }

  const two = (act) => (event) => {
    if (event.touches.length === 2 && view.isDrawn()) {
      event.preventDefault();
      event.stopPropagation();
      act(event);
    }
  };
  face.addEventListener("touchstart", two((event) => {
    last = fingers(event);
  }), { capture: true, passive: false });
  face.addEventListener("touchmove", two((event) => {
    if (last !== null) {
      if (next === null) {
        requestAnimationFrame(redraw);
      }
      next = fingers(event);
    }
  }), { capture: true, passive: false });
  face.addEventListener("touchend", () => {
    last = null;
  }, { capture: true });
}
