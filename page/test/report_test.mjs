// The page in a browser: what a reader does, and what is then to be seen.
// Usage: node report_test.mjs --template FILE     made-up runs in this template, everything that can be checked against them
//        node report_test.mjs REPORT              a report of talus: that it opens, draws, moves and asks nothing of the network
import assert from 'node:assert/strict';
import {existsSync, mkdtempSync, readFileSync, rmSync, writeFileSync} from 'node:fs';
import {createServer} from 'node:http';
import {tmpdir} from 'node:os';
import {join} from 'node:path';
import {MAPS} from '../src/colours.js';
import {decode, value_of} from '../src/decode.js';
import {launch, missing, open, pixels} from './browser.mjs';
import {SAMPLES, fill} from './sample.mjs';

const VIEW = '#canvas';
const settle = (page) =>
  page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(() => setTimeout(done, 60)))));
const text_of = (page, selector) => page.locator(selector).textContent();

/** Waits until what is read from the page is as it should be. */
async function eventually(page, read, is_right, words) {
  for (let tries = 0; tries < 80; ++tries) {
    const value = await read();
    if (is_right(value)) return value;
    await page.waitForTimeout(50);
  }
  return assert.fail(`${words}: ${JSON.stringify(await read())}`);
}

const set = async (page, name, value) => {
  const input = page.locator(`#controls [name="${name}"]`);
  if ((await input.evaluate((element) => element.tagName)) === 'SELECT') await input.selectOption(value);
  else {
    await input.fill(String(value));
    await input.dispatchEvent('change');
    await input.blur(); // what is being typed is not written over
  }
};

/** What stands over the canvas is out of the way of looking at pixels. */
const bare = (page) =>
  page.evaluate(() =>
    ['legend', 'gauge', 'views', 'particle'].forEach((id) => {
      document.getElementById(id).style.visibility = 'hidden';
    }),
  );

/** Pixels that have a colour, unlike background and mesh: [x, y, r, g, b]. */
function coloured({width, data}) {
  const found = [];
  for (let i = 0; i < data.length; i += 4) {
    const [r, g, b] = [data[i], data[i + 1], data[i + 2]];
    if (Math.max(r, g, b) - Math.min(r, g, b) > 30) found.push([(i / 4) % width, Math.floor(i / 4 / width), r, g, b]);
  }
  return found;
}

