// The particles of a run: decoded, drawn, turned, played.
//
// 1D is drawn as a field against x, 2D and 3D with WebGL2 as discs and lit spheres in parallel
// projection. Numbers arrive as the upper three bytes of 32-bit floats, plane by plane, packed
// with zlib and written in base64.
(() => {
"use strict";
const byId = (id) => document.getElementById(id);
const source = byId("view-data");
if (!source) return;
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

// ---- WebGL ----

const VERTEX = `#version 300 es
in vec3 place;
in float tone;
in float diameter;
uniform vec3 right, up, front, middle;
uniform vec2 size, origin;
uniform float scale, depth, factor;
out float tone_;
out float radius;
void main() {
  vec3 from = place - middle;
  vec2 pixel = origin + scale * vec2(dot(from, right), -dot(from, up));
  gl_Position = vec4(2.0 * pixel.x / size.x - 1.0, 1.0 - 2.0 * pixel.y / size.y, -dot(from, front) / depth, 1.0);
  gl_PointSize = max(diameter * factor * scale, 1.5);
  tone_ = tone;
  radius = 0.25 * diameter * factor / depth;
}`;
const FRAGMENT = `#version 300 es
precision highp float;
in float tone_;
in float radius;
uniform sampler2D map;
uniform float lit;
out vec4 colour;
void main() {
  vec2 at = 2.0 * gl_PointCoord - 1.0;
  float far = dot(at, at);
  if (far > 1.0) discard;
  float height = sqrt(1.0 - far);
  vec3 own = tone_ < 0.0 ? vec3(1.0, 0.0, 1.0) : texture(map, vec2((tone_ * 255.0 + 0.5) / 256.0, 0.5)).rgb;
  float light = max(dot(vec3(at.x, -at.y, height), normalize(vec3(-0.35, 0.55, 0.85))), 0.0);
  float shade = mix(1.0, 0.42 + 0.66 * light, lit);
  colour = vec4(min(own * shade, 1.0), 1.0);
  gl_FragDepth = gl_FragCoord.z - lit * radius * height;
}`;

const LINE_VERTEX = `#version 300 es
in vec2 at;
in float depth;
void main() { gl_Position = vec4(at, depth, 1.0); }`;
const LINE_FRAGMENT = `#version 300 es
precision mediump float;
uniform vec4 ink;
out vec4 colour;
void main() { colour = ink; }`;

let gl = null, points = null, lines = null;

function compile(kind, code) {
  const shader = gl.createShader(kind);
  gl.shaderSource(shader, code);
  gl.compileShader(shader);
  if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS) && !gl.isContextLost()) throw new Error(gl.getShaderInfoLog(shader));
  return shader;
}

// A program with a buffer for each attribute and the places of its uniforms.
function link(vertex, fragment, attributes, names) {
  const program = gl.createProgram(), array = gl.createVertexArray(), buffers = {}, uniforms = {};
  gl.attachShader(program, compile(gl.VERTEX_SHADER, vertex));
  gl.attachShader(program, compile(gl.FRAGMENT_SHADER, fragment));
  gl.linkProgram(program);
  gl.bindVertexArray(array);
  for (const [name, size] of attributes) {
    buffers[name] = gl.createBuffer();
    gl.bindBuffer(gl.ARRAY_BUFFER, buffers[name]);
    const at = gl.getAttribLocation(program, name);
    gl.enableVertexAttribArray(at);
    gl.vertexAttribPointer(at, size, gl.FLOAT, false, 0, 0);
  }
  for (const name of names) uniforms[name] = gl.getUniformLocation(program, name);
  return { program, array, buffers, uniforms };
}

function fill(buffer, numbers) {
  gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
  gl.bufferData(gl.ARRAY_BUFFER, numbers, gl.DYNAMIC_DRAW);
}

function prepare() {
  points = link(VERTEX, FRAGMENT, [["place", 3], ["tone", 1], ["diameter", 1]],
    ["right", "up", "front", "middle", "size", "origin", "scale", "depth", "factor", "map", "lit"]);
  lines = link(LINE_VERTEX, LINE_FRAGMENT, [["at", 2], ["depth", 1]], ["ink"]);
  gl.bindTexture(gl.TEXTURE_2D, gl.createTexture());
  for (const side of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER]) gl.texParameteri(gl.TEXTURE_2D, side, gl.LINEAR);
  for (const side of [gl.TEXTURE_WRAP_S, gl.TEXTURE_WRAP_T]) gl.texParameteri(gl.TEXTURE_2D, side, gl.CLAMP_TO_EDGE);
}

