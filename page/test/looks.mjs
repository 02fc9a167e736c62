// What tests of the page do with it, and what they see of it.
import assert from 'node:assert/strict';
import {MAPS} from '../src/colours.js';

export const VIEW = '#canvas';
export const settle = (page) =>
  page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(() => setTimeout(done, 60)))));
export const text_of = (page, selector) => page.locator(selector).textContent();

/** Waits until what is read from the page is as it should be. */
export async function eventually(page, read, is_right, words) {
  for (let tries = 0; tries < 80; ++tries) {
    const value = await read();
    if (is_right(value)) return value;
    await page.waitForTimeout(50);
  }
  return assert.fail(`${words}: ${JSON.stringify(await read())}`);
}

export const set = async (page, name, value) => {
  const input = page.locator(`#controls [name="${name}"]`);
  if ((await input.evaluate((element) => element.tagName)) === 'SELECT') await input.selectOption(value);
  else {
    await input.fill(String(value));
    await input.dispatchEvent('change');
    await input.blur(); // what is being typed is not written over
  }
};

/** What stands over the canvas is out of the way of looking at pixels. */
export const bare = (page) =>
  page.evaluate(() =>
    ['legend', 'gauge', 'views', 'particle'].forEach((id) => {
      document.getElementById(id).style.visibility = 'hidden';
    }),
  );

/** Pixels that have a colour, unlike background and mesh: [x, y, r, g, b]. */
export function coloured({width, data}) {
  const found = [];
  for (let i = 0; i < data.length; i += 4) {
    const [r, g, b] = [data[i], data[i + 1], data[i + 2]];
    if (Math.max(r, g, b) - Math.min(r, g, b) > 30) found.push([(i / 4) % width, Math.floor(i / 4 / width), r, g, b]);
  }
  return found;
}

/** Share of pixels within a few steps of a colour of the map, at the light that a disk has. */
export function share_of_map(found, map) {
  const table = [];
  for (let i = 0; i < MAPS[map].length - 1; ++i)
    for (let t = 0; t < 1; t += 0.1) table.push(MAPS[map][i].map((low, c) => low + t * (MAPS[map][i + 1][c] - low)));
  const fits = ([, , r, g, b]) =>
    table.some((colour) =>
      [1, 0.93, 0.86, 0.79, 0.72].some(
        (light) => Math.abs(colour[0] * light - r) + Math.abs(colour[1] * light - g) + Math.abs(colour[2] * light - b) < 24,
      ),
    );

  const sample = found.filter((_, k) => k % Math.ceil(found.length / 1500) === 0);
  return sample.filter(fits).length / sample.length;
}

export const ends = (found, axis) =>
  found.reduce(([least, most], pixel) => [Math.min(least, pixel[axis]), Math.max(most, pixel[axis])], [Infinity, -Infinity]);
