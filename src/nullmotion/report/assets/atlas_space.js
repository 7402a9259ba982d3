// Momentum space: the singular surfaces, their radii, the cutting plane, the momentum's path.
const AXES = ["x", "y", "z"];

function nice(most, steps = 4) {
  const rough = most / steps, power = 10 ** Math.floor(Math.log10(rough));
  return [1, 2, 2.5, 5, 10].map((f) => f * power).find((s) => s >= rough * 0.999);
}

// How surfaces look: by type, or by the torque that is left, which thin colours would not tell.
const style = (data, byTorque) => {
  const towards = unit([0.35, 0.55, 0.75]); // to the right, up, towards the eye
  const anchors = data.scale.map(rgbOf);
  return {
    anchors, ramp: byTorque ? ramp(anchors) : null,
    kinds: data.kinds.map((k) => ({ rgb: rgbOf(k.colour), alpha: byTorque ? 0.25 + 0.75 * k.alpha : k.alpha, rim: k.rim, stripes: k.stripes })),
    stripeAxis: scaled([0.28, 0.36, 0.89], 15 / data.radius),
    light: (view) => sum(sum(scaled(view.right, towards[0]), scaled(view.up, towards[1])), scaled(view.towards, towards[2])),
  };
};

function spaceView(data, array, state) {
  const figure = document.getElementById("atlas-space");
  const [behind, canvas, front] = figure.querySelectorAll("canvas");
  const looks = { type: style(data, false), left: style(data, true) }, radius = 1.12 * data.radius;
  const paints = () => looks[state.colour];
  const renderer = webgl(canvas) ?? rasteriser(canvas);
  let built = [], surface = null, list = null, listed = "", settled = 0;

  // Sheets are meshed when they are first switched on; `list` is what is drawn of them.
  function current() {
    const key = JSON.stringify([state.kinds, state.sheets, state.plane]);
    if (key === listed) return;
    if (!surface || state.sheets.some((on, i) => on && !built[i])) {
      built = state.sheets.map((on, i) => on || Boolean(built[i]));
      surface = mesh(data, array, built);
    }
    list = chosen(surface, state, state.plane);
    listed = key;
  }

  const view = () => projection(figure.clientWidth, figure.clientHeight, radius, look.zoom.space);

  // Surfaces are drawn coarsely in motion and again with all detail once it stops.
  let moving = true;
  const surfaces = () => {
    const where = view();
    if (!where.width || !where.height) return;
    current();
    renderer.draw(surface, ordered(surface, list, where.towards, radius), where, paints(), state.plane, !moving);
    if (moving && renderer.name === "raster") {
      clearTimeout(settled);
      settled = setTimeout(() => { moving = false; repaint(surfaces); }, 140);
    }
    drawn(renderer.name);
  };
  surfaces.heavy = true; // time does not change it
  painters.add(surfaces);
  new ResizeObserver(() => repaint(surfaces)).observe(figure);

  sheetOf(behind, (context) => {
    const where = view(), step = nice(data.radius), end = 1.08 * data.radius;
    AXES.forEach((name, i) => {
      const axis = [0, 0, 0];
      axis[i] = 1;
      line(context, [where.to(scaled(axis, -end)), where.to(scaled(axis, end))], "#5b6570", 1);
      for (let k = -Math.floor(end / step); k * step <= end; k += 1) {
        if (k === 0) continue;
        const [x, y] = where.to(scaled(axis, k * step));
        context.fillStyle = "#5b6570";
        context.fillRect(x - 1.5, y - 1.5, 3, 3);
      }
    });
  });

  sheetOf(front, (context) => {
    const where = view(), end = 1.08 * data.radius, step = nice(data.radius);
    AXES.forEach((name, i) => {
      const axis = [0, 0, 0];
      axis[i] = end;
      const [x, y] = where.to(axis), [ox, oy] = where.to([0, 0, 0]);
      if (Math.hypot(x - ox, y - oy) < 14) return;
      words(context, `h${name}`, x + 9 * Math.sign(x - ox || 1), y - 6, { colour: "#1b1f24", weight: 600 });
      const last = Math.floor(end / step) * step;
      words(context, tidy(last), ...where.to(scaled(axis, last / end)).map((v, j) => v + (j ? 11 : 0)), { colour: "#5b6570", size: 10.5 });
    });
    const balls = data.spheres.filter((s) => state.spheres[s.key]);
    balls.forEach((ball) => drawBall(context, where, ball));
    if (state.plane) drawPlane(context, where);
    for (const motion of data.motions) drawPath(context, where, motion, motion === state.motion);
    drawMomentum(context, where);
    balls.forEach((ball) => nameBall(context, where, ball));
    if (state.marked) {
      const [x, y] = where.to(state.marked);
      context.beginPath();
      context.arc(x, y, 7, 0, 2 * Math.PI);
      Object.assign(context, { strokeStyle: "#1b1f24", lineWidth: 2 });
      context.stroke();
    }
  });

  function drawBall(context, where, ball) {
    const r = where.outline(ball.radius, ball.centre), at = where.to(ball.centre);
    for (const [colour, width, dash] of [["rgba(255,255,255,.75)", 4, []], [ball.colour, 2, DASH[ball.dash]]]) {
      context.beginPath();
      context.arc(at[0], at[1], r, 0, 2 * Math.PI);
      Object.assign(context, { strokeStyle: colour, lineWidth: width });
      context.setLineDash(dash);
      context.stroke();
      context.setLineDash([]);
    }
  }

  function nameBall(context, where, ball) {
    const r = where.outline(ball.radius, ball.centre), at = where.to(ball.centre), angle = ball.angle * RADIAN;
    words(context, tidy(ball.radius, 4), at[0] + r * Math.cos(angle), at[1] - r * Math.sin(angle), { colour: ball.colour, size: 11.5, weight: 600 });
  }

  // Where a plane cuts what is switched on; kept for each that asks.
  const sections = new Map();
  function section(plane = state.plane, asker = "slice") {
    const key = JSON.stringify([state.kinds, state.sheets, plane]);
    if (sections.get(asker)?.key !== key) {
      current();
      sections.set(asker, { key, found: cut(surface, state, plane) });
    }
    return sections.get(asker).found;
  }

  function drawPlane(context, where) {
    const { normal, offset, across, upward } = state.plane, r = 1.04 * data.radius, foot = scaled(normal, offset);
    const corners = [[-1, -1], [1, -1], [1, 1], [-1, 1], [-1, -1]].map(([a, b]) => where.to(sum(foot, sum(scaled(across, a * r), scaled(upward, b * r)))));
    line(context, corners, "#5b6570", 1, [4, 3]);
    strokes(context, section(), where.to, data.kinds, { ...byTorque(paints().ramp), width: () => 1.8 });
  }

  function drawPath(context, where, motion, current) {
    const h = array(motion.h), points = [];
    for (let i = 0; i < h.length; i += 3) if (Number.isFinite(h[i])) points.push(where.to([h[i], h[i + 1], h[i + 2]]));
    if (points.length < 2) return;
    if (current) line(context, points, "rgba(255,255,255,.8)", 5);
    context.globalAlpha = current ? 1 : 0.55;
    line(context, points, motion.colour, current ? 2.6 : 1.4, DASH[motion.dash]);
    context.globalAlpha = 1;
  }

  function drawMomentum(context, where) {
    const to = where.to(state.momentum), from = where.to([0, 0, 0]);
    line(context, [from, to], "rgba(255,255,255,.8)", 5);
    arrow(context, from, to, "#1b1f24", 2.2);
    dotAt(context, to);
  }

  return {
    section, paints,
    // Turned, cut or coloured in another way: coarse first.
    moved() { moving = true; repaint(...[...painters].filter((p) => !p.flat)); },
    changed() { moving = true; repaint(); },
    pick(x, y) {
      current();
      return picked(surface, list, view(), x, y);
    },
  };
}
