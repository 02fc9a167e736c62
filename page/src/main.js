// The page of a run: reads what talus has put into the document, and starts what shows it.
import 'uplot/dist/uPlot.min.css';
import './page.css';
import {make_blocks} from './blocks.js';
import {group_by_unit, split_columns} from './columns.js';
import {make_controls} from './controls.js';
import {el} from './dom.js';
import {show_balances} from './balances.js';
import {show_histories, thinned_note} from './histories.js';
import {make_keys} from './keys.js';
import {follow, go_back} from './live.js';
import {metric_table, remarks_of, show_cost, show_head, show_overview} from './overview.js';
import {show_line, show_scene} from './scene_text.js';
import {make_state} from './state.js';
import {make_timeline} from './timeline.js';
import {start_viewer} from './viewer.js';

const FORMAT = 1;
const place = (id) => document.getElementById(id);

/** The run, or words why there is none. */
function read_run() {
  const element = place('run');
  if (!element) return {problem: 'This is the empty page that talus report fills: it holds no run.'};
  let run;
  try {
    run = JSON.parse(element.textContent);
  } catch (error) {
    return {problem: `What talus has written into this page cannot be read: ${error.message}. The file may have been cut off.`};
  }
  if (run.format !== FORMAT)
    return {
      problem: `The run in this page is written in format ${run.format}; the page reads format ${FORMAT}. Make it again with one version of talus report.`,
    };
  return {run: {warnings: [], notes: [], metrics: [], ...run}};
}

/** Every part on its own: what goes wrong in one is told there and leaves the others alone. */
async function fill(id, action) {
  try {
    await action(place(id));
  } catch (error) {
    console.error(error);
    place(id).append(el('p', {class: 'empty', role: 'alert'}, `This part cannot be shown: ${error.message}`));
  }
}

/** Frame whose time is nearest. */
function nearest_frame(frames, time) {
  let nearest = 0;
  frames.forEach((frame, f) => {
    if (Math.abs(frame.time - time) < Math.abs(frames[nearest].time - time)) nearest = f;
  });
  return nearest;
}

/** When what has been put into the page is on the screen, or soon, where nothing is painted (a page in the background). */
const painted = () =>
  new Promise((go_on) => {
    requestAnimationFrame(() => setTimeout(go_on));
    setTimeout(go_on, 200);
  });

async function show(run) {
  const state = make_state();
  const blocks = make_blocks();
  const remarks = remarks_of(run);
  show_head(run);
  new ResizeObserver(([entry]) => document.documentElement.style.setProperty('--head', `${entry.target.offsetHeight}px`)).observe(
    document.querySelector('header'),
  );
  fill('overview-body', (element) => show_overview(element, run, remarks));
  fill('scene-body', (element) => show_scene(element, run.scene, remarks, run.summary?.scene?.set));
  fill('cost-body', (element) => show_cost(element, run));

  // Numbers first: the picture takes the browser's time while its programs are made, seconds where no graphics card helps.
  let viewer = null;
  const frames = run.particles?.frames ?? [];
  const timeline = make_timeline((time) => viewer?.go_to(nearest_frame(frames, time)));

  let columns = null;
  await fill('histories-body', async (element) => {
    if (!run.history?.rows) {
      element.replaceChildren(
        el(
          'p',
          {class: 'empty'},
          run.live ? 'The history has no rows so far.' : 'No history was asked for: outputs.history of the scene does that.',
        ),
      );
      place('zoom').hidden = true;
      return;
    }
    columns = split_columns(await blocks.numbers(run.history.values), run.history);
    show_histories(element, run.history, columns, {timeline, chosen: state.get().plots, keep: (plots) => state.set({plots})});
    element.append(thinned_note(run.history) ?? '');
  });
  await fill('balances-body', (element) => show_balances(element, run, columns, timeline));
  await fill('runout-body', async (element) => {
    element.replaceChildren(...metric_table(run.metrics));
    if (run.run_out?.rows) {
      const plots = element.appendChild(el('div', {}));
      const table = run.run_out;
      show_histories(plots, table, split_columns(await blocks.numbers(table.values), table), {
        timeline,
        group: group_by_unit,
        chosen: null,
        keep: () => {},
      });
    }
    if (!element.childElementCount) element.append(el('p', {class: 'empty'}, 'Nothing to measure: no particles were written.'));
  });

  await painted();
  await fill('stage', () => {
    viewer = start_viewer(run, state, blocks);
    make_keys(run, viewer, viewer ? make_controls(run, viewer, state).save_picture : null);
  });
  if (!viewer) place('viewer').classList.add('without');
  viewer?.listen(({frame}) => timeline.set_now(frame.time));

  place('zoom-in').addEventListener('click', () => timeline.zoom_by(2));
  place('zoom-out').addEventListener('click', () => timeline.zoom_by(0.5));
  place('zoom-all').addEventListener('click', () => timeline.whole());

  if (state.get().line)
    show_line(state.get().line, /line=|^#L/.test(location.hash) && performance.getEntriesByType('navigation')[0]?.type !== 'reload');
  state.listen(({line}, changed) => changed.has('line') && line && show_line(line));
  addEventListener('click', (event) => {
    // links within the page leave the address to the choices
    const target = event.target.closest?.('a[href^="#"]')?.getAttribute('href').slice(1);
    if (!target) return;
    event.preventDefault();
    const line = /^L(\d+)$/.exec(target);
    if (line) {
      state.set({line: Number(line[1])});
      show_line(Number(line[1]));
    } else {
      place(target)?.scrollIntoView({behavior: matchMedia('(prefers-reduced-motion: reduce)').matches ? 'auto' : 'smooth'});
      place(target)?.focus({preventScroll: true});
    }
  });
  if (run.live) {
    follow(run.live, state.keep);
    go_back();
  }
  await viewer?.ready;
  if (frames.length && viewer) timeline.set_now(frames[viewer.current()].time);
  document.documentElement.dataset.ready = 'yes';
}

const {run, problem} = read_run();
if (problem) {
  place('page').replaceChildren(el('p', {class: 'empty', role: 'alert'}, problem));
  document.documentElement.dataset.ready = 'yes';
} else {
  show(run);
}
