// Particles drawn with WebGL 2, in parallel projection: discs in 2D, lit spheres in 3D.

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
  vec3 own = tone_ < -1.5 ? vec3(0.63) : tone_ < 0.0 ? vec3(1.0, 0.0, 1.0) : texture(map, vec2((tone_ * 255.0 + 0.5) / 256.0, 0.5)).rgb;
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
    tones[i] = Number.isFinite(own[i]) ? Math.min(Math.max(width > 0 ? (own[i] - state.low) / width : 0.5, 0), 1) : own[i] === -Infinity ? -2 : -1;
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

