// Torque capability over planes of momentum space: a colour for each cell, and in each cell the
// gimbal angles that give it.
const NONE = 65535; // of a cell that no gimbal angles reach

function mapView(map, looks, section) {
  const view = document.querySelector(`[data-map="${map.key}"]`);
  const [behind, front] = view.querySelectorAll("canvas");
  const value = array(map.value), delta = array(map.delta), [nx, ny] = [map.x[2], map.y[2]];
  const [dx, dy] = [map.x, map.y].map(([low, high, count]) => (high - low) / Math.max(count - 1, 1));
  const ends = [map.x, map.y].map(([low, high], k) => [low - [dx, dy][k] / 2, high + [dx, dy][k] / 2]);
  const normal = planar ? [0, 0, 1] : cross(...map.basis), plane = { normal, offset: dot(normal, map.origin) };
  const order = new Int32Array(nx * ny).fill(-1); // of cells that are reached, as their angles are kept
  value.reduce((count, v, i) => (v === NONE ? count : ((order[i] = count), count + 1)), 0);
  const flat = (p) => map.basis.map((axis) => dot(axis, sum(p, scaled(map.origin, -1))));
  let at = [nx >> 1, ny >> 1], pointed = false, pressed = null, picture = null;

  const cellAt = ([i, j]) => j * nx + i;
  const placeOf = ([i, j]) => [map.x[0] + i * dx, map.y[0] + j * dy];
  const momentumAt = (cell) => placeOf(cell).reduce((h, v, k) => sum(h, scaled(map.basis[k], v)), map.origin);

  const colours = (() => {
    const small = Object.assign(document.createElement("canvas"), { width: nx, height: ny });
    const image = new ImageData(nx, ny), { data: pixels } = image, table = ramp(data.scale.map(rgbOf));
    value.forEach((v, cell) => {
      if (v === NONE) return;
      const k = 3 * Math.round((255 * v) / (NONE - 1)), p = 4 * ((ny - 1 - Math.floor(cell / nx)) * nx + (cell % nx));
      pixels.set([table[k], table[k + 1], table[k + 2], 255], p);
    });
    small.getContext("2d").putImageData(image, 0, 0);
    return small;
  })();

  const back = sheetOf(behind, (context, width, height) => {
    picture = frame(width, height, ...ends);
    const { left, top, wide, high } = picture;
    context.save();
    context.beginPath();
    context.rect(left, top, wide, high);
    context.clip();
    hatched(context, left, top, wide, high);
    context.imageSmoothingEnabled = false;
    context.drawImage(colours, left, top, wide, high);
    const place = (p) => picture.to(...flat(p));
    strokes(context, section(plane, map.key), place, looks, { width: (look) => 0.55 * look.width, halo: 1.4 });
    context.restore();
    scales(context, picture, map.names, { lines: false });
  });
  back.heavy = back.flat = true;

  const marks = sheetOf(front, (context, width, height) => {
    const where = frame(width, height, ...ends), away = Math.abs(dot(normal, state.momentum) - plane.offset);
    dotAt(context, where.to(...flat(state.momentum)), 5, away < 0.01 * data.radius ? 1 : 0.35);
    if (!pointed && document.activeElement !== view) return;
    const [x, y] = where.to(...placeOf(at)), [w, h] = [Math.max(dx * where.scale, 7), Math.max(dy * where.scale, 7)];
    for (const [colour, size] of [["#fff", 4], ["#1b1f24", 2]]) {
      Object.assign(context, { strokeStyle: colour, lineWidth: size });
      context.strokeRect(x - w / 2, y - h / 2, w, h);
    }
  });
  marks.flat = true;

  function tell() {
    const v = value[cellAt(at)], h = momentumAt(at).slice(0, planar ? 2 : 3);
    const said = v === NONE ? "cannot be reached" : `${tidy((v / (NONE - 1)) * map.most, 4)} N m in every direction`;
    const place = document.querySelector(`[data-map-told="${map.key}"]`);
    place.textContent = `h = ${vector(h)} N m s: ${said}`;
    repaint(marks);
  }

  function go() {
    const k = order[cellAt(at)];
    tell();
    if (k >= 0) byHand(angles(delta, k), "best torque at this momentum");
  }

  const under = (event) => {
    const box = view.getBoundingClientRect();
    const [a, b] = picture.from(event.clientX - box.left, event.clientY - box.top);
    const cell = [Math.round((a - map.x[0]) / dx), Math.round((b - map.y[0]) / dy)];
    return cell.every((c, k) => c >= 0 && c < [nx, ny][k]) ? cell : null;
  };
  const point = (event) => {
    const cell = under(event);
    pointed = Boolean(cell);
    if (cell) { at = cell; tell(); } else repaint(marks);
  };
  view.addEventListener("pointermove", point);
  view.addEventListener("pointerleave", () => { pointed = false; repaint(marks); });
  // A click's place is in whole pixels, and under a finger nothing points any more: as it was pressed.
  view.addEventListener("pointerdown", (event) => { pressed = under(event); point(event); });
  view.addEventListener("click", () => { if (pressed) { at = pressed; go(); } });
  view.addEventListener("focus", () => { if (view.matches(":focus-visible")) tell(); });
  view.addEventListener("blur", () => repaint(marks));
  const STEPS = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };
  view.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const step = STEPS[event.key], wide = event.shiftKey ? 5 : 1;
    if (step) at = at.map((v, k) => clamp(v + wide * step[k], 0, [nx, ny][k] - 1));
    else if (event.key === "Home") at = [nx >> 1, ny >> 1];
    else if (event.key !== "Enter" && event.key !== " ") return;
    event.preventDefault();
    if (step || event.key === "Home") tell(); else go();
  });
}

// Grey with stripes: no colour of the scale, and not white, which would be nothing at all.
function hatched(context, left, top, wide, high) {
  context.fillStyle = "#eceef1";
  context.fillRect(left, top, wide, high);
  context.beginPath();
  for (let x = left - high; x < left + wide; x += 7) { context.moveTo(x, top + high); context.lineTo(x + high, top); }
  Object.assign(context, { strokeStyle: "#b9c0c8", lineWidth: 1 });
  context.stroke();
}

for (const map of data.maps) if (document.querySelector(`[data-map="${map.key}"]`)) mapView(map, data.kinds, lines);
