// The true path from above with the stretches in which two methods differ. Geometry first: tested by node.
import { el } from "./dom.js";
import { formatNumber } from "./format.js";
import { isNumber } from "./stats.js";

/** Pieces of the path inside a stretch of time, with the samples beside its ends, so that short ones show. */
export function pieces(path, stretches) {
  return stretches.map((stretch) => {
    let first = path.t.findIndex((t) => t >= stretch.from);
    if (first < 0) return { ...stretch, points: [] };
    let last = first;
    while (last + 1 < path.t.length && path.t[last + 1] <= stretch.to) ++last;
    first = Math.max(0, first - 1);
    const points = [];
    for (let i = first; i <= last; ++i) if (isNumber(path.x[i]) && isNumber(path.y[i])) points.push([path.x[i], path.y[i]]);
    return { ...stretch, points };
  });
}

/** A round length of about a fifth of the width. */
export function scaleLength(width_m) {
  const target = width_m / 5;
  const decade = 10 ** Math.floor(Math.log10(target));
  return [5, 2, 1].map((factor) => factor * decade).find((length) => length <= target) ?? decade;
}

/** Ends of the picture in metres: the path with room around it, never flatter than 1:4. */
export function frame(path) {
  const xs = path.x.filter(isNumber), ys = path.y.filter(isNumber);
  if (xs.length === 0) return null;
  const [x0, x1, y0, y1] = [Math.min(...xs), Math.max(...xs), Math.min(...ys), Math.max(...ys)];
  const size = Math.max(x1 - x0, y1 - y0, 1);
  const margin = 0.08 * size;
  const width = Math.max(x1 - x0, 0.25 * size) + 2 * margin, height = Math.max(y1 - y0, 0.25 * size) + 2 * margin;
  return { x: 0.5 * (x0 + x1) - 0.5 * width, y: 0.5 * (y0 + y1) - 0.5 * height, width, height };
}

const kSvg = "http://www.w3.org/2000/svg";

function svg(tag, attributes, ...children) {
  const node = document.createElementNS(kSvg, tag);
  for (const [name, value] of Object.entries(attributes)) node.setAttribute(name, value);
  node.append(...children);
  return node;
}

/** colorOf(stretch) names a css variable. Lines keep their width however large the drive is. */
export function pathMap(path, stretches, colorOf, wordsOf) {
  const box = frame(path);
  if (!box) return null;
  const place = ([x, y]) => `${(x - box.x).toFixed(3)},${(box.height - (y - box.y)).toFixed(3)}`;
  const points = path.x.map((x, i) => [x, path.y[i]]).filter(([x, y]) => isNumber(x) && isNumber(y));
  const line = (of, attributes) => svg("polyline", { points: of.map(place).join(" "), fill: "none", "vector-effect": "non-scaling-stroke",
    "stroke-linejoin": "round", "stroke-linecap": "round", ...attributes });
  const picture = svg("svg", { viewBox: `0 0 ${box.width} ${box.height}`, class: "pathmap", role: "img", "aria-label": "True path from above" },
    line(points, { class: "way" }));
  for (const piece of pieces(path, stretches)) {
    if (piece.points.length < 2) continue;
    const drawn = line(piece.points, { class: "stretch", style: `stroke: var(${colorOf(piece)})` });
    drawn.append(svg("title", {}, wordsOf(piece)));
    picture.append(drawn);
  }
  const [sx, sy] = place(points[0]).split(",");
  picture.append(svg("path", { d: `M${sx} ${sy}h0`, class: "start", "vector-effect": "non-scaling-stroke", "stroke-linecap": "round" }));
  // Inside the picture, since that is what is scaled.
  const length = scaleLength(box.width), edge = 0.03 * box.width;
  picture.append(svg("path", { d: `M${edge} ${box.height - 0.03 * box.width}h${length}`, class: "scale", "vector-effect": "non-scaling-stroke" }));
  return el("div", { class: "pathmap-wrap" }, picture,
    el("div", { class: "pathmap-legend" }, el("span", {}, el("i", { class: "scale-mark" }), `${formatNumber(length, 1)} m`),
      el("span", {}, el("i", { class: "dot start-dot" }), "start")));
}
