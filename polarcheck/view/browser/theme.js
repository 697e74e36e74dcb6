// ---- theme: light or dark, as the system has it or as chosen; drawings read their colors from the style ----

const THEME_NAMES = { "": "system", light: "light", dark: "dark" };
const themeViews = [];

/** The color of a custom property of the style, as "--ink". */
function color(name) {
  return getComputedStyle(document.documentElement).getPropertyValue(name).trim();
}

/** Choose "light", "dark", or "" for what the system has. */
function theme(name) {
  if (name) {
    document.documentElement.dataset.theme = name;
  } else {
    delete document.documentElement.dataset.theme;
  }
  themeViews.forEach((view) => view());
}

/** Call view() after each change of colors. */
function onTheme(view) {
  themeViews.push(view);
}

/** The button that goes from one theme to the next. */
function themeSwitch() {
  const names = Object.keys(THEME_NAMES);
  const made = button("", () => {
    const next = names[(names.indexOf(document.documentElement.dataset.theme || "") + 1) % names.length];
    theme(next);
  });
  made.className = "theme";
  const show = () => {
    made.textContent = `Theme: ${THEME_NAMES[document.documentElement.dataset.theme || ""]}`;
  };
  show();
  onTheme(show);
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => theme(document.documentElement.dataset.theme || ""));
  return made;
}
