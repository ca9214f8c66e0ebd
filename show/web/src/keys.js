// The keyboard.
import { element } from './layout.js';

const KEYS = [
  ['space', 'play or pause'],
  ['← →', 'one sample back or on'],
  ['Shift ← →', 'a twentieth of the run back or on'],
  ['Home End', 'to the start or the end'],
  ['E', 'to the next event'],
  ['+ −', 'faster or slower'],
  ['F', 'frames of bodies'],
  ['T', 'trails'],
  ['I', 'inertia ellipsoids'],
  ['L', 'names'],
  ['G', 'ground'],
  ['A', 'forces: weight, springs, loads, reactions'],
  ['C', 'the camera follows'],
  ['D', 'angles in degrees'],
  ['1 2 3 4', 'front, top, side, corner'],
  ['R', 'the first view again'],
  ['P V', 'picture (PNG), video of the run'],
  ['Esc', 'nothing selected'],
  ['?', 'this list'],
];

export function keys(clock, place, events) {
  place.help.append(
    element('h2', {}, 'Keys'),
    element('dl', {}, ...KEYS.flatMap(([key, what]) => [element('dt', {}, key), element('dd', {}, what)])),
    element('p', {}, 'Drag to turn the picture, wheel or two fingers to come nearer, right button to shift it. '
      + 'Click a body for its numbers. In a plot: click for a time, drag to zoom in, double click for the whole.'),
    element('form', { method: 'dialog' }, element('button', {}, 'Close')));
  place.helpButton.onclick = () => place.help.showModal();
  const far = clock.end / 20;
  const actions = {
    ' ': () => clock.play(),
    ArrowLeft: (event) => (event.shiftKey ? clock.seek(clock.t - far) : clock.step(-1)),
    ArrowRight: (event) => (event.shiftKey ? clock.seek(clock.t + far) : clock.step(1)),
    Home: () => clock.seek(0),
    End: () => clock.seek(clock.end),
    e: () => clock.seek(events.find(([t]) => t > clock.t + 1e-9 * clock.end)?.[0] ?? clock.t),
    '+': () => clock.faster(1),
    '=': () => clock.faster(1),
    '-': () => clock.faster(-1),
    '?': () => place.help.showModal(),
  };
  addEventListener('keydown', (event) => {
    const tag = event.target.tagName;
    if (event.ctrlKey || event.metaKey || event.altKey || place.help.open || tag === 'SELECT') return;
    // Numbers and sliders of a live mechanism take their keys themselves.
    if (event.target.closest?.('.live') && tag === 'INPUT') return;
    // A button in focus takes the space bar itself.
    if (event.key === ' ' && tag === 'BUTTON') return;
    const action = actions[event.key];
    if (action) { event.preventDefault(); action(event); return; }
    dispatchEvent(new CustomEvent('picture-key', { detail: event.key.toLowerCase() }));
  });
}
