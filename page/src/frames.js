// Frames of particles as the viewer needs them, decoded when asked for; the last few are kept.
import {as_steps, value_of} from './decode.js';

const KEPT_BYTES = 384e6;

/** Promises by key; the ones not asked for the longest go when there is more than KEPT_BYTES. */
function make_cache() {
  const entries = new Map();
  let held = 0;
  function shrink() {
    for (const [key, entry] of entries) {
      if (held <= KEPT_BYTES || entries.size <= 4) return;
      if (!entry.bytes) continue;
      held -= entry.bytes;
      entries.delete(key);
    }
  }
  return (key, make) => {
    const known = entries.get(key);
    if (known) {
      entries.delete(key);
      entries.set(key, known);
      return known.promise;
    }
    const entry = {bytes: 0, promise: make()};
    entries.set(key, entry);
    entry.promise.then(
      (numbers) => {
        entry.bytes = numbers?.byteLength ?? 1;
        held += entry.bytes;
        shrink();
      },
      () => entries.delete(key),
    );
    return entry.promise;
  };
}

/** Positions of a frame, four whole numbers a particle: x, y, z in [low, high] of the frame, body + 256 * hundredths by which it is drawn larger. */
function join_places([x, y, z, body, growth], {count, low, high}) {
  const steps = [x, y, z].map((numbers, axis) => numbers && as_steps(numbers, low[axis], high[axis]));
  const places = new Uint16Array(4 * count);
  for (let p = 0; p < count; ++p) {
    places[4 * p] = steps[0][p];
    places[4 * p + 1] = steps[1][p];
    places[4 * p + 2] = steps[2] ? steps[2][p] : 0;
    places[4 * p + 3] = (body ? body[p] : 0) + 256 * (growth ? growth[p] : 0);
  }
  return places;
}

/**
 * @param {object} particles `particles` of the run
 * @param {ReturnType<import('./blocks.js').make_blocks>} blocks
 */
export function make_frames(particles, blocks) {
  const cached = make_cache();
  const {frames, fields} = particles;
  const optional = (block) => (block ? blocks.numbers(block) : null);

  /** Uint16Array, 4 a particle */
  const places = (f) =>
    cached(`places ${f}`, async () => {
      const {x, y, z, body, growth} = frames[f];
      const numbers = [blocks.numbers(x), blocks.numbers(y), optional(z), optional(body), optional(growth)];
      return join_places(await Promise.all(numbers), frames[f]);
    });
  /** Uint16Array in [low, high] of the field over all frames, or null where the frame does not have the field */
  const steps = (f, field) =>
    cached(`field ${field} ${f}`, async () => {
      const block = frames[f].fields[field];
      return block ? as_steps(await blocks.numbers(block), fields[field].low, fields[field].high) : null;
    });
  /** Uint32Array */
  const ids = (f) => cached(`ids ${f}`, () => blocks.numbers(frames[f].id));
  /** Float32Array, 7 a rigid body, or null where they are not known */
  const rigid = (f) => cached(`rigid ${f}`, async () => optional(frames[f].rigid));

  return {places, steps, ids, rigid};
}

/** Number of the body of particle p of a frame. */
export const body_of = (places, p) => places[4 * p + 3] & 255;

/** Where particle p of a frame is [m]. */
export function place_of(places, p, {low, high}) {
  return [0, 1, 2].map((axis) => value_of(places[4 * p + axis], low[axis] ?? 0, high[axis] ?? 0));
}

/** Lowest and highest value among whole numbers, or null if there are none. */
export function range_of(steps, low, high) {
  let least = Infinity,
    most = -Infinity;
  for (const step of steps) {
    if (step > 65534) continue;
    if (step < least) least = step;
    if (step > most) most = step;
  }
  return least > most ? null : [value_of(least, low, high), value_of(most, low, high)];
}
