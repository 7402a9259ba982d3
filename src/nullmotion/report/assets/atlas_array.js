// The array: rotors on a ring about its common axis, turned to the present gimbal angles.
function spread(array) {
  // Each rotor stands where its gimbal axis points; those that would meet are set apart.
  const angles = array.gimbal_axes.map((g, i) => [Math.hypot(g[0], g[1]) > 0.2 ? Math.atan2(g[1], g[0]) : null, i]);
  const known = angles.filter(([a]) => a !== null).sort((p, q) => p[0] - q[0]);
  const gaps = known.map(([a], k) => (k ? a - known[k - 1][0] : a + 2 * Math.PI - known.at(-1)[0]));
  if (known.length === angles.length && Math.min(...gaps) > 0.6) return angles.map(([a]) => a);
  const order = [...known, ...angles.filter(([a]) => a === null)].map(([, i]) => i);
  const found = [];
  order.forEach((i, k) => { found[i] = (2 * Math.PI * k) / order.length + (known[0]?.[0] ?? 0); });
  return found;
}

function arrayView(data, state) {
  const { array } = data;
  const canvas = document.querySelector("#atlas-array canvas");
  const around = spread(array), n = array.gimbal_axes.length;
  const ring = n > 6 ? 1.5 : 1.25, wheel = Math.min(0.42, (1.9 * ring) / n);
  const largest = Math.max(...array.h0), total = array.h0.reduce((a, b) => a + b, 0);
  const inBody = (h) => (array.torque_axes.length === 3 ? h : array.torque_axes.reduce((v, axis, k) => sum(v, scaled(axis, h[k])), [0, 0, 0]));

  sheetOf(canvas, (context, width, height) => {
    const where = projection(width, height, ring + 0.95, look.zoom.array);
    const parts = [];
    for (let i = 0; i < n; i += 1) parts.push(...rotor(i, where));
    const h = scaled(inBody(state.momentum), (ring + 0.4) / total);
    parts.push([0.001, () => {
      arrow(context, where.to([0, 0, 0]), where.to(h), "#fff", 7, 14);
      arrow(context, where.to([0, 0, 0]), where.to(h), "#1b1f24", 3, 13);
    }]);
    line(context, Array.from({ length: 97 }, (_, k) => where.to([ring * Math.cos((k * Math.PI) / 48), ring * Math.sin((k * Math.PI) / 48), 0])), "#d5dae0", 1);
    parts.sort((a, b) => a[0] - b[0]).forEach(([, paint]) => paint(context));
    triad(context, width, height, where);
  });

  function rotor(i, where) {
    const g = array.gimbal_axes[i], colour = data.colours[i % data.colours.length];
    const [c, s] = [Math.cos(state.delta[i]), Math.sin(state.delta[i])];
    const h = sum(scaled(array.spin_axes[i], c), scaled(array.transverse_axes[i], s));
    const t = cross(g, h), at = [ring * Math.cos(around[i]), ring * Math.sin(around[i]), 0];
    const depth = (p) => dot(where.towards, p);
    const size = 0.35 + (0.65 * array.h0[i]) / (largest || 1);
    const r = wheel * (0.6 + 0.4 * size), thick = 0.22 * r;
    const rim = (along) => Array.from({ length: 37 }, (_, k) => {
      const a = (k * Math.PI) / 18;
      return where.to(sum(sum(at, scaled(h, along)), sum(scaled(g, r * Math.cos(a)), scaled(t, r * Math.sin(a)))));
    });
    const face = depth(h) >= 0 ? thick : -thick;
    const body = (context) => {
      for (const along of [-face, face]) {
        context.beginPath();
        rim(along).forEach(([x, y]) => context.lineTo(x, y));
        context.fillStyle = colour;
        context.globalAlpha = along === face ? 0.4 : 0.55;
        context.fill();
        context.globalAlpha = 1;
        Object.assign(context, { strokeStyle: colour, lineWidth: 1.3 });
        context.stroke();
      }
    };
    const tip = sum(at, scaled(h, size));
    const axle = (sign) => (context) => line(context, [where.to(sum(at, scaled(g, sign * r))), where.to(sum(at, scaled(g, sign * (r + 0.28))))], "#5b6570", 2.2, sign > 0 ? [] : [3, 3]);
    const name = sum(at, scaled(g, r + 0.42));
    return [
      [depth(at), body],
      [depth(sum(at, g)) * 1e-3 + depth(at) + (depth(g) > 0 ? 1e-3 : -1e-3), axle(1)],
      [depth(at) + (depth(g) > 0 ? -1e-3 : 1e-3), axle(-1)],
      [depth(tip) + 2e-3, (context) => { arrow(context, where.to(at), where.to(tip), "#fff", 6, 12); arrow(context, where.to(at), where.to(tip), colour, 3, 11); }],
      [10, (context) => words(context, String(array.names[i]), ...where.to(name), { colour, weight: 700, size: 13 })],
    ];
  }

  // Body axes in a corner, so that they are in nobody's way.
  function triad(context, width, height, where) {
    const corner = [34, height - 34];
    AXES.forEach((name, i) => {
      const tip = [corner[0] + 24 * where.right[i], corner[1] - 24 * where.up[i]];
      arrow(context, corner, tip, "#5b6570", 1.5, 6);
      words(context, name, corner[0] + 33 * where.right[i], corner[1] - 33 * where.up[i], { colour: "#5b6570", size: 11 });
    });
  }
}
