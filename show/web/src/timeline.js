// Play, steps, slider, speed.
import { SPEEDS } from './clock.js';
import { element, icon } from './layout.js';

export function timeline(place, clock) {
  const { slider, play, back, forward, time, speed } = place;
  slider.max = clock.end || 1;
  for (const value of SPEEDS) speed.append(element('option', { value }, `${value} ×`));
  play.onclick = () => clock.play();
  back.onclick = () => clock.step(-1);
  forward.onclick = () => clock.step(1);
  slider.oninput = () => clock.seek(Number(slider.value));
  speed.onchange = () => { clock.speed = Number(speed.value); };
  let shown = null;
  const digits = clock.end > 0 ? Math.max(0, 4 - Math.floor(Math.log10(clock.end))) : 3;
  clock.listen(() => {
    slider.value = clock.t;
    time.textContent = `${clock.t.toFixed(Math.min(6, digits))} s`;
    if (shown !== clock.playing) play.replaceChildren(icon(clock.playing ? 'pause' : 'play'));
    shown = clock.playing;
    speed.value = clock.speed;
  });
  clock.touch();
}
