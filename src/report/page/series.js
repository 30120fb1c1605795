// Errors against time: what is shown, and the curves of a method.

const metrics = {
  relmse: {name: 'relMSE', of: sample => sample.relmse},
  mse: {name: 'MSE', of: sample => sample.mse},
  relmse_trimmed: {name: 'relMSE, trimmed', of: sample => sample.relmse_trimmed},
  mape: {name: 'MAPE', of: sample => sample.mape},
  ssim: {name: '1 − SSIM', of: sample => is_number(sample.ssim) ? 1 - sample.ssim : null},
};
const clocks = {
  cpu_seconds: {name: 'CPU time', title: 'time', unit: 's', text: seconds},
  seconds: {name: 'Wall time', title: 'time', unit: 's', text: seconds},
  spp: {name: 'Samples per pixel', title: 'samples', unit: '', text: x => `${number(x)} spp`},
};

/** What the budget is given in: all seeds end there, and so the curves end at the errors of the tables. */
function clock_of_budget() { return ['spp', 'seconds'].find(key => is_number(results.budget?.[key])) ?? 'cpu_seconds'; }

// What all plots show; watchers are called when it changes.
const shown = {
  metric: 'relmse',
  clock: clock_of_budget(),
  seeds: false,
  watchers: []
};

function show(change) {
  Object.assign(shown, change);
  for (const watcher of shown.watchers) watcher();
}

const all_samples = scenes.flatMap(
    scene => (scene.methods ?? []).flatMap(method => (method.runs ?? []).flatMap(run => run.samples ?? [])));

/** The [key, name] pairs of a table that some sample has positive values of. */
function present(choices, of) {
  return Object.entries(choices)
      .filter(([key]) => all_samples.some(sample => of(key, sample) > 0))
      .map(([key, {name}]) => [key, name]);
}

/** Points {t, e} of each seed, in the order of time; only what has a logarithm. */
function seed_curves(method) {
  const {of} = metrics[shown.metric];
  return (method.runs ?? [])
      .map(run => ({
             seed: run.seed,
             points: (run.samples ?? [])
                         .map(sample => ({t: sample[shown.clock], e: of(sample)}))
                         .filter(({t, e}) => is_number(t) && is_number(e) && t > 0 && e > 0)
                         .sort((a, b) => a.t - b.t),
           }))
      .filter(({points}) => points.length > 0);
}

/** A straight line between points in logarithms; null outside of them. */
function error_at(points, t) {
  const i = points.findIndex(point => point.t >= t);
  if (i < 0) return null;
  if (i === 0) return points[0].t === t ? points[0].e : null;
  const a = points[i - 1], b = points[i], share = Math.log(t / a.t) / Math.log(b.t / a.t);
  return a.e * (b.e / a.e) ** share;
}

/** Whether no point has a larger error: the time that time_to gives is one by which it was reached. */
const reached_at_once = (points, error) => points.every(point => point.e <= error);

/** The time from which on the error is no larger, between points as above; Infinity if it ends larger. */
function time_to(points, error) {
  if (points.at(-1).e > error) return Infinity;
  const i = points.findLastIndex(point => point.e > error) + 1;
  if (i === 0) return points[0].t;
  const a = points[i - 1], b = points[i], share = Math.log(error / a.e) / Math.log(b.e / a.e);
  return a.t * (b.t / a.t) ** share;
}

function log_steps(low, high, count) {
  return Array.from(
      {length: count},
      (_, i) => i === 0   ? low :
          i === count - 1 ? high :
                            low * (high / low) ** (i / (count - 1)));
}

/** Points {t, median, low, high} over the seeds, where all of them have been measured. */
function median_curve(seeds) {
  if (seeds.length === 0) return [];
  const low = Math.max(...seeds.map(({points}) => points[0].t)),
        high = Math.min(...seeds.map(({points}) => points.at(-1).t));
  const times = seeds.length === 1 || !(low < high) ? seeds[0].points.map(({t}) => t) : log_steps(low, high, 64);
  return times.map(t => ({t, ...spread(seeds.map(({points}) => error_at(points, t)).filter(is_number))}));
}

/** The curve's values at a time; null outside. */
function curve_at(curve, t) {
  const of = key => error_at(curve.map(point => ({t: point.t, e: point[key]})), t);
  const median = of('median');
  return median === null ? null : {median, low: of('low'), high: of('high')};
}
