// Blocks of numbers as talus report packs them, of made-up particles, meshes and ground.
import {deflateSync} from 'node:zlib';

const TYPES = {u8: Uint8Array, u16: Uint16Array, u32: Uint32Array, f32: Float32Array, f64: Float64Array};
const STEPS = 65534,
  NOTHING = 65535;

/** Blocks of one report: packs numbers, keeps the text, returns what says where they are. @param {string[]} texts of blocks before */
export function make_packer(texts = []) {
  /** @param {ArrayLike<number>} values */
  function pack(values, type, {delta = false, planes = false} = {}) {
    const numbers = TYPES[type].from(values);
    if (delta) for (let i = numbers.length - 1; i > 0; --i) numbers[i] -= numbers[i - 1];
    const bytes = new Uint8Array(numbers.buffer);
    const width = numbers.BYTES_PER_ELEMENT;
    const placed = planes ? Uint8Array.from(bytes, (_, k) => bytes[(k % numbers.length) * width + Math.floor(k / numbers.length)]) : bytes;
    texts.push(deflateSync(placed, {level: 5}).toString('base64'));
    return {id: texts.length - 1, count: numbers.length, type, delta, planes};
  }
  const steps = (values, low, high) =>
    Uint16Array.from(values, (v) => (Number.isNaN(v) ? NOTHING : Math.round((STEPS * (v - low)) / (high - low || 1))));
  return {
    texts,
    pack,
    positions: (values, low, high) => pack(steps(values, low, high), 'u16', {delta: true, planes: true}),
    field: (values, {low, high}) => pack(steps(values, low, high), 'u16', {planes: true}),
    table: (columns, rows) => ({
      columns: columns.map(({name, unit, label}) => ({name, unit, label})),
      rows: rows.length,
      thinned: 1,
      values: pack(
        columns.flatMap((_, c) => rows.map((row) => row[c])),
        'f64',
        {planes: true},
      ),
    }),
  };
}

/** The template with a run in it. */
export function fill(template, run, texts) {
  const line = '<!--TALUS-RUN-->';
  if (!template.includes(line)) throw new Error('the template has no line for the run');
  const scripts = [
    `<script id="run" type="application/json">${JSON.stringify(run).replaceAll('<', '\\u003c')}</script>`,
    ...texts.map((text, id) => `<script id="block-${id}" type="application/octet-stream">${text}</script>`),
  ];
  return template.replace(line, () => scripts.join('\n'));
}

/** Evenly spread in [0, 1), the same every time. */
export function make_random(seed) {
  let state = seed;
  return () => {
    state = (Math.imul(state, 1664525) + 1013904223) >>> 0;
    return state / 2 ** 32;
  };
}

/** From nothing to all of it. */
export const grown = (x) => 1 - Math.exp(-(x * x));

const range_of = (arrays) =>
  arrays.reduce(
    ([low, high], values) => values.reduce(([l, h], v) => (Number.isNaN(v) ? [l, h] : [Math.min(l, v), Math.max(h, v)]), [low, high]),
    [Infinity, -Infinity],
  );

/**
 * Frames of particles out of functions of place and time.
 * @param {{start: number[][], bodies: number[], times: number[], move: Function, fields: object[]}} what fields: {name, label, unit, of(start, place, t)}
 */
export function pack_particles(packer, {start, bodies, times, move, fields, dimension, radius, names, range}) {
  const places = times.map((t) => start.map((x, p) => move(x, t, bodies[p])));
  const values = fields.map(({of}) => times.map((t, f) => Float64Array.from(start, (x, p) => of(x, places[f][p], t, p))));
  const described = fields.map(({name, label, unit}, k) => {
    const [low, high] = range_of(values[k].map((v) => v));
    return {name, label, unit, low, high};
  });
  return {
    total: start.length,
    shown: start.length,
    radius,
    bodies: names,
    fields: described,
    field: 0,
    range: range ?? null,
    frames: times.map((time, f) => {
      const axes = [0, 1, 2].slice(0, dimension).map((axis) => Float64Array.from(places[f], (x) => x[axis]));
      const ends = axes.map((axis) => range_of([axis]));
      const low = ends.map(([l]) => l),
        high = ends.map(([, h]) => h);
      const [x, y, z] = axes.map((axis, k) => packer.positions(axis, low[k], high[k]));
      return {
        time,
        count: start.length,
        low,
        high,
        x,
        y,
        z: z ?? null,
        id: packer.pack(
          start.map((_, p) => p),
          'u32',
          {delta: true, planes: true},
        ),
        body: names.length > 1 ? packer.pack(bodies, 'u8') : null,
        fields: fields.map((_, k) => packer.field(values[k][f], described[k])),
      };
    }),
  };
}

