// Sliders for parameters and inputs of a mechanism that runs in the page.
import { element } from './layout.js';

// From nothing to twice the value; of zero, about it.
function span(value) {
  return value === 0 ? [-1, 1] : [Math.min(0, 2 * value), Math.max(0, 2 * value)];
}

function row(kind, { name, value, unit }, changed) {
  const [min, max] = span(value);
  const words = name.replaceAll('_', ' ');
  const slider = element('input', { type: 'range', min, max, step: 'any', 'aria-label': words });
  const number = element('input', { type: 'number', step: 'any', 'aria-label': `${words}, number` });
  const show = (now) => {
    slider.min = Math.min(slider.min, now);
    slider.max = Math.max(slider.max, now);
    slider.value = now;
    number.value = Number(now.toPrecision(5));
  };
  slider.oninput = () => { number.value = Number(Number(slider.value).toPrecision(5)); changed(kind, name, Number(slider.value)); };
  number.onchange = () => {
    if (!Number.isFinite(number.valueAsNumber)) { show(value); changed(kind, name, value); return; }
    show(number.valueAsNumber);
    changed(kind, name, number.valueAsNumber);
  };
  show(value);
  return { line: element('label', { class: kind }, element('span', {}, words + (unit ? ` [${unit}]` : '')), slider, number), reset: () => show(value) };
}

export function sliders(place, live, clock, redraw) {
  const { parameters, inputs, without } = live.given;
  const say = element('p', { role: 'status' });
  const changed = (kind, name, value) => {
    live.set(kind, name, value);
    live.from(clock.t);
    redraw(kind);
  };
  const rows = [['parameter', parameters], ['input', inputs]].flatMap(([kind, all]) => all.map((of) => row(kind, of, changed)));
  const button = (words, title, work) => element('button', { type: 'button', title, onclick: work }, words);
  const anew = () => { live.begin(0); clock.seek(0); };
  // The run that is shown is no longer the one that the page came with.
  const note = (words) => element('div', { role: 'note' }, `Computed here without ${words}`);
  place.live.append(
    ...without.map(note),
    ...rows.map(({ line }) => line),
    element('div', {},
      button('anew', 'From the start, with the values that are set', anew),
      button('reset', 'All values, and the run, as they were', () => {
        live.reset();
        rows.forEach((each) => each.reset());
        anew();
        redraw('parameter');
      })),
    say);
  place.live.hidden = false;
  live.listen(() => {
    const { failure, isReady, scene, next } = live;
    say.textContent = failure ? failure.message : isReady ? '' : `${Math.round((100 * next) / scene.n)} %`;
  });
}
