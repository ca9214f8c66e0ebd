// What bodies and joints look like, decided from what is known of them: joint points and axes, mass and inertia. No
// renderer here: a *part* is plain data in a body's frame.
//
// - A body between two axes that cross at one point is a ring of a gimbal; rings nest, the outer around the inner.
// - A body on one axis through its mass centre is a rotor: the solid of revolution with its inertia, on a shaft.
// - Any other body is made of bars between its joint points, with the solid of its inertia about them.
import { poseAt } from '../data.js';
import {
  across, add, cross, distance, dot, inGlobal, length, middle, principal, scale, turn, unit,
} from '../vector.js';

const RING_STEP = 1.3;
const TURNING = new Set(['Revolute', 'Cylindrical', 'Screw']);
const HINGED = new Set(['Revolute', 'Cylindrical', 'Screw', 'Universal', 'Spherical']);

// The homogeneous cylinder, sphere or box with a body's inertia; null if it has none.
export function solidOf({ mass, inertia }) {
  const { moments, axes } = principal(inertia);
  const most = Math.max(...moments);
  if (!(mass > 0) || !(most > 0)) return null;
  const near = (a, b) => Math.abs(a - b) < 0.03 * most;
  const [a, b, c] = moments;
  if (near(a, b) && near(b, c)) return { type: 'sphere', at: [0, 0, 0], radius: Math.sqrt(2.5 * most / mass) };
  for (const [k, i, j] of [[0, 1, 2], [1, 2, 0], [2, 0, 1]]) {
    if (!near(moments[i], moments[j])) continue;
    const radius = Math.sqrt(Math.max(2 * moments[k], 1e-6 * most) / mass);
    const height = Math.sqrt(Math.max(6 * (moments[i] + moments[j] - moments[k]) / mass, 0.01 * radius * radius));
    return { type: 'cylinder', at: [0, 0, 0], axis: axes[k], radius, height };
  }
  const edge = (i, j, k) => Math.sqrt(Math.max(6 * (moments[i] + moments[j] - moments[k]) / mass, 1e-5 * most / mass));
  return { type: 'box', at: [0, 0, 0], axes, size: [edge(1, 2, 0), edge(2, 0, 1), edge(0, 1, 2)] };
}

export const reach = (solid) => (!solid ? 0 : solid.type === 'sphere' ? solid.radius
  : solid.type === 'cylinder' ? Math.hypot(solid.radius, solid.height / 2) : length(solid.size) / 2);

// Semi-axes of the homogeneous ellipsoid with a body's inertia.
export function ellipsoidOf({ mass, inertia }) {
  if (!(mass > 0)) return null;
  const { moments, axes } = principal(inertia);
  const semi = (i, j, k) => Math.sqrt(Math.max(2.5 * (moments[i] + moments[j] - moments[k]) / mass, 0));
  const size = [semi(1, 2, 0), semi(2, 0, 1), semi(0, 1, 2)];
  return Math.max(...size) > 0 ? { axes, size } : null;
}

// Where two lines come nearest, and how near.
function crossing(a, b) {
  const n = cross(a.axis, b.axis);
  const nn = dot(n, n);
  if (nn < 0.19) return null;
  const d = add(b.point, a.point, -1);
  const p = add(a.point, a.axis, dot(cross(d, b.axis), n) / nn);
  const q = add(b.point, b.axis, dot(cross(d, a.axis), n) / nn);
  return { at: middle([p, q]), gap: distance(p, q), normal: unit(n) };
}

// Points of a body by which it is connected.
function attachments(mechanism, b) {
  const found = [];
  mechanism.joints.forEach((joint, index) => joint.ends.forEach((end, side) => {
    if (end.body === b) found.push({ kind: joint.kind, joint: index, side, ...end });
  }));
  mechanism.links.forEach((link) => link.ends.forEach(([body, point]) => {
    if (body === b) found.push({ kind: 'Link', point, axis: [0, 0, 1] });
  }));
  return found;
}

