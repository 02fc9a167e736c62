// Blocks decode to what was packed, and what is computed from words and choices is right. Run by: node --test test/decode_test.mjs
import assert from 'node:assert/strict';
import {test} from 'node:test';
import {deflateSync} from 'node:zlib';
import {add_up, as_steps, decode, join_planes, to_numbers, value_of} from '../src/decode.js';
import {first_choice, from_text, group_columns, to_text} from '../src/columns.js';
import {line_in, tokens_of} from '../src/scene_text.js';
import {limit_of, section_of, shown_test} from '../src/shown.js';
import {from_hash, to_hash} from '../src/state.js';
import {number, split_unit} from '../src/dom.js';
import {make_packer} from './sample_blocks.mjs';

test('a block decodes to what was packed, whatever its type and packing', async () => {
  const values = {
    u8: [0, 255, 3, 3, 200],
    u16: [5, 65535, 0, 12, 40000],
    u32: [0, 4294967295, 7, 65536, 1],
    f32: [0, -1.5, 3e7],
    f64: [Math.PI, -0, 1e300],
  };
  for (const [type, numbers] of Object.entries(values))
    for (const planes of [false, true])
      for (const delta of type.startsWith('u') ? [false, true] : [false]) {
        const packer = make_packer();
        const block = packer.pack(numbers, type, {delta, planes});
        assert.deepEqual(Array.from(await decode(packer.texts[0], block)), numbers, `${type} delta ${delta} planes ${planes}`);
      }
});

test('bytes by hand: differences modulo 2^16, lowest bytes first', async () => {
  // 1, 258 (+257), 255 (-3 = 65533): lowest bytes 1 1 253, then 0 1 255
  const text = deflateSync(Uint8Array.of(1, 1, 253, 0, 1, 255)).toString('base64');
  assert.deepEqual(Array.from(await decode(text, {id: 0, count: 3, type: 'u16', delta: true, planes: true})), [1, 258, 255]);
  assert.deepEqual(Array.from(join_planes(Uint8Array.of(1, 2, 10, 20), 2)), [1, 10, 2, 20]);
  assert.deepEqual(Array.from(add_up(Uint8Array.of(250, 10, 1))), [250, 4, 5]);
});

test('a block that was cut off or is of an unknown type is refused by its number', () => {
  assert.throws(() => to_numbers(new Uint8Array(5), {id: 7, count: 3, type: 'u16'}), /block 7: 5 bytes/);
  assert.throws(() => to_numbers(new Uint8Array(5), {id: 8, count: 3, type: 'u64'}), /block 8.*u64/);
});

test('whole numbers stand for values: both ends exactly, the last one for nothing', () => {
  assert.equal(value_of(0, -2, 6), -2);
  assert.equal(value_of(65534, -2, 6), 6);
  assert.ok(Number.isNaN(value_of(65535, -2, 6)));
  assert.deepEqual(Array.from(as_steps(Float32Array.of(-2, 2, 6, NaN), -2, 6)), [0, 32767, 65534, 65535]);
});

test('columns of a history are sorted by kind and unit', () => {
  const columns = [
    ['time', 's'],
    ['step', ''],
    ['kinetic', 'J'],
    ['load_work', 'J'],
    ['reaction_y_min_x', 'N'],
    ['angular_momentum_z', 'kg m^2/s'],
    ['momentum_x', 'kg m/s'],
    ['crest_x', 'm'],
    ['crest_ux', 'm'],
    ['crest_vx', 'm/s'],
    ['crest_sxy', 'Pa'],
    ['toe', 'm'],
    ['momentum_meter', 'V'],
  ].map(([name, unit]) => ({name, unit}));
  const groups = group_columns(columns, (c) => columns[c].name === 'load_work');
  const names = Object.fromEntries(groups.map(({title, columns: its}) => [title, its.map((c) => columns[c].name).join()]));
  assert.deepEqual(names, {
    energies: 'kinetic,load_work',
    fronts: 'toe',
    'crest: displacement': 'crest_ux',
    'crest: velocity': 'crest_vx',
    momentum: 'momentum_x',
    reactions: 'reaction_y_min_x',
    steps: 'step',
    'angular momentum': 'angular_momentum_z',
    'crest: position': 'crest_x',
    'crest: stress': 'crest_sxy',
    momentum_meter: 'momentum_meter',
  });
  assert.deepEqual(groups[0].chosen, [2], 'a column in which nothing happens is not drawn at first');
  assert.deepEqual(
    first_choice(groups).map(({title}) => title),
    ['energies', 'fronts', 'crest: displacement'],
  );
  const plots = [
    {title: 'energies', names: ['kinetic', 'plastic']},
    {title: 'crest: stress', names: []},
  ];
  assert.deepEqual(from_text(to_text(plots)), plots);
});

