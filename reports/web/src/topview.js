// Paths on a picture of the scene from above: drag, zoom, hover, and errors drawn larger than they are.
import { cssColor, el } from "./dom.js";
import { formatLength, formatNumber } from "./format.js";
import { isNumber, range } from "./stats.js";

const kMagnifications = [1, 10, 100];

export class TopView {
  constructor(state) {
    this.state = state;
    this.magnify = 1;
    this.canvas = el("canvas", { class: "topview", tabindex: "0", role: "application",
      "aria-label": "Paths from above. Plus and minus zoom, arrow keys move, zero shows all." });
    this.tip = el("div", { class: "hover-card", hidden: true });
    this.wrap = el("div", { class: "topview-wrap" }, this.canvas, this.tip, this.tools());
    this.element = el("div", {}, this.magnifier(), this.wrap);
    this.image = null;
    const top = state.data.pictures.top;
    if (!state.hasTruth) this.element.firstChild.remove();
    if (top) {
      this.image = new Image();
      this.image.onload = () => this.draw();
      this.image.src = top.src;
    }
    this.listen();
    new ResizeObserver(() => this.resize()).observe(this.wrap);
  }

  tools() {
    const button = (label, name, action) => el("button", { type: "button", "aria-label": name, "data-tip": name, onclick: action }, label);
    return el("div", { class: "map-tools" },
      button("+", "Zoom in", () => this.zoomAt(this.width / 2, this.height / 2, 1.6)),
      button("−", "Zoom out", () => this.zoomAt(this.width / 2, this.height / 2, 1 / 1.6)),
      button("⤢", "Show all", () => this.fit()));
  }

  magnifier() {
    const group = el("div", { class: "segments", role: "group", "aria-label": "Draw errors larger" });
    for (const factor of kMagnifications) {
      group.append(el("button", { type: "button", "aria-pressed": factor === 1, onclick: (event) => {
        this.magnify = factor;
        for (const other of group.children) other.setAttribute("aria-pressed", other === event.target);
        this.draw();
      } }, `${factor}×`));
    }
    return el("div", { class: "chart-bar" }, el("span", { class: "axis-name" }, "Errors drawn"), group);
  }

  /** Paths of the chosen seeds: truth once a seed, estimates as [{name, color, x, y, truth, index}]. */
  paths() {
    const truths = [];
    const estimates = [];
    for (const estimator of this.state.data.estimators) {
      for (const run of this.state.runs(estimator)) {
        const truth = this.state.data.truth[String(run.seed)]?.path_true;
        if (truth && !truths.includes(truth)) truths.push(truth);
        const path = run.series.path_estimate;
        if (!path || !this.state.isVisible(estimator)) continue;
        estimates.push({ name: estimator, seed: run.seed, color: this.state.color(estimator), truth, ...path });
      }
    }
    return { truths, estimates };
  }

  /** Where the geometry leaves a direction free, on the true paths of the chosen seeds. */
  degenerate() {
    const seeds = this.state.seed === "all" ? this.state.data.seeds : [this.state.seed];
    return seeds.map((seed) => this.state.data.truth[String(seed)]?.path_degenerate).filter(Boolean);
  }

  /** Where a sample is drawn: the true place plus the error times the magnification. */
  place(path, i) {
    const [x, y] = [path.x[i], path.y[i]];
    if (!isNumber(x) || !isNumber(y)) return null;
    const truth = path.truth;
    if (this.magnify === 1 || !truth || truth.x.length !== path.x.length) return [x, y];
    return [truth.x[i] + this.magnify * (x - truth.x[i]), truth.y[i] + this.magnify * (y - truth.y[i])];
  }

