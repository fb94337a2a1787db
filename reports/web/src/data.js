// The data block as figures want it. No DOM here: tested by node.

/** Series that share their x name it by its number: put it back in its place. */
export function unpack(data) {
  const grids = data.grids ?? [];
  const fill = (all) => {
    for (const series of Object.values(all)) if (typeof series.x === "number") series.x = grids[series.x];
  };
  data.runs.forEach((run) => fill(run.series));
  Object.values(data.truth).forEach(fill);
  return data;
}
