// ---- controls: the buttons, the slider and the texts of a player ----

const SPEEDS = [0.1, 0.25, 0.5, 1, 2, 5, 10];

/** Minutes and seconds, as 1:02.5. */
function clockOf(seconds) {
  const tenths = Math.round(seconds * 10);
  return `${Math.floor(tenths / 600)}:${((tenths % 600) / 10).toFixed(1).padStart(4, "0")}`;
}

/** Why there is less to see than there could be. */
function whyNot(section) {
  const reasons = [];
  if (section.radius === null) {
    reasons.push("R of the cutter is not known: the programmed point alone moves, and no metal is taken away.");
  } else if (section.stock === null && !section.bar.length) {
    reasons.push("The diameter of the stock is not known: the bar ends where the cuts do.");
  }
  return reasons.map((text) => Object.assign(element("p", text), { className: "remark" }));
}

/** The time of the section, as 0:12.5 of 1:02.0. */
function timeText({ duration, isAssumed }, time) {
  if (!(duration > 0)) {
    return isAssumed ? "time not known" : clockOf(0);
  }
  return `${clockOf(time)} of ${isAssumed ? "at least " : ""}${clockOf(duration)}`;
}

/** The block that runs, as one line. */
function blockText(section, { move }) {
  return move < 0 ? "" : `line ${section.moves.line[move]}: ${section.moves.block[move]}`;
}

/** What is special about a moment; empty if nothing is. */
function noteText(section, line, { move, kind, feed, play }) {
  if (kind === JUMP) {
    return "At the center the C axis would have to turn 180 deg at once. The clock waits here while it is shown.";
  }
  if (kind === ASSUMED) {
    const hasFeed = Number.isFinite(feed) && section.moves.role[move] !== "positioning";
    return `The time of this move is not known: it is shown ${hasFeed ? "at its F" : "quickly"}, and not counted.`;
  }
  return play >= line.length && line.length > 0 ? "End of the section." : "";
}

/** The controls of a player in their place. */
function playerControls(bar, hasNext) {
  const made = (name, text, title) => Object.assign(element("button", text), { type: "button", className: name, title });
  const toggle = made("play", "Play", "Space");
  const next = made("next", "Next section", "n");
  next.hidden = !hasNext;
  const slider = Object.assign(element("input"), { type: "range", className: "clock", min: "0", max: "0", step: "any", value: "0", ariaLabel: "Time in the section" });
  const time = Object.assign(element("output", "0:00.0"), { className: "time" });
  time.setAttribute("aria-live", "off");
  time.setAttribute("aria-label", "Time");
  const speed = Object.assign(element("select"), { className: "speed", ariaLabel: "Speed", title: "Speed (< and >)" });
  speed.append(...SPEEDS.map((each) => Object.assign(element("option", `${each}\u00d7`), { value: String(each) })));
  speed.value = "1";
  const metal = Object.assign(element("input"), { type: "checkbox", checked: true, className: "with-metal" });
  const block = Object.assign(element("code"), { className: "running" });
  const note = Object.assign(element("p"), { className: "player-note" });
  note.setAttribute("role", "status");
  bar.replaceChildren(toggle, next, slider, time, speed, element("label", "", metal, " metal"), block, note);
  return {
    speed: () => Number(speed.value),
    hasMetal: () => metal.checked,
    faster(way) {
      speed.selectedIndex = Math.min(Math.max(speed.selectedIndex + way, 0), SPEEDS.length - 1);
    },
    setLength(length) {
      slider.max = String(length);
      [toggle, slider].forEach((each) => {
        each.disabled = !(length > 0);
      });
    },
    setTime(play, text) {
      slider.value = String(play);
      slider.setAttribute("aria-valuetext", text);
      write(time, text);
    },
    setBlock(text, remark) {
      write(block, text);
      write(note, remark);
    },
    setPlaying(isPlaying) {
      write(toggle, isPlaying ? "Pause" : "Play");
      bar.classList.toggle("is-playing", isPlaying);
    },
    onPlay: (action) => toggle.addEventListener("click", action),
    onNext: (action) => next.addEventListener("click", action),
    onMetal: (action) => metal.addEventListener("change", action),
    onSeek: (action) => onSlider(slider, action),
  };
}
