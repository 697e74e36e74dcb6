// ---- printing: all pictures are drawn, as wide as a page of A4 or Letter leaves room ----

const PAPER = { width: 660, face: 410, rates: 220 };

function printable(views) {
  const resized = (sizes) => {
    for (const view of views.filter((one) => one.isDrawn())) {
      view.plots().forEach((plot, place) => Plotly.relayout(plot, sizes(place)));
    }
  };
  window.addEventListener("beforeprint", () => {
    views.forEach((view) => view.draw());
    resized((place) => ({ autosize: false, width: PAPER.width, height: place ? PAPER.rates : PAPER.face }));
  });
  window.addEventListener("afterprint", () => {
    resized(() => ({ autosize: true, width: null, height: null }));
    views.forEach((view) => view.plots().forEach((plot) => view.isDrawn() && Plotly.Plots.resize(plot)));
  });
}
