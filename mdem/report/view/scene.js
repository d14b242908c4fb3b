// The scene of three.js: tubes, coloured by a field, in one frame, whole or cut open.
import {$, elementBegin, facts, fieldValue, frames, jointBegin, joints, position, tubes} from './frames.js';

// --- Colours ------------------------------------------------------------------------------------------------

const rgb = (hex) => [1, 3, 5].map((k) => parseInt(hex.substr(k, 2), 16));
export const sequential = facts.colours.map(rgb);
export const diverging = ['#2166ac', '#67a9cf', '#d1dde6', '#e8e4df', '#f5d5c0', '#ef8a62', '#b2182b'].map(rgb);
const noColour = [128, 128, 128];

export function mapped(stops, at) {
  const s = (stops.length - 1) * Math.min(1, Math.max(0, at));
  const k = Math.min(stops.length - 2, Math.floor(s));
  return stops[k].map((c, i) => c + (s - k) * (stops[k + 1][i] - c));
}

// Elements are coloured by a field, which changes in time, by a number of their tube, or by nothing.
export const sources = [
  ...facts.fields.map((f, k) => ({...f, field: k})),
  ...facts.tube_numbers.map((n) => ({...n, tube: n.values, from: Math.min(...n.values), to: Math.max(...n.values)})),
  {name: 'No colour', plain: true},
];

export const shown = {frame: frames - 1, source: sources[0]};

function colourAt(s, value) {
  if (s.plain) return [150, 176, 204];
  if (Number.isNaN(value)) return noColour;
  return mapped(s.signed ? diverging : sequential, s.to > s.from ? (value - s.from) / (s.to - s.from) : 0);
}

// --- The scene ----------------------------------------------------------------------------------------------

export const canvas = $('canvas');
export let renderer, scene;
// Three texels a joint: position, normal of the ring, a direction in the ring. Textures have 1024 joints in a row.
const stride = 12, rowJoints = 1024, rows = Math.ceil(joints / rowJoints);
const jointData = new Float32Array(rows * rowJoints * stride);
const tints = new Uint8Array(rows * rowJoints * 4);
const jointTexture = new THREE.DataTexture(jointData, 3 * rowJoints, rows, THREE.RGBAFormat, THREE.FloatType);
const tintTexture = new THREE.DataTexture(tints, rowJoints, rows, THREE.RGBAFormat);
export const meshes = [];  // of the same tubes in more and more detail
const discCorners = 24, mostDiscs = 10 * tubes;  // two ends of every tube and a few cuts through it
let discs;

export const right = new THREE.Vector3(...facts.right), up = new THREE.Vector3(...facts.up),
  towards = new THREE.Vector3(...facts.towards);
export const cut = {normal: null, name: '', sign: 1, at: 0.5, offset: 0};

// A tube is one instance: software that draws as a graphics card does takes as long for an instance as for hundreds of
// triangles. A vertex is a corner of the ring at a joint, whose data stand in the texture. Thin tubes are ribbons that face
// the reader and are lit like round ones, which takes a fifth of the triangles. WebGL 2.
const vertexShader = `
attribute vec3 tube;  // first joint, elements, radius
uniform highp sampler2D joints, tints;
varying vec3 side, facing, eye, world;
flat varying vec3 colour;
void main() {
  int i = int(tube.x + min(position.z, tube.y));
  ivec2 at = ivec2(i % ${rowJoints}, i / ${rowJoints});
  ivec2 first = ivec2(3 * at.x, at.y);
  vec3 centre = texelFetch(joints, first, 0).xyz, along = texelFetch(joints, first + ivec2(1, 0), 0).xyz;
#ifdef RIBBON
  vec3 towards = normalize(cameraPosition - centre);
  vec3 outward = position.x * normalize(cross(along, towards));
  facing = (viewMatrix * vec4(normalize(towards - dot(towards, along) * along), 0.0)).xyz;
#else
  vec3 u = texelFetch(joints, first + ivec2(2, 0), 0).xyz;
  vec3 outward = u * position.x + cross(along, u) * position.y;
  facing = vec3(0.0);
#endif
  world = centre + tube.z * outward;
  colour = texelFetch(tints, at, 0).rgb;
  vec4 seen = viewMatrix * vec4(world, 1.0);
  side = (viewMatrix * vec4(outward, 0.0)).xyz;
  eye = seen.xyz;
  gl_Position = projectionMatrix * seen;
}`;