  /** What is shown at first: the true paths with room around them; without truth the picture, or the estimates. */
  bounds() {
    const { truths, estimates } = this.paths();
    const top = this.state.data.pictures.top;
    if (truths.length === 0 && top) return [...top.min_m, ...top.max_m];
    const drawn = truths.length ? truths : estimates;
    const [x0, x1] = range(drawn.flatMap((path) => path.x)) ?? [-10, 10];
    const [y0, y1] = range(drawn.flatMap((path) => path.y)) ?? [-10, 10];
    const margin = 0.1 * Math.max(x1 - x0, y1 - y0, truths.length ? 10 : 0.1);
    return [x0 - margin, y0 - margin, x1 + margin, y1 + margin];
  }

  fit() {
    const [x0, y0, x1, y1] = this.bounds();
    this.scale = Math.min(this.width / (x1 - x0), this.height / (y1 - y0));  // px a metre
    this.center = [(x0 + x1) / 2, (y0 + y1) / 2];
    this.fitted = true;
    this.draw();
  }

  toScreen([x, y]) {
    return [this.width / 2 + (x - this.center[0]) * this.scale, this.height / 2 - (y - this.center[1]) * this.scale];
  }

  toWorld(px, py) {
    return [this.center[0] + (px - this.width / 2) / this.scale, this.center[1] - (py - this.height / 2) / this.scale];
  }

  zoomAt(px, py, factor) {
    const before = this.toWorld(px, py);
    this.scale = Math.min(Math.max(this.scale * factor, 0.2), 5000);
    const after = this.toWorld(px, py);
    this.center = [this.center[0] + before[0] - after[0], this.center[1] + before[1] - after[1]];
    this.fitted = false;
    this.draw();
  }

  pan(dx, dy) {
    this.center = [this.center[0] - dx / this.scale, this.center[1] + dy / this.scale];
    this.fitted = false;
    this.draw();
  }

  resize() {
    const width = this.wrap.clientWidth;
    if (width === 0 || width === this.width) return;
    const [x0, y0, x1, y1] = this.bounds();
    this.width = width;
    this.height = Math.round(width * Math.min(Math.max((y1 - y0) / (x1 - x0), 0.45), 0.6));
    this.canvas.style.height = `${this.height}px`;
    const ratio = window.devicePixelRatio || 1;
    this.canvas.width = Math.round(width * ratio);
    this.canvas.height = Math.round(this.height * ratio);
    this.ratio = ratio;
    if (this.fitted !== false) this.fit();
    else this.draw();
  }

  draw() {
    if (!this.width || !this.scale) return;
    const g = this.canvas.getContext("2d");
    g.setTransform(this.ratio, 0, 0, this.ratio, 0, 0);
    g.fillStyle = cssColor("--map-ground");
    g.fillRect(0, 0, this.width, this.height);
    this.drawPicture(g);
    const { truths, estimates } = this.paths();
    const onPicture = Boolean(this.image);
    for (const path of this.degenerate()) {
      this.stroke(g, path.x.map((x, i) => [x, path.y[i]]), onPicture ? "rgba(240,70,40,0.62)" : "rgba(200,60,30,0.4)", 17);
    }
    for (const path of truths) {
      const points = path.x.map((x, i) => [x, path.y[i]]);
      this.stroke(g, points, onPicture ? "rgba(20,24,28,0.55)" : "transparent", 6.5);
      this.stroke(g, points, onPicture ? "#ffffff" : cssColor("--ink"), 3.6);
    }
    const many = this.state.data.seeds.length > 1 && this.state.seed === "all";
    for (const path of estimates) {
      const points = path.x.map((_, i) => this.place(path, i));
      if (onPicture) this.stroke(g, points, "rgba(255,255,255,0.35)", many ? 2.2 : 3.4);
      this.stroke(g, points, onPicture ? cssColor(path.color.replace("--c", "--map-c")) : cssColor(path.color), many ? 1.1 : 1.9);
    }
    for (const path of (truths.length ? truths : estimates).slice(0, 1)) this.drawEnds(g, path);
    this.drawScaleBar(g);
  }

