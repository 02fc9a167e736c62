// The picture of particles and mesh: draws when something has changed, and says where things are in it.
import * as THREE from 'three';
import {make_eye} from './camera.js';
import {body_pixels, map_pixels} from './colours.js';
import {value_of} from './decode.js';
import {contour_step, ground_material} from './ground_shader.js';
import {map_texture, particle_material} from './particle_shader.js';
import {make_rigid_bodies} from './rigid.js';
import {make_shade_pass} from './shade_pass.js';

/** Everything that is ever shown, rigid bodies where they are at the beginning, in the coordinates of the run [m]. */
function bounds_of({particles, mesh, ground, rigid, dimension}) {
  const box = new THREE.Box3();
  const corner = (numbers) => new THREE.Vector3(numbers[0], numbers[1], dimension === 3 ? numbers[2] : 0);
  for (const part of [...(particles?.frames ?? []), ...(mesh ? [mesh] : []), ...(ground ? [ground] : []), ...(rigid ?? [])])
    if (part.count) box.expandByPoint(corner(part.low)).expandByPoint(corner(part.high));
  return box.isEmpty() ? new THREE.Box3(new THREE.Vector3(0, 0, 0), new THREE.Vector3(1, 1, 1)) : box;
}

const css_colour = (name) => new THREE.Color(getComputedStyle(document.documentElement).getPropertyValue(name).trim() || '#888');

/**
 * @param {HTMLCanvasElement} canvas
 * @param {object} run
 * @param {() => void} moved the reader has moved the eye
 * @throws where the browser has no WebGL 2
 */
