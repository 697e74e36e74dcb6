// ---- data: what is drawn, as the page holds it ----

/** A value of `packing.py` as it was before it was packed. */
function unpacked(value) {
  if (Array.isArray(value)) {
    return value.length && typeof value[0] !== "object" ? value : value.map(unpacked);
  }
  if (value === null || typeof value !== "object") {
    return value;
  }
  if (value.steps) {
    const unit = Number(`1e${value.digits}`);
    let sum = 0;
    return value.steps.map((step) => {
      sum += step;
      return step === null ? null : sum / unit;
    });
  }
  if (value.columns) {
    const columns = value.columns.map(unpacked);
    return columns[0].map((_, row) => columns.map((column) => column[row]));
  }
  return Object.fromEntries(Object.entries(value).map(([name, element]) => [name, unpacked(element)]));
}

/** Calls `begin` with the pictures of the page; at once where they are not packed. */
function withData(begin) {
  const { type, textContent } = document.getElementById("data");
  if (type === "application/json") {
    begin(JSON.parse(textContent));
    return;
  }
  if (typeof DecompressionStream === "undefined") {
    document.querySelector("main").prepend(element("p", "The pictures need a browser of 2023 or later; all findings are in the table."));
    return;
  }
  const bytes = Uint8Array.from(atob(textContent), (character) => character.charCodeAt(0));
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
  new Response(stream).text().then((text) => begin(unpacked(JSON.parse(text))));
}
