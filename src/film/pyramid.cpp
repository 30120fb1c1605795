#include "ajar/film/pyramid.h"

#include <fmt/format.h>

#include <cstdio>
#include <filesystem>
#include <string_view>

#include "footprint.h"

namespace ajar {
namespace {

void splat(const Film& film, const Strategy& c, Pyramid::Layer& layer) {
  const double per_path = 1.0 / double(film.pixels());
  for_each_reached(film, c.raster, 0, film.height, [&](size_t i, float wx, float wy) {
    const double w = per_path * double(wx) * double(wy);
    layer.raw[i] += glm::dvec3(c.raw) * w;
    layer.weighted[i] += glm::dvec3(c.weighted) * w;
  });
}

void clear_layers(const std::string& folder) {
  std::error_code ignored;
  for (const std::filesystem::path& path : files_in(folder))
    if (is_layer(path.filename().string())) std::filesystem::remove(path, ignored);
}

}  // namespace

bool is_layer(const std::string& name) {
  int end = 0;
  if (std::sscanf(name.c_str(), "%*1[sm]%*[0-9]t%*[0-9]%n", &end) != 0) return false;
  const std::string_view rest = std::string_view(name).substr(size_t(end));
  return end > 0 && (rest == ".exr" || rest == "-raw.exr");
}

void merge(Pyramid& pyramid, const Film& film, const std::vector<std::vector<Strategy>>& chunks) {
  for (const auto& chunk : chunks)
    for (const Strategy& c : chunk) {
      if (std::abs(c.s) + c.t > most_vertices) continue;
      Pyramid::Layer& layer = pyramid.layers[{c.s, c.t}];
      if (layer.raw.empty()) layer.raw.resize(film.pixels()), layer.weighted.resize(film.pixels());
      if (c.t == 1) {
        splat(film, c, layer);
      } else {
        const size_t i = size_t(c.raster.y) * film.width + size_t(c.raster.x);
        layer.raw[i] += glm::dvec3(c.raw);
        layer.weighted[i] += glm::dvec3(c.weighted);
      }
    }
}

void write_pyramid(const Pyramid& pyramid, const Film& film, const std::string& folder) {
  make_folder(folder);
  clear_layers(folder);
  for (const auto& [st, layer] : pyramid.layers) {
    const std::string base = fmt::format("{}/{}{}t{}", folder, st.first < 0 ? 'm' : 's', std::abs(st.first), st.second);
    write_exr(base + ".exr", average(film, layer.weighted, st.second == 1));
    write_exr(base + "-raw.exr", average(film, layer.raw, st.second == 1));
  }
}

}  // namespace ajar
