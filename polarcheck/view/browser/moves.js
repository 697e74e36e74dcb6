// ---- moves: the table of all moves, of which only the rows in sight are made ----

const ROW = 24;
/** Rows that are made above and below those in sight. */
const SPARE = 12;

/** The table of the moves of the section that is shown, and what steps through them. */
function movesView(root, picture, state, program) {
  const find = (name) => root.querySelector(`.${name}`);
  const slider = find("step");
  let section = null;
  let table = { show: () => {}, resized: () => {} };
  const choose = (move) => state.choose({ program, section, move });
  const count = () => picture.sections[section].moves.line.length;

  function show(chosen) {
    if (chosen.program !== program || chosen.section === null) {
      return;
    }
    if (chosen.section !== section) {
      section = chosen.section;
      table = moveTable(find("moves"), picture.sections[section], choose, picture.findings.filter((finding) => !finding.silenced));
      slider.max = String(Math.max(count() - 1, 0));
    }
    slider.value = String(chosen.move === null ? 0 : chosen.move);
    find("count").textContent = chosen.move === null ? `${count()} moves` : `${chosen.move + 1} of ${count()}`;
    table.show(chosen.move);
  }

  onSlider(slider, choose);
  const step = (way) => {
    const from = state.chosen.move === null ? (way > 0 ? -1 : count()) : state.chosen.move;
    choose(Math.min(Math.max(from + way, 0), count() - 1));
  };
  find("back").addEventListener("click", () => step(-1));
  find("on").addEventListener("click", () => step(1));
  new ResizeObserver(() => table.resized()).observe(find("moves"));
  find("move-list").hidden = !picture.sections.length;
  state.subscribe(show);
  if (picture.sections.length) {
    show({ program, section: firstSection(picture), move: null });
  }
}

function moveTable(box, section, choose, findings) {
  const severities = new Map();
  for (const finding of [...findings].reverse()) {
    [finding.line, ...(finding.also || [])].forEach((line) => severities.set(line, finding.severity));
  }
  const units = unitsOf(section);
  const { moves } = section;
  const count = moves.line.length;
  const table = element("table");
  const head = element("tr");
  const hasLimit = moves.share.some((share) => share !== null);
  const heads = [["line", ""], ["block", ""], ["Z", units.name], ["F", `${units.name}/min`], ["C", "deg/min"], ["C %", "of its limit"], ["time", "s"]];
  for (const [label, unit] of heads.filter(([label]) => hasLimit || label !== "C %")) {
    const cell = element("th", label);
    cell.scope = "col";
    cell.title = unit;
    head.append(cell);
  }
  const body = element("tbody");
  table.append(element("thead", "", head), body);
  table.setAttribute("aria-rowcount", String(count + 1));
  box.replaceChildren(table);
  let chosen = null;
  let filled = "";
  // To ask for it makes the browser lay out the page: not five times a second while it plays.
  let height = box.clientHeight;

  const number = (value, text) => (value === null ? "" : text(value));
  function row(move) {
    const values = [
      String(moves.line[move]), moves.block[move], number(moves.z[move][1], units.length),
      number(moves.feed[move], (feed) => rounded(feed / section.scale)), number(moves.c_feed[move], rounded),
      ...(hasLimit ? [number(moves.share[move], (share) => String(Math.round(100 * share)))] : []),
      number(moves.time[move], (time) => time.toFixed(2)),
    ];
    const made = element("tr", "", ...values.map((value) => element("td", value)));
    made.dataset.move = String(move);
    made.setAttribute("aria-rowindex", String(move + 2));
    made.title = `${moves.role[move]}: ${moves.block[move]}`;
    made.className = [move === chosen ? "is-chosen" : "", moves.share[move] > 1 ? "above" : "", severities.get(moves.line[move]) || ""].join(" ").trim();
    return made;
  }

  function gap(rows) {
    const made = element("tr");
    made.style.height = `${rows * ROW}px`;
    made.setAttribute("aria-hidden", "true");
    return made;
  }

  function fill() {
    // The table is hidden while the program is shown in its place.
    if (!height) {
      return;
    }
    const first = Math.max(Math.floor(box.scrollTop / ROW) - SPARE, 0);
    const last = Math.min(first + Math.ceil(height / ROW) + 2 * SPARE, count);
    if (filled === `${first} ${last}`) {
      body.querySelectorAll("tr[data-move]").forEach((made) => made.classList.toggle("is-chosen", Number(made.dataset.move) === chosen));
      return;
    }
    filled = `${first} ${last}`;
    const rows = [];
    for (let move = first; move < last; move += 1) {
      rows.push(row(move));
    }
    body.replaceChildren(gap(first), ...rows, gap(count - last));
  }

  function show(move) {
    chosen = move;
    reveal();
    fill();
  }

  function reveal() {
    if (chosen !== null && height) {
      const room = height - 2 * ROW;
      if (chosen * ROW < box.scrollTop || chosen * ROW > box.scrollTop + room) {
        box.scrollTop = Math.max(chosen * ROW - room / 2, 0);
      }
    }
  }

  box.onscroll = () => requestAnimationFrame(fill);
  body.addEventListener("click", (event) => {
    const hit = event.target.closest("tr[data-move]");
    if (hit) {
      choose(Number(hit.dataset.move));
    }
  });
  box.scrollTop = 0;
  fill();
  function resized() {
    height = box.clientHeight;
    show(chosen);
  }

  return { show, resized };
}
