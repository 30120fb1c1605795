#include "ajar/scene/light.h"

#include "ajar/core/frame.h"
#include "ajar/core/warp.h"
#include "ajar/scene/geometry.h"
#include "environment.h"
#include "solid.h"

namespace ajar {
namespace {

LightPoint point_at_infinity(const Vec3& travel, uint32_t light) {
  LightPoint p;
  p.n = travel, p.light = light, p.infinite = true;
  return p;
}

LightPoint point_of_delta(const Light& light, uint32_t id) {
  LightPoint p;
  p.p = light.position, p.light = id, p.delta_position = true;
  return p;
}

bool in_sun(const Light& light, const Vec3& w) { return length2(w + light.direction) < 2 * light.cone; }

Rgb environment_at(const Scene& scene, const Light& light, const Vec3& w) {
  if (light.kind == LightKind::constant) return light.radiance.value;
  if (light.kind == LightKind::sun) return in_sun(light, w) ? light.radiance.value : Rgb(0);
  float stretch;
  return environment_radiance(scene, scene.environments[light.environment], to_local(light, w, stretch));
}

float environment_pdf_at(const Scene& scene, const Light& light, const Vec3& w) {
  if (light.kind == LightKind::constant) return sphere_pdf;
  if (light.kind == LightKind::sun) return in_sun(light, w) ? cone_pdf(light.cone) : 0;
  float stretch;
  const Vec3 local = to_local(light, w, stretch);
  return environment_pdf(scene.environments[light.environment], local) * stretch;
}

// Unit direction towards an infinite light; false where the light is black.
bool sample_environment_at(const Scene& scene, const Light& light, const Vec2& u, Vec3& w, float& pdf) {
  if (light.kind == LightKind::constant) {
    w = to_sphere(u);
    pdf = sphere_pdf;
    return true;
  }
  if (light.kind == LightKind::sun) {
    w = glm::normalize(make_frame(-light.direction).to_world(to_cone(u, light.cone)));
    pdf = cone_pdf(light.cone);
    return true;
  }
  const Vec3 local = sample_environment(scene.environments[light.environment], u, pdf);
  if (!(pdf > 0)) return false;
  const Vec3 v = Mat3(light.to_world) * local;
  w = v / std::sqrt(length2(v));
  float stretch;
  to_local(light, w, stretch);
  pdf *= stretch;
  return true;
}

// From the distance of the two unit vectors, or from the opposite one's: the cosine tells small angles apart badly.
float angle_to_spot(const Light& light, const Vec3& w) {
  const auto across = [](const Vec3& between) {
    return 2 * std::asin(std::min(0.5f * std::sqrt(length2(between)), 1.0f));
  };
  return glm::dot(light.direction, w) > 0 ? across(w - light.direction) : pi - across(w + light.direction);
}

// Share of a spot's intensity in unit direction of travel w: linear in the angle between beam and cutoff.
float spot_share(const Light& light, const Vec3& w) {
  const float angle = angle_to_spot(light, w);
  if (angle <= light.beam) return 1;
  if (angle >= light.cutoff) return 0;
  return (light.cutoff - angle) / (light.cutoff - light.beam);
}
// 1 - cos(cutoff)
float spot_height(const Light& light) { return 2 * sqr(std::sin(0.5f * light.cutoff)); }

// A texture on a spot covers the square around its cone, seen along the axis.
Rgb spot_color(const Scene& scene, const Light& light, const Vec3& w) {
  if (!light.textured) return light.radiance.value;
  const Vec3 local = light.to_local * w;
  if (!(local.z > 0) || !(light.cutoff < pi / 2)) return Rgb(0);
  const float tangent = std::tan(light.cutoff);
  Surface at;
  at.uv = Vec2(local) / (local.z * tangent) * 0.5f + 0.5f;
  return eval(scene, light.radiance, at);
}

// Where unit direction of travel w meets a projector's picture, from (-1, -1) to (1, 1); false outside. cos: to its
// axis.
bool on_picture(const Light& light, const Vec3& w, Vec2& at, float& cos) {
  const Vec3 local = light.to_local * w;
  cos = local.z;
  if (!(cos > 0)) return false;
  at = Vec2(local) / (cos * light.plane);
  return std::max(std::abs(at.x), std::abs(at.y)) <= 1;
}

Rgb thrown_picture(const Scene& scene, const Light& light, const Vec3& w) {
  Vec2 at;
  float cos;
  if (!on_picture(light, w, at, cos)) return Rgb(0);
  Surface surface;
  surface.uv = 0.5f - 0.5f * at;  // x is to the left and y up, as in a camera
  return radiance_at(scene, light, surface) / (cos * cos * cos);
}

// Uniform on the picture.
float picture_pdf(const Light& light, float cos) { return 1 / (4 * light.plane.x * light.plane.y * cos * cos * cos); }

Rgb delta_intensity(const Scene& scene, const Light& light, const Vec3& w) {
  if (light.kind == LightKind::projector) return thrown_picture(scene, light, w);
  if (light.kind == LightKind::point) return light.radiance.value;
  const float share = spot_share(light, w);
  return share > 0 ? spot_color(scene, light, w) * share : Rgb(0);
}

float disk_pdf(const Scene& scene) { return 1 / (pi * scene.radius * scene.radius); }

bool sample_direct_infinite(const Scene& scene, uint32_t id, const Vec3& x, const Vec2& u, DirectSample& out) {
  const Light& light = scene.lights[id];
  out.distance = infinity;
  if (light.kind == LightKind::directional) {
    out.wi = -light.direction;
    out.pdf = 1;
    out.radiance = light.radiance.value;
    out.point = point_at_infinity(light.direction, id);
    out.point.delta_direction = true;
  } else {
    if (!sample_environment_at(scene, light, u, out.wi, out.pdf)) return false;
    out.radiance = environment_at(scene, light, out.wi);
    out.point = point_at_infinity(-out.wi, id);
  }
  out.point.p = x;
  return !is_black(out.radiance);
}

bool sample_direct_delta(const Scene& scene, uint32_t id, const Vec3& x, DirectSample& out) {
  const Light& light = scene.lights[id];
  const Vec3 between = light.position - x;
  const float d2 = length2(between);
  if (!(d2 > 0)) return false;
  out.distance = std::sqrt(d2);
  out.wi = between / out.distance;
  out.pdf = 1;
  out.radiance = delta_intensity(scene, light, -out.wi) / d2;
  out.point = point_of_delta(light, id);
  return !is_black(out.radiance) && is_finite(out.radiance);
}

bool sample_emission_infinite(const Scene& scene, uint32_t id, const Vec2& u_position, const Vec2& u_direction,
                              EmissionSample& out) {
  const Light& light = scene.lights[id];
  if (light.kind == LightKind::directional) {
    out.direction = light.direction;
    out.pdf_direction = 1;
    out.radiance = light.radiance.value;
  } else {
    Vec3 w;
    if (!sample_environment_at(scene, light, u_direction, w, out.pdf_direction)) return false;
    out.direction = -w;
    out.radiance = environment_at(scene, light, w);
  }
  out.point = point_at_infinity(out.direction, id);
  out.point.delta_direction = light.kind == LightKind::directional;
  place_on_disk(scene, u_position, out);
  return !is_black(out.radiance);
}

bool sample_emission_delta(const Scene& scene, uint32_t id, const Vec2& u_direction, EmissionSample& out) {
  const Light& light = scene.lights[id];
  out.point = point_of_delta(light, id);
  out.pdf_position = 1;
  if (light.kind == LightKind::point) {
    out.direction = to_sphere(u_direction);
    out.pdf_direction = sphere_pdf;
  } else if (light.kind == LightKind::projector) {
    const Vec3 local = glm::normalize(Vec3((2.0f * u_direction - 1.0f) * light.plane, 1));
    out.direction = glm::normalize(Mat3(light.to_world) * local);
    out.pdf_direction = picture_pdf(light, local.z);
  } else {
    const float height = spot_height(light);
    if (!(height > 0)) return false;
    out.direction = make_frame(light.direction).to_world(to_cone(u_direction, height));
    out.pdf_direction = cone_pdf(height);
  }
  out.radiance = delta_intensity(scene, light, out.direction);
  return !is_black(out.radiance);
}

double mean_luminance(const Scene& scene, const Slot& slot) { return std::max(luminance(mean(scene, slot)), 0.0f); }

// Of a textured lamp, by points on it: its (u, v) may show a part of the texture alone. A little of what the whole
// texture would make of it remains, for what shines between the points.
double area_power(const Scene& scene, const Light& light) {
  const double evenly = std::numbers::pi * area(scene, light.shape) * mean_luminance(scene, light.radiance);
  if (!light.textured) return evenly;
  const Shape& shape = scene.shapes[light.shape];
  const Mesh* mesh = shape.kind == ShapeKind::mesh ? &scene.meshes[shape.mesh] : nullptr;
  const size_t n = std::clamp<size_t>(mesh ? 4 * mesh->triangles.size() : 0, 256, 1 << 16);
  double sum = 0;
  for (size_t i = 0; i < n; ++i) {
    float pdf;
    const double turn = double(i) * 0.6180339887498949;
    const Surface at = sample_area(scene, light.shape, {(float(i) + 0.5f) / float(n), turn - std::floor(turn)}, pdf);
    if (pdf > 0) sum += std::max(luminance(radiance_at(scene, light, at)), 0.0f) / double(pdf);
  }
  const double most = std::numbers::pi * area(scene, light.shape) * luminance(maximum(scene, light.radiance, mesh));
  return std::max({std::numbers::pi * sum / double(n), 1e-3 * evenly, most < infinity ? 1e-6 * most : 0});
}

}  // namespace

double spot_solid_angle(const Light& light) {
  const double middle = 0.5 * (double(light.cutoff) + light.beam), half = 0.5 * (double(light.cutoff) - light.beam);
  const double slope = half > 1e-9 ? std::sin(half) / half : 1;
  return 2 * std::numbers::pi * (1 - std::cos(middle) * slope);
}

bool sample_direct(const Scene& scene, uint32_t id, const Vec3& x, const Vec2& u, DirectSample& out) {
  const Light& light = scene.lights[id];
  if (is_infinite(light.kind)) return sample_direct_infinite(scene, id, x, u, out);
  if (light.kind != LightKind::area) return sample_direct_delta(scene, id, x, out);
  if (light.rectangle.area > 0) {
    out.radiance = light.radiance.value;
    out.point.light = id;
    return !is_black(out.radiance) && sample_rectangle(light.rectangle, x, u, out);
  }
  ShapeSample sample;
  if (!sample_shape(scene, light, x, u, sample)) return false;
  out.wi = sample.wi, out.distance = sample.distance, out.pdf = sample.pdf;
  out.radiance = radiance_at(scene, light, sample.at);
  out.point = point_of(sample.at, id);
  return !is_black(out.radiance);
}

bool may_light(const Scene& scene, uint32_t id, const Vec3& x, const Vec3& n) {
  const Rectangle& r = scene.lights[id].rectangle;
  if (!(r.area > 0)) return true;
  const Vec3 to_corner = r.corner - x;
  const float highest = glm::dot(n, to_corner) + std::max(glm::dot(n, r.x), 0.0f) + std::max(glm::dot(n, r.y), 0.0f);
  return highest > 0 && glm::dot(r.normal, to_corner) < 0;
}

float pdf_direct(const Scene& scene, const LightPoint& point, const Vec3& x, const Vec3& wi) {
  const Light& light = scene.lights[point.light];
  if (point.delta_position || point.delta_direction) return 0;
  if (point.infinite) return environment_pdf_at(scene, light, wi);
  return shape_pdf(scene, light, point, x, wi);
}

bool sample_emission(const Scene& scene, uint32_t id, const Vec2& u_position, const Vec2& u_direction,
                     EmissionSample& out) {
  const Light& light = scene.lights[id];
  if (is_infinite(light.kind)) return sample_emission_infinite(scene, id, u_position, u_direction, out);
  if (light.kind != LightKind::area) return sample_emission_delta(scene, id, u_direction, out);
  const Surface at = sample_light_area(scene, light, u_position, out.pdf_position);
  const Vec3 local = to_cosine_hemisphere(u_direction);
  out.pdf_direction = cosine_hemisphere_pdf(local);
  if (!(out.pdf_position > 0) || !(out.pdf_direction > 0)) return false;
  out.point = point_of(at, id);
  out.direction = make_frame(at.ng).to_world(local);
  out.radiance = radiance_at(scene, light, at);
  return !is_black(out.radiance);
}

EmissionPdf pdf_emission(const Scene& scene, const LightPoint& point, const Vec3& direction) {
  const Light& light = scene.lights[point.light];
  switch (light.kind) {
    case LightKind::area:
      return {light_area_pdf(scene, light, point), std::max(glm::dot(point.n, direction), 0.0f) * inv_pi};
    case LightKind::directional:
      return {disk_pdf(scene), 1};
    case LightKind::point:
      return {1, sphere_pdf};
    case LightKind::spot:
      return {1, angle_to_spot(light, direction) < light.cutoff ? cone_pdf(spot_height(light)) : 0};
    case LightKind::projector: {
      Vec2 at;
      float cos;
      return {1, on_picture(light, direction, at, cos) ? picture_pdf(light, cos) : 0};
    }
    default:
      return {disk_pdf(scene), environment_pdf_at(scene, light, -direction)};
  }
}

Rgb emitted(const Scene& scene, const Surface& at, const Vec3& wo) {
  const uint32_t id = scene.shapes[at.shape].light;
  if (id == none || at.instance != none || !(glm::dot(at.ng, wo) > 0)) return Rgb(0);
  return radiance_at(scene, scene.lights[id], at);
}

LightPoint light_point(const Scene& scene, const Surface& at) {
  return point_of(at, at.instance == none ? scene.shapes[at.shape].light : none);
}

Rgb environment(const Scene& scene, uint32_t id, const Vec3& w) {
  const Light& light = scene.lights[id];
  return light.kind == LightKind::directional ? Rgb(0) : environment_at(scene, light, w);
}

LightPoint light_point(const Scene& scene, uint32_t id, const Vec3& w) {
  LightPoint p = point_at_infinity(-w, id);
  p.delta_direction = scene.lights[id].kind == LightKind::directional;
  return p;
}

float power(const Scene& scene, uint32_t id) {
  const Light& light = scene.lights[id];
  const double disk = std::numbers::pi * scene.radius * scene.radius, sphere = 4 * std::numbers::pi;
  double watts = 0;
  switch (light.kind) {
    case LightKind::area:
      watts = area_power(scene, light);
      break;
    case LightKind::constant:
      watts = sphere * disk * luminance(light.radiance.value);
      break;
    case LightKind::envmap:
      watts = disk * environment_total(scene.environments[light.environment]);
      break;
    case LightKind::sun:
      watts = 2 * std::numbers::pi * double(light.cone) * disk * luminance(light.radiance.value);
      break;
    case LightKind::directional:
      watts = disk * luminance(light.radiance.value);
      break;
    case LightKind::point:
      watts = sphere * luminance(light.radiance.value);
      break;
    case LightKind::spot:
      watts = spot_solid_angle(light) * mean_luminance(scene, light.radiance);
      break;
    case LightKind::projector:
      watts = 4.0 * light.plane.x * light.plane.y * mean_luminance(scene, light.radiance);
      break;
  }
  return float(std::clamp(watts, 0.0, double(std::numeric_limits<float>::max())));
}

}  // namespace ajar
