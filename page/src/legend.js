// What colours mean: the map with its values, or the bodies with theirs.
import {DISTINCT, css, gradient} from './colours.js';
import {el, number, unit} from './dom.js';

export function make_legend(element) {
  let shown = null;
  return {
    last: () => shown,
    /** @param {{field: object|null, range: number[], map: string, bodies: object[], missing: boolean}} what field null: by body */
    show(what) {
      shown = what;
      const {field, range, map, bodies, missing} = what;
      element.hidden = false;
      if (!field) {
        element.replaceChildren(
          el('strong', {}, 'body'),
          el(
            'ul',
            {},
            bodies.map(({name, law}, i) => {
              const swatch = el('i');
              swatch.style.background = css(DISTINCT[i % DISTINCT.length]);
              return el('li', {}, swatch, name, el('small', {}, law ? ` ${law}` : ''));
            }),
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
