// A headless Chromium of the machine, with WebGL in software, and pages opened from disk.
import { chromium } from 'playwright-core';
import { existsSync, mkdtempSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { pathToFileURL } from 'node:url';

const PROGRAM = [process.env.CHROMIUM, '/usr/bin/chromium', '/usr/bin/chromium-browser', '/usr/bin/google-chrome']
  .find((path) => path && existsSync(path));
const QUIET = ['--no-sandbox', '--disable-gpu', '--disable-quic', '--no-first-run', '--disable-background-networking',
  '--disable-component-update', '--disable-sync'];
const SOFTWARE = ['--use-angle=swiftshader', '--enable-unsafe-swiftshader'];

export async function withChromium(work, { webgl = true } = {}) {
  if (!PROGRAM) throw new Error('no Chromium: install it (Debian: chromium), or set CHROMIUM to its path');
  const profile = mkdtempSync(join(tmpdir(), 'gyro-chromium-'));
  const browser = await chromium.launchPersistentContext(profile, {
    executablePath: PROGRAM,
    headless: true,
    args: [...QUIET, ...(webgl ? SOFTWARE : ['--disable-3d-apis'])],
    viewport: { width: 1280, height: 800 },
    offline: true,
  });
  try {
    return await work(browser);
  } finally {
    await browser.close();
    rmSync(profile, { recursive: true, force: true });
  }
}

// A page from disk, ready. Its errors are collected, and what the graphics driver has to say of its speed is not one.
export async function open(browser, path) {
  const page = await browser.newPage();
  page.errors = [];
  page.on('pageerror', (error) => page.errors.push(String(error)));
  page.on('console', (message) => {
    if (['error', 'warning'].includes(message.type()) && !message.text().includes('GPU stall due to ReadPixels')) {
      page.errors.push(message.text());
    }
  });
  page.on('request', (request) => {
    if (!/^(file|data|blob):/.test(request.url())) page.errors.push(`asked for ${request.url()}`);
  });
  await page.goto(pathToFileURL(path).href);
  await page.waitForFunction(() => document.body.dataset.ready, null, { timeout: 60000 });
  return page;
}

// The picture alone at a time, so many pixels wide and high, as a data URL.
export async function still(page, t, [width, height], type = 'image/webp', quality = 0.8) {
  await page.setViewportSize({ width, height });
  await page.evaluate(() => document.body.classList.add('still'));
  await page.waitForFunction(([wide, high]) => {
    const { clientWidth, clientHeight } = globalThis.gyroPage.picture.canvas;
    return clientWidth === wide && clientHeight === high;
  }, [width, height]);
  return page.evaluate(({ t, type, quality }) => {
    const { clock, picture } = globalThis.gyroPage;
    picture.home();
    clock.seek(t);
    picture.draw();
    return picture.canvas.toDataURL(type, quality);
  }, { t, type, quality });
}
