// Drives the page as a reader does (drive.js).

const room = one('#scene-0'), odd = one('#scene-1');

async function test_plots() {
  await until('curves are drawn', () => all('.plot .line', room).length === 4);
  const svg = one('.plot', room);
  check('no path holds NaN', all('svg path').every(path => !path.getAttribute('d').includes('NaN')));
  const [x, y] = last_point(one('.plot .line.m0', room)), row = one('.legend tbody tr', room);
  near('the curve ends at the budget', axis(svg, false)(x), 30, 0.2);
  near('the curve ends at the error of the legend', axis(svg, true)(y) / number_in(row.cells[1].textContent), 1, 0.02);
  near('the slope is that of the results', number_in(row.cells[2].textContent), -1, 1e-9);
  same('axes are named', texts('.axis', svg), ['CPU time (s)', 'relMSE']);
  check('floor and guides are there', one('.floor', svg) && one('.guide', svg));

  const relmse = number_in(row.cells[1].textContent);
  one('.controls [data-value=mse]').click();
  near(
      'MSE replaces relMSE', number_in(one('.legend tbody tr', room).cells[1].textContent), relmse * 0.21,
      relmse * 0.002);
  same('the axis follows', texts('.axis', one('.plot', room)), ['CPU time (s)', 'MSE']);
  check('no floor in MSE', !one('.plot .floor', room));
  one('.controls [data-value=ssim]').click();
  near('1 - SSIM', number_in(one('.legend tbody tr', room).cells[1].textContent), 0.5 * relmse / (1 + relmse), 1e-4);
  one('.controls [data-value=relmse]').click();
  one('.controls [data-value=seconds]').click();
  same('wall time', texts('.axis', one('.plot', room)), ['Wall time (s)', 'relMSE']);
  near('its end', axis(one('.plot', room), false)(last_point(one('.plot .line.m0', room))[0]), 15.9, 0.15);
  one('.controls [data-value=cpu_seconds]').click();
  same('seeds are hidden', all('.plot .seed', room).length, 0);
  one('.controls .seeds').click();
  same('seeds on demand', all('.plot .seed', room).length, 12);

  const rect = one('.plot', room).getBoundingClientRect();
  one('.plot', room)
      .dispatchEvent(new PointerEvent(
          'pointermove', {clientX: rect.left + rect.width / 2, clientY: rect.top + rect.height / 2, bubbles: true}));
  check(
      'hovering shows the four methods', !one('#tip').hidden && all('#tip .swatch').length === 4,
      one('#tip').textContent);
  const values = all('#tip div:not(.tip-head) b').map(b => Number(b.textContent));
  check('in the order of error', values.every((v, i) => i === 0 || v >= values[i - 1]), values.join());
  one('.plot', room).dispatchEvent(new PointerEvent('pointerleave'));
  check('and hides again', one('#tip').hidden);
}

async function test_reach() {
  const cells = i => texts('td', all('.reach tbody tr', room)[i]);
  const error = number_in(one('.side output', room).textContent.replace('relMSE', ''));
  same('the slider begins where the last seed of the baseline ends', cells(0)[1].match(/([\d.]+) s\]/)?.[1], '30.0');
  same('the baseline is 1', cells(0)[2], '1');
  check(
      'path does not get there', cells(1)[1].startsWith('not within') && cells(1)[2].startsWith('<'), cells(1).join());
  near('guided-bdpt gets there by its law', number_in(cells(2)[1]), (0.55 / error) ** (1 / 1.35), 3);
  const before = cells(2).join();
  input(one('.reach[type=range]', room), 600);
  check('the slider moves the figures', cells(2).join() !== before && cells(0)[2] === '1', cells(2).join());
  check('path gets there now', !cells(1)[1].startsWith('not'), cells(1).join());
  input(one('.reach[type=range]', room), 1000);
  check('what all have from the first is a bound', [0, 1, 2].every(i => cells(i)[1].startsWith('≤ ')), cells(1).join());
  same('and no gain', cells(2)[2], '–');
}

