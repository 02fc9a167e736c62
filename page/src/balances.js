// Mass, momentum and energy: what closes, what does not, and where the energy went.
import {CURVES} from './timeline.js';
import {el, number, split_unit, table, unit, with_unit} from './dom.js';

/** Energies as they enter the balance: those put in, and where they are in the end. */
const GIVEN = [
  ['gravity_work', 'work of gravity'],
  ['load_work', 'work of loads'],
  ['wall_work', 'work of walls'],
  ['kinetic_start', 'kinetic energy at the start'],
];
const FOUND = [
  ['kinetic', 'kinetic energy'],
  ['strain', 'strain energy'],
  ['plastic', 'plastic dissipation'],
  ['friction', 'friction at walls and contacts'],
  ['damping', 'damping'],
  ['carried_away', 'carried away by deleted particles'],
  ['resampled', 'lost where particles are merged'],
  ['transfer_loss', 'lost in transfers between particles and nodes'],
  ['energy_defect', 'not accounted for'],
];

/** {"stage 0 run: kinetic [J]": 3} -> Map {'' => Map {kinetic => ...}, 'stage 0 run' => ...} */
export function terms_by_stage(terms) {
  const stages = new Map([['', new Map()]]);
  for (const [key, value] of Object.entries(terms)) {
    const [, stage = '', name] = /^(?:(stage \d+ [^:]*): )?(.*)$/.exec(split_unit(key)[0]);
    if (!stages.has(stage)) stages.set(stage, new Map());
    stages.get(stage).set(name, value);
  }
  return stages;
}

const percent = (share) => (share >= 0.001 ? `${number(100 * share, 3)} %` : number(share, 3));

function closing_words(name, {closure, relative_to: scale, closes}) {
  if (closure === null) return `Whether ${name.toLowerCase()} closes cannot be told: a number is missing.`;
  if (!closes) return `${name} does not close: ${percent(closure)} are left over, relative to ${scale}, more than is allowed.`;
  return closure === 0 ? `${name} closes exactly.` : `${name} closes up to ${percent(closure)}, relative to ${scale}.`;
}

function mass_words(mass) {
  const removed = mass['removed [kg]'];
  const by_stages = (count, kilograms, words) =>
    count || kilograms ? `stages ${words} ${count ?? 0} particles with ${with_unit(kilograms, 'kg')}; ` : '';
  return (
    `${with_unit(mass['start [kg]'], 'kg')} at the start, ${with_unit(mass['end [kg]'], 'kg')} at the end; ` +
    by_stages(mass.particles_placed, mass['placed [kg]'], 'placed') +
    by_stages(mass.particles_taken, mass['taken [kg]'], 'took') +
    (mass.particles_removed
      ? `${mass.particles_removed} particles with ${with_unit(removed, 'kg')} were removed.`
      : 'no particle was removed.')
  );
}

function verdicts(balances) {
  const names = {mass: 'Mass', momentum: 'Momentum', angular_momentum: 'Angular momentum', energy: 'Energy'};
  return el(
    'ul',
    {class: 'verdicts'},
    Object.entries(names)
      .filter(([key]) => balances[key])
      .map(([key, words]) => {
        const balance = balances[key];
        return el(
          'li',
          {class: balance.closes ? 'good' : 'bad'},
          el('b', {'aria-hidden': 'true'}, balance.closes ? '✓ ' : '✗ '),
          closing_words(words, balance),
          key === 'mass' ? ` ${mass_words(balance)}` : null,
        );
      }),
  );
}

function energy_words(terms) {
  const sum = (names) => names.reduce((total, [name]) => total + (terms.get(name) ?? 0), 0);
  const given = sum(GIVEN);
  const largest = FOUND.filter(([name]) => name !== 'energy_defect')
    .map(([name, words]) => [terms.get(name) ?? 0, words])
    .sort(([a], [b]) => Math.abs(b) - Math.abs(a))[0];
  const unexplained = terms.get('unexplained / dissipated');
  return (
    `${with_unit(given, 'J')} were put in. Most of it is ${largest[1]}: ${with_unit(largest[0], 'J')}` +
    (given ? ` (${percent(Math.abs(largest[0] / given))}).` : '.') +
    (unexplained !== undefined && unexplained !== null
      ? ` Not accounted for: ${percent(Math.abs(unexplained))} of what was dissipated.`
      : '') +
    (given && terms.get('transfer_loss') ? ` Transfers took ${percent(terms.get('transfer_loss') / Math.abs(given))} of what was put in.` : '')
  );
}

function energy_table(stages) {
  const columns = [...stages.keys()];
  const head = ['energy [J]', ...columns.map((stage) => stage || 'whole run')];
  const row = ([name, words]) => [words, ...columns.map((stage) => number(stages.get(stage).get(name)))];
  const present = ([name]) => columns.some((stage) => stages.get(stage).get(name));
  const sum = (names) => columns.map((stage) => number(names.reduce((total, [name]) => total + (stages.get(stage).get(name) ?? 0), 0)));
  return table(
    'Where the energy came from and where it is',
    head,
    [
      ...GIVEN.filter(present).map(row),
      [el('b', {}, 'put in'), ...sum(GIVEN)],
      ...FOUND.filter((term) => present(term) || term[0] === 'energy_defect').map(row),
      [el('b', {}, 'sum'), ...sum(FOUND)],
    ],
    {class: 'sums'},
  );
}

