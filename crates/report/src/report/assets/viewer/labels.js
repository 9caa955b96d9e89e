// Axes, colour bar and labels over the particles; in 1D the field against x.

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