async function test_comparer() {
  const {width, height, pixels} = expected, box = one('.comparer', room);
  box.scrollIntoView();
  if (!await until(
          'the images appear',
          () => all('canvas', box).length === 5 && one('[data-name=reference] canvas', box).width > 200))
    return;
  await frames(3);
  const canvas = name => one(`.pane[data-name=${name}] canvas`, box),
        colours = name => pixels.map(({x, y}) => colour_at(canvas(name), x, y, width, height));
  same('the reference as its PNG', colours('reference'), pixels.map(p => p.reference));
  same('path as its PNG', colours('path'), pixels.map(p => p.path));
  input(one('.exposure', box), -1.5);
  await frames(2);
  same('exposure', colours('reference'), pixels.map(p => p.darker));
  key(box, 'e'), key(box, 'e'), key(box, 'e');
  await frames(2);
  same('exposure by keys', colours('reference'), pixels.map(p => p.reference));

  await until('relMSE of the panes', () => /relMSE \d/.test(one('.pane[data-name=path] .range', box).textContent));
  near(
      'relMSE of the images is that of Ajar',
      number_in(one('.pane[data-name=path] .range', box).textContent) / expected.relmse, 1, 0.006);
  one('[data-value=signed]', box).click();
  await frames(2);
  same('the signed difference is that of ajar compare', colours('path'), pixels.map(p => p.difference));
  same('the reference stays', colours('reference'), pixels.map(p => p.reference));
  check(
      'it has a legend', one('.look-legend canvas', box) && one('.look-legend', box).textContent.includes('brighter'));
  key(box, 'd');
  await frames(2);
  check('the squared error differs', JSON.stringify(colours('path')) !== JSON.stringify(pixels.map(p => p.difference)));
  key(box, 'd');
  await frames(2);
  same('round to the images', colours('path'), pixels.map(p => p.path));

  const rect = canvas('path').getBoundingClientRect(), p = pixels[0];
  const at = {
    clientX: rect.left + (p.x + 0.5) * rect.width / width,
    clientY: rect.top + (p.y + 0.5) * rect.height / height,
    bubbles: true,
    cancelable: true
  };
  canvas('path').dispatchEvent(new PointerEvent('pointermove', at));
  await frames(2);
  const values = one('[data-name=reference] .pixel', box).textContent.trim().split(/\s+/).map(Number);
  check(
      'the read-out of a pixel',
      values.length === 3 && values.every((value, c) => Math.abs(value - p.values[c]) <= 0.003 * p.values[c]),
      values.join());
  same('its place', one('.place', box).textContent, `pixel ${p.x}, ${p.y}`);
  check(
      'with the difference', /[+−][\d.]+ %/.test(one('.pane[data-name=path] .pixel', box).textContent),
      one('.pane[data-name=path] .pixel', box).textContent);

  canvas('path').dispatchEvent(new WheelEvent('wheel', {...at, deltaY: -960}));
  canvas('path').dispatchEvent(new PointerEvent('pointerleave'));
  await frames(2);
  same('the wheel scrolls the page while the images sleep', one('.place', box).textContent, 'zoom 1.0×');
  box.focus();
  canvas('path').dispatchEvent(new WheelEvent('wheel', {...at, deltaY: -960}));
  canvas('path').dispatchEvent(new PointerEvent('pointerleave'));
  await frames(2);
  same('and zooms when they are awake', one('.place', box).textContent, 'zoom 16×');
  const [u, v] = [(p.x + 0.5) / width, (p.y + 0.5) / height];
  for (const name of ['path', 'reference']) {
    same(`${name} zooms about the pointer`, shown_at(canvas(name), u, v), p[name]);
    same(`${name} is enlarged`, shown_at(canvas(name), u + 6 / width, v), p[name]);
  }
  const s = rect.width / width * 16;
  const pointer = (type, dx) =>
      canvas('path').dispatchEvent(new PointerEvent(type, {...at, clientX: at.clientX + dx, pointerId: 1}));
  pointer('pointerdown', 0), pointer('pointermove', s), pointer('pointerup', s);
  canvas('path').dispatchEvent(new PointerEvent('pointerleave'));
  await frames(2);
  same('dragging one pane moves all', shown_at(canvas('reference'), u + 16 / width, v), p.reference);
  key(box, 'a');
  await frames(2);
  same('fit', one('.place', box).textContent, 'zoom 1.0×');

  const seen = () => images_seen(box);
  same('all beside each other', seen(), ['bdpt', 'path', 'guided-bdpt', 'light', 'reference']);
  key(box, '1');
  same('key 1', seen(), ['bdpt']);
  key(box, '2');
  same('key 2', seen(), ['path']);
  key(box, ' ');
  same('space goes back', seen(), ['bdpt']);
  key(box, ' ');
  same('and forth', seen(), ['path']);
  key(box, '5');
  await frames(2);
  same('key 5', seen(), ['reference']);
  same('drawn large', colours('reference'), pixels.map(q => q.reference));
  key(box, 'f');
  same('side by side', seen().length, 5);
}

