// The picture as the reader sees it, with its legend, as a PNG file.
import {DISTINCT, RIGID, colour_at, css} from './colours.js';
import {number, unit} from './dom.js';
import {rigid_names} from './legend.js';

const style = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();

function draw_legend(context, legend, width, height, scale) {
  const {field, range, map, bodies, rigid} = legend;
  const left = 16 * scale,
    base = height - 16 * scale,
    wide = Math.min(260 * scale, width / 2),
    bar = 12 * scale;
  context.font = `${13 * scale}px system-ui, sans-serif`;
  context.fillStyle = style('--text');
  if (!field) {
    const entries = [...bodies.map(({name}, i) => [name, DISTINCT[i % DISTINCT.length]]), ...rigid_names(rigid).map((name) => [name, RIGID])];
    entries.forEach(([name, colour], i) => {
      const y = base - (entries.length - 1 - i) * 18 * scale;
      context.fillStyle = css(colour);
      context.fillRect(left, y - bar, bar, bar);
      context.fillStyle = style('--text');
      context.fillText(name, left + 1.6 * bar, y - 1 * scale);
    });
    return;
  }
  const colours = context.createLinearGradient(left, 0, left + wide, 0);
  for (let i = 0; i <= 32; ++i) colours.addColorStop(i / 32, css(colour_at(map, i / 32)));
  context.fillText(`${field.label || field.name}${field.unit ? ` [${unit(field.unit)}]` : ''}`, left, base - 36 * scale);
  [0, 0.5, 1].forEach((t) => {
    context.textAlign = ['left', 'center', 'right'][2 * t];
    context.fillText(number(range[0] + t * (range[1] - range[0]), 3), left + t * wide, base);
  });
  context.textAlign = 'left';
  context.fillStyle = colours;
  context.fillRect(left, base - 29 * scale, wide, bar);
}

/** @param {{canvas: HTMLCanvasElement, legend: object|null, time: number|undefined}} picture @param {string} title @returns {HTMLCanvasElement} */
export function compose({canvas, legend, time}, title) {
  const whole = document.createElement('canvas');
  const {width, height} = canvas;
  Object.assign(whole, {width, height});
  const scale = width / canvas.clientWidth;
  const context = whole.getContext('2d');
  context.fillStyle = style('--canvas');
  context.fillRect(0, 0, width, height);
  context.drawImage(canvas, 0, 0);
  context.fillStyle = style('--text');
  context.font = `600 ${15 * scale}px system-ui, sans-serif`;
  context.fillText(time === undefined ? title : `${title}, ${number(time)} s`, 16 * scale, 26 * scale, width - 32 * scale);
  if (legend) draw_legend(context, legend, width, height, scale);
  return whole;
}

export function save(picture, title, file) {
  compose(picture, title).toBlob((blob) => {
    const link = document.createElement('a');
    link.href = URL.createObjectURL(blob);
    link.download = file;
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 10000);
  }, 'image/png');
}
