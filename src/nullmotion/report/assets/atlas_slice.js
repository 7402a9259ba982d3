// A plane of momentum space drawn flat: where it cuts the surfaces, radii, path, momentum.
// An array with two torque dimensions has only this one plane.
function sliceView(data, array, state, section, paints) {
  const canvas = document.querySelector("#atlas-slice canvas");
  const painter = sheetOf(canvas, (context, width, height) => {
    const { plane } = state;
    if (!plane) return;
    const most = 1.06 * data.radius, picture = frame(width, height, [-most, most], [-most, most]);
    const flat = (p) => picture.to(dot(p, plane.across), dot(p, plane.upward));
    scales(context, picture, plane.names);
    context.save();
    context.beginPath();
    context.rect(picture.left, picture.top, picture.wide, picture.high);
    context.clip();
    strokes(context, section(), flat, data.kinds, byTorque(paints()?.ramp));
    circles(context, { normal: plane.normal, foot: scaled(plane.normal, plane.offset), to: flat }, picture.scale, data.spheres.filter((s) => state.spheres[s.key]));
    for (const motion of data.motions) {
      const h = array(motion.h), points = [], current = motion === state.motion;
      for (let i = 0; i < h.length; i += 3) if (Number.isFinite(h[i])) points.push(flat([h[i], h[i + 1], h[i + 2]]));
      context.globalAlpha = current ? 1 : 0.5;
      line(context, points, motion.colour, current ? 2.4 : 1.3, DASH[motion.dash]);
      context.globalAlpha = 1;
    }
    dotAt(context, flat(state.momentum));
    context.restore();
    drawn("lines");
  });
  painter.flat = true; // turning the view does not change it
  return painter;
}
