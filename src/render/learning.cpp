#include "ajar/render/learning.h"

#include <algorithm>

#include "ajar/core/sampler.h"

namespace ajar {
namespace {

uint32_t youth(const Learning& l) { return l.train > 0 ? l.train : young_generations; }
// Passes whose fields knew too little for the image. Training passes are not for the image in any case.
uint32_t blind(const Learning& l) { return l.train > 0 ? l.train : blind_generations; }
bool is_young(const Learning& l) { return l.fields.generation < youth(l); }
bool is_frozen(const Learning& l) { return l.train > 0 && !is_young(l); }

// Once fields are no longer young: passes from one lesson to the next, and of how many paths one is recorded.
uint32_t rarity(const Learning& l) { return rare_records << std::min(l.fields.generation - young_generations, 6u); }

// Passes from one lesson to the next.
uint32_t interval(const Learning& l) { return is_young(l) ? l.lesson : rarity(l); }

// For a lesson of fields that know something.
constexpr size_t enough_pixels = 16384;

// Of how many pixels one is traced in the first two passes and in the other blind ones, and how many of the paths of
// those that follow are recorded: so many pixels that enough are left, as far as that is possible.
struct YoungShares {
  uint32_t first, later, recorded;
};

YoungShares young_shares(size_t pixels) {
  const auto one_in = [&](size_t least, size_t most) { return uint32_t(std::clamp<size_t>(pixels / least, 1, most)); };
  const uint32_t first = one_in(4096, 16);
  return {first, first == 1 ? 1 : std::max(first / 2, 2u), one_in(enough_pixels, rare_records)};
}

}  // namespace

Learning start_learning(const Scene& scene, const Film& film, const LearnOptions& options) {
  Learning l;
  l.train = options.train + options.train % 2;  // passes are dropped in pairs
  l.fields = start_fields(scene, double(film.pixels()), options);
  l.training = start_training(l.fields);
  return l;
}

void go_on_from(const Scene& scene, StoredFields stored, const LearnOptions& options, Learning& l, Film& film) {
  fit_lights(scene.light_tree, options, stored.fields);
  // Importance counts pixels, and this film may have more or fewer of them; and lamps may shine more or less.
  const double scale = l.fields.w.unit / stored.fields.w.unit;
  stored.fields.q.unit = l.fields.q.unit;
  l.fields = std::move(stored.fields);
  l.fields.rule = options.rule;
  Field& w = l.fields.w;
  w.unit *= scale;
  for (UFloat16& m : w.mean) m = float(scale) * m;
  for (FieldCell& c : w.cells) c.direct *= float(scale), c.total *= float(scale);
  l.fields.starts.unit *= scale, l.fields.disk.unit *= scale;
  for (UFloat16& m : l.fields.disk.mean) m = float(scale) * m;
  restrict_to(l.fields, options.guided);
  l.training = start_training(l.fields);
  if (l.fields.generation < blind(l)) l.fields.generation -= l.fields.generation % 2;  // passes are dropped in pairs
  l.first = film.dropped = (stored.passes + 1) / 2 * 2;
}

StoredFields stored_fields(const Scene& scene, const Learning& l, uint32_t passes) {
  return {l.fields, scene_key(scene), passes};
}

bool in_training(const Learning& l) { return l.train > 0 && is_young(l); }

void end_training(Learning& l) {
  const uint32_t pair = (l.fields.generation + 2) / 2 * 2;  // passes are dropped in pairs
  if (in_training(l)) l.train = std::min(l.train, std::max(pair, blind_generations));
}

uint32_t traced_one_in(const Learning& l, const Film& film) {
  if (l.of_film) return uint32_t(std::clamp<size_t>(film.pixels() / enough_pixels, 1, 16));
  if (l.train > 0 || l.lesson > 1 || knows_enough(l)) return 1;
  const YoungShares shares = young_shares(film.pixels());
  return l.fields.generation < blind_generations / 2 ? shares.first : shares.later;
}

uint32_t recorded_one_in(const Learning& l, const Film& film) {
  if (!is_young(l)) return rarity(l);
  return l.train > 0 || !knows_enough(l) ? 1 : young_shares(film.pixels()).recorded;
}

uint32_t light_recorded_one_in(const Learning& l, const Film& film, float rate) {
  return std::max(uint32_t(float(recorded_one_in(l, film)) * rate), 1u);
}

bool is_recorded(const Learning& learning, uint64_t pixel, uint32_t pass, uint32_t one_in) {
  return !is_frozen(learning) && hash(pixel, pass) % one_in == 0;
}

Recorded paths_recorded(const Learning& l, const LearnOptions& options, const Film& film, float rate) {
  const uint32_t traced = options.guided == Guided::neither ? 1 : traced_one_in(l, film);
  const double paths = double(film.pixels()) * l.passes / traced;
  return {paths / recorded_one_in(l, film), paths * double(rate) / light_recorded_one_in(l, film, rate)};
}

void end_pass(const Scene& scene, Learning& l, const LearnOptions& options, float rate, Film& film) {
  if (is_frozen(l) || ++l.passes < interval(l)) return;
  const Recorded paths = paths_recorded(l, options, film, rate);
  l.fields = learn(l.fields, l.training, l.sightings, paths, options, &scene.light_tree);
  l.training = start_training(l.fields);
  l.sightings.clear();
  l.passes = 0;
  if (options.guided != Guided::neither && l.fields.generation == blind(l)) drop_passes(film);
}

}  // namespace ajar
