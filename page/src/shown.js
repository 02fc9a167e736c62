// Which particles are shown and in which colours: the reader's choices, made exact for one frame. The shader asks the same questions.
import {NOTHING, value_of} from './decode.js';
import {place_of, range_of} from './frames.js';

export const BODY = 'body';

/** Index of a field by name; without one, or with one the report does not have, the field it begins with. -1: by body. */
export function field_index(particles, name) {
  if (name === BODY) return -1;
  const found = particles.fields.findIndex((field) => field.name === name);
  return found >= 0 ? found : particles.fields.length ? Math.min(particles.field ?? 0, particles.fields.length - 1) : -1;
}

/** Number of the frame that is shown. */
export const frame_index = ({frame}, count) => (frame === null ? count - 1 : Math.min(count - 1, Math.max(0, Math.round(frame))));

/** Values where colours begin and end. @param {Uint16Array|null} steps of the field in this frame */
export function colour_range(particles, choices, index, steps) {
  const {low, high} = particles.fields[index];
  const whole_run = [low, high];
  if (choices.range === 'hand') return [choices.from ?? low, choices.to ?? high];
  if (choices.range === 'frame') return (steps && range_of(steps, low, high)) ?? whole_run;
  if (choices.range === 'auto' && index === particles.field && particles.range) return particles.range;
  return whole_run;
}

/** A value as a share of its field's range, which is what a particle's number is. */
export const share_of = (value, {low, high}) => (high > low ? (value - low) / (high - low) : 0);

/** Directions of sections by name. @returns {number[]|null} unit vector */
export function section_normal(choices) {
  const axes = {x: [1, 0, 0], y: [0, 1, 0], z: [0, 0, 1], view: choices.normal};
  return axes[choices.section] ?? null;
}

/** Places of a box along a direction: [least, most]. @param {{min: {x, y, z}, max: {x, y, z}}} box */
export function span_along(normal, {min, max}) {
  const reach = (pick) => ['x', 'y', 'z'].reduce((sum, axis, k) => sum + normal[k] * (pick(normal[k] > 0) ? max : min)[axis], 0);
  return [reach((forward) => !forward), reach((forward) => forward)];
}

/** What lies beyond `at` along `normal` is left out; flipped, what lies before it. */
export function section_of(choices, box) {
  const normal = section_normal(choices);
  if (!normal) return null;
  const [least, most] = span_along(normal, box);
  const at = choices.at ?? (least + most) / 2;
  return choices.flip ? {normal: normal.map((c) => -c), at: -at} : {normal, at};
}

/** Lowest and highest share shown of the field that limits, or null. */
export function limit_of(particles, choices) {
  const field = particles.fields.find(({name}) => name === choices.only);
  if (!field || (choices.lowest === null && choices.highest === null)) return null;
  const step = 0.5 / 65534; // half of what numbers are rounded to, so that the ends of the range belong to it
  return [
    choices.lowest === null ? -1 : share_of(choices.lowest, field) - step,
    choices.highest === null ? 2 : share_of(choices.highest, field) + step,
  ];
}

/** @returns {(p: number) => boolean} whether particle p of a frame is shown */
export function shown_test(frame, places, limiting, limit, section) {
  return (p) => {
    if (limit) {
      const share = limiting ? limiting[p] / 65534 : 2;
      if (!limiting || limiting[p] === NOTHING || share < limit[0] || share > limit[1]) return false;
    }
    if (!section) return true;
    const [x, y, z] = place_of(places, p, frame);
    return section.normal[0] * x + section.normal[1] * y + section.normal[2] * z <= section.at;
  };
}

/** Value of a field of particle p. */
export const field_value = (steps, p, {low, high}) => value_of(steps[p], low, high);
