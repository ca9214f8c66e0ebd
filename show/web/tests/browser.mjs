// Drives headless Chromium over pages of `gyro show`: loads them from disk, without a network, plays, seeks, selects,
// resizes, switches to dark, zooms, and compares pictures with the gallery's. Takes the folder with the pages.
import assert from 'node:assert/strict';
import { existsSync, readFileSync, statSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { open, still, withChromium } from './chromium.mjs';
import { MODELS, nameOf } from './models.mjs';

const folder = process.argv[2];
if (!folder) throw new Error('usage: node tests/browser.mjs FOLDER');
const at = (name) => join(folder, `${name}.html`);
const gallery = new URL('../../../docs/images/show/', import.meta.url);

const LARGEST = 500_000;
const [PLOTS, PICTURE] = [1000, 3000];
// Mean difference of colours, of 255: what another driver or font makes; another pose makes several times as much.
const ALIKE = 4;

const clockTime = (page) => page.evaluate(() => globalThis.gyroPage.clock.t);

const tests = {
  async 'the page of ten seconds is small and quick'(browser) {
    assert.ok(statSync(at('gyroscope')).size <= LARGEST, `${statSync(at('gyroscope')).size} bytes`);
    const page = await open(browser, at('gyroscope'));
    const { plots, picture } = await page.evaluate(() => globalThis.gyroPage.marks);
    console.log(`  plots after ${Math.round(plots)} ms, picture after ${Math.round(picture)} ms`);
    assert.ok(plots < PLOTS && picture < PICTURE);
    return page;
  },

  async 'it plays, pauses, steps and seeks'(browser) {
    const page = await open(browser, at('gyroscope'));
    const shot = () => page.evaluate(() => { globalThis.gyroPage.picture.draw(); return globalThis.gyroPage.picture.canvas.toDataURL(); });
    const first = await shot();
    await page.keyboard.press('Space');
    await page.waitForFunction(() => globalThis.gyroPage.clock.t > 0.01);
    await page.keyboard.press('Space');
    const t = await clockTime(page);
    await page.waitForTimeout(200);
    assert.equal(await clockTime(page), t, 'paused');
    assert.notEqual(await shot(), first, 'nothing has moved');
    await page.keyboard.press('End');
    assert.equal(await clockTime(page), 10);
    await page.keyboard.press('Home');
    await page.keyboard.press('ArrowRight');
    await page.keyboard.press('ArrowRight');
    await page.keyboard.press('ArrowLeft');
    assert.ok(Math.abs(await clockTime(page) - 0.001) < 1e-7, `one sample on: ${await clockTime(page)}`);
    await page.locator('input[type=range]').fill('5');
    assert.equal(await clockTime(page), 5);
    await page.locator('button[title^="Play"]').click();
    await page.waitForFunction(() => globalThis.gyroPage.clock.t > 5.01);
    return page;
  },

  async 'numbers are those of the run'(browser) {
    const page = await open(browser, at('gyroscope'));
    const found = await page.evaluate(() => {
      const [scene] = globalThis.gyroPage.scenes;
      const last = scene.n - 1;
      const value = (group, title) => scene.columns.find((c) => c.group === group && c.title === title).values[last];
      return { n: scene.n, t: scene.time[last], alpha: value('Joints', 'alpha'), phi: value('Joints', 'phi') };
    });
    // Precession at m g d / H = 0.1 rad/s for ten seconds, and the rotor's 100 rad/s.
    assert.equal(found.n, 10001);
    assert.ok(Math.abs(found.t - 10) < 1e-7 && Math.abs(found.alpha - 1) < 2e-3 && Math.abs(found.phi - 1000) < 0.1, JSON.stringify(found));
    return page;
  },

  async 'arcs show the torques that accelerate'(browser) {
    const page = await open(browser, at('torsion'));
    await page.keyboard.press('a');
    const { torque, needed, most } = await page.evaluate(() => {
      const { picture, scenes: [scene], clock } = globalThis.gyroPage;
      clock.seek(0.3);
      picture.draw();
      const laws = picture.arrows.drawn.filter(({ source }) => source.turns);
      const rate = scene.columns.find(({ group }) => group === 'Rates').values;
      // About the axis, z: J α, with α from the rates around.
      const sums = (t) => laws.reduce((sum, { source }) => sum + source.at(t)[0][1][2], 0);
      const k = scene.time.findIndex((t) => t > 0.3);
      const needed = 0.02 * (rate[k + 1] - rate[k - 1]) / (scene.time[k + 1] - scene.time[k - 1]);
      return { torque: sums(scene.time[k]), needed, most: laws.filter(({ arrows: [arc] }) => arc.visible).length };
    });
    assert.ok(Math.abs(torque - needed) < 1e-3 * Math.abs(needed) && Math.abs(needed) > 0.1, `${torque} ${needed}`);
    assert.equal(most, 2, 'a spring and a damper');
    return page;
  },

  async 'forces by formula are drawn as they accelerate'(browser) {
    for (const [name, body, mass] of [['quadrotor', 'frame', 1.2], ['crane', 'load', 50]]) {
      const page = await open(browser, at(name));
      await page.keyboard.press('a');
      const { sum, needed, count } = await page.evaluate(([body, mass]) => {
        const { picture, scenes: [scene] } = globalThis.gyroPage;
        const b = scene.mechanism.bodies.findIndex(({ name }) => name === body);
        const pushes = picture.arrows.drawn.filter(({ source }) => !source.turns);
        const k = Math.floor(scene.n / 2);
        const t = scene.time[k];
        const sum = [0, 1, 2].map((axis) => pushes.reduce((all, { source }) => all + source.at(t)[0][1][axis], 0));
        const v = scene.bodies[b].velocity;
        const needed = [0, 1, 2].map((axis) => mass * (v[axis][k + 1] - v[axis][k - 1]) / (scene.time[k + 1] - scene.time[k - 1]));
        return { sum, needed, count: pushes.length };
      }, [body, mass]);
      const size = Math.hypot(...needed);
      assert.ok(size > 0.1 && count > 1, `${name}: ${needed} of ${count}`);
      assert.ok(Math.hypot(...sum.map((x, axis) => x - needed[axis])) < 1e-2 * mass * 9.81, `${name}: ${sum}, not ${needed}`);
      await page.close();
    }
    return open(browser, at('crane'));
  },

  async 'contacts carry what lies on them, where it lies, and their way is drawn'(browser) {
    const page = await open(browser, at('crates'));
    await page.keyboard.press('a');
    await page.keyboard.press('t');
    const { pushes, ways, masses, places } = await page.evaluate(() => {
      const { picture, scenes: [scene], clock } = globalThis.gyroPage;
      const t = scene.time[scene.n - 1];
      clock.seek(t);
      picture.draw();
      const drawn = picture.arrows.drawn.filter(({ source }) => source.kind === 'contact');
      return {
        pushes: drawn.map(({ source, arrows }) => [...source.at(t), arrows.every((arrow) => arrow.visible)]),
        ways: picture.trails.lines.filter(({ ends }) => ends?.at(-1) > 100).length,
        masses: scene.mechanism.bodies.map(({ mass }) => mass).slice(1),
        places: scene.bodies.slice(1).map(({ pose }) => pose.slice(0, 3).map((channel) => channel.at(-1))),
      };
    });
    assert.ok(pushes.length === 3 && ways === 3, `${pushes.length} ${ways}`);
    pushes.forEach(([[place, force], [, other], visible], k) => {
      const above = masses.slice(k).reduce((sum, mass) => sum + mass, 0);
      assert.ok(visible && Math.abs(force[2] / (9.81 * above) - 1) < 1e-2 && other[2] === -force[2], `${k}: ${force} under ${above} kg`);
      // Below the crate that it carries, and near it.
      const off = place.map((x, axis) => x - places[k][axis]);
      assert.ok(off[2] < -0.05 && Math.hypot(...off) < 0.2, `${k}: ${off}`);
    });
    return page;
  },

  async 'meshes are where and as large as their model file says'(browser) {
    const page = await open(browser, at('wedge'));
    const box = await page.evaluate(() => {
      const { picture, scenes: [scene] } = globalThis.gyroPage;
      const corners = [Infinity, Infinity, Infinity, -Infinity, -Infinity, -Infinity];
      picture.all[0].bodies[1].group.children[0].traverse((part) => {
        if (!part.geometry) return;
        part.geometry.computeBoundingBox();
        const { min, max } = part.geometry.boundingBox.applyMatrix4(part.matrix);
        [min.x, min.y, min.z].forEach((x, k) => { corners[k] = Math.min(corners[k], x); });
        [max.x, max.y, max.z].forEach((x, k) => { corners[3 + k] = Math.max(corners[3 + k], x); });
      });
      return { corners, triangles: scene.meshes[0].triangles.length / 3 };
    });
    assert.equal(box.triangles, 8);
    const expected = [-0.05, -0.05, 0, 0.15, 0.05, 0.1];
    box.corners.forEach((x, k) => assert.ok(Math.abs(x - expected[k]) < 2e-4, `${box.corners}`));
    return page;
  },

  async 'a click selects a body and shows its numbers'(browser) {
    const page = await open(browser, at('gyroscope'));
    // A point of the picture where there is a moving body, found by asking all over it.
    const spot = await page.evaluate(() => {
      const { canvas, under } = globalThis.gyroPage.picture;
      for (let x = 0.3; x < 0.7; x += 0.02) {
        for (let y = 0.2; y < 0.8; y += 0.02) {
          const place = { offsetX: x * canvas.clientWidth, offsetY: y * canvas.clientHeight };
          if (under(place)?.body === 3) return place;
        }
      }
      return null;
    });
    assert.ok(spot, 'the rotor is not in the picture');
    const box = await page.locator('canvas').first().boundingBox();
    const canvas = await page.evaluate(() => { const { x, y } = globalThis.gyroPage.picture.canvas.getBoundingClientRect(); return { x, y }; });
    assert.ok(box);
    await page.mouse.move(canvas.x + spot.offsetX, canvas.y + spot.offsetY);
    assert.equal(await page.locator('.label').textContent(), 'rotor');
    await page.mouse.click(canvas.x + spot.offsetX, canvas.y + spot.offsetY);
    const words = await page.locator('.panel').textContent();
    assert.match(words, /rotor.*mass \[kg\]0\.08.*angular velocity.*100/);
    await page.keyboard.press('Escape');
    assert.ok(await page.locator('.panel').isHidden());
    return page;
  },

  async 'a cursor in one plot is a cursor in all, a click seeks, dragging zooms to every sample'(browser) {
    const page = await open(browser, at('gyroscope'));
    const over = page.locator('.u-over').first();
    const box = await over.boundingBox();
    await page.mouse.move(box.x + box.width / 2, box.y + 20);
    const cursors = await page.evaluate(() => globalThis.gyroPage.charts.made.map(({ u }) => u.cursor.left));
    assert.ok(cursors.length > 2 && cursors.every((left) => Math.abs(left - cursors[0]) < 2), JSON.stringify(cursors));
    await page.mouse.click(box.x + box.width / 2, box.y + 20);
    assert.ok(Math.abs(await clockTime(page) - 5) < 0.1);
    await page.evaluate(() => globalThis.gyroPage.charts.zoom(2, 2.05));
    const { shown, samples } = await page.evaluate(() => {
      const { u } = globalThis.gyroPage.charts.made[0];
      const inside = (t) => t >= 2 && t <= 2.05;
      return { shown: u.data[0].filter(inside).length, samples: globalThis.gyroPage.scenes[0].time.filter(inside).length };
    });
    assert.ok(samples > 45 && shown === samples, `${shown} of ${samples}`);
    // The line at the time that is shown stands where the zoomed plot has that time.
    await page.evaluate(() => { globalThis.gyroPage.clock.seek(3.02); globalThis.gyroPage.charts.zoom(3, 3.05); });
    await page.waitForTimeout(100);
    const off = await page.evaluate(() => {
      const { u } = globalThis.gyroPage.charts.made[0];
      const hand = u.over.querySelector('.hand').getBoundingClientRect().left - u.over.getBoundingClientRect().left;
      return hand - u.over.clientWidth * 0.4;
    });
    assert.ok(Math.abs(off) < 2, `the line is ${off} pixels off`);
    await page.mouse.dblclick(box.x + box.width / 2, box.y + 20);
    assert.deepEqual(await page.evaluate(() => globalThis.gyroPage.charts.range()), [0, await page.evaluate(() => globalThis.gyroPage.clock.end)]);
    return page;
  },

  async 'dark, and as wide as a phone'(browser) {
    const page = await open(browser, at('gyroscope'));
    await page.emulateMedia({ colorScheme: 'dark' });
    await page.waitForFunction(() => document.documentElement.dataset.theme === 'dark');
    const dark = await page.evaluate(() => getComputedStyle(document.body).backgroundColor);
    assert.ok(dark.match(/\d+/g).every((part) => Number(part) < 60), dark);
    await page.locator('button[title^="Light"]').click();
    assert.equal(await page.evaluate(() => document.documentElement.dataset.theme), 'light');
    await page.setViewportSize({ width: 390, height: 780 });
    await page.waitForFunction(() => globalThis.gyroPage.picture.canvas.clientWidth === 390);
    const { wide, tall } = await page.evaluate(() => ({ wide: document.documentElement.scrollWidth, tall: document.documentElement.scrollHeight }));
    assert.ok(wide <= 390 && tall <= 780, `${wide} × ${tall}`);
    for (const words of ['Play', 'One sample on']) assert.ok(await page.locator(`button[title^="${words}"]`).isVisible());
    return page;
  },

  async 'a camera follows what flies far, and standard views look along the axes'(browser) {
    const page = await open(browser, at('thrown'));
    const seen = (t) => page.evaluate((time) => {
      const { picture: { camera, all, draw, boxes }, clock } = globalThis.gyroPage;
      clock.seek(time);
      draw();
      const { x, y } = all[0].bodies[0].group.getWorldPosition(camera.position.clone()).project(camera);
      return { x, y, follows: boxes.c.checked };
    }, t);
    for (const t of [0, 1, 2]) {
      const { x, y, follows } = await seen(t);
      assert.ok(follows && Math.hypot(x, y) < 0.7, `at ${t} s the stone is at ${x}, ${y}`);
    }
    const back = { 1: [0, -1, 0], 2: [0, 0, 1], 3: [1, 0, 0], 4: [1, -1, 1] };
    for (const [key, [x, y, z]] of Object.entries(back)) {
      await page.keyboard.press(key);
      const off = await page.evaluate((v) => {
        const { camera, controls } = globalThis.gyroPage.picture;
        const along = camera.position.clone().sub(controls.target).normalize();
        return along.distanceTo(along.clone().set(...v).normalize());
      }, [x, y, z]);
      assert.ok(off < 2e-3, `view ${key} is off by ${off}`);
    }
    await page.keyboard.press('c');
    const far = await seen(2);
    assert.ok(!far.follows && Math.hypot(far.x, far.y) > 0.3, JSON.stringify(far));
    const quiet = await open(browser, at('gyroscope'));
    assert.equal(await quiet.evaluate(() => globalThis.gyroPage.picture.boxes.c.checked), false);
    assert.deepEqual(quiet.errors, []);
    return page;
  },

  async 'free bodies are plotted, events marked, angles in degrees, units raised, rounding said, colours kept'(browser) {
    const page = await open(browser, at('thrown'));
    const captions = async () => (await page.locator('figcaption').allTextContents()).join('\n');
    for (const words of ['stone position [m]', 'stone orientation', 'stone velocity [m/s]', 'wag [rad]', 'felt [m/s²]']) {
      assert.ok((await captions()).includes(words), `${words} is missing in ${await captions()}`);
    }
    await page.keyboard.press('d');
    assert.ok((await captions()).includes('wag [°]') && (await captions()).includes('[°/s]'));
    const { fall, last, most, events, marks, colour } = await page.evaluate(() => {
      const { scenes: [scene], picture, charts, clock } = globalThis.gyroPage;
      const column = (title, name) => scene.columns.find((c) => c.title === title && c.name === name).values;
      const end = scene.n - 1;
      clock.seek(scene.events[0][0]);
      return {
        // Of both bodies together the centre falls freely; the stone is never further from it than 0.05 m. The tail, a
        // quarter of a metre behind on a stone that turns at 5 rad/s, starts 1.25 m/s faster.
        fall: column('stone position', 'z')[end] - ((10 + (0.2 * 1.25) / 1.2) * 2 - (9.81 * 4) / 2),
        last: charts.made[0].u.data[1].at(-1),
        most: column('wag', '')[end],
        events: scene.events,
        marks: document.querySelectorAll('.marks i').length,
        colour: picture.all[0].bodies[0].group.children[0].material.color.getHexString(),
      };
    });
    assert.ok(Math.abs(fall) < 0.05, `${fall}`);
    assert.ok(Math.abs(last - (most * 180) / Math.PI) < 1e-3 * Math.abs(last), `${last}° for ${most} rad`);
    assert.ok(events.length > 0 && marks === events.length, `${events.length} events, ${marks} marks`);
    assert.match(await page.locator('.event').textContent(), /apex/);
    assert.equal(colour, 'b22222');
    // Torques of 3e-16 N·m beside forces of a newton are none; of 3e-3, they are.
    for (const [size, isNothing] of [[3e-16, true], [3e-3, false]]) {
      await page.evaluate((value) => {
        const { scenes: [scene], charts } = globalThis.gyroPage;
        for (const { title, unit, values } of scene.columns) if (title === 'force' && unit === 'N*m') values.fill(value);
        charts.renew();
      }, size);
      assert.equal((await captions()).includes('force [N·m]: rounding alone, drawn as zero'), isNothing, await captions());
    }
    return page;
  },

  async 'picture and video are saved'(browser) {
    const page = await open(browser, at('thrown'));
    const [sizes, kinds, t] = await page.evaluate(async () => {
      const { picture, clock } = globalThis.gyroPage;
      clock.speed = 2;
      const made = [await picture.png(), await picture.video()];
      return [made.map(({ size }) => size), made.map(({ type }) => type), clock.t];
    });
    assert.ok(sizes.every((size) => size > 5000), `${sizes}`);
    assert.ok(kinds[0] === 'image/png' && kinds[1].startsWith('video/') && t === 2, `${kinds} ${t}`);
    return page;
  },

  async 'whatever can be shown on request is shown'(browser) {
    const page = await open(browser, at('compared'));
    for (const key of ['f', 't', 'i', 'l', 'a', 'g', 'r']) await page.keyboard.press(key);
    await page.evaluate(() => globalThis.gyroPage.clock.seek(0.3));
    assert.ok(await page.locator('.tag').first().isVisible());
    assert.deepEqual(await page.locator('.run').allTextContents(), ['length = 0.5', 'length = 0.4']);
    const lines = await page.evaluate(() => globalThis.gyroPage.charts.made[0].chart.lines.length);
    assert.equal(lines, 2);
    await page.keyboard.press('?');
    assert.ok(await page.locator('dialog').isVisible());
    return page;
  },

  async 'a hundred thousand samples stay smooth'(browser) {
    const page = await open(browser, at('many'));
    const took = await page.evaluate(() => {
      const { charts, clock, scenes } = globalThis.gyroPage;
      const time = (work) => { const begin = performance.now(); work(); return performance.now() - begin; };
      return {
        n: scenes[0].n,
        points: Math.max(...charts.made.map(({ u }) => u.data[0].length)),
        zoom: time(() => charts.zoom(0.1 * clock.end, 0.9 * clock.end)) / charts.made.length,
        frame: time(() => { for (let k = 0; k < 50; k++) clock.seek((clock.end * k) / 50); }) / 50,
      };
    });
    console.log(`  ${took.n} samples, ${took.points} points in a plot; zoom ${took.zoom.toFixed(1)} ms a plot, a step of the clock ${took.frame.toFixed(2)} ms`);
    assert.ok(took.n === 100_001 && took.points < 8000 && took.zoom < 100 && took.frame < 16);
    return page;
  },

  async 'motors, springs beside sliders, and the sides that show them'(browser) {
    const seen = async (name) => {
      const page = await open(browser, at(name));
      const found = await page.evaluate(() => {
        const { all: [{ form: { joints, coils, thick } }], camera, controls } = globalThis.gyroPage.picture;
        return { joints, coils, thick, from: camera.position.clone().sub(controls.target).normalize().toArray() };
      });
      await page.close();
      return found;
    };
    const cart = await seen('cart-pendulum');
    const [[, wall], [, slider]] = cart.coils[0].between;
    assert.ok(slider[0] - wall[0] > 14 * cart.thick, 'the coil is behind the slider');
    const { joints: [shoulder, elbow] } = await seen('arm');
    const drums = (parts) => parts.filter(({ side, type }) => side === 0 && type === 'rod').length;
    assert.deepEqual([drums(shoulder), drums(elbow)], [1, 0], 'motors');
    // The top leans towards -y at the start; the disc's shaft is along z.
    const [top, disc] = [(await seen('heavy-top')).from, (await seen('torsion')).from];
    assert.ok(Math.abs(top[1]) < 0.2 && Math.abs(disc[2]) < 0.8, `${top}; ${disc}`);
  },

  async 'pictures are like those of the gallery'(browser) {
    for (const [file, , part] of MODELS) {
      const name = nameOf(file);
      const kept = new URL(`${name}.webp`, gallery);
      assert.ok(existsSync(kept), `${name}.webp is missing: run npm run gallery`);
      const page = await open(browser, at(name));
      const end = await page.evaluate(() => globalThis.gyroPage.clock.end);
      const shot = await still(page, part * end, [480, 360], 'image/png');
      const other = `data:image/webp;base64,${readFileSync(kept).toString('base64')}`;
      const gap = await page.evaluate(async ([a, b]) => {
        const pixels = async (url) => {
          const image = new Image();
          image.src = url;
          await image.decode();
          const canvas = new OffscreenCanvas(120, 90);
          const context = canvas.getContext('2d');
          context.drawImage(image, 0, 0, 120, 90);
          return context.getImageData(0, 0, 120, 90).data;
        };
        const [x, y] = [await pixels(a), await pixels(b)];
        return x.reduce((sum, value, k) => sum + Math.abs(value - y[k]), 0) / x.length;
      }, [shot, other]);
      if (process.env.KEEP) writeFileSync(join(process.env.KEEP, `${name}.png`), Buffer.from(shot.split(',')[1], 'base64'));
      assert.ok(gap < ALIKE, `${name} differs by ${gap.toFixed(1)} of 255: look at it, then run npm run gallery`);
      assert.deepEqual(page.errors, [], name);
      await page.close();
    }
  },
};

await withChromium(async (browser) => {
  for (const [name, test] of Object.entries(tests)) {
    console.log(name);
    const page = await test(browser);
    if (page) {
      assert.deepEqual(page.errors, [], name);
      await page.close();
    }
  }
});

console.log('without WebGL there is a word, and the plots are there');
await withChromium(async (browser) => {
  const page = await open(browser, at('gyroscope'));
  assert.match(await page.locator('.word').textContent(), /no WebGL/);
  assert.ok(await page.locator('.u-over').count() > 2);
  await page.keyboard.press('End');
  assert.equal(await clockTime(page), 10);
  assert.deepEqual(page.errors, []);
}, { webgl: false });
console.log('all well');
