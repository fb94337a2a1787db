// Numbers as people read them. No DOM here: tested by node.

/** Three significant digits, no exponent between 0.0001 and 1e6; null and NaN are "n/a". */
export function formatNumber(value, digits = 3) {
  if (value === null || value === undefined || Number.isNaN(value)) return "n/a";
  if (!Number.isFinite(value)) return value > 0 ? "∞" : "−∞";
  if (value === 0) return "0";
  const size = Math.abs(value);
  if (size < 1e-4 || size >= 1e6) {
    const [mantissa, exponent] = value.toExponential(digits - 1).split("e");
    return minus(`${Number(mantissa)}e${Number(exponent)}`);
  }
  const decimals = Math.max(0, digits - 1 - Math.floor(Math.log10(size)));
  return minus(value.toFixed(Math.min(decimals, 12)));
}

/** A tick label: as few digits as the step between ticks needs. */
export function formatTick(value, step) {
  if (value === 0) return "0";
  const size = Math.abs(value);
  if (size < 1e-4 || size >= 1e5) return formatNumber(value, 1);
  let decimals = 0;  // 0.25 needs two of them, though it is above 0.1
  while (decimals < 6 && Math.abs(step * 10 ** decimals - Math.round(step * 10 ** decimals)) > 1e-6 * step * 10 ** decimals) ++decimals;
  return minus(value.toFixed(decimals));
}

/** Ticks of a logarithmic axis: 1, 2, 5 over few decades, powers of ten over many. */
export function logTicks(min, max) {
  if (!(min > 0) || !(max >= min)) return [];
  const from = Math.floor(Math.log10(min) - 1e-9);
  const to = Math.ceil(Math.log10(max) + 1e-9);
  const factors = max / min > 2000 ? [1] : [1, 2, 5];
  const ticks = [];
  for (let decade = from; decade <= to; ++decade) {
    for (const factor of factors) {
      const tick = Number(`${factor}e${decade}`);
      if (tick >= min * (1 - 1e-9) && tick <= max * (1 + 1e-9)) ticks.push(tick);
    }
  }
  return ticks;
}

/** A length with a unit that suits it: 0.0123 m -> "1.23 cm". */
export function formatLength(metres) {
  if (metres === null || metres === undefined || Number.isNaN(metres)) return "n/a";
  const size = Math.abs(metres);
  if (size === 0) return "0 m";
  if (size < 0.01) return `${formatNumber(metres * 1000)} mm`;
  if (size < 1) return `${formatNumber(metres * 100)} cm`;
  return `${formatNumber(metres)} m`;
}

/** "0.19–0.23"; one number when both ends read the same. */
export function formatRange([low, high]) {
  const [from, to] = [formatNumber(low), formatNumber(high)];
  return from === to ? from : `${from}–${to}`;
}

/** "position error [m]" -> ["position error", "m"]; the unit 1 is none. */
export function splitLabel(label) {
  const match = /^(.*?)\s*\[([^\]]*)\]\s*$/.exec(label ?? "");
  return match ? [match[1], match[2] === "1" ? "" : match[2]] : [label ?? "", ""];
}

export function capitalize(text) {
  return text ? text[0].toUpperCase() + text.slice(1) : text;
}

function minus(text) {
  return text.replace("-", "−").replace("e−", "e-");
}
