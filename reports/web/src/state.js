// What the reader has chosen; figures listen.

export function createState(data) {
  const listeners = [];
  const hidden = new Set();
  const state = {
    data,
    hasTruth: Object.values(data.truth).some((series) => series.path_true),
    seed: data.seeds.length > 1 ? "all" : data.seeds[0],
    isVisible: (estimator) => !hidden.has(estimator),
    toggle(estimator) {
      if (!hidden.delete(estimator)) hidden.add(estimator);
      state.changed("visible");
    },
    only(estimator) {
      const alone = data.estimators.every((name) => (name === estimator) !== hidden.has(name));
      hidden.clear();
      if (!alone) for (const name of data.estimators) if (name !== estimator) hidden.add(name);
      state.changed("visible");
    },
    setSeed(seed) {
      state.seed = seed;
      state.changed("seed");
    },
    listen: (listener) => listeners.push(listener),
    changed: (what) => listeners.forEach((listener) => listener(what)),
    /** Runs of one estimator that the chosen seed selects. */
    runs: (estimator) => data.runs.filter(
      (run) => run.estimator === estimator && (state.seed === "all" || run.seed === state.seed)),
    color: (estimator) => `--c${data.estimators.indexOf(estimator) % 8}`,
  };
  return state;
}
