// What was measured on what, and the table of wins and losses.

const verdicts = {
  win: ['▲', 'win'],
  loss: ['▼', 'loss'],
  tie: ['≈', 'tie'],
  baseline: ['', 'baseline'],
};

function verdict_chip(verdict) {
  const [sign, word] = verdicts[verdict] ?? ['', verdict ?? nothing];
  return el('span', {class: `verdict ${verdicts[verdict] ? verdict : ''}`}, sign ? `${sign} ${word}` : word);
}

const whole_seconds = x => x >= 120 && x % 60 === 0 ? `${x / 60} min` : `${x} s`;

function budget_text() {
  const {cpu_seconds, seconds: wall, spp} = results.budget ?? {};
  return [
    is_number(cpu_seconds) ? `${whole_seconds(cpu_seconds)} of CPU time` : null,
    is_number(wall) ? `${whole_seconds(wall)} of wall time` : null,
    is_number(spp) ? `${counted(spp, 'sample')} per pixel` : null
  ].filter(Boolean)
             .join(', ') ||
      nothing;
}

function write_head() {
  const {machine = {}, seeds = [], baseline} = results;
  const facts = [
    [
      'Budget',
      `${budget_text()} per method, scene and seed${results.quick ? ' (a quick run: too short for conclusions)' : ''}${
          results.interrupted ? '; interrupted, so some is missing' : ''}`
    ],
    ['Seeds', seeds.length ? `${seeds.length} (${seeds.join(', ')})` : nothing],
    ['Baseline', baseline ?? nothing],
    [
      'Machine',
      [
        machine.cpu, is_number(machine.threads) ? counted(machine.threads, 'thread') : null,
        machine.memory_bytes > 0 ? bytes(machine.memory_bytes) : null, machine.system, machine.compiler
      ].filter(Boolean)
              .join(' · ') ||
          nothing
    ],
    ['Made by', `Ajar ${results.version ?? ''}`],
  ];
  const date = new Date(results.date ?? '');
  document.getElementById('head').append(
      el('div', {class: 'headline'},
         el('div', {}, el('h1', {}, results.title || 'Bench report'),
            el('p', {class: 'date'},
               Number.isNaN(date.getTime()) ? results.date ?? '' :
                                              date.toISOString().slice(0, 16).replace('T', ' ') + ' UTC')),
         el('button', {type: 'button', class: 'theme', title: 'Light or dark', onclick: turn_theme}, '◐')),
      el('dl', {class: 'facts'}, facts.map(([name, value]) => [el('dt', {}, name), el('dd', {}, value)])),
      results.command ? el('pre', {class: 'command'}, results.command) : null);
}

function turn_theme() {
  document.documentElement.dataset.theme = document.documentElement.dataset.theme === 'dark' ? 'light' : 'dark';
}

function follow_system_theme() {
  const dark = matchMedia('(prefers-color-scheme: dark)');
  const follow = () => {
    document.documentElement.dataset.theme = dark.matches ? 'dark' : 'light';
  };
  dark.addEventListener('change', follow);
  follow();
}

const compared = () => scenes.flatMap(
    scene => (scene.methods ?? []).map(method => ({scene, method, summary: method.summary?.relmse ?? {}})));

/** The range that all whiskers of the table share, symmetric about 1. */
function forest_reach() {
  const values = compared()
                     .flatMap(({summary: {error_ratio: r}}) => r ? [r.value, r.low, r.high] : [])
                     .filter(x => is_number(x) && x > 0);
  return Math.max(1.5, ...values.map(x => Math.max(x, 1 / x))) * 1.08;
}

/** Value and whiskers on a logarithmic axis with 1 in its middle. */
function forest(value, reach, class_name) {
  const width = 140, height = 18;
  const at = x => width / 2 * (1 + Math.log(Math.min(Math.max(x, 1 / reach), reach)) / Math.log(reach));
  const root =
      svg('svg', {class: 'forest', width, height, viewBox: `0 0 ${width} ${height}`, 'aria-hidden': 'true'},
          svg('line', {class: 'one', x1: width / 2, x2: width / 2, y1: 0, y2: height}));
  if (!value || !(value.value > 0)) return root;
  if (value.low > 0 && value.high > 0)
    root.append(
        svg('line',
            {class: `whisker ${class_name}`, x1: at(value.low), x2: at(value.high), y1: height / 2, y2: height / 2}));
  root.append(svg('circle', {class: `dot ${class_name}`, cx: at(value.value), cy: height / 2, r: 3.5}));
  return root;
}

/** bound: the truth is at least as far from 1. */
function ratio_cell(value) {
  if (!value) return [nothing];
  return with_range((value.bound ? value.value < 1 ? '≤ ' : '≥ ' : '') + ratio(value.value), value, number);
}

