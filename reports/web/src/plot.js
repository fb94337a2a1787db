// One chart: lines over a common x, with zoom, a readout that follows the pointer, and a logarithmic axis on demand.
import uPlot from "uplot";
import { cssColor, el } from "./dom.js";
import { capitalize, formatNumber, formatTick, logTicks, splitLabel } from "./format.js";
import { isNumber, nearestIndex } from "./stats.js";

const kFont = '11.5px "Inter", ui-sans-serif, system-ui, "Helvetica Neue", Arial, sans-serif';

/** Worth a logarithmic axis: the lines' typical sizes are more than a factor 8 apart. */
export function wantsLog(lines) {
  const sizes = lines.map((line) => {
    const positive = line.y.filter((value) => isNumber(value) && value > 0).sort((a, b) => a - b);
    return positive[positive.length >> 1];
  }).filter(isNumber);
  return sizes.length > 1 && Math.max(...sizes) > 8 * Math.min(...sizes);
}

/**
 * lines: [{name, color (css variable), x, y, low?, high?, width?, dash?, dots?: points without a line, steps?: no points}].
 * options: {xLabel, yLabel, sync?, height, bare?: no label below,
 *   log?: "never" | "linear" at first | "log" at first | "outside": as setLog says; default: as the lines need,
 *   range?, logRange?: () => [low, high] of an axis that charts share,
 *   shades?: () => [{from, to, color}] stretches of x behind the lines}
 */
export class Chart {
  constructor(options) {
    this.options = options;
    this.lines = [];
    this.log = null;  // null: not chosen by the reader yet
    this.readout = el("div", { class: "readout", "aria-live": "off" });
    this.box = el("div", { class: "plot", style: { height: `${options.height}px` } });
    this.reset = el("button", { type: "button", class: "quiet", hidden: true, onclick: () => this.zoom(null) }, "Reset zoom");
    this.axisButton = options.log === "never" || options.log === "outside" ? null
      : el("button", { type: "button", class: "quiet", onclick: () => { this.log = !this.isLog(); this.build(); } });
    this.element = el("div", { class: "chart" },
      el("div", { class: "chart-bar" }, this.readout,
        el("span", { class: "chart-tools" }, this.reset, this.axisButton)),
      this.box);
    this.installKeys();
    new ResizeObserver(() => this.resize()).observe(this.box);
  }

  isLog() {
    return this.log ?? (this.options.log === "log" || (this.options.log === undefined && wantsLog(this.lines)));
  }

  /** For charts with log: "outside". */
  setLog(log) {
    this.log = log;
    this.build();
  }

  /** New axes: other labels, and what was zoomed into is gone. */
  setLabels(xLabel, yLabel) {
    Object.assign(this.options, { xLabel, yLabel });
    this.reset.hidden = true;
  }

  setLines(lines) {
    this.lines = lines.filter((line) => line && line.x.length > 0);
    this.build();
  }

  build() {
    const kept = this.plot && !this.reset.hidden ? { ...this.plot.scales.x } : null;
    this.plot?.destroy();
    this.plot = null;
    this.box.replaceChildren();
    if (this.axisButton) {
      this.axisButton.textContent = this.isLog() ? "Linear axis" : "Log axis";
      this.axisButton.hidden = this.lines.length === 0;
    }
    if (this.lines.length === 0) {
      this.readout.textContent = "";
      this.box.append(el("p", { class: "empty" }, "Nothing to draw: no chosen estimator has these values."));
      return;
    }
    this.plot = new uPlot(this.config(), this.table(), this.box);
    this.box.append(...this.note());
    this.showReadout(null);
    if (kept) this.plot.setScale("x", { min: kept.min, max: kept.max });
  }

  note() {
    return [];
  }

  /** Columns for uPlot: every line's band and line on the union of all x. */
  table() {
    const usable = this.isLog() ? (value) => (isNumber(value) && value > 0 ? value : null)
      : (value) => (isNumber(value) ? value : null);
    const tables = [];
    for (const line of this.lines) {
      const columns = [line.x, line.y.map(usable)];
      if (line.low) columns.push(line.low.map(usable), line.high.map(usable));
      tables.push(columns);
    }
    return uPlot.join(tables, tables.map((columns) => columns.map(() => 2)));
  }

  config() {
    const [xName, xUnit] = splitLabel(this.options.xLabel);
    const series = [{}];
    const bands = [];
    for (const line of this.lines) {
      const color = cssColor(line.color);
      const width = line.width ?? 1.6;
      series.push(line.dots
        ? { stroke: `${color}99`, width: 0, paths: () => null, points: { show: true, size: 3.5, fill: `${color}80`, width: 0 } }
        : { stroke: color, width, dash: line.dash, points: { show: !line.dash && !line.steps && line.x.length < 60, size: 4, fill: color, width: 0 }, spanGaps: false });
      if (line.low) {
        const at = series.length;
        for (let k = 0; k < 2; ++k) series.push({ stroke: "transparent", width: 0, points: { show: false } });
        bands.push({ series: [at + 1, at], fill: `${color}26` });
      }
    }
    return {
      width: this.box.clientWidth || 320,
      height: this.options.height,
      series, bands,
      legend: { show: false },
      padding: [8, 10, 0, 0],
      cursor: {
        sync: this.options.sync ? { key: this.options.sync } : undefined,
        drag: { x: true, y: false, uni: 20 },
        points: { size: 7, width: 1.5 },
        y: false,
      },
      scales: { x: { time: false }, y: this.yScale() },
      axes: [this.axis(this.options.bare ? { size: 24 } : { label: [capitalize(xName), xUnit].filter(Boolean).join(", "), size: 34, labelSize: 18 }), this.yAxis()],
      hooks: {
        drawClear: this.options.shades ? [(plot) => this.drawShades(plot)] : [],
        setCursor: [(plot) => this.showReadout(plot.cursor.left >= 0 ? plot.posToVal(plot.cursor.left, "x") : null)],
        setScale: [(plot, key) => { if (key === "x") this.reset.hidden = this.isWhole(plot); }],
      },
    };
  }

