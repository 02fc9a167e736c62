// Elements of the page in one expression, and numbers as they are read.

/** el('a', {href: '#L3', class: 'line'}, 'line ', 3): attributes; functions are listeners; children are nodes or text. */
export function el(tag, attributes = {}, ...children) {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (value === null || value === undefined || value === false) continue;
    if (typeof value === 'function') element.addEventListener(name, value);
    else if (name === 'value' || name === 'checked' || name === 'disabled') element[name] = value;
    else element.setAttribute(name, value === true ? '' : value);
  }
  element.append(
    ...children
      .flat(Infinity)
      .filter((child) => child !== null && child !== undefined && child !== false)
      .map((child) => (child instanceof Node ? child : String(child))),
  );
  return element;
}

const SHAPES = {
  // in a box of 16 by 16
  play: 'M4 2l10 6-10 6z',
  pause: 'M4 2h3v12H4zM9 2h3v12H9z',
  next: 'M3 2l8 6-8 6zM11 2h2v12h-2z',
  back: 'M13 2L5 8l8 6zM5 2H3v12h2z',
  last: 'M1 3l6 5-6 5zM7 3l6 5-6 5zM13 3h2v10h-2z',
  first: 'M15 3L9 8l6 5zM9 3L3 8l6 5zM3 3H1v10h2z',
};

/** A sign on a button, which has its words in aria-label. */
export function icon(name) {
  const svg = document.createElementNS('http://www.w3.org/2000/svg', 'svg');
  for (const [key, value] of Object.entries({viewBox: '0 0 16 16', width: 14, height: 14, fill: 'currentColor', 'aria-hidden': 'true'}))
    svg.setAttribute(key, value);
  svg.append(document.createElementNS(svg.namespaceURI, 'path'));
  svg.firstChild.setAttribute('d', SHAPES[name]);
  return svg;
}

/** A choice out of several: [[value, words], ...]. */
export function choice(label, options, attributes = {}) {
  return el(
    'label',
    {},
    el('span', {}, label),
    el(
      'select',
      {name: attributes.name, change: attributes.change},
      options.map(([value, words]) => el('option', {value}, words)),
    ),
  );
}

export function table(caption, head, rows, attributes = {}) {
  return el(
    'div',
    {class: 'wide', tabindex: 0, role: 'region', 'aria-label': caption},
    el(
      'table',
      attributes,
      el('caption', {}, caption),
      el(
        'thead',
        {},
        el(
          'tr',
          {},
          head.map((words) => el('th', {scope: 'col'}, words)),
        ),
      ),
      el(
        'tbody',
        {},
        rows.map(([first, ...rest]) =>
          el(
            'tr',
            {},
            el('th', {scope: 'row'}, first),
            rest.map((cell) => el('td', {}, cell)),
          ),
        ),
      ),
    ),
  );
}

/** Four digits, powers of ten where plain writing would be long. */
export function number(value, digits = 4) {
  if (value === null || value === undefined || Number.isNaN(value)) return '–';
  if (!Number.isFinite(value)) return value > 0 ? '∞' : '−∞';
  const size = Math.abs(value);
  if (size !== 0 && (size >= 1e6 || size < 1e-3)) {
    const [mantissa, power] = value.toExponential(digits - 1).split('e');
    return `${mantissa.replace(/\.?0+$/, '').replace('-', '−')}·10${superscript(Number(power))}`;
  }
  return String(+value.toPrecision(digits)).replace('-', '−');
}

const superscript = (power) => String(power).replace(/[-\d]/g, (c) => (c === '-' ? '⁻' : '⁰¹²³⁴⁵⁶⁷⁸⁹'[c]));

/** 1234567 -> "1 234 567", with narrow spaces that do not break. */
export const whole = (value) => String(Math.round(value)).replace(/\B(?=(\d{3})+$)/g, '\u202f');

/** Units as they are written by hand: "kg m^2/s" -> "kg m²/s". */
export const unit = (text) => (text ?? '').replace(/\^(\d)/g, (_, digit) => superscript(digit));

export const with_unit = (value, text) => (text ? `${number(value)}\u00a0${unit(text)}` : number(value));

/** "name [unit]" -> [name, unit] */
export function split_unit(text) {
  const parts = /^(.*?)\s*\[(.*)\]$/.exec(text);
  return parts ? [parts[1], parts[2]] : [text, ''];
}

/** Seconds of wall time as a person says them. */
export function duration(seconds) {
  if (!(seconds >= 0)) return '–';
  if (seconds < 120) return `${number(seconds, 3)} s`;
  if (seconds < 7200) return `${Math.floor(seconds / 60)} min ${Math.round(seconds % 60)} s`;
  return `${Math.floor(seconds / 3600)} h ${Math.round((seconds % 3600) / 60)} min`;
}
