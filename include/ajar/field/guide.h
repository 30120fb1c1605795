// Enters: a bsdf at a point, and the point's cell of the learned fields.
// Leaves: the one seam through which a direction is sampled or its density evaluated, for camera and light subpaths
// alike.
#pragma once

#include "ajar/core/sampler.h"
#include "ajar/field/fields.h"
#include "ajar/scene/bsdf.h"
#include "ajar/scene/geometry.h"

namespace ajar {

/// Of (G4), for directions on one side of the surface: how often the field is drawn from there, and how often the bsdf.
struct Mix {
  float field = 0, bsdf = 1;
};

/// What the other side's walks do here that go on to wo: from wo's side of the surface (near), or from beyond it (far).
struct BackMix {
  Mix near, far;
  float pdf = 0;  ///< density of their field alone
};

/// Everything that scatters at one vertex. Built once per vertex by make_guide; world directions, unit, away from the
/// surface. Side by side with wo is near, on the surface's other side far: what is opaque has near alone.
struct Guide {
  Frame frame;       ///< shading frame, turned as twosided, bump and normal maps asked
  Vec3 ng{0, 0, 1};  ///< geometric normal on the shading normal's side
  Vec3 p{0};         ///< the vertex
  Vec3 wo{0};        ///< world direction to the previous vertex
  Vec3 wo_local{0};
  float adjoint = 1;         ///< |wo.ns| / |wo.ng|: half of the shading-normal correction (Veach 1997, equation 5.19)
  bool bent = false;         ///< the shading normal differs from the geometric one
  bool blocked = false;      ///< the normals disagree about the side of wo: nothing scatters
  Side side = Side::camera;  ///< whose subpath this is: Q guides the camera's, W the light's
  const Fields* fields = nullptr;  ///< null: unguided
  uint32_t cell = none;            ///< near
  uint32_t far_cell = none;        ///< where light is scattered through
  CellKey missing = 0;             ///< the cell that should have been found
  Mix near, far;                   ///< with which this side's field is mixed in; bsdf alike in both
  BackMix back;
  float through = 0;  ///< of what is scattered, the share that goes through
  Bsdf bsdf;
};

/// f_cos is f |cos(ns, wi)|, with the shading-normal correction where Mode is importance; densities per solid angle.
struct GuideEval {
  Rgb f_cos{0};
  float pdf = 0;
  float pdf_reverse = 0;
};

struct GuideSample {
  Vec3 wi{0};     ///< world, unit
  Rgb weight{0};  ///< f_cos / pdf, already divided
  float pdf = 0;  ///< solid angle; discrete probability for a delta event
  float pdf_reverse = 0;
  float eta = 1;
  bool delta = false;
};

/// Resolves the material at the surface for a viewer in direction wo, and finds the cell. fields may be null.
void make_guide(const Scene& scene, const Fields* fields, Side side, const Surface& surface, const Vec3& wo,
                Guide& out);
/// Whether a direction that is not a delta event can leave here: not from the black back of what is opaque.
inline bool connectable(const Guide& guide) {
  return guide.bsdf.has_smooth && !guide.blocked && (!guide.bsdf.opaque || guide.wo_local.z > 0);
}
/// False where evaluate towards w, of any length, is sure to be black; quick.
inline bool may_scatter(const Guide& guide, const Vec3& w) {
  return !guide.bsdf.opaque || (glm::dot(guide.frame.n, w) > 0 && (!guide.bent || glm::dot(guide.ng, w) > 0));
}
/// Whether a world direction, of any length, is on the surface's other side, as wo's.
inline bool is_far(const Guide& guide, const Vec3& w) {
  return glm::dot(guide.ng, w) * glm::dot(guide.ng, guide.wo) < 0;
}
/// The cell on the direction's side of the surface.
inline uint32_t cell_towards(const Guide& guide, const Vec3& w) {
  return guide.through > 0 && is_far(guide, w) ? guide.far_cell : guide.cell;
}
/// The region that the vertex is in (views.h), no_region if unknown. Its joins through the surface are that region's,
/// too.
inline uint32_t region_of(const Guide& guide) {
  return guide.cell == none ? no_region : guide.fields->cells[guide.cell].region;
}
/// Radiance that a vertex scatters to any one direction per irradiance, taken as diffuse [1/sr]; luminance.
inline float scatters(const Guide& guide) { return luminance(albedo(guide.bsdf, guide.wo_local)) * inv_pi; }
/// Whether fields know the vertex: both of its sides, if light is scattered through.
inline bool is_known(const Guide& guide) {
  return guide.cell != none && (!(guide.through > 0) || guide.far_cell != none);
}
/// What a field brings a vertex that is known and that it can scatter: of either side of the surface by the share that
/// is scattered from there, so that the vertex's albedo times it is what it scatters.
struct Arrival {
  float all = 0;
  float direct = 0;  ///< of it, by next-event estimation (the lens's connection) at the vertex itself
};
inline Arrival arrival(const Field& field, const Guide& guide) {
  const FieldCell& here = field.cells[guide.cell];
  if (guide.far_cell == none) return {here.total, here.direct};
  const FieldCell& there = field.cells[guide.far_cell];
  return {glm::mix(here.total, there.total, guide.through), glm::mix(here.direct, there.direct, guide.through)};
}
/// Radiance that a known vertex is expected to scatter, luminance; never less than this share of a typical
/// value: errors are judged against it.
inline float expected_radiance(const Fields& fields, const Guide& guide, float least) {
  const double out = scatters(guide) * arrival(fields.q, guide).all;
  return float(std::sqrt(sqr(out) + sqr(double(least) * fields.q.unit)));
}
/// What a pixel's error counts for where the lens sees this vertex: errors are judged relative to the image, so the
/// lens's importance is divided by what the field expects the pixel to be. (G5)
inline float relative_importance(const Fields& fields, const Guide& guide) {
  return float(fields.q.unit) / expected_radiance(fields, guide, 0.02f);
}
/// What a subpath of throughput beta that arrives at a vertex is expected to bring, by the field of its side: beta
/// times the radiance (importance) that the vertex scatters, as luminance. 0 where the fields do not know.
struct Promise {
  float all = 0;
  float beyond = 0;  ///< without what next-event estimation (the lens's connection) brings at the vertex itself
};
Promise promise(const Guide& guide, const Rgb& beta);
/// Whether sample reads u_lobe.
inline bool chooses(const Guide& guide) { return guide.bsdf.chooses || guide.near.bsdf < 1; }
/// What the vertex scatters between wo and the unit world direction wi by all but delta events, and with which
/// densities either side would go that way: pdf is sample's, pdf_reverse that of wo for the other side's walk that
/// comes from wi. All zero where nothing can leave towards wi.
GuideEval evaluate(const Guide& guide, const Vec3& wi, Mode mode);
/// The same but for pdf, which is the bsdf's alone. with_field makes of it, where f_cos is not black, that of evaluate:
/// the field is what takes time.
GuideEval evaluate_bsdf(const Guide& guide, const Vec3& wi, Mode mode);
float with_field(const Guide& guide, const Vec3& wi, float bsdf_pdf);
/// Samples wi, delta events among it, from the mixture of field and bsdf: u_lobe and u in [0, 1), u_lobe read only
/// where chooses says so. The weight is divided by the density, and may be black. False where nothing is
/// scattered: then out is not to be read.
bool sample(const Guide& guide, float u_lobe, const Vec2& u, Mode mode, GuideSample& out);

}  // namespace ajar
