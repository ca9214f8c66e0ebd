// The page's program: reads the data, builds timeline, plots and picture, and lets one clock drive them.
import { readScenes } from './data.js';
import { layout } from './layout.js';
import { Clock } from './clock.js';
import { timeline } from './timeline.js';
import { plots } from './plots.js';
import { panel } from './panel.js';
import { keys } from './keys.js';
import { Live } from './live.js';
import { sliders } from './sliders.js';
import { drawnWith } from './drawn.js';
import { watchTheme } from './theme.js';
import { picture } from './scene/picture.js';

const began = performance.now();
const scenes = readScenes(gyro.head, gyro.numbers);
const place = layout(gyro.head, scenes);
const clock = new Clock(scenes);
const theme = watchTheme(place.themeButton);

const [{ events }] = scenes;
timeline(place, clock, events);
const charts = plots(place.plots, scenes, clock, theme);
const marks = { plots: performance.now() - began };
const numbers = panel(place, scenes, clock);
keys(clock, place, events);

// For tests and for `gallery.mjs`: what the page shows, and how long it took.
const api = { clock, scenes, charts, numbers, marks, picture: null, live: null };
globalThis.gyroPage = api;

// The plots are on the screen before the picture's shaders are compiled.
requestAnimationFrame(() => setTimeout(() => {
  api.picture = picture(place, scenes, clock, theme, numbers);
  marks.picture = performance.now() - began;
  clock.touch();
  document.body.dataset.ready = api.picture ? 'picture' : 'plots';
  if (gyro.head.live) runLive();
}));

// The first run is computed anew, here, and from then on whenever something is set.
async function runLive() {
  const [scene] = scenes;
  const live = await Live.of(gyro.head.live, gyro.module, scene);
  api.live = live;
  sliders(place, live, clock, (kind) => {
    if (kind === 'parameter' && drawnWith(scene.mechanism, gyro.head.live, live.mechanism.parameters)) api.picture?.remake();
  });
  live.listen(() => {
    // They were those of the run that the page came with.
    events.length = 0;
    place.marks.replaceChildren();
    charts.renew();
    api.picture?.renew();
    clock.touch();
  });
}
