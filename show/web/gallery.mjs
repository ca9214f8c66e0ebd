// Draws the gallery's pictures anew, docs/images/show/*.webp, and the README's moving gyroscope, from pages that it has
// `cargo xtask show` write; with a folder as argument, from the pages in there.
import { mkdtempSync, mkdirSync, statSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import gifenc from 'gifenc';
import { open, still, withChromium } from './tests/chromium.mjs';
import { MODELS, nameOf } from './tests/models.mjs';
import { writePages } from './tests/pages.mjs';

const IMAGES = new URL('../../docs/images/', import.meta.url).pathname;
const [STILL, FILM] = [40_000, 300_000];

let folder = process.argv[2];
if (!folder) {
  folder = mkdtempSync(join(tmpdir(), 'gyro-gallery-'));
  writePages(folder);
}
mkdirSync(join(IMAGES, 'show'), { recursive: true });

function keep(path, bytes, most) {
  writeFileSync(path, bytes);
  const { size } = statSync(path);
  console.log(`${path.slice(IMAGES.length)}: ${size} bytes`);
  if (size > most) throw new Error(`${path} is larger than ${most} bytes`);
}

await withChromium(async (browser) => {
  for (const [file, , part] of MODELS) {
    const page = await open(browser, join(folder, `${nameOf(file)}.html`));
    const end = await page.evaluate(() => globalThis.gyroPage.clock.end);
    const url = await still(page, part * end, [480, 360]);
    keep(join(IMAGES, 'show', `${nameOf(file)}.webp`), Buffer.from(url.split(',')[1], 'base64'), STILL);
    await page.close();
  }
  keep(join(IMAGES, 'gyroscope-moving.gif'), await film(await open(browser, join(folder, 'gyroscope.html'))), FILM);
});

// One second of precession for each rad of the outer ring would be still for the eye: ten seconds in four, the rotor by
// a quarter of a mark's spacing from picture to picture, and back at the start as it was.
async function film(page) {
  const [wide, high, n] = [420, 320, 48];
  await still(page, 0, [wide, high]);
  const encoder = gifenc.GIFEncoder();
  let palette = null;
  for (let k = 0; k < n; k++) {
    const data = await page.evaluate(({ part, k }) => {
      const { clock, picture, scenes } = globalThis.gyroPage;
      // A sample near the time at which the rotor's marks have gone on by a little.
      const [{ time, columns }] = scenes;
      const phi = columns.find((c) => c.group === 'Joints' && c.title === 'phi').values;
      const third = (2 * Math.PI) / 3;
      const wanted = ((k * third) / 6) % third;
      const from = Math.floor(part * (time.length - 1));
      let best = from;
      const off = (i) => { const d = (((phi[i] - wanted) % third) + third) % third; return Math.min(d, third - d); };
      for (let i = Math.max(0, from - 30); i < Math.min(time.length, from + 30); i++) if (off(i) < off(best)) best = i;
      clock.seek(time[best]);
      picture.draw();
      const { width, height } = picture.canvas;
      const copy = new OffscreenCanvas(width, height).getContext('2d');
      copy.drawImage(picture.canvas, 0, 0);
      const { data } = copy.getImageData(0, 0, width, height);
      let text = '';
      for (let p = 0; p < data.length; p += 8192) text += String.fromCharCode(...data.subarray(p, p + 8192));
      return { width, height, pixels: btoa(text) };
    }, { part: 0.5 - 0.5 * Math.cos((2 * Math.PI * k) / n), k });
    const pixels = new Uint8Array(Buffer.from(data.pixels, 'base64'));
    palette ??= gifenc.quantize(pixels, 40);
    const indices = gifenc.applyPalette(pixels, palette);
    const last = film.last;
    film.last = indices.slice();
    // What has not changed is left as it was.
    if (last) for (let p = 0; p < indices.length; p++) if (indices[p] === last[p]) indices[p] = palette.length;
    encoder.writeFrame(indices, data.width, data.height, {
      palette: last ? undefined : [...palette, [0, 0, 0]], delay: 80, transparent: Boolean(last), transparentIndex: palette.length, dispose: 1,
    });
  }
  encoder.finish();
  return Buffer.from(encoder.bytes());
}
