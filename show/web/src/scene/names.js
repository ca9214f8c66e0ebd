// Names of bodies and joints beside them.
import { Vector3 } from 'three';
import { element } from '../layout.js';

export class Names {
  constructor(place, mechanism, actors) {
    this.on = false;
    this.tags = [];
    const tag = (name, b, point) => {
      const made = element('div', { class: 'tag', hidden: '' }, name.replaceAll('_', ' '));
      place.append(made);
      this.tags.push({ made, group: actors.bodies[b].group, point: new Vector3(...point) });
    };
    mechanism.bodies.forEach((body, b) => {
      const ring = actors.form.parts[b].find(({ type }) => type === 'ring');
      // In the middle of a ring is what it carries: its name is at its rim.
      const point = ring ? new Vector3(...ring.axis).cross(new Vector3(0.31, 0.62, 0.72)).setLength(ring.radius).toArray() : [0, 0, 0];
      if (body.support !== 'fixed') tag(body.name, b, point);
    });
  }

  remove() { for (const { made } of this.tags) made.remove(); }

  turn(on) {
    this.on = on;
    for (const { made } of this.tags) made.hidden = !on;
  }

  show(camera, canvas) {
    if (!this.on) return;
    const at = new Vector3();
    for (const { made, group, point } of this.tags) {
      at.copy(point).applyMatrix4(group.matrixWorld).project(camera);
      made.hidden = at.z > 1;
      const [x, y] = [((at.x + 1) / 2) * canvas.clientWidth, ((1 - at.y) / 2) * canvas.clientHeight];
      made.style.transform = `translate(${x.toFixed(1)}px, ${y.toFixed(1)}px) translate(8px, -50%)`;
    }
  }
}
