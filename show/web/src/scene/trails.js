// The way that each body has gone: of its mass centre or of the joint point that goes farthest.
import { BufferGeometry, Float32BufferAttribute, Group, Line, LineBasicMaterial } from 'three';
import { indexAt, poseAt } from '../data.js';
import { distance, inGlobal } from '../vector.js';
import { looks } from './forms.js';

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
    return found;
  }

  show(t) {
    if (!this.on) return;
    for (const { line, times } of this.lines) line.geometry.setDrawRange(0, indexAt(times, t) + 1);
  }
}