// Sends what the chosen time, field and range make of the particles.
function upload() {
  const { columns } = frames[state.frame];
  const places = new Float32Array(3 * N), tones = new Float32Array(N), sizes = new Float32Array(N);
  const own = values(state.frame), width = state.high - state.low;
  for (let i = 0; i < N; i++) {
    for (let axis = 0; axis < D; axis++) {
      const at = columns[axis][i];
      // Far outside of any view.
      places[3 * i + axis] = Number.isFinite(at) ? at : 1e20;
    }
    tones[i] = Number.isFinite(own[i]) ? Math.min(Math.max(width > 0 ? (own[i] - state.low) / width : 0.5, 0), 1) : -1;
    sizes[i] = diameters[i];
    if (state.hidden.has(data.body[i])) places[3 * i] = 1e20;
  }
  for (const [name, array] of [["place", places], ["tone", tones], ["diameter", sizes]]) fill(points.buffers[name], array);
  gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGB, 256, 1, 0, gl.RGB, gl.UNSIGNED_BYTE, new Uint8Array(colours()));
}

function paint() {
  const ratio = drawing.width / Math.max(drawing.clientWidth, 1);
  const eye = camera();
  gl.viewport(0, 0, drawing.width, drawing.height);
  gl.clearColor(0, 0, 0, 0);
  gl.enable(gl.DEPTH_TEST);
  gl.depthFunc(gl.LEQUAL);
  gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
  const { uniforms } = points;
  gl.useProgram(points.program);
  gl.bindVertexArray(points.array);
  for (const name of ["right", "up", "front", "middle"]) gl.uniform3fv(uniforms[name], eye[name]);
  gl.uniform2f(uniforms.size, drawing.width, drawing.height);
  gl.uniform2f(uniforms.origin, eye.origin[0] * ratio, eye.origin[1] * ratio);
  gl.uniform1f(uniforms.scale, eye.scale * ratio);
  gl.uniform1f(uniforms.depth, eye.depth);
  gl.uniform1f(uniforms.factor, state.size);
  gl.uniform1f(uniforms.lit, D === 3 ? 1 : 0);
  gl.uniform1i(uniforms.map, 0);
  gl.drawArrays(gl.POINTS, 0, N);
  if (D === 3) edges(eye);
}

// The edges of the box of the data, behind and in front of the particles.
function edges(eye) {
  const corner = (bits) => eye.project([0, 1, 2].map((axis) => (bits >> axis & 1 ? box.high[axis] : box.low[axis])));
  const at = [], depth = [];
  for (let axis = 0; axis < 3; axis++) {
    for (let bits = 0; bits < 8; bits++) {
      if (bits >> axis & 1) continue;
      for (const [x, y, near] of [corner(bits), corner(bits | 1 << axis)]) {
        at.push(2 * x / eye.width - 1, 1 - 2 * y / eye.height);
        depth.push(-near / eye.depth);
      }
    }
  }
  gl.useProgram(lines.program);
  gl.bindVertexArray(lines.array);
  fill(lines.buffers.at, new Float32Array(at));
  fill(lines.buffers.depth, new Float32Array(depth));
  gl.uniform4f(lines.uniforms.ink, 0.55, 0.6, 0.68, 1);
  gl.drawArrays(gl.LINES, 0, depth.length);
}

// ---- axes, colour bar and labels ----

function inks() {
  const style = getComputedStyle(view);
  return { ink: style.getPropertyValue("--ink").trim(), faint: style.getPropertyValue("--faint").trim(), line: style.getPropertyValue("--line").trim(), stage: style.getPropertyValue("--stage").trim() };
}

function label() {
  const own = field(), count = own.components.length;
  const part = count > 1 ? "." + (own.components[state.component] ?? "magnitude") : "";
  return own.name + part + (unit(own) ? " [" + unit(own) + "]" : "");
}

