// The camera: draws the scene as often and as finely as the machine can, and moves about it.
import {$, facts, joints, tickText} from './frames.js';
import {canvas, jointAt, meshes, renderer, right, scene, towards, uniforms, up} from './scene.js';

export let camera, controls;
// Called before each drawing while frames play.
export const animation = {step: null};

const corner = new THREE.Vector3();
let wanted = false, moving = 0, ratio = 1, lastDraw = 0, wasRestless = false;
export const still = Math.max(2, window.devicePixelRatio || 1);

export function makeCamera() {
  camera = new THREE.PerspectiveCamera(26, 1, 1, 1000);
  camera.up.copy(up);
  controls = new THREE.OrbitControls(camera, canvas);
  controls.enableKeys = false;
  controls.screenSpacePanning = true;
  controls.rotateSpeed = 0.8;
  controls.addEventListener('change', request);
}

// Draws soon. While things move, as many pixels as come fast enough; then once more, smoothly.
export function request() {
  moving = performance.now();
  schedule();
}

function schedule() {
  if (wanted || !renderer) return;
  wanted = true;
  requestAnimationFrame(draw);
}

function size(pixels) {
  const box = canvas.parentElement;
  const width = box.clientWidth, height = box.clientHeight;
  renderer.setPixelRatio(pixels);
  renderer.setSize(width, height, false);
  camera.aspect = width / height;
}

function prepareCamera(hasty) {
  const sphere = bounds();
  const distance = camera.position.distanceTo(sphere.centre);
  camera.near = Math.max(0.002 * sphere.radius, distance - 1.1 * sphere.radius);
  camera.far = distance + 1.1 * sphere.radius;
  camera.updateProjectionMatrix();
  const target = camera.position.distanceTo(controls.target), thick = Math.max(8, 0.6 * sphere.radius);
  uniforms.haze.value.set(target, target + thick);
  // The number of sides follows the tubes' size on the screen. In haste thin tubes pass over two joints of three.
  const pixels = Math.max(...facts.tube_radius) * pixelsPerNm() * renderer.getPixelRatio();
  const detail = pixels < 6 ? (hasty ? 0 : 1) : pixels < 14 || hasty ? 2 : pixels < 40 ? 3 : 4;
  meshes.forEach((mesh, k) => { mesh.visible = k === detail; });
}

function pixelsPerNm() {
  return canvas.clientHeight / (2 * Math.tan(camera.fov * Math.PI / 360) * camera.position.distanceTo(controls.target));
}

function bounds() {
  const low = new THREE.Vector3(Infinity, Infinity, Infinity), high = low.clone().negate();
  for (let i = 0; i < joints; ++i) {
    jointAt(i, corner);
    low.min(corner);
    high.max(corner);
  }
  return {centre: low.clone().add(high).multiplyScalar(0.5), radius: 0.5 * low.distanceTo(high) + Math.max(...facts.tube_radius)};
}

// hasty: with fewer sides or joints.
export function render(pixels, hasty = false) {
  size(pixels);
  prepareCamera(hasty);
  renderer.setClearColor(stageColour());
  renderer.render(scene, camera);
}

function draw(now) {
  wanted = false;
  if (!renderer) return;
  const restless = animation.step || performance.now() - moving < 250;
  if (restless) {
    const gap = now - lastDraw;
    if (wasRestless && gap > 36) ratio = Math.max(0.5, ratio * 0.85);
    if (wasRestless && gap < 22) ratio = Math.min(still, ratio * 1.05);
    wasRestless = true;
    lastDraw = now;
    render(ratio, ratio < 0.9);
    counted(now);
    showScale();
    if (animation.step) animation.step(now);
    schedule();
    return;
  }
  wasRestless = false;
  render(still);
  showScale();
  document.documentElement.dataset.state = 'ready';
}

let drawn = [];
// Writes down how fast it is: frames per second while something moves.
function counted(now) {
  drawn.push(now);
  drawn = drawn.filter((t) => t > now - 1000);
  document.documentElement.dataset.rate = drawn.length;
}

