// The results, and how elements are made.

const results = JSON.parse(document.getElementById('results').textContent);
const files = JSON.parse(document.getElementById('files').textContent);
const scenes = results.scenes ?? [];
const method_names = [...new Set(scenes.flatMap(scene => (scene.methods ?? []).map(method => method.name)))];

function furnish(element, attributes, content) {
  for (const [name, value] of Object.entries(attributes ?? {})) {
    if (value === null || value === undefined || value === false) continue;
    if (name.startsWith('on'))
      element.addEventListener(name.slice(2), value);
    else
      element.setAttribute(name, value === true ? '' : value);
  }
  element.append(...content.flat(Infinity).filter(child => child !== null && child !== undefined));
  return element;
}

/** An HTML element; text among the content is text, never markup. */
function el(tag, attributes, ...content) { return furnish(document.createElement(tag), attributes, content); }

function svg(tag, attributes, ...content) {
  return furnish(document.createElementNS('http://www.w3.org/2000/svg', tag), attributes, content);
}

/** Which dashes the lines of a method have: 0 are none, of those that colours suffice for. */
function dash_of(name) { return Math.floor(method_names.indexOf(name) / 8) % 3; }

/** The classes that give a method its colour and dashes, the same in every scene. */
function look_of(name) {
  const colour = `m${method_names.indexOf(name) % 8}`, dash = dash_of(name);
  return dash > 0 ? `${colour} d${dash}` : colour;
}

function swatch(name) { return el('i', {class: `swatch ${look_of(name)}`}); }

/**
 * Calls draw(width) soon and whenever the element's width changes; in the next frame, as drawing may change the
 * layout.
 */
function on_width(element, draw) {
  let last = 0;
  new ResizeObserver(() => {
    const width = Math.floor(element.clientWidth);
    if (width === last || width === 0) return;
    last = width;
    requestAnimationFrame(() => draw(width));
  }).observe(element);
}

/** A group of buttons of which one is pressed; choices: [value, label] pairs. */
function switcher(label, choices, value, choose) {
  const buttons = choices.map(
      ([key, name]) => el(
          'button',
          {type: 'button', 'data-value': key, 'aria-pressed': String(key === value), onclick: () => press(key)}, name));
  function press(key) {
    for (const button of buttons) button.setAttribute('aria-pressed', String(button.dataset.value === key));
    choose(key);
  }
  return el(
      'span', {class: 'switch', role: 'group', 'aria-label': label}, el('span', {class: 'label'}, label), buttons);
}

function slider(label, {min, max, step, value, name}, input) {
  const control = el('input', {
    type: 'range',
    min,
    max,
    step,
    value,
    class: name,
    'aria-label': label,
    oninput: () => input(Number(control.value))
  });
  return control;
}

/** A label, a slider and its read-out. */
function labelled(label, control, read_out) {
  return el('label', {class: 'slider'}, el('span', {class: 'label'}, label), control, read_out);
}

// The read-out beside the pointer.
const tip = document.getElementById('tip');

function show_tip(event, ...content) {
  tip.replaceChildren(...content.flat(Infinity));
  tip.hidden = false;
  const x = event.clientX + 16, y = event.clientY + 16;
  tip.style.left = `${Math.max(4, x + tip.offsetWidth > innerWidth - 8 ? event.clientX - tip.offsetWidth - 12 : x)}px`;
  tip.style.top =
      `${Math.max(4, y + tip.offsetHeight > innerHeight - 8 ? event.clientY - tip.offsetHeight - 12 : y)}px`;
}

function hide_tip() { tip.hidden = true; }

function table(class_name, head, rows, foot = []) {
  const cells = (tag, row) =>
      el('tr', row.attributes,
         (row.cells ?? row).map(cell => cell instanceof HTMLTableCellElement ? cell : el(tag, {}, cell)));
  return el(
      'table', {class: class_name}, el('thead', {}, cells('th', head)),
      el('tbody', {}, rows.map(row => cells('td', row))),
      foot.length ? el('tfoot', {}, foot.map(row => cells('td', row))) : null);
}

/** Camera paths of a run, lessons' among them, whose rays are counted too; where there are none, samples in the image. */
function samples_of(run, pixels) {
  const edges = run.mean_path_edges?.camera;
  return edges > 0 ? run.rays?.camera / edges : run.spp * pixels;
}
