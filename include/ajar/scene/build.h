// Enters: sizes, colours, angles.
// Leaves: small scenes made without files, shared by tests and benchmarks, and the parts to make others.
#pragma once

#include <span>
#include <string>

#include "ajar/scene/scene.h"

namespace ajar {

/// Puts the camera of a scene that has none where Mitsuba does: it looks along +z, from so far before the scene that
/// its longest side fills 45 degrees; with Mitsuba's filter, a Gaussian. False where the scene has no extent.
bool add_camera(Scene& scene);

// Parts. They add to a scene and return the index of what they added; call finish() at the end. Metres, y is up.

uint32_t add_material(Scene& scene, const Material& material);
uint32_t add_diffuse(Scene& scene, const Rgb& reflectance);
/// A typical material of the kind, with those that it nests: measured gold for conductors, glass of index 1.5 for
/// dielectrics and plastics, GGX of the given roughness, a checkerboard in masks and blends, waves in maps.
uint32_t add_example(Scene& scene, MaterialKind kind, float alpha = 0.2f);
/// 8 x 8 checkerboard over the unit square of uv.
Slot add_checkerboard(Scene& scene, const Rgb& a, const Rgb& b);
/// Linear image, 3 floats a pixel, row 0 on top, behind a texture. Throws Error where there are not so many, or not all
/// are finite.
Slot add_image(Scene& scene, int width, int height, std::vector<float> rgb);

/// A mesh as it stands, in world space.
uint32_t add_mesh(Scene& scene, Mesh mesh, uint32_t material);
/// Parallelogram corner, corner + u, corner + u + v, corner + v with uv (0,0) to (1,1); its outside is cross(u, v).
uint32_t add_quad(Scene& scene, const Vec3& corner, const Vec3& u, const Vec3& v, uint32_t material);
/// The cube [-1,1]^3 under a transform, outside out; inward for rooms.
uint32_t add_box(Scene& scene, const Mat4& to_world, uint32_t material, bool inward = false);
/// The box between two corners.
uint32_t add_box(Scene& scene, const Vec3& low, const Vec3& high, uint32_t material, bool inward = false);
/// A sphere as quadric.
uint32_t add_sphere(Scene& scene, const Vec3& center, float radius, uint32_t material);
/// A sphere of triangles with smooth normals.
uint32_t add_globe(Scene& scene, const Vec3& center, float radius, uint32_t material, int rings = 24);
/// A sphere, disk or cylinder as Shape has it under a transform, which leaves a sphere round.
uint32_t add_quadric(Scene& scene, ShapeKind kind, const Mat4& to_world, uint32_t material);
/// Shows the shapes of a group, of which there are Scene::groups, under a transform.
uint32_t add_instance(Scene& scene, uint32_t group, const Mat4& to_world);

/// Makes a shape an area light [W/(m^2 sr)]; returns the light. Throws Error where there is no such shape.
uint32_t add_area_light(Scene& scene, uint32_t shape, const Slot& radiance);
/// A light without a shape, at the origin or along -y. constant, sun (0.5358 degrees across): radiance; directional:
/// irradiance; point, spot, projector: intensity (the spot with a cutoff of 40 and a beam of 30 degrees). For an envmap
/// take add_envmap.
uint32_t add_light(Scene& scene, LightKind kind, const Slot& radiance);
/// An envmap from an image slot made by add_image; throws Error for another.
uint32_t add_envmap(Scene& scene, const Slot& image, float scale = 1);

/// Camera space (x left, y up, z forward) at eye, looking at target.
Mat4 look_at(const Vec3& eye, const Vec3& target);
/// Perspective camera (set_perspective) with a horizontal field of view between 0 and 180 degrees, eye apart from
/// target; sets the film's size, too, without a crop window.
void set_camera(Scene& scene, const Vec3& eye, const Vec3& target, float fov, int width, int height);

// Scenes: finished, box filter, size x size pixels unless they say otherwise. Change one and call finish() again.

enum class Oven : uint8_t { box, sphere, globe };  ///< globe: of triangles

/// Closed, seen from inside, every wall of the material and emitting radiance. For a diffuse material of albedo a every
/// pixel is radiance / (1 - a).
Scene furnace(Oven oven, const Material& wall, const Rgb& radiance = Rgb(1), int size = 16);
/// Regular polygon of the radius about the y axis at the height, its first corner towards +z, shining down on a diffuse
/// floor at y = 0 that reaches 50 from the axis; the camera sees only floor. Irradiance: Lambert's polygon formula.
Scene polygon_over_plane(int corners, float height = 1, float radius = 0.7f, const Rgb& radiance = Rgb(4),
                         float reflectance = 0.5f, int size = 32);
/// A black sphere that emits inwards, the camera off its centre: every pixel is the radiance.
Scene inside_sphere(const Rgb& radiance = Rgb(1), int size = 16);
/// Two diffuse rooms of 4 x 2.5 x 4, a wall between them with a door that turns by door_degrees (0 closed, with gaps of
/// 5 mm; up to 120). The light is a ceiling panel in the far room, out of sight of the near one; the camera in the near
/// room sees the door. 16:9, of the given height.
Scene two_rooms(float door_degrees, int height = 36);
/// The room [-1,1]^3, open in front, red left and green right wall, ceiling lamp, two boxes.
Scene cornell(int size = 32);
/// The same room with a ball of glass of the index instead of the boxes.
Scene glass_ball(float ior = 1.5f, int size = 32);
/// A lit screen that the camera sees over so many mirrors, all else black. Throws Error unless 0 to 64 mirrors.
Scene mirror_chain(int mirrors, int size = 24);
/// The room with boxes and so many small square lamps of different colours and powers under its ceiling, instead of
/// one.
Scene many_lights(int lights, uint64_t seed = 1, int size = 32);
/// A diffuse ball on a floor under a constant, envmap or directional light.
Scene under_sky(LightKind kind, int size = 24);
/// A room with grey walls and a lopsided group of shapes in its left and right half: instances that are shifted copies,
/// or, mirrored, mirror images at x = 0. Then all of the scene is, and the expected image is its own mirror image.
Scene instanced(bool mirrored, int size = 32);
/// A floor and back wall whose diffuse material is bent by a bump map (or a normal map), under the room's lamp.
Scene bump_plane(bool normal_map = false, int size = 32);
/// The room without its ceiling, seen from above so that walls and floor fill the image, lit by one light of the kind
/// (area: the lamp).
Scene lit_by(LightKind kind, int size = 24);
/// The room, its lamp of the shape (mesh: a globe of triangles).
Scene lit_by(ShapeKind kind, int size = 24);
/// The room with lamp and a ball of the example material of the kind.
Scene with_material(MaterialKind kind, float alpha = 0.2f, int size = 24);

/// One small scene per feature, for tests that hold all ways of rendering against each other.
struct FeatureScene {
  std::string name;
  Scene (*make)();
  bool path = true;   ///< next-event estimation and hits alone can find all its light
  bool light = true;  ///< paths from the lights, joined to the camera, alone can find all its light
};
std::span<const FeatureScene> feature_scenes();

}  // namespace ajar