function distinct(points, apart) {
  const kept = [];
  for (const p of points) if (!kept.some((q) => distance(p, q) < apart)) kept.push(p);
  return kept;
}

// Times at which the motion is looked at to see how much room it takes.
export function looks(scene, most = 60) {
  const n = scene.time.length;
  const every = Math.max(1, (n - 1) / most);
  const times = [];
  for (let k = 0; k < n; k += every) times.push(scene.time[Math.floor(k)]);
  return times;
}

export function forms(scene) {
  const { mechanism } = scene;
  const { bodies, joints } = mechanism;
  const solids = bodies.map((body) => (body.support === 'fixed' ? null : solidOf(body)));
  const held = bodies.map((_, b) => attachments(mechanism, b));
  const start = bodies.map((_, b) => poseAt(scene, b, scene.time[0]));

  // The mechanism's size: of the room that joints take, or of its bodies where these have their joints at one point.
  const points = held.flatMap((all, b) => all.map(({ point }) => inGlobal(start[b], point)));
  bodies.forEach((body, b) => { if (body.support !== 'fixed') points.push(inGlobal(start[b], [0, 0, 0])); });
  const centre = points.length ? middle(points) : [0, 0, 0];
  const spread = 2 * Math.max(0, ...points.map((p) => distance(p, centre)));
  const reaches = solids.map(reach).filter((r) => r > 0).sort((a, b) => a - b);
  const body = reaches.length ? reaches[reaches.length - 1] : 0;
  const isNest = spread < 0.2 * body;
  const size = Math.max(spread, (isNest ? 1.6 : 0.8) * body, 1e-9);

  // What stands still, or is moved as a base without mass is.
  const isGround = (b) => bodies[b].support !== 'moving' && !(bodies[b].support === 'driven' && bodies[b].mass > 0);
  const down = unit(mechanism.gravity, [0, -1, 0]);
  const rings = bodies.map((each, b) => {
    if (isGround(b) || each.shapes?.length) return null;
    const turning = held[b].filter(({ kind }) => TURNING.has(kind));
    const gyration = Math.max(reach(solids[b]), 1e-12);
    for (let i = 0; i < turning.length; i++) {
      for (let j = 0; j < i; j++) {
        const found = crossing(turning[i], turning[j]);
        if (found && found.gap < 0.08 * gyration && length(found.at) < 0.3 * gyration) return { ...found, pins: [turning[i], turning[j]] };
      }
    }
    return null;
  });
  const rotors = bodies.map((each, b) => {
    if (isGround(b) || each.shapes?.length || held[b].length !== 1) return null;
    const [only] = held[b];
    if (!TURNING.has(only.kind) || !solids[b]) return null;
    const along = dot(only.point, only.axis);
    return length(add(only.point, only.axis, -along)) < 0.05 * reach(solids[b]) ? only : null;
  });

  // Outer radii, from the innermost outwards.
  const radii = new Map();
  const radius = (b, seen = new Set()) => {
    if (radii.has(b)) return radii.get(b);
    if (seen.has(b)) return 0;
    seen.add(b);
    let own = 0;
    if (rings[b]) {
      const inside = joints.filter(({ ends }) => ends[0].body === b).map(({ ends }) => room(ends[1].body, seen));
      const { moments } = principal(bodies[b].inertia);
      const alone = bodies[b].mass > 0 ? Math.sqrt(Math.max(...moments) / bodies[b].mass) : 0;
      own = Math.max(alone, RING_STEP * Math.max(0, ...inside));
    } else if (solids[b]) {
      const solid = solids[b];
      own = solid.type === 'cylinder' ? Math.hypot(solid.radius, solid.height / 2) : reach(solid);
    }
    radii.set(b, own);
    return own;
  };

  // With what stands off from a ring.
  const room = (b, seen) => Math.max(radius(b, seen), ...(rings[b] ? held[b].map(({ point }) => distance(point, rings[b].at)) : []));

  const nested = rings.some(Boolean);
  const widest = Math.max(0, ...bodies.map((_, b) => (rings[b] ? radius(b) : 0)));
  const thick = 0.018 * Math.max(nested && isNest ? 0 : size, nested ? 2.6 * widest : 0);
  // Half the length of the shaft of a rotor that stands on the ground.
  const shaftOf = (b) => {
    const solid = solids[b];
    const isDisc = solid.type === 'cylinder' && Math.abs(dot(solid.axis, rotors[b].axis)) > 0.9;
    return isDisc ? solid.height / 2 + 0.7 * solid.radius : reach(solid) * 1.2;
  };
  const formOf = (b) => {
    const each = bodies[b];
    const parts = [];
    const solid = solids[b];
    if (each.shapes?.length) {
      parts.push(...each.shapes.map((shape) => ({ type: 'shape', ...shape, surface: scene.meshes[shape.mesh] })));
      return parts;
    }
    if (rings[b]) {
      const { at, normal, pins } = rings[b];
      parts.push({ type: 'ring', at, axis: normal, radius: radius(b), thick: 1.5 * thick });
      for (const pin of pins) {
        // A ring carries the pins on which what is inside of it turns.
        const other = joints[pin.joint].ends[1 - pin.side].body;
        const inner = pin.side === 0 ? (rings[other] ? radius(other) : 0) : null;
        if (inner === null) continue;
        if (inner > 0) {
          for (const sign of [-1, 1]) {
            parts.push({ type: 'rod', from: add(at, pin.axis, sign * inner), to: add(at, pin.axis, sign * radius(b)), thick: 0.8 * thick, metal: true });
          }
        }
      }
      // What else it is joined by stands off from its rim.
      for (const { point } of held[b]) {
        const off = add(point, at, -1);
        const inPlane = add(off, normal, -dot(off, normal));
        if (length(off) < 0.3 * radius(b)) continue;
        if (length(inPlane) < 0.3 * radius(b)) {
          // Two arms from the pins that the ring hangs on.
          const { axis } = pins.find(({ side }) => side === 1) ?? pins[0];
          for (const sign of [-1, 1]) parts.push({ type: 'rod', from: add(at, axis, sign * radius(b)), to: point, thick: 0.7 * thick });
          continue;
        }
        parts.push({ type: 'rod', from: add(at, unit(inPlane), radius(b)), to: point, thick });
      }
      return parts;
    }
    if (rotors[b]) {
      const { axis, point, joint, side } = rotors[b];
      const other = joints[joint].ends[1 - side].body;
      const half = rings[other] ? radius(other) : shaftOf(b);
      parts.push({ ...solid, marked: axis });
      parts.push({ type: 'rod', from: add(point, axis, -half), to: add(point, axis, half), thick: 0.8 * thick, metal: true });
      return parts;
    }
    if (isGround(b)) return groundParts(b);
    const at = held[b].map(({ point }) => point);
    const ends = distinct(at, 0.03 * size);
    const isShort = Math.max(0, ...ends.map(length)) < 0.03 * size;
    if (ends.length > 1 || !isShort) {
      const hub = ends.length === 2 && offLine([0, 0, 0], ends) < 0.12 * distance(...ends) ? null
        : ends.length === 1 ? [0, 0, 0] : hubOf(ends);
      if (isTop(b, ends)) {
        const [tip] = ends;
        const away = unit(scale(tip, -1));
        parts.push({ type: 'cone', tip, axis: away, radius: 0.75 * solid.radius, height: length(tip) - 0.4 * solid.height });
        parts.push({ type: 'rod', from: [0, 0, 0], to: scale(away, solid.height / 2 + 0.7 * solid.radius), thick: 0.09 * solid.radius });
      } else if (ends.length > 2 && flat(ends, 0.06 * size)) {
        parts.push({ type: 'plate', points: ends, normal: flat(ends, 0.06 * size), thick: 0.9 * thick });
        if (offPlane(ends) > 3 * thick) parts.push({ type: 'rod', from: middle(ends), to: [0, 0, 0], thick });
      } else if (isBarBy(solid, ends)) {
        parts.push({ type: 'bar', from: ends[0], to: add([0, 0, 0], unit(ends[0]), -Math.min(solid.height / 2, 1.2 * length(ends[0]))), thick: 1.25 * thick, across: barAcross(held[b], [ends[0], [0, 0, 0]]) });
      } else if (hub) for (const end of ends) { if (distance(end, hub) > 1e-9) parts.push({ type: 'rod', from: hub, to: end, thick }); }
      else {
        const side = barAcross(held[b], ends);
        // Bars that share a hinge lie side by side.
        const from = side ? add(ends[0], side, (b % 2 ? 0.75 : -0.75) * thick) : ends[0];
        parts.push({ type: 'bar', from, to: add(from, add(ends[1], ends[0], -1)), thick: 1.25 * thick, across: side });
      }
      if (ends.length === 1 && solid && !isBarBy(solid, ends)) {
        // A bar that hangs from one end shows whole by its solid; a bob at a rod's end by a ball.
        parts.push({ ...solid, marked: solid.type === 'cylinder' && solid.radius > solid.height ? solid.axis : null });
      }
      return parts;
    }
    if (solid && !held[b].some(({ kind }) => kind === 'Prismatic')) {
      const far = reach(solid) > 0.9 * size && !isNest && spread > 0 ? 0.35 * size / reach(solid) : 1;
      parts.push({ ...shrunk(solid, far), marked: solid.axis ?? null });
    } else if (!solid) parts.push({ type: 'sphere', at: [0, 0, 0], radius: 2 * thick });
    return parts;
  };

  // A fork goes round where nothing else is joined to the ground.
  const backOf = (b, { joint, point, axis }, wide) => {
    const others = held[b].filter((other) => other.joint !== joint).map((other) => add(other.point, point, -1));
    const aside = others.length ? middle(others) : [0, 0, 0];
    const level = add(aside, axis, -dot(aside, axis));
    return length(level) > 0.1 * wide ? scale(unit(level), -1) : unit(cross(axis, across(axis)));
  };

  // Whether what carries the mechanism is turned by a driver.
  const rocks = (b) => bodies[b].support === 'driven'
    && looks(scene).some((t) => distance(poseAt(scene, b, t).slice(4, 7), start[b].slice(4, 7)) > 1e-3);

  const groundParts = (b) => {
    const parts = [];
    for (const { joint, side, kind, point, axis } of held[b]) {
      if (joint === undefined) continue;
      const other = joints[joint].ends[1 - side].body;
      if (rings[other]) {
        // A fork about the outermost ring.
        const outer = radius(other);
        const wide = RING_STEP * 0.93 * outer;
        const isUpright = Math.abs(dot(down, axis)) >= 0.8;
        const back = isUpright ? backOf(b, { joint, point, axis }, wide) : unit(add(down, axis, -dot(down, axis)));
        parts.push({ type: 'arc', at: point, axis, back, radius: wide, thick: 1.7 * thick });
        for (const sign of [-1, 1]) {
          parts.push({ type: 'rod', from: add(point, axis, sign * outer), to: add(point, axis, sign * wide), thick: 0.8 * thick, metal: true });
        }
        const foot = isUpright ? add(point, axis, Math.sign(dot(down, axis)) * wide) : add(point, back, wide);
        parts.push({ type: 'foot', at: foot, height: 0.35 * outer, wide: 0.5 * outer, thick });
        if (rocks(b)) parts.push({ type: 'rocker', at: add(foot, down, 0.35 * outer), wide: 0.75 * outer });
      } else if (isTop(other, held[other].map((end) => end.point))) {
        const wide = solids[other].radius;
        parts.push({ type: 'foot', at: point, height: 0.8 * wide, wide: 0.5 * wide, thick: 0.07 * wide });
      } else if (kind === 'Spherical' && held[other].length === 1 && solids[other]?.type === 'cylinder' && solids[other].radius > solids[other].height) {
        // A disc at the end of a rod that leans on a ball: the ball stands higher than the disc reaches down.
        const wide = solids[other].radius;
        parts.push({ type: 'foot', at: point, height: 1.15 * wide, wide: 0.5 * wide, thick: 0.8 * thick });
      } else if (rotors[other] && Math.abs(dot(down, axis)) < 0.8) {
        // Two bearings on posts.
        const half = shaftOf(other);
        const low = reach(solids[other]) * 1.2;
        const floor = unit(add(down, axis, -dot(down, axis)));
        for (const sign of [-1, 1]) {
          const at = add(point, axis, 0.92 * sign * half);
          parts.push({ type: 'rod', from: add(at, axis, -1.6 * thick), to: add(at, axis, 1.6 * thick), thick: 2 * thick });
          parts.push({ type: 'foot', at, height: low, wide: 4 * thick, thick: 0.7 * thick });
        }
        parts.push({ type: 'bar', from: add(add(point, axis, -1.2 * half), floor, low), to: add(add(point, axis, 1.2 * half), floor, low), thick, across: floor });
      } else if (rotors[other]) {
        const half = shaftOf(other);
        parts.push({ type: 'foot', at: add(point, axis, Math.sign(dot(down, axis)) * 0.6 * half), height: half, wide: 0.6 * half, thick: 1.4 * thick });
      } else if (HINGED.has(kind) || kind === 'Fixed') {
        parts.push({ type: 'bracket', at: point, wide: 3.2 * thick });
      }
    }
    return parts;
  };

  // A spinning top: a disc on one ball, not far below it.
  const isTop = (b, ends) => {
    const solid = solids[b];
    return ends.length === 1 && held[b].length === 1 && held[b][0].kind === 'Spherical' && solid?.type === 'cylinder'
      && length(ends[0]) < 2.5 * solid.radius && length(ends[0]) > 0.5 * solid.height
      && Math.abs(dot(unit(ends[0]), solid.axis)) > 0.97;
  };

  // The solid of the inertia around bars, as a ghost: it says where the mass is.
  const ghostOf = (b, parts) => {
    const solid = solids[b];
    if (!solid || rings[b] || rotors[b] || bodies[b].shapes?.length || !parts.some(({ type }) => type === 'bar' || type === 'rod' || type === 'plate')) return null;
    if (parts.some(({ type }) => type === 'cylinder' || type === 'box' || type === 'sphere')) return null;
    return reach(solid) < 0.7 * size ? solid : null;
  };

  const coilOf = (joint, shaft) => {
    const { kind, ends: [first, second] } = joint;
    if (kind === 'Prismatic') {
      // From where the rail begins, if the slider would hide it.
      const from = isSprungOnGround(scene, joint) ? add(first.point, first.axis, railOf(scene, joint, thick).begin) : first.point;
      return { between: [[first.body, from], [second.body, second.point]], radius: 2.6 * thick };
    }
    const [from, to] = shaft ? [0.3 * shaft, 0.85 * shaft] : [-2.5 * thick, 2.5 * thick];
    const radius = (shaft ? 4 : 2.6) * thick;
    return { body: first.body, from: add(first.point, first.axis, from), to: add(first.point, first.axis, to), radius };
  };
  const parts = bodies.map((_, b) => formOf(b));
  return {
    isWheel: rotors.some(Boolean) && joints.length === 1,
    hasTop: parts.some((each) => each.some(({ type }) => type === 'cone')),
    size: nested && isNest ? 2 * RING_STEP * widest : size,
    thick,
    parts,
    ghosts: parts.map((each, b) => ghostOf(b, each)),
    // Springs along coordinates: coils about a hinge, or between what slides.
    coils: (mechanism.springs ?? []).map((joint) => coilOf(joints[joint], rotors[joints[joint].ends[1].body] ? shaftOf(joints[joint].ends[1].body) : 0)),
    // A body of triangles shows its joints itself.
    joints: joints.map((joint) => (joint.ends.some(({ body }) => isMesh(bodies[body])) ? [] : jointForm(scene, joint, { thick, rings, rotors, size }))),
  };
}

