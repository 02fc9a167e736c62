// The page of a plane run, on which everything can be checked against numbers that are known.
import assert from 'node:assert/strict';
import {decode, value_of} from '../src/decode.js';
import {open, pixels} from './browser.mjs';
import {VIEW, bare, coloured, ends, eventually, set, settle, share_of_map, text_of} from './looks.mjs';

/** Time, colours, section, limits, a particle, histories: a plane run whose every number is known. */
export async function test_plane_run(browser, file, {run, texts}) {
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
