// Stills of the scene and of the maps.
import { el } from "./dom.js";
import { figure } from "./figures.js";
import { formatNumber } from "./format.js";

export function pictureNote(state) {
  const note = state.data.pictures.note;
  return note ? el("p", { class: "note", role: "note" }, note) : null;
}

function image(picture, alt) {
  return el("img", { class: "still", src: picture.src, width: picture.width_px, height: picture.height_px, alt });
}

/** A small picture that fills the window when asked to. */
function enlargeable(picture, alt) {
  return el("button", { type: "button", class: "enlarge", "aria-label": `${alt}: enlarge`, onclick: () => {
    const dialog = el("dialog", { "aria-label": alt, onclick: () => dialog.close(), onclose: () => dialog.remove() }, image(picture, alt),
      el("button", { type: "button", class: "close" }, "Close"));
    document.body.append(dialog);
    dialog.showModal();
  } }, image(picture, alt));
}

export function overview(state) {
  const picture = state.data.pictures.overview;
  return picture ? image(picture, "The scene seen from the south-west") : null;
}

/** Colours with their errors in centimetres, logarithmic between the ends. */
function colorBar(scale) {
  const ticks = [];
  for (let decade = Math.floor(Math.log10(scale.low_m)); decade <= Math.ceil(Math.log10(scale.high_m)); ++decade) {
    for (const factor of [1, 2, 5]) {
      const value = Number(`${factor}e${decade}`);
      if (value >= scale.low_m * 0.999 && value <= scale.high_m * 1.001) ticks.push(value);
    }
  }
  // The last but one gives way where its label would touch the last one's.
  const last = ticks.length - 1;
  if (last > 1 && Math.log(ticks[last] / ticks[last - 1]) < 0.1 * Math.log(scale.high_m / scale.low_m)) ticks.splice(last - 1, 1);
  const place = (value) => 100 * Math.log(value / scale.low_m) / Math.log(scale.high_m / scale.low_m);
  return el("div", { class: "colorbar", role: "img", "aria-label": `Colours from ${formatNumber(100 * scale.low_m)} to ${formatNumber(100 * scale.high_m)} centimetres` },
    el("span", { class: "axis-name" }, "Point error, cm"),
    el("div", { class: "ramp" },
      el("div", { class: "gradient", style: { background: `linear-gradient(90deg, ${scale.colors.join(", ")})` } }),
      ...ticks.map((value, i) => {
        const at = place(value);
        const text = formatNumber(100 * value, 1);
        const label = i === 0 ? `≤ ${text}` : i === ticks.length - 1 ? `≥ ${text}` : text;
        return el("span", { class: `tick${i % 2 ? " minor" : ""}${i === 0 ? " first" : i === ticks.length - 1 ? " last" : ""}`, style: { left: `${at}%` } }, label);
      })));
}

export function mapGallery(state) {
  const { maps, scale } = state.data.pictures;
  if (!maps?.length) return null;
  const tiles = maps.map((map) => el("div", { class: "map-tile", "data-estimator": map.estimator },
    el("div", { class: "map-title" }, el("i", { class: "dot", style: { background: `var(${state.color(map.estimator)})` } }), map.estimator,
      state.data.seeds.length > 1 ? el("span", { class: "muted" }, `seed ${map.seed}`) : null),
    enlargeable(map, `Map of ${map.estimator}, points coloured by error`)));
  const update = () => tiles.forEach((tile) => { tile.hidden = !state.isVisible(tile.dataset.estimator); });
  state.listen(update);
  return figure("Maps coloured by error",
    "Every dot is a static point where the method put it, coloured by how far that is from the point's true place on one logarithmic scale for all pictures; points on moving things are left out.",
    colorBar(scale), el("div", { class: `gallery n${maps.length === 1 ? 1 : maps.length === 2 || maps.length === 4 ? 2 : 3}` }, ...tiles));
}
