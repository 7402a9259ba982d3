// Gimbals turned by hand: one by one, to a singular point, to a point of a torque map.
function byHand(delta, from = "set by hand", marked = null) {
  if (state.motion) pause();
  Object.assign(state, { byHand: true, delta, from, marked });
  show();
}

all("[data-gimbal]").forEach((input, i) => input.addEventListener("input", () => {
  byHand(state.delta.map((d, k) => (k === i ? Number(input.value) * RADIAN : d)));
}));

// ---- a singular point: by pointing at a surface, or by signs and direction ----
function direction() {
  const [az, el] = ["#atlas-azimuth", "#atlas-elevation"].map((id) => Number($(id).value) * RADIAN);
  return [Math.cos(el) * Math.cos(az), Math.cos(el) * Math.sin(az), Math.sin(el)];
}

function visit(owner, u) {
  const signs = data.sheets[owner].signs, found = singularPoint(cmgs, u, signs);
  const kind = data.kinds.find((k) => k.key === found.kind);
  byHand(found.delta, "at a singular point", momentumOf(cmgs, found.delta));
  told("point", `${kind.name}, ${kind.meaning}. Signs ${data.sheets[owner].name}, u = ${vector(u)}.`);
}

if (!planar) {
  const follow = () => visit(Number($("#atlas-sheet").value), direction());
  for (const id of ["#atlas-sheet", "#atlas-azimuth", "#atlas-elevation"]) $(id).addEventListener("input", () => { degrees(id); follow(); });
  $("#atlas-visit").addEventListener("click", follow);
}
function degrees(id) {
  const input = $(id);
  const output = input.parentElement.querySelector("output");
  if (!output) return;
  output.textContent = `${fixed(Number(input.value), 0)}°`;
  input.setAttribute("aria-valuetext", `${input.value} degrees`);
}
function point(u, owner) {
  $("#atlas-sheet").value = String(owner);
  $("#atlas-azimuth").value = String(Math.round(Math.atan2(u[1], u[0]) / RADIAN));
  $("#atlas-elevation").value = String(Math.round(Math.asin(clamp(u[2], -1, 1)) / RADIAN));
  ["#atlas-azimuth", "#atlas-elevation"].forEach(degrees);
  visit(owner, u);
}

// A flat piece has gimbal angles of its own at each corner, a sheet has them by u and signs.
function meet({ owner, kind, u, vertex }) {
  const { delta, name } = data.sheets[owner];
  if (delta === undefined) point(u, owner);
  else {
    const found = angles(array(delta), vertex), look = data.kinds[kind];
    byHand(found, "at a singular point", momentumOf(cmgs, found));
    told("point", `${look.name}, ${look.meaning}. Signs ${name}, u = ${vector(u)}.`);
  }
}

// One row of a table of gimbal angles in 16 bits.
function angles(table, row) {
  const n = cmgs.h0.length;
  return Array.from(table.subarray(row * n, (row + 1) * n), (d) => (d * Math.PI) / 32768);
}
