// The page of `ropewalk view`: frames of a run in three dimensions. THREE and THREE.OrbitControls stand before this
// script. The data are in #facts (JSON, written by view_page.cpp) and #frames (packed as pack.hpp says).
(function () {
'use strict';

const $ = (id) => document.getElementById(id);
const facts = JSON.parse($('facts').textContent);
const frames = facts.time_ps.length;
const tubes = facts.tube_radius.length;
const elementBegin = facts.tube_begin;
const jointBegin = elementBegin.map((e, t) => e + t);
const elements = elementBegin[tubes], joints = jointBegin[tubes];
const noNumber = 65535;

function fail(words) {
  renderer = null;
  $('app').hidden = true;
  $('failure').hidden = false;
  $('failure').textContent = words;
  document.documentElement.dataset.state = 'failed';
}

// --- Numbers as text ----------------------------------------------------------------------------------------

function numberText(value, digits = 4) {
  if (!Number.isFinite(value)) return '–';
  if (value === 0) return '0';
  const size = Math.abs(value);
  let text = size >= 1e6 || size < 1e-4 ? value.toExponential(digits - 1)
    : value.toFixed(Math.max(0, digits - 1 - Math.floor(Math.log10(size))));
  text = text.replace(/e([+-])(\d+)/, (_, sign, power) =>
    '·10' + (sign === '-' ? '⁻' : '') + [...power].map((d) => '⁰¹²³⁴⁵⁶⁷⁸⁹'[d]).join(''));
  if (size >= 1e4 && size < 1e6) text = text.replace(/\B(?=(\d{3})+(?!\d))/g, '\u2009');
  return text.replace('-', '−');
}

const withUnit = (text, unit) => unit ? text + ' ' + unit : text;

// --- Unpacking ----------------------------------------------------------------------------------------------

async function inflated() {
  const text = atob($('frames').textContent.trim());
  const packed = new Uint8Array(text.length);
  for (let i = 0; i < text.length; ++i) packed[i] = text.charCodeAt(i);
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream('deflate'));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

// The codes of one channel, frame by frame; `at` is where its bytes begin.
function channel(bytes, at, begin, order) {
  const count = begin[tubes], total = frames * count;
  const codes = new Uint16Array(total);
  let i = 0;
  for (let f = 0; f < frames; ++f) {
    let first = 0;
    for (let t = 0; t < tubes; ++t) {
      let before = first, second = first;
      for (let k = begin[t]; k < begin[t + 1]; ++k, ++i) {
        const stored = bytes[at + i] | bytes[at + total + i] << 8;
        const difference = stored & 1 ? -(stored + 1 >> 1) : stored >> 1;
        const guess = order === 2 && k - begin[t] >= 2 ? 2 * before - second : before;
        const code = guess + difference & 65535;
        codes[i] = code;
        if (k === begin[t]) first = code;
        second = before;
        before = code;
      }
    }
  }
  return codes;
}

let positions;   // codes of x, y and z of all joints
let fieldCodes;  // of each field

function unpack(bytes) {
  let at = 0;
  const next = (begin, order) => {
    const codes = channel(bytes, at, begin, order);
    at += 2 * codes.length;
    return codes;
  };
  positions = [0, 1, 2].map(() => next(jointBegin, 2));
  fieldCodes = facts.fields.map(() => next(elementBegin, 1));
  if (at !== bytes.length) throw new Error('the frames have another length than the facts say');
}

const position = (f, joint, k) => facts.position.low[k] + positions[k][f * joints + joint] * facts.position.step;

function fieldValue(field, f, element) {
  const code = fieldCodes[field][f * elements + element];
  return code === noNumber ? NaN : facts.fields[field].low + code * facts.fields[field].step;
}

// What was unpacked against what view_page.cpp wrote down: single numbers, and extremes and sums of every frame.
function check() {
  let compared = 0;
  const compare = (found, expected, allowed, what) => {
    ++compared;
    if (expected === null) {
      if (!Number.isNaN(found) && Number.isFinite(found)) throw new Error(what + ' has a number where there is none');
      return;
    }
    if (!(Math.abs(found - expected) <= 1.001 * allowed)) throw new Error(`${what} is ${found} and not ${expected}`);
  };
  for (const c of facts.check) {
    c.position.forEach((x, k) =>
      compare(position(c.frame, c.joint, k), x, 0.5 * facts.position.step, 'a position'));
    c.values.forEach((v, k) =>
      compare(fieldValue(k, c.frame, c.element), v, 0.5 * facts.fields[k].step, facts.fields[k].name));
  }
  let logged = 0, furthest = 0;
  facts.fields.forEach((field, k) => {
    for (let f = 0; f < frames; ++f) {
      let sum = 0, least = Infinity, most = -Infinity, n = 0;
      for (let e = 0; e < elements; ++e) {
        const v = fieldValue(k, f, e);
        if (Number.isNaN(v)) continue;
        sum += v;
        least = Math.min(least, v);
        most = Math.max(most, v);
        ++n;
      }
      compare(least, field.least[f], 0.5 * field.step, field.name);
      compare(most, field.most[f], 0.5 * field.step, field.name);
      compare(sum, field.total[f], 0.5 * n * field.step + 1e-9 * Math.abs(sum), 'the sum of ' + field.name);
      if (field.log[f] === null) continue;
      ++logged;
      const scale = Math.max(Math.abs(field.log[f]), 1);
      furthest = Math.max(furthest, Math.abs(field.total[f] - field.log[f]) / scale);
    }
  });
  if (furthest > 1e-3) throw new Error(`a sum is off the one in log.csv by ${numberText(100 * furthest, 2)} %`);
  return `Checked when this page was opened: ${compared} positions, values, extremes and sums are those of the frames` +
    ` within their rounding` + (logged ? `; ${logged} sums of energies agree with log.csv to ${numberText(Math.max(furthest, 1e-9), 1)}` : '') + '.';
}

// --- Colours ------------------------------------------------------------------------------------------------

const rgb = (hex) => [1, 3, 5].map((k) => parseInt(hex.substr(k, 2), 16));
const sequential = facts.colours.map(rgb);
const diverging = ['#2166ac', '#67a9cf', '#d1dde6', '#e8e4df', '#f5d5c0', '#ef8a62', '#b2182b'].map(rgb);
const noColour = [128, 128, 128];

function mapped(stops, at) {
  const s = (stops.length - 1) * Math.min(1, Math.max(0, at));
  const k = Math.min(stops.length - 2, Math.floor(s));
  return stops[k].map((c, i) => c + (s - k) * (stops[k + 1][i] - c));
}

// What elements are coloured by: the fields, which change in time, then the numbers of tubes, then nothing.
const sources = [
  ...facts.fields.map((f, k) => ({...f, field: k})),
  ...facts.tube_numbers.map((n) => ({...n, tube: n.values, from: Math.min(...n.values), to: Math.max(...n.values)})),
  {name: 'No colour', plain: true},
];
let source = 0;

function colourAt(s, value) {
  if (s.plain) return [150, 176, 204];
  if (Number.isNaN(value)) return noColour;
  return mapped(s.signed ? diverging : sequential, s.to > s.from ? (value - s.from) / (s.to - s.from) : 0);
}

// --- The scene ----------------------------------------------------------------------------------------------

const canvas = $('canvas');
let renderer, camera, controls, scene;
// A texel each: position, normal of the ring, a direction in the ring. Textures have 1024 joints in a row.
const stride = 12, rowJoints = 1024, rows = Math.ceil(joints / rowJoints);
const jointData = new Float32Array(rows * rowJoints * stride);
const tints = new Uint8Array(rows * rowJoints * 4);
const jointTexture = new THREE.DataTexture(jointData, 3 * rowJoints, rows, THREE.RGBAFormat, THREE.FloatType);
const tintTexture = new THREE.DataTexture(tints, rowJoints, rows, THREE.RGBAFormat);
const meshes = [];  // of the same tubes in more and more detail
const discCorners = 24, mostDiscs = 10 * tubes;  // two ends of every tube and a few cuts through it
let discs;
let frame = frames - 1;

const right = new THREE.Vector3(...facts.right), up = new THREE.Vector3(...facts.up),
  towards = new THREE.Vector3(...facts.towards);
const cut = {normal: null, name: '', sign: 1, at: 0.5, offset: 0};

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

const uniforms = {
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

function makeScene() {
  const context = canvas.getContext('webgl2', {antialias: false, alpha: false, powerPreference: 'high-performance'});
  if (!context) throw new Error('this browser offers no WebGL 2; `ropewalk picture` makes pictures without it');
  renderer = new THREE.WebGLRenderer({canvas, context, antialias: false});
  scene = new THREE.Scene();
  camera = new THREE.PerspectiveCamera(26, 1, 1, 1000);
  camera.up.copy(up);
  controls = new THREE.OrbitControls(camera, canvas);
  controls.enableKeys = false;
  controls.screenSpacePanning = true;
  controls.rotateSpeed = 0.8;
  controls.addEventListener('change', request);

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
}

// --- A frame ------------------------------------------------------------------------------------------------

const p = new THREE.Vector3(), q = new THREE.Vector3(), n = new THREE.Vector3(), u = new THREE.Vector3();

// Rings stand on the bisecting planes; the direction in the ring is carried along the tube without turning.
function placeJoints() {
  for (let i = 0; i < joints; ++i)
    for (let k = 0; k < 3; ++k) jointData[i * stride + k] = position(frame, i, k);
  for (let t = 0; t < tubes; ++t) {
    const from = jointBegin[t], to = jointBegin[t + 1] - 1;
    for (let i = from; i <= to; ++i) {
      p.fromArray(jointData, Math.max(from, i - 1) * stride);
      q.fromArray(jointData, Math.min(to, i + 1) * stride);
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
  return s.tube ? s.tube[tube] : fieldValue(s.field, frame, element);
}

function paintElements() {
  const s = sources[source];
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
      centre.fromArray(jointData, i * stride);
      if (height(centre) > 0) continue;
      n.fromArray(jointData, i * stride + 4);
      a.fromArray(jointData, i * stride + 8).multiplyScalar(radius);
      b.crossVectors(n, a);
      addDisc(centre, a, b, joint);
    }
    if (!cut.normal) continue;
    for (let i = from; i < to; ++i) {
      p.fromArray(jointData, i * stride);
      q.fromArray(jointData, (i + 1) * stride);
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

function placeCut() {
  for (const mesh of meshes) mesh.material = cut.normal ? mesh.userData.cutOpen : mesh.userData.whole;
  if (!cut.normal) return;
  let low = Infinity, high = -Infinity;
  for (let i = 0; i < joints; ++i) {
    const h = cut.normal.dot(p.fromArray(jointData, i * stride));
    low = Math.min(low, h);
    high = Math.max(high, h);
  }
  const radius = Math.max(...facts.tube_radius);
  low -= radius;
  high += radius;
  cut.offset = cut.sign * (low + cut.at * (high - low));
  uniforms.plane.value.set(cut.sign * cut.normal.x, cut.sign * cut.normal.y, cut.sign * cut.normal.z, cut.offset);
}

function showFrame(f) {
  frame = Math.min(frames - 1, Math.max(0, f));
  $('frame').value = frame;
  const time = numberText(facts.time_ps[frame]);
  const still = facts.time_ps[frames - 1] === facts.time_ps[0] && frames > 1;  // a relaxation
  $('when').innerHTML = (still ? `step ${facts.step[frame]}` : time + ' ps') +
    `<span>frame ${frame + 1} of ${frames}</span>`;
  $('frame').setAttribute('aria-valuetext', $('when').textContent);
  placeJoints();
  refresh();
}

function refresh() {
  placeCut();
  paintElements();
  placeDiscs();
  showNumbers();
  request();
}

// --- Legend -------------------------------------------------------------------------------------------------

// Numbers below the bar: both ends, with a sign where values lie beyond, and round numbers between.
function ticksOf(s) {
  const tick = (v, sign = '') => ({at: onBar(s, v), text: sign + tickText(v)});
  if (s.tube) {
    const all = [];
    for (let v = s.from; v <= s.to; ++v) all.push(v);
    return (all.length <= 12 ? all : [s.from, s.to]).map((v) => tick(v));
  }
  const out = [tick(s.from, Math.min(...s.least) < s.from ? '≤ ' : ''), tick(s.to, Math.max(...s.most) > s.to ? '≥ ' : '')];
  if (!(s.to > s.from)) return out.slice(0, 1);
  const rough = (s.to - s.from) / 4, base = Math.pow(10, Math.floor(Math.log10(rough)));
  const step = [1, 2, 5, 10].map((m) => m * base).find((v) => v >= rough);
  for (let k = Math.ceil(s.from / step); k * step < s.to; ++k)
    if (Math.abs(onBar(s, k * step) - 0.5) < 0.36) out.push(tick(k * step));
  return out;
}

const tickText = (v) => numberText(Number(v.toPrecision(6)), 3).replace(/(\.\d*?)0+$/, '$1').replace(/\.$/, '');

function barColours(s) {
  const n = s.tube ? Math.min(64, s.to - s.from + 1) : 64;
  return Array.from({length: n}, (_, k) =>
    mapped(s.signed ? diverging : sequential, s.tube ? (n > 1 ? k / (n - 1) : 0) : (k + 0.5) / n));
}

// Where a value stands on the bar, from 0 to 1. The colours of whole numbers are fields of one width.
function onBar(s, v) {
  if (s.tube) return (v - s.from + 0.5) / (s.to - s.from + 1);
  return s.to > s.from ? (v - s.from) / (s.to - s.from) : 0;
}

function showLegend() {
  const s = sources[source];
  $('field-name').innerHTML = '<b></b><br>';
  $('field-name').firstChild.textContent = s.name + (s.unit ? ', ' + s.unit : '');
  $('field-name').append(s.meaning || '');
  const bar = $('bar');
  bar.textContent = '';
  if (s.plain) return;
  const colours = document.createElement('div');
  colours.className = 'colours';
  for (const c of barColours(s)) {
    const i = document.createElement('i');
    i.style.background = `rgb(${c.map(Math.round)})`;
    colours.append(i);
  }
  bar.append(colours);
  for (const {at, text} of ticksOf(s)) {
    const tick = document.createElement('span');
    tick.className = at < 0.03 ? 'tick first' : at > 0.97 ? 'tick last' : 'tick';
    tick.style.left = 100 * at + '%';
    tick.textContent = text;
    bar.append(tick);
  }
  bar.setAttribute('aria-label', `Colours of ${s.name} from ${tickText(s.from)} to ${withUnit(tickText(s.to), s.unit)}`);
}

function showNumbers() {
  const s = sources[source];
  const out = $('numbers');
  out.textContent = '';
  if (s.field === undefined) return;
  const least = s.least[frame], most = s.most[frame];
  out.innerHTML = `This frame: <b data-number="least">${numberText(least)}</b> to <b data-number="most">` +
    `${numberText(most)}</b> ${s.unit}<br>` +
    (s.unit === 'eV' && s.name !== 'Bending moment'
      ? `sum over the elements <b data-number="total">${numberText(s.total[frame], 6)}</b> eV` : '');
  const beyond = most > s.to || least < s.from;
  if (beyond) out.append(out.lastChild && out.lastChild.nodeName === 'BR' ? '' : '; ', 'some are beyond the ends of the colours');
}

// --- Looking ------------------------------------------------------------------------------------------------

let wanted = false, moving = 0, ratio = 1, lastDraw = 0, wasRestless = false;
const still = Math.max(2, window.devicePixelRatio || 1);

// Draws soon. While things move, as many pixels as come fast enough; then once more, smoothly.
function request() {
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
  // As many sides as the tubes' size on the screen needs. In haste thin tubes pass over two joints of three.
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
    p.fromArray(jointData, i * stride);
    low.min(p);
    high.max(p);
  }
  return {centre: low.clone().add(high).multiplyScalar(0.5), radius: 0.5 * low.distanceTo(high) + Math.max(...facts.tube_radius)};
}

// hasty: with fewer sides or joints.
function render(pixels, hasty = false) {
  size(pixels);
  prepareCamera(hasty);
  renderer.setClearColor(stageColour());
  renderer.render(scene, camera);
}

function draw(now) {
  wanted = false;
  if (!renderer) return;
  const restless = playing || performance.now() - moving < 250;
  if (restless) {
    const gap = now - lastDraw;
    if (wasRestless && gap > 36) ratio = Math.max(0.5, ratio * 0.85);
    if (wasRestless && gap < 22) ratio = Math.min(still, ratio * 1.05);
    wasRestless = true;
    lastDraw = now;
    render(ratio, ratio < 0.9);
    counted(now);
    showScale();
    if (playing) step(now);
    schedule();
    return;
  }
  wasRestless = false;
  render(still);
  showScale();
  document.documentElement.dataset.state = 'ready';
}

let drawn = [];
// For those who want to know how fast it is: frames per second while something moves.
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
function lookFrom(x, y, z) {
  const direction = new THREE.Vector3().addScaledVector(right, x).addScaledVector(up, y).addScaledVector(towards, z)
    .normalize();
  const back = direction, side = new THREE.Vector3().crossVectors(up, back).normalize();
  const above = new THREE.Vector3().crossVectors(back, side);
  const tall = Math.tan(camera.fov * Math.PI / 360), box = canvas.parentElement;
  const wide = tall * box.clientWidth / box.clientHeight;
  const radius = 1.6 * Math.max(...facts.tube_radius);
  // The middle of what is seen, then as near as all points allow.
  const middle = bounds().centre;
  let target = middle;
  let distance = 0;
  for (let round = 0; round < 4; ++round) {
    const reach = {l: 0, r: 0, b: 0, t: 0};
    distance = 0;
    for (let i = 0; i < joints; ++i) {
      p.fromArray(jointData, i * stride).sub(target);
      const depth = p.dot(back), px = p.dot(side), py = p.dot(above);
      distance = Math.max(distance, (Math.abs(px) + radius) / wide + depth, (Math.abs(py) + radius) / tall + depth);
    }
    for (let i = 0; i < joints; ++i) {
      p.fromArray(jointData, i * stride).sub(target);
      const w = distance - p.dot(back), px = p.dot(side) / w, py = p.dot(above) / w;
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
function fitAgain() {
  if (looked && camera.position.distanceTo(looked.place) < 1e-6) lookFrom(...looked.from);
  else request();
}

const sides = {oblique: [0.55, 0.3, 0.78], side: [0, 0, 1], top: [0, 1, 1e-4], end: [1, 0, 1e-4]};

function turn(x, y) {
  const arm = camera.position.clone().sub(controls.target);
  arm.applyAxisAngle(up, x);
  const angle = arm.angleTo(up), to = Math.min(Math.PI - 0.01, Math.max(0.01, angle - y));
  arm.applyAxisAngle(new THREE.Vector3().crossVectors(up, arm).normalize(), to - angle);
  camera.position.copy(controls.target).add(arm);
  controls.update();
  request();
}

function shift(x, y) {
  const step = 40 / pixelsPerNm();
  const across = new THREE.Vector3().setFromMatrixColumn(camera.matrix, 0),
    above = new THREE.Vector3().setFromMatrixColumn(camera.matrix, 1);
  for (const v of [camera.position, controls.target]) v.addScaledVector(across, x * step).addScaledVector(above, y * step);
  controls.update();
  request();
}

function zoom(factor) {
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

// --- Pointing -----------------------------------------------------------------------------------------------

// The element under the pointer: the nearest of those whose axis comes within the radius of the line of sight.
function elementAt(event) {
  const box = canvas.getBoundingClientRect();
  const x = 2 * (event.clientX - box.left) / box.width - 1, y = 1 - 2 * (event.clientY - box.top) / box.height;
  const from = camera.position, d = new THREE.Vector3(x, y, 0.5).unproject(camera).sub(from).normalize();
  let best = null, nearest = Infinity;
  const axis = new THREE.Vector3(), w = new THREE.Vector3();
  for (let t = 0; t < tubes; ++t)
    for (let i = jointBegin[t]; i < jointBegin[t + 1] - 1; ++i) {
      p.fromArray(jointData, i * stride);
      axis.fromArray(jointData, (i + 1) * stride).sub(p);
      w.subVectors(p, from);
      // The nearest points of the line of sight and the element's axis.
      const c = axis.dot(d), l = axis.lengthSq(), e = axis.dot(w), f = d.dot(w), det = l - c * c;
      let along = det > 1e-12 * l ? (c * f - e) / det : 0;
      along = Math.min(1, Math.max(0, along));
      const depth = f + along * c;
      const gap = w.lengthSq() + along * along * l + 2 * along * e - depth * depth;
      const r = facts.tube_radius[t];
      if (depth <= 0 || gap > r * r) continue;
      const front = depth - Math.sqrt(r * r - gap);
      if (front >= nearest) continue;
      q.copy(p).addScaledVector(axis, along);
      if (cut.normal && cut.sign * q.dot(cut.normal) > cut.offset) continue;
      nearest = front;
      best = {tube: t, element: i - t, place: q.clone()};
    }
  return best;
}

let pointed = null;
function showPointed() {
  if (!pointed) {
    $('pointed').textContent = '';
    return;
  }
  const {tube, element} = pointed, s = sources[source];
  const words = `tube ${tube + 1}, element ${element - elementBegin[tube] + 1} of ${elementBegin[tube + 1] - elementBegin[tube]}`;
  $('pointed').textContent = s.plain ? words : words + ': ' + (s.tube
    ? `${s.name.toLowerCase()} ${s.tube[tube]}`
    : withUnit(numberText(fieldValue(s.field, frame, element)), s.unit));
}

// --- Playing ------------------------------------------------------------------------------------------------

let playing = false, due = 0;

function play(on) {
  playing = on && frames > 1;
  if (playing && frame === frames - 1) showFrame(0);
  due = performance.now();
  $('play').classList.toggle('playing', playing);
  $('play').setAttribute('aria-label', playing ? 'Pause' : 'Play');
  request();
}

// Where frames take longer than their time, some are passed over.
function step(now) {
  const pause = 1000 / Number($('speed').value), steps = Math.floor((now - due) / pause);
  if (steps < 1) return;
  due += steps * pause;
  const next = frame + Math.min(steps, 3);
  if (frame === frames - 1) return play(false);
  showFrame(Math.min(next, frames - 1));
  showPointed();
}

// --- Picture ------------------------------------------------------------------------------------------------

// The stage, with its colours, scale and time below.
function pictureCanvas() {
  const box = canvas.parentElement, zoomed = Math.max(still, 2400 / box.clientWidth);
  render(zoomed);
  const out = document.createElement('canvas'), foot = 74 * zoomed;
  out.width = canvas.width;
  out.height = canvas.height + foot;
  const c = out.getContext('2d'), style = getComputedStyle(document.documentElement);
  c.fillStyle = style.getPropertyValue('--stage').trim();
  c.fillRect(0, 0, out.width, out.height);
  c.drawImage(canvas, 0, 0);
  c.translate(0, canvas.height);
  c.scale(zoomed, zoomed);
  c.fillStyle = style.getPropertyValue('--ink').trim();
  c.font = '14px "Helvetica Neue",Helvetica,Arial,"Liberation Sans",sans-serif';
  const line = $('scale').children[1].getBoundingClientRect().width;
  c.fillRect(16, 30, line, 3);
  c.fillText($('scale').textContent.trim(), 16, 22);
  c.fillText(`${facts.name}, ${$('when').firstChild.textContent}`, 16, 60);
  const s = sources[source];
  if (!s.plain) {
    const width = Math.min(420, 0.45 * box.clientWidth), left = box.clientWidth - width - 24;
    const colours = barColours(s);
    colours.forEach((colour, k) => {
      c.fillStyle = `rgb(${colour.map(Math.round)})`;
      c.fillRect(left + k * width / colours.length, 26, width / colours.length + 0.5, 12);
    });
    c.fillStyle = style.getPropertyValue('--ink').trim();
    c.fillText(s.name + (s.unit ? ', ' + s.unit : ''), left, 19);
    for (const {at, text} of ticksOf(s)) {
      c.textAlign = at < 0.03 ? 'left' : at > 0.97 ? 'right' : 'center';
      c.fillText(text, left + width * at, 56);
    }
  }
  request();
  return out;
}

function savePicture() {
  pictureCanvas().toBlob((blob) => {
    const a = document.createElement('a');
    a.href = URL.createObjectURL(blob);
    a.download = `${facts.name.replace(/[^\w.-]+/g, '-')}-${numberText(facts.time_ps[frame]).replace(/[^\d.]/g, '')}ps.png`;
    a.click();
    setTimeout(() => URL.revokeObjectURL(a.href), 10000);
  }, 'image/png');
}

// --- Controls -----------------------------------------------------------------------------------------------

function chooseSource(k) {
  source = (k + sources.length) % sources.length;
  $('field').value = source;
  showLegend();
  paintElements();
  placeDiscs();
  showNumbers();
  showPointed();
  request();
}

function chooseCut(name) {
  cut.name = name;
  cut.normal = {right, up, towards}[name] || null;
  // The half that is taken off is that before the reader.
  if (cut.normal) cut.sign = camera.position.clone().sub(controls.target).dot(cut.normal) < 0 ? -1 : 1;
  $('cut').value = name;
  $('cut-at').disabled = $('cut-side').disabled = !cut.normal;
  refresh();
}

function moveCut(at) {
  cut.at = Math.min(1, Math.max(0, at));
  $('cut-at').value = Math.round(1000 * cut.at);
  refresh();
}

function otherSide() {
  cut.sign = -cut.sign;
  refresh();
}

const keys = {
  ' ': () => play(!playing),
  ',': () => { play(false); showFrame(frame - 1); },
  '.': () => { play(false); showFrame(frame + 1); },
  Home: () => { play(false); showFrame(0); },
  End: () => { play(false); showFrame(frames - 1); },
  '+': () => zoom(0.9), '=': () => zoom(0.9), '-': () => zoom(1 / 0.9), '−': () => zoom(1 / 0.9),
  c: () => chooseSource(source + 1),
  s: () => {
    const names = ['', 'right', 'towards', 'up'];
    chooseCut(names[(names.indexOf(cut.name) + 1) % names.length]);
  },
  '[': () => moveCut(cut.at - 0.02), ']': () => moveCut(cut.at + 0.02),
  x: () => { if (cut.normal) otherSide(); },
  p: savePicture,
  1: () => lookFrom(...sides.oblique), 2: () => lookFrom(...sides.side),
  3: () => lookFrom(...sides.top), 4: () => lookFrom(...sides.end),
  ArrowLeft: (e) => e.shiftKey ? shift(-1, 0) : turn(-0.08, 0),
  ArrowRight: (e) => e.shiftKey ? shift(1, 0) : turn(0.08, 0),
  ArrowUp: (e) => e.shiftKey ? shift(0, 1) : turn(0, 0.08),
  ArrowDown: (e) => e.shiftKey ? shift(0, -1) : turn(0, -0.08),
};

function listen() {
  $('play').onclick = () => play(!playing);
  $('frame').max = frames - 1;
  $('frame').oninput = () => { play(false); showFrame(Number($('frame').value)); showPointed(); };
  sources.forEach((s, k) => $('field').append(new Option(s.name, k)));
  $('field').onchange = () => chooseSource(Number($('field').value));
  $('cut').onchange = () => chooseCut($('cut').value);
  $('cut-at').oninput = () => moveCut($('cut-at').value / 1000);
  $('cut-side').onclick = otherSide;
  for (const b of document.querySelectorAll('[data-side]')) b.onclick = () => lookFrom(...sides[b.dataset.side]);
  $('picture').onclick = savePicture;
  canvas.addEventListener('pointermove', (e) => {
    if (e.buttons && e.pointerType === 'mouse') return;
    pointed = elementAt(e);
    showPointed();
  });
  canvas.addEventListener('pointerdown', (e) => { pointed = elementAt(e); showPointed(); canvas.focus({preventScroll: true}); });
  canvas.addEventListener('pointerleave', () => { pointed = null; showPointed(); });
  canvas.addEventListener('dblclick', (e) => {
    const at = elementAt(e);
    if (!at) return;
    const arm = camera.position.clone().sub(controls.target);
    controls.target.copy(at.place);
    camera.position.copy(at.place).addScaledVector(arm, 0.5);
    controls.update();
    request();
  });
  document.addEventListener('keydown', (e) => {
    if (e.ctrlKey || e.metaKey || e.altKey) return;
    // Controls keep the keys that they need themselves.
    const tag = e.target.tagName;
    if (tag === 'SELECT' || (tag === 'INPUT' && /^(Arrow|Home|End|Page)/.test(e.key))) return;
    if ((tag === 'BUTTON' || tag === 'SUMMARY') && (e.key === ' ' || e.key === 'Enter')) return;
    const act = keys[e.key.length === 1 ? e.key.toLowerCase() : e.key];
    if (!act) return;
    e.preventDefault();
    act(e);
  });
  new ResizeObserver(fitAgain).observe(canvas.parentElement);
  window.addEventListener('beforeprint', () => { if (renderer) render(still); });
  matchMedia('(prefers-color-scheme: dark)').addEventListener('change', request);
}

// view.html#frame=12&colour=Shell&cut=right&at=0.3&look=end opens the page like that. Frames count from 1.
function followAddress() {
  const wish = new URLSearchParams(location.hash.slice(1));
  const colour = sources.findIndex((s) => s.name === wish.get('colour'));
  if (wish.has('frame')) showFrame(Number(wish.get('frame')) - 1 || 0);
  if (colour >= 0) chooseSource(colour);
  if (sides[wish.get('look')]) lookFrom(...sides[wish.get('look')]);
  if (wish.has('at')) moveCut(Number(wish.get('at')) || 0);
  if (['right', 'towards', 'up'].includes(wish.get('cut'))) chooseCut(wish.get('cut'));
}

function about() {
  const rounding = facts.fields.map((f) => `${f.name} to ${withUnit(numberText(0.5 * f.step, 2), f.unit)}`).join(', ');
  $('about').textContent = `${frames} of ${facts.stored_frames} stored frames; ${tubes} tubes, ${elements} elements. ` +
    `An element reaches from joint to joint, where neighbours meet halfway. Positions are rounded to ` +
    `${numberText(0.5 * facts.position.step, 2)} nm, ${rounding}. Extremes and sums are exact. The colours end where ` +
    `99 % of all values of the run lie between.`;
}

async function start() {
  if (typeof DecompressionStream === 'undefined') throw new Error('this browser is too old to unpack the frames');
  unpack(await inflated());
  $('app').hidden = false;
  $('failure').hidden = true;
  makeScene();
  listen();
  about();
  showLegend();
  showFrame(frames - 1);
  lookFrom(...sides.oblique);
  followAddress();
  window.addEventListener('hashchange', followAddress);
  $('check').textContent = check();
}

start().catch((e) => fail('This page cannot be shown: ' + e.message + '.'));
})();
