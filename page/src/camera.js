// The eye: a direction, what is looked at, and how high the picture is there. Either camera can be made of that, so that changing over keeps the view.
import * as THREE from 'three';
import {OrbitControls} from 'three/addons/controls/OrbitControls.js';

const OPENING = 35; // degrees, of the perspective camera
const SLOPE = 2 * Math.tan(THREE.MathUtils.degToRad(OPENING / 2)); // height of the picture over distance

/** Three directions at right angles: up, to the right, and towards a reader who stands in front. */
export function directions(up, dimension) {
  const upwards = dimension === 2 ? new THREE.Vector3(0, 1, 0) : new THREE.Vector3(...up).normalize();
  const axes = [new THREE.Vector3(1, 0, 0), new THREE.Vector3(0, 1, 0), new THREE.Vector3(0, 0, 1)];
  const right = axes.find((axis) => Math.abs(axis.dot(upwards)) < 0.8).clone();
  right.addScaledVector(upwards, -right.dot(upwards)).normalize();
  return {up: upwards, right, towards: new THREE.Vector3().crossVectors(right, upwards)};
}

/** Named views: unit vectors from what is looked at to the eye. The top is looked at with a hair of slant, which says where its lower edge is. */
export function named_views({up, right, towards}) {
  const mix = (r, u, t) => new THREE.Vector3().addScaledVector(right, r).addScaledVector(up, u).addScaledVector(towards, t).normalize();
  return {front: mix(0, 0, 1), back: mix(0, 0, -1), side: mix(1, 0, 0), top: mix(0, 1, 1e-4), iso: mix(0.55, 0.45, 1)};
}

/**
 * @param {HTMLElement} element that is dragged
 * @param {{dimension: number, up: number[], bounds: THREE.Box3, moved: () => void}} what bounds from the origin of the view [m]
 */
export function make_eye(element, {dimension, up, bounds, moved}) {
  const around = directions(up, dimension);
  const views = named_views(around);
  const span = Math.max(bounds.getSize(new THREE.Vector3()).length(), 1e-9);
  const cameras = {flat: new THREE.OrthographicCamera(-1, 1, 1, -1, 0.1, 1), deep: new THREE.PerspectiveCamera(OPENING, 1, 0.1, 1)};
  let camera = dimension === 2 ? cameras.flat : cameras.deep;
  let aspect = 1;
  let quiet = false;
  let fitted = null; // direction from which everything was made to fit, until the reader moves
  for (const c of Object.values(cameras)) c.up.copy(around.up);

  const controls = new OrbitControls(camera, element);
  controls.enableDamping = false;
  controls.zoomToCursor = true;
  controls.screenSpacePanning = true;
  if (dimension === 2) {
    controls.enableRotate = false;
    controls.mouseButtons.LEFT = THREE.MOUSE.PAN;
    controls.touches.ONE = THREE.TOUCH.PAN;
  }
  controls.addEventListener('change', () => {
    if (quiet) return;
    fitted = null;
    moved();
  });

  const height = () =>
    camera === cameras.flat ? (camera.top - camera.bottom) / camera.zoom : SLOPE * camera.position.distanceTo(controls.target);

  function shape() {
    cameras.deep.aspect = aspect;
    Object.assign(cameras.flat, {left: -aspect, right: aspect, top: 1, bottom: -1});
    const distance = camera.position.distanceTo(controls.target);
    const reach = span + controls.target.length() + height();
    camera.near = camera === cameras.flat ? distance - reach : Math.max(distance - reach, distance * 1e-3, span * 1e-5);
    camera.far = distance + reach;
    camera.updateProjectionMatrix();
  }

  /** The picture's height so that all of the bounds is in it. */
  function height_to_fit(towards) {
    const right = new THREE.Vector3().crossVectors(around.up, towards).normalize();
    const top = new THREE.Vector3().crossVectors(towards, right);
    const middle = bounds.getCenter(new THREE.Vector3());
    let half_width = 0,
      half_height = 0,
      nearest = 0;
    for (let corner = 0; corner < 8; ++corner) {
      const to = new THREE.Vector3(...['x', 'y', 'z'].map((axis, k) => (corner & (1 << k) ? bounds.max : bounds.min)[axis])).sub(middle);
      half_width = Math.max(half_width, Math.abs(to.dot(right)));
      half_height = Math.max(half_height, Math.abs(to.dot(top)));
      nearest = Math.max(nearest, to.dot(towards));
    }
    const flat = 2.1 * Math.max(half_height, half_width / aspect, span * 1e-3);
    return camera === cameras.flat ? flat : flat + SLOPE * nearest * 0.8;
  }

  /** @param {{towards?: THREE.Vector3, target?: THREE.Vector3, height?: number}} view what is left out stays */
  function look(view) {
    const towards = (view.towards ?? camera.position.clone().sub(controls.target)).clone().normalize();
    const tall = view.height ?? height();
    fitted = null;
    quiet = true;
    if (view.target) controls.target.copy(view.target);
    camera.zoom = camera === cameras.flat ? 2 / tall : 1;
    camera.position.copy(controls.target).addScaledVector(towards, camera === cameras.flat ? 2 * span : tall / SLOPE);
    shape();
    controls.update();
    quiet = false;
  }

  function fit(towards = views[dimension === 2 ? 'front' : 'iso']) {
    look({towards, target: bounds.getCenter(new THREE.Vector3()), height: height_to_fit(towards)});
    fitted = towards;
  }
  const towards = () => camera.position.clone().sub(controls.target).normalize();

  return {
    views,
    around,
    fit,
    look,
    towards,
    height,
    shape,
    camera: () => camera,
    target: () => controls.target,
    fit_as_seen: () => fit(towards()),
    is_orthographic: () => camera === cameras.flat,
    set_orthographic(yes) {
      const next = yes ? cameras.flat : cameras.deep;
      if (next === camera) return;
      const view = {towards: towards(), target: controls.target.clone(), height: height()};
      const before = fitted;
      camera = next;
      controls.object = camera;
      if (before) fit(before);
      else look(view);
    },
    set_aspect(value) {
      aspect = value;
      if (fitted) fit(fitted);
      else shape();
    },
    /** Turned by angles [rad] about the vertical and towards it, moved by shares of the picture, zoomed. */
    nudge({turn = 0, tilt = 0, right = 0, up: upwards = 0, zoom = 1}) {
      const from = new THREE.Spherical().setFromVector3(
        towards().applyQuaternion(new THREE.Quaternion().setFromUnitVectors(around.up, new THREE.Vector3(0, 1, 0))),
      );
      if (dimension === 3) {
        from.theta += turn;
        from.phi -= tilt;
        from.makeSafe();
      }
      const direction = new THREE.Vector3()
        .setFromSpherical(from)
        .applyQuaternion(new THREE.Quaternion().setFromUnitVectors(new THREE.Vector3(0, 1, 0), around.up));
      const sideways = new THREE.Vector3().setFromMatrixColumn(camera.matrix, 0);
      const across = new THREE.Vector3().setFromMatrixColumn(camera.matrix, 1);
      const target = controls.target
        .clone()
        .addScaledVector(sideways, right * height())
        .addScaledVector(across, upwards * height());
      look({towards: direction, target, height: height() / zoom});
      moved();
    },
  };
}
