// ---- workbench: the sections of a program, one of which is shown; and how its face is seen ----

/** The views of all sections of a program. root: the element of the program. */
function sectionsView(root, picture, state, program) {
  const articles = [...root.querySelectorAll(".polar")];
  const views = picture.sections.map((_, place) => sectionView(articles[place], picture, state, program, place));
  const tabs = root.querySelector(".tabs");
  let shown = 0;

  function show(place) {
    shown = place;
    articles.forEach((article, other) => {
      article.hidden = other !== place;
    });
    [...tabs.children].forEach((tab, other) => tab.setAttribute("aria-pressed", String(other === place)));
    if (isInSight(root)) {
      views[place].draw();
    }
  }

  picture.sections.forEach((section, place) => {
    const count = picture.findings.filter((finding) => finding.section === place && !finding.silenced).length;
    const text = count ? `${section.title} (${count})` : section.title;
    tabs.append(button(text, () => state.choose({ program, section: place })));
  });
  tabs.hidden = views.length < 2;
  root.querySelector(".bar").hidden = !views.length;
  root.querySelector(".aside").hidden = false;
  viewSwitch(root, articles, state, program);
  root.querySelector(".windows").append(
    button("To move", () => {
      const { section, move } = state.chosen;
      if (move !== null && state.chosen.program === program) {
        const way = wayOf(picture.sections[section], move);
        views[section].closeUp(way, 2 * (picture.sections[section].radius || 0.5));
      }
    }),
    button("Back", () => views[shown].back()),
    button("Whole", () => views[shown].whole()),
  );
  const titles = ["Zoom to the chosen move", "The window before the zoom", "The whole face"];
  [...root.querySelector(".windows").children].forEach((made, number) => {
    made.title = titles[number];
  });
  if (program === 0) {
    root.querySelector("header").append(themeSwitch());
  }
  if (views.length) {
    show(0);
    new IntersectionObserver((entries) => entries.some((entry) => entry.isIntersecting) && views[shown].draw(), { rootMargin: "400px" })
      .observe(root.querySelector(".stage"));
  }
  state.subscribe((chosen) => {
    if (chosen.program === program && chosen.section !== null && chosen.section !== shown) {
      show(chosen.section);
    }
  });
  return { views, shown: () => views[shown] };
}

function isInSight(root) {
  const { top, bottom } = root.getBoundingClientRect();
  return bottom > 0 && top < document.documentElement.clientHeight;
}

/** Face, machine, or both. */
function viewSwitch(root, articles, state, program) {
  const names = { face: "Face", machine: "Machine", both: "Both" };
  const place = root.querySelector(".view-switch");
  const buttons = Object.entries(names).map(([view, name]) => [view, button(name, () => state.choose({ program, view }))]);
  place.append(...buttons.map(([, made]) => made));
  function show({ view }) {
    buttons.forEach(([name, made]) => made.setAttribute("aria-pressed", String(name === view)));
    articles.forEach((article) => {
      article.dataset.view = view;
    });
  }
  show(state.chosen);
  state.subscribe(show);
}
