"use strict";
// What both animations share: looking at three dimensions, a clock, the charts beside.
const Rover = (() => {
  const INK = "#1b1f24", QUIET = "#5b6570", BLUE = "#0072b2";

  function decoded(text) {
    const bytes = Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
    return new Float32Array(bytes.buffer);
  }

  const add = (a, b, k = 1) => [a[0] + k * b[0], a[1] + k * b[1], a[2] + k * b[2]];
  const scaled = (a, k) => [k * a[0], k * a[1], k * a[2]];
  const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
  const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
  const norm = (a) => Math.sqrt(dot(a, a));
  const unit = (a) => scaled(a, 1 / norm(a));
  const mean = (points) => scaled(points.reduce((sum, p) => add(sum, p), [0, 0, 0]), 1 / points.length);

  // About a unit axis through a point.
  function turned(p, point, axis, angle) {
    const v = add(p, point, -1), c = Math.cos(angle), s = Math.sin(angle);
    const along = scaled(axis, dot(axis, v) * (1 - c));
    return add(point, add(add(along, v, c), cross(axis, v), s));
  }

  // Seen from afar: lengths do not shrink with distance. z is up.
  class Eye {
    // `held` are the points that are kept in the picture; with a `zoom` its middle is `centre`.
    constructor(canvas, held) {
      Object.assign(this, { canvas, held, zoom: 0, centre: [0, 0, 0], azimuth: -1.1, elevation: 0.42, width: 1, height: 1 });
      this.pen = canvas.getContext("2d");
    }

    fit() {
      const { canvas } = this, sharp = Math.min(devicePixelRatio || 1, 3);
      this.width = canvas.clientWidth;
      this.height = canvas.clientHeight;
      const [w, h] = [Math.round(this.width * sharp), Math.round(this.height * sharp)];
      if (canvas.width !== w || canvas.height !== h) { canvas.width = w; canvas.height = h; }
      this.sharp = sharp;
      this.pen.setTransform(sharp, 0, 0, sharp, 0, 0);
      this.pen.clearRect(0, 0, this.width, this.height);
      this.pen.lineJoin = "round";
      const [ca, sa, ce, se] = [Math.cos(this.azimuth), Math.sin(this.azimuth), Math.cos(this.elevation), Math.sin(this.elevation)];
      this.towards = [ce * ca, ce * sa, se];
      this.right = [-sa, ca, 0];
      this.up = cross(this.towards, this.right);
      const [x, y] = [this.right, this.up].map((axis) => this.held.map((p) => dot(p, axis)));
      const [x0, x1, y0, y1] = [Math.min(...x), Math.max(...x), Math.min(...y), Math.max(...y)];
      const room = 26;
      this.scale = Math.min((this.width - 2 * room) / (x1 - x0), (this.height - 2 * room) / (y1 - y0));
      this.at = [(x0 + x1) / 2, (y0 + y1) / 2];
      if (!this.zoom) return;
      this.scale *= this.zoom;
      this.at = [dot(this.centre, this.right), dot(this.centre, this.up)];
    }

    see(p) {
      return [this.width / 2 + this.scale * (dot(p, this.right) - this.at[0]), this.height / 2 - this.scale * (dot(p, this.up) - this.at[1])];
    }

    path(points, closed = false) {
      this.pen.beginPath();
      points.forEach((p, i) => { const [x, y] = this.see(p); if (i) this.pen.lineTo(x, y); else this.pen.moveTo(x, y); });
      if (closed) this.pen.closePath();
    }

    line(points, colour, width = 1.5, dash = [], closed = false) {
      this.path(points, closed);
      Object.assign(this.pen, { strokeStyle: colour, lineWidth: width });
      this.pen.setLineDash(dash);
      this.pen.stroke();
      this.pen.setLineDash([]);
    }

    fill(points, colour) {
      this.path(points, true);
      this.pen.fillStyle = colour;
      this.pen.fill();
    }

    dot(p, colour, size = 3) {
      const [x, y] = this.see(p);
      this.pen.beginPath();
      this.pen.arc(x, y, size, 0, 7);
      this.pen.fillStyle = colour;
      this.pen.fill();
    }

    arrow(from, to, colour, width = 2.5) {
      this.line([from, to], colour, width);
      const [a, b] = [this.see(from), this.see(to)];
      const length = Math.hypot(b[0] - a[0], b[1] - a[1]);
      if (length < 5) return;
      const [x, y] = [(b[0] - a[0]) / length, (b[1] - a[1]) / length], tip = Math.min(9, 0.6 * length);
      this.pen.beginPath();
      this.pen.moveTo(b[0] + 2 * x, b[1] + 2 * y);
      this.pen.lineTo(b[0] - tip * x - 0.45 * tip * y, b[1] - tip * y + 0.45 * tip * x);
      this.pen.lineTo(b[0] - tip * x + 0.45 * tip * y, b[1] - tip * y - 0.45 * tip * x);
      this.pen.fillStyle = colour;
      this.pen.fill();
    }

    text(p, words, colour = INK, [dx, dy] = [0, 0], align = "center", bold = false) {
      const [x, y] = this.see(p), { pen } = this;
      pen.font = `${bold ? "600 " : ""}13px system-ui, -apple-system, "Segoe UI", Roboto, Arial, sans-serif`;
      Object.assign(pen, { textAlign: align, textBaseline: "middle", lineWidth: 3, strokeStyle: "rgba(251,251,252,.9)", fillStyle: colour });
      pen.strokeText(words, x + dx, y + dy);
      pen.fillText(words, x + dx, y + dy);
    }
  }

  // Draw when something changed, once a frame.
  function stage(eye, draw, looks) {
    let waiting = false;
    const again = () => {
      if (waiting) return;
      waiting = true;
      requestAnimationFrame(() => { waiting = false; eye.fit(); draw(); });
    };
    new ResizeObserver(again).observe(eye.canvas);
    addEventListener("beforeprint", () => { eye.fit(); draw(); });

    const buttons = [...document.querySelectorAll("[data-look]")];
    const press = (key) => buttons.forEach((b) => b.setAttribute("aria-pressed", String(b.dataset.look === key)));
    const look = (key) => { looks[key](); press(key); again(); };
    buttons.forEach((b) => b.addEventListener("click", () => look(b.dataset.look)));

    let from = null;
    eye.canvas.addEventListener("pointerdown", (event) => {
      from = [event.clientX, event.clientY, eye.azimuth, eye.elevation];
      eye.canvas.setPointerCapture(event.pointerId);
    });
    eye.canvas.addEventListener("pointermove", (event) => {
      if (!from) return;
      eye.azimuth = from[2] - (event.clientX - from[0]) / 160;
      eye.elevation = Math.min(1.55, Math.max(0.05, from[3] + (event.clientY - from[1]) / 200));
      press("");
      again();
    });
    for (const end of ["pointerup", "pointercancel"]) eye.canvas.addEventListener(end, () => { from = null; });
    look(Object.keys(looks)[0]);
    return again;
  }

  // The charts have a cursor of their own: what moves it is told to `seek`, and the other way.
  function charts(ends, seek, playing) {
    const cursor = document.getElementById("cursor");
    const [from, to] = ends;
    if (!(to > from)) return () => {};
    let mine = null;
    new MutationObserver(() => {
      const share = Number(cursor.value);
      if (playing() || (mine !== null && Math.abs(share - mine) < 0.51)) return;
      mine = null;
      seek(from + (share / 1000) * (to - from), true);
    }).observe(cursor, { attributes: true, attributeFilter: ["aria-valuetext"] });
    return (at) => {
      mine = (1000 * (at - from)) / (to - from);
      cursor.value = String(mine);
      cursor.dispatchEvent(new Event("input"));
    };
  }

  // A clock from `from` to `to` that runs at `rate` a second; `show` draws a time.
  function clock({ from, to, rate, says, show, steps, onChart = (t) => t, onClock = (t) => t, chartEnds = [from, to] }) {
    const [slider, button, output, speed] = ["clock", "play", "clock-says", "speed"].map((id) => document.getElementById(id));
    const calm = matchMedia("(prefers-reduced-motion: reduce)");
    let now = from, playing = false, last = 0;

    function seek(at, fromCharts = false) {
      now = Math.min(to, Math.max(from, fromCharts ? onClock(at) : at));
      slider.value = String(now);
      output.textContent = says(now);
      slider.setAttribute("aria-valuetext", output.textContent);
      show(now);
      if (!fromCharts) follow(onChart(now));
    }
    const follow = charts(chartEnds, seek, () => playing);

    // Who wants less motion sees stills.
    function run(stamp) {
      if (!playing) return;
      const gone = (stamp - last) / 1000;
      if (calm.matches && gone < 0.9) { requestAnimationFrame(run); return; }
      last = stamp;
      const still = (to - from) / 14;
      seek(now + (calm.matches ? still : Math.min(gone, 0.1) * rate * Number(speed.value)));
      if (now >= to) toggle(); else requestAnimationFrame(run);
    }

    function toggle() {
      playing = !playing;
      button.textContent = playing ? "Pause" : "Play";
      if (!playing) return;
      if (now >= to) seek(from);
      last = performance.now();
      requestAnimationFrame(run);
    }

    button.addEventListener("click", toggle);
    slider.addEventListener("input", () => seek(Number(slider.value)));
    document.querySelectorAll("[data-at]").forEach((b) => b.addEventListener("click", () => seek(Number(b.dataset.at))));

    const moves = { ArrowLeft: -1, ArrowRight: 1 };
    document.addEventListener("keydown", (event) => {
      const { key, target } = event;
      if (event.ctrlKey || event.metaKey || event.altKey) return;
      if (target.closest("select, .scroll, textarea, [contenteditable]")) return;
      if (key === " " && !target.closest("button, summary, a")) toggle();
      else if (key in moves) seek(steps(now, moves[key], event.shiftKey));
      else if (key === "Home" && target.closest(".stage")) seek(from);
      else if (key === "End" && target.closest(".stage")) seek(to);
      else return;
      event.preventDefault();
    });
    return seek;
  }

  return { INK, QUIET, BLUE, Eye, stage, clock, decoded, add, scaled, dot, cross, norm, unit, mean, turned };
})();
