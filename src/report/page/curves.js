// Error against time of one scene, and its legend.

function floor_of(scene) {
  const noise = scene.reference?.relmse;
  return shown.metric === 'relmse' && noise > 0 ? noise : null;
}

/** The curves of a scene's methods for what is shown now. */
function curves_of(scene) {
  return (scene.methods ?? [])
      .map(method => {
        const seeds = seed_curves(method);
        return {name: method.name, method, seeds, curve: median_curve(seeds), base: method.name === results.baseline};
      })
      .filter(({curve}) => curve.length > 0);
}

function ranges(curves, floor) {
  const points = curves.flatMap(({seeds}) => seeds.flatMap(({points: p}) => p));
  const errors = points.map(({e}) => e), times = points.map(({t}) => t);
  let low = Math.min(...errors);
  if (floor !== null && floor > low / 10) low = Math.min(low, floor);
  return {t: padded(Math.min(...times), Math.max(...times), 1.15), e: padded(low, Math.max(...errors), 1.4)};
}

function band(frame, curve) {
  const pixel = key => curve.map(point => [frame.x(point.t), frame.y(point[key])]);
  return `${path_of([...pixel('high'), ...pixel('low').reverse()])}Z`;
}

/** Lines of slope -1, a decade apart: what an error that falls with the inverse of time runs along. */
function draw_guides(frame) {
  const {box} = frame, [from, to] = [frame.value_x(box.left), frame.value_x(box.right)];
  const [low, high] = [frame.value_y(box.bottom), frame.value_y(box.top)];
  const last = Math.ceil(Math.log10(to * high)) - 1;
  for (let k = Math.ceil(Math.log10(from * low)); k <= last; ++k)
    frame.layer.append(svg('path', {
      class: 'guide',
      d: path_of([[frame.x(from), frame.y(10 ** k / from)], [frame.x(to), frame.y(10 ** k / to)]])
    }));
  const t = Math.max(from, 10 ** last / high);
  const x = frame.x(t) + 30, room = x + 60 < box.right;
  frame.layer.append(
      svg('text', {
        class: 'guide-name',
        x: room ? x : box.right - 6,
        y: frame.y(10 ** last / t) + 14,
        'text-anchor': room ? 'start' : 'end'
      },
          'slope −1'));
}

function draw_floor(frame, floor) {
  if (floor === null || floor < frame.value_y(frame.box.bottom)) return;
  const y = frame.y(floor);
  frame.layer.append(
      svg('line', {class: 'floor', x1: frame.box.left, x2: frame.box.right, y1: y, y2: y}),
      svg('text', {class: 'guide-name', x: frame.box.left + 8, y: y - 5}, 'noise of the reference'));
}

/** For a piece of its line before each name; 0 where colours alone tell them apart. */
const room_of_keys = curves => curves.some(({name}) => dash_of(name) > 0) ? 26 : 0;

/** Names at the right ends of the lines, pushed apart where they meet. */
function draw_names(frame, curves) {
  const ends = curves.map(({name, curve}) => ({name, y: frame.y(curve.at(-1).median)})).sort((a, b) => a.y - b.y);
  for (let i = 1; i < ends.length; ++i) ends[i].y = Math.max(ends[i].y, ends[i - 1].y + 14);
  for (let i = ends.length - 1, most = frame.box.bottom; i >= 0; --i, most -= 14) ends[i].y = Math.min(ends[i].y, most);
  const keys = room_of_keys(curves), x = frame.box.right + 6;
  for (const {name, y} of ends) {
    if (keys)
      frame.root.append(svg('line', {class: `key-line ${look_of(name)}`, x1: x, x2: x + keys - 5, y1: y, y2: y}));
    frame.root.append(
        svg('text', {class: `line-name ${look_of(name)}`, x: x + keys, y: y + 4},
            name.length > 14 ? `${name.slice(0, 13)}…` : name));
  }
}