const paint = `
uniform vec3 paper;
uniform vec2 haze;  // from this distance to that one
vec3 lit(vec3 colour, vec3 n, vec3 eye) {
  vec3 v = normalize(-eye);
  float facing = max(dot(n, v), 0.0);
  vec3 key = normalize(vec3(-0.35, 0.75, 0.6));
  float light = 0.5 + 0.38 * max(dot(n, key), 0.0) + 0.2 * facing;
  float shine = pow(max(dot(n, normalize(key + v)), 0.0), 30.0);
  // The rim is dark, so that neighbours are told apart.
  return (colour * light + 0.22 * shine) * mix(0.3, 1.0, smoothstep(0.05, 0.5, facing));
}
vec3 hazy(vec3 colour, vec3 eye) {
  return mix(colour, paper, 0.3 * smoothstep(haze.x, haze.y, length(eye)));
}`;

const fragmentShader = paint + `
varying vec3 side, facing, eye, world;
flat varying vec3 colour;
#ifdef CUT
uniform vec4 plane;
#endif
void main() {
#ifdef CUT
  if (dot(world, plane.xyz) > plane.w) discard;
#endif
  vec3 n = normalize(side + facing * sqrt(max(0.0, 1.0 - dot(side, side))));
#ifdef RIBBON
  vec3 c = lit(colour, n, eye);
#else
  vec3 c = gl_FrontFacing ? lit(colour, n, eye) : 0.55 * colour;
#endif
  gl_FragColor = vec4(hazy(c, eye), 1.0);
}`;

// Ends of tubes, and tubes cut across.
const discVertexShader = `
attribute vec2 corner;
attribute vec3 tint;
varying vec3 eye, colour;
varying vec2 at;
void main() {
  vec4 seen = viewMatrix * vec4(position, 1.0);
  eye = seen.xyz;
  colour = tint;
  at = corner;
  gl_Position = projectionMatrix * seen;
}`;
const discFragmentShader = paint + `
varying vec3 eye, colour;
varying vec2 at;
void main() {
  float rim = smoothstep(0.72, 0.8, length(at));
  gl_FragColor = vec4(hazy(colour * mix(1.0, 0.35, rim), eye), 1.0);
}`;

export const uniforms = {
  paper: {value: new THREE.Vector3(1, 1, 1)},
  haze: {value: new THREE.Vector2(0, 1)},
  plane: {value: new THREE.Vector4(0, 0, 0, 0)},
  joints: {value: jointTexture},
  tints: {value: tintTexture},
};

// Rings at every joint of the longest tube, or every second ...; a shorter tube draws its last ring again.
function tubeGeometry(sides, every) {
  const elementsOf = facts.tube_radius.map((_, t) => elementBegin[t + 1] - elementBegin[t]);
  const rings = Math.ceil(Math.max(...elementsOf) / every) + 1, corners = [], index = [];
  for (let k = 0; k < rings; ++k)
    for (let c = 0; c < sides; ++c)
      corners.push(Math.cos(2 * Math.PI * c / sides), Math.sin(2 * Math.PI * c / sides), k * every);
  // The last corner of a triangle gives it its colour: that of the joint where the element begins.
  for (let k = 0; k + 1 < rings; ++k)
    for (let c = 0; c < (sides === 2 ? 1 : sides); ++c) {  // two sides are a ribbon
      const here = k * sides + c, next = k * sides + (c + 1) % sides;
      index.push(next, next + sides, here, next + sides, here + sides, here);
    }
  const g = new THREE.InstancedBufferGeometry();
  g.setAttribute('position', new THREE.BufferAttribute(new Float32Array(corners), 3));
  g.setIndex(index);
  g.setAttribute('tube', new THREE.InstancedBufferAttribute(
    new Float32Array(elementsOf.flatMap((n, t) => [jointBegin[t], n, facts.tube_radius[t]])), 3));
  return g;
}