function bar(pen, ink, height, width) {
  const map = colours(), top = 40, left = width - 96, length = Math.max(Math.min(height - 90, 420), 40);
  for (let y = 0; y < length; y++) {
    const tone = Math.round(255 * (1 - y / (length - 1)));
    pen.fillStyle = "rgb(" + map.slice(3 * tone, 3 * tone + 3).join(",") + ")";
    pen.fillRect(left, top + y, 14, 1.5);
  }
  pen.strokeStyle = pen.fillStyle = ink;
  pen.lineWidth = 1;
  pen.strokeRect(left - 0.5, top - 0.5, 15, length + 1.5);
  pen.textAlign = "left";
  pen.textBaseline = "middle";
  const [low, high] = [state.low, state.high];
  for (const value of ticks(low, high, 6)) {
    const y = top + length * (1 - (value - low) / (high - low));
    pen.fillRect(left + 14, y - 0.5, 4, 1);
    pen.fillText(text(value, 4), left + 22, y);
  }
  if (!(high > low)) pen.fillText(text(low, 4), left + 22, top + length / 2);
  pen.textAlign = "right";
  pen.fillText(label(), width - 8, top - 22);
  pen.textAlign = "left";
}

function flatAxes(pen, eye, ink, faint) {
  const { margin, scale, origin, middle, width, height } = eye;
  const right = width - margin.right, bottom = height - margin.bottom;
  const ends = [
    [(margin.left - origin[0]) / scale + middle[0], (right - origin[0]) / scale + middle[0]],
    [(origin[1] - bottom) / scale + middle[1], (origin[1] - margin.top) / scale + middle[1]],
  ];
  pen.clearRect(0, bottom, width, margin.bottom);
  axes(pen, ends.map(([low, high], axis) => [low + data.centre[axis], high + data.centre[axis]]), { left: margin.left, right, top: margin.top, bottom }, ["x [m]", "y [m]"], ink, faint, null);
}

// Ticks, labels and a frame around an area; lines across it in the colour `grid`, if any.
function axes(pen, [[x0, x1], [y0, y1]], { left, right, top, bottom }, names, ink, faint, grid) {
  pen.lineWidth = 1;
  pen.fillStyle = ink;
  pen.textAlign = "center";
  pen.textBaseline = "top";
  for (const value of ticks(x0, x1, Math.max(2, (right - left) / 90))) {
    const x = left + (value - x0) / (x1 - x0) * (right - left);
    pen.strokeStyle = grid || faint;
    pen.beginPath(); pen.moveTo(x, grid ? top : bottom); pen.lineTo(x, bottom + 4); pen.stroke();
    pen.fillText(text(value, 4), x, bottom + 7);
  }
  pen.textAlign = "right";
  pen.textBaseline = "middle";
  for (const value of ticks(y0, y1, Math.max(2, (bottom - top) / 60))) {
    const y = bottom - (value - y0) / (y1 - y0) * (bottom - top);
    pen.strokeStyle = grid || faint;
    pen.beginPath(); pen.moveTo(left - 4, y); pen.lineTo(grid ? right : left, y); pen.stroke();
    pen.fillText(text(value, 4), left - 8, y);
  }
  pen.strokeStyle = faint;
  pen.strokeRect(left + 0.5, top + 0.5, right - left, bottom - top);
  pen.textAlign = "center";
  pen.fillText(names[0], (left + right) / 2, bottom + 32);
  pen.save();
  pen.translate(12, (top + bottom) / 2);
  pen.rotate(-Math.PI / 2);
  pen.fillText(names[1], 0, 0);
  pen.restore();
}

function solidAxes(pen, eye, ink) {
  const at = [52, eye.height - 52];
  pen.lineWidth = 1.6;
  pen.textAlign = "center";
  pen.textBaseline = "middle";
  for (let axis = 0; axis < 3; axis++) {
    const across = 32 * eye.right[axis], up = -32 * eye.up[axis];
    pen.strokeStyle = pen.fillStyle = ink;
    pen.beginPath(); pen.moveTo(at[0], at[1]); pen.lineTo(at[0] + across, at[1] + up); pen.stroke();
    pen.fillText(NAMES[axis], at[0] + 1.35 * across, at[1] + 1.35 * up);
  }
  const lengths = box.low.map((low, axis) => text(box.high[axis] - low, 3));
  pen.textAlign = "left";
  pen.fillText("box of all times: " + lengths.join(" × ") + " m", 14, eye.height - 10);
}