const isMesh = (body) => body.shapes?.some(({ kind }) => kind === 'mesh');

// Whether a body with one joint is a slender bar that begins there.
function isBarBy(solid, ends) {
  return ends.length === 1 && solid?.type === 'cylinder' && solid.height > 6 * solid.radius
    && Math.abs(dot(solid.axis, unit(ends[0]))) > 0.97 && length(ends[0]) > 0.25 * solid.height;
}

// The normal of the plane in which points are, if they are in one and not in a line.
function flat(points, apart) {
  const at = middle(points);
  let best = [0, 0, 0];
  for (const p of points) for (const q of points) {
    const n = cross(add(p, at, -1), add(q, at, -1));
    if (length(n) > length(best)) best = n;
  }
  const wide = Math.max(...points.map((p) => distance(p, at)));
  if (length(best) < 0.15 * wide * wide) return null;
  const normal = unit(best);
  return points.every((p) => Math.abs(dot(add(p, at, -1), normal)) < apart) ? normal : null;
}

const offPlane = (points) => { const normal = flat(points, Infinity); return Math.abs(dot(middle(points), normal)); };

function shrunk(solid, by) {
  const part = { ...solid };
  if (part.radius) part.radius *= by;
  if (part.height) part.height *= by;
  if (part.size) part.size = scale(part.size, by);
  return part;
}

