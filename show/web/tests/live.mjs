// Pages of `gyro show --live` in headless Chromium: a mechanism that is computed in the page gives, at all times, the bits
// of the C program of the same mechanism on this machine; sliders change the run from the time that is shown on.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { mkdirSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { open, withChromium } from './chromium.mjs';
import { LIVE, ROOT, nameOf } from './models.mjs';

const folder = process.argv[2];
if (!folder) throw new Error('usage: node tests/live.mjs FOLDER');

const ready = (page) => page.waitForFunction(() => globalThis.gyroPage.live?.isReady && !globalThis.gyroPage.live.waiting, null, { timeout: 60000 });
const hex = (numbers) => [...new BigUint64Array(Float64Array.from(numbers).buffer)].map((bits) => bits.toString(16).padStart(16, '0'));

// Reads times, and writes the bits of the joint state at each: as the page's solver goes, from the start to the last.
const program = (name) => `#include "${name}.h"
#include <inttypes.h>
#include <stdio.h>
#include <string.h>
int main(void)
{
    static ${name} m;
    static ${name}_solver s;
    static double times[100000], x[${name.toUpperCase()}_N_JOINTS];
    ${name}_control control = ${name}_default_control(1e-9);
    size_t n = fread(times, sizeof *times, 100000, stdin);
    ${name}_init(&m);
    ${name}_joint_start(&m, x);
    ${name}_solver_init(&s, ${name.toUpperCase()}_DOP853, times[0], x);
    ${name}_solver_set_control(&s, &control);
    ${name}_solver_correct(&s, &m);
    for (size_t k = 0; k < n; k++) {
        while (s.t < times[k])
            if (${name}_solver_step_towards(&s, &m, times[n - 1]) != ${name.toUpperCase()}_OK)
                return 1;
        ${name}_solver_interpolate(&s, &m, times[k], x);
        for (int i = 0; i < ${name.toUpperCase()}_N_JOINTS; i++) {
            uint64_t bits;
            memcpy(&bits, &x[i], sizeof bits);
            printf("%016" PRIx64 "\\n", bits);
        }
    }
    return 0;
}
`;

function onTheDesk(file, times) {
  const name = nameOf(file).replaceAll('-', '_');
  const place = join(folder, name);
  mkdirSync(place, { recursive: true });
  execFileSync('cargo', ['xtask', 'export', 'c', file, '--count-work', '--out', place], { cwd: ROOT, stdio: ['ignore', 'ignore', 'ignore'] });
  writeFileSync(join(place, 'main.c'), program(name));
  execFileSync(process.env.CC ?? 'cc', ['-std=c99', '-O2', '-ffp-contract=off', 'main.c', `${name}.c`, '-lm', '-o', 'main'], { cwd: place });
  const out = execFileSync(join(place, 'main'), { input: Buffer.from(Float64Array.from(times).buffer), maxBuffer: 1 << 28 });
  return out.toString().trim().split('\n');
}

await withChromium(async (browser) => {
  for (const [file] of LIVE) {
    const page = await open(browser, join(folder, `live-${nameOf(file)}.html`));
    await ready(page);
    const { times, states } = await page.evaluate(() => {
      const { live } = globalThis.gyroPage;
      return { times: [...live.scene.time], states: [...live.states] };
    });
    const desk = onTheDesk(file, times);
    assert.ok(states.length > 400 && states.every(Number.isFinite), `${file}: ${states.length} numbers`);
    assert.deepEqual(hex(states), desk, `${file}: other bits than on the desk`);
    const empty = await page.evaluate(() => globalThis.gyroPage.scenes[0].columns.filter(({ values }) => !values.every(Number.isFinite)).map(({ title }) => title));
    assert.deepEqual(empty, [], `${file}: curves with gaps`);
    assert.deepEqual(page.errors, []);
    await page.close();
    console.log(`${file}: the bits of the desk, ${states.length} numbers at ${times.length} times`);
  }

  console.log('a slider changes the run from the time that is shown on, and the drawing');
  const page = await open(browser, join(folder, 'live-pendulum.html'));
  await ready(page);
  const curve = () => page.evaluate(() => [...globalThis.gyroPage.scenes[0].columns[0].values]);
  const shot = () => page.evaluate(() => { globalThis.gyroPage.picture.draw(); return globalThis.gyroPage.picture.canvas.toDataURL(); });
  const [before, picture] = [await curve(), await shot()];
  await page.evaluate(() => { const { clock } = globalThis.gyroPage; clock.seek(clock.end / 2); });
  await page.locator('.live input[type=range]').fill('0.25');
  await ready(page);
  const after = await curve();
  const first = before.findIndex((x, k) => x !== after[k]);
  assert.ok(Math.abs(first - before.length / 2) < 3, `the first change is at ${first} of ${before.length}`);
  assert.equal(await page.evaluate(() => globalThis.gyroPage.live.mechanism.parameters.length), 0.25);
  const hinge = await page.evaluate(() => globalThis.gyroPage.scenes[0].mechanism.joints[0].ends[1].point[1]);
  assert.ok(Math.abs(hinge - 0.25) < 1e-12, `the hinge is drawn at ${hinge}`);
  await page.locator('.live input[type=number]').fill('-0.3');
  await page.keyboard.press('Enter');
  await ready(page);
  assert.equal(await page.evaluate(() => globalThis.gyroPage.live.mechanism.parameters.length), -0.3);
  await page.getByText('reset').click();
  await ready(page);
  assert.deepEqual([await curve(), await shot()], [before, picture]);

  console.log('a run that fails says where and when, and the page goes on');
  const cart = await open(browser, join(folder, 'live-cart-pendulum.html'));
  await ready(cart);
  await cart.locator('.live input[type=number]').fill('1e300');
  await cart.keyboard.press('Enter');
  await cart.waitForFunction(() => globalThis.gyroPage.live.failure);
  await ready(cart);
  assert.match(await cart.locator('.live p').textContent(), / at \d.* s/);
  await cart.getByText('reset').click();
  await ready(cart);
  assert.equal(await cart.evaluate(() => globalThis.gyroPage.live.failure), null);
  assert.ok(await cart.evaluate(() => globalThis.gyroPage.scenes[0].columns[0].values.every(Number.isFinite)));

  console.log('a run that turns out stiff goes on by the implicit method');
  const stiff = await open(browser, join(folder, 'live-gyroscope-stiff.html'));
  await ready(stiff);
  const { method, failure } = await stiff.evaluate(() => ({ ...globalThis.gyroPage.live, failure: String(globalThis.gyroPage.live.failure) }));
  assert.deepEqual([method, failure], ['rodas4', 'null']);

  console.log('what the page computes without is said in it');
  const thrown = await open(browser, join(folder, 'live-thrown.html'));
  await ready(thrown);
  assert.ok(await thrown.getByRole('note').isVisible());
  assert.match(await thrown.getByRole('note').textContent(), /without event `apex`/);
  for (const each of [page, cart, stiff, thrown]) {
    assert.deepEqual(each.errors, []);
    await each.close();
  }
});
console.log('all well');
