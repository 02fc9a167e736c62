// What the reader sets about the picture: time, colours, section, limits, display; and the keys for it.
import {MAPS} from './colours.js';
import {choice, el, icon, number, unit} from './dom.js';
import {BODY, field_index, limit_of, section_normal, span_along} from './shown.js';
import {save} from './picture.js';

const SLIDER = 1000; // steps of a slider

/** A number that may be left empty; what is not a number is left as it was. */
function number_input(label, name, apply) {
  return el(
    'label',
    {},
    el('span', {}, label),
    el('input', {
      name,
      type: 'number',
      step: 'any',
      inputmode: 'decimal',
      change: ({target}) => apply(target.value === '' || !Number.isFinite(target.valueAsNumber) ? null : target.valueAsNumber),
    }),
  );
}

const group = (title, ...children) => el('fieldset', {}, el('legend', {}, title), children);

/** Shows what the state says, unless the reader is typing there. */
function show_value(root, name, value) {
  const input = root.querySelector(`[name="${name}"]`);
  if (!input || (input === document.activeElement && input.type === 'number')) return;
  if (input.type === 'checkbox') input.checked = value;
  else input.value = value ?? '';
}

/** Play, step, slider, time. */
function make_time_bar(run, viewer, state) {
  const bar = document.getElementById('time');
  const frames = run.particles?.frames ?? [];
  if (!frames.length) {
    bar.hidden = true;
    return;
  }
  const play = el(
    'button',
    {type: 'button', 'aria-label': 'Play', title: 'Play or pause (space)', click: () => viewer.play()},
    icon('play'),
  );
  const slider = el('input', {
    type: 'range',
    min: 0,
    max: frames.length - 1,
    step: 1,
    'aria-label': 'Frame',
    input: ({target}) => viewer.go_to(target.valueAsNumber),
  });
  const time = el('output', {});
  bar.append(
    el('button', {type: 'button', 'aria-label': 'First frame', title: 'First frame (Home)', click: () => viewer.go_to(0)}, icon('first')),
    el('button', {type: 'button', 'aria-label': 'One frame back', title: 'One frame back (,)', click: () => viewer.step(-1)}, icon('back')),
    play,
    el('button', {type: 'button', 'aria-label': 'One frame on', title: 'One frame on (.)', click: () => viewer.step(1)}, icon('next')),
    el(
      'button',
      {type: 'button', 'aria-label': 'Last frame', title: 'Last frame (End)', click: () => viewer.go_to(frames.length - 1)},
      icon('last'),
    ),
    slider,
    time,
  );
  const show = () => {
    const index = viewer.current();
    slider.value = index;
    time.textContent = `${number(frames[index].time)} s`;
    slider.setAttribute('aria-valuetext', `${number(frames[index].time)} seconds, frame ${index + 1} of ${frames.length}`);
    time.title = `frame ${index + 1} of ${frames.length}`;
  };
  viewer.listen_play((playing) => {
    play.replaceChildren(icon(playing ? 'pause' : 'play'));
    play.setAttribute('aria-label', playing ? 'Pause' : 'Play');
  });
  state.listen(show);
  show();
}

function make_colour_group({particles}, viewer, state) {
  const fields = particles.fields.map(({name, label}) => [name, label || name]);
  const by_hand = (changes) => {
    const [from, to] = viewer.colour_range() ?? [null, null];
    state.set({from, to, ...changes, range: 'hand'});
  };
  const root = group(
    'Colours',
    choice('by', [...fields, [BODY, 'body']], {
      name: 'field',
      change: ({target}) => state.set({field: target.value, range: 'auto', from: null, to: null}),
    }),
    el(
      'div',
      {class: 'pair'},
      choice(
        'map',
        Object.keys(MAPS).map((name) => [name, name]),
        {name: 'map', change: ({target}) => state.set({map: target.value})},
      ),
      choice(
        'range',
        [
          ['auto', 'auto'],
          ['run', 'whole run'],
          ['frame', 'this frame'],
          ['hand', 'by hand'],
        ],
        {
          name: 'range',
          change: ({target}) => (target.value === 'hand' ? by_hand({}) : state.set({range: target.value, from: null, to: null})),
        },
      ),
    ),
    el(
      'div',
      {class: 'pair'},
      number_input('from', 'from', (from) => by_hand({from})),
      number_input('to', 'to', (to) => by_hand({to})),
    ),
  );
  const show = () => {
    const choices = state.get();
    const index = field_index(particles, choices.field);
    show_value(root, 'field', index < 0 ? BODY : particles.fields[index].name);
    show_value(root, 'map', choices.map);
    show_value(root, 'range', choices.range);
    const range = viewer.colour_range();
    show_value(root, 'from', range && +range[0].toPrecision(4));
    show_value(root, 'to', range && +range[1].toPrecision(4));
    for (const name of ['map', 'range', 'from', 'to']) root.querySelector(`[name="${name}"]`).disabled = index < 0;
  };
  state.listen(show);
  viewer.listen(show);
  show();
  return root;
}