async function test_drawers() {
  const pyramid = one('.strategies', room);
  same('no strategies before they are asked for', all('canvas', pyramid).length, 0);
  pyramid.open = true;
  if (!await until('the strategies appear', () => all('canvas', pyramid).length === 20)) return;
  same(
      'in rows of equal length',
      all('.pyramid-row', pyramid).map(row => all('canvas', row).map(canvas => canvas.dataset.strategy)[0]),
      ['0 2', '0 3', '0 4', '0 5', '0 6']);
  const colour = () => shown_at(one('[data-strategy="2 2"]', pyramid), 0.42, 0.37);
  const before = colour();
  check('a strategy is not black', Math.max(...before) > 20, before.join());
  const shares = texts('.range', pyramid).map(number_in);
  near('shares add to all', shares.reduce((a, b) => a + b, 0), 100, 1.5);
  input(one('.exposure', pyramid), 3);
  await until('their exposure', () => Math.max(...colour()) > Math.max(...before) + 40);
  const drawer = one('.share', room);
  drawer.open = true;
  if (!await until('the shares appear', () => one('.shares tbody tr', drawer))) return;
  const row = all('.shares tbody tr', drawer).map(({cells}) => [...cells].map(cell => cell.textContent));
  same('a row for each strategy, shortest paths first', row.map(([st]) => st), ['0, 2', '1, 2', '8+, 1']);
  same('energy, time, rays and what they see', row[1].slice(1, 5), ['60 %', '20 %', '1.5', '50 %']);
  same('what a method does not do is left blank', row[2].slice(5, 9), ['–', '–', '–', '–']);
  const fields = one('.learned', room);
  fields.open = true;
  await until('the field appears', () => one('img', fields)?.naturalWidth === 64);
}

async function test_odd_scene() {
  same('a name is text', one('h2', odd).textContent, expected.odd_name);
  same('names run nothing', window.broken, undefined);
  one('.comparer', odd).scrollIntoView();
  if (!await until('its image appears', () => one('canvas', odd)?.width > 100)) return;
  await frames(3);
  same('what is not a number is magenta', colour_at(one('canvas', odd), 0, 0, 20, 30), [255, 0, 255]);
  check('no differences without a reference', !one('.comparer [data-value=signed]', odd));
  check('no strategies, no fields', !one('.strategies', odd) && !one('.learned', odd));
  check('what was left out says why', one('#scene-2').textContent.includes('veach.xml is not there'));
}

async function test_rest() {
  same('verdicts', texts('.summary .verdict'), ['baseline', '▼ loss', '▲ win', '≈ tie', 'baseline']);
  const total = all('.summary tfoot tr').find(row => row.textContent.includes('guided-bdpt'));
  check('geometric mean', total.textContent.includes(`${expected.guided_ratio}×`), total.textContent);
  same('bars', all('.bars', room).length, 5);
  check('what true means', one('#estimates .note').textContent.includes('the reference\'s own noise'));
  check('noise of the reference', one('.scene-facts', room).textContent.includes('relMSE 0.00210'));
  check('of none there is nothing to say', !one('.scene-facts', odd).textContent.includes('noise'));
  same('estimates', all('#estimates .spot').length, expected.estimates);
  near('their ratio', number_in(one('.estimates tbody tr').cells[2].textContent), 0.95, 0.08);
  one('.theme').click();
  const dark = document.documentElement.dataset.theme;
  one('.theme').click();
  check('light and dark', dark !== document.documentElement.dataset.theme && ['light', 'dark'].includes(dark), dark);
  const wide = all('body *')
                   .filter(element => element.getBoundingClientRect().right > innerWidth && !element.closest('.wide'))
                   .map(element => `${element.tagName}.${element.className}`);
  check('nothing is wider than the window', document.scrollingElement.scrollWidth <= innerWidth, wide.join(' '));
}

run([test_plots, test_reach, test_comparer, test_drawers, test_odd_scene, test_rest]);
