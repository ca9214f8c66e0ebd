// From parts to meshes.
import {
  BoxGeometry, BufferGeometry, CapsuleGeometry, Color, ConeGeometry, CylinderGeometry, Float32BufferAttribute, Group, LatheGeometry, Matrix4,
  Mesh, MeshStandardMaterial, PlaneGeometry, Quaternion, SphereGeometry, TorusGeometry, TubeGeometry, Curve, Vector2, Vector3,
} from 'three';
import { ConvexGeometry } from 'three/addons/geometries/ConvexGeometry.js';
import { toCreasedNormals } from 'three/addons/utils/BufferGeometryUtils.js';
import { across as anyAcross, add, cross, dot, middle } from '../vector.js';

const vector = (a) => new Vector3(...a);
const Y = new Vector3(0, 1, 0);
const Z = new Vector3(0, 0, 1);

// The turn that takes the columns to these axes.
function frame(x, y, z) {
  return new Quaternion().setFromRotationMatrix(new Matrix4().makeBasis(vector(x), vector(y), vector(z)));
}

const toAxis = (from, axis) => new Quaternion().setFromUnitVectors(from, vector(axis).normalize());

export class Materials {
  constructor(transparent) {
    this.transparent = transparent;
    this.made = new Map();
  }

  get(name, colour, more = {}) {
    if (!this.made.has(name)) {
      const faint = this.transparent ? { transparent: true, opacity: 0.32, depthWrite: false } : {};
      this.made.set(name, new MeshStandardMaterial({ color: new Color(colour), roughness: 0.55, metalness: 0.1, ...faint, ...more }));
    }
    return this.made.get(name);
  }
}

function mesh(geometry, material, at = null, turn = null) {
  const made = new Mesh(geometry, material);
  if (at) made.position.copy(vector(at));
  if (turn) made.quaternion.copy(turn);
  made.castShadow = true;
  made.receiveShadow = true;
  return made;
}

function rod(part, material, sides = 20) {
  const [a, b] = [vector(part.from), vector(part.to)];
  const along = b.clone().sub(a);
  const made = mesh(new CylinderGeometry(part.thick, part.thick, along.length(), sides), material);
  made.position.copy(a.add(b).multiplyScalar(0.5));
  if (along.lengthSq() > 0) made.quaternion.setFromUnitVectors(Y, along.normalize());
  return made;
}

// A box along a line, its broad side across a direction.
function beam({ from, to, across, thick }, [deep, wide], material) {
  const [a, b] = [vector(from), vector(to)];
  const along = b.clone().sub(a);
  const z = along.clone().normalize();
  const x = vector(across ?? anyAcross(z.toArray()));
  x.addScaledVector(z, -x.dot(z)).normalize();
  const turn = frame(x.toArray(), cross(z.toArray(), x.toArray()), z.toArray());
  return mesh(new BoxGeometry(deep * thick, wide * thick, along.length()), material, a.add(b).multiplyScalar(0.5).toArray(), turn);
}

class Helix extends Curve {
  constructor(turns, radius) { super(); this.turns = turns; this.radius = radius; }

  getPoint(t, target = new Vector3()) {
    const inside = Math.min(1, Math.max(0, (t - 0.08) / 0.84));
    const r = this.radius * Math.min(1, 12 * Math.min(t, 1 - t));
    const angle = 2 * Math.PI * this.turns * inside;
    return target.set(r * Math.cos(angle), r * Math.sin(angle), t);
  }
}

// Along z, of length one.
export const helix = (turns, radius, thick) => new TubeGeometry(new Helix(turns, radius), turns * 16, thick, 6);

function cylinder(part, materials) {
  const group = new Group();
  group.position.copy(vector(part.at));
  group.quaternion.copy(toAxis(Y, part.axis));
  group.add(mesh(new CylinderGeometry(part.radius, part.radius, part.height, 64), materials.body));
  if (part.marked) {
    // By its marks one sees it turn.
    const wide = 0.16 * part.radius;
    for (let k = 0; k < 3; k++) {
      const spoke = mesh(new BoxGeometry(0.82 * part.radius, part.height * 1.03 + 0.004 * part.radius, wide), k ? materials.dark : materials.light);
      const angle = 2 * Math.PI * k / 3;
      spoke.position.set(0.5 * part.radius * Math.cos(angle), 0, -0.5 * part.radius * Math.sin(angle));
      spoke.rotation.y = angle;
      spoke.castShadow = false;
      group.add(spoke);
    }
  }
  return group;
}

