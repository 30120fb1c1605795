// The images of a scene beside each other or in turn: exposure, differences, one view of all, values of a pixel.

const looks = [['image', 'Images'], ['signed', 'Signed difference'], ['square', 'Squared error']];

/** What there is to see: the methods' images, then the reference. */
function entries_of(scene) {
  const own =
      (scene.methods ?? []).filter(({image}) => image && files[image]).map(({name, image}) => ({name, file: image}));
  const reference = scene.reference?.image;
  return reference && files[reference] ? [...own, {name: 'reference', file: reference, reference: true}] : own;
}

/** The key that shows an image, or nothing: there are no more. */
function key_of(entry, i) {
  if (entry.reference) return el('kbd', {}, 'R');
  return i < 10 ? el('kbd', {}, (i + 1) % 10) : null;
}

function figure_of(entry, i, state) {
  const canvas = el('canvas', {'aria-label': `Image of ${entry.name}`}), value = el('span', {class: 'pixel'}),
        figure_text = el('span', {class: 'range'});
  const aspect = files[entry.file].width / files[entry.file].height;
  canvas.style.aspectRatio = aspect;
  const figure =
      el('figure', {class: 'pane', 'data-name': entry.name, style: `max-width: ${(80 * aspect).toFixed(2)}vh`}, canvas,
         el('figcaption', {},
            el('span', {class: 'pane-name'}, key_of(entry, i), entry.reference ? null : swatch(entry.name), entry.name,
               figure_text),
            value));
  return Object.assign(entry, {canvas, value, figure, figure_text, picture: el('canvas'), painted: ''});
}

/** Paints an entry's picture where exposure, look or range changed since. */
function paint(entry, state) {
  const look = entry.reference || !state.reference ? 'image' : state.look;
  const key = `${look} ${look === 'image' ? state.exposure : state.range}`;
  if (entry.painted === key) return;
  entry.painted = key;
  const {image} = entry, {reference} = state;
  const range = 10 ** state.range;
  const data = look === 'image' ? toned(image, state.exposure) :
      look === 'signed'         ? painted(image, i => signed_colour(relative_difference(image, reference, i), range)) :
                                  painted(image, i => heat_colour(relative_square(image, reference, i), range));
  Object.assign(entry.picture, {width: image.width, height: image.height});
  entry.picture.getContext('2d').putImageData(data, 0, 0);
}

function pixel_text(entry, state) {
  if (!state.pixel) return ' ';
  const {x, y} = state.pixel, i = y * entry.image.width + x;
  const text = values_at(entry.image, i).map(v => Number.isNaN(v) ? 'NaN' : is_number(v) ? number(v) : '∞').join('  ');
  if (entry.reference || !state.reference) return text;
  const difference = 100 * relative_difference(entry.image, state.reference, i);
  return is_number(difference) ? `${text}   ${difference > 0 ? '+' : ''}${number(difference)} %` : text;
}

/** relMSE of the part in view. */
function error_in_view(entry, {view, reference}) {
  const half_x = view.width / 2 / view.zoom, half_y = view.height / 2 / view.zoom;
  let sum = 0, count = 0;
  for (let y = Math.floor(view.y - half_y + 0.5); y < view.y + half_y - 0.5 + 1e-6 && y < view.height; ++y)
    for (let x = Math.floor(view.x - half_x + 0.5); x < view.x + half_x - 0.5 + 1e-6 && x < view.width; ++x, ++count)
      sum += relative_square(entry.image, reference, y * view.width + x);
  return count ? sum / count : null;
}

function draw_panes(state) {
  const flip = state.mode === 'flip';
  state.panes.classList.toggle('flip', flip);
  state.entries.forEach((entry, i) => {
    const seen = !flip || i === state.current;
    entry.figure.hidden = !seen;
    entry.tab.setAttribute('aria-pressed', String(flip && i === state.current));
    if (!seen) return;
    paint(entry, state);
    draw_view(state.view, entry.canvas, entry.picture);
    if (state.pixel) mark_pixel(state.view, entry.canvas, state.pixel);
    entry.value.textContent = pixel_text(entry, state);
    entry.canvas.style.touchAction = state.view.zoom > 1 ? 'none' : 'pan-y';
  });
  state.place.textContent =
      state.pixel ? `pixel ${state.pixel.x}, ${state.pixel.y}` : `zoom ${number(state.view.zoom, 2)}×`;
}

function measure_view(state) {
  for (const entry of state.entries)
    if (!entry.reference && state.reference)
      entry.figure_text.textContent =
          ` relMSE ${state.view.zoom > 1 ? 'in view ' : ''}${number(error_in_view(entry, state))}`;
}

