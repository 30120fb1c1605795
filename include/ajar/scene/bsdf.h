// Enters: a material, a surface point and the direction it is seen from.
// Leaves: a Bsdf, the material evaluated there as a plain value, with eval, pdf and sample in the local shading frame.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstring>

#include "ajar/scene/bsdf/lobes.h"
#include "ajar/scene/material.h"

namespace ajar {

/// What the path carries through the surface; they differ by eta^2 at refraction (Veach 1997, section 5.2).
enum class Mode : uint8_t { radiance, importance };

inline constexpr int max_lobes = 4;

/// A bsdf at one point: a weighted sum of lobes, textures evaluated. A plain value, copied freely while the scene
/// lives; what lies beyond count is never written, read or copied.
struct Bsdf {
  int count = 0;            ///< lobes in use; 0 absorbs what does not pass
  bool has_smooth = false;  ///< some lobe is not a delta: the vertex can be connected to
  bool has_delta = false;
  bool chooses = false;  ///< sample reads u_lobe
  bool opaque = true;    ///< f is 0 unless both directions are in front
  bool bent = false;     ///< lobes have normals of their own
  bool two_faced = false;  ///< there is another material behind
  float opacity = 1;  ///< 1 - opacity of the light passes straight through as a delta; weights account for it already
  float pass = 0;     ///< probability of sampling that passage; choice adds up to the rest
  float weights[max_lobes];
  float choice[max_lobes];  ///< probability of sampling each lobe: does not depend on direction, so the same both ways
  Lobe lobes[max_lobes];
  Vec3 normals[max_lobes];  ///< where bent: each lobe's, unit, in the frame of the directions

  Bsdf() = default;
  Bsdf(const Bsdf& o) { *this = o; }
  Bsdf& operator=(const Bsdf& o) {
    std::memcpy(static_cast<void*>(this), &o, offsetof(Bsdf, lobes) + size_t(o.count) * sizeof(Lobe));
    if (o.bent) std::copy_n(o.normals, o.count, normals);
    return *this;
  }
};

/// Value and densities for one pair of directions, smooth (non-delta) part only. Of a bent Bsdf f is what makes f times
/// the cosine at the frame's normal the sum of the lobes' values times the cosines at their normals; the cosine in
/// question is the one on the side that light comes from: of wi in radiance, of wo in importance.
struct BsdfEval {
  Rgb f{0};               ///< bsdf [1/sr], without the cosine
  float pdf = 0;          ///< solid-angle density of sampling wi given wo [1/sr]
  float pdf_reverse = 0;  ///< solid-angle density of sampling wo given wi, in the opposite Mode [1/sr]
};

struct BsdfSample {
  Vec3 wi{0};             ///< local, unit
  Rgb weight{0};          ///< f |cos wi| / pdf, already divided; may be black where the density is not zero
  float pdf = 0;          ///< solid-angle density of the smooth part; for a delta event its discrete probability
  float pdf_reverse = 0;  ///< the same for the opposite way (wi -> wo, opposite Mode)
  float eta = 1;          ///< relative index passed: outside of wi over that of wo, 1 for reflection and null
  bool delta = false;
};

/// Evaluates the material of the surface for a viewer in world direction wo (unit, away from the surface). frame is
/// input and output: a copy of surface.frame goes in, and comes out turned and bent as twosided (by the side of ng that
/// wo is on), bump and normal maps ask; local directions below are in that frame. A bent normal stays on the side of ng
/// but not always on the viewer's: there an opaque bsdf is 0, from both sides alike, so that f stays the same function
/// for camera and light paths. Where branches of a sum bend it differently the frame is the one before them, and each
/// lobe has its normal.
void resolve(const Scene& scene, const Surface& surface, const Vec3& wo, Frame& frame, Bsdf& out);

/// f and both densities; zero for directions that only a delta lobe connects. Local directions, unit, away from the
/// surface.
BsdfEval eval(const Bsdf& bsdf, const Vec3& wo, const Vec3& wi, Mode mode);
/// Chooses lobe and direction; false when nothing was found (absorbed). u_lobe and u in [0, 1). A smooth sample has the
/// f and the densities of eval.
bool sample(const Bsdf& bsdf, const Vec3& wo, float u_lobe, const Vec2& u, Mode mode, BsdfSample& out);
/// Directional-hemispherical reflectance estimate for AOVs and roulette; in [0, 1] per channel for physical inputs. The
/// passage of a mask counts too.
Rgb albedo(const Bsdf& bsdf, const Vec3& wo);
/// Roughness (alpha) of its narrowest lobe that is no delta; 1 where there is none, and of diffuse ones.
float least_roughness(const Bsdf& bsdf);

}  // namespace ajar