function draw_curves(scene, width, pick) {
  const curves = curves_of(scene), metric = metrics[shown.metric].name, clock = clocks[shown.clock];
  if (curves.length === 0)
    return el('p', {class: 'note'}, `No values of ${metric} against ${clock.name.toLowerCase()}.`);
  const floor = floor_of(scene), {t, e} = ranges(curves, floor);
  const longest = Math.min(14, Math.max(...curves.map(({name}) => name.length)));
  const frame = log_frame({
    width,
    height: Math.max(300, Math.min(460, width * 0.62)),
    right: 14 + 7.2 * longest + room_of_keys(curves),
    x: {low: t[0], high: t[1], name: clock.unit ? `${clock.name} (${clock.unit})` : clock.name},
    y: {low: e[0], high: e[1], name: metric}
  });
  draw_guides(frame);
  draw_floor(frame, floor);
  for (const {name, seeds, curve} of curves) {
    if (seeds.length > 1) frame.layer.append(svg('path', {class: `band ${look_of(name)}`, d: band(frame, curve)}));
    if (shown.seeds && seeds.length > 1)
      for (const {points} of seeds)
        frame.layer.append(
            svg('path', {class: `seed ${look_of(name)}`, d: path_of(points.map(p => [frame.x(p.t), frame.y(p.e)]))}));
  }
  for (const {name, curve} of curves) {
    frame.layer.append(
        svg('path', {class: `line ${look_of(name)}`, d: path_of(curve.map(p => [frame.x(p.t), frame.y(p.median)]))}));
    if (curve.length === 1)
      frame.layer.append(
          svg('circle', {class: `dot ${look_of(name)}`, cx: frame.x(curve[0].t), cy: frame.y(curve[0].median), r: 4}));
  }
  draw_names(frame, curves);
  const aim = svg('line', {class: 'aim', x1: frame.box.left, x2: frame.box.right});
  frame.layer.append(aim);
  frame.root.aim_at = error => {
    aim.setAttribute('y1', frame.y(error));
    aim.setAttribute('y2', frame.y(error));
  };
  follow_pointer(frame, curves, pick);
  return frame.root;
}

function follow_pointer(frame, curves, pick) {
  const rule = svg('line', {class: 'rule', y1: frame.box.top, y2: frame.box.bottom, visibility: 'hidden'});
  const dots = curves.map(({name}) => svg('circle', {class: `dot ${look_of(name)}`, r: 3.5, visibility: 'hidden'}));
  frame.layer.append(rule, ...dots);
  const hide = () => {
    for (const part of [rule, ...dots]) part.setAttribute('visibility', 'hidden');
    hide_tip();
  };
  frame.root.addEventListener('pointerleave', hide);
  frame.root.addEventListener('pointermove', event => {
    const {x, y} = place(frame.root, event);
    if (x < frame.box.left || x > frame.box.right || y < frame.box.top || y > frame.box.bottom) return hide();
    const t = frame.value_x(x), rows = [];
    rule.setAttribute('x1', x);
    rule.setAttribute('x2', x);
    rule.setAttribute('visibility', 'visible');
    curves.forEach(({name, curve}, i) => {
      const value = curve_at(curve, t);
      dots[i].setAttribute('visibility', value ? 'visible' : 'hidden');
      if (!value) return;
      dots[i].setAttribute('cx', x);
      dots[i].setAttribute('cy', frame.y(value.median));
      rows.push({name, ...value});
    });
    rows.sort((a, b) => a.median - b.median);
    show_tip(
        event, el('div', {class: 'tip-head'}, `${metrics[shown.metric].name} at ${clocks[shown.clock].text(t)}`),
        rows.map(row => el('div', {}, swatch(row.name), `${row.name}  `, with_range(number(row.median), row, number))));
  });
  frame.root.addEventListener('click', event => {
    const {y} = place(frame.root, event);
    if (y >= frame.box.top && y <= frame.box.bottom) pick(frame.value_y(y));
  });
}

function legend(scene) {
  const rows = curves_of(scene).map(({name, method, seeds}) => {
    const figures = method.summary?.[shown.metric] ?? {};
    const last = spread(seeds.map(({points}) => points.at(-1).e));
    return [
      [swatch(name), name], with_range(number(last.median), last, x => number(x, 2)),
      figures.slope ? with_range(slope_text(figures.slope.value), figures.slope, slope_text) : nothing
    ];
  });
  const floor = floor_of(scene);
  return [
    el('div', {class: 'wide'}, table('legend', ['Method', metrics[shown.metric].name, 'Slope'], rows)),
    floor === null ? null :
                     el('p', {class: 'note'},
                        `The reference's own relMSE is about ${number(floor)}; errors near it are not to be trusted.`)
  ];
}
