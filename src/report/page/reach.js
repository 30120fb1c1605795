// The time each method needs to reach an error that the reader chooses.

function time_row({name, seeds, base}, error, baseline) {
  const times = seeds.map(({points}) => time_to(points, error)), there = times.filter(Number.isFinite).length;
  const text = clocks[shown.clock].text;
  const last = Math.max(...seeds.map(({points}) => points.at(-1).t));
  const {median, low, high} = spread(times);
  const sign = seeds.some(({points}) => reached_at_once(points, error)) ? '≤ ' : '';
  const time = median === Infinity ? `not within ${text(last)}` : with_range(sign + text(median), {low, high}, text);
  const some =
      there > 0 && there < seeds.length ? el('span', {class: 'range'}, ` (${there} of ${seeds.length} seeds)`) : null;
  return [[swatch(name), name], [time, some], base ? '1' : gain({seeds, last, median}, error, baseline)];
}

/**
 * Baseline's time over this method's: paired by seed where both got there, a bound where one did, or where one's time
 * is itself a bound; nothing where both are.
 */
function gain({seeds, last, median}, error, baseline) {
  if (!baseline) return nothing;
  if (median === Infinity) return baseline.median === Infinity ? nothing : `< ${ratio(baseline.median / last)}`;
  if (baseline.median === Infinity) return `> ${ratio(baseline.last / median)}`;
  const at_once = ({seeds: of}) => of.some(({points}) => reached_at_once(points, error));
  const soon = at_once({seeds}), sign = soon ? '> ' : at_once(baseline) ? '< ' : '';
  if (soon && at_once(baseline)) return nothing;
  const pairs = seeds
                    .map(({seed, points}) => {
                      const other = baseline.seeds.find(s => s.seed === seed);
                      return other ? time_to(other.points, error) / time_to(points, error) : NaN;
                    })
                    .filter(x => Number.isFinite(x) && x > 0);
  if (pairs.length === 0) return sign + ratio(baseline.median / median);
  const s = spread(pairs);
  return with_range(sign + ratio(s.median), s, x => number(x, 2));
}

function time_table(scene, error) {
  const curves = curves_of(scene), base = curves.find(c => c.base);
  const baseline = base && {
    seeds: base.seeds,
    median: spread(base.seeds.map(({points}) => time_to(points, error))).median,
    last: Math.max(...base.seeds.map(({points}) => points.at(-1).t))
  };
  return table(
      'reach', ['Method', clocks[shown.clock].name, 'Gain'], curves.map(curve => time_row(curve, error, baseline)));
}

/** The range of errors that the slider covers, and where it begins: where all seeds of the baseline end. */
function reach_range(curves) {
  const errors = curves.flatMap(({seeds}) => seeds.flatMap(({points}) => points.map(({e}) => e)));
  const base = curves.find(c => c.base) ?? curves[0];
  return {
    low: Math.min(...errors),
    high: Math.max(...errors),
    start: Math.max(...base.seeds.map(({points}) => points.at(-1).e))
  };
}

/** Plot, legend, slider and table of one scene. */
function write_curves(scene, parent) {
  const plot = el('div', {class: 'plot-box'}), side = el('div', {class: 'side'});
  parent.append(el('div', {class: 'curves'}, plot, side));
  const state = {error: null, low: 1, high: 1};
  const value = el('output', {}), times = el('div', {class: 'wide'});
  const control = slider(
      'Error to reach', {min: 0, max: 1000, step: 1, value: 0, name: 'reach'},
      at => aim(state.low * (state.high / state.low) ** (at / 1000), false));
  function aim(error, move = true) {
    state.error = Math.min(Math.max(error, state.low), state.high);
    if (move)
      control.value = 1000 * Math.log(state.error / state.low) / Math.max(Math.log(state.high / state.low), 1e-9);
    value.textContent = `${metrics[shown.metric].name} ${number(state.error)}`;
    times.replaceChildren(time_table(scene, state.error));
    plot.firstElementChild?.aim_at?.(state.error);
  }
  function draw(width) {
    plot.replaceChildren(draw_curves(scene, width, aim));
    if (state.error !== null) plot.firstElementChild?.aim_at?.(state.error);
  }
  function refresh() {
    const curves = curves_of(scene), {title} = clocks[shown.clock];
    side.replaceChildren();
    state.error = null;
    if (curves.length > 0) {
      Object.assign(state, reach_range(curves));
      side.append(
          el('h4', {}, 'At the end of the budget'), ...legend(scene).filter(Boolean),
          el('h4', {}, `${title[0].toUpperCase()}${title.slice(1)} to reach an error`), labelled('', control, value),
          times,
          el('p', {class: 'note'},
             `Gain: the baseline's ${title} over this method's, paired by seed. Or click on the plot.`));
      aim(state.start);
    }
    if (plot.clientWidth) draw(Math.floor(plot.clientWidth));
  }
  shown.watchers.push(refresh);
  refresh();
  on_width(plot, draw);
}
