#include "feature_parts.h"

#include <glm/gtc/matrix_transform.hpp>

namespace ajar {
namespace {

using namespace kit;

Scene with_filter(FilterKind kind) {
  Scene scene = stage();
  scene.filter = make_filter(kind);
  return finished(std::move(scene));
}

Scene with_camera(CameraKind kind) {
  Scene scene = stage();
  Camera& c = scene.camera;
  if (kind == CameraKind::orthographic)
    set_orthographic(c, glm::scale(look_at({0.2f, 0.1f, 3}, {0, 0, 0}), Vec3(0.9f)));
  if (kind == CameraKind::thinlens) c.kind = kind, c.aperture = 0.3f, c.focus = 4;
  c.principal = {0.03f, -0.05f};
  return finished(std::move(scene));
}

Scene with_crop() {
  Scene scene = stage(48);
  Camera& c = scene.camera;
  c.crop_x = 9, c.crop_y = 20, c.crop_width = 30, c.crop_height = 18;
  scene.filter = make_filter(FilterKind::gaussian);
  return finished(std::move(scene));
}

// A wall between lens and near plane, which must not be seen nor shade; and a far plane within the room.
Scene with_clip_planes() {
  Scene scene = stage();
  add_quad(scene, {-1, -1, 4}, {2, 0, 0}, {0, 2, 0}, add_diffuse(scene, Rgb(0.5f)));
  scene.camera.near_clip = 0.5f;
  scene.camera.far_clip = 4.5f;
  return finished(std::move(scene));
}

// A plate just behind the near plane, which hides what is behind it.
Scene with_clipped_orthographic() {
  Scene scene = stage();
  set_orthographic(scene.camera, look_at({0, 0, 3}, {0, 0, 0}));
  scene.camera.near_clip = 1.8f;
  add_quad(scene, {-0.7f, -0.7f, 0.8f}, {0.9f, 0, 0}, {0, 0.9f, 0}, add_diffuse(scene, Rgb(0.2f)));
  return finished(std::move(scene));
}

const Feature of_cameras[] = {
    {"thin_lens", [] { return with_camera(CameraKind::thinlens); }},
    {"orthographic", [] { return with_camera(CameraKind::orthographic); }},
    {"clipped_orthographic", with_clipped_orthographic},
    {"principal_point", [] { return with_camera(CameraKind::perspective); }},
    {"crop", with_crop},
    {"clip_planes", with_clip_planes},
    {"tent", [] { return with_filter(FilterKind::tent); }, "pbl", 3},
    {"gaussian", [] { return with_filter(FilterKind::gaussian); }, "pbl", 3},
    {"mitchell", [] { return with_filter(FilterKind::mitchell); }, "pbl", 3},
    {"catmullrom", [] { return with_filter(FilterKind::catmullrom); }, "pbl", 3},
    {"lanczos", [] { return with_filter(FilterKind::lanczos); }, "pbl", 3},
};

}  // namespace

std::span<const Feature> features_of_cameras() { return of_cameras; }

}  // namespace ajar