function momentum_table(title, balance, its_unit) {
  const of = (name) => balance[`${name} [${its_unit}]`] ?? [];
  const names = of('end').length === 1 ? ['z'] : ['x', 'y', 'z'].slice(0, of('end').length);
  return table(
    `${title} [${unit(its_unit)}]`,
    ['', ...names],
    [
      ['at the start', of('start')],
      ['impulse from outside', of('impulse')],
      ['lost between particles and nodes', of('transfer_loss')],
      ['at the end', of('end')],
    ]
      .filter(([, values]) => values.length)
      .map(([words, values]) => [words, ...values.map((v) => number(v))]),
  );
}

/** Energies as bands that lie on one another, positive ones upwards, negative ones downwards; the line is what was put in. */
function energy_picture(element, table, columns, timeline) {
  const column = (name) => columns[table.columns.findIndex((c) => c.name === name && c.unit === 'J')];
  const bands = FOUND.map(([name, words], k) => ({words, values: column(name), colour: CURVES[k % CURVES.length]})).filter(
    ({values}) => values && values.some((v) => Math.abs(v) > 0),
  );
  if (!bands.length) return false;
  const rows = table.rows;
  const put_in = new Float64Array(rows);
  const edges = {up: [new Float64Array(rows)], down: [new Float64Array(rows)]};
  for (const [name] of GIVEN)
    column(name)?.forEach((v, row) => {
      put_in[row] += v;
    });
  for (const {values} of bands) {
    const next = (before, keep) => before.map((sum, row) => sum + (keep(values[row]) ? values[row] : 0));
    edges.up.push(next(edges.up.at(-1), (v) => v > 0));
    edges.down.push(next(edges.down.at(-1), (v) => v < 0));
  }
  const low = Math.min(0, ...edges.down.at(-1), ...put_in),
    high = Math.max(0, ...edges.up.at(-1), ...put_in);
  const room = 0.04 * (high - low) || 1;

  function draw(plot) {
    const {ctx: context, bbox} = plot;
    const x = Array.from(columns[0], (t) => plot.valToPos(t, 'x', true));
    context.save();
    context.beginPath();
    context.rect(bbox.left, bbox.top, bbox.width, bbox.height);
    context.clip();
    bands.forEach(({colour}, k) => {
      context.fillStyle = colour;
      for (const side of [edges.up, edges.down]) {
        context.beginPath();
        for (let row = 0; row < rows; ++row) context.lineTo(x[row], plot.valToPos(side[k + 1][row], 'y', true));
        for (let row = rows - 1; row >= 0; --row) context.lineTo(x[row], plot.valToPos(side[k][row], 'y', true));
        context.fill();
      }
    });
    context.restore();
  }
  const readings = [];
  const key = (words, colour, k) => {
    const swatch = el('i', {class: colour ? 'block' : null});
    swatch.style.color = colour ?? 'var(--text)';
    readings[k] = el('output', {});
    return el('span', {class: 'chip'}, swatch, words, readings[k]);
  };
  const place = el('div', {
    class: 'plot',
    role: 'img',
    'aria-label': 'Energies over time, one on the other; the table has the numbers of the end',
  });
  element.append(
    el(
      'div',
      {class: 'chips'},
      bands.map(({words, colour}, k) => key(words, colour, k)),
      key('put in', null, bands.length),
    ),
    place,
  );
  timeline.add(place, {
    unit: 'J',
    height: 230,
    draw,
    data: [columns[0], put_in],
    range: () => [low - room, high + room],
    series: [{label: 'put in', stroke: () => getComputedStyle(document.documentElement).getPropertyValue('--text').trim(), width: 2}],
    read: (row) =>
      [...bands.map(({values}) => values), put_in].forEach((values, k) => {
        readings[k].textContent = row === null ? '' : number(values[row]);
      }),
  });
  return true;
}

/** What the last row of the history says, while there is no summary. */
function terms_so_far(table, columns) {
  const entries = table.columns
    .map(({name, unit: its_unit}, c) => [name, its_unit, columns[c].at(-1)])
    .filter(([, its_unit]) => its_unit === 'J');
  return new Map([['', new Map(entries.map(([name, , value]) => [name, value]))]]);
}

/** @param {ArrayLike<number>[]|null} columns of the history */
export function show_balances(element, run, columns, timeline) {
  const balances = run.summary?.balances ?? {};
  const picture = el('div', {});
  const parts = [];
  if (run.summary) {
    parts.push(
      Object.keys(balances).length
        ? verdicts(balances)
        : el('p', {class: 'empty'}, 'The balances are drawn up when a run ends; this one did not come to that.'),
    );
  } else {
    parts.push(
      el('p', {class: 'note'}, 'The balances are drawn up when the run ends.', columns ? ' So far, by the last row of the history:' : ''),
    );
  }
  const stages = balances.energy ? terms_by_stage(balances.energy.terms) : columns ? terms_so_far(run.history, columns) : null;
  if (stages) parts.push(el('h3', {}, 'Energy'), el('p', {}, energy_words(stages.get(''))), picture, energy_table(stages));
  if (balances.momentum) parts.push(el('h3', {}, 'Momentum'), momentum_table('Momentum', balances.momentum, 'kg m/s'));
  if (balances.angular_momentum) parts.push(momentum_table('Angular momentum about the origin', balances.angular_momentum, 'kg m^2/s'));
  element.replaceChildren(...parts);
  if (stages && !(columns && energy_picture(picture, run.history, columns, timeline)))
    picture.append(
      el(
        'p',
        {class: 'note'},
        columns ? 'No energies changed.' : 'How energies went in time is not known: no history was asked for (outputs.history).',
      ),
    );
}
