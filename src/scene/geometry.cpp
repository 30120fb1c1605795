#include "ajar/scene/geometry.h"

#include "ajar/core/angle.h"
#include "ajar/core/warp.h"

namespace ajar {
namespace {

// Offsets are this many times the magnitudes that went into a point: 4 units in the last place of each. The bound of
// the barycentric sum is 3 (Pharr et al. 2016, section 3.9); the ray tracer's own rounding takes the rest. tests/scene/
// offset_test.cpp measures it: a quarter of this hits itself now and then.
constexpr float error_scale = 0x1p-21f;
constexpr float least_error = 1e-30f;

// By the transpose of m's linear part: normals, with m the inverse of the transform.
Vec3 map_normal(const Mat4& m, const Vec3& n) {
  return {glm::dot(Vec3(m[0]), n), glm::dot(Vec3(m[1]), n), glm::dot(Vec3(m[2]), n)};
}
// Largest magnitude that occurs when m maps p.
float map_magnitude(const Mat4& m, const Vec3& p) {
  return max_component(glm::abs(Vec3(m[0])) * std::abs(p.x) + glm::abs(Vec3(m[1])) * std::abs(p.y) +
                       glm::abs(Vec3(m[2])) * std::abs(p.z) + glm::abs(Vec3(m[3])));
}

// Unit vector along v, also where its square under- or overflows; fallback where v is zero or not finite.
Vec3 unit(const Vec3& v, const Vec3& fallback) {
  const float l2 = length2(v);
  if (l2 > 1e-30f && l2 < 1e30f) return v * (1 / std::sqrt(l2));
  const float m = max_abs(v);
  if (!(m > 0 && m < infinity)) return fallback;
  const Vec3 scaled = v / m;
  return scaled / std::sqrt(length2(scaled));
}

PackedVertex vertex(const Mesh& mesh, uint32_t i) {
  const Vec2 uv = mesh.uvs.empty() ? Vec2(0) : mesh.uvs[i];
  return {mesh.positions[i], uv.x, mesh.normals.empty() ? Vec3(0) : mesh.normals[i], uv.y};
}

// Corners of a triangle where they lie: copies of them would be half the work of a hit.
struct Triangle {
  const PackedVertex &a, &b, &c;
};

float magnitude_of(const Triangle& t) { return std::max(max_abs(t.a.p), std::max(max_abs(t.b.p), max_abs(t.c.p))); }

// Normal and error of slivers. In double: in single precision the normal tilts, and rays along the triangle start on
// the wrong side. The ray tracer's own normal, in single precision, is off by the square of the edges over the area,
// and so is the distance that it computes to the far end: slivers need more room.
void set_sliver_normal(const Triangle& t, Vec3& normal, float& error) {
  const glm::dvec3 p(t.a.p), e1 = glm::dvec3(t.b.p) - p, e2 = glm::dvec3(t.c.p) - p, n = glm::cross(e1, e2);
  const double n2 = glm::dot(n, n), edge2 = std::max(glm::dot(e1, e1), glm::dot(e2, e2));
  if (!(n2 > 0)) return;
  const double per_length = 1 / std::sqrt(n2), sliver = edge2 * per_length;
  normal = Vec3(n * per_length);
  error += error_scale / 16 * float(std::min(sliver, 3e4) * std::sqrt(edge2));
}

// Unit normal by the winding, and error.
void set_normal(const Triangle& t, Vec3& normal, float& error) {
  error = error_scale * magnitude_of(t) + least_error;
  const Vec3 e1 = t.b.p - t.a.p, e2 = t.c.p - t.a.p, n = glm::cross(e1, e2);
  const float n2 = length2(n), edge2 = std::max(length2(e1), length2(e2));
  if (n2 > 1e-30f && n2 < 1e30f && edge2 * edge2 < 16 * n2)
    normal = n / std::sqrt(n2);
  else
    set_sliver_normal(t, normal, error);
}

Vec2 uv_of(const Mesh& mesh, const Triangle& t, const Vec2& b) {
  return mesh.mapped ? Vec2(t.a.u, t.a.v) * (1 - b.x - b.y) + Vec2(t.b.u, t.b.v) * b.x + Vec2(t.c.u, t.c.v) * b.y : b;
}

// Position, error, ng and uv of a point of a triangle, in the mesh's space; returns the triangle.
inline Triangle set_point(const Mesh& mesh, const PackedTriangle& face, Surface& s) {
  const Triangle t{mesh.packed[face.v.x], mesh.packed[face.v.y], mesh.packed[face.v.z]};
  const Vec2 b = s.bary;
  const float a = 1 - b.x - b.y;
  s.p = t.a.p * a + t.b.p * b.x + t.c.p * b.y;
  s.ng = face.ng;
  s.error = face.error;
  s.uv = uv_of(mesh, t, b);
  return t;
}

// Solves p = p0 + dpdu u + dpdv v on the triangle.
void set_tangents(const Mesh& mesh, const Triangle& t, Surface& s) {
  if (!mesh.mapped) return;
  const Vec2 d1(t.b.u - t.a.u, t.b.v - t.a.v), d2(t.c.u - t.a.u, t.c.v - t.a.v);
  const float det = d1.x * d2.y - d1.y * d2.x;
  // What is left of a determinant of 0 is rounding, up to 2^-23 of its products (with fused products more than
  // without).
  if (!(std::abs(det) > 0x1p-22f * (std::abs(d1.x * d2.y) + std::abs(d1.y * d2.x)))) return;
  const Vec3 e1 = t.b.p - t.a.p, e2 = t.c.p - t.a.p;
  const float per_det = 1 / det;
  const Vec3 dpdu = (e1 * d2.y - e2 * d1.y) * per_det, dpdv = (e2 * d1.x - e1 * d2.x) * per_det;
  if (is_finite(dpdu) && is_finite(dpdv)) s.dpdu = dpdu, s.dpdv = dpdv;
}

float magnification(const Mat4& m) {
  return std::sqrt(length2(Vec3(m[0])) + length2(Vec3(m[1])) + length2(Vec3(m[2])));
}

// The ray tracer maps rays into the group in single precision: more rounding than a triangle in world space sees.
float instance_error(const Instance& instance, const Vec3& p) {
  return 3 * error_scale * map_magnitude(instance.to_world, p);
}

void move_to_world(const Instance& instance, Surface& s, Vec3& shading) {
  s.error = s.error * magnification(instance.to_world) + instance_error(instance, s.p);
  s.p = map_point(instance.to_world, s.p);
  s.ng = unit(map_normal(instance.to_object, s.ng), s.ng);
  shading = map_normal(instance.to_object, shading);
  s.dpdu = map_vector(instance.to_world, s.dpdu);
  s.dpdv = map_vector(instance.to_world, s.dpdv);
}

void set_mesh_surface(const Scene& scene, const Shape& shape, const Mesh& mesh, const PackedTriangle& face,
                      Surface& s) {
  const Triangle t = set_point(mesh, face, s);
  if (shape.tangents) set_tangents(mesh, t, s);
  Vec3 shading = mesh.smooth ? t.a.n * (1 - s.bary.x - s.bary.y) + t.b.n * s.bary.x + t.c.n * s.bary.y : s.ng;
  if (s.instance != none) move_to_world(scene.instances[s.instance], s, shading);
  Vec3 n = mesh.smooth ? unit(shading, s.ng) : s.ng;
  if (glm::dot(n, s.ng) < 0) n = -n;
  s.frame = shape.tangents ? make_frame(n, s.dpdu) : make_frame(n);
}

// Of a mesh that finish has not seen: the triangle as it would have packed it. Apart, so that all others do not make
// room for it.
[[gnu::noinline]] void set_unpacked_surface(const Scene& scene, const Shape& shape, const Mesh& mesh, uint32_t prim,
                                            Surface& s) {
  Mesh one;
  PackedTriangle face = pack_triangle(mesh, prim);
  for (int i = 0; i < 3; ++i) one.packed.push_back(vertex(mesh, face.v[i]));
  face.v = {0, 1, 2};
  one.smooth = !mesh.normals.empty(), one.mapped = !mesh.uvs.empty();
  set_mesh_surface(scene, shape, one, face, s);
}

void set_mesh_surface(const Scene& scene, Surface& s) {
  const Shape& shape = scene.shapes[s.shape];
  const Mesh& mesh = scene.meshes[shape.mesh];
  if (!mesh.faces.empty()) return set_mesh_surface(scene, shape, mesh, mesh.faces[s.prim], s);
  set_unpacked_surface(scene, shape, mesh, s.prim, s);
}

// Nearest point of the unit object; its normal; derivatives of position to u and v (of which accel's hits are made).
struct UnitPoint {
  glm::dvec3 p;
  Vec3 n, dpdu, dpdv;
};

UnitPoint unit_point(ShapeKind kind, const glm::dvec3& q) {
  const double rho = std::sqrt(q.x * q.x + q.y * q.y);
  if (kind == ShapeKind::disk) {
    const Vec3 around = 2 * pi * Vec3(float(-q.y), float(q.x), 0);
    const Vec3 out = rho > 0 ? Vec3(float(q.x / rho), float(q.y / rho), 0) : Vec3(0);
    return {{q.x, q.y, 0}, {0, 0, 1}, out, around};
  }
  if (kind == ShapeKind::cylinder) {
    const glm::dvec3 p(rho > 0 ? q.x / rho : 1, rho > 0 ? q.y / rho : 0, q.z);
    return {p, Vec3(float(p.x), float(p.y), 0), 2 * pi * Vec3(float(-p.y), float(p.x), 0), {0, 0, 1}};
  }
  const double r = std::sqrt(rho * rho + q.z * q.z);
  const glm::dvec3 p = r > 0 ? q / r : glm::dvec3(0, 0, 1);
  const double ring = std::sqrt(p.x * p.x + p.y * p.y);
  const Vec3 down = ring > 0 ? Vec3(float(p.z * p.x / ring), float(p.z * p.y / ring), float(-ring)) : Vec3(0);
  return {p, Vec3(p), 2 * pi * Vec3(float(-p.y), float(p.x), 0), pi * down};
}

// ng and tangents of a unit point in the space of the shape.
void set_quadric_axes(const Shape& shape, const UnitPoint& at, Surface& s) {
  s.ng = unit(map_normal(shape.to_object, shape.flip ? -at.n : at.n), at.n);
  s.dpdu = map_vector(shape.to_world, at.dpdu);
  s.dpdv = map_vector(shape.to_world, at.dpdv);
}

float quadric_error(const Shape& shape, const Vec3& p) {
  return error_scale * (max_abs(p) + magnification(shape.to_world)) + least_error;
}

// Of a point at a hit. On spheres, which are not sheared, all but its rounding is in double: else a ground as large as
// the Earth would send rays off from metres above it.
float hit_error(const Shape& shape, const Vec3& p, float t) {
  if (shape.kind != ShapeKind::sphere) return quadric_error(shape, p);
  return error_scale * max_abs(p) + 0x1p-44f * (magnification(shape.to_world) + t) + least_error;
}

// In double: the ray may have started far away. The point on the ray is moved onto the object by a first-order step,
// which leaves an error of the second order of a small distance.
void set_quadric_surface(const Scene& scene, const Hit& hit, const Vec3& ray_o, const Vec3& ray_d, Surface& s) {
  const Shape& shape = scene.shapes[s.shape];
  const Instance* instance = s.instance == none ? nullptr : &scene.instances[s.instance];
  glm::dvec3 p = glm::dvec3(ray_o) + double(hit.t) * glm::dvec3(ray_d);
  if (instance) p = glm::dvec3(glm::dmat4(instance->to_object) * glm::dvec4(p, 1));
  const glm::dvec3 q = glm::dmat4(shape.to_object) * glm::dvec4(p, 1);
  const UnitPoint at = unit_point(shape.kind, q);
  s.p = p + glm::dvec3(glm::dmat4(shape.to_world) * glm::dvec4(at.p - q, 0));
  s.error = instance ? quadric_error(shape, s.p) : hit_error(shape, s.p, hit.t);
  s.uv = hit.bary;
  set_quadric_axes(shape, at, s);
  Vec3 shading = s.ng;
  if (instance) move_to_world(*instance, s, shading);
  s.frame = make_frame(s.ng, s.dpdu);
}

// Unit object's point and (u, v) uniform in the parameters that are uniform by area on it.
UnitPoint sample_unit(ShapeKind kind, const Vec2& u, Vec2& uv) {
  if (kind == ShapeKind::sphere) {
    const Vec3 w = to_sphere(u);
    uv = {u.y, std::acos(std::clamp(w.z, -1.0f, 1.0f)) * inv_pi};
    return {glm::dvec3(w), w, Vec3(0), Vec3(0)};
  }
  if (kind == ShapeKind::disk) {
    const Vec2 d = to_disk(u);
    const float turn = fast_atan2(d.y, d.x) / (2 * pi);
    uv = {std::sqrt(glm::dot(d, d)), turn < 0 ? turn + 1 : turn};
    return {glm::dvec3(d, 0), {0, 0, 1}, Vec3(0), Vec3(0)};
  }
  const float phi = 2 * pi * u.x;
  const Vec3 n(std::cos(phi), std::sin(phi), 0);
  uv = u;
  return {glm::dvec3(n.x, n.y, u.y), n, Vec3(0), Vec3(0)};
}

// World area per unit of height and of angle [rad] on a cylinder at the angle 2 pi u.
double cylinder_stretch(const Shape& shape, double u) {
  const double phi = 2 * std::numbers::pi * u;
  const glm::dmat4 m(shape.to_world);
  const glm::dvec3 around = glm::dvec3(m[0]) * -std::sin(phi) + glm::dvec3(m[1]) * std::cos(phi);
  return glm::length(glm::cross(around, glm::dvec3(m[2])));
}

double quadric_area(const Shape& shape) {
  const glm::dmat4 m(shape.to_world);
  if (shape.kind == ShapeKind::sphere) return 4 * std::numbers::pi * glm::dot(glm::dvec3(m[0]), glm::dvec3(m[0]));
  if (shape.kind == ShapeKind::disk)
    return std::numbers::pi * glm::length(glm::cross(glm::dvec3(m[0]), glm::dvec3(m[1])));
  constexpr int n = 256;  // equal steps around a period: exact to rounding
  double sum = 0;
  for (int i = 0; i < n; ++i) sum += cylinder_stretch(shape, double(i) / n);
  return sum * 2 * std::numbers::pi / n;
}

float inverse(double area) { return area > 0 ? float(std::min(1 / area, 1e38)) : 0; }

}  // namespace

void set_surface(const Scene& scene, const Hit& hit, const Vec3& ray_o, const Vec3& ray_d, Surface& s) {
  s.shape = hit.shape, s.prim = hit.prim, s.instance = hit.instance;
  s.bary = hit.bary;
  s.dpdu = s.dpdv = Vec3(0);
  if (scene.shapes[hit.shape].kind == ShapeKind::mesh)
    set_mesh_surface(scene, s);
  else
    set_quadric_surface(scene, hit, ray_o, ray_d, s);
}

Vec2 texture_point(const Scene& scene, uint32_t shape, uint32_t prim, const Vec2& bary) {
  if (scene.shapes[shape].kind != ShapeKind::mesh) return bary;
  const Mesh& mesh = scene.meshes[scene.shapes[shape].mesh];
  const glm::uvec3 v = mesh.faces[prim].v;
  return uv_of(mesh, {mesh.packed[v.x], mesh.packed[v.y], mesh.packed[v.z]}, bary);
}

Surface sample_triangle(const Scene& scene, uint32_t id, uint32_t prim, const Vec2& u, float& pdf) {
  const Mesh& mesh = scene.meshes[scene.shapes[id].mesh];
  Surface s;
  s.shape = id;
  s.prim = prim;
  s.bary = to_triangle(u);
  set_point(mesh, mesh.faces[prim], s);
  pdf = inverse(double(triangle_area(mesh, prim)));
  return s;
}

Surface sample_area(const Scene& scene, uint32_t id, const Vec2& u, float& pdf) {
  const Shape& shape = scene.shapes[id];
  Surface s;
  s.shape = id;
  if (shape.kind == ShapeKind::mesh) {
    const Mesh& mesh = scene.meshes[shape.mesh];
    pdf = 0;
    if (!(mesh.total_area > 0)) return s;
    Vec2 in_triangle = u;
    s.prim = mesh.area.sample(in_triangle.x);
    s.bary = to_triangle(in_triangle);
    set_point(mesh, mesh.faces[s.prim], s);
  } else {
    const UnitPoint at = sample_unit(shape.kind, u, s.uv);
    s.p = map_point(shape.to_world, Vec3(at.p));
    s.error = position_error(shape, s.p);
    set_quadric_axes(shape, at, s);
  }
  pdf = area_pdf(scene, id, s.prim, s.uv);
  return s;
}

float area_pdf(const Scene& scene, uint32_t id, uint32_t prim, const Vec2& uv) {
  const Shape& shape = scene.shapes[id];
  if (shape.kind == ShapeKind::mesh) {
    const Mesh& mesh = scene.meshes[shape.mesh];
    const float triangle = triangle_area(mesh, prim);
    return mesh.total_area > 0 && triangle > 0 ? mesh.area.pdf(prim) / triangle : 0;
  }
  if (shape.kind == ShapeKind::cylinder) return inverse(2 * std::numbers::pi * cylinder_stretch(shape, uv.x));
  return inverse(quadric_area(shape));
}

double area(const Scene& scene, uint32_t id) {
  const Shape& shape = scene.shapes[id];
  if (shape.kind != ShapeKind::mesh) return quadric_area(shape);
  const Mesh& mesh = scene.meshes[shape.mesh];
  double sum = 0;
  for (uint32_t i = 0; i < mesh.triangles.size(); ++i) sum += triangle_area(mesh, i);
  return sum;
}

Vec2 sphere_uv(const Shape& sphere, const Vec3& p) {
  const Vec3 q = map_point(sphere.to_object, p);
  const float turn = fast_atan2(q.y, q.x) / (2 * pi);
  return {turn < 0 ? turn + 1 : turn, fast_atan2(std::sqrt(q.x * q.x + q.y * q.y), q.z) * inv_pi};
}

PackedTriangle pack_triangle(const Mesh& mesh, uint32_t triangle) {
  PackedTriangle packed{mesh.triangles[triangle]};
  const PackedVertex a = vertex(mesh, packed.v.x), b = vertex(mesh, packed.v.y), c = vertex(mesh, packed.v.z);
  set_normal({a, b, c}, packed.ng, packed.error);
  return packed;
}

float position_error(const Shape& quadric, const Vec3& p) {
  return quadric_error(quadric, p) + error_scale * max_abs(Vec3(quadric.to_world[3]));
}

float triangle_area(const Mesh& mesh, uint32_t triangle) {
  const glm::uvec3 t = mesh.triangles[triangle];
  const glm::dvec3 a(mesh.positions[t.x]), b(mesh.positions[t.y]), c(mesh.positions[t.z]);
  const double twice = glm::length(glm::cross(b - a, c - a));
  // Below this a density per area would overflow; nothing of that size lights anything.
  return twice > 1e-30 && twice < 1e38 ? float(twice / 2) : 0;
}

bool is_similarity(const glm::dmat4& m, double tolerance) {
  const glm::dvec3 x(m[0]), y(m[1]), z(m[2]);
  const double size = glm::dot(x, x), slack = 2 * tolerance * size;
  return std::abs(glm::dot(y, y) - size) < slack && std::abs(glm::dot(z, z) - size) < slack &&
         std::abs(glm::dot(x, y)) < slack && std::abs(glm::dot(y, z)) < slack && std::abs(glm::dot(z, x)) < slack;
}

}  // namespace ajar
