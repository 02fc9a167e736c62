// Particles in time: what is chosen (state) and decoded (frames) goes into the picture (scene3d), and words about it stand around it.
import {make_view} from './scene3d.js';
import {body_of, make_frames, place_of} from './frames.js';
import {colour_range, field_index, field_value, frame_index, limit_of, section_of, share_of, shown_test} from './shown.js';
import {make_legend} from './legend.js';
import {make_gauge} from './gauge.js';
import {el, number, whole, with_unit} from './dom.js';
import {value_of, NOTHING} from './decode.js';

/** The number of a particle: those from 2^31 on are of particles that were split, which have 2^40 and more in the run. */
const name_of = (id) => `particle ${id < 2 ** 31 ? whole(id) : 2 ** 40 + id - 2 ** 31}`;

const FASTEST_PLAY = 120; // ms a frame

/** Two values a particle: of the field that colours, of the one that limits. */
function join_values(count, colouring, limiting) {
  const values = new Uint16Array(2 * count);
  for (let p = 0; p < count; ++p) {
    values[2 * p] = colouring ? colouring[p] : NOTHING;
    values[2 * p + 1] = limiting ? limiting[p] : NOTHING;
  }
  return values;
}

/** Nodes of the mesh, or of the ground, as places [m], three numbers each. */
async function mesh_places(mesh, blocks) {
  const axes = await Promise.all([mesh.x, mesh.y, mesh.z].map((block) => (block ? blocks.numbers(block) : null)));
  const places = new Float32Array(3 * mesh.count);
  axes.forEach((numbers, axis) => {
    if (!numbers) return;
    const packed = numbers instanceof Uint16Array;
    for (let v = 0; v < mesh.count; ++v) places[3 * v + axis] = packed ? value_of(numbers[v], mesh.low[axis], mesh.high[axis]) : numbers[v];
  });
  return places;
}

/**
 * @param {object} run
 * @param {ReturnType<import('./state.js').make_state>} state
 * @param {ReturnType<import('./blocks.js').make_blocks>} blocks
 * @returns what the rest of the page may ask of it, or null where nothing can be drawn (words that say so are left in its place)
 */