// Bars meet in the mass centre if that is among them, else in the middle of their ends.
function hubOf(ends) {
  const hub = middle(ends);
  const wide = Math.max(...ends.map((end) => distance(end, hub)));
  return length(hub) < 1.2 * wide ? [0, 0, 0] : hub;
}

function offLine(p, [a, b]) {
  const along = unit(add(b, a, -1));
  const to = add(p, a, -1);
  return length(add(to, along, -dot(to, along)));
}

// A bar is flat across the hinge at its end.
function barAcross(held, [a, b]) {
  const along = unit(add(b, a, -1));
  const hinge = held.find(({ kind, axis }) => TURNING.has(kind) && Math.abs(dot(axis, along)) < 0.7);
  return hinge ? hinge.axis : null;
}

// How far a sliding joint goes in the run, as its first body sees it.
function stroke(scene, { ends: [first, second] }) {
  let range = null;
  for (const t of looks(scene, 400)) {
    const a = poseAt(scene, first.body, t);
    const b = poseAt(scene, second.body, t);
    const d = dot(add(inGlobal(b, second.point), inGlobal(a, first.point), -1), turn(a, first.axis));
    range = range ? [Math.min(range[0], d), Math.max(range[1], d)] : [d, d];
  }
  return range ?? [0, 0];
}

