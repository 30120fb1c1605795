// Enters: light descriptions.
// Leaves: points on lights with their radiance and densities, for next-event estimation and for emission.
#pragma once

#include "ajar/core/distribution.h"
#include "ajar/scene/lighttree.h"
#include "ajar/scene/texture.h"

namespace ajar {

enum class LightKind : uint8_t { area, constant, envmap, point, spot, directional, projector, sun };

/// Whether its light comes from infinitely far away.
inline bool is_infinite(LightKind kind) {
  return kind == LightKind::constant || kind == LightKind::envmap || kind == LightKind::directional ||
         kind == LightKind::sun;
}

/// Whether no ray finds it: a place or a direction alone.
inline bool has_no_extent(LightKind kind) {
  return kind == LightKind::point || kind == LightKind::spot || kind == LightKind::projector ||
         kind == LightKind::directional;
}

/// A mesh light that is one rectangle: corner + a x + b y, 0 <= a, b <= 1, shines to the side of cross(x, y).
struct Rectangle {
  Vec3 corner{0}, x{0}, y{0};
  Vec3 normal{0, 0, 1};  ///< unit
  float area = 0;        ///< 0: it is no rectangle
  float error = 0;       ///< LightPoint::error of its points
};

struct Light {
  LightKind kind = LightKind::area;
  Slot radiance{1.0f};  ///< area, constant, sun: radiance [W/(m^2 sr)]; directional: irradiance on a perpendicular
                        ///< plane; point, spot: intensity [W/sr]; projector: the same along its axis, see plane
  float sampling_weight = 1;    ///< the user's factor on the chance of being chosen; 0: rays alone find it
  uint32_t shape = none;        ///< area: index into Scene::shapes
  uint32_t environment = none;  ///< envmap: index into Scene::environments
  Mat4 to_world{1};             ///< envmap, spot, projector: orientation (the latter two: position too)
  Mat3 to_local{1};             ///< inverse of to_world's linear part; made by finish
  Vec3 position{0};             ///< point, spot, projector
  Vec3 direction{0, 0, 1};      ///< spot, directional, sun: where the light travels to, unit
  float cone = 0;               ///< sun: 1 - cos of half the angle that it is seen under
  float cutoff = pi / 2;        ///< spot: nothing outside this angle to its direction, at most pi
  float beam = 0;               ///< spot: full intensity inside; between the two it falls linearly with the angle
  Vec2 plane{1, 1};             ///< projector: half extents of its picture at distance 1, seen as by a Camera; the
                                ///< intensity rises with cos^-3 from the axis, so that a screen across it is lit evenly
  bool textured = false;        ///< radiance has a texture; made by finish
  Rectangle rectangle;          ///< area: untextured rectangles; made by finish
};

/// A point of a light. For infinite lights n is the direction *of travel* of the light, from infinity into the scene,
/// and p any point of its ray.
struct LightPoint {
  Vec3 p{0};
  float error = 0;
  Vec3 n{0};   ///< area: unit normal of the emitting side; infinite: direction of travel; point, spot, projector: zero
  Vec2 uv{0};  ///< area: of the shape; sample_direct gives it for textured lights alone
  uint32_t light = none;
  uint32_t prim = 0;
  uint32_t place = none;  ///< of its piece in the light tree, where next-event estimation or emission chose one
  bool infinite = false;
  bool delta_position = false;   ///< point, spot, projector: a ray cannot hit it
  bool delta_direction = false;  ///< directional: a ray cannot find it
};

/// Next-event estimation: light as seen from a reference point.
struct DirectSample {
  LightPoint point;
  Vec3 wi{0};          ///< from the reference point to the light, unit
  float distance = 0;  ///< infinity for infinite lights
  Rgb radiance{0};     ///< arriving, unoccluded; with 1/d^2 for points, spots and projectors; NOT divided by pdf
  float pdf = 0;       ///< solid-angle density at the reference point [1/sr]; 1 for deltas; without the choice of light
};

/// Emission: the start of a light subpath.
struct EmissionSample {
  LightPoint point;         ///< infinite: p is a point on the disk from which the ray starts, outside the scene
  Vec3 direction{0};        ///< of travel, unit
  Rgb radiance{0};          ///< NOT divided by any pdf; point, spot, projector: intensity; directional: irradiance
  float pdf_position = 0;   ///< area: per area; infinite: per area of the disk across the scene; others: 1
  float pdf_direction = 0;  ///< per solid angle; 1 for directional
};

/// One light seen from x. u in [0,1)^2. False where this sample gives x nothing. Spheres seen from outside are sampled
/// by the cone that they fill, near rectangles by solid angle, other shapes by area, cylinders that of what faces x.
bool sample_direct(const Scene& scene, uint32_t light, const Vec3& x, const Vec2& u, DirectSample& out);
/// A piece of a light (lighttree.h) seen from x, the same way; pdf is without the choice of the piece. Triangles are
/// sampled by area.
bool sample_direct(const Scene& scene, const LightPiece& piece, const Vec3& x, const Vec2& u, DirectSample& out);
/// Whether a piece is a tile of a light's sphere: then sample_direct and sample_emission leave its density at 0, and
/// the densities below are to be asked: several tiles may reach to the same direction.
bool is_tile(const Scene& scene, const LightPiece& piece);
/// Density with which a piece finds a point; see is_tile.
struct PieceDensity {
  uint32_t place = none;  ///< in the light tree
  float pdf = 0;          ///< as DirectSample::pdf; 1 for deltas
};
inline constexpr int most_shares = 4;
/// Fills the pieces that find a point of a light from x along unit wi; returns how many there are.
int densities_direct(const Scene& scene, const LightPoint& point, const Vec3& x, const Vec3& wi,
                     PieceDensity out[most_shares]);
/// The piece that finds a point of a light, above others; none if it is never chosen.
uint32_t place_at(const Scene& scene, const LightPoint& point);
/// False where no point of the light can shine on the side of x that n points to; quick, and true in doubt.
bool may_light(const Scene& scene, uint32_t light, const Vec3& x, const Vec3& n);
/// Solid-angle density with which sample_direct at x would have found this point of this light along unit wi; 0 for
/// deltas.
float pdf_direct(const Scene& scene, const LightPoint& point, const Vec3& x, const Vec3& wi);
/// Emission of one light. u_position, u_direction in [0,1)^2.
bool sample_emission(const Scene& scene, uint32_t light, const Vec2& u_position, const Vec2& u_direction,
                     EmissionSample& out);
/// Puts an infinite light's point onto the disk across the scene, evenly, for its direction. u in [0,1)^2.
void place_on_disk(const Scene& scene, const Vec2& u, EmissionSample& out);
/// Densities with which sample_emission would have started here in this direction of travel.
struct EmissionPdf {
  float position = 0, direction = 0;
};
EmissionPdf pdf_emission(const Scene& scene, const LightPoint& point, const Vec3& direction);
/// Emission of one piece; the densities are those of the piece alone.
bool sample_emission(const Scene& scene, const LightPiece& piece, const Vec2& u_position, const Vec2& u_direction,
                     EmissionSample& out);
/// The pieces that emission finds this point by, in this direction of travel: with densities of position, or, for
/// infinite lights, of direction.
int densities_emission(const Scene& scene, const LightPoint& point, const Vec3& direction,
                       PieceDensity out[most_shares]);

/// Radiance that leaves an emissive surface point towards unit wo; black on the back (emission is one-sided, ng's
/// side).
Rgb emitted(const Scene& scene, const Surface& at, const Vec3& wo);
/// The light point of an emissive surface that a ray hit; light == none where the surface does not emit.
LightPoint light_point(const Scene& scene, const Surface& at);
/// Radiance of one infinite light arriving from world direction w (unit, towards infinity); black for directional.
Rgb environment(const Scene& scene, uint32_t light, const Vec3& w);
/// The light point of an infinite light that an escaping ray of direction w found.
LightPoint light_point(const Scene& scene, uint32_t light, const Vec3& w);
/// Emitted power [W] (luminance) used to choose among lights; infinite lights with the scene's bounding sphere. Never 0
/// for a light that emits somewhere.
float power(const Scene& scene, uint32_t light);
/// Integral of a spot's intensity over directions, relative to that along its axis.
double spot_solid_angle(const Light& light);

/// Image map over the sphere, bilinear. In the light's own space y is up and the direction (sin phi sin theta, cos
/// theta, -cos phi sin theta) looks up u = phi / (2 pi), v = theta / pi, v = 0 on top: the latitude-longitude
/// convention of Mitsuba 0.x. Polar, as in its later versions, the centres of the first and last row of texels are at
/// the poles, v = 0 and 1. Directions are drawn from the bilinear interpolation of luminance times sin(theta) at the
/// texels: positive wherever the map is.
struct Environment {
  uint32_t image = none;
  float scale = 1;
  bool polar = false;
  Distribution2D table;  ///< made by make_environment: the share of each texel
};
/// Throws Error where a texel is negative or not finite, or is not when times scale.
Environment make_environment(const Scene& scene, uint32_t image, float scale, bool polar = false);

}  // namespace ajar
