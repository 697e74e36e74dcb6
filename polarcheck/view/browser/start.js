// ---- start: the data into the views ----

/** Views of a program, each called with the element of the program, its picture, the state and its number. */
const VIEWS = [
  chosenView,
  movesView,
  playersView,
];

function start(pictures) {
  const hover = element("dl");
  hover.id = "hover";
  hover.hidden = true;
  document.body.append(hover);
  if (typeof Plotly === "undefined" && pictures.some(({ sections }) => sections.length)) {
    document.querySelector("main").prepend(element("p", "The library that draws is missing beside this page."));
    return;
  }
  const state = pageState(pictures);
  const programs = pictures.map((picture, program) => {
    const root = document.getElementById(`p${program}`);
    const sections = sectionsView(root, picture, state, program);
    const list = findingsView(root, picture, state, program, sections);
    VIEWS.forEach((view) => view(root, picture, state, program, sections));
    return { root, picture, sections, list, tools: toolsView(root, picture, state, program, sections, pictures) };
  });
  toolKeys(programs.map((program) => program.tools), state);
  chooser(programs, state);
  printable(programs.flatMap((program) => program.sections.views));
  if (pictures[0].sections.length) {
    state.choose({ program: 0, section: firstSection(pictures[0]) });
  }
  linked(pictures, state, ({ program }) => programs[program].root.scrollIntoView({ block: "start" }));
  const memory = pageMemory(pictures, state, programs);
  served(memory.keep, memory.restore);
  embedded(state, memory);
}

withData(start);
