// Where to look from, so that the whole motion is in the picture.
import { Vector3 } from 'three';
import { dot, length, turn, unit } from '../vector.js';
import { looks } from './forms.js';
import { poseAt } from '../data.js';

const TURNING = new Set(['Revolute', 'Cylindrical', 'Screw']);

export function upOf(mechanism) {
  const { gravity } = mechanism;
  return length(gravity) > 0 ? new Vector3(...unit(gravity)).negate() : new Vector3(0, 1, 0);
}

// The direction that all hinges share, if the mechanism moves in a plane that stands upright.
function hinge(scene, up) {
  const axes = [];
  for (const joint of scene.mechanism.joints) {
    if (joint.kind === 'Spherical' || joint.kind === 'Universal') continue;
    if (!TURNING.has(joint.kind)) continue;
    const { body, axis } = joint.ends[0];
    axes.push(turn(poseAt(scene, body, scene.time[0]), axis));
  }
  if (!axes.length || axes.some((axis) => Math.abs(dot(axis, axes[0])) < 0.98)) return null;
  return Math.abs(dot(axes[0], up.toArray())) < 0.3 ? new Vector3(...axes[0]) : null;
}

// Where a top leans at the start, seen from above.
function leaning(scene, up, form) {
  for (const [b, parts] of form.parts.entries()) {
    const cone = parts.find(({ type }) => type === 'cone');
    if (!cone) continue;
    const axis = new Vector3(...turn(poseAt(scene, b, scene.time[0]), cone.axis));
    axis.addScaledVector(up, -axis.dot(up));
    if (axis.length() > 0.1) return axis.normalize();
  }
  return null;
}

// From the mechanism to the camera.
export function direction(scene, up, form) {
  const nested = form.parts.flat().some(({ type }) => type === 'ring');
  const planar = nested ? null : hinge(scene, up);
  const side = new Vector3(1, 0, 0);
  if (Math.abs(side.dot(up)) > 0.9) side.set(0, 0, 1);
  side.addScaledVector(up, -side.dot(up)).normalize();
  if (planar) {
    planar.addScaledVector(up, -planar.dot(up)).normalize();
    if (planar.dot(new Vector3(1, 1.1, 1.2)) < 0) planar.negate();
    const right = up.clone().cross(planar);
    // What a wheel turns on is behind or before it.
    return planar.addScaledVector(up, 0.3).addScaledVector(right, form.isWheel ? 1.2 : 0.42).normalize();
  }
  // Across the lean of a top, which otherwise hides the tip that it spins on.
  const lean = leaning(scene, up, form);
  if (lean) return lean.clone().cross(up).addScaledVector(up, 0.12).normalize();
  const front = side.clone().cross(up);
  return front.multiplyScalar(0.82).addScaledVector(side, 0.62).addScaledVector(up, form.hasTop ? 0.12 : 0.38).normalize();
}

// Some vertices of a body's meshes, in its frame.
function outline(group) {
  const found = [];
  const parent = group.parent;
  group.removeFromParent();
  group.position.set(0, 0, 0);
  group.quaternion.identity();
  group.updateMatrixWorld(true);
  for (const child of group.children) {
    if (child.userData.ghost) continue;
    child.traverse(({ geometry, matrixWorld }) => {
      const vertices = geometry?.getAttribute('position');
      if (!vertices) return;
      const every = Math.max(1, Math.floor(vertices.count / 40));
      for (let k = 0; k < vertices.count; k += every) found.push(new Vector3().fromBufferAttribute(vertices, k).applyMatrix4(matrixWorld));
    });
  }
  parent.add(group);
  return found;
}

// The middle of what moves, at a time that is shown.
export function middle({ bodies, scene }) {
  const moving = bodies.filter((_, b) => scene.bodies[b].moves);
  return moving.reduce((sum, { group }) => sum.addScaledVector(group.position, 1 / moving.length), new Vector3());
}

// The standard views: from where, with x to the right or, of the one from the side, towards the camera.
export function standard(up) {
  const right = new Vector3(1, 0, 0);
  if (Math.abs(right.dot(up)) > 0.9) right.set(0, 0, 1);
  right.addScaledVector(up, -right.dot(up)).normalize();
  const front = right.clone().cross(up);
  // Not quite from above: which way is up stays.
  const top = up.clone().addScaledVector(front, 1e-3).normalize();
  return { 1: ['front', front], 2: ['top', top], 3: ['side', right], 4: ['corner', front.clone().add(right).add(up).normalize()] };
}

// Points of all bodies at times of the run; or of those that move, from the middle of these.
export function corners(actors, fromMiddle = false) {
  const outlines = actors.bodies.map(({ group }) => outline(group));
  const found = [];
  const add = (point, { position, quaternion }, about) => found.push(point.applyQuaternion(quaternion).add(position).sub(about));
  for (const t of looks(actors.scene, 40)) {
    actors.show(t);
    const about = fromMiddle ? middle(actors) : new Vector3();
    outlines.forEach((points, b) => {
      if (fromMiddle && !actors.scene.bodies[b].moves) return;
      // What stands still is looked at once.
      if (t > actors.scene.time[0] && !actors.scene.bodies[b].moves) return;
      for (const point of points) add(point.clone(), actors.bodies[b].group, about);
    });
    for (const { ends } of actors.stretched) for (const [b, at] of ends) if (!fromMiddle) add(new Vector3(...at), actors.bodies[b].group, about);
  }
  return found;
}

// Puts the camera so far away that the points fill the picture.
export function fit(camera, target, points, from, up) {
  const back = from.clone().normalize();
  const right = up.clone().cross(back).normalize();
  const top = back.clone().cross(right);
  const range = (axis) => points.reduce(([a, b], p) => [Math.min(a, p.dot(axis)), Math.max(b, p.dot(axis))], [Infinity, -Infinity]);
  const middle = [right, top, back].map((axis) => { const [a, b] = range(axis); return (a + b) / 2; });
  const centre = new Vector3();
  [right, top, back].forEach((axis, k) => centre.addScaledVector(axis, middle[k]));
  const tall = Math.tan((camera.fov * Math.PI) / 360);
  const wide = tall * camera.aspect;
  let far = 1e-9;
  for (const p of points) {
    const d = p.clone().sub(centre);
    far = Math.max(far, Math.abs(d.dot(right)) / wide + d.dot(back), Math.abs(d.dot(top)) / tall + d.dot(back));
  }
  far *= 1.12;
  camera.up.copy(up);
  camera.position.copy(centre).addScaledVector(back, far);
  camera.near = far / 200;
  camera.far = far * 20;
  camera.updateProjectionMatrix();
  camera.lookAt(centre);
  target.copy(centre);
  return far;
}
