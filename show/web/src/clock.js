// The time that is shown, and who wants to know of it.
import { indexAt } from './data.js';

export const SPEEDS = [0.001, 0.002, 0.005, 0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 50, 100];

export class Clock {
  constructor(scenes) {
    this.end = Math.max(...scenes.map(({ time }) => time[time.length - 1] ?? 0));
    this.times = scenes[0].time;
    this.t = 0;
    this.playing = false;
    this.speed = pleasant(scenes, this.end);
    this.listeners = [];
    this.last = null;
  }

  listen(listener) { this.listeners.push(listener); }

  touch() { for (const listener of this.listeners) listener(this); }

  seek(t) {
    this.t = Math.min(this.end, Math.max(0, t));
    this.touch();
  }

  play(playing = !this.playing) {
    if (playing && this.t >= this.end) this.t = 0;
    this.playing = playing && this.end > 0;
    this.last = null;
    if (this.playing) requestAnimationFrame((now) => this.tick(now));
    this.touch();
  }

  tick(now) {
    if (!this.playing) return;
    const passed = this.last === null ? 0 : Math.min(0.1, (now - this.last) / 1000);
    this.last = now;
    this.t += passed * this.speed;
    if (this.t >= this.end) this.t = this.end > 0 ? this.t % this.end : 0;
    this.touch();
    requestAnimationFrame((next) => this.tick(next));
  }

  // To a neighbouring sample.
  step(by) {
    this.playing = false;
    const k = indexAt(this.times, this.t + 1e-9 * this.end) + by;
    this.seek(this.times[Math.min(this.times.length - 1, Math.max(0, k))]);
  }

  faster(by) {
    const k = SPEEDS.findIndex((speed) => speed >= this.speed * 0.999) + by;
    this.speed = SPEEDS[Math.min(SPEEDS.length - 1, Math.max(0, k))];
    this.touch();
  }
}

// Real time, but slower where the eye could not follow (more than a turn a second), and faster where nothing would
// happen for minutes.
function pleasant(scenes, end) {
  let fastest = 0;
  for (const { bodies, time } of scenes) {
    for (const { velocity } of bodies) {
      if (!velocity.length) continue;
      const every = Math.max(1, Math.floor(time.length / 200));
      for (let k = 0; k < time.length; k += every) {
        fastest = Math.max(fastest, Math.hypot(velocity[3][k], velocity[4][k], velocity[5][k]));
      }
    }
  }
  const most = Math.min(fastest > 0 ? 6 / fastest : Infinity, Math.max(1, end / 20));
  const wanted = Math.max(most, end / 60);
  return SPEEDS.filter((speed) => speed <= Math.min(wanted, Math.max(1, end / 20))).pop() ?? SPEEDS[0];
}