function discGeometry() {
  const corner = [], index = [];
  for (let d = 0; d < mostDiscs; ++d) {
    corner.push(0, 0);
    for (let c = 0; c < discCorners; ++c) {
      corner.push(Math.cos(2 * Math.PI * c / discCorners), Math.sin(2 * Math.PI * c / discCorners));
      const first = d * (discCorners + 1);
      index.push(first, first + 1 + c, first + 1 + (c + 1) % discCorners);
    }
  }
  const g = new THREE.BufferGeometry(), vertices = corner.length / 2;
  const moving = (values, n, scaled) => new THREE.BufferAttribute(values, n, scaled).setUsage(THREE.DynamicDrawUsage);
  g.setAttribute('position', moving(new Float32Array(3 * vertices), 3));
  g.setAttribute('tint', moving(new Uint8Array(3 * vertices), 3, true));
  g.setAttribute('corner', new THREE.BufferAttribute(new Float32Array(corner), 2));
  g.setIndex(index);
  return g;
}

// Links: rods between the axes of the tubes that they join, of which the part between the walls can be seen.
let rods;

function makeLinks() {
  if (facts.links.length === 0) return;
  rods = new THREE.InstancedMesh(new THREE.CylinderGeometry(1, 1, 1, 8), new THREE.MeshBasicMaterial({color: 0xe0281e}),
    facts.links.length);
  rods.frustumCulled = false;
  scene.add(rods);
}

// Cages about elements that passed a limit, from then on, and about the one that was gone to. They show through tubes.
export const gone = {element: -1};
const cages = [];

function makeCages() {
  const shape = new THREE.SphereGeometry(1, 10, 8);
  for (let k = 0; k <= facts.marks.length; ++k) {
    const cage = new THREE.Mesh(shape, new THREE.MeshBasicMaterial(
      {color: k < facts.marks.length ? 0xe07b00 : 0xc2185b, wireframe: true, depthTest: false, transparent: true}));
    cage.frustumCulled = false;
    cage.renderOrder = 1;
    cages.push(cage);
    scene.add(cage);
  }
}

export const tubeOfElement = (element) => elementBegin.findIndex((begin) => begin > element) - 1;

// Its middle, in this frame.
export function placeOf(element, into) {
  const joint = element + tubeOfElement(element);
  return jointAt(joint, into).add(jointAt(joint + 1, u)).multiplyScalar(0.5);
}

function placeCages() {
  const time = facts.time_ps[shown.frame];
  cages.forEach((cage, k) => {
    const mark = facts.marks[k], element = mark ? mark.element : gone.element;
    cage.visible = element >= 0 && (!mark || mark.time_ps <= time + 1e-9);
    if (!cage.visible) return;
    placeOf(element, cage.position);
    cage.scale.setScalar((mark ? 1.6 : 1.9) * facts.tube_radius[tubeOfElement(element)]);
  });
}