  drawPicture(g) {
    const top = this.state.data.pictures.top;
    if (!top || !this.image.complete || this.image.naturalWidth === 0) return;
    const [left, upper] = this.toScreen([top.min_m[0], top.max_m[1]]);
    const [right, lower] = this.toScreen([top.max_m[0], top.min_m[1]]);
    g.imageSmoothingQuality = "high";
    g.drawImage(this.image, left, upper, right - left, lower - upper);
    g.fillStyle = cssColor("--map-veil");  // the picture steps back behind the lines
    g.fillRect(left, upper, right - left, lower - upper);
  }

  stroke(g, points, color, width) {
    g.beginPath();
    let open = false;
    for (const point of points) {
      if (!point || !isNumber(point[0]) || !isNumber(point[1])) {
        open = false;
        continue;
      }
      const [x, y] = this.toScreen(point);
      if (open) g.lineTo(x, y);
      else g.moveTo(x, y);
      open = true;
    }
    g.lineJoin = "round";
    g.lineCap = "round";
    g.strokeStyle = color;
    g.lineWidth = width;
    g.stroke();
  }

  drawEnds(g, path) {
    const at = [0, path.x.length - 1].map((i) => this.toScreen([path.x[i], path.y[i]]));
    g.font = '600 11.5px "Inter", ui-sans-serif, system-ui, sans-serif';
    const close = Math.hypot(at[0][0] - at[1][0], at[0][1] - at[1][1]) < 24;
    for (const [[x, y], label, dy] of [[at[0], "start", close ? 18 : -10], [at[1], "end", -10]]) {
      g.beginPath();
      g.arc(x, y, 5, 0, 2 * Math.PI);
      g.fillStyle = label === "start" ? "#ffffff" : "#14181c";
      g.fill();
      g.lineWidth = 2;
      g.strokeStyle = label === "start" ? "#14181c" : "#ffffff";
      g.stroke();
      this.label(g, label, x + 8, y + dy + 4);
    }
  }

  drawScaleBar(g) {
    const target = 110 / this.scale;
    const decade = 10 ** Math.floor(Math.log10(target));
    const length = [5, 2, 1].map((f) => f * decade).find((l) => l <= target) ?? decade;
    const [x, y, width] = [16, this.height - 18, length * this.scale];
    g.font = '600 11.5px "Inter", ui-sans-serif, system-ui, sans-serif';
    const text = length >= 1 ? `${length} m` : formatLength(length);
    for (const [color, line] of this.image ? [["rgba(20,24,28,0.7)", 5], ["#ffffff", 2]] : [[cssColor("--ink"), 1.5]]) {
      g.beginPath();
      g.moveTo(x, y - 5);
      g.lineTo(x, y);
      g.lineTo(x + width, y);
      g.lineTo(x + width, y - 5);
      g.strokeStyle = color;
      g.lineWidth = line;
      g.lineJoin = "miter";
      g.stroke();
    }
    this.label(g, text, x + 6, y - 8);
  }

  /** White on the picture, ink on plain ground. */
  label(g, text, x, y) {
    g.lineWidth = 3;
    g.strokeStyle = this.image ? "rgba(20,24,28,0.75)" : cssColor("--map-ground");
    g.fillStyle = this.image ? "#ffffff" : cssColor("--ink");
    g.strokeText(text, x, y);
    g.fillText(text, x, y);
  }

  /** The nearest drawn sample within reach of the pointer. */
  nearest(px, py) {
    let best = null;
    for (const path of this.paths().estimates) {
      for (let i = 0; i < path.x.length; ++i) {
        const point = this.place(path, i);
        if (!point) continue;
        const [x, y] = this.toScreen(point);
        const distance = Math.hypot(x - px, y - py);
        if (distance < (best?.distance ?? 22)) best = { distance, path, i, x, y };
      }
    }
    return best;
  }