// A hatched block below a point of the ground, with a wedge up to it: the sign for a fixed pivot.
function bracket(part, materials, down) {
  const group = new Group();
  group.position.copy(vector(part.at));
  group.quaternion.copy(toAxis(new Vector3(0, -1, 0), down));
  const { wide } = part;
  const wedge = mesh(new ConeGeometry(0.8 * wide, 1.5 * wide, 4), materials.fixed, [0, -0.75 * wide, 0]);
  wedge.rotation.y = Math.PI / 4;
  group.add(wedge, mesh(new BoxGeometry(1.9 * wide, 0.25 * wide, 1.3 * wide), materials.dark, [0, -1.6 * wide, 0]));
  return group;
}

const MAKERS = {
  rod: (part, materials) => rod(part, part.metal ? materials.metal : materials.body),
  bar: (part, materials) => {
    const group = new Group();
    group.add(beam(part, part.across ? [1.1, 2.4] : [1.7, 1.7], materials.body));
    for (const end of [part.from, part.to]) {
      const eye = part.across
        ? mesh(new CylinderGeometry(1.9 * part.thick, 1.9 * part.thick, 1.1 * part.thick, 28), materials.body, end, toAxis(Y, part.across))
        : mesh(new SphereGeometry(1.3 * part.thick, 20, 14), materials.body, end);
      group.add(eye);
    }
    return group;
  },
  ring: (part, materials) => {
    const made = mesh(new TorusGeometry(part.radius, part.thick, 16, 96), materials.body, part.at, toAxis(Z, part.axis));
    made.scale.z = 1.7;
    return made;
  },
  arc: (part, materials) => {
    // Half a ring from one end of the axis by way of `back` to the other.
    const turn = frame(part.axis, part.back, cross(part.axis, part.back));
    const made = mesh(new TorusGeometry(part.radius, part.thick, 14, 72, Math.PI), materials.fixed, part.at, turn);
    for (const side of [-1, 1]) made.add(mesh(new SphereGeometry(part.thick, 14, 10), materials.fixed, [side * part.radius, 0, 0]));
    made.scale.z = 1.4;
    return made;
  },
  // Between points of a plane, a little wider than they are.
  plate: (part, materials) => {
    const at = middle(part.points);
    const x = anyAcross(part.normal);
    const y = cross(part.normal, x);
    const flat = hull(part.points.map((p) => { const d = add(p, at, -1); return [dot(d, x), dot(d, y)]; }));
    const wider = flat.map(([u, v]) => { const by = 1 + 2 * part.thick / (Math.hypot(u, v) || 1); return [u * by, v * by]; });
    return mesh(prism(wider, 1.6 * part.thick), materials.body, at, frame(x, y, part.normal));
  },
  // With its tip at a point and its broad end along the axis from it.
  cone: (part, materials) => {
    const group = new Group();
    group.position.copy(vector(part.tip));
    group.quaternion.copy(toAxis(new Vector3(0, -1, 0), part.axis));
    group.add(mesh(new ConeGeometry(part.radius, part.height, 48), materials.body, [0, -part.height / 2, 0]));
    return group;
  },
  foot: (part, materials, down) => {
    const group = new Group();
    group.position.copy(vector(part.at));
    group.quaternion.copy(toAxis(new Vector3(0, -1, 0), down));
    group.add(mesh(new CylinderGeometry(1.6 * part.thick, 2.2 * part.thick, part.height, 24), materials.fixed, [0, -part.height / 2, 0]));
    group.add(mesh(new CylinderGeometry(part.wide, 1.08 * part.wide, 0.16 * part.wide, 48), materials.fixed, [0, -part.height, 0]));
    return group;
  },
  // A disc on half an ellipsoid, on which a body rocks.
  rocker: ({ at, wide }, materials, down) => {
    const outline = Array.from({ length: 16 }, (_, k) => {
      const angle = (k * Math.PI) / 30;
      return new Vector2(wide * Math.sin(angle), -0.55 * wide * Math.cos(angle));
    });
    const group = new Group();
    group.position.copy(vector(at));
    group.quaternion.copy(toAxis(new Vector3(0, -1, 0), down));
    group.add(mesh(new LatheGeometry(outline, 48), materials.dark), mesh(new CylinderGeometry(wide, wide, 0.06 * wide, 48), materials.fixed));
    return group;
  },
  bracket,
  cylinder,
  sphere: (part, materials) => mesh(new SphereGeometry(part.radius, 36, 24), materials.body, part.at),
  box: (part, materials) => mesh(new BoxGeometry(...part.size), materials.body, part.at, frame(...rightHanded(part.axes))),
  rail: (part, materials) => beam(part, [1.4, 1.4], part.ground ? materials.fixed : materials.metal),
  block: (part, materials) => {
    const half = part.long / 2;
    const ends = [-half, half].map((s) => part.at.map((x, k) => x + s * part.axis[k]));
    return beam({ from: ends[0], to: ends[1], across: part.across, thick: part.wide }, [2, 2], part.ofBody ? materials.body : materials.metal);
  },
  sheet: (part, materials) => mesh(new PlaneGeometry(part.wide, part.wide), materials.sheet, part.at,
    frame(part.across, cross(part.axis, part.across), part.axis)),
  thread: (part, materials) => {
    const [a, b] = [vector(part.from), vector(part.to)];
    const along = b.clone().sub(a);
    const turns = Math.min(60, Math.max(3, along.length() / Math.max(part.lead, along.length() / 60)));
    const made = mesh(helix(Math.round(turns), part.radius, 0.25 * part.radius), materials.metal);
    made.position.copy(a);
    made.quaternion.setFromUnitVectors(Z, along.clone().normalize());
    made.scale.z = along.length();
    return made;
  },
  shape: (part, materials) => {
    const [w, x, y, z] = part.orientation;
    if (part.surface) {
      const made = mesh(surface(part.surface), materials.body, part.position, new Quaternion(x, y, z, w));
      made.scale.set(...part.size);
      return made;
    }
    const geometry = FORMS[part.kind](part.size);
    return mesh(geometry, materials.body, part.position, new Quaternion(x, y, z, w));
  },
};