function make_section_group(run, viewer, state) {
  const {bounds, eye} = viewer.view;
  const axes = [
    ['none', 'none'],
    ['x', 'across x'],
    ['y', 'across y'],
    ...(run.dimension === 3
      ? [
          ['z', 'across z'],
          ['view', 'across the line of sight'],
        ]
      : []),
  ];
  const slider = el('input', {
    type: 'range',
    name: 'slide',
    min: 0,
    max: SLIDER,
    step: 1,
    'aria-label': 'Place of the section',
    input: ({target}) => {
      const [least, most] = span_along(section_normal(state.get()), bounds);
      state.set({at: least + ((most - least) * target.valueAsNumber) / SLIDER});
    },
  });
  const root = group(
    'Section',
    choice('cut', axes, {
      name: 'section',
      change: ({target}) => {
        const normal = target.value === 'view' ? eye.towards().toArray() : null;
        state.set({section: target.value, normal, at: null, flip: target.value === 'none' ? false : state.get().flip});
      },
    }),
    slider,
    el(
      'div',
      {class: 'pair'},
      number_input('at [m]', 'at', (at) => state.set({at})),
      el(
        'label',
        {class: 'tick'},
        el('input', {type: 'checkbox', name: 'flip', change: ({target}) => state.set({flip: target.checked})}),
        'flip',
      ),
    ),
  );
  const show = () => {
    const choices = state.get();
    const normal = section_normal(choices);
    show_value(root, 'section', choices.section);
    show_value(root, 'flip', choices.flip);
    for (const name of ['slide', 'at', 'flip']) root.querySelector(`[name="${name}"]`).disabled = !normal;
    if (!normal) {
      show_value(root, 'at', null);
      return;
    }
    const [least, most] = span_along(normal, bounds);
    const at = choices.at ?? (least + most) / 2;
    slider.value = (SLIDER * (at - least)) / (most - least || 1);
    slider.setAttribute('aria-valuetext', `${number(at)} metres`);
    show_value(root, 'at', +at.toPrecision(4));
  };
  state.listen(show);
  show();
  return root;
}

function make_limit_group({particles}, state) {
  const root = group(
    'Only values',
    choice('of', [['', 'every particle'], ...particles.fields.map(({name, label}) => [name, label || name])], {
      name: 'only',
      change: ({target}) => state.set({only: target.value || null, lowest: null, highest: null}),
    }),
    el(
      'div',
      {class: 'pair'},
      number_input('at least', 'lowest', (lowest) => state.set({lowest})),
      number_input('at most', 'highest', (highest) => state.set({highest})),
    ),
    el('p', {class: 'note'}),
  );
  const show = () => {
    const choices = state.get();
    const field = particles.fields.find(({name}) => name === choices.only);
    show_value(root, 'only', field ? field.name : '');
    for (const name of ['lowest', 'highest']) {
      show_value(root, name, field ? choices[name] : null);
      root.querySelector(`[name="${name}"]`).disabled = !field;
    }
    root.querySelector('.note').textContent = !field
      ? ''
      : `${limit_of(particles, choices) ? '' : 'No limit so far. '}In this run ${number(field.low, 3)} to ${number(field.high, 3)} ${unit(field.unit)}`;
  };
  state.listen(show);
  show();
  return root;
}

function make_display_group(run, state) {
  const meshes = [['none', 'hidden'], ['outline', 'outline'], ...(run.mesh?.cells ? [['cells', 'every edge']] : [])];
  const root = group(
    'Display',
    run.particles
      ? el(
          'label',
          {},
          el('span', {}, 'size'),
          el('input', {
            type: 'range',
            name: 'size',
            min: 0.3,
            max: 2,
            step: 0.1,
            input: ({target}) => state.set({size: target.valueAsNumber}),
          }),
        )
      : null,
    run.mesh ? choice('mesh', meshes, {name: 'mesh', change: ({target}) => state.set({mesh: target.value})}) : null,
    run.ground
      ? el(
          'label',
          {class: 'tick'},
          el('input', {type: 'checkbox', name: 'ground', change: ({target}) => state.set({ground: target.checked})}),
          'ground',
        )
      : null,
    run.rigid
      ? el(
          'label',
          {class: 'tick'},
          el('input', {type: 'checkbox', name: 'rigid', change: ({target}) => state.set({rigid: target.checked})}),
          'rigid bodies',
        )
      : null,
    run.dimension === 3
      ? el(
          'label',
          {class: 'tick'},
          el('input', {type: 'checkbox', name: 'orthographic', change: ({target}) => state.set({orthographic: target.checked})}),
          'parallel view',
        )
      : null,
  );
  const show = () => {
    const choices = state.get();
    for (const name of ['size', 'mesh', 'ground', 'rigid', 'orthographic']) show_value(root, name, choices[name]);
  };
  state.listen(show);
  show();
  return root;
}

export function make_controls(run, viewer, state) {
  make_time_bar(run, viewer, state);
  const views =
    run.dimension === 3
      ? [
          ['iso', 'Oblique', 1],
          ['front', 'Front', 2],
          ['side', 'Side', 3],
          ['top', 'Top', 4],
          ['fit', 'All', 'f'],
        ]
      : [['fit', 'All', 'f']];
  const save_picture = () => {
    const index = viewer.current();
    const field = run.particles ? (state.get().field ?? run.particles.fields[run.particles.field ?? 0]?.name ?? BODY) : 'mesh';
    save(viewer.picture(), run.title, `${run.name || 'talus'}_${field}_${String(index).padStart(4, '0')}.png`);
  };
  document
    .getElementById('views')
    .append(
      ...views.map(([name, words, key]) =>
        el('button', {type: 'button', title: `${words} (${key})`, click: () => viewer.look_from(name)}, words),
      ),
      el('button', {type: 'button', title: 'Save the picture (p)', click: save_picture}, 'Save PNG'),
    );
  document
    .getElementById('controls')
    .append(
      ...[
        run.particles && make_colour_group(run, viewer, state),
        run.particles && make_section_group(run, viewer, state),
        run.particles?.fields.length ? make_limit_group(run, state) : null,
        make_display_group(run, state),
      ].filter(Boolean),
    );
  return {save_picture};
}
