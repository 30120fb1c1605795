#include "ajar/render/learning.h"

#include "ajar/core/sampler.h"

namespace ajar {
namespace {

bool is_young(const Learning& l) { return l.fields.generation < young_generations; }

// Passes from one lesson to the next.
uint32_t interval(const Learning& l) {
  return is_young(l) ? 1 : rare_records << std::min(l.fields.generation - young_generations, 6u);
}

}  // namespace

Learning start_learning(const Scene& scene, const Film& film) {
  Learning l;
  l.fields = start_fields(scene, double(film.pixels()));
  return l;
}

void go_on_from(StoredFields stored, const LearnOptions& options, Learning& l, Film& film) {
  // Importance counts pixels, and this film may have more or fewer of them.
  const double scale = l.fields.w.unit / stored.fields.w.unit;
  l.fields = std::move(stored.fields);
  Field& w = l.fields.w;
  w.unit *= scale;
  for (float& m : w.mean) m *= float(scale);
  for (FieldCell& c : w.cells) c.direct *= float(scale), c.total *= float(scale);
  restrict_to(l.fields, options.guided);
  l.training = start_training(l.fields);
  l.first = film.dropped = (stored.passes + 1) / 2 * 2;
}

StoredFields stored_fields(const Scene& scene, const Learning& l, const Film& film) {
  return {l.fields, scene_key(scene), film.dropped + film.passes + (film.chunks > 0)};
}

bool is_recorded(const Learning& learning, uint64_t pixel, uint32_t pass) {
  return is_young(learning) || hash(pixel, pass) % rare_records == 0;
}

void end_pass(Learning& l, const LearnOptions& options, Film& film) {
  if (++l.passes < interval(l)) return;
  const double paths = double(film.pixels()) * l.passes / (is_young(l) ? 1 : rare_records);
  l.fields = learn(l.fields, l.training, l.sightings, paths, options);
  l.training = start_training(l.fields);
  l.sightings.clear();
  l.passes = 0;
  if (l.fields.generation == young_generations) drop_passes(film);
}

}  // namespace ajar
