// Reports with made-up runs, written as talus report writes them. Usage: node sample.mjs TEMPLATE OUT [column|block|valley|ram|tumbler|million|failed|bare]
import {readFileSync, writeFileSync} from 'node:fs';
import {fileURLToPath} from 'node:url';
import {fill, grown, make_packer, make_random, pack_ground, pack_mesh, pack_particles, pack_rigid_box} from './sample_blocks.mjs';

const SCENE = `# A column of sand falls over its foot.
title: Collapse of a column
dimension: 2

mesh:
  size: 0.05                                     # m
  regions:
    - {name: sand, shape: {type: box, low: [0, 0], high: [1, 2]}}
    - {name: "air", shape: {type: box, low: [1, 0], high: [5, 2]}}

materials:
  - {name: sand, law: drucker_prager, density: 1600, youngs_modulus: 1.0e6, poisson_ratio: 0.3, friction_angle: 31}

bodies:
  - {name: column, material: sand, region: sand, particles_per_cell: 4}

loads:
  - {type: gravity, acceleration: [0, -9.81]}

boundaries:
  - {type: friction, on: y_min, coefficient: 0.4}
  - {type: roller, on: x_min}

time: {end: 2}

outputs:
  particles: {every: 0.1, fields: [velocity, plastic_strain]}
  history: {every: 0.01, fronts: [{name: toe, direction: +x}]}
`;

function summary_of(title, dimension, particles, rows, columns) {
  const end = Object.fromEntries(columns.map(({name}, c) => [name, rows.at(-1)[c]]));
  const term = (name) => end[name] ?? 0;
  return {
    title,
    status: 'done',
    program: {version: '0.1.0', commit: '0123456789ab', compiler: 'GNU 12.2.0', build: 'Release: -O3'},
    dimension,
    kernel: 'projected',
    transfer: 'aflip, musl',
    mesh: {nodes: 4141, cells: 8000, digest: 'c75b770bebecbbc4', quality: {}},
    bodies: [{name: 'column', material: 'sand', law: 'drucker_prager', particles, 'mass [kg]': 3200}],
    stages: [
      {kind: 'geostatic', result: 'reached', steps: 812, 'duration [s]': 0.4, residual: 0.0041, residual_at_begin: 0.21},
      {kind: 'run', result: 'done', steps: 9120, 'duration [s]': 2},
    ],
    steps: 9932,
    'simulated_time [s]': 2.4,
    cost: {
      ranks: {count: 1},
      threads: 4,
      'wall [s]': 312.5,
      wall_by_phase: {mesh: 1.2, locate: 30.1, scatter: 81.4, nodes: 12.2, gather: 90.3, stress: 71.9, output: 18.8},
      particle_steps_per_second: 3.4e6,
      bytes_per_particle: 444,
      'peak_memory [B]': 108187648,
    },
    balances: {
      energy: {
        terms: {
          ...Object.fromEntries(['gravity_work', 'load_work', 'wall_work'].map((name) => [`${name} [J]`, term(name)])),
          'kinetic_start [J]': 0,
          ...Object.fromEntries(
            ['kinetic', 'strain', 'plastic', 'friction', 'damping', 'carried_away', 'transfer_loss', 'energy_defect'].map((name) => [
              `${name} [J]`,
              term(name),
            ]),
          ),
          'unexplained / dissipated': 0.031,
          'stage 0 geostatic: gravity_work [J]': 10,
          'stage 0 geostatic: kinetic [J]': 1,
        },
        closure: 0.0044,
        relative_to: 'largest term',
        closes: true,
      },
      momentum: {
        'start [kg m/s]': [0, 0, 0].slice(0, dimension),
        'end [kg m/s]': [12, -3, 0].slice(0, dimension),
        'impulse [kg m/s]': [12, -3, 0].slice(0, dimension),
        closure: 2e-16,
        relative_to: 'momenta at the start and impulses',
        closes: true,
      },
      angular_momentum: {
        'start [kg m^2/s]': [0],
        'end [kg m^2/s]': [-41.2],
        'impulse [kg m^2/s]': [-37.9],
        closure: 0.08,
        relative_to: 'their moments',
        closes: false,
      },
      mass: {
        'start [kg]': 3200,
        'end [kg]': 3200,
        'removed [kg]': 0,
        particles_removed: 0,
        closure: 0,
        relative_to: 'mass at the start',
        closes: true,
      },
    },
    watch: {},
    warnings: [],
    files: [],
    scene: {file: 'scene.yaml', set: []},
  };
}

