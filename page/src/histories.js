// Columns of a table over time: plots by kind, each with the columns the reader ticks.
import {first_choice, from_text, group_columns, to_text} from './columns.js';
import {curve} from './timeline.js';
import {el, number, unit} from './dom.js';

/** One plot: its title, a box to tick for each column with the value at the cursor, the curves. */
function make_plot(group, table, columns, timeline, {chosen, changed, close}) {
  const readings = [];
  const shown = group.columns.map((c) => chosen.includes(c));
  const place = el('div', {class: 'plot', role: 'img', 'aria-label': `${group.title} over time`});
  let plot = null;
  const boxes = group.columns.map((c, k) => {
    const swatch = el('i', {class: curve(k).dash.length ? 'dashed' : null});
    swatch.style.color = curve(k).stroke;
    readings[k] = el('output', {});
    return el(
      'label',
      {class: 'chip'},
      el('input', {
        type: 'checkbox',
        name: `column-${table.columns[c].name}`,
        checked: shown[k],
        change: ({target}) => {
          shown[k] = target.checked;
          plot.plot.setSeries(k + 1, {show: target.checked});
          changed();
        },
      }),
      swatch,
      table.columns[c].label || table.columns[c].name,
      readings[k],
    );
  });
  const element = el(
    'section',
    {class: 'history', 'aria-label': group.title},
    el(
      'h3',
      {},
      group.title,
      group.unit ? el('small', {}, ` [${unit(group.unit)}]`) : null,
      el('button', {type: 'button', class: 'close', 'aria-label': `Close ${group.title}`, click: close}, '×'),
    ),
    el('div', {class: 'chips'}, boxes),
    place,
  );
  return {
    element,
    group,
    chosen: () => group.columns.filter((_, k) => shown[k]),
    /** The element must be on the page by now: the plot is as wide as that. */
    draw() {
      plot = timeline.add(place, {
        unit: group.unit,
        data: [columns[0], ...group.columns.map((c) => Array.from(columns[c], (value) => (Number.isFinite(value) ? value : null)))], // NaN would leave the axis without ends
        series: group.columns.map((c, k) => ({
          ...curve(k),
          label: table.columns[c].name,
          width: 1.6,
          show: shown[k],
          points: {show: table.rows < 40},
        })),
        read: (row) =>
          readings.forEach((reading, k) => {
            reading.textContent = row === null ? '' : number(columns[group.columns[k]][row]);
          }),
      });
    },
    remove() {
      plot?.remove();
      element.remove();
    },
  };
}

/**
 * @param {HTMLElement} element to fill
 * @param {object} table TABLE of the run
 * @param {ArrayLike<number>[]} columns its values
 * @param {{timeline: object, group?: Function, chosen: string|null, keep: (text: string) => void}} links chosen: plots in words, kept by the address
 */
export function show_histories(element, table, columns, {timeline, group: sort = group_columns, chosen, keep}) {
  const is_zero = (c) => columns[c].every((v) => !(Math.abs(v) > 0));
  const groups = sort(table.columns, is_zero);
  const menu = el('div', {class: 'chips', role: 'group', 'aria-label': 'Plots'});
  const list = el('div', {class: 'histories'});
  const open = new Map();

  const tell = () =>
    keep(
      to_text(
        groups
          .filter((group) => open.has(group))
          .map((group) => ({
            title: group.title,
            names: open
              .get(group)
              .chosen()
              .map((c) => table.columns[c].name),
          })),
      ),
    );

  function show(group, its_columns) {
    const plot = make_plot(group, table, columns, timeline, {
      chosen: its_columns,
      changed: tell,
      close: () => {
        hide(group);
        tell();
      },
    });
    open.set(group, plot);
    const next = groups.slice(groups.indexOf(group) + 1).find((later) => open.has(later));
    list.insertBefore(plot.element, next ? open.get(next).element : null);
    plot.draw();
    menu.querySelector(`[name="plot-${groups.indexOf(group)}"]`).checked = true;
  }
  function hide(group) {
    open.get(group).remove();
    open.delete(group);
    menu.querySelector(`[name="plot-${groups.indexOf(group)}"]`).checked = false;
  }

  menu.append(
    ...groups.map((group, k) =>
      el(
        'label',
        {class: 'chip'},
        el('input', {
          type: 'checkbox',
          name: `plot-${k}`,
          change: ({target}) => {
            if (target.checked) show(group, group.chosen);
            else hide(group);
            tell();
          },
        }),
        group.title,
      ),
    ),
  );
  element.replaceChildren(menu, list);

  const wished = chosen === null ? null : from_text(chosen);
  if (!wished) {
    for (const group of first_choice(groups)) show(group, group.chosen);
  } else {
    for (const {title, names} of wished) {
      const group = groups.find((g) => g.title === title);
      if (group && !open.has(group))
        show(
          group,
          group.columns.filter((c) => names.includes(table.columns[c].name)),
        );
    }
  }
}

/** Notes below a table's plots. */
export const thinned_note = ({thinned, rows}) =>
  thinned > 1 ? el('p', {class: 'note'}, `Every ${thinned}th row is here, ${rows} in all; the file has all of them.`) : null;
