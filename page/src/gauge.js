// Which way the axes point in the picture, and how long a metre is in it.
import * as THREE from 'three';
import {number} from './dom.js';

const NAMESPACE = 'http://www.w3.org/2000/svg';
const ARM = 22; // CSS pixels

function svg(tag, attributes, text = '') {
  const element = document.createElementNS(NAMESPACE, tag);
  for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, value);
  element.textContent = text;
  return element;
}

/** The largest of 1, 2, 5, 10 ... that is not above. */
export function round_length(length) {
  const power = 10 ** Math.floor(Math.log10(length));
  return power * [5, 2, 1].find((factor) => factor * power <= length * (1 + 1e-9));
}

/** @returns {(eye: object, canvas: HTMLCanvasElement) => void} */
export function make_gauge(element, dimension) {
  const axes = [
    [1, 0, 0],
    [0, 1, 0],
    [0, 0, 1],
  ]
    .slice(0, dimension)
    .map((axis) => new THREE.Vector3(...axis));
  return (eye, canvas) => {
    const towards = eye.towards();
    const right = new THREE.Vector3().crossVectors(eye.around.up, towards).normalize();
    const up = new THREE.Vector3().crossVectors(towards, right);
    const arms = axes
      .map((axis, k) => ({name: 'xyz'[k], x: axis.dot(right), y: -axis.dot(up), depth: axis.dot(towards)}))
      .filter(({x, y}) => Math.hypot(x, y) > 0.08)
      .sort((a, b) => a.depth - b.depth);
    const cross = svg('svg', {viewBox: '-34 -34 68 68', width: 68, height: 68, 'aria-hidden': 'true'});
    for (const {name, x, y} of arms)
      cross.append(svg('line', {x1: 0, y1: 0, x2: x * ARM, y2: y * ARM}), svg('text', {x: x * 1.3 * ARM, y: y * 1.3 * ARM}, name));

    const metre = canvas.clientHeight / eye.height();
    const length = round_length(Math.max(90 / metre, 1e-12));
    const bar = document.createElement('div');
    bar.className = 'metre';
    bar.style.width = `${length * metre}px`;
    bar.textContent = `${number(length)} m`;
    bar.title = eye.is_orthographic() ? 'true everywhere in the picture' : 'true at the distance of the middle of the picture';
    element.replaceChildren(cross, bar);
  };
}
