// ---- printing: all pictures are drawn, as wide as a page of A4 or Letter leaves room, dark on white ----

const PAPER = { width: 690, face: 320, rates: 175 };

/** views: those of all sections; each is shown and drawn as the page is printed. */
function printable(views) {
  const resized = (sizes) => {
    for (const view of views.filter((one) => one.isDrawn())) {
      view.plots().forEach((plot, place) => Plotly.relayout(plot, sizes(place)));
    }
  };
  let before = null;
  window.addEventListener("beforeprint", () => {
    if (before !== null) {
      return;
    }
    before = { theme: document.documentElement.dataset.theme || "", hidden: views.map((view) => view.root.hidden) };
    theme("light");
    views.forEach((view) => {
      view.root.hidden = false;
      view.draw();
    });
    resized((place) => ({ autosize: false, width: PAPER.width, height: place ? PAPER.rates : PAPER.face }));
  });
  window.addEventListener("afterprint", () => {
    if (before === null) {
      return;
    }
    resized(() => ({ autosize: true, width: null, height: null }));
    views.forEach((view, place) => {
      view.root.hidden = before.hidden[place];
      view.plots().forEach((plot) => view.isDrawn() && !view.root.hidden && Plotly.Plots.resize(plot));
    });
    theme(before.theme);
    before = null;
  });
}
