// The page's places. Everything is made here; the other files fill it.
import css from './style.css';
import uplotCss from 'uplot/dist/uPlot.min.css';

export function element(tag, attributes = {}, ...children) {
  const made = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (name === 'class') made.className = value;
    else if (name.startsWith('on')) made.addEventListener(name.slice(2), value);
    else if (value !== null && value !== undefined) made.setAttribute(name, value);
  }
  made.append(...children);
  return made;
}

// Pictures on buttons: fonts do not have them everywhere.
export const ICONS = {
  play: 'M5 3l10 6-10 6z',
  pause: 'M5 3h3v12H5zM10 3h3v12h-3z',
  back: 'M4 3h2v12H4zM14 3v12L7 9z',
  forward: 'M12 3h2v12h-2zM4 3v12l7-6z',
  theme: 'M9 2a7 7 0 1 0 0 14A7 7 0 1 0 9 2zM9 4v10A5 5 0 1 0 9 4z',
};

export function icon(name) {
  const svg = document.createElementNS('http://www.w3.org/2000/svg', 'svg');
  svg.setAttribute('viewBox', '0 0 18 18');
  svg.innerHTML = `<path fill="currentColor" fill-rule="evenodd" d="${ICONS[name]}"/>`;
  return svg;
}

export function layout(head, scenes) {
  document.head.append(element('style', {}, uplotCss + css));
  const place = {};
  const keep = (name, made) => { place[name] = made; return made; };
  const { name } = scenes[0].mechanism;
  const legend = scenes.length > 1
    ? scenes.map((scene, k) => element('span', { class: `run run${k}` }, scene.name))
    : [];
  const button = (label, words) => element('button', { type: 'button', title: words, 'aria-label': words }, label);
  document.body.append(
    element('header', {},
      element('h1', {}, name.replaceAll('_', ' ')),
      element('div', { class: 'runs' }, ...legend),
      keep('helpButton', button('?', 'Keys (?)')),
      keep('themeButton', button(icon('theme'), 'Light or dark'))),
    element('main', {},
      element('section', { class: 'picture', 'aria-label': 'the mechanism' },
        keep('picture', element('div', { class: 'canvas' })),
        keep('options', element('div', { class: 'options' })),
        keep('label', element('div', { class: 'label', hidden: '' })),
        keep('live', element('aside', { class: 'live', hidden: '', 'aria-label': 'parameters and inputs' })),
        keep('panel', element('aside', { class: 'panel', hidden: '' })),
        keep('word', element('p', { class: 'word', hidden: '' }))),
      keep('plots', element('section', { class: 'plots', 'aria-label': 'plots' }))),
    element('footer', {},
      keep('back', button(icon('back'), 'One sample back (←)')),
      keep('play', button(icon('play'), 'Play or pause (space)')),
      keep('forward', button(icon('forward'), 'One sample on (→)')),
      element('div', { class: 'track' }, keep('slider', element('input', { type: 'range', min: 0, max: 1, step: 'any', value: 0, 'aria-label': 'time' })), keep('marks', element('div', { class: 'marks' }))),
      keep('event', element('output', { class: 'event' })),
      keep('time', element('output', { class: 'time' })),
      keep('speed', element('select', { title: 'Speed (+ −)', 'aria-label': 'speed' }))),
    keep('help', element('dialog', { class: 'help' })));
  return place;
}
