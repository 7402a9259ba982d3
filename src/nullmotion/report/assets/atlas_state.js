// What is shown, and what follows from it: rotor momenta, Jacobian, measures, singular points.
function rotors(array, delta) {
  return array.gimbal_axes.map((_, i) => {
    const [c, s] = [Math.cos(delta[i]), Math.sin(delta[i])];
    const [spin, across] = [array.spin_axes[i], array.transverse_axes[i]];
    return { h: sum(scaled(spin, c), scaled(across, s)), t: sum(scaled(across, c), scaled(spin, -s)) };
  });
}

function momentumOf(array, delta) {
  return rotors(array, delta).reduce((total, rotor, i) => sum(total, scaled(rotor.h, array.h0[i])), array.bias);
}

// Components along the torque axes, as the momentum's picture has them; three numbers always.
const inTorqueSpace = (array, v) => (array.torque_axes.length === 3 ? v : [0, 1, 2].map((k) => (array.torque_axes[k] ? dot(array.torque_axes[k], v) : 0)));

// Singular values of A over the mean momentum, largest first: roots of A A^T's eigenvalues.
function singularValues(array, delta) {
  const columns = rotors(array, delta).map((rotor, i) => array.torque_axes.map((axis) => (dot(axis, rotor.t) * array.h0[i]) / array.mean));
  const m = array.torque_axes.length;
  const gram = array.torque_axes.map((_, a) => array.torque_axes.map((__, b) => columns.reduce((s, c) => s + c[a] * c[b], 0)));
  // Jacobi's rotations: a 3 x 3 matrix is diagonal after a few sweeps.
  for (let sweep = 0; sweep < 12; sweep += 1)
    for (let p = 0; p < m; p += 1)
      for (let q = p + 1; q < m; q += 1) {
        if (Math.abs(gram[p][q]) < 1e-300) continue;
        const theta = (gram[q][q] - gram[p][p]) / (2 * gram[p][q]);
        const t = (theta >= 0 ? 1 : -1) / (Math.abs(theta) + Math.hypot(theta, 1));
        const c = 1 / Math.hypot(t, 1), s = t * c;
        for (let k = 0; k < m; k += 1) [gram[k][p], gram[k][q]] = [c * gram[k][p] - s * gram[k][q], s * gram[k][p] + c * gram[k][q]];
        for (let k = 0; k < m; k += 1) [gram[p][k], gram[q][k]] = [c * gram[p][k] - s * gram[q][k], s * gram[p][k] + c * gram[q][k]];
      }
  return gram.map((row, k) => Math.sqrt(Math.max(row[k], 0))).sort((a, b) => b - a);
}

// The singular point of a direction u (in B) and signs: gimbal angles, and the type from the
// radii of curvature C as in `nullmotion.atlas.kind`.
function singularPoint(array, u, signs) {
  const helper = Math.abs(u[0]) < 0.6 ? [1, 0, 0] : [0, 1, 0];
  const e1 = unit(cross(u, helper)), e2 = cross(u, e1);
  const delta = [], c = [0, 0, 0];
  array.gimbal_axes.forEach((g, i) => {
    const p = scaled(sum(u, scaled(g, -dot(u, g))), signs[i]);
    const across = length(p);
    delta.push(across < 1e-9 ? 0 : Math.atan2(dot(array.transverse_axes[i], p), dot(array.spin_axes[i], p)));
    const [a, b] = [dot(e1, cross(g, unit(p))), dot(e2, cross(g, unit(p)))];
    const weight = (signs[i] * array.h0[i]) / Math.max(across, 1e-6);
    [a * a, a * b, b * b].forEach((v, k) => { c[k] += weight * v; });
  });
  return { delta, kind: kindOf(array, signs, c) };
}

function kindOf(array, signs, [c11, c12, c22]) {
  const working = signs.filter((_, i) => array.h0[i] > 0);
  const [above, below] = [working.filter((s) => s > 0).length, working.filter((s) => s < 0).length];
  if (!above || !below) return "saturation";
  const [middle, spreadOf] = [(c11 + c22) / 2, Math.hypot((c11 - c22) / 2, c12)];
  const least = 1e-9 * array.mean;
  const values = [middle - spreadOf, middle + spreadOf];
  const [plus, minus] = [values.filter((v) => v > least).length, values.filter((v) => v < -least).length];
  const [positive, negative] = [above + minus - 2, below + plus - 2];
  if (positive > 0 && negative > 0) return "hyperbolic";
  return plus + minus < 2 ? "degenerate-hyperbolic" : "elliptic";
}

// A run at a time between its samples; after the last one it stands still.
function sample(times, table, width, t) {
  let low = 0, high = times.length - 1;
  if (t <= times[0] || high === 0) [low, high] = [0, 0];
  else if (t >= times[high]) low = high;
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (times[middle] <= t) low = middle; else high = middle;
  }
  const f = high > low ? (t - times[low]) / (times[high] - times[low]) : 0;
  return Array.from({ length: width }, (_, k) => (1 - f) * table[low * width + k] + f * table[high * width + k]);
}