export function make_view(canvas, run, moved) {
  const renderer = new THREE.WebGLRenderer({canvas, antialias: false, alpha: true, powerPreference: 'high-performance'});
  renderer.outputColorSpace = THREE.LinearSRGBColorSpace; // colours are written as they are meant to be seen
  THREE.ColorManagement.enabled = false;
  const everything = bounds_of(run);
  const origin = everything.getCenter(new THREE.Vector3()); // single precision of the graphics card counts from here
  const bounds = everything.clone().translate(origin.clone().negate());
  const flat = run.dimension === 2;
  const radius = run.particles?.radius ?? 1;

  const scene = new THREE.Scene();
  const material = particle_material(!flat);
  const points = new THREE.Points(new THREE.BufferGeometry(), material);
  points.frustumCulled = false;
  const mark = make_mark(scene);
  const lines = {};
  let ground = null; // the surface, in 3-D
  const rigid = make_rigid_bodies(scene, origin, flat);
  scene.add(points);
  const shaded = flat ? null : make_shade_pass(renderer);
  const eye = make_eye(canvas, {
    dimension: run.dimension,
    up: run.up,
    bounds,
    moved: () => {
      draw_soon();
      moved();
    },
  });

  let due = 0;
  function draw() {
    cancelAnimationFrame(due);
    due = 0;
    eye.shape();
    const camera = eye.camera();
    renderer.setClearAlpha(0);
    if (shaded) shaded(scene, camera, Math.max(6 * radius, 0.015 * eye.height()));
    else renderer.render(scene, camera);
  }
  function draw_soon() {
    due ||= requestAnimationFrame(draw);
  }

  function resize() {
    const room = canvas.parentElement.getBoundingClientRect();
    const [width, height] = [Math.floor(room.width), Math.floor(room.height) - 1]; // whole pixels, or the browser would blur the picture
    if (width < 1 || height < 1) return;
    renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
    renderer.setSize(width, height);
    material.uniforms.pixels.value = height * renderer.getPixelRatio();
    eye.set_aspect(width / height);
    draw();
  }

  function set_attribute(name, numbers, size) {
    const known = points.geometry.getAttribute(name);
    if (known && known.array.length === numbers.length) {
      known.array = numbers;
      known.needsUpdate = true;
    } else {
      points.geometry.setAttribute(name, new THREE.BufferAttribute(numbers, size, true));
    }
  }

  /** @param {{count: number, low: number[], high: number[]}} frame @param {Uint16Array} places @param {Uint16Array} values two a particle */
  function set_particles(frame, places, values) {
    const grown = points.geometry.getAttribute('place')?.array.length !== places.length;
    if (grown) {
      // buffers of the graphics card keep their size
      points.geometry.dispose();
      points.geometry = new THREE.BufferGeometry();
    }
    set_attribute('place', places, 4);
    set_attribute('values', values, 2);
    points.geometry.setDrawRange(0, frame.count);
    const low = new THREE.Vector3(frame.low[0], frame.low[1], flat ? 0 : frame.low[2]);
    const high = new THREE.Vector3(frame.high[0], frame.high[1], flat ? 0 : frame.high[2]);
    material.uniforms.extent.value.copy(high).sub(low);
    material.uniforms.low.value.copy(low).sub(origin);
    draw_soon();
  }

  function set_map(name) {
    material.uniforms.map.value?.dispose();
    material.uniforms.map.value = map_texture(name === null ? body_pixels() : map_pixels(name));
    material.uniforms.by_body.value = name === null;
  }

  /** @param {{size: number, range: number[], limit: number[]|null, section: {normal: number[], at: number}|null}} looks
   *  range and limit as shares of their fields' ranges, the section in the coordinates of the run */
  function set_looks({size, range, limit, section}) {
    const u = material.uniforms;
    u.radius.value = radius * size;
    u.range.value.set(range[0], range[1] === range[0] ? range[0] + 1e-6 : range[1]);
    u.limits.value = limit !== null;
    if (limit) u.limit.value.set(...limit);
    u.cuts.value = section !== null;
    if (section) {
      const normal = new THREE.Vector3(...section.normal);
      u.section.value.set(normal.x, normal.y, normal.z, section.at - normal.dot(origin));
    }
    if (ground) {
      ground.material.uniforms.cuts.value = u.cuts.value;
      ground.material.uniforms.section.value.copy(u.section.value);
    }
    rigid.cut(u.cuts.value, u.section.value);
    draw_soon();
  }

  /** Edges of the mesh. @param {Float32Array} places three a node, coordinates of the run @param {Uint32Array} pairs of nodes */
  function add_lines(name, places, pairs) {
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute('position', new THREE.BufferAttribute(places, 3));
    geometry.setIndex(new THREE.BufferAttribute(pairs, 1));
    lines[name] = new THREE.LineSegments(geometry, new THREE.LineBasicMaterial({transparent: true, depthWrite: false}));
    lines[name].frustumCulled = false;
    lines[name].position.copy(origin).negate();
    scene.add(lines[name]);
    take_colours();
  }

  function show_lines(shown) {
    for (const [name, object] of Object.entries(lines)) object.visible = shown.includes(name);
    draw_soon();
  }

  /** The rigid surface of a mesh of terrain. @param {Float32Array} places as above @param {Uint32Array} triples of nodes */
  function add_ground(places, triples) {
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute('position', new THREE.BufferAttribute(places, 3));
    geometry.setIndex(new THREE.BufferAttribute(triples, 1));
    geometry.computeVertexNormals();
    const up = eye.around.up;
    ground = new THREE.Mesh(geometry, ground_material(up, contour_step(places, up)));
    ground.material.uniforms.origin.value.copy(origin);
    ground.frustumCulled = false;
    ground.position.copy(origin).negate();
    scene.add(ground);
    take_colours();
  }

  function show_ground(yes) {
    if (ground) ground.visible = yes;
    draw_soon();
  }

  function take_colours() {
    for (const [name, object] of Object.entries(lines)) {
      object.material.color = css_colour(name === 'rigid' || name === 'layers' ? '--layer' : '--line');
      object.material.opacity = name === 'cells' ? 0.22 : name === 'outline' ? 0.75 : 1;
    }
    if (ground) {
      ground.material.uniforms.rock.value = css_colour('--rock');
      ground.material.uniforms.contour.value = css_colour('--contour');
    }
    mark.material.uniforms.colour.value = css_colour('--mark');
    draw_soon();
  }

  /** @param {Float32Array|null} motion as in a frame */
  function move_rigid(motion) {
    rigid.move(motion);
    draw_soon();
  }

  function show_rigid(yes) {
    rigid.show(yes);
    draw_soon();
  }

  /** The particle whose middle is nearest to the reader among those under a point of the canvas [CSS pixels], or -1 and the name of the rigid
   *  body there. In 3-D it hides what is behind it; in 2-D it lies behind the particles. @param {(p: number) => boolean} is_shown
   *  @returns {{particle: number, rigid: string|undefined}} */
  function found_at(x, y, frame, places, is_shown, size) {
    eye.shape();
    const camera = eye.camera();
    camera.updateMatrixWorld();
    const {clientWidth: width, clientHeight: height} = canvas;
    const to_clip = new THREE.Matrix4().multiplyMatrices(camera.projectionMatrix, camera.matrixWorldInverse).elements;
    const scale = camera.projectionMatrix.elements[5];
    const ray = new THREE.Raycaster();
    ray.setFromCamera(new THREE.Vector2((2 * x) / width - 1, 1 - (2 * y) / height), camera);
    const hit = rigid.met_by(ray);
    let found = -1,
      nearest = hit && !flat ? hit.point.clone().project(camera).z : Infinity;
    for (let p = 0; p < frame.count; ++p) {
      const X = value_of(places[4 * p], frame.low[0], frame.high[0]) - origin.x;
      const Y = value_of(places[4 * p + 1], frame.low[1], frame.high[1]) - origin.y;
      const Z = flat ? -origin.z : value_of(places[4 * p + 2], frame.low[2], frame.high[2]) - origin.z;
      const w = to_clip[3] * X + to_clip[7] * Y + to_clip[11] * Z + to_clip[15];
      if (w <= 0) continue;
      const u = (0.5 + (0.5 * (to_clip[0] * X + to_clip[4] * Y + to_clip[8] * Z + to_clip[12])) / w) * width - x;
      const v = (0.5 - (0.5 * (to_clip[1] * X + to_clip[5] * Y + to_clip[9] * Z + to_clip[13])) / w) * height - y;
      const reach = Math.max(2, (0.5 * radius * size * scale * height) / w);
      const off = u * u + v * v;
      if (off > reach * reach) continue;
      const depth = flat ? off : (to_clip[2] * X + to_clip[6] * Y + to_clip[10] * Z + to_clip[14]) / w;
      if (depth < nearest && is_shown(p)) {
        nearest = depth;
        found = p;
      }
    }
    return {particle: found, rigid: found < 0 ? hit?.name : undefined};
  }

  /** @param {number[]|null} place of the particle that is looked at, coordinates of the run */
  function set_mark(place) {
    mark.visible = place !== null;
    if (place) mark.position.set(...place).sub(origin);
    mark.material.uniforms.size.value = 26 * Math.min(devicePixelRatio, 2);
    draw_soon();
  }

  new ResizeObserver(resize).observe(canvas.parentElement);
  matchMedia('(prefers-color-scheme: dark)').addEventListener('change', take_colours);
  set_map('viridis');
  take_colours();

  return {
    eye,
    origin,
    bounds: everything,
    draw,
    draw_soon,
    resize,
    set_particles,
    set_map,
    set_looks,
    add_lines,
    show_lines,
    add_ground,
    show_ground,
    add_rigid: rigid.add,
    move_rigid,
    show_rigid,
    found_at,
    set_mark,
    count_drawn: () => renderer.info.render.points,
  };
}

/** A ring about the particle that is looked at, over everything else. */
function make_mark(scene) {
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute('position', new THREE.Float32BufferAttribute([0, 0, 0], 3));
  const material = new THREE.RawShaderMaterial({
    glslVersion: THREE.GLSL3,
    transparent: true,
    depthTest: false,
    depthWrite: false,
    uniforms: {size: {value: 26}, colour: {value: new THREE.Color('#d00')}},
    vertexShader: `precision highp float; in vec3 position; uniform mat4 modelViewMatrix, projectionMatrix; uniform float size;
      void main() { gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0); gl_PointSize = size; }`,
    fragmentShader: `precision highp float; uniform vec3 colour; uniform float size; out vec4 painted;
      void main() { float off = abs(length(2.0 * gl_PointCoord - 1.0) - 0.8) * size / 2.0;
        if (off > 2.4) discard; painted = vec4(off < 1.3 ? colour : vec3(1.0), 1.0); }`,
  });
  const mark = new THREE.Points(geometry, material);
  mark.visible = false;
  mark.frustumCulled = false;
  mark.renderOrder = 1;
  scene.add(mark);
  return mark;
}