// The field against x.
function curve(pen, { ink, faint, line }) {
  const width = overlay.clientWidth, height = overlay.clientHeight;
  const area = { left: 84, right: width - 20, top: 22, bottom: height - 46 };
  let [x0, x1] = [box.low[0] + data.centre[0], box.high[0] + data.centre[0]];
  let [y0, y1] = [state.low, state.high];
  if (!(x1 > x0)) [x0, x1] = [x0 - 0.5, x1 + 0.5];
  if (!(y1 > y0)) [y0, y1] = [y0 - 0.05 * Math.abs(y0) - 1e-12, y1 + 0.05 * Math.abs(y1) + 1e-12];
  const around = 0.04 * (y1 - y0);
  y0 -= around; y1 += around;
  axes(pen, [[x0, x1], [y0, y1]], area, ["x [m]", label()], ink, faint, line);
  const { columns } = frames[state.frame], places = columns[0], own = values(state.frame);
  const project = (i) => [
    area.left + (places[i] + data.centre[0] - x0) / (x1 - x0) * (area.right - area.left),
    area.bottom - (own[i] - y0) / (y1 - y0) * (area.bottom - area.top),
  ];
  const order = Array.from(places.keys()).filter((i) => Number.isFinite(places[i]) && !state.hidden.has(data.body[i])).sort((a, b) => places[a] - places[b]);
  const bodies = new Set(data.body);
  pen.save();
  pen.beginPath();
  pen.rect(area.left, area.top - 4, area.right - area.left, area.bottom - area.top + 8);
  pen.clip();
  for (const body of bodies) {
    const tone = Math.round(255 * (bodies.size > 1 ? body / (bodies.size - 1) : 0.35));
    pen.strokeStyle = pen.fillStyle = "rgb(" + data.sequential.slice(3 * tone, 3 * tone + 3).join(",") + ")";
    pen.lineWidth = 1.6;
    pen.beginPath();
    let down = false;
    for (const i of order) {
      if (data.body[i] !== body) continue;
      if (!Number.isFinite(own[i])) { down = false; continue; }
      const [x, y] = project(i);
      if (down) pen.lineTo(x, y); else pen.moveTo(x, y);
      down = true;
    }
    pen.stroke();
    for (const i of order) {
      if (data.body[i] !== body || !Number.isFinite(own[i])) continue;
      const [x, y] = project(i);
      pen.beginPath(); pen.arc(x, y, order.length > 400 ? 1.6 : 3, 0, 7); pen.fill();
    }
  }
  pen.restore();
  return project;
}

let projectLine = null;

function annotate() {
  const ratio = overlay.width / Math.max(overlay.clientWidth, 1);
  const pen = overlay.getContext("2d");
  pen.setTransform(ratio, 0, 0, ratio, 0, 0);
  pen.clearRect(0, 0, overlay.clientWidth, overlay.clientHeight);
  pen.font = "12.5px system-ui, sans-serif";
  const { ink, faint, line } = inks();
  if (D === 1) {
    projectLine = curve(pen, { ink, faint, line });
  } else {
    const eye = camera();
    if (D === 2) flatAxes(pen, eye, ink, faint); else solidAxes(pen, eye, ink);
    bar(pen, ink, eye.height, eye.width);
  }
  mark(pen, ink);
}

function screenOf(i) {
  if (D === 1) return projectLine(i);
  const { columns } = frames[state.frame];
  return camera().project([columns[0][i], columns[1][i], D === 3 ? columns[2][i] : 0]);
}

function mark(pen, ink) {
  if (state.under < 0) return;
  const [x, y] = screenOf(state.under);
  const radius = D === 1 ? 5 : Math.max(0.5 * diameters[state.under] * state.size * camera().scale, 3) + 1.5;
  pen.strokeStyle = ink;
  pen.lineWidth = 2;
  pen.beginPath(); pen.arc(x, y, radius, 0, 7); pen.stroke();
}

// ---- frames of the screen ----

let wanted = { data: true, paint: true };
let asked = false;
function redraw(what) {
  if (what === "data") wanted.data = true;
  wanted.paint = true;
  if (!asked) {
    asked = true;
    requestAnimationFrame(render);
  }
}

function resize() {
  const ratio = window.devicePixelRatio || 1;
  for (const canvas of [drawing, overlay]) {
    const width = Math.max(1, Math.round(canvas.clientWidth * ratio)), height = Math.max(1, Math.round(canvas.clientHeight * ratio));
    if (canvas.width !== width || canvas.height !== height) [canvas.width, canvas.height] = [width, height];
  }
}

