// A step: the body turns over its edge on the slope, the CMG inside it.
addEventListener("DOMContentLoaded", () => {
  const { INK, QUIET, BLUE, add, scaled, dot, cross, unit } = Rover;
  const EDGE = "#b0508a", SPIN = "#008a65", GIMBAL = "#d55e00", PUSH = "#b87800";
  const data = JSON.parse(document.getElementById("scene-data").textContent);
  const L = data.length, [f, r, p] = data.ground, up = [0, 0, 1];
  const place = (x, y, z = 0) => add(add(scaled(f, x), r, y), p, z);

  // ---- the body at a time ----
  const track = (coded) => coded && Object.fromEntries(Object.entries(coded).map(([key, text]) => [key, Rover.decoded(text)]));
  const plan = track(data.plan), result = track(data.result);

  function mixed(values, size, k, u) {
    const next = Math.min(k + 1, data.frames - 1);
    return Array.from({ length: size }, (_, i) => (1 - u) * values[size * k + i] + u * values[size * next + i]);
  }

  function body(source, t) {
    const at = ((data.frames - 1) * (t - data.from)) / (data.to - data.from);
    const k = Math.min(Math.floor(at), data.frames - 1), u = at - k;
    const centre = mixed(source.centre, 3, k, u), R = mixed(source.turn, 9, k, u);
    const moved = (v) => [0, 3, 6].map((i) => R[i] * v[0] + R[i + 1] * v[1] + R[i + 2] * v[2]);
    const [theta] = mixed(source.theta, 1, k, u), [delta] = mixed(source.delta, 1, k, u);
    const c = Math.cos(delta), s = Math.sin(delta);
    const spin = add(scaled(data.cmg.s, c), data.cmg.o, s);
    return {
      centre, theta, delta, spin: moved(spin), gimbal: moved(data.cmg.g),
      spikes: data.vertices.map((v) => add(centre, moved(v))),
      force: source.force ? mixed(source.force, 3 * data.vertices.length, k, u) : null,
    };
  }

  // ---- what stands still ----
  const start = body(plan, data.from), goal = body(plan, data.to);
  const [BACK, AHEAD, WIDE] = [-1.05 * L, 1.3 * L, 0.85 * L];
  const corners = [place(BACK, -WIDE), place(AHEAD, -WIDE), place(AHEAD, WIDE), place(BACK, WIDE)];
  // The wedge that the slope is the top of, seen from one side.
  const rise = Math.asin(Math.max(-1, Math.min(1, f[2]))), steep = Math.abs(rise);
  const wedge = (side) => {
    const [low, high] = [BACK, AHEAD].map((x) => place(x, side)).sort((a, b) => a[2] - b[2]);
    return [low, high, [high[0], high[1], low[2]]];
  };
  const top = add(place(0, 0), up, 0.92 * L);
  const eye = new Rover.Eye(document.getElementById("scene"), [...corners, ...wedge(-WIDE), ...wedge(WIDE), ...start.spikes, ...goal.spikes, top]);
  const path = (source, until) => {
    const points = [];
    for (let i = 0; i < data.frames; i += 3) {
      const t = data.from + (i / (data.frames - 1)) * (data.to - data.from);
      if (t > until) break;
      points.push([0, 1, 2].map((j) => source.centre[3 * i + j]));
    }
    return [...points, body(source, until).centre];
  };

  function ground() {
    eye.fill(corners, "rgba(196,178,150,.30)");
    const faint = "rgba(120,104,80,.22)", mesh = L / 4;
    for (let x = Math.ceil(BACK / mesh); x * mesh <= AHEAD; x += 1)
      eye.line([place(x * mesh, -WIDE), place(x * mesh, WIDE)], faint, 1);
    for (let y = Math.ceil(-WIDE / mesh); y * mesh <= WIDE; y += 1)
      eye.line([place(BACK, y * mesh), place(AHEAD, y * mesh)], faint, 1);
    eye.line(corners, "rgba(120,104,80,.45)", 1, [], true);
    slope(dot(r, eye.towards) > 0 ? WIDE : -WIDE);
  }

  function slope(side) {
    if (steep < 0.005 || eye.elevation > 1.2) return;
    const [low, high, foot] = wedge(side);
    eye.fill([low, high, foot], "rgba(120,104,80,.16)");
    eye.line([low, high, foot], "rgba(120,104,80,.45)", 1, [], true);
    const level = unit(add(foot, low, -1)), arc = [], size = 0.55 * L;
    const at = (angle, far) => add(add(low, level, far * Math.cos(angle)), up, far * Math.sin(angle));
    for (let i = 0; i <= 16; i += 1) arc.push(at((steep * i) / 16, size));
    eye.line(arc, QUIET, 1.2);
    eye.text(at(steep / 2, 1.32 * size), `${+((steep * 180) / Math.PI).toFixed(1)}°`, QUIET);
  }

  // Straight down on the slope.
  function shadow(spikes) {
    const points = spikes.map((v) => add(v, up, -dot(v, p) / p[2])).map((q) => [dot(q, f), dot(q, r)]);
    points.sort((a, b) => a[0] - b[0] || a[1] - b[1]);
    const half = (list) => {
      const hull = [];
      for (const q of list) {
        while (hull.length > 1) {
          const [a, b] = hull.slice(-2);
          if ((b[0] - a[0]) * (q[1] - a[1]) - (b[1] - a[1]) * (q[0] - a[0]) > 0) break;
          hull.pop();
        }
        hull.push(q);
      }
      return hull.slice(0, -1);
    };
    const hull = [...half(points), ...half([...points].reverse())];
    eye.fill(hull.map(([x, y]) => place(x, y)), "rgba(27,31,36,.10)");
  }

  // ---- what moves ----
  function outward(spikes, face, centre) {
    const [a, b, c] = face.map((i) => spikes[i]);
    const n = cross(add(b, a, -1), add(c, b, -1));
    return dot(n, add(a, centre, -1)) > 0 ? n : scaled(n, -1);
  }

  function edges(spikes, chosen, colour, width, dash) {
    for (const [i, j] of chosen) eye.line([spikes[i], spikes[j]], colour, width, dash);
  }

  function gyro({ centre, spin, gimbal }) {
    const across = cross(gimbal, spin), ring = [], disc = [];
    for (let i = 0; i < 40; i += 1) {
      const [c, s] = [Math.cos((i * Math.PI) / 20), Math.sin((i * Math.PI) / 20)];
      ring.push(add(add(centre, spin, 0.2 * L * c), gimbal, 0.2 * L * s));
      disc.push(add(add(centre, across, 0.15 * L * c), gimbal, 0.15 * L * s));
    }
    eye.line([add(centre, gimbal, -0.42 * L), add(centre, gimbal, 0.42 * L)], GIMBAL, 3);
    eye.line(ring, GIMBAL, 1.6, [], true);
    for (const shift of [-0.025, 0.025]) {
      const side = disc.map((q) => add(q, spin, shift * L));
      eye.fill(side, "rgba(0,138,101,.28)");
      eye.line(side, SPIN, 1.3, [], true);
    }
    eye.arrow(add(centre, spin, -0.2 * L), add(centre, spin, 0.36 * L), SPIN, 3);
    eye.text(add(centre, gimbal, 0.49 * L), "g", GIMBAL, [0, 0], "center", true);
    eye.text(add(centre, spin, 0.43 * L), "s", SPIN, [0, 0], "center", true);
  }

  function solid(now) {
    const sides = data.faces.map((face) => {
      const n = unit(outward(now.spikes, face, now.centre));
      return { points: face.map((i) => now.spikes[i]), face, facing: dot(n, eye.towards), bright: n[2] };
    });
    const seen = new Set(sides.filter((s) => s.facing > 0).flatMap((s) => s.face.map((v, i) => {
      const w = s.face[(i + 1) % s.face.length];
      return `${Math.min(v, w)}-${Math.max(v, w)}`;
    })));
    const near = ([i, j]) => seen.has(`${Math.min(i, j)}-${Math.max(i, j)}`);
    const paint = ({ points, bright }, strength) => eye.fill(points, `rgba(${Math.round(70 + 40 * bright)},${Math.round(140 + 25 * bright)},${Math.round(190 + 20 * bright)},${strength})`);
    sides.filter((s) => s.facing <= 0).forEach((s) => paint(s, 0.2));
    edges(now.spikes, data.edges.filter((e) => !near(e)), "rgba(0,114,178,.45)", 1.3, []);
    gyro(now);
    sides.filter((s) => s.facing > 0).forEach((s) => paint(s, 0.2));
    edges(now.spikes, data.edges.filter(near), BLUE, 2.4, []);
  }

  function pushes({ spikes, force }) {
    if (!force) return;
    spikes.forEach((spike, i) => {
      const push = [0, 1, 2].map((j) => force[3 * i + j]), size = Rover.norm(push);
      if (size < 0.02) return;
      eye.arrow(spike, add(spike, push, (Math.min(size, 1.6) / size) * 0.5 * L), PUSH, 3);
    });
  }

  let t = data.from;
  function draw() {
    const shown = result ?? plan, now = body(shown, t), meant = body(plan, t);
    ground();
    shadow(now.spikes);
    for (const [pose, face] of [[start, data.start], [goal, data.end]])
      eye.line(face.map((i) => pose.spikes[i]), QUIET, 1.2, [2, 4], true);
    eye.line(path(plan, data.to), INK, 1, [2, 4]);
    eye.line(path(shown, t), BLUE, 1.8);
    const [a, b] = data.axis;
    eye.line([now.spikes[a], now.spikes[b]], EDGE, 7);
    solid(now);
    if (result) edges(meant.spikes, data.edges, INK, 1.3, [6, 4]);
    pushes(now);
    now.spikes.forEach((spike, i) => {
      const away = unit(add(spike, now.centre, -1));
      eye.dot(spike, INK, 3.2);
      eye.text(add(spike, away, 0.07 * L), String(i), INK);
    });
    const degrees = (angle) => `${((angle * 180) / Math.PI).toFixed(1)}°`.replace("-0.0", "0.0").replace("-", "−");
    document.getElementById("scene-says").textContent = `turned ${degrees(now.theta)} of ${degrees(data.turn)}, gimbal at ${degrees(now.delta)}`;
  }

  const view = (azimuth, elevation) => () => Object.assign(eye, { azimuth, elevation });
  const again = Rover.stage(eye, draw, {
    oblique: view(f[2] < -0.005 ? -1.05 : -2.1, 0.42), side: view(-Math.PI / 2, 0.06), above: view(-Math.PI / 2, 1.5),
  });
  const seek = Rover.clock({
    from: data.from, to: data.to, rate: 1,
    says: (now) => `${now.toFixed(2)} s`,
    steps: (now, way, far) => now + way * (data.to - data.from) * (far ? 0.1 : 0.01),
    show: (now) => { t = now; again(); },
  });
  seek(data.from);
});
