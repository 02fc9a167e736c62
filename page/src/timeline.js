// One axis of time under all plots: one zoom, one cursor, and the line where the viewer stands.
import uPlot from 'uplot';
import {number, unit as write_unit} from './dom.js';

export const CURVES = ['#0072b2', '#d55e00', '#009e73', '#cc79a7', '#e69f00', '#56b4e9', '#8c8c8c', '#7a4ea3']; // Okabe and Ito, the pale ones left out
const DASHES = [[], [6, 3], [2, 3]];
const style = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();

/** Colour and dash of the k-th curve. */
export const curve = (k) => ({stroke: CURVES[k % CURVES.length], dash: DASHES[Math.floor(k / CURVES.length) % DASHES.length]});

/** @param {(time: number) => void} go_to what a click at a time does */
export function make_timeline(go_to) {
  const plots = new Set();
  let now = null;
  let zoom = null; // [from, to] s, or null: everything
  let following = false;

  function set_zoom(range) {
    zoom = range;
    following = true;
    for (const plot of plots) {
      const x = plot.data[0];
      const [from, to] = zoom ?? [x[0], x[x.length - 1]];
      plot.setScale('x', {min: from, max: to > from ? to : from + 1});
    }
    following = false;
  }

  function draw_now(plot) {
    if (now === null || now < plot.scales.x.min || now > plot.scales.x.max) return;
    const {
      ctx: context,
      bbox: {top, height},
    } = plot;
    const x = Math.round(plot.valToPos(now, 'x', true)) + 0.5;
    context.save();
    context.strokeStyle = style('--mark');
    context.lineWidth = 1.5 * devicePixelRatio;
    context.setLineDash([]);
    context.beginPath();
    context.moveTo(x, top);
    context.lineTo(x, top + height);
    context.stroke();
    context.restore();
  }

  const axis = (extra) => ({
    stroke: () => style('--muted'),
    font: '12px system-ui, sans-serif',
    grid: {stroke: () => style('--grid'), width: 1},
    ticks: {stroke: () => style('--grid'), width: 1},
    values: (_, splits) => splits.map((v) => number(v, 5)),
    ...extra,
  });

  /**
   * A plot over time in an element, as wide as that is.
   * @param {HTMLElement} parent
   * @param {{data: ArrayLike<number>[], series: object[], unit: string, height?: number, range?: Function, draw?: Function, read?: Function}} what
   *  data and series begin with the time; draw(plot) paints below the curves; read(row or null) hears where the cursor is
   */
  function add(parent, {data, series, unit, height = 190, range, draw, read}) {
    let pressed = 0;
    const plot = new uPlot(
      {
        width: Math.max(200, parent.clientWidth),
        height,
        legend: {show: false},
        cursor: {
          points: {size: 6},
          drag: {x: true, y: false},
          sync: {key: 'talus', scales: ['x', null], filters: {pub: (type) => type === 'mousemove' || type === 'mouseleave'}},
        },
        scales: {x: {time: false}, y: range ? {range} : {}},
        axes: [
          axis({size: 34}),
          axis({size: 66, label: write_unit(unit), labelSize: 18, labelGap: 0, labelFont: '12px system-ui, sans-serif'}),
        ],
        series: [{}, ...series],
        hooks: {
          drawClear: draw ? [draw] : [],
          draw: [draw_now],
          setCursor: [(u) => read?.(u.cursor.idx ?? null)],
          setScale: [
            (u, key) => {
              if (key !== 'x' || following) return;
              const x = u.data[0];
              const {min, max} = u.scales.x;
              set_zoom(min <= x[0] && max >= x[x.length - 1] ? null : [min, max]);
            },
          ],
        },
      },
      data,
      parent,
    );
    plot.over.addEventListener('mousedown', (event) => {
      pressed = event.clientX;
    });
    plot.over.addEventListener('click', (event) => {
      if (Math.abs(event.clientX - pressed) < 4) go_to(plot.posToVal(event.offsetX, 'x'));
    });
    plots.add(plot);
    const fit = new ResizeObserver(() => {
      if (parent.clientWidth && parent.clientWidth !== plot.width) plot.setSize({width: parent.clientWidth, height});
    });
    fit.observe(parent);
    set_zoom(zoom);
    return {
      plot,
      remove() {
        fit.disconnect();
        plots.delete(plot);
        plot.destroy();
      },
    };
  }

  matchMedia('(prefers-color-scheme: dark)').addEventListener('change', () => plots.forEach((plot) => plot.redraw()));

  return {
    add,
    /** @param {number} time of the viewer [s] */
    set_now(time) {
      now = time;
      for (const plot of plots) plot.redraw(false);
    },
    whole: () => set_zoom(null),
    /** Narrower (factor > 1) or wider about the time that the viewer shows, by keyboard as well. */
    zoom_by(factor) {
      const [plot] = plots;
      if (!plot) return;
      const x = plot.data[0];
      const [first, last] = [x[0], x[x.length - 1]];
      const {min, max} = plot.scales.x;
      const middle = now !== null && now >= min && now <= max ? now : (min + max) / 2;
      const half = (max - min) / factor / 2;
      const [from, to] = [Math.max(first, middle - half), Math.min(last, middle + half)];
      set_zoom(from <= first && to >= last ? null : [from, to]);
    },
  };
}
