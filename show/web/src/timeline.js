// Play, steps, slider, speed.
import { SPEEDS } from './clock.js';
import { element, icon } from './layout.js';

export function timeline(place, clock, events) {
  const { slider, play, back, forward, time, speed } = place;
  slider.max = clock.end || 1;
  for (const value of SPEEDS) speed.append(element('option', { value }, `${value} ×`));
  play.onclick = () => clock.play();
  back.onclick = () => clock.step(-1);
  forward.onclick = () => clock.step(1);
  slider.oninput = () => clock.seek(Number(slider.value));
  speed.onchange = () => { clock.speed = Number(speed.value); };
  for (const [t, words] of events) {
    const title = `${words}, t = ${+t.toPrecision(6)} s`;
    place.marks.append(element('i', { style: `left:${(100 * t) / (clock.end || 1)}%`, title, onclick: () => clock.seek(t) }));
  }
  // The last event, for half a second of those who look.
  const since = (t) => {
    const last = events.findLast(([at]) => at <= t + 1e-9 * clock.end);
    return last && t - last[0] <= 0.5 * clock.speed ? last[1].replaceAll('_', ' ') : '';
  };
  let shown = null;
  const digits = clock.end > 0 ? Math.max(0, 4 - Math.floor(Math.log10(clock.end))) : 3;
  clock.listen(() => {
    slider.value = clock.t;
    time.textContent = `${clock.t.toFixed(Math.min(6, digits))} s`;
    if (shown !== clock.playing) play.replaceChildren(icon(clock.playing ? 'pause' : 'play'));
    shown = clock.playing;
    speed.value = clock.speed;
    place.event.textContent = since(clock.t);
  });
  clock.touch();
}
