// Forces as arrows: weight, springs and dampers, loads and motors, contacts, reactions where the run has them. Torques are
// arcs about their axis. Forces are all to one scale, and so are torques.
import { Vector3 } from 'three';
import { amountOf, poseAt, valueAt } from '../data.js';
import { add, cross, distance, dot, inGlobal, length, scale, turn, unit } from '../vector.js';
import { alongJoints } from './efforts.js';
import { touched } from './touches.js';
import { looks } from './forms.js';
import { arc, arrow } from './solids.js';

const LONGEST = 0.32;
// Of arcs, so that a motor's goes around a spring's.
const RADII = { link: 0.085, load: 0.11 };
const COLOURS = { weight: '#8a8f98', link: '#2e9e5b', load: '#d98a1f', contact: '#8257c9', reaction: '#c8403a' };

// The force with which a spring and damper pulls at its second end, and that end's place.
function linkForce(scene, link, t) {
  const dt = 1e-5 * Math.max(scene.time[scene.time.length - 1], 1e-9);
  const along = (at) => {
    const [a, b] = link.ends.map(([body, point]) => inGlobal(poseAt(scene, body, at), point));
    return { a, b, long: distance(a, b) };
  };
  const { a, b, long } = along(t);
  if (link.force) return { a, b, force: scale(unit(add(b, a, -1)), amountOf(scene, link.force)(t)) };
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
    const [force, torque] = [load.force, load.torque].map((vector) => vector.map((amount) => amountOf(scene, amount)));
    const at = (vector, t) => vector.map((value) => value(t));
    found.push({ kind: 'load', at: (t) => {
      const pose = poseAt(scene, load.body, t);
      return [[inGlobal(pose, load.point), load.in_body ? turn(pose, at(force, t)) : at(force, t)]];
    } });
    found.push({ kind: 'load', turns: true, at: (t) => {
      const pose = poseAt(scene, load.body, t);
      return [[inGlobal(pose, load.point), load.in_body ? turn(pose, at(torque, t)) : at(torque, t)]];
    } });
  }
  for (const touch of mechanism.touches) {
    const at = touched(scene, touch);
    found.push({ kind: 'contact', twice: true, at: (t) => {
      const [place, force] = at(t);
      return [[place, force], [place, scale(force, -1)]];
    } });
  }
  found.push(...alongJoints(scene));
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
    // The largest force and the largest torque.
    this.most = { false: 0, true: 0 };
    this.drawn = this.all.flatMap(({ scene }) => sources(scene).map((source) => {
      const turns = Boolean(source.turns);
      const sizes = looks(scene, 100).flatMap((t) => source.at(t).map(([, force]) => length(force) || 0)).sort((a, b) => a - b);
      // Impacts are none of what rests.
      const place = source.kind === 'contact' ? Math.floor(0.9 * sizes.length) : sizes.length - 1;
      this.most[turns] = Math.max(this.most[turns], sizes[place] ?? 0);
      const arrows = Array.from({ length: source.twice ? 2 : 1 }, () => (turns ? arc(COLOURS[source.kind], RADII[source.kind]) : arrow(COLOURS[source.kind], source.kind === 'contact')));
      arrows.forEach((each) => { each.traverse((part) => { part.raycast = () => {}; }); this.world.add(each); });
      return { source, arrows };
    }));
  }

  show(t) {
    if (!this.on) return;
    for (const { source, arrows } of this.drawn) {
      source.at(t).forEach(([at, force], k) => {
        // Small forces are not lost beside large ones: the root.
        const long = LONGEST * Math.min(1, Math.sqrt(length(force) / (this.most[Boolean(source.turns)] || 1)));
        arrows[k].userData.point(new Vector3(...at).divideScalar(this.size), new Vector3(...force), long);
      });
    }
  }
}
