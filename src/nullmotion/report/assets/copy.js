// Tables to take away: a row a line, tabs between cells, numbers as a spreadsheet reads them.
document.querySelectorAll("[data-copy]").forEach((button) => button.addEventListener("click", async () => {
  const rows = [...document.querySelectorAll(`#${button.dataset.copy} tr`)];
  const written = (cell) => cell.querySelector("[data-value]")?.dataset.value ?? cell.textContent.trim().replace(/\s+/g, " ");
  const text = rows.map((row) => [...row.cells].map(written).join("\t")).join("\n");
  const said = document.getElementById(`${button.dataset.copy}-copied`);
  const by = (area) => {
    document.body.append(area);
    area.select();
    const done = document.execCommand("copy");
    area.remove();
    button.focus();
    return done;
  };
  const kept = await navigator.clipboard?.writeText(text).then(() => true, () => false);
  const done = kept || by(Object.assign(document.createElement("textarea"), { value: text }));
  said.textContent = done ? "Copied." : "The browser does not allow copying here.";
  setTimeout(() => { said.textContent = ""; }, 2500);
}));
