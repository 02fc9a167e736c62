// Makes the template of talus report: one HTML file that holds everything but the run. Usage: node build.mjs FILE
import {createHash} from 'node:crypto';
import {mkdirSync, readFileSync, renameSync, writeFileSync} from 'node:fs';
import {createRequire} from 'node:module';
import {dirname, join, resolve} from 'node:path';
import {fileURLToPath} from 'node:url';

const here = dirname(fileURLToPath(import.meta.url));
const modules = resolve(process.env.TALUS_PAGE_MODULES ?? join(here, 'node_modules'));
const file = process.argv[2];
if (!file) {
  console.error('usage: node build.mjs FILE');
  process.exit(2);
}
const {build} = createRequire(join(modules, 'here.js'))('esbuild');

const ours = {
  bundle: true,
  minify: true,
  write: false,
  target: 'es2022',
  legalComments: 'none',
  charset: 'utf8',
  logLevel: 'warning',
  nodePaths: [modules],
  loader: {'.html': 'text'},
};

/** import text from 'worker:./file.js': a script of its own, as text, because a page in one file has no second one to name. */
const workers = {
  name: 'workers',
  setup(bundle) {
    bundle.onResolve({filter: /^worker:/}, ({path, resolveDir}) => ({
      path: join(resolveDir, path.slice('worker:'.length)),
      namespace: 'worker',
    }));
    bundle.onLoad({filter: /.*/, namespace: 'worker'}, async ({path}) => {
      const made = await build({...ours, entryPoints: [path], format: 'iife', metafile: true});
      return {contents: made.outputFiles[0].text, loader: 'text', watchFiles: Object.keys(made.metafile.inputs)};
    });
  },
};

const escape = (text) => text.replaceAll('&', '&amp;').replaceAll('<', '&lt;').replaceAll('>', '&gt;');
const digest = (text) => `'sha256-${createHash('sha256').update(text).digest('base64')}'`;

/** The licences of the packages whose files are in the bundle, as their authors give them. */
function licences(inputs) {
  const names = new Set(inputs.flatMap((input) => /node_modules\/((?:@[^/]+\/)?[^/]+)\//.exec(input)?.[1] ?? []));
  return [...names]
    .sort()
    .map((name) => {
      const {version, license} = JSON.parse(readFileSync(join(modules, name, 'package.json'), 'utf8'));
      const text = readFileSync(join(modules, name, 'LICENSE'), 'utf8');
      return `<details><summary>${escape(name)} ${escape(version)}, ${escape(license)}</summary><pre>${escape(text)}</pre></details>`;
    })
    .join('\n');
}

const made = await build({
  ...ours,
  entryPoints: [join(here, 'src/main.js')],
  outdir: 'out',
  format: 'iife',
  metafile: true,
  plugins: [workers],
});
const text_of = (ending) => made.outputFiles.find(({path}) => path.endsWith(ending)).text.trim();
const script = text_of('.js').replaceAll('</script', '<\\/script').replaceAll('<!--', '<\\!--');
const style = text_of('.css');

// Nothing may be asked of any network but the page's own server (talus watch), and nothing may run that is not in this file as it was built.
const policy = [
  "default-src 'none'",
  `script-src ${digest(script)} blob:`,
  `style-src ${digest(style)}`,
  'img-src data: blob:',
  'worker-src blob:',
  "connect-src 'self'",
  "base-uri 'none'",
  "form-action 'none'",
].join('; ');

const page = readFileSync(join(here, 'src/page.html'), 'utf8').replace(
  /\{\{(\w+)\}\}/g,
  (_, name) => ({policy, style, script, licences: licences(Object.keys(made.metafile.inputs))})[name],
);
if (page.split('\n').filter((line) => line === '<!--TALUS-RUN-->').length !== 1)
  throw new Error('the template must have one line for the run');

mkdirSync(dirname(resolve(file)), {recursive: true});
writeFileSync(`${file}.part`, page);
renameSync(`${file}.part`, file);
