// A mission: the rover rolls over shaded ground and leaves its footprints.
addEventListener("DOMContentLoaded", () => {
  const { INK, BLUE, add, scaled, dot, cross, unit, mean, turned } = Rover;
  const GIMBAL = "#d55e00", START = "#008a65", GOAL = "#a3230a";
  const LOW = [93, 125, 151], MIDDLE = [169, 183, 176], HIGH = [242, 223, 180];
  const data = JSON.parse(document.getElementById("scene-data").textContent);
  const corners = Rover.decoded(data.corners), planned = Rover.decoded(data.planned);
  const triple = (list, i) => [list[3 * i], list[3 * i + 1], list[3 * i + 2]];
  const footprint = (k) => [0, 1, 2].map((m) => triple(corners, 3 * k + m));
  const middles = Array.from({ length: data.steps + 1 }, (_, k) => mean(footprint(k)));
  const L = Rover.norm(add(footprint(0)[1], footprint(0)[0], -1));
  const lifted = (p) => [p[0], p[1], p[2] + 0.03 * L];

  // ---- the ground ----
  const { rows, columns, bounds: [x0, x1, y0, y1], contour } = data.ground;
  const heights = Rover.decoded(data.ground.heights);
  const known = heights.filter((z) => !Number.isNaN(z));
  const lowest = known.reduce((a, b) => Math.min(a, b)), highest = known.reduce((a, b) => Math.max(a, b));
  const point = (i, j) => [x0 + ((x1 - x0) * i) / (columns - 1), y0 + ((y1 - y0) * j) / (rows - 1), heights[j * columns + i]];
  const light = unit([-0.5, 0.45, 0.74]);

  function height(x, y) {
    const u = ((x - x0) / (x1 - x0)) * (columns - 1), v = ((y - y0) / (y1 - y0)) * (rows - 1);
    if (!(u >= 0 && v >= 0 && u <= columns - 1 && v <= rows - 1)) return NaN;
    const i = Math.min(Math.floor(u), columns - 2), j = Math.min(Math.floor(v), rows - 2), a = u - i, b = v - j;
    const z = (m, n) => heights[(j + n) * columns + i + m];
    return (1 - b) * ((1 - a) * z(0, 0) + a * z(1, 0)) + b * ((1 - a) * z(0, 1) + a * z(1, 1));
  }

  function tint(z, n) {
    const share = highest > lowest ? (z - lowest) / (highest - lowest) : 0.5;
    const [from, to, u] = share < 0.5 ? [LOW, MIDDLE, 2 * share] : [MIDDLE, HIGH, 2 * share - 1];
    const bright = 0.62 + 0.42 * Math.max(0, dot(n, light));
    return `rgb(${from.map((c, i) => Math.round(Math.min(255, ((1 - u) * c + u * to[i]) * bright))).join(",")})`;
  }

  const cells = [];
  for (let j = 0; j + 1 < rows; j += 1)
    for (let i = 0; i + 1 < columns; i += 1) {
      const points = [point(i, j), point(i + 1, j), point(i + 1, j + 1), point(i, j + 1)];
      if (points.some((p) => Number.isNaN(p[2]))) continue;
      const n = unit(cross(add(points[2], points[0], -1), add(points[3], points[1], -1)));
      cells.push({ points, middle: mean(points), colour: tint(mean(points)[2], n), lines: contours(points) });
    }

  // Where the square's two triangles cross whole multiples of the distance.
  function contours(points) {
    const pieces = [];
    for (const three of [[0, 1, 2], [0, 2, 3]]) {
      const corner = three.map((i) => points[i]), z = corner.map((p) => p[2]);
      for (let k = Math.ceil(Math.min(...z) / contour); k * contour <= Math.max(...z); k += 1) {
        const level = k * contour, ends = [];
        for (const [a, b] of [[0, 1], [1, 2], [2, 0]])
          if ((z[a] < level) !== (z[b] < level))
            ends.push(add(corner[a], add(corner[b], corner[a], -1), (level - z[a]) / (z[b] - z[a])));
        if (ends.length === 2) pieces.push({ ends, thick: k % 5 === 0 });
      }
    }
    return pieces;
  }

  const direction = () => `${eye.azimuth} ${eye.elevation}`;
  let sortedFor = "";
  function paint() {
    const { pen, width, height: tall } = eye;
    if (sortedFor !== direction()) {
      for (const cell of cells) cell.depth = dot(cell.middle, eye.towards);
      cells.sort((a, b) => a.depth - b.depth);
      sortedFor = direction();
    }
    const seen = cells.filter(({ middle }) => {
      const [x, y] = eye.see(middle);
      return x > -60 && y > -60 && x < width + 60 && y < tall + 60;
    });
    pen.lineWidth = 0.8;
    for (const { points, colour } of seen) {
      eye.path(points, true);
      pen.fillStyle = pen.strokeStyle = colour;
      pen.fill();
      pen.stroke();
    }
    for (const thick of [false, true]) {
      pen.beginPath();
      for (const { lines } of seen)
        for (const one of lines) {
          if (one.thick !== thick || behind(one, mean(one.ends))) continue;
          const [[xa, ya], [xb, yb]] = one.ends.map((p) => eye.see(p));
          pen.moveTo(xa, ya);
          pen.lineTo(xb, yb);
        }
      Object.assign(pen, { strokeStyle: "rgba(27,31,36,.42)", lineWidth: thick ? 1.3 : 0.6 });
      pen.stroke();
    }
  }

  // The ground does not move: its picture is kept until one looks from elsewhere. Where one
  // follows the rover it is larger than what is seen.
  const kept = document.createElement("canvas");
  let keptFor = "", keptAt = [0, 0];
  function ground() {
    const { canvas, pen, sharp, width, height: tall, scale, at } = eye, more = eye.zoom ? 1.8 : 1;
    const key = [canvas.width, canvas.height, scale, direction()].join();
    const shift = () => [scale * (keptAt[0] - at[0]), -scale * (keptAt[1] - at[1])];
    const [x, y] = shift(), room = (more - 1) / 2;
    if (key !== keptFor || Math.abs(x) > room * width + 1 || Math.abs(y) > room * tall + 1) {
      kept.width = Math.round(more * canvas.width);
      kept.height = Math.round(more * canvas.height);
      const own = kept.getContext("2d");
      own.setTransform(sharp, 0, 0, sharp, 0, 0);
      own.lineJoin = "round";
      Object.assign(eye, { pen: own, width: more * width, height: more * tall });
      paint();
      Object.assign(eye, { pen, width, height: tall });
      [keptFor, keptAt] = [key, at];
    }
    const [dx, dy] = shift();
    pen.drawImage(kept, dx - room * width, dy - room * tall, more * width, more * tall);
  }

  // Behind a hill: the ground rises above the line of sight.
  function hidden(p) {
    const step = (x1 - x0) / (columns - 1);
    for (let s = 1.5 * step; p[2] + s * eye.towards[2] < highest; s += step) {
      const q = add(p, eye.towards, s), z = height(q[0], q[1]);
      if (Number.isNaN(z) && !(q[0] > x0 && q[0] < x1 && q[1] > y0 && q[1] < y1)) return false;
      if (z > q[2]) return true;
      if (s > 4 * (x1 - x0 + y1 - y0)) return false;
    }
    return false;
  }

  // The same for what does not move: found out once for each direction.
  const found = new WeakMap();
  function behind(thing, p) {
    const old = found.get(thing);
    if (old?.direction === direction()) return old.is;
    const is = hidden(p);
    found.set(thing, { direction: direction(), is });
    return is;
  }

  // Runs of pieces in sight and behind hills, each as one line, so that dashes go on.
  function line(points, colour, width, dash = []) {
    const { pen } = eye;
    for (let i = 0; i + 1 < points.length;) {
      const away = behind(points[i], mean([points[i], points[i + 1]]));
      let end = i + 1;
      while (end + 1 < points.length && behind(points[end], mean([points[end], points[end + 1]])) === away) end += 1;
      pen.globalAlpha = away ? 0.25 : 1;
      eye.line(points.slice(i, end + 1), colour, width, dash);
      i = end;
    }
    pen.globalAlpha = 1;
  }

  // ---- the rover ----
  function pose(u) {
    const k = Math.min(Math.floor(u), Math.max(data.steps - 1, 0)), share = data.steps ? u - k : 0;
    const feet = footprint(k);
    const n = unit(cross(add(feet[1], feet[0], -1), add(feet[2], feet[0], -1)));
    const spikes = Array(4);
    data.feet[k].forEach((spike, m) => { spikes[spike] = feet[m]; });
    spikes[6 - data.feet[k].reduce((a, b) => a + b)] = add(mean(feet), n, L * Math.sqrt(2 / 3));
    if (!share) return spikes;
    const [a, b] = [1, 2].map((m) => feet[(data.left[k] + m) % 3]);
    const axis = unit(add(b, a, -1)), angle = (data.turn[k] * (1 - Math.cos(Math.PI * share))) / 2;
    return spikes.map((p) => turned(p, a, axis, angle));
  }

  function rover(spikes) {
    const centre = mean(spikes);
    eye.pen.globalAlpha = hidden(centre) ? 0.45 : 1;
    const sides = [[0, 1, 2], [0, 1, 3], [0, 2, 3], [1, 2, 3]].map((face) => {
      const points = face.map((i) => spikes[i]), n = unit(cross(add(points[1], points[0], -1), add(points[2], points[0], -1)));
      const out = dot(n, add(points[0], centre, -1)) > 0 ? n : scaled(n, -1);
      return { points, facing: dot(out, eye.towards), bright: Math.max(0, dot(out, light)) };
    });
    for (const { points, facing, bright } of sides) {
      if (facing <= 0) continue;
      const shade = [20, 120, 190].map((c) => Math.round(c * (0.65 + 0.5 * bright)));
      eye.fill(points, `rgba(${shade.join(",")},.82)`);
      eye.line(points, "#fff", 2.2, [], true);
      eye.line(points, INK, 1.1, [], true);
    }
    if (data.gimbal) {
      const axis = data.gimbal.reduce((sum, w, i) => add(sum, spikes[i], w), [0, 0, 0]);
      eye.line([add(centre, axis, -0.5 * L), add(centre, axis, 0.5 * L)], "#fff", 4);
      eye.line([add(centre, axis, -0.5 * L), add(centre, axis, 0.5 * L)], GIMBAL, 2.4);
    }
    eye.pen.globalAlpha = 1;
  }

  function flag(p, words, colour) {
    const top = add(p, [0, 0, 1], 1.4 * L);
    eye.line([p, top], colour, 2);
    eye.dot(p, colour, 4);
    eye.text(top, words, colour, [0, -9], "center", true);
  }

  const edge = [[x0, y0], [x1, y0], [x1, y1], [x0, y1]].flatMap(([x, y]) => [[x, y, lowest], [x, y, highest]]);
  const eye = new Rover.Eye(document.getElementById("scene"), edge);
  const prints = Array.from({ length: data.steps + 1 }, (_, k) => footprint(k).map(lifted));
  const trail = middles.map(lifted);
  const meant = Array.from({ length: planned.length / 3 }, (_, i) => lifted(triple(planned, i)));
  let u = 0;
  function draw() {
    const done = Math.floor(u), spikes = pose(u), share = u - done;
    ground();
    line(meant, INK, 1.4, [5, 4]);
    for (let k = 0; k <= done; k += 1) {
      eye.pen.globalAlpha = behind(prints[k], middles[k]) ? 0.25 : 1;
      eye.fill(prints[k], "rgba(0,114,178,.20)");
      eye.line(prints[k], "rgba(0,80,130,.75)", 1, [], true);
    }
    eye.pen.globalAlpha = 1;
    const here = share ? [add(scaled(trail[done], 1 - share), trail[done + 1], share)] : [];
    line([...trail.slice(0, done + 1), ...here], BLUE, 2.6);
    flag(middles[0], "start", START);
    flag(data.goal, "goal", GOAL);
    rover(spikes);
    const way = (1 - share) * data.way[done] + share * (data.way[done + 1] ?? 0);
    const energy = (1 - share) * data.energy[done] + share * (data.energy[done + 1] ?? 0);
    document.getElementById("scene-says").textContent = `${way.toFixed(1)} m, ${(energy / 1000).toFixed(2)} kJ in the motors`;
  }

  const view = (azimuth, elevation, zoom = 0) => () => Object.assign(eye, { azimuth, elevation, zoom });
  const again = Rover.stage(eye, () => { eye.centre = mean(pose(u)); if (eye.zoom) eye.fit(); draw(); }, {
    oblique: view(-1.9, 0.8), above: view(-Math.PI / 2, 1.55), follow: view(-1.9, 0.6, Math.max(2, (0.16 * (x1 - x0 + y1 - y0)) / (2 * L))),
  });

  // The charts count metres, the clock steps.
  const metres = (at) => { const k = Math.min(Math.floor(at), data.steps); return data.way[k] + (at - k) * ((data.way[k + 1] ?? data.way[k]) - data.way[k]); };
  const steps = (way) => { const k = Math.max(0, data.way.findLastIndex((w) => w <= way)); return k >= data.steps ? data.steps : k + (way - data.way[k]) / (data.way[k + 1] - data.way[k]); };
  const seek = Rover.clock({
    from: 0, to: data.to, rate: 1.2,
    says: (now) => `step ${Math.min(Math.floor(now + 1e-9) + (now % 1 > 1e-9 ? 1 : 0), data.steps)} of ${data.steps}`,
    steps: (now, way, far) => (far ? Math.round(now + 5 * way) : way > 0 ? Math.floor(now + 1 + 1e-9) : Math.ceil(now - 1 - 1e-9)),
    show: (now) => { u = now; again(); },
    onChart: metres, onClock: steps, chartEnds: [0, data.way[data.steps]],
  });
  seek(0);
});