function scene_rows(scene, reach) {
  const methods = scene.methods ?? [];
  const name = span =>
      el('td', {class: 'scene', rowspan: span}, el('a', {href: `#${scene_id(scene)}`}, scene.name ?? nothing));
  if (methods.length === 0)
    return [{
      attributes: {class: 'first'},
      cells: [name(1), el('td', {colspan: 7, class: 'skipped'}, `left out: ${scene.skipped ?? 'no results'}`)]
    }];
  return methods.map((method, i) => {
    const relmse = method.summary?.relmse ?? {}, {slope} = relmse, base = method.verdict === 'baseline';
    const cells = [
      [swatch(method.name), method.name], with_range(number(relmse.median), relmse, number),
      base ? '1' : ratio_cell(relmse.error_ratio),
      base ? forest(null, reach) : forest(relmse.error_ratio, reach, look_of(method.name)),
      base ? '1' : ratio_cell(relmse.time_ratio),
      slope ? with_range(slope_text(slope.value), slope, slope_text) : nothing, verdict_chip(method.verdict)
    ];
    return {
      attributes: {class: i === 0 ? 'first' : ''},
      cells: [...(i === 0 ? [name(methods.length)] : []), ...cells.map(cell => el('td', {}, cell))]
    };
  });
}

/** Per method that is not the baseline: geometric means over the scenes, and how often it won. */
function totals() {
  return method_names
      .map(name => {
        const rows = compared().filter(({method}) => method.name === name && method.verdict !== 'baseline');
        const count = verdict => rows.filter(({method}) => method.verdict === verdict).length;
        const ratios = key => geometric(rows.map(({summary}) => summary[key]?.value));
        return {
          name,
          scenes: rows.length,
          error: ratios('error_ratio'),
          time: ratios('time_ratio'),
          slope: mean(rows.map(({summary}) => summary.slope?.value)),
          wins: count('win'),
          ties: count('tie'),
          losses: count('loss')
        };
      })
      .filter(({scenes: n}) => n > 0);
}

/** A geometric mean; of how many scenes, where not of all n. */
function mean_of(ratios, n) {
  if (!ratios) return nothing;
  const part = ratios.count < n ? el('span', {class: 'range'}, ` of ${ratios.count}`) : null;
  return [el('b', {}, ratio(ratios.mean)), part];
}

function total_rows(reach) {
  return totals().map(({name, scenes: n, error, time, slope, wins, ties, losses}, i, all) => ({
                        attributes: {class: i === 0 ? 'first' : ''},
                        cells:
                            [
                              ...(i === 0 ?
                                      [el('td', {class: 'scene', rowspan: all.length}, 'all scenes, geometric means')] :
                                      []),
                              ...[[swatch(name), name], counted(n, 'scene'),
                                  mean_of(error, n),
                                  error ? forest({value: error.mean}, reach, look_of(name)) : '',
                                  mean_of(time, n),
                                  slope_text(slope), `${wins} ▲  ${ties} ≈  ${losses} ▼`]
                                  .map(cell => el('td', {}, cell))
                            ],
                      }));
}

function headline({name, error, time, wins, ties, losses}) {
  const n = error?.count ?? 0;
  const better = error && error.mean >= 1;
  const figures = error ? ` ${ratio(better ? error.mean : 1 / error.mean)} ${better ? 'less' : 'more'} error than ${
                              results.baseline} ${equal_budget()}` :
                          ' has no ratio to the baseline';
  const times = time ? `, ${ratio(time.mean >= 1 ? time.mean : 1 / time.mean)} ${
                           time.mean >= 1 ? 'less' : 'more'} time to the same error` :
                       '';
  const means = error ? ` (geometric means over ${counted(n, 'scene')})` : '';
  return el(
      'li', {}, swatch(name), el('b', {}, name),
      `: ${figures}${times}${means}; ${wins} won, ${ties} tied, ${losses} lost.`);
}

const equal_budget = () => results.budget?.spp ? 'at the same samples per pixel' : 'at equal time';

function write_summary(main) {
  const reach = forest_reach();
  const head = [
    'Scene', 'Method', 'relMSE', 'Error ratio',
    el('th', {class: 'forest-head'}, el('span', {}, '← worse'), el('span', {}, 'better →')), 'Time ratio', 'Slope',
    'Verdict'
  ];
  main.append(el(
      'section', {id: 'summary'}, el('h2', {}, 'Summary'), el('ul', {class: 'headlines'}, totals().map(headline)),
      el('div', {class: 'wide'},
         table('summary', head, scenes.flatMap(scene => scene_rows(scene, reach)), total_rows(reach))),
      el('p', {class: 'note'},
         'relMSE: mean of (I − R)² / (R² + 0.01) at the end of the budget, median over seeds [quartiles; of fewer ' +
             `than four seeds the extremes]. Error ratio: the baseline's error over this method's ${equal_budget()}, ` +
             'paired by seed. Time ratio: the baseline\'s time over this method\'s to the same error, the larger of the ' +
             'two final ones. Both with their spread; above 1 is better. Slope: of log error against log time; −1 is ' +
             'what an unbiased method without learning has. A tie: the spread of the error ratio covers 1, or a t-test of ' +
             'the ratios does not tell them from 1, or there is one seed.')));
}
