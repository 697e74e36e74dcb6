// ---- memory: what is kept of a page that is loaded anew, since its program was saved ----

/** keep(): what is chosen and seen, as JSON; restore(kept): chooses it on the new page, as far as it is still there. */
function pageMemory(pictures, state, programs) {
  const drawn = new Map();

  const rangesOf = (face) => ["xaxis", "yaxis"].map((axis) => [...face._fullLayout[axis].range]);

  programs.forEach(({ sections }) => sections.views.forEach((view) => {
    whenDrawn(view, () => drawn.set(view, rangesOf(view.face)));
  }));

  /** The window of a face, null where it is the one that it was drawn with. */
  function windowOfFace(view) {
    if (!view || !drawn.has(view)) {
      return null;
    }
    const [now, before] = [rangesOf(view.face), drawn.get(view)];
    const [left, right] = before[0];
    const isSame = now.flat().every((end, place) => Math.abs(end - before.flat()[place]) < 1e-6 * (right - left));
    return isSame ? null : now;
  }

  const textAt = ({ source, source_line: first }, line) => (line === null ? null : source[line - first]);

  function keep() {
    const { program, section, line, view } = state.chosen;
    const shown = programs[program].sections.shown();
    return {
      program, section, line, view, text: textAt(pictures[program], line), window: windowOfFace(shown),
      scroll: [window.scrollX, window.scrollY],
    };
  }

  /** The line of the block that stood in a line: the nearest one with the same text, or the same line. */
  function lineNow(picture, line, text) {
    const same = picture.source.flatMap((other, place) => (other === text ? [place + picture.source_line] : []));
    return same.reduce((best, other) => (Math.abs(other - line) < Math.abs(best - line) ? other : best), same.length ? same[0] : line);
  }

  function restore({ program, section, line, view, text, window: ranges, scroll }) {
    const picture = pictures[program];
    if (!picture) {
      return;
    }
    state.choose({ program, view });
    if (section !== null && section < picture.sections.length) {
      state.choose({ program, section });
    }
    if (line !== null && line <= picture.source_lines) {
      state.choose({ program, line: lineNow(picture, line, text) });
    }
    const { views } = programs[program].sections;
    if (ranges !== null && views[section]) {
      const { face } = views[section];
      const seen = () => Plotly.relayout(face, { "xaxis.range": ranges[0], "yaxis.range": ranges[1] });
      // The face gets its height a moment after it is drawn; a window that is set before would grow with it.
      whenDrawn(views[section], () => requestAnimationFrame(() => requestAnimationFrame(() => Plotly.Plots.resize(face).then(seen))));
    }
    window.scrollTo(...scroll);
  }

  return { keep, restore };
}
