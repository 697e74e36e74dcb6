// ---- state: what is chosen on the page, in one place; every view subscribes to it ----

/**
 * The state of the page.
 *
 * chosen: what is chosen. program: its number on the page; section, move, finding: numbers in the data of the program,
 * null for none; line: a line of the file; time: in the section [s], null for the end of the move; view: face, machine
 * or both; playing: true while the player runs.
 * subscribe(view): view(chosen, before) is called after each change; it must not choose in turn.
 * choose(change): changes what is given. A finding brings its section, move and line; a move its line and finding; a
 * line its move and finding, where it has them; another section or program leaves nothing chosen in it.
 */
function pageState(programs) {
  const chosen = { program: 0, section: null, move: null, finding: null, line: null, time: null, view: "face", playing: false };
  const views = [];

  function ofFinding(program, place) {
    const { section, move, line, is_beside: isBeside } = programs[program].findings[place];
    const isDrawn = section !== null && programs[program].sections[section] !== undefined;
    return isDrawn ? { section, move: isBeside ? null : move, line } : { move: null, line };
  }

  function ofMove(program, section, move) {
    const line = programs[program].sections[section].moves.line[move];
    return { line, finding: findingAt(programs[program], line) };
  }

  function ofLine(program, line) {
    const { sections } = programs[program];
    const here = chosen.program === program && chosen.section !== null ? [chosen.section] : [];
    const place = { section: null, move: -1 };
    for (const section of [...here, ...sections.keys()]) {
      if (place.move < 0) {
        Object.assign(place, { section, move: sections[section].moves.line.indexOf(line) });
      }
    }
    const finding = findingAt(programs[program], line);
    return place.move < 0 ? { move: null, finding } : { ...place, finding };
  }

  function completed(change) {
    const program = change.program === undefined ? chosen.program : change.program;
    const whole = { program, ...change };
    const isOther = program !== chosen.program || (change.section !== undefined && change.section !== chosen.section);
    if (isOther) {
      Object.assign(whole, { section: null, move: null, finding: null, line: null, time: null }, change);
    }
    if (change.finding !== undefined && change.finding !== null) {
      Object.assign(whole, { time: null }, ofFinding(program, change.finding), change);
    } else if (change.move !== undefined && change.move !== null) {
      const section = whole.section === undefined ? chosen.section : whole.section;
      Object.assign(whole, { time: null }, ofMove(program, section, change.move), change);
    } else if (change.line !== undefined && change.line !== null) {
      Object.assign(whole, { time: null }, ofLine(program, change.line), change);
    }
    if (whole.section === null && programs[program].sections.length) {
      whole.section = program === chosen.program && chosen.section !== null ? chosen.section : 0;
    }
    return whole;
  }

  function choose(change) {
    const before = { ...chosen };
    Object.assign(chosen, completed(change));
    views.forEach((view) => view(chosen, before));
  }

  return { chosen, choose, subscribe: (view) => views.push(view) };
}

/** The first finding at a line of the file, also if it is one of the other lines of a finding; null without one. */
function findingAt({ findings }, line) {
  let place = findings.findIndex((finding) => finding.line === line);
  if (place < 0) {
    place = findings.findIndex((finding) => (finding.also || []).includes(line));
  }
  return place < 0 ? null : place;
}
