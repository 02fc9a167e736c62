// Keys, and the page that lists them.
import {el} from './dom.js';

const CANVAS_KEYS = {
  ArrowLeft: {turn: 0.1},
  ArrowRight: {turn: -0.1},
  ArrowUp: {tilt: -0.1},
  ArrowDown: {tilt: 0.1},
  '+': {zoom: 1.2},
  '=': {zoom: 1.2},
  '-': {zoom: 1 / 1.2},
};
const SHIFTED = {ArrowLeft: {right: -0.05}, ArrowRight: {right: 0.05}, ArrowUp: {up: 0.05}, ArrowDown: {up: -0.05}};

function make_help(rows) {
  const dialog = el(
    'dialog',
    {id: 'help', 'aria-labelledby': 'help-title'},
    el('h2', {id: 'help-title'}, 'Keys'),
    el(
      'dl',
      {},
      rows.map(([keys, words]) => [
        el(
          'dt',
          {},
          keys.map((key) => el('kbd', {}, key)),
        ),
        el('dd', {}, words),
      ]),
    ),
    el('form', {method: 'dialog'}, el('button', {}, 'Close')),
  );
  document.body.append(dialog);
  return dialog;
}

export function make_keys(run, viewer, save_picture) {
  const flat = run.dimension === 2;
  const rows = [
    [['space'], 'play or pause'],
    [[',', '.'], 'one frame back, one on'],
    [['Home', 'End'], 'first frame, last frame'],
    ...(flat
      ? []
      : [
          [['1', '2', '3', '4'], 'oblique, front, side, top'],
          [['o'], 'with or without perspective'],
        ]),
    [['f'], 'all of it'],
    [['p'], 'save the picture'],
    [['←', '→', '↑', '↓'], flat ? 'with shift, and the picture chosen: move it' : 'the picture chosen: turn it; with shift: move it'],
    [['+', '−'], 'the picture chosen: nearer, further'],
    [['?'], 'this list'],
  ];
  const help = make_help(rows);
  document.getElementById('help-button').addEventListener('click', () => help.showModal());

  const actions = {
    '?': () => help.showModal(),
    ...(viewer && {
      ' ': () => viewer.play(),
      ',': () => viewer.step(-1),
      '.': () => viewer.step(1),
      Home: () => viewer.go_to(0),
      End: () => viewer.go_to(viewer.last),
      f: () => viewer.look_from('fit'),
      p: save_picture,
      ...(!flat && {
        1: () => viewer.look_from('iso'),
        2: () => viewer.look_from('front'),
        3: () => viewer.look_from('side'),
        4: () => viewer.look_from('top'),
        o: () => document.querySelector('[name="orthographic"]').click(),
      }),
    }),
  };
  addEventListener('keydown', (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey || help.open) return;
    const {target, key} = event;
    if (target.closest('select, input[type="number"]')) return; // typing
    if (key === ' ' && target.closest('button, summary, a, input[type="checkbox"]')) return; // these have a use for it themselves
    if (['Home', 'End'].includes(key) && (target.type === 'range' || !(target === document.body || target.closest('#viewer')))) return;
    if (viewer && event.target.id === 'canvas') {
      const nudge = (event.shiftKey && SHIFTED[event.key]) || (!event.shiftKey || event.key === '+' ? CANVAS_KEYS[event.key] : null);
      if (nudge) {
        event.preventDefault();
        viewer.view.eye.nudge(nudge);
        return;
      }
    }
    const action = actions[event.key];
    if (!action) return;
    event.preventDefault();
    action();
  });
}
