// Where bodies touch.
import { amountOf, poseAt } from '../data.js';
import { add, cross, dot, inGlobal, scale, turn } from '../vector.js';

// The force on the second body at a time, and a place on its line of action: where that meets the plane that is touched, or
// else where it is nearest to the body's own point.
export function touched(scene, { bodies: [first, second], orientation, plane, point, force, torque }) {
  const [f, m] = [force, torque].map((vector) => vector.map((amount) => amountOf(scene, amount)));
  return (t) => {
    const frame = poseAt(scene, first, t);
    const axes = (v) => turn(frame, turn([0, 0, 0, ...orientation], v));
    const [all, moment] = [f, m].map((vector) => axes(vector.map((value) => value(t))));
    const square = dot(all, all);
    const place = add(inGlobal(poseAt(scene, second, t), point), square > 0 ? scale(cross(all, moment), 1 / square) : [0, 0, 0]);
    if (!plane) return [place, all];
    const normal = axes([0, 0, 1]);
    const across = dot(all, normal);
    const above = dot(add(place, inGlobal(frame, plane), -1), normal);
    return [add(place, all, across ? -above / across : 0), all];
  };
}
