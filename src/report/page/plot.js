// A frame with two logarithmic axes, to draw in.

let frames = 0;  // for names that only one frame has

function decades(low, high) {
  const ticks = [];
  for (let d = Math.floor(Math.log10(low)); d <= Math.ceil(Math.log10(high)); ++d)
    for (let k = 1; k < 10; ++k) ticks.push({value: k * 10 ** d, digit: k, decade: d});
  return ticks.filter(({value}) => value >= low * 0.9999 && value <= high * 1.0001);
}

function tick_text({value, digit, decade}) {
  if (decade >= -3 && decade <= 3) return number(value, 1);
  return digit === 1 ? power_of_ten(decade) : `${digit}·${power_of_ten(decade)}`;
}

/** Which digits of the ticks get a label: 1 alone where there is room for decades only, but at least two ticks. */
function labelled_digits(ticks, {low, high}, pixels) {
  const per_decade = pixels / Math.log10(high / low);
  const digits = per_decade > 110 ? [1, 2, 5] : per_decade > 80 ? [1, 3] : [1];
  return [digits, [1, 2, 5], [1, 2, 3, 5, 7]].find(
             some => ticks.filter(({digit}) => some.includes(digit)).length >= 2) ??
      [1, 2, 3, 4, 5, 6, 7, 8, 9];
}

/**
 * x, y: {low, high, name}. Leaves {root, layer, x(value), y(value), box, value_x(pixel), value_y(pixel)}; what is drawn
 * in layer is cut at the box.
 */
function log_frame({width, height, x, y, right = 16}) {
  const box = {left: 62, top: 12, right: width - right, bottom: height - 46};
  const scale = (low, high, from, to) => ({
    pixel: value => from + Math.log(value / low) / Math.log(high / low) * (to - from),
    value: pixel => low * (high / low) ** ((pixel - from) / (to - from)),
  });
  const sx = scale(x.low, x.high, box.left, box.right), sy = scale(y.low, y.high, box.bottom, box.top);
  const name = `cut-${frames++}`;
  const root = svg('svg', {
    class: 'plot',
    width,
    height,
    viewBox: `0 0 ${width} ${height}`,
    role: 'img',
    'aria-label': `${y.name} against ${x.name}`
  });
  const grid = svg('g', {class: 'grid'}), texts = svg('g', {class: 'ticks'});
  const ticks_x = decades(x.low, x.high), ticks_y = decades(y.low, y.high);
  const digits_x = labelled_digits(ticks_x, x, box.right - box.left),
        digits_y = labelled_digits(ticks_y, y, 2 * (box.bottom - box.top));
  for (const tick of ticks_x) {
    const at = sx.pixel(tick.value);
    grid.append(
        svg('line', {x1: at, x2: at, y1: box.top, y2: box.bottom, class: tick.digit === 1 ? 'major' : 'minor'}));
    if (digits_x.includes(tick.digit))
      texts.append(svg('text', {x: at, y: box.bottom + 17, 'text-anchor': 'middle'}, tick_text(tick)));
  }
  for (const tick of ticks_y) {
    const at = sy.pixel(tick.value);
    grid.append(
        svg('line', {x1: box.left, x2: box.right, y1: at, y2: at, class: tick.digit === 1 ? 'major' : 'minor'}));
    if (digits_y.includes(tick.digit))
      texts.append(svg('text', {x: box.left - 7, y: at + 4, 'text-anchor': 'end'}, tick_text(tick)));
  }
  const layer = svg('g', {'clip-path': `url(#${name})`});
  const middle = (box.top + box.bottom) / 2;
  root.append(
      svg('defs', {},
          svg('clipPath', {id: name},
              svg('rect', {x: box.left, y: box.top, width: box.right - box.left, height: box.bottom - box.top}))),
      grid,
      svg('rect', {class: 'frame', x: box.left, y: box.top, width: box.right - box.left, height: box.bottom - box.top}),
      texts,
      svg('text', {class: 'axis', x: (box.left + box.right) / 2, y: height - 8, 'text-anchor': 'middle'}, x.name),
      svg('text', {class: 'axis', x: 14, y: middle, transform: `rotate(-90 14 ${middle})`, 'text-anchor': 'middle'},
          y.name),
      layer);
  return {root, layer, box, x: sx.pixel, y: sy.pixel, value_x: sx.value, value_y: sy.value};
}

function path_of(points) {
  return points.map(([x, y], i) => `${i ? 'L' : 'M'}${x.toFixed(1)} ${y.toFixed(1)}`).join('');
}

/** The pointer's place in the drawing's own units. */
function place(root, event) {
  const rect = root.getBoundingClientRect(), view = root.viewBox.baseVal;
  return {
    x: (event.clientX - rect.left) * view.width / rect.width,
    y: (event.clientY - rect.top) * view.height / rect.height
  };
}

/** Widens a range by a factor, and to at least half a decade. */
function padded(low, high, factor) {
  const grow = Math.max(factor, Math.sqrt(Math.max(1, 3 / (high / low))));
  return [low / grow, high * grow];
}
