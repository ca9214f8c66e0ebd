// Forces as arrows: weight, springs and dampers, loads, reactions where the run has them. All are to one scale.
import { Vector3 } from 'three';
import { poseAt, valueAt } from '../data.js';
import { add, cross, distance, dot, inGlobal, length, scale, turn, unit } from '../vector.js';
import { looks } from './forms.js';
import { arrow } from './solids.js';

const LONGEST = 0.32;
const COLOURS = { weight: '#8a8f98', link: '#2e9e5b', load: '#d98a1f', reaction: '#c8403a' };

// The force with which a spring and damper pulls at its second end, and that end's place.
function linkForce(scene, link, t) {
  const dt = 1e-5 * Math.max(scene.time[scene.time.length - 1], 1e-9);
  const along = (at) => {
    const [a, b] = link.ends.map(([body, point]) => inGlobal(poseAt(scene, body, at), point));
    return { a, b, long: distance(a, b) };
  };
  const { a, b, long } = along(t);
  const rate = (along(t + dt).long - long) / dt;
  const force = -link.stiffness * (long - link.free_length) - link.damping * rate;
  return { a, b, force: scale(unit(add(b, a, -1)), force) };
}

function sources(scene) {
  const { mechanism } = scene;
  const found = [];
  mechanism.bodies.forEach((body, b) => {
    if (body.support !== 'moving' || !(body.mass > 0) || !length(mechanism.gravity)) return;
    found.push({ kind: 'weight', at: (t) => [[inGlobal(poseAt(scene, b, t), [0, 0, 0]), scale(mechanism.gravity, body.mass)]] });
  });
  for (const link of mechanism.links) {
    found.push({ kind: 'link', twice: true, at: (t) => {
      const { a, b, force } = linkForce(scene, link, t);
      return [[b, force], [a, scale(force, -1)]];
    } });
  }
  for (const load of mechanism.loads) {
    found.push({ kind: 'load', at: (t) => {
      const pose = poseAt(scene, load.body, t);
      return [[inGlobal(pose, load.point), load.in_body ? turn(pose, load.force) : load.force]];
    } });
  }
  for (const { joint, column } of scene.reactions) {
    const [first, second] = mechanism.joints[joint].ends;
    const parts = scene.columns.slice(column, column + 3);
    found.push({ kind: 'reaction', at: (t) => {
      const frame = poseAt(scene, first.body, t);
      const axes = [first.zero, cross(first.axis, first.zero), first.axis].map((v) => turn(frame, v));
      const force = axes.reduce((sum, axis, k) => add(sum, axis, valueAt(scene.time, parts[k].values, t)), [0, 0, 0]);
      return [[inGlobal(poseAt(scene, second.body, t), second.point), force]];
    } });
  }
  return found;
}

export class Arrows {
  constructor(all, world, size) {
    Object.assign(this, { all, world, size, drawn: null, on: false });
  }

  // Of a run or a mechanism that has changed.
  renew() {
    for (const { arrows } of this.drawn ?? []) for (const each of arrows) each.removeFromParent();
    this.drawn = null;
    this.turn(this.on);
  }

  turn(on) {
    this.on = on;
    if (on && !this.drawn) this.make();
    for (const { arrows } of this.drawn ?? []) for (const each of arrows) each.visible = on;
  }

  make() {
    let most = 0;
    this.drawn = this.all.flatMap(({ scene }) => sources(scene).map((source) => {
      for (const t of looks(scene, 100)) for (const [, force] of source.at(t)) most = Math.max(most, Math.sqrt(dot(force, force)) || 0);
      const arrows = Array.from({ length: source.twice ? 2 : 1 }, () => arrow(COLOURS[source.kind]));
      arrows.forEach((each) => { each.traverse((part) => { part.raycast = () => {}; }); this.world.add(each); });
      return { source, arrows };
    }));
    this.most = most || 1;
  }

  show(t) {
    if (!this.on) return;
    for (const { source, arrows } of this.drawn) {
      source.at(t).forEach(([at, force], k) => {
        // Small forces are not lost beside large ones: the root.
        const long = LONGEST * Math.sqrt(length(force) / this.most);
        arrows[k].userData.point(new Vector3(...at).divideScalar(this.size), new Vector3(...force), long);
      });
    }
  }
}
