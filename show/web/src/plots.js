// The plots: one for each group, title and unit, made when they come into view, linked by time.
import uPlot from 'uplot';
import { indexAt, valueAt } from './data.js';
import { element } from './layout.js';
import { measure } from './rounding.js';
import { PALETTE } from './theme.js';
import { onDegrees, shown } from './units.js';

const HEIGHT = 150;
const GROUPS = ['Joints', 'Rates', 'Free bodies', 'Outputs', 'Inputs', 'Energy', 'Violations'];

// Columns of the first run by group, title and unit; beside each, those of other runs that it is compared with.
function charts(scenes) {
  const found = new Map();
  scenes.forEach((scene, run) => {
    for (const column of scene.columns) {
      const key = [column.group, column.title, column.unit].join('\n');
      if (!found.has(key)) found.set(key, { ...column, lines: [] });
      found.get(key).lines.push({ run, column, time: scene.time });
    }
  });
  const rank = ({ group }) => GROUPS.indexOf(group);
  return [...found.values()].sort((a, b) => rank(a) - rank(b));
}

// Of each bucket the smallest and the largest value, as all curves of a plot share their times: the curve as the eye
// sees it. `null` is a gap.
function thin(time, columns, from, to, buckets) {
  let first = Math.max(0, indexAt(time, from) - 1);
  const last = Math.min(time.length - 1, indexAt(time, to) + 2);
  const all = [];
  if (last - first < 4 * buckets) {
    for (let k = first; k <= last; k++) all.push(k);
  } else {
    const size = (last - first + 1) / buckets;
    for (let b = 0; b < buckets; b++) {
      const end = b === buckets - 1 ? last + 1 : Math.floor(last + 1 - (buckets - 1 - b) * size);
      const chosen = new Set([first, end - 1]);
      for (const values of columns) {
        let low = first;
        let high = first;
        for (let k = first; k < end; k++) {
          if (values[k] < values[low]) low = k;
          if (values[k] > values[high]) high = k;
        }
        chosen.add(low).add(high);
      }
      all.push(...[...chosen].sort((a, b2) => a - b2));
      first = end;
    }
  }
  return all;
}

// Data of a plot over a stretch of time. Runs with times of their own are joined by uPlot.
function slice(chart, from, to, width) {
  const tables = [];
  for (const run of new Set(chart.lines.map((line) => line.run))) {
    const lines = chart.lines.filter((line) => line.run === run);
    const { time } = lines[0];
    const columns = lines.map((line) => line.column.values);
    const chosen = thin(time, columns, from, to, Math.max(50, width));
    const { factor } = shown(chart.unit);
    const drawn = (v, { nothing }) => (Number.isFinite(v) && !(chart.log && v < 1e-25) ? (nothing ? 0 : factor * v) : null);
    tables.push([chosen.map((k) => time[k]), ...lines.map((line) => chosen.map((k) => drawn(line.column.values[k], line)))]);
  }
  return tables.length > 1 ? uPlot.join(tables, tables.map((table) => table.slice(1).map(() => 2))) : tables[0];
}

const number = (v) => (v === null || v === undefined ? '–' : Math.abs(v) >= 1e5 || (v !== 0 && Math.abs(v) < 1e-3)
  ? v.toExponential(4) : v.toPrecision(6));

