// The page: legend, time, what is pointed at, pictures, and what buttons and keys do.
import {$, check, elementBegin, elements, facts, fieldValue, frames, jointBegin, numberText, tickText, tubes, unpack, withUnit}
  from './frames.js';
import {canvas, closeScene, cut, diverging, gone, jointAt, linksShown, makeScene, mapped, placeFrame, placeOf, renderer, right,
  sequential, shown, sources, towards, tubeOfElement, up, updateScene} from './scene.js';
import {animation, camera, controls, fitAgain, lookFrom, makeCamera, render, request, shift, sides, still, turn, zoom}
  from './camera.js';

function showFrame(f) {
  placeFrame(f);
  $('frame').value = shown.frame;
  const time = numberText(facts.time_ps[shown.frame]);
  const relaxation = facts.time_ps[frames - 1] === facts.time_ps[0] && frames > 1;
  $('when').innerHTML = (relaxation ? `step ${facts.step[shown.frame]}` : time + ' ps') +
    `<span>frame ${shown.frame + 1} of ${frames}</span>`;
  $('frame').setAttribute('aria-valuetext', $('when').textContent);
  refresh();
}

function refresh() {
  updateScene();
  $('links').textContent = facts.links.length > 0 ? `links (red): ${linksShown}` : '';
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

function barColours(s) {
  const n = s.tube ? Math.min(64, s.to - s.from + 1) : 64;
  return Array.from({length: n}, (_, k) =>
    mapped(s.signed ? diverging : sequential, s.tube ? (n > 1 ? k / (n - 1) : 0) : (k + 0.5) / n));
}

// The place of a value on the bar, from 0 to 1. The colours of whole numbers are fields of one width.
function onBar(s, v) {
  if (s.tube) return (v - s.from + 0.5) / (s.to - s.from + 1);
  return s.to > s.from ? (v - s.from) / (s.to - s.from) : 0;
}

function showLegend() {
  const s = shown.source;
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
  const s = shown.source;
  const out = $('numbers');
  out.textContent = '';
  if (s.field === undefined) return;
  const least = s.least[shown.frame], most = s.most[shown.frame];
  out.innerHTML = `This frame: <b data-number="least">${numberText(least)}</b> to <b data-number="most">` +
    `${numberText(most)}</b> ${s.unit}<br>` +
    (s.unit === 'eV' && s.name !== 'Bending moment'
      ? `sum over the elements <b data-number="total">${numberText(s.total[shown.frame], 6)}</b> eV` : '');
  const beyond = most > s.to || least < s.from;
  if (beyond) out.append(out.lastChild && out.lastChild.nodeName === 'BR' ? '' : '; ', 'some are beyond the ends of the colours');
}

// --- Pointing -----------------------------------------------------------------------------------------------

// The element under the pointer: the nearest of those whose axis comes within the radius of the line of sight.
function elementAt(event) {
  const box = canvas.getBoundingClientRect();
  const x = 2 * (event.clientX - box.left) / box.width - 1, y = 1 - 2 * (event.clientY - box.top) / box.height;
  const from = camera.position, d = new THREE.Vector3(x, y, 0.5).unproject(camera).sub(from).normalize();
  let best = null, nearest = Infinity;
  const p = new THREE.Vector3(), q = new THREE.Vector3(), axis = new THREE.Vector3(), w = new THREE.Vector3();
  for (let t = 0; t < tubes; ++t)
    for (let i = jointBegin[t]; i < jointBegin[t + 1] - 1; ++i) {
      jointAt(i, p);
      jointAt(i + 1, axis).sub(p);
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

// As messages and tables count them, from 0: an element of a tube of the scene, whatever parts it has broken into.
function wordsOf(element) {
  const piece = tubeOfElement(element), [tube, first] = facts.piece_of[piece];
  return `tube ${tube}, element ${first + element - elementBegin[piece]}`;
}

// -1: there is none.
function elementOf(tube, element) {
  const piece = facts.piece_of.findIndex(([t, first], k) =>
    t === tube && element >= first && element < first + elementBegin[k + 1] - elementBegin[k]);
  return piece < 0 ? -1 : elementBegin[piece] + element - facts.piece_of[piece][1];
}

// Looks at an element from near; with a time, in the first frame from then on.
function goTo(element, time) {
  play(false);
  gone.element = element;
  const after = facts.time_ps.findIndex((t) => t >= time - 1e-9);
  showFrame(time === undefined ? shown.frame : after < 0 ? frames - 1 : after);
  const place = placeOf(element, new THREE.Vector3());
  const arm = camera.position.clone().sub(controls.target);
  arm.setLength(Math.min(arm.length(), 40 * facts.tube_radius[tubeOfElement(element)]));
  controls.target.copy(place);
  camera.position.copy(place).add(arm);
  controls.update();
  $('gone').textContent = wordsOf(element);
  const [tube, first] = facts.piece_of[tubeOfElement(element)];
  $('go-tube').value = tube;
  $('go-element').value = first + element - elementBegin[tubeOfElement(element)];
  request();
}

function tryToGo(tube, element) {
  const at = elementOf(tube, element);
  if (at >= 0) return goTo(at);
  const of = facts.piece_of.map(([t], k) => t === tube ? elementBegin[k + 1] - elementBegin[k] : 0).reduce((a, b) => a + b, 0);
  $('gone').textContent = of > 0 ? `the elements of tube ${tube} are 0 to ${of - 1}`
    : `the tubes are 0 to ${Math.max(...facts.piece_of.map(([t]) => t))}`;
}

function listMarks() {
  for (const m of facts.marks) {
    const button = document.createElement('button');
    button.type = 'button';
    button.dataset.mark = m.limit;
    button.textContent = `${m.limit}, ${m.time_ps > 0 ? `from ${numberText(m.time_ps)} ps on` : 'from the start on'}: ` +
      wordsOf(m.element) + (m.held_by ? `, at ${m.held_by}` : '');
    button.onclick = () => goTo(m.element, m.time_ps);
    $('marks').append(button);
  }
  if (facts.marks.length > 0) $('marks').prepend('Limits that were passed, in cages: ');
}

let pointed = null;
function showPointed() {
  if (!pointed) {
    $('pointed').textContent = '';
    return;
  }
  const {tube, element} = pointed, s = shown.source;
  const words = wordsOf(element);
  $('pointed').textContent = s.plain ? words : words + ': ' + (s.tube
    ? `${s.name.toLowerCase()} ${s.tube[tube]}`
    : withUnit(numberText(fieldValue(s.field, shown.frame, element)), s.unit));
}

// --- Playing ------------------------------------------------------------------------------------------------

let due = 0;  // when the next frame is to be shown

function play(on) {
  const playing = on && frames > 1;
  animation.step = playing ? step : null;
  if (playing && shown.frame === frames - 1) showFrame(0);
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
  const next = shown.frame + Math.min(steps, 3);
  if (shown.frame === frames - 1) return play(false);
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
  const s = shown.source;
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
    a.download = `${facts.name.replace(/[^\w.-]+/g, '-')}-${numberText(facts.time_ps[shown.frame]).replace(/[^\d.]/g, '')}ps.png`;
    a.click();
    setTimeout(() => URL.revokeObjectURL(a.href), 10000);
  }, 'image/png');
}

// --- Controls -----------------------------------------------------------------------------------------------

function chooseSource(k) {
  const chosen = (k + sources.length) % sources.length;
  shown.source = sources[chosen];
  $('field').value = chosen;
  showLegend();
  refresh();
  showPointed();
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
  ' ': () => play(!animation.step),
  ',': () => { play(false); showFrame(shown.frame - 1); },
  '.': () => { play(false); showFrame(shown.frame + 1); },
  Home: () => { play(false); showFrame(0); },
  End: () => { play(false); showFrame(frames - 1); },
  '+': () => zoom(0.9), '=': () => zoom(0.9), '-': () => zoom(1 / 0.9), '−': () => zoom(1 / 0.9),
  c: () => chooseSource(sources.indexOf(shown.source) + 1),
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
  $('play').onclick = () => play(!animation.step);
  $('frame').max = frames - 1;
  $('frame').oninput = () => { play(false); showFrame(Number($('frame').value)); showPointed(); };
  sources.forEach((s, k) => $('field').append(new Option(s.name, k)));
  $('field').onchange = () => chooseSource(Number($('field').value));
  $('cut').onchange = () => chooseCut($('cut').value);
  $('cut-at').oninput = () => moveCut($('cut-at').value / 1000);
  $('cut-side').onclick = otherSide;
  for (const b of document.querySelectorAll('[data-side]')) b.onclick = () => lookFrom(...sides[b.dataset.side]);
  $('picture').onclick = savePicture;
  $('go').onsubmit = (e) => { e.preventDefault(); tryToGo($('go-tube').valueAsNumber, $('go-element').valueAsNumber); };
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

// view.html#frame=12&colour=Shell&cut=right&at=0.3&look=end&tube=3&element=7 opens the page like that. Frames count from 1.
function followAddress() {
  const wish = new URLSearchParams(location.hash.slice(1));
  const colour = sources.findIndex((s) => s.name === wish.get('colour'));
  if (wish.has('frame')) showFrame(Number(wish.get('frame')) - 1 || 0);
  if (colour >= 0) chooseSource(colour);
  if (sides[wish.get('look')]) lookFrom(...sides[wish.get('look')]);
  if (wish.has('at')) moveCut(Number(wish.get('at')) || 0);
  if (['right', 'towards', 'up'].includes(wish.get('cut'))) chooseCut(wish.get('cut'));
  if (wish.has('tube')) tryToGo(Number(wish.get('tube')), Number(wish.get('element')) || 0);
}

function about() {
  const rounding = facts.fields.map((f) => `${f.name} to ${withUnit(numberText(0.5 * f.step, 2), f.unit)}`).join(', ');
  $('about').textContent = `${frames} of ${facts.stored_frames} stored frames; ${tubes} tubes, ${elements} elements. ` +
    `An element reaches from joint to joint, where neighbours meet halfway. Positions are rounded to ` +
    `${numberText(0.5 * facts.position.step, 2)} nm, ${rounding}. Extremes and sums are exact. The colours end where ` +
    `99 % of all values of the run lie between.`;
}

function fail(words) {
  closeScene();
  $('app').hidden = true;
  $('failure').hidden = false;
  $('failure').textContent = words;
  document.documentElement.dataset.state = 'failed';
}

async function start() {
  await unpack();
  $('app').hidden = false;
  $('failure').hidden = true;
  makeScene();
  makeCamera();
  listen();
  about();
  listMarks();
  showLegend();
  showFrame(frames - 1);
  lookFrom(...sides.oblique);
  followAddress();
  window.addEventListener('hashchange', followAddress);
  $('check').textContent = check();
}

start().catch((e) => fail('This page cannot be shown: ' + e.message + '.'));
