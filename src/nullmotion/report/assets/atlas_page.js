// The page: what the controls do, what is said in words, how time runs.
const data = JSON.parse(document.getElementById("atlas-data").textContent);
const section = document.getElementById("atlas");
const array = decoder(data.arrays);
const cmgs = data.array;
const planar = cmgs.torque_axes.length < 3;
const $ = (selector) => section.querySelector(selector);
const all = (selector) => [...section.querySelectorAll(selector)];

const state = {
  kinds: data.kinds.map((k) => k.shown), sheets: data.sheets.map((s) => s.shown), spheres: {},
  plane: planar ? flatPlane() : null,
  motion: data.motions[0] ?? null, time: 0, byHand: data.motions.length === 0,
  delta: [...cmgs.home], momentum: [0, 0, 0], marked: null,
};
data.spheres.forEach((ball) => { state.spheres[ball.key] = ball.shown; });

function flatPlane() {
  return { normal: [0, 0, 1], offset: 0, across: [1, 0, 0], upward: [0, 1, 0], names: data.axis_names.map((name) => `h${name}`) };
}

// ---- pictures ----
const space = planar ? null : spaceView(data, array, state);
arrayView(data, state);
const lines = planar ? lineSection : space.section;
const slice = sliceView(data, array, state, lines);

function lineSection() {
  const ends = [], kinds = [];
  data.sheets.forEach((sheet, owner) => {
    if (!state.sheets[owner]) return;
    const h = array(sheet.h), kind = array(sheet.kind), cells = array(data.meshes[sheet.mesh].triangles);
    for (let e = 0; e < cells.length; e += 2) {
      const [a, b] = [cells[e], cells[e + 1]];
      if (!state.kinds[kind[a]]) continue;
      for (const v of [a, b]) ends.push(h[2 * v] * data.quantum, h[2 * v + 1] * data.quantum, 0);
      kinds.push(kind[a]);
    }
  });
  return { ends, kinds };
}

// ---- where the gimbals are ----
function told(key, text) {
  const place = $(`[data-told="${key}"]`);
  if (place && place.textContent !== text) place.textContent = text;
}

function show() {
  const own = !state.byHand && state.motion;
  if (own) {
    const times = array(own.t);
    state.delta = sample(times, array(own.delta), cmgs.h0.length, state.time);
    state.momentum = sample(times, array(own.h), 3, state.time);
  } else state.momentum = inTorqueSpace(cmgs, momentumOf(cmgs, state.delta));
  const h = state.momentum.slice(0, cmgs.torque_axes.length), size = Math.hypot(...h);
  const sigma = own && own.sigma !== undefined
    ? sample(array(own.t), array(own.sigma), 1, state.time)[0]
    : singularValues(cmgs, state.delta).at(-1);
  told("momentum", `${vector(h)} N m s`);
  told("size", `${fixed(size, 3)} N m s = ${fixed(size / cmgs.mean, 3)} × mean h0`);
  told("sigma", `${fixed(sigma, 4)}${sigma < 0.01 ? " (singular)" : ""}`);
  told("angles", state.delta.map((d) => fixed(wrapped(d) / RADIAN, 1)).join(", "));
  told("source", own ? `${own.label}, t = ${tidy(state.time)} s` : state.marked ? "at a singular point" : "set by hand");
  all("[data-gimbal]").forEach((input, i) => {
    const degrees = wrapped(state.delta[i]) / RADIAN;
    if (document.activeElement !== input || own) input.value = String(Math.round(10 * degrees) / 10);
    input.setAttribute("aria-valuetext", `${fixed(degrees, 1)} degrees`);
    input.parentElement.querySelector("output").textContent = `${fixed(degrees, 1)}°`;
  });
  repaint(...[...painters].filter((p) => !p.heavy));
}

const wrapped = (angle) => angle - 2 * Math.PI * Math.round(angle / (2 * Math.PI));

// ---- time, shared with the charts of a run ----
const clock = $("#atlas-time");
const span = () => {
  const times = array(state.motion.t);
  return [times[0], times.at(-1)];
};
const whole = () => data.motions.reduce(([from, to], motion) => {
  const times = array(motion.t);
  return [Math.min(from, times[0]), Math.max(to, times.at(-1))];
}, [Infinity, -Infinity]);

function goTo(time, tell = true) {
  const [from, to] = whole();
  state.time = clamp(time, from, to);
  state.byHand = false;
  state.marked = null;
  clock.value = String(Math.round((1000 * (state.time - from)) / (to - from || 1)));
  const text = `${tidy(state.time)} s`;
  $("#atlas-clock").textContent = text;
  clock.setAttribute("aria-valuetext", text);
  show();
  if (tell) document.dispatchEvent(new CustomEvent("atlas-time", { detail: state.time }));
}

if (state.motion) {
  clock.addEventListener("input", () => {
    const [from, to] = whole();
    pause();
    goTo(from + (Number(clock.value) / 1000) * (to - from));
  });
  document.addEventListener("chart-time", (event) => goTo(event.detail, false));
  $("#atlas-play").addEventListener("click", () => (playing ? pause() : play()));
  $("#atlas-motion")?.addEventListener("change", (event) => {
    state.motion = data.motions[Number(event.target.value)];
    goTo(state.time);
  });
}

let playing = 0;
function play() {
  const [from, to] = span();
  const begin = state.time >= to - 1e-9 || state.time < from ? from : state.time;
  const pace = Math.max((to - from) / 12, 1e-9); // a run takes twelve seconds
  const started = performance.now();
  $("#atlas-play").textContent = "Pause";
  const step = (now) => {
    const time = begin + (pace * Math.max(0, now - started)) / 1000;
    goTo(Math.min(time, to));
    if (time < to) playing = requestAnimationFrame(step); else pause();
  };
  playing = requestAnimationFrame(step);
}
function pause() {
  cancelAnimationFrame(playing);
  playing = 0;
  $("#atlas-play").textContent = "Play";
}

// ---- by hand ----
all("[data-gimbal]").forEach((input, i) => input.addEventListener("input", () => {
  if (state.motion) pause();
  Object.assign(state, { byHand: true, marked: null });
  state.delta = [...state.delta];
  state.delta[i] = Number(input.value) * RADIAN;
  show();
}));

// ---- a singular point: by pointing at a surface, or by signs and direction ----
function direction() {
  const [az, el] = ["#atlas-azimuth", "#atlas-elevation"].map((id) => Number($(id).value) * RADIAN);
  return [Math.cos(el) * Math.cos(az), Math.cos(el) * Math.sin(az), Math.sin(el)];
}

function visit(owner, u) {
  const signs = data.sheets[owner].signs, found = singularPoint(cmgs, u, signs);
  const kind = data.kinds.find((k) => k.key === found.kind);
  if (state.motion) pause();
  Object.assign(state, { byHand: true, delta: found.delta });
  state.marked = momentumOf(cmgs, found.delta);
  told("point", `${kind.name}, ${kind.meaning}. Signs ${data.sheets[owner].name}, u = ${vector(u)}.`);
  show();
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

// ---- toggles ----
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
  space.moved();
}
if (!planar) {
  $("#atlas-plane").addEventListener("change", () => { state.plane = null; setPlane(); });
  $("#atlas-offset").addEventListener("input", setPlane);
  setPlane();
}