export function makeScene() {
  const context = canvas.getContext('webgl2', {antialias: false, alpha: false, powerPreference: 'high-performance'});
  if (!context) throw new Error('this browser offers no WebGL 2; `ropewalk picture` makes pictures without it');
  renderer = new THREE.WebGLRenderer({canvas, context, antialias: false});
  scene = new THREE.Scene();

  const material = (defines) => new THREE.ShaderMaterial({
    vertexShader, fragmentShader, uniforms, defines,
    side: defines.CUT || defines.RIBBON ? THREE.DoubleSide : THREE.FrontSide,
  });
  for (const [sides, every] of [[2, 3], [2, 1], [8, 1], [12, 1], [24, 1]]) {
    const ribbon = sides === 2 ? {RIBBON: 1} : {};
    const materials = {whole: material(ribbon), cutOpen: material({...ribbon, CUT: 1})};
    const mesh = new THREE.Mesh(tubeGeometry(sides, every), materials.whole);
    mesh.frustumCulled = false;
    mesh.userData = materials;
    meshes.push(mesh);
    scene.add(mesh);
  }
  discs = new THREE.Mesh(discGeometry(), new THREE.ShaderMaterial(
    {vertexShader: discVertexShader, fragmentShader: discFragmentShader, uniforms, side: THREE.DoubleSide}));
  discs.frustumCulled = false;
  scene.add(discs);
  makeLinks();
  makeCages();
}

// --- A frame ------------------------------------------------------------------------------------------------

// The position of a joint in this frame.
export const jointAt = (i, into) => into.fromArray(jointData, i * stride);

const p = new THREE.Vector3(), q = new THREE.Vector3(), n = new THREE.Vector3(), u = new THREE.Vector3();

// Rings stand on the bisecting planes; the direction in the ring is carried along the tube without turning.
function placeJoints() {
  for (let i = 0; i < joints; ++i)
    for (let k = 0; k < 3; ++k) jointData[i * stride + k] = position(shown.frame, i, k);
  for (let t = 0; t < tubes; ++t) {
    const from = jointBegin[t], to = jointBegin[t + 1] - 1;
    for (let i = from; i <= to; ++i) {
      jointAt(Math.max(from, i - 1), p);
      jointAt(Math.min(to, i + 1), q);
      n.subVectors(q, p).normalize();
      if (i === from) u.set(Math.abs(n.x) < 0.6 ? 1 : 0, Math.abs(n.x) < 0.6 ? 0 : 1, 0);
      u.addScaledVector(n, -u.dot(n)).normalize();
      n.toArray(jointData, i * stride + 4);
      u.toArray(jointData, i * stride + 8);
    }
  }
  jointTexture.needsUpdate = true;
}

function valueOf(s, element, tube) {
  if (s.plain) return NaN;
  return s.tube ? s.tube[tube] : fieldValue(s.field, shown.frame, element);
}

function paintElements() {
  const s = shown.source;
  for (let t = 0; t < tubes; ++t) {
    for (let e = elementBegin[t]; e < elementBegin[t + 1]; ++e) {
      const c = colourAt(s, valueOf(s, e, t)), at = 4 * (e + t);
      tints[at] = c[0];
      tints[at + 1] = c[1];
      tints[at + 2] = c[2];
      tints[at + 3] = 255;
    }
  }
  tintTexture.needsUpdate = true;
}

let discCount = 0;

// `a` and `b` are half axes.
function addDisc(centre, a, b, joint) {
  if (discCount === mostDiscs) return;
  const {position, tint, corner} = discs.geometry.attributes;
  const first = discCount++ * (discCorners + 1);
  for (let i = first; i <= first + discCorners; ++i) {
    const x = corner.array[2 * i], y = corner.array[2 * i + 1];
    position.array[3 * i] = centre.x + x * a.x + y * b.x;
    position.array[3 * i + 1] = centre.y + x * a.y + y * b.y;
    position.array[3 * i + 2] = centre.z + x * a.z + y * b.z;
    for (let k = 0; k < 3; ++k) tint.array[3 * i + k] = tints[4 * joint + k];
  }
}

