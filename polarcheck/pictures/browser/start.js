// ---- start: the data into the pictures ----

function start() {
  if (typeof Plotly === "undefined") {
    document.querySelector("main").prepend(element("p", "The library that draws is missing beside this page."));
    return;
  }
  const told = element("dl");
  told.id = "told";
  told.hidden = true;
  document.body.append(told);
  let choose = () => {};
  const programs = JSON.parse(document.getElementById("data").textContent).map(({ findings, sections }, program) => ({
    findings,
    views: sections.map((section, place) =>
      sectionView(document.getElementById(`p${program}s${place}`), section, (move) => choose(program, place, move)),
    ),
  }));
  choose = chooser(programs);
  const views = programs.flatMap((program) => program.views);
  const inSight = new IntersectionObserver(
    (entries) => entries.filter((entry) => entry.isIntersecting).forEach((entry) => views.find((view) => view.root === entry.target).draw()),
    { rootMargin: "400px" },
  );
  views.forEach((view) => inSight.observe(view.root));
  printable(views);
  served(() => null, () => {});
}

start();
