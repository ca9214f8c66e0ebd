// The way that each body has gone: of its mass centre or of the joint point that goes farthest; and where bodies touched.
import { BufferGeometry, Float32BufferAttribute, Group, Line, LineBasicMaterial, LineSegments } from 'three';
import { indexAt, poseAt } from '../data.js';
import { distance, inGlobal, length } from '../vector.js';
import { looks } from './forms.js';
import { touched } from './touches.js';

const POINTS = 3000;

export class Trails {
  constructor(all, stage) {
    this.all = all;
    this.stage = stage;
    this.lines = null;
    this.on = false;
  }

  // Of a run that has changed, the next time that they are asked for.
  renew() {
    for (const { line } of this.lines ?? []) line.removeFromParent();
    this.lines = null;
    this.turn(this.on);
  }

  turn(on) {
    this.on = on;
    if (on && !this.lines) this.lines = this.all.flatMap((actors) => this.make(actors));
    for (const { line } of this.lines ?? []) line.visible = on;
  }

  make(actors) {
    const { scene } = actors;
    const times = looks(scene, POINTS);
    const group = new Group();
    this.stage.add(group);
    const found = [];
    scene.mechanism.bodies.forEach((body, b) => {
      if (!scene.bodies[b].moves) return;
      const candidates = [[0, 0, 0], ...scene.mechanism.joints.flatMap(({ ends }) => ends.filter((end) => end.body === b).map(({ point }) => point))];
      const few = looks(scene, 100);
      const way = (point) => {
        let sum = 0;
        let last = null;
        for (const t of few) {
          const now = inGlobal(poseAt(scene, b, t), point);
          if (last) sum += distance(now, last);
          last = now;
        }
        return sum;
      };
      const [point, long] = candidates.map((p) => [p, way(p)]).reduce((best, next) => (next[1] > best[1] ? next : best));
      if (long < 1e-3 * actors.form.size) return;
      const positions = times.flatMap((t) => inGlobal(poseAt(scene, b, t), point));
      const geometry = new BufferGeometry().setAttribute('position', new Float32BufferAttribute(positions, 3));
      const line = new Line(geometry, new LineBasicMaterial({ color: actors.bodies[b].colour }));
      line.frustumCulled = false;
      line.raycast = () => {};
      group.add(line);
      found.push({ line, times });
    });
    for (const touch of scene.mechanism.touches) {
      const at = touched(scene, touch);
      const all = times.map((t) => at(t));
      // Where next to nothing acts, nothing tells where.
      const least = 1e-3 * Math.max(...all.map(([, force]) => length(force)));
      const pushes = ([, force]) => length(force) > least;
      // From sample to sample where both touch; so many ends of pieces there are up to each.
      const [positions, ends] = [[], [0]];
      for (let k = 1; k < all.length; k++) {
        if (pushes(all[k - 1]) && pushes(all[k])) positions.push(...all[k - 1][0], ...all[k][0]);
        ends.push(positions.length / 3);
      }
      const geometry = new BufferGeometry().setAttribute('position', new Float32BufferAttribute(positions, 3));
      const line = new LineSegments(geometry, new LineBasicMaterial({ color: '#8257c9' }));
      line.frustumCulled = false;
      line.raycast = () => {};
      group.add(line);
      found.push({ line, times, ends });
    }
    return found;
  }

  show(t) {
    if (!this.on) return;
    for (const { line, times, ends } of this.lines) {
      const index = indexAt(times, t);
      line.geometry.setDrawRange(0, ends ? ends[index] : index + 1);
    }
  }
}
