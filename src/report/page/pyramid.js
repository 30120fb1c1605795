// What single strategies (s, t) bring and cost, and pictures of learned fields; made when they are asked for.

/** An on-demand part; fill(box) runs when it is first opened. */
function drawer(title, class_name, fill) {
  const box = el('div', {class: 'drawer'}), details = el('details', {class: class_name}, el('summary', {}, title), box);
  details.addEventListener('toggle', () => {
    if (details.open) fill(box);
  }, {once: true});
  return details;
}

function energy({red, green, blue, scale}) {
  let sum = 0;
  for (let i = 0; i < red.length; ++i) {
    const value = scale * luminance([half_values[red[i]], half_values[green[i]], half_values[blue[i]]]);
    if (Number.isFinite(value)) sum += value;
  }
  return sum / red.length;
}

/** Rows of paths of one length, as in Veach's figures: s grows to the right; merges, whose vertex in common counts on
 * both sides, behind the joins. */
async function draw_pyramid(method, kind, exposure, box) {
  const techniques = method.techniques.filter(technique => technique[kind] && files[technique[kind]]);
  const images = await Promise.all(techniques.map(technique => load(technique[kind])));
  const means = images.map(energy), all = means.reduce((a, b) => a + b, 0);
  const rows = new Map();
  techniques.forEach(({s, t, merged}, i) => {
    const edges = s + t - (merged ? 2 : 1), letter = merged ? 'm' : 's';
    const image = images[i], canvas = el('canvas', {
                               width: image.width,
                               height: image.height,
                               'aria-label': `${letter} = ${s}, t = ${t}`,
                               'data-strategy': merged ? `m${s} ${t}` : `${s} ${t}`
                             });
    canvas.getContext('2d').putImageData(toned(image, exposure), 0, 0);
    const share = all > 0 ? means[i] / all : 0;
    const cell =
        el('figure',
           {title: `${s} light and ${t} camera vertices${merged ? ', merged' : ''}; mean luminance ${number(means[i])}`},
           canvas,
           el('figcaption', {}, `${letter} ${s}, t ${t}`,
              kind === 'weighted' ? el('span', {class: 'range'}, ` ${share === 0 ? '0' : percent(share)}`) : null));
    canvas.addEventListener('click', () => cell.classList.toggle('large'));
    if (!rows.has(edges)) rows.set(edges, []);
    rows.get(edges).push({order: s + (merged ? 100 : 0), cell});
  });
  box.replaceChildren(
      ...[...rows]
          .sort(([a], [b]) => a - b)
          .map(
              ([edges, cells]) =>
                  el('div', {class: 'pyramid-row'}, el('span', {class: 'label'}, `${edges} edge${edges === 1 ? '' : 's'}`),
                     cells.sort((a, b) => a.order - b.order).map(({cell}) => cell))));
}

function fill_pyramid(methods, box) {
  const state = {method: methods[0], kind: 'weighted', exposure: 0};
  const rows = el('div', {class: 'pyramid'}), text = el('output', {}, '0.0 stops');
  const draw = () => draw_pyramid(state.method, state.kind, state.exposure, rows);
  const set = change => {
    Object.assign(state, change);
    draw();
  };
  const exposure =
      slider('Exposure of the strategies', {min: -8, max: 12, step: 0.5, value: 0, name: 'exposure'}, value => {
        text.textContent = `${value > 0 ? '+' : ''}${value.toFixed(1)} stops`.replace('-', '−');
        set({exposure: value});
      });
  const raw = methods.some(({techniques}) => techniques.some(technique => technique.raw));
  box.append(
      el('div', {class: 'tools'},
         methods.length > 1 ?
             switcher('Method', methods.map(({name}, i) => [String(i), name]), '0', i => set({method: methods[i]})) :
             el('span', {}, swatch(methods[0].name), methods[0].name),
         raw ? switcher('Show', [['weighted', 'Weighted'], ['raw', 'Raw']], 'weighted', kind => set({kind})) : null,
         labelled('Exposure', exposure, text)),
      el('div', {class: 'wide'}, rows),
      el('p', {class: 'note'},
         'One picture for each number s of light and t of camera vertices; a row has the paths of one length, ' +
             'merges (m) behind joins (s). ' +
             'Weighted: what it adds to the image, with its share of the light; ' +
             'raw: its own estimate of all of it. Click a picture to enlarge it.'));
  draw();
}

function fill_fields(methods, box) {
  for (const {name, fields} of methods)
    box.append(
        el('h4', {}, swatch(name), name),
        el('div', {class: 'fields'},
           fields.filter(({image}) => image && files[image])
               .map(
                   ({title, image}) =>
                       el('figure', {}, el('img', {src: `data:image/png;base64,${raw_text(image)}`, alt: title ?? ''}),
                          el('figcaption', {}, title ?? '')))));
}

/** A row for each strategy, the methods side by side; means over the seeds. */
function fill_shares(scene, methods, box) {
  const all_of = ({runs}) => runs.flatMap(run => run.strategies ?? []);
  const keys =
      [...new Set(methods.flatMap(all_of).map(({s, t}) => `${s} ${t}`))].map(key => key.split(' ').map(Number));
  keys.sort(([s, t], [s2, t2]) => s + t - s2 - t2 || s - s2);
  const name = x => x < 8 ? String(x) : '8+';
  const pixels = scene.width * scene.height;
  const of_method = (method, s, t) => {
    const rows = method.runs.map(run => run.strategies?.find(row => row.s === s && row.t === t));
    const share = key => {
      const value = mean(rows.map(row => row?.[key] ?? 0));
      return value === 0 ? '0' : `${number(100 * value, 2)} %`;
    };
    if (!rows.some(Boolean)) return [nothing, nothing, nothing, nothing];
    const sum = key => rows.reduce((total, row) => total + (row?.[key] ?? 0), 0);
    const samples = method.runs.reduce((total, run) => total + samples_of(run, pixels), 0);
    const rays = sum('rays');
    return [
      share('energy'), share('time'), number(rays / samples, 2),
      rays > 0 ? `${number(100 * sum('visible') / rays, 2)} %` : nothing
    ];
  };
  box.append(
      el('div', {class: 'wide'},
         table(
             'shares',
             ['s, t', ...methods.flatMap(({name}) => [[swatch(name), `${name}: light`], 'time', 'rays', 'see'])],
             keys.map(([s, t]) => [`${name(s)}, ${name(t)}`, ...methods.flatMap(method => of_method(method, s, t))]))),
      el('p', {class: 'note'},
         'Joins of s light and t camera vertices: their share of the light in the image, of the time of tracing, ' +
             'their shadow rays per sample, and how many of these see the other end. ' +
             'One sample in 256 is timed, part by part; walks and learning have the rest of the time.'));
}

function write_strategies(scene, parent) {
  const methods = scene.methods ?? [];
  const with_shares = methods.filter(({runs}) => runs?.some(({strategies}) => strategies?.length));
  if (with_shares.length)
    parent.append(drawer('What strategies bring and cost', 'share', box => fill_shares(scene, with_shares, box)));
  const with_techniques =
      methods.filter(({techniques}) => techniques?.some(({weighted}) => weighted && files[weighted]));
  const with_fields = methods.filter(({fields}) => fields?.some(({image}) => image && files[image]));
  if (with_techniques.length)
    parent.append(drawer('Strategies (s, t)', 'strategies', box => fill_pyramid(with_techniques, box)));
  if (with_fields.length) parent.append(drawer('Learned fields', 'learned', box => fill_fields(with_fields, box)));
}
