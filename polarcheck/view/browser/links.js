// ---- links: #L120 is a line of the program, #p1L120 one of the second program on the page, #s2L120 in its third section ----

const LINK = /^#(?:p(\d{1,6}))?(?:s(\d{1,6}))?L(\d{1,9})$/;

/** The address of what is chosen, from # on; empty if no line is. */
function linkOf(pictures, { program, section, move, line }) {
  if (line === null || line === undefined) {
    return "";
  }
  const { sections } = pictures[program];
  const first = sections.findIndex((other) => other.moves.line.includes(line));
  const ofProgram = pictures.length > 1 ? `p${program}` : "";
  const ofSection = move !== null && section !== null && section !== first ? `s${section}` : "";
  return `#${ofProgram}${ofSection}L${line}`;
}

/** What an address leads to, as a change of the state; null for no line of a program on the page. */
function placeOfLink(pictures, hash) {
  const parts = LINK.exec(hash);
  if (parts === null) {
    return null;
  }
  const [program, line] = [Number(parts[1] || 0), Number(parts[3])];
  const picture = pictures[program];
  if (picture === undefined || line < 1 || line > Math.max(picture.source_lines, ...picture.findings.map((finding) => finding.line))) {
    return null;
  }
  const section = parts[2] === undefined ? undefined : picture.sections[Number(parts[2])];
  const move = section === undefined ? -1 : section.moves.line.indexOf(line);
  return move < 0 ? { program, line } : { program, section: Number(parts[2]), move };
}

/** The address follows what is chosen, and leads back to it. shown: shows the place of a program. */
function linked(pictures, state, shown) {
  let timer = null;
  let read = "";

  function go() {
    read = location.hash;
    const place = placeOfLink(pictures, location.hash);
    if (place !== null) {
      state.choose(place);
      shown(place);
    }
  }

  function write() {
    timer = null;
    const link = linkOf(pictures, state.chosen);
    // An address that has just changed is not read yet: its own event follows, and must find it.
    const isRead = read === location.hash;
    if (isRead && link !== location.hash && (link || LINK.test(location.hash))) {
      try {
        history.replaceState(null, "", link || `${location.pathname}${location.search}`);
        read = location.hash;
      } catch {
        // A page within another one, as in an editor, may have no address that could change.
      }
    }
  }

  go();
  window.addEventListener("hashchange", go);
  // Browsers refuse many changes of the address in a short time.
  state.subscribe((now, before) => {
    const isOther = ["line", "program", "section", "playing"].some((name) => now[name] !== before[name]);
    if (timer === null && !now.playing && isOther) {
      timer = setTimeout(write, 150);
    }
  });
}
