#include "ajar/report/fields.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "ajar/accel/sight.h"
#include "ajar/scene/geometry.h"

namespace ajar {
namespace {

// First hit of a pixel's centre.
struct Look {
  uint32_t cell = none;
  Vec3 n{0};        // the cell's normal, where there is a cell
  float shade = 0;  // cosine of the view; 0 where nothing is hit
};

struct Looks {
  int width = 0, height = 0;
  std::vector<Look> at;
};

Looks look(const Scene& scene, const Accel& accel, const Fields& fields) {
  const Camera& camera = scene.camera;
  Looks out{camera.crop_width, camera.crop_height, {}};
  out.at.resize(size_t(out.width) * size_t(out.height));
  for (size_t i = 0; i < out.at.size(); ++i) {
    const int x = int(i) % out.width + camera.crop_x, y = int(i) / out.width + camera.crop_y;
    const CameraRay ray = generate(camera, Vec2(float(x) + 0.5f, float(y) + 0.5f), Vec2(0.5f));
    Hit hit;
    if (!first_seen(scene, accel, ray, hit)) continue;
    const Surface s = make_surface(scene, hit, ray.o, ray.d);
    const float cosine = glm::dot(s.ng, ray.d);
    out.at[i].shade = std::abs(cosine);
    out.at[i].cell = find(fields.table, s.p, cosine > 0 ? -s.ng : s.ng).cell;
    if (out.at[i].cell != none) out.at[i].n = fields.cells[out.at[i].cell].frame.n;
  }
  return out;
}

Rgb grey(const Look& l) { return Rgb(0.12f * l.shade); }

// Black, blue, green, yellow, white, each lighter than the one before.
Rgb ramp(float x) {
  static constexpr float stops[][3] = {
      {0, 0, 0}, {0.02f, 0.04f, 0.35f}, {0.02f, 0.35f, 0.25f}, {0.9f, 0.6f, 0.02f}, {1, 1, 1}};
  const float at = std::clamp(x, 0.0f, 1.0f) * 4;
  const int i = std::min(int(at), 3);
  const auto color = [&](int k) { return Rgb(stops[k][0], stops[k][1], stops[k][2]); };
  return glm::mix(color(i), color(i + 1), at - float(i));
}

Rgb color_of(CellKey key) {
  const uint64_t h = mix64(key);
  const auto part = [&](int i) { return 0.08f + 0.92f * sqr(float((h >> (16 * i)) & 0xffff) / 65535.0f); };
  return {part(0), part(1), part(2)};
}

template <class Paint>
Picture paint(const Looks& looks, const Paint& color) {
  Picture out{looks.width, looks.height, {"R", "G", "B"}, {}};
  for (const Look& l : looks.at) {
    const Rgb c = color(l);
    out.pixels.insert(out.pixels.end(), {c.x, c.y, c.z});
  }
  return out;
}

// Pixels apart from each other and from the border, as evenly spread as may be: each the farthest from all before.
std::vector<glm::ivec2> spread(const Looks& looks, const Field& field, int border, size_t most) {
  std::vector<glm::ivec2> candidates, chosen;
  for (int y = border; y < looks.height - border; y += 2)
    for (int x = border; x < looks.width - border; x += 2) {
      const Look& l = looks.at[size_t(y) * size_t(looks.width) + size_t(x)];
      if (l.cell != none && field.cells[l.cell].mix > 0) candidates.emplace_back(x, y);
    }
  std::vector<int> distance2(candidates.size(), std::numeric_limits<int>::max());
  while (!candidates.empty() && chosen.size() < most) {
    const size_t next = size_t(std::max_element(distance2.begin(), distance2.end()) - distance2.begin());
    if (distance2[next] < 4 * border * border) break;
    chosen.push_back(candidates[next]);
    for (size_t i = 0; i < candidates.size(); ++i) {
      const glm::ivec2 d = candidates[i] - chosen.back();
      distance2[i] = std::min(distance2[i], d.x * d.x + d.y * d.y);
    }
  }
  return chosen;
}

// What the field's stratum is believed to be, towards unit world direction w above the cell.
float mean_of(const Fields& fields, const Field& field, uint32_t cell, const Vec3& w) {
  return field.mean[find_stratum(fields, field, cell, fields.cells[cell].frame.to_local(w))];
}

// Draws the strata of a cell as a disk about a pixel.
void draw_disk(Picture& out, const Scene& scene, const Fields& fields, const Field& field, const Look& l,
               const glm::ivec2& centre, int radius) {
  const Vec3 up(scene.camera.to_world[1]), ahead(scene.camera.to_world[2]);
  // Upright, and seen from in front: up is the camera's as far as the surface allows, on floors what lies ahead of it.
  const bool flat = std::abs(glm::dot(glm::normalize(up), l.n)) > 0.8f;
  const Vec3 y = make_frame(l.n, flat ? ahead : up).s, x = glm::cross(y, l.n);
  std::vector<std::pair<size_t, float>> values;
  float largest = 0;
  for (int j = -radius; j <= radius; ++j)
    for (int i = -radius; i <= radius; ++i) {
      const Vec2 d = Vec2(float(i), float(-j)) / (float(radius) + 0.5f);
      const float r2 = glm::dot(d, d);
      if (r2 >= 1) continue;
      const float value = mean_of(fields, field, l.cell, x * d.x + y * d.y + l.n * std::sqrt(1 - r2));
      const size_t at = size_t(centre.y + j) * size_t(out.width) + size_t(centre.x + i);
      values.emplace_back(at, r2 > sqr(1 - 1.5f / float(radius)) ? -1 : value);
      largest = std::max(largest, value);
    }
  for (const auto& [at, value] : values) {
    const Rgb c = value < 0     ? Rgb(0.4f)
                  : largest > 0 ? ramp(1 + std::log10(std::max(value / largest, 1e-9f)) / 3)
                                : Rgb(0);
    for (int k = 0; k < 3; ++k) out.pixels[3 * at + size_t(k)] = c[k];
  }
}

std::string counts(const std::vector<size_t>& by_level) {
  std::string out;
  for (size_t i = 0; i < by_level.size(); ++i)
    if (by_level[i] > 0) out += fmt::format("{}level {}: {}", out.empty() ? "" : ", ", i, by_level[i]);
  return out.empty() ? "none" : out;
}

void count_nodes(const Field& field, uint32_t node, size_t level, std::vector<size_t>& by_level) {
  ++by_level[level];
  for (int i = 0; i < 16; ++i)
    if (field.nodes[node].is_divided(i)) count_nodes(field, field.nodes[node].child(i), level + 1, by_level);
}

std::string describe(const Field& field, const char* name, const char* amount) {
  std::vector<size_t> by_level(most_levels), by_mix(5);
  std::vector<float> totals;
  for (const FieldCell& c : field.cells) {
    count_nodes(field, c.root, 0, by_level);
    ++by_mix[std::min(size_t(c.mix * 5), by_mix.size() - 1)];
    if (c.total > 0) totals.push_back(c.total);
  }
  std::string out = fmt::format("{}: {} nodes of 16 strata; {}\n", name, field.nodes.size(), counts(by_level));
  out += fmt::format("  cells by share of the strata in sampling: 0 to 0.2: {}", by_mix[0]);
  for (size_t i = 1; i < by_mix.size(); ++i)
    out += fmt::format(", {:.1f} to {:.1f}: {}", 0.2 * double(i), 0.2 * double(i + 1), by_mix[i]);
  out += fmt::format("\n  {}: ", amount);
  if (totals.empty()) return out + "none anywhere\n";
  std::sort(totals.begin(), totals.end());
  return out + fmt::format("{:.3g} to {:.3g}, median {:.3g}; none in {} cells\n", totals.front(), totals.back(),
                           totals[totals.size() / 2], field.cells.size() - totals.size());
}

}  // namespace

std::string describe(const StoredFields& stored) {
  const Fields& f = stored.fields;
  std::vector<size_t> by_level(most_cell_levels + 1);
  for (const Cell& c : f.cells) ++by_level[size_t(level_of(c.key))];
  return fmt::format("scene: {}\n", stored.scene) +
         fmt::format("learned {} times; whoever goes on from them begins with pass {}; {} bytes\n", f.generation,
                     stored.passes, bytes(f)) +
         fmt::format("{}, {} cells; {}; edge at level 0: {:.3g}\n", structure_names[size_t(f.structure)],
                     f.cells.size(), counts(by_level), f.table.width) +
         describe(f.q, "Q", "irradiance [W/m^2]") + describe(f.w, "W", "importance [pixels/m^2]");
}

Picture picture_cells(const Scene& scene, const Accel& accel, const Fields& fields) {
  return paint(look(scene, accel, fields), [&](const Look& l) {
    return l.cell == none ? grey(l) : color_of(fields.cells[l.cell].key) * (0.3f + 0.7f * l.shade);
  });
}

FalseColour picture_totals(const Scene& scene, const Accel& accel, const Fields& fields, Side side) {
  const Looks looks = look(scene, accel, fields);
  const auto total = [&](const Look& l) { return l.cell == none ? 0 : fields.of(side).cells[l.cell].total; };
  std::vector<float> seen;
  for (const Look& l : looks.at)
    if (total(l) > 0) seen.push_back(total(l));
  FalseColour out;
  if (!seen.empty()) {
    std::sort(seen.begin(), seen.end());
    out.low = seen[seen.size() / 200], out.high = seen[seen.size() - 1 - seen.size() / 200];
  }
  const float octaves = std::log2(out.high / out.low);
  out.picture = paint(looks, [&](const Look& l) {
    if (!(total(l) > 0)) return grey(l);
    return ramp(octaves > 0 ? std::log2(total(l) / out.low) / octaves : 1);
  });
  return out;
}

Picture picture_strata(const Scene& scene, const Accel& accel, const Fields& fields, Side side) {
  const Looks looks = look(scene, accel, fields);
  Picture out = paint(looks, [](const Look& l) { return Rgb(0.25f * l.shade); });
  const int radius = std::min(looks.width, looks.height) / 10;
  for (const glm::ivec2& at : spread(looks, fields.of(side), radius + 1, 16))
    draw_disk(out, scene, fields, fields.of(side), looks.at[size_t(at.y) * size_t(looks.width) + size_t(at.x)], at,
              radius);
  return out;
}

}  // namespace ajar
