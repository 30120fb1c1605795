// What a method's time goes into: bars and a table.

function nice_step(high) {
  const rough = high / 3, power = 10 ** Math.floor(Math.log10(rough));
  return [1, 2, 5, 10].find(k => k * power >= rough) * power;
}

/** rows: {name, parts: [{name, value}], note}; grouped: bars under each other rather than end to end. */
function bar_chart({title, unit, rows, grouped: side_by_side = false, most}, width) {
  const part_names = rows[0].parts.map(({name}) => name);
  const left = Math.min(96, 10 + 6.6 * Math.max(...rows.map(({name}) => Math.min(name.length, 13)))),
        right = 14 + 6.8 * Math.max(...rows.map(({note}) => note.length)), row_height = 30, top = 6;
  const lengths = rows.flatMap(
      ({parts}) =>
          side_by_side ? parts.map(({value}) => value ?? 0) : [parts.reduce((sum, {value}) => sum + (value ?? 0), 0)]);
  const high = most ?? (Math.max(...lengths) || 1), bottom = top + row_height * rows.length;
  const x = value => left + value / high * (width - left - right);
  const root = svg('svg', {
    class: 'bars',
    width,
    height: bottom + 38,
    viewBox: `0 0 ${width} ${bottom + 38}`,
    role: 'img',
    'aria-label': title
  });
  const step = nice_step(high);
  for (let tick = 0; tick <= high * 1.001; tick += step)
    root.append(
        svg('line', {class: 'minor', x1: x(tick), x2: x(tick), y1: top, y2: bottom}),
        svg('text', {x: x(tick), y: bottom + 15, 'text-anchor': 'middle'}, number(tick, 2)));
  rows.forEach(({name, parts, note}, i) => {
    const y = top + i * row_height, tall = side_by_side ? 20 / parts.length : 18;
    root.append(
        svg('text', {x: left - 7, y: y + 19, 'text-anchor': 'end'}, name.length > 13 ? `${name.slice(0, 12)}…` : name));
    let from = 0;
    parts.forEach((part, k) => {
      if (!is_number(part.value)) return;
      const bar = svg('rect', {
        class: `p${k}`,
        x: x(from),
        y: y + (side_by_side ? 5 + k * tall : 6),
        width: Math.max(0, x(from + part.value) - x(from)),
        height: tall,
        onpointermove: event => show_tip(
            event, el('div', {class: 'tip-head'}, name),
            el('div', {}, `${part.name}: ${part.text ?? number(part.value)} ${unit}`)),
        onpointerleave: hide_tip
      });
      root.append(bar);
      if (!side_by_side) from += part.value;
    });
    root.append(
        svg('text',
            {class: 'note', x: x(side_by_side ? Math.max(...parts.map(({value}) => value ?? 0)) : from) + 6, y: y + 19},
            note));
  });
  root.append(
      svg('line', {class: 'axis-line', x1: left, x2: left, y1: top, y2: bottom}),
      svg('text', {class: 'axis', x: (left + width - right) / 2, y: bottom + 32, 'text-anchor': 'middle'}, unit));
  return el(
      'figure', {class: 'bar-chart'},
      el('figcaption', {}, el('b', {}, title),
         el('span', {class: 'keys'},
            part_names.length > 1 ? part_names.map((name, k) => el('span', {}, el('i', {class: `key p${k}`}), name)) :
                                    '\u00a0')),
      root);
}

const sum_of = parts => parts.reduce((sum, {value}) => sum + (value ?? 0), 0);

function parts_of(runs, names, of, text) {
  return Object.entries(names).map(([key, name]) => {
    const value = mean(runs.map(run => of(run, key)));
    return {name, value, text: text && value !== null ? text(value) : undefined};
  });
}

const known = parts => parts.some(({value}) => is_number(value));

