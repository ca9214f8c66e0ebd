// Units as they are printed, and angles in degrees on request.

const RAISED = { '-': '⁻', 0: '⁰', 1: '¹', 2: '²', 3: '³', 4: '⁴', 5: '⁵', 6: '⁶', 7: '⁷', 8: '⁸', 9: '⁹' };
const listeners = [];
let inDegrees = false;

/** `kg.m2/s2` as kg·m²/s². */
export const printed = (unit) => unit.replace(/[.*]/g, '·')
  .replace(/(?<=[a-z])\^?(-?\d+)/gi, (_, power) => [...power].map((c) => RAISED[c]).join(''));

/** By what values of a unit are multiplied to be shown, and the unit that they are shown in. */
export function shown(unit) {
  const isAngle = inDegrees && /^rad(?![a-z])/.test(unit);
  return { factor: isAngle ? 180 / Math.PI : 1, unit: printed(isAngle ? unit.replace('rad', '°') : unit) };
}

export function degrees(on) {
  inDegrees = on;
  for (const listener of listeners) listener();
}

export const onDegrees = (listener) => listeners.push(listener);
