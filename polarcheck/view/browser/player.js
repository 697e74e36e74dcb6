// ---- player: the clock of a section; it moves the tool in the view onto the face and in that of the machine ----

/** While it plays the numbers follow so often, and the chosen move of the page [ms]. */
const READ_EVERY = 100;
const REPORT_EVERY = 200;
/** The longest time between two frames that counts as time [ms]: a page in the background stands still. */
const LONGEST_FRAME = 250;
/** A step by key [s], at speed 1. */
const KEY_STEP = 0.1;

/** The players of all sections of a program; each is made as its section is first shown. */
function playersView(root, picture, state, program, sections) {
  const players = [];
  function playerOf(place) {
    if (!players[place]) {
      const next = place + 1 < sections.views.length ? () => {
        state.choose({ program, section: place + 1, move: null });
        return playerOf(place + 1);
      } : null;
      players[place] = playerView(sections.views[place].root, program, place, picture.sections[place], state, next);
    }
    return players[place];
  }
  const show = ({ section }) => {
    if (section !== null && sections.views[section]) {
      playerOf(section).show();
    }
  };
  state.subscribe((chosen, before) => {
    if (chosen.program === program && (chosen.section !== before.section || chosen.view !== before.view || chosen.program !== before.program)) {
      show(chosen);
    }
  });
  if (sections.views.length) {
    playerOf(0);
  }
}

/**
 * The player of a section.
 *
 * root: its element, with the places .player, .machine, .face and .over. program, place: its numbers. next: the player
 * of the next section, as a function, null for the last one. The timeline and the views are made as it is first shown.
 */
