// What planes of momentum space have in common: cuts, lines by type, a frame with scales, colours.
const rgbOf = (hex) => [1, 3, 5].map((i) => parseInt(hex.slice(i, i + 2), 16));

// 256 colours between a scale's anchors, three numbers each.
function ramp(anchors) {
  const found = new Uint8ClampedArray(768);
  for (let k = 0; k < 256; k += 1) {
    const place = (k / 255) * (anchors.length - 1), i = Math.min(Math.floor(place), anchors.length - 2);
    for (let j = 0; j < 3; j += 1) found[3 * k + j] = anchors[i][j] + (place - i) * (anchors[i + 1][j] - anchors[i][j]);
  }
  return found;
}

// Where a plane cuts the triangles that are switched on: pairs of points, their types and levels.
function cut(surface, shown, plane) {
  const { corner, place, kind, level } = surface;
  const ends = [], kinds = [], levels = [];
  for (const t of chosen(surface, shown, null)) {
    const side = [0, 1, 2].map((j) => {
      const v = 3 * corner[3 * t + j];
      return plane.normal[0] * place[v] + plane.normal[1] * place[v + 1] + plane.normal[2] * place[v + 2] - plane.offset;
    });
    if ((side[0] > 0) === (side[1] > 0) && (side[1] > 0) === (side[2] > 0)) continue;
    let mean = 0;
    for (let j = 0; j < 3; j += 1) {
      const next = (j + 1) % 3;
      if ((side[j] > 0) === (side[next] > 0)) continue;
      const f = side[j] / (side[j] - side[next]);
      const [p, q] = [3 * corner[3 * t + j], 3 * corner[3 * t + next]];
      for (let i = 0; i < 3; i += 1) ends.push(place[p + i] + f * (place[q + i] - place[p + i]));
      mean += 0.5 * (level[corner[3 * t + j]] * (1 - f) + level[corner[3 * t + next]] * f);
    }
    kinds.push(kind[t]);
    levels.push(mean);
  }
  return { ends, kinds, levels };
}

// Draws pieces of lines: by type, or by their level where `colours` is a ramp.
function strokes(context, { ends, kinds, levels }, to, looks, { colours = null, width = (look) => look.width, halo = 0, around = "rgba(255,255,255,.75)" } = {}) {
  const points = [];
  for (let i = 0; i < ends.length; i += 3) points.push(to(ends.slice(i, i + 3)));
  const bins = new Map();
  kinds.forEach((kind, i) => {
    const bin = colours ? 64 * kind + (levels[i] >> 3) : kind;
    if (!bins.has(bin)) bins.set(bin, []);
    bins.get(bin).push(i);
  });
  context.lineCap = "round";
  for (const [bin, pieces] of bins) {
    const look = looks[colours ? bin >> 6 : bin], k = 3 * (8 * (bin & 31) + 4);
    context.beginPath();
    for (const i of pieces) { context.moveTo(...points[2 * i]); context.lineTo(...points[2 * i + 1]); }
    if (halo) { Object.assign(context, { strokeStyle: around, lineWidth: width(look) + halo }); context.stroke(); }
    Object.assign(context, { strokeStyle: colours ? `rgb(${colours[k]},${colours[k + 1]},${colours[k + 2]})` : look.colour, lineWidth: width(look) });
    context.stroke();
  }
}

// Bright colours of the scale need an edge on white.
const byTorque = (colours) => ({ colours, halo: colours ? 1.6 : 0, around: "rgba(27,31,36,.45)" });

// A square or oblong piece of a plane inside a canvas: from its two coordinates to pixels and back.
function frame(width, height, [x0, x1], [y0, y1]) {
  const edge = { left: 50, right: 14, top: 8, bottom: 40 };
  const scale = Math.min((width - edge.left - edge.right) / (x1 - x0), (height - edge.top - edge.bottom) / (y1 - y0));
  const [wide, high] = [scale * (x1 - x0), scale * (y1 - y0)];
  const left = edge.left + (width - edge.left - edge.right - wide) / 2, top = edge.top;
  return {
    left, top, wide, high, scale, x: [x0, x1], y: [y0, y1],
    to: (a, b) => [left + scale * (a - x0), top + scale * (y1 - b)],
    from: (px, py) => [x0 + (px - left) / scale, y1 - (py - top) / scale],
  };
}

function scales(context, { left, top, wide, high, x, y, to }, names, { lines = true } = {}) {
  const step = nice(Math.max(x[1] - x[0], y[1] - y[0]) / 2, 3), quiet = { colour: "#5b6570", size: 11 };
  const steps = ([low, high]) => Array.from({ length: Math.floor(high / step) - Math.ceil(low / step) + 1 }, (_, k) => (Math.ceil(low / step) + k) * step);
  const shade = (v) => (Math.abs(v) < 1e-9 * step ? "#5b6570" : "#e3e6ea");
  for (const v of steps(x)) {
    const [at] = to(v, y[0]);
    line(context, lines ? [[at, top], [at, top + high]] : [[at, top + high], [at, top + high + 4]], lines ? shade(v) : "#5b6570", 1);
    words(context, tidy(v), at, top + high + 11, quiet);
  }
  for (const v of steps(y)) {
    const [, at] = to(x[0], v);
    line(context, lines ? [[left, at], [left + wide, at]] : [[left - 4, at], [left, at]], lines ? shade(v) : "#5b6570", 1);
    words(context, tidy(v), left - 6, at, { ...quiet, align: "right" });
  }
  Object.assign(context, { strokeStyle: "#5b6570", lineWidth: 1 });
  context.strokeRect(left, top, wide, high);
  words(context, `${names[0]} [N m s]`, left + wide / 2, top + high + 28, { size: 12 });
  context.save();
  context.translate(left - 38, top + high / 2);
  context.rotate(-Math.PI / 2);
  words(context, `${names[1]} [N m s]`, 0, 0, { size: 12 });
  context.restore();
}

// Circles of the radii where a plane meets them; `at` is the plane's foot towards the origin.
function circles(context, { normal, foot, to }, scale, balls) {
  for (const ball of balls) {
    const away = dot(normal, foot) - dot(normal, ball.centre);
    if (ball.radius <= Math.abs(away)) continue;
    context.beginPath();
    context.arc(...to(ball.centre), scale * Math.sqrt(ball.radius ** 2 - away ** 2), 0, 2 * Math.PI);
    Object.assign(context, { strokeStyle: ball.colour, lineWidth: 1.6 });
    context.setLineDash(DASH[ball.dash]);
    context.stroke();
    context.setLineDash([]);
  }
}

function dotAt(context, [x, y], size = 5, opacity = 1) {
  context.globalAlpha = opacity;
  context.beginPath();
  context.arc(x, y, size, 0, 2 * Math.PI);
  Object.assign(context, { fillStyle: "#fff", strokeStyle: "#1b1f24", lineWidth: 2.3 });
  context.fill();
  context.stroke();
  context.globalAlpha = 1;
}
