// Columns of a history, sorted into plots: what is of one kind and one unit belongs into one picture.

const KINDS = [
  // pattern of the name, unit it needs (null: any), title of the plot; first match decides
  [/^angular_momentum_[xyz]$/, null, () => 'angular momentum'],
  [/^momentum_[xyz]$/, null, () => 'momentum'],
  [/^reaction_/, null, () => 'reactions'],
  [/^centre_[xyz]$/, null, () => 'centre of mass'],
  [/./, 'J', () => 'energies'],
  [
    /^(dt|step|stage|mass|residual)$/,
    null,
    ([name]) => ({dt: 'length of a step', step: 'steps', stage: 'stage', mass: 'mass', residual: 'unbalanced share of the load'})[name],
  ],
  [/^(.+)_u[xyz]$/, 'm', ([, point]) => `${point}: displacement`],
  [/^(.+)_v[xyz]$/, 'm/s', ([, point]) => `${point}: velocity`],
  [/^(.+)_s[xyz]{2}$/, 'Pa', ([, point]) => `${point}: stress`],
  [/^(.+)_[xyz]$/, 'm', ([, point]) => `${point}: position`],
  [/./, 'm', () => 'fronts'],
  [/./, null, ([name]) => name],
];

const RANK = ['energies', 'fronts', 'displacement', 'velocity', 'momentum', 'reactions'];
const rank = (title) => {
  const place = RANK.findIndex((word) => title === word || title.endsWith(`: ${word}`));
  return place < 0 ? RANK.length : place;
};

/** Energies that say most about a run; the others can be added. */
const TELLING = /^(kinetic|strain|plastic|friction|damping|gravity_work|energy_defect)$/;

/**
 * @param {{name: string, unit: string, label?: string}[]} columns the first is the time
 * @param {(column: number) => boolean} is_zero columns in which nothing ever happens are not chosen at first
 * @returns {{title: string, unit: string, columns: number[], chosen: number[]}[]} those to be shown first stand first
 */
export function group_columns(columns, is_zero = () => false) {
  const groups = new Map();
  columns.forEach(({name, unit = ''}, c) => {
    if (c === 0) return;
    const [pattern, , title_of] = KINDS.find(([pattern, its_unit]) => pattern.test(name) && (its_unit === null || its_unit === unit));
    const title = title_of(pattern.exec(name).length > 1 ? pattern.exec(name) : [name, name]);
    const key = `${title} [${unit}]`;
    if (!groups.has(key)) groups.set(key, {title, unit, columns: []});
    groups.get(key).columns.push(c);
  });
  return [...groups.values()]
    .map((group) => {
      const busy = group.columns.filter((c) => !is_zero(c));
      const telling = group.title === 'energies' ? busy.filter((c) => TELLING.test(columns[c].name)) : busy;
      return {...group, chosen: (telling.length ? telling : busy.length ? busy : group.columns).slice(0, 8)};
    })
    .sort((a, b) => rank(a.title) - rank(b.title));
}

/** Columns of a table that talus has made up of words, such as the run-out: one plot for each unit. */
export function group_by_unit(columns) {
  const titles = {m: 'places and lengths', 'm/s': 'speeds', deg: 'angles', '': 'ratios'};
  const units = [...new Set(columns.slice(1).map(({unit = ''}) => unit))];
  return units.map((unit) => {
    const its = columns.map((_, c) => c).filter((c) => c > 0 && (columns[c].unit ?? '') === unit);
    return {title: titles[unit] ?? unit, unit, columns: its, chosen: its.slice(0, 6)};
  });
}

/** Plots that are open when nothing was chosen: energies, fronts, and the first that says how something moved. */
export function first_choice(groups) {
  const busy = groups.filter(({title}) => title === 'energies' || title === 'fronts');
  const moving = groups.find(({title}) => /: displacement$|^momentum$/.test(title));
  return [...busy, ...(moving ? [moving] : [])].length ? [...busy, ...(moving ? [moving] : [])] : groups.slice(0, 2);
}

/** "energies:kinetic+strain;fronts:toe" <-> open plots with the names of their columns. */
export const to_text = (plots) => plots.map(({title, names}) => `${title}=${names.join('+')}`).join(';');
export const from_text = (text) =>
  text
    .split(';')
    .filter(Boolean)
    .map((part) => {
      const [title, names = ''] = part.split('=');
      return {title, names: names.split('+').filter(Boolean)};
    });

/** A table's block -> one array a column. @param {{columns: object[], rows: number}} table */
export const split_columns = (numbers, {columns, rows}) => columns.map((_, c) => numbers.subarray(c * rows, (c + 1) * rows));