function stageColour() {
  const css = getComputedStyle(document.documentElement).getPropertyValue('--stage').trim();
  const colour = new THREE.Color(css);
  uniforms.paper.value.set(colour.r, colour.g, colour.b);
  return colour;
}

let looked = null;

// From a direction (of right, up and towards), so that the rope fills the stage.
export function lookFrom(x, y, z) {
  const direction = new THREE.Vector3().addScaledVector(right, x).addScaledVector(up, y).addScaledVector(towards, z)
    .normalize();
  const back = direction, side = new THREE.Vector3().crossVectors(up, back).normalize();
  const above = new THREE.Vector3().crossVectors(back, side);
  const tall = Math.tan(camera.fov * Math.PI / 360), box = canvas.parentElement;
  const wide = tall * box.clientWidth / box.clientHeight;
  const radius = 1.6 * Math.max(...facts.tube_radius);
  // Looks at the middle of the shown part, from as near as all its points allow.
  const middle = bounds().centre;
  let target = middle;
  let distance = 0;
  for (let round = 0; round < 4; ++round) {
    const reach = {l: 0, r: 0, b: 0, t: 0};
    distance = 0;
    for (let i = 0; i < joints; ++i) {
      jointAt(i, corner).sub(target);
      const depth = corner.dot(back), px = corner.dot(side), py = corner.dot(above);
      distance = Math.max(distance, (Math.abs(px) + radius) / wide + depth, (Math.abs(py) + radius) / tall + depth);
    }
    for (let i = 0; i < joints; ++i) {
      jointAt(i, corner).sub(target);
      const w = distance - corner.dot(back), px = corner.dot(side) / w, py = corner.dot(above) / w;
      reach.l = Math.min(reach.l, px);
      reach.r = Math.max(reach.r, px);
      reach.b = Math.min(reach.b, py);
      reach.t = Math.max(reach.t, py);
    }
    if (round < 3)
      target = target.clone().addScaledVector(side, 0.5 * (reach.l + reach.r) * distance)
        .addScaledVector(above, 0.5 * (reach.b + reach.t) * distance);
  }
  controls.target.copy(target);
  camera.position.copy(target).addScaledVector(back, 1.06 * distance);
  controls.update();
  looked = {from: [x, y, z], place: camera.position.clone()};
  request();
}

// The stage has another size. Whoever has not turned the rope since sees all of it again.
export function fitAgain() {
  if (looked && camera.position.distanceTo(looked.place) < 1e-6) lookFrom(...looked.from);
  else request();
}

export const sides = {oblique: [0.55, 0.3, 0.78], side: [0, 0, 1], top: [0, 1, 1e-4], end: [1, 0, 1e-4]};

export function turn(x, y) {
  const arm = camera.position.clone().sub(controls.target);
  arm.applyAxisAngle(up, x);
  const angle = arm.angleTo(up), to = Math.min(Math.PI - 0.01, Math.max(0.01, angle - y));
  arm.applyAxisAngle(new THREE.Vector3().crossVectors(up, arm).normalize(), to - angle);
  camera.position.copy(controls.target).add(arm);
  controls.update();
  request();
}

export function shift(x, y) {
  const step = 40 / pixelsPerNm();
  const across = new THREE.Vector3().setFromMatrixColumn(camera.matrix, 0),
    above = new THREE.Vector3().setFromMatrixColumn(camera.matrix, 1);
  for (const v of [camera.position, controls.target]) v.addScaledVector(across, x * step).addScaledVector(above, y * step);
  controls.update();
  request();
}

export function zoom(factor) {
  camera.position.sub(controls.target).multiplyScalar(factor).add(controls.target);
  controls.update();
  request();
}

function showScale() {
  const perNm = pixelsPerNm(), longest = 0.2 * canvas.clientWidth / perNm;
  const base = Math.pow(10, Math.floor(Math.log10(longest)));
  const length = [5, 2, 1].map((m) => m * base).find((v) => v <= longest);
  $('scale').firstElementChild.textContent = tickText(length) + ' nm';
  $('scale').style.width = 100 * length * perNm / canvas.clientWidth + '%';  // also of a stage that is printed smaller
}
