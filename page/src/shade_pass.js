// Shade between what is near and what lies behind it (Boucheron, 2009: eye-dome lighting), by which a cloud of balls shows its shape.
import * as THREE from 'three';

const VERTEX = `precision highp float; in vec3 position; out vec2 at;
  void main() { at = 0.5 + 0.5 * position.xy; gl_Position = vec4(position.xy, 0.0, 1.0); }`;

const FRAGMENT = `
  precision highp float;
  in vec2 at;
  uniform sampler2D picture, depths;
  uniform vec2 pixel;           // of the picture, in its width and height
  uniform float reach;          // depth over which shade is full [m]
  uniform vec2 near_far;
  uniform bool orthographic;
  out vec4 painted;

  float distance_at(vec2 place)
  {
    float d = texture(depths, place).r;
    return orthographic ? mix(near_far.x, near_far.y, d) : near_far.x * near_far.y / (near_far.y - d * (near_far.y - near_far.x));
  }

  void main()
  {
    vec4 colour = texture(picture, at);
    if (texture(depths, at).r < 1.0) {
      float here = distance_at(at), shade = 0.0;
      for (int k = 0; k < 8; ++k) {
        float angle = 0.785398 * float(k);
        vec2 step = pixel * vec2(cos(angle), sin(angle));
        shade += clamp((here - distance_at(at + 1.5 * step)) / reach, 0.0, 1.0) + clamp((here - distance_at(at + 4.0 * step)) / (2.0 * reach), 0.0, 1.0);
      }
      colour.rgb *= 1.0 - 0.6 * min(1.0, shade / 8.0);
    }
    painted = colour;
  }`;

/** Draws a scene into a picture of its own, and that with shade to the canvas. */
export function make_shade_pass(renderer) {
  const target = new THREE.WebGLRenderTarget(1, 1, {depthTexture: new THREE.DepthTexture(1, 1, THREE.UnsignedIntType)});
  const material = new THREE.RawShaderMaterial({
    glslVersion: THREE.GLSL3,
    vertexShader: VERTEX,
    fragmentShader: FRAGMENT,
    depthTest: false,
    depthWrite: false,
    transparent: true,
    blending: THREE.NoBlending,
    uniforms: {
      picture: {value: target.texture},
      depths: {value: target.depthTexture},
      pixel: {value: new THREE.Vector2()},
      reach: {value: 1},
      near_far: {value: new THREE.Vector2()},
      orthographic: {value: false},
    },
  });
  const triangle = new THREE.BufferGeometry();
  triangle.setAttribute('position', new THREE.Float32BufferAttribute([-1, -1, 0, 3, -1, 0, -1, 3, 0], 3));
  const mesh = new THREE.Mesh(triangle, material);
  mesh.frustumCulled = false;
  const screen = new THREE.Scene().add(mesh);
  const nothing = new THREE.Camera();
  const size = new THREE.Vector2();

  return (scene, camera, reach) => {
    renderer.getDrawingBufferSize(size);
    if (target.width !== size.x || target.height !== size.y) target.setSize(size.x, size.y);
    renderer.setRenderTarget(target);
    renderer.render(scene, camera);
    renderer.setRenderTarget(null);
    material.uniforms.pixel.value.set(1 / size.x, 1 / size.y).multiplyScalar(renderer.getPixelRatio());
    material.uniforms.reach.value = reach;
    material.uniforms.near_far.value.set(camera.near, camera.far);
    material.uniforms.orthographic.value = camera.isOrthographicCamera === true;
    renderer.render(screen, nothing);
  };
}
