// What scripts that drive the page are made of (browser_test.cpp): they log PASS and FAIL lines and close the window.
// `expected` and `errors` come before.

const lines = [];
const check = (what, sound, detail = '') =>
    lines.push(`${sound ? 'PASS' : 'FAIL'} ${what}${sound ? '' : `: ${detail}`}`);
const same = (what, is, should) => check(
    what, JSON.stringify(is) === JSON.stringify(should),
    `is ${JSON.stringify(is)}, should be ${JSON.stringify(should)}`);
const near = (what, is, should, tolerance) =>
    check(what, Math.abs(is - should) <= tolerance, `is ${is}, should be ${should} within ${tolerance}`);
const one = (selector, root = document) => root.querySelector(selector);
const all = (selector, root = document) => [...root.querySelectorAll(selector)];
const frames = async n => {
  for (let i = 0; i < n; ++i) await new Promise(done => requestAnimationFrame(done));
};
const until = async (what, ready) => {
  for (let i = 0; i < 400; ++i) {
    if (ready()) return true;
    await new Promise(done => setTimeout(done, 20));
  }
  check(what, false, 'did not happen');
  return false;
};

const input = (control, value) => {
  control.value = value;
  control.dispatchEvent(new Event('input', {bubbles: true}));
};
const key = (element, name, more = {}) =>
    element.dispatchEvent(new KeyboardEvent('keydown', {key: name, bubbles: true, cancelable: true, ...more}));
const texts = (selector, root) => all(selector, root).map(element => element.textContent);
const number_in = text => Number(text.replace('−', '-').match(/-?[\d.]+/)[0]);

/** The value that a labelled axis gives a pixel: from two of its ticks. */
function axis(svg, vertical) {
  const ticks = all('.ticks text', svg)
                    .map(text => ({
                           at: Number(text.getAttribute(vertical ? 'y' : 'x')) - (vertical ? 4 : 0),
                           end: text.getAttribute('text-anchor') === 'end',
                           value: Number(text.textContent)
                         }))
                    .filter(({end, value}) => end === vertical && value > 0);
  const [a, b] = [ticks[0], ticks.at(-1)];
  return pixel => a.value * (b.value / a.value) ** ((pixel - a.at) / (b.at - a.at));
}

const last_point = path => path.getAttribute('d').match(/([\d.]+) ([\d.]+)$/).slice(1).map(Number);

const scratch = document.createElement('canvas').getContext('2d', {willReadFrequently: true});

/** The colour that a canvas shows at a place, in shares of its size. */
function shown_at(canvas, x, y) {
  scratch.drawImage(canvas, Math.floor(x * canvas.width), Math.floor(y * canvas.height), 1, 1, 0, 0, 1, 1);
  return [...scratch.getImageData(0, 0, 1, 1).data].slice(0, 3);
}

/** At the middle of an image pixel, while all of the image is in view. */
const colour_at = (canvas, x, y, width, height) => shown_at(canvas, (x + 0.5) / width, (y + 0.5) / height);

/** Names of the images that a comparer shows. */
const images_seen = box => all('.pane', box).filter(pane => !pane.hidden).map(pane => pane.dataset.name);

async function run(tests) {
  for (const test of tests) {
    try {
      await test();
    } catch (error) {
      check(test.name, false, `${error} ${error.stack}`);
    }
  }
  same('no errors on the page', errors, []);
  console.log(`selftest\n${lines.join('\n')}\ndone`);
  window.close();
}
