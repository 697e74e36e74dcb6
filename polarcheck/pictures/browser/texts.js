// ---- texts: the source and the table of moves, one of which is shown ----

/** The tabs of a program; the source is shown first if there is one. */
function textsView(root, picture) {
  const place = root.querySelector(".text-switch");
  const panels = { Source: root.querySelector(".source"), Moves: root.querySelector(".move-list") };
  const names = Object.keys(panels).filter((name) => (name === "Source" ? panels[name].childElementCount : picture.sections.length));
  const tabs = names.map((name) => {
    const tab = button(name, () => show(name));
    tab.setAttribute("role", "tab");
    tab.id = `${root.id}-${name}`;
    panels[name].id = `${root.id}-${name}-panel`;
    tab.setAttribute("aria-controls", panels[name].id);
    return tab;
  });

  function show(shown) {
    Object.entries(panels).forEach(([name, panel]) => {
      panel.hidden = name !== shown;
    });
    names.forEach((name, number) => {
      tabs[number].setAttribute("aria-selected", String(name === shown));
      tabs[number].tabIndex = name === shown ? 0 : -1;
    });
  }

  place.append(...tabs);
  place.addEventListener("keydown", (event) => {
    const way = { ArrowRight: 1, ArrowLeft: -1 }[event.key];
    if (way) {
      event.preventDefault();
      const next = tabs[(tabs.indexOf(document.activeElement) + way + tabs.length) % tabs.length];
      next.focus();
      next.click();
    }
  });
  place.hidden = names.length < 2;
  root.querySelector(".texts").hidden = !names.length;
  show(names[0]);
}