  drawShades(plot) {
    const g = plot.ctx;
    g.save();
    for (const { from, to, color } of this.options.shades()) {
      const left = Math.max(plot.valToPos(from, "x", true), plot.bbox.left);
      const right = Math.min(plot.valToPos(to, "x", true), plot.bbox.left + plot.bbox.width);
      if (!(right > left)) continue;
      g.fillStyle = `${cssColor(color)}26`;
      g.fillRect(left, plot.bbox.top, Math.max(right - left, 1), plot.bbox.height);
    }
    g.restore();
  }

  axis(extra) {
    return {
      stroke: cssColor("--muted"), font: kFont, labelFont: kFont, gap: 5,
      grid: { stroke: cssColor("--grid"), width: 1 },
      ticks: { stroke: cssColor("--line"), width: 1, size: 4 },
      values: (_, splits) => splits.map((v, i) => (v === null ? "" : formatTick(v, Math.abs((splits[i + 1] ?? v) - (splits[i] ?? v)) || splits[1] - splits[0]))),
      ...extra,
    };
  }

  yAxis() {
    const extra = { size: 48, space: 26 };
    if (this.isLog()) {
      extra.splits = (_, __, min, max) => logTicks(min, max);
      extra.values = (_, splits) => splits.map((v) => (v === null ? "" : formatNumber(v, 1)));
      extra.filter = (_, splits) => splits;
    }
    return this.axis(extra);
  }

  yScale() {
    if (!this.isLog()) {
      if (this.options.range) return { range: () => this.options.range() };
      return { range: (_, min, max) => {
        const low = Math.min(0, min);
        const margin = 0.06 * (max - low) || 1e-6;
        return [low < 0 ? low - margin : low, max + margin];
      } };
    }
    if (this.options.logRange) return { distr: 3, range: () => this.options.logRange() };
    return { distr: 3, range: (_, min, max) => (min > 0 ? [min / 1.4, max * 1.4] : [0.1, 10]) };
  }

  isWhole(plot) {
    const [min, max] = [plot.data[0][0], plot.data[0][plot.data[0].length - 1]];
    return plot.scales.x.min <= min && plot.scales.x.max >= max;
  }

  /** Values at the pointer; without one, what the axis shows. Always one line high: nothing jumps. */
  showReadout(x) {
    const [yName, yUnit] = splitLabel(this.options.yLabel);
    if (x === null || x === undefined || Number.isNaN(x)) {
      this.readout.replaceChildren(el("span", { class: "axis-name" }, [capitalize(yName), yUnit].filter(Boolean).join(", ")));
      return;
    }
    const [, xUnit] = splitLabel(this.options.xLabel);
    const values = this.lines.map((line) => {
      const y = line.y[nearestIndex(line.x, x)];
      return el("span", { class: "value" }, el("i", { class: "dot", style: { background: `var(${line.color})` } }),
        el("span", { class: "sr" }, `${line.name} `), formatNumber(y));
    });
    this.readout.replaceChildren(el("span", { class: "at" }, `${formatNumber(x)}${xUnit ? ` ${xUnit}` : ""}`), ...values,
      el("span", { class: "axis-name" }, yUnit));
  }

  zoom(span) {
    if (!this.plot) return;
    const x = this.plot.data[0];
    const [min, max] = span ?? [x[0], x[x.length - 1]];
    this.plot.setScale("x", { min, max });
  }

  resize() {
    if (this.plot && this.box.clientWidth > 0 && this.plot.width !== this.box.clientWidth) {
      this.plot.setSize({ width: this.box.clientWidth, height: this.options.height });
    }
  }

  /** Arrow keys walk along the lines, + and - zoom, 0 shows all; a finger walks too. */
  installKeys() {
    this.box.tabIndex = 0;
    this.box.setAttribute("role", "application");
    this.box.setAttribute("aria-label",
      `${splitLabel(this.options.yLabel)[0]} over ${splitLabel(this.options.xLabel)[0]}. Arrow keys read values, plus and minus zoom, zero shows all.`);
    let left = 0;
    this.box.addEventListener("keydown", (event) => {
      if (!this.plot) return;
      const width = this.plot.over.clientWidth;
      const scale = this.plot.scales.x;
      const zoomBy = (factor) => {
        const middle = this.plot.posToVal(left || width / 2, "x");
        this.zoom([middle - (middle - scale.min) * factor, middle + (scale.max - middle) * factor]);
      };
      if (event.key === "ArrowRight" || event.key === "ArrowLeft") {
        left = Math.min(width - 1, Math.max(1, left + (event.key === "ArrowRight" ? 6 : -6)));
        this.plot.setCursor({ left, top: this.plot.over.clientHeight / 2 });
      } else if (event.key === "+" || event.key === "=") zoomBy(0.6);
      else if (event.key === "-") zoomBy(1 / 0.6);
      else if (event.key === "0") this.zoom(null);
      else return;
      event.preventDefault();
    });
    this.box.addEventListener("touchmove", (event) => {
      if (!this.plot || event.touches.length !== 1) return;
      const area = this.plot.over.getBoundingClientRect();
      this.plot.setCursor({ left: event.touches[0].clientX - area.left, top: event.touches[0].clientY - area.top });
    }, { passive: true });
  }
}
