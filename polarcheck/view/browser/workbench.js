// ---- workbench: the sections of a program, one of which is shown; and how its face is seen ----

/** Sections up to this number have a button each. */
const TABS = 4;
/** Space below the player, and the least height of a face [px]. */
const SPARE_HEIGHT = 12;
const LEAST_FACE = 300;

/** The views of all sections of a program. root: the element of the program. */
function sectionsView(root, picture, state, program) {
  const articles = [...root.querySelectorAll(".polar")];
  const views = picture.sections.map((_, place) => sectionView(articles[place], picture, state, program, place));
  let shown = 0;

  function show(place) {
    shown = place;
    articles.forEach((article, other) => {
      article.hidden = other !== place;
    });
    showTab(place);
    if (isInSight(root)) {
      fit();
      views[place].draw();
      fit();
    }
  }

  /** The face is as high as the window leaves room for below the buttons and above the legend and the player. */
  function fit() {
    const article = articles[shown];
    const [top, bottom] = [root, article.querySelector(".views")].map((part) => part.getBoundingClientRect().top);
    const below = [...article.querySelectorAll(".legend, .player")].reduce((sum, part) => sum + part.offsetHeight, 0);
    const height = document.documentElement.clientHeight - (bottom - top) - below - SPARE_HEIGHT;
    const now = `${Math.min(Math.max(Math.round(height), LEAST_FACE), 1000)}px`;
    if (root.style.getPropertyValue("--face") !== now) {
      root.style.setProperty("--face", now);
      if (views[shown].isDrawn()) {
        Plotly.Plots.resize(views[shown].face);
      }
    }
  }

  const showTab = tabsOf(root.querySelector(".tabs"), picture, (place) => state.choose({ program, section: place }));
  articles.forEach((article) => {
    article.querySelector("h2").classList.toggle("only-printed", views.length > 1);
  });
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
    show(firstSection(picture));
    window.addEventListener("resize", () => requestAnimationFrame(fit));
    new IntersectionObserver((entries) => entries.some((entry) => entry.isIntersecting) && show(shown), { rootMargin: "400px" })
      .observe(root.querySelector(".stage"));
  }
  state.subscribe((chosen) => {
    if (chosen.program === program && chosen.section !== null && chosen.section !== shown) {
      show(chosen.section);
    }
  });
  return { views, shown: () => views[shown] };
}

/** The section of the worst finding, the first one without findings. */
function firstSection({ order, findings }) {
  const worst = order.find((number) => findings[number].section !== null && !findings[number].silenced);
  return worst === undefined ? 0 : findings[worst].section;
}

/** Buttons for a few sections, a list for many. Returns what shows a section as chosen. */
function tabsOf(place, picture, choose) {
  const texts = picture.sections.map((section, number) => {
    const count = picture.findings.filter((finding) => finding.section === number && !finding.silenced).length;
    return count ? `${section.title} (${count} ${count === 1 ? "finding" : "findings"})` : section.title;
  });
  place.hidden = texts.length < 2;
  if (texts.length <= TABS) {
    const tabs = texts.map((text, number) => button(text, () => choose(number)));
    place.append(...tabs);
    return (shown) => tabs.forEach((tab, number) => tab.setAttribute("aria-pressed", String(number === shown)));
  }
  const list = element("select", "", ...texts.map((text, number) => Object.assign(element("option", `${number + 1}. ${text}`), { value: String(number) })));
  list.setAttribute("aria-label", "Polar section");
  list.addEventListener("change", () => choose(Number(list.value)));
  const step = (way) => choose(Math.min(Math.max(Number(list.value) + way, 0), texts.length - 1));
  const [before, next] = [button("\u25c0", () => step(-1)), button("\u25b6", () => step(1))];
  before.setAttribute("aria-label", "Section before");
  next.setAttribute("aria-label", "Next section");
  place.append(before, list, next);
  return (shown) => {
    list.value = String(shown);
  };
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
