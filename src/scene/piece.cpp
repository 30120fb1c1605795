// Pieces of lights: what the light tree chooses, sampled one by one.

#include <algorithm>

#include "ajar/core/angle.h"
#include "ajar/core/frame.h"
#include "ajar/core/warp.h"
#include "ajar/scene/geometry.h"
#include "environment.h"
#include "solid.h"

namespace ajar {
namespace {

// Whether the piece is one triangle of many.
bool is_triangle(const Light& light, const LightPiece& piece) {
  return light.kind == LightKind::area && piece.part != none;
}

// Unit direction towards a tile of the sphere.
Vec3 sample_tile(const Scene& scene, const Light& light, const Tile& tile, const Vec2& u) {
  if (light.kind == LightKind::constant) {
    const Tiling& t = scene.light_tree.tilings[scene.light_tree.tiling[size_t(&light - scene.lights.data())]];
    return to_sphere({(float(tile.low.y) + u.x) / float(t.height), (float(tile.low.x) + u.y) / float(t.width)});
  }
  return glm::normalize(Mat3(light.to_world) * sample_tile(scene.environments[light.environment], tile, u));
}

const Tile& tile_at(const Scene& scene, const LightPiece& piece) {
  return scene.light_tree.tilings[scene.light_tree.tiling[piece.light]].tiles[piece.part];
}

// The tiles that find unit direction w.
int densities_of_tiles(const Scene& scene, uint32_t id, const Vec3& w, PieceDensity out[most_shares]) {
  const Light& light = scene.lights[id];
  const LightTree& tree = scene.light_tree;
  const Tiling& t = tree.tilings[tree.tiling[id]];
  if (light.kind == LightKind::constant) {
    const float turn = fast_atan2(w.y, w.x) * (inv_pi / 2);
    const int x = std::clamp(int((turn < 0 ? turn + 1 : turn) * float(t.width)), 0, t.width - 1);
    const int y = std::clamp(int((1 - w.z) * 0.5f * float(t.height)), 0, t.height - 1);
    out[0] = {place_of(tree, id, uint32_t(y * t.width + x)), sphere_pdf * float(t.tiles.size())};
    return out[0].place == none ? 0 : 1;
  }
  float stretch;
  const Vec3 local = to_local(light, w, stretch);
  TileDensity found[most_shares];
  const int n = tile_densities(scene.environments[light.environment], t, local, found);
  int kept = 0;
  for (int i = 0; i < n; ++i) {
    const uint32_t place = place_of(tree, id, found[i].tile);
    if (place != none && found[i].pdf > 0) out[kept++] = {place, found[i].pdf * stretch};
  }
  return kept;
}

// The one piece of a light that finds a point, but for its density; none where there are several or it is never chosen.
uint32_t only_place(const Scene& scene, const LightPoint& point) {
  return place_of(scene.light_tree, point.light, point.prim);
}

bool is_tiled(const Scene& scene, uint32_t light) { return scene.light_tree.tiling[light] != none; }

}  // namespace

bool is_tile(const Scene& scene, const LightPiece& piece) {
  return piece.part != none && !is_triangle(scene.lights[piece.light], piece);
}

bool sample_direct(const Scene& scene, const LightPiece& piece, const Vec3& x, const Vec2& u, DirectSample& out) {
  const Light& light = scene.lights[piece.light];
  if (piece.part == none) return sample_direct(scene, piece.light, x, u, out);
  if (!is_triangle(light, piece)) {
    out.wi = sample_tile(scene, light, tile_at(scene, piece), u);
    out.distance = infinity;
    out.radiance = environment(scene, piece.light, out.wi);
    out.point = light_point(scene, piece.light, out.wi);
    out.point.p = x;
    out.pdf = 0;
    return !is_black(out.radiance);
  }
  float pdf;
  const Surface at = sample_triangle(scene, light.shape, piece.part, u, pdf);
  const Vec3 between = at.p - x;
  const float d2 = length2(between);
  if (!(d2 > 0) || !(pdf > 0)) return false;
  out.distance = std::sqrt(d2);
  out.wi = between / out.distance;
  const float cosine = -glm::dot(at.ng, out.wi);
  if (!(cosine > 0)) return false;
  out.pdf = pdf * d2 / cosine;
  out.radiance = radiance_at(scene, light, at);
  out.point = point_of(at, piece.light);
  return out.pdf > 0 && out.pdf < infinity && !is_black(out.radiance);
}

int densities_direct(const Scene& scene, const LightPoint& point, const Vec3& x, const Vec3& wi,
                     PieceDensity out[most_shares]) {
  if (is_tiled(scene, point.light)) return densities_of_tiles(scene, point.light, wi, out);
  out[0].place = only_place(scene, point);
  if (out[0].place == none) return 0;
  const LightPiece& piece = scene.light_tree.pieces[out[0].place];
  const Light& light = scene.lights[point.light];
  if (is_triangle(light, piece)) {
    const float cosine = -glm::dot(point.n, wi);
    const float area = triangle_area(scene.meshes[scene.shapes[light.shape].mesh], piece.part);
    out[0].pdf = cosine > 0 && area > 0 ? length2(point.p - x) / (cosine * area) : 0;
  } else {
    out[0].pdf = point.delta_position || point.delta_direction ? 1 : pdf_direct(scene, point, x, wi);
  }
  return out[0].pdf > 0 && out[0].pdf < infinity ? 1 : 0;
}

uint32_t place_at(const Scene& scene, const LightPoint& point) {
  if (!is_tiled(scene, point.light)) return only_place(scene, point);
  PieceDensity found[most_shares];
  const int n = densities_of_tiles(scene, point.light, -point.n, found);
  const auto less = [](const PieceDensity& a, const PieceDensity& b) { return a.pdf < b.pdf; };
  return n > 0 ? std::max_element(found, found + n, less)->place : none;
}

bool sample_emission(const Scene& scene, const LightPiece& piece, const Vec2& u_position, const Vec2& u_direction,
                     EmissionSample& out) {
  const Light& light = scene.lights[piece.light];
  if (piece.part == none) return sample_emission(scene, piece.light, u_position, u_direction, out);
  if (!is_triangle(light, piece)) {
    const Vec3 w = sample_tile(scene, light, tile_at(scene, piece), u_direction);
    out.direction = -w;
    out.radiance = environment(scene, piece.light, w);
    out.point = light_point(scene, piece.light, w);
    out.pdf_direction = 0;
    place_on_disk(scene, u_position, out);
    return !is_black(out.radiance);
  }
  const Surface at = sample_triangle(scene, light.shape, piece.part, u_position, out.pdf_position);
  const Vec3 local = to_cosine_hemisphere(u_direction);
  out.pdf_direction = cosine_hemisphere_pdf(local);
  if (!(out.pdf_position > 0) || !(out.pdf_direction > 0)) return false;
  out.point = point_of(at, piece.light);
  out.direction = make_frame(at.ng).to_world(local);
  out.radiance = radiance_at(scene, light, at);
  return !is_black(out.radiance);
}

int densities_emission(const Scene& scene, const LightPoint& point, const Vec3& direction,
                       PieceDensity out[most_shares]) {
  if (is_tiled(scene, point.light)) return densities_of_tiles(scene, point.light, -direction, out);
  out[0].place = only_place(scene, point);
  if (out[0].place == none) return 0;
  const LightPiece& piece = scene.light_tree.pieces[out[0].place];
  const Light& light = scene.lights[point.light];
  if (is_triangle(light, piece)) {
    const float area = triangle_area(scene.meshes[scene.shapes[light.shape].mesh], piece.part);
    out[0].pdf = area > 0 ? 1 / area : 0;
  } else {
    const EmissionPdf e = pdf_emission(scene, point, direction);
    out[0].pdf = point.infinite ? e.direction : e.position;
  }
  return out[0].pdf > 0 ? 1 : 0;
}

void place_on_disk(const Scene& scene, const Vec2& u, EmissionSample& out) {
  const Frame frame = make_frame(out.direction);
  const Vec2 disk = to_disk(u);
  out.point.p = scene.center + scene.radius * (frame.s * disk.x + frame.t * disk.y - out.direction);
  out.pdf_position = 1 / (pi * scene.radius * scene.radius);
}

}  // namespace ajar