function render() {
  asked = false;
  resize();
  if (wanted.data) {
    applyRange();
    byId("time").value = state.frame;
    byId("clock").textContent = "t = " + text(frames[state.frame].time, 6) + " s  (" + (state.frame + 1) + " of " + frames.length + ")";
    view.dataset.frame = state.frame;
  }
  if (D > 1 && !gl.isContextLost()) {
    if (wanted.data) upload();
    paint();
  }
  annotate();
  wanted = { data: false, paint: false };
  view.dataset.drawn = String(Number(view.dataset.drawn || 0) + 1);
}

// ---- controls ----

function option(select, value, words) {
  const made = document.createElement("option");
  made.value = value;
  made.textContent = words;
  select.append(made);
}

function fillComponents() {
  const select = byId("component"), { components } = field();
  select.replaceChildren();
  components.forEach((name, number) => option(select, number, name || "value"));
  if (components.length > 1) option(select, components.length, "magnitude");
  select.value = state.component;
  select.closest("label").hidden = components.length < 2;
}

// The data without their ends, where a short peak would take the colours from all the rest. Of a
// line the peak is worth seeing, unless it flattens it.
function chooseRange() {
  const [low, high] = rangeOf("all"), [inner, outer] = rangeOf("most");
  state.range = outer > inner && high - low > (D === 1 ? 20 : 1.3) * (outer - inner) ? "most" : "all";
  byId("range").value = state.range;
}

function chooseField(number, component) {
  state.field = number;
  const { components } = data.fields[number];
  state.component = component ?? (components.length > 1 ? components.length : 0);
  byId("field").value = number;
  fillComponents();
  if (state.range !== "now") chooseRange();
  redraw("data");
}

function firstField() {
  const [name, part] = (data.first || "pressure").split(".");
  const number = data.fields.findIndex((field) => field.name === name);
  if (number < 0) return chooseField(0);
  const component = data.fields[number].components.indexOf(part);
  chooseField(number, component >= 0 ? component : undefined);
}

function go(frame) {
  state.frame = Math.min(Math.max(frame, 0), frames.length - 1);
  state.under = -1;
  tip.hidden = true;
  redraw("data");
}

let last = 0;
function tick(now) {
  if (!state.playing) return;
  if (now - last > 90) {
    last = now;
    go((state.frame + 1) % frames.length);
  }
  requestAnimationFrame(tick);
}
function play(on) {
  state.playing = on;
  byId("play").textContent = on ? "Pause" : "Play";
  if (on) requestAnimationFrame(tick);
}

function fit() {
  state.zoom = 1;
  state.shift = [0, 0];
  redraw();
}

function look(direction) {
  const views = { iso: [0.6, 0.42], x: [Math.PI / 2, 0], y: [0, 0], z: [0, Math.PI / 2] };
  [state.turn, state.lift] = views[direction];
  fit();
}

function zoom(factor, x, y) {
  const next = Math.min(Math.max(state.zoom * factor, 0.05), 500);
  const eye = camera(), real = next / state.zoom;
  // The point under the pointer stays there.
  state.shift[0] += (x - eye.origin[0]) * (1 - real);
  state.shift[1] += (y - eye.origin[1]) * (1 - real);
  state.zoom = next;
  redraw();
}

// The particle under a point of the canvas, the nearest to the viewer.
function pick(x, y) {
  let found = -1, best = D === 3 ? -Infinity : Infinity;
  const { columns } = frames[state.frame];
  const eye = D === 1 ? null : camera();
  const own = D === 1 ? values(state.frame) : null;
  for (let i = 0; i < N; i++) {
    if (state.hidden.has(data.body[i])) continue;
    if (D === 1) {
      if (!Number.isFinite(own[i])) continue;
      const [px, py] = projectLine(i), far = Math.hypot(px - x, 0.2 * (py - y));
      if (far < Math.min(best, 30)) [best, found] = [far, i];
      continue;
    }
    const [px, py, near] = eye.project([columns[0][i], columns[1][i], D === 3 ? columns[2][i] : 0]);
    const far = Math.hypot(px - x, py - y);
    const radius = Math.max(0.5 * diameters[i] * state.size * eye.scale, 4);
    if (!(far <= radius)) continue;
    if (D === 3 ? near > best : far < best) [best, found] = [D === 3 ? near : far, i];
  }
  return found;
}

