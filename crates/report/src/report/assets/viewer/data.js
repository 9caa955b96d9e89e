// The particles of a run in the browser: one program in four files, which the page holds as one
// module. Here: the numbers, what is chosen of them, and where the particles are.
//
// Numbers arrive as the upper three bytes of 32-bit floats, plane by plane, packed with zlib and
// written in base64.

const byId = (id) => document.getElementById(id);
const source = byId("view-data");
const data = JSON.parse(source.textContent);
const D = data.dimension;
const N = data.ids.length;
const view = byId("view"), drawing = byId("drawing"), overlay = byId("overlay"), tip = byId("tip");
const MAGENTA = [255, 0, 255];
const NAMES = ["x", "y", "z"];

function trouble(text) {
  byId("trouble").textContent = text;
  byId("trouble").hidden = false;
  view.hidden = true;
}

// ---- numbers ----

async function unpack(text) {
  const packed = Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

function column(bytes, number) {
  const values = new Float32Array(N);
  const bits = new Uint32Array(values.buffer);
  const start = 3 * N * number;
  for (let i = 0; i < N; i++) {
    bits[i] = ((bytes[start + i] << 24) | (bytes[start + N + i] << 16) | (bytes[start + 2 * N + i] << 8)) >>> 0;
  }
  return values;
}

function text(value, digits = 5) {
  if (value === -Infinity) return "none";
  if (!Number.isFinite(value)) return "not finite";
  if (value === 0) return "0";
  const size = Math.abs(value);
  const plain = size >= 1e-3 && size < 1e6;
  const written = plain ? String(Number(value.toPrecision(digits))) : value.toExponential(digits - 1);
  const [digit, power] = written.split("e");
  const short = digit.includes(".") ? digit.replace(/0+$/, "").replace(/\.$/, "") : digit;
  return (power === undefined ? short : short + "e" + Number(power)).replaceAll("-", "\u2212");
}

const unit = (field) => (field.unit === "1" || field.unit === "" ? "" : field.unit.replaceAll("^2", "²").replaceAll("^3", "³").replaceAll("*", "·"));

// Round numbers between low and high, at most `most`.
function ticks(low, high, most) {
  const rough = (high - low) / Math.max(most, 1);
  if (!(rough > 0) || !Number.isFinite(rough)) return [];
  const power = 10 ** Math.floor(Math.log10(rough));
  const step = [1, 2, 5, 10].map((digit) => digit * power).find((step) => step >= rough * 0.999);
  const found = [];
  for (let i = Math.ceil(low / step - 1e-6); i * step <= high + 1e-6 * step; i++) found.push(i * step);
  return found;
}

// ---- state ----

const frames = [];
const start = D + 0;
const offsets = [];
{
  let next = start;
  for (const field of data.fields) {
    offsets.push(next);
    next += field.components.length;
  }
}
const state = {
  frame: 0, field: 0, component: 0, range: "all", low: 0, high: 1, map: "auto", size: 1,
  turn: 0.6, lift: 0.42, zoom: 1, shift: [0, 0], hidden: new Set(), playing: false, under: -1,
};
const field = () => data.fields[state.field];

// The numbers that colour the particles of a frame, kept for the chosen component.
const kept = new Map();
function values(frame) {
  const key = frame + "/" + state.field + "/" + state.component;
  if (kept.has(key)) return kept.get(key);
  const { columns } = frames[frame];
  const first = offsets[state.field], count = field().components.length;
  let result = columns[first + Math.min(state.component, count - 1)];
  if (count > 1 && state.component === count) {
    result = new Float32Array(N);
    for (let i = 0; i < N; i++) {
      let sum = 0;
      for (let c = 0; c < count; c++) sum += columns[first + c][i] ** 2;
      result[i] = Math.sqrt(sum);
    }
  }
  if (kept.size > 2 * frames.length + 8) kept.clear();
  kept.set(key, result);
  return result;
}

function finiteRange(arrays, share) {
  let low = Infinity, high = -Infinity;
  const sample = [];
  let total = 0;
  for (const array of arrays) total += array.length;
  const step = Math.max(1, Math.floor(total / 200000));
  let number = 0;
  for (const array of arrays) {
    for (const value of array) {
      if (!Number.isFinite(value)) continue;
      if (share > 0) {
        if (number++ % step === 0) sample.push(value);
      } else {
        if (value < low) low = value;
        if (value > high) high = value;
      }
    }
  }
  if (share > 0 && sample.length) {
    sample.sort((a, b) => a - b);
    low = sample[Math.floor(share * (sample.length - 1))];
    high = sample[Math.ceil((1 - share) * (sample.length - 1))];
  }
  return low <= high ? [low, high] : [0, 1];
}

const ranges = new Map();
function rangeOf(mode) {
  const key = mode + "/" + state.field + "/" + state.component + (mode === "now" ? "/" + state.frame : "");
  if (!ranges.has(key)) {
    const arrays = mode === "now" ? [values(state.frame)] : frames.map((_, number) => values(number));
    ranges.set(key, finiteRange(arrays, mode === "most" ? 0.01 : 0));
  }
  return ranges.get(key);
}

function applyRange() {
  if (state.range !== "fixed") [state.low, state.high] = rangeOf(state.range);
  const fixed = state.range === "fixed";
  for (const [input, value] of [[byId("low"), state.low], [byId("high"), state.high]]) {
    input.disabled = !fixed;
    if (document.activeElement !== input) input.value = Number(value.toPrecision(5));
  }
}

function colours() {
  let map = state.map;
  if (map === "auto") map = state.low < 0 && state.high > 0 && Math.min(-state.low, state.high) > 0.999 * Math.max(-state.low, state.high) ? "diverging" : "sequential";
  return map === "diverging" ? data.diverging : data.sequential;
}

// ---- where the particles are ----

let box = { low: [0, 0, 0], high: [1, 1, 1] };
let diameters = new Float32Array(N);

function measure() {
  for (let axis = 0; axis < 3; axis++) {
    if (axis >= D) {
      box.low[axis] = box.high[axis] = 0;
      continue;
    }
    const arrays = frames.map((frame) => frame.columns[axis]);
    let [low, high] = finiteRange(arrays, 0);
    const [inner, outer] = finiteRange(arrays, 0.005);
    // What has flown off does not set the view.
    if (high - low > 4 * (outer - inner) && outer > inner) {
      [low, high] = [inner - 0.5 * (outer - inner), outer + 0.5 * (outer - inner)];
    }
    box.low[axis] = low;
    box.high[axis] = high;
  }
  let volume = 1;
  for (let axis = 0; axis < D; axis++) {
    const [low, high] = finiteRange([frames[0].columns[axis]], 0);
    volume *= Math.max(high - low, 1e-30);
  }
  const guess = (volume / Math.max(N, 1)) ** (1 / D);
  for (let i = 0; i < N; i++) diameters[i] = data.diameters[data.body[i]] || guess;
}

function directions() {
  if (D < 3) return { right: [1, 0, 0], up: [0, 1, 0], front: [0, 0, 1] };
  const [st, ct, sl, cl] = [Math.sin(state.turn), Math.cos(state.turn), Math.sin(state.lift), Math.cos(state.lift)];
  return { right: [ct, st, 0], up: [-sl * st, sl * ct, cl], front: [cl * st, -cl * ct, sl] };
}
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];

