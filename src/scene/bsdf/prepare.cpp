#include <fmt/format.h>

#include <map>
#include <tuple>

#include "ajar/core/error.h"
#include "ajar/core/parallel.h"
#include "ajar/scene/bsdf.h"
#include "ajar/scene/bsdf/table.h"
#include "ajar/scene/scene.h"
#include "rough.h"

namespace ajar {

namespace {

// Mean of value(m) over n * n normals that are visible from wo.
template <int n, class Value>
float mean_over_facets(const Facets& f, const Vec3& wo, const Value& value) {
  // Midpoints after u = t^2 (3 - 2t), which flattens the integrand's steep ends.
  const auto at = [](int i) { return (float(i) + 0.5f) / n; };
  const auto warp = [](float t) { return t * t * (3 - 2 * t); };
  const auto density = [](float t) { return 6 * t * (1 - t); };
  double sum = 0, weights = 0;
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      const double weight = density(at(i)) * density(at(j));
      weights += weight;
      sum += weight * value(sample_facet(f, wo, {warp(at(i)), warp(at(j))}));
    }
  }
  return float(sum / weights);
}
Vec3 along(float cos) { return {safe_sqrt(1 - cos * cos), 0, std::max(cos, 1e-6f)}; }

}  // namespace

float rough_transmittance(Microfacet kind, float alpha, float ior, float cos) {
  const Facets f{alpha, alpha, kind};
  const Vec3 wo = along(cos);
  return mean_over_facets<16>(f, wo, [&](const Vec3& m) {
    float cos_t;
    const float through = 1 - fresnel_dielectric(glm::dot(wo, m), ior, cos_t);
    const Vec3 wi = refracted(wo, m, ior, cos_t);
    return wi.z < 0 ? through * 2 * facet_visibility(f, wi) * -wi.z : 0;
  });
}

float rough_reflectance(Microfacet kind, float alpha, float ior, float cos) {
  const Facets f{alpha, alpha, kind};
  const Vec3 wo = along(cos);
  return mean_over_facets<32>(f, wo, [&](const Vec3& m) {  // total reflection begins at an edge
    const Vec3 wi = mirrored(wo, m);
    return wi.z > 0 ? fresnel_dielectric(glm::dot(wo, m), ior) * 2 * facet_visibility(f, wi) * wi.z : 0;
  });
}

