// The bar that stays in view: what the page holds, and which methods and seeds its figures show.
import { el } from "./dom.js";

export function legend(state) {
  const { data } = state;
  const keys = data.estimators.map((name) => el("button", {
    type: "button", class: "key", "aria-pressed": "true", "data-tip": "Click shows or hides; double click shows this one alone",
    onclick: () => state.toggle(name), ondblclick: () => state.only(name),
  }, el("i", { class: "dot", style: { background: `var(${state.color(name)})` } }), name));
  const truth = state.hasTruth ? el("span", { class: "key fixed" }, el("i", { class: "line-mark" }), "truth") : null;
  const seeds = data.seeds.length > 1 ? el("label", { class: "seeds" }, "Seeds ",
    el("select", { onchange: (event) => state.setSeed(event.target.value === "all" ? "all" : Number(event.target.value)) },
      el("option", { value: "all" }, `all ${data.seeds.length}: median, band`),
      ...data.seeds.map((seed) => el("option", { value: seed }, `seed ${seed}`)))) : null;
  document.querySelector("#legend .bar").append(el("div", { class: "keys" }, ...keys, truth ?? ""), seeds ?? "");
  state.listen(() => data.estimators.forEach((name, i) => keys[i].setAttribute("aria-pressed", state.isVisible(name))));
}

/** One line with a link to each section; the one being read is marked. sections: [{id, title}]. */
export function contents(sections) {
  const nav = document.querySelector("#legend nav");
  const links = new Map(sections.map(({ id, title }) => [id, el("a", { href: `#${id}`, onclick: (event) => {
    event.preventDefault();  // the address keeps what it says of the theme
    document.getElementById(id).scrollIntoView({ behavior: "smooth" });
  } }, title)]));
  nav.append(...links.values());
  const read = () => {
    const line = 0.3 * window.innerHeight;
    const current = sections.filter(({ id }) => document.getElementById(id).getBoundingClientRect().top < line).at(-1)?.id;
    for (const [id, link] of links) {
      if (id === current && !link.hasAttribute("aria-current")) {
        link.setAttribute("aria-current", "true");
        nav.scrollTo({ left: link.offsetLeft - nav.clientWidth / 2 + link.offsetWidth / 2 });
      } else if (id !== current) link.removeAttribute("aria-current");
    }
  };
  let waiting = false;
  window.addEventListener("scroll", () => {
    if (waiting) return;
    waiting = true;
    requestAnimationFrame(() => { waiting = false; read(); });
  }, { passive: true });
  read();
}