function pack_history(packer, end, mass) {
  const columns = [
    ['time', 's'],
    ['dt', 's'],
    ['kinetic', 'J'],
    ['strain', 'J'],
    ['plastic', 'J'],
    ['friction', 'J'],
    ['damping', 'J'],
    ['carried_away', 'J'],
    ['gravity_work', 'J'],
    ['load_work', 'J'],
    ['wall_work', 'J'],
    ['transfer_loss', 'J'],
    ['energy_defect', 'J'],
    ['momentum_x', 'kg m/s'],
    ['momentum_y', 'kg m/s'],
    ['reaction_y_min_y', 'N'],
    ['crest_x', 'm'],
    ['crest_ux', 'm'],
    ['crest_uy', 'm'],
    ['toe', 'm'],
  ].map(([name, unit]) => ({name, unit}));
  const rows = Array.from({length: 201}, (_, k) => {
    const t = (end * k) / 200,
      s = grown((2.2 * t) / end);
    const work = mass * 9.81 * 0.6 * s,
      kinetic = 0.35 * mass * 9.81 * Math.sin(Math.PI * Math.min(1, (1.3 * t) / end)) ** 2 * (t < end / 1.3 ? 1 : 0.02);
    const left = work - kinetic;
    return [
      t,
      2e-4 + 1e-5 * Math.sin(20 * t),
      kinetic,
      0.02 * left,
      0.62 * left,
      0.27 * left,
      0,
      0,
      work,
      0,
      0,
      0.095 * left,
      -0.005 * left,
      (900 * kinetic) / mass,
      (-400 * kinetic) / mass,
      mass * 9.81 * (1 + 0.1 * Math.cos(15 * t)),
      1,
      1.4 * s,
      -0.9 * s,
      1 + 2.2 * s,
    ];
  });
  return {history: packer.table(columns, rows), columns, rows};
}

function pack_run_out(packer, times) {
  const rows = times.map((t, n) => {
    const s = grown((2.2 * t) / times.at(-1));
    return [t, 2 - 1.1 * s, n > 0 ? 1 + 2.2 * s : NaN]; // nothing has moved at the first
  });
  return packer.table(
    [
      {name: 'time', unit: 's'},
      {name: 'crest', unit: 'm', label: 'highest point'},
      {name: 'front_x', unit: 'm', label: 'front towards +x'},
    ],
    rows,
  );
}

const METRICS = [
  {
    group: 'run-out',
    name: 'run-out of the toe',
    value: 2.18,
    unit: 'm',
    note: 'largest x of all particles at the last output less that at the first',
  },
  {group: 'run-out', name: 'H/L', value: 0.47, unit: '', note: 'fall of the crest to the farthest toe over the distance between them'},
  {group: 'crest', name: 'drop of the highest point', value: 1.09, unit: 'm', note: 'against gravity, first output to last'},
];

/** A column of sand in plane strain that spreads over its foot. */
export function collapsing_column(count = 6000) {
  const packer = make_packer();
  const random = make_random(1);
  const start = Array.from({length: count}, () => [random(), 2 * random()]);
  const times = Array.from({length: 13}, (_, k) => k / 6);
  const spread = (t) => grown(1.1 * t);
  const move = ([x, y], t) => {
    const s = spread(t);
    const top = 1 - s * 0.62;
    return [x * (1 + 2.2 * s * (1 - 0.42 * y)) + 0.1 * s * x * Math.sin(5 * y), y * top * (1 - 0.28 * s * x)];
  };
  const particles = pack_particles(packer, {
    start,
    times,
    move,
    bodies: start.map(([, y]) => (y > 1 ? 1 : 0)),
    dimension: 2,
    radius: Math.sqrt(2 / count) / 1.7,
    names: [
      {name: 'column', material: 'sand', law: 'drucker_prager'},
      {name: 'upper half', material: 'sand', law: 'drucker_prager'},
    ],
    fields: [
      {name: 'displacement', label: 'displacement', unit: 'm', of: (a, b) => Math.hypot(b[0] - a[0], b[1] - a[1])},
      {
        name: 'plastic_strain',
        label: 'plastic strain',
        unit: '',
        of: (a, b, t) => spread(t) * Math.exp(-(((a[0] + a[1] - 1.4) / 0.35) ** 2)),
      },
      {name: 'pressure', label: 'pressure', unit: 'Pa', of: (a, b, t, p) => (p % 997 === 0 ? NaN : 1600 * 9.81 * (2 - b[1] - 0.3 * b[0]))},
    ],
  });
  const {history, columns, rows} = pack_history(packer, 2, 3200);
  const run = {
    format: 1,
    title: 'Collapse of a column',
    name: 'column',
    dimension: 2,
    up: [0, 1, 0],
    live: null,
    summary: summary_of('Collapse of a column', 2, count, rows, columns),
    scene: {file: 'scene.yaml', text: SCENE},
    warnings: [{text: 'boundaries[0].coefficient: 0.4 is less than tan(friction_angle) of sand: it slides over its foot', line: 22}],
    notes: ['frames: 13 of 21 are shown'],
    particles,
    mesh: pack_mesh(packer, [0, 0], [5, 2], [50, 20]),
    history,
    run_out: pack_run_out(packer, times),
    metrics: METRICS,
  };
  return {run, texts: packer.texts};
}