function tell(x, y) {
  const found = pick(x, y);
  if (found !== state.under) {
    state.under = found;
    redraw();
  }
  tip.hidden = found < 0;
  if (found < 0) return;
  const { columns } = frames[state.frame];
  const own = values(state.frame)[found];
  const place = NAMES.slice(0, D).map((name, axis) => name + " = " + text(columns[axis][found] + data.centre[axis], 5));
  const body = data.bodies[data.body[found]];
  const lines = [label().replace(/ \[.*\]$/, "") + " = " + text(own) + (unit(field()) ? " " + unit(field()) : ""), place.join(", ") + " m", "particle " + data.ids[found] + (body ? " of " + body : "")];
  tip.replaceChildren(...lines.map((line) => Object.assign(document.createElement("div"), { textContent: line })));
  tip.style.left = Math.min(x + 14, drawing.clientWidth - tip.offsetWidth - 4) + "px";
  tip.style.top = Math.max(Math.min(y + 14, drawing.clientHeight - tip.offsetHeight - 4), 0) + "px";
}

function listen() {
  byId("field").addEventListener("change", (event) => chooseField(Number(event.target.value)));
  byId("component").addEventListener("change", (event) => {
    state.component = Number(event.target.value);
    if (state.range !== "now") chooseRange();
    redraw("data");
  });
  byId("range").addEventListener("change", (event) => { state.range = event.target.value; redraw("data"); });
  byId("map").addEventListener("change", (event) => { state.map = event.target.value; redraw("data"); });
  for (const [id, key] of [["low", "low"], ["high", "high"]]) {
    byId(id).addEventListener("input", (event) => {
      const value = event.target.valueAsNumber;
      if (Number.isFinite(value)) { state[key] = value; redraw("data"); }
    });
  }
  byId("time").addEventListener("input", (event) => { play(false); go(Number(event.target.value)); });
  byId("play").addEventListener("click", () => play(!state.playing));
  byId("fit").addEventListener("click", fit);
  byId("size").addEventListener("input", (event) => { state.size = Number(event.target.value); redraw(); });
  for (const button of byId("directions").children) button.addEventListener("click", () => look(button.dataset.view));
  byId("save").addEventListener("click", save);

  const pointers = new Map();
  const at = (event) => {
    const area = drawing.getBoundingClientRect();
    return [event.clientX - area.left, event.clientY - area.top];
  };
  drawing.addEventListener("pointerdown", (event) => {
    pointers.set(event.pointerId, at(event));
    drawing.setPointerCapture(event.pointerId);
    drawing.focus({ preventScroll: true });
  });
  drawing.addEventListener("pointermove", (event) => {
    const [x, y] = at(event), before = pointers.get(event.pointerId);
    if (!before) return tell(x, y);
    if (D === 1) return;
    tip.hidden = true;
    state.under = -1;
    const others = [...pointers].filter(([id]) => id !== event.pointerId).map(([, place]) => place);
    if (others.length) {
      const apart = (place) => Math.hypot(place[0] - others[0][0], place[1] - others[0][1]);
      zoom(apart([x, y]) / Math.max(apart(before), 1), (x + others[0][0]) / 2, (y + others[0][1]) / 2);
    } else if (D === 3 && !(event.shiftKey || event.buttons & 6)) {
      state.turn -= 0.008 * (x - before[0]);
      state.lift = Math.min(Math.max(state.lift + 0.008 * (y - before[1]), -Math.PI / 2), Math.PI / 2);
    } else {
      state.shift[0] += x - before[0];
      state.shift[1] += y - before[1];
    }
    pointers.set(event.pointerId, [x, y]);
    redraw();
  });
  for (const name of ["pointerup", "pointercancel"]) drawing.addEventListener(name, (event) => pointers.delete(event.pointerId));
  drawing.addEventListener("pointerleave", () => { state.under = -1; tip.hidden = true; redraw(); });
  drawing.addEventListener("contextmenu", (event) => event.preventDefault());
  drawing.addEventListener("dblclick", fit);
  drawing.addEventListener("wheel", (event) => {
    if (D === 1) return;
    event.preventDefault();
    zoom(Math.exp(-0.0015 * event.deltaY * (event.deltaMode ? 20 : 1)), ...at(event));
  }, { passive: false });
  drawing.addEventListener("keydown", (event) => {
    const keys = {
      ArrowRight: () => go(state.frame + 1), ArrowLeft: () => go(state.frame - 1), Home: () => go(0), End: () => go(frames.length - 1),
      " ": () => play(!state.playing), "+": () => zoom(1.2, ...camera().origin), "-": () => zoom(1 / 1.2, ...camera().origin),
    };
    if (keys[event.key]) { event.preventDefault(); keys[event.key](); }
  });
  drawing.addEventListener("webglcontextlost", (event) => event.preventDefault());
  drawing.addEventListener("webglcontextrestored", () => { prepare(); redraw("data"); });
  new ResizeObserver(() => redraw()).observe(drawing);
  window.matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => redraw());
}