/** Draws once before the next frame, however often it is asked; figures of the view when it has come to rest. */
function make_refresh(state) {
  let asked = false, timer = 0, measured = '';
  return () => {
    const key = `${state.view.zoom} ${state.view.x} ${state.view.y}`;
    if (key !== measured) {
      measured = key;
      clearTimeout(timer);
      timer = setTimeout(() => measure_view(state), 150);
    }
    if (asked) return;
    asked = true;
    requestAnimationFrame(() => {
      asked = false;
      draw_panes(state);
    });
  };
}

function show_entry(state, i) {
  if (i < 0 || i >= state.entries.length) return;
  if (state.mode === 'flip' && i !== state.current) state.previous = state.current;
  state.current = i;
  set_mode(state, 'flip');
}

function set_mode(state, mode) {
  state.mode = mode;
  for (const button of state.mode_switch.querySelectorAll('button'))
    button.setAttribute('aria-pressed', String(button.dataset.value === mode));
  draw_panes(state);
  state.refresh();
}

function press_look(state, look) { state.look_switch.querySelector(`[data-value=${look}]`)?.click(); }

/** What the keys do; true where one was meant. */
function press(state, key) {
  const step = 40 / state.view.zoom * state.view.width / 640;
  const actions = {
    ' ': () => show_entry(state, state.mode === 'flip' ? state.previous : state.current),
    f: () => set_mode(state, state.mode === 'flip' ? 'side' : 'flip'),
    Escape: () => set_mode(state, 'side'),
    d: () => press_look(state, looks[(looks.findIndex(([name]) => name === state.look) + 1) % looks.length][0]),
    e: () => state.expose(state.exposure + 0.5),
    E: () => state.expose(state.exposure - 0.5),
    '+': () => state.view.zoom_by(1.5),
    '=': () => state.view.zoom_by(1.5),
    '-': () => state.view.zoom_by(1 / 1.5),
    a: () => state.view.fit(),
    r: () => show_entry(state, state.entries.findIndex(entry => entry.reference)),
    ArrowLeft: () => state.view.pan(-step, 0),
    ArrowRight: () => state.view.pan(step, 0),
    ArrowUp: () => state.view.pan(0, -step),
    ArrowDown: () => state.view.pan(0, step),
  };
  if (/^[0-9]$/.test(key))
    show_entry(state, key === '0' ? 9 : Number(key) - 1);
  else if (Object.hasOwn(actions, key))
    actions[key]();
  else
    return false;
  return true;
}

function legend_of_look(state) {
  const range = 10 ** state.range, ticks = [];
  if (state.look === 'image' || !state.reference) return [];
  const bar = el('canvas', {width: 200, height: 1, class: 'colour-bar'});
  const of = state.look === 'signed' ? i => signed_colour((i / 99.5 - 1) * range, range) :
                                       i => heat_colour(range * 10 ** (4 * (i / 199 - 1)), range);
  bar.getContext('2d').putImageData(painted(bar, of), 0, 0);
  if (state.look === 'signed')
    ticks.push(`−${percent(range)}`, 'equal', `+${percent(range)}`);
  else
    ticks.push(
        power_of_ten(number_of_range(state.range - 4)), power_of_ten(number_of_range(state.range - 2)),
        power_of_ten(number_of_range(state.range)));
  return [
    el('span', {class: 'colours'}, bar, el('span', {class: 'colour-ticks'}, ticks.map(tick => el('span', {}, tick)))),
    el('span', {class: 'note'},
       state.look === 'signed' ?
           '(I − R) / (|R| + 0.01) of the luminance: red brighter, blue darker than the reference' :
           '(I − R)² / (R² + 0.01): its mean is relMSE')
  ];
}

const number_of_range = x => Number(x.toFixed(1));

function toolbar(state) {
  const exposure_text = el('output', {}), range_text = el('output', {}), legend_box = el('div', {class: 'look-legend'});
  const exposure =
      slider('Exposure', {min: -8, max: 8, step: 0.1, value: 0, name: 'exposure'}, value => state.expose(value));
  const range = slider('Range', {min: -3, max: 2, step: 0.5, value: 0, name: 'difference-range'}, value => {
    state.range = value;
    refresh_look();
  });
  const range_label = labelled('Range', range, range_text);
  state.expose = value => {
    state.exposure = Math.min(Math.max(value, -8), 8);
    exposure.value = state.exposure;
    exposure_text.textContent = `${
        state.exposure > 0     ? '+' :
            state.exposure < 0 ? '−' :
                                 ''}${Math.abs(state.exposure).toFixed(1)} stops`;
    state.refresh();
  };
  const refresh_look = () => {
    range_label.hidden = state.look === 'image';
    range_text.textContent =
        state.look === 'signed' ? `± ${percent(10 ** state.range)}` : `to ${number(10 ** state.range)}`;
    legend_box.replaceChildren(...legend_of_look(state));
    state.refresh();
  };
  state.mode_switch =
      switcher('View', [['side', 'Side by side'], ['flip', 'Flip']], state.mode, mode => set_mode(state, mode));
  state.look_switch = switcher('Show', looks, state.look, look => {
    state.look = look;
    refresh_look();
  });
  const button = (text, title, act) => el('button', {type: 'button', title, onclick: act}, text);
  const tabs = state.entries.map((entry, i) => {
    entry.tab = button([key_of(entry, i), ' ', entry.name], `Show ${entry.name} alone`, () => show_entry(state, i));
    return entry.tab;
  });
  state.expose(0);
  refresh_look();
  return [
    el('div', {class: 'tools'}, state.mode_switch, state.reference_file ? state.look_switch : null,
       labelled('Exposure', exposure, exposure_text), range_label,
       el('span', {class: 'switch zoom'}, button('−', 'Zoom out', () => state.view.zoom_by(1 / 1.5)),
          button('+', 'Zoom in', () => state.view.zoom_by(1.5)), button('Fit', 'Show all', () => state.view.fit())),
       state.place),
    el('div', {class: 'tools'}, el('span', {class: 'switch tabs'}, tabs)), legend_box
  ];
}

