// The frames of a run: facts (JSON, written by view_page.cpp) and packed numbers (pack.hpp), unpacked and checked.

export const $ = (id) => document.getElementById(id);
export const facts = JSON.parse($('facts').textContent);
export const frames = facts.time_ps.length;
export const tubes = facts.tube_radius.length;
export const elementBegin = facts.tube_begin;
export const jointBegin = elementBegin.map((e, t) => e + t);
export const elements = elementBegin[tubes], joints = jointBegin[tubes];
const noNumber = 65535;

// --- Numbers as text ----------------------------------------------------------------------------------------

export function numberText(value, digits = 4) {
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

// On an axis: without zeros at the end.
export const tickText = (v) => numberText(Number(v.toPrecision(6)), 3).replace(/(\.\d*?)0+$/, '$1').replace(/\.$/, '');

export const withUnit = (text, unit) => unit ? text + ' ' + unit : text;

// --- Unpacking ----------------------------------------------------------------------------------------------

async function inflated() {
  if (typeof DecompressionStream === 'undefined') throw new Error('this browser is too old to unpack the frames');
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

export async function unpack() {
  const bytes = await inflated();
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

export const position = (f, joint, k) => facts.position.low[k] + positions[k][f * joints + joint] * facts.position.step;

export function fieldValue(field, f, element) {
  const code = fieldCodes[field][f * elements + element];
  return code === noNumber ? NaN : facts.fields[field].low + code * facts.fields[field].step;
}

// Compares what was unpacked with what view_page.cpp wrote down: single numbers, and extremes and sums of every frame.
export function check() {
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
