// What the page shows, in pictures and in words.
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
  delta: [...cmgs.home], momentum: [0, 0, 0], marked: null, from: "set by hand", colour: "type",
};
data.spheres.forEach((ball) => { state.spheres[ball.key] = ball.shown; });

function flatPlane() {
  return { normal: [0, 0, 1], offset: 0, across: [1, 0, 0], upward: [0, 1, 0], names: data.axis_names.map((name) => `h${name}`) };
}

// ---- pictures ----
const space = planar ? null : spaceView(data, array, state);
arrayView(data, state);
const lines = planar ? lineSection : space.section;
sliceView(data, array, state, lines, () => space?.paints());

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
  told("source", own ? `${own.label}, t = ${tidy(state.time)} s` : state.from);
  all("[data-gimbal]").forEach((input, i) => {
    const degrees = wrapped(state.delta[i]) / RADIAN;
    if (document.activeElement !== input || own) input.value = String(Math.round(10 * degrees) / 10);
    input.setAttribute("aria-valuetext", `${fixed(degrees, 1)} degrees`);
    input.parentElement.querySelector("output").textContent = `${fixed(degrees, 1)}°`;
  });
  repaint(...[...painters].filter((p) => !p.heavy));
}

const wrapped = (angle) => angle - 2 * Math.PI * Math.round(angle / (2 * Math.PI));