/** As few rows as panes of at least 200 pixels allow, and as even. */
function columns_of(count, width) {
  const most = Math.max(1, Math.floor((width + 12) / 212));
  return Math.ceil(count / Math.ceil(count / most));
}

const keys_help = [
  ['1 … 9, 0', 'show one image'], ['R', 'the reference'], ['Space', 'back to the one before'],
  ['F', 'flip or side by side'], ['D', 'images or differences'], ['E, ⇧E', 'exposure'], ['+ − A', 'zoom, fit'],
  ['arrows, drag', 'move']
];

function fill_comparer(state, scene, box) {
  const some_seeds = results.seeds?.length > 1 ?
      'Images, and the relMSE below them, are those of the first seed; tables have medians over the seeds.' :
      null;
  box.replaceChildren(
      ...toolbar(state), state.panes,
      el('p', {class: 'note keys'}, 'Click an image to wake the keys and the wheel: ',
         keys_help.map(([key, what], i) => [el('kbd', {}, key), ` ${what}${i + 1 < keys_help.length ? ',  ' : '.  '}`]),
         'Images are tonemapped as Ajar\'s PNGs: exposure, clip, sRGB.', some_seeds ? [' ', some_seeds] : null));
  box.addEventListener('keydown', event => {
    if (event.ctrlKey || event.altKey || event.metaKey) return;
    if (event.target.matches('input') && event.key.startsWith('Arrow')) return;
    if (event.target.matches('button') && event.key === ' ') return;
    if (press(state, event.key)) event.preventDefault();
  });
  const lay_out = width => {
    state.panes.style.setProperty('--columns', columns_of(state.entries.length, width));
    state.refresh();
  };
  lay_out(state.panes.clientWidth);
  on_width(state.panes, lay_out);
}

async function start_comparer(scene, entries, box) {
  const {width, height} = files[entries[0].file];
  const state = {
    entries,
    mode: 'side',
    look: 'image',
    exposure: 0,
    range: 0,
    current: 0,
    previous: entries.length - 1,
    pixel: null,
    place: el('span', {class: 'place'}),
    panes: el('div', {class: 'panes'}),
    reference_file: entries.find(entry => entry.reference)?.file ?? null
  };
  const images = await Promise.all(entries.map(({file}) => load(file)));
  entries.forEach((entry, i) => {
    entry.image = images[i];
  });
  state.reference = entries.find(entry => entry.reference)?.image ?? null;
  state.view = make_view(width, height, () => state.refresh());
  state.refresh = make_refresh(state);
  const awake = () => box.contains(document.activeElement);
  const point = at => {
    const inside = at && at.x >= 0 && at.y >= 0 && at.x < width && at.y < height;
    state.pixel = inside ? {x: Math.floor(at.x), y: Math.floor(at.y)} : null;
    state.refresh();
  };
  entries.forEach((entry, i) => {
    state.panes.append(figure_of(entry, i, state).figure);
    handle_pointer(state.view, entry.canvas, {awake, point});
    entry.canvas.addEventListener('pointerdown', () => box.focus({preventScroll: true}));
  });
  fill_comparer(state, scene, box);
}

/** Runs once when the element comes near the window. */
function when_near(element, run) {
  const observer = new IntersectionObserver(seen => {
    if (!seen.some(({isIntersecting}) => isIntersecting)) return;
    observer.disconnect();
    run();
  }, {rootMargin: '800px'});
  observer.observe(element);
}

function write_comparer(scene, parent) {
  const entries = entries_of(scene);
  if (entries.length === 0) return;
  const box =
      el('div', {class: 'comparer', tabindex: 0, 'aria-label': `Images of ${scene.name}`},
         el('p', {class: 'note'}, 'The images are unpacked when they come into view.'));
  parent.append(el('h3', {}, 'Images'), box);
  when_near(box, () => start_comparer(scene, entries, box));
}