/** A block that slides down a plane and breaks in two. */
export function sliding_block(across = 15, frames = 9, on_ground = false) {
  const packer = make_packer();
  const random = make_random(2);
  const [lx, ly, lz] = [3, 2, 1];
  const count = lx * ly * lz * across ** 3; // in the order of space, as a run has them
  const at = (k) => (k + 0.5 + 0.6 * (random() - 0.5)) / across;
  const start = Array.from({length: count}, (_, p) => [
    at(Math.floor(p / (across * across * ly * lz))),
    at(Math.floor(p / (across * lz)) % (across * ly)),
    at(p % (across * lz)),
  ]);
  const times = Array.from({length: frames}, (_, k) => (2 * k) / (frames - 1));
  const slope = Math.tan(Math.PI / 9);
  const move = ([x, y, z], t, body) => {
    const along = 0.5 * 9.81 * 0.12 * t * t * (body ? 1.5 : 1);
    const place = 0.2 + x + along;
    return [place, y, 4.6 - slope * place + z];
  };
  const particles = pack_particles(packer, {
    start,
    times,
    move,
    bodies: start.map(([x]) => (x > lx / 2 ? 1 : 0)),
    dimension: 3,
    radius: 0.6 / across,
    names: [
      {name: 'upper', material: 'rock', law: 'neo_hookean'},
      {name: 'lower', material: 'rock', law: 'neo_hookean'},
    ],
    range: [0, 4],
    fields: [
      {
        name: 'velocity',
        label: 'velocity',
        unit: 'm/s',
        of: ([x], b, t) => 9.81 * 0.12 * t * (x > lx / 2 ? 1.5 : 1) * (1 + 0.1 * Math.sin(3 * x)),
      },
      {name: 'height', label: 'height', unit: 'm', of: (a, b) => b[2]},
    ],
  });
  const {history, columns, rows} = pack_history(packer, 2, 15000);
  const run = {
    format: 1,
    title: 'A block slides down a plane',
    name: 'block',
    dimension: 3,
    up: [0, 0, 1],
    live: null,
    summary: summary_of('A block slides down a plane', 3, count, rows, columns),
    scene: {file: 'scene.yaml', text: SCENE},
    warnings: [],
    notes: [],
    particles,
    mesh: pack_mesh(packer, [0, 0, 0], [12, 2, 6]),
    ground: on_ground ? pack_ground(packer, (x) => 4.6 - slope * x) : null,
    history,
    run_out: pack_run_out(packer, times),
    metrics: METRICS,
  };
  return {run, texts: packer.texts};
}

/** The column, and a rigid box that moves to the left, rises and turns by 45 degrees. */
export function column_and_ram() {
  const {run, texts} = collapsing_column(2000);
  const move = (share) => ({by: [-2.5 * share, 0.5 * share], turned: (share * Math.PI) / 4});
  return {run: {...run, rigid: pack_rigid_box(make_packer(texts), run, 'ram', [3.5, 1], [4.3, 1.8], move)}, texts};
}

/** The block, and a rigid box that flies over it and turns by 45 degrees. */
export function block_and_tumbler() {
  const {run, texts} = sliding_block(8, 3);
  const move = (share) => ({by: [-4 * share, 0, share], turned: (share * Math.PI) / 4});
  return {run: {...run, rigid: pack_rigid_box(make_packer(texts), run, 'tumbler', [9, 0.5, 3.5], [10, 1.5, 4.5], move)}, texts};
}

/** A run that failed before it wrote anything but a summary. */
export function failed_run() {
  const {run} = collapsing_column(10);
  return {
    run: {
      ...run,
      title: 'Fails </script> at once',
      particles: null,
      mesh: null,
      history: null,
      run_out: null,
      metrics: [],
      notes: [],
      summary: {
        ...run.summary,
        status: 'failed',
        message: 'step 12, 0.01 s, body "column", scene.yaml:15:5: particle 7 turned inside out',
        balances: {},
      },
    },
    texts: [],
  };
}

/** A run in which nothing was asked for, still going on. */
export function bare_run() {
  const {run} = collapsing_column(10);
  return {
    run: {...run, particles: null, mesh: null, history: null, run_out: null, metrics: [], notes: [], warnings: [], summary: null},
    texts: [],
  };
}

export {fill};
export const SAMPLES = {
  column: collapsing_column,
  block: sliding_block,
  valley: () => sliding_block(8, 3, true),
  ram: column_and_ram,
  tumbler: block_and_tumbler,
  million: () => sliding_block(55, 3),
  failed: failed_run,
  bare: bare_run,
};

if (process.argv[1] === fileURLToPath(import.meta.url)) {
  const [template, out, name = 'column'] = process.argv.slice(2);
  if (!out || !SAMPLES[name]) {
    console.error(`usage: node sample.mjs TEMPLATE OUT [${Object.keys(SAMPLES).join('|')}]`);
    process.exit(2);
  }
  const {run, texts} = SAMPLES[name]();
  writeFileSync(out, fill(readFileSync(template, 'utf8'), run, texts));
}
