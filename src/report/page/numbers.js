// Numbers as text, and figures of several numbers.

const nothing = '–';
const is_number = x => typeof x === 'number' && Number.isFinite(x);

function power_of_ten(exponent) {
  return '10' + String(exponent).replace('-', '⁻').replace(/\d/g, digit => '⁰¹²³⁴⁵⁶⁷⁸⁹'[digit]);
}

function grouped(x) { return Math.round(x).toString().replace(/\B(?=(\d{3})+$)/g, ' ').replace('-', '−'); }

/** "1 scene", "2 scenes", "12 345 scenes". */
function counted(n, what) { return `${grouped(n)} ${what}${n === 1 ? '' : 's'}`; }

/** Three digits that count: 0.0123, 1.23, 12 300, 1.23·10⁻⁵. */
function number(x, digits = 3) {
  if (!is_number(x)) return nothing;
  if (x === 0) return '0';
  const exponent = Math.floor(Math.log10(Math.abs(Number(x.toPrecision(digits)))));
  if (exponent < -3 || exponent > 5)
    return `${(x / 10 ** exponent).toFixed(digits - 1)}·${power_of_ten(exponent)}`.replace('-', '−');
  if (exponent >= digits - 1) return grouped(Number(x.toPrecision(digits)));
  return x.toFixed(digits - 1 - exponent).replace('-', '−');
}

function slope_text(x) { return is_number(x) ? x.toFixed(2).replace('-', '−') : nothing; }

function ratio(x) { return is_number(x) ? `${number(x)}×` : nothing; }

function seconds(x) {
  if (!is_number(x)) return nothing;
  if (x >= 6000) return `${number(x / 3600)} h`;
  return x >= 0.1 || x === 0 ? `${number(x)} s` : `${number(x * 1000)} ms`;
}

function bytes(x) {
  if (!is_number(x)) return nothing;
  for (const [unit, size] of [['GB', 1e9], ['MB', 1e6], ['kB', 1e3]])
    if (x >= size) return `${number(x / size)} ${unit}`;
  return `${grouped(x)} B`;
}

function millions(x) {
  if (!is_number(x)) return nothing;
  return x >= 1e9 ? `${number(x / 1e9)} G` : x >= 1e6 ? `${number(x / 1e6)} M` : grouped(x);
}

function percent(x) { return is_number(x) ? `${number(100 * x)} %` : nothing; }

/** "1.23 [1.10, 1.31]" as two elements; the range is left out where there is none. */
function with_range(text, {low, high}, format) {
  const range = is_number(low) && is_number(high) && low !== high;
  return [el('b', {}, text), range ? el('span', {class: 'range'}, ` [${format(low)}, ${format(high)}]`) : null];
}

const sorted = values => [...values].sort((a, b) => a - b);

/** Of sorted values, of which the last may be infinite; interpolated between neighbours. */
function quantile(values, q) {
  const at = q * (values.length - 1), i = Math.floor(at);
  return at === i || values[i] === values[i + 1] ? values[i] : values[i] + (at - i) * (values[i + 1] - values[i]);
}

/** Median with quartiles, of fewer than four values with the least and the greatest; null of none. */
function spread(values) {
  if (values.length === 0) return null;
  const v = sorted(values), few = v.length < 4;
  return {median: quantile(v, 0.5), low: quantile(v, few ? 0 : 0.25), high: quantile(v, few ? 1 : 0.75)};
}

function mean(values) {
  const known = values.filter(is_number);
  return known.length ? known.reduce((a, b) => a + b, 0) / known.length : null;
}

/** {mean, deviation} of the logarithms, as factors; null where there is no positive value. */
function geometric(values) {
  const logs = values.filter(x => is_number(x) && x > 0).map(Math.log);
  if (logs.length === 0) return null;
  const centre = mean(logs), square = mean(logs.map(x => (x - centre) ** 2));
  return {mean: Math.exp(centre), deviation: Math.exp(Math.sqrt(square)), count: logs.length};
}
