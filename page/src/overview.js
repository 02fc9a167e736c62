// What was run and how it went: the head of the page, warnings, stages, bodies, cost.
import {duration, el, number, split_unit, table, unit, whole, with_unit} from './dom.js';
import {line_in} from './scene_text.js';

const STATUS = {done: 'done', failed: 'failed', stopped: 'stopped'};

/** Warnings, and the error of a run that failed, with their lines. */
export function remarks_of(run) {
  const warnings = run.warnings.map(({text, line}) => ({text, line: line ?? line_in(text), kind: 'warning'}));
  const message = run.summary?.message;
  return message
    ? [{text: message, line: line_in(message), kind: run.summary.status === 'stopped' ? 'stopped' : 'error'}, ...warnings]
    : warnings;
}

export function show_head(run) {
  const {summary, particles} = run;
  document.title = `${run.title || run.name} - Talus`;
  document.getElementById('title').textContent = run.title || run.name;
  const status = summary ? (STATUS[summary.status] ?? summary.status) : 'going on';
  const facts = [
    el('span', {class: `status ${summary?.status ?? 'going'}`}, status),
    `${run.dimension}-D`,
    summary?.kernel && `kernel ${summary.kernel}`,
    summary?.transfer,
    summary?.program && `talus ${summary.program.version}, commit ${summary.program.commit}`,
    particles && `${whole(particles.total)} particles`,
    summary?.mesh?.cells && `${whole(summary.mesh.cells)} cells`,
    summary?.steps && `${whole(summary.steps)} steps`,
    summary?.steps && `${number(summary['simulated_time [s]'])} s simulated`,
    summary?.cost?.['wall [s]'] && `${duration(summary.cost['wall [s]'])} of computing`,
  ].filter(Boolean);
  document.getElementById('facts').replaceChildren(...facts.map((fact) => el('li', {}, fact)));
}

function remark_list(remarks) {
  if (!remarks.length) return el('p', {class: 'note'}, 'No warnings.');
  return el(
    'ul',
    {class: 'remarks'},
    remarks.map(({text, line, kind}, k) =>
      el(
        'li',
        {id: `warning-${k}`, class: kind},
        el('b', {}, `${kind}: `),
        text,
        line ? [' ', el('a', {href: `#L${line}`}, `line ${line}`)] : null,
      ),
    ),
  );
}

const stage_table = (stages) =>
  table(
    'Stages',
    ['stage', 'result', 'steps', 'simulated', 'unbalanced / loads', 'when it began'],
    stages.map((stage, k) => [
      `${k} ${stage.name ?? stage.kind}`,
      stage.result || '–',
      whole(stage.steps),
      with_unit(stage['duration [s]'], 's'),
      stage.residual === undefined ? '–' : number(stage.residual, 3),
      stage.residual_at_begin === undefined ? '–' : number(stage.residual_at_begin, 3),
    ]),
  );

const body_table = (bodies) =>
  table(
    'Bodies',
    ['body', 'material', 'law', 'particles', 'mass'],
    bodies.map((body) => [
      body.name,
      body.material,
      body.law,
      body.particles === undefined ? '–' : whole(body.particles),
      with_unit(body['mass [kg]'], 'kg'),
    ]),
  );

export function show_overview(element, run, remarks) {
  const {summary} = run;
  const going =
    !summary &&
    el(
      'p',
      {class: 'note'},
      run.live
        ? 'The run is going on; this page is renewed as it goes.'
        : 'There is no summary: the run was going on when this page was made, or was ended from outside.',
    );
  const origin =
    summary?.initial &&
    el(
      'p',
      {},
      `The bodies began where another run ended: ${summary.initial.file}, step ${whole(summary.initial.step)}, ${number(summary.initial['time [s]'])} s.`,
    );
  element.replaceChildren(
    ...[
      going,
      remark_list(remarks),
      origin,
      run.notes?.length
        ? el(
            'ul',
            {class: 'notes', 'aria-label': 'What this page leaves out'},
            run.notes.map((note) => el('li', {}, note)),
          )
        : null,
      summary?.stages?.length ? stage_table(summary.stages) : null,
      summary?.changes?.length ? el('ul', {class: 'changes'}, summary.changes.map((change) => el('li', {}, change))) : null,
      body_table(summary?.bodies?.length ? summary.bodies : (run.particles?.bodies ?? [])),
    ].filter(Boolean),
  );
}

export function show_cost(element, run) {
  const cost = run.summary?.cost;
  if (!(cost?.['wall [s]'] > 0)) {
    // a run that was ended from outside leaves a summary without numbers
    element.replaceChildren(el('p', {class: 'empty'}, 'What a run costs is written when it ends.'));
    return;
  }
  const phases = Object.entries(cost.wall_by_phase ?? {}).sort(([, a], [, b]) => b - a);
  const total = cost['wall [s]'];
  const rest = total - phases.reduce((sum, [, seconds]) => sum + seconds, 0);
  if (rest > 0.005 * total) phases.push(['everything else', rest]);
  const most = Math.max(...phases.map(([, seconds]) => seconds), 1e-12);
  const bars = el(
    'ul',
    {class: 'bars', 'aria-label': 'Wall time by phase'},
    phases.map(([name, seconds]) => {
      const bar = el('i', {'aria-hidden': 'true'});
      bar.style.width = `${(100 * seconds) / most}%`;
      return el(
        'li',
        {},
        el('span', {}, name),
        el('span', {class: 'track'}, bar),
        el('span', {}, `${duration(seconds)}, ${number((100 * seconds) / total, 2)} %`),
      );
    }),
  );
  const facts = [
    ['wall time', duration(total)],
    ['speed', `${number(cost.particle_steps_per_second / 1e6, 3)} million particle-steps a second`],
    ['threads', cost.threads],
    ...Object.entries(cost.ranks ?? {})
      .filter(([name]) => name !== 'count' || cost.ranks.count > 1)
      .map(([name, value]) => [
        split_unit(name)[0]
          .replaceAll('_', ' ')
          .replace(/^count$/, 'ranks'),
        with_unit(value, split_unit(name)[1]),
      ]),
    ['memory at most', cost['peak_memory [B]'] ? `${number(cost['peak_memory [B]'] / 2 ** 20, 4)} MiB` : '–'],
    ['state of a particle', `${number(cost.bytes_per_particle)} bytes`],
    ['compiler', run.summary.program?.compiler],
    ['build', run.summary.program?.build],
  ];
  element.replaceChildren(
    bars,
    el(
      'dl',
      {class: 'facts'},
      facts.flatMap(([name, value]) => [el('dt', {}, name), el('dd', {}, value ?? '–')]),
    ),
  );
}

/** Numbers about run-out and crest, by what they are about. */
export function metric_table(metrics) {
  const groups = new Map();
  for (const metric of metrics) groups.set(metric.group, [...(groups.get(metric.group) ?? []), metric]);
  return [...groups].map(([group, rows]) =>
    table(
      group,
      ['what', 'value', 'how it was measured'],
      rows.map(({name, value, unit: its, note}) => [
        name,
        typeof value === 'number' || value === null ? with_unit(value, its) : `${value} ${unit(its)}`,
        el('span', {class: 'how'}, note ?? ''),
      ]),
      {class: 'metrics'},
    ),
  );
}