  hover(px, py) {
    const hit = this.nearest(px, py);
    this.draw();
    this.tip.hidden = !hit;
    if (!hit) return;
    const { path, i } = hit;
    const g = this.canvas.getContext("2d");
    const color = this.image ? path.color.replace("--c", "--map-c") : path.color;
    const truth = path.truth && path.truth.x.length === path.x.length ? [path.truth.x[i], path.truth.y[i]] : null;
    if (truth) this.stroke(g, [truth, this.place(path, i)], "#ffffff", 1.5);
    g.beginPath();
    g.arc(hit.x, hit.y, 5, 0, 2 * Math.PI);
    g.fillStyle = cssColor(color);
    g.fill();
    g.strokeStyle = "#ffffff";
    g.lineWidth = 1.5;
    g.stroke();
    const error = truth ? Math.hypot(path.x[i] - truth[0], path.y[i] - truth[1]) : null;
    const seeds = this.state.data.seeds.length > 1 ? ` · seed ${path.seed}` : "";
    this.tip.replaceChildren(el("strong", {}, `${path.name}${seeds}`), el("br"),
      `sweep ${path.first + i * path.step}`, el("br"),
      ...(error === null ? [] : [`${formatLength(error)} from the truth, seen from above`, el("br")]),
      el("span", { class: "muted" }, `x ${formatNumber(path.x[i])} m, y ${formatNumber(path.y[i])} m`));
    const left = hit.x + 14 + this.tip.offsetWidth > this.width ? hit.x - 14 - this.tip.offsetWidth : hit.x + 14;
    this.tip.style.left = `${Math.max(4, left)}px`;
    this.tip.style.top = `${Math.max(4, hit.y - this.tip.offsetHeight - 8)}px`;
  }

  listen() {
    const c = this.canvas;
    const pointers = new Map();
    const position = (event) => {
      const box = c.getBoundingClientRect();
      return [event.clientX - box.left, event.clientY - box.top];
    };
    c.addEventListener("pointerdown", (event) => {
      pointers.set(event.pointerId, position(event));
      if (event.pointerType === "mouse") c.setPointerCapture(event.pointerId);
    });
    c.addEventListener("pointermove", (event) => {
      const now = position(event);
      const before = pointers.get(event.pointerId);
      if (before && pointers.size === 2) this.pinch(pointers, event.pointerId, now);
      else if (before && event.pointerType === "mouse") this.pan(now[0] - before[0], now[1] - before[1]);
      else this.hover(...now);
      if (before) pointers.set(event.pointerId, now);
    });
    const release = (event) => pointers.delete(event.pointerId);
    c.addEventListener("pointerup", release);
    c.addEventListener("pointercancel", release);
    c.addEventListener("pointerleave", () => { this.tip.hidden = true; this.draw(); });
    // The wheel scrolls the page unless the reader has stepped into the picture or holds Ctrl.
    c.addEventListener("wheel", (event) => {
      if (!event.ctrlKey && document.activeElement !== c) return;
      event.preventDefault();
      this.zoomAt(...position(event), Math.exp(-0.0016 * event.deltaY));
    }, { passive: false });
    c.addEventListener("dblclick", (event) => this.zoomAt(...position(event), 2));
    c.addEventListener("keydown", (event) => {
      const step = { ArrowLeft: [40, 0], ArrowRight: [-40, 0], ArrowUp: [0, 40], ArrowDown: [0, -40] }[event.key];
      if (step) this.pan(...step);
      else if (event.key === "+" || event.key === "=") this.zoomAt(this.width / 2, this.height / 2, 1.4);
      else if (event.key === "-") this.zoomAt(this.width / 2, this.height / 2, 1 / 1.4);
      else if (event.key === "0") this.fit();
      else return;
      event.preventDefault();
    });
  }

  pinch(pointers, moved, now) {
    const [other] = [...pointers].filter(([id]) => id !== moved).map(([, at]) => at);
    const before = pointers.get(moved);
    const grow = Math.hypot(now[0] - other[0], now[1] - other[1]) / Math.max(1, Math.hypot(before[0] - other[0], before[1] - other[1]));
    this.zoomAt((now[0] + other[0]) / 2, (now[1] + other[1]) / 2, grow);
    this.pan((now[0] - before[0]) / 2, (now[1] - before[1]) / 2);
  }
}