// The drawing with its labels as a PNG file.
function save() {
  const whole = document.createElement("canvas");
  [whole.width, whole.height] = [overlay.width, overlay.height];
  const pen = whole.getContext("2d");
  pen.fillStyle = inks().stage || "white";
  pen.fillRect(0, 0, whole.width, whole.height);
  if (D > 1) pen.drawImage(drawing, 0, 0);
  pen.drawImage(overlay, 0, 0);
  whole.toBlob((blob) => {
    const link = document.createElement("a");
    link.href = URL.createObjectURL(blob);
    link.download = (field().name + "_t" + text(frames[state.frame].time, 4) + ".png").replaceAll("\u2212", "-");
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 1000);
  });
}

function offer() {
  data.fields.forEach((field, number) => option(byId("field"), number, field.name.replaceAll("_", " ")));
  byId("time").max = frames.length - 1;
  byId("directions").hidden = D < 3;
  byId("help").textContent = D === 3 ? "Drag to turn, shift and drag to move, scroll to zoom." : D === 2 ? "Drag to move, scroll to zoom." : "";
  if (D === 1) {
    for (const id of ["map", "sizing"]) (byId(id).closest("label") || byId(id)).hidden = true;
    byId("fit").hidden = true;
    byId("range").closest("label").firstChild.textContent = "Values ";
  }
  const bodies = [...new Set(data.body)];
  if (bodies.length > 1 && bodies.length <= 24) {
    for (const body of bodies) {
      const made = document.createElement("label"), tick = document.createElement("input");
      tick.type = "checkbox";
      tick.checked = true;
      tick.addEventListener("change", () => {
        if (tick.checked) state.hidden.delete(body); else state.hidden.add(body);
        redraw("data");
      });
      made.append(tick, " " + (data.bodies[body] ?? "body " + body));
      byId("which").append(made);
    }
  }
}

async function begin() {
  if (typeof DecompressionStream === "undefined") return trouble("This browser cannot unpack the particles: it has no DecompressionStream. The pictures below show them.");
  if (D > 1) {
    gl = drawing.getContext("webgl2", { alpha: true, antialias: true, preserveDrawingBuffer: true });
    if (!gl) return trouble("This browser has no WebGL 2, which the interactive view needs. The pictures below show the particles.");
    prepare();
  }
  byId("trouble").textContent = "Unpacking the particles …";
  const texts = [...document.querySelectorAll("script.frame")];
  const total = D + data.fields.reduce((sum, field) => sum + field.components.length, 0);
  for (const [number, script] of texts.entries()) {
    const bytes = await unpack(script.textContent);
    if (bytes.length !== 3 * N * total) throw new Error("an instant has the wrong length");
    frames.push({ time: data.times[number] ?? NaN, columns: Array.from({ length: total }, (_, c) => column(bytes, c)) });
    script.remove();
  }
  // A file without fields is coloured by the body of its particles.
  if (!data.fields.length) {
    data.fields.push({ name: "body", unit: "1", components: [""] });
    offsets.push(total);
    for (const frame of frames) frame.columns.push(Float32Array.from(data.body));
  }
  state.frame = frames.length - 1;
  measure();
  offer();
  listen();
  view.hidden = false;
  byId("trouble").hidden = true;
  firstField();
  requestAnimationFrame(() => { view.dataset.ready = "yes"; });
}

begin().catch((error) => trouble("The particles cannot be shown: " + error.message + ". The pictures below show them."));
})();