/** The charts of a scene whose figures are there, as functions of a width. */
function charts_of(scene) {
  const methods = (scene.methods ?? []).map(({name, runs = []}) => ({name, runs})).filter(({runs}) => runs.length);
  const pixels = scene.width * scene.height;
  const sides = {camera: 'camera', light: 'light', shadow: 'shadow'},
        phases = {trace: 'trace', learn: 'learn', rebuild: 'rebuild'};
  const chart = (make, options) =>
      ({...options, rows: methods.map(({name, runs}) => ({name, ...make(runs)})).filter(({parts}) => known(parts))});
  const charts = [
    chart(
        runs => {
          const parts = parts_of(runs, sides, (run, key) => run.rays?.[key] / samples_of(run, pixels));
          return {parts, note: number(sum_of(parts))};
        },
        {title: 'Rays', unit: 'rays per sample'}),
    chart(
        runs => {
          const total = run => Object.values(run.phases_cpu ?? {}).reduce((a, b) => a + b, 0);
          const parts = parts_of(runs, phases, (run, key) => 100 * run.phases_cpu?.[key] / total(run));
          return {parts, note: seconds(mean(runs.map(total)))};
        },
        {title: 'CPU time', unit: '% of CPU time', most: 100}),
    chart(
        runs => {
          const parts = parts_of(
              runs, {camera: 'camera walks', light: 'light walks', joins: 'joins'},
              (run, key) => 100 * run.tracing?.[key] / (1 - run.tracing?.learn));
          return {parts, note: ''};
        },
        {title: 'Tracing', unit: '% of tracing time', most: 100}),
    chart(
        runs => {
          const parts = parts_of(runs, {camera: 'camera', light: 'light'}, (run, key) => run.mean_path_edges?.[key]);
          return {parts, note: parts.filter(({value}) => value > 0).map(({value}) => number(value, 2)).join(', ')};
        },
        {title: 'Mean length of subpaths', unit: 'edges', grouped: true}),
    chart(
        runs => {
          const parts = parts_of(runs, {zero: 'share'}, run => 100 * run.zero_contribution_paths);
          return {parts, note: `${number(parts[0].value)} %`};
        },
        {title: 'Paths that bring nothing', unit: '% of paths', most: 100}),
  ];
  return charts.filter(({rows}) => rows.length > 0);
}

function cost_table(scene) {
  const figures = [
    ['spp', runs => number(mean(runs.map(run => run.spp)))],
    ['CPU time', runs => seconds(mean(runs.map(run => run.cpu_seconds)))],
    ['Wall time', runs => seconds(mean(runs.map(run => run.seconds)))],
    [
      'Rays per CPU second',
      runs =>
          millions(mean(runs.map(run => Object.values(run.rays ?? {}).reduce((a, b) => a + b, 0) / run.cpu_seconds)))
    ],
    ['Memory peak', runs => bytes(mean(runs.map(run => run.memory_peak_bytes)))],
    ['Fields', runs => bytes(mean(runs.map(run => run.field_bytes)))],
    ['Cells', runs => number(mean(runs.map(run => run.fields?.cells)))],
    ['Strata nodes', runs => number(mean(runs.map(run => run.fields?.nodes.q + run.fields?.nodes.w)))],
    ['Rejected values', runs => grouped(runs.reduce((sum, run) => sum + (run.rejected_values ?? 0), 0))],
  ];
  const rows = (scene.methods ?? [])
                   .filter(({runs = []}) => runs.length)
                   .map(({name, runs}) => [[swatch(name), name], ...figures.map(([, of]) => of(runs))]);
  return rows.length ? el('div', {class: 'wide'}, table('cost', ['Method', ...figures.map(([name]) => name)], rows)) :
                       null;
}

function write_bars(scene, parent) {
  const charts = charts_of(scene), rows = cost_table(scene);
  if (charts.length === 0 && !rows) return;
  const grid = el('div', {class: 'bar-grid'}, charts.map(chart => {
    const box = el('div');
    on_width(box, width => box.replaceChildren(bar_chart(chart, width)));
    return box;
  }));
  parent.append(
      el('h3', {}, 'Cost'), grid, ...(rows ? [rows] : []),
      el('p', {class: 'note'},
         'Means over the seeds; rejected values are a sum, and anything but 0 is a fault. The memory peak is the whole ' +
             'process\'s so far, with all methods and the scenes before, not this method\'s.'));
}
