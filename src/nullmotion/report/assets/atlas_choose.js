// What is drawn: toggles, colours, the cutting plane.
all("[data-kind]").forEach((box) => box.addEventListener("change", () => { state.kinds[Number(box.dataset.kind)] = box.checked; repaint(); }));
all("[data-sheet]").forEach((box) => box.addEventListener("change", () => { state.sheets[Number(box.dataset.sheet)] = box.checked; groups(); repaint(); }));
all("[data-sphere]").forEach((box) => box.addEventListener("change", () => { state.spheres[box.dataset.sphere] = box.checked; repaint(); }));
all("[data-minus]").forEach((box) => box.addEventListener("change", () => {
  all(`[data-sheet][data-of="${box.dataset.minus}"]`).forEach((one) => { one.checked = box.checked; state.sheets[Number(one.dataset.sheet)] = box.checked; });
  repaint();
}));
function groups() {
  all("[data-minus]").forEach((box) => {
    const own = all(`[data-sheet][data-of="${box.dataset.minus}"]`).map((one) => one.checked);
    box.checked = own.every(Boolean);
    box.indeterminate = own.some(Boolean) && !box.checked;
  });
}
groups();

$("#atlas-colour")?.addEventListener("change", (event) => {
  state.colour = event.target.value;
  $("#atlas-scale").hidden = state.colour === "type";
  space.changed();
});

// ---- the cutting plane ----
function setPlane() {
  const which = $("#atlas-plane").value, on = which !== "none";
  const offset = (Number($("#atlas-offset").value) / 100) * data.radius;
  $("#atlas-offset").disabled = !on;
  $("#atlas-slice").closest("figure").hidden = !on;
  if (!on) state.plane = null;
  else if (which === "view") {
    const kept = state.plane?.which === "view" ? state.plane.frame : look.axes();
    state.plane = { which, frame: kept, normal: kept[2], across: kept[0], upward: kept[1], names: ["h to the right", "h upward"] };
  } else {
    const [across, upward] = { 0: [1, 2], 1: [0, 2], 2: [0, 1] }[which];
    const axis = (k) => [0, 1, 2].map((j) => (j === k ? 1 : 0));
    state.plane = { which, normal: axis(Number(which)), across: axis(across), upward: axis(upward), names: [`h${AXES[across]}`, `h${AXES[upward]}`] };
  }
  if (on) state.plane.offset = offset;
  const text = `${fixed(offset, 3)} N m s`;
  $("#atlas-offset").setAttribute("aria-valuetext", text);
  $("#atlas-offset-text").textContent = on ? fixed(offset, 3) : "–";
  space.changed();
}
if (!planar) {
  $("#atlas-plane").addEventListener("change", () => { state.plane = null; setPlane(); });
  $("#atlas-offset").addEventListener("input", setPlane);
  setPlane();
}