namespace {

constexpr int max_nesting = 64;

// What turns or bends the normal: branches of a sum that turn it alike share one frame.
struct Outline {
  int lobes = 0;
  bool turns = false, bends = false;
  bool splits = false;
  std::string problem;
};

Outline outline_of(const Scene& scene, uint32_t id, int depth);

Outline outline_of_branches(const Scene& scene, const Material& m, int depth) {
  Outline sum;
  bool first = true;
  for (const uint32_t nested : m.nested) {
    if (nested == none) continue;
    const Outline branch = outline_of(scene, nested, depth + 1);
    if (!branch.problem.empty()) return branch;
    if (branch.lobes == 0) continue;  // null scatters nothing
    sum.lobes += branch.lobes;
    sum.splits |= branch.bends || (!first && branch.turns != sum.turns);
    sum.turns |= branch.turns;
    sum.bends |= branch.bends;
    first = false;
  }
  sum.bends |= sum.splits;  // for the sum that this one may be in
  return sum;
}

Outline outline_of(const Scene& scene, uint32_t id, int depth) {
  if (depth > max_nesting) return {.problem = fmt::format("nested more than {} deep, or inside itself", max_nesting)};
  if (id >= scene.materials.size()) return {.problem = "a nested bsdf is missing"};
  const Material& m = scene.materials[id];
  Outline outline;
  switch (m.kind) {
    case MaterialKind::null:
      return outline;
    case MaterialKind::blend:
      if (m.nested[0] == none || m.nested[1] == none) return {.problem = "a nested bsdf is missing"};
      [[fallthrough]];
    case MaterialKind::mixture:
      return outline_of_branches(scene, m, depth);
    case MaterialKind::mask:
      return outline_of(scene, m.nested[0], depth + 1);
    case MaterialKind::twosided: {
      outline = outline_of(scene, m.nested[0], depth + 1);
      const Outline behind = m.nested[1] == none ? Outline{} : outline_of(scene, m.nested[1], depth + 1);
      outline.lobes = std::max(outline.lobes, behind.lobes);
      outline.bends |= behind.bends;
      outline.turns = true;
      if (outline.problem.empty()) outline.problem = behind.problem;
      return outline;
    }
    case MaterialKind::bumpmap:
    case MaterialKind::normalmap:
      outline = outline_of(scene, m.nested[0], depth + 1);
      outline.bends = true;
      return outline;
    default:
      outline.lobes = 1;
      return outline;
  }
}

float alpha_of_row(int row) {
  if (row <= table_alphas) return sqr(float(row) / table_alphas);
  const int left = table_alphas + table_wide_alphas - row;
  return left > 0 ? sqr(float(table_wide_alphas) / float(left)) : widest_in_table;
}

// eta^2 (1 - R), R being the share of diffuse light inside that the boundary reflects.
float not_reflected_inside(const Material& m, float alpha) {
  constexpr int n = 32;
  const float critical = safe_sqrt(1 - 1 / (m.ior * m.ior));  // cosine: below it a smooth boundary reflects everything
  double reflected = 0;
  for (int i = 0; i < n; ++i) {
    const float t = (float(i) + 0.5f) / n;
    for (const auto& [cos, width] :
         {std::pair{critical * t, critical}, {critical + (1 - critical) * t * t, (1 - critical) * 2 * t}})
      reflected += 2.0 / n * double(cos * width) * rough_reflectance(m.distribution, alpha, 1 / m.ior, cos);
  }
  return float(double(m.ior) * m.ior * (1 - reflected));
}

void fill_table(Material& m) {
  const bool textured = m.alpha_u.texture != none && m.inner != Inner::lost;
  const int rows = textured ? table_alphas + table_wide_alphas + 1 : 1;
  m.entering_table.resize(size_t(rows) * table_row);
  for (int r = 0; r < rows; ++r) {
    const float alpha = textured ? alpha_of_row(r) : scalar_of(m.alpha_u.value);
    float* row = m.entering_table.data() + r * table_row;
    double mean = 0;
    for (int i = 0; i <= table_cosines; ++i) {
      const float cos = float(i) / table_cosines;
      row[1 + i] = m.inner == Inner::lost ? 1 - fresnel_dielectric(cos, m.ior)
                                          : rough_transmittance(m.distribution, std::max(alpha, min_alpha), m.ior, cos);
      mean += (i == table_cosines ? 1 : 2) * double(cos) * row[1 + i];
    }
    row[0] = float(mean / table_cosines);
    // At least what enters leaves: rounding aside.
    row[table_leaving] = m.hides ? std::max(not_reflected_inside(m, std::max(alpha, min_alpha)), row[0]) : row[0];
  }
}

// Rough plastics of one boundary share a table's numbers.
void fill_tables(Scene& scene) {
  std::map<std::tuple<float, Microfacet, float, bool, bool>, std::vector<Material*>> boundaries;
  for (Material& m : scene.materials)
    if (m.kind == MaterialKind::roughplastic)
      boundaries[{m.ior, m.distribution, m.alpha_u.texture != none ? -1 : scalar_of(m.alpha_u.value), m.hides,
                  m.inner == Inner::lost}]
          .push_back(&m);
  std::vector<std::vector<Material*>> apart;
  for (auto& [boundary, materials] : boundaries) apart.push_back(std::move(materials));
  parallel_for(apart.size(), [&](size_t i) {
    fill_table(*apart[i][0]);
    for (Material* m : apart[i]) m->entering_table = apart[i][0]->entering_table;
  });
}

}  // namespace

std::string material_problem(const Scene& scene, uint32_t material) {
  const Outline outline = outline_of(scene, material, 0);
  if (!outline.problem.empty()) return outline.problem;
  if (outline.lobes > max_lobes)
    return fmt::format("it adds up to {} elementary bsdfs, {} are possible: leave some out", outline.lobes, max_lobes);
  return {};
}

int lobe_count(const Scene& scene, uint32_t material) { return outline_of(scene, material, 0).lobes; }

bool wants_tangents(const Scene& scene, uint32_t material) {
  const Material& m = scene.materials[material];
  if (m.kind == MaterialKind::bumpmap || m.kind == MaterialKind::normalmap) return true;
  if (m.kind == MaterialKind::principled) return m.anisotropic.texture != none || m.anisotropic.value != Rgb(0);
  if (m.kind == MaterialKind::roughconductor || m.kind == MaterialKind::roughdielectric ||
      m.kind == MaterialKind::ward || (m.kind == MaterialKind::roughplastic && m.inner == Inner::lost))
    return m.alpha_u.texture != m.alpha_v.texture || m.alpha_u.value != m.alpha_v.value;
  return std::any_of(m.nested.begin(), m.nested.end(),
                     [&](uint32_t id) { return id != none && wants_tangents(scene, id); });
}

void prepare_materials(Scene& scene) {
  for (uint32_t i = 0; i < scene.materials.size(); ++i) {
    if (const std::string problem = material_problem(scene, i); !problem.empty())
      throw Error(fmt::format("bsdf {} of the scene: {}", i, problem));
    Material& m = scene.materials[i];
    m.splits = outline_of(scene, i, 0).splits;
    m.entering = float(1 - fresnel_diffuse(m.ior));
  }
  fill_tables(scene);
}

}  // namespace ajar