// By the numbers that each kind of shape has.
const FORMS = {
  box: (size) => new BoxGeometry(...size),
  sphere: ([radius]) => new SphereGeometry(radius, 36, 24),
  cylinder: ([radius, length]) => new CylinderGeometry(radius, radius, length, 48).rotateX(Math.PI / 2),
  capsule: ([radius, length]) => new CapsuleGeometry(radius, length, 12, 36).rotateX(Math.PI / 2),
  ellipsoid: (size) => new SphereGeometry(1, 48, 32).scale(...size),
  torus: ([radius, rim]) => new TorusGeometry(radius, rim, 20, 72),
  // As thick as it can be seen, below the plane.
  plane: ([a, b]) => new BoxGeometry(a, b, 0.004 * Math.max(a, b)).translate(0, 0, -0.002 * Math.max(a, b)),
  vertices: (numbers) => {
    const points = Array.from({ length: numbers.length / 3 }, (_, k) => new Vector3(...numbers.slice(3 * k, 3 * k + 3)));
    return points.length > 3 ? new ConvexGeometry(points) : new SphereGeometry(0.005, 12, 8).translate(...numbers.slice(0, 3));
  },
};

// Triangles; edges sharper than CREASE are seen as such.
const CREASE = 0.6;
function surface({ vertices: [x, y, z], triangles }) {
  const corners = new Float32Array(3 * triangles.length);
  triangles.forEach((v, k) => corners.set([x[v], y[v], z[v]], 3 * k));
  return toCreasedNormals(new BufferGeometry().setAttribute('position', new Float32BufferAttribute(corners, 3)), CREASE);
}

