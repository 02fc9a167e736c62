// Particles as points that are drawn like balls (3-D) or disks (2-D): one vertex each, everything else happens on the graphics card.
import * as THREE from 'three';

const VERTEX = `
  in vec4 place;          // x, y, z of the frame's box, body + 256 * hundredths by which it is larger than the radius; in 65535ths
  in vec2 values;         // of the field that colours and of the one that limits, in 65535ths of their ranges
  uniform vec3 low, extent;             // of the frame's box [m], from the origin of the view
  uniform float radius, pixels;         // m; height of the picture
  uniform vec4 section;                 // normal, place along it: what lies beyond is left out
  uniform bool cuts, limits, by_body;
  uniform vec2 range, limit;            // where colours begin and end, lowest and highest shown; as values
  uniform sampler2D map;
  out vec3 colour;
  out float eye_z, size;

  const float whole = 65535.0 / 65534.0;

  void hide() { gl_Position = vec4(2.0, 2.0, 2.0, 1.0); gl_PointSize = 0.0; }

  void main()
  {
    vec3 x = low + extent * (place.xyz * whole);
    float limited = values.y * whole;
    if (cuts && dot(section.xyz, x) > section.w) { hide(); return; }
    if (limits && (values.y == 1.0 || limited < limit.x || limited > limit.y)) { hide(); return; }

    vec4 eye = modelViewMatrix * vec4(x, 1.0);
    gl_Position = projectionMatrix * eye;
    eye_z = eye.z;
    float both = floor(place.w * 65535.0 + 0.5), growth = floor(both / 256.0), body = both - 256.0 * growth;
    size = radius * (1.0 + 0.01 * growth) * pixels * projectionMatrix[1][1] / gl_Position.w;
    gl_PointSize = max(size, 1.5);

    float t = by_body ? (body + 0.5) / 256.0
                      : (0.5 + 255.0 * clamp((values.x * whole - range.x) / (range.y - range.x), 0.0, 1.0)) / 256.0;
    colour = !by_body && values.x == 1.0 ? vec3(0.6) : texture(map, vec2(t, 0.5)).rgb;
  }`;

// The colour in the middle of a particle is that of the map, so that the legend can be read; light falls from over the reader's left shoulder.
const FRAGMENT = `
  in vec3 colour;
  in float eye_z, size;
  uniform float radius;
  uniform mat4 projectionMatrix;
  out vec4 painted;

  void main()
  {
    vec2 at = 2.0 * gl_PointCoord - 1.0;
    float outside = dot(at, at);
    if (outside > 1.0 && size > 2.0) discard;
    vec3 normal = vec3(at.x, -at.y, sqrt(max(0.0, 1.0 - outside)));
    #ifdef BALLS
    float lit = min(1.0, 0.30 + 0.82 * max(0.0, dot(normal, vec3(-0.30, 0.40, 0.866))));
    float light = mix(0.95, lit, smoothstep(2.0, 8.0, size));   // of a ball of few pixels nothing but noise would be seen
    float z = eye_z + radius * normal.z;
    vec2 clip = vec2(projectionMatrix[2][2] * z + projectionMatrix[3][2], projectionMatrix[2][3] * z + projectionMatrix[3][3]);
    gl_FragDepth = clamp(0.5 + 0.5 * clip.x / clip.y, 0.0, 1.0);
    #else
    float light = size > 5.0 ? mix(0.72, 1.0, smoothstep(0.0, 0.45, normal.z)) : 1.0;
    #endif
    painted = vec4(colour * light, 1.0);
  }`;

export function particle_material(balls) {
  return new THREE.RawShaderMaterial({
    glslVersion: THREE.GLSL3,
    defines: balls ? {BALLS: ''} : {},
    vertexShader: `precision highp float; uniform mat4 modelViewMatrix, projectionMatrix; ${VERTEX}`,
    fragmentShader: `precision highp float; ${FRAGMENT}`,
    uniforms: {
      low: {value: new THREE.Vector3()},
      extent: {value: new THREE.Vector3()},
      radius: {value: 1},
      pixels: {value: 1},
      section: {value: new THREE.Vector4()},
      cuts: {value: false},
      limits: {value: false},
      by_body: {value: false},
      range: {value: new THREE.Vector2(0, 1)},
      limit: {value: new THREE.Vector2(0, 1)},
      map: {value: null},
    },
  });
}

/** A row of 256 colours. */
export function map_texture(pixels) {
  const texture = new THREE.DataTexture(pixels, 256, 1, THREE.RGBAFormat);
  texture.needsUpdate = true;
  return texture;
}