export function plots(place, scenes, clock, theme) {
  const made = [];
  const sync = uPlot.sync('time');
  let range = [0, clock.end || 1];
  const zoom = (from, to) => {
    range = to - from > 1e-9 * clock.end ? [Math.max(0, from), Math.min(clock.end, to)] : range;
    for (const chart of made) chart.show();
  };

  const make = (chart, box) => {
    const ink = () => theme.colours.ink;
    const axis = (more) => ({
      stroke: ink, grid: { stroke: () => theme.colours.faint, width: 1 }, ticks: { stroke: () => theme.colours.faint, size: 5 },
      font: '11px system-ui, sans-serif', ...more,
    });
    const perRun = chart.lines.filter((line) => line.run === 0).length || chart.lines.length;
    const series = chart.lines.map(({ run, column }, k) => ({
      label: [column.name, scenes.length > 1 ? scenes[run].name : ''].filter(Boolean).join(' · ') || 'value',
      stroke: PALETTE[(scenes.length > 1 && perRun === 1 ? k : k % perRun) % PALETTE.length],
      width: 1.4,
      dash: run ? [5, 4] : undefined,
      points: { show: false },
      spanGaps: scenes.length > 1,
      value: (_, v) => number(v),
    }));
    const width = () => Math.max(120, box.clientWidth);
    const options = {
      width: width(),
      height: HEIGHT,
      pxAlign: 0,
      legend: { show: false },
      cursor: { sync: { key: sync.key, setSeries: false }, drag: { x: true, y: false, setScale: false } },
      scales: {
        x: { time: false, range: () => range },
        y: chart.log ? { distr: 3 } : { range: (_, low, high) => room(low, high) },
      },
      axes: [
        axis({ size: 26, label: 't [s]', labelSize: 16, labelGap: 0, gap: 2, labelFont: '11px system-ui, sans-serif', values: (_, ticks) => ticks.map((t) => +t.toPrecision(6)) }),
        axis({ size: 62, values: (_, ticks) => ticks.map((v) => (v === null ? '' : v === 0 ? '0' : short(v))) }),
      ],
      series: [{ label: 't', value: (_, v) => (v === null ? '–' : `${+v.toPrecision(8)} s`) }, ...series],
      hooks: {
        // Scales are set some time after they are asked for.
        draw: [(u) => { markEvents(u, scenes[0].events, theme.colours.ink); drawn?.point(); }],
        setCursor: [(u) => { if (drawn) drawn.read(u.cursor.idx === null || u.cursor.left < 0 ? clock.t : u.posToVal(u.cursor.left, 'x')); }],
        setSelect: [(u) => {
          if (u.select.width < 4) return;
          zoom(u.posToVal(u.select.left, 'x'), u.posToVal(u.select.left + u.select.width, 'x'));
          u.setSelect({ left: 0, width: 0, top: 0, height: 0 }, false);
        }],
      },
    };
    // Values where the cursor is, or at the time that is shown.
    const values = series.map(({ label, stroke }, k) => {
      const value = element('span', { class: 'value' });
      const key = element('span', { class: `key${chart.lines[k].run ? ' dashed' : ''}`, style: `color:${stroke}` });
      box.legend.append(element('span', {}, key, series.length > 1 ? label : '', value));
      return value;
    });
    let drawn = null;
    const u = new uPlot(options, slice(chart, ...range, width()), box);
    const hand = element('div', { class: 'hand' });
    u.over.append(hand);
    let pressed = 0;
    u.over.addEventListener('mousedown', (event) => { pressed = event.clientX; });
    u.over.addEventListener('click', (event) => {
      if (Math.abs(event.clientX - pressed) < 4) clock.seek(u.posToVal(event.offsetX, 'x'));
    });
    u.over.addEventListener('dblclick', () => zoom(0, clock.end || 1));
    drawn = {
      u,
      chart,
      read(t) {
        chart.lines.forEach(({ column, time }, k) => {
          const { nothing } = chart.lines[k];
          const value = nothing ? `0 (rounding, below ${nothing.toExponential(0)})` : number(shown(chart.unit).factor * kept(valueAt(time, column.values, t), column));
          if (values[k].textContent !== value) values[k].textContent = value;
        });
      },
      point() {
        if (!(u.cursor.left >= 0)) drawn.read(clock.t);
        const left = u.valToPos(clock.t, 'x');
        hand.style.transform = `translateX(${left}px)`;
        hand.hidden = left < 0 || left > u.over.clientWidth;
      },
      show() { u.setData(slice(chart, ...range, width())); drawn.point(); },
      resize() { u.setSize({ width: width(), height: HEIGHT }); drawn.show(); },
    };
    made.push(drawn);
    drawn.point();
    return drawn;
  };

  const coming = new IntersectionObserver((entries) => {
    for (const { isIntersecting, target } of entries) {
      if (!isIntersecting) continue;
      coming.unobserve(target);
      make(target.chart, target);
    }
  }, { root: place, rootMargin: '200px' });

  let group = null;
  const all = charts(scenes);
  measure(all);
  const captions = [];
  for (const chart of all) {
    if (chart.group !== group) place.append(element('h2', {}, chart.group));
    group = chart.group;
    const title = element('span', {});
    captions.push(() => {
      const { unit } = shown(chart.unit);
      const isNothing = chart.lines.every(({ nothing }) => nothing);
      title.textContent = chart.title.replaceAll('_', ' ') + (unit && unit !== '1' ? ` [${unit}]` : '') + (isNothing ? ': rounding alone, drawn as zero' : '');
    });
    const box = element('div', { class: 'chart' });
    box.chart = chart;
    box.legend = element('div', { class: 'legend' });
    place.append(element('figure', {}, element('figcaption', {}, title, box.legend), box));
    box.style.minHeight = `${HEIGHT}px`;
    coming.observe(box);
  }
  const caption = () => captions.forEach((write) => write());
  caption();
  const showAll = () => { caption(); for (const chart of made) chart.show(); };
  onDegrees(showAll);
  clock.listen(() => { for (const chart of made) chart.point(); });
  theme.listen(() => { for (const { u } of made) u.redraw(false); });
  new ResizeObserver(() => { for (const chart of made) chart.resize(); }).observe(place);
  return { made, zoom, range: () => range, renew: () => { measure(all); showAll(); } };
}

// A dashed line for each event.
function markEvents(u, events, colour) {
  const { ctx, bbox: { left, top, width, height } } = u;
  ctx.save();
  ctx.beginPath();
  ctx.rect(left, top, width, height);
  ctx.clip();
  ctx.strokeStyle = colour;
  ctx.globalAlpha = Math.max(0.15, 0.6 - events.length / 200);
  ctx.setLineDash([2, 3]);
  ctx.beginPath();
  for (const [t] of events) {
    const x = Math.round(u.valToPos(t, 'x', true)) + 0.5;
    ctx.moveTo(x, top);
    ctx.lineTo(x, top + height);
  }
  ctx.stroke();
  ctx.restore();
}

// As many digits as the page keeps.
function kept(v, { log, channel: { step } }) {
  if (log || !(step > 0)) return v;
  const unit = 10 ** Math.floor(Math.log10(step) + 0.7);
  return Math.round(v / unit) * unit;
}

// Rounding noise about a constant is drawn as a constant.
function room(low, high) {
  if (low === null || high === null) return [-1, 1];
  const middle = (low + high) / 2;
  const half = Math.max((high - low) / 2, 1e-9 * Math.abs(middle), 1e-300) * 1.08;
  return [middle - half, middle + half];
}

function short(v) {
  const size = Math.abs(v);
  return size >= 1e5 || size < 1e-3 ? v.toExponential(Number.isInteger(Math.log10(size)) ? 0 : 1) : String(+v.toPrecision(7));
}