export function start_viewer(run, state, blocks) {
  const stage = document.getElementById('stage');
  const canvas = document.getElementById('canvas');
  const particles = run.particles?.frames.length ? run.particles : null;
  if (!particles && !run.mesh) {
    stage.replaceChildren(
      el(
        'p',
        {class: 'empty'},
        run.live
          ? 'Nothing to draw yet: the run has not written particles or a mesh so far.'
          : 'Nothing to draw: the run wrote neither particles nor a mesh. outputs.particles of the scene asks for them.',
      ),
    );
    return null;
  }
  let view;
  try {
    view = make_view(canvas, run, moved);
  } catch (error) {
    console.info(error.message);
    stage.replaceChildren(
      el(
        'p',
        {class: 'empty', id: 'no-webgl'},
        'This browser does not offer WebGL 2, so particles cannot be drawn here. Everything else of the page works. ',
        'Another browser, or hardware acceleration in the settings of this one, helps.',
      ),
    );
    return null;
  }

  const frames = particles && make_frames(particles, blocks);
  const legend = make_legend(document.getElementById('legend'));
  const gauge = make_gauge(document.getElementById('gauge'), run.dimension);
  const message = document.getElementById('loading');
  const count_line = document.getElementById('shown');
  const picked = document.getElementById('particle');
  const listeners = [];
  let now = null; // the frame in the picture: {index, frame, places, colouring, limiting, field}
  let wanted = 0;
  let playing = false;
  let counting = 0;

  const last = particles ? particles.frames.length - 1 : 0;
  const current = () => frame_index(state.get(), last + 1);

  function moved() {
    gauge(view.eye, canvas);
    clearTimeout(moved.timer);
    moved.timer = setTimeout(() => state.set(eye_choices()), 150);
  }
  const eye_choices = () => ({
    towards: view.eye.towards().toArray(),
    target: view.eye.target().clone().add(view.origin).toArray(),
    height: view.eye.height(),
  });

  /** The frame that is chosen, decoded and drawn. Only the last call of several wins. */
  async function load() {
    if (!particles) return;
    const ticket = ++wanted;
    const index = current();
    const frame = particles.frames[index];
    const choices = state.get();
    const field = field_index(particles, choices.field);
    const limiting_field = particles.fields.findIndex(({name}) => name === choices.only);
    const slow = setTimeout(() => {
      message.textContent = `Unpacking ${whole(frame.count)} particles at ${number(frame.time)} s …`;
      message.hidden = false;
    }, 150);
    try {
      const [places, motion, colouring, limiting] = await Promise.all([
        frames.places(index),
        frames.rigid(index),
        field >= 0 ? frames.steps(index, field) : null,
        limiting_field >= 0 ? frames.steps(index, limiting_field) : null,
      ]);
      if (ticket !== wanted) return;
      now = {index, frame, places, colouring, limiting, field};
      view.move_rigid(motion);
      view.set_particles(frame, places, join_values(frame.count, colouring, limiting));
      apply();
      message.hidden = true;
      show_picked();
    } catch (error) {
      message.textContent = `This frame cannot be shown: ${error.message}`;
      message.hidden = false;
    } finally {
      clearTimeout(slow);
    }
    if (index < last) frames.places(index + 1).catch(() => {}); // next to be asked for, most likely
  }

  /** Colours, section and limits of what is in the picture. */
  function apply() {
    if (!now) return;
    const choices = state.get();
    const by_body = now.field < 0;
    const field = by_body ? null : particles.fields[now.field];
    const range = by_body ? [0, 1] : colour_range(particles, choices, now.field, now.colouring);
    view.set_map(by_body ? null : choices.map);
    view.set_looks({
      size: choices.size,
      range: by_body ? range : range.map((value) => share_of(value, field)),
      limit: limit_of(particles, choices),
      section: section_of(choices, view.bounds),
    });
    legend.show({field, range, map: choices.map, bodies: particles.bodies, rigid: run.rigid ?? [], missing: !by_body && !now.colouring});
    clearTimeout(counting);
    counting = setTimeout(count, 120);
    for (const listener of listeners) listener({...now, range});
  }

  const shown = () =>
    shown_test(now.frame, now.places, now.limiting, limit_of(particles, state.get()), section_of(state.get(), view.bounds));

  function count() {
    const {count: total} = now.frame;
    const choices = state.get();
    let seen = total;
    if (choices.section !== 'none' || limit_of(particles, choices)) {
      const is_shown = shown();
      seen = 0;
      for (let p = 0; p < total; ++p) seen += is_shown(p);
    }
    count_line.textContent = seen === total ? `${whole(total)} particles` : `${whole(seen)} of ${whole(total)} particles`;
  }

  function pick(x, y) {
    if (!now) return;
    const {particle, rigid} = view.found_at(x, y, now.frame, now.places, shown(), state.get().size);
    if (particle < 0) {
      state.set({particle: null, clicked: rigid ?? null});
      return;
    }
    frames.ids(now.index).then((ids) => state.set({particle: ids[particle], clicked: null}));
  }

  /** The particle that was clicked: where it is and what its fields are, in this frame; or the name of the rigid body that was. */
  async function show_picked() {
    const {particle: id, clicked} = state.get();
    picked.hidden = (id === null && clicked === null) || !now;
    if (picked.hidden) {
      view.set_mark(null);
      return;
    }
    const close = el(
      'button',
      {type: 'button', class: 'close', 'aria-label': 'Forget what was clicked', click: () => state.set({particle: null, clicked: null})},
      '×',
    );
    if (id === null) {
      view.set_mark(null);
      picked.replaceChildren(close, el('strong', {}, clicked), el('span', {}, ', rigid body'));
      return;
    }
    const {index, frame, places} = now;
    const ids = await frames.ids(index);
    const p = ids.indexOf(id);
    if (p < 0) {
      view.set_mark(null);
      picked.replaceChildren(close, el('strong', {}, name_of(id)), el('p', {}, 'is not in this frame.'));
      return;
    }
    const values = await Promise.all(particles.fields.map((_, field) => frames.steps(index, field)));
    if (now?.index !== index || state.get().particle !== id) return;
    const place = place_of(places, p, frame);
    const body = particles.bodies[body_of(places, p)];
    view.set_mark(place);
    picked.replaceChildren(
      close,
      el('strong', {}, name_of(id)),
      body ? el('span', {}, ` of ${body.name}`) : null,
      el(
        'dl',
        {},
        place.slice(0, run.dimension).flatMap((c, k) => [el('dt', {}, 'xyz'[k]), el('dd', {}, with_unit(c, 'm'))]),
        particles.fields.flatMap((field, k) => [
          el('dt', {}, field.label || field.name),
          el('dd', {}, values[k] ? with_unit(field_value(values[k], p, field), field.unit) : '–'),
        ]),
      ),
    );
  }

  /** Click, not drag. */
  let pressed = null;
  canvas.addEventListener('pointerdown', (event) => {
    pressed = [event.offsetX, event.offsetY];
  });
  canvas.addEventListener('pointerup', (event) => {
    if (pressed && event.button === 0 && Math.hypot(event.offsetX - pressed[0], event.offsetY - pressed[1]) < 4)
      pick(event.offsetX, event.offsetY);
    pressed = null;
  });

  async function play() {
    playing = !playing;
    tell_playing();
    while (playing && last > 0) {
      const begin = performance.now();
      const next = current() >= last ? 0 : current() + 1;
      state.set({frame: next === last ? null : next});
      await load();
      await new Promise((go_on) => setTimeout(go_on, Math.max(16, FASTEST_PLAY - (performance.now() - begin))));
    }
  }
  const play_listeners = [];
  const tell_playing = () => play_listeners.forEach((listener) => listener(playing));

  function go_to(index) {
    const clamped = Math.min(last, Math.max(0, index));
    state.set({frame: clamped === last ? null : clamped});
  }

  async function load_mesh() {
    if (!run.mesh) return;
    const places = await mesh_places(run.mesh, blocks);
    view.add_lines('outline', places, await blocks.numbers(run.mesh.outline));
    if (run.mesh.cells) view.add_lines('cells', places, await blocks.numbers(run.mesh.cells));
    show_lines();
  }

  async function load_ground() {
    if (!run.ground) return;
    const places = await mesh_places(run.ground, blocks);
    const rigid = await blocks.numbers(run.ground.rigid);
    if (run.dimension === 3) view.add_ground(places, rigid);
    else view.add_lines('rigid', places, rigid);
    view.add_lines('layers', places, await blocks.numbers(run.ground.layers));
    show_lines();
    apply();
  }

  async function load_rigid() {
    for (const {name, count, low, high, x, y, z, triangles} of run.rigid ?? []) {
      const middle = low.map((end, d) => (end + high[d]) / 2);
      const from_middle = (place) => place.map((c, d) => c - middle[d]);
      const places = await mesh_places({count, low: from_middle(low), high: from_middle(high), x, y, z}, blocks);
      view.add_rigid(name, middle, places, await blocks.numbers(triangles));
    }
  }

  function show_lines() {
    const {mesh, ground, rigid} = state.get();
    const of_mesh = {none: [], outline: ['outline'], cells: ['outline', 'cells']}[mesh] ?? ['outline'];
    view.show_lines(ground ? [...of_mesh, 'rigid', 'layers'] : of_mesh);
    view.show_ground(ground);
    view.show_rigid(rigid);
  }

  function restore_eye() {
    const {towards, target, height, orthographic} = state.get();
    if (run.dimension === 3 && orthographic !== null) view.eye.set_orthographic(orthographic);
    if (towards && target && height) {
      const {eye, origin} = view;
      eye.look({
        towards: eye.around.up.clone().set(...towards),
        target: origin
          .clone()
          .set(...target)
          .sub(origin),
        height,
      });
    } else {
      view.eye.fit();
    }
    view.draw_soon();
    gauge(view.eye, canvas);
  }

  function look_from(name) {
    if (name === 'fit') view.eye.fit_as_seen();
    else view.eye.fit(view.eye.views[name]);
    view.draw_soon();
    moved();
  }

  state.listen((choices, changed) => {
    const any = (...names) => names.some((name) => changed.has(name));
    if (any('frame', 'field', 'only') && !playing) load();
    else if (any('map', 'range', 'from', 'to', 'section', 'at', 'normal', 'flip', 'lowest', 'highest', 'size')) apply();
    if (any('mesh', 'ground', 'rigid')) show_lines();
    if (any('particle', 'clicked')) show_picked();
    if (any('orthographic')) {
      view.eye.set_orthographic(choices.orthographic ?? run.dimension === 2);
      view.draw_soon();
      gauge(view.eye, canvas);
    }
    if (changed.size > 8) restore_eye(); // another address: everything may have changed
  });
  new ResizeObserver(() => gauge(view.eye, canvas)).observe(canvas);
  canvas.addEventListener('webglcontextlost', () => {
    message.textContent = 'The graphics card has let go of the picture. Reloading the page brings it back.';
    message.hidden = false;
  });

  view.resize();
  restore_eye();
  load_mesh().catch((error) => {
    count_line.textContent = `The mesh cannot be shown: ${error.message}`;
  });
  load_ground().catch((error) => {
    count_line.textContent = `The ground cannot be shown: ${error.message}`;
  });
  show_lines();
  const ready = load_rigid()
    .catch((error) => {
      count_line.textContent = `The rigid bodies cannot be shown: ${error.message}`;
    })
    .then(load);
  if (!particles) count_line.textContent = run.live ? 'no particles so far, only the mesh' : 'no particles were written, only the mesh';

  return {
    ready,
    view,
    go_to,
    look_from,
    play,
    current,
    last,
    listen: (listener) => listeners.push(listener),
    listen_play: (listener) => play_listeners.push(listener),
    step: (by) => go_to(current() + by),
    picture: () => {
      view.draw();
      return {canvas, legend: legend.last(), time: now?.frame.time};
    },
    colour_range: () => (now && now.field >= 0 ? colour_range(particles, state.get(), now.field, now.colouring) : null),
  };
}
