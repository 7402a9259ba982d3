// Vectors, the common direction of view, numbers as text, arrays out of base64.
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const scaled = (a, s) => [a[0] * s, a[1] * s, a[2] * s];
const sum = (a, b) => [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const length = (a) => Math.hypot(a[0], a[1], a[2]);
const unit = (a) => scaled(a, 1 / (length(a) || 1));
const clamp = (v, low, high) => Math.min(high, Math.max(low, v));
const RADIAN = Math.PI / 180;

const tidy = (v, digits = 4) => {
  if (!Number.isFinite(v)) return "–";
  const size = Math.abs(v);
  if (size < 1e-9) return "0";
  const written = size < 1e-3 || size >= 1e5 ? v.toExponential(digits - 2) : String(+v.toPrecision(digits));
  return written.replaceAll("-", "−");
};
const fixed = (v, digits) => (Math.abs(v) < 0.5 * 10 ** -digits ? 0 : v).toFixed(digits).replaceAll("-", "−");
const vector = (v, digits = 3) => `(${v.map((x) => fixed(x, digits)).join(", ")})`;

function bytes(text) {
  if (Uint8Array.fromBase64) return Uint8Array.fromBase64(text);
  const raw = atob(text), found = new Uint8Array(raw.length);
  for (let i = 0; i < raw.length; i += 1) found[i] = raw.charCodeAt(i);
  return found;
}

function decoder(coded) {
  const kinds = { f8: Float64Array, f4: Float32Array, i2: Int16Array, i1: Int8Array, u1: Uint8Array, u2: Uint16Array, u4: Uint32Array };
  const known = new Map();
  return (index) => {
    if (!known.has(index)) {
      const [kind, text] = coded[index].split(":");
      known.set(index, new kinds[kind](bytes(text).buffer));
    }
    return known.get(index);
  };
}

// Both pictures are seen from the same side, so that what points alike is drawn alike.
const look = {
  azimuth: -55 * RADIAN, elevation: 24 * RADIAN, zoom: { space: 1, array: 1 },
  // Rows: to the right, up, towards the eye.
  axes() {
    const [ca, sa, ce, se] = [Math.cos(this.azimuth), Math.sin(this.azimuth), Math.cos(this.elevation), Math.sin(this.elevation)];
    return [[-sa, ca, 0], [-se * ca, -se * sa, ce], [ce * ca, ce * sa, se]];
  },
  turn(right, up) {
    this.azimuth -= right;
    this.elevation = clamp(this.elevation + up, -Math.PI / 2, Math.PI / 2);
  },
  scale(factor, which) { this.zoom[which] = clamp(this.zoom[which] * factor, 0.5, 12); },
  reset() { Object.assign(this, { azimuth: -55 * RADIAN, elevation: 24 * RADIAN, zoom: { space: 1, array: 1 } }); },
};

const EYE = 6; // distance of the eye over the radius of what is shown

// A view's projection: from space [any unit, `radius` fills the view] to pixels.
function projection(width, height, radius, zoom) {
  const [right, up, towards] = look.axes();
  const size = (0.46 * Math.min(width, height) * zoom) / radius;
  const far = EYE * radius;
  return {
    right, up, towards, size, far, width, height,
    to(p) {
      const f = (size * far) / (far - dot(towards, p));
      return [width / 2 + f * dot(right, p), height / 2 - f * dot(up, p)];
    },
    // Radius in pixels of a sphere, as its outline shows it.
    outline(r, centre) {
      const away = far - dot(towards, centre);
      return (size * far * r) / Math.sqrt(Math.max(away * away - r * r, 1e-12));
    },
  };
}

// Everything that wants to be drawn again is drawn once, before the next frame.
const painters = new Set();
const waiting = new Set();
function repaint(...which) {
  const idle = waiting.size === 0;
  for (const painter of which.length ? which : painters) waiting.add(painter);
  if (idle) requestAnimationFrame(() => {
    const now = [...waiting];
    waiting.clear();
    now.forEach((painter) => painter());
  });
}

// A canvas that is as sharp as the screen; `paint(context, width, height)` counts in CSS pixels.
function sheetOf(canvas, paint) {
  const painter = () => {
    const [width, height] = [canvas.clientWidth, canvas.clientHeight];
    if (!width || !height) return;
    const density = Math.max(1, devicePixelRatio);
    const [w, h] = [Math.round(width * density), Math.round(height * density)];
    if (canvas.width !== w || canvas.height !== h) Object.assign(canvas, { width: w, height: h });
    const context = canvas.getContext("2d");
    context.setTransform(density, 0, 0, density, 0, 0);
    context.clearRect(0, 0, width, height);
    paint(context, width, height);
  };
  painters.add(painter);
  new ResizeObserver(() => repaint(painter)).observe(canvas);
  return painter;
}

// Marks the first picture, for whoever measures how long it took.
function drawn(by) {
  const section = document.getElementById("atlas");
  if (section.dataset.drawn) return;
  section.dataset.drawn = by;
  performance.mark("atlas-drawn");
}

const FONT = "system-ui, -apple-system, Segoe UI, Roboto, Arial, sans-serif";
function words(context, text, x, y, { colour = "#1b1f24", size = 12, align = "center", weight = 400 } = {}) {
  context.font = `${weight} ${size}px ${FONT}`;
  Object.assign(context, { textAlign: align, textBaseline: "middle", lineJoin: "round", lineWidth: 3.5, strokeStyle: "rgba(255,255,255,.9)", fillStyle: colour });
  context.strokeText(text, x, y);
  context.fillText(text, x, y);
}

function line(context, points, colour, width, dash = []) {
  context.beginPath();
  points.forEach(([x, y], i) => (i ? context.lineTo(x, y) : context.moveTo(x, y)));
  Object.assign(context, { strokeStyle: colour, lineWidth: width, lineCap: "round", lineJoin: "round" });
  context.setLineDash(dash);
  context.stroke();
  context.setLineDash([]);
}

function arrow(context, from, to, colour, width, head = 9) {
  const [dx, dy] = [to[0] - from[0], to[1] - from[1]];
  const long = Math.hypot(dx, dy);
  if (long < 1) return;
  const size = Math.min(head, 0.6 * long);
  const [ux, uy] = [dx / long, dy / long];
  const neck = [to[0] - ux * size * 0.8, to[1] - uy * size * 0.8];
  line(context, [from, neck], colour, width);
  context.beginPath();
  context.moveTo(...to);
  for (const side of [1, -1]) context.lineTo(to[0] - ux * size - side * uy * size * 0.42, to[1] - uy * size + side * ux * size * 0.42);
  context.closePath();
  context.fillStyle = colour;
  context.fill();
}

const DASH = { solid: [], dash: [7, 4], dot: [1.5, 4], dashdot: [8, 4, 1.5, 4], longdash: [13, 5] };
