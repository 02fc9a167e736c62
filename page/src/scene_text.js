// The scene as it was run: lines with numbers to point at, colours for what is key, value and remark.
import {el} from './dom.js';

const TOKENS =
  /(?<remark>(?<=^|\s)#.*$)|(?<text>"(?:[^"\\]|\\.)*"|'(?:[^']|'')*')|(?<key>[\w.\-]+(?=\s*:(?:\s|$)))|(?<number>(?<![\w.])[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?(?![\w.]))|(?<sign>[{}[\],:]|(?<=^\s*)-(?=\s))/g;

/** A line of YAML as [kind or null, text] pairs whose texts make up the line. */
export function tokens_of(line) {
  const tokens = [];
  let done = 0;
  for (const match of line.matchAll(TOKENS)) {
    if (match.index > done) tokens.push([null, line.slice(done, match.index)]);
    tokens.push([Object.entries(match.groups).find(([, text]) => text !== undefined)[0], match[0]]);
    done = match.index + match[0].length;
  }
  if (done < line.length) tokens.push([null, line.slice(done)]);
  return tokens;
}

/** Line that a message names: "scene.yaml:12:3: ..." or "line 12". */
export function line_in(text) {
  const found = /\.ya?ml:(\d+)/.exec(text) ?? /\bline (\d+)\b/.exec(text);
  return found ? Number(found[1]) : null;
}

/** @param {{file: string, text: string}} scene @param {{text: string, line?: number}[]} remarks warnings and errors with the lines they are about */
export function show_scene(element, scene, remarks, changes) {
  if (!scene?.text) {
    element.replaceChildren(el('p', {class: 'empty'}, 'The scene is not in this report: the folder has no scene.yaml.'));
    return;
  }
  const about = new Map();
  remarks.forEach((remark, k) => {
    if (remark.line) about.set(remark.line, [...(about.get(remark.line) ?? []), [remark, k]]);
  });
  const lines = scene.text.replace(/\n$/, '').split('\n');
  const digits = String(lines.length).length;
  element.replaceChildren(
    el('p', {class: 'note'}, el('code', {}, scene.file || 'scene.yaml'), changes?.length ? `, changed by --set ${changes.join(', ')}` : ''),
    el(
      'div',
      {class: 'scene', tabindex: 0, role: 'region', 'aria-label': 'Text of the scene', style: null},
      lines.map((line, k) => {
        const notes = about.get(k + 1) ?? [];
        return el(
          'div',
          {class: notes.length ? 'line marked' : 'line', id: `L${k + 1}`},
          el('a', {href: `#L${k + 1}`, 'aria-label': `line ${k + 1}`}, String(k + 1).padStart(digits, '\u2007')),
          el(
            'code',
            {},
            tokens_of(line).map(([kind, text]) => (kind ? el('span', {class: kind}, text) : text)),
            line === '' ? ' ' : '',
          ),
          notes.map(([remark, number]) => el('a', {class: 'remark-below', href: `#warning-${number}`}, remark.text)),
        );
      }),
    ),
  );
}

/** Brings a line into sight and marks it; the address is kept by whoever calls. */
export function show_line(line, scroll = true) {
  document.querySelectorAll('.line.chosen').forEach((chosen) => chosen.classList.remove('chosen'));
  const element = document.getElementById(`L${line}`);
  if (!element) return;
  element.classList.add('chosen');
  if (scroll) element.scrollIntoView({block: 'center'});
}
