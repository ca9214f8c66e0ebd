// The keyboard.
import { element } from './layout.js';

const KEYS = [
  ['space', 'play or pause'],
  ['← →', 'one sample back or on'],
  ['Shift ← →', 'a twentieth of the run back or on'],
  ['Home End', 'to the start or the end'],
  ['+ −', 'faster or slower'],
  ['F', 'frames of bodies'],
  ['T', 'trails'],
  ['I', 'inertia ellipsoids'],
  ['L', 'names'],
  ['G', 'ground'],
  ['A', 'forces: weight, springs, loads, reactions'],
  ['R', 'the first view again'],
  ['Esc', 'nothing selected'],
  ['?', 'this list'],
];

export function keys(clock, place) {
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
