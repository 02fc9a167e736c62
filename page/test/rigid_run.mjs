// Rigid bodies in the page: where they are, how they have turned, what they hide, and their names.
import assert from 'node:assert/strict';
import {RIGID} from '../src/colours.js';
import {open, pixels} from './browser.mjs';
import {VIEW, bare, coloured, ends, eventually, set, settle, text_of} from './looks.mjs';

/** Pixels of the colour of rigid bodies at a brightness between two: [x, y]. */
function grey({width, data}, [darkest, brightest]) {
  const found = [];
  for (let i = 0; i < data.length; i += 4) {
    const light = data[i + 2] / RIGID[2];
    if (light > darkest && light < brightest && RIGID.every((channel, k) => Math.abs(data[i + k] - channel * light) < 2.5))
      found.push([(i / 4) % width, Math.floor(i / 4 / width)]);
  }
  return found;
}

const extent = (found) => [0, 1].map((axis) => ends(found, axis)).map(([least, most]) => most - least + 1);
const middle = (found) => [0, 1].map((axis) => ends(found, axis)).map(([least, most]) => (least + most) / 2);

async function go_to(page, key) {
  await page.locator('#time input').focus();
  await page.keyboard.press(key);
  await page.evaluate(() => document.activeElement.blur());
  await settle(page);
}

async function click_at(page, [x, y]) {
  const box = await page.locator(VIEW).boundingBox();
  await page.mouse.click(box.x + x, box.y + y);
}

/** A square that moves and turns by 45 degrees. */
export async function test_plane_rigid(browser, file, {run}) {
  const {page, complaints, requests, close} = await open(browser, file);
  await bare(page);
  const look = async () => grey(await pixels(page, VIEW), [0.97, 1.03]);
  const last = await look();
  await go_to(page, 'Home');
  const first = await look();
  const {low, high, name} = run.rigid[0];
  const [wide, tall] = extent(first);
  assert.ok(first.length > 0.9 * wide * tall, `a square is filled: ${first.length} of ${wide} x ${tall} pixels`);
  assert.ok(Math.abs(wide - tall) < 3, 'as wide as high');
  const scale = wide / (high[0] - low[0]); // pixels a metre
  const moved = middle(last).map((at, axis) => (at - middle(first)[axis]) / scale);
  assert.ok(Math.abs(moved[0] + 2.5) < 0.06 && Math.abs(moved[1] + 0.5) < 0.03, `it has moved by -2.5 m and up by 0.5 m: ${moved}`);
  for (const now of extent(last)) assert.ok(Math.abs(now / wide - Math.SQRT2) < 0.05, `turned by 45 degrees it is wider: ${now}, ${wide}`);

  const own = await open(browser, `${file}#frame=0&field=body`);
  assert.match(await text_of(own.page, '#legend'), new RegExp(`${name} rigid`));
  await own.close();
  await click_at(page, middle(first));
  await eventually(
    page,
    () => text_of(page, '#particle'),
    (words) => words === `×${name}, rigid body`,
    'a click tells its name',
  );
  await set(page, 'section', 'x');
  await set(page, 'at', (low[0] + high[0]) / 2);
  await settle(page);
  assert.ok(Math.abs((await look()).length / first.length - 0.5) < 0.03, 'a section cuts it');
  await set(page, 'section', 'none');
  await page.locator('[name="rigid"]').uncheck();
  await settle(page);
  assert.equal((await look()).length, 0, 'it can be hidden');
  assert.match(await page.evaluate(() => location.hash), /rigid=no/);
  assert.deepEqual([complaints, requests, own.complaints], [[], [], []]);
  await close();
}

/** A cube over particles: sides of different brightness, and particles behind it are hidden from the pointer as well. */
export async function test_solid_rigid(browser, file, {run}) {
  const {page, complaints, requests, close} = await open(browser, file);
  await bare(page);
  const sides = [0.4, 1.02];
  const oblique = grey(await pixels(page, VIEW), sides);
  assert.ok(oblique.length > 1000, `it is drawn: ${oblique.length} pixels`);
  await page.keyboard.press('2');
  await go_to(page, 'Home');
  await page.keyboard.press('o');
  await settle(page);
  const first = grey(await pixels(page, VIEW), sides);
  await go_to(page, 'End');
  const last = grey(await pixels(page, VIEW), sides);
  const [wide, tall] = extent(first);
  assert.ok(Math.abs(wide - tall) < 4, `a cube from the front is a square: ${wide} x ${tall}`);
  for (const now of extent(last)) assert.ok(Math.abs(now / wide - Math.SQRT2) < 0.08, `turned by 45 degrees it is wider: ${now}, ${wide}`);
  const moved = middle(last).map((at, axis) => (at - middle(first)[axis]) / wide);
  assert.ok(Math.abs(moved[0] + 4) < 0.1 && Math.abs(moved[1] + 1) < 0.05, `it has moved by four times its width, and up: ${moved}`);

  await page.keyboard.press('4');
  await settle(page);
  const above = await pixels(page, VIEW);
  const roof = grey(above, sides);
  await click_at(page, middle(roof));
  await eventually(
    page,
    () => text_of(page, '#particle'),
    (words) => words === `×${run.rigid[0].name}, rigid body`,
    'a click tells its name, not that of a particle under it',
  );
  const particles = coloured(above).length;
  await page.locator('[name="rigid"]').uncheck();
  await settle(page);
  assert.ok(coloured(await pixels(page, VIEW)).length > particles + 100, 'it had hidden particles under it');
  assert.deepEqual([complaints, requests], [[], []]);
  await close();
}