// The convex hull of points of a plane, by Andrew's chain.
function hull(points) {
  const sorted = [...points].sort((a, b) => a[0] - b[0] || a[1] - b[1]);
  const chain = (all) => {
    const kept = [];
    for (const p of all) {
      const turns = () => {
        const [a, b] = kept.slice(-2);
        return (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]);
      };
      while (kept.length > 1 && turns() <= 0) kept.pop();
      kept.push(p);
    }
    return kept.slice(0, -1);
  };
  return [...chain(sorted), ...chain(sorted.reverse())];
}

// On a convex outline, half above and half below its plane.
function prism(outline, deep) {
  const corners = [];
  const at = ([u, v], side) => [u, v, (side * deep) / 2];
  outline.forEach((p, k) => {
    const q = outline[(k + 1) % outline.length];
    corners.push(at(p, -1), at(q, -1), at(q, 1), at(p, -1), at(q, 1), at(p, 1));
    if (k > 0 && k < outline.length - 1) {
      const o = outline[0];
      corners.push(at(o, 1), at(p, 1), at(q, 1), at(o, -1), at(q, -1), at(p, -1));
    }
  });
  const geometry = new BufferGeometry().setAttribute('position', new Float32BufferAttribute(corners.flat(), 3));
  geometry.computeVertexNormals();
  return geometry;
}

function rightHanded([x, y]) { return [x, y, cross(x, y)]; }

export function solid(part, materials, down) {
  const make = MAKERS[part.type];
  return make ? make(part, materials, down) : new Group();
}

// An arrow; one that lies within bodies is seen through them.
export function arrow(colour, within = false) {
  const material = new MeshStandardMaterial({ color: colour, roughness: 0.6, emissive: colour, emissiveIntensity: 0.25, depthTest: !within });
  const group = new Group();
  const shaft = mesh(new CylinderGeometry(0.008, 0.008, 1, 10), material, [0, 0.5, 0]);
  const head = mesh(new ConeGeometry(0.024, 0.06, 16), material);
  for (const part of [shaft, head]) {
    part.castShadow = false;
    part.renderOrder = Number(within);
  }
  group.add(shaft, head);
  group.userData.point = (from, force, long) => {
    group.visible = long > 0.01;
    if (!group.visible) return;
    group.position.copy(from);
    group.quaternion.setFromUnitVectors(Y, force.clone().normalize());
    const body = Math.max(long - 0.06, 0.001);
    shaft.scale.y = body;
    shaft.position.y = body / 2;
    head.position.y = body + 0.03;
  };
  return group;
}

// A torque: part of a circle about its axis, with a head.
export function arc(colour, radius) {
  const [SIDES, STEPS] = [8, 60];
  const material = new MeshStandardMaterial({ color: colour, roughness: 0.6, emissive: colour, emissiveIntensity: 0.25 });
  const circle = new Curve();
  circle.getPoint = (part, point = new Vector3()) => point.set(radius * Math.cos(2 * Math.PI * part), radius * Math.sin(2 * Math.PI * part), 0);
  const group = new Group();
  const shaft = mesh(new TubeGeometry(circle, STEPS, 0.007, SIDES), material);
  const head = mesh(new ConeGeometry(0.02, 0.05, 16), material);
  for (const part of [shaft, head]) part.castShadow = false;
  group.add(shaft, head);
  group.userData.point = (from, torque, long) => {
    group.visible = long > 0.01;
    if (!group.visible) return;
    group.position.copy(from);
    group.quaternion.setFromUnitVectors(Z, torque.clone().normalize());
    // Three quarters of a circle at most, from where the greatest force has its length.
    const steps = Math.max(1, Math.round(0.75 * STEPS * Math.min(1, long / 0.32)));
    shaft.geometry.setDrawRange(0, 6 * SIDES * steps);
    const end = (2 * Math.PI * steps) / STEPS;
    head.position.set(radius * Math.cos(end), radius * Math.sin(end), 0);
    head.quaternion.setFromUnitVectors(Y, new Vector3(-Math.sin(end), Math.cos(end), 0));
  };
  return group;
}
