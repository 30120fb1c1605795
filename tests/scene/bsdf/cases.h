// Enters: nothing.
// Leaves: materials of every kind, with their sharp and odd variants, resolved in their own frame for the tests.
#pragma once

#include <initializer_list>
#include <ostream>
#include <string>
#include <vector>

#include "ajar/core/sampler.h"
#include "ajar/scene/bsdf.h"
#include "ajar/scene/scene.h"

namespace ajar::test {

/// A material tree, root first.
struct Case {
  std::string name;
  std::vector<Material> materials;
  bool transmits = false;  ///< scatters to the other side
  bool behind = false;     ///< does something when seen from behind
  bool bent = false;       ///< its parts have normals of their own
};

inline std::ostream& operator<<(std::ostream& out, const Case& c) { return out << c.name; }

std::vector<Case> cases();
std::vector<Case> smooth_cases();  ///< those with a part that is not a delta
std::vector<Case> delta_cases();   ///< those with a delta

/// The case by its name.
Case find_case(const std::string& name);

/// A scene of one shape with the materials, prepared.
Scene scene_of(const std::vector<Material>& materials);

/// Resolved on the plane z = 0 whose frame is the world's.
struct Resolved {
  Scene scene;
  Surface surface;
  Bsdf bsdf;
};
Resolved resolved(const std::vector<Material>& materials, const Vec3& wo = {0, 0, 1});

inline Vec3 direction(float theta, float phi) {
  return {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
}
/// Uniform over the sphere.
Vec3 random_direction(Sampler& sampler);

Material material(MaterialKind kind);
Material microfacet(MaterialKind kind, Microfacet distribution, float alpha_u, float alpha_v);
Material parent(MaterialKind kind, std::initializer_list<uint32_t> nested);
Material with_normal(const Vec3& n, uint32_t nested);

}  // namespace ajar::test
