// Rigid bodies: their surfaces, which move and turn with the frames.
import * as THREE from 'three';
import {toCreasedNormals} from 'three/examples/jsm/utils/BufferGeometryUtils.js';
import {RIGID} from './colours.js';

const SHARP_EDGE = (40 * Math.PI) / 180; // between facets, above which their normals are not averaged
const NUMBERS = 7; // of a body in a frame: translation, quaternion

const VERTEX = `precision highp float;
  in vec3 position, normal;
  uniform mat4 modelMatrix, modelViewMatrix, projectionMatrix;
  uniform mat3 normalMatrix;
  out vec3 seen_normal, place;
  void main()
  {
    place = (modelMatrix * vec4(position, 1.0)).xyz;   // as particles have it, from the origin of the view
    seen_normal = normalMatrix * normal;
    gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
  }`;

const FRAGMENT = `precision highp float;
  in vec3 seen_normal, place;
  uniform vec3 colour;
  uniform vec4 section;
  uniform bool cuts;
  out vec4 painted;
  void main()
  {
    if (cuts && dot(section.xyz, place) > section.w) discard;
    #ifdef SHADED
    vec3 normal = normalize(gl_FrontFacing ? seen_normal : -seen_normal);
    float light = mix(0.45, 1.0, 0.5 + 0.5 * dot(normal, vec3(-0.30, 0.40, 0.866)));
    #else
    float light = 1.0;
    #endif
    painted = vec4(colour * light, 1.0);
  }`;

/** Edges that belong to one triangle only. @param {ArrayLike<number>} triples of nodes @returns {number[]} pairs of nodes */
export function outline_of(triples) {
  const edges = new Map();
  for (let t = 0; t < triples.length; t += 3)
    for (let k = 0; k < 3; ++k) {
      const pair = [triples[t + k], triples[t + ((k + 1) % 3)]];
      const key = `${Math.min(...pair)} ${Math.max(...pair)}`;
      edges.set(key, edges.has(key) ? [] : pair);
    }
  return [...edges.values()].flat();
}

/** @param {THREE.Scene} scene @param {THREE.Vector3} origin of the view @param {boolean} flat in 2-D they lie behind the particles */
export function make_rigid_bodies(scene, origin, flat) {
  const group = new THREE.Group();
  scene.add(group);
  const uniforms = {section: {value: new THREE.Vector4()}, cuts: {value: false}};
  const material = (light) =>
    new THREE.RawShaderMaterial({
      glslVersion: THREE.GLSL3,
      side: THREE.DoubleSide,
      depthWrite: !flat,
      defines: flat ? {} : {SHADED: ''},
      vertexShader: VERTEX,
      fragmentShader: FRAGMENT,
      uniforms: {...uniforms, colour: {value: new THREE.Vector3(...RIGID).multiplyScalar(light / 255)}},
    });
  const [inside, edge] = [material(1), material(0.5)];

  /** @param {number[]} middle of its box at the beginning @param {Float32Array} places three a node, from there @param {Uint32Array} triples */
  function add(name, middle, places, triples) {
    let geometry = new THREE.BufferGeometry();
    geometry.setAttribute('position', new THREE.BufferAttribute(places, 3));
    geometry.setIndex(new THREE.BufferAttribute(triples, 1));
    if (!flat) geometry = toCreasedNormals(geometry, SHARP_EDGE);
    const body = new THREE.Mesh(geometry, inside);
    body.name = name;
    body.userData.middle = new THREE.Vector3(...middle).sub(origin);
    body.position.copy(body.userData.middle);
    body.renderOrder = flat ? -2 : 0;
    if (flat) {
      const border = new THREE.BufferGeometry();
      border.setAttribute('position', geometry.getAttribute('position'));
      border.setIndex(outline_of(triples));
      const lines = new THREE.LineSegments(border, edge);
      lines.renderOrder = -1;
      lines.raycast = () => {};
      body.add(lines);
    }
    group.add(body);
  }

  /** @param {Float32Array|null} motion of all bodies since the beginning; without, they are not shown */
  function move(motion) {
    group.children.forEach((body, b) => {
      body.visible = motion !== null;
      if (!motion) return;
      const [x, y, z, ...turn] = motion.subarray(NUMBERS * b, NUMBERS * (b + 1));
      body.position.set(x, y, z).add(body.userData.middle);
      body.quaternion.set(...turn).normalize();
    });
  }

  /** What is beyond a plane is left out, as of particles. */
  function cut(cuts, section) {
    uniforms.cuts.value = cuts;
    uniforms.section.value.copy(section);
  }

  /** The body that a ray meets first, and where. @param {THREE.Raycaster} ray @returns {{name: string, point: THREE.Vector3}|undefined} */
  function met_by(ray) {
    if (!group.visible) return undefined;
    const {section, cuts} = uniforms;
    const {x, y, z, w} = section.value;
    const is_there = ({object, point}) => object.visible && !(cuts.value && x * point.x + y * point.y + z * point.z > w);
    group.updateMatrixWorld();
    const hit = ray.intersectObjects(group.children).find(is_there);
    return hit && {name: hit.object.name, point: hit.point};
  }

  return {
    add,
    move,
    cut,
    met_by,
    show: (yes) => {
      group.visible = yes;
    },
  };
}
