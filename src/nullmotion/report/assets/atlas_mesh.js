// The singular surfaces as one list of triangles, each of one type.
//
// A triangle whose corners differ in type is cut where the quadratic form's margin passes
// through zero (halfway where none is given), so that the types part along a smooth line.
function mesh(data, array, wanted) {
  const vertices = [], normals = [], levels = [], triangles = [], kinds = [], owners = [], firsts = [];
  let count = 0;
  data.sheets.forEach((sheet, owner) => {
    if (!wanted[owner]) return;
    const grid = data.meshes[sheet.mesh];
    const h = array(sheet.h), kind = array(sheet.kind), corners = array(grid.triangles);
    const u = array(grid.u);
    const margin = sheet.margin === undefined ? null : array(sheet.margin);
    const left = grid.left === undefined ? null : array(grid.left);
    const first = count;
    firsts[owner] = first;
    for (let i = 0; i < h.length; i += 1) vertices.push(h[i] * data.quantum);
    for (let i = 0; i < u.length; i += 1) normals.push(u[i] / 32767);
    for (let i = 0; 3 * i < h.length; i += 1) levels.push(left ? left[i] : 0);
    count += h.length / 3;
    const add = (a, b, c, k) => { triangles.push(a, b, c); kinds.push(k); owners.push(owner); };
    const between = (a, b) => {
      const f = margin && margin[a] * margin[b] < 0 ? margin[a] / (margin[a] - margin[b]) : 0.5;
      for (let j = 0; j < 3; j += 1) {
        const [p, q] = [3 * (first + a) + j, 3 * (first + b) + j];
        vertices.push(vertices[p] + f * (vertices[q] - vertices[p]));
        normals.push(normals[p] + f * (normals[q] - normals[p]));
      }
      levels.push(levels[first + a] + f * (levels[first + b] - levels[first + a]));
      count += 1;
      return count - 1;
    };
    for (let t = 0; t < corners.length; t += 3) {
      const [a, b, c] = [corners[t], corners[t + 1], corners[t + 2]];
      const [ka, kb, kc] = [kind[a], kind[b], kind[c]];
      if (ka === kb && kb === kc) add(first + a, first + b, first + c, ka);
      else if (ka !== kb && kb !== kc && kc !== ka) add(first + a, first + b, first + c, kb);
      else {
        // p is the corner that differs from q and r
        const [p, q, r] = kb === kc ? [a, b, c] : kc === ka ? [b, c, a] : [c, a, b];
        const [pq, pr] = [between(p, q), between(p, r)];
        add(first + p, pq, pr, kind[p]);
        add(pq, first + q, first + r, kind[q]);
        add(pq, first + r, pr, kind[q]);
      }
    }
  });
  return finished({
    firsts,
    place: Float32Array.from(vertices), normal: Float32Array.from(normals), level: Uint8Array.from(levels),
    corner: Uint32Array.from(triangles), kind: Uint8Array.from(kinds), owner: Uint16Array.from(owners),
  });
}

function finished(made) {
  const { place, normal, corner } = made;
  const middle = new Float32Array(corner.length), flat = new Float32Array(corner.length);
  for (let t = 0; t < corner.length; t += 3) {
    for (let j = 0; j < 3; j += 1) {
      const [a, b, c] = [3 * corner[t] + j, 3 * corner[t + 1] + j, 3 * corner[t + 2] + j];
      middle[t + j] = (place[a] + place[b] + place[c]) / 3;
      flat[t + j] = normal[a] + normal[b] + normal[c];
    }
    const size = Math.hypot(flat[t], flat[t + 1], flat[t + 2]) || 1;
    for (let j = 0; j < 3; j += 1) flat[t + j] /= size;
  }
  return { ...made, middle, flat, count: corner.length / 3 };
}

// Triangles that are switched on and not wholly cut away.
function chosen(surface, shown, plane) {
  const { corner, place, kind, owner, count } = surface;
  const list = new Uint32Array(count);
  let size = 0;
  for (let t = 0; t < count; t += 1) {
    if (!shown.kinds[kind[t]] || !shown.sheets[owner[t]]) continue;
    if (plane) {
      let inside = false;
      for (let j = 0; j < 3 && !inside; j += 1) {
        const v = 3 * corner[3 * t + j];
        inside = plane.normal[0] * place[v] + plane.normal[1] * place[v + 1] + plane.normal[2] * place[v + 2] <= plane.offset;
      }
      if (!inside) continue;
    }
    list[size++] = t;
  }
  return list.subarray(0, size);
}

// Far triangles first: a counting sort by the distance of their middles.
function ordered(surface, list, towards, radius) {
  const BINS = 4096;
  const { middle } = surface;
  const starts = new Uint32Array(BINS + 1), bins = new Uint16Array(list.length), sorted = new Uint32Array(list.length);
  const factor = (BINS - 1) / (2.2 * radius);
  for (let i = 0; i < list.length; i += 1) {
    const m = 3 * list[i];
    const depth = towards[0] * middle[m] + towards[1] * middle[m + 1] + towards[2] * middle[m + 2];
    bins[i] = clamp((depth + 1.1 * radius) * factor, 0, BINS - 1);
    starts[bins[i] + 1] += 1;
  }
  for (let b = 0; b < BINS; b += 1) starts[b + 1] += starts[b];
  for (let i = 0; i < list.length; i += 1) sorted[starts[bins[i]]++] = list[i];
  return sorted;
}

// The nearest triangle under a pixel, and the unit direction u there.
function picked(surface, list, view, x, y) {
  const { corner, place, normal } = surface;
  let found = null, nearest = -Infinity;
  const point = (v) => view.to([place[3 * v], place[3 * v + 1], place[3 * v + 2]]);
  for (const t of list) {
    const v = [corner[3 * t], corner[3 * t + 1], corner[3 * t + 2]];
    const m = 3 * t;
    const depth = dot(view.towards, [surface.middle[m], surface.middle[m + 1], surface.middle[m + 2]]);
    if (depth <= nearest) continue;
    const [a, b, c] = v.map(point);
    const area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
    if (area === 0) continue;
    const f = ((x - a[0]) * (c[1] - a[1]) - (y - a[1]) * (c[0] - a[0])) / area;
    const g = ((b[0] - a[0]) * (y - a[1]) - (b[1] - a[1]) * (x - a[0])) / area;
    if (f < 0 || g < 0 || f + g > 1) continue;
    const mixed = (table) => [0, 1, 2].map((j) => (1 - f - g) * table[3 * v[0] + j] + f * table[3 * v[1] + j] + g * table[3 * v[2] + j]);
    const most = f >= g && f >= 1 - f - g ? 1 : g >= 1 - f - g ? 2 : 0; // the corner that is closest
    found = { owner: surface.owner[t], kind: surface.kind[t], u: unit(mixed(normal)), vertex: v[most] - surface.firsts[surface.owner[t]] };
    nearest = depth;
  }
  return found;
}
