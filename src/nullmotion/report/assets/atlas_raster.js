// Draws ordered triangles without a graphics card: flat light, exact edges, no seams.
function rasteriser(canvas) {
  const context = canvas.getContext("2d");
  let image = null, pixels = null, width = 0, height = 0, detail = 1, took = 30;
  let xs = new Int32Array(0), ys = new Int32Array(0);
  const tone = new Float64Array(3), side = new Float64Array(3), level = new Float64Array(3);

  function prepare(view, sharp) {
    // Turning stays fluent on a slow machine; standing still is drawn with all detail.
    const most = Math.max(view.width, view.height);
    detail = sharp ? Math.max(1, Math.min(2, 1800 / most)) : clamp(detail * Math.sqrt(30 / Math.max(took, 8)), 0.4, 1);
    width = Math.max(1, Math.round(view.width * detail));
    height = Math.max(1, Math.round(view.height * detail));
    if (!image || image.width !== width || image.height !== height) {
      Object.assign(canvas, { width, height });
      image = context.createImageData(width, height);
      pixels = new Uint32Array(image.data.buffer);
    }
    pixels.fill(0);
  }

  // In 1/16 pixels, so that what two triangles share is decided alike for both.
  function project(surface, view) {
    const p = surface.place, count = p.length / 3, grain = (16 * width) / view.width;
    if (xs.length < count) { xs = new Int32Array(count); ys = new Int32Array(count); }
    const [[rx, ry, rz], [ux, uy, uz], [tx, ty, tz]] = [view.right, view.up, view.towards];
    const strength = view.size * view.far;
    for (let i = 0, v = 0; i < count; i += 1, v += 3) {
      const f = strength / (view.far - (tx * p[v] + ty * p[v + 1] + tz * p[v + 2]));
      xs[i] = Math.round((view.width / 2 + f * (rx * p[v] + ry * p[v + 1] + rz * p[v + 2])) * grain);
      ys[i] = Math.round((view.height / 2 - f * (ux * p[v] + uy * p[v + 1] + uz * p[v + 2])) * grain);
    }
  }

  // An edge that is no top or left one leaves its pixels to the neighbour.
  const bias = (dx, dy) => (dy < 0 || (dy === 0 && dx > 0) ? 0 : -1);

  // Colours are 0 to 255, alpha 0 to 256; `tone`, `side` and `level` hold what the corners have.
  function fill(va, vb, vc, red, green, blue, alpha, striped, gapped, ramp, shade) {
    const ax = xs[va], ay = ys[va];
    let bx = xs[vb], by = ys[vb], cx = xs[vc], cy = ys[vc], b = 1, c = 2;
    let area = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax);
    if (area === 0) return;
    if (area < 0) { [bx, by, cx, cy, b, c, area] = [cx, cy, bx, by, 2, 1, -area]; }
    const left = Math.max(0, Math.ceil((Math.min(ax, bx, cx) - 8) / 16));
    const right = Math.min(width - 1, Math.floor((Math.max(ax, bx, cx) - 8) / 16));
    const top = Math.max(0, Math.ceil((Math.min(ay, by, cy) - 8) / 16));
    const bottom = Math.min(height - 1, Math.floor((Math.max(ay, by, cy) - 8) / 16));
    if (left > right || top > bottom) return;
    const px = 16 * left + 8, py = 16 * top + 8;
    let rowA = (cx - bx) * (py - by) - (cy - by) * (px - bx) + bias(cx - bx, cy - by);
    let rowB = (ax - cx) * (py - cy) - (ay - cy) * (px - cx) + bias(ax - cx, ay - cy);
    let rowC = (bx - ax) * (py - ay) - (by - ay) * (px - ax) + bias(bx - ax, by - ay);
    const stepA = 16 * (cy - by), stepB = 16 * (ay - cy), stepC = 16 * (by - ay);
    for (let j = top; j <= bottom; j += 1) {
      let eA = rowA, eB = rowB, eC = rowC;
      for (let i = left, at = j * width + left; i <= right; i += 1, at += 1) {
        if (eA >= 0 && eB >= 0 && eC >= 0 && !(gapped && eA * side[0] + eB * side[b] + eC * side[c] > 0)) {
          let r = red, g = green, u = blue, strength = alpha;
          if (ramp) {
            const k = 3 * (((eA * level[0] + eB * level[b] + eC * level[c]) / area) | 0);
            r = shade * ramp[k]; g = shade * ramp[k + 1]; u = shade * ramp[k + 2];
          }
          if (striped) {
            const f = (eA * tone[0] + eB * tone[b] + eC * tone[c]) / area;
            if (f - Math.floor(f) < 0.2) { r *= 0.6; g *= 0.6; u *= 0.6; strength = Math.min(256, alpha + 50); }
          }
          const old = pixels[at], keep = 256 - strength;
          const nr = (r * strength + (old & 255) * keep) >> 8;
          const ng = (g * strength + ((old >> 8) & 255) * keep) >> 8;
          const nb = (u * strength + ((old >> 16) & 255) * keep) >> 8;
          const na = (255 * strength + (old >>> 24) * keep) >> 8;
          pixels[at] = ((na << 24) | (nb << 16) | (ng << 8) | nr) >>> 0;
        }
        eA -= stepA; eB -= stepB; eC -= stepC;
      }
      rowA += 16 * (cx - bx); rowB += 16 * (ax - cx); rowC += 16 * (bx - ax);
    }
  }

  // Canvases want colours that are not yet multiplied by their opacity.
  function divide() {
    for (let i = 0; i < pixels.length; i += 1) {
      const p = pixels[i], a = p >>> 24;
      if (a === 0 || a === 255) continue;
      const f = 255 / a;
      const r = Math.min(255, (p & 255) * f), g = Math.min(255, ((p >> 8) & 255) * f), b = Math.min(255, ((p >> 16) & 255) * f);
      pixels[i] = ((a << 24) | (b << 16) | (g << 8) | r) >>> 0;
    }
  }

  return {
    name: "raster",
    draw(surface, order, view, style, plane, sharp) {
      const begun = performance.now();
      prepare(view, sharp);
      project(surface, view);
      const { corner, kind, flat, place } = surface, { kinds: paints, ramp } = style;
      const [lx, ly, lz] = style.light(view), [tx, ty, tz] = view.towards, [sx, sy, sz] = style.stripeAxis;
      const [px, py, pz] = plane ? plane.normal : [0, 0, 0], offset = plane ? plane.offset : 0;
      for (let o = 0; o < order.length; o += 1) {
        const t = 3 * order[o], a = corner[t], b = corner[t + 1], c = corner[t + 2];
        const facing = flat[t] * tx + flat[t + 1] * ty + flat[t + 2] * tz;
        const lit = flat[t] * lx + flat[t + 1] * ly + flat[t + 2] * lz;
        const shade = Math.min(1, 0.7 + 0.3 * (facing < 0 ? -lit : lit)), paint = paints[kind[order[o]]];
        const thin = 1 - Math.abs(facing);
        const alpha = Math.round(256 * (paint.alpha + (1 - paint.alpha) * paint.rim * thin * thin * thin));
        if (paint.stripes) {
          tone[0] = sx * place[3 * a] + sy * place[3 * a + 1] + sz * place[3 * a + 2];
          tone[1] = sx * place[3 * b] + sy * place[3 * b + 1] + sz * place[3 * b + 2];
          tone[2] = sx * place[3 * c] + sy * place[3 * c + 1] + sz * place[3 * c + 2];
        }
        let gapped = false;
        if (plane) {
          side[0] = px * place[3 * a] + py * place[3 * a + 1] + pz * place[3 * a + 2] - offset;
          side[1] = px * place[3 * b] + py * place[3 * b + 1] + pz * place[3 * b + 2] - offset;
          side[2] = px * place[3 * c] + py * place[3 * c + 1] + pz * place[3 * c + 2] - offset;
          gapped = side[0] > 0 || side[1] > 0 || side[2] > 0;
        }
        if (ramp) { level[0] = surface.level[a]; level[1] = surface.level[b]; level[2] = surface.level[c]; }
        const { rgb } = paint;
        fill(a, b, c, shade * rgb[0], shade * rgb[1], shade * rgb[2], alpha, paint.stripes, gapped, ramp, shade);
      }
      divide();
      context.putImageData(image, 0, 0);
      if (!sharp) took = performance.now() - begun;
      return performance.now() - begun;
    },
  };
}