test('the address keeps every choice, and does not mind strangers', () => {
  const chosen = {
    ...from_hash(''),
    frame: 3,
    field: 'plastic_strain',
    flip: true,
    towards: [0.5, -0.25, 1],
    lowest: 0,
    plots: 'energies=kinetic+plastic;fronts=toe',
    range: 'hand',
    from: -1e-5,
  };
  assert.deepEqual(from_hash(`#${to_hash(chosen)}`), chosen);
  assert.equal(to_hash(from_hash('')), '');
  assert.equal(from_hash('#L12').line, 12);
  assert.deepEqual(from_hash('#frame=seven&nonsense=1&towards=1,2'), from_hash(''));
});

test('the scene is coloured without losing a letter, and messages name its lines', () => {
  for (const line of ['  - {name: "a # b", at: [30, -3.5e-2]}   # why: "so"', "key-2: 'it''s'", '', '\t# only', 'http://x: 1.2.3'])
    assert.equal(
      tokens_of(line)
        .map(([, text]) => text)
        .join(''),
      line,
    );
  const kinds = (line) =>
    tokens_of(line)
      .filter(([kind]) => kind)
      .map(([kind, text]) => `${kind} ${text}`);
  assert.deepEqual(kinds('size: 2.15  # m, edge: 3'), ['key size', 'sign :', 'number 2.15', 'remark # m, edge: 3']);
  assert.equal(line_in('slope/scene.yaml:12:3: cohesion: must not be negative'), 12);
  assert.equal(line_in('body "a", line 7'), 7);
  assert.equal(line_in('nothing of the kind'), null);
});

test('section and limits leave out what they should', () => {
  const frame = {low: [0, 0], high: [2, 1]};
  const places = Uint16Array.of(0, 0, 0, 0, 32767, 0, 0, 0, 65534, 65534, 0, 0); // x = 0, 1, 2
  const box = {min: {x: 0, y: 0, z: 0}, max: {x: 2, y: 1, z: 0}};
  const seen = (choices, limiting = null, limit = null) =>
    [0, 1, 2].map(shown_test(frame, places, limiting, limit, section_of({...from_hash(''), ...choices}, box)));
  assert.deepEqual(seen({section: 'x', at: 1.5}), [true, true, false]);
  assert.deepEqual(seen({section: 'x', at: 1.5, flip: true}), [false, false, true]);
  assert.deepEqual(seen({section: 'x'}), [true, true, false], 'the middle, unless told');
  const particles = {fields: [{name: 'p', low: 10, high: 30}]};
  const limit = limit_of(particles, {only: 'p', lowest: 20, highest: null});
  assert.deepEqual(seen({}, Uint16Array.of(0, 32767, 65535), limit), [false, true, false], 'without a value a particle is not shown');
  assert.equal(limit_of(particles, {only: 'p', lowest: null, highest: null}), null);
});

test('numbers read well', () => {
  assert.deepEqual(
    [0, 0.5, -1234.5678, 1.5e7, -2e-16, NaN, Infinity].map((v) => number(v)),
    ['0', '0.5', '−1235', '1.5·10⁷', '−2·10⁻¹⁶', '–', '∞'],
  );
  assert.deepEqual(split_unit('stage 1 run: kinetic [J]'), ['stage 1 run: kinetic', 'J']);
});
