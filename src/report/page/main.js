// The page from top to bottom.

function scene_id(scene) { return `scene-${scenes.indexOf(scene)}`; }

/** What the plots show; stays in view beside them. */
function write_controls(main) {
  const seeds = el('input', {type: 'checkbox', class: 'seeds', onchange: () => show({seeds: seeds.checked})});
  main.append(el(
      'div', {class: 'controls'},
      switcher(
          'Error', present(metrics, (key, sample) => metrics[key].of(sample)), shown.metric, metric => show({metric})),
      switcher('Against', present(clocks, (key, sample) => sample[key]), shown.clock, clock => show({clock})),
      scenes.some(({methods = []}) => methods.some(({runs = []}) => runs.length > 1)) ?
          el('label', {class: 'check'}, seeds, ' single seeds') :
          null));
}

function facts_of(scene) {
  const {reference = {}} = scene,
                     defines =
                         Object.entries(scene.defines ?? {}).map(([name, value]) => `${name} = ${value}`).join(', ');
  return [
    scene.file, defines, is_number(scene.width) ? `${scene.width} × ${scene.height}` : null,
    is_number(scene.max_depth) ?
        (scene.max_depth < 0 ? 'paths of any length' : `paths of at most ${counted(scene.max_depth, 'edge')}`) :
                               null,
    scene.triangles > 0 ? counted(scene.triangles, 'triangle') : null,
    is_number(scene.load_seconds) ?
        `loaded in ${seconds(scene.load_seconds)}, built in ${seconds(scene.build_seconds)}` :
        null,
    is_number(reference?.relmse) ? `noise of the reference: relMSE ${number(reference.relmse)}` :
        reference?.image ? 'noise of the reference unknown' :
                           null
  ].filter(Boolean)
      .join(' · ');
}

function write_options(scene, parent) {
  const text = value => el('pre', {}, JSON.stringify(value, null, 1).replace(/\n\s*/g, ' '));
  const rows = (scene.methods ?? []).map(({name, options}) => [[swatch(name), name], text(options ?? {})]);
  const made = scene.reference?.made_by;
  if (made) rows.push(['reference', text(made)]);
  if (rows.length)
    parent.append(
        el('details', {class: 'options'}, el('summary', {}, 'Options'),
           el('div', {class: 'wide'}, table('options', ['Method', 'Options'], rows))));
}

function write_scene(scene, main) {
  const section =
      el('section', {class: 'one-scene', id: scene_id(scene)}, el('h2', {}, scene.name ?? nothing),
         el('p', {class: 'scene-facts'}, facts_of(scene)));
  main.append(section);
  if (scene.skipped || !scene.methods?.length) {
    section.append(el('p', {class: 'note'}, `Left out: ${scene.skipped ?? 'no results'}`));
    return;
  }
  const heading = el('h3');
  const name_clock = () => {
    heading.textContent = `Error against ${clocks[shown.clock].title}`;
  };
  shown.watchers.push(name_clock);
  name_clock();
  section.append(heading);
  write_curves(scene, section);
  write_bars(scene, section);
  write_comparer(scene, section);
  write_strategies(scene, section);
  write_options(scene, section);
}

function write_page() {
  const main = document.getElementById('main');
  follow_system_theme();
  write_head();
  if (scenes.length === 0) {
    main.append(el('p', {}, 'These results have no scenes.'));
    return;
  }
  write_summary(main);
  if (all_samples.length > 0) write_controls(main);
  for (const scene of scenes) write_scene(scene, main);
  write_estimates(main);
}

write_page();
