// ---- tools: the buttons above the face, and what the page says when they have done something ----

/** The tools of a program: what the keys call. */
function toolsView(root, picture, state, program, sections, pictures) {
  const place = root.querySelector(".tools");
  const message = element("output");
  message.className = "message";
  message.setAttribute("role", "status");
  let timer = null;
  let pointed = null;

  const say = (text) => {
    message.textContent = text;
    clearTimeout(timer);
    timer = setTimeout(() => {
      message.textContent = "";
    }, 6000);
  };
  const named = (text, key, title, act) => {
    const made = button(text, act);
    made.title = `${title || text} (key ${key})`;
    place.append(made);
    return made;
  };
  const hand = {
    say,
    toggle: (text, key, act) => {
      const made = named(text, key, "", act);
      made.setAttribute("aria-pressed", "false");
      return made;
    },
    hasDrawing: () => !sections.views.length || sections.shown().coloring.hasNominal !== false,
  };
  const source = sourceView(root, picture, state, program);
  const zoom = zoomView(sections);
  [["+", "in", "Zoom in"], ["\u2212", "out", "Zoom out"]].forEach(([text, act, title]) => {
    named(text, text, title, () => zoom[act]()).setAttribute("aria-label", title);
  });
  const measure = measuringView(state, program, sections, hand);
  const sides = sidesView(root, picture, state, program, sections, hand);

  /** The drawing is shown or hidden in all sections. */
  const hasDrawing = picture.sections.some((section) => section.drawing.length);
  const drawing = () => {
    if (hasDrawing) {
      const hasNominal = !hand.hasDrawing();
      toggle.setAttribute("aria-pressed", String(hasNominal));
      sections.views.forEach((view) => {
        view.coloring.hasNominal = hasNominal;
        view.redraw();
      });
    }
  };
  const toggle = hasDrawing ? hand.toggle("Drawing", "d", drawing) : null;
  if (toggle) {
    toggle.setAttribute("aria-pressed", "true");
  }

  /** What is copied: the cursor of measuring, the pointer on the face, or the end of the chosen move. */
  function copy() {
    const view = sections.shown();
    if (!view) {
      say("nothing to copy: there is no polar section");
      return;
    }
    const { move } = state.chosen;
    const ofMove = move === null || state.chosen.program !== program ? null : view.section.moves.end[move];
    const at = measure.at() || (pointed !== null && pointed.view === view ? pointed.at : null) || ofMove;
    if (at === null || at[0] === null || at[1] === null) {
      say("nothing to copy: point at the face, or choose a move");
      return;
    }
    const doubt = doubtOfWords(view.section);
    copyText(wordsAt(view.section, at), (text) => say(doubt ? `${text} (${doubt})` : text));
  }

  function link() {
    const hash = linkOf(pictures, state.chosen);
    if (!hash) {
      say("no link: choose a line first");
      return;
    }
    copyText(`${location.href.split("#")[0]}${hash}`, say);
  }

  named("Copy position", "c", "Copy the position of the pointer, or the end of the move", copy);
  named("Copy link", "l", "Copy a link to the line", link);
  named("?", "?", "Keys", () => document.getElementById("keys").showModal()).setAttribute("aria-label", "Keys");
  place.append(message);

  sections.views.forEach((view) => {
    const readout = element("output");
    readout.className = "readout";
    readout.setAttribute("aria-hidden", "true");
    view.face.parentElement.append(readout);
    const box = view.face.parentElement;
    box.addEventListener("pointermove", (event) => {
      if (!view.isDrawn()) {
        return;
      }
      const { left, top } = box.getBoundingClientRect();
      const plane = planeTransform(view.face);
      const [px, py] = [event.clientX - left, event.clientY - top];
      const isInside = px >= plane.left && py >= plane.top && px <= plane.left + plane.width && py <= plane.top + plane.height;
      const at = measure.at() || plane.toPlane(px, py);
      pointed = isInside ? { view, at } : null;
      readout.textContent = isInside ? wordsAt(view.section, at) : "";
    });
    box.addEventListener("pointerleave", () => {
      pointed = null;
      readout.textContent = "";
    });
  });
  return {
    measure: measure.toggle, isMeasuring: measure.isOn, letGo: measure.letGo, copy, link, find: source.find,
    drawing, sides: sides.toggle, zoom,
  };
}