/** Share of pixels within a few steps of a colour of the map, at the light that a disk has. */
function share_of_map(found, map) {
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

const ends = (found, axis) =>
  found.reduce(([least, most], pixel) => [Math.min(least, pixel[axis]), Math.max(most, pixel[axis])], [Infinity, -Infinity]);

/** Time, colours, section, limits, a particle, histories: a plane run whose every number is known. */
async function test_plane_run(browser, file, {run, texts}) {
  const {page, complaints, requests, close} = await open(browser, file);
  const numbers = (block) => decode(texts[block.id], block);
  const {frames, fields} = run.particles;
  assert.equal(await text_of(page, '#title'), run.title);
  assert.match(await text_of(page, '#facts'), /done.*2-D.*projected.*0123456789ab/s);
  await bare(page);
  const last = coloured(await pixels(page, VIEW));
  assert.ok(last.length > 3000, `the picture is not empty: ${last.length} pixels have a colour`);
  assert.ok(share_of_map(last, 'viridis') > 0.95, 'colours are those of the map');
  assert.ok(share_of_map(last, 'cividis') < 0.7, 'and of no other');

  // time: slider and keys
  await page.locator('#time input').focus();
  await page.keyboard.press('Home');
  await eventually(
    page,
    () => text_of(page, '#time output'),
    (words) => words === '0 s',
    'the slider goes to the first frame',
  );
  await settle(page);
  const first = coloured(await pixels(page, VIEW));
  assert.ok(ends(first, 1)[0] < ends(last, 1)[0] - 20, 'the column stands higher at the start');
  assert.ok(ends(first, 0)[1] < ends(last, 0)[1] - 20, 'and reaches less far');
  assert.match(await page.evaluate(() => location.hash), /frame=0/);
  await page.locator(VIEW).focus();
  await page.keyboard.press('.');
  await eventually(
    page,
    () => text_of(page, '#time output'),
    (words) => words === '0.1667 s',
    'a key goes one frame on',
  );
  await page.keyboard.press(' ');
  await eventually(
    page,
    () => text_of(page, '#time output'),
    (words) => parseFloat(words) >= 0.5,
    'the space bar plays',
  );
  await page.keyboard.press(' ');
  await page.evaluate(() => document.activeElement.blur());
  await page.keyboard.press('End');
  await eventually(
    page,
    () => text_of(page, '#time output'),
    (words) => words === '2 s',
    'End goes to the last frame',
  );

  // colours: map, field, range, body
  await set(page, 'map', 'cividis');
  await settle(page);
  assert.ok(share_of_map(coloured(await pixels(page, VIEW)), 'cividis') > 0.95, 'another map, other colours');
  await set(page, 'map', 'viridis');
  await set(page, 'field', 'plastic_strain');
  await eventually(
    page,
    () => text_of(page, '#legend'),
    (words) => /plastic strain/.test(words),
    'the legend names the field',
  );
  await set(page, 'from', -2);
  await set(page, 'to', -1);
  await settle(page);
  const top = coloured(await pixels(page, VIEW));
  assert.ok(
    top.filter(([, , r, g, b]) => r > 170 && g > 155 && b < 60).length > 0.98 * top.length,
    'above the range everything has the last colour',
  );
  await set(page, 'range', 'frame');
  const strains = await numbers(frames.at(-1).fields[1]);
  const most = value_of(Math.max(...strains), fields[1].low, fields[1].high);
  assert.ok(
    Math.abs((await page.locator('[name="to"]').inputValue()) - most) < 1e-3 * most,
    'the range of this frame ends at its largest value',
  );
  await set(page, 'field', 'body');
  await eventually(
    page,
    () => text_of(page, '#legend'),
    (words) => /upper half/.test(words),
    'the legend names the bodies',
  );

  // section and limits: as many particles as there are
  await set(page, 'field', 'displacement');
  await set(page, 'section', 'x');
  await set(page, 'at', 1);
  const frame = frames.at(-1);
  const x = Array.from(await numbers(frame.x), (step) => value_of(step, frame.low[0], frame.high[0]));
  const moved = Array.from(await numbers(frame.fields[0]), (step) => value_of(step, fields[0].low, fields[0].high));
  const said = (words) => Number(words.split(' of ')[0].replace(/\D/g, ''));
  const before = x.filter((v) => v <= 1).length;
  await eventually(
    page,
    () => text_of(page, '#shown'),
    (words) => Math.abs(said(words) - before) <= 2,
    `a section leaves ${before} particles`,
  );
  await settle(page);
  const cut = coloured(await pixels(page, VIEW));
  assert.ok(
    ends(cut, 0)[1] < ends(last, 0)[1] - 100 && ends(cut, 0)[0] < ends(last, 0)[0] + 4,
    'what lies beyond the section is gone, what lies before it is not',
  );
  await page.locator('[name="flip"]').check();
  await settle(page);
  assert.ok(ends(coloured(await pixels(page, VIEW)), 0)[0] > ends(cut, 0)[1] - 6, 'flipped, it is the other side');
  await set(page, 'section', 'none');
  await set(page, 'only', 'displacement');
  await set(page, 'lowest', 1);
  const far = moved.filter((v) => v >= 1).length;
  await eventually(
    page,
    () => text_of(page, '#shown'),
    (words) => Math.abs(said(words) - far) <= 2,
    `a limit leaves ${far} particles`,
  );
  await settle(page);
  const limited = coloured(await pixels(page, VIEW));
  assert.ok(limited.length > 100 && limited.length < 0.9 * last.length, 'fewer of them are in the picture');
  await set(page, 'only', '');

  // a particle
  await settle(page);
  const [px, py] = last[Math.floor(last.length / 2)];
  const box = await page.locator(VIEW).boundingBox();
  await page.mouse.click(box.x + px, box.y + py);
  const words = await eventually(
    page,
    () => text_of(page, '#particle'),
    (found) => /particle/.test(found),
    'a click tells about a particle',
  );
  const id = Number(/particle\s*([\d\u202f]+)/.exec(words)[1].replace(/\D/g, ''));
  const p = (await numbers(frame.id)).indexOf(id);
  assert.ok(words.includes(`x${String(+x[p].toPrecision(4))}`), `its place is told: ${words}`);
  assert.ok(words.includes(`displacement${String(+moved[p].toPrecision(4))}`), `and its values: ${words}`);
  const right = Math.max(...last.filter(([, y]) => Math.abs(y - py) < 3).map(([its]) => its)),
    left = ends(last, 0)[0];
  const widest = Math.max(...x);
  assert.ok(
    Math.abs(x[p] - ((px - left) / (ends(last, 0)[1] - left)) * widest) < 0.1,
    `it is the one under the pointer, ${px} of ${left} to ${right}`,
  );

  // histories: what is drawn, a click that goes to a time, zoom
  const plots = '#histories-body .plot';
  assert.ok((await page.locator(plots).count()) >= 3, 'energies, fronts and the crest are drawn at first');
  const whole = await pixels(page, `${plots} >> nth=0`);
  assert.ok(coloured(whole).length > 300, 'there are curves');
  await page.locator('[name="column-gravity_work"]').uncheck();
  await settle(page);
  assert.notDeepEqual((await pixels(page, `${plots} >> nth=0`)).data, whole.data, 'a column that is not ticked is not drawn');
  assert.match(decodeURIComponent(await page.evaluate(() => location.hash)), /^(?!.*gravity_work).*plots=energies=kinetic/);
  const over = page.locator(`${plots} >> nth=0 >> .u-over`);
  const size = await over.boundingBox();
  await over.click({position: {x: size.width / 4, y: size.height / 2}});
  await eventually(
    page,
    () => text_of(page, '#time output'),
    (time) => time === '0.5 s',
    'a click in a plot goes to the frame of that time',
  );
  const wide = await pixels(page, `${plots} >> nth=1`);
  await page.locator('#zoom-in').click();
  await settle(page);
  assert.notDeepEqual((await pixels(page, `${plots} >> nth=1`)).data, wide.data, 'all plots are zoomed');
  await page.locator('#zoom-all').click();

  // balances, run-out, scene
  const balances = await text_of(page, '#balances-body');
  assert.match(balances, /Mass closes exactly/);
  assert.match(balances, /Angular momentum does not close: 8 %/);
  assert.match(balances, /Most of it is plastic dissipation/);
  assert.ok(coloured(await pixels(page, '#balances-body .plot')).length > 5000, 'energies are drawn on one another');
  const blue = coloured(await pixels(page, '#runout-body .plot')).filter(([, , r, g, b]) => b > r + 30); // the first curve, not the red line of the time
  assert.ok(blue.length > 100, `a curve that begins late does not take the others away: ${blue.length} pixels`);
  assert.match(await text_of(page, '#runout-body'), /run-out of the toe\s*2\.18\sm/);
  assert.match(await text_of(page, '#cost-body'), /5 min 13 s[\s\S]*3\.4 million particle-steps/);
  await page.locator('#overview-body a[href="#L22"]').click();
  assert.ok(await page.locator('#L22.chosen').isVisible());
  assert.match(await page.locator('#L22').innerText(), /roller[\s\S]*slides over its foot/);

  // the address brings it all back
  await set(page, 'section', 'y');
  await set(page, 'at', 0.5);
  await page.evaluate(() => document.activeElement.blur());
  await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
  await page.mouse.wheel(0, -300);
  await page.waitForTimeout(600);
  await page.mouse.move(2, 2);
  const hash = await page.evaluate(() => location.hash);
  const seen = await pixels(page, VIEW);
  const again = await open(browser, `${file}${hash}`);
  await bare(again.page);
  await settle(again.page);
  assert.equal(await text_of(again.page, '#time output'), '0.5 s', hash);
  assert.equal(await again.page.locator('[name="section"]').inputValue(), 'y');
  assert.equal(await again.page.locator('[name="column-gravity_work"]').isChecked(), false);
  const restored = await pixels(again.page, VIEW);
  let off = 0;
  for (let i = 0; i < seen.data.length; i += 4) off += Math.abs(seen.data[i] - restored.data[i]) > 16;
  assert.ok(off < 0.002 * (seen.data.length / 4), `the same picture: ${off} pixels differ`);
  await again.close();

  // nothing was asked of any network, and nothing may be
  const refused = await page.evaluate(
    () =>
      new Promise((tell) => {
        addEventListener('securitypolicyviolation', (event) => tell(event.effectiveDirective));
        fetch('http://127.0.0.1:9/').catch(() => {});
        setTimeout(() => tell('nothing'), 2000);
      }),
  );
  assert.equal(refused, 'connect-src');
  assert.deepEqual([...requests, ...again.requests], []);
  assert.deepEqual(
    [...complaints, ...again.complaints].filter((line) => !/127\.0\.0\.1:9|Content Security Policy/.test(line)),
    [],
  );
  await close();
}

/** Views, section along the line of sight, keys of the canvas, by Tab to everything, phone. */
async function test_solid_run(browser, file) {
  const {page, complaints, requests, close} = await open(browser, file, {scheme: 'dark'});
  await bare(page);
  const picture = async () => {
    await page.evaluate(() => document.activeElement.blur()); // the ring of what is chosen has a colour, too
    await settle(page);
    return coloured(await pixels(page, VIEW));
  };
  const oblique = await picture();
  assert.ok(oblique.length > 3000);
  await page.keyboard.press('4');
  const from_above = await picture();
  await page.keyboard.press('2');
  const in_front = await picture();
  const height = (found) => ends(found, 1)[1] - ends(found, 1)[0],
    width = (found) => ends(found, 0)[1] - ends(found, 0)[0];
  assert.ok(
    height(in_front) / width(in_front) > 1.1 * (height(from_above) / width(from_above)),
    'the block is higher in front than from above',
  );
  const [px, py] = in_front[Math.floor(in_front.length / 2)];
  const box = await page.locator(VIEW).boundingBox();
  await page.mouse.click(box.x + px, box.y + py);
  const words = await eventually(
    page,
    () => text_of(page, '#particle'),
    (found) => /particle/.test(found),
    'a click tells about a particle',
  );
  const depth = Number(/y([\d.]+)\sm/.exec(words)[1]);
  assert.ok(depth < 0.2, `of those behind one another it is the one in front: ${words}`);
  await page.locator('#particle .close').evaluate((button) => button.click());
  await page.keyboard.press('o');
  const parallel = await picture();
  assert.ok(await page.locator('[name="orthographic"]').isChecked());
  assert.notEqual(parallel.length, in_front.length);
  await set(page, 'section', 'view');
  await eventually(
    page,
    () => text_of(page, '#shown'),
    (words) => / of /.test(words),
    'a section across the line of sight',
  );
  await set(page, 'section', 'none');
  await page.locator(VIEW).focus();
  for (let k = 0; k < 5; ++k) await page.keyboard.press('ArrowLeft');
  const before = width(parallel);
  await eventually(page, async () => width(await picture()), (now) => Math.abs(now - before) > 5, `arrows turn, ${before} pixels before`);

  await page.evaluate(() => {
    document.getElementById('views').style.visibility = '';
  });
  await page.locator('.skip').focus();
  const reached = new Set();
  for (let k = 0; k < 45; ++k) {
    await page.keyboard.press('Tab');
    reached.add(
      await page.evaluate(
        () =>
          document.activeElement.name ||
          document.activeElement.id ||
          document.activeElement.getAttribute('aria-label') ||
          document.activeElement.textContent,
      ),
    );
  }
  for (const name of ['canvas', 'help-button', 'Frame', 'Play', 'field', 'section', 'only', 'orthographic', 'Save PNG', 'Histories'])
    assert.ok(reached.has(name), `Tab reaches ${name}; it reached ${[...reached].join(', ')}`);
  await page.keyboard.press('?');
  assert.ok(await page.locator('#help').isVisible());
  await page.keyboard.press('Escape');
  assert.ok(!(await page.locator('#help').isVisible()));
  const [download] = await Promise.all([page.waitForEvent('download'), page.getByRole('button', {name: 'Save PNG'}).click()]);
  assert.equal(download.suggestedFilename(), 'block_velocity_0008.png');
  assert.equal(
    readFileSync(await download.path())
      .subarray(1, 4)
      .toString(),
    'PNG',
  );

  await page.setViewportSize({width: 360, height: 720});
  await settle(page);
  const layout = await page.evaluate(() => [
    document.documentElement.scrollWidth,
    document.getElementById('viewer').getBoundingClientRect().bottom,
    document.getElementById('panels').getBoundingClientRect().top,
  ]);
  assert.ok(layout[0] <= 360, `no scrolling sideways on a phone: ${layout[0]}`);
  assert.ok(layout[1] <= layout[2] + 1, 'the picture stands above the numbers');
  assert.ok((await picture()).length > 300);
  const buttons = await page.locator('#time button, #time input, #views button').evaluateAll((all) => all.map((one) => one.getBoundingClientRect()));
  assert.ok(
    buttons.every(({left, right}) => left >= 0 && right <= 360),
    'every button can be reached',
  );
  assert.deepEqual([complaints, requests], [[], []]);
  await close();
}

/** The ground of a mesh of terrain: shaded, cut with the particles, hidden on demand. */
async function test_ground(browser, file) {
  const {page, complaints, requests, close} = await open(browser, file);
  await bare(page);
  const count = async () => {
    await settle(page);
    const {data} = await pixels(page, VIEW);
    let rock = 0,
      particles = 0;
    for (let i = 0; i < data.length; i += 4) {
      const [r, g, b] = [data[i], data[i + 1], data[i + 2]];
      if (r >= g && g > b && r - b >= 8 && r - b <= 40 && r < 240) ++rock;
      if (Math.max(r, g, b) - Math.min(r, g, b) > 60) ++particles;
    }
    return {rock, particles};
  };
  const whole = await count();
  assert.ok(whole.rock > 10000, `the ground is drawn: ${whole.rock} pixels`);
  assert.ok(whole.particles > 1000, 'and particles on it');
  await set(page, 'section', 'x');
  await set(page, 'at', 6);
  const cut = await count();
  assert.ok(cut.rock < 0.75 * whole.rock, `a section cuts it, too: ${cut.rock} of ${whole.rock} pixels`);
  await set(page, 'section', 'none');
  await page.locator('[name="ground"]').uncheck();
  const without = await count();
  assert.ok(without.rock < 0.02 * whole.rock, `and it can be hidden: ${without.rock} pixels are left`);
  assert.ok(whole.particles > 0.95 * without.particles, 'it hid nothing that lies on it');
  assert.match(await page.evaluate(() => location.hash), /ground=no/);
  assert.deepEqual([complaints, requests], [[], []]);
  await close();
}

/** Where drawing takes long (software, a large run) the numbers do not wait for it. */
async function test_numbers_first(browser, file) {
  const {page, close} = await open(browser, file, {
    before: () => {
      const get = HTMLCanvasElement.prototype.getContext;
      HTMLCanvasElement.prototype.getContext = function (kind, ...rest) {
        if (/webgl/.test(kind) && window.plots_before_the_picture === undefined)
          window.plots_before_the_picture = ['histories', 'balances', 'runout'].map(
            (part) => document.querySelectorAll(`#${part} .plot canvas`).length,
          );
        return get.call(this, kind, ...rest);
      };
    },
  });
  const [histories, balances, runout] = await page.evaluate(() => window.plots_before_the_picture);
  assert.ok(histories >= 3 && balances >= 1 && runout >= 1, `plots before the picture: ${[histories, balances, runout]}`);
  await close();
}

/** Nothing to show is said in words; what cannot be read is, too. */
async function test_words(browser, at, template) {
  const look = async (file, selector, pattern, options) => {
    const {page, complaints, close} = await open(browser, file, options);
    assert.match(await page.locator(selector).innerText(), pattern);
    assert.deepEqual(complaints, []);
    await close();
  };
  await look(at('failed'), 'body', /Fails <\/script> at once[\s\S]*failed[\s\S]*particle 7 turned inside out line 15/);
  await look(
    at('bare'),
    'body',
    /going on[\s\S]*wrote neither particles nor a mesh[\s\S]*No history was asked for[\s\S]*The balances are drawn up when the run ends/,
  );
  const without = () => {
    const get = HTMLCanvasElement.prototype.getContext;
    HTMLCanvasElement.prototype.getContext = function (kind, ...rest) {
      return /webgl/.test(kind) ? null : get.call(this, kind, ...rest);
    };
  };
  const {page, close} = await open(browser, at('column'), {before: without});
  assert.match(await text_of(page, '#stage'), /does not offer WebGL 2/);
  assert.ok((await page.locator('#histories-body .plot').count()) >= 3, 'the rest works without');
  await close();
  const {run} = SAMPLES.bare();
  writeFileSync(at('later'), fill(template, {...run, format: 2}, []));
  await look(at('later'), '#page', /format 2; the page reads format 1/);
  await look(`${at('column')}#L12`, '.line.chosen', /drucker_prager/);
}

/** talus watch: a new stamp renews the page, which goes on showing the same. */
async function test_live(browser, template) {
  const {run, texts} = SAMPLES.column(500);
  let stamp = 'one',
    title = 'first';
  const server = createServer((request, response) => {
    if (request.url === '/stamp') response.end(stamp);
    else response.setHeader('content-type', 'text/html').end(fill(template, {...run, title, live: {interval: 0.15}, summary: null}, texts));
  });
  await new Promise((done) => server.listen(0, '127.0.0.1', done));
  const {page, complaints, close} = await open(browser, `http://127.0.0.1:${server.address().port}/`);
  assert.equal(await page.locator('#live').isVisible(), true);
  await page.locator('#time input').focus();
  await page.keyboard.press('Home');
  await page.evaluate(() => scrollTo(0, 700));
  await page.waitForTimeout(400);
  [stamp, title] = ['two', 'second'];
  await eventually(
    page,
    () => text_of(page, '#title').catch(() => ''),
    (words) => words === 'second',
    'a new stamp renews the page',
  );
  await eventually(
    page,
    () => text_of(page, '#time output').catch(() => ''),
    (words) => words === '0 s',
    'at the same frame',
  );
  await eventually(
    page,
    () => page.evaluate(() => scrollY),
    (far) => Math.abs(far - 700) < 40,
    'and the same place of the page',
  );
  assert.deepEqual(complaints, []);
  server.closeAllConnections();
  server.close();
  await eventually(
    page,
    () => text_of(page, '#live'),
    (words) => /does not answer/.test(words),
    'without an answer it says so',
  );
  await close();
}

/** A report that talus has written. */
async function test_any(browser, file) {
  const {page, complaints, requests, close} = await open(browser, file);
  await bare(page);
  if (await page.locator(VIEW).count()) {
    assert.ok(coloured(await pixels(page, VIEW)).length > 200, 'the picture is not empty');
    if (await page.locator('#time input').count()) {
      await page.locator('#time input').focus();
      await page.keyboard.press('Home');
      await settle(page);
      assert.ok(coloured(await pixels(page, VIEW)).length > 200, 'nor is the first frame');
      for (const value of await page.locator('[name="field"] option').evaluateAll((options) => options.map(({value: its}) => its))) {
        await set(page, 'field', value);
        await settle(page);
        assert.ok(await page.locator('#loading').isHidden());
      }
    }
  }
  await page.setViewportSize({width: 360, height: 720});
  await settle(page);
  assert.ok((await page.evaluate(() => document.documentElement.scrollWidth)) <= 360, 'no scrolling sideways on a phone');
  assert.equal(await page.locator('[role="alert"]').count(), 0);
  assert.deepEqual([complaints, requests], [[], []]);
  await close();
}

const [flag, name] = process.argv.slice(2);
if (!flag || (flag === '--template' && !name)) {
  console.error('usage: node report_test.mjs --template FILE | REPORT');
  process.exit(2);
}
const lacking = missing() ?? (existsSync(name ?? flag) ? null : `${name ?? flag} was left out of the build`);
if (lacking) {
  console.error(`the page is not looked at: ${lacking}`);
  process.exit(process.env.CI ? 1 : 77); // 77: skipped, as ctest is told; never in CI
}
const folder = mkdtempSync(join(tmpdir(), 'talus_page_'));
const browser = await launch();
const begin = Date.now();
const timed = async (words, action) => {
  await action();
  console.log(`${words}: good, ${((Date.now() - begin) / 1000).toFixed(1)} s so far`);
};
try {
  if (flag !== '--template') {
    await timed(flag, () => test_any(browser, flag));
  } else {
    const template = readFileSync(name, 'utf8');
    const at = (sample) => join(folder, `${sample}.html`);
    const samples = Object.fromEntries(['column', 'block', 'valley', 'failed', 'bare'].map((sample) => [sample, SAMPLES[sample]()]));
    for (const [sample, {run, texts}] of Object.entries(samples)) writeFileSync(at(sample), fill(template, run, texts));
    const others = async () => {
      await timed('a run in three dimensions', () => test_solid_run(browser, at('block')));
      await timed('ground', () => test_ground(browser, at('valley')));
      await timed('numbers first', () => test_numbers_first(browser, at('block')));
      await timed('words', () => test_words(browser, at, template));
      await timed('a live page', () => test_live(browser, template));
    };
    await Promise.all([timed('a plane run', () => test_plane_run(browser, at('column'), samples.column)), others()]); // pages mostly wait
  }
} finally {
  await browser.close();
  rmSync(folder, {recursive: true});
}
