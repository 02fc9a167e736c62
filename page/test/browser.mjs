// A browser without a window, and what its pages look like.
import {existsSync} from 'node:fs';
import {createRequire} from 'node:module';
import {dirname, join, resolve} from 'node:path';
import {fileURLToPath, pathToFileURL} from 'node:url';

const here = dirname(fileURLToPath(import.meta.url));
const modules = resolve(process.env.TALUS_PAGE_MODULES ?? join(here, '../node_modules'));
const path_of_browser = process.env.CHROMIUM ?? '/usr/bin/chromium';

/** What is needed to look at pages and is not there; null if nothing. */
export function missing() {
  if (!existsSync(join(modules, 'playwright-core')))
    return `playwright-core is not in ${modules}: npm could not fetch the libraries of the page`;
  if (!existsSync(path_of_browser)) return `there is no ${path_of_browser}, and CHROMIUM names no other`;
  return null;
}

/** Debian's Chromium, drawing by software. */
export const launch = () =>
  createRequire(join(modules, 'here.js'))('playwright-core').chromium.launch({
    executablePath: path_of_browser,
    args: ['--no-sandbox', '--use-gl=angle', '--use-angle=swiftshader', '--enable-unsafe-swiftshader'],
  });

/** A page of its own, with what it complained about and what it asked of networks. */
export async function open(browser, address, {width = 1280, height = 800, scheme = 'light', before} = {}) {
  const context = await browser.newContext({viewport: {width, height}, colorScheme: scheme, reducedMotion: 'reduce'});
  const page = await context.newPage();
  const complaints = [],
    requests = [];
  page.on('console', (message) => ['error', 'warning'].includes(message.type()) && complaints.push(message.text()));
  page.on('pageerror', (error) => complaints.push(error.stack ?? error.message));
  page.on('request', (request) => /^(file|data|blob):/.test(request.url()) || requests.push(request.url()));
  if (before) await page.addInitScript(before);
  await page.goto(
    /^https?:/.test(address)
      ? address
      : pathToFileURL(resolve(address.split('#')[0])).href + (address.includes('#') ? `#${address.split('#')[1]}` : ''),
  );
  await page.waitForSelector('html[data-ready]', {timeout: 60000, state: 'attached'});
  return {page, complaints, requests, close: () => context.close()};
}

/** Pixels of an element as it stands on the screen: {width, height, data: RGBA}. */
export async function pixels(page, selector) {
  const picture = await page.locator(selector).screenshot();
  const {width, height, text} = await page.evaluate(async (base64) => {
    const bytes = Uint8Array.from(atob(base64), (c) => c.charCodeAt(0));
    const bitmap = await createImageBitmap(new Blob([bytes], {type: 'image/png'}));
    const context = new OffscreenCanvas(bitmap.width, bitmap.height).getContext('2d');
    context.drawImage(bitmap, 0, 0);
    const {data} = context.getImageData(0, 0, bitmap.width, bitmap.height);
    let letters = '';
    for (let i = 0; i < data.length; i += 8192) letters += String.fromCharCode(...data.subarray(i, i + 8192));
    return {width: bitmap.width, height: bitmap.height, text: btoa(letters)};
  }, picture.toString('base64'));
  return {width, height, data: Buffer.from(text, 'base64')};
}
