// ---- source: the whole program beside the picture, of which only the rows in sight are made ----

const SOURCE_ROW = 20;
const SOURCE_SPARE = 10;
const SEVERITIES = { error: "E", warning: "W", note: "N" };

/** The findings of each line, also of those that a finding names beside its own: the numbers of the findings. */
function findingsByLine(findings) {
  const lines = new Map();
  findings.forEach((finding, number) => {
    [finding.line, ...(finding.also || [])].forEach((line) => lines.set(line, [...(lines.get(line) || []), number]));
  });
  return lines;
}

/** The tabs of the texts beside the picture: the program, and the table of moves. Returns what shows one of them. */
function textSwitch(root, picture) {
  const place = root.querySelector(".text-switch");
  const panels = { source: root.querySelector(".source"), moves: root.querySelector(".move-list") };
  const tabs = Object.entries({ source: "Program", moves: "Moves" }).map(([name, text]) => {
    const tab = button(text, () => show(name));
    panels[name].id = `${root.id}${name}`;
    tab.id = `${root.id}${name}-tab`;
    Object.entries({ role: "tab", "aria-controls": panels[name].id }).forEach(([key, value]) => tab.setAttribute(key, value));
    panels[name].setAttribute("aria-labelledby", tab.id);
    panels[name].removeAttribute("aria-label");
    return [name, tab];
  });

  function show(shown) {
    tabs.forEach(([name, tab]) => {
      panels[name].hidden = name !== shown;
      tab.setAttribute("aria-selected", String(name === shown));
      tab.tabIndex = name === shown ? 0 : -1;
    });
  }

  place.append(...tabs.map(([, tab]) => tab));
  place.addEventListener("keydown", (event) => {
    if (event.key === "ArrowLeft" || event.key === "ArrowRight") {
      const [name, tab] = tabs.find(([, other]) => other !== event.target);
      event.preventDefault();
      event.stopPropagation();
      show(name);
      tab.focus();
    }
  });
  place.hidden = !picture.sections.length;
  show(picture.source.length || !picture.sections.length ? "source" : "moves");
  return show;
}