// Room in CSS pixels for axes and colour bar.
const room = () => (D === 2 ? { left: 62, right: 118, top: 14, bottom: 44 } : { left: 14, right: 118, top: 14, bottom: 14 });

// From metres (relative to the centre of the data) to CSS pixels of the canvas.
function camera() {
  const { right, up, front } = directions();
  const margin = room();
  const width = drawing.clientWidth, height = drawing.clientHeight;
  const middle = box.low.map((low, axis) => 0.5 * (low + box.high[axis]));
  const half = box.low.map((low, axis) => 0.5 * (box.high[axis] - low));
  const radius = Math.max(Math.hypot(...half), 1e-30);
  const largest = finiteRange([diameters], 0)[1];
  // In 3D the fit does not change while it turns.
  const needed = D === 3 ? [radius, radius] : [half[0] + largest, half[1] + largest];
  const inner = [width - margin.left - margin.right, height - margin.top - margin.bottom].map((length) => Math.max(length, 20));
  const fit = D === 3 ? 1.04 * Math.min(...inner) / 2 / radius : 0.96 * Math.min(inner[0] / 2 / needed[0], inner[1] / 2 / needed[1]);
  const scale = fit * state.zoom;
  const origin = [margin.left + inner[0] / 2 + state.shift[0], margin.top + inner[1] / 2 + state.shift[1]];
  const project = (place) => {
    const from = [place[0] - middle[0], place[1] - middle[1], place[2] - middle[2]];
    return [origin[0] + scale * dot(from, right), origin[1] - scale * dot(from, up), dot(from, front)];
  };
  return { right, up, front, scale, origin, middle, project, width, height, margin, depth: 4 * radius + 4 * largest };
}

