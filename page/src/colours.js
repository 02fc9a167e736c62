// Colour maps that readers with any kind of colour vision can order, and colours for bodies and curves.

const rows = (text) => text.match(/[0-9a-f]{6}/g).map((hex) => [0, 2, 4].map((i) => parseInt(hex.slice(i, i + 2), 16)));

/** Supports at even distances, low to high. viridis and cividis: Smith, van der Walt, Firing; Nuñez et al. (2018), both CC0. */
export const MAPS = {
  viridis: rows('440154 48186a 472d7b 424086 3b528b 33638d 2c728e 26828e 21918c 1fa088 28ae80 3fbc73 5ec962 84d44b addc30 d8e219 fde725'),
  cividis: rows('00224e 002e6a 1a386f 32436d 434e6c 535a6d 61656f 6f7073 7d7c78 8c8878 9b9476 aba072 bcae6c cdbb63 dec958 f0d846 fee838'),
  'blue–orange': rows('08306b 2166ac 4a90c9 92c0de d9e6ee f3ead9 f4c48a e58f3c b85a10 6e3005'), // lightness symmetrical about the middle
};

/** Okabe and Ito (2008), without black; pairs stay apart with any kind of colour vision. */
export const DISTINCT = rows('e69f00 56b4e9 009e73 d55e00 cc79a7 0072b2 f0e442 999999');

/** Rigid bodies, as talus render has them. */
export const RIGID = [128, 136, 148];

export const css = ([r, g, b]) => `rgb(${Math.round(r)} ${Math.round(g)} ${Math.round(b)})`;

/** Colour at t in [0, 1], straight between supports: [r, g, b] of 255. */
export function colour_at(map, t) {
  const supports = MAPS[map] ?? MAPS.viridis;
  const place = Math.min(1, Math.max(0, t)) * (supports.length - 1);
  const below = Math.min(supports.length - 2, Math.floor(place));
  return supports[below].map((low, c) => low + (supports[below + 1][c] - low) * (place - below));
}

const COLUMNS = 256;

/** 256 colours, four bytes each, for the graphics card. */
export function map_pixels(map) {
  const pixels = new Uint8Array(4 * COLUMNS);
  for (let i = 0; i < COLUMNS; ++i) pixels.set([...colour_at(map, i / (COLUMNS - 1)).map(Math.round), 255], 4 * i);
  return pixels;
}

/** The same for bodies: column = number of the body. */
export function body_pixels() {
  const pixels = new Uint8Array(4 * COLUMNS);
  for (let i = 0; i < COLUMNS; ++i) pixels.set([...DISTINCT[i % DISTINCT.length], 255], 4 * i);
  return pixels;
}

/** For a style: the map from left to right. */
export const gradient = (map) => `linear-gradient(to right, ${MAPS[map].map(css).join(', ')})`;
