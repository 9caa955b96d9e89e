// Values under the pointer on charts, and pictures at full size.
const SVG = "http://www.w3.org/2000/svg";

function written(value, digits) {
  if (value === 0) return "0";
  const size = Math.abs(value);
  const text = size >= 1e-3 && size < 1e6 ? String(Number(value.toPrecision(digits))) : value.toExponential(digits - 1);
  return text.replaceAll("-", "\u2212");
}

// The points of a curve out of its path; rings start at their left end.
function points(group) {
  const path = group.querySelector("path:last-child");
  const ring = path.classList.contains("marks") ? 3.4 : 0;
  const found = [];
  for (const [, x, y] of path.getAttribute("d").matchAll(/[ML](-?[\d.]+) (-?[\d.]+)/g)) found.push([Number(x) + ring, Number(y)]);
  return found;
}

function chart(panel) {
  const range = Object.fromEntries(["x0", "x1", "y0", "y1", "left", "right", "top", "bottom"].map((key) => [key, Number(panel.dataset[key])]));
  const unit = panel.dataset.unit === "1" ? "" : " " + panel.dataset.unit;
  let curves = null, layer = null;
  const tip = document.createElement("div");
  tip.className = "tip";
  tip.hidden = true;
  const holder = document.createElement("div");
  holder.className = "holder";
  panel.replaceWith(holder);
  holder.append(panel, tip);

  const xOf = (at) => range.x0 + (at - range.left) / (range.right - range.left) * (range.x1 - range.x0);
  const yOf = (at) => range.y1 - (at - range.top) / (range.bottom - range.top) * (range.y1 - range.y0);

  function hide() {
    tip.hidden = true;
    layer?.remove();
    layer = null;
  }

  panel.addEventListener("pointermove", (event) => {
    const area = panel.getBoundingClientRect(), scale = panel.viewBox.baseVal.width / area.width;
    const at = (event.clientX - area.left) * scale;
    if (at < range.left || at > range.right) return hide();
    curves ??= [...panel.querySelectorAll(".curve")].map((group) => ({ name: group.dataset.name, points: points(group) }));
    layer?.remove();
    layer = document.createElementNS(SVG, "g");
    const nearest = curves.map((curve) => {
      let best = null;
      for (const point of curve.points) if (!best || Math.abs(point[0] - at) < Math.abs(best[0] - at)) best = point;
      return { name: curve.name, point: best };
    }).filter(({ point }) => point && Math.abs(point[0] - at) < 40);
    if (!nearest.length) return hide();
    const line = document.createElementNS(SVG, "path");
    line.setAttribute("d", `M${nearest[0].point[0]} ${range.top}V${range.bottom}`);
    line.setAttribute("class", "cursor");
    layer.append(line);
    for (const { point } of nearest) {
      const dot = document.createElementNS(SVG, "circle");
      for (const [key, value] of [["cx", point[0]], ["cy", point[1]], ["r", 3.4], ["class", "cursor"]]) dot.setAttribute(key, value);
      layer.append(dot);
    }
    panel.append(layer);
    const rows = [panel.dataset.xName + " = " + written(xOf(nearest[0].point[0]), 4) + " " + panel.dataset.xUnit, ...nearest.map(({ name, point }) => name + " = " + written(yOf(point[1]), 4) + unit)];
    tip.replaceChildren(...rows.map((row) => Object.assign(document.createElement("div"), { textContent: row })));
    tip.hidden = false;
    const x = nearest[0].point[0] / scale;
    tip.style.left = (x > area.width / 2 ? x - tip.offsetWidth - 12 : x + 12) + "px";
    tip.style.top = Math.max(range.top / scale, 0) + 4 + "px";
  });
  panel.addEventListener("pointerleave", hide);
}

function enlarge() {
  const dialog = document.createElement("dialog");
  const large = document.createElement("img");
  dialog.append(large);
  document.body.append(dialog);
  dialog.addEventListener("click", () => dialog.close());
  for (const picture of document.querySelectorAll(".pictures img")) {
    picture.tabIndex = 0;
    const open = () => {
      large.src = picture.src;
      large.alt = picture.alt;
      dialog.showModal();
    };
    picture.addEventListener("click", open);
    picture.addEventListener("keydown", (event) => { if (event.key === "Enter") open(); });
  }
}

document.querySelectorAll("svg.panel").forEach(chart);
enlarge();
