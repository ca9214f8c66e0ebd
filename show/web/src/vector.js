// Small vectors as arrays, so that the forms of bodies can be decided without a renderer.

export const add = (a, b, s = 1) => [a[0] + s * b[0], a[1] + s * b[1], a[2] + s * b[2]];
export const scale = (a, s) => [a[0] * s, a[1] * s, a[2] * s];
export const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
export const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
export const length = (a) => Math.hypot(...a);
export const distance = (a, b) => length(add(a, b, -1));
export const unit = (a, otherwise = [0, 0, 1]) => { const l = length(a); return l > 0 ? scale(a, 1 / l) : otherwise; };
export const middle = (points) => scale(points.reduce((sum, p) => add(sum, p), [0, 0, 0]), 1 / points.length);

// A direction at right angles.
export function across(a) {
  const least = [0, 1, 2].reduce((k, j) => (Math.abs(a[j]) < Math.abs(a[k]) ? j : k), 0);
  return unit(cross(a, [0, 1, 2].map((k) => (k === least ? 1 : 0))));
}

// A vector of a body's frame in the global one; p are Euler parameters from pose[3].
export function turn(pose, v) {
  const [w, u] = [pose[3], [pose[4], pose[5], pose[6]]];
  const c = cross(u, v);
  return add(add(v, c, 2 * w), cross(u, c), 2);
}
export const inGlobal = (pose, point) => add([pose[0], pose[1], pose[2]], turn(pose, point));

// Principal moments and axes of [xx, yy, zz, xy, xz, yz], by Jacobi's rotations.
export function principal([xx, yy, zz, xy, xz, yz]) {
  const m = [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]];
  const axes = [[1, 0, 0], [0, 1, 0], [0, 0, 1]];
  for (let sweep = 0; sweep < 30; sweep++) {
    for (const [p, q] of [[0, 1], [0, 2], [1, 2]]) {
      if (Math.abs(m[p][q]) < 1e-14 * (Math.abs(m[p][p]) + Math.abs(m[q][q]))) continue;
      const angle = 0.5 * Math.atan2(2 * m[p][q], m[q][q] - m[p][p]);
      const [c, s] = [Math.cos(angle), Math.sin(angle)];
      for (let k = 0; k < 3; k++) [m[k][p], m[k][q]] = [c * m[k][p] - s * m[k][q], s * m[k][p] + c * m[k][q]];
      for (let k = 0; k < 3; k++) [m[p][k], m[q][k]] = [c * m[p][k] - s * m[q][k], s * m[p][k] + c * m[q][k]];
      [axes[p], axes[q]] = [add(scale(axes[p], c), axes[q], -s), add(scale(axes[p], s), axes[q], c)];
    }
  }
  return { moments: [m[0][0], m[1][1], m[2][2]], axes };
}
