// What colours mean: the map with its values, or the bodies with theirs.
import {DISTINCT, RIGID, css, gradient} from './colours.js';
import {el, number, unit} from './dom.js';

const MOST_RIGID = 6; // that are named one by one: all have the same colour

/** Names of rigid bodies, or how many there are. */
export const rigid_names = (rigid) => (rigid.length > MOST_RIGID ? [`${rigid.length} bodies`] : rigid.map(({name}) => name));

function entry(colour, name, law) {
  const swatch = el('i');
  swatch.style.background = css(colour);
  return el('li', {}, swatch, name, el('small', {}, law ? ` ${law}` : ''));
}

export function make_legend(element) {
  let shown = null;
  return {
    last: () => shown,
    /** @param {{field: object|null, range: number[], map: string, bodies: object[], rigid: object[], missing: boolean}} what field null: by body */
    show(what) {
      shown = what;
      const {field, range, map, bodies, rigid, missing} = what;
      element.hidden = false;
      if (!field) {
        element.replaceChildren(
          el('strong', {}, 'body'),
          el(
            'ul',
            {},
            bodies.map(({name, law}, i) => entry(DISTINCT[i % DISTINCT.length], name, law)),
            rigid_names(rigid).map((name) => entry(RIGID, name, 'rigid')),
          ),
        );
        return;
      }
      const bar = el('div', {class: 'bar'});
      bar.style.background = gradient(map);
      element.replaceChildren(
        el('strong', {}, field.label || field.name, field.unit ? ` [${unit(field.unit)}]` : ''),
        bar,
        el(
          'div',
          {class: 'ticks'},
          [0, 0.5, 1].map((t) => el('span', {}, number(range[0] + t * (range[1] - range[0]), 3))),
        ),
        missing ? el('small', {}, 'not in this frame') : '',
      );
    },
  };
}
