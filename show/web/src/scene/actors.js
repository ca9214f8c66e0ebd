// A run's bodies, joints and springs, which move.
import { Color, DoubleSide, Group, Mesh, MeshBasicMaterial, SphereGeometry, Vector3, CylinderGeometry, Quaternion, Matrix4 } from 'three';
import { poseAt } from '../data.js';
import { PALETTE } from '../theme.js';
import { inGlobal, unit } from '../vector.js';
import { ellipsoidOf, forms } from './forms.js';
import { Materials, helix, solid } from './solids.js';

const Z = new Vector3(0, 0, 1);

// Along z, of length and radius one.
const unitRod = () => new CylinderGeometry(1, 1, 1, 14).translate(0, 0.5, 0).rotateX(Math.PI / 2);

export function setPose(object, pose) {
  object.position.set(pose[0], pose[1], pose[2]);
  object.quaternion.set(pose[4], pose[5], pose[6], pose[3]);
}

export class Actors {
  constructor(scene, run, colours) {
    this.scene = scene;
    this.run = run;
    this.form = forms(scene);
    this.root = new Group();
    this.materials = new Materials(run > 0);
    this.stretched = [];
    this.poses = scene.bodies.map(() => new Float64Array(7));
    const { mechanism } = scene;
    const down = unit(mechanism.gravity, [0, -1, 0]);
    let moving = 0;
    this.bodies = mechanism.bodies.map((body, b) => {
      const group = new Group();
      group.userData = { body: b, run };
      const colour = body.support === 'fixed' || (body.support === 'driven' && !(body.mass > 0)) ? colours.fixed : PALETTE[moving++ % PALETTE.length];
      const materials = this.palette(b, run ? '#e08030' : colour, colours);
      for (const part of this.form.parts[b]) {
        const own = part.color ? { ...materials, body: this.materials.get(part.color, part.color) } : materials;
        group.add(solid(part, own, down));
      }
      const ghost = this.form.ghosts[b];
      if (ghost && !run) {
        const see = this.materials.get(`ghost${b}`, colour, { transparent: true, opacity: 0.16, depthWrite: false });
        const made = solid(ghost, { ...materials, body: see }, down);
        made.traverse((part) => { part.castShadow = false; part.receiveShadow = false; });
        made.userData.ghost = true;
        group.add(made);
      }
      this.root.add(group);
      return { group, colour, down };
    });
    mechanism.joints.forEach((joint, j) => this.addJoint(joint, this.form.joints[j], colours, down));
    mechanism.links.forEach((link) => this.addLink(link, colours));
    this.form.coils.forEach((coil) => this.addCoil(coil, colours));
    this.ellipsoids = null;
  }

  palette(b, colour, colours) {
    const of = this.materials;
    const tint = new Color(colour);
    const lighter = tint.clone().lerp(new Color('#ffffff'), 0.72);
    const darker = tint.clone().lerp(new Color('#000000'), 0.4);
    return {
      body: of.get(`body${b}`, colour),
      light: of.get(`light${b}`, lighter),
      dark: of.get(`dark${b}`, darker),
      metal: of.get('metal', colours.joint, { metalness: 0.45, roughness: 0.4 }),
      fixed: of.get('fixed', colours.fixed),
      sheet: of.get('sheet', colours.fixed, { transparent: true, opacity: 0.2, side: DoubleSide, depthWrite: false }),
    };
  }

  addJoint(joint, parts, colours, down) {
    for (const part of parts) {
      const on = joint.ends[part.side ?? 1].body;
      const materials = this.palette(on, this.bodies[on].colour, colours);
      if (part.type === 'between') {
        this.stretch(new Mesh(unitRod(), materials.metal), joint.ends.map(({ body, point }) => [body, point]), this.form.thick * 0.8);
        continue;
      }
      // Pins and balls are metal, sliders are of their body.
      const metal = { ...materials, body: part.ofBody ? materials.body : materials.metal };
      this.bodies[on].group.add(solid(part, metal, down));
    }
  }

  addLink(link, colours) {
    const { thick } = this.form;
    const metal = this.palette(0, '#888888', colours).metal;
    if (link.stiffness !== 0) {
      this.stretch(new Mesh(helix(9, 2.4 * thick, 0.42 * thick), metal), link.ends, null);
    }
    if (link.damping !== 0 || link.stiffness === 0) {
      this.stretch(new Mesh(unitRod(), metal), link.ends, 0.6 * thick);
    }
  }

  // A spring along a joint's coordinate.
  addCoil(coil, colours) {
    const { metal } = this.palette(0, '#888888', colours);
    const wire = helix(8, coil.radius, 0.4 * this.form.thick);
    if (coil.between) { this.stretch(new Mesh(wire, metal), coil.between, null); return; }
    const made = new Mesh(wire, metal);
    const [from, to] = [coil.from, coil.to].map((point) => new Vector3(...point));
    made.position.copy(from);
    made.scale.z = from.distanceTo(to);
    made.quaternion.setFromUnitVectors(Z, to.sub(from).normalize());
    made.castShadow = true;
    this.bodies[coil.body].group.add(made);
  }

  // Of length one along z; drawn out between two points of bodies.
  stretch(made, ends, thick) {
    const group = new Group();
    made.castShadow = true;
    if (thick !== null) made.scale.set(thick, thick, 1);
    group.add(made);
    this.root.add(group);
    this.stretched.push({ group, ends });
  }

  // Shows the run at a time.
  show(t) {
    this.poses.forEach((pose, b) => {
      poseAt(this.scene, b, t, pose);
      setPose(this.bodies[b].group, pose);
    });
    for (const { group, ends } of this.stretched) {
      const [from, to] = ends.map(([b, point]) => new Vector3(...inGlobal(this.poses[b], point)));
      const along = to.clone().sub(from);
      const long = along.length();
      group.position.copy(from);
      group.scale.set(1, 1, Math.max(long, 1e-9));
      if (long > 0) group.quaternion.setFromUnitVectors(Z, along.divideScalar(long));
    }
  }

  showEllipsoids(on) {
    if (on && !this.ellipsoids) {
      this.ellipsoids = this.scene.mechanism.bodies.map((body, b) => {
        const found = body.support === 'fixed' ? null : ellipsoidOf(body);
        if (!found) return null;
        const see = new MeshBasicMaterial({ color: this.bodies[b].colour, wireframe: true, transparent: true, opacity: 0.35 });
        const made = new Mesh(new SphereGeometry(1, 24, 16), see);
        const [x, y] = found.axes.map((axis) => new Vector3(...axis));
        made.quaternion.copy(new Quaternion().setFromRotationMatrix(new Matrix4().makeBasis(x, y, x.clone().cross(y))));
        made.scale.set(...found.size.map((s) => Math.max(s, 1e-3 * this.form.size)));
        this.bodies[b].group.add(made);
        return made;
      });
    }
    for (const made of this.ellipsoids ?? []) if (made) made.visible = on;
  }

  // Lit up, or none.
  select(b) {
    this.bodies.forEach(({ group }, k) => group.traverse(({ material }) => {
      if (material?.emissive && material !== this.materials.made.get('metal')) {
        material.emissive.set(k === b ? '#ffffff' : '#000000');
        material.emissiveIntensity = k === b ? 0.18 : 0;
      }
    }));
  }
}
