// The error that a render estimates without a reference, against the true one.

function estimates() {
  return scenes.flatMap(
      scene =>
          (scene.methods ?? [])
              .flatMap(
                  method =>
                      (method.runs ?? [])
                          .flatMap(
                              run => (run.samples ?? [])
                                         .filter(({relmse, estimated_relmse}) => relmse > 0 && estimated_relmse > 0)
                                         .map(sample => ({
                                                scene: scene.name,
                                                method: method.name,
                                                seed: run.seed,
                                                ...sample,
                                                ratio: sample.estimated_relmse / sample.relmse
                                              })))));
}

function draw_scatter(points, width) {
  const values = points.flatMap(({relmse, estimated_relmse}) => [relmse, estimated_relmse]);
  const [low, high] = padded(Math.min(...values), Math.max(...values), 1.3), side = Math.min(width, 520);
  const frame = log_frame({
    width: side,
    height: side - 16,
    x: {low, high, name: 'True relMSE, against the reference'},
    y: {low, high, name: 'Estimated relMSE'}
  });
  for (const factor of [1, 2, 0.5])
    frame.layer.append(svg('line', {
      class: factor === 1 ? 'diagonal' : 'guide',
      x1: frame.x(low),
      y1: frame.y(low * factor),
      x2: frame.x(high),
      y2: frame.y(high * factor)
    }));
  frame.layer.append(
      svg('text', {class: 'guide-name', x: frame.x(high / 2) - 12, y: frame.box.top + 16, 'text-anchor': 'end'}, '× 2'),
      svg('text', {class: 'guide-name', x: frame.box.right - 6, y: frame.y(high / 2) + 22, 'text-anchor': 'end'},
          '÷ 2'));
  for (const point of points)
    frame.layer.append(svg('circle', {
      class: `spot ${look_of(point.method)}`,
      cx: frame.x(point.relmse),
      cy: frame.y(point.estimated_relmse),
      r: 2.6
    }));
  frame.root.addEventListener('pointerleave', hide_tip);
  frame.root.addEventListener('pointermove', event => {
    const at = place(frame.root, event);
    const far = point => Math.hypot(frame.x(point.relmse) - at.x, frame.y(point.estimated_relmse) - at.y);
    const near = points.reduce((best, point) => far(point) < far(best) ? point : best);
    if (far(near) > 20) return hide_tip();
    show_tip(
        event, el('div', {class: 'tip-head'}, `${near.scene}, seed ${near.seed}, ${number(near.spp)} spp`),
        el('div', {}, swatch(near.method), near.method),
        el('div', {}, `estimated ${number(near.estimated_relmse)}, true ${number(near.relmse)}: ${ratio(near.ratio)}`));
  });
  return frame.root;
}

function estimate_table(points) {
  const rows = method_names
                   .map(name => {
                     const own = points.filter(({method}) => method === name),
                           g = geometric(own.map(point => point.ratio));
                     if (!g) return null;
                     const near = own.filter(point => point.ratio > 0.5 && point.ratio < 2).length / own.length;
                     return [
                       [swatch(name), name], grouped(own.length), el('b', {}, ratio(g.mean)),
                       `×/÷ ${number(g.deviation)}`, percent(near)
                     ];
                   })
                   .filter(Boolean);
  return table('estimates', ['Method', 'Samples', 'Estimated / true', 'Spread', 'Within ×/÷ 2'], rows);
}

function write_estimates(main) {
  const all = estimates();
  if (all.length === 0) return;
  const box = el('div', {class: 'plot-box'}), side = el('div', {class: 'side'});
  let points = all;
  const draw = () => {
    if (box.clientWidth) box.replaceChildren(draw_scatter(points, Math.floor(box.clientWidth)));
    figures.replaceChildren(estimate_table(points));
  };
  const figures = el('div', {class: 'wide'});
  const choice = el(
      'select', {
        'aria-label': 'Scene',
        onchange: () => {
          points = choice.value === '' ? all : all.filter(({scene}) => scene === scenes[choice.value].name);
          draw();
        }
      },
      el('option', {value: ''}, 'all scenes'),
      scenes.map(
          (scene, i) => all.some(point => point.scene === scene.name) ? el('option', {value: i}, scene.name) : null));
  side.append(
      el('label', {class: 'slider'}, el('span', {class: 'label'}, 'Scene'), choice), figures,
      el('p', {class: 'note'},
         'Every sample of every seed. Estimated / true is a geometric mean, the spread one geometric standard deviation. ' +
             'The estimate comes from the image alone; above the diagonal it is too careful, below too bold. What is called ' +
             'true holds the reference\'s own noise, too, which draws the ratio down where it is large.'));
  main.append(
      el('section', {id: 'estimates'}, el('h2', {}, 'Estimated against true error'),
         el('div', {class: 'curves even'}, box, side)));
  draw();
  on_width(box, draw);
}
