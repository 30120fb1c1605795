#include "ajar/film/fireflies.h"

#include <algorithm>
#include <array>

#include "ajar/film/pixels.h"

namespace ajar {
namespace {

using Bright = Film::Bright;
constexpr int kept = Film::brightest_kept;
constexpr int reach = 2;
constexpr float slack = 2;  // how much brighter a pass may be than what others saw

// The brightest passes so far, each by the brightest that it brought some pixel.
struct Passes {
  struct Pass {
    float luminance = 0;
    uint32_t number = 0;
  };
  std::array<Pass, kept> best{};

  void add(float luminance, uint32_t number) {
    if (!(luminance > best.back().luminance)) return;
    int at = kept - 1;  // whose place it takes
    for (int i = 0; i < kept; ++i)
      if (best[i].luminance > 0 && best[i].number == number) {
        if (best[i].luminance >= luminance) return;
        at = i;
      }
    for (; at > 0 && best[at - 1].luminance < luminance; --at) best[at] = best[at - 1];
    best[at] = {luminance, number};
  }
};

float limit_at(const Film& film, int x, int y) {
  Passes passes;
  for_each_around(film, x, y, reach, [&](size_t i) {
    const Bright* of = &film.brightest[kept * i];
    for (int k = 0; k < kept; ++k) passes.add(luminance(of[k].value), of[k].pass);
  });
  return slack * passes.best.back().luminance;
}

}  // namespace

void limit_fireflies(Film& film) { film.brightest.assign(kept * film.pixels(), {}); }

void note(Film& film, size_t pixel, const Rgb& value, float weight) {
  Bright* of = &film.brightest[kept * pixel];
  const float l = luminance(value);
  if (!(l > luminance(of[kept - 1].value))) return;
  int at = kept - 1;
  for (; at > 0 && luminance(of[at - 1].value) < l; --at) of[at] = of[at - 1];
  of[at] = {value, film.passes, weight};
}

std::vector<float> limits(const Film& film) {
  if (film.passes < uint32_t(kept)) return std::vector<float>(film.pixels(), infinity);
  return each_pixel(film, [&](int x, int y) { return limit_at(film, x, y); });
}

float kept_share(const Rgb& value, float limit) {
  const float l = luminance(value);
  return l > limit ? limit / l : 1;
}

glm::dvec3 excess(const Film& film, size_t pixel, float limit) {
  glm::dvec3 sum(0);
  for (int k = 0; k < kept; ++k) {
    const Bright& bright = film.brightest[kept * pixel + k];
    sum += glm::dvec3(bright.value * (1 - kept_share(bright.value, limit))) * double(bright.weight);
  }
  return film.weight > 0 ? sum * (film.passes / film.weight) : sum;
}

}  // namespace ajar