function placeDiscs() {
  discCount = 0;
  const centre = new THREE.Vector3(), d = new THREE.Vector3(), a = new THREE.Vector3(), b = new THREE.Vector3();
  const height = (v) => cut.normal ? cut.sign * v.dot(cut.normal) - cut.offset : -1;
  for (let t = 0; t < tubes; ++t) {
    const radius = facts.tube_radius[t], from = jointBegin[t], to = jointBegin[t + 1] - 1;
    for (const [i, joint] of [[from, from], [to, to - 1]]) {
      jointAt(i, centre);
      if (height(centre) > 0) continue;
      n.fromArray(jointData, i * stride + 4);
      a.fromArray(jointData, i * stride + 8).multiplyScalar(radius);
      b.crossVectors(n, a);
      addDisc(centre, a, b, joint);
    }
    if (!cut.normal) continue;
    for (let i = from; i < to; ++i) {
      jointAt(i, p);
      jointAt(i + 1, q);
      const hp = height(p), hq = height(q);
      if (hp * hq > 0 || hp === hq) continue;
      d.subVectors(q, p).normalize();
      const slope = cut.sign * d.dot(cut.normal);
      if (Math.abs(slope) < 0.3) continue;  // the inside of the tube shows its colour instead
      centre.copy(p).lerp(q, hp / (hp - hq));
      a.fromArray(jointData, i * stride + 8);
      a.addScaledVector(d, -a.dot(d)).normalize();
      b.crossVectors(d, a);
      // Slid along the tube into the plane.
      for (const v of [a, b]) v.addScaledVector(d, -cut.sign * v.dot(cut.normal) / slope).multiplyScalar(radius);
      addDisc(centre, a, b, i);
    }
  }
  const {position, tint} = discs.geometry.attributes;
  position.needsUpdate = tint.needsUpdate = true;
  discs.geometry.setDrawRange(0, 3 * discCorners * discCount);
}

export let linksShown = 0;

// A rod of no thickness: the link does not hold now, is cut away, or joins the image of a tube one period away.
function placeLinks() {
  if (!rods) return;
  const time = facts.time_ps[shown.frame], radius = Math.max(...facts.tube_radius), along = new THREE.Vector3(0, 1, 0);
  const turn = new THREE.Quaternion(), size = new THREE.Vector3(), place = new THREE.Matrix4();
  const middleOf = (joint, into) => jointAt(joint, into).add(jointAt(joint + 1, u)).multiplyScalar(0.5);
  linksShown = 0;
  facts.links.forEach(([a, b, formed, broke], k) => {
    middleOf(a, p);
    middleOf(b, q);
    n.subVectors(q, p);
    const length = n.length();
    p.lerp(q, 0.5);
    const holds = formed <= time && (broke === null || time < broke);
    const there = holds && length < 4 * radius + 1 && !(cut.normal && cut.sign * p.dot(cut.normal) > cut.offset);
    linksShown += there;
    turn.setFromUnitVectors(along, n.divideScalar(length || 1));
    size.set(0.3 * radius, length, 0.3 * radius).multiplyScalar(there ? 1 : 0);
    rods.setMatrixAt(k, place.compose(p, turn, size));
  });
  rods.instanceMatrix.needsUpdate = true;
}

function placeCut() {
  for (const mesh of meshes) mesh.material = cut.normal ? mesh.userData.cutOpen : mesh.userData.whole;
  if (!cut.normal) return;
  let low = Infinity, high = -Infinity;
  for (let i = 0; i < joints; ++i) {
    const h = cut.normal.dot(jointAt(i, p));
    low = Math.min(low, h);
    high = Math.max(high, h);
  }
  const radius = Math.max(...facts.tube_radius);
  low -= radius;
  high += radius;
  cut.offset = cut.sign * (low + cut.at * (high - low));
  uniforms.plane.value.set(cut.sign * cut.normal.x, cut.sign * cut.normal.y, cut.sign * cut.normal.z, cut.offset);
}

export function placeFrame(f) {
  shown.frame = Math.min(frames - 1, Math.max(0, f));
  placeJoints();
}

// Another frame, colour or cut is chosen.
export function updateScene() {
  placeCut();
  paintElements();
  placeDiscs();
  placeLinks();
  placeCages();
}

// Nothing is drawn any more.
export function closeScene() {
  renderer = null;
}
