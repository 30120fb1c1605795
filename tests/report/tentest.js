// Drives a page of ten methods (drive.js).

const room = one('#scene-0');
const dashes_of = selector => getComputedStyle(one(selector, room)).strokeDasharray;

async function test_looks() {
  await until('curves are drawn', () => all('.plot .line', room).length === 10);
  same('the first line is whole', dashes_of('.plot .line.m0:not(.d1)'), 'none');
  same('the ninth has its colour, and dashes', dashes_of('.plot .line.m0.d1'), '8px, 4px');
  same('a piece of each line before its name', all('.plot .key-line', room).length, 10);
  const swatch = i => one('.swatch', all('.legend tbody tr', room)[i]);
  check(
      'the legend shows the dashes',
      getComputedStyle(swatch(8)).backgroundImage.includes('gradient') &&
          getComputedStyle(swatch(0)).backgroundImage === 'none');
}

async function test_keys() {
  const box = one('.comparer', room);
  box.scrollIntoView();
  if (!await until('the images appear', () => all('canvas', box).length === 11)) return;
  const seen = () => images_seen(box);
  same('their keys', texts('.pane-name kbd', box), ['1', '2', '3', '4', '5', '6', '7', '8', '9', '0', 'R']);
  key(box, '9');
  same('key 9', seen(), ['method 9']);
  key(box, '0');
  same('key 0', seen(), ['method 10']);
  key(box, 'r');
  same('key R', seen(), ['reference']);
  check('nothing is wider than the window', document.scrollingElement.scrollWidth <= innerWidth);
}

function test_words() {
  const head = one('#head').textContent, facts = one('.scene-facts', room).textContent;
  check('one thread', head.includes('· 1 thread ·'), head);
  check('edges and triangles', facts.includes('at most 1 edge ·') && facts.includes('12 345 triangles'), facts);
  check('noise that is not known', facts.includes('noise of the reference unknown'), facts);
  const notes = texts('.note', room).join();
  check('whose memory', notes.includes('the whole process'), notes);
  check('whose images', notes.includes('those of the first seed'), notes);
}

run([test_looks, test_keys, test_words]);