const acts = ({ mechanism }, joint, law) => (mechanism.efforts ?? []).some((effort) => effort.law === law && mechanism.joints[effort.joint] === joint);

// Whether a spring pulls a slider towards a place of its rail on the ground.
const isSprungOnGround = (scene, joint) => joint.kind === 'Prismatic' && scene.mechanism.bodies[joint.ends[0].body].support === 'fixed'
  && acts(scene, joint, 'spring');

// Where a rail begins and ends along its axis, with room for a spring behind the slider.
function railOf(scene, joint, thick) {
  const [low, high] = stroke(scene, joint);
  const pad = Math.max(4 * thick, 0.1 * (high - low));
  return { low, begin: low - pad - (isSprungOnGround(scene, joint) ? 14 * thick : 0), end: high + pad };
}

// Parts of a joint, each on one of its sides.
function jointForm(scene, joint, { thick, rings, rotors, size }) {
  const { kind, ends: [first, second] } = joint;
  // The drum of a motor sits beside the hinge.
  const motor = { side: 0, type: 'rod', from: add(first.point, first.axis, 1.6 * thick), to: add(first.point, first.axis, 7 * thick), thick: 2.6 * thick };
  const isNested = [first, second].some(({ body }) => rings[body]) || rotors[second.body] || rotors[first.body];
  const pin = (end, side, half, wide) => ({
    side, type: 'rod', from: add(end.point, end.axis, -half), to: add(end.point, end.axis, half), thick: wide,
  });
  const isOnGround = scene.mechanism.bodies[first.body].support === 'fixed';
  switch (kind) {
    case 'Revolute':
      return isNested ? [] : [pin(second, 1, 2.6 * thick, 1.4 * thick), ...(acts(scene, joint, 'motor') ? [motor] : [])];
    case 'Spherical':
      return [{ side: 1, type: 'sphere', at: second.point, radius: 2 * thick }];
    case 'Universal':
      return [pin(first, 0, 2.4 * thick, 0.8 * thick), pin(second, 1, 2.4 * thick, 0.8 * thick),
        { side: 1, type: 'sphere', at: second.point, radius: 1.3 * thick }];
    case 'Prismatic':
    case 'Cylindrical':
    case 'PointOnLine':
    case 'Screw': {
      const { low, begin, end } = railOf(scene, joint, thick);
      // A rail of the ground is where the slider goes; one of a moving body also reaches that body.
      const from = isOnGround ? begin : Math.min(0, begin);
      const to = isOnGround || low <= 0 ? Math.max(0, end) : low + 2 * thick;
      const rail = {
        side: 0, type: kind === 'Prismatic' ? 'rail' : 'rod', from: add(first.point, first.axis, from),
        to: add(first.point, first.axis, isOnGround ? end : to), thick: kind === 'Screw' ? 0.9 * thick : 0.75 * thick,
        ground: isOnGround, across: first.zero, metal: true,
      };
      if (kind === 'PointOnLine') return [rail, { side: 1, type: 'sphere', at: second.point, radius: 1.8 * thick }];
      const isAlone = scene.mechanism.joints.every(({ ends }) => ends.every((end) => end.body !== second.body || length(end.point) < 0.03 * size));
      const block = kind === 'Prismatic'
        ? { side: 1, type: 'block', at: second.point, axis: second.axis, across: second.zero, wide: (isAlone ? 3 : 2) * thick, long: (isAlone ? 9 : 5) * thick, ofBody: true }
        : { side: 1, type: 'rod', from: add(second.point, second.axis, -2.5 * thick), to: add(second.point, second.axis, 2.5 * thick), thick: 1.7 * thick, ofBody: true };
      const thread = kind === 'Screw'
        ? [{ side: 0, type: 'thread', from: rail.from, to: rail.to, radius: thick, lead: 2 * Math.PI * Math.abs(joint.lead) }] : [];
      const feet = isOnGround ? [rail.from, rail.to].map((at) => ({ side: 0, type: 'bracket', at, wide: 2.2 * thick, ofBody: true })) : [];
      return [rail, block, ...thread, ...feet];
    }
    case 'Planar':
      return [{ side: 0, type: 'sheet', at: first.point, axis: first.axis, across: first.zero, wide: 0.6 * size },
        pin(second, 1, 1.2 * thick, 2 * thick)];
    case 'Rod':
      return [{ type: 'between' }, ...[first, second].map((end, side) => ({ side, type: 'sphere', at: end.point, radius: 1.5 * thick }))];
    default:
      return [{ side: 1, type: 'block', at: second.point, axis: second.axis, across: second.zero, wide: 1.8 * thick, long: 2.5 * thick }];
  }
}
