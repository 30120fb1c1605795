// Drives a page whose budget is in samples (drive.js).

const room = one('#scene-0'), odd = one('#scene-1');

async function test_ends() {
  await until('curves are drawn', () => all('.plot .line', room).length === 4);
  const svg = one('.plot', room), row = one('.legend tbody tr', room);
  const [x, y] = last_point(one('.plot .line.m0', room));
  near('the curve ends at the budget', axis(svg, false)(x), 273, 2);
  near('the curve ends at the error of the legend', axis(svg, true)(y) / number_in(row.cells[1].textContent), 1, 0.02);
  same('axes are named', texts('.axis', svg), ['Samples per pixel', 'relMSE']);
  check('so are headings', texts('h3, h4', room).join().match(/Error against samples.*Samples to reach/));
  one('.controls [data-value=cpu_seconds]').click();
  check('they follow the clock', texts('h3, h4', room).join().match(/Error against time.*Time to reach/));
}

async function test_narrow_axes() {
  await until('its curve is drawn', () => one('.plot .line', odd));
  const labels = anchor => texts(`.ticks [text-anchor=${anchor}]`, one('.plot', odd));
  check('times have labels', labels('middle').length >= 2, labels('middle').join());
  check('errors have labels', labels('end').length >= 2, labels('end').join());
}

run([test_ends, test_narrow_axes]);
