// The ground as a surface in the light that falls on particles, with lines at round elevations.
import * as THREE from 'three';

const CONTOURS = 16; // about so many over the height of the ground

const VERTEX = `precision highp float;
  in vec3 position, normal;
  uniform mat4 modelViewMatrix, projectionMatrix;
  uniform mat3 normalMatrix;
  uniform vec3 up, origin;
  out vec3 seen_normal, seen_up, place;
  out float elevation;
  void main()
  {
    place = position - origin;                 // as particles have it, from the origin of the view
    elevation = dot(position, up);
    seen_normal = normalMatrix * normal;
    seen_up = normalMatrix * up;
    gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
  }`;

const FRAGMENT = `precision highp float;
  in vec3 seen_normal, seen_up, place;
  in float elevation;
  uniform vec3 rock, contour;
  uniform float contours;                      // m between them, or 0
  uniform vec4 section;
  uniform bool cuts;
  out vec4 painted;
  void main()
  {
    if (cuts && dot(section.xyz, place) > section.w) discard;
    vec3 normal = normalize(seen_normal);
    if (dot(normal, seen_up) < 0.0) normal = -normal;
    float light = mix(0.55, 1.0, max(0.0, dot(normal, normalize(0.55 * vec3(-0.30, 0.40, 0.866) + 0.6 * normalize(seen_up) + vec3(-0.35, 0.0, 0.0)))));
    float steps = contours > 0.0 ? elevation / contours : 0.0;
    float wide = max(fwidth(steps), 1e-6);
    float line = contours > 0.0 ? 1.0 - smoothstep(0.4, 1.0, abs(fract(steps - 0.5) - 0.5) / wide) : 0.0;
    painted = vec4(mix(rock * light, contour, 0.6 * line * (1.0 - smoothstep(0.2, 0.5, wide))), 1.0); // lines that would fill the picture fade
  }`;

/** A round step, so that there are about CONTOURS lines. @param {Float32Array} places three a node */
export function contour_step(places, up) {
  let low = Infinity,
    high = -Infinity;
  for (let n = 0; n < places.length; n += 3) {
    const z = places[n] * up.x + places[n + 1] * up.y + places[n + 2] * up.z;
    low = Math.min(low, z);
    high = Math.max(high, z);
  }
  const wanted = (1.5 * (high - low)) / CONTOURS;
  if (!(wanted > 0)) return 0;
  const decade = 10 ** Math.floor(Math.log10(wanted));
  return decade * [5, 2, 1].find((factor) => factor * decade <= wanted);
}

/** @param {THREE.Vector3} up @param {number} contours metres between lines, or 0 for none */
export function ground_material(up, contours) {
  return new THREE.RawShaderMaterial({
    glslVersion: THREE.GLSL3,
    side: THREE.DoubleSide,
    polygonOffset: true, // lines on the surface are not buried in it
    polygonOffsetFactor: 1,
    polygonOffsetUnits: 1,
    vertexShader: VERTEX,
    fragmentShader: FRAGMENT,
    uniforms: {
      up: {value: up.clone()},
      origin: {value: new THREE.Vector3()},
      rock: {value: new THREE.Color('#ddd')},
      contour: {value: new THREE.Color('#777')},
      contours: {value: contours},
      section: {value: new THREE.Vector4()},
      cuts: {value: false},
    },
  });
}
