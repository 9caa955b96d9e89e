// What the reader does, and when what is drawn anew.

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
