#include "primaries.h"

#include <cmath>

namespace ajar {
namespace {

constexpr Chromaticities rec709{0.64f, 0.33f, 0.3f, 0.6f, 0.15f, 0.06f, 0.3127f, 0.329f};

glm::dvec3 xyz_of(const Chromaticities& c, size_t i) { return {c[2 * i], c[2 * i + 1], 1.0 - c[2 * i] - c[2 * i + 1]}; }

// Its columns are red, green and blue as XYZ, which add up to white of luminance 1 (SMPTE RP 177).
glm::dmat3 to_xyz(const Chromaticities& c) {
  glm::dmat3 m(xyz_of(c, 0), xyz_of(c, 1), xyz_of(c, 2));
  const glm::dvec3 white = xyz_of(c, 3), shares = glm::inverse(m) * (white / white.y);
  for (int i = 0; i < 3; ++i) m[i] *= shares[i];
  return m;
}

}  // namespace

bool are_rec709(const Chromaticities& c) {
  float distance2 = 0;
  for (size_t i = 0; i < c.size(); ++i) distance2 += sqr(c[i] - rec709[i]);
  return distance2 < 1e-6f;
}

std::optional<Mat3> to_rec709(const Chromaticities& c) {
  const double area = glm::determinant(glm::dmat3(xyz_of(c, 0), xyz_of(c, 1), xyz_of(c, 2)));
  if (!(std::abs(area) > 1e-6) || !(std::abs(c[7]) > 1e-6f)) return {};
  const Mat3 m(glm::inverse(to_xyz(rec709)) * to_xyz(c));
  for (int i = 0; i < 3; ++i)
    if (!is_finite(m[i])) return {};
  return m;
}

}  // namespace ajar
