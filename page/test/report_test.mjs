// The page in a browser: what a reader does, and what is then to be seen.
// Usage: node report_test.mjs --template FILE     made-up runs in this template, everything that can be checked against them
//        node report_test.mjs REPORT              a report of talus: that it opens, draws, moves and asks nothing of the network
import assert from 'node:assert/strict';
import {existsSync, mkdtempSync, readFileSync, rmSync, writeFileSync} from 'node:fs';
import {createServer} from 'node:http';
import {tmpdir} from 'node:os';
import {join} from 'node:path';
import {launch, missing, open, pixels} from './browser.mjs';
import {VIEW, bare, coloured, ends, eventually, set, settle, text_of} from './looks.mjs';
import {test_plane_run} from './plane_run.mjs';
import {test_plane_rigid, test_solid_rigid} from './rigid_run.mjs';
import {SAMPLES, fill} from './sample.mjs';

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
    const samples = Object.fromEntries(['column', 'block', 'valley', 'ram', 'tumbler', 'failed', 'bare'].map((sample) => [sample, SAMPLES[sample]()]));
    for (const [sample, {run, texts}] of Object.entries(samples)) writeFileSync(at(sample), fill(template, run, texts));
    const others = async () => {
      await timed('a run in three dimensions', () => test_solid_run(browser, at('block')));
      await timed('ground', () => test_ground(browser, at('valley')));
      await timed('a rigid body in two dimensions', () => test_plane_rigid(browser, at('ram'), samples.ram));
      await timed('a rigid body in three dimensions', () => test_solid_rigid(browser, at('tumbler'), samples.tumbler));
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
