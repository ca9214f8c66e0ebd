// The numbers of the body that was clicked on.
import { poseAt, valueAt } from './data.js';
import { element } from './layout.js';
import { onDegrees, shown } from './units.js';

const number = (x) => (!Number.isFinite(x) ? '–' : x !== 0 && (Math.abs(x) < 1e-3 || Math.abs(x) >= 1e5) ? x.toExponential(3) : String(+x.toPrecision(4)));

// The angle of the turn from the global frame, and its axis.
function rotation(pose) {
  const sine = Math.hypot(pose[4], pose[5], pose[6]);
  const angle = 2 * Math.atan2(sine, Math.abs(pose[3]));
  const axis = [4, 5, 6].map((k) => (sine > 0 ? (Math.sign(pose[3]) || 1) * pose[k] / sine : 0));
  return { angle, axis };
}

function rows(scene, b, t) {
  const { mechanism, bodies } = scene;
  const body = mechanism.bodies[b];
  const pose = poseAt(scene, b, t);
  const { angle, axis } = rotation(pose);
  const found = [];
  if (body.mass > 0) found.push(['mass', [number(body.mass)], 'kg']);
  if (body.mass > 0 && body.support === 'moving') found.push(['inertia xx, yy, zz', body.inertia.slice(0, 3).map(number), 'kg·m²']);
  if (body.inertia.slice(3).some(Boolean)) found.push(['xy, xz, yz', body.inertia.slice(3).map(number), 'kg·m²']);
  found.push(['position', [0, 1, 2].map((k) => number(pose[k])), 'm']);
  found.push(['turned by', [number((angle * 180) / Math.PI)], '°'], ['about', axis.map(number), '']);
  if (bodies[b].velocity.length) {
    const velocity = bodies[b].velocity.map((values) => valueAt(scene.time, values, t));
    found.push(['velocity', velocity.slice(0, 3).map(number), 'm/s'], ['speed', [number(Math.hypot(...velocity.slice(0, 3)))], 'm/s']);
    const { factor, unit } = shown('rad/s');
    const spin = velocity.slice(3).map((x) => factor * x);
    found.push(['angular velocity, body frame', spin.map(number), unit], ['its size', [number(Math.hypot(...spin))], unit]);
  }
  return found;
}

export function panel(place, scenes, clock) {
  let selected = null;
  const listeners = [];
  const show = () => {
    place.panel.hidden = selected === null;
    if (selected === null) return;
    const { bodies, joints } = scenes[0].mechanism;
    const { name, support } = bodies[selected];
    const own = joints.filter(({ ends }) => ends.some(({ body }) => body === selected)).map((joint) => `${joint.name} (${joint.kind.toLowerCase()})`);
    const close = element('button', { type: 'button', 'aria-label': 'close', onclick: () => select(null) }, '×');
    const tables = scenes.flatMap((scene) => {
      if (!scene.bodies[selected]) return [];
      const lines = rows(scene, selected, clock.t).map(([what, values, unit]) => element('tr', {},
        element('th', {}, what + (unit ? ` [${unit}]` : '')), element('td', {}, ...values.map((value) => element('div', {}, value)))));
      return [...(scenes.length > 1 ? [element('p', {}, scene.name)] : []), element('table', {}, ...lines)];
    });
    place.panel.replaceChildren(close, element('h2', {}, name.replaceAll('_', ' ') + (support === 'moving' ? '' : ` (${support})`)),
      ...tables, element('p', {}, own.length ? `Joints: ${own.join(', ')}` : ''));
  };
  const select = (b) => {
    selected = b;
    for (const listener of listeners) listener(b);
    show();
  };
  onDegrees(show);
  clock.listen(() => { if (selected !== null) show(); });
  return { select, onSelect: (listener) => listeners.push(listener), selected: () => selected };
}
