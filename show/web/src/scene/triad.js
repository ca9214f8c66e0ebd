// The directions of the global axes, with their letters, in a corner of the picture.
import { Vector3 } from 'three';

const AXES = [['x', '#d04a4a', new Vector3(1, 0, 0)], ['y', '#3f9b4f', new Vector3(0, 1, 0)], ['z', '#3f70d0', new Vector3(0, 0, 1)]];

/** Draws it as the camera sees it, about a point of a canvas, of this radius. */
export function triad(context, camera, [x, y], radius) {
  const back = camera.quaternion.clone().invert();
  const seen = AXES.map(([letter, colour, axis]) => ({ letter, colour, at: axis.clone().applyQuaternion(back) }));
  context.lineWidth = radius / 16;
  context.font = `600 ${radius / 2.6}px system-ui, sans-serif`;
  context.textAlign = 'center';
  context.textBaseline = 'middle';
  for (const { letter, colour, at } of seen.sort((a, b) => a.at.z - b.at.z)) {
    context.strokeStyle = colour;
    context.fillStyle = colour;
    context.beginPath();
    context.moveTo(x, y);
    context.lineTo(x + 0.72 * radius * at.x, y - 0.72 * radius * at.y);
    context.stroke();
    context.fillText(letter, x + 0.94 * radius * at.x, y - 0.94 * radius * at.y);
  }
}
