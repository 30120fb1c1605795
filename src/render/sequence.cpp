#include "ajar/render/sequence.h"

#include <fmt/format.h>

#include "ajar/accel/sight.h"
#include "ajar/core/bytes.h"
#include "ajar/core/error.h"
#include "ajar/field/guide.h"

namespace ajar {
namespace {

constexpr FileKind carried_kind = {"AJARan08", "carried field file", "an animation leaves one beside its frames",
                                   "remove it: the fields are learned again from the first frame on"};

// Share of a frame's time that its lessons may take.
constexpr double teaching_share = 1.0 / 3;

constexpr float kept_near_motion = 0.125f;  // share of the evidence, from frame to frame

// So many lessons of so many passes each, and no pass more. Where their time is over, one all the same, which ends with
// the next pass, and as many as fields need to be of use. False where the monitor said stop.
bool give_lessons(const Scene& scene, const Accel& accel, const RenderOptions& options, uint32_t lessons,
                  uint32_t passes, RenderState& state, const Monitor& monitor) {
  Learning& l = state.learning;
  const uint32_t first = l.fields.generation, least = std::max(first + 1, blind_generations);
  l.lesson = passes, l.of_film = true;
  l.train = first + lessons;
  RenderOptions endless = options;
  endless.spp = 0, endless.seconds = 0, endless.cpu_seconds = 0, endless.noise = 0, endless.leaves_out = false;
  bool stopped = false;
  render(scene, accel, endless, state, [&](const RenderState& now) {
    stopped = monitor && !monitor(now);
    if (is_over(options, now.stats, teaching_share)) l.lesson = 1, l.train = std::max(l.fields.generation, least);
    return !stopped && in_training(l);
  });
  return !stopped;
}

void go_on_with(const Scene& scene, const Fields& before, const std::vector<Box>& moved,
                const SequenceOptions& sequence, const LearnOptions& options, RenderState& state) {
  StoredFields carried{doubt(before, moved, kept_near_motion, options), {}, 0};
  for (Cell& c : carried.fields.cells) c.seen *= sequence.forget;  // or cells divide until the memory is full
  state.learning.train = 0;  // of an image; lessons that time cut short go on from where they are
  go_on_from(scene, std::move(carried), options, state.learning, state.film);
}

// Whether lessons have shown a place to the lens: W of its cell has an eighth at least of what the lens gives it.
bool was_seen(const Camera& camera, const Fields& fields, const Guide& guide, const Vec3& p, const CameraRay& ray) {
  if (guide.cell == none) return false;
  const double cosine = std::abs(glm::dot(guide.ng, ray.d));
  const double given = raster_factor(camera, ray.o, p) * cosine * double(relative_importance(fields, guide));
  return double(fields.w.cells[guide.cell].direct) >= given / 8;
}

// Share of what the lens sees that no lesson has shown to it: all of it after a cut.
double share_unseen(const Scene& scene, const Accel& accel, const Fields& fields) {
  constexpr int side = 32;
  const Camera& camera = scene.camera;
  int all = 0, unseen = 0;
  for (int i = 0; i < side * side; ++i) {
    const Vec2 within = (Vec2(float(i % side), float(i / side)) + 0.5f) / float(side);
    const Vec2 raster = Vec2(float(camera.crop_x), float(camera.crop_y)) +
                        within * Vec2(float(camera.crop_width), float(camera.crop_height));
    const CameraRay ray = generate(camera, raster, Vec2(0.5f));
    Hit hit;
    if (!first_seen(scene, accel, ray, hit)) continue;
    Guide guide;
    const Surface surface = make_surface(scene, hit, ray.o, ray.d);
    make_guide(scene, &fields, Side::camera, surface, -ray.d, guide);
    if (!connectable(guide)) continue;
    ++all, unseen += was_seen(camera, fields, guide, surface.p, ray) ? 0 : 1;
  }
  return all > 0 ? double(unseen) / all : 0;
}

// Of what a tiny image shows its lessons miss the more. Fields that are young are still being taught.
bool is_cut(const Scene& scene, const Accel& accel, const Fields& fields, size_t pixels) {
  const double known = 0.5 * std::min(double(pixels) / 1024, 1.0);
  return fields.generation >= young_generations && share_unseen(scene, accel, fields) > 1 - known;
}

// Lessons of others would never end.
void require_learning(const char* who, const RenderOptions& options) {
  if (!learns(options))
    throw Error(fmt::format("{}: {} learns no fields; take an integrator that guides, or set learn_lights", who,
                            options.integrator));
}

}  // namespace

uint64_t image_seed(const SequenceOptions& sequence, uint64_t seed, uint32_t frame) {
  return sequence.coherence.numbers ? seed : hash(hash(seed, 0xf4a3e), frame);
}

uint64_t teaching_seed(const SequenceOptions& sequence, uint64_t seed, uint32_t frame) {
  return hash(hash(seed, 0x7eac4), sequence.coherence.numbers ? 0 : frame);
}

std::optional<Fields> teach(const Scene& scene, const Accel& accel, const RenderOptions& options,
                            const SequenceOptions& sequence, const Carried* before, const std::vector<Box>& moved,
                            uint32_t frame, const Monitor& monitor) {
  RenderOptions teaching = options;
  teaching.limit_fireflies = teaching.techniques = false;  // of an image
  teaching.seed = teaching_seed(sequence, options.seed, frame);
  require_learning("teach", teaching);
  if (!(sequence.forget >= 0 && sequence.forget <= 1))
    throw Error(fmt::format("teach: sequence.forget is {}; give it 0 to 1", sequence.forget));
  RenderState state = start_render(scene, teaching);
  if (before) {
    go_on_with(scene, before->fields, moved, sequence, learn_options(teaching), state);
    if (!is_cut(scene, accel, state.learning.fields, state.film.pixels())) {
      teaching.learn.forget = sequence.forget, teaching.learn.steady = sequence.coherence.numbers;
      if (!give_lessons(scene, accel, teaching, 1, sequence.teach, state, monitor)) return {};
      return std::move(state.learning.fields);
    }
    state = start_render(scene, teaching);  // as if nothing were known
  }
  const uint32_t last = std::max(sequence.begin, young_generations + 1) - young_generations;
  if (!give_lessons(scene, accel, teaching, young_generations, 1, state, monitor)) return {};
  if (!is_over(options, state.stats, teaching_share) && !give_lessons(scene, accel, teaching, 1, last, state, monitor))
    return {};
  return std::move(state.learning.fields);
}

RenderState start_with(const Scene& scene, const RenderOptions& options, Fields fields) {
  require_learning("start_with", options);
  RenderState state = start_render(scene, options);
  fit_lights(scene.light_tree, learn_options(options), fields);
  state.learning.fields = std::move(fields);
  state.learning.training = start_training(state.learning.fields);
  state.learning.train = state.learning.fields.generation;
  return state;
}

FileHistory with_frame(const FileHistory& before, uint64_t content) {
  if (content == before.content) return before;
  return {content, checksum(&content, sizeof content, before.all)};
}

void save_carried(const std::string& path, const std::string& key, const Carried& carried) {
  write_file(path, carried_kind, [&](Writer& w) {
    w.key(key);
    w.value(carried.frame), w.value(carried.files);
    write(w, carried.fields);
  });
}

Carried load_carried(const std::string& path, const std::string& key) {
  Reader r(path, carried_kind);
  std::string stored;
  Carried carried;
  r.key(stored);
  if (stored != key)
    throw Error(fmt::format("{}: fields of another animation ({}); this one is {}; remove the file, or write elsewhere",
                            path, stored, key));
  r.value(carried.frame), r.value(carried.files);
  read(r, carried.fields);
  r.finish();
  return carried;
}

}  // namespace ajar