/** A box of triangles (2-D) or its twelve edges (3-D). */
export function pack_mesh(packer, low, high, cells) {
  const dimension = low.length;
  const nodes = [];
  const pairs = [],
    all = [];
  if (dimension === 2) {
    const [nx, ny] = cells;
    const node = (i, j) => j * (nx + 1) + i;
    for (let j = 0; j <= ny; ++j)
      for (let i = 0; i <= nx; ++i) {
        nodes.push([low[0] + ((high[0] - low[0]) * i) / nx, low[1] + ((high[1] - low[1]) * j) / ny]);
        if (i < nx) (j === 0 || j === ny ? pairs : all).push(node(i, j), node(i + 1, j));
        if (j < ny) (i === 0 || i === nx ? pairs : all).push(node(i, j), node(i, j + 1));
        if (i < nx && j < ny) all.push(node(i, j), node(i + 1, j + 1));
      }
    all.push(...pairs);
  } else {
    for (let k = 0; k < 8; ++k) nodes.push([0, 1, 2].map((axis) => (k & (1 << axis) ? high : low)[axis]));
    for (let k = 0; k < 8; ++k) for (let axis = 0; axis < 3; ++axis) if (!(k & (1 << axis))) pairs.push(k, k | (1 << axis));
  }
  const [x, y, z] = low.map((_, axis) =>
    packer.positions(
      nodes.map((node) => node[axis]),
      low[axis],
      high[axis],
    ),
  );
  return {
    count: nodes.length,
    low,
    high,
    x,
    y,
    z: z ?? null,
    outline: packer.pack(pairs, 'u32', {delta: true, planes: true}),
    cells: all.length ? packer.pack(all, 'u32', {delta: true, planes: true}) : null,
  };
}

/** A rigid plane under the block, in squares of a metre, and the line around a part of it. @param {(x: number) => number} height */
export function pack_ground(packer, height) {
  const [nx, ny] = [12, 4];
  const nodes = [],
    triples = [];
  const node = (i, j) => j * (nx + 1) + i;
  for (let j = 0; j <= ny; ++j)
    for (let i = 0; i <= nx; ++i) {
      nodes.push([i, j - 1, height(i)]);
      if (i < nx && j < ny) triples.push(node(i, j), node(i + 1, j), node(i, j + 1), node(i + 1, j), node(i + 1, j + 1), node(i, j + 1));
    }
  const low = [0, -1, height(nx)],
    high = [nx, ny - 1, height(0)];
  const [x, y, z] = low.map((_, axis) =>
    packer.positions(
      nodes.map((place) => place[axis]),
      low[axis],
      high[axis],
    ),
  );
  const layers = [node(0, 1), node(3, 1), node(3, 1), node(3, 3), node(3, 3), node(0, 3), node(0, 3), node(0, 1)];
  return {
    count: nodes.length,
    low,
    high,
    x,
    y,
    z,
    rigid: packer.pack(triples, 'u32', {delta: true, planes: true}),
    layers: packer.pack(layers, 'u32', {delta: true, planes: true}),
  };
}

const SQUARE = [0, 1, 2, 1, 3, 2]; // corners 0 to 3, x first
const CUBE = [0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4, 2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5]; // sides face outside

/** A rigid box that has moved and turned about y (2-D: z) in each frame. @param {(share: number) => {by: number[], turned: number}} move */
export function pack_rigid_box(packer, {particles, dimension}, name, low, high, move) {
  const flat = dimension === 2;
  const corners = Array.from({length: flat ? 4 : 8}, (_, k) => low.map((end, axis) => (k & (1 << axis) ? high[axis] : end)));
  const [x, y, z] = low.map((end, axis) =>
    packer.positions(
      corners.map((corner) => corner[axis]),
      end,
      high[axis],
    ),
  );
  particles.frames.forEach((frame, f) => {
    const {by, turned} = move(f / (particles.frames.length - 1));
    const [sine, cosine] = [Math.sin(turned / 2), Math.cos(turned / 2)];
    frame.rigid = packer.pack(flat ? [...by, 0, 0, 0, sine, cosine] : [...by, 0, sine, 0, cosine], 'f32', {planes: true});
  });
  const ends = (place) => [...place, 0].slice(0, 3);
  const triangles = packer.pack(flat ? SQUARE : CUBE, 'u32', {delta: true, planes: true});
  return [{name, count: corners.length, low: ends(low), high: ends(high), x, y, z: z ?? null, triangles}];
}