function playerView(root, program, place, section, state, next) {
  const face = root.querySelector(".face");
  const control = playerControls(root.querySelector(".player"), next !== null);
  const moment = { place: 1, play: 0, move: -1, kind: STEADY };
  let views = null;
  let isPlaying = false;
  /** True at a time of the section, while it plays or by the slider: else nothing covers the face. */
  let isShown = false;
  let frame = 0;
  let lastFrame = 0;
  let lastRead = 0;
  let lastReport = 0;
  let sent = null;

  /** The timeline and the views, made at the first call. */
  function open() {
    if (views) {
      return;
    }
    const line = timelineOf(section);
    const canvas = element("canvas");
    canvas.setAttribute("role", "img");
    const gauges = Object.assign(element("div"), { className: "gauges" });
    root.querySelector(".machine").replaceChildren(canvas, gauges, ...whyNot(section));
    views = { line, canvas, machine: machineView(canvas, section, line), gauges: gaugesView(gauges, section, line), over: null };
    new ResizeObserver(redraw).observe(canvas);
    control.setLength(line.length);
    momentAt(line, 0, moment);
    read();
  }

  /** The canvas over the face, once the face is drawn. */
  function over() {
    if (views.over === null && face._fullLayout) {
      const plane = planeTransform(face);
      views.over = faceCanvas(root.querySelector(".over"), face, section, views.line, plane);
      plane.onChange(redraw);
    }
    return views.over;
  }

  /** Show a time on the slider. */
  function seek(play) {
    open();
    momentAt(views.line, Math.min(Math.max(play, 0), views.line.length), moment);
    read();
    redraw();
  }

  function seekByHand(play) {
    isPlaying = false;
    control.setPlaying(false);
    isShown = true;
    seek(play);
    report();
  }

  /** Write the numbers of the moment. */
  function read() {
    const { line, gauges, canvas } = views;
    control.setTime(moment.play, timeText(line, moment.time));
    gauges.show(moment, true);
    control.setBlock(blockText(section, moment), noteText(section, line, moment));
    if (!isPlaying) {
      canvas.setAttribute("aria-label", `The view along the spindle: the part turns, the cutter moves along X. ${blockText(section, moment)}`);
    }
  }

  /** Tell the page what is chosen now: while it plays only as the move changes. */
  function report() {
    const now = { program, section: place, move: moment.move < 0 ? null : moment.move, time: moment.time, playing: isPlaying };
    if (!sent || !isPlaying || sent.move !== now.move || sent.playing !== now.playing) {
      sent = now;
      state.choose(now);
    }
  }

  function redraw() {
    if (!frame && views) {
      frame = requestAnimationFrame(drawFrame);
    }
  }

  function drawFrame(now) {
    frame = 0;
    if (isPlaying) {
      advance(now);
    }
    const faceView = over();
    const isDone = [views.machine.draw(moment), !isShown || !faceView || faceView.draw(moment, control.hasMetal())];
    if (isPlaying || isDone.includes(false)) {
      redraw();
    }
  }

  /** Go on by the time since the last frame. */
  function advance(now) {
    const passed = Math.min(Math.max(now - lastFrame, 0), LONGEST_FRAME) / 1000;
    lastFrame = now;
    momentAt(views.line, Math.min(moment.play + passed * control.speed(), views.line.length), moment);
    if (moment.play >= views.line.length) {
      pause();
    } else if (now - lastRead >= READ_EVERY) {
      lastRead = now;
      read();
    } else {
      views.gauges.show(moment, false);
    }
    if (isPlaying && now - lastReport >= REPORT_EVERY) {
      lastReport = now;
      report();
    }
  }

  function play() {
    open();
    if (!(views.line.length > 0)) {
      return;
    }
    if (moment.play >= views.line.length) {
      seek(0);
    }
    isPlaying = true;
    isShown = true;
    lastFrame = performance.now();
    lastRead = lastFrame;
    lastReport = lastFrame;
    control.setPlaying(true);
    read();
    report();
    redraw();
  }

  function pause() {
    isPlaying = false;
    control.setPlaying(false);
    read();
    report();
  }

  function toggle() {
    (isPlaying ? pause : play)();
  }

  /** Show the beginning of the next section, and play it. */
  function goOn() {
    if (next !== null) {
      pause();
      next().play();
    }
  }

  /** Follow what others have chosen: a move, of which the end is shown, or a time. */
  function follow(chosen) {
    if (chosen.program !== program || chosen.section !== place) {
      stop();
      return;
    }
    const isOwn = sent !== null && sent.move === chosen.move && sent.time === chosen.time && sent.playing === chosen.playing;
    if (isOwn) {
      return;
    }
    stop();
    open();
    sent = { ...chosen };
    const hasTime = chosen.time !== null && chosen.time !== undefined;
    // The end of a chosen move is marked in the plot itself.
    isShown = hasTime;
    if (!hasTime && views.over) {
      views.over.clear();
    }
    if (chosen.move === null) {
      seek(0);
    } else {
      seek(hasTime ? playAtTime(views.line, chosen.time) : playAtEndOf(views.line, chosen.move));
    }
  }

  /** Stand still for the sake of another choice. */
  function stop() {
    if (isPlaying) {
      isPlaying = false;
      control.setPlaying(false);
      // The page is being told of that choice; this follows it.
      queueMicrotask(() => state.choose({ playing: false }));
    }
  }

  const step = () => KEY_STEP * control.speed();
  const actions = {
    " ": toggle, ".": () => seekByHand(moment.play + step()), ",": () => seekByHand(moment.play - step()),
    ">": () => control.faster(1), "<": () => control.faster(-1), n: goOn,
  };
  document.addEventListener("keydown", (event) => {
    const target = event.target instanceof Element ? event.target : document.body;
    const isTaken = target.closest(event.key === " " ? TAKES_SPACE : TAKES_TEXT);
    const isOurs = state.chosen.program === program && (state.chosen.section === null ? 0 : state.chosen.section) === place;
    const isPlain = !event.defaultPrevented && !event.ctrlKey && !event.altKey && !event.metaKey;
    if (isOurs && isPlain && !isTaken && actions[event.key]) {
      event.preventDefault();
      actions[event.key]();
    }
  });
  control.onPlay(toggle);
  control.onSeek(seekByHand);
  control.onNext(goOn);
  control.onMetal(redraw);
  state.subscribe(follow);

  /** Draw with the colors that the page has now. */
  function recolor() {
    if (views) {
      views.machine.refit();
      if (views.over) {
        views.over.refit();
      }
      redraw();
    }
  }

  onTheme(recolor);
  return {
    play,
    /** Draw what is in sight. */
    show() {
      open();
      redraw();
    },
  };
}

/** What a key belongs to where the focus is there. */
const TAKES_TEXT = "select, textarea, input:not(.clock):not([type=checkbox])";
const TAKES_SPACE = "select, textarea, input:not(.clock), button, summary, a, [role=button], [role=tab], tr[tabindex]";
