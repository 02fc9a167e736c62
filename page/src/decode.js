// What a block of the report holds: text -> bytes -> numbers.
// The way back of io/page/page.cpp: base64, zlib, planes of bytes, differences, whole numbers instead of real ones.

/**
 * Where a table of numbers stands and how it was packed.
 * @typedef {{id: number, count: number, type: 'u8'|'u16'|'u32'|'f32'|'f64', delta: boolean, planes: boolean}} Block
 */

const TYPES = {u8: Uint8Array, u16: Uint16Array, u32: Uint32Array, f32: Float32Array, f64: Float64Array};

/** The largest whole number that stands for a value; the one above it says that there is none. */
export const STEPS = 65534;
export const NOTHING = 65535;

/** @param {string} text @returns {Uint8Array} */
export function from_base64(text) {
  if (Uint8Array.fromBase64) return Uint8Array.fromBase64(text);
  const characters = atob(text);
  const bytes = new Uint8Array(characters.length);
  for (let i = 0; i < bytes.length; ++i) bytes[i] = characters.charCodeAt(i);
  return bytes;
}

/** @param {Uint8Array} bytes zlib (RFC 1950) @returns {Promise<Uint8Array>} */
export async function inflate(bytes) {
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream('deflate'));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

/** All lowest bytes, then all second bytes ... -> the bytes of each number beside one another. */
export function join_planes(bytes, width) {
  const count = bytes.length / width;
  const joined = new Uint8Array(bytes.length);
  for (let plane = 0; plane < width; ++plane) for (let i = 0; i < count; ++i) joined[i * width + plane] = bytes[plane * count + i];
  return joined;
}

/** Differences -> values; the array's own width is the modulus. */
export function add_up(values) {
  for (let i = 1; i < values.length; ++i) values[i] += values[i - 1];
  return values;
}

/** Inflated bytes of a block -> its numbers. @param {Uint8Array} bytes @param {Block} block */
export function to_numbers(bytes, block) {
  const Numbers = TYPES[block.type];
  if (!Numbers) throw new Error(`block ${block.id}: numbers of type "${block.type}" are not known to this page`);
  const width = Numbers.BYTES_PER_ELEMENT;
  if (bytes.length !== block.count * width)
    throw new Error(`block ${block.id}: ${bytes.length} bytes, where ${block.count} numbers of ${width} were announced`);
  const whole = block.planes && width > 1 ? join_planes(bytes, width) : bytes;
  const numbers = new Numbers(whole.buffer, whole.byteOffset, block.count);
  return block.delta ? add_up(numbers) : numbers;
}

/** @param {string} text of the block's script @param {Block} block */
export async function decode(text, block) {
  return to_numbers(await inflate(from_base64(text.trim())), block);
}

/** A whole number of a block -> the value it stands for, NaN where it stands for none. */
export function value_of(step, low, high) {
  return step === NOTHING ? NaN : low + ((high - low) * step) / STEPS;
}

/** Numbers of any type as the whole numbers of [low, high] that the graphics card is given. */
export function as_steps(numbers, low, high) {
  if (numbers instanceof Uint16Array) return numbers;
  const scale = high > low ? STEPS / (high - low) : 0;
  return Uint16Array.from(numbers, (v) => (Number.isFinite(v) ? Math.min(STEPS, Math.max(0, Math.round((v - low) * scale))) : NOTHING));
}
