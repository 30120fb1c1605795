// Which part of the images is seen: one view that several canvases share, moved by wheel, drag, pinch and keys.

/** {zoom: 1 shows all, x, y: the image point in the middle}; changed() is called after every move. */
function make_view(width, height, changed) {
  const view = {zoom: 1, x: width / 2, y: height / 2, width, height};
  const clamp = () => {
    view.zoom = Math.min(Math.max(view.zoom, 1), 128);
    const half_x = width / 2 / view.zoom, half_y = height / 2 / view.zoom;
    view.x = Math.min(Math.max(view.x, half_x), width - half_x);
    view.y = Math.min(Math.max(view.y, half_y), height - half_y);
    changed();
  };
  view.pan = (dx, dy) => {
    view.x += dx;
    view.y += dy;
    clamp();
  };
  /** The image point (x, y) keeps its place. */
  view.zoom_by = (factor, x = view.x, y = view.y) => {
    const zoom = Math.min(Math.max(view.zoom * factor, 1), 128), share = view.zoom / zoom;
    view.x = x + (view.x - x) * share;
    view.y = y + (view.y - y) * share;
    view.zoom = zoom;
    clamp();
  };
  view.fit = () => {
    view.zoom = 1;
    clamp();
  };
  return view;
}

/** Canvas pixels per image pixel. */
function scale_of(view, canvas) { return canvas.width / view.width * view.zoom; }

function image_point(view, canvas, event) {
  const rect = canvas.getBoundingClientRect(), s = rect.width / view.width * view.zoom;
  return {
    x: view.x + (event.clientX - rect.left - rect.width / 2) / s,
    y: view.y + (event.clientY - rect.top - rect.height / 2) / s
  };
}

function draw_view(view, canvas, picture) {
  const width = Math.round(canvas.clientWidth * devicePixelRatio),
        height = Math.round(width * view.height / view.width);
  if (width === 0) return;
  if (canvas.width !== width || canvas.height !== height) Object.assign(canvas, {width, height});
  const s = scale_of(view, canvas), context = canvas.getContext('2d');
  context.imageSmoothingEnabled = s < 1;
  context.imageSmoothingQuality = 'high';
  context.drawImage(picture, width / 2 - view.x * s, height / 2 - view.y * s, view.width * s, view.height * s);
}

/** A frame around the pixel that is read out. */
function mark_pixel(view, canvas, {x, y}) {
  const s = scale_of(view, canvas), context = canvas.getContext('2d'), size = Math.max(s, 5);
  const left = canvas.width / 2 + (x + 0.5 - view.x) * s - size / 2,
        top = canvas.height / 2 + (y + 0.5 - view.y) * s - size / 2;
  for (const [grow, colour] of [[1, '#000'], [0, '#fff']]) {
    context.strokeStyle = colour;
    context.strokeRect(left - grow - 0.5, top - grow - 0.5, size + 2 * grow + 1, size + 2 * grow + 1);
  }
}

/** Drag, pinch and wheel on a canvas. The wheel zooms where awake() says so or with Ctrl, else the page scrolls. */
function handle_pointer(view, canvas, {awake, point}) {
  const down = new Map();
  canvas.addEventListener('pointerdown', event => {
    down.set(event.pointerId, event);
    if (event.isTrusted) canvas.setPointerCapture(event.pointerId);
  });
  for (const end of ['pointerup', 'pointercancel']) canvas.addEventListener(end, event => down.delete(event.pointerId));
  canvas.addEventListener('pointermove', event => {
    point(image_point(view, canvas, event));
    const before = down.get(event.pointerId);
    if (!before) return;
    const s = canvas.clientWidth / view.width * view.zoom;
    const other = [...down.values()].find(({pointerId}) => pointerId !== event.pointerId);
    if (other) {
      const length = e => Math.hypot(e.clientX - other.clientX, e.clientY - other.clientY);
      const middle = {clientX: (event.clientX + other.clientX) / 2, clientY: (event.clientY + other.clientY) / 2},
            at = image_point(view, canvas, middle);
      view.zoom_by(length(event) / Math.max(length(before), 1), at.x, at.y);
    }
    const share = other ? 0.5 : 1;
    view.pan(-(event.clientX - before.clientX) / s * share, -(event.clientY - before.clientY) / s * share);
    down.set(event.pointerId, event);
  });
  canvas.addEventListener('pointerleave', () => point(null));
  canvas.addEventListener('dblclick', event => {
    const at = image_point(view, canvas, event);
    view.zoom_by(2, at.x, at.y);
  });
  canvas.addEventListener('wheel', event => {
    if (!awake() && !event.ctrlKey) return;
    event.preventDefault();
    const at = image_point(view, canvas, event);
    view.zoom_by(2 ** (-event.deltaY / (event.deltaMode === 1 ? 12 : 240)), at.x, at.y);
  }, {passive: false});
}
