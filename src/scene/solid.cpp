#include "solid.h"

#include "ajar/core/frame.h"
#include "ajar/core/warp.h"

namespace ajar {
namespace {

// The cone that a sphere fills, for a point outside.
struct Cone {
  Vec3 axis{0, 0, 1};  // from x to the centre
  float sine = 1;      // of half the angle: radius / distance of the centre
  float rest = 0;      // 1 / sine^2 - 1, which cancels near the sphere
  float height = 1;    // 1 - cosine of half the angle
};

// False inside (or on the surface), and for spheres that shine inwards: then area is sampled.
bool cone_of(const Shape& sphere, const Vec3& x, Cone& cone) {
  if (sphere.flip) return false;
  const glm::dvec3 to_center = glm::dvec3(Vec3(sphere.to_world[3])) - glm::dvec3(x);
  const double d2 = glm::dot(to_center, to_center), r2 = double(length2(Vec3(sphere.to_world[0])));
  if (!(d2 > r2 * (1 + 1e-6))) return false;
  const double sin2 = r2 / d2, d = std::sqrt(d2);
  cone.axis = Vec3(to_center / d);
  cone.sine = float(std::sqrt(sin2));
  cone.rest = float((d2 - r2) / r2);
  cone.height = float(sin2 / (1 + std::sqrt(1 - sin2)));
  return cone.height > 0 && cone.rest < infinity;
}

// Uniform in the cone. With theta the angle of w to the axis, sin(beta) = sin(theta) / sine and alpha = beta - theta
// the angle at the centre; in the forms below nothing cancels, however far or near the sphere is.
bool sample_cone(const Shape& shape, const Light& light, const Cone& cone, const Vec2& u, ShapeSample& out) {
  const Vec3 w = to_cone(u, cone.height);
  const float sin_theta = std::sqrt(w.x * w.x + w.y * w.y), sin_beta = std::min(sin_theta / cone.sine, 1.0f);
  const float cos_beta = safe_sqrt(1 - sin_beta * sin_beta), toward = w.z / cone.sine + cos_beta;
  const float cos_alpha = sin_theta * sin_beta + w.z * cos_beta;
  const float across = cone.rest / toward;  // sin(alpha) / sin(theta)
  const float radius = std::sqrt(length2(Vec3(shape.to_world[0])));
  const Frame frame = make_frame(cone.axis);
  Surface& at = out.at;
  at.ng = frame.s * (w.x * across) + frame.t * (w.y * across) - cone.axis * cos_alpha;
  at.p = Vec3(shape.to_world[3]) + at.ng * radius;
  at.shape = light.shape;
  at.error = position_error(shape, at.p);
  if (light.textured) at.uv = sphere_uv(shape, at.p);
  out.wi = frame.to_world(w);
  out.distance = radius * cone.rest / toward;
  out.pdf = cone_pdf(cone.height);
  return cos_beta > 0 && out.distance > 0 && out.distance < infinity && out.pdf < infinity;
}

// A rectangle as a point sees it, with what is constant in its parametrisation by solid angle (Urena, Fajardo and King
// 2013, An Area-Preserving Parametrization for Spherical Rectangles). In double: angles nearly cancel in their sum.
struct View {
  glm::dvec3 x, y, z;         // axes: edges, and towards the rectangle
  double x0, x1, y0, y1, z0;  // extents and distance of the plane
  double b0, b1, k;           // z of the normals of two side planes; 2 pi less two angles
  double solid = 0;
};

// False where the rectangle is sampled by area: farther away than its diagonal, where that is as good and faster, and
// where x is so near its plane that it is a line. x on the dark side counts as seeing it.
bool view_of(const Rectangle& r, const Vec3& from, View& v) {
  const Vec3 middle = r.corner + 0.5f * (r.x + r.y) - from;
  if (length2(middle) > length2(r.x) + length2(r.y)) return false;
  const glm::dvec3 ex(r.x), ey(r.y), to_corner = glm::dvec3(r.corner) - glm::dvec3(from);
  const double width = glm::length(ex), height = glm::length(ey);
  v.x = ex / width;
  v.y = ey / height;
  v.z = glm::cross(v.x, v.y);
  v.z0 = glm::dot(to_corner, v.z);
  if (v.z0 < 0) v.z = -v.z, v.z0 = -v.z0;
  v.x0 = glm::dot(to_corner, v.x), v.x1 = v.x0 + width;
  v.y0 = glm::dot(to_corner, v.y), v.y1 = v.y0 + height;
  const double z2 = v.z0 * v.z0;
  const double n0 = -v.y0 / std::sqrt(z2 + v.y0 * v.y0), n1 = v.x1 / std::sqrt(z2 + v.x1 * v.x1);
  const double n2 = v.y1 / std::sqrt(z2 + v.y1 * v.y1), n3 = -v.x0 / std::sqrt(z2 + v.x0 * v.x0);
  const double g0 = std::acos(-n0 * n1), g1 = std::acos(-n1 * n2), g2 = std::acos(-n2 * n3), g3 = std::acos(-n3 * n0);
  v.b0 = n0, v.b1 = n2;
  v.k = 2 * std::numbers::pi - g2 - g3;
  v.solid = g0 + g1 - v.k;
  return v.solid > 1e-6;
}

// Uniform in solid angle. Fills place, direction and density.
bool sample_view(const View& v, const Vec3& x, const Vec2& u, DirectSample& out) {
  const double angle = u.x * v.solid + v.k, f = (std::cos(angle) * v.b0 - v.b1) / std::sin(angle);
  const double c = std::clamp(std::copysign(1 / std::sqrt(f * f + v.b0 * v.b0), f), -1.0, 1.0);
  const double px = std::clamp(c * v.z0 / std::sqrt(std::max(1 - c * c, 1e-300)), v.x0, v.x1);
  const double d = std::sqrt(px * px + v.z0 * v.z0);
  const double h0 = v.y0 / std::sqrt(d * d + v.y0 * v.y0), h1 = v.y1 / std::sqrt(d * d + v.y1 * v.y1);
  const double h = h0 + u.y * (h1 - h0);
  const double py = std::clamp(h * d / std::sqrt(std::max(1 - h * h, 1e-300)), v.y0, v.y1);
  const glm::dvec3 between = v.x * px + v.y * py + v.z * v.z0;
  const double distance = glm::length(between);
  out.point.p = Vec3(glm::dvec3(x) + between);
  out.wi = Vec3(between / distance);
  out.distance = float(distance);
  out.pdf = float(1 / v.solid);
  return out.distance > 0;
}

// The same, uniform in area.
bool sample_plane(const Rectangle& r, const Vec3& x, const Vec2& u, DirectSample& out) {
  out.point.p = r.corner + r.x * u.x + r.y * u.y;
  const Vec3 between = out.point.p - x;
  const float d2 = length2(between);
  out.distance = std::sqrt(d2);
  out.wi = between / out.distance;
  out.pdf = d2 / (r.area * -glm::dot(r.normal, out.wi));
  return d2 > 0 && out.pdf < infinity;
}

// The part of a cylinder that faces a point: where in u it is, from 0 to 1 around.
struct Arc {
  double middle = 0.5, width = 1;
};

// All of it where the point is not beside it, or it shines inwards. Whether a point faces another one does not depend
// on how the unit cylinder is stretched.
Arc arc_of(const Shape& shape, const Vec3& x) {
  if (shape.kind != ShapeKind::cylinder || shape.flip) return {};
  const glm::dvec3 at(glm::inverse(glm::dmat4(shape.to_world)) * glm::dvec4(x, 1));
  const double distance = std::hypot(at.x, at.y);
  if (!(distance > 1 + 1e-6 && distance < double(infinity))) return {};
  return {std::atan2(at.y, at.x) / (2 * std::numbers::pi), std::acos(1 / distance) / std::numbers::pi};
}

bool sample_by_area(const Scene& scene, const Light& light, const Vec3& x, const Vec2& u, ShapeSample& out) {
  const Arc arc = arc_of(scene.shapes[light.shape], x);
  const double turn = arc.middle + arc.width * (double(u.x) - 0.5);
  const Vec2 within = arc.width < 1 ? Vec2(turn - std::floor(turn), u.y) : u;
  out.at = sample_light_area(scene, light, within, out.pdf);
  out.pdf /= float(arc.width);
  const Vec3 between = out.at.p - x;
  const float d2 = length2(between);
  if (!(d2 > 0)) return false;
  out.distance = std::sqrt(d2);
  out.wi = between / out.distance;
  const float cosine = -glm::dot(out.at.ng, out.wi);
  if (!(cosine > 0)) return false;
  out.pdf *= d2 / cosine;
  return out.pdf > 0 && out.pdf < infinity;
}

}  // namespace

bool sample_rectangle(const Rectangle& r, const Vec3& x, const Vec2& u, DirectSample& out) {
  if (!(glm::dot(r.normal, x - r.corner) > 0)) return false;
  View view;
  if (!(view_of(r, x, view) ? sample_view(view, x, u, out) : sample_plane(r, x, u, out))) return false;
  out.point.n = r.normal;
  out.point.error = r.error;
  return -glm::dot(r.normal, out.wi) > 0;
}

bool sample_shape(const Scene& scene, const Light& light, const Vec3& x, const Vec2& u, ShapeSample& out) {
  const Shape& shape = scene.shapes[light.shape];
  Cone cone;
  if (shape.kind == ShapeKind::sphere && cone_of(shape, x, cone)) return sample_cone(shape, light, cone, u, out);
  return sample_by_area(scene, light, x, u, out);
}

float shape_pdf(const Scene& scene, const Light& light, const LightPoint& point, const Vec3& x, const Vec3& wi) {
  const float cosine = -glm::dot(point.n, wi);
  if (!(cosine > 0)) return 0;
  View view;
  if (light.rectangle.area > 0 && view_of(light.rectangle, x, view)) return float(1 / view.solid);
  const Shape& shape = scene.shapes[light.shape];
  Cone cone;
  if (shape.kind == ShapeKind::sphere && cone_of(shape, x, cone)) return cone_pdf(cone.height);
  const float by_area = light_area_pdf(scene, light, point) / float(arc_of(shape, x).width);
  const float pdf = by_area * length2(point.p - x) / cosine;
  return pdf < infinity ? pdf : 0;
}

Surface sample_light_area(const Scene& scene, const Light& light, const Vec2& u, float& pdf) {
  const Rectangle& r = light.rectangle;
  if (!(r.area > 0)) return sample_area(scene, light.shape, u, pdf);
  Surface at;
  at.shape = light.shape;
  at.ng = r.normal;
  at.error = r.error;
  at.p = r.corner + r.x * u.x + r.y * u.y;
  pdf = 1 / r.area;
  return at;
}

float light_area_pdf(const Scene& scene, const Light& light, const LightPoint& point) {
  return light.rectangle.area > 0 ? 1 / light.rectangle.area : area_pdf(scene, light.shape, point.prim, point.uv);
}

// Two triangles of the same winding that share a diagonal. The first one's corner at the right angle and its neighbours
// span the rectangle; the fourth corner must be where that puts it.
Rectangle rectangle_of(const Mesh& mesh) {
  if (mesh.triangles.size() != 2) return {};
  const glm::uvec3 s = mesh.triangles[0], t = mesh.triangles[1];
  for (int i = 0; i < 3; ++i) {
    const Vec3 corner = mesh.positions[s[i]], a = mesh.positions[s[(i + 1) % 3]], b = mesh.positions[s[(i + 2) % 3]];
    const Vec3 x = a - corner, y = b - corner, far = a + y, normal = glm::cross(x, y);
    const float size = std::sqrt(length2(x) + length2(y)), close = 1e-5f * (size + max_abs(corner));
    if (!(std::abs(glm::dot(x, y)) <= 1e-5f * std::sqrt(length2(x) * length2(y)))) continue;
    const float area = std::sqrt(length2(normal));
    if (!(area > 1e-15f * size && area < 1e15f && close < 1e-3f * size)) return {};
    for (int j = 0; j < 3; ++j)
      if (glm::distance(mesh.positions[t[j]], far) <= close &&
          glm::distance(mesh.positions[t[(j + 1) % 3]], b) <= close &&
          glm::distance(mesh.positions[t[(j + 2) % 3]], a) <= close)
        return {corner,        x,    y,
                normal / area, area, std::max(pack_triangle(mesh, 0).error, pack_triangle(mesh, 1).error)};
  }
  return {};
}

}  // namespace ajar
