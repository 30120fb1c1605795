#include "ajar/scene/build.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <glm/gtc/matrix_transform.hpp>
#include <set>

#include "ajar/core/error.h"
#include "kit/files.h"

namespace ajar {
namespace {

void expect_finished(const Scene& scene, const std::string& name) {
  EXPECT_TRUE(is_finite(scene.center)) << name;
  EXPECT_TRUE(scene.radius > 0.1f && scene.radius < 200) << name << " " << scene.radius;
  ASSERT_FALSE(scene.lights.empty()) << name;
  EXPECT_TRUE(scene.light_tree.power_before.back() > 0 && std::isfinite(scene.light_tree.power_before.back())) << name;
  for (uint32_t i = 0; i < scene.lights.size(); ++i) EXPECT_GT(power(scene, i), 0) << name;
  for (uint32_t i = 0; i < scene.materials.size(); ++i) EXPECT_EQ(material_problem(scene, i), "") << name;
  for (const Shape& shape : scene.shapes) {
    EXPECT_LT(shape.material, scene.materials.size()) << name;
    if (shape.kind == ShapeKind::mesh) {
      EXPECT_LT(shape.mesh, scene.meshes.size()) << name;
    }
  }
  EXPECT_TRUE(is_finite(generate(scene.camera, Vec2(0.5f), Vec2(0.5f)).d)) << name;
}

// Geometric normal of a triangle times twice its area, and its first corner.
std::pair<Vec3, Vec3> face(const Mesh& mesh, const glm::uvec3& t) {
  const Vec3 p = mesh.positions[t.x];
  return {glm::cross(mesh.positions[t.y] - p, mesh.positions[t.z] - p), p};
}

// What a change of the box says: of the furnace, which has a mesh, a material and an area light.
std::string refusal(const std::function<void(Scene&)>& change) {
  Scene scene = furnace(Oven::box, Material{});
  change(scene);
  return kit::error_of([&] { finish(scene); });
}

void expect(const char* words, const std::function<void(Scene&)>& change) {
  const std::string said = refusal(change);
  EXPECT_NE(said.find(words), std::string::npos) << words << ": " << said;
}

TEST(Build, what_does_not_fit_is_an_error) {
  EXPECT_EQ(refusal([](Scene&) {}), "");
  const float nan = std::nanf("");
  expect("shape 0: its material is 5, and the scene has 1", [](Scene& s) { s.shapes[0].material = 5; });
  expect("shape 0: its mesh is 3, and the scene has 1", [](Scene& s) { s.shapes[0].mesh = 3; });
  expect("shape 0: its group is 0, and the scene has 0", [](Scene& s) { s.shapes[0].group = 0; });
  expect("instance 0: its group is 0", [](Scene& s) { s.instances.emplace_back(); });
  expect("shape 0: its light is 7", [](Scene& s) { s.shapes[0].light = 7; });
  expect("shape 0: its light 0 is not an area light", [](Scene& s) { s.lights[0].kind = LightKind::point; });
  expect("light 0: its shape 0 has another light", [](Scene& s) { s.shapes[0].light = none; });
  expect("light 0: has no shape", [](Scene& s) { s.lights[0].shape = none, s.shapes[0].light = none; });
  expect("light 0: its radiance is negative", [](Scene& s) { s.lights[0].radiance = Slot(-1.0f); });
  expect("light 0: its sampling_weight is -1", [](Scene& s) { s.lights[0].sampling_weight = -1; });
  expect("light 1: has no environment", [](Scene& s) { add_light(s, LightKind::envmap, Slot(1.0f)); });
  expect("material 0: its reflectance is 9, and the scene has 0 textures",
         [](Scene& s) { s.materials[0].reflectance.texture = 9; });
  expect("material 0: its reflectance is not finite", [&](Scene& s) { s.materials[0].reflectance = Slot(nan); });
  expect("material 0: its specular is negative", [](Scene& s) { s.materials[0].specular = Slot(-0.5f); });
  expect("material 0: its roughness is not finite", [](Scene& s) { s.materials[0].roughness = Slot(infinity); });
  expect("material 0: its eta, k, ior or map_scale", [&](Scene& s) { s.materials[0].ior = nan; });
  expect("material 0: its ior is -1.5; give it more than 0", [](Scene& s) { s.materials[0].ior = -1.5f; });
  expect("material 0: one of its weights is -1", [](Scene& s) { s.materials[0].weights[1] = -1; });
  expect("material 0: its nested material is 4", [](Scene& s) { s.materials[0].nested[0] = 4; });
  expect("mesh 0: its triangle 2 has a corner", [](Scene& s) { s.meshes[0].triangles[2].y = 1000; });
  expect("mesh 0: one of its positions is not finite", [&](Scene& s) { s.meshes[0].positions[1].z = nan; });
  expect("shape 1: its to_world cannot be inverted", [&](Scene& s) { add_sphere(s, Vec3(nan), 1, 0); });
  expect("light 1: stands farther than 1e+18", [](Scene& s) {
    add_light(s, LightKind::point, Slot(1.0f));
    s.lights[1].position.x = 1e19f;
  });
  expect("light 1: its direction is none", [&](Scene& s) {
    add_light(s, LightKind::directional, Slot(1.0f));
    s.lights[1].direction.y = nan;
  });
  expect("mesh 0: has 1 normals and", [](Scene& s) { s.meshes[0].normals = {{0, 0, 1}}; });
  expect("mesh 0: has 1 uvs and", [](Scene& s) { s.meshes[0].uvs = {{0, 0}}; });
  expect("mesh 0: has 2 colors and", [](Scene& s) { s.meshes[0].colors.resize(2); });
  expect("attribute \"wet\"", [](Scene& s) { s.meshes[0].attributes.push_back({"wet", true, {Rgb(1)}}); });
  expect("texture 0: has no image", [](Scene& s) { s.textures.emplace_back(); });
  expect("texture 0: is nested more than", [](Scene& s) {
    s.textures.resize(2);
    s.textures[0].kind = s.textures[1].kind = TextureKind::scale;
    s.textures[0].color1.texture = 1, s.textures[1].color0.texture = 0;
  });
  expect("image 0: has 11 numbers", [](Scene& s) {
    add_image(s, 2, 2, std::vector<float>(12));
    s.images[0].floats.pop_back();
  });
  expect("image 0: is of 0x2 pixels", [](Scene& s) {
    add_image(s, 2, 2, std::vector<float>(12));
    s.images[0].width = 0;
  });
  expect("image 0: its alpha has 3", [](Scene& s) {
    add_image(s, 2, 2, std::vector<float>(12));
    s.images[0].alpha.resize(3);
  });
}

TEST(Build, cameras_that_cannot_be_are_errors) {
  const auto set = [](const Vec3& eye, const Vec3& target, float fov) {
    return [=](Scene& s) { set_camera(s, eye, target, fov, 8, 8); };
  };
  EXPECT_EQ(refusal(set({0, 0, 3}, {0, 0, 0}, 179)), "");
  expect("camera looks nowhere", set({1, 2, 3}, {1, 2, 3}, 40));
  expect("camera looks nowhere", set({std::nanf(""), 0, 3}, {0, 0, 0}, 40));
  expect("camera looks nowhere", [](Scene& s) { set_perspective(s.camera, 40, Mat4(0)); });
  expect("camera stands farther than 1e+18", [](Scene& s) { s.camera.to_world[3].y = 1e19f; });
  for (const float fov : {0.0f, -5.0f, 180.0f, 200.0f, 360.0f, infinity, std::nanf("")})
    expect("camera has no view", set({0, 0, 3}, {0, 0, 0}, fov));
  expect("camera has a lens that is none", [](Scene& s) { s.camera.focus = 0; });
  expect("camera has a lens that is none", [](Scene& s) { s.camera.focus = 1e-38f; });
  for (const float bad : {std::nanf(""), 1e20f}) {
    expect("camera has a lens that is none", [=](Scene& s) { s.camera.aperture = bad; });
    expect("camera has no view", [=](Scene& s) { s.camera.plane.y = bad; });
  }
  expect("camera has less than a pixel", [](Scene& s) { s.camera.width = 0; });
  expect("crop window that is not inside", [](Scene& s) { s.camera.crop_x = 1; });
  expect("crop window that is not inside", [](Scene& s) { s.camera.crop_height = 0; });
}

TEST(Build, cameras_have_places_for_their_clip_planes) {
  for (const float bad : {std::nanf(""), infinity, -1.0f, 1e19f})
    expect("clip planes that are none", [=](Scene& s) { s.camera.near_clip = bad; });
  expect("clip planes that are none", [](Scene& s) { s.camera.far_clip = std::nanf(""); });
  expect("clip planes that are none", [](Scene& s) { s.camera.far_clip = s.camera.near_clip; });
  EXPECT_EQ(refusal([](Scene& s) { set_orthographic(s.camera, Mat4(1)), s.camera.near_clip = -1; }), "");
  expect("clip planes that are none",
         [](Scene& s) { set_orthographic(s.camera, Mat4(1)), s.camera.near_clip = -1e19f; });
  for (const float bad : {std::nanf(""), 1e30f})
    expect("principal point more than", [=](Scene& s) { s.camera.principal.y = bad; });
}

TEST(Build, a_finished_scene_s_camera_may_be_set_but_must_see) {
  Scene scene = cornell(16);
  set_camera(scene, {0, 0, 2}, {0, 0, 0}, 45, 8, 8);
  EXPECT_NO_THROW(require_finished(scene));
  set_camera(scene, {0, 0, 0}, {0, 0, 0}, 45, 8, 8);
  EXPECT_THROW(require_finished(scene), Error);
  set_orthographic(scene.camera, Mat4(1));
  set_camera(scene, {0, 0, 2}, {0, 0, 0}, 45, 8, 8);
  EXPECT_EQ(scene.camera.kind, CameraKind::perspective);
}

TEST(Build, what_is_moved_by_its_transform_is_moved) {
  const Mat4 there = look_at({3, 1, 2}, {0, 0.5f, 0});
  Scene scene = cornell(16);
  scene.groups = 1;
  const uint32_t disk = add_quadric(scene, ShapeKind::disk, Mat4(1), 0);
  scene.shapes[0].group = 0;
  add_instance(scene, 0, Mat4(1));
  finish(scene);
  scene.shapes[disk].to_world = scene.instances[0].to_world = scene.camera.to_world = there;
  finish(scene);
  for (const Mat4& m : {scene.shapes[disk].to_object, scene.instances[0].to_object, scene.camera.to_camera})
    EXPECT_LT(max_abs(map_point(m, map_point(there, {1, 2, 3})) - Vec3(1, 2, 3)), 1e-5f);
}

TEST(Build, transforms_that_cannot_be_are_errors) {
  const Mat4 flat = glm::scale(Mat4(1), Vec3(1, 0, 1)), uneven = glm::scale(Mat4(1), Vec3(1, 2, 1));
  for (const Mat4& m : {flat, Mat4(0), Mat4(std::nanf(""))}) {
    expect("cannot be inverted", [&](Scene& s) { add_quadric(s, ShapeKind::cylinder, m, 0); });
    expect("instance 0: its to_world cannot be inverted", [&](Scene& s) { s.groups = 1, add_instance(s, 0, m); });
  }
  expect("stretches the sphere", [&](Scene& s) { add_quadric(s, ShapeKind::sphere, uneven, 0); });
  EXPECT_EQ(refusal([&](Scene& s) { add_quadric(s, ShapeKind::disk, uneven, 0); }), "");
}

TEST(Build, lights_that_cannot_be_are_errors) {
  expect("is a light and in a group", [](Scene& s) {
    s.groups = 1;
    s.shapes[s.lights[0].shape].group = 0;
  });
  expect("its cone is 0", [](Scene& s) { s.lights[add_light(s, LightKind::sun, Rgb(1))].cone = 0; });
  EXPECT_EQ(refusal([](Scene& s) { add_light(s, LightKind::sun, Rgb(1)); }), "");
  for (const float bad : {std::nanf(""), 0.0f, 7.0f})
    expect(fmt::format("its cutoff is {}", bad).c_str(),
           [=](Scene& s) { s.lights[add_light(s, LightKind::spot, Rgb(1))].cutoff = bad; });
  expect("its beam 2", [](Scene& s) { s.lights[add_light(s, LightKind::spot, Rgb(1))].beam = 2; });
  expect("its picture has no extent",
         [](Scene& s) { s.lights[add_light(s, LightKind::projector, Rgb(1))].plane.y = std::nanf(""); });
  expect("its scale is -1", [](Scene& s) { add_envmap(s, add_image(s, 1, 1, {1, 1, 1}), -1); });
}

TEST(Build, directions_become_unit) {
  Scene scene = under_sky(LightKind::directional);
  scene.lights[0].direction = {0, -5, 0};
  finish(scene);
  EXPECT_EQ(scene.lights[0].direction, Vec3(0, -1, 0));
}

TEST(Build, doors_open_so_far) {
  EXPECT_THROW(two_rooms(121), Error);
  EXPECT_THROW(two_rooms(-1), Error);
  EXPECT_NO_THROW(two_rooms(120));
}

TEST(Build, the_camera_is_set_without_a_crop_window) {
  Scene scene = cornell(16);
  scene.camera.crop_x = 8, scene.camera.crop_y = 4, scene.camera.crop_width = 8;
  set_camera(scene, {0, 0, 3}, {0, 0, 0}, 45, 16, 16);
  EXPECT_EQ(scene.camera.crop_x, 0);
  EXPECT_EQ(scene.camera.crop_y, 0);
  EXPECT_EQ(scene.camera.crop_width, 16);
}

TEST(Build, the_choice_of_lights_outlives_a_change) {
  Scene scene = many_lights(8, 1, 16);
  EXPECT_EQ(scene.light_tree.choice, LightChoice::tree);
  set_light_choice(scene, LightChoice::power);
  finish(scene);
  EXPECT_EQ(scene.light_tree.choice, LightChoice::power);
  Scene other;
  set_light_choice(other, LightChoice::uniform);
  finish(other);
  EXPECT_EQ(other.light_tree.choice, LightChoice::uniform);
}

TEST(Build, parts_that_cannot_be_are_errors) {
  Scene scene;
  EXPECT_THROW(add_image(scene, 64, 64, {1, 1, 1}), Error);
  EXPECT_THROW(add_image(scene, 1, 1, {1, std::nanf(""), 1}), Error);
  EXPECT_THROW(add_envmap(scene, Slot(1.0f)), Error);
  EXPECT_THROW(add_envmap(scene, add_checkerboard(scene, Rgb(0), Rgb(1))), Error);
  EXPECT_THROW(add_area_light(scene, 0, Slot(1.0f)), Error);
}

// Maps of normals may hold them.
TEST(Build, negative_images_are_no_colours) {
  const auto grey_of = [](Scene& s, float value) { return add_image(s, 1, 1, {value, value, value}); };
  EXPECT_EQ(refusal([&](Scene& s) { s.materials[0].reflectance = grey_of(s, 1); }), "");
  EXPECT_EQ(refusal([&](Scene& s) { s.materials[0].map = grey_of(s, -1); }), "");
  expect("image 0 of its reflectance holds negative", [&](Scene& s) { s.materials[0].reflectance = grey_of(s, -1); });
  expect("image 0 of its radiance holds negative", [&](Scene& s) { s.lights[0].radiance = grey_of(s, -1); });
  expect("image 0 of its reflectance holds negative", [&](Scene& s) {
    Texture mixed;
    mixed.kind = TextureKind::scale, mixed.color0 = grey_of(s, -1);
    s.textures.push_back(mixed);
    s.materials[0].reflectance.texture = uint32_t(s.textures.size() - 1);
  });
}

TEST(Build, what_was_added_to_is_not_finished) {
  Scene scene;
  EXPECT_THROW(require_finished(scene), Error);
  finish(scene);
  EXPECT_NO_THROW(require_finished(scene));
  scene = cornell(16);
  EXPECT_NO_THROW(require_finished(scene));
  add_sphere(scene, Vec3(0), 0.1f, 0);
  EXPECT_THROW(require_finished(scene), Error);
  finish(scene);
  scene.lights.emplace_back();
  EXPECT_THROW(require_finished(scene), Error);
  scene = cornell(16);
  scene.meshes[0].triangles.pop_back();
  EXPECT_THROW(require_finished(scene), Error);
  scene.meshes[0].triangles.push_back({0, 1, 1000});
  EXPECT_THROW(finish(scene), Error);
  EXPECT_THROW(require_finished(scene), Error) << "what cannot be finished is not";
}

TEST(Build, every_feature_scene_is_finished) {
  std::set<std::string> names;
  for (const FeatureScene& feature : feature_scenes()) {
    const Scene scene = feature.make();
    expect_finished(scene, feature.name);
    EXPECT_LE(scene.camera.width, 32) << feature.name;
    EXPECT_TRUE(names.insert(feature.name).second) << feature.name << " twice";
  }
  EXPECT_GE(names.size(), 30u);
}

TEST(Build, every_material_has_an_example) {
  for (int kind = 0; kind <= int(MaterialKind::normalmap); ++kind)
    expect_finished(with_material(MaterialKind(kind)), "material " + std::to_string(kind));
}

TEST(Build, furnaces_are_closed_and_shine_inwards) {
  for (const Oven oven : {Oven::box, Oven::sphere, Oven::globe}) {
    const Scene scene = furnace(oven, Material{}, Rgb(2));
    expect_finished(scene, "furnace");
    ASSERT_EQ(scene.shapes.size(), 1u);
    EXPECT_EQ(scene.lights[scene.shapes[0].light].radiance.value, Rgb(2));
    if (oven == Oven::sphere) {
      EXPECT_TRUE(scene.shapes[0].flip);
      continue;
    }
    for (const glm::uvec3& t : scene.meshes[0].triangles) {
      const auto [n, p] = face(scene.meshes[0], t);
      EXPECT_LT(glm::dot(n, p), 0);
    }
  }
  expect_finished(inside_sphere(), "inside");
}

TEST(Build, the_polygon_has_its_area_and_faces_the_floor) {
  for (const int n : {3, 4, 5, 12}) {
    const Scene scene = polygon_over_plane(n, 2, 0.5f);
    expect_finished(scene, "polygon");
    const Mesh& mesh = scene.meshes[1];
    EXPECT_NEAR(mesh.total_area, 0.5 * n * 0.25 * std::sin(2 * std::numbers::pi / n), 1e-6);
    for (const glm::uvec3& t : mesh.triangles) EXPECT_LT(face(mesh, t).first.y, 0);
  }
  // The camera sees floor alone: every corner ray goes down, below the polygon.
  const Scene scene = polygon_over_plane(4);
  for (const Vec2& at : {Vec2(0, 0), Vec2(32, 0), Vec2(0, 32), Vec2(32, 32)}) {
    const CameraRay ray = generate(scene.camera, at, Vec2(0.5f));
    EXPECT_LT(ray.o.y, 1);
    EXPECT_LT(ray.d.y, 0);
    EXPECT_LT(glm::length(ray.o - ray.d * (ray.o.y / ray.d.y)), 50);
  }
}

TEST(Build, two_rooms_share_an_opening_and_one_light) {
  for (const float door : {0.0f, 5.0f, 90.0f, 120.0f}) {
    const Scene scene = two_rooms(door);
    expect_finished(scene, "two rooms");
    EXPECT_EQ(scene.lights.size(), 1u);
    for (const size_t room : {0, 1}) {
      EXPECT_EQ(scene.meshes[room].triangles.size(), 10u);  // five walls
      for (const glm::uvec3& t : scene.meshes[room].triangles) {
        const auto [n, p] = face(scene.meshes[room], t);
        EXPECT_GT(glm::dot(n, Vec3(2, 1.25f, room == 0 ? 2 : -2) - p), 0);  // looks into the room
      }
    }
    EXPECT_GT(scene.camera.to_world[3].z, 0);                               // the camera here,
    for (const Vec3& p : scene.meshes.back().positions) EXPECT_LT(p.z, 0);  // the lamp there
  }
}

TEST(Build, mirror_chains_reach_their_screen) {
  for (const int n : {0, 1, 2, 7, 64}) {
    const Scene scene = mirror_chain(n);
    expect_finished(scene, "mirrors");
    ASSERT_EQ(scene.shapes.size(), size_t(n) + 2);
    Vec3 o(0), d = glm::normalize(Vec3(1, 1, 0));
    for (int i = 0; i <= n; ++i) {  // by hand: the next shape's plane, inside its outline, from its outer side
      const Mesh& mesh = scene.meshes[size_t(i)];
      const Vec3 normal = glm::normalize(face(mesh, mesh.triangles[0]).first);
      const float t = glm::dot(mesh.positions[0] - o, normal) / glm::dot(d, normal);
      EXPECT_GT(t, 0.1f);
      EXPECT_LT(glm::dot(d, normal), 0) << i << " of " << n;
      o += t * d, d = glm::reflect(d, normal);
      const Vec3 middle = 0.5f * (mesh.positions[0] + mesh.positions[2]);
      EXPECT_LT(max_abs(o - middle), 1e-3f) << i << " of " << n;
    }
  }
}

TEST(Build, many_lights_are_as_many_and_the_seed_decides) {
  for (const int n : {1, 2, 100, 1000}) {
    const Scene scene = many_lights(n, 3);
    EXPECT_EQ(scene.lights.size(), size_t(n));
    EXPECT_EQ(scene.light_tree.pieces.size(), size_t(n));
  }
  const Scene a = many_lights(9, 1), b = many_lights(9, 1), c = many_lights(9, 2);
  EXPECT_EQ(a.meshes.back().positions, b.meshes.back().positions);
  EXPECT_NE(a.meshes.back().positions, c.meshes.back().positions);
  EXPECT_TRUE(many_lights(0).lights.empty());
}

TEST(Build, instances_are_copies_or_mirror_images) {
  const Scene copies = instanced(false), mirrored = instanced(true);
  ASSERT_EQ(mirrored.instances.size(), 2u);
  EXPECT_GT(glm::determinant(Mat3(copies.instances[1].to_world)), 0);
  EXPECT_LT(glm::determinant(Mat3(mirrored.instances[1].to_world)), 0);
  for (const Shape& shape : mirrored.shapes) {
    if (shape.group == none) continue;
    for (const Vec3& p : mirrored.meshes[shape.mesh].positions) {
      const Vec3 left = mirrored.instances[0].to_world * Vec4(p, 1),
                 right = mirrored.instances[1].to_world * Vec4(p, 1);
      EXPECT_LT(max_abs(left * Vec3(-1, 1, 1) - right), 1e-6f);
      EXPECT_LT(max_abs(left), 1);
      EXPECT_LT(left.x, 0);
    }
  }
}

TEST(Build, boxes_and_quads_face_where_they_say) {
  Scene scene;
  const uint32_t grey = add_diffuse(scene, Rgb(0.5f));
  add_quad(scene, {1, 2, 3}, {2, 0, 0}, {0, 0, -3}, grey);
  add_box(scene, {1, 1, 1}, {3, 4, 5}, grey);
  add_box(scene, {1, 1, 1}, {3, 4, 5}, grey, true);
  for (const glm::uvec3& t : scene.meshes[0].triangles) EXPECT_EQ(face(scene.meshes[0], t).first, Vec3(0, 6, 0));
  for (const size_t i : {1, 2})
    for (const glm::uvec3& t : scene.meshes[i].triangles) {
      const auto [n, p] = face(scene.meshes[i], t);
      EXPECT_GT(glm::dot(n, p - Vec3(2, 2.5f, 3)) * (i == 1 ? 1 : -1), 0);
    }
}

}  // namespace
}  // namespace ajar
