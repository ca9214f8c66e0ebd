// Forces and torques along the coordinates of joints, by their laws: springs, dampers, friction, stops, motors.
import { amountOf, poseAt, valueAt } from '../data.js';
import { cross, inGlobal, scale, turn } from '../vector.js';

// The smooth ramp of a stop and its slope, where the coordinate is past the limit by z.
const ramp = (z, soft) => (z + Math.hypot(z, soft)) / 2;
const slope = (z, soft) => (1 + z / (Math.hypot(z, soft) || 1)) / 2;

// What acts along a coordinate x with the rate v, as the model file's document defines it.
const LAWS = {
  spring: ({ stiffness, free }, x) => -stiffness * (x - free),
  damper: ({ damping }, x, v) => -damping * v,
  coulomb: ({ level, rate }, x, v) => -level * Math.tanh(v / rate),
  upper: ({ limit, stiffness, damping, softness }, x, v) =>
    -stiffness * ramp(x - limit, softness) - damping * slope(x - limit, softness) * v,
  lower: ({ limit, stiffness, damping, softness }, x, v) =>
    stiffness * ramp(limit - x, softness) - damping * slope(limit - x, softness) * v,
  motor: ({ value }) => value,
};

// The axis of a coordinate in the global frame.
function axisOf(coordinate, [first, second], poses) {
  const across = cross(first.axis, first.zero);
  switch (coordinate) {
    case 'x': return turn(poses[0], first.zero);
    case 'y': return turn(poses[0], across);
    case 'second_angle': return turn(poses[1], second.axis);
    default: return turn(poses[0], first.axis);
  }
}

/** What acts on the second body of a joint, along each of its coordinates, and against it on the first. */
export function alongJoints(scene) {
  const { mechanism, columns, time } = scene;
  const column = (of, title) => columns.find((each) => each.group === of && each.title === title)?.values;
  const at = (values, t) => (values ? valueAt(time, values, t) : 0);
  return (mechanism.efforts ?? []).map(({ joint, coordinate, title, law, numbers }) => {
    const [x, v] = [column('Joints', title), column('Rates', title)];
    const { ends } = mechanism.joints[joint];
    const known = Object.entries(numbers).map(([name, amount]) => [name, amountOf(scene, amount)]);
    const turns = coordinate.endsWith('angle');
    return {
      kind: law === 'motor' ? 'load' : 'link',
      turns,
      twice: !turns,
      at: (t) => {
        const now = Object.fromEntries(known.map(([name, value]) => [name, value(t)]));
        const poses = ends.map(({ body }) => poseAt(scene, body, t));
        const force = scale(axisOf(coordinate, ends, poses), LAWS[law](now, at(x, t), at(v, t)));
        const [first, second] = ends.map(({ point }, k) => inGlobal(poses[k], point));
        return turns ? [[second, force]] : [[second, force], [first, scale(force, -1)]];
      },
    };
  });
}
