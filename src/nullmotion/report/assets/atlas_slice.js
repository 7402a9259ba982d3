// A plane of momentum space drawn flat: where it cuts the surfaces, radii, path, momentum.
// An array with two torque dimensions has only this one plane.
function sliceView(data, array, state, section) {
  const canvas = document.querySelector("#atlas-slice canvas");
  return sheetOf(canvas, (context, width, height) => {
    const plane = state.plane;
    if (!plane) return;
    const edge = 44, side = Math.min(width, height) - edge - 12, most = 1.06 * data.radius;
    const left = edge + (width - edge - side) / 2 - 4, top = 8;
    const to = (a, b) => [left + (side * (a + most)) / (2 * most), top + (side * (most - b)) / (2 * most)];
    const flat = (p) => to(dot(p, plane.across), dot(p, plane.upward));
    axes(context, to, most, plane, left, top, side);
    context.save();
    context.beginPath();
    context.rect(left, top, side, side);
    context.clip();
    const { ends, kinds } = section();
    data.kinds.forEach((kind, k) => {
      context.beginPath();
      kinds.forEach((it, i) => {
        if (it !== k) return;
        context.moveTo(...flat(ends.slice(6 * i, 6 * i + 3)));
        context.lineTo(...flat(ends.slice(6 * i + 3, 6 * i + 6)));
      });
      Object.assign(context, { strokeStyle: kind.colour, lineWidth: kind.width, lineCap: "round" });
      context.stroke();
    });
    for (const ball of data.spheres.filter((s) => state.spheres[s.key])) {
      const away = plane.offset - dot(plane.normal, ball.centre), at = flat(ball.centre);
      if (ball.radius <= Math.abs(away)) continue;
      const r = (side * Math.sqrt(ball.radius ** 2 - away ** 2)) / (2 * most);
      context.beginPath();
      context.arc(...at, r, 0, 2 * Math.PI);
      Object.assign(context, { strokeStyle: ball.colour, lineWidth: 1.6 });
      context.setLineDash(DASH[ball.dash]);
      context.stroke();
      context.setLineDash([]);
    }
    for (const motion of data.motions) {
      const h = array(motion.h), points = [];
      for (let i = 0; i < h.length; i += 3) if (Number.isFinite(h[i])) points.push(flat([h[i], h[i + 1], h[i + 2]]));
      context.globalAlpha = motion === state.motion ? 1 : 0.5;
      line(context, points, motion.colour, motion === state.motion ? 2.4 : 1.3, DASH[motion.dash]);
      context.globalAlpha = 1;
    }
    const at = flat(state.momentum);
    context.beginPath();
    context.arc(...at, 5, 0, 2 * Math.PI);
    Object.assign(context, { fillStyle: "#fff", strokeStyle: "#1b1f24", lineWidth: 2.2 });
    context.fill();
    context.stroke();
    context.restore();
    drawn("lines");
  });

  function axes(context, to, most, plane, left, top, side) {
    const step = nice(most, 3);
    for (let k = -Math.floor(most / step); k * step <= most; k += 1) {
      const v = k * step, [x] = to(v, 0), [, y] = to(0, v);
      const colour = k === 0 ? "#5b6570" : "#e3e6ea";
      line(context, [[x, top], [x, top + side]], colour, 1);
      line(context, [[left, y], [left + side, y]], colour, 1);
      words(context, tidy(v), x, top + side + 11, { colour: "#5b6570", size: 11 });
      words(context, tidy(v), left - 5, y, { colour: "#5b6570", size: 11, align: "right" });
    }
    Object.assign(context, { strokeStyle: "#5b6570", lineWidth: 1 });
    context.strokeRect(left, top, side, side);
    words(context, `${plane.names[0]} [N m s]`, left + side / 2, top + side + 27, { size: 12 });
    context.save();
    context.translate(left - 34, top + side / 2);
    context.rotate(-Math.PI / 2);
    words(context, `${plane.names[1]} [N m s]`, 0, 0, { size: 12 });
    context.restore();
  }
}