/** The source of a program. */
function sourceView(root, picture, state, program) {
  const place = root.querySelector(".source");
  const showText = textSwitch(root, picture);
  const { source, source_line: first, findings } = picture;
  if (!source.length) {
    place.append(element("p", "The text of the program is not on this page."));
    return { find: () => {} };
  }
  const last = first + source.length - 1;
  const marks = findingsByLine(findings);
  const order = Object.keys(SEVERITIES);
  const worst = (line) => order.find((severity) => (marks.get(line) || []).some((number) => findings[number].severity === severity && !findings[number].silenced));
  const digits = String(last).length;
  const { form, field, count } = findForm();
  const box = element("div");
  box.className = "lines";
  Object.entries({ tabindex: "0", role: "listbox", "aria-label": "Lines of the program" }).forEach(([name, value]) => box.setAttribute(name, value));
  const body = element("div");
  body.setAttribute("role", "presentation");
  body.style.height = `${source.length * SOURCE_ROW}px`;
  box.append(body);
  place.append(form, ...shortened(), box);
  let chosen = null;
  let hits = [];
  let isHit = new Set();
  let filled = "";
  let wasSeen = false;
  // To ask for them makes the browser lay out the page: not five times a second while it plays.
  let [height, scrolled] = [0, 0];

  function shortened() {
    const isWhole = first === 1 && source.length >= picture.source_lines;
    return isWhole ? [] : [element("p", `Lines ${first} to ${last} of ${picture.source_lines}.`)];
  }

  function sectionOf(line) {
    return picture.sections.some((section) => section.line <= line && line <= section.end_line);
  }

  function row(line) {
    const severity = worst(line);
    const sign = element("span", severity ? SEVERITIES[severity] : "");
    sign.className = "sign";
    const number = element("span", String(line).padStart(digits));
    number.className = "number";
    const text = element("code", source[line - first] || " ");
    const made = element("div", "", number, sign, text);
    made.id = `p${program}source${line}`;
    made.dataset.line = String(line);
    made.className = ["row", severity || "", sectionOf(line) ? "in-polar" : "", line === chosen ? "is-chosen" : "", isHit.has(line) ? "is-hit" : ""].join(" ").trim();
    made.style.top = `${(line - first) * SOURCE_ROW}px`;
    Object.entries({ role: "option", "aria-selected": String(line === chosen), "aria-setsize": String(source.length), "aria-posinset": String(line - first + 1) })
      .forEach(([name, value]) => made.setAttribute(name, value));
    const messages = (marks.get(line) || []).map((finding) => `${findings[finding].severity}: ${findings[finding].message}`);
    if (messages.length) {
      made.title = messages.slice(0, 5).join("\n");
    }
    return made;
  }

  function fill() {
    const from = Math.max(Math.floor(scrolled / SOURCE_ROW) - SOURCE_SPARE, 0);
    const to = Math.min(from + Math.ceil((height || 400) / SOURCE_ROW) + 2 * SOURCE_SPARE, source.length);
    const key = `${from} ${to}`;
    if (key === filled) {
      body.querySelectorAll('[aria-selected="true"]').forEach((made) => select(made, false));
      const now = chosen === null ? null : body.querySelector(`[data-line="${chosen}"]`);
      if (now !== null) {
        select(now, true);
      }
    } else {
      filled = key;
      body.replaceChildren(...Array.from({ length: to - from }, (_, at) => row(first + from + at)));
    }
    if (chosen !== null && chosen - first >= from && chosen - first < to) {
      box.setAttribute("aria-activedescendant", `p${program}source${chosen}`);
    } else {
      box.removeAttribute("aria-activedescendant");
    }
  }

  function select(made, isChosen) {
    made.classList.toggle("is-chosen", isChosen);
    made.setAttribute("aria-selected", String(isChosen));
  }

  function show(line) {
    chosen = line;
    reveal(line);
    fill();
  }

  function reveal(line) {
    if (height && line !== null && line >= first && line <= last) {
      const top = (line - first) * SOURCE_ROW;
      if (top < scrolled || top > scrolled + height - 2 * SOURCE_ROW) {
        scrolled = Math.min(Math.max(top - height / 2, 0), Math.max(source.length * SOURCE_ROW - height, 0));
        box.scrollTop = scrolled;
      }
    }
  }

  /** The chosen line stays in sight; the first time that the lines have a height, that of the worst finding is. */
  function resized() {
    height = box.clientHeight;
    scrolled = box.scrollTop;
    reveal(chosen === null && !wasSeen && picture.order.length ? findings[picture.order[0]].line : chosen);
    wasSeen = wasSeen || height > 0;
    fill();
  }

  function choose(line) {
    if (line !== chosen) {
      state.choose({ program, line });
      return;
    }
    // Once more on the same line: the next time that it runs.
    const { section, move } = state.chosen;
    const next = section === null || move === null ? -1 : picture.sections[section].moves.line.indexOf(line, nextRun(picture.sections[section].moves.line, move));
    state.choose(next < 0 ? { program, line } : { program, section, move: next });
  }

  /** Lines with a text, or the one with a number; the chosen one moves to the next of them. */
  function find(way) {
    const wanted = field.value.trim();
    const isNumber = /^:?\d+$/.test(wanted);
    const number = Number(wanted.replace(":", ""));
    hits = !wanted ? [] : isNumber ? [number].filter((line) => line >= first && line <= last) : linesWith(wanted);
    [isHit, filled] = [new Set(hits), ""];
    if (!hits.length) {
      count.textContent = !wanted ? "" : isNumber ? `no line ${number}` : "not in the program";
      fill();
      return;
    }
    const from = chosen === null ? first - 1 : chosen;
    const ahead = hits.findIndex((line) => line > from);
    const behind = hits.filter((line) => line < from).length - 1;
    const at = way > 0 ? (ahead < 0 ? 0 : ahead) : behind < 0 ? hits.length - 1 : behind;
    count.textContent = `${at + 1} of ${hits.length}`;
    state.choose({ program, line: hits[at] });
    show(hits[at]);
  }

  function linesWith(wanted) {
    const text = wanted.toUpperCase();
    return source.flatMap((line, at) => (line.toUpperCase().includes(text) ? [first + at] : []));
  }

  function findForm() {
    const form = element("div");
    form.className = "find";
    form.setAttribute("role", "group");
    form.setAttribute("aria-label", "Find in the program");
    const field = element("input");
    Object.entries({ type: "search", placeholder: "Text or line number", "aria-label": "Find in the program: text, or a line number", autocomplete: "off" })
      .forEach(([name, value]) => field.setAttribute(name, value));
    const count = element("output");
    const [before, next] = [button("\u25b2", () => find(-1)), button("\u25bc", () => find(1))];
    before.setAttribute("aria-label", "Hit before");
    next.setAttribute("aria-label", "Next hit");
    form.append(field, before, next, count);
    field.addEventListener("keydown", (event) => {
      if (event.key === "Enter") {
        event.preventDefault();
        find(event.shiftKey ? -1 : 1);
      } else if (event.key === "Escape") {
        event.stopPropagation();
        box.focus();
      }
    });
    return { form, field, count };
  }

  box.addEventListener("scroll", () => requestAnimationFrame(() => {
    scrolled = box.scrollTop;
    fill();
  }));
  body.addEventListener("click", (event) => {
    const hit = event.target.closest("[data-line]");
    if (hit && !String(getSelection())) {
      choose(Number(hit.dataset.line));
    }
  });
  box.addEventListener("keydown", (event) => {
    const from = chosen === null ? first - 1 : chosen;
    const page = Math.max(Math.floor(box.clientHeight / SOURCE_ROW) - 1, 1);
    const to = { ArrowDown: from + 1, ArrowUp: from - 1, PageDown: from + page, PageUp: from - page, Home: first, End: last }[event.key];
    if (to !== undefined && !event.ctrlKey && !event.altKey && !event.metaKey && !event.shiftKey) {
      event.preventDefault();
      event.stopPropagation();
      state.choose({ program, line: Math.min(Math.max(to, first), last) });
    }
  });
  new ResizeObserver(resized).observe(box);
  state.subscribe((now, before) => {
    const line = now.program === program ? now.line : null;
    if (line !== chosen || now.program !== before.program) {
      show(line);
    }
  });
  show(state.chosen.program === program ? state.chosen.line : null);
  function toFind() {
    showText("source");
    field.focus();
    field.select();
  }

  return { find: toFind };
}

/** The first move behind those of the same run of a block. */
function nextRun(lines, move) {
  let next = move + 1;
  while (next < lines.length && lines[next] === lines[move]) {
    next += 1;
  }
  return next;
}
