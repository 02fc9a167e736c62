// What the reader has chosen: one flat record, kept in the address, so that a link or a reload shows the same.

/** name: [kind, value when nothing was chosen]. Lengths in metres, values in the field's unit. */
const CHOICES = {
  frame: ['number', null], // null: the last one, also when a run goes on and there are more
  field: ['text', null], // name of a field, or "body"
  map: ['text', 'viridis'],
  range: ['text', 'auto'], // auto, run, frame or hand
  from: ['number', null], // with range=hand
  to: ['number', null],
  section: ['text', 'none'], // none, x, y, z or view
  at: ['number', null], // along the normal
  normal: ['numbers', null], // with section=view
  flip: ['flag', false],
  only: ['text', null], // name of the field whose values are limited
  lowest: ['number', null],
  highest: ['number', null],
  mesh: ['text', 'outline'], // none, outline or cells
  ground: ['flag', true], // of a mesh of terrain
  rigid: ['flag', true], // rigid bodies
  size: ['number', 1], // of the particles, times their radius
  orthographic: ['flag', null],
  towards: ['numbers', null], // unit vector from what is looked at to the eye
  target: ['numbers', null],
  height: ['number', null], // of what is seen at the target
  particle: ['number', null], // id
  clicked: ['text', null], // name of a rigid body
  plots: ['text', null],
  line: ['number', null], // of the scene
};

const write = {
  number: (v) => String(+v.toPrecision(7)),
  text: (v) => v,
  flag: (v) => (v ? 'yes' : 'no'),
  numbers: (v) => v.map((x) => +x.toPrecision(6)).join(','),
};
const read = {
  number: (text) => (text !== '' && Number.isFinite(Number(text)) ? Number(text) : null),
  text: (text) => text,
  flag: (text) => text === 'yes',
  numbers: (text) => {
    const numbers = text.split(',').map(Number);
    return numbers.length === 3 && numbers.every(Number.isFinite) ? numbers : null;
  },
};

export function to_hash(choices) {
  const parts = new URLSearchParams();
  for (const [name, [kind, otherwise]] of Object.entries(CHOICES))
    if (choices[name] !== otherwise && choices[name] !== null) parts.set(name, write[kind](choices[name]));
  return parts.toString().replaceAll('%2C', ',').replaceAll('%3A', ':');
}

/** Unknown names and values that cannot be read are left out: an address of another report does no harm. */
export function from_hash(hash) {
  const choices = Object.fromEntries(Object.entries(CHOICES).map(([name, [, otherwise]]) => [name, otherwise]));
  const text = hash.replace(/^#/, '');
  const line = /^L(\d+)$/.exec(text);
  if (line) return {...choices, line: Number(line[1])};
  for (const [name, value] of new URLSearchParams(text))
    if (CHOICES[name]) choices[name] = read[CHOICES[name][0]](value) ?? CHOICES[name][1];
  return choices;
}

/** The choices of this page. `set` tells those who `listen`, and the address soon after. */
export function make_state() {
  let choices = from_hash(location.hash);
  const listeners = [];
  let timer = 0;
  const keep = () => {
    clearTimeout(timer);
    timer = 0;
    const hash = to_hash(choices);
    history.replaceState(null, '', hash ? `#${hash}` : location.pathname + location.search);
  };
  const tell = (changed) => {
    for (const listener of listeners) listener(choices, changed);
  };
  addEventListener('hashchange', () => {
    choices = {...choices, ...(/^#L\d+$/.test(location.hash) ? {line: from_hash(location.hash).line} : from_hash(location.hash))};
    tell(new Set(Object.keys(choices)));
    keep();
  });
  addEventListener('pagehide', () => timer && keep());
  return {
    get: () => choices,
    keep,
    listen: (listener) => listeners.push(listener),
    set(changes) {
      const changed = new Set(Object.keys(changes).filter((name) => choices[name] !== changes[name]));
      if (!changed.size) return;
      choices = {...choices, ...changes};
      tell(changed);
      timer ||= setTimeout(keep, 200); // browsers allow only so many changes of the address a second
    },
  };
}
